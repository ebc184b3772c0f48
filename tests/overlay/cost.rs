//! Moving polygons are cut only where necessary.

use binspace::overlay::Overlay;
use testkit::prelude::*;

/// Small polygons in free air stay whole. A polygon across the whole scene is cut by a few planes of the
/// scene, not by all.
#[test]
fn pieces_are_few() {
    let scene = scene::terrain(40, 3);
    let tree = BspTree::build(scene.polygons()).expect("within budget");
    let (low, high) = scene.bounds().expect("corners");
    let at = |x: f64, y: f64| low + (high - low) * dvec3(x, y, 1.0);
    let size = (high - low).max_element() * 1e-4;
    let small = (0..100).map(|k| {
        let at = at(0.005 + 0.0099 * f64::from(k), 0.4999);
        vec![at, at + DVec3::X * size, at + DVec3::Y * size]
    });
    let mut overlay = Overlay::new(&tree);
    overlay.replace(&tree, small).expect("on the grid");
    assert!((100..150).contains(&overlay.len()), "{}", overlay.len());
    let wide = [at(0.0, 0.0), at(1.0, 0.0), at(1.0, 1.0), at(0.0, 1.0)];
    overlay.replace(&tree, [wide]).expect("on the grid");
    assert!(
        (1..3 * tree.len() / 2).contains(&overlay.len()),
        "{} of {}",
        overlay.len(),
        tree.len()
    );
}
