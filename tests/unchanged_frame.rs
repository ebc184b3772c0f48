//! A frame whose layers did not change allocates nothing, nor does reading it. Alone in its program,
//! as it counts what all threads allocate.

#[path = "support/counted.rs"]
mod counted;
#[path = "../benches/support/pages.rs"]
#[allow(dead_code, unreachable_pub, reason = "made for benches too")]
mod pages;

use binspace::layers::{Layer, Layers};
use counted::allocations;
use dhat::Profiler;
use pages::{Page, SCREEN};

/// Reads all of a page, so that nothing of it is left out.
fn read(page: &Layers) -> usize {
    let pieces = page.back_to_front().map(|piece| {
        let own = piece.edges().flatten().count();
        own + piece.vertices().filter(|vertex| vertex.w > 0.0).count()
    });
    pieces.sum()
}

#[test]
fn an_unchanged_frame_allocates_nothing() {
    let _profiler = Profiler::builder().testing().build();
    for kind in Page::ALL {
        let layers: Vec<Layer> = kind
            .layers(30, 1)
            .iter()
            .map(|layer| Layer::new([layer.half.map(|side| -side), layer.half], layer.matrix))
            .collect();
        let mut page = Layers::new([[0.0; 2], SCREEN]);
        // What is counted is counted: the first frame has to make room.
        assert!(allocations(|| assert!(page.update(&layers).unwrap())) > 10, "{kind:?}");
        let mut corners = 0;
        let mut unchanged = || {
            allocations(|| {
                assert!(!page.update(&layers).unwrap());
                corners = read(&page);
                assert!(page.hit([960.0, 540.0]).is_some() || kind != Page::Crossing);
            })
        };
        // Once of several times, as the program that runs the tests may allocate beside them.
        assert_eq!((0..5).map(|_| unchanged()).min(), Some(0), "{kind:?}");
        assert!(corners > 100, "{corners}");
    }
}
