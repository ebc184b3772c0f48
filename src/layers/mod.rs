//! Layers of a page in space: rectangles with 4×4 matrices, as in CSS 3D transforms, cut and sorted for
//! painting.
//!
//! ```
//! use binspace::glam::{DMat4, DVec3};
//! use binspace::layers::{Layer, Layers};
//!
//! // An eye 800 pixels in front of the screen's centre.
//! let mut perspective = DMat4::IDENTITY;
//! perspective.z_axis.w = -1.0 / 800.0;
//! let camera = DMat4::from_translation(DVec3::new(320.0, 240.0, 0.0)) * perspective;
//!
//! // Two cards that cross, and a badge in the plane of the second.
//! let card = [[-100.0, -60.0], [100.0, 60.0]];
//! let turned = camera * DMat4::from_rotation_y(0.7);
//! let mut page = Layers::new([[0.0, 0.0], [640.0, 480.0]]);
//! let layers = [
//!     Layer::new(card, camera * DMat4::from_rotation_y(-0.7)),
//!     Layer::new(card, turned),
//!     Layer::new([[60.0, -50.0], [90.0, -30.0]], turned),
//! ];
//! assert!(page.update(&layers)?);
//! assert!(!page.update(&layers)?); // nothing changed, so nothing is done
//!
//! assert_eq!((page.visible(), page.len()), (3, 4)); // one card was cut in two
//! for piece in page.back_to_front() {
//!     for vertex in piece.vertices() {
//!         let (_on_screen, _in_the_layer) = (vertex.position, vertex.local);
//!     }
//! }
//! # Ok::<(), binspace::Error>(())
//! ```
//!
//! # Conventions
//!
//! The conventions of CSS apply. On the screen, x points right, y points down, and z points towards the
//! viewer. All three have the same unit, usually the pixel. A matrix maps a point (u, v) of its layer, as
//! (u, v, 0, 1), to homogeneous screen coordinates (x, y, z, w), and includes the perspective. If w is
//! positive, the point is at (x/w, y/w) on the screen, and a larger z/w is nearer to the viewer. So the page
//! is seen along −z *after* the division, and layers are painted in the order of increasing z/w.
//!
//! If depths of your matrices increase away from the viewer, negate their third row. If depths are from 0 to
//! 1, multiply the third row by the size of the viewport: depths are compared with the same tolerance as x
//! and y.
//!
//! # Matrices
//!
//! The matrix of an element is its parent's matrix, times the matrices of the element's own CSS properties,
//! from left to right:
//!
//! | CSS | matrix |
//! |---|---|
//! | the parent's `perspective` and `perspective-origin` | [`perspective(distance, origin)`](perspective) |
//! | place in the parent's box | `DMat4::from_translation(DVec3::new(left, top, 0.0))` |
//! | `transform` and `transform-origin` | [`about(origin, transform)`](about) |
//! | `rotateX(20deg)`, `translateZ(9px)`, … | `DMat4::from_rotation_x(20f64.to_radians())`, … |
//! | `matrix3d(a1, …, d4)` | `DMat4::from_cols_array(&[a1, …, d4])` |
//! | `transform-style: flat` | `DMat4::from_scale(DVec3::new(1.0, 1.0, 0.0))` before the children's matrices |
//!
//! ```
//! use binspace::glam::{DMat4, DVec3};
//! use binspace::layers::{Layer, about, perspective};
//!
//! // <div style="perspective: 600px; width: 400px; height: 300px">
//! //   <div style="position: absolute; left: 100px; top: 80px; width: 200px; height: 120px;
//! //               transform: rotateY(60deg)">
//! let parent = perspective(600.0, [200.0, 150.0]);
//! let place = DMat4::from_translation(DVec3::new(100.0, 80.0, 0.0));
//! let turned = about([100.0, 60.0], DMat4::from_rotation_y(60f64.to_radians()));
//! let card = Layer::rect([200.0, 120.0], parent * place * turned);
//! // Its middle stays. Its left edge comes nearer: at half the width, and √3/2 of 100 to the front.
//! assert!(card.local([200.0, 140.0]).is_some_and(|[u, v]| (u - 100.0).hypot(v - 60.0) < 1e-9));
//! let left = 200.0 - 50.0 / (1.0 - 75f64.sqrt() * 10.0 / 600.0);
//! assert!(card.local([left, 150.0]).is_some_and(|[u, _]| u.abs() < 1e-9));
//! ```
//!
//! # Pieces of a layer
//!
//! A layer is clipped, in homogeneous coordinates, to its [ancestors](Layer::clipped_by) and to a box. Then
//! its corners are divided by w. The box depends on the length R, which is 2²⁰ times the longer side of the
//! viewport:
//!
//! | | the box |
//! |---|---|
//! | x, y | the viewport; or, if [`unclipped`](Layers::unclipped), the viewport extended by R on each side |
//! | depth z/w | from −R to R |
//!
//! Points in the box have a positive w. The front of the box, at depth R, is the near plane. With the CSS
//! perspective of distance d, w is the distance from the eye divided by d, and w is about d / R at the near
//! plane. If d is about the longer side, layers at the near plane are magnified about a million times. Inside
//! the viewport, only a layer that nearly passes through the eye reaches the near plane, and such a layer is
//! seen edge-on.
//!
//! | layer | result |
//! |---|---|
//! | has a number that is NaN, infinite, or so large that a product with another of its numbers is infinite | an error that names the layer |
//! | outside the box: behind the eye, beside the viewport, or at a depth beyond R, such as 10¹⁸ pixels | no piece |
//! | any layer, if the viewport has no area | no piece |
//! | a rectangle without area, or with low and high exchanged | no piece |
//! | outside an ancestor that [clips](Layer::clipped_by) the layer, or clipped by an ancestor whose matrix maps the ancestor to a line or a point | no piece |
//! | mapped by its matrix to a line or a point | no piece |
//! | seen edge-on within the rounding of the matrix; also a rectangle so far from its own origin that this rounding is as large as the area on the screen | no piece |
//! | has numbers of so different sizes that rounding puts a corner further outside the box than the box is wide | no piece |
//! | has numbers so small that `f64` has fewer digits for them: w below 2·10⁻³⁰⁸ (for example a matrix times 10⁻³¹⁰), or a product of the rectangle's sides below 2·10⁻³⁰⁸ (for example 10⁻¹⁷⁰ by 10⁻¹⁷⁰) | no piece |
//! | smaller on the screen than 2⁻⁵² of the [extent](crate::BspTree#exactness) of all layers, to which positions are rounded | no piece |
//! | any other layer | a convex polygon of at most ten corners, plus four for each ancestor that clips it; in one piece, or in several pieces if other layers cut it |
//!
//! Every other layer that is partly in the box has pieces. Only NaN, infinite and too large numbers are an
//! error. A card that turns past its edge, or leaves the screen, causes no error. [`Layers::visible`] counts
//! the layers with pieces, and [`LayerPiece::layer`] identifies them. A layer's number is its index in the
//! list, whether or not other layers have pieces. Layers that lie in one plane within the
//! [tolerance](#tolerance) are painted in the order of the list.
//!
//! # Why layers are clipped
//!
//! Near the eye's plane, divided coordinates are unbounded, and the [default
//! tolerance](crate::BspTree#which-tolerance) of a [`BspTree`](crate::BspTree) is a share of the scene's
//! extent. Four pages of 30 layers above a floor that reaches behind the eye show the effect. If the parts
//! with w ≥ 10⁻⁹ are divided by w and passed directly to a tree, the painting order is wrong at 67 to 97 %
//! of the points where layers overlap. If the parts with w ≥ 10⁻⁶ are passed, one of the four pages is still
//! wrong, at 42 % of these points. No page is wrong with the tolerance of this module, clipped to the
//! viewport or [unclipped](Layers::unclipped). (Bench `peers`, section `clipping`.) Clipping to the viewport
//! also leaves fewer layers to cut, because many layers of a long page are not on the screen.
//!
//! # Antialiasing
//!
//! Painters that antialias a path blend its border pixels with the pixels below. Where two pieces of a layer
//! meet, both pieces blend, and the background shows through as a seam. To paint opaque layers without seams,
//! for each piece:
//!
//! 1. Fill its outline without antialiasing.
//! 2. Stroke the edges for which [`LayerPiece::edges`] returns `Some`, one pixel wide, with round joins,
//!    antialiased, in the layer's colour.
//!
//! The example `smooth_layers` does this with tiny-skia. The cuts where layers cross are not antialiased. Do
//! not stroke translucent layers: half the stroke covers the fill and is visible.
//!
//! # Tolerance
//!
//! A page has one tolerance: a length on the screen, in the unit of x, y and depth. The tolerance is four
//! times the largest rounding error of a corner's distance from its layer's plane. Each number of a matrix is
//! assumed to have a relative error of 2⁻⁵², or of 2⁻²³ if the layer is made by [`Layer::from_f32`]. The
//! tolerance has three limits:
//!
//! - at least 10⁻⁹ of the viewport's longer side;
//! - at least 2⁻⁴⁵ of the largest coordinate (x, y or depth) of any corner, which matters only if a layer
//!   reaches further than 35 000 times the longer side;
//! - at most 10⁻⁵ of the longer side.
//!
//! The order of two layers where they overlap:
//!
//! | two layers | painted |
//! |---|---|
//! | with equal matrices | in the order of the list, because they lie in one plane by definition |
//! | each with all its corners within the tolerance of the other's plane | in the order of the list |
//! | everywhere in their overlap more than twice the tolerance apart, measured along the normal of either plane | by depth |
//! | any other | in either order |
//!
//! In an unclipped page, a layer that reaches behind the eye has corners so far away that the second row can
//! be violated. In the tests, this occurs in fewer than one in a thousand of the most difficult pages.
//!
//! The first three rows have the same exception as the [tree](crate::BspTree#exactness). Two layers may be
//! painted in either order if they overlap only within twice the tolerance of the plane of a third layer in
//! another plane.

mod clip;
mod page;
mod piece;

pub use page::Layers;
pub use piece::{Layer, LayerPiece, LayerVertex, about, perspective};
