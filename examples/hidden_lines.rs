//! A line drawing of a machine part: visible edges are solid, hidden edges are dashed.
//!
//! ```sh
//! cargo run --release --example hidden_lines -- docs/hidden_lines.svg
//! ```
//!
//! The visibility map returns each edge as visible and hidden runs, with the kind of the edge: a silhouette,
//! or a crease between two polygons. Edges inside round parts, where polygons meet at a small angle, are left
//! out. Runs of the same style are joined into polylines.
//!
//! ![A nut with a flange, with its hidden edges dashed](../docs/hidden_lines.svg)

#![allow(clippy::print_stdout, reason = "a program")]

use binspace::BspTree;
use binspace::drawing::{EdgeKind, EdgeRun, Hidden, Stroke, VectorPicture, ViewOptions, polylines};
use binspace::glam::{DVec3, dvec3};
use binspace::view::Camera;
use std::error::Error;
use std::f64::consts::{FRAC_PI_3, FRAC_PI_6, TAU};

const SIZE: [u32; 2] = [640, 420];
/// The number of quads around the part.
const QUADS: usize = 96;
/// The smallest angle of a crease that is drawn, in radians.
const CREASE: f64 = 0.3;

type Ring = [DVec3; QUADS];

fn circle(radius: f64, z: f64) -> Ring {
    std::array::from_fn(|k| {
        let (sin, cos) = (TAU * k as f64 / QUADS as f64).sin_cos();
        dvec3(radius * cos, radius * sin, z)
    })
}

/// A hexagon whose sides are this far from the axis.
fn hexagon(distance: f64, z: f64) -> Ring {
    let mut ring = circle(distance, z);
    for (k, point) in ring.iter_mut().enumerate() {
        let angle = (TAU * k as f64 / QUADS as f64) % FRAC_PI_3 - FRAC_PI_6;
        *point = dvec3(point.x / angle.cos(), point.y / angle.cos(), z);
    }
    ring
}

/// A nut with a flange and a step in its bore. It consists of rings, each joined to the next, and the last to
/// the first.
fn part() -> Vec<[DVec3; 4]> {
    let rings = [
        circle(3.1, 0.0),
        circle(3.1, 0.35),
        circle(2.6, 0.55),
        hexagon(2.1, 0.55),
        hexagon(2.1, 2.4),
        circle(1.5, 2.4),
        circle(1.2, 2.1),
        circle(1.2, 0.9),
        circle(1.7, 0.9),
        circle(1.7, 0.0),
    ];
    let quad = |r: usize, k: usize| {
        let (ring, next) = (&rings[r], &rings[(r + 1) % rings.len()]);
        let after = (k + 1) % QUADS;
        [ring[k], ring[after], next[after], next[k]]
    };
    (0..rings.len() * QUADS).map(|i| quad(i / QUADS, i % QUADS)).collect()
}

fn runs() -> Result<Vec<EdgeRun>, Box<dyn Error>> {
    let tree = BspTree::build(part())?;
    let eye = dvec3(7.0, -9.0, 9.0);
    let camera = Camera::perspective(eye, dvec3(0.0, 0.0, 0.8), DVec3::Z, 0.46, SIZE)?;
    let mut runs = tree.visibility(&camera, &ViewOptions::DEFAULT)?.edges(Hidden::Keep)?;
    runs.retain(|run| !matches!(run.kind, EdgeKind::Crease(angle) if angle < CREASE));
    Ok(runs)
}

/// The lines as an SVG, with hidden lines below visible lines.
fn svg(runs: &[EdgeRun]) -> Result<String, Box<dyn Error>> {
    const INK: [u8; 3] = [17, 34, 51];
    let mut picture = VectorPicture::new(SIZE).with_background([255; 3]);
    let hidden = Stroke::new(0.8, INK).with_dashes(3.5, 3.0);
    for (is_visible, stroke) in [(false, hidden), (true, Stroke::new(1.6, INK))] {
        let alike = runs.iter().filter(|run| run.is_visible == is_visible);
        picture.add_lines(polylines(alike.map(|run| run.ends))?, stroke);
    }
    Ok(picture.to_svg())
}

fn main() -> Result<(), Box<dyn Error>> {
    let runs = runs()?;
    let visible = runs.iter().filter(|run| run.is_visible).count();
    println!(
        "{} quads; {visible} visible runs of edges, {} hidden",
        part().len(),
        runs.len() - visible
    );
    if let Some(path) = std::env::args().nth(1) {
        std::fs::write(path, svg(&runs)?)?;
    }
    Ok(())
}

/// Each edge of the part belongs to two quads, and all are in the picture.
#[test]
fn outlines_are_closed_and_some_edges_hidden() {
    let runs = runs().unwrap();
    assert!(runs.iter().all(|run| run.kind != EdgeKind::Border));
    let count = |is_visible: bool| runs.iter().filter(|run| run.is_visible == is_visible).count();
    assert!(count(true) > 300 && count(false) > 300, "{} {}", count(true), count(false));
    // The whole part is in the picture.
    for [x, y] in runs.iter().flat_map(|run| run.ends) {
        assert!(x > 5.0 && x < f64::from(SIZE[0]) - 5.0 && y > 5.0 && y < f64::from(SIZE[1]) - 5.0);
    }
    let text = svg(&runs).unwrap();
    assert!(text.matches('m').count() < 120 && text.len() < 20_000, "{}", text.len());
}
