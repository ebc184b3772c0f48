//! Pages of layers against exact rationals that know the rectangles and matrices alone: what is
//! seen of a layer, where in it a point of the screen is, and what is painted over what.

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
use binspace::layers::{Layer, Layers};
use oracle::Truth;
use testkit::pages::{self, PageLayer, SCREEN, camera};
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

fn page_of(layers: &[Given]) -> Layers {
    let mut page = Layers::new(VIEWPORT);
    let layers: Vec<Layer> = layers.iter().map(Given::layer).collect();
    assert!(page.update(&layers).unwrap());
    page
}

/// Rectangles of all sizes turned every way, many partly behind the eye or beside the screen.
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
fn an_unchanged_frame_is_not_worked_on() {
    let layers: Vec<Layer> =
        pages::Page::Carousel.layers(12, 3).into_iter().map(|l| Given::from(l).layer()).collect();
    let mut page = Layers::new(VIEWPORT);
    assert!(page.is_empty() && page.visible() == 0);
    assert!(page.update(&layers).unwrap());
    let first: Vec<_> = page.back_to_front().map(|piece| piece.layer()).collect();
    assert!(!page.update(&layers).unwrap());
    assert_eq!(page.back_to_front().map(|piece| piece.layer()).collect::<Vec<_>>(), first);
    // Any number that differs is a change; so are one layer more or less and another order.
    let mut moved = layers.clone();
    let mut matrix = pages::Page::Carousel.layers(12, 3)[7].matrix;
    matrix.w_axis.x += 1e-9;
    moved[7] = Layer::new([[-1.0; 2], [1.0; 2]], matrix);
    for changed in [&moved[..], &layers[..11], &layers, &[], &layers] {
        assert!(page.update(changed).unwrap());
        assert!(!page.update(changed).unwrap());
        assert_eq!(page.visible(), changed.len());
    }
    // Another clip makes another page.
    let mut unclipped = page.unclipped();
    assert!(unclipped.is_empty() && unclipped.back_to_front().next().is_none());
    assert!(unclipped.update(&layers).unwrap() && !unclipped.update(&layers).unwrap());
    // A page of none is a page.
    let mut none = Layers::new(VIEWPORT);
    assert!(none.update(&[]).unwrap() && !none.update(&[]).unwrap());
    assert!(none.is_empty() && none.hit([5.0, 5.0]).is_none());
}
