//! Compares pages of layers with exact rationals of the rectangles and matrices: the visible part of a layer,
//! the point of a layer that appears at a point of the screen, and the painting order.

mod clips;
mod drawn;
mod hit;
mod hostile;
mod nearly_one_plane;
mod neighbours;
mod one_plane;
mod oracle;
mod order;
mod outline;
mod planes;
mod short_edges;

use binspace::glam::DMat4;
use binspace::layers::{Layer, LayerPiece, Layers};
use oracle::Truth;
use testkit::pages::{Page, PageLayer, SCREEN, camera};
use testkit::prelude::*;

type Rect = [[f64; 2]; 2];

const VIEWPORT: Rect = [[0.0; 2], SCREEN];

/// A layer as given, for both the library and its judge.
#[derive(Clone, Copy, Debug)]
struct Given {
    rect: Rect,
    matrix: DMat4,
}

impl From<PageLayer> for Given {
    fn from(layer: PageLayer) -> Self {
        Self { rect: [layer.half.map(|side| -side), layer.half], matrix: layer.matrix }
    }
}

impl Given {
    fn layer(&self) -> Layer {
        Layer::new(self.rect, self.matrix)
    }

    fn truth(&self) -> Truth {
        Truth::new(self.rect, self.matrix)
    }
}

/// The layers of a page's pieces, back to front.
fn order(page: &Layers) -> Vec<usize> {
    page.back_to_front().map(|piece| piece.layer()).collect()
}

/// The layers of a page's pieces, back to front, with the pieces' outlines on the screen.
fn outlines(page: &Layers) -> Vec<(usize, Vec<DVec2>)> {
    let outline = |piece: LayerPiece<'_>| piece.vertices().map(|v| v.position.truncate()).collect();
    page.back_to_front().map(|piece| (piece.layer(), outline(piece))).collect()
}

/// The layers of a page, in their given order.
fn layers_of(page: Page, count: usize, seed: u64) -> Vec<Given> {
    page.layers(count, seed).into_iter().map(Given::from).collect()
}

/// A page of a part of the screen.
fn page_on(viewport: Rect, is_clipped: bool, layers: impl IntoIterator<Item = Layer>) -> Layers {
    let page = Layers::new(viewport);
    let mut page = if is_clipped { page } else { page.unclipped() };
    page.update(&layers.into_iter().collect::<Vec<_>>()).unwrap();
    page
}

fn page_of(layers: &[Given]) -> Layers {
    page_on(VIEWPORT, true, layers.iter().map(Given::layer))
}

/// Rectangles of all sizes in any orientation, many partly behind the eye or beside the screen.
fn wild(dice: &mut Dice) -> Given {
    let mut between = |low: f64, high: f64| low + (high - low) * dice.share();
    let low = [between(-900.0, 300.0), between(-900.0, 300.0)];
    let high = low.map(|low| low + between(10.0, 1500.0));
    let at = dvec3(between(-900.0, 900.0), between(-600.0, 600.0), between(-1500.0, 1800.0));
    let turn = DMat4::from_rotation_z(between(0.0, 6.3))
        * DMat4::from_rotation_y(between(0.0, 6.3))
        * DMat4::from_rotation_x(between(0.0, 6.3));
    Given { rect: [low, high], matrix: camera() * DMat4::from_translation(at) * turn }
}

#[test]
fn an_unchanged_frame_takes_no_work() {
    let given = layers_of(Page::Carousel, 12, 3);
    let layers: Vec<Layer> = given.iter().map(Given::layer).collect();
    let mut page = Layers::new(VIEWPORT);
    assert!(page.is_empty() && page.visible() == 0);
    assert!(page.update(&layers).unwrap());
    let first = order(&page);
    assert!(!page.update(&layers).unwrap());
    assert_eq!(order(&page), first);
    // Any different number is a change. So is an added or a removed layer, and another order.
    let mut moved = layers.clone();
    let mut matrix = given[7].matrix;
    matrix.w_axis.x += 1e-9;
    moved[7] = Layer::new([[-1.0; 2], [1.0; 2]], matrix);
    for changed in [&moved[..], &layers[..11], &layers, &[], &layers] {
        assert!(page.update(changed).unwrap());
        assert!(!page.update(changed).unwrap());
        assert_eq!(page.visible(), changed.len());
    }
    // Another clipping makes another page.
    let mut unclipped = page.unclipped();
    assert!(unclipped.is_empty() && unclipped.back_to_front().next().is_none());
    assert!(unclipped.update(&layers).unwrap() && !unclipped.update(&layers).unwrap());
    // An empty page is a page.
    let mut none = Layers::new(VIEWPORT);
    assert!(none.update(&[]).unwrap() && !none.update(&[]).unwrap());
    assert!(none.is_empty() && none.hit([5.0, 5.0]).is_none());
}
