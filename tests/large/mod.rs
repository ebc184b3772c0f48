//! Trees of scenes of 500 to 5 000 polygons, judged by `testkit::as_given`.
//!
//! A longer run, over seed after seed and scenes of up to 5 000 polygons, writes a table of its counts to
//! standard output:
//!
//! ```sh
//! BINSPACE_EFFORT=10 cargo test --release large::long -- --ignored --nocapture
//! ```

mod all_scenes;
mod copies;
mod heaps;
mod layers;
mod long;
mod order;
mod planes_through_lines;
mod round_bodies;
mod slivers;
mod trial;
