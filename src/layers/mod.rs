//! Layers of a page in space: rectangles with 4×4 matrices, as CSS 3D transforms make them, cut and
//! put in order for painting.
//!
//! ```
//! use binspace::glam::{DMat4, DVec3};
//! use binspace::layers::{Layer, Layers};
//!
//! // An eye 800 pixels in front of the middle of a screen.
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
//! assert!(!page.update(&layers)?); // nothing changed, nothing was done
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
//! Those of CSS. On the screen x runs right, y down and z towards the viewer, in one unit, usually
//! the pixel. A matrix maps a point (u, v) of its layer, as (u, v, 0, 1), to homogeneous screen
//! coordinates (x, y, z, w), and holds the perspective; the screen shows it at (x/w, y/w) if w is
//! positive, and at a larger z/w it is nearer to the viewer. So the page is seen along −z *after*
//! the division, and paint order is that of rising z/w.
//!
//! If depths of your matrices rise away from the viewer, negate their third row. If they run from 0
//! to 1, multiply it by the size of the viewport: depths are compared with the same tolerance as
//! x and y.
//!
//! # Matrices
//!
//! The matrix of an element is its parent's, times what CSS says about the element itself, from left to right:
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
//! // Its middle stays, and its left edge comes nearer: at half the width, and √3/2 of 100 to the front.
//! assert!(card.local([200.0, 140.0]).is_some_and(|[u, v]| (u - 100.0).hypot(v - 60.0) < 1e-9));
//! let left = 200.0 - 50.0 / (1.0 - 75f64.sqrt() * 10.0 / 600.0);
//! assert!(card.local([left, 150.0]).is_some_and(|[u, _]| u.abs() < 1e-9));
//! ```
//!
//! # What becomes of a layer
//!
//! It is clipped, in homogeneous coordinates, to its [ancestors](Layer::clipped_by) and to a box on the screen, and then
//! divided by w:
//!
//! | | the box |
//! |---|---|
//! | x, y | the viewport; or, if [`unclipped`](Layers::unclipped), 2²⁰ of its longer side around it |
//! | depth z/w | 2²⁰ longer sides of the viewport to the front and to the back |
//!
//! What is in the box has a positive w. The limit of depth is the near plane. With the perspective d
//! of CSS it is where w, the distance from the eye as a share of d, is d / (2²⁰ longer sides). There
//! a layer appears about a million times enlarged: only one that nearly passes through the eye, and so
//! is seen along its edge, comes as near as that inside the viewport.
//!
//! | layer | becomes |
//! |---|---|
//! | NaN or infinite numbers, or some whose products are | an error that names the layer |
//! | outside of the box: behind the eye, beside the viewport, or at a depth of more than 2²⁰ of its longer side, as 10¹⁸ pixels are | no piece |
//! | any, if the viewport has no area | no piece |
//! | a rectangle without area, or with low and high exchanged | no piece |
//! | outside of an ancestor that [clips](Layer::clipped_by) it, or clipped by one that its matrix makes a line or a point of | no piece |
//! | a matrix that makes a line or a point of it | no piece |
//! | seen along its edge, up to the rounding of the matrix; a rectangle so far from its own origin that this rounding is as large as its area on the screen counts as such | no piece |
//! | numbers so small that `f64` holds them with fewer digits: where w is below 2·10⁻³⁰⁸, as of a matrix times 10⁻³¹⁰, or where the sides of the rectangle times each other are, as of 10⁻¹⁷⁰ by 10⁻¹⁷⁰ | no piece |
//! | on the screen smaller than the rounding of positions, 2⁻⁵² of how far the page reaches | no piece |
//! | any other | a convex polygon of at most ten corners, and four more for each ancestor that clips it, in as many pieces as other layers cut it |
//!
//! There is no other way to have no piece, and a layer of which a part is in the box has its part. So
//! only numbers that are none are an error: a card that turns past its edge, or leaves the screen, is
//! an ordinary frame. [`Layers::visible`] counts the layers that have a piece; which those are,
//! [`LayerPiece::layer`] tells. A layer's number is its index in the list, whatever became of others.
//! Layers in one plane come in the order of the list; the [tolerance](#tolerance) says which those are.
//!
//! # Why to clip
//!
//! Near the eye's plane divided coordinates have no bound, and the default tolerance of a
//! [`BspTree`](crate::BspTree) is a share of the scene's extent. Pages of 30 layers above a floor that
//! reaches behind the eye, divided where w ≥ 10⁻⁹ and given to a tree as they are, are painted in a
//! wrong order at 67 to 97 % of the points where layers lie over each other; with w ≥ 10⁻⁶ one of four
//! pages is still wrong (at 42 %). Clipped as above, or with the tolerance of this module and not
//! clipped to the viewport, none is. (Bench `peers`, section `clipping`.) Clipping to the viewport
//! also leaves fewer layers to cut, as many of a long page are not on the screen.
//!
//! # Antialiasing
//!
//! Painters that antialias a path blend its border pixels with the pixels below. Where two pieces of a layer meet, both do
//! so, and a seam of the background shows. To paint opaque layers without seams, for each piece:
//!
//! 1. Fill its outline without antialiasing.
//! 2. Stroke the edges that [`LayerPiece::edges`] has as `Some`, one pixel wide, with round joins,
//!    antialiased, in the layer's colour.
//!
//! The example `smooth_layers` does so with tiny-skia. Along cuts, where layers cross, nothing is antialiased. A stroke
//! of a translucent layer shows on its border, as it covers half a pixel of the fill: leave it out there.
//!
//! # Tolerance
//!
//! A page has one tolerance, a length on the screen, where depth counts like x and y. It is four times
//! what rounding moves a corner off its layer's plane, at the corner where that is most: each number
//! of a matrix is taken to be off by 2⁻⁵² of itself, or 2⁻²³ if the layer is made by
//! [`Layer::from_f32`]. It is at least 10⁻⁹ of the viewport's longer side, and at least 2⁻⁴⁵ of the
//! largest coordinate, x, y or depth, of any corner (which is more only if a layer reaches further than
//! 35 000 times that side). It is at most 10⁻⁵ of that side.
//!
//! The order of two layers where they lie over each other:
//!
//! | two layers | painted |
//! |---|---|
//! | of equal matrices | in the order of the list, as they lie in one plane by definition |
//! | each of which has all its corners within the tolerance of the other's plane | in the order of the list |
//! | further apart there than twice the tolerance, measured along the normal of either plane | by depth |
//! | any other | in either order |
//!
//! In a page that is not clipped, a layer that reaches behind the eye has corners so far away that single
//! pages break the second row: fewer than one in a thousand of those that the tests make to be hard.
//!
//! The first three rows have one exception. Where the two lie over each other only within twice the
//! tolerance of the plane of a third layer that does not lie in theirs, they come in either order. It is
//! that of the [tree](crate::BspTree#exactness).

mod clip;
mod page;
mod piece;

pub use page::Layers;
pub use piece::{Layer, LayerPiece, LayerVertex, about, perspective};
