//! The growth of trees with the number of polygons.

use std::time::Instant;

use binspace::internals::Faces;
use binspace::scene::{Builtin, Scene};
use binspace::{BuildOptions, Heuristic, Viewpoint};
use binspace_evidence::{Tree, Worst, noisy_sphere};

use super::figures::EXACT;
use crate::args::ReportArgs;
use binspace_cli::failure::Failure;
use binspace_cli::progress::Progress;

/// The rounded tree for comparison.
const ROUNDED: &str = "bsp f64 1e-6";
const EPSILON: f64 = 1e-6;
/// The largest number of fragments. Too large: a build takes minutes. Too small: curves end early.
const MAX_FRAGMENTS: usize = 1 << 22;
/// Builds that take less time are repeated once, and the faster build counts.
const SHORT: f64 = 1.0;

/// A tree of one size.
pub(super) struct Growth {
    /// The name of the scene, without its size.
    pub(super) scene: String,
    pub(super) polygons: usize,
    pub(super) method: &'static str,
    /// The figures, or the reason for their absence.
    pub(super) found: Result<Size, String>,
}

/// The size of a tree, and the times for building and ordering it.
pub(super) struct Size {
    pub(super) fragments: usize,
    pub(super) depth: usize,
    pub(super) bytes: usize,
    pub(super) build: f64,
    /// Seconds for an order.
    pub(super) order: f64,
}

/// Measures growth and passes on one tree after another. Each named scene has a single size.
pub(super) fn run(
    args: &ReportArgs,
    scenes: &[Scene],
    mut add: impl FnMut(Growth) -> Result<(), Failure>,
) -> Result<(), Failure> {
    let cases = cases(args.quick);
    let progress = Progress::steps("growth: tree", 2 * (cases.len() + scenes.len()) as u64);
    let mut each = |name: &str, heuristic, polygons: &Scene| {
        let mut add = |method, found| {
            progress.step();
            add(Growth { scene: name.to_owned(), polygons: polygons.len(), method, found })
        };
        add(EXACT, exact(polygons, heuristic))?;
        add(ROUNDED, rounded(polygons))
    };
    for Case { subject, size } in cases {
        let polygons = match subject {
            Subject::Builtin(scene) => scene.build(Some(size), args.seed),
            Subject::Worst(worst) => worst.scene(size),
            Subject::NoisySphere => noisy_sphere(size, args.seed),
        };
        each(subject.name(), subject.heuristic(), &polygons)?;
    }
    scenes.iter().try_for_each(|scene| each(scene.name(), Heuristic::Auto, scene))
}

/// A scene with a given size.
struct Case {
    subject: Subject,
    size: u32,
}

/// The scene that grows.
#[derive(Clone, Copy, PartialEq)]
enum Subject {
    Builtin(Builtin),
    Worst(Worst),
    /// A sphere with noise, in place of a scanned object.
    NoisySphere,
}

impl Subject {
    const ALL: [Self; 8] = [
        Self::Builtin(Builtin::Terrain),
        Self::Builtin(Builtin::City),
        Self::Builtin(Builtin::Sphere),
        Self::NoisySphere,
        Self::Builtin(Builtin::Random),
        Self::Worst(Worst::Walls),
        Self::Worst(Worst::Saddle),
        Self::Worst(Worst::Sheets),
    ];

    fn name(self) -> &'static str {
        match self {
            Self::Builtin(scene) => scene.name(),
            Self::Worst(worst) => worst.name(),
            Self::NoisySphere => "noisy sphere",
        }
    }

    /// Uses the planes of the walls alone; any plane between the two layers would avoid all splits.
    fn heuristic(self) -> Heuristic {
        if self == Self::Worst(Worst::Walls) { Heuristic::First } else { Heuristic::Auto }
    }

    /// The largest scene. Too large: fragments grow as n² or n³, and a build takes minutes.
    fn most(self) -> u32 {
        match self {
            Self::Builtin(Builtin::Random) => 3000,
            Self::Builtin(_) | Self::NoisySphere => u32::MAX,
            Self::Worst(Worst::Walls | Worst::Saddle) => 1000,
            Self::Worst(Worst::Sheets) => 100,
        }
    }
}

fn cases(quick: bool) -> Vec<Case> {
    let large: &[u32] =
        if quick { &[300, 1000, 3000] } else { &[300, 1000, 3000, 10_000, 30_000, 100_000] };
    let small: &[u32] = if quick { &[10, 20, 50] } else { &[10, 20, 50, 100, 300, 1000] };
    let mut cases = Vec::new();
    for subject in Subject::ALL {
        let sizes = if matches!(subject, Subject::Worst(_)) { small } else { large };
        let sizes = sizes.iter().filter(|&&size| size <= subject.most());
        cases.extend(sizes.map(|&size| Case { subject, size }));
    }
    cases
}

/// The exact tree of a scene.
fn exact(scene: &Scene, heuristic: Heuristic) -> Result<Size, String> {
    let options = BuildOptions::DEFAULT.with_max_fragments(MAX_FRAGMENTS).with_heuristic(heuristic);
    let build = || options.build(scene.polygons()).map_err(|error| error.to_string());
    let (tree, build) = timed(build)?;
    let order = time_order(|viewpoint, order| tree.back_to_front_into(viewpoint, order));
    let (fragments, depth, bytes) = (tree.len(), tree.stats().depth_max, tree.memory_usage());
    Ok(Size { fragments, depth, bytes, build, order })
}

/// The tree of rounded numbers.
fn rounded(scene: &Scene) -> Result<Size, String> {
    let build = || {
        let (faces, _) = Faces::new(scene.polygons(), None).map_err(|error| error.to_string())?;
        Tree::with_epsilon::<f64>(faces, EPSILON, MAX_FRAGMENTS)
            .ok_or_else(|| format!("more than {MAX_FRAGMENTS} fragments"))
    };
    let (tree, build) = timed(build)?;
    let order = time_order(|viewpoint, order| tree.back_to_front_into(viewpoint, order));
    let (fragments, depth) = (tree.len(), tree.depth());
    let bytes = tree.bytes() + tree.faces().memory_usage();
    Ok(Size { fragments, depth, bytes, build, order })
}

/// The result of a function, and its time in seconds.
fn timed<T>(build: impl Fn() -> Result<T, String>) -> Result<(T, f64), String> {
    let build = || {
        let start = Instant::now();
        build().map(|tree| (tree, start.elapsed().as_secs_f64()))
    };
    let (mut tree, mut seconds) = build()?;
    if seconds < SHORT {
        let again = build()?;
        seconds = seconds.min(again.1);
        tree = again.0;
    }
    Ok((tree, seconds))
}

/// The seconds that one order takes: the least time of five runs.
fn time_order(mut order: impl FnMut(Viewpoint, &mut Vec<u32>)) -> f64 {
    let mut list = Vec::new();
    let mut time = || {
        let start = Instant::now();
        order(Viewpoint::direction([1.0, 2.0, -3.0]), &mut list);
        std::hint::black_box(&list);
        start.elapsed().as_secs_f64()
    };
    (0..5).map(|_| time()).fold(f64::INFINITY, f64::min)
}
