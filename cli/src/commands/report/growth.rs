//! How trees grow with the number of polygons.

use std::time::Instant;

use binspace::internals::{Exact, Faces, Kernel};
use binspace::scene::Builtin;
use binspace::{BuildOptions, Viewpoint};
use binspace_evidence::{Float, KernelTree};

use super::figures::EXACT;
use crate::args::ReportArgs;
use crate::failure::Failure;
use crate::progress::Progress;

/// The rounded kernel to compare with.
const ROUNDED: &str = "bsp f64 1e-6";
/// The most fragments; more take minutes.
const MAX_FRAGMENTS: usize = 1 << 22;
/// What is built in less is built twice, and the faster one counts.
const SHORT: f64 = 1.0;

/// A tree of one size.
pub(super) struct Growth {
    pub(super) scene: Builtin,
    pub(super) polygons: usize,
    pub(super) method: &'static str,
    /// The figures, or why there are none.
    pub(super) found: Result<Size, String>,
}

/// What it takes.
pub(super) struct Size {
    pub(super) fragments: usize,
    pub(super) depth: usize,
    pub(super) bytes: usize,
    pub(super) build: f64,
    /// Seconds for an order.
    pub(super) order: f64,
}

/// Measures growth, and hands over one tree after another.
pub(super) fn run(
    args: &ReportArgs,
    mut add: impl FnMut(Growth) -> Result<(), Failure>,
) -> Result<(), Failure> {
    let cases = cases(args.quick);
    let progress = Progress::steps("growth: tree", 2 * cases.len() as u64);
    for (scene, size) in cases {
        let polygons = scene.build(Some(size), args.seed);
        let mut each = |method, found| {
            progress.step();
            add(Growth { scene, polygons: polygons.len(), method, found })
        };
        each(EXACT, measure(Exact, &polygons))?;
        each(ROUNDED, measure(Float::<f64>::new(1e-6), &polygons))?;
    }
    Ok(())
}

fn cases(quick: bool) -> Vec<(Builtin, u32)> {
    let sizes: &[u32] =
        if quick { &[300, 1000, 3000] } else { &[300, 1000, 3000, 10_000, 30_000, 100_000] };
    let mut cases = Vec::new();
    for scene in [Builtin::Terrain, Builtin::City, Builtin::Sphere, Builtin::Random] {
        // Of triangles that all cross there are n² pieces in the end, or more.
        let most = if scene == Builtin::Random { 3000 } else { u32::MAX };
        cases.extend(sizes.iter().filter(|&&size| size <= most).map(|&size| (scene, size)));
    }
    cases
}

fn measure<K: Kernel>(kernel: K, scene: &binspace::scene::Scene) -> Result<Size, String> {
    let options = BuildOptions::DEFAULT.with_max_fragments(MAX_FRAGMENTS);
    let build = || {
        let start = Instant::now();
        let faces = Faces::new(scene.polygons(), None).map(|(faces, _)| faces);
        let tree = faces.and_then(|faces| KernelTree::build(kernel, &options, faces));
        tree.map(|tree| (tree, start.elapsed().as_secs_f64())).map_err(|error| error.to_string())
    };
    let (mut tree, mut seconds) = build()?;
    if seconds < SHORT {
        let again = build()?;
        seconds = seconds.min(again.1);
        tree = again.0;
    }
    let mut order = Vec::new();
    let mut time = || {
        let start = Instant::now();
        tree.back_to_front_into(Viewpoint::direction([1.0, 2.0, -3.0]), &mut order);
        std::hint::black_box(&order);
        start.elapsed().as_secs_f64()
    };
    let times: Vec<f64> = (0..5).map(|_| time()).collect();
    let order = times.into_iter().fold(f64::INFINITY, f64::min);
    let (fragments, depth) = (tree.len(), tree.depth());
    let bytes = tree.bytes() + tree.faces().bytes();
    Ok(Size { fragments, depth, bytes, build: seconds, order })
}
