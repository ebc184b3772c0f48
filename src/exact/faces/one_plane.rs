//! Polygons that lie in one plane by definition.

use std::ops::Range;

use glam::DVec3;

use super::{Faces, Frame};
use crate::error::Error;
use crate::exact::lattice::MAX_TOLERANCE;
use crate::exact::{Flattener, Plane, cross, have_area, is_convex};
use crate::memory::{push, reserve};

impl Faces {
    /// Puts the faces of some polygons into one plane: that of three of their corners, far apart. The
    /// other corners are moved onto it, as those of one polygon are onto its own plane.
    ///
    /// Corners are rounded, so polygons of one plane have planes of their own. Extended to another
    /// polygon, the plane of a small one is off by the rounding times the ratio of their sizes. Corners
    /// that are far apart bound that ratio for all of the polygons.
    ///
    /// A face that is not convex as seen along the plane's main axis keeps its own plane: it is so thin
    /// that rounding decides its shape. A tree of such faces has no mesh, no drawing and no file, which
    /// know frames of a face's own corners alone.
    pub(crate) fn put_into_one_plane(&mut self, polygons: &[u32]) -> Result<(), Error> {
        let Some(triangle) = self.far_apart(polygons) else { return Ok(()) };
        if self.planes.is_empty() {
            let mut planes = std::mem::take(&mut self.planes);
            reserve(&mut planes, self.len())?;
            planes.extend((0..self.len() as u32).map(|face| self.reference_triangle(face)));
            self.planes = planes;
        }
        let known = self.moved.len();
        for &polygon in polygons {
            for face in self.faces_of(polygon) {
                self.move_onto(triangle, face, known)?;
            }
        }
        self.moved.sort_unstable_by_key(|&(corner, _)| corner);
        Ok(())
    }

    /// Moves a face onto the plane of three corners. Of the corners that were moved, the first `known`
    /// are in ascending order.
    fn move_onto(&mut self, triangle: [u32; 3], face: u32, known: usize) -> Result<(), Error> {
        let points = triangle.map(|corner| self.corner(corner));
        let plane = Plane::through(points);
        let axis = plane.main_axis();
        let flattener = Flattener::new(points, axis);
        let (range, own) = (self.corner_range(face), self.triangle(face));
        let corners = &self.corners[range.clone()];
        let is_near = |corner| flattener.off(corner).distance <= MAX_TOLERANCE;
        if !is_convex(corners.len(), |k| corners[k], axis) || !corners.iter().all(is_near) {
            return Ok(());
        }
        for corner in range {
            let given = self.corners[corner];
            let steps = flattener.off(&given).steps;
            if steps == 0.0 || triangle.contains(&(corner as u32)) {
                continue;
            }
            self.corners[corner][axis] -= steps;
            let corner = corner as u32;
            if self.moved[..known].binary_search_by_key(&corner, |&(moved, _)| moved).is_err() {
                push(&mut self.moved, (corner, given))?;
            }
        }
        let [_, second, third] = self.faces[face as usize].frame.triangle().map(|k| k as usize);
        self.faces[face as usize].frame = Frame::new(second, third, Some(axis));
        // Both have their fronts on one side.
        let [a, b, c] = triangle;
        let [p, q, r] = own;
        let is_reversed = (cross(p, q, r)[axis] > 0) != (plane.normal()[axis] > 0);
        self.planes[face as usize] = if is_reversed { [a, c, b] } else { [a, b, c] };
        Ok(())
    }

    /// The faces of a polygon.
    fn faces_of(&self, polygon: u32) -> Range<u32> {
        let first = self.faces.partition_point(|face| face.polygon < polygon);
        let faces = self.faces[first..].iter().take_while(|face| face.polygon == polygon);
        first as u32..(first + faces.count()) as u32
    }

    /// Three corners of some polygons that span a large triangle; `None` if the polygons have one face
    /// at most, or all corners are on one line.
    fn far_apart(&self, polygons: &[u32]) -> Option<[u32; 3]> {
        let faces = || polygons.iter().flat_map(|&polygon| self.faces_of(polygon));
        let corners = || faces().flat_map(|face| self.corner_range(face));
        faces().nth(1)?;
        let point = |corner: usize| DVec3::from(self.corners[corner]);
        let furthest = |of: &dyn Fn(usize) -> f64| {
            let larger = |best: (f64, usize), corner| {
                let size = of(corner);
                if size > best.0 { (size, corner) } else { best }
            };
            corners().fold((f64::NEG_INFINITY, 0), larger).1
        };
        let first = point(corners().next()?);
        let a = furthest(&|corner| point(corner).distance_squared(first));
        let b = furthest(&|corner| point(corner).distance_squared(point(a)));
        let arm = point(b) - point(a);
        let c = furthest(&|corner| (point(corner) - point(a)).cross(arm).length_squared());
        have_area([a, b, c].map(|corner| self.corners[corner]))
            .then_some([a, b, c].map(|c| c as u32))
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::Faces;
    use crate::exact::PlaneId;

    /// A large square, and a small one with its front on the other side, whose plane is off by more than the
    /// tolerance where the large one ends.
    #[test]
    fn polygons_put_into_one_plane_share_it_and_keep_their_fronts() {
        let square = |x: f64, size: f64| {
            [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]].map(|[u, v]| {
                let (x, y) = (x + u * size, v * size);
                DVec3::new(x, y, 0.3 * x + 0.7 * y)
            })
        };
        for reversed in 0..2 {
            let mut squares = [square(0.1, 1e-7), square(-1.0, 2.0)];
            squares[reversed].reverse();
            let mut faces = Faces::new(squares, Some(1e-9)).unwrap().0;
            let front =
                |faces: &Faces, face| faces.plane(PlaneId::face(face)).normal_f64().normalize();
            let before = [0, 1].map(|face| front(&faces, face));
            faces.put_into_one_plane(&[0, 1]).unwrap();
            let [a, b] = [0, 1].map(|face| {
                let mut triangle = faces.reference_triangle(face);
                triangle.sort_unstable();
                triangle
            });
            assert_eq!(a, b);
            for (face, before) in (0..).zip(before) {
                assert!(front(&faces, face).dot(before) > 0.9, "{face}");
            }
        }
    }
}
