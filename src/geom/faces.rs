//! The faces of a scene: convex, planar, on the lattice.

use super::Lattice;
use super::prepare::Preparation;

/// The faces of a scene in lattice coordinates, each convex and planar, each of one input polygon.
///
/// Polygons that are convex, have at most 32 768 corners, and lie within the tolerance of one plane
/// are one face; others are several triangles. The corners of a face that do not lie exactly on the plane of its
/// reference triangle are *defined* to lie on it, moved along the axis in which the plane is least
/// steep; what is kept of them is the lattice point nearest to that.
#[derive(Clone, Debug)]
pub struct Faces {
    pub(super) lattice: Lattice,
    pub(super) tolerance: f64,
    pub(super) corners: Vec<[f64; 3]>,
    /// The number within its polygon of the corners of some faces, with [`INNER`] where the edge
    /// to the next is none of the polygon's. Those of all others count up from 0.
    pub(super) numbers: Vec<u32>,
    /// These faces, and where their numbers begin.
    pub(super) numbered: Vec<(u32, u32)>,
    pub(super) faces: Vec<Face>,
}

/// Marks corners from which the edge to the next is none of the polygon's.
pub(super) const INNER: u32 = 1 << 31;

/// Where a face's corners begin, what it came from, and which of its corners span its plane.
#[derive(Clone, Copy, Debug)]
pub(super) struct Face {
    pub(super) start: u32,
    pub(super) polygon: u32,
    pub(super) frame: Frame,
}

/// The reference triangle of a face, its corners 0, `second` and `third`, and the axis along which
/// its other corners are taken to its plane, unless they lie on it as they are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Frame(u32);

impl Frame {
    /// The most corners of a face.
    pub(super) const MAX_CORNERS: usize = 1 << 15;
    /// That of a triangle.
    pub(super) const TRIANGLE: Self = Self::new(1, 2, None);

    pub(super) const fn new(second: usize, third: usize, drop: Option<usize>) -> Self {
        let axis = match drop {
            Some(axis) => axis as u32,
            None => 3,
        };
        Self(axis << 30 | (second as u32) << 15 | third as u32)
    }

    pub(super) const fn triangle(self) -> [u32; 3] {
        [0, self.0 >> 15 & 0x7fff, self.0 & 0x7fff]
    }

    pub(super) const fn drop_axis(self) -> Option<usize> {
        if self.0 >> 30 == 3 { None } else { Some((self.0 >> 30) as usize) }
    }
}

impl Faces {
    /// How many faces there are.
    pub fn len(&self) -> usize {
        self.faces.len()
    }

    /// Whether there is no face.
    pub fn is_empty(&self) -> bool {
        self.faces.is_empty()
    }

    /// The grid that the corners lie on.
    pub fn lattice(&self) -> &Lattice {
        &self.lattice
    }

    /// The coplanar tolerance in lattice units.
    pub fn tolerance(&self) -> f64 {
        self.tolerance
    }

    /// The index of the polygon that a face is, or is part of.
    #[inline]
    pub fn polygon(&self, face: u32) -> u32 {
        self.faces[face as usize].polygon
    }

    /// The lattice points of a face's corners, counter-clockwise seen from its front.
    #[inline]
    pub fn corners(&self, face: u32) -> &[[f64; 3]] {
        &self.corners[self.corner_range(face)]
    }

    /// The corners of a face among those of all faces.
    #[inline]
    pub fn corner_range(&self, face: u32) -> std::ops::Range<usize> {
        let face = face as usize;
        let end = self.faces.get(face + 1).map_or(self.corners.len(), |next| next.start as usize);
        self.faces[face].start as usize..end
    }

    /// The lattice point of a corner, counted over all faces.
    #[inline]
    pub fn corner(&self, corner: u32) -> [f64; 3] {
        self.corners[corner as usize]
    }

    /// The three corners, counted over all faces, that define a face's plane.
    #[inline]
    pub fn reference_triangle(&self, face: u32) -> [u32; 3] {
        let face = &self.faces[face as usize];
        face.frame.triangle().map(|k| face.start + k)
    }

    /// The polygons without a face, by number, among those that were prepared together.
    pub fn dropped(&self, preparation: &Preparation) -> impl Iterator<Item = usize> {
        let mut faces = (0..self.len() as u32).map(|face| self.polygon(face) as usize).peekable();
        (0..preparation.polygons).filter(move |&polygon| {
            let is_dropped = faces.next_if_eq(&polygon).is_none();
            while faces.next_if_eq(&polygon).is_some() {}
            is_dropped
        })
    }

    /// How many corners all faces have together.
    pub fn corner_count(&self) -> usize {
        self.corners.len()
    }

    /// The axis along which the corners of a face are taken to its plane; `None` for a face whose
    /// corners lie exactly on it. The edges of the former are cut out by the planes through their
    /// ends and along that axis.
    #[inline]
    pub(crate) fn upright_axis(&self, face: u32) -> Option<usize> {
        self.faces[face as usize].frame.drop_axis()
    }

    /// The number within its polygon of a face's corner `k`.
    pub fn corner_number(&self, face: u32, k: u32) -> u32 {
        self.number(face, k) & !INNER
    }

    /// The number of the polygon's edge that a face's edge `k` is, counted by the corner where it
    /// begins; `None` for one made by triangulation.
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

    /// The resident size in bytes.
    pub fn bytes(&self) -> usize {
        size_of_val(&*self.corners)
            + size_of_val(&*self.numbers)
            + size_of_val(&*self.numbered)
            + size_of_val(&*self.faces)
    }
}
