//! What rays hit, what blocks a line of sight, and where points are, against exact rationals: every ray
//! against every polygon.

mod beginnings;
mod cases;
mod crowded;
mod hard;
mod large;
mod limits;
mod locate;
mod names;
mod real_scenes;
mod region;
mod scaled_planes;
mod slivers;
mod winding;
