//! Portals and potentially visible sets: the polygons that may be seen in closed interiors, by their openings
//! alone.
//!
//! | file | contains |
//! |---|---|
//! | `outline` | convex polygons in floats |
//! | `cells` | the cells of a tree, and the portals between them |
//! | `sight` | visibility through portals, from an eye or from a cell |
//!
//! No visible polygon is left out; polygons kept without need are counted against exact pictures.
//!
//! The computation is in floats, and its errors are conservative. The planes that bound a view are moved
//! outwards by 10⁻⁷ of the scene, more than all roundings can move them (`SLACK` in `sight` has the sum).
//! Near a very close opening, roundings could move a plane by more, so such an opening does not narrow the
//! view. Only two kinds of polygons can be left out: polygons seen only through openings thinner than 10⁻⁹ of
//! the scene, which count as closed, and parts of polygons thinner than 10⁻⁹ of the scene.

mod cells;
mod outline;
mod sight;
#[cfg(test)]
mod tests;

pub use cells::Cells;
pub use sight::Seen;
