//! The remainder of a large scene after culling.

use std::time::Instant;

use binspace::raster::Rays;
use binspace::{BspTree, scene};
use binspace_evidence::culling::{Left, measure, over_the_city};

use binspace_cli::failure::Failure;
use binspace_cli::progress::Progress;

/// The number of polygons of the city: as in a course, and for `quick`. The smaller city also reaches far
/// beyond the eye.
const POLYGONS: [u32; 2] = [2_600_000, 100_000];
const SIZE: [u32; 2] = [320, 240];

/// The steps of culling for one view of a city.
pub(super) struct City {
    pub(super) polygons: usize,
    pub(super) fragments: usize,
    pub(super) build: f64,
    pub(super) steps: Vec<Left>,
}

/// Builds the city and measures it.
pub(super) fn run(is_quick: bool) -> Result<City, Failure> {
    let progress = Progress::steps("culling: city", 1);
    let scene = scene::city(POLYGONS[usize::from(is_quick)], 1);
    let begin = Instant::now();
    let tree = BspTree::build(scene.polygons());
    let tree = tree.map_err(|error| Failure::about(scene.name(), error))?;
    let build = begin.elapsed().as_secs_f64();
    let view = |error| Failure::about("a view of the city", error);
    let camera = over_the_city(SIZE).map_err(view)?;
    let rays = Rays::new(&camera, tree.faces()).map_err(view)?;
    let steps = measure(&tree, &camera, &rays);
    progress.step();
    Ok(City { polygons: scene.len(), fragments: tree.len(), build, steps })
}
