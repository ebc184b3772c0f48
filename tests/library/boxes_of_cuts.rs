//! Boxes of fragments whose cut vertices are rounded.

use binspace::{BuildOptions, Heuristic};

/// A triangle with an edge that leans by 2⁻⁵⁰ over its height of 1, cut by a floor at 2⁻¹² of it: the cut is
/// at x = ½ + 2⁻⁶², which an `f64` cannot hold.
#[test]
fn a_box_has_room_for_the_rounding_of_a_cut() {
    let foot = 2f64.powi(-12);
    let floor = [[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [1.0, 1.0, 0.0], [-1.0, 1.0, 0.0]];
    let triangle = [[0.5, 0.0, -foot], [0.5 + 2f64.powi(-50), 0.0, 1.0 - foot], [-0.5, 0.25, -0.5]];
    let options = BuildOptions::DEFAULT.with_heuristic(Heuristic::First).with_tolerance(0.0);
    let tree = options.build([floor.to_vec(), triangle.to_vec()]).unwrap();
    let bounds = tree.bounds().unwrap();
    let mut lower =
        tree.fragments().filter(|f| f.polygon() == 1 && f.vertices().all(|p| p.z < 0.5));
    let fragment = lower.next().expect("the part below the floor");
    assert_eq!(fragment.vertices().map(|p| p.x).fold(-1.0, f64::max), 0.5);
    let [_, high] = bounds.of_fragment(fragment.index());
    assert!(high.x > 0.5, "{high} leaves out the cut");
    let root = tree.root().expect("the floor's node");
    assert!(bounds.of(root)[1].x > 0.5 && bounds.all().unwrap()[1].x > 0.5);
}
