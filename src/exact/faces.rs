//! The faces of a scene: convex, planar, on the lattice.

use std::fmt;
use std::ops::Range;

#[cfg(feature = "layers")]
use glam::DVec3;

use super::classify::Side;
use super::lattice::{LIMIT, MAX_TOLERANCE};
use super::names::MAX_NAMES;
#[cfg(any(feature = "save", feature = "validate"))]
use super::names::PlaneKind;
use super::plane::{RoundedNormal, have_area};
#[cfg(feature = "layers")]
use super::{Flattener, cross, is_convex};
use super::{Lattice, PlaneId};
use crate::error::{Error, Kind};
use crate::memory::{collect, push, reserve};

/// The faces of a scene: convex planar polygons, with corners on the scene's [grid](crate::Grid). Each face
/// belongs to one input polygon.
///
/// An input polygon becomes one face if it is convex, has at most 32 768 corners, and lies in one plane
/// within the [tolerance](crate::BspTree#exactness). Any other polygon becomes triangles. Three corners of a
/// face, far apart, define the face's plane. Every other corner is moved onto this plane, parallel to an
/// axis: the axis that is most nearly perpendicular to the plane. The grid point nearest to the moved corner
/// is stored.
#[derive(Clone, Default)]
pub struct Faces {
    pub(crate) lattice: Lattice,
    pub(crate) tolerance: f64,
    pub(crate) corners: Vec<[f64; 3]>,
    /// For the faces in `numbered`: the number of each corner within its polygon, with [`INNER`]
    /// set if the edge to the next corner is not an edge of the polygon. The corners of all other
    /// faces are numbered 0, 1, 2, ….
    pub(crate) numbers: Vec<u32>,
    /// Faces with explicit corner numbers, and the index of each face's first number in `numbers`.
    pub(crate) numbered: Vec<(u32, u32)>,
    pub(crate) faces: Vec<Face>,
    /// The corners, counted over all faces, that were moved onto their face's plane, with their positions
    /// before the move. In ascending order.
    pub(crate) moved: Vec<(u32, [f64; 3])>,
    /// For each face, the three corners that define its plane. Empty if every face's plane is defined by its
    /// own reference triangle.
    pub(crate) planes: Vec<[u32; 3]>,
    pub(crate) thin: Thin,
}

impl fmt::Debug for Faces {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Faces")
            .field("lattice", &self.lattice)
            .field("tolerance", &self.tolerance)
            .field("corners", &self.corners.len())
            .field("faces", &self.faces.len())
            .finish_non_exhaustive()
    }
}

/// The number of faces at the end that have no area: first segments, then points, then borders.
///
/// A segment has three corners: its ends, and a corner that is not collinear with them. The third corner is
/// never drawn: it selects one of the planes through the segment. A point has one corner, and no plane. A border is no
/// shape and does not count as a face: it only defines a plane, through an edge of a face.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Thin {
    pub(crate) segments: usize,
    pub(crate) points: usize,
    pub(crate) borders: usize,
}

/// Marks a corner if the edge from this corner to the next is not an edge of the polygon.
pub(crate) const INNER: u32 = 1 << 31;

/// The first of a face's corners, its polygon, and the corners that span its plane.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Face {
    pub(crate) start: u32,
    pub(crate) polygon: u32,
    pub(crate) frame: Frame,
}

/// The reference triangle of a face (the face's corners 0, `second` and `third`), and the axis along which
/// the face's other corners are moved onto the triangle's plane, if any corner is off that plane.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Frame(pub(super) u32);

impl Frame {
    /// The largest number of corners of a face.
    pub(crate) const MAX_CORNERS: usize = 1 << 15;
    /// The frame of a triangle.
    pub(crate) const TRIANGLE: Self = Self::new(1, 2, None);
    /// The frame of a point, which has no plane.
    pub(crate) const POINT: Self = Self::new(0, 0, None);

    pub(crate) const fn new(second: usize, third: usize, moved: Option<usize>) -> Self {
        let axis = match moved {
            Some(axis) => axis as u32,
            None => 3,
        };
        Self(axis << 30 | (second as u32) << 15 | third as u32)
    }

    pub(crate) const fn triangle(self) -> [u32; 3] {
        [0, self.0 >> 15 & 0x7fff, self.0 & 0x7fff]
    }

    pub(crate) const fn moved_axis(self) -> Option<usize> {
        if self.0 >> 30 == 3 { None } else { Some((self.0 >> 30) as usize) }
    }
}

impl Faces {
    /// Returns the number of faces, without borders.
    pub fn len(&self) -> usize {
        self.faces.len() - self.thin.borders
    }

    /// Returns whether there are no faces.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Returns the grid that the corners lie on.
    #[doc(hidden)]
    pub fn lattice(&self) -> &Lattice {
        &self.lattice
    }

    /// Returns the coplanar tolerance in lattice units.
    #[doc(hidden)]
    pub fn tolerance(&self) -> f64 {
        self.tolerance
    }

    /// Returns the index of the polygon that a face belongs to.
    #[inline]
    pub fn polygon(&self, face: u32) -> usize {
        self.faces[face as usize].polygon as usize
    }

    /// Returns the lattice points of a face's corners, counter-clockwise seen from its front.
    #[doc(hidden)]
    #[inline]
    pub fn corners(&self, face: u32) -> &[[f64; 3]] {
        &self.corners[self.corner_range(face)]
    }

    /// Whether the face or the corner that a plane's name refers to exists.
    #[cfg(any(feature = "save", feature = "validate"))]
    pub(crate) fn has_plane(&self, plane: PlaneId) -> bool {
        match plane.kind() {
            PlaneKind::Face(face) => (face as usize) < self.len(),
            PlaneKind::Axis(axis, corner) => axis < 3 && (corner as usize) < self.corners.len(),
        }
    }

    /// Returns the range of a face's corners in the list of all corners.
    #[doc(hidden)]
    #[inline]
    pub fn corner_range(&self, face: u32) -> Range<usize> {
        let face = face as usize;
        let end = self.faces.get(face + 1).map_or(self.corners.len(), |next| next.start as usize);
        self.faces[face].start as usize..end
    }

    /// The first face that has no area: an overlay's segments and points follow its polygons.
    pub(crate) fn first_thin(&self) -> usize {
        self.first_point() - self.thin.segments
    }

    /// The first face that is a point.
    pub(crate) fn first_point(&self) -> usize {
        self.len() - self.thin.points
    }

    /// Whether a face is a polygon, not a segment or a point.
    pub(crate) fn has_area(&self, face: u32) -> bool {
        (face as usize) < self.first_thin()
    }

    /// The number of leading corners that belong to a face: two for a segment, one for a point, and all
    /// corners for other faces.
    pub(crate) fn reach(&self, face: u32) -> usize {
        if self.has_area(face) {
            self.corner_range(face).len()
        } else if (face as usize) < self.first_point() {
            2
        } else {
            1
        }
    }

    /// Adds a border: a plane through edge `k` of a face, along the axis nearest to the face's normal. Returns `None` if
    /// the face is so thin that this plane is not defined.
    pub(crate) fn push_border(&mut self, face: u32, k: u32) -> Result<Option<PlaneId>, Error> {
        let corners = self.corners(face);
        let [p, q] = [k as usize, (k as usize + 1) % corners.len()].map(|k| corners[k]);
        let axis = RoundedNormal::through(self.triangle(face)).dominant_axis();
        // As long as the edge, towards the middle of the grid.
        let length = (0..3).map(|i| (q[i] - p[i]).abs()).fold(0.0, f64::max).min(LIMIT);
        let mut r = p;
        r[axis] += if p[axis] < 0.0 { length } else { -length };
        if !have_area([p, q, r]) {
            return Ok(None);
        }
        let border = self.faces.len() as u32;
        self.push(0, [p, q, r].into_iter(), Frame::TRIANGLE)?;
        self.thin.borders += 1;
        Ok(Some(PlaneId::face(border)))
    }

    /// Returns the lattice point of a corner, counted over all faces.
    #[doc(hidden)]
    #[inline]
    pub fn corner(&self, corner: u32) -> [f64; 3] {
        self.corners[corner as usize]
    }

    /// The lattice point of a corner, counted over all faces, before it was moved onto its face's plane.
    /// Polygons that share a corner in the input have equal points here.
    pub(crate) fn given_corner(&self, corner: u32) -> [f64; 3] {
        match self.moved.binary_search_by_key(&corner, |&(corner, _)| corner) {
            Ok(at) => self.moved[at].1,
            Err(_) => self.corner(corner),
        }
    }

    /// Returns the three corners, counted over all faces, that define a face's plane.
    #[doc(hidden)]
    #[inline]
    pub fn reference_triangle(&self, face: u32) -> [u32; 3] {
        match self.planes.get(face as usize) {
            Some(&triangle) => triangle,
            None => self.own_triangle(face),
        }
    }

    #[inline]
    fn own_triangle(&self, face: u32) -> [u32; 3] {
        let face = &self.faces[face as usize];
        face.frame.triangle().map(|k| face.start + k)
    }

    /// Whether corners of the face itself define its plane.
    pub(crate) fn has_own_plane(&self, face: u32) -> bool {
        self.reference_triangle(face) == self.own_triangle(face)
    }

    /// Adds a face.
    pub(crate) fn push(
        &mut self,
        polygon: usize,
        corners: impl ExactSizeIterator<Item = [f64; 3]>,
        frame: Frame,
    ) -> Result<(), Error> {
        let start = self.corners.len();
        if start + corners.len() >= MAX_NAMES {
            return Err(Kind::CornersInAll(MAX_NAMES).error());
        }
        // Reserve both lists first: corners without a face would belong to the previous face.
        reserve(&mut self.corners, corners.len())?;
        reserve(&mut self.faces, 1)?;
        self.corners.extend(corners);
        self.faces.push(Face { start: start as u32, polygon: polygon as u32, frame });
        Ok(())
    }

    /// The corners that define a face's plane.
    #[inline]
    pub(crate) fn triangle(&self, face: u32) -> [[f64; 3]; 3] {
        self.reference_triangle(face).map(|corner| self.corner(corner))
    }

    /// Returns the numbers of the polygons that have no face, out of `polygons` prepared polygons.
    #[doc(hidden)]
    pub fn dropped(&self, polygons: usize) -> impl Iterator<Item = usize> + Clone {
        let mut faces = (0..self.len() as u32).map(|face| self.polygon(face)).peekable();
        (0..polygons).filter(move |&polygon| {
            let is_dropped = faces.next_if_eq(&polygon).is_none();
            while faces.next_if_eq(&polygon).is_some() {}
            is_dropped
        })
    }

    /// Returns the number of corners of all faces.
    #[doc(hidden)]
    pub fn corner_count(&self) -> usize {
        self.corners.len()
    }

    /// The axis along which the corners of a face are moved onto its plane, or `None` if all corners lie
    /// exactly on the plane. An edge of a face with moved corners lies in the plane through the edge's two
    /// lattice points and along that axis.
    #[inline]
    pub(crate) fn moved_axis(&self, face: u32) -> Option<usize> {
        self.faces[face as usize].frame.moved_axis()
    }

    /// Returns the number, within the polygon, of corner `k` of a face.
    #[doc(hidden)]
    pub fn corner_number(&self, face: u32, k: u32) -> u32 {
        self.number(face, k) & !INNER
    }

    /// Returns the number of the polygon's edge that contains a face's edge `k`: the number of the corner
    /// where the polygon's edge begins. `None` for an edge made by triangulation. If a polygon touches itself
    /// or traverses an edge twice, those edges may be `None` as well.
    #[doc(hidden)]
    pub fn outline_edge(&self, face: u32, k: u32) -> Option<u32> {
        let number = self.number(face, k);
        (number & INNER == 0).then_some(number)
    }

    fn number(&self, face: u32, k: u32) -> u32 {
        match self.numbered.binary_search_by_key(&face, |&(face, _)| face) {
            Ok(at) => self.numbers[self.numbered[at].1 as usize + k as usize],
            Err(_) => k,
        }
    }

    pub(crate) fn clear(&mut self) {
        self.corners.clear();
        self.numbers.clear();
        self.numbered.clear();
        self.faces.clear();
        self.moved.clear();
        self.planes.clear();
        self.thin = Thin::default();
    }

    /// An empty set of faces with the same lattice and tolerance.
    pub(crate) fn without_faces(&self) -> Self {
        let Self { lattice, tolerance, .. } = *self;
        Self { lattice, tolerance, ..Self::default() }
    }

    /// Copies the faces; an error if memory runs out.
    pub(crate) fn try_clone(&self) -> Result<Self, Error> {
        let Self { lattice, tolerance, ref corners, ref numbers, ref numbered, .. } = *self;
        let Self { ref faces, ref moved, ref planes, thin, .. } = *self;
        Ok(Self {
            lattice,
            tolerance,
            corners: collect(corners.iter().copied())?,
            numbers: collect(numbers.iter().copied())?,
            numbered: collect(numbered.iter().copied())?,
            faces: collect(faces.iter().copied())?,
            moved: collect(moved.iter().copied())?,
            planes: collect(planes.iter().copied())?,
            thin,
        })
    }

    /// Frees unused capacity.
    pub(crate) fn shrink_to_fit(&mut self) {
        self.corners.shrink_to_fit();
        self.numbers.shrink_to_fit();
        self.numbered.shrink_to_fit();
        self.faces.shrink_to_fit();
        self.moved.shrink_to_fit();
        self.planes.shrink_to_fit();
    }

    /// Adds the faces of later polygons.
    pub(crate) fn append(&mut self, next: Self) -> Result<(), Error> {
        let (corners, numbers) = (self.corners.len(), self.numbers.len() as u32);
        if corners + next.corners.len() >= MAX_NAMES {
            return Err(Kind::CornersInAll(MAX_NAMES).error());
        }
        let first = self.faces.len() as u32;
        let numbered = next.numbered.iter();
        reserve(&mut self.numbered, numbered.len())?;
        self.numbered.extend(numbered.map(|&(face, at)| (first + face, numbers + at)));
        reserve(&mut self.numbers, next.numbers.len())?;
        self.numbers.extend(next.numbers);
        reserve(&mut self.corners, next.corners.len())?;
        self.corners.extend(next.corners);
        reserve(&mut self.faces, next.faces.len())?;
        let moved = |face: Face| Face { start: face.start + corners as u32, ..face };
        self.faces.extend(next.faces.into_iter().map(moved));
        let moved = next.moved.into_iter();
        reserve(&mut self.moved, moved.len())?;
        self.moved.extend(moved.map(|(corner, given)| (corner + corners as u32, given)));
        Ok(())
    }

    /// Removes the faces from number `faces` on, and all faces without area.
    pub(crate) fn truncate(&mut self, faces: usize) {
        self.thin = Thin::default();
        self.planes.truncate(faces);
        let Some(face) = self.faces.get(faces) else { return };
        let (corners, first) = (face.start, faces as u32);
        self.faces.truncate(faces);
        self.corners.truncate(corners as usize);
        let numbered = self.numbered.partition_point(|&(face, _)| face < first);
        if let Some(&(_, numbers)) = self.numbered.get(numbered) {
            self.numbers.truncate(numbers as usize);
        }
        self.numbered.truncate(numbered);
        self.moved.truncate(self.moved.partition_point(|&(corner, _)| corner < corners));
    }

    /// Returns the memory that the faces occupy, in bytes.
    pub fn memory_usage(&self) -> usize {
        size_of_val(&*self.corners)
            + size_of_val(&*self.numbers)
            + size_of_val(&*self.numbered)
            + size_of_val(&*self.faces)
            + size_of_val(&*self.moved)
            + size_of_val(&*self.planes)
    }
}

// A cell of a larger scene: a box between lattice planes, to which faces are cut. The box's two corners are
// stored before the corners of all faces and belong to no face, so planes through them have names like planes
// through corners of faces.

/// A box by its lower and its upper corner, in lattice units.
pub(crate) type CellBox = [[f64; 3]; 2];

/// The magnitude of the coordinate of a side without a plane: beyond all lattice points, and within the
/// limits of the predicates.
const OPEN: f64 = LIMIT + MAX_TOLERANCE;
/// A cell without planes: the whole lattice.
pub(crate) const EVERYWHERE: CellBox = [[-OPEN; 3], [OPEN; 3]];

impl Faces {
    /// An empty set of faces that are to be cut to a cell.
    pub(crate) fn of_cell(lattice: Lattice, tolerance: f64, cell: CellBox) -> Self {
        Self { lattice, tolerance, corners: cell.to_vec(), ..Self::default() }
    }

    /// The number of corners that belong to no face; these corners are first.
    pub(crate) fn corners_of_cell(&self) -> usize {
        self.faces.first().map_or(self.corners.len(), |face| face.start as usize)
    }

    /// The two corners of the cell; empty without a cell.
    pub(crate) fn cell(&self) -> &[[f64; 3]] {
        &self.corners[..self.corners_of_cell()]
    }

    /// The planes that bound the cell, and the cell's side of each plane.
    pub(crate) fn planes_of_cell(&self) -> impl Iterator<Item = (PlaneId, Side)> {
        self.cell().iter().zip([(0, Side::Front), (1, Side::Back)]).flat_map(
            |(corner, (k, side))| {
                let axes = (0..3).filter(|&axis| corner[axis].abs() < OPEN);
                axes.map(move |axis| (PlaneId::axis(axis, k), side))
            },
        )
    }

    /// Whether `corners` can bound a cell.
    #[cfg(feature = "save")]
    pub(crate) fn is_cell(corners: &[[f64; 3]]) -> bool {
        let is_side = |c: f64, open: f64| c.abs() <= LIMIT || c == open;
        match corners {
            [low, high] => {
                low.iter().all(|&c| is_side(c, -OPEN)) && high.iter().all(|&c| is_side(c, OPEN))
            }
            _ => corners.is_empty(),
        }
    }

    /// Removes all faces that are not in `kept`, a list in ascending order.
    pub(crate) fn keep(&mut self, kept: &[u32]) -> Result<(), Error> {
        let (mut numbered, mut numbers, mut moved) = (vec![], vec![], vec![]);
        let mut start = self.corners_of_cell();
        // Faces and corners are moved down in place, so no item is overwritten before it is read.
        for (new, &face) in kept.iter().enumerate() {
            let range = self.corner_range(face);
            if let Ok(at) = self.numbered.binary_search_by_key(&face, |&(face, _)| face) {
                let first = self.numbered[at].1 as usize;
                push(&mut numbered, (new as u32, numbers.len() as u32))?;
                reserve(&mut numbers, range.len())?;
                numbers.extend_from_slice(&self.numbers[first..first + range.len()]);
            }
            let [first, end] = [range.start, range.end]
                .map(|end| self.moved.partition_point(|&(corner, _)| (corner as usize) < end));
            let down = (range.start - start) as u32;
            reserve(&mut moved, end - first)?;
            moved.extend(self.moved[first..end].iter().map(|&(corner, p)| (corner - down, p)));
            self.faces[new] = Face { start: start as u32, ..self.faces[face as usize] };
            self.corners.copy_within(range.clone(), start);
            start += range.len();
        }
        self.faces.truncate(kept.len());
        self.corners.truncate(start);
        (self.numbered, self.numbers, self.moved) = (numbered, numbers, moved);
        Ok(())
    }
}

#[cfg(feature = "layers")]
impl Faces {
    /// Puts the faces of some polygons into one plane: the plane through three corners of these polygons that
    /// are far apart. The other corners are moved onto this plane, like the corners of one polygon onto its
    /// own plane.
    ///
    /// Corners are rounded, so polygons meant for one plane have different planes. Extended to another
    /// polygon, the plane of a small polygon is off by the rounding error times the ratio of the two
    /// polygons' sizes. Corners that are far apart bound that ratio for all polygons.
    ///
    /// A face that is not convex in a projection along the plane's main axis keeps its own plane: such a face
    /// is so thin that rounding decides its shape. A tree with common planes has no mesh, no drawing and no
    /// file, because meshes, drawings and files support only planes through a face's own corners.
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
                self.move_onto(triangle, face, known);
            }
        }
        self.moved.sort_unstable_by_key(|&(corner, _)| corner);
        Ok(())
    }

    /// Moves a face onto the plane of three corners. The first `known` items of `moved` are in ascending
    /// order.
    fn move_onto(&mut self, triangle: [u32; 3], face: u32, known: usize) {
        let points = triangle.map(|corner| self.corner(corner));
        let flattener = Flattener::new(points);
        let Flattener { plane, axis, .. } = flattener;
        let (range, own) = (self.corner_range(face), self.triangle(face));
        let corners = &self.corners[range.clone()];
        let is_near = |corner| flattener.off(corner).distance <= MAX_TOLERANCE;
        if !is_convex(corners.len(), |k| corners[k], axis) || !corners.iter().all(is_near) {
            return;
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
                self.moved.push((corner, given));
            }
        }
        let [_, second, third] = self.faces[face as usize].frame.triangle().map(|k| k as usize);
        self.faces[face as usize].frame = Frame::new(second, third, Some(axis));
        // Both planes have their fronts on the same side.
        let [a, b, c] = triangle;
        let [p, q, r] = own;
        let is_reversed = (cross(p, q, r)[axis] > 0) != (plane.normal()[axis] > 0);
        self.planes[face as usize] = if is_reversed { [a, c, b] } else { [a, b, c] };
    }

    /// The faces of a polygon.
    fn faces_of(&self, polygon: u32) -> Range<u32> {
        let first = self.faces.partition_point(|face| face.polygon < polygon);
        let faces = self.faces[first..].iter().take_while(|face| face.polygon == polygon);
        first as u32..(first + faces.count()) as u32
    }

    /// Three corners of some polygons that span a large triangle; `None` if the polygons have at most one
    /// face, or all corners are collinear.
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

#[cfg(all(test, feature = "layers"))]
mod tests;
