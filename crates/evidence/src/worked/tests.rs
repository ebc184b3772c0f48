//! The examples against hand computation, and against other methods.

use binspace::raster::{NONE, zbuffer};
use binspace::verify::verify;
use testkit::prelude::*;

use super::{
    EIGHT, EIGHT_ORDER, EYE_OF_EIGHT, GRID_OF_SIX, eight, eye_on_eight, letters, six_by_six,
    six_by_six_camera,
};
use crate::Hiding;
use crate::method::{Centroid, DepthBuffer, DepthFormat, InputOrder, Method, Newell};

/// The side of the line of a wall on which a point of the floor lies.
fn side(wall: char, [x, y]: [f64; 2]) -> f64 {
    let (_, [[a, b], [c, d]]) = EIGHT.into_iter().find(|&(letter, _)| letter == wall).unwrap();
    ((c - a) * (y - b) - (d - b) * (x - a)).signum()
}

#[test]
fn the_walls_stand_as_the_tree_says() {
    let ends = |wall: char| EIGHT.into_iter().find(|&(letter, _)| letter == wall).unwrap().1;
    // The walls on the eye's side of a line, and the walls on the other.
    let check = |line: char, near: &str, far: &str| {
        let eye = side(line, EYE_OF_EIGHT);
        assert_ne!(eye, 0.0);
        for (walls, expected) in [(near, eye), (far, -eye)] {
            for end in walls.chars().flat_map(ends) {
                assert_eq!(side(line, end), expected, "{line} {walls}");
            }
        }
    };
    check('A', "BDEH", "CFG");
    check('C', "G", "F");
    check('B', "EH", "");
    check('D', "EH", "");
    check('E', "H", "");
    let [left, right] = ends('D');
    assert_eq!(side('B', right), side('B', EYE_OF_EIGHT));
    assert_eq!(side('B', left), -side('B', right), "B's line cuts D");
    // The eye is in front of the line of D's right piece, and so are E and H.
    assert_eq!(side('D', EYE_OF_EIGHT), side('D', ends('H')[0]));
}

#[test]
fn eight_walls_are_painted_in_the_order_worked_by_hand() {
    let options = BuildOptions::DEFAULT.with_heuristic(Heuristic::First).with_tolerance(0.0);
    let tree = options.build(eight().map(|(_, wall)| wall)).unwrap();
    let camera = eye_on_eight([320, 240]).unwrap();
    let order: Vec<u32> = tree.back_to_front(camera.viewpoint()).map(|f| f.index()).collect();
    assert_eq!(letters(&tree, &order), EIGHT_ORDER);
    assert_eq!(tree.root().and_then(|root| root.polygon()), Some(0));
    assert_eq!((tree.len(), tree.face_count()), (9, 8));
    let seen = verify(&tree, &camera).unwrap();
    assert_eq!(seen.comparison.wrong(), 0);
    assert!(seen.comparison.covered > 1000);
}

/// Each piece is painted after all pieces that it hides parts of, by big integers.
#[test]
fn no_piece_of_the_eight_walls_hides_a_later_one() {
    let options = BuildOptions::DEFAULT.with_heuristic(Heuristic::First).with_tolerance(0.0);
    let tree = options.build(eight().map(|(_, wall)| wall)).unwrap();
    let viewpoint = eye_on_eight([320, 240]).unwrap().viewpoint();
    let order: Vec<u32> = tree.back_to_front(viewpoint).map(|f| f.index()).collect();
    let pieces: Vec<Vec<_>> =
        order.iter().map(|&f| tree.fragment(f).vertices().collect()).collect();
    let (faces, _) = Faces::new(&pieces, Some(0.0)).unwrap();
    let hiding = Hiding::of(&faces, viewpoint);
    for a in 0..9 {
        assert!((a + 1..9).all(|b| !hiding.hides(a, b)), "{a}");
    }
    assert!(hiding.pairs() > 3, "{hiding:?}");
}

#[test]
fn a_grid_of_six_by_six_matches_hand_computation() {
    let both = six_by_six();
    let camera = six_by_six_camera().unwrap();
    let (faces, _) = Faces::new(both, Some(0.0)).unwrap();
    let rays = Rays::new(&camera, &faces).unwrap();
    let truth = zbuffer(&rays, &faces);
    // Depths are measured from the middle of the scene.
    let middle = 0.5 * (1.0 + 12.0);
    let cells = |depths: Vec<f64>, row: usize| {
        let text = |d: &f64| if d.is_finite() { (d + middle).to_string() } else { "·".to_owned() };
        depths[6 * row..][..6].iter().map(text).collect::<Vec<_>>().join(" ")
    };
    for (row, [second, shown, names]) in GRID_OF_SIX.into_iter().enumerate() {
        // Half of a scene has its own grid, and its depths refer to this grid.
        assert_eq!(cells(truth.depths().collect(), row), shown);
        let own: Vec<&str> = second.split(' ').collect();
        for (column, cell) in own.into_iter().enumerate() {
            let (x, y) = (column as f64 + 0.5, 5.5 - row as f64);
            let is_inside = y > x + 0.25;
            let expected = if is_inside { (2.0 * x + 1.0).to_string() } else { "·".to_owned() };
            assert_eq!(cell, expected);
        }
        let letter = |&face: &u32| if face == NONE { "·" } else { ["A", "B"][face as usize] };
        let faces = &truth.image().faces()[6 * row..][..6];
        assert_eq!(faces.iter().map(letter).collect::<Vec<_>>().join(" "), names);
    }
    let picture = |method: &dyn Method| {
        method.prepare(&faces).unwrap().paint(&camera, &rays).unwrap().image.faces().to_vec()
    };
    let right = truth.image().faces().to_vec();
    assert_eq!(picture(&Newell::DEFAULT), right);
    assert_eq!(picture(&DepthBuffer::new(DepthFormat::Integer(16))), right);
    // B is nearer only at the left, so no order of whole triangles is right.
    assert_ne!(picture(&InputOrder), right);
    assert_ne!(picture(&Centroid), right);
    let tree = BspTree::build(both).unwrap();
    assert_eq!(verify(&tree, &camera).unwrap().comparison.wrong(), 0);
    assert_eq!(Hiding::of(&faces, camera.viewpoint()).mutual(), 1);
}
