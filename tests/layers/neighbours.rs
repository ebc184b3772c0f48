//! Layers side by side.

use super::{VIEWPORT, page_on, wild};
use binspace::layers::Layer;
use testkit::prelude::*;

/// The edge runs up in one layer and down in the other.
#[test]
fn two_layers_are_clipped_at_the_same_point_of_an_edge_that_they_share() {
    let mut dice = Dice(91);
    let mut shared = 0;
    for round in 0..600 {
        let given = wild(&mut dice);
        let [[left, low], [right, high]] = given.rect;
        let middle = left + (right - left) * (0.2 + 0.6 * dice.share());
        // The right edge of the first layer is edge 1. The left edge of the second layer is edge 3.
        let layers = [
            Layer::new([[left, low], [middle, high]], given.matrix),
            Layer::new([[middle, low], [right, high]], given.matrix),
        ];
        let page = page_on(VIEWPORT, true, layers.iter().cloned());
        let on_edge = |layer: usize| -> Vec<(f64, DVec3)> {
            let piece = page.back_to_front().find(|piece| piece.layer() == layer);
            let vertices = piece.into_iter().flat_map(|piece| piece.vertices());
            let on_edge = vertices.filter(|v| v.local.x == middle);
            let mut found: Vec<_> = on_edge.map(|v| (v.local.y, v.position)).collect();
            found.sort_by(|a, b| a.0.total_cmp(&b.0));
            found
        };
        let [one, other] = [on_edge(0), on_edge(1)];
        if one.len() == 2 && other.len() == 2 {
            assert_eq!(one, other, "{round}");
            shared += one.iter().filter(|&&(v, _)| v != low && v != high).count();
        }
    }
    assert!(shared > 100, "{shared}");
}
