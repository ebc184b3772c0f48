//! A walk through a level of rooms with a door that swings: culling, occlusion and sight lines.
//!
//! ```sh
//! cargo run --release --example level -- docs/level.png
//! ```
//!
//! The level is a tree that is built once. For each frame
//!
//! - **culling**: the tree is walked from front to back. A subtree is skipped if its box is outside the
//!   camera's frustum, or if a mask shows that all pixels that it may cover are covered. Back faces of closed
//!   bodies are left out. Each remaining fragment is visible in at least one pixel. The number of visits does
//!   not depend on the size of the rest of the level;
//! - **the door** moves, so it is in an overlay, which splits it by the planes of the tree and returns one
//!   order of both. The tree is not changed;
//! - **a sight line** from a guard to the camera is free if neither the level nor the door blocks it. One
//!   query to the overlay answers this.
//!
//! The picture shows a frame, and beside it a map: painted polygons are bright, unvisited ones dark.
//!
//! ![A frame inside the rooms, and a map of the visited polygons](../../docs/level.png)

#![allow(clippy::print_stdout, reason = "a program")]

#[path = "../canvas/mod.rs"]
mod canvas;
mod door;
mod picture;
mod rooms;

use binspace::glam::{DVec3, dvec3};
use binspace::occlusion::CoverageMask;
use binspace::overlay::Overlay;
use binspace::raster::Rays;
use binspace::view::Camera;
use binspace::{BspTree, Facing, Flow, Part, Ray, Viewpoint};
use canvas::Canvas;
use door::Door;
use picture::{paint_map, paint_view};
use rooms::{Kind, Quad, ROOM};
use std::error::Error;
use std::f64::consts::FRAC_PI_2;

const ROOMS: usize = 14;
const FRAMES: usize = 8;
/// The frame that is painted.
const PICTURE: usize = 2;
const VIEW: [u32; 2] = [640, 480];
const MAP: f64 = 480.0;

/// The static level, and the moving door.
struct Level {
    polygons: Vec<(Kind, Quad)>,
    tree: BspTree,
    door: Door,
    overlay: Overlay,
}

/// The result of a frame.
struct Frame {
    /// The fragments that are visible in a pixel, front to back.
    seen: Vec<u32>,
    /// The number of subtrees and fragments that the walk visited.
    visits: usize,
    /// The painted fragments, back to front: visible fragments, and the pieces of the door.
    order: Vec<u32>,
}

impl Level {
    fn new() -> Result<Self, Box<dyn Error>> {
        let polygons = rooms::rooms(ROOMS);
        let tree = BspTree::build(polygons.iter().map(|(_, quad)| quad))?;
        let door = Door::nearest(&polygons, dvec3(4.0, 4.5, 0.0) * ROOM).ok_or("no doorway")?;
        Ok(Self { overlay: Overlay::new(&tree), polygons, tree, door })
    }

    /// Opens the door by an angle.
    fn open(&mut self, angle: f64) -> Result<(), binspace::Error> {
        self.overlay.replace(&self.tree, [self.door.leaf(angle)])
    }

    /// A frame with the door opened by an angle.
    fn frame(&mut self, camera: &Camera, angle: f64) -> Result<Frame, Box<dyn Error>> {
        let (seen, visits) = self.walk(camera)?;
        self.open(angle)?;
        let mut order = Vec::new();
        self.overlay.order(&self.tree, camera.viewpoint())?.write_into(&mut order);
        // Visible fragments of the tree, and the whole door. If the door is behind a wall, the wall is
        // painted over it.
        let mut is_painted = vec![false; self.tree.len()];
        seen.iter().for_each(|&fragment| is_painted[fragment as usize] = true);
        order.retain(|&number| is_painted.get(number as usize).copied().unwrap_or(true));
        Ok(Frame { seen, visits, order })
    }

    /// The fragments of the tree that are visible in a pixel, front to back, and the number of visited parts.
    /// Fragments that only the door hides are included.
    fn walk(&self, camera: &Camera) -> Result<(Vec<u32>, usize), Box<dyn Error>> {
        let Self { polygons, tree, .. } = self;
        let frustum = camera.frustum();
        let mut mask = CoverageMask::new(tree, &Rays::new(camera, tree.faces())?, 1);
        let (mut seen, mut visits) = (Vec::new(), 0);
        let _ = tree.order(camera.viewpoint()).front_to_back().walk(|part| {
            visits += 1;
            match part {
                Part::Subtree(node) => {
                    let region = node.bounds();
                    if !frustum.meets(region) || mask.hides(region) {
                        return Flow::Skip;
                    }
                }
                Part::Fragment(fragment) => {
                    // Walls are thin and visible from both sides, so their back faces are kept.
                    let is_thin = polygons[fragment.polygon()].0 == Kind::Wall;
                    let is_drawn = is_thin || fragment.facing(camera.viewpoint()) == Facing::Front;
                    if is_drawn && mask.cover(&fragment) {
                        seen.push(fragment.index());
                    }
                }
            }
            if mask.is_full() { Flow::Break(()) } else { Flow::Descend }
        });
        Ok((seen, visits))
    }

    /// Whether neither the level nor the door in its current position blocks the line between two points.
    fn is_in_sight(&self, from: DVec3, to: DVec3) -> Result<bool, binspace::Error> {
        Ok(!self.overlay.is_occluded(&self.tree, Ray::between(from, to))?)
    }

    /// A guard behind the closed door, at the height of the camera.
    fn guard(&self) -> DVec3 {
        let [hinge, end, ..] = self.door.leaf(0.0);
        let behind = (end - hinge).cross(DVec3::Z).normalize();
        ((hinge + end) * 0.5 + behind * 2.5).with_z(1.7)
    }
}

/// The camera of a frame. It walks from room to room, one step per frame, and looks around.
fn camera(frame: usize) -> Result<Camera, Box<dyn Error>> {
    let along = frame as f64 / (FRAMES - 1) as f64;
    let eye = dvec3(2.5 + 3.0 * along, 4.5, 0.0) * ROOM + DVec3::Z * 1.7;
    let angle = 0.5 - 0.7 * along;
    let look = dvec3(angle.cos(), angle.sin(), -0.06);
    Ok(Camera::perspective(eye, eye + look, DVec3::Z, 1.05, VIEW)?)
}

/// The angle of the open door in a frame, in radians.
fn angle(frame: usize) -> f64 {
    FRAC_PI_2 * frame as f64 / (FRAMES - 1) as f64
}

fn main() -> Result<(), Box<dyn Error>> {
    let mut level = Level::new()?;
    let parts = level.tree.nodes().len() + level.tree.len();
    let (polygons, fragments) = (level.polygons.len(), level.tree.len());
    println!("{} rooms, {polygons} polygons, {fragments} fragments", ROOMS * ROOMS);
    for number in 0..FRAMES {
        let (camera, angle) = (camera(number)?, angle(number));
        let frame = level.frame(&camera, angle)?;
        let share = 100.0 * frame.visits as f64 / parts as f64;
        let Viewpoint::Eye(eye) = camera.viewpoint() else { continue };
        println!(
            "frame {number}: {} of {parts} visits ({share:.1} %), {} fragments seen; the door is open by \
             {:.0} degrees, in {} pieces; the guard {} us",
            frame.visits,
            frame.seen.len(),
            angle.to_degrees(),
            level.overlay.len(),
            if level.is_in_sight(level.guard(), eye)? { "sees" } else { "does not see" },
        );
    }
    if let Some(path) = std::env::args().nth(1) {
        let camera = camera(PICTURE)?;
        let frame = level.frame(&camera, angle(PICTURE))?;
        let mut canvas = Canvas::new([VIEW[0] as usize + MAP as usize, MAP as usize], [0.06; 3]);
        paint_view(&mut canvas, &level, &camera, &frame);
        paint_map(&mut canvas, &level, &camera, &frame);
        canvas.write_png(&path)?;
    }
    Ok(())
}

#[test]
fn a_frame_visits_few_parts_and_misses_none() {
    let mut level = Level::new().unwrap();
    let parts = level.tree.nodes().len() + level.tree.len();
    for number in 0..FRAMES {
        let camera = camera(number).unwrap();
        let frame = level.frame(&camera, angle(number)).unwrap();
        assert!(frame.visits * 5 < parts, "{} of {parts}", frame.visits);
        // The picture of the whole order shows no face that the frame has left out.
        let tree = &level.tree;
        let rays = Rays::new(&camera, tree.faces()).unwrap();
        let whole = binspace::paint::paint_tree(tree, camera.viewpoint(), &rays);
        let is_seen =
            |polygon: usize| frame.seen.iter().any(|&f| tree.fragment(f).polygon() == polygon);
        let shown = whole.faces().iter().filter(|&&face| face != binspace::raster::NONE);
        assert!(shown.map(|&face| tree.faces().polygon(face)).all(is_seen));
    }
    let mut canvas = Canvas::new([VIEW[0] as usize + MAP as usize, MAP as usize], [0.06; 3]);
    let camera = camera(0).unwrap();
    let frame = level.frame(&camera, 0.0).unwrap();
    paint_view(&mut canvas, &level, &camera, &frame);
    let background = canvas.pixel([900, 2]);
    assert!((0..480).step_by(60).all(|y| canvas.pixel([300, y]) != background));
}

/// The pixels in which the door is visible, if outlines are painted one over the other.
#[cfg(test)]
fn door_pixels(camera: &Camera, outlines: impl Iterator<Item = (bool, Vec<DVec3>)>) -> Vec<bool> {
    let mut canvas = Canvas::new(VIEW.map(|side| side as usize), [0.0; 3]);
    for (is_door, outline) in outlines {
        let light = if is_door { 1.0 } else { 0.0 };
        canvas.fill(&camera.clip(&outline), |_| [light, light, light, 1.0]);
    }
    let pixels = (0..VIEW[1]).flat_map(|y| (0..VIEW[0]).map(move |x| [x as usize, y as usize]));
    pixels.map(|pixel| canvas.pixel(pixel)[0] > 128).collect()
}

/// The picture equals the picture of one tree of the level and the door, built for this frame.
#[test]
fn the_door_shows_where_it_would_in_a_tree_of_its_own_frame() {
    let mut level = Level::new().unwrap();
    let mut shown = 0;
    for number in 0..5 {
        let (camera, angle) = (camera(number).unwrap(), angle(number));
        let frame = level.frame(&camera, angle).unwrap();
        let Level { tree, overlay, polygons, door, .. } = &level;
        let painted = frame.order.iter().map(|&number| {
            let piece = overlay.piece(number);
            let fragment = piece.unwrap_or_else(|| tree.fragment(number));
            (piece.is_some(), fragment.vertices().collect())
        });
        let painted = door_pixels(&camera, painted);
        let quads = polygons.iter().map(|&(_, quad)| quad);
        let all = BspTree::build(quads.chain([door.leaf(angle)])).unwrap();
        let is_door = |polygon: usize| polygon == polygons.len();
        let truth = all
            .back_to_front(camera.viewpoint())
            .map(|fragment| (is_door(fragment.polygon()), fragment.vertices().collect()));
        let truth = door_pixels(&camera, truth);
        // Edges of cuts are blended differently.
        let wrong = painted.iter().zip(&truth).filter(|(a, b)| a != b).count();
        let right = truth.iter().filter(|&&is_door| is_door).count();
        assert!(wrong * 100 <= right, "frame {number}: {wrong} of {right}");
        shown += right;
    }
    assert!(shown > 2000, "{shown}");
}

#[test]
fn the_guard_sees_into_the_room_when_the_door_is_open() {
    let mut level = Level::new().unwrap();
    let [hinge, end, ..] = level.door.leaf(0.0);
    let guard = level.guard();
    let room = ((hinge + end) - guard).with_z(1.7);
    assert!(!level.tree.is_occluded(Ray::between(guard, room)), "the doorway is free of walls");
    level.open(0.0).unwrap();
    assert!(!level.is_in_sight(guard, room).unwrap());
    level.open(FRAC_PI_2).unwrap();
    assert!(level.is_in_sight(guard, room).unwrap());
    // A sight line through a wall is blocked, whether the door is open or closed.
    assert!(!level.is_in_sight(guard, room + DVec3::Z * 9.0).unwrap());
}
