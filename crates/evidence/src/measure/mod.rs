//! Error measures: the errors of a [method](crate::method), against exact truth.

mod area;
mod fill;
mod picture;

pub use area::{AreaError, area_error};
pub use fill::{FillError, Filled};
pub use picture::{PictureError, extent};
