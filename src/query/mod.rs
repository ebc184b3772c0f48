//! Questions to a finished tree: where a point is, and what a ray meets.
//!
//! | file | decides |
//! |---|---|
//! | `probe` | how a ray is prepared, in floats and in integers; which of two places comes first |
//! | `walk` | which parts of a tree a ray may meet, and in which order they are looked at; the same by bounding boxes |
//! | `chord` | where a ray meets a fragment: exactly |
//! | `filter` | the same in floats, where they are certain |
//! | `hits` | what is one hit, which comes next, and whether there is any |
//! | `locate` | in which leaf a point is, and whose planes it is on |
//! | `region` | which fragments have points in a region |

mod chord;
mod filter;
mod hits;
mod locate;
mod probe;
mod region;
mod walk;

pub use chord::Spot;
pub use hits::{Hit, Hits};
pub use locate::Location;
pub use region::FragmentsIn;
