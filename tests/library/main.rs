//! The library's parts, each against an oracle of its own. One program: it links once.

mod bounds;
mod cancel;
mod cuts;
mod dropped;
mod duplicates;
mod eye;
mod faces;
mod facing;
mod facing_bounds;
mod fuzz_regressions;
mod many_parts;
mod narrow;
mod parts;
mod peeled;
mod precision;
mod predicates;
mod preparation;
mod scenes;
mod send_sync;
mod size_hints;
mod small_frames;
#[path = "../support/mod.rs"]
mod support;
mod tolerance;
mod world;
