//! A view of a scene, drawn by one method after another.

use binspace::Error;
use binspace::glam::DVec3;
use binspace::internals::Faces;
use binspace::raster::{Image, Rays, picture, zbuffer};
use binspace::scene::Scene;
use binspace::view::Camera;
use binspace_evidence::measure::PictureError;
use binspace_evidence::method::{Method, MethodError};

use super::chapter::{Picture, percent};
use binspace_cli::colours::{BACKGROUND, Colouring, Colours};
use binspace_cli::failure::Failure;

/// The size of the pictures in a chapter.
pub(super) const SIZE: [u32; 2] = [320, 240];

/// A scene, a camera, and the true picture.
pub(super) struct Shot<'a> {
    pub(super) faces: Faces,
    pub(super) camera: Camera,
    pub(super) rays: Rays,
    /// The nearest face in each pixel, exactly.
    pub(super) truth: Image,
    colours: Colours<'a>,
}

/// The result of a method.
pub(super) struct Painted {
    pub(super) image: Image,
    pub(super) error: PictureError,
}

impl<'a> Shot<'a> {
    /// Views the whole scene from `direction`.
    pub(super) fn around(scene: &'a Scene, direction: DVec3) -> Result<Self, Failure> {
        let (low, high) = scene.bounds().unwrap_or_default();
        let (centre, reach) = ((low + high) * 0.5, (high - low).length() * 0.5);
        let eye = centre + direction.normalize() * (2.8 * reach);
        let camera = Camera::perspective_by_slope(eye, centre, scene.up(), 0.34, SIZE);
        Self::new(scene, camera)
    }

    pub(super) fn new(scene: &'a Scene, camera: Result<Camera, Error>) -> Result<Self, Failure> {
        let about = |error: &dyn std::fmt::Display| Failure::about(scene.name(), error);
        let camera = camera.map_err(|error| about(&error))?;
        let (faces, _) = Faces::new(scene.polygons(), None).map_err(|error| about(&error))?;
        let rays = Rays::new(&camera, &faces).map_err(|error| about(&error))?;
        let truth = zbuffer(&rays, &faces).into_image();
        Ok(Self { faces, camera, rays, truth, colours: Colours::new(scene, Colouring::Material) })
    }

    /// Gives each polygon its own colour, for scenes with few materials.
    pub(super) fn coloured_by_polygon(self, scene: &'a Scene) -> Self {
        Self { colours: Colours::new(scene, Colouring::Polygon), ..self }
    }

    pub(super) fn paint(&self, method: &dyn Method) -> Result<Painted, Failure> {
        let about = |error: MethodError| Failure::about(method.name(), error);
        let mut prepared = method.prepare(&self.faces).map_err(about)?;
        let painted = prepared.paint(&self.camera, &self.rays).map_err(about)?;
        let error = PictureError::of(&self.rays, &self.faces, &painted.image, &self.truth);
        Ok(Painted { image: painted.image, error })
    }

    /// A picture whose caption ends with the share of wrong pixels.
    pub(super) fn picture(&self, painted: &Painted, caption: &str) -> Picture {
        let share = percent(painted.error.wrong() as f64, painted.error.covered as f64);
        self.image(&painted.image, format!("{caption}: {share} wrong"))
    }

    /// A picture that may be incomplete.
    pub(super) fn image(&self, image: &Image, caption: impl Into<String>) -> Picture {
        let colour = |polygon| self.colours.rgb(polygon);
        let rgb = picture(&self.rays, &self.faces, image, colour, BACKGROUND);
        Picture::new(self.camera.size(), rgb, caption)
    }

    /// The picture of a method.
    pub(super) fn by(&self, method: &dyn Method, caption: &str) -> Result<Picture, Failure> {
        Ok(self.picture(&self.paint(method)?, caption))
    }
}
