//! The bodies of the fuzz targets. Each panics if the library's result contradicts its oracle.

pub(crate) mod cells;
mod cover;
#[cfg(feature = "drawing")]
pub(crate) mod drawing;
pub(crate) mod faces;
pub(crate) mod large;
#[cfg(feature = "obj")]
pub(crate) mod obj;
pub(crate) mod query;
pub(crate) mod saved;
pub(crate) mod split;
pub(crate) mod tree;
