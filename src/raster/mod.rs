//! Pictures of faces, exact in every pixel, and their comparison.
//!
//! A camera becomes [`Rays`]: one integer ray per pixel. Whether a ray meets a piece of a face, and
//! which of two faces it meets first, are signs of integer polynomials. So a painter and a depth
//! buffer that are both right make the *same* picture; if they differ, one of them is wrong. This
//! module judges orders, so it does not know how an order was found.
//!
//! It shares no arithmetic with the builder either. It computes planes from the corners that define
//! them, in integers of its own, so that a mistake in the builder's arithmetic shows as wrong
//! pixels and is not repeated here. It takes over the input: the faces' corners on the lattice;
//! which of them define a face's plane, and along which axis the others are moved to it; the eye on
//! the lattice; and the labels that name the lines of a piece. Tests of the preparation compare
//! these with the polygons as given.

mod bounds;
mod compare_pictures;
mod coverage;
mod digits;
mod exact;
mod line;
mod painter;
mod picture;
mod rays;
#[cfg(test)]
pub(crate) mod tests;
mod zbuffer;

pub use crate::exact::Faces;
#[cfg(feature = "drawing")]
pub(crate) use bounds::VERTEX_ERROR;
pub use compare_pictures::{Comparison, DepthError, Verdict, compare, depth_error};
pub(crate) use compare_pictures::{compare_by, is_open};
pub(crate) use coverage::Mask;
#[cfg(feature = "drawing")]
pub(crate) use line::edge;
#[cfg(feature = "drawing")]
pub(crate) use line::{Sheet, normal_of};
pub use painter::{Image, NONE};
pub(crate) use painter::{Layers, covers};
pub(crate) use picture::for_each_shaded;
pub use picture::{blend, brightness, colour_of, depth_map, difference, picture};
#[cfg(feature = "drawing")]
pub(crate) use rays::RayOrigin;
pub use rays::Rays;
pub(crate) use zbuffer::zbuffer_layers;
pub use zbuffer::{DepthImage, zbuffer};

/// For painters of other orders, which `crates/evidence` compares with the tree's. What they draw is
/// named by faces on the lattice, which users do not see.
#[doc(hidden)]
pub use self::{
    coverage::{Outline, Piece},
    painter::{Order, Painter, for_each_run},
};
