//! Layers that cross, painted by an antialiasing painter ([tiny-skia](https://docs.rs/tiny-skia)) without seams: a ring of
//! opaque cards, each with a ribbon that its card cuts off (CSS `overflow: hidden`).
//!
//! ```sh
//! cargo run --release --example smooth_layers -- page.png
//! ```
//!
//! Filled with antialiasing, two pieces of a card blend with the background where they meet, and the cut shows. So each
//! piece is filled without, and then only the edges of its layer are stroked with antialiasing.

#![allow(clippy::print_stdout, reason = "a program")]

use binspace::glam::{DMat4, DVec2, dvec3};
use binspace::layers::{Layer, LayerPiece, Layers, about, perspective};
use std::error::Error;
use std::f64::consts::TAU;
use tiny_skia::{Color, FillRule, LineJoin, Paint, PathBuilder, Pixmap, Stroke, Transform};

const SCREEN: [u32; 2] = [960, 540];
const BACKGROUND: [u8; 3] = [18, 20, 28];
const CARDS: usize = 8;
const RIBBON: [f64; 2] = [200.0, 34.0];

/// The size of a card. Every second one is lower: where its plane cuts the higher ones, the cut is longer than it.
fn card_size(k: usize) -> [f64; 2] {
    [300.0, [260.0, 150.0][k % 2]]
}

/// Each card followed by its ribbon, with their colours.
fn page() -> Vec<(Layer, [u8; 3])> {
    // CSS: `perspective: 900px` on the body, then `translate3d(480px, 245px, -90px) rotateX(-20deg)`.
    let ring = perspective(900.0, SCREEN.map(|side| f64::from(side) / 2.0))
        * DMat4::from_translation(dvec3(480.0, 245.0, -90.0))
        * DMat4::from_rotation_x(-20f64.to_radians());
    let mut layers = Vec::new();
    for k in 0..CARDS {
        let angle = TAU * (k as f64 + 0.12) / CARDS as f64;
        let [width, height] = card_size(k);
        let place = ring
            * DMat4::from_rotation_y(angle)
            * DMat4::from_translation(dvec3(-width / 2.0, -height / 2.0, 260.0));
        // Across the card's upper right corner: `left: 160px; top: 20px; transform: rotate(45deg)`.
        let turned = about(RIBBON.map(|side| side / 2.0), DMat4::from_rotation_z(TAU / 8.0));
        let across = place * DMat4::from_translation(dvec3(160.0, 20.0, 0.0)) * turned;
        let card = Layer::rect([width, height], place);
        let ribbon = Layer::rect(RIBBON, across).clipped_by(&card);
        let hue = TAU * k as f64 / CARDS as f64;
        let light = 150.0 + 60.0 * angle.cos();
        let colour = [0.0, 2.1, 4.2].map(|shift: f64| (light + 45.0 * (hue + shift).cos()) as u8);
        layers.extend([(card, colour), (ribbon, [200, 60, 60])]);
    }
    layers
}

/// Fills a piece without antialiasing, and strokes the edges of its layer with it.
fn paint_piece(pixmap: &mut Pixmap, piece: LayerPiece<'_>, [red, green, blue]: [u8; 3]) {
    let corners: Vec<DVec2> = piece.vertices().map(|v| v.position.truncate()).collect();
    let edges: Vec<Option<u8>> = piece.edges().collect();
    let at = |k: usize| corners[k % corners.len()].as_vec2();
    let mut paint = Paint { anti_alias: false, ..Paint::default() };
    paint.set_color_rgba8(red, green, blue, 255);

    let mut outline = PathBuilder::new();
    outline.move_to(at(0).x, at(0).y);
    (1..corners.len()).for_each(|k| outline.line_to(at(k).x, at(k).y));
    outline.close();
    if let Some(path) = outline.finish() {
        pixmap.fill_path(&path, &paint, FillRule::Winding, Transform::identity(), None);
    }

    // One path for each run of edges between cuts, so that corners are joined.
    let first_cut = edges.iter().position(Option::is_none);
    let mut lines = PathBuilder::new();
    let mut is_drawing = false;
    for k in (0..edges.len()).map(|k| first_cut.unwrap_or(0) + k) {
        let is_edge = edges[k % edges.len()].is_some();
        if is_edge && !is_drawing {
            lines.move_to(at(k).x, at(k).y);
        }
        if is_edge {
            lines.line_to(at(k + 1).x, at(k + 1).y);
        }
        is_drawing = is_edge;
    }
    if first_cut.is_none() {
        lines.close();
    }
    if let Some(path) = lines.finish() {
        paint.anti_alias = true;
        // Mitred corners would stick out by more than half a pixel.
        let stroke = Stroke { width: 1.0, line_join: LineJoin::Round, ..Stroke::default() };
        pixmap.stroke_path(&path, &paint, &stroke, Transform::identity(), None);
    }
}

fn paint(layers: &[(Layer, [u8; 3])]) -> Result<(Layers, Pixmap), Box<dyn Error>> {
    let mut page = Layers::new([[0.0, 0.0], SCREEN.map(f64::from)]);
    let list: Vec<Layer> = layers.iter().map(|(layer, _)| layer.clone()).collect();
    page.update(&list)?;
    let mut pixmap = Pixmap::new(SCREEN[0], SCREEN[1]).ok_or("no pixels")?;
    let [red, green, blue] = BACKGROUND;
    pixmap.fill(Color::from_rgba8(red, green, blue, 255));
    for piece in page.back_to_front() {
        paint_piece(&mut pixmap, piece, layers[piece.layer()].1);
    }
    Ok((page, pixmap))
}

fn main() -> Result<(), Box<dyn Error>> {
    let layers = page();
    let (page, pixmap) = paint(&layers)?;
    println!("{} layers, {} seen, in {} pieces", layers.len(), page.visible(), page.len());
    if let Some(path) = std::env::args().nth(1) {
        pixmap.save_png(path)?;
    }
    Ok(())
}

/// Compares all pixels on cuts with the colours of their layers, away from the borders of what is visible; returns how
/// many. The cuts are those of the layer itself, where pieces of it meet.
#[cfg(test)]
fn compared(layers: &[(Layer, [u8; 3])]) -> usize {
    let (page, pixmap) = paint(layers).unwrap();
    // Cuts, as segments of their layers, and all corners: a thin one is missed by the points that are looked at.
    let mut cuts: Vec<(usize, [DVec2; 2])> = Vec::new();
    let mut all_corners: Vec<DVec2> = Vec::new();
    for piece in page.back_to_front() {
        let corners: Vec<DVec2> = piece.vertices().map(|v| v.position.truncate()).collect();
        for (k, edge) in piece.edges().enumerate() {
            match edge {
                None => cuts.push((piece.layer(), [corners[k], corners[(k + 1) % corners.len()]])),
                Some(_) => all_corners.push(corners[k]),
            }
        }
    }
    let is_on = |[a, b]: [DVec2; 2], at: DVec2| {
        let share = ((at - a).dot(b - a) / (b - a).length_squared()).clamp(0.0, 1.0);
        at.distance(a.lerp(b, share)) < 0.7
    };
    let mut compared = 0;
    for (x, y) in (2..SCREEN[0] - 2).flat_map(|x| (2..SCREEN[1] - 2).map(move |y| (x, y))) {
        let middle = DVec2::new(f64::from(x), f64::from(y)) + 0.5;
        let near: Vec<usize> =
            cuts.iter().filter(|(_, cut)| is_on(*cut, middle)).map(|&(layer, _)| layer).collect();
        if near.is_empty() || all_corners.iter().any(|corner| corner.distance(middle) < 5.0) {
            continue;
        }
        let at = |dx: f64, dy: f64| page.hit([middle.x + dx, middle.y + dy]).map(|hit| hit.0);
        let Some(layer) = at(0.0, 0.0).filter(|layer| near.contains(layer)) else { continue };
        let around = [-1.5, 0.0, 1.5];
        if around.iter().all(|&dx| around.iter().all(|&dy| at(dx, dy) == Some(layer))) {
            let colour = pixmap.pixel(x, y).map(|pixel| [pixel.red(), pixel.green(), pixel.blue()]);
            assert_eq!(colour, Some(layers[layer].1), "({x}, {y})");
            compared += 1;
        }
    }
    compared
}

#[test]
fn no_seam_shows_where_pieces_of_a_layer_meet() {
    let ring = compared(&page());
    assert!(ring > 150, "{ring}");
    // Small cards that cut a large one, and each other, in all directions: many pieces meet in one point.
    let crossing = (0..16).map(|k| {
        let angle = 2.4 * f64::from(k);
        let shift = dvec3(480.0 + 160.0 * angle.cos(), 270.0 + 90.0 * angle.sin(), -30.0);
        let turn = DMat4::from_rotation_z(angle) * DMat4::from_rotation_y(0.5 + 0.1 * angle);
        let size = if k == 0 { [700.0, 420.0] } else { [160.0, 90.0] };
        let place = match k {
            0 => DMat4::from_translation(dvec3(130.0, 60.0, -30.0)),
            _ => DMat4::from_translation(shift) * turn,
        };
        let colour = [40 + 13 * k as u8, 230 - 11 * k as u8, 120];
        (Layer::rect(size, perspective(900.0, [480.0, 270.0]) * place), colour)
    });
    let crossing = compared(&crossing.collect::<Vec<_>>());
    assert!(crossing > 2000, "{crossing}");
}
