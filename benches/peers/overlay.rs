//! Polygons that move in a tree that stays: what a frame costs, against building the tree of all anew
//! and against the order of the tree alone.

use binspace::glam::{DMat3, DVec3};
use binspace::{BspTree, BuildOptions, Overlay, Viewpoint};
use std::time::{Duration, Instant};
use support::{SEED, Table, Target, against, check, scene, time, viewpoints};

const SCENES: [&str; 6] = [
    "city:10000",
    "terrain:10000",
    "city:100000",
    "terrain:100000",
    "sphere:100000",
    "showroom_big_cc0.obj",
];
const MOVERS: usize = 200;
const FRAMES: usize = 20;

pub(crate) fn run() {
    let table = Table::new(
        "200 polygons that move, each frame: replace / rebuild, merged order / the tree's own",
        &[
            "scene",
            "fragments",
            "pieces / mover",
            "rebuild",
            "replace",
            "ratio",
            "target",
            "met",
            "order",
            "merged",
            "ratio",
            "target",
            "met",
            "empty",
        ],
    );
    for name in SCENES {
        let Some(scene) = scene(name) else { continue };
        let (low, high) = scene.bounds().expect("a scene with polygons");
        let margin = (high - low) * 0.1;
        let options = BuildOptions::DEFAULT.with_bounds(low - margin, high + margin);
        let start = Instant::now();
        let tree = options.build(scene.polygons()).expect("within budget");
        let rebuild = start.elapsed();
        check(&tree, &scene);
        let mut overlay = Overlay::new(&tree);
        let (mut replacing, mut ordering) = (Duration::ZERO, [Duration::ZERO; 3]);
        let (mut pieces, viewpoints) = (0, viewpoints(&scene));
        for frame in 0..FRAMES {
            let movers = movers(low, high, frame);
            let eye = viewpoints[frame % viewpoints.len()];
            let empty = orders(&mut overlay, &tree, &[], eye).1[1];
            let (replaced, [alone, merged]) = orders(&mut overlay, &tree, &movers, eye);
            judge(&overlay, &tree, eye);
            pieces += overlay.len();
            replacing += replaced;
            [alone, merged, empty].iter().zip(&mut ordering).for_each(|(one, sum)| *sum += *one);
        }
        let mean = |sum: Duration| sum / FRAMES as u32;
        let [alone, merged, empty] = ordering.map(mean);
        let share = |a: Duration, b: Duration| a.as_secs_f64() / b.as_secs_f64();
        let [ratio, target, met] = against(share(mean(replacing), rebuild), Target::AtMost(0.02));
        let [ratio_2, target_2, met_2] = against(share(merged, alone), Target::AtMost(1.3));
        table.row(&[
            name.to_owned(),
            tree.len().to_string(),
            format!("{:.2}", pieces as f64 / (MOVERS * FRAMES) as f64),
            time(rebuild),
            time(mean(replacing)),
            ratio,
            target,
            met,
            time(alone),
            time(merged),
            ratio_2,
            target_2,
            met_2,
            format!("{:.2}", share(empty, alone)),
        ]);
    }
}

/// Squares of a hundredth of the extent, on their ways through the scene, turning.
fn movers(low: DVec3, high: DVec3, frame: usize) -> Vec<[DVec3; 4]> {
    let size = (high - low).max_element() * 0.005;
    let mut random = binspace::internals::SplitMix64::new(SEED);
    let mover = |_| {
        let [x, y, z, turn] = [0; 4].map(|_| random.range(0.0, 1.0));
        let angle = turn * 6.0 + frame as f64 * 0.2;
        let way = DVec3::new(angle.cos(), angle.sin(), 0.3 * (2.0 * angle).sin()) * 0.02;
        let share = (DVec3::new(x, y, z) + way).clamp(DVec3::ZERO, DVec3::ONE);
        let turned = DMat3::from_rotation_z(angle) * DMat3::from_rotation_x(turn * 9.0);
        let at = low + (high - low) * share;
        [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]]
            .map(|[x, y]| at + turned * DVec3::new(x, y, 0.0) * size)
    };
    (0..MOVERS).map(mover).collect()
}

/// The shortest times of a replacement, of the tree's own order, and of both parts' order.
fn orders(
    overlay: &mut Overlay,
    tree: &BspTree,
    movers: &[[DVec3; 4]],
    eye: Viewpoint,
) -> (Duration, [Duration; 2]) {
    let (mut alone, mut both) = (Vec::new(), Vec::new());
    let (mut replacing, mut ordering) = (Duration::MAX, [Duration::MAX; 2]);
    for _ in 0..7 {
        let start = Instant::now();
        overlay.replace(tree, movers).expect("on the grid");
        replacing = replacing.min(start.elapsed());
        let start = Instant::now();
        tree.back_to_front_into(eye, &mut alone);
        ordering[0] = ordering[0].min(start.elapsed());
        let start = Instant::now();
        overlay.back_to_front_into(tree, eye, &mut both).expect("its own tree");
        ordering[1] = ordering[1].min(start.elapsed());
    }
    let of_tree = both.iter().copied().filter(|&number| (number as usize) < tree.len());
    assert!(of_tree.eq(alone), "the tree's own order");
    (replacing, ordering)
}

/// Both forms of the order agree, with each piece once.
fn judge(overlay: &Overlay, tree: &BspTree, eye: Viewpoint) {
    let mut order = Vec::new();
    overlay.back_to_front_into(tree, eye, &mut order).expect("its own tree");
    let listed = overlay.back_to_front(tree, eye).expect("its own tree");
    assert!(listed.map(|fragment| fragment.index()).eq(order.iter().copied()));
    order.sort_unstable();
    assert!(order.into_iter().eq(0..(tree.len() + overlay.len()) as u32));
}
