//! Hits of rays, occlusion of lines of sight, and leaves of points, compared with exact rationals: every
//! ray with every polygon.

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
