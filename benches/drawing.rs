//! Drawings of one view: the number of visible polygons and of cells, and the time of a drawing, on one
//! thread and on two, against building the tree in the same process. Fans show the growth of cells with the
//! triangles around one vertex.
//!
//! ```sh
//! cargo bench -p binspace-benches --bench drawing                      # all scenes
//! cargo bench -p binspace-benches --bench drawing -- terrain:10000 fan:500
//! ```

#![allow(missing_docs, reason = "a program")]

use binspace::BspTree;
use binspace::drawing::ViewOptions;
use binspace::glam::DVec3;
use binspace::scene::Scene;
use binspace::view::Camera;
use rayon::ThreadPoolBuilder;
use std::time::Duration;
use support::{Table, best_of, print_head, time, wanted};
use testkit::shapes::fan;

/// Scenes, and their up directions. Files are in the folder `BINSPACE_SCENES`, and are skipped without it.
const SCENES: [(&str, DVec3); 17] = [
    ("terrain:10000", DVec3::Z),
    ("terrain:100000", DVec3::Z),
    ("sphere:10000", DVec3::Z),
    ("city:10000", DVec3::Z),
    ("random:1500", DVec3::Z),
    ("triangles in cubes:5000", DVec3::Z),
    ("chessboard_63k.obj", DVec3::Y),
    ("doom_e1m1.obj", DVec3::Y),
    ("bunny_4k.obj", DVec3::Y),
    ("fan:500", DVec3::Z),
    ("fan:1000", DVec3::Z),
    ("fan:2000", DVec3::Z),
    ("fan:10000", DVec3::Z),
    ("fan:100000", DVec3::Z),
    ("cone:500", DVec3::Z),
    ("cone:2000", DVec3::Z),
    ("cone:10000", DVec3::Z),
];

const SIZE: [u32; 2] = [1600, 1200];

fn main() {
    print_head("Drawings of one view", "cargo bench -p binspace-benches --bench drawing");
    let columns = [
        "scene",
        "polygons",
        "visible",
        "cells",
        "tree",
        "drawing",
        "ratio",
        "tree, 2",
        "drawing, 2",
        "ratio, 2",
        "1 ÷ 2",
        "µs a visible one",
    ];
    let table = Table::new("Drawing ÷ tree, by threads", &columns);
    for (name, up) in SCENES.into_iter().filter(|(name, _)| wanted(name)) {
        let Some(scene) = scene(name) else { continue };
        let views = match name.starts_with("fan") || name.starts_with("cone") {
            true => {
                vec![("above", DVec3::new(0.01, 0.02, 1.0)), ("aslant", DVec3::new(1.0, 0.3, 0.4))]
            }
            false => vec![("", DVec3::ZERO)],
        };
        for (view, from) in views {
            let camera = camera(&scene, up, from);
            table.row(&measured(&format!("{name} {view}"), &scene, &camera));
        }
    }
}

fn measured(name: &str, scene: &Scene, camera: &Camera) -> Vec<String> {
    let [one, two] = [1, 2].map(|threads| {
        let pool = ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
        pool.install(|| {
            let build = || BspTree::build(scene.polygons()).expect("within budget");
            let (building, tree) = best_of(2, build);
            let drawn = || {
                let map = tree.visibility(camera, &ViewOptions::DEFAULT).expect("memory");
                let paths = map.drawing().expect("memory").paths().len();
                (paths, map.cells().count())
            };
            let (drawing, counts) = best_of(2, drawn);
            (building, drawing, counts)
        })
    });
    assert_eq!(one.2, two.2, "{name}");
    let ratio = |a: Duration, b: Duration| format!("{:.2}", a.as_secs_f64() / b.as_secs_f64());
    let (visible, cells) = two.2;
    let mut row = vec![name.to_owned(), scene.len().to_string()];
    row.extend([visible, cells].map(|count| count.to_string()));
    for (building, drawing, _) in [&one, &two] {
        row.extend([time(*building), time(*drawing), ratio(*drawing, *building)]);
    }
    row.push(ratio(one.1, two.1));
    row.push(format!("{:.1}", two.1.as_secs_f64() * 1e6 / visible.max(1) as f64));
    row
}

fn scene(name: &str) -> Option<Scene> {
    let Some((kind, count)) = name.split_once(':') else { return support::scene(name) };
    let count: u32 = count.parse().expect("a number");
    let round = |height: f64| {
        let mut scene = Scene::new(name.to_owned(), DVec3::Z);
        fan(count as usize, height).into_iter().for_each(|corners| scene.push(corners, 0));
        Some(scene)
    };
    match kind {
        "fan" => round(0.0),
        "cone" => round(1.5),
        "triangles in cubes" => Some(support::triangles_in_cubes(count)),
        _ => support::scene(name),
    }
}

/// The whole scene, seen from a direction; from around it if that is zero.
fn camera(scene: &Scene, up: DVec3, from: DVec3) -> Camera {
    let (low, high) = scene.bounds().expect("polygons");
    let (middle, size) = ((low + high) * 0.5, (high - low).length());
    let camera = match from == DVec3::ZERO {
        true => Camera::looking_at_all([low, high], up, SIZE),
        false => Camera::perspective(middle + from.normalize() * size, middle, DVec3::Z, 1.0, SIZE),
    };
    camera.expect("a camera")
}
