//! Portals and potentially visible sets: what may be seen in closed interiors, by their openings
//! alone.
//!
//! | file | has |
//! |---|---|
//! | `outline` | convex polygons in floats |
//! | `cells` | the cells of a tree, and the portals between them |
//! | `sight` | what is seen through portals, from an eye or from a cell |
//!
//! Nothing that can be seen is left out; what is kept in vain is counted against exact pictures.
//!
//! It works in floats, and errs to one side: what bounds a view is moved outwards by 10⁻⁷ of the scene,
//! more than all roundings can move it (`SLACK` in `sight` has the sum), and an opening that is so near
//! that roundings would count for more does not narrow the view at all. One thing can be left out: what is
//! seen only through openings thinner than 10⁻⁹ of the scene, which count as closed, and what of a polygon
//! is thinner than that.

mod cells;
mod outline;
mod sight;
#[cfg(test)]
mod tests;

pub use cells::Cells;
pub use sight::Seen;
