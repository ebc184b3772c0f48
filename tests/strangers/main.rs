//! Trees of scenes of 500 to 5 000 polygons, judged by a stranger: it knows the polygons as they
//! were given and what the library promises, and decides in big integers of its own.
//!
//! Rays are shot at the *source polygons*, which gives what is hit and in what depth, exactly. The
//! fragment at a hit is found by its rounded vertices, and where these cannot tell, by the
//! cells that [`nodes`](binspace::BspTree::nodes) describes. Then every pair must come far
//! before near, pairs in one plane in input order, and every hit must find its polygon covered once.
//!
//! For longer runs, over seed after seed and scenes of up to 5 000 polygons, name the seconds; a
//! table of what was judged goes to standard output:
//!
//! ```sh
//! BINSPACE_LONG=60 cargo test --release --test strangers for_long -- --nocapture
//! ```

mod bodies;
mod cells;
mod copies;
mod court;
mod drawing;
mod exact;
mod heaps;
mod kinds;
mod layers;
mod long;
mod order;
mod ray;
mod scene;
mod sheaves;
mod slivers;
#[path = "../support/mod.rs"]
mod support;
mod trial;
mod view;
mod whole;
