//! Drawings of scenes in which nothing is hidden, and of scenes in which only some polygons are translucent.

use super::map_with;
use super::scenes::cameras;
use binspace::drawing::{EdgeKind, EdgeRun};
use testkit::layered::{Layers, check_all};
use testkit::prelude::*;
use testkit::scenes::{scene_of, triangles};

/// Opacities: a third of the polygons are translucent, nearly all are, or some are left out.
const MIXES: [fn(usize) -> f64; 3] = [
    |polygon| if polygon.is_multiple_of(3) { 0.5 } else { 1.0 },
    |polygon| if polygon.is_multiple_of(17) { 1.0 } else { 0.25 },
    |polygon| [0.0, 1.0, 0.75, 1.0][polygon / 5 % 4],
];

/// The counts of comparisons of fully translucent drawings, and of mixed drawings.
#[derive(Default)]
struct Scores {
    all: Layers,
    mixed: Layers,
}

fn check_scene(scene: &Scene, Scores { all, mixed }: &mut Scores) {
    let tree = BspTree::build(scene.polygons()).unwrap();
    for (i, camera) in cameras(scene, 1, [96, 72]).into_iter().enumerate() {
        check_all(&tree, &camera, &MIXES[i % 3], [all, mixed])
            .unwrap_or_else(|fault| panic!("{}, {i}, {camera:?}: {fault}", scene.name()));
    }
}

/// The layers of the tree. If some polygons are opaque, layers end there.
#[test]
fn layers_of_whole_scenes_agree_with_the_tree() {
    let mut scores = Scores::default();
    for builtin in Builtin::ALL {
        let size = builtin.default_size().map(|size| size.min(300));
        check_scene(&builtin.build(size, 3), &mut scores);
    }
    let Scores { all, mixed } = scores;
    enough!(all.pixels > 200_000, all.layers > 250_000; "{all:?}");
    enough!(mixed.pixels > 200_000, mixed.layers > 120_000; "{mixed:?}");
    enough!(mixed.hidden > 3_000, mixed.rays > 5_000, mixed.small > 1_500; "{mixed:?}");
    enough!(mixed.regions > 15_000; "{mixed:?}");
    assert!(
        [all, mixed].iter().all(|score| score.unsure < score.pixels / 100),
        "{all:?} {mixed:?}"
    );
    // Most cuts of the tree are undone, and few polygons are drawn in parts.
    assert!(all.paths * 2 < all.polygons * 3, "{all:?}");
    assert!(mixed.paths * 10 < mixed.polygons * 11, "{mixed:?}");
}

/// Small, large and a few very large polygons that cross: opaque polygons are clipped, and translucent
/// polygons are divided into parts.
#[test]
fn layers_of_crossing_triangles_agree_with_the_tree() {
    let (mut dice, mut scores) = (Dice(1), Scores::default());
    for (count, edge) in [(300, 0.1), (150, 0.5), (50, 1.0)] {
        let triangles = triangles(&mut dice, count, [0.0, 1.0], edge);
        check_scene(&scene_of(format!("{count} triangles"), triangles), &mut scores);
    }
    let Scores { all, mixed } = scores;
    assert!(all.layers > 100_000 && all.paths > 3 * all.polygons, "{all:?}");
    assert!(mixed.clipped > 25 && mixed.paths > mixed.polygons, "{mixed:?}");
}

/// Two panes that cross: the crossing is reported once, for any opacities.
#[test]
fn panes_cross_in_one_line() {
    let upright = [[0.3, -1.0, -1.0], [0.3, 1.0, -1.0], [0.3, 1.0, 1.0], [0.3, -1.0, 1.0]];
    let level = [[-1.0, -1.0, 0.1], [1.0, -1.0, 0.1], [1.0, 1.0, 0.1], [-1.0, 1.0, 0.1]];
    let tree = BspTree::build([upright, level].map(|square| square.map(DVec3::from))).unwrap();
    let eye = DVec3::new(4.0, 3.0, 5.0);
    let camera = Camera::perspective(eye, DVec3::ZERO, DVec3::Z, 0.9, [300, 200]).unwrap();
    let runs = |opacities: [f64; 2]| {
        let opacity = |polygon: usize| opacities[polygon];
        let map = map_with(&tree, &camera, opacity);
        map.crossings(Hidden::Skip).unwrap()
    };
    let length = |run: &EdgeRun| {
        let [[ax, ay], [bx, by]] = run.ends;
        (bx - ax).hypot(by - ay)
    };
    let [glass, thick, front] = [[0.5, 0.5], [1.0, 1.0], [1.0, 0.5]].map(runs);
    for runs in [&glass, &thick, &front] {
        assert_eq!(runs.len(), 1, "{runs:?}");
        assert_eq!((runs[0].polygon, runs[0].kind), (0, EdgeKind::Crossing(1)));
        assert!(length(&runs[0]) <= length(&glass[0]) + 1e-9);
    }
    // Everything is visible through glass.
    assert!((length(&glass[0]) - length(&thick[0])).abs() < 1e-9, "{glass:?} {thick:?}");
    assert!(runs([0.0, 0.5]).is_empty());
}
