//! Layers that cross, painted by an antialiasing painter ([tiny-skia](https://docs.rs/tiny-skia)) without seams: a ring of
//! opaque cards, each with a ribbon that its card cuts off (CSS `overflow: hidden`).
//!
//! ```sh
//! cargo run --release --example smooth_layers -- page.png
//! ```
//!
//! With antialiased fills, two pieces of a card blend with the background where they meet, and a seam is
//! visible. So each piece is filled without antialiasing, with the corners of its neighbours on its own cuts: the
//! painter rounds an edge by its ends. Then only the edges of its layer are stroked with antialiasing.

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

/// The size of a card. Every second card is lower. Where its plane cuts a higher neighbour, the cut is longer
/// than the low card is high.
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

fn corners(piece: LayerPiece<'_>) -> Vec<DVec2> {
    piece.vertices().map(|vertex| vertex.position.truncate()).collect()
}

/// Those of some points that lie between the ends of an edge, from its begin to its end.
fn between(points: &[DVec2], [begin, end]: [DVec2; 2]) -> Vec<DVec2> {
    let along = end - begin;
    let place = |at: &DVec2| (*at - begin).dot(along) / along.length_squared();
    let is_on = |at: &&DVec2| {
        (0.0..1.0).contains(&place(at)) && at.distance(begin.lerp(end, place(at))) < 1e-6
    };
    let mut found: Vec<DVec2> = points.iter().filter(is_on).copied().collect();
    found.sort_by(|a, b| place(a).total_cmp(&place(b)));
    found
}

/// Fills a piece without antialiasing, and strokes the edges of its layer with it. `others` are the corners of all
/// pieces of the layer.
fn paint_piece(
    pixmap: &mut Pixmap,
    piece: LayerPiece<'_>,
    others: &[DVec2],
    [red, green, blue]: [u8; 3],
) {
    let corners = corners(piece);
    let edges: Vec<Option<u8>> = piece.edges().collect();
    let at = |k: usize| corners[k % corners.len()].as_vec2();
    let mut paint = Paint { anti_alias: false, ..Paint::default() };
    paint.set_color_rgba8(red, green, blue, 255);

    let mut outline = PathBuilder::new();
    outline.move_to(at(0).x, at(0).y);
    for (k, edge) in edges.iter().enumerate() {
        let [begin, end] = [corners[k], corners[(k + 1) % corners.len()]];
        if edge.is_none() {
            for at in between(others, [begin, end]) {
                outline.line_to(at.x as f32, at.y as f32);
            }
        }
        outline.line_to(end.x as f32, end.y as f32);
    }
    outline.close();
    if let Some(path) = outline.finish() {
        pixmap.fill_path(&path, &paint, FillRule::Winding, Transform::identity(), None);
    }

    // Each run of edges between cuts is one path, so that corners are joined.
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
    let mut of_layers = vec![vec![]; layers.len()];
    for piece in page.back_to_front() {
        of_layers[piece.layer()].extend(corners(piece));
    }
    for piece in page.back_to_front() {
        paint_piece(&mut pixmap, piece, &of_layers[piece.layer()], layers[piece.layer()].1);
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

/// Compares the colour of each pixel at which two pieces of one layer meet with the colour of that layer.
/// Pixels near strokes and near borders of visible parts are skipped. Returns the number of compared pixels.
#[cfg(test)]
fn compared(layers: &[(Layer, [u8; 3])]) -> usize {
    use std::collections::BTreeSet;

    let (page, pixmap) = paint(layers).unwrap();
    let mut cuts: Vec<(usize, [DVec2; 2])> = Vec::new();
    let mut strokes: Vec<[DVec2; 2]> = Vec::new();
    for piece in page.back_to_front() {
        let corners = corners(piece);
        for (k, edge) in piece.edges().enumerate() {
            let ends = [corners[k], corners[(k + 1) % corners.len()]];
            match edge {
                None => cuts.push((piece.layer(), ends)),
                Some(_) => strokes.push(ends),
            }
        }
    }
    let is_near = |[a, b]: [DVec2; 2], at: DVec2, most: f64| {
        let share = ((at - a).dot(b - a) / (b - a).length_squared()).clamp(0.0, 1.0);
        at.distance(a.lerp(b, share)) < most
    };
    let mut compared = 0;
    let steps = |[a, b]: [DVec2; 2]| {
        let count = (2.0 * a.distance(b)).ceil() as u32;
        (0..=count).map(move |k| a.lerp(b, f64::from(k) / f64::from(count.max(1))))
    };
    let pixels: BTreeSet<[u32; 2]> = cuts
        .iter()
        .flat_map(|&(_, cut)| steps(cut))
        .map(|at| at.to_array().map(|c| c as u32))
        .filter(|at| (0..2).all(|axis| at[axis] > 1 && at[axis] < SCREEN[axis] - 2))
        .collect();
    for [x, y] in pixels {
        let middle = DVec2::new(f64::from(x), f64::from(y)) + 0.5;
        let cut_here = cuts.iter().filter(|(_, cut)| is_near(*cut, middle, 0.7));
        let near: Vec<usize> = cut_here.map(|&(layer, _)| layer).collect();
        if near.is_empty() || strokes.iter().any(|&stroke| is_near(stroke, middle, 1.8)) {
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
    assert!(ring > 100, "{ring}");
    // Cards of different sizes that cut each other in all directions.
    let crossing = (0..14).map(|k| {
        let angle = 2.4 * f64::from(k);
        let shift = dvec3(480.0 + 60.0 * angle.cos(), 270.0 + 60.0 * angle.sin(), -200.0);
        let turn = DMat4::from_rotation_z(angle) * DMat4::from_rotation_y(1.9 * angle);
        let size = [600.0 - 35.0 * f64::from(k), 240.0];
        let middle = DMat4::from_translation(dvec3(-size[0] / 2.0, -size[1] / 2.0, 0.0));
        let place = DMat4::from_translation(shift) * turn * middle;
        let colour = [40 + 15 * k as u8, 230 - 13 * k as u8, 120];
        (Layer::rect(size, perspective(900.0, [480.0, 270.0]) * place), colour)
    });
    let crossing = compared(&crossing.collect::<Vec<_>>());
    assert!(crossing > 500, "{crossing}");
}
