//! From which side a fragment is seen.

use std::cmp::Ordering;

use super::Fragment;
use crate::exact::{Eye, PlaneId};
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
        let eye = Eye::new(viewpoint, faces.lattice());
        faces.plane(PlaneId::face(self.face)).facing(&eye)
    }
}
