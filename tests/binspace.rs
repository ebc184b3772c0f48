//! The tests of the library, in one program that is linked once. README.md describes them.

mod cells;
mod drawing;
mod heuristics;
mod large;
mod layers;
mod library;
mod mesh;
mod obj;
mod overlay;
mod query;
mod saved;
mod tree;
mod walk;
