//! Compares the library with its peers, the crates that users would take instead, on the same work in the
//! same run. Prints tables of figures.md.
//!
//! ```sh
//! cargo bench -p binspace-benches --bench peers                          # all sections
//! cargo bench -p binspace-benches --bench peers -- order plane-split     # some of them
//! ```

#![allow(missing_docs, reason = "a program")]
#![allow(clippy::print_stdout, clippy::print_stderr, reason = "prints measurements")]

mod build;
mod clipping;
mod culling;
mod drawings;
mod exactness;
mod frames;
mod mesh;
mod order;
mod overlay;
mod plane_split;
mod rays;
mod same;
mod saved;
mod transparency;

/// A section's name on the command line, and its function.
type Section = (&'static str, fn());

const SECTIONS: &[Section] = &[
    ("order", order::run),
    ("transparency", transparency::run),
    ("mesh", mesh::run),
    ("overlay", overlay::run),
    ("same-order", same::run),
    ("build", build::run),
    ("plane-split", plane_split::run),
    ("frames", frames::run),
    ("clipping", clipping::run),
    ("culling", culling::run),
    ("drawings", drawings::run),
    ("gl2ps", drawings::gl2ps::run),
    ("exactness", exactness::run),
    ("saved", saved::run),
    ("rays", rays::run),
];

fn main() {
    support::print_head("Measured against peers", "cargo bench -p binspace-benches --bench peers");
    for (_, run) in SECTIONS.iter().filter(|(name, _)| support::wanted(name)) {
        run();
    }
}
