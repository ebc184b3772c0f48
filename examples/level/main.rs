//! A walk through a level of rooms that looks only at what may be seen: front to back, without the
//! subtrees that are outside of the view or behind what is painted already.
//!
//! ```sh
//! cargo run --release --example level -- docs/level.png
//! ```
//!
//! Each frame walks the tree from front to back. A subtree is skipped if its box is outside of the
//! camera's frustum, or if a mask of the picture's pixels says that all it may cover is covered. What
//! is left owns the pixels of the picture, and no visit depends on how large the rest of the level is.
//! The picture shows a frame, and beside it a map: bright is what was painted, dark what was never
//! looked at.
//!
//! ![A frame inside the rooms, and a map of what was looked at](../../docs/level.png)

#![allow(clippy::print_stdout, reason = "a program")]

#[path = "../canvas/mod.rs"]
mod canvas;
mod rooms;

use binspace::glam::{DVec3, dvec3};
use binspace::raster::Rays;
use binspace::view::Camera;
use binspace::{Bounds, BspTree, CoverageMask, Flow, Fragment, Part, Viewpoint};
use canvas::Canvas;
use rooms::{Kind, Quad, ROOM};
use std::error::Error;
use std::f64::consts::FRAC_PI_8;

const ROOMS: usize = 14;
const FRAMES: usize = 8;
/// The frame that is painted.
const PICTURE: usize = 2;
const VIEW: [u32; 2] = [640, 480];
const MAP: f64 = 480.0;

/// What a frame found.
struct Frame {
    /// The fragments that own a pixel, front to back.
    seen: Vec<u32>,
    /// The subtrees and fragments that the walk came to.
    visits: usize,
}

/// The camera of a frame: from room to room, a step at a time, and looking around.
fn camera(frame: usize) -> Result<Camera, Box<dyn Error>> {
    let along = frame as f64 / (FRAMES - 1) as f64;
    let eye = dvec3(2.5 + 3.0 * along, 4.5, 0.0) * ROOM + DVec3::Z * 1.7;
    let angle = 0.5 - 0.7 * along;
    let look = dvec3(angle.cos(), angle.sin(), -0.06);
    Ok(Camera::perspective(eye, eye + look, DVec3::Z, 1.05, VIEW)?)
}

fn walk(tree: &BspTree, bounds: &Bounds, camera: &Camera) -> Result<Frame, Box<dyn Error>> {
    let frustum = camera.frustum();
    let mut mask = CoverageMask::new(tree, &Rays::new(camera, tree.faces())?, 1);
    let mut frame = Frame { seen: Vec::new(), visits: 0 };
    let _ = tree.walk_front_to_back(camera.viewpoint(), |part| {
        frame.visits += 1;
        match part {
            Part::Subtree(node) => {
                let region = bounds.of(node);
                if !frustum.meets(region) || mask.hides(region) {
                    return Flow::Skip;
                }
            }
            Part::Fragment(fragment) => {
                if mask.cover(&fragment) {
                    frame.seen.push(fragment.index());
                }
            }
        }
        if mask.is_full() { Flow::Break(()) } else { Flow::Descend }
    });
    Ok(frame)
}

fn colour(kind: Kind) -> [f64; 3] {
    match kind {
        Kind::Floor => [0.66, 0.58, 0.48],
        Kind::Ceiling => [0.80, 0.80, 0.78],
        Kind::Wall => [0.86, 0.78, 0.62],
        Kind::Pillar => [0.45, 0.60, 0.70],
        Kind::Crate => [0.75, 0.45, 0.25],
    }
}

/// The frame as it is seen, on the left.
fn paint_view(
    canvas: &mut Canvas,
    tree: &BspTree,
    level: &[(Kind, Quad)],
    camera: &Camera,
    frame: &Frame,
) {
    let Viewpoint::Eye(eye) = camera.viewpoint() else { return };
    for &index in frame.seen.iter().rev() {
        let fragment = tree.fragment(index);
        let (kind, [a, b, c, _]) = level[fragment.polygon()];
        let vertices: Vec<DVec3> = fragment.vertices().collect();
        let middle = vertices.iter().sum::<DVec3>() / vertices.len() as f64;
        let normal = (b - a).cross(c - a).normalize();
        // Lit from two sides, and darker with the distance.
        let light = 0.72 + 0.18 * normal.x.abs() + 0.10 * normal.z.abs();
        let light = light / (1.0 + (middle - eye).length() / 45.0);
        let [r, g, b] = colour(kind).map(|c| c * light);
        canvas.fill(&camera.clip(&vertices), |_| [r, g, b, 1.0]);
    }
}

/// The level from above, on the right: what was painted is bright.
fn paint_map(
    canvas: &mut Canvas,
    tree: &BspTree,
    level: &[(Kind, Quad)],
    camera: &Camera,
    frame: &Frame,
) {
    let scale = (MAP - 20.0) / (ROOMS as f64 * ROOM);
    let place = |p: DVec3| [f64::from(VIEW[0]) + 10.0 + p.x * scale, MAP - 10.0 - p.y * scale];
    let mut draw = |fragment: Fragment<'_>, is_seen: bool| {
        let kind = level[fragment.polygon()].0;
        let vertices: Vec<DVec3> = fragment.vertices().collect();
        let share = if is_seen { 1.0 } else { 0.3 };
        let [r, g, b] = colour(kind).map(|c| c * share);
        match kind {
            Kind::Ceiling => {}
            // Above a door.
            Kind::Wall if vertices.iter().all(|p| p.z > 0.0) => {}
            Kind::Floor => {
                let outline: Vec<[f64; 2]> = vertices.into_iter().map(place).collect();
                canvas.fill(&outline, |_| [0.7 * r, 0.7 * g, 0.7 * b, 1.0]);
            }
            _ => {
                let (low, high) = vertices
                    .iter()
                    .fold((DVec3::MAX, DVec3::MIN), |(low, high), &p| (low.min(p), high.max(p)));
                let ([x0, y1], [x1, y0]) = (place(low), place(high));
                let outline = [
                    [x0 - 0.8, y0 - 0.8],
                    [x1 + 0.8, y0 - 0.8],
                    [x1 + 0.8, y1 + 0.8],
                    [x0 - 0.8, y1 + 0.8],
                ];
                canvas.fill(&outline, |_| [r, g, b, 1.0]);
            }
        }
    };
    let is_floor = |f: &Fragment<'_>| level[f.polygon()].0 == Kind::Floor;
    let seen: Vec<Fragment<'_>> = frame.seen.iter().map(|&index| tree.fragment(index)).collect();
    // Floors first: on a map, walls stand on them.
    tree.fragments().filter(is_floor).for_each(|f| draw(f, false));
    seen.iter().filter(|f| is_floor(f)).for_each(|&f| draw(f, true));
    tree.fragments().filter(|f| !is_floor(f)).for_each(|f| draw(f, false));
    seen.iter().filter(|f| !is_floor(f)).for_each(|&f| draw(f, true));
    if let Viewpoint::Eye(eye) = camera.viewpoint() {
        let [x, y] = place(eye);
        let ring: Vec<[f64; 2]> = (0..16)
            .map(|k| (f64::from(k) * FRAC_PI_8).sin_cos())
            .map(|(s, c)| [x + 4.0 * s, y - 4.0 * c])
            .collect();
        canvas.fill(&ring, |_| [0.95, 0.2, 0.2, 1.0]);
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let level = rooms::rooms(ROOMS);
    let tree = BspTree::build(level.iter().map(|(_, quad)| quad))?;
    let bounds = tree.bounds()?;
    let parts = tree.nodes().len() + tree.len();
    println!("{} rooms, {} polygons, {} fragments", ROOMS * ROOMS, level.len(), tree.len());
    for number in 0..FRAMES {
        let frame = walk(&tree, &bounds, &camera(number)?)?;
        let share = 100.0 * frame.visits as f64 / parts as f64;
        println!(
            "frame {number}: {} of {parts} visits ({share:.1} %), {} fragments seen",
            frame.visits,
            frame.seen.len()
        );
    }
    if let Some(path) = std::env::args().nth(1) {
        let camera = camera(PICTURE)?;
        let frame = walk(&tree, &bounds, &camera)?;
        let mut canvas = Canvas::new([VIEW[0] as usize + MAP as usize, MAP as usize], [0.06; 3]);
        paint_view(&mut canvas, &tree, &level, &camera, &frame);
        paint_map(&mut canvas, &tree, &level, &camera, &frame);
        canvas.write_png(&path)?;
    }
    Ok(())
}

#[test]
fn a_frame_looks_at_little_and_misses_nothing() {
    let level = rooms::rooms(ROOMS);
    let tree = BspTree::build(level.iter().map(|(_, quad)| quad)).unwrap();
    let bounds = tree.bounds().unwrap();
    let parts = tree.nodes().len() + tree.len();
    for number in 0..FRAMES {
        let camera = camera(number).unwrap();
        let frame = walk(&tree, &bounds, &camera).unwrap();
        assert!(frame.visits * 5 < parts, "{} of {parts}", frame.visits);
        // The whole order paints no face that the frame has not seen.
        let rays = Rays::new(&camera, tree.faces()).unwrap();
        let whole = binspace::paint_tree(&tree, camera.viewpoint(), &rays);
        let is_seen =
            |polygon: usize| frame.seen.iter().any(|&f| tree.fragment(f).polygon() == polygon);
        let shown = whole.faces().iter().filter(|&&face| face != binspace::raster::NONE);
        assert!(shown.map(|&face| tree.faces().polygon(face)).all(is_seen));
    }
    let mut canvas = Canvas::new([VIEW[0] as usize + MAP as usize, MAP as usize], [0.06; 3]);
    let frame = walk(&tree, &bounds, &camera(0).unwrap()).unwrap();
    paint_view(&mut canvas, &tree, &level, &camera(0).unwrap(), &frame);
    let background = canvas.pixel([900, 2]);
    assert!((0..480).step_by(60).all(|y| canvas.pixel([300, y]) != background));
}
