//! Texture coordinates and colours of corners, interpolated across the splits of a tree.
//!
//! ```sh
//! cargo run --release --example attributes -- docs/attributes.png
//! ```
//!
//! Five sheets cross each other and are split. `Fragment::weights` returns each new vertex as a weighted
//! sum of corners, so checks and colours continue across the splits. The picture draws splits as thin
//! lines.
//!
//! ![Five sheets that cross, with checks that continue across the splits](../docs/attributes.png)

#![allow(clippy::print_stdout, reason = "a program")]

mod canvas;

use binspace::glam::{DVec2, DVec3, dvec2, dvec3};
use binspace::{BspTree, BuildOptions, Error, Fragment, Heuristic, Viewpoint};
use canvas::{Canvas, Colour};

const SIZE: [usize; 2] = [960, 540];
/// The direction towards the eye. In a parallel projection, linear functions in space are linear in the
/// picture.
const TOWARDS_EYE: DVec3 = dvec3(0.45, -0.75, 0.5);
const CHECKS: f64 = 8.0;
/// Texture coordinates of each sheet's four corners.
const UV: [DVec2; 4] = [dvec2(0.0, 0.0), dvec2(1.0, 0.0), dvec2(1.0, 1.0), dvec2(0.0, 1.0)];

/// The attributes of a corner. The attributes of a vertex are weighted sums of the attributes of corners.
#[derive(Clone, Copy)]
struct Attributes {
    uv: DVec2,
    colour: DVec3,
}

/// A sheet around a point, from the vectors to the middles of two of its sides.
fn sheet(middle: DVec3, right: DVec3, up: DVec3) -> [DVec3; 4] {
    [middle - right - up, middle + right - up, middle + right + up, middle - right + up]
}

fn sheets() -> [[DVec3; 4]; 5] {
    [
        sheet(dvec3(0.0, 0.0, -0.1), dvec3(1.9, 0.0, 0.0), dvec3(0.0, 1.0, 0.0)),
        sheet(dvec3(-0.9, 0.0, 0.0), dvec3(0.1, 0.75, 0.0), dvec3(0.1, 0.0, 0.7)),
        sheet(dvec3(0.0, 0.1, 0.0), dvec3(0.7, -0.4, 0.1), dvec3(0.0, 0.3, 0.75)),
        sheet(dvec3(0.15, -0.1, 0.1), dvec3(0.5, 0.6, 0.1), dvec3(-0.3, 0.1, 0.6)),
        sheet(dvec3(1.1, 0.0, 0.05), dvec3(0.55, 0.1, 0.35), dvec3(-0.1, 0.8, 0.1)),
    ]
}

/// The planes of the sheets are used in input order. The first plane cuts all other sheets, so there are more
/// cuts than by default.
fn build() -> Result<BspTree, Error> {
    BuildOptions::DEFAULT.with_heuristic(Heuristic::First).build(sheets())
}

/// Each corner of a sheet has a different colour.
fn corner(sheet: usize, corner: usize) -> Attributes {
    let hue = 1.3 * sheet as f64 + 0.55 * corner as f64;
    let colour = dvec3(hue.cos(), (hue - 2.1).cos(), (hue - 4.2).cos()) * 0.38 + 0.6;
    Attributes { uv: UV[corner], colour }
}

/// The attributes of the vertices of a fragment.
fn attributes(fragment: &Fragment<'_>) -> Vec<Attributes> {
    let zero = Attributes { uv: DVec2::ZERO, colour: DVec3::ZERO };
    let sheet = fragment.polygon();
    let of_vertex = |weights: &[(u32, f64)]| {
        weights.iter().fold(zero, |sum, &(k, weight)| {
            let corner = corner(sheet, k as usize);
            let uv = sum.uv + corner.uv * weight;
            Attributes { uv, colour: sum.colour + corner.colour * weight }
        })
    };
    fragment.weights().map(|weights| of_vertex(&weights)).collect()
}

/// The position of a point in the picture.
fn project(point: DVec3) -> DVec2 {
    let ahead = TOWARDS_EYE.normalize();
    let right = DVec3::Z.cross(ahead).normalize();
    let down = right.cross(ahead);
    dvec2(right.dot(point), down.dot(point)) * 220.0 + dvec2(480.0, 268.0)
}

fn paint(tree: &BspTree) -> Canvas {
    let mut canvas = Canvas::new(SIZE, [0.95, 0.95, 0.93]);
    for fragment in tree.back_to_front(Viewpoint::direction(-TOWARDS_EYE)) {
        let corners: Vec<DVec2> = fragment.vertices().map(project).collect();
        let attributes = attributes(&fragment);
        for k in 2..corners.len() {
            let pick = [0, k - 1, k];
            let triangle = pick.map(|k| corners[k]);
            canvas.fill(&triangle.map(|p| p.to_array()), |point| {
                texture(triangle, pick.map(|k| attributes[k]), point.into())
            });
        }
        for (k, edge) in fragment.edges().enumerate() {
            if edge.is_none() {
                draw_line(&mut canvas, corners[k], corners[(k + 1) % corners.len()]);
            }
        }
    }
    canvas
}

/// Interpolates texture coordinates in a triangle and looks up the colour, like a graphics card.
fn texture([a, b, c]: [DVec2; 3], of: [Attributes; 3], point: DVec2) -> Colour {
    let area = (b - a).perp_dot(c - a);
    let (s, t) = ((point - a).perp_dot(c - a) / area, (b - a).perp_dot(point - a) / area);
    let shares = [1.0 - s - t, s, t];
    let uv: DVec2 = (0..3).map(|k| of[k].uv * shares[k]).sum();
    let colour: DVec3 = (0..3).map(|k| of[k].colour * shares[k]).sum();
    let check = (uv * CHECKS).floor();
    let is_dark = (check.x + check.y).rem_euclid(2.0) == 1.0;
    (if is_dark { colour * 0.62 } else { colour }).extend(1.0).to_array()
}

fn draw_line(canvas: &mut Canvas, a: DVec2, b: DVec2) {
    let half = (b - a).perp().normalize_or_zero() * 0.7;
    let outline = [a - half, b - half, b + half, a + half].map(|p| p.to_array());
    canvas.fill(&outline, |_| [1.0, 1.0, 1.0, 0.9]);
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let tree = build()?;
    println!("{} sheets in {} fragments", sheets().len(), tree.len());
    if let Some(path) = std::env::args().nth(1) {
        paint(&tree).write_png(&path)?;
    }
    Ok(())
}

/// A sheet is flat, so the position of a vertex determines its texture coordinates.
#[test]
fn attributes_continue_across_splits() {
    let tree = build().unwrap();
    assert!(tree.len() > 10);
    let mut cut = 0;
    for fragment in tree.fragments() {
        let [a, b, _, d] = sheets()[fragment.polygon()];
        for (vertex, found) in fragment.vertices().zip(attributes(&fragment)) {
            let place = a + (b - a) * found.uv.x + (d - a) * found.uv.y;
            assert!((place - vertex).length() < 1e-12, "{place} {vertex}");
            cut += usize::from(!UV.contains(&found.uv));
        }
    }
    assert!(cut > 20, "{cut}");
    // The picture is not empty, and has light and dark checks.
    let canvas = paint(&tree);
    let row: Vec<[u8; 3]> = (0..SIZE[0]).map(|x| canvas.pixel([x, 268])).collect();
    let changes = row.windows(2).filter(|pair| pair[0][0].abs_diff(pair[1][0]) > 15).count();
    assert!(changes > 20, "{changes}");
}
