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
//! It works in floats: openings thinner than 10⁻⁹ of the scene count as closed.

mod cells;
mod outline;
mod sight;
#[cfg(test)]
mod tests;

pub use cells::Cells;
pub use sight::Seen;
