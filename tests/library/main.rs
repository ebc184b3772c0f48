//! The library's parts, each against an oracle of its own. One program: it links once.

mod bounds;
mod cancel;
mod cuts;
mod dropped;
mod duplicates;
mod eye;
mod eyes;
mod faces;
mod facing;
mod facing_bounds;
mod far;
mod fuzz_regressions;
mod input_order;
mod many_parts;
mod parts;
mod peeled;
mod precision;
mod predicates;
mod preparation;
mod scenes;
mod send_sync;
mod size_hints;
mod slivers;
mod small_frames;
#[path = "../support/mod.rs"]
mod support;
mod tolerance;
mod world;
