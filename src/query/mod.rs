//! Queries of a finished tree: the place of a point, the hits of a ray, the fragments in a region.

mod hits;
mod locate;
mod ray;
mod region;
mod walk;
mod winding;

pub use hits::Hit;
pub(crate) use hits::{Pieces, Targets};
pub use locate::Location;
pub use ray::Spot;
