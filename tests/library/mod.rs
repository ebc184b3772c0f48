//! The library's parts, each compared with a separate oracle. One program: it links once.

mod bent_counts;
mod bounds;
mod cancel;
mod cuts;
mod dropped;
mod duplicates;
mod error_kinds;
mod eye;
mod eyes;
mod faces;
mod facing;
mod facing_bounds;
mod far;
mod fuzz_regressions;
mod input_order;
mod iterators;
mod modules;
mod narrow;
mod odd_viewpoints;
mod other_trees;
#[cfg(target_os = "linux")]
mod out_of_memory;
mod panicking_callback;
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
mod together;
mod tolerance;
mod vertex_errors;
