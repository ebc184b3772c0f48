//! What made a line of the picture, and its coefficients.

use super::frame::{ExactLine, Frame};
use super::rounded::Rounded;
use crate::exact::PlaneId;
use crate::raster::{Sheet, edge};

/// What made a line. Equal keys are equal lines, up to their direction; those of other keys may be, too,
/// but for edges: edges on one line have its first key.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) enum Key {
    /// The edge between two points, the lower number first.
    Edge([u32; 2]),
    /// A face's edge from its corner to the next, one of which was moved onto the face's plane, or may have
    /// been.
    Upright(u32, u32),
    /// The cut of a face by a plane: of two faces' planes, of the lower by the higher.
    Cut(u32, PlaneId),
}

impl Key {
    /// The line in floats, in a picture that reaches so far. Points have the numbers of these corners.
    pub(super) fn rounded(self, frame: &Frame<'_>, corners: &[u32], reach: [f64; 2]) -> Rounded {
        let Frame { rays, faces } = frame;
        let sheet = |plane| Sheet::new(rays, faces, plane);
        let (k, error) = match self {
            Self::Edge(points) => return rounded_edge(frame, ends(frame, corners, points), reach),
            Self::Upright(face, k) => {
                let ([a, b], axis) = upright(frame, face, k);
                sheet(PlaneId::face(face)).cut(&Sheet::upright(rays, a, b, axis))
            }
            Self::Cut(face, plane) => sheet(PlaneId::face(face)).cut(&sheet(plane)),
        };
        // The picture may end half a pixel beyond the pixels that the error is for, and its lists reach a
        // pixel further.
        let rounded = Rounded::scaled(k, 4.0 * error);
        if rounded.is_fine() { rounded } else { Rounded::new(&self.exact(frame, corners), reach) }
    }

    /// The line in integers.
    pub(super) fn exact(self, frame: &Frame<'_>, corners: &[u32]) -> ExactLine {
        match self {
            Self::Edge(points) => frame.edge(ends(frame, corners, points)),
            Self::Upright(face, k) => {
                let (ends, axis) = upright(frame, face, k);
                frame.sheet(PlaneId::face(face)).cut(&frame.upright(ends, axis))
            }
            Self::Cut(face, plane) => frame.sheet(PlaneId::face(face)).cut(&frame.sheet(plane)),
        }
    }
}

/// The edge from one lattice point to another in floats, in a picture that reaches so far.
pub(super) fn rounded_edge(frame: &Frame<'_>, ends: [[f64; 3]; 2], reach: [f64; 2]) -> Rounded {
    let (k, error) = edge(&frame.rays, ends);
    let rounded = Rounded::scaled(k, 4.0 * error);
    if rounded.is_fine() { rounded } else { Rounded::new(&frame.edge(ends), reach) }
}

/// The ends of an edge.
fn ends(frame: &Frame<'_>, corners: &[u32], points: [u32; 2]) -> [[f64; 3]; 2] {
    points.map(|point| frame.faces.corner(corners[point as usize]))
}

/// The ends of a face's edge `k`, and the axis along which they were moved onto the face's plane.
fn upright(frame: &Frame<'_>, face: u32, k: u32) -> ([[f64; 3]; 2], usize) {
    let corners = frame.faces.corners(face);
    let next = if k as usize + 1 == corners.len() { 0 } else { k as usize + 1 };
    let axis = frame.faces.upright_axis(face).unwrap_or_default();
    ([corners[k as usize], corners[next]], axis)
}
