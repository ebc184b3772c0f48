//! Questions to a finished tree: where a point is, what a ray meets, and what is in a region.

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
