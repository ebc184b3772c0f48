//! One view as a vector picture.
//!
//! A tree cuts polygons for all viewpoints; one picture needs almost none of the cuts. A
//! [`VisibilityMap`] says which polygon shows where, exactly, and answers everything else from that:
//!
//! | asked for | |
//! |---|---|
//! | [`VisibilityMap::drawing`] | one filled path for each polygon that shows, in an order to paint them in |
//! | [`VisibilityMap::polygons`] | which polygons show, how much of each, and where |
//! | [`VisibilityMap::edges`], [`crossings`](VisibilityMap::crossings) | visible and hidden runs of edges, and of lines in which polygons go through one another |
//! | [`VisibilityMap::lines`], [`markers`](VisibilityMap::markers) | what shows of an overlay's lines and points |
//! | [`VisibilityMap::regions`] | where the same translucent polygons show, one behind the other |
//! | [`polylines`] | runs joined to few long lines, in an order for a pen |
//!
//! Polygons may be translucent: [`VisibilityMap::with_opacities`] knows what shows through, and
//! [`Drawing::translucent`] hides nothing and needs no map.
//!
//! ```
//! use binspace::drawing::VisibilityMap;
//! use binspace::raster::Rays;
//! use binspace::view::Camera;
//! use binspace::{BspTree, glam::DVec3};
//!
//! // A square, and half of it behind another one.
//! let square = |x: f64, y: f64| [[x, y, 0.0], [x + 2.0, y, 0.0], [x + 2.0, y, 2.0], [x, y, 2.0]];
//! let tree = BspTree::build([square(0.0, 0.0), square(1.0, -1.0)])?;
//! let (eye, target) = (DVec3::new(1.5, -9.0, 1.0), DVec3::new(1.5, 0.0, 1.0));
//! let camera = Camera::perspective(eye, target, DVec3::Z, 0.6, [320, 240])?;
//! let rays = Rays::new(&camera, tree.faces())?;
//!
//! let map = VisibilityMap::of(&tree, rays)?;
//! assert_eq!(map.polygons().count(), 2);
//! let drawing = map.drawing()?;
//! // Both are whole, and the hidden one comes first.
//! assert!(drawing.paths().map(|path| path.polygon()).eq([0, 1]));
//! for path in drawing.paths() {
//!     // The outlines of one path are filled together: some are holes.
//!     let outline = |o: &[[f64; 2]]| o.iter().map(|[x, y]| format!("{x:.2},{y:.2} ")).collect();
//!     let outlines: Vec<String> = path.outlines().map(outline).collect();
//!     println!(r#"<path d="M{}Z"/>"#, outlines.join("ZM"));
//! }
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

// The files:
//
// | file | |
// |---|---|
// | `frame` | lines of the picture in integers |
// | `table` | tables by numbers, with a quick hash |
// | `half` | lines by their numbers, each with a side |
// | `rounded` | lines in floats |
// | `twofold` | the same in pairs of floats |
// | `exact_lines` | on which side of a line two others meet, where floats cannot tell |
// | `feet` | lines found by where they are |
// | `key` | what made a line |
// | `lines` | all lines of a picture, by what made them |
// | `rect` | boxes in the picture |
// | `cell` | convex cells, and how a line cuts them |
// | `near_vertices` | vertices of fragments, nearly |
// | `stock` | the pieces that may show |
// | `rims` | the lines that bound them, made when they are asked for |
// | `tile` | tiles of the picture |
// | `reporter` | progress and cancellation |
// | `halving` | the picture halved until its parts are simple, on all threads |
// | `narrow` | the pieces that may show in a tile |
// | `visible` | what is visible, tile by tile |
// | `map` | the visibility map |
// | `pairs` | pairs of what is drawn before what |
// | `above` | which polygon shows above which |
// | `order` | an order of them, and who is in cycles |
// | `divided` | tiles in parts that show the same items |
// | `regions` | where the same polygons show, one behind the other |
// | `outline` | outlines of areas in parts |
// | `paths` | drawings: filled outlines in an order |
// | `opaque` | drawings of opaque polygons |
// | `overlaps` | which pieces overlap, nothing hidden |
// | `join` | pieces joined while an order is left |
// | `parts` | parts of polygons that are painted at once |
// | `translucent` | drawings of translucent polygons |
// | `reaches` | pieces in a part of the picture |
// | `edge_run` | runs of edges and crossings |
// | `edges` | visible and hidden runs of edges |
// | `shared_edges` | edges, by the faces that have them |
// | `intervals` | parts of segments, from one place to another |
// | `inner_edges` | edges inside polygons, which triangulation made |
// | `certain` | what floats tell of segments |
// | `crossings` | lines in which polygons go through one another |
// | `straddling` | faces with corners on both sides of one another's planes |
// | `through` | faces that go through one another, shown or not |
// | `sight` | segments of the scene as the picture shows them |
// | `spot` | points of the scene as the picture shows them |
// | `overlaid` | what shows of an overlay's lines and points |
// | `passes` | where segments pass in front of pieces or behind them |
// | `in_front` | how many polygons lie in front of lines |
// | `between` | lines and points between what is painted |
// | `display_list` | all that a drawing paints |
// | `pen` | segments joined to lines, in an order for a pen |
// | `near` | the nearest of the ends that are left |

mod above;
mod between;
mod cell;
mod certain;
mod crossings;
mod display_list;
mod divided;
mod edge_run;
mod edges;
mod exact_lines;
mod feet;
mod frame;
mod half;
mod halving;
mod in_front;
mod inner_edges;
mod intervals;
mod join;
mod key;
mod lines;
mod map;
mod narrow;
mod near;
mod near_vertices;
mod opaque;
mod order;
mod outline;
mod overlaid;
mod overlaps;
mod pairs;
mod parts;
mod passes;
mod paths;
mod pen;
mod reaches;
mod rect;
mod regions;
mod reporter;
mod rims;
mod rounded;
mod shared_edges;
mod sight;
mod spot;
mod stock;
mod straddling;
mod table;
mod through;
mod tile;
mod translucent;
mod twofold;
mod visible;

pub use display_list::DisplayItem;
pub use edge_run::{EdgeKind, EdgeRun};
pub use map::{MapCell, Shown, VisibilityMap};
pub use overlaid::{LineRun, MarkerView};
pub use paths::{Drawing, Path};
pub use pen::{Polyline, polylines};
pub use regions::Region;
