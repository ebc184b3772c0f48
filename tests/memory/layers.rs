//! A frame whose layers did not change allocates nothing, and reading it allocates nothing.

use super::{allocations, counted, least_allocations};
use binspace::layers::{Layer, Layers};
use testkit::pages::{Page, SCREEN};
use testkit::prelude::*;

/// Reads a whole page, so that no part is skipped.
fn read(page: &Layers) -> usize {
    let pieces = page.back_to_front().map(|piece| {
        let own = piece.edges().flatten().count();
        own + piece.vertices().filter(|vertex| vertex.w > 0.0).count()
    });
    pieces.sum()
}

#[test]
fn an_unchanged_frame_allocates_nothing() {
    counted(look_at_unchanged_frames);
}

fn look_at_unchanged_frames() {
    for kind in Page::ALL {
        let layers: Vec<Layer> = kind
            .layers(30, 1)
            .iter()
            .map(|layer| Layer::new([layer.half.map(|side| -side), layer.half], layer.matrix))
            .collect();
        let mut page = Layers::new([[0.0; 2], SCREEN]);
        // The counter works: the first frame has to allocate.
        assert!(allocations(|| assert!(page.update(&layers).unwrap())) > 10, "{kind:?}");
        let mut corners = 0;
        let unchanged = least_allocations(|| {
            assert!(!page.update(&layers).unwrap());
            corners = read(&page);
            assert!(page.hit([960.0, 540.0]).is_some() || kind != Page::Crossing);
        });
        assert_eq!(unchanged, 0, "{kind:?}");
        enough!(corners > 100; "{corners}");
    }
}
