//! The exact numbers of a tree: its grid, and planes through grid points.

use glam::DVec3;

use super::BspTree;
use crate::exact::{Faces, PlaneId, PlaneKind, integers};

/// The grid that a tree's corners lie on: [`BspTree::grid`].
///
/// The grid point g, three integers, is at `base + g * 2^exponent` in the polygons' unit. That is exact,
/// but for scenes smaller than some 10⁻²⁹⁰ or further from the origin than 2⁵⁸ times their size, where
/// `base` has no room for all digits.
///
/// Planes by three points of the grid let you compute what the tree decides, with integers or fractions
/// of your own: the point x is in front of the plane through p, q and r where the determinant of q − p,
/// r − p and x − p is positive.
///
/// ```
/// use binspace::BspTree;
///
/// let square = |z: f64| [[0.0, 0.0, z], [1.0, 0.0, z], [1.0, 1.0, z], [0.0, 1.0, z]];
/// let tree = BspTree::build([square(0.0), square(0.75)])?;
/// let grid = tree.grid();
/// let [p, _, _] = tree.fragment(1).grid_points();
/// let height = grid.base.z + p[2] as f64 * 2f64.powi(grid.exponent);
/// assert!(height == 0.0 || height == 0.75);
/// # Ok::<(), binspace::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Grid {
    /// Where the grid point (0, 0, 0) is.
    pub base: DVec3,
    /// The grid's step is two to this power.
    pub exponent: i32,
}

impl BspTree {
    /// The grid that corners are rounded to.
    pub fn grid(&self) -> Grid {
        let lattice = self.faces.lattice();
        Grid { base: lattice.to_world([0.0; 3]), exponent: -lattice.exponent() }
    }
}

/// The unit normal of a plane: each coordinate is off by a few roundings.
pub(super) fn unit_normal(faces: &Faces, plane: PlaneId) -> DVec3 {
    faces.plane(plane).normal_f64().normalize()
}

/// The distance of a plane from the origin along its unit normal.
pub(super) fn offset(faces: &Faces, plane: PlaneId) -> f64 {
    let corner = match plane.kind() {
        PlaneKind::Face(face) => faces.reference_triangle(face)[0],
        PlaneKind::Axis(_, corner) => corner,
    };
    unit_normal(faces, plane).dot(faces.lattice().to_world(faces.corner(corner)))
}

/// Three lattice points of a plane, counter-clockwise seen from its front.
pub(crate) fn plane_points(faces: &Faces, plane: PlaneId) -> [[i64; 3]; 3] {
    match plane.kind() {
        PlaneKind::Face(face) => faces.triangle(face).map(integers),
        PlaneKind::Axis(axis, corner) => {
            let point = integers(faces.corner(corner));
            [point, along(point, (axis + 1) % 3), along(point, (axis + 2) % 3)]
        }
    }
}

/// The next point along an axis.
pub(crate) fn along(mut point: [i64; 3], axis: usize) -> [i64; 3] {
    point[axis] += 1;
    point
}
