//! A build with every thread, against the surface area heuristic of the `bvh` crate with its
//! rayon executor on the same triangles.

use binspace::BspTree;
use binspace::scene::Scene;
use bvh::aabb::{Aabb, Bounded};
use bvh::bounding_hierarchy::BHShape;
use bvh::bvh::{Bvh, rayon_executor};
use nalgebra::Point3;
use support::{Table, Target, against, best, check, scene, time};

const SCENES: [(&str, f64); 4] = [
    ("chessboard_63k.obj", 8.0),
    ("teapot_quads_32k.obj", 8.0),
    ("showroom_big_cc0.obj", 15.0),
    ("maple_tree_166k.obj", 15.0),
];

pub(crate) fn run() {
    let table = Table::new(
        "Build, exact kernel, two threads, against bvh",
        &["scene", "triangles", "fragments", "binspace", "bvh", "ratio", "target", "met"],
    );
    for (name, target) in SCENES {
        let Some(scene) = scene(name) else { continue };
        let mut triangles = triangles(&scene);
        let (theirs, bvh) = best(|| Bvh::build_with_executor(&mut triangles, rayon_executor));
        assert_eq!(bvh.nodes.len(), 2 * triangles.len() - 1);
        let (ours, tree) = best(|| BspTree::build(scene.polygons()).expect("within budget"));
        check(&tree, &scene);
        let [ratio, target, met] =
            against(ours.as_secs_f64() / theirs.as_secs_f64(), Target::AtMost(target));
        table.row(&[
            name.to_owned(),
            triangles.len().to_string(),
            tree.len().to_string(),
            time(ours),
            time(theirs),
            ratio,
            target,
            met,
        ]);
    }
}

struct Triangle {
    corners: [Point3<f64>; 3],
    node: usize,
}

/// Fans: a bounding volume hierarchy does not mind that some faces are not convex.
fn triangles(scene: &Scene) -> Vec<Triangle> {
    let point = |corner: binspace::glam::DVec3| Point3::from(corner.to_array());
    let mut triangles = Vec::new();
    for corners in scene.polygons() {
        for pair in corners.windows(2).skip(1) {
            let corners = [corners[0], pair[0], pair[1]].map(point);
            triangles.push(Triangle { corners, node: 0 });
        }
    }
    triangles
}

impl Bounded<f64, 3> for Triangle {
    fn aabb(&self) -> Aabb<f64, 3> {
        self.corners.iter().fold(Aabb::empty(), |bounds, corner| bounds.grow(corner))
    }
}

impl BHShape<f64, 3> for Triangle {
    fn set_bh_node_index(&mut self, index: usize) {
        self.node = index;
    }

    fn bh_node_index(&self) -> usize {
        self.node
    }
}
