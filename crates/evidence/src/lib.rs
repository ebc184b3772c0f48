//! Evidence about binspace: other methods to decide visibility, trees of rounded
//! numbers, families of hard scenes, and measures of error against exact truth. Users of the
//! library do not compile this crate.

mod accuracy;
pub mod antialias;
pub mod culling;
pub mod curved;
mod facing;
mod family;
pub mod fighting;
mod hiding;
pub mod interior;
pub mod layers;
pub mod measure;
pub mod method;
mod noisy;
pub mod overdraw;
pub mod panes;
pub mod patches;
mod place;
pub mod plain;
pub mod portals;
pub mod rectangles;
mod residue;
pub mod room;
mod rounded;
pub mod shadows;
pub mod translucent;
mod tree;
mod worked;
mod worst;

pub use accuracy::{Accuracy, accuracy};
pub use facing::Facing;
pub use family::{Family, FamilyError};
pub use hiding::{Hiding, overlaps_in_depth};
pub use noisy::noisy_sphere;
pub use rounded::{Precision, RoundedPiece, RoundedPlane};
pub use tree::Tree;
pub use worked::{
    EIGHT_ORDER, EYE_OF_EIGHT, GRID_OF_SIX, eight, eye_on_eight, letters, six_by_six,
    six_by_six_camera,
};
pub use worst::Worst;
