//! From which side a fragment is seen.

use std::cmp::Ordering;

use super::Fragment;
use crate::exact::{Eye, Faces, PlaneId};
use crate::viewpoint::Viewpoint;

impl Fragment<'_> {
    /// Which side of the fragment faces a viewpoint: `Greater` if its front does, from which its
    /// vertices run counter-clockwise; `Less` if its back does; `Equal` if it is seen edge-on,
    /// because the eye lies on its plane, or the direction of view runs along it.
    ///
    /// This is exact, for the viewpoint as orders round it (see [`Viewpoint`]), so it says the same
    /// of all fragments of a face. The triangles of a polygon that is not planar are faces with
    /// planes of their own. O(1).
    ///
    /// To leave out what is seen from behind, such as the walls between the eye and the inside of
    /// a room:
    ///
    /// ```
    /// use binspace::{BspTree, Viewpoint};
    ///
    /// let floor = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
    /// let ceiling = [[0.0, 0.0, 1.0], [0.0, 1.0, 1.0], [1.0, 1.0, 1.0], [1.0, 0.0, 1.0]];
    /// let tree = BspTree::build([floor, ceiling])?;
    ///
    /// let above = Viewpoint::eye([0.5, 0.5, 3.0]);
    /// let seen = tree.back_to_front(above).filter(|fragment| fragment.facing(above).is_gt());
    /// assert!(seen.map(|fragment| fragment.polygon()).eq([0]));
    /// # Ok::<(), binspace::Error>(())
    /// ```
    pub fn facing(&self, viewpoint: Viewpoint) -> Ordering {
        let faces = self.faces;
        facing(faces, self.face, &Eye::new(viewpoint, faces.lattice()))
    }
}

/// Error bound: a rounded distance is off by at most `ERROR` times the sum of the magnitudes of all
/// its terms.
///
/// With u = 2⁻⁵³: differences of corners are exact, so a component of the normal is off by 2u of its
/// two products; the eye, rounded, less a corner by 2u of both (a direction is exact); the products and
/// sums add 3u.
/// Smaller: wrong signs pass. Larger: more faces are decided by integers.
const ERROR: f64 = 5.0 * f64::EPSILON;

/// Which side of a face an eye sees: by floats where the bound allows, else exactly.
pub(super) fn facing(faces: &Faces, face: u32, eye: &Eye) -> Ordering {
    let [p, q, r] = faces.triangle(face);
    let (at, w) = eye.homogeneous();
    let (mut distance, mut size) = (0.0, 0.0);
    for i in 0..3 {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        let a = (q[j] - p[j]) * (r[k] - p[k]);
        let b = (q[k] - p[k]) * (r[j] - p[j]);
        distance += (a - b) * (at[i] - w * p[i]);
        size += (a.abs() + b.abs()) * (at[i].abs() + w * p[i].abs());
    }
    if distance.abs() > ERROR * size {
        return distance.total_cmp(&0.0);
    }
    faces.plane(PlaneId::face(face)).facing(eye)
}
