//! A cleared overlay is equal to an overlay that never had contents.

use binspace::Preparation;
use binspace::overlay::{Overlay, Shapes};
use testkit::prelude::*;

#[test]
fn a_cleared_overlay_keeps_no_preparation() {
    let tree = BspTree::build(scene::city(100, 1).polygons()).expect("within budget");
    let square = [[0.0, 0.0, 1.0], [1.0, 0.0, 1.0], [1.0, 1.0, 1.0], [0.0, 1.0, 1.0]];
    let arrow = [[0.0, 0.0, 1.0], [2.0, 1.0, 1.0], [0.0, 2.0, 1.0], [1.0, 1.0, 1.0]];
    let nothing = [[1.0; 3]; 4];
    let mut overlay = Overlay::new(&tree);
    let fresh = format!("{overlay:?}");
    let shapes = Shapes::NONE.with_polygons([square, arrow, nothing]);
    let shapes = shapes.with_lines([square]).with_points(square);
    overlay.replace_with(&tree, shapes).expect("on the grid");
    let found = overlay.preparation();
    assert_eq!((found.polygons, found.dropped, found.triangulated), (3, 1, 1));
    assert!(!overlay.is_empty());
    overlay.clear();
    assert!(overlay.is_empty());
    assert_eq!(*overlay.preparation(), Preparation::default());
    assert_eq!(format!("{overlay:?}"), fresh);
    assert_eq!(overlay.faces().len(), tree.faces().len());
    // The same holds after an error.
    overlay.replace(&tree, [square]).expect("on the grid");
    assert!(overlay.replace(&tree, [square.map(|[x, y, _]| [x, y, f64::NAN])]).is_err());
    assert_eq!(*overlay.preparation(), Preparation::default());
}
