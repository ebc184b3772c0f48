//! Trees of scenes of 500 to 5 000 polygons, judged by a stranger: it knows the polygons as they
//! were given and what the library promises, and decides in big integers of its own.
//!
//! Rays are shot at the *source polygons*, which gives what is hit and in what depth, exactly. The
//! fragment at a hit is found by its rounded vertices, and where these cannot tell, by the
//! cells that [`nodes`](binspace::BspTree::nodes) describes. Then every pair must come far
//! before near, pairs in one plane in input order, and every hit must find its polygon covered once.
//!
//! A longer run, over seed after seed and scenes of up to 5 000 polygons, writes a table of what was
//! judged to standard output:
//!
//! ```sh
//! BINSPACE_EFFORT=10 cargo test --release large::long -- --ignored --nocapture
//! ```

mod all_scenes;
mod cells;
mod copies;
mod drawing;
mod exact;
mod heaps;
mod layers;
mod long;
mod order;
mod planes_through_lines;
mod ray;
mod round_bodies;
mod scene;
mod slivers;
mod trees_by_rays;
mod trial;
mod view;
