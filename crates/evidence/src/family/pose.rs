//! Rotated coordinate frames, and views of them.

use glam::DVec3;

use super::trial::Look;
use binspace::internals::SplitMix64;
use binspace::scene::{Material, Scene};

/// A frame with a random orientation: three perpendicular unit vectors at a place.
pub(super) struct Pose {
    pub(super) axes: [DVec3; 3],
    pub(super) origin: DVec3,
}

impl Pose {
    /// Any orientation, by a random unit quaternion; the origin stays.
    pub(super) fn random(random: &mut SplitMix64) -> Self {
        let mut draw = || std::array::from_fn::<f64, 4, _>(|_| random.range(-1.0, 1.0));
        let square = |q: &[f64; 4]| q.iter().map(|c| c * c).sum::<f64>();
        // Points outside the unit ball are rejected, so that all orientations are equally likely. This
        // rejects about two draws in three.
        let [w, x, y, z] = (0..1000)
            .map(|_| draw())
            .find(|q| (0.01..1.0).contains(&square(q)))
            .unwrap_or([0.5, 0.1, 0.2, 0.3]);
        let s = 2.0 / square(&[w, x, y, z]);
        let axes = [
            DVec3::new(1.0 - s * (y * y + z * z), s * (x * y + w * z), s * (x * z - w * y)),
            DVec3::new(s * (x * y - w * z), 1.0 - s * (x * x + z * z), s * (y * z + w * x)),
            DVec3::new(s * (x * z + w * y), s * (y * z - w * x), 1.0 - s * (x * x + y * y)),
        ];
        Self { axes, origin: DVec3::ZERO }
    }

    /// A point given in the frame.
    pub(super) fn place(&self, p: DVec3) -> DVec3 {
        self.origin + self.direction(p)
    }

    /// A direction given in the frame.
    pub(super) fn direction(&self, v: DVec3) -> DVec3 {
        self.axes[0] * v.x + self.axes[1] * v.y + self.axes[2] * v.z
    }

    /// A view in the frame.
    pub(super) fn look(&self, eye: DVec3, target: DVec3) -> Look {
        let up = if (eye - target).x.abs() > (eye - target).y.abs() { DVec3::Y } else { DVec3::X };
        Look { eye: self.place(eye), target: self.place(target), up: self.direction(up) }
    }

    /// Views of the surroundings of the frame's origin within `reach`: from the front (where z comes from),
    /// from within, from behind, and from two slanting directions. All eyes are at `distance` from the
    /// origin, except the one within.
    pub(super) fn looks(&self, distance: f64, reach: f64, random: &mut SplitMix64) -> Vec<Look> {
        let mut jitter = |size: f64| random.point(-size, size);
        let around = [
            DVec3::new(0.05, 0.03, 1.0),
            DVec3::new(-0.04, 0.06, -1.0),
            DVec3::new(0.7, -0.5, 0.6),
            DVec3::new(-0.9, 0.3, 0.25),
        ];
        let mut looks = Vec::new();
        for direction in around {
            let eye = (direction + jitter(0.03)) * distance;
            looks.push(self.look(eye, jitter(0.05) * reach));
        }
        let eye = (DVec3::new(0.15, -0.2, 0.3) + jitter(0.1)) * reach;
        let inside = self.look(eye, DVec3::new(-0.4, 0.3, -0.05) * reach);
        looks.insert(1, inside);
        looks
    }
}

/// A scene without polygons, with eight colours.
pub(super) fn empty(name: &str, difficulty: f64) -> Scene {
    let mut scene = Scene::new(format!("{name}:{difficulty:e}"), DVec3::Z);
    Material::palette().for_each(|material| {
        scene.add_material(material);
    });
    scene
}

/// Adds polygons in random order, so that input order does not help.
pub(super) fn push_shuffled(
    scene: &mut Scene,
    mut polygons: Vec<Vec<DVec3>>,
    random: &mut SplitMix64,
) {
    for i in (1..polygons.len()).rev() {
        polygons.swap(i, (random.next() % (i as u64 + 1)) as usize);
    }
    for (i, polygon) in polygons.into_iter().enumerate() {
        scene.push(polygon, (i % 8) as u32);
    }
}
