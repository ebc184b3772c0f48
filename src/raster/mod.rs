//! Pictures of faces, exact in every pixel, and what tells two of them apart.
//!
//! A camera becomes [`Rays`]: one integer ray a pixel. Whether a ray meets a piece of a face, and
//! which of two faces it meets first, are signs of integer polynomials, so a painter and a depth
//! buffer that are both right make the *same* picture, and where they differ one of them is wrong.
//! Nothing here knows how an order was found: this module judges those that find one.

mod bounds;
mod canvas;
mod compare;
mod coverage;
mod depth_error;
mod image;
mod line;
mod painter;
mod picture;
mod plane;
mod rays;
mod runs;
#[cfg(test)]
mod tests;
mod zbuffer;

pub use canvas::Canvas;
pub use compare::{Comparison, Verdict, compare, is_open};
pub use depth_error::{DepthError, depth_error};
pub use image::{Image, NONE};
pub use painter::{Order, Outline, Painter, Piece, covers, for_each_run, paint};
pub use picture::{brightness, colour_of, depth_map, difference, picture};
pub use rays::Rays;
pub use zbuffer::{DepthImage, zbuffer};
