//! Back-face detection as a step before a method.

use std::cmp::Ordering;

use super::{Method, MethodError, Painted, Prepared, Space};
use crate::Accuracy;
use binspace::internals::{Eye, Faces, PlaneId};
use binspace::raster::Rays;
use binspace::view::Camera;

/// Another method, which gets only the faces that turn their fronts to the eye.
///
/// All visible faces of a convex body are front faces, and none of them hides another. So for a convex body,
/// this step and [`InputOrder`](super::InputOrder) give the exact picture. For other closed bodies, the step
/// removes about half of the faces before the method starts. Surfaces that are not closed lose their visible
/// backs.
///
/// The side of the eye is decided exactly.
#[derive(Clone, Copy, Debug, Default)]
pub struct FrontFaces<M>(pub M);

impl<M: Method> Method for FrontFaces<M> {
    fn name(&self) -> String {
        format!("fronts, {}", self.0.name())
    }

    /// Faces are removed whole, in object space.
    fn space(&self) -> Space {
        match self.0.space() {
            Space::Neither | Space::Object => Space::Object,
            Space::Image | Space::Both => Space::Both,
        }
    }

    fn prepare<'a>(&'a self, faces: &'a Faces) -> Result<Box<dyn Prepared + 'a>, MethodError> {
        Ok(Box::new(Ready { method: self.0.prepare(faces)?, faces }))
    }
}

struct Ready<'a> {
    method: Box<dyn Prepared + 'a>,
    faces: &'a Faces,
}

impl Prepared for Ready<'_> {
    fn paint(&mut self, camera: &Camera, rays: &Rays) -> Result<Painted, MethodError> {
        let rays = rays.clone().with_front_faces_only();
        let painted = self.method.paint(camera, &rays)?;
        let is_shown = shown(&rays, self.faces);
        let removed = (0..self.faces.len() as u32).filter(|&face| !is_shown(face)).count();
        Ok(Painted { removed, ..painted })
    }

    fn bytes(&self) -> usize {
        self.method.bytes()
    }

    fn for_each_piece(&self, visit: &mut dyn FnMut(u32, &[[f64; 3]])) {
        self.method.for_each_piece(visit);
    }

    fn accuracy(&self) -> Option<Accuracy> {
        self.method.accuracy()
    }
}

/// Whether a method has to process a face: every face, or only front faces if the rays meet only fronts.
pub(super) fn shown<'a>(rays: &Rays, faces: &'a Faces) -> impl Fn(u32) -> bool + use<'a> {
    let eye = rays.is_front_only().then(|| Eye::new(rays.viewpoint(), faces.lattice()));
    move |face| eye.is_none_or(|eye| faces.eye_side(PlaneId::face(face), &eye) == Ordering::Greater)
}
