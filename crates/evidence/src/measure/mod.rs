//! Error measures: what a [method](crate::method) gets wrong, against exact truth.

mod area;
mod picture;

pub use area::{AreaError, area_error};
pub use picture::{PictureError, extent};
