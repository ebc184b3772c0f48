//! A build on one thread and on two, against the surface area heuristic of the `bvh` crate on two threads, on
//! the same polygons as triangles. Its boxes are computed beforehand, in `f32` as most of its users would.

use binspace::BspTree;
use binspace::glam::DVec3;
use binspace::scene::Scene;
use bvh::aabb::{Aabb, Bounded};
use bvh::bounding_hierarchy::BHShape;
use bvh::bvh::{Bvh, rayon_executor};
use nalgebra::Point3;
use std::time::Duration;
use support::{Table, best, check, ratio, scene, threads, time, triangulated};

const SCENES: [&str; 13] = [
    "random:1000",
    "terrain:100000",
    "sphere:100000",
    "city:100000",
    "terrain:1000000",
    "bunny.obj",
    "spider.obj",
    "person.obj",
    "dragon.obj",
    "dragon_large.obj",
    "engine.obj",
    "level.obj",
    "level_large.obj",
];

pub(crate) fn run() {
    let table = Table::new(
        "Build",
        &[
            "scene",
            "polygons",
            "fragments",
            "fragments a polygon",
            "one thread",
            "two threads",
            "one ÷ two",
            "bvh",
            "bvh ÷ ours",
        ],
    );
    let (one, two) = (threads(1), threads(2));
    for name in SCENES {
        let scene = scene(name);
        let build = || BspTree::build(scene.polygons()).expect("within budget");
        let (alone, by_one) = one.install(|| best(build));
        let (together, by_two) = two.install(|| best(build));
        check(&by_two, &scene);
        assert_same(&by_one, &by_two);
        let hierarchy = two.install(|| hierarchy(&scene));
        table.row(&[
            name.to_owned(),
            scene.len().to_string(),
            by_two.len().to_string(),
            format!("{:.2}", by_two.len() as f64 / scene.len() as f64),
            time(alone),
            time(together),
            ratio(alone, together),
            time(hierarchy),
            ratio(hierarchy, together),
        ]);
    }
}

/// The same statistics, and the same fragments bit for bit in the same places.
fn assert_same(a: &BspTree, b: &BspTree) {
    assert_eq!(a.stats(), b.stats());
    for (a, b) in a.fragments().zip(b.fragments()) {
        assert_eq!(a.polygon(), b.polygon());
        assert!(a.vertices().eq(b.vertices()));
    }
}

/// The shortest time to build a hierarchy of boxes.
fn hierarchy(scene: &Scene) -> Duration {
    let triangles = triangulated(scene);
    let bounds = |points: &[DVec3]| {
        let points = points.iter().map(|p| Point3::from(p.as_vec3().to_array()));
        points.fold(Aabb::empty(), |bounds, point| bounds.grow(&point))
    };
    let mut boxes: Vec<Shape> = triangles
        .polygons()
        .map(|corners| Shape { bounds: bounds(corners.points()), node: 0 })
        .collect();
    let (shortest, hierarchy) = best(|| Bvh::build_with_executor(&mut boxes, rayon_executor));
    assert_eq!(hierarchy.nodes.len(), 2 * boxes.len() - 1);
    shortest
}

#[derive(Clone)]
struct Shape {
    bounds: Aabb<f32, 3>,
    node: usize,
}

impl Bounded<f32, 3> for Shape {
    fn aabb(&self) -> Aabb<f32, 3> {
        self.bounds
    }
}

impl BHShape<f32, 3> for Shape {
    fn set_bh_node_index(&mut self, index: usize) {
        self.node = index;
    }

    fn bh_node_index(&self) -> usize {
        self.node
    }
}
