//! Error measures: what a [method](crate::method) gets wrong, against exact truth.

mod area;
mod fill;
mod picture;

pub use area::{AreaError, area_error};
pub use fill::{FillError, Filled};
pub use picture::{PictureError, extent};
