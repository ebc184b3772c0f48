//! Polygons that are just hidden, and polygons that are just visible.

use super::map_of;
use testkit::fill::{Score, check};
use testkit::prelude::*;
use testkit::shapes::rectangle;

fn shown(tree: &BspTree, camera: &Camera) -> Vec<usize> {
    let map = map_of(tree, camera);
    map.polygons().map(|shown| shown.polygon).collect()
}

fn sized([x, y]: [f64; 2], [w, h]: [f64; 2], z: f64) -> Vec<DVec3> {
    rectangle([x, y], [x + w, y + h], z)
}

/// A checkerboard whose squares of one colour are further back, and larger, so that all squares together fill
/// the picture without gaps. In the picture, squares share only corners and edges.
#[test]
fn polygons_behind_a_checkerboard_are_hidden_until_a_square_is_missing() {
    let eye = DVec3::new(0.0, 0.0, 16.0);
    let camera = Camera::perspective(eye, DVec3::ZERO, DVec3::Y, 0.9, [97, 61]).unwrap();
    let mut squares = Vec::new();
    for i in -4..4 {
        for j in -4..4 {
            // Squares at twice the distance from the eye are twice as large.
            let (z, scale) = if (i + j) % 2 == 0 { (8.0, 0.5) } else { (0.0, 1.0) };
            squares.push(sized([i, j].map(|c| f64::from(c) * scale), [scale; 2], z));
        }
    }
    let hidden = squares.len();
    squares.push(sized([-3.0, -3.0], [6.0; 2], -1.0));
    let tree = BspTree::build(&squares).unwrap();
    let all: Vec<usize> = (0..hidden).collect();
    assert_eq!(shown(&tree, &camera), all);
    for missing in [0, 9, 27, 36] {
        let mut squares = squares.clone();
        squares.remove(missing);
        let tree = BspTree::build(&squares).unwrap();
        let is_shown = shown(&tree, &camera).contains(&(hidden - 1));
        // The first square reaches beyond the square behind it.
        assert_eq!(is_shown, missing != 0, "{missing}");
        check(&tree, &camera, &mut Score::default()).unwrap();
    }
}

/// The background is visible through a gap far narrower than a pixel.
#[test]
fn the_narrowest_gap_shows_polygons_behind() {
    let eye = DVec3::new(0.0, 0.0, 5.0);
    let camera = Camera::perspective(eye, DVec3::ZERO, DVec3::Y, 0.9, [64, 64]).unwrap();
    for (gap, expected) in [(0.0, vec![0, 1]), (2f64.powi(-40), vec![0, 1, 2])] {
        let left = sized([-4.0, -4.0], [4.0, 8.0], 0.0);
        let right = sized([gap, -4.0], [4.0, 8.0], 0.0);
        let behind = sized([-1.0, -1.0], [2.0; 2], -1.0);
        let tree = BspTree::build([left, right, behind]).unwrap();
        assert_eq!(shown(&tree, &camera), expected, "{gap}");
    }
}

/// A wall hides everything behind it, although polygons in front of the wall cut it into many pieces.
#[test]
fn a_wall_in_pieces_hides_all_behind_it() {
    let mut polygons = vec![sized([-50.0, -50.0], [100.0; 2], 0.0)];
    for i in 0..40 {
        let at = f64::from(i) - 20.0;
        // Planes of fins cut the wall.
        let fin = [
            [at, -20.0, -0.5],
            [at + 0.3, 20.0, -0.5],
            [at + 0.2, 20.0, 0.9],
            [at - 0.1, -20.0, 0.9],
        ];
        polygons.push(fin.map(DVec3::from).to_vec());
    }
    let visible = polygons.len();
    for i in 0..200 {
        let (x, y) = (f64::from(i % 20) - 10.0, f64::from(i / 20) - 5.0);
        polygons.push(sized([x, y], [0.7, 0.7], -1.0 - f64::from(i)));
    }
    let tree = BspTree::build(&polygons).unwrap();
    assert!(tree.len() > polygons.len(), "the wall is cut");
    let eye = DVec3::new(0.3, 0.2, 30.0);
    let camera = Camera::perspective(eye, DVec3::ZERO, DVec3::Y, 0.9, [120, 90]).unwrap();
    assert!(shown(&tree, &camera).iter().all(|&polygon| polygon < visible));
}
