//! Almost straight lines. The plane through two segments is the plane of a sliver, and its tolerance must be
//! a length too.

use binspace::overlay::{Overlay, Shape, Shapes};
use testkit::prelude::*;

#[test]
fn a_nearly_straight_line_does_not_make_lines_coplanar() {
    let bent = [
        dvec3(-1.0, -1.0, 0.0),
        dvec3(0.719_638_576_572_251_9, 0.75, 0.0),
        dvec3(0.931_029_674_363_226_3, 0.965_123_355_671_395_6, 0.0),
    ];
    let [upper, lower] = [dvec3(0.5, 0.25, 0.125), dvec3(0.25, 0.5, -0.125)];
    // Seen from above and from below, the two lines cross.
    let ends = |to: DVec3| vec![dvec3(-to.x, -to.y, to.z), to];
    let lines = [bent.to_vec(), ends(upper), ends(lower)];
    let options = BuildOptions::DEFAULT.with_bounds(DVec3::NEG_ONE, DVec3::ONE);
    let tree = options.build(Vec::<[DVec3; 3]>::new()).expect("a tree of nothing");
    let mut overlay = Overlay::new(&tree);
    overlay.replace_with(&tree, Shapes::NONE.with_lines(lines)).expect("on the grid");
    for (z, expected) in [(5.0, [2, 1]), (-5.0, [1, 2])] {
        let viewpoint = Viewpoint::eye([0.0, 0.0, z]);
        let order = overlay.order(&tree, viewpoint).expect("its own tree");
        let line = |shape: Shape<'_>| match shape {
            Shape::Segment(segment) => segment.line(),
            _ => unreachable!("there are lines only"),
        };
        let mut painted: Vec<usize> =
            order.into_iter().map(line).filter(|&line| line > 0).collect();
        painted.dedup();
        assert_eq!(painted, expected, "from {z}");
    }
}
