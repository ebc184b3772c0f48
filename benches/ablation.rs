//! Changes one tuning constant at a time (off, halved, doubled), and measures fragments and build time over
//! all scenes. Prints the table of ABLATION.md.
//!
//! ```sh
//! cargo bench -p binspace-benches --bench ablation
//! ```

#![allow(missing_docs, reason = "a program")]
#![allow(clippy::print_stdout, clippy::print_stderr, reason = "prints measurements")]

use binspace::BuildOptions;
use binspace::glam::{DQuat, DVec3, EulerRot};
use binspace::internals::{Faces, FrameTuning, Tuning, tree_of};
use binspace::scene::Scene;
use std::time::{Duration, Instant};
use support::{SEED, Table, boxes, check, print_head, random_quads, scene, small_triangles};
use testkit::pages::Page;

const BUILTIN: [&str; 13] = [
    "crossing:100",
    "layers:100",
    "teapot:8",
    "teapot:16",
    "terrain:5000",
    "sphere:3000",
    "city:5000",
    "random:150",
    "random:260",
    "random:500",
    "random:1000",
    "random:5000",
    "chain:2000",
];
const TURNED: [&str; 6] =
    ["teapot:8", "terrain:2000", "sphere:1000", "sphere:20000", "city:2000", "layers:200"];
const FILES: [&str; 6] =
    ["bunny.obj", "spider.obj", "person.obj", "dragon.obj", "level.obj", "level_large.obj"];

/// Builds of a scene with one tuning are repeated until they take this long together, or [`MOST_BUILDS`]
/// times.
const ENOUGH: Duration = Duration::from_millis(12);
const MOST_BUILDS: usize = 9;

/// The name of the changed field, the kind of change, and the function that makes the change.
type Change = (&'static str, &'static str, fn(&mut Tuning));

/// For each field, the name of its change and the new value.
macro_rules! changes {
    ($($field:ident: $($how:literal => $value:expr),+;)*) => {
        [$($((stringify!($field), $how, |t: &mut Tuning| t.$field = $value),)+)*]
    };
}

const MOST: usize = usize::MAX;

const CHANGES: [Change; 29] = changes! {
    frames: "as in frames" => Some(FrameTuning::FRAMES),
        "clean planes alone" => Some(FrameTuning { crossings: 0, ..FrameTuning::FRAMES });
    clean_below: "0" => 0, "½" => 32, "×2" => 128;
    small: "0" => 0, "¼" => 64, "½" => 128;
    risk: "0" => 0.0, "½" => 0.25, "×2" => 1.0;
    risk_at: "½" => 0.1, "×2" => 0.4;
    pairs: "1" => 1, "½" => 2, "×2" => 8;
    next_cuts: "0" => 0.0, "½" => 0.025, "×2" => 0.1;
    sample: "0" => 0, "½" => 32, "×2" => 128, "×4" => 256;
    one_sided_needed: "never" => f64::INFINITY, "½" => 0.375, "×4/3" => 1.0;
    groups_per_box: "½" => 32, "×2" => 128, "all" => 1 << 30;
};

/// The changes of the tuning for frames.
const OF_FRAMES: [Change; 11] = [
    ("frames: crossings", "0", |t| {
        t.frames = Some(FrameTuning { crossings: 0, ..FrameTuning::FRAMES })
    }),
    ("frames: crossings", "½", |t| {
        t.frames = Some(FrameTuning { crossings: 1, ..FrameTuning::FRAMES })
    }),
    ("frames: crossings", "all", |t| {
        t.frames = Some(FrameTuning { crossings: MOST, ..FrameTuning::FRAMES })
    }),
    ("frames: probes", "0", |t| t.frames = Some(FrameTuning { probes: 0, ..FrameTuning::FRAMES })),
    ("frames: probes", "×2", |t| {
        t.frames = Some(FrameTuning { probes: 8, ..FrameTuning::FRAMES })
    }),
    ("frames: uneven", "never", |t| {
        t.frames = Some(FrameTuning { uneven: 1, ..FrameTuning::FRAMES })
    }),
    ("frames: uneven", "×2", |t| {
        t.frames = Some(FrameTuning { uneven: 8, ..FrameTuning::FRAMES })
    }),
    ("frames: trusted_share", "½", |t| {
        t.frames = Some(FrameTuning { trusted_share: 0.125, ..FrameTuning::FRAMES })
    }),
    ("frames: trusted_share", "×2", |t| {
        t.frames = Some(FrameTuning { trusted_share: 0.5, ..FrameTuning::FRAMES })
    }),
    ("frames: coarse", "0", |t| {
        t.frames = Some(FrameTuning { coarse: 0.0, ..FrameTuning::FRAMES })
    }),
    ("frames: coarse", "∞", |t| {
        t.frames = Some(FrameTuning { coarse: f64::INFINITY, ..FrameTuning::FRAMES })
    }),
];

fn main() {
    print_head("Ablation of choosing", "cargo bench -p binspace-benches --bench ablation");
    let scenes = scenes();
    let faces: usize = scenes.iter().map(Scene::len).sum();
    println!("- scenes: {}, of {faces} polygons together", scenes.len());
    println!("- figures: geometric means over the scenes, relative to the default tuning");
    println!(
        "- times: the shortest of up to {MOST_BUILDS} builds, alternating with the default tuning"
    );
    println!(
        "- fragments are exact; times vary by about 5 % on an idle machine, and more on others"
    );
    let columns = ["field", "change", "fragments", "most", "on", "time", "longest", "on"];
    let table = Table::new("Ablation", &columns);
    ablate(&table, &Tuning::DEFAULT, &CHANGES, &scenes);
    // Fields that only frames use, measured over pages of layers.
    ablate(&table, &Tuning::FRAMES, &OF_FRAMES, &pages());
}

fn ablate(table: &Table, base: &Tuning, changes: &[Change], scenes: &[Scene]) {
    for &(field, how, change) in changes {
        let mut tuning = *base;
        change(&mut tuning);
        let rows: Vec<_> = scenes.iter().map(|scene| compare(scene, [base, &tuning])).collect();
        let mean = |of: fn(&[f64; 2]) -> f64| {
            (rows.iter().map(|row| of(row).ln()).sum::<f64>() / rows.len() as f64).exp()
        };
        let worst = |figure: usize| {
            let place =
                (0..rows.len()).max_by(|&a, &b| rows[a][figure].total_cmp(&rows[b][figure]));
            let place = place.expect("a scene");
            let name = scenes[place].name();
            let name = name.rsplit('/').next().unwrap_or(name).to_owned();
            (rows[place][figure], name)
        };
        let ((most, most_on), (longest, longest_on)) = (worst(0), worst(1));
        table.row(&[
            field.to_owned(),
            how.to_owned(),
            format!("{:.3}", mean(|row| row[0])),
            format!("{most:.3}"),
            most_on,
            format!("{:.2}", mean(|row| row[1])),
            format!("{longest:.2}"),
            longest_on,
        ]);
    }
}

/// The fragments and the time with the second tuning, divided by the fragments and the time with the first.
fn compare(scene: &Scene, tunings: [&Tuning; 2]) -> [f64; 2] {
    let mut shortest = [Duration::MAX; 2];
    let mut fragments = [0; 2];
    let (mut spent, mut builds) = (Duration::ZERO, 0);
    while builds == 0 || builds < MOST_BUILDS && spent < ENOUGH {
        for turn in 0..2 {
            // The first build of a turn finds other data in the caches, so the tunings take turns in being
            // first.
            let i = (turn + builds) % 2;
            let start = Instant::now();
            let (faces, preparation) = Faces::new(scene.polygons(), None).expect("finite");
            let tree =
                tree_of(&BuildOptions::DEFAULT, tunings[i], faces, preparation).expect("a tree");
            let time = start.elapsed();
            shortest[i] = shortest[i].min(time);
            fragments[i] = tree.stats().fragments;
            spent += time;
            if builds == 0 && scene.len() < 500 {
                check(&tree, scene);
            }
        }
        builds += 1;
    }
    let [default, other] = shortest.map(|time| time.as_secs_f64());
    [fragments[1] as f64 / fragments[0] as f64, other / default]
}

fn scenes() -> Vec<Scene> {
    let mut scenes: Vec<Scene> = BUILTIN.into_iter().map(scene).collect();
    scenes.extend(TURNED.into_iter().map(scene).map(|scene| turned(&scene)));
    scenes.extend([random_quads(200), random_quads(300), small_triangles(5000)]);
    scenes.extend([boxes(100), boxes(300)]);
    scenes.extend(FILES.into_iter().map(scene));
    scenes
}

/// The pages of the bench of frames.
fn pages() -> Vec<Scene> {
    let counts = [12, 30, 100, 200];
    let page = |(page, count): (Page, usize)| {
        let mut scene = Scene::new(format!("{}:{count}", page.name()), DVec3::Y);
        for layer in page.layers(count, SEED) {
            scene.push(layer.outline().map(DVec3::from), 0);
        }
        scene
    };
    Page::ALL.into_iter().flat_map(|page| counts.map(|count| (page, count))).map(page).collect()
}

/// A copy of a scene in which nothing is perpendicular to an axis.
fn turned(scene: &Scene) -> Scene {
    let turn = DQuat::from_euler(EulerRot::XYZ, 0.3, 0.5, 0.7);
    let mut turned = Scene::new(format!("{}, turned", scene.name()), scene.up());
    for corners in scene.polygons() {
        turned.push(corners.points().iter().map(|&corner: &DVec3| turn * corner), 0);
    }
    turned
}
