//! Ways to decide visibility, behind one trait, so that speed and error can be measured side by
//! side.
//!
//! A [`Method`] is prepared for a scene's faces once, and then paints them from one camera after
//! another. What it paints is a picture of faces, to be [compared](crate::raster::compare) with
//! that of the exact depth buffer.
//!
//! | method | decides by | errs where |
//! |---|---|---|
//! | [`Bsp`] with [`Exact`](crate::geom::Exact) | the tree of this library | nowhere |
//! | [`Bsp`] with [`Float`](crate::geom::Float) | the same tree, rounded distances and an epsilon | distances are near the epsilon or the precision |
//! | [`Centroid`] | one depth a face | faces overlap in depth |
//! | [`Newell`] | plane tests in `f64`, splits where nothing else helps | distances are near its epsilon |
//! | [`DepthBuffer`] | the depth in each pixel, in limited precision | depths are nearer than its steps |
//! | [`ExactDepth`] | the depth in each pixel, exactly | nowhere: the judge |
//!
//! ```
//! use binspace::method::{Centroid, Method, Newell};
//! use binspace::{geom::Faces, raster, scene, view};
//!
//! let scene = scene::random_triangles(60, 1);
//! let (faces, _) = Faces::new(scene.polygons(), None)?;
//! let (low, high) = scene.bounds().expect("a scene with corners");
//! let camera = &view::views([low, high], scene.up(), 1, [160, 120], 1)?[0];
//! let rays = raster::Rays::new(camera, &faces)?;
//! let truth = raster::zbuffer(&rays, &faces);
//! let wrong = |method: &dyn Method| -> Result<usize, binspace::method::MethodError> {
//!     let painted = method.prepare(&faces)?.paint(camera, &rays)?;
//!     Ok(raster::compare(&rays, &faces, &painted.image, truth.image()).wrong())
//! };
//! assert_eq!(wrong(&Newell::DEFAULT)?, 0);
//! assert!(wrong(&Centroid)? > 0);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod bsp;
mod centroid;
mod clip;
mod depth;
mod error;
mod exact_depth;
mod newell;
mod space;
#[cfg(test)]
mod tests;

pub use bsp::Bsp;
pub use centroid::Centroid;
pub use depth::{DepthBuffer, DepthFormat, Interpolation};
pub use error::MethodError;
pub use exact_depth::ExactDepth;
pub use newell::Newell;

use std::time::Duration;

use crate::bsp::{Accuracy, BuildOptions};
use crate::geom::Faces;
use crate::raster::{Image, Rays};
use crate::view::Camera;

/// A way to decide which face shows in each pixel.
pub trait Method: Send + Sync {
    /// A short name, different from those of all other methods and options: "newell",
    /// "bsp f64 1e-6", "z 24".
    fn name(&self) -> String;

    /// Does what does not depend on the viewpoint.
    ///
    /// # Errors
    ///
    /// If a budget runs out.
    fn prepare<'a>(&'a self, faces: &'a Faces) -> Result<Box<dyn Prepared + 'a>, MethodError>;
}

/// A method made ready for the faces of a scene.
pub trait Prepared {
    /// Paints the scene. The rays must be those of the camera through the faces that the method
    /// was prepared for.
    ///
    /// # Errors
    ///
    /// If a budget runs out, or the method's options do not fit the camera.
    fn paint(&mut self, camera: &Camera, rays: &Rays) -> Result<Painted, MethodError>;

    /// The resident bytes between two views, besides the faces.
    fn bytes(&self) -> usize;

    /// Shows each piece of a face that was made ahead of any view: the face, and the piece's
    /// vertices in lattice units, in the face's orientation. Methods that cut nothing ahead show
    /// nothing.
    fn for_each_piece(&self, visit: &mut dyn FnMut(u32, &[[f64; 3]])) {
        let _ = visit;
    }

    /// How far the pieces are from their definitions, of methods that keep any.
    fn accuracy(&self) -> Option<Accuracy> {
        None
    }
}

/// A picture, and what it cost.
#[derive(Clone, Debug)]
pub struct Painted {
    /// The face in each pixel.
    pub image: Image,
    /// The time until the order was found; zero for methods that find none.
    pub order: Duration,
    /// The time that drawing took.
    pub draw: Duration,
    /// How many pieces were drawn, faces that were not cut included.
    pub pieces: usize,
}

/// Options of the methods that [`all`] makes.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Options {
    /// How trees are built. The tolerance is that of the faces, whatever is said here.
    pub build: BuildOptions,
    /// Newell's algorithm, its budgets and its epsilon.
    pub newell: Newell,
    /// The near plane of depth buffers; see [`DepthBuffer::near`].
    pub near: Option<f64>,
    /// The far plane of depth buffers; see [`DepthBuffer::far`].
    pub far: Option<f64>,
}

impl Options {
    /// The defaults.
    pub const DEFAULT: Self =
        Self { build: BuildOptions::DEFAULT, newell: Newell::DEFAULT, near: None, far: None };

    /// With other options for trees.
    #[must_use]
    pub const fn with_build(self, build: BuildOptions) -> Self {
        Self { build, ..self }
    }

    /// With another budget or epsilon for Newell's algorithm.
    #[must_use]
    pub const fn with_newell(self, newell: Newell) -> Self {
        Self { newell, ..self }
    }

    /// With given near and far planes, in world units, for depth buffers.
    #[must_use]
    pub const fn with_range(self, near: f64, far: f64) -> Self {
        Self { near: Some(near), far: Some(far), ..self }
    }
}

impl Default for Options {
    fn default() -> Self {
        Self::DEFAULT
    }
}

/// The standard field of competitors, the exact tree first and the judge last.
pub fn all(options: &Options) -> Vec<Box<dyn Method>> {
    let build = options.build;
    let mut methods: Vec<Box<dyn Method>> = vec![Box::new(Bsp::exact(build))];
    for epsilon in [1e-12, 1e-9, 1e-6, 1e-3] {
        methods.push(Box::new(Bsp::double(build, epsilon)));
    }
    for epsilon in [1e-6, 1e-5, 1e-4, 1e-3] {
        methods.push(Box::new(Bsp::single(build, epsilon)));
    }
    methods.push(Box::new(Centroid));
    methods.push(Box::new(options.newell));
    let buffer =
        |format| DepthBuffer { near: options.near, far: options.far, ..DepthBuffer::new(format) };
    use DepthFormat::{Float, FloatReversed, Integer, LinearFloat, LinearInteger};
    for format in [Integer(16), Integer(24), Float, FloatReversed, LinearInteger(16), LinearFloat] {
        methods.push(Box::new(buffer(format)));
    }
    let incremental = buffer(Integer(24)).with_interpolation(Interpolation::Incremental);
    methods.push(Box::new(incremental));
    methods.push(Box::new(ExactDepth));
    methods
}
