//! The test kit: exact oracles for the library, scenes that are hard to decide, random choices from a seed,
//! and the bodies of the fuzz targets. Tests, benches and fuzzing share it.

pub mod as_given;
pub mod browser;
pub mod cell_cover;
pub mod cell_orders;
pub mod checks;
pub mod cut_walk;
pub mod decode;
pub mod dice;
pub mod divided;
pub mod effort;
pub mod fill;
pub mod fragment_pixels;
pub mod hard;
pub mod hinted;
pub mod hits;
pub mod judge;
pub mod layered;
pub mod model;
pub mod orders;
pub mod pages;
pub mod prelude;
pub mod rational;
pub mod rays;
pub mod real_scenes;
pub mod saved;
pub mod scenes;
pub mod shapes;
pub mod shots;
pub mod slivers;
pub mod snapshot;
pub mod tally;
pub mod targets;
pub mod vector;
pub mod views;
