//! The use of clipping to the viewport: pages with a floor that reaches behind the eye. Without clipping,
//! coordinates after the division have no bound, so the scene's extent and its default tolerance have none.

use crate::frames::{Painted, judge};
use binspace::glam::{DMat4, DVec3, dvec3};
use binspace::layers::{Layer, Layers};
use binspace::{BspTree, Viewpoint};
use std::f64::consts::FRAC_PI_2;
use std::time::{Duration, Instant};
use support::{SEED, Table, best_of, time};
use testkit::pages::{Page, PageLayer, SCREEN, camera};

const COUNT: usize = 30;
/// The least number of judged points of the screen, at which layers lie over each other. With fewer points, a
/// table would show nothing.
const LEAST_JUDGED: usize = 10;
/// Without clipping, a layer is cut off where w is below this. Where w is 1, a pixel of the layer is a pixel
/// of the screen.
const NEAR: [f64; 3] = [1e-2, 1e-6, 1e-9];

pub(crate) fn run() {
    let table =
        Table::new("Floor behind the eye", &["page", "way", "pieces", "frame", "judged", "wrong"]);
    for page in Page::ALL {
        let mut layers = page.layers(COUNT, SEED);
        let floor = DMat4::from_translation(dvec3(0.0, 420.0, 0.0))
            * DMat4::from_rotation_x(FRAC_PI_2 + 0.02);
        layers.push(PageLayer { half: [4000.0, 4000.0], matrix: camera() * floor });
        let name = format!("{}:{COUNT}", page.name());
        let row = |way: String, is_ours: bool, (frame, pieces): (Duration, Vec<Painted>)| {
            let (judged, wrong) = judge(|at| depths(&layers, at), &pieces);
            assert!(judged >= LEAST_JUDGED, "{name}: {judged} points");
            assert!(!is_ours || wrong == 0, "{name}, {way}: {wrong} of {judged} points are wrong");
            let [pieces, judged, wrong] = [pieces.len(), judged, wrong].map(|n| n.to_string());
            table.row(&[name.clone(), way, pieces, time(frame), judged, wrong]);
        };
        let viewport = [[0.0; 2], SCREEN];
        row("clipped".to_owned(), true, by_layers(&layers, Layers::new(viewport)));
        row("unclipped".to_owned(), true, by_layers(&layers, Layers::new(viewport).unclipped()));
        for near in NEAR {
            row(format!("w ≥ {near:e}, no more"), false, by_tree(&layers, near));
        }
    }
}

fn by_layers(layers: &[PageLayer], empty: Layers) -> (Duration, Vec<Painted>) {
    let layers: Vec<Layer> = layers
        .iter()
        .map(|layer| Layer::new([layer.half.map(|side| -side), layer.half], layer.matrix))
        .collect();
    let mut page = empty;
    // The page is emptied before each frame, so that no frame counts as unchanged.
    let frame = (0..9).map(|_| {
        page.update(&[]).expect("no layers");
        let begin = Instant::now();
        page.update(&layers).expect("within budget");
        begin.elapsed()
    });
    let frame = frame.min().unwrap_or_default();
    let painted = |piece: binspace::layers::LayerPiece<'_>| Painted {
        layer: piece.layer(),
        corners: piece.vertices().map(|vertex| vertex.position.truncate().to_array()).collect(),
    };
    (frame, page.back_to_front().map(painted).collect())
}

/// Paints like a program that uses only the tree, with the tree's default tolerance.
fn by_tree(layers: &[PageLayer], near: f64) -> (Duration, Vec<Painted>) {
    let (frame, tree) = best_of(3, || {
        BspTree::build(layers.iter().map(|layer| divided(layer, near))).expect("within budget")
    });
    let painted = |fragment: binspace::Fragment<'_>| Painted {
        layer: fragment.polygon(),
        corners: fragment.vertices().map(|vertex| [vertex.x, vertex.y]).collect(),
    };
    let order = tree.back_to_front(Viewpoint::direction([0.0, 0.0, -1.0]));
    (frame, order.map(painted).collect())
}

/// A layer's corners after the division, where w is not below a limit.
fn divided(layer: &PageLayer, near: f64) -> Vec<DVec3> {
    let [x, y] = layer.half;
    let corners = [[-x, -y], [x, -y], [x, y], [-x, y]];
    let corners = corners.map(|[x, y]| layer.matrix * dvec3(x, y, 0.0).extend(1.0));
    let mut kept = Vec::new();
    for (i, &here) in corners.iter().enumerate() {
        let next = corners[(i + 1) % 4];
        if here.w >= near {
            kept.push(here);
        }
        if (here.w >= near) != (next.w >= near) {
            kept.push(here + (next - here) * ((near - here.w) / (next.w - here.w)));
        }
    }
    kept.into_iter().map(|corner| corner.truncate() / corner.w).collect()
}

/// The depth of each layer that covers a point, by Cramer's rule; `None` too near to its edges.
fn depths(layers: &[PageLayer], [x, y]: [f64; 2]) -> Vec<Option<f64>> {
    let depth = |layer: &PageLayer| {
        let row = |k: usize| {
            let [u, v, one] = [0, 1, 3].map(|column: usize| layer.matrix.col(column)[k]);
            dvec3(u, v, one)
        };
        let (a, b) = (row(0) - row(3) * x, row(1) - row(3) * y);
        let determinant = a.x * b.y - a.y * b.x;
        let u = (a.y * b.z - a.z * b.y) / determinant;
        let v = (a.z * b.x - a.x * b.z) / determinant;
        let at = dvec3(u, v, 1.0);
        let is_inside = u.abs() < layer.half[0] - 0.01 && v.abs() < layer.half[1] - 0.01;
        let w = row(3).dot(at);
        (is_inside && w > 0.0).then(|| row(2).dot(at) / w)
    };
    layers.iter().map(depth).collect()
}
