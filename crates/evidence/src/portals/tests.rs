//! What is kept, against exact pictures.

use super::Cells;
use super::outline::{Plane, clip, hull, split, without};
use crate::interior;
use binspace::BspTree;
use binspace::glam::{DVec3, dvec3};
use binspace::internals::SplitMix64;
use binspace::raster::{NONE, Rays, zbuffer};
use binspace::view::Camera;

/// The polygons that own a pixel in a picture.
fn owners(tree: &BspTree, camera: &Camera) -> Vec<usize> {
    let rays = Rays::new(camera, tree.faces()).unwrap();
    let depth = zbuffer(&rays, tree.faces());
    let shown = depth.image().faces().iter().filter(|&&face| face != NONE);
    let mut owners: Vec<usize> = shown.map(|&face| tree.faces().polygon(face)).collect();
    owners.sort_unstable();
    owners.dedup();
    owners
}

#[test]
fn nothing_that_owns_a_pixel_is_left_out() {
    let level = interior::rooms(5);
    let tree = BspTree::build(&level).unwrap();
    let cells = Cells::new(&tree, level.len());
    let mut random = SplitMix64::new(5);
    let (mut owned, mut kept, mut kept_by_cell) = (0, 0, 0);
    for _ in 0..60 {
        let eye = dvec3(random.range(0.1, 39.9), random.range(0.1, 39.9), random.range(0.2, 2.9));
        let target = eye + random.point(-1.0, 1.0) * dvec3(1.0, 1.0, 0.3);
        let camera = Camera::perspective(eye, target, DVec3::Z, 1.2, [96, 72]).unwrap();
        let seen = cells.seen_from(eye, &camera.frustum());
        let at: Vec<usize> = cells.at(eye);
        assert_eq!(at.len(), 1);
        let from_cell = cells.seen_from_cell(at[0]);
        for polygon in owners(&tree, &camera) {
            assert!(seen.polygons[polygon], "{polygon} from {eye}");
            assert!(from_cell.polygons[polygon], "{polygon} from the cell of {eye}");
            owned += 1;
        }
        // An eye sees less than its cell.
        for (&by_eye, &by_cell) in seen.polygons.iter().zip(&from_cell.polygons) {
            assert!(!by_eye || by_cell);
        }
        kept += seen.polygon_count();
        kept_by_cell += from_cell.polygon_count();
    }
    let all = 60 * level.len();
    assert!(owned > 400, "{owned}");
    assert!(kept * 4 < 5 * owned, "{kept} of {owned}");
    assert!(kept_by_cell < all / 2, "{kept_by_cell} of {all}");
}

/// A square with corners at `low` and `high` in the plane z = 0.
fn square(low: f64, high: f64) -> Vec<DVec3> {
    [(low, low), (high, low), (high, high), (low, high)].map(|(x, y)| dvec3(x, y, 0.0)).to_vec()
}

fn area(outline: &[DVec3]) -> f64 {
    let arms = outline.windows(2).map(|pair| (pair[0] - outline[0]).cross(pair[1] - outline[0]));
    0.5 * arms.sum::<DVec3>().length()
}

#[test]
fn outlines_by_hand() {
    let ground = Plane::new(DVec3::Z, DVec3::ZERO);
    let slope = Plane::new(dvec3(1.0, 1.0, 0.0).normalize(), dvec3(1.0, 0.0, 0.0));
    // The corner below x + y = 1 is half a unit square, of four.
    assert!((area(&clip(&square(0.0, 2.0), &slope)) - 3.5).abs() < 1e-12);
    let [front, back] = split(&square(0.0, 2.0), &slope, 1e-9);
    assert!((area(&front) - 3.5).abs() < 1e-12 && (area(&back) - 0.5).abs() < 1e-12);
    // A window in a wall leaves four pieces; a wall in a window none; one beside it all of it.
    let left = without(square(0.0, 4.0), &square(1.0, 2.0), &ground, 1e-9);
    assert_eq!(left.len(), 4);
    assert!((left.iter().map(|piece| area(piece)).sum::<f64>() - 15.0).abs() < 1e-12);
    assert!(without(square(1.0, 2.0), &square(0.0, 4.0), &ground, 1e-9).is_empty());
    assert!(without(square(1.0, 2.0), &square(1.0, 2.0 - 1e-12), &ground, 1e-9).is_empty());
    assert_eq!(without(square(0.0, 1.0), &square(1.0, 2.0), &ground, 1e-9).len(), 1);
    let both = [square(0.0, 1.0), square(2.0, 3.0)].concat();
    assert!((area(&hull(both, &ground)) - 5.0).abs() < 1e-12);
}
