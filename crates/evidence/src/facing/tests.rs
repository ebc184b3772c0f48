//! Back-face detection on convex bodies and on other bodies.

use binspace::internals::cuboid;
use binspace::raster::{compare, zbuffer};
use proptest::prelude::*;
use testkit::prelude::*;

use super::Facing;
use crate::method::{FrontFaces, InputOrder, Method, Newell};

type Corner = [i64; 3];

fn minus(a: Corner, b: Corner) -> Corner {
    std::array::from_fn(|i| a[i] - b[i])
}

/// Six times the volume between three points and a fourth.
fn volume(p: Corner, q: Corner, r: Corner, s: Corner) -> i64 {
    let [[a, b, c], [d, e, f], [g, h, i]] = [minus(q, p), minus(r, p), minus(s, p)];
    a * (e * i - f * h) - b * (d * i - f * g) + c * (d * h - e * g)
}

/// The triangles of the convex hull of points, fronts outside: each has every other point behind it. `None`
/// if four points are in one plane there.
fn hull(points: &[Corner]) -> Option<Vec<[DVec3; 3]>> {
    let mut triangles = Vec::new();
    for (i, &p) in points.iter().enumerate() {
        for (j, &q) in points.iter().enumerate().skip(i + 1) {
            for (k, &r) in points.iter().enumerate().skip(j + 1) {
                let others = points.iter().enumerate().filter(|(l, _)| ![i, j, k].contains(l));
                let sides: Vec<i64> = others.map(|(_, &s)| volume(p, q, r, s)).collect();
                let (above, below) = (sides.iter().any(|&v| v > 0), sides.iter().any(|&v| v < 0));
                if above && below {
                    continue;
                }
                if sides.contains(&0) {
                    return None;
                }
                let corner = |c: Corner| DVec3::from_array(c.map(|c| c as f64));
                let [a, b, c] = [p, q, r].map(corner);
                triangles.push(if above { [a, c, b] } else { [a, b, c] });
            }
        }
    }
    Some(triangles)
}

fn corner() -> impl Strategy<Value = Corner> {
    [-1000..1000i64, -1000..1000i64, -1000..1000i64]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(60))]

    #[test]
    fn of_a_convex_body_the_faces_that_show_their_fronts_are_the_picture(
        points in prop::collection::vec(corner(), 4..20),
        from in corner(),
        is_parallel in any::<bool>(),
    ) {
        let hull = hull(&points);
        prop_assume!(hull.is_some() && from != [0; 3]);
        let triangles = hull.unwrap_or_default();
        let direction = DVec3::from_array(from.map(|c| c as f64)).normalize();
        let size = [64, 48];
        let up = DVec3::new(0.3, 0.5, 0.7);
        let camera = if is_parallel {
            Camera::parallel(-direction, up, DVec3::ZERO, 3000.0, size)
        } else {
            Camera::perspective(direction * 4000.0, DVec3::ZERO, up, 0.7, size)
        };
        prop_assume!(camera.is_ok());
        let camera = camera.unwrap();
        let (faces, _) = Faces::new(&triangles, Some(0.0)).unwrap();
        let rays = Rays::new(&camera, &faces).unwrap();
        let method = FrontFaces(InputOrder);
        let painted = method.prepare(&faces).unwrap().paint(&camera, &rays).unwrap();
        let found = compare(&rays, &faces, &painted.image, zbuffer(&rays, &faces).image());
        prop_assert_eq!(found.wrong(), 0);
        let facing = Facing::of(&faces, camera.viewpoint());
        prop_assert_eq!(painted.pieces + facing.removed(), faces.len());
        prop_assert!(found.covered > 0 || facing.front > 0);
    }
}

fn seen(polygons: &[[DVec3; 4]], camera: &Camera) -> (Facing, usize) {
    let (faces, _) = Faces::new(polygons, Some(0.0)).unwrap();
    let rays = Rays::new(camera, &faces).unwrap();
    let method = FrontFaces(InputOrder);
    let painted = method.prepare(&faces).unwrap().paint(camera, &rays).unwrap();
    let found = compare(&rays, &faces, &painted.image, zbuffer(&rays, &faces).image());
    (Facing::of(&faces, camera.viewpoint()), found.wrong())
}

#[test]
fn a_box_shows_one_two_or_three_faces() {
    let cube = cuboid(DVec3::ZERO, DVec3::ONE);
    let facing = |front, back, edge_on| Facing { front, back, edge_on };
    // If the direction is along one axis, C = 0 for four faces. If it is in the plane of two axes, C = 0 for
    // two faces. Otherwise C = 0 for no face.
    for (direction, expected) in [
        (DVec3::NEG_Z, facing(1, 1, 4)),
        (DVec3::new(-1.0, 0.0, -1.0), facing(2, 2, 2)),
        (DVec3::new(-1.0, -2.0, -3.0), facing(3, 3, 0)),
    ] {
        let up = DVec3::new(0.0, 1.0, 0.1);
        let camera = Camera::parallel(direction, up, DVec3::splat(0.5), 3.0, [40, 30]).unwrap();
        assert_eq!(seen(&cube, &camera), (expected, 0), "{direction}");
    }
    // An eye near a face sees only this face. An eye in the plane of a face does not see this face.
    for (eye, expected) in [
        (DVec3::new(0.5, 0.5, 3.0), facing(1, 5, 0)),
        (DVec3::new(1.0, 0.5, 3.0), facing(1, 4, 1)),
        (DVec3::new(2.0, 0.5, 3.0), facing(2, 4, 0)),
        (DVec3::new(2.0, 5.0, 3.0), facing(3, 3, 0)),
    ] {
        let camera =
            Camera::perspective(eye, DVec3::splat(0.5), DVec3::new(0.1, 1.0, 0.2), 0.9, [40, 30]);
        assert_eq!(seen(&cube, &camera.unwrap()), (expected, 0), "{eye}");
    }
}

/// Two boxes, the nearer first. Their fronts overlap, so the step alone is not enough. Before another method,
/// the step changes only the work.
#[test]
fn the_step_does_not_change_pictures_of_closed_bodies() {
    let near = cuboid(DVec3::new(0.0, 0.0, 2.0), DVec3::new(1.0, 1.0, 3.0));
    let two = [near, cuboid(DVec3::ZERO, DVec3::ONE)].concat();
    let eye = DVec3::new(1.5, 1.7, 9.0);
    let camera = Camera::perspective(eye, DVec3::splat(0.5), DVec3::Y, 0.5, [80, 60]).unwrap();
    assert!(seen(&two, &camera).1 > 50);
    for scene in [scene::city(60, 1), scene::newell_bars()] {
        let (faces, _) = Faces::new(scene.polygons(), Some(0.0)).unwrap();
        let (low, high) = scene.bounds().unwrap();
        let camera = Camera::looking_at_all([low, high], DVec3::Z, [80, 60]).unwrap();
        let rays = Rays::new(&camera, &faces).unwrap();
        let paint =
            |method: &dyn Method| method.prepare(&faces).unwrap().paint(&camera, &rays).unwrap();
        let (all, fronts) = (paint(&Newell::DEFAULT), paint(&FrontFaces(Newell::DEFAULT)));
        let found = compare(&rays, &faces, &fronts.image, zbuffer(&rays, &faces).image());
        assert_eq!(found.wrong(), 0, "{}", scene.name());
        let facing = Facing::of(&faces, camera.viewpoint());
        assert_eq!([all.removed, fronts.removed], [0, facing.removed()]);
        assert!(3 * fronts.pieces < 2 * all.pieces, "{} {}", fronts.pieces, all.pieces);
    }
}
