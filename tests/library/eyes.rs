//! Eyes are rounded once: points of the grid are not moved, even if their position on the grid has more
//! digits than the eye's own coordinates.

use binspace::Facing;
use binspace::internals::Lattice;
use testkit::prelude::*;
use testkit::rational::Plane;
use testkit::views::in_lattice;

#[test]
fn an_eye_one_step_behind_a_plane_sees_its_back() {
    let (hair, step) = (2f64.powi(-46), 2f64.powi(-51));
    let wall = [
        [0.25, 0.25, 0.25],
        [1.25 + hair, 0.25, 0.25],
        [1.25 + hair, 1.25, 1.25],
        [0.25, 1.25, 1.25],
    ];
    let triangle =
        [[0.5 + step, 0.5, 0.5], [0.5 + step, 0.75, 0.5], [1.0 + step, 0.5, 0.503_906_25]];
    let tree = BuildOptions::DEFAULT
        .with_tolerance(0.0)
        .build([&wall[..], &triangle[..]])
        .expect("two polygons");
    let eye = DVec3::new(100.0, 0.5, 1.277_343_75);
    let corners = triangle.map(rational::point);
    let plane = Plane::through(corners.each_ref());
    assert_eq!(rational::sign(&plane.at(&rational::point(eye))), Ordering::Less);
    let seen = tree.fragments().find(|fragment| fragment.polygon() == 1).expect("a fragment");
    assert_eq!(seen.facing(Viewpoint::Eye(eye)), Facing::Back);
}

/// Triangles whose planes go through an eye, or miss it by a step of the grid. Eyes are up to 400 extents
/// from the scene.
#[test]
fn eyes_on_the_grid_are_not_moved() {
    let mut dice = Dice(7);
    let mut seen = [0; 3];
    for round in 0..400 {
        // A box whose middle has as many digits as the grid.
        let mut digits = || (dice.roll() >> 14) as f64 * 2f64.powi(-50);
        let low = DVec3::new(digits(), digits(), digits());
        let high = low + DVec3::new(1.0 - digits().min(0.25), 0.75, 0.5);
        let lattice = Lattice::new(low, high);
        let size = [1.0, 30.0, 400.0][round % 3];
        let eye =
            DVec3::from_array([0; 3].map(|_| ((dice.share() - 0.5) * size * 64.0).round() / 64.0));
        let Some((triangle, exact)) = triangle_beside(&lattice, eye, &mut dice) else { continue };
        let corners = triangle.map(|corner| lattice.to_world(corner));
        let frame = [low, high, DVec3::new(low.x, high.y, low.z)];
        let (faces, _) = Faces::new([frame, corners], Some(0.0)).expect("finite");
        assert_eq!(faces.corners(1), triangle, "the box defines the lattice");
        let expected = rational::sign(&exact);
        let tree = BuildOptions::DEFAULT.with_tolerance(0.0).build([frame, corners]).expect("fits");
        for fragment in tree.fragments().filter(|fragment| fragment.polygon() == 1) {
            assert_eq!(
                fragment.facing(Viewpoint::Eye(eye)),
                expected.into(),
                "round {round}: {eye}"
            );
        }
        seen[(expected as i8 + 1) as usize] += 1;
    }
    assert!(seen.iter().all(|&count| count > 30), "{seen:?}");
}

/// A triangle of lattice points, and the value of its plane at an eye: 0, or about the area of a
/// parallelogram that is a step wide.
fn triangle_beside(
    lattice: &Lattice,
    eye: DVec3,
    dice: &mut Dice,
) -> Option<([[f64; 3]; 3], Rational)> {
    const REACH: i128 = 1 << 49;
    let exact = in_lattice(lattice, eye);
    let at = exact.each_ref().map(|c| i128::try_from(c.numerator().clone()).expect("near enough"));
    assert!(exact.iter().all(|c| c.is_int()), "on the grid");
    let mut any = |most: i128| i128::from(dice.roll() >> 8) % (2 * most + 1) - most;
    let p = [0; 3].map(|_| any(REACH));
    let way: [i128; 3] = std::array::from_fn(|i| at[i] - p[i]);
    // The eye is at p + times · u + w.
    let times = 1 + way.iter().map(|c| c.abs()).max()? / REACH;
    let u: [i128; 3] = std::array::from_fn(|i| way[i] / times + any(REACH / 4 / times));
    let mut w: [i128; 3] = std::array::from_fn(|i| way[i] - times * u[i]);
    let axis = any(1) + 1;
    w[axis as usize] += any(1);
    let corner = |arm: [i128; 3]| std::array::from_fn(|i| (p[i] + arm[i]) as f64);
    let triangle: [[f64; 3]; 3] = [[0; 3], u, w].map(corner);
    let corners = triangle.map(rational::point);
    let is_within = triangle.iter().flatten().all(|c| c.abs() <= (2 * REACH) as f64);
    is_within.then(|| (triangle, Plane::through(corners.each_ref()).at(&exact)))
}
