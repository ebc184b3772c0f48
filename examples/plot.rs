//! A plot in space: two surfaces that cross, axes through both, a curve that winds around them, and
//! markers and labels, all in one exact order.
//!
//! ```sh
//! cargo run --release --example plot -- docs/plot.png
//! cargo run --release --example plot -- plot.svg
//! ```
//!
//! The surfaces are the polygons of a tree. Lines and points go into an overlay, which cuts each line where
//! it goes through a surface, so that the part behind the surface is painted before it, and the part in front
//! after it. A label is a point; its text is written when the order reaches it.
//!
//! The SVG (`plot/svg.rs`) has one path for each visible quad. Hidden parts of lines are dashed; the
//! visibility map returns them.
//!
//! ![Two surfaces that cross, axes, a curve, markers and labels](../docs/plot.png)

#![allow(clippy::print_stdout, reason = "a program")]

mod canvas;
#[path = "plot/svg.rs"]
mod svg;

use binspace::glam::{DVec2, DVec3, dvec2, dvec3};
use binspace::overlay::{Overlay, Shape, Shapes};
use binspace::{BspTree, BuildOptions, Viewpoint};
use canvas::{Canvas, Colour};
use std::error::Error;
use std::f64::consts::TAU;

const SIZE: [usize; 2] = [960, 640];
/// The direction towards the eye, for a parallel projection.
const TOWARDS_EYE: DVec3 = dvec3(0.62, -0.78, 0.52);
/// Pixels for a length of 1.
const UNIT: f64 = 128.0;
/// Quads along each side of a surface.
const QUADS: usize = 36;
const TURNS: f64 = 3.0;

const INK: Colour = [0.12, 0.13, 0.17, 1.0];
const FAINT: Colour = [0.12, 0.13, 0.17, 0.22];
const RED: Colour = [0.82, 0.16, 0.18, 1.0];

struct Line {
    corners: Vec<DVec3>,
    width: f64,
    colour: Colour,
}

/// A dot, or a text at a place.
struct Mark {
    at: DVec3,
    text: String,
}

fn ripple(x: f64, y: f64) -> f64 {
    let r = x.hypot(y);
    1.1 * (2.6 * r).cos() / (1.0 + 0.6 * r * r)
}

fn saddle(x: f64, y: f64) -> f64 {
    0.22 * (x * x - y * y) + 0.15 * x
}

/// The quads of both surfaces, over a square of side 4.
fn surfaces() -> Vec<[DVec3; 4]> {
    let at = |k: usize| 4.0 * k as f64 / QUADS as f64 - 2.0;
    let quads = |height: fn(f64, f64) -> f64| {
        (0..QUADS * QUADS).map(move |k| {
            let (i, j) = (k / QUADS, k % QUADS);
            [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)].map(|(i, j)| {
                let (x, y) = (at(i), at(j));
                dvec3(x, y, height(x, y))
            })
        })
    };
    quads(ripple).chain(quads(saddle)).collect()
}

/// A point of the helix around the axis, from share 0 at the lower end to 1 at the upper end.
fn helix(share: f64) -> DVec3 {
    let angle = TURNS * TAU * share;
    dvec3(1.5 * angle.cos(), 1.5 * angle.sin(), 3.2 * share - 1.6)
}

fn lines() -> Vec<Line> {
    let mut lines = Vec::new();
    for k in -4..=4 {
        let (k, floor) = (0.5 * f64::from(k), -1.6);
        for ends in [[(k, -2.0), (k, 2.0)], [(-2.0, k), (2.0, k)]] {
            let corners = ends.map(|(x, y)| dvec3(x, y, floor)).to_vec();
            lines.push(Line { corners, width: 1.2, colour: FAINT });
        }
    }
    for (axis, length) in DVec3::AXES.into_iter().zip([2.6, 2.6, 2.1]) {
        lines.push(Line { corners: vec![-axis * length, axis * length], width: 2.2, colour: INK });
        let across = if axis == DVec3::Z { DVec3::X } else { DVec3::Z } * 0.07;
        for tick in ticks(axis) {
            lines.push(Line {
                corners: vec![tick - across, tick + across],
                width: 2.2,
                colour: INK,
            });
        }
    }
    let corners = (0..=240).map(|k| helix(f64::from(k) / 240.0)).collect();
    lines.push(Line { corners, width: 3.0, colour: RED });
    lines
}

fn ticks(axis: DVec3) -> impl Iterator<Item = DVec3> {
    [-2.0, -1.0, 1.0, 2.0].into_iter().map(move |at| axis * at)
}

fn marks() -> Vec<Mark> {
    let mut marks = Vec::new();
    for k in 0..=12 {
        marks.push(Mark { at: helix(f64::from(k) / 12.0), text: String::new() });
    }
    for (axis, name) in DVec3::AXES.into_iter().zip(["x", "y", "z"]) {
        let beside = if axis == DVec3::Z { DVec3::X * 0.2 } else { DVec3::Z * -0.22 };
        for tick in ticks(axis).filter(|tick| tick.length() > 1.5) {
            marks.push(Mark { at: tick + beside, text: axis.dot(tick).to_string() });
        }
        let end = if axis == DVec3::Z { 2.3 } else { 2.8 };
        marks.push(Mark { at: axis * end, text: name.to_owned() });
    }
    marks
}

/// The position of a point in the picture.
fn project(point: DVec3) -> DVec2 {
    let ahead = TOWARDS_EYE.normalize();
    let right = DVec3::Z.cross(ahead).normalize();
    let down = right.cross(ahead);
    dvec2(right.dot(point), down.dot(point)) * UNIT + dvec2(480.0, 284.0)
}

fn stroke(canvas: &mut Canvas, a: DVec2, b: DVec2, width: f64, colour: Colour) {
    let half = (b - a).perp().normalize_or_zero() * width / 2.0;
    canvas.fill(&[a - half, b - half, b + half, a + half].map(|p| p.to_array()), |_| colour);
}

fn dot(canvas: &mut Canvas, at: DVec2, radius: f64, colour: Colour) {
    let point = |k: i32| at + DVec2::from_angle(TAU * f64::from(k) / 24.0) * radius;
    let outline: Vec<[f64; 2]> = (0..24).map(|k| point(k).to_array()).collect();
    canvas.fill(&outline, |_| colour);
}

/// Digits consist of seven strokes: on the left, in the middle and on the right of a box.
const BARS: [[DVec2; 2]; 7] = [
    [dvec2(0.0, 0.0), dvec2(1.0, 0.0)],
    [dvec2(1.0, 0.0), dvec2(1.0, 1.0)],
    [dvec2(1.0, 1.0), dvec2(1.0, 2.0)],
    [dvec2(0.0, 2.0), dvec2(1.0, 2.0)],
    [dvec2(0.0, 1.0), dvec2(0.0, 2.0)],
    [dvec2(0.0, 0.0), dvec2(0.0, 1.0)],
    [dvec2(0.0, 1.0), dvec2(1.0, 1.0)],
];

fn glyph(letter: char) -> Vec<[DVec2; 2]> {
    let bars = |of: &[usize]| of.iter().map(|&bar| BARS[bar]).collect();
    let [left, right] = [0.0, 1.0].map(|x| move |y: f64| dvec2(x, y));
    match letter {
        '2' => bars(&[0, 1, 6, 4, 3]),
        '-' => bars(&[6]),
        'x' => vec![[left(0.6), right(2.0)], [right(0.6), left(2.0)]],
        'y' => vec![[left(0.6), dvec2(0.5, 1.3)], [right(0.6), dvec2(0.0, 2.6)]],
        'z' => vec![[left(0.6), right(0.6)], [right(0.6), left(2.0)], [left(2.0), right(2.0)]],
        _ => vec![],
    }
}

fn write(canvas: &mut Canvas, text: &str, at: DVec2) {
    let step = dvec2(11.0, 0.0);
    let start = at - step * (text.len() as f64 - 0.3) / 2.0 - dvec2(0.0, 7.0);
    // A light outline first, so that the text is readable on any background.
    for (width, colour) in [(5.0, [1.0, 1.0, 1.0, 0.6]), (2.0, INK)] {
        for (k, letter) in text.chars().enumerate() {
            for bar in glyph(letter) {
                let [a, b] = bar.map(|end| start + step * k as f64 + end * 7.0);
                let over = (b - a).normalize_or_zero() * width / 2.0;
                stroke(canvas, a - over, b + over, width, colour);
            }
        }
    }
}

struct Plot {
    quads: Vec<[DVec3; 4]>,
    lines: Vec<Line>,
    marks: Vec<Mark>,
    tree: BspTree,
    overlay: Overlay,
}

impl Plot {
    fn new() -> Result<Self, binspace::Error> {
        let (quads, lines, marks) = (surfaces(), lines(), marks());
        // The axes reach beyond the surfaces.
        let room = BuildOptions::DEFAULT.with_bounds(DVec3::splat(-3.0), DVec3::splat(3.0));
        let tree = room.build(&quads)?;
        let mut overlay = Overlay::new(&tree);
        let shapes = Shapes::NONE
            .with_lines(lines.iter().map(|line| &line.corners))
            .with_points(marks.iter().map(|mark| mark.at));
        overlay.replace_with(&tree, shapes)?;
        Ok(Self { quads, lines, marks, tree, overlay })
    }

    fn paint(&self) -> Result<Canvas, binspace::Error> {
        let mut canvas = Canvas::new(SIZE, [0.97, 0.97, 0.95]);
        let viewpoint = Viewpoint::direction(-TOWARDS_EYE);
        for shape in self.overlay.order(&self.tree, viewpoint)? {
            match shape {
                Shape::Fragment(fragment) => {
                    let outline: Vec<DVec2> = fragment.vertices().map(project).collect();
                    let colour = self.colour(fragment.polygon());
                    let points: Vec<[f64; 2]> = outline.iter().map(|p| p.to_array()).collect();
                    canvas.fill(&points, |_| colour);
                    for (k, edge) in fragment.edges().enumerate() {
                        if edge.is_some() {
                            let ends = [outline[k], outline[(k + 1) % outline.len()]];
                            stroke(&mut canvas, ends[0], ends[1], 0.7, [0.0, 0.0, 0.0, 0.16]);
                        }
                    }
                }
                Shape::Segment(segment) => {
                    let Line { width, colour, .. } = self.lines[segment.line()];
                    let [a, b] = segment.ends().map(project);
                    stroke(&mut canvas, a, b, width, colour);
                }
                Shape::Marker(marker) => {
                    let mark = &self.marks[marker.point()];
                    let at = project(marker.position());
                    if mark.text.is_empty() {
                        dot(&mut canvas, at, 6.5, INK);
                        dot(&mut canvas, at, 5.0, [1.0, 0.84, 0.3, 1.0]);
                    } else {
                        write(&mut canvas, &mark.text, at);
                    }
                }
                _ => {}
            }
        }
        Ok(canvas)
    }

    /// The colour of a quad, from its height and its slope.
    fn colour(&self, quad: usize) -> Colour {
        let [a, b, c, d] = self.quads[quad];
        let light = (c - a).cross(d - b).normalize().dot(dvec3(0.2, -0.5, 0.84)).abs();
        let height = ((a.z + c.z) / 2.4).clamp(-1.0, 1.0) * 0.5 + 0.5;
        let [low, high] = if quad < QUADS * QUADS {
            [dvec3(0.10, 0.30, 0.55), dvec3(0.55, 0.85, 0.80)]
        } else {
            [dvec3(0.78, 0.45, 0.20), dvec3(0.98, 0.84, 0.50)]
        };
        (low.lerp(high, height) * (0.55 + 0.45 * light)).extend(0.93).to_array()
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let plot = Plot::new()?;
    let segments: usize = plot.lines.iter().map(|line| line.corners.len() - 1).sum();
    println!(
        "{} quads in {} fragments; {segments} segments and {} points in {} pieces",
        plot.quads.len(),
        plot.tree.len(),
        plot.marks.len(),
        plot.overlay.len()
    );
    if let Some(path) = std::env::args().nth(1) {
        match path.ends_with(".svg") {
            true => std::fs::write(path, svg::picture(&plot)?.to_svg())?,
            false => plot.paint()?.write_png(&path)?,
        }
    }
    Ok(())
}

/// Whether a surface is between a place and the eye, by steps along the ray; `None` where it is close.
#[cfg(test)]
fn is_hidden(place: DVec3) -> Option<bool> {
    let step = TOWARDS_EYE.normalize() * 0.002;
    [ripple, saddle].into_iter().try_fold(false, |hidden, height: fn(f64, f64) -> f64| {
        let above = |p: DVec3| p.z - height(p.x, p.y);
        let inside = |p: DVec3| p.x.abs().max(p.y.abs()) < 2.0;
        let ray = (0..3000).map(|k| place + step * f64::from(k)).take_while(|&p| inside(p));
        let heights: Vec<f64> = ray.map(above).collect();
        let crossed = heights.windows(2).any(|pair| pair[0] * pair[1] <= 0.0);
        let is_close = heights[0].abs() < 0.1 || !crossed && heights.iter().any(|h| h.abs() < 0.04);
        (!is_close).then_some(hidden || crossed)
    })
}

#[test]
fn markers_show_where_no_surface_is_in_front_of_them() {
    let plot = Plot::new().unwrap();
    let canvas = plot.paint().unwrap();
    let mut found = [0; 2];
    for mark in plot.marks.iter().filter(|mark| mark.text.is_empty()) {
        let Some(hidden) = is_hidden(mark.at) else { continue };
        // Points away from the middle, where the curve may be in front.
        let yellow = (0..8).filter(|&k| {
            let at = project(mark.at) + DVec2::from_angle(TAU * f64::from(k) / 8.0) * 3.5;
            let [red, _, blue] = canvas.pixel(at.to_array().map(|x| x as usize));
            red > 240 && (60..100).contains(&blue)
        });
        let yellow = yellow.count();
        assert!(if hidden { yellow == 0 } else { yellow > 3 }, "{yellow} of 8: {}", mark.at);
        found[usize::from(hidden)] += 1;
    }
    assert!(found[0] > 3 && found[1] > 1, "{found:?}");
}

/// The visibility map has the same markers at the same positions.
#[test]
fn a_vector_picture_has_the_visible_markers() {
    use binspace::drawing::ViewOptions;

    let plot = Plot::new().unwrap();
    let camera = svg::camera().unwrap();
    let map = plot.tree.visibility(&camera, &ViewOptions::DEFAULT).unwrap();
    let mut found = [0; 2];
    let markers = map.markers(&plot.overlay).unwrap();
    for marker in &markers {
        let place = plot.marks[marker.point].at;
        let at = project(place);
        assert!((DVec2::from(marker.position) - at).length() < 2e-3, "{marker:?} {at}");
        // Labels lie beyond the surfaces.
        let is_dot = plot.marks[marker.point].text.is_empty();
        let Some(hidden) = is_dot.then(|| is_hidden(place)).flatten() else { continue };
        assert_eq!(marker.is_visible, !hidden, "{marker:?}");
        found[usize::from(hidden)] += 1;
    }
    assert!(found[0] > 5 && found[1] > 1, "{found:?}");
    let shown = markers.iter().filter(|marker| marker.is_visible).count();
    let text = svg::picture(&plot).unwrap().to_svg();
    assert_eq!(text.matches("<circle").count() + text.matches("<text").count(), shown);
    assert!(text.matches("<path").count() > 1000 && text.contains("stroke-dasharray"));
}
