//! One view as a vector picture.
//!
//! A tree cuts polygons so that they have an order from every viewpoint. A picture from one viewpoint needs
//! almost no cuts. [`BspTree::visibility`](crate::BspTree::visibility) computes a [`VisibilityMap`]: the
//! exact visible part of each polygon. The map returns
//!
//! | call | result |
//! |---|---|
//! | [`VisibilityMap::drawing`] | one filled path for each visible polygon, in painting order |
//! | [`VisibilityMap::polygons`] | the visible polygons, the area of each, and a point of each |
//! | [`VisibilityMap::edges`], [`crossings`](VisibilityMap::crossings) | [runs](EdgeRun) of edges, and of the lines in which polygons intersect; a run is a part that is entirely visible or entirely hidden |
//! | [`VisibilityMap::lines`], [`markers`](VisibilityMap::markers) | the visible parts of the lines and points of an [overlay](crate::overlay::Overlay) |
//! | [`VisibilityMap::regions`] | the parts of the picture in which the same translucent polygons lie one behind the other |
//! | [`polylines`] | runs joined into few long polylines, sorted to shorten pen travel |
//!
//! A [`VectorPicture`] combines these results with colours and line styles of your choice. The picture can be
//! written as SVG, TikZ and, with the feature `pdf`, PDF.
//!
//! [`ViewOptions::opacities`] makes polygons translucent. If all polygons are translucent,
//! [`Drawing::translucent`] draws them without a map.
//!
//! ```
//! use binspace::drawing::{VectorPicture, ViewOptions};
//! use binspace::view::Camera;
//! use binspace::{BspTree, glam::DVec3};
//!
//! // A square, and half of it behind another one.
//! let square = |x: f64, y: f64| [[x, y, 0.0], [x + 2.0, y, 0.0], [x + 2.0, y, 2.0], [x, y, 2.0]];
//! let tree = BspTree::build([square(0.0, 0.0), square(1.0, -1.0)])?;
//! let (eye, target) = (DVec3::new(1.5, -9.0, 1.0), DVec3::new(1.5, 0.0, 1.0));
//! let camera = Camera::perspective(eye, target, DVec3::Z, 0.6, [320, 240])?;
//! let map = tree.visibility(&camera, &ViewOptions::default())?;
//! assert_eq!(map.polygons().count(), 2);
//! let drawing = map.drawing()?;
//! // Both squares are drawn whole. The partly hidden square comes first.
//! assert!(drawing.paths().map(|path| path.polygon()).eq([0, 1]));
//! let mut picture = VectorPicture::new(drawing.size());
//! picture.add_drawing(&drawing, |polygon| [[200, 80, 40], [40, 80, 200]][polygon]);
//! println!("{}", picture.to_svg());
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod adjacency;
mod batching;
mod cell;
mod crossings;
mod edges;
mod graph;
mod lines;
mod map;
mod overlaid;
mod pairs;
mod passes;
mod paths;
#[cfg(feature = "pdf")]
mod pdf;
mod pen;
mod picture;
mod primitives;
mod quadtree;
mod regions;
mod segments;
mod sheets;
mod svg;
mod tikz;
mod translucent;
mod trapping;

pub use edges::{EdgeKind, EdgeRun};
pub use map::{Hidden, MapCell, ViewOptions, VisibilityMap, VisiblePolygon};
pub use overlaid::{LineRun, MarkerView};
pub use paths::{DisplayItem, Drawing, Path};
pub use pen::{Polyline, polylines};
pub use picture::{Paint, Stroke, VectorPicture};
pub use regions::Region;
