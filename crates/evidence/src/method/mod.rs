//! Methods to decide visibility. They share a trait, so that their speed and errors can be compared.
//!
//! A [`Method`] is prepared for a scene's faces once, and then paints them from one camera after another.
//! [`compare`](binspace::raster::compare) compares a method's picture with the picture of the exact depth
//! buffer.
//!
//! | method | decides by | is wrong where |
//! |---|---|---|
//! | [`Bsp::exact`] | the tree of this library | nowhere |
//! | [`Bsp::double`], [`Bsp::single`] | a textbook tree: rounded distances and an epsilon | distances are near the epsilon or the precision |
//! | [`InputOrder`] | nothing | wherever an earlier face hides a later one |
//! | [`FrontFaces`] before another | the side that a face turns to the eye | back faces are visible |
//! | [`Centroid`] | one depth per face | faces overlap in depth |
//! | [`Newell`] | plane tests in `f64`, splits where nothing else helps | distances are near its epsilon |
//! | [`DepthBuffer`] | the depth in each pixel, in limited precision | depths are nearer than its steps |
//! | [`ExactDepth`] | the depth in each pixel, exactly | nowhere: the judge |
//!
//! ```
//! use binspace_evidence::method::{Centroid, Method, Newell};
//! use binspace::{internals::Faces, raster, scene, view};
//!
//! let scene = scene::random_triangles(60, 1);
//! let (faces, _) = Faces::new(scene.polygons(), None)?;
//! let (low, high) = scene.bounds().expect("a scene with corners");
//! let camera = &view::views([low, high], scene.up(), 1, [160, 120], 1)?[0];
//! let rays = raster::Rays::new(camera, &faces)?;
//! let truth = raster::zbuffer(&rays, &faces);
//! let wrong = |method: &dyn Method| -> Result<usize, binspace_evidence::method::MethodError> {
//!     let painted = method.prepare(&faces)?.paint(camera, &rays)?;
//!     Ok(raster::compare(&rays, &faces, &painted.image, truth.image()).wrong())
//! };
//! assert_eq!(wrong(&Newell::DEFAULT)?, 0);
//! assert!(wrong(&Centroid)? > 0);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod attributes;
mod bsp;
mod centroid;
mod clip;
mod decides_in;
mod depth;
mod error;
mod exact_depth;
mod field;
mod front_faces;
mod input_order;
mod newell;
mod space;
#[cfg(test)]
mod tests;

pub use attributes::{Across, paint_attributes};
pub use bsp::Bsp;
pub use centroid::{Centroid, centroid_order};
pub use decides_in::Space;
pub use depth::{
    Clear, DepthBuffer, DepthFormat, DepthRules, DepthTest, Interpolation, Layered, Layers, Nearer,
    Sections, SetUp, Stored, Unstored,
};
pub use error::MethodError;
pub use exact_depth::ExactDepth;
pub use field::{Options, all};
pub use front_faces::FrontFaces;
pub use input_order::InputOrder;
pub use newell::{Decisions, Newell};

use std::time::Duration;

use crate::Accuracy;
use binspace::internals::Faces;
use binspace::raster::{Image, Rays};
use binspace::view::Camera;

/// A method that decides which face shows in each pixel.
pub trait Method: Send + Sync {
    /// Returns a short name, unique among all methods and options: "newell", "bsp f64 1e-6", "z 24".
    fn name(&self) -> String;

    /// Returns the space in which the method decides visibility.
    fn space(&self) -> Space;

    /// Does all work that does not depend on the viewpoint.
    ///
    /// # Errors
    ///
    /// If a budget runs out.
    fn prepare<'a>(&'a self, faces: &'a Faces) -> Result<Box<dyn Prepared + 'a>, MethodError>;
}

/// A method prepared for the faces of a scene.
pub trait Prepared {
    /// Paints the scene. The rays must be the camera's rays through the faces that the method was prepared
    /// for.
    ///
    /// # Errors
    ///
    /// If a budget runs out, or the method's options are invalid for the camera.
    fn paint(&mut self, camera: &Camera, rays: &Rays) -> Result<Painted, MethodError>;

    /// Returns the memory in bytes that is kept between two views, without the faces.
    fn bytes(&self) -> usize;

    /// Visits each piece of a face that was made before any view: the face, and the piece's
    /// vertices in lattice units, in the face's orientation. Methods that split nothing before a view
    /// visit none.
    fn for_each_piece(&self, visit: &mut dyn FnMut(u32, &[[f64; 3]])) {
        let _ = visit;
    }

    /// Returns the errors of the pieces against their exact definitions; `None` if the method keeps no
    /// definitions.
    fn accuracy(&self) -> Option<Accuracy> {
        None
    }
}

/// A picture, and the time and pieces that it took.
#[derive(Clone, Debug)]
pub struct Painted {
    /// The face in each pixel.
    pub image: Image,
    /// The time until the order was found; zero for methods without an order.
    pub order: Duration,
    /// The time that drawing took.
    pub draw: Duration,
    /// The number of drawn pieces, including faces that were not cut.
    pub pieces: usize,
    /// The number of faces that a step before the method left out, because they do not show their fronts.
    pub removed: usize,
}
