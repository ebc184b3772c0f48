//! A door that swings in one of the level's doorways.

use binspace::glam::DVec3;

use crate::rooms::{Kind, Quad};

/// The position of a door: a point on the floor, and the vector to the other side of the doorway.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Door {
    hinge: DVec3,
    across: DVec3,
    height: f64,
}

impl Door {
    /// The door of the doorway that is nearest to a point; `None` if the level has none.
    pub(crate) fn nearest(level: &[(Kind, Quad)], point: DVec3) -> Option<Self> {
        // A doorway is found by the lower corners of the piece of wall above it.
        let lintels = level.iter().filter_map(|&(kind, [a, b, ..])| {
            let height = a.z;
            let on_floor = |p: DVec3| p.with_z(0.0);
            (kind == Kind::Wall && height > 0.0).then(|| Self {
                hinge: on_floor(a),
                across: on_floor(b - a),
                height,
            })
        });
        let distance = |door: &Self| (door.hinge + 0.5 * door.across - point).length();
        lintels.min_by(|a, b| distance(a).total_cmp(&distance(b)))
    }

    /// The leaf of the door, opened by an angle in radians. At 0, it closes the doorway.
    pub(crate) fn leaf(&self, angle: f64) -> Quad {
        let (sin, cos) = angle.sin_cos();
        let end = self.hinge + self.across * cos + DVec3::Z.cross(self.across) * sin;
        let up = DVec3::Z * self.height;
        [self.hinge, end, end + up, self.hinge + up]
    }
}
