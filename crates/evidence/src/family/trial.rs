//! A scene and its views.

use glam::DVec3;

use binspace::scene::Scene;

/// The tangent of half the vertical field of view: about 39 degrees.
pub(super) const HALF_HEIGHT: f64 = 0.35;

/// An eye, its target, and the up direction.
pub(super) struct Look {
    pub(super) eye: DVec3,
    pub(super) target: DVec3,
    pub(super) up: DVec3,
}

/// A scene with its views.
pub(super) struct Trial {
    pub(super) scene: Scene,
    pub(super) looks: Vec<Look>,
    /// The tangent of half the vertical field of view.
    pub(super) half_height: f64,
}

impl Trial {
    /// A scene with views of the usual width.
    pub(super) fn new(scene: Scene, looks: Vec<Look>) -> Self {
        Self { scene, looks, half_height: HALF_HEIGHT }
    }
}
