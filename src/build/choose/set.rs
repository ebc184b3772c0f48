//! A set of pieces for choosing a plane: the pieces themselves, and the pieces packed in single precision,
//! four at a time.

use std::ops::Range;

use glam::{DVec3, Vec3, Vec4};

use super::cost::Counts;
use crate::build::piece::{Division, Piece};
use crate::exact::{Faces, PlaneId, PlaneKind, PreparedPlane, Side, Vertex};

/// The number of pieces that are compared with a plane at once.
pub(super) const LANES: usize = 4;

/// Pieces of a set, relative to the middle of the set's box, and rounded to `f32`.
///
/// Packed pieces rank planes, and rounding may change the ranks. A result that is called certain is also true
/// of the exact pieces: it allows for rounding errors and the tolerance.
#[derive(Debug, Default)]
pub(super) struct PackedPieces {
    middle: DVec3,
    /// The largest error of a distance, plus the tolerance, in lattice units like all coordinates.
    slack: f32,
    /// The tolerance, in lattice units.
    tolerance: f32,
    /// The vertices of each group of pieces: the first vertices of all four pieces, then the second vertices,
    /// and so on. A piece with fewer vertices repeats its last vertex.
    rows: Vec<[Vec4; 3]>,
    /// The end of each group's rows.
    ends: Vec<u32>,
    /// The number of each piece in its set, group by group.
    numbers: Vec<u32>,
    /// For each group, 1 where there is a piece, and 0 where the last group is not full.
    lanes: Vec<Vec4>,
}

/// A plane in the coordinates of packed pieces: a unit normal, and the plane's distance from the middle of
/// the set's box.
#[derive(Clone, Copy, Debug)]
pub(super) struct PackedPlane {
    normal: [f32; 3],
    offset: f32,
}

/// Pieces of a group as bits: the pieces that certainly reach in front of a plane, the pieces that certainly
/// reach behind it, and the pieces that may come within twice the tolerance of the plane.
#[derive(Clone, Copy, Debug)]
pub(super) struct Reach {
    pub(super) front: u8,
    pub(super) back: u8,
    pub(super) near: u8,
}

/// A box around some pieces: its middle, and half its size.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct PackedBox {
    middle: Vec3,
    half: Vec3,
}

impl PackedPieces {
    /// Removes all pieces.
    pub(super) fn clear(&mut self) {
        self.rows.clear();
        self.ends.clear();
        self.numbers.clear();
        self.lanes.clear();
    }

    /// Removes all pieces, and sets the extent of another set.
    pub(super) fn reset(&mut self, set: &Set<'_>) {
        self.clear();
        let (min, max) = (DVec3::from_array(set.min), DVec3::from_array(set.max));
        self.middle = 0.5 * (min + max);
        let size = (max - self.middle).max(self.middle - min).max_element();
        // In units of u · size, with u = 2⁻²⁴ = ε / 2: the normal adds 2√3 between a vertex and the plane's
        // point, both in the box. The vertex adds √3, the three products with the normal √3, the two sums of
        // these products √2 + √3, the offset √3, and the sum of offset and slack √3. The total is 13.5, less
        // than 7 ε. Vertex and point are off by 1.5 lattice units in each coordinate: 3√3. The tolerance is
        // rounded to `f32` and in two sums: 3 u times the tolerance, less than 2 ε times.
        let tolerance = set.faces.tolerance() * (1.0 + 2.0 * f64::from(f32::EPSILON));
        self.tolerance = tolerance as f32;
        self.slack = size as f32 * 7.0 * f32::EPSILON + 6.0 + self.tolerance;
    }

    /// Adds pieces of the set, by number.
    pub(super) fn extend(&mut self, set: &Set<'_>, numbers: impl ExactSizeIterator<Item = usize>) {
        debug_assert!(self.numbers.len().is_multiple_of(LANES), "the last group is full");
        let first = self.numbers.len();
        self.numbers.reserve(numbers.len());
        self.numbers.extend(numbers.map(|number| number as u32));
        for start in (first..self.numbers.len()).step_by(LANES) {
            self.add_group(set, start);
        }
    }

    fn add_group(&mut self, set: &Set<'_>, start: usize) {
        let group = &self.numbers[start..self.numbers.len().min(start + LANES)];
        let vertices = group.iter().map(|&piece| set.vertices(piece as usize)).max().unwrap_or(0);
        let row = self.rows.len();
        self.rows.reserve(vertices);
        self.rows.resize(row + vertices, [Vec4::ZERO; 3]);
        let rows = &mut self.rows[row..];
        for lane in 0..LANES {
            let piece = group[lane.min(group.len() - 1)] as usize;
            let mut next = 0;
            let mut last = [0.0; 3];
            set.for_each_vertex(piece, |vertex| {
                last = (DVec3::from_array(vertex) - self.middle).as_vec3().to_array();
                for (column, c) in rows[next].iter_mut().zip(last) {
                    column[lane] = c;
                }
                next += 1;
            });
            for row in &mut rows[next..] {
                for (column, c) in row.iter_mut().zip(last) {
                    column[lane] = c;
                }
            }
        }
        self.ends.push(self.rows.len() as u32);
        let lane = |lane| if lane < group.len() { 1.0 } else { 0.0 };
        self.lanes.push(Vec4::from_array([0, 1, 2, 3].map(lane)));
    }

    /// The number of pieces.
    pub(super) fn len(&self) -> usize {
        self.numbers.len()
    }

    pub(super) fn groups(&self) -> usize {
        self.ends.len()
    }

    /// The rows of some groups, at least one group.
    #[inline]
    fn rows_of(&self, groups: Range<usize>) -> Range<usize> {
        let start = groups.start.checked_sub(1).map_or(0, |before| self.ends[before] as usize);
        start..self.ends[groups.end - 1] as usize
    }

    /// Converts the number of a packed piece to the piece's number in the set.
    pub(super) fn number(&self, piece: usize) -> usize {
        self.numbers[piece] as usize
    }

    /// The plane of a piece of the set in the coordinates of the packed pieces.
    #[inline]
    pub(super) fn plane(&self, set: &Set<'_>, piece: usize) -> PackedPlane {
        let (normal, point) = set.rounded_plane(piece);
        let offset = normal.as_dvec3().dot(point - self.middle);
        PackedPlane { normal: normal.to_array(), offset: offset as f32 }
    }

    /// Whether a piece of the set may lie on the plane of the piece `own`.
    pub(super) fn may_be_on(&self, set: &Set<'_>, own: usize, piece: usize) -> bool {
        let (normal, point) = set.rounded_plane(own);
        let (normal, mut is_near) = (normal.as_dvec3(), true);
        set.for_each_vertex(piece, |vertex| {
            let distance = normal.dot(DVec3::from_array(vertex) - point);
            is_near &= distance.abs() <= f64::from(self.slack);
        });
        is_near
    }

    /// Compares the pieces of some groups with a plane. Bits of empty lanes mean nothing.
    #[inline]
    pub(super) fn for_each_reach(
        &self,
        plane: &PackedPlane,
        groups: Range<usize>,
        mut see: impl FnMut(usize, Reach),
    ) {
        let plane = Splat::new(plane, self.slack);
        let tolerance = Vec4::splat(self.tolerance);
        let mut start = groups.start.checked_sub(1).map_or(0, |before| self.ends[before] as usize);
        for group in groups {
            let end = self.ends[group] as usize;
            let (low, high) = plane.extents(&self.rows[start..end]);
            start = end;
            let near = low.cmple(plane.above + tolerance).bitmask()
                & high.cmpge(plane.below - tolerance).bitmask();
            let (front, back) = (high.cmpgt(plane.above), low.cmplt(plane.below));
            let [front, back] = [front, back].map(|lanes| lanes.bitmask() as u8);
            see(group, Reach { front, back, near: near as u8 });
        }
    }

    /// A bit for each lane of a group that holds a piece.
    pub(super) fn lanes(&self, group: usize) -> u8 {
        self.lanes[group].cmpgt(Vec4::ZERO).bitmask() as u8
    }

    /// The box around the pieces of some groups.
    pub(super) fn bounds(&self, groups: Range<usize>) -> PackedBox {
        let mut min = [Vec4::INFINITY; 3];
        let mut max = [Vec4::NEG_INFINITY; 3];
        for row in &self.rows[self.rows_of(groups)] {
            min = [0, 1, 2].map(|axis| min[axis].min(row[axis]));
            max = [0, 1, 2].map(|axis| max[axis].max(row[axis]));
        }
        let min = Vec3::from_array(min.map(|column| column.min_element()));
        let max = Vec3::from_array(max.map(|column| column.max_element()));
        PackedBox { middle: 0.5 * (min + max), half: 0.5 * (max - min) }
    }

    /// The side of a plane on which a box certainly lies: 0 in front, 1 behind; `None` if the box may reach
    /// the plane.
    #[inline]
    pub(super) fn side_of_box(&self, plane: &PackedPlane, around: &PackedBox) -> Option<usize> {
        let normal = Vec3::from_array(plane.normal);
        let distance = normal.dot(around.middle) - plane.offset;
        // The box is rounded once more, and so is its distance.
        let radius = normal.abs().dot(around.half) + 2.0 * self.slack;
        (distance.abs() > radius).then_some(usize::from(distance < 0.0))
    }

    /// Counts the pieces of some groups against a plane.
    #[inline]
    pub(super) fn count(&self, plane: &PackedPlane, groups: Range<usize>) -> Counts {
        let plane = Splat::new(plane, self.slack);
        // Sums above 2²⁴ are rounded in `f32`; they only rank planes.
        let (mut front, mut back, mut both) = (Vec4::ZERO, Vec4::ZERO, Vec4::ZERO);
        let mut start = groups.start.checked_sub(1).map_or(0, |before| self.ends[before] as usize);
        for (&end, &lanes) in self.ends[groups.clone()].iter().zip(&self.lanes[groups]) {
            let (low, high) = plane.extents(&self.rows[start..end as usize]);
            start = end as usize;
            let in_front = Vec4::select(high.cmpgt(plane.above), lanes, Vec4::ZERO);
            let behind = Vec4::select(low.cmplt(plane.below), lanes, Vec4::ZERO);
            front += in_front;
            back += behind;
            both += in_front * behind;
        }
        let [front, back, both] = [front, back, both].map(|sum| sum.element_sum() as u32);
        Counts { front: front - both, back: back - both, splits: both }
    }
}

/// A plane, with each of its numbers copied to all four lanes.
struct Splat {
    normal: [Vec4; 3],
    /// A vertex above `above` along the normal is certainly in front; a vertex below `below` is certainly
    /// behind.
    above: Vec4,
    below: Vec4,
}

impl Splat {
    #[inline]
    fn new(plane: &PackedPlane, slack: f32) -> Self {
        Self {
            normal: plane.normal.map(Vec4::splat),
            above: Vec4::splat(plane.offset + slack),
            below: Vec4::splat(plane.offset - slack),
        }
    }

    /// The rounded extent of each piece of a group along the normal: the smallest and the largest
    /// coordinates.
    #[inline]
    fn extents(&self, rows: &[[Vec4; 3]]) -> (Vec4, Vec4) {
        let [a, b, c] = self.normal;
        let (mut low, mut high) = (Vec4::INFINITY, Vec4::NEG_INFINITY);
        for [x, y, z] in rows {
            let along = *x * a + *y * b + *z * c;
            low = low.min(along);
            high = high.max(along);
        }
        (low, high)
    }
}

/// A set of one or more pieces to divide.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Set<'a> {
    pub(in crate::build) faces: &'a Faces,
    pub(in crate::build) pieces: &'a [Piece],
    pub(in crate::build) arena: &'a [Vertex],
    /// The planes of all faces, if the planes were prepared in advance.
    pub(in crate::build) planes: &'a [PreparedPlane],
    /// The number of planes that separated the pieces from others.
    pub(in crate::build) depth: usize,
    /// The bounding box of the pieces.
    pub(super) min: [f64; 3],
    pub(super) max: [f64; 3],
    /// Along each axis, the smallest end and the largest start of a piece.
    first_end: [f64; 3],
    last_begin: [f64; 3],
}

impl<'a> Set<'a> {
    pub(crate) fn new(faces: &'a Faces, pieces: &'a [Piece], arena: &'a [Vertex]) -> Self {
        let (mut min, mut max) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
        let (mut first_end, mut last_begin) = (min, max);
        // No coordinate is NaN, so a comparison suffices; it takes fewer instructions than `f64::min`.
        let lower = |a: &mut f64, b: f64| *a = if b < *a { b } else { *a };
        let raise = |a: &mut f64, b: f64| *a = if b > *a { b } else { *a };
        for piece in pieces {
            for axis in 0..3 {
                lower(&mut min[axis], piece.min[axis]);
                raise(&mut max[axis], piece.max[axis]);
                lower(&mut first_end[axis], piece.max[axis]);
                raise(&mut last_begin[axis], piece.min[axis]);
            }
        }
        Self { faces, pieces, arena, planes: &[], depth: 0, min, max, first_end, last_begin }
    }

    /// The same set, with the planes of all faces.
    pub(in crate::build) fn with(self, planes: &'a [PreparedPlane]) -> Self {
        Self { planes, ..self }
    }

    /// The same set with its pieces in another list. The box stays.
    pub(super) fn over<'b>(&self, pieces: &'b [Piece]) -> Set<'b>
    where
        'a: 'b,
    {
        Set { pieces, ..*self }
    }

    pub(in crate::build) fn len(&self) -> usize {
        self.pieces.len()
    }

    /// The size of the bounding box.
    pub(super) fn size(&self) -> [f64; 3] {
        std::array::from_fn(|axis| self.max[axis] - self.min[axis])
    }

    /// Whether a plane perpendicular to an axis may cut nothing and yet leave pieces on both sides.
    pub(super) fn may_part(&self, axis: usize) -> bool {
        self.first_end[axis] <= self.last_begin[axis] + self.faces.tolerance()
    }

    /// A stricter test than [`may_part`](Self::may_part): returns false if some piece crosses the plane at
    /// every place. The places are divided into bins, one bit each; a piece covers a bin if it reaches across
    /// the bin. For small sets this takes less time than an unsuccessful sort.
    pub(super) fn may_have_gap(&self, axis: usize) -> bool {
        let tolerance = self.faces.tolerance();
        let (start, end) = (self.first_end[axis], self.last_begin[axis] + tolerance);
        if start >= end {
            return true;
        }
        let per_unit = f64::from(u64::BITS - 1) / (end - start);
        // Larger values are never in earlier bins, so a gap's bin stays free.
        let bin = |value: f64| ((value - start) * per_unit) as u32;
        let below = |bin| 1u64.checked_shl(bin).map_or(u64::MAX, |bit| bit - 1);
        let covered = self.pieces.iter().fold(0, |covered, piece| {
            let begin = piece.min[axis] + tolerance;
            let first = if begin < start { 0 } else { bin(begin).saturating_add(1) };
            covered | below(bin(piece.max[axis])) & !below(first)
        });
        covered != u64::MAX
    }

    /// The rounded plane of a piece's face: a unit normal, and a point on the plane.
    #[inline]
    pub(super) fn rounded_plane(&self, piece: usize) -> (Vec3, DVec3) {
        let piece = &self.pieces[piece];
        let normal = self.faces.normal(piece.face).normalize().as_vec3();
        (normal, piece.point(self.faces, self.arena))
    }

    /// The plane of a piece's face.
    pub(super) fn own_plane(&self, piece: usize) -> PlaneId {
        PlaneId::face(self.pieces[piece].face)
    }

    #[inline]
    pub(in crate::build) fn prepare(&self, plane: PlaneId) -> PreparedPlane {
        let known = match plane.kind() {
            PlaneKind::Face(face) => self.planes.get(face as usize),
            PlaneKind::Axis(..) => None,
        };
        known.copied().unwrap_or_else(|| PreparedPlane::new(self.faces, plane))
    }

    /// The side of a plane on which a piece lies, decided exactly.
    pub(super) fn classify(&self, prepared: &PreparedPlane, piece: usize) -> Side {
        self.pieces[piece].side(self.faces, prepared, self.arena)
    }

    /// Classifies all pieces against a plane. Returns false if the plane cuts more than `most` pieces.
    pub(in crate::build) fn divide(
        &self,
        plane: PlaneId,
        most: usize,
        division: &mut Division,
    ) -> bool {
        division.classify(self.faces, (self.pieces, self.arena), self.prepare(plane), most)
    }

    /// Calls a function with the rounded position of each vertex of a piece, in lattice units.
    #[inline]
    pub(super) fn for_each_vertex(&self, piece: usize, see: impl FnMut([f64; 3])) {
        self.pieces[piece].for_each_vertex(self.faces, self.arena, see);
    }

    pub(super) fn vertices(&self, piece: usize) -> usize {
        let cut = self.pieces[piece].cut_vertices(self.arena);
        cut.map_or_else(|| self.faces.corners(self.pieces[piece].face).len(), <[_]>::len)
    }

    /// Returns `count` of the pieces, spread evenly; all pieces if there are fewer.
    pub(super) fn sample(&self, count: usize) -> impl Iterator<Item = usize> + use<> {
        let n = self.len();
        let count = count.min(n);
        // Division is slow.
        (0..count).map(move |i| if count == n { i } else { i * n / count })
    }
}

#[cfg(test)]
mod tests;
