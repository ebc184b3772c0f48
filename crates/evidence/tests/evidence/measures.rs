//! The measures of error, against pictures and trees with known faults.

use binspace::raster::{Outline, Painter, Piece, zbuffer};
use binspace_evidence::measure::{PictureError, area_error, extent};
use binspace_evidence::{Accuracy, Family, Tree, accuracy};
use testkit::prelude::*;

/// A square of side 2 around the z axis.
fn square(z: f64) -> [[f64; 3]; 4] {
    [[-1.0, -1.0, z], [1.0, -1.0, z], [1.0, 1.0, z], [-1.0, 1.0, z]]
}

/// Squares half a unit apart, seen from above without perspective, in 40 × 40 of 60 × 60 pixels.
fn stack() -> (Faces, Rays) {
    let (faces, _) = Faces::new([square(0.0), square(0.5), square(1.0)], Some(0.0)).unwrap();
    let camera = Camera::parallel(DVec3::NEG_Z, DVec3::Y, DVec3::ZERO, 3.0, [60, 60]).unwrap();
    let rays = Rays::new(&camera, &faces).unwrap();
    (faces, rays)
}

fn judged(order: &[u32], pieces: Outline<'_>) -> PictureError {
    let (faces, rays) = stack();
    let mut painter = Painter::new(&rays, &faces);
    for &face in order {
        painter.draw(Piece { face, outline: pieces });
    }
    let truth = zbuffer(&rays, &faces).into_image();
    PictureError::of(&rays, &faces, &painter.finish(), &truth)
}

#[test]
fn known_faults_of_pictures_are_found() {
    let right = judged(&[0, 1, 2], Outline::Whole);
    assert_eq!((right.covered, right.wrong(), right.depth_max), (1600, 0, 0.0));

    // The lowest square is painted on top: all pixels are wrong, by 1 of an extent of 2.
    let upside_down = judged(&[2, 1, 0], Outline::Whole);
    assert_eq!((upside_down.wrong_order, upside_down.wrong()), (1600, 1600));
    assert!((upside_down.depth_max - 0.5).abs() < 1e-12, "{upside_down:?}");
    assert!((upside_down.depth_mean - 0.5).abs() < 1e-12, "{upside_down:?}");
    let middle = judged(&[2, 0, 1], Outline::Whole);
    assert!((middle.depth_mean - 0.25).abs() < 1e-12, "{middle:?}");

    let holes = judged(&[], Outline::Whole);
    assert_eq!((holes.holes, holes.wrong(), holes.wrong_share()), (1600, 1600, 1.0));

    // Half of each square: the lower half of the picture is left out.
    let (faces, _) = stack();
    let [a, b, ..] = *faces.corners(0) else { panic!("a square") };
    let half = [[a[0], 0.0, a[2]], [b[0], 0.0, b[2]], [b[0], -a[1], b[2]], [a[0], -a[1], a[2]]];
    let halved = judged(&[0, 1, 2], Outline::Vertices(&half));
    assert_eq!((halved.holes, halved.wrong()), (800, 800));

    // Half as high again: pixels above and below are painted by mistake.
    let high = faces.corners(0).to_vec();
    let high: Vec<[f64; 3]> = high.into_iter().map(|[x, y, z]| [x, 1.5 * y, z]).collect();
    let spilt = judged(&[0, 1, 2], Outline::Vertices(&high));
    assert_eq!((spilt.spills, spilt.wrong()), (800, 800));
}

#[test]
fn sums_of_pictures_keep_the_mean_depth() {
    let mut sum = judged(&[2, 1, 0], Outline::Whole);
    sum += judged(&[2, 0, 1], Outline::Whole);
    sum += judged(&[0, 1, 2], Outline::Whole);
    assert_eq!((sum.covered, sum.wrong(), sum.depth_pixels), (4800, 3200, 3200));
    assert!((sum.depth_mean - 0.375).abs() < 1e-12 && (sum.depth_max - 0.5).abs() < 1e-12);
}

#[test]
fn the_extent_is_the_longest_side() {
    let (faces, _) = stack();
    assert_eq!(extent(&faces), 2.0);
}

#[test]
fn area_that_is_missing_or_too_much_is_found() {
    let (faces, _) = stack();
    assert_eq!(area_error(&faces, |_| {}), None);
    let show = |shares: [f64; 3]| {
        let error = area_error(&faces, |visit| {
            for (face, share) in (0..).zip(shares) {
                let shrink = |c: &[f64; 3]| [c[0] * share, c[1], c[2]];
                let vertices: Vec<[f64; 3]> = faces.corners(face).iter().map(shrink).collect();
                visit(face, &vertices);
            }
        });
        let error = error.unwrap();
        (error.pieces, error.worst, error.total)
    };
    assert_eq!(show([1.0, 1.0, 1.0]), (3, 0.0, 0.0));
    assert_eq!(show([1.0, 0.75, 1.0]), (3, 0.25, 0.25 / 3.0));
    assert_eq!(show([1.5, 0.5, 1.0]), (3, 0.5, 1.0 / 3.0));
}

fn accuracy_with(epsilon: f64, scene: &Scene) -> Accuracy {
    let (faces, _) = Faces::new(scene.polygons(), Some(0.0)).unwrap();
    accuracy(&Tree::with_epsilon::<f64>(faces, epsilon, usize::MAX).unwrap())
}

#[test]
fn a_large_epsilon_misplaces_vertices_and_moves_them() {
    let scene = Family::Penetration.scene(30.0, 2);
    let far = accuracy_with(0.05, &scene);
    enough!(far.misplaced > 50; "{far:?}");
    assert!(far.drift_max > 1e10 && far.torn > 0, "{far:?}");
    let near = accuracy_with(1e-12, &scene);
    assert!(near.misplaced < far.misplaced / 10, "{near:?}");
    assert!((0.1..100.0).contains(&near.drift_max), "{near:?}");
}

#[test]
fn the_exact_tree_misplaces_and_tears_nothing_in_any_family() {
    let options = BuildOptions::DEFAULT.with_tolerance(Family::TOLERANCE);
    for family in Family::ALL {
        for &difficulty in family.sweep(true) {
            if family == Family::Nesting && difficulty > 100.0 {
                continue;
            }
            let scene = family.scene(difficulty, 2);
            let found = accuracy(&Tree::from(&options.build(scene.polygons()).unwrap()));
            let wrong = (found.misplaced, found.undefined, found.torn);
            assert_eq!(wrong, (0, 0, 0), "{family} {difficulty:e}: {found:?}");
            // Three roundings of at most a quarter each.
            assert!(found.drift_max <= 0.75, "{family} {difficulty:e}: {found:?}");
        }
    }
}

#[test]
fn crossing_triangles_within_the_epsilon_are_put_on_wrong_planes() {
    let scene = Family::Angle.scene(1e-9, 1);
    let found = accuracy_with(1e-6, &scene);
    // Six triangles are put on one plane. All corners of the other triangles are misplaced, except corners
    // that happen to be on the plane.
    assert!((10..=15).contains(&found.misplaced), "{found:?}");
    assert_eq!((found.vertices, found.torn), (18, 0), "{found:?}");
}
