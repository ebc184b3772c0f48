//! What rays hit, what blocks a line of sight, and where points are, against exact rationals: every ray
//! against every polygon.

mod cases;
mod hard;
mod large;
mod locate;
mod real;
#[path = "../support/mod.rs"]
mod support;
