//! Pictures of faces, exact in every pixel, and their comparison.
//!
//! A camera becomes [`Rays`]: one integer ray per pixel. Signs of integer polynomials decide whether a ray
//! meets a piece of a face, and which of two faces it meets first. So a painter and a depth buffer that are
//! both right make the *same* picture; if the pictures differ, one of the two programs is wrong. This module
//! judges orders, so it does not use how an order was computed.
//!
//! This module shares no arithmetic with the builder. Planes are computed from their defining corners in
//! separate integers, so a mistake in the builder's arithmetic shows as wrong pixels and is not repeated
//! here. The module and the builder share only the input: the faces' corners on the lattice; the corners that
//! define a face's plane, and the axis along which the other corners are moved to that plane; the eye on the
//! lattice; and the labels that name the lines of a piece. Tests of the preparation compare this input with
//! the given polygons.

mod coverage;
mod exact;
mod judge;
mod line;
mod painter;
mod rays;
#[cfg(test)]
pub(crate) mod tests;

pub use crate::exact::Faces;
pub use judge::{Comparison, DepthImage, Verdict, compare, zbuffer};
pub(crate) use judge::{Layers, compare_by, is_open, zbuffer_layers};
#[cfg(feature = "drawing")]
pub(crate) use line::{Sheet, edge, normal_of};
pub use painter::{Image, NONE, blend, brightness, colour_of, depth_map, difference, picture};
pub(crate) use painter::{covers, for_each_shaded};
#[cfg(feature = "drawing")]
pub(crate) use rays::RayOrigin;
pub use rays::Rays;
pub(crate) use rays::Window;

/// Items for painters of other orders, which `crates/evidence` compares with the tree's order. These painters
/// name faces on the lattice, which are not part of the public interface.
#[doc(hidden)]
pub use self::{
    coverage::{Outline, Piece},
    painter::{Painter, for_each_run},
};
