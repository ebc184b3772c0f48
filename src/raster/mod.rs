//! Pictures of faces, exact in every pixel, and their comparison.
//!
//! A *face* is an input polygon that is convex and planar, or a triangle of another input polygon; see
//! [`Faces`]. A camera becomes [`Rays`]: one integer ray per pixel. Exact integer arithmetic decides whether
//! a ray meets a part of a face, and which of two faces it meets first. So a correct painter and a correct
//! depth buffer make the *same* picture; if the pictures differ, one of the two is wrong. This module judges
//! orders, so it ignores how an order was computed.
//!
//! This module shares no arithmetic with the builder of trees. Planes are computed from the faces' corners
//! by separate code, so a mistake in the builder's arithmetic is not repeated here, and becomes visible as
//! wrong pixels. The module and the builder share only this input:
//!
//! - the faces' corners, rounded to the [grid](crate::Grid);
//! - for each face, the three corners that define its plane, and the axis along which its other corners are
//!   moved to that plane;
//! - the eye, rounded to the grid;
//! - for each side of a [fragment](crate::Fragment), the number of the edge or plane that made this side.

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
pub(crate) use painter::for_each_shaded;
pub use painter::{Image, NONE, blend, brightness, colour_of, depth_map, difference, picture};
pub use rays::Rays;
pub(crate) use rays::Window;
#[cfg(feature = "drawing")]
pub(crate) use rays::{Projected, RayOrigin};

/// Items for painters of other orders, which `crates/evidence` compares with the tree's order. These painters
/// name faces on the lattice, which are not part of the public interface.
#[doc(hidden)]
pub use self::{
    coverage::{Outline, Piece},
    painter::{Painter, for_each_run},
};
