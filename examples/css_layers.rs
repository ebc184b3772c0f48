//! A page as a browser composes it: a carousel of glass cards that cross their neighbours, each with a badge
//! in its plane. A plate goes through all cards.
//!
//! ```sh
//! cargo run --release --example css_layers -- docs/css_layers.png
//! ```
//!
//! No whole card can be painted before its neighbour, so cards are split. A badge lies in the plane of its
//! card and comes after the card in the list, so it is painted over the card and not split by it.
//!
//! ![Glass cards that cross, cut and painted back to front](../docs/css_layers.png)

#![allow(clippy::print_stdout, reason = "a program")]

mod canvas;

use binspace::glam::{DMat4, dvec3};
use binspace::layers::{Layer, Layers};
use canvas::{Canvas, Colour};
use std::error::Error;
use std::f64::consts::{FRAC_PI_2, TAU};

const SCREEN: [f64; 2] = [960.0, 540.0];
const CARDS: usize = 7;
const CARD: [[f64; 2]; 2] = [[-150.0, -105.0], [150.0, 105.0]];
const BADGE: [[f64; 2]; 2] = [[60.0, -90.0], [132.0, -62.0]];
const PLATE: [[f64; 2]; 2] = [[-330.0, -330.0], [330.0, 330.0]];

/// CSS: `perspective: 900px`, from the middle of the screen.
fn camera() -> DMat4 {
    let mut perspective = DMat4::IDENTITY;
    perspective.z_axis.w = -1.0 / 900.0;
    DMat4::from_translation(dvec3(SCREEN[0] / 2.0, SCREEN[1] / 2.0, 0.0)) * perspective
}

/// Each card followed by its badge, and the plate at the end.
fn page() -> Vec<Layer> {
    // CSS: `translate3d(0, -25px, -90px) rotateX(-20deg)`, and for each card `rotateY(…) translateZ(240px)`.
    let ring = camera()
        * DMat4::from_translation(dvec3(0.0, -25.0, -90.0))
        * DMat4::from_rotation_x(-0.35);
    let mut layers = Vec::new();
    for k in 0..CARDS {
        let turn = DMat4::from_rotation_y(TAU * (k as f64 + 0.12) / CARDS as f64);
        let place = ring * turn * DMat4::from_translation(dvec3(0.0, 0.0, 240.0));
        layers.extend([Layer::new(CARD, place), Layer::new(BADGE, place)]);
    }
    let lying = DMat4::from_translation(dvec3(0.0, 62.0, 0.0)) * DMat4::from_rotation_x(FRAC_PI_2);
    layers.push(Layer::new(PLATE, ring * lying));
    layers
}

fn paint(layers: &[Layer], page: &Layers) -> Canvas {
    let mut canvas = Canvas::new(SCREEN.map(|side| side as usize), [0.07, 0.08, 0.11]);
    for piece in page.back_to_front() {
        let number = piece.layer();
        let outline: Vec<[f64; 2]> =
            piece.vertices().map(|vertex| vertex.position.truncate().to_array()).collect();
        canvas.fill(&outline, |point| match layers[number].local(point) {
            Some(local) if number == 2 * CARDS => plate(local),
            Some(local) if number % 2 == 1 => badge(local),
            Some(local) => card(number / 2, local),
            None => [0.0; 4],
        });
    }
    canvas
}

/// The distance of a point from the boundary of a rectangle with round corners, positive inside.
fn inside([low, high]: [[f64; 2]; 2], [u, v]: [f64; 2], radius: f64) -> f64 {
    let off = |at: f64, low: f64, high: f64| (at - (low + high) / 2.0).abs() - (high - low) / 2.0;
    let [x, y] = [off(u, low[0], high[0]), off(v, low[1], high[1])].map(|off| off + radius);
    radius - x.max(0.0).hypot(y.max(0.0)) - x.max(y).min(0.0)
}

fn card(number: usize, local: [f64; 2]) -> Colour {
    let hue = TAU * number as f64 / CARDS as f64;
    let [r, g, b] = [0.0, 2.1, 4.2].map(|shift: f64| 0.56 + 0.3 * (hue + shift).cos());
    let [u, v] = local;
    let is_line = (-110.0..[70.0, 105.0, 20.0][number % 3]).contains(&u)
        && (v > -30.0 && v < 40.0 && (v + 30.0) % 28.0 < 9.0);
    match inside(CARD, local, 16.0) {
        depth if depth < 0.0 => [0.0; 4],
        depth if depth < 4.0 => [r + 0.2, g + 0.2, b + 0.2, 1.0],
        _ if is_line => [r * 0.45, g * 0.45, b * 0.45, 0.9],
        _ if v < -46.0 => [r * 0.72, g * 0.72, b * 0.72, 0.95],
        _ => [r, g, b, 0.86],
    }
}

fn badge(local: [f64; 2]) -> Colour {
    match inside(BADGE, local, 14.0) {
        depth if depth < 0.0 => [0.0; 4],
        depth if depth < 3.0 => [1.0, 1.0, 1.0, 1.0],
        _ => [0.88, 0.22, 0.25, 1.0],
    }
}

fn plate([u, v]: [f64; 2]) -> Colour {
    let is_rule = [u, v].iter().any(|at| (at + 330.0) % 60.0 < 3.0);
    match inside(PLATE, [u, v], 330.0) {
        depth if depth < 0.0 => [0.0; 4],
        depth if depth < 5.0 => [0.9, 0.95, 1.0, 1.0],
        _ => [0.55, 0.7, 0.9, if is_rule { 0.85 } else { 0.45 }],
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let layers = page();
    let mut page = Layers::new([[0.0, 0.0], SCREEN]);
    page.update(&layers)?;
    println!("{} layers, {} seen, in {} pieces", layers.len(), page.visible(), page.len());
    if let Some(path) = std::env::args().nth(1) {
        paint(&layers, &page).write_png(&path)?;
    }
    Ok(())
}

#[test]
fn the_page_is_cut_where_it_crosses_and_painted_in_order() {
    let layers = page();
    let mut page = Layers::new([[0.0, 0.0], SCREEN]);
    page.update(&layers).unwrap();
    assert_eq!(page.visible(), layers.len());
    assert!(page.len() > page.visible());
    // A card comes before its badge.
    let order: Vec<usize> = page.back_to_front().map(|piece| piece.layer()).collect();
    let first = |layer| order.iter().position(|&other| other == layer);
    assert!((0..CARDS).all(|k| first(2 * k) < first(2 * k + 1)));
    // The badge of the front card is red, and the hit test at its middle returns it.
    let canvas = paint(&layers, &page);
    let badge = page.back_to_front().rfind(|piece| piece.layer() == 1).unwrap();
    let corners: Vec<_> = badge.vertices().map(|vertex| vertex.position.truncate()).collect();
    let middle = (corners[0] + corners[2]) / 2.0;
    assert_eq!(page.hit(middle.to_array()).map(|(layer, _)| layer), Some(1));
    let [red, green, _] = canvas.pixel(middle.to_array().map(|x| x as usize));
    assert!(red > 200 && green < 80, "{red} {green}");
}
