//! What the fuzz targets do with their bytes. Each panics if what it finds is not what its oracle
//! says.

#[cfg(feature = "obj")]
pub(crate) mod obj;
pub(crate) mod split;
pub(crate) mod tree;
