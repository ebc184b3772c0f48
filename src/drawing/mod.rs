//! One view as a vector picture.
//!
//! A tree cuts polygons for all viewpoints; one picture needs almost none of the cuts. A
//! [`VisibilityMap`] says which polygon shows where, exactly. From it a [`Drawing`] is made: one filled
//! path for each polygon that shows, in an order to paint them in. [`Drawing::translucent`] hides nothing
//! and needs no map.
//!
//! | file | |
//! |---|---|
//! | `frame` | lines of the picture in integers |
//! | `table` | tables by numbers, with a quick hash |
//! | `half` | lines by their numbers, each with a side |
//! | `lines` | all lines of a picture, by what made them |
//! | `region` | boxes in the picture |
//! | `cell` | convex cells, and how a line cuts them |
//! | `stock` | the pieces that may show |
//! | `rims` | the lines that bound them, made when they are asked for |
//! | `tile` | tiles of the picture |
//! | `halving` | the picture halved until its parts are simple, on all threads |
//! | `narrow` | the pieces that may show in a tile |
//! | `visible` | what is visible, tile by tile |
//! | `map` | the visibility map |
//! | `pairs` | pairs of what is drawn before what |
//! | `above` | which polygon shows above which |
//! | `order` | an order of them, and who is in cycles |
//! | `outline` | outlines of areas in parts |
//! | `opaque` | the drawing |
//! | `overlaps` | which pieces overlap, nothing hidden |
//! | `join` | pieces joined while an order is left |
//! | `translucent` | the drawing in which nothing is hidden |
//! | `reaches` | pieces in a part of the picture |
//! | `edges` | visible and hidden runs of edges |
//! | `crossings` | lines in which polygons go through one another |
//! | `sight` | segments and points of the scene as the picture shows them |
//! | `overlaid` | what shows of an overlay's lines and points |
//! | `passes` | where segments pass in front of pieces or behind them |
//! | `in_front` | how many polygons lie in front of lines |
//! | `between` | lines and points between what is painted |
//! | `steps` | all that a drawing paints |
//! | `pen` | segments joined to lines, in an order for a pen |
//! | `near` | the nearest of the ends that are left |

mod above;
mod between;
mod cell;
mod crossings;
mod edges;
mod frame;
mod half;
mod halving;
mod in_front;
mod join;
mod lines;
mod map;
mod narrow;
mod near;
mod opaque;
mod order;
mod outline;
mod overlaid;
mod overlaps;
mod pairs;
mod passes;
mod pen;
mod reaches;
mod region;
mod rims;
mod sight;
mod steps;
mod stock;
mod table;
mod tile;
mod translucent;
mod visible;

pub use edges::{EdgeKind, EdgeRun};
pub use map::{MapCell, Shown, VisibilityMap};
pub use opaque::{Drawing, Path};
pub use overlaid::{LineRun, MarkerView};
pub use pen::{Polyline, polylines};
pub use steps::Step;
