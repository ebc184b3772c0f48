//! Trees broken by hand, in every way for which validation has a message, and in some other ways.

mod cover;
mod layout;
mod names;
mod oracle;
mod sides;
mod sizes;

use glam::{DQuat, DVec3};

use crate::build::{BuildOptions, Heuristic};
use crate::exact::StoredVertex;
use crate::scene::{self, Scene};
use crate::tree::BspTree;
use crate::tree::node::Walk;
use crate::tree::parts::{self, RawChild, RawNode, Record};

type Stored = StoredVertex;

/// A tree taken apart into its builder's output.
#[derive(Clone)]
struct Dismantled {
    nodes: Vec<RawNode>,
    /// For each fragment, the face, and the vertices; no vertices for a whole face.
    pieces: Vec<(u32, Vec<Stored>)>,
    cuts: usize,
}

impl Dismantled {
    fn of(tree: &BspTree) -> Self {
        let mut walk = Walk::new(tree);
        let mut nodes = Vec::new();
        while let Some(visit) = walk.next(tree) {
            let node = &tree.nodes[visit.node];
            let child =
                |is_node, len| if is_node { RawChild::Node } else { RawChild::Leaf(len as u32) };
            nodes.push(RawNode {
                plane: node.plane,
                own: node.own(),
                front: child(node.front_nodes > 0, visit.front.len()),
                back: child(node.back_is_node(), visit.back.len()),
            });
        }
        let pieces = tree.fragments().map(|f| (f.face(), f.stored().to_vec())).collect();
        Self { nodes, pieces, cuts: tree.cuts }
    }

    /// A tree made of these parts, right or wrong. The tree's sizes, layout and rounded planes agree with the
    /// parts.
    fn tree(&self, like: &BspTree) -> BspTree {
        let (nodes, cuts) = (self.nodes.clone(), self.cuts);
        let mut parts = parts::Parts { nodes, cuts, ..Default::default() };
        for (face, vertices) in &self.pieces {
            parts.records.push(Record { face: *face, vertices: parts.vertices.len() as u32 });
            parts.vertices.extend_from_slice(vertices);
        }
        BspTree::new(like.faces.clone(), like.preparation, parts).unwrap()
    }
}

/// The fault that validation finds; empty for a valid tree.
fn verdict(tree: &BspTree) -> String {
    tree.validate().err().unwrap_or_default()
}

/// Takes a tree apart, edits the parts and joins them again. Fails unless validation finds this fault.
#[track_caller]
fn assert_fault(tree: &BspTree, edit: impl FnOnce(&mut Dismantled), fault: &str) {
    assert_eq!(verdict(tree), "");
    let mut parts = Dismantled::of(tree);
    edit(&mut parts);
    let said = verdict(&parts.tree(tree));
    assert!(said.contains(fault), "{said:?}, not {fault:?}");
}

fn build(scene: &Scene, heuristic: Heuristic) -> BspTree {
    BuildOptions::DEFAULT.with_heuristic(heuristic).build(scene.polygons()).expect("finite")
}

/// Squares that all cross in one line, the first whole and the others cut in halves.
fn crossing(count: u32) -> BspTree {
    build(&scene::crossing(count), Heuristic::First)
}

fn square(half: f64, z: f64) -> [DVec3; 4] {
    [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)]
        .map(|(x, y)| DVec3::new(x * half, y * half, z))
}

/// Nested squares in two planes, some facing up and some down, and an upright square that cuts all of them.
fn decals() -> Scene {
    let mut scene = Scene::new("decals", DVec3::Z);
    let upright = square(9.0, 0.1).map(|p| DVec3::new(p.z, p.x, p.y));
    scene.push(upright, 0);
    for k in 0..12 {
        let mut corners = square(8.0 - 0.5 * f64::from(k), f64::from(k % 2));
        if k % 3 == 0 {
            corners.reverse();
        }
        scene.push(corners, 0);
    }
    scene
}

/// A scene rotated away from all axes.
fn tilted(scene: &Scene) -> Scene {
    let turn = DQuat::from_axis_angle(DVec3::new(0.3, 0.7, 0.2).normalize(), 1.1);
    let mut tilted = Scene::new(scene.name(), scene.up());
    for polygon in scene.polygons() {
        tilted.push(polygon.points().iter().map(|&corner| turn * corner), 0);
    }
    tilted
}

/// Trees of all kinds: no node, one node, cuts, pieces in one plane, lists, large trees.
fn trees() -> Vec<(String, BspTree)> {
    let mut trees = Vec::new();
    for scene in [
        Scene::new("nothing", DVec3::Z),
        scene::chain(1),
        scene::crossing(7),
        decals(),
        tilted(&decals()),
        scene::random_triangles(40, 3),
        scene::random_triangles(300, 1),
        tilted(&scene::sphere(600)),
        scene::chain(500),
        scene::city(500, 2),
        scene::newell_bars(),
        scene::layers(12, 1e-4),
    ] {
        for by in [Heuristic::First, Heuristic::FreePlanes, Heuristic::default()] {
            trees.push((format!("{} by {by}", scene.name()), build(&scene, by)));
        }
    }
    trees
}

#[test]
fn built_trees_are_valid_and_have_the_counted_cuts() {
    let (mut cut, mut lists, mut large) = (0, 0, 0);
    for (name, tree) in trees() {
        assert_eq!(verdict(&tree), "", "{name}");
        assert_eq!(verdict(&Dismantled::of(&tree).tree(&tree)), "", "{name} put together again");
        let stats = tree.stats();
        assert_eq!(stats.fragments, stats.faces + stats.splits, "{name}");
        cut += usize::from(stats.splits > 0);
        lists += usize::from(stats.depth_max > 100);
        large += usize::from(stats.fragments > 400);
    }
    assert!(cut >= 15 && lists >= 3 && large >= 10, "{cut} {lists} {large}");
}

#[test]
fn cuts_are_counted_over_all_jobs_of_a_build() {
    let tree = build(&scene::random_triangles(3000, 5), Heuristic::default());
    let stats = tree.stats();
    assert!(stats.splits > 5000, "{stats:?}");
    assert_eq!((stats.fragments, verdict(&tree)), (stats.faces + stats.splits, String::new()));
}
