//! A page's data of a scene and its tree.

use binspace::BspTree;
use binspace::glam::DVec3;
use binspace::internals::LATTICE_LIMIT;
use binspace::scene::Scene;
use binspace::view::{Camera, Projection};
use indexmap::IndexSet;
use serde::Serialize;

use super::arrays::{Arrays, number};
use crate::colours::{Colouring, Colours};

/// The data of a page. Positions count from the middle of the tree's grid, in units of [`LATTICE_LIMIT`]
/// steps of the grid, so that no coordinate of the scene is above 1.
#[derive(Serialize)]
pub(super) struct Data {
    figures: Vec<(String, String)>,
    view: View,
    materials: Vec<Colour>,
    /// Steps of the grid in a unit.
    steps: f64,
    /// The number of planes of nodes, which come before all other planes.
    #[serde(rename = "nodePlaneCount")]
    node_planes: usize,
    arrays: Arrays,
}

/// The camera with which the page begins.
#[derive(Serialize)]
struct View {
    forward: [f64; 3],
    right: [f64; 3],
    up: [f64; 3],
    target: [f64; 3],
    distance: f64,
    /// The tangent of half the angle of view from bottom to top.
    slope: f64,
}

/// The look of a material.
#[derive(Serialize)]
struct Colour {
    colour: [u8; 3],
    opacity: f32,
}

impl Data {
    /// `up` is the direction that points up on the page, unless the camera had to use another.
    pub(super) fn new(
        scene: &Scene,
        tree: &BspTree,
        camera: &Camera,
        up: DVec3,
        figures: Vec<(String, String)>,
    ) -> Self {
        let (materials, polygon_materials) = materials(scene);
        let (arrays, node_planes) = Arrays::of(tree, &polygon_materials);
        let view = View::new(scene, tree, camera, up);
        Self { figures, view, materials, steps: LATTICE_LIMIT, node_planes, arrays }
    }
}

impl View {
    fn new(scene: &Scene, tree: &BspTree, camera: &Camera, up: DVec3) -> Self {
        let lattice = tree.faces().lattice();
        let units = |length: f64| lattice.length_to_lattice(length) / LATTICE_LIMIT;
        let (low, high) = scene.bounds().unwrap_or_default();
        let middle = low * 0.5 + high * 0.5;
        let (eye, slope) = match *camera.projection() {
            Projection::Perspective { eye, half_height } => (eye, half_height),
            Projection::Parallel { centre, .. } => (centre, 1.0),
        };
        let distance = (middle - eye).dot(camera.forward());
        let target = lattice.to_lattice(eye + camera.forward() * distance);
        let up = up.normalize_or_zero();
        let is_taken = up != DVec3::ZERO && camera.right().dot(up).abs() < 1e-9;
        Self {
            forward: camera.forward().to_array(),
            right: camera.right().to_array(),
            up: if is_taken { up } else { camera.up() }.to_array(),
            target: target.map(|c| c / LATTICE_LIMIT),
            distance: units(distance),
            slope,
        }
    }
}

/// The different looks of a scene's materials, and the look of each polygon.
fn materials(scene: &Scene) -> (Vec<Colour>, Vec<u32>) {
    let colours = Colours::new(scene, Colouring::Material);
    let mut looks = IndexSet::new();
    let look = |polygon| (colours.rgb(polygon), colours.opacity(polygon).to_bits());
    let numbers = (0..scene.len()).map(|polygon| number(&mut looks, look(polygon))).collect();
    let colour =
        |&(colour, bits): &([u8; 3], u32)| Colour { colour, opacity: f32::from_bits(bits) };
    (looks.iter().map(colour).collect(), numbers)
}
