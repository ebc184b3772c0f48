//! A build with every thread, against the surface area heuristic of the `bvh` crate with its rayon executor
//! on the same triangles. Their boxes are computed beforehand, in `f32` as most of its users would, and in
//! `f64`.

use binspace::BspTree;
use binspace::scene::Scene;
use bvh::aabb::{Aabb, Bounded};
use bvh::bounding_hierarchy::{BHShape, BHValue};
use bvh::bvh::{Bvh, rayon_executor};
use nalgebra::Point3;
use std::time::Duration;
use support::{Table, Target, against, best, check, scene, time};

const SCENES: [(&str, f64); 6] = [
    ("bunny_4k.obj", 25.0),
    ("doom_map12_big.obj", 15.0),
    ("chessboard_63k.obj", 15.0),
    ("teapot_quads_32k.obj", 15.0),
    ("showroom_big_cc0.obj", 25.0),
    ("maple_tree_166k.obj", 25.0),
];

pub(crate) fn run() {
    let table = Table::new(
        "Build, two threads, against bvh",
        &[
            "scene",
            "triangles",
            "fragments",
            "binspace",
            "bvh f64",
            "ratio",
            "bvh f32",
            "ratio",
            "target",
            "met",
        ],
    );
    for (name, target) in SCENES {
        let Some(scene) = scene(name) else { continue };
        let double = hierarchy(&boxes::<f64>(&scene, |x| x));
        let single = hierarchy(&boxes::<f32>(&scene, |x| x as f32));
        let (ours, tree) = best(|| BspTree::build(scene.polygons()).expect("within budget"));
        check(&tree, &scene);
        let ratio = |theirs: Duration| ours.as_secs_f64() / theirs.as_secs_f64();
        let [of_single, target, met] = against(ratio(single), Target::AtMost(target));
        table.row(&[
            name.to_owned(),
            boxes::<f64>(&scene, |x| x).len().to_string(),
            tree.len().to_string(),
            time(ours),
            time(double),
            format!("{:.2}", ratio(double)),
            time(single),
            of_single,
            target,
            met,
        ]);
    }
}

/// The shortest time to build a hierarchy of boxes.
fn hierarchy<T: BHValue + Send>(boxes: &[Shape<T>]) -> Duration {
    let mut boxes = boxes.to_vec();
    let (shortest, hierarchy) = best(|| Bvh::build_with_executor(&mut boxes, rayon_executor));
    assert_eq!(hierarchy.nodes.len(), 2 * boxes.len() - 1);
    shortest
}

/// The box of each triangle. Faces are cut into fans: a hierarchy does not mind that some of them
/// are not convex.
fn boxes<T: BHValue>(scene: &Scene, number: impl Fn(f64) -> T) -> Vec<Shape<T>> {
    let mut boxes = Vec::new();
    for corners in scene.polygons() {
        for pair in corners.points().windows(2).skip(1) {
            let corners = [corners.points()[0], pair[0], pair[1]];
            let points = corners.map(|p| Point3::from(p.to_array().map(&number)));
            let bounds = points.iter().fold(Aabb::empty(), |bounds, point| bounds.grow(point));
            boxes.push(Shape { bounds, node: 0 });
        }
    }
    boxes
}

#[derive(Clone)]
struct Shape<T: BHValue> {
    bounds: Aabb<T, 3>,
    node: usize,
}

impl<T: BHValue> Bounded<T, 3> for Shape<T> {
    fn aabb(&self) -> Aabb<T, 3> {
        self.bounds
    }
}

impl<T: BHValue> BHShape<T, 3> for Shape<T> {
    fn set_bh_node_index(&mut self, index: usize) {
        self.node = index;
    }

    fn bh_node_index(&self) -> usize {
        self.node
    }
}
