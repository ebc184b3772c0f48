//! One view as a vector picture.
//!
//! A tree cuts polygons for all viewpoints; one picture needs almost none of the cuts. A
//! [`VisibilityMap`] says which polygon shows where, exactly. From it a [`Drawing`] is made: one filled
//! path for each polygon that shows, in an order to paint them in.
//!
//! | file | |
//! |---|---|
//! | `frame` | lines of the picture in integers |
//! | `lines` | all lines of a picture, by what made them |
//! | `cell` | convex cells, and how a line cuts them |
//! | `stock` | the pieces that may show, by their lines |
//! | `tile` | what is visible, tile by tile |
//! | `map` | the visibility map |
//! | `above` | which polygon shows above which |
//! | `order` | an order of them, and who is in cycles |
//! | `outline` | outlines of areas in parts |
//! | `opaque` | the drawing |
//! | `edges` | visible and hidden runs of edges |
//! | `pen` | segments joined to lines, in an order for a pen |
//! | `near` | the nearest of the ends that are left |

mod above;
mod cell;
mod edges;
mod frame;
mod lines;
mod map;
mod near;
mod opaque;
mod order;
mod outline;
mod pen;
mod stock;
mod tile;

pub use edges::{EdgeKind, EdgeRun};
pub use map::{MapCell, Shown, VisibilityMap};
pub use opaque::{Drawing, Path};
pub use pen::{Polyline, polylines};
