//! The bodies of the fuzz targets. Each panics if the library's result contradicts its oracle.

pub mod cells;
mod cover;
pub mod drawing;
pub mod faces;
pub mod large;
pub mod obj;
pub mod query;
pub mod saved;
pub mod split;
pub mod tree;
