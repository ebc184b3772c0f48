//! The lines of a picture: their origins and numbers, their intersections, and the side of a line on which
//! two other lines meet.
//!
//! Three integers k define a line: the points (x, y) of the picture, in pixels, with k₀ + x·k₁ + y·k₂ = 0.
//! The line's slope is the vector (k₁, k₂). One side of a line, a half-plane of the picture, is called a half
//! of the line. The edge between two points is the plane through both points and the eye. The cut of a face f
//! by a plane h consists of the rays that meet f and h in one point. Let κ be the value of a plane at the eye
//! (for parallel rays, the plane's slope along the rays), and φ the plane's value along a ray. Then
//! k = κ_f φ_h − κ_h φ_f.
//!
//! If the coordinates of corners are below 2⁵², of rays below 2⁶⁰ and of the eye below 2⁸¹, the integers of
//! an edge have 197 bits and of a cut 361 bits. The determinant of three lines has less than 1088 bits.

use std::cmp::Ordering;
use std::collections::HashMap;
use std::hash::{BuildHasherDefault, Hash, Hasher};

use super::adjacency::Adjacency;
use crate::Error;
use crate::exact::lattice::{exponent_of, scaled};
use crate::exact::{Faces, Int, Plane, PlaneId, PlaneKind, dot};
use crate::progress::Watch;
use crate::random::mix;
use crate::raster::{RayOrigin, Rays, Sheet, edge};

/// The number that stands for a missing point.
pub(super) const NO_POINT: u32 = u32::MAX;
/// Faces with more corners than this are not searched for corners that a cut goes through. Too small: more
/// intersections are computed in integers. Too large: the search takes longer.
const FEW: usize = 8;
/// The lines of a picture: the edges of all faces that the picture may show, and the cuts of their pieces.
#[derive(Debug)]
pub(super) struct LineTable<'t> {
    pub(super) frame: ViewFrame<'t>,
    /// The largest coordinates in the picture, plus one pixel.
    pub(super) reach: [f64; 2],
    pub(super) adjacency: Adjacency,
    keys: Vec<Key>,
    rounded: Vec<Rounded>,
    /// Points that each line is known to go through; [`NO_POINT`] for a missing point.
    pub(super) through: Vec<[u32; 2]>,
    /// The lines of edges, by the edges' numbers. Only while lines are made.
    of_edges: Vec<u32>,
    /// For each cut, the half on which its line is positive.
    of_cuts: Table<(u32, PlaneId), HalfPlane>,
    /// The lines of cuts, by their positive halves.
    cuts: Table<HalfPlane, ()>,
}

/// The number that stands for a line that is not made yet.
const NO_LINE: u32 = u32::MAX;

impl<'t> LineTable<'t> {
    /// An empty table.
    pub(super) fn new(frame: ViewFrame<'t>, watch: &Watch<'_>) -> Result<Self, Error> {
        let reach = frame.rays.size().map(|side| f64::from(side) + 1.0);
        let adjacency = Adjacency::of(frame.faces, watch)?;
        let of_edges = vec![NO_LINE; adjacency.edge_count()];
        Ok(Self {
            frame,
            reach,
            adjacency,
            keys: vec![],
            rounded: vec![],
            through: vec![],
            of_edges,
            of_cuts: Table::default(),
            cuts: Table::default(),
        })
    }

    /// Adds a line. `through` are points that the line goes through.
    fn add(&mut self, key: Key, through: [u32; 2]) -> Result<u32, Error> {
        // Memory for lines runs out before their numbers do.
        let number = u32::try_from(self.keys.len()).map_err(|_| Error::out_of_memory())?;
        self.rounded.push(self.rounded_of(key));
        self.keys.push(key);
        self.through.push(through);
        Ok(number)
    }

    /// The half of a face's edge `k` on which the face lies. `is_positive` is whether the face's κ is
    /// positive.
    pub(super) fn edge(
        &mut self,
        face: u32,
        k: u32,
        is_positive: bool,
        is_as_given: bool,
    ) -> Result<HalfPlane, Error> {
        let faces = self.frame.faces;
        let range = faces.corner_range(face);
        let next = if k as usize + 1 == range.len() { 0 } else { k + 1 };
        let [a, b] = [k, next].map(|k| range.start as u32 + k);
        let flattened = faces.moved_axis(face).filter(|_| !is_as_given);
        let certain = faces.reference_triangle(face);
        if let Some(axis) = flattened
            && !(certain.contains(&a) && certain.contains(&b))
        {
            // The upright plane faces outwards if the face's normal has a positive component along the axis.
            let normal = faces.plane(PlaneId::face(face)).normal()[axis];
            let flip = is_positive == (normal > 0);
            let points = [a, b].map(|corner| match certain.contains(&corner) {
                true => self.adjacency.point(corner),
                false => self.adjacency.moved(corner),
            });
            return Ok(HalfPlane::of(self.add(Key::Upright(face, k), points)?).flipped(flip));
        }
        let [from, to] = [a, b].map(|corner| self.adjacency.point(corner));
        let edge = self.adjacency.edge(a) as usize;
        if self.of_edges[edge] == NO_LINE {
            let points = [from.min(to), from.max(to)];
            self.of_edges[edge] = self.add(Key::Edge(points), points)?;
        }
        let is_front = is_positive == self.frame.rays.is_perspective();
        Ok(HalfPlane::of(self.of_edges[edge]).flipped((from > to) != is_front))
    }

    /// The half of a face's cut by a plane on which a piece of the face lies. `behind` is whether the piece
    /// is behind the plane, and `is_positive` whether the face's κ is positive.
    pub(super) fn cut(
        &mut self,
        face: u32,
        plane: PlaneId,
        behind: bool,
        is_positive: bool,
    ) -> Result<HalfPlane, Error> {
        let own = PlaneId::face(face);
        let (key, swapped) = match plane.kind() {
            PlaneKind::Face(other) if other < face => ((other, own), true),
            _ => ((face, plane), false),
        };
        let half = match self.of_cuts.get(&key) {
            Some(&half) => half,
            None => {
                let through = self.on_cut(face, plane);
                let half = HalfPlane::of(self.add(Key::Cut(key.0, key.1), through)?);
                self.of_cuts.insert(key, half);
                half
            }
        };
        Ok(half.flipped(is_positive == (behind != swapped)))
    }

    /// Corners of a face that are known to lie on a plane that cuts it: corners shared with the plane's face,
    /// or corners on an axis plane. (Only for faces with few corners, none of which was moved.)
    fn on_cut(&self, face: u32, plane: PlaneId) -> [u32; 2] {
        let faces = self.frame.faces;
        let own = faces.corners(face);
        let is_exact = |face: u32| faces.moved_axis(face).is_none();
        let mut found = [NO_POINT; 2];
        if own.len() > FEW || !is_exact(face) {
            return found;
        }
        let other = match plane.kind() {
            PlaneKind::Face(other) if is_exact(other) => faces.corners(other),
            _ => &[],
        };
        let is_on = |corner: &[f64; 3]| match plane.kind() {
            PlaneKind::Face(_) => other.len() <= FEW && other.contains(corner),
            PlaneKind::Axis(axis, at) => corner[axis] == faces.corner(at)[axis],
        };
        let start = faces.corner_range(face).start as u32;
        let on = (start..).zip(own).filter(|(_, corner)| is_on(corner));
        for (place, (corner, _)) in found.iter_mut().zip(on) {
            *place = self.adjacency.point(corner);
        }
        found
    }

    /// Whether a cut was made along a half's line.
    pub(super) fn is_cut(&self, half: HalfPlane) -> bool {
        self.cuts.contains_key(&half.positive())
    }

    /// Whether the cut of two faces, the lower number first, is known to lie on a half's line.
    pub(super) fn is_cut_of(&self, half: HalfPlane, [one, other]: [u32; 2]) -> bool {
        let cut = self.of_cuts.get(&(one, PlaneId::face(other)));
        cut.is_some_and(|cut| cut.line() == half.line())
    }

    /// The pairs of faces whose planes meet in a line in which one of the two was cut, and the line.
    pub(super) fn cuts_of_faces(&self) -> impl Iterator<Item = (HalfPlane, [u32; 2])> {
        self.of_cuts.iter().filter_map(|(&(one, plane), half)| match plane.kind() {
            PlaneKind::Face(other) => Some((half.positive(), [one, other])),
            PlaneKind::Axis(..) => None,
        })
    }

    /// Whether two faces meet in a half's line, between two points of the line. With a tolerance, the plane of a
    /// coplanar neighbour of either face may have made the line.
    pub(super) fn do_meet(&self, faces: [u32; 2], half: HalfPlane, ends: [[f64; 2]; 2]) -> bool {
        /// Coplanar neighbours of a face, and their neighbours, are less than this many tolerances away from it. Too
        /// small: crossings are lost where the plane of such a neighbour made the line. Too large: faces that meet
        /// beside the line seem to meet in it.
        const CHAIN: f64 = 4.0;
        let is_near = |at: [f64; 2]| {
            let [a, b] = faces.map(|face| self.frame.meeting(face, at));
            (a.place - b.place).abs() < CHAIN * (a.slack + b.slack)
        };
        if self.frame.faces.tolerance() > 0.0 && ends.into_iter().all(is_near) {
            return true;
        }
        let [one, other] = faces.map(|face| self.frame.sheet(PlaneId::face(face)));
        let cut = one.cut(&other);
        // Faces in one plane have no line of intersection.
        cut.iter().any(|c| c.sign().is_ne()) && compare(&cut, &self.exact(half)).is_eq()
    }

    /// The key that a line was first made for.
    fn key(&self, line: u32) -> Key {
        self.keys[line as usize]
    }

    /// A line in floats.
    fn rounded_of(&self, key: Key) -> Rounded {
        key.rounded(&self.frame, &self.adjacency, self.reach)
    }

    /// A line in integers.
    fn exact_of(&self, key: Key) -> ExactLine {
        key.exact(&self.frame, &self.adjacency)
    }
}

impl LineTable<'_> {
    /// A half's line in floats.
    #[inline]
    pub(super) fn rounded(&self, half: HalfPlane) -> Rounded {
        match half.number() {
            Some(line) => self.rounded[line as usize],
            None => {
                let (axis, steps) = half.border();
                let mut k = [-(steps as f64) / STEPS, 0.0, 0.0];
                k[axis + 1] = 1.0;
                Rounded { k, error: 4.0 * ROUNDING * self.reach[axis], slope: 1.0 }
            }
        }
    }

    /// The largest error of the components of a line's slope.
    pub(super) fn slope_error(&self, line: &Rounded) -> f64 {
        line.error / self.reach[0].min(self.reach[1])
    }

    /// The edge from one lattice point to another in floats, whether or not its line is in the table.
    pub(super) fn rounded_edge(&self, ends: [[f64; 3]; 2]) -> Rounded {
        rounded_edge(&self.frame, ends, self.reach)
    }

    /// A line in floats that is not in the table.
    pub(super) fn rounded_other(&self, exact: &ExactLine) -> Rounded {
        Rounded::new(exact, self.reach)
    }

    /// Whether a point is in the picture or at most a pixel beyond it. Errors are bounded only for such
    /// points.
    pub(super) fn shows(&self, at: [f64; 2]) -> bool {
        (0..2).all(|axis| -1.0 <= at[axis] && at[axis] <= self.reach[axis])
    }

    /// The line of a half, in integers.
    pub(super) fn exact(&self, half: HalfPlane) -> ExactLine {
        match half.number() {
            Some(line) => self.exact_of(self.key(line)),
            None => {
                let (axis, steps) = half.border();
                let mut k = [-steps, 0, 0];
                k[axis + 1] = 1 << STEP_BITS;
                k.map(Int::from)
            }
        }
    }
}

/// The origin of a line. Equal keys have equal lines, up to their direction. Different keys may also have
/// equal lines.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) enum Key {
    /// The edge between two points, the lower number first.
    Edge([u32; 2]),
    /// A face's edge from a corner to the next, if one of the two corners was moved onto the face's plane, or
    /// may have been moved.
    Upright(u32, u32),
    /// The cut of a face by a plane. If the plane is the plane of another face, the face of the lower number
    /// comes first.
    Cut(u32, PlaneId),
}

impl Key {
    /// The line in floats, in a picture whose largest coordinates are `reach`.
    pub(super) fn rounded(
        self,
        frame: &ViewFrame<'_>,
        adjacency: &Adjacency,
        reach: [f64; 2],
    ) -> Rounded {
        let ViewFrame { rays, faces } = frame;
        let sheet = |plane| Sheet::new(rays, faces, plane);
        let (k, error) = match self {
            Self::Edge(points) => {
                return rounded_edge(frame, ends(frame, adjacency, points), reach);
            }
            Self::Upright(face, k) => {
                let ([a, b], axis) = upright(frame, face, k);
                sheet(PlaneId::face(face)).cut(&Sheet::upright(rays, a, b, axis))
            }
            Self::Cut(face, plane) => sheet(PlaneId::face(face)).cut(&sheet(plane)),
        };
        // The error is for the picture alone, but lines are evaluated up to a pixel beyond it.
        let rounded = Rounded::scaled(k, 4.0 * error);
        if rounded.is_fine() { rounded } else { Rounded::new(&self.exact(frame, adjacency), reach) }
    }

    /// The line in integers.
    pub(super) fn exact(self, frame: &ViewFrame<'_>, adjacency: &Adjacency) -> ExactLine {
        match self {
            Self::Edge(points) => frame.edge(ends(frame, adjacency, points)),
            Self::Upright(face, k) => {
                let (ends, axis) = upright(frame, face, k);
                frame.sheet(PlaneId::face(face)).cut(&frame.upright(ends, axis))
            }
            Self::Cut(face, plane) => frame.sheet(PlaneId::face(face)).cut(&frame.sheet(plane)),
        }
    }
}

/// The edge from one lattice point to another in floats, in a picture whose largest coordinates are `reach`.
pub(super) fn rounded_edge(frame: &ViewFrame<'_>, ends: [[f64; 3]; 2], reach: [f64; 2]) -> Rounded {
    let (k, error) = edge(&frame.rays, ends);
    let rounded = Rounded::scaled(k, 4.0 * error);
    if rounded.is_fine() { rounded } else { Rounded::new(&frame.edge(ends), reach) }
}

/// The ends of an edge.
fn ends(frame: &ViewFrame<'_>, adjacency: &Adjacency, points: [u32; 2]) -> [[f64; 3]; 2] {
    points.map(|point| adjacency.at(point, frame.faces))
}

/// The ends of a face's edge `k`, and the axis along which they were moved onto the face's plane.
fn upright(frame: &ViewFrame<'_>, face: u32, k: u32) -> ([[f64; 3]; 2], usize) {
    let corners = frame.faces.corners(face);
    let next = if k as usize + 1 == corners.len() { 0 } else { k as usize + 1 };
    let axis = frame.faces.moved_axis(face).unwrap_or_default();
    ([corners[k as usize], corners[next]], axis)
}

/// A hash table whose keys consist of numbers. Nothing depends on the order of its entries.
pub(super) type Table<K, V> = HashMap<K, V, BuildHasherDefault<Mixer>>;

/// 2⁶⁴ divided by the golden ratio: odd, and without a pattern in its bits.
const FACTOR: u64 = 0x9e37_79b9_7f4a_7c15;

/// A hasher for keys that consist of numbers.
#[derive(Debug, Default)]
pub(super) struct Mixer(u64);

impl Hasher for Mixer {
    fn finish(&self) -> u64 {
        mix(self.0)
    }

    fn write(&mut self, bytes: &[u8]) {
        for chunk in bytes.chunks(8) {
            let mut word = [0; 8];
            word[..chunk.len()].copy_from_slice(chunk);
            self.write_u64(u64::from_le_bytes(word));
        }
    }

    fn write_u32(&mut self, number: u32) {
        self.write_u64(u64::from(number));
    }

    fn write_usize(&mut self, number: usize) {
        self.write_u64(number as u64);
    }

    fn write_i64(&mut self, number: i64) {
        self.write_u64(number as u64);
    }

    fn write_isize(&mut self, number: isize) {
        self.write_u64(number as u64);
    }

    fn write_u64(&mut self, number: u64) {
        self.0 = (self.0.rotate_left(23) ^ number).wrapping_mul(FACTOR);
    }
}

/// The number of steps per pixel. Borders of tiles are at whole steps.
pub(super) const STEPS: f64 = (1u64 << STEP_BITS) as f64;
pub(super) const STEP_BITS: u32 = 24;

/// One side of a line.
///
/// The last bit is set for the side on which the line is negative. The bits above it are the number of the
/// line; or, if the first bit is set, the axis and place of a tile's border, so that borders need no list.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub(super) struct HalfPlane(u64);

const BORDER: u64 = 1 << 63;
/// The number added to the place of a border, so that all numbers are positive.
const OFFSET: i64 = 1 << 60;

impl HalfPlane {
    /// The side of a line on which the line is positive.
    pub(super) const fn of(line: u32) -> Self {
        Self((line as u64) << 1)
    }

    /// The points whose coordinate (axis 0, 1 for x, y) is at least `steps` / [`STEPS`] pixels.
    pub(super) const fn beyond(axis: usize, steps: i64) -> Self {
        Self(BORDER | (((steps + OFFSET) as u64) << 1 | axis as u64) << 1)
    }

    /// A number that both halves of a line share.
    pub(super) const fn line(self) -> u64 {
        self.0 >> 1
    }

    /// The half of the same line on which the line is positive.
    pub(super) const fn positive(self) -> Self {
        Self(self.0 & !1)
    }

    /// The number of the line; `None` for a border.
    pub(super) const fn number(self) -> Option<u32> {
        if self.0 & BORDER == 0 { Some((self.0 >> 1) as u32) } else { None }
    }

    /// The axis of a border, and its position in steps.
    pub(super) const fn border(self) -> (usize, i64) {
        let number = (self.0 & !BORDER) >> 1;
        ((number & 1) as usize, (number >> 1) as i64 - OFFSET)
    }

    /// Whether this is the side on which the line is negative.
    pub(super) const fn is_negative(self) -> bool {
        self.0 & 1 == 1
    }

    /// The other side, if `flip`.
    pub(super) const fn flipped(self, flip: bool) -> Self {
        Self(self.0 ^ flip as u64)
    }
}

impl LineTable<'_> {
    /// The exact side of a half's line on which the lines of two other halves meet. These two lines must
    /// bound consecutive sides of a convex cell.
    #[cold]
    pub(super) fn exact_side(&self, half: HalfPlane, [first, second]: [HalfPlane; 2]) -> Ordering {
        let lines = [first, second, half];
        if half.line() == first.line() || half.line() == second.line() || self.share_point(lines) {
            return Ordering::Equal;
        }
        let side = orientation(lines.map(|half| self.exact(half)).each_ref());
        let flips = lines.iter().filter(|half| half.is_negative()).count();
        if flips % 2 == 1 { side.reverse() } else { side }
    }

    /// The exact side of a line on which two other lines meet. The line need not be in the table.
    #[cold]
    pub(super) fn exact_side_of(&self, line: &ExactLine, corner: [HalfPlane; 2]) -> Ordering {
        let [a, b] = corner.map(|half| self.exact(half));
        let side = orientation([&a, &b, line]);
        if corner[0].is_negative() == corner[1].is_negative() { side } else { side.reverse() }
    }

    /// The point where two lines meet, computed from integers, and a bound on the point's rounding error.
    #[cold]
    pub(super) fn exact_meeting(&self, halves: [HalfPlane; 2]) -> ([f64; 2], f64) {
        let exact = halves.map(|half| self.exact(half));
        let at = meeting(exact.each_ref());
        let radius = 8.0 * ROUNDING * self.reach[0].max(self.reach[1]);
        if self.shows(at) { (at, radius) } else { ([0.0; 2], f64::INFINITY) }
    }

    /// Whether three lines are known to go through one point.
    fn share_point(&self, lines: [HalfPlane; 3]) -> bool {
        let through = lines.map(|half| half.number().map(|line| self.through[line as usize]));
        let [Some(a), Some(b), Some(c)] = through else { return false };
        a.iter().any(|point| *point != NO_POINT && b.contains(point) && c.contains(point))
    }
}

/// The coefficients of a line.
pub(super) type ExactLine = [Int<6>; 3];

/// The data that all lines of a picture share: the picture's rays, and the faces.
#[derive(Debug)]
pub(super) struct ViewFrame<'t> {
    pub(super) rays: Rays,
    pub(super) faces: &'t Faces,
}

/// A plane, as a function of the rays.
#[derive(Clone, Copy, Debug)]
pub(super) struct ImagePlane {
    kappa: Int<4>,
    phi: [Int<3>; 3],
}

/// The place where a ray meets a face's plane, in multiples of the ray's direction, rounded. If the plane moves by the
/// tolerance, the place moves by `slack`.
struct Meeting {
    place: f64,
    slack: f64,
}

/// A point of the scene in homogeneous coordinates of the picture: a weight, positive ahead of the eye, and
/// the coordinates times the weight.
pub(super) type Image = [Int<4>; 3];

impl ViewFrame<'_> {
    /// The place where the ray through a point of the picture meets a face's plane.
    fn meeting(&self, face: u32, at: [f64; 2]) -> Meeting {
        let normal = self.faces.normal(face);
        let [from, way] = self.rays.through(at, self.faces.triangle(face)[0]);
        let slope = normal.dot(way);
        // From very far away, rounding moves the place further than the tolerance does.
        let length = self.faces.tolerance() + 16.0 * ROUNDING * from.length();
        Meeting { place: -normal.dot(from) / slope, slack: length * normal.length() / slope.abs() }
    }

    /// A plane of the scene, as a function of the rays.
    pub(super) fn sheet(&self, plane: PlaneId) -> ImagePlane {
        self.sheet_of(&self.faces.plane(plane))
    }

    /// The plane through two lattice points and along an axis, as a function of the rays.
    pub(super) fn upright(&self, [a, b]: [[f64; 3]; 2], axis: usize) -> ImagePlane {
        self.sheet_of(&Plane::upright(a, b, axis))
    }

    fn sheet_of(&self, plane: &Plane) -> ImagePlane {
        let Rays { base, right, down, pencil, .. } = self.rays;
        let point = plane.point();
        let (kappa, first) = match pencil {
            RayOrigin::From { eye, shift } => {
                let kappa = plane.along(eye).shifted::<4>(shift) - plane.along(point).resize();
                (kappa, base)
            }
            RayOrigin::Along { direction } => {
                let first = std::array::from_fn(|i| base[i] - point[i]);
                (plane.along(direction).resize(), first)
            }
        };
        ImagePlane { kappa, phi: [first, right, down].map(|v| plane.along(v)) }
    }

    /// The position of a lattice point in the picture.
    pub(super) fn image(&self, point: [f64; 3]) -> Image {
        let Rays { base, right, down, pencil, .. } = self.rays;
        let point = point.map(|c| c as i64);
        // Cramer's rule, with `base`, `right` and `down`, or `right`, `down` and the direction, as axes.
        // (Both bases are right-handed: cameras look along right × down.)
        match pencil {
            RayOrigin::From { eye, shift } => {
                let duals = [product(right, down), product(down, base), product(base, right)];
                duals.map(|dual| dot(dual, point).resize() - dot(dual, eye).shifted(shift))
            }
            RayOrigin::Along { direction } => {
                let arm = std::array::from_fn(|i| point[i] - base[i]);
                let [x, y] = [product(down, direction), product(direction, right)];
                [(x, right), (x, arm), (y, arm)].map(|(dual, v)| dot(dual, v).resize())
            }
        }
    }

    /// The edge from one lattice point to another. The direction of the edge in the picture is (k₂, −k₁).
    /// Inside a face whose front is seen, the face's edges are negative.
    pub(super) fn edge(&self, [a, b]: [[f64; 3]; 2]) -> ExactLine {
        let Rays { base, right, down, pencil, .. } = self.rays;
        let integer = |p: [f64; 3]| p.map(|c| c as i64);
        let (a, b) = (integer(a), integer(b));
        let arm = std::array::from_fn(|i| b[i] - a[i]);
        match pencil {
            // v · ((a − eye) × (b − eye)) = v · (a × arm) − v · (eye × arm)
            RayOrigin::From { eye, shift } => {
                let (near, far) = (product(a, arm), product(eye, arm));
                [base, right, down].map(|v| dot(near, v).resize() - dot(far, v).shifted(shift))
            }
            // (p − a) · (direction × arm)
            RayOrigin::Along { direction } => {
                let normal = product(direction, arm);
                let first = std::array::from_fn(|i| base[i] - a[i]);
                [first, right, down].map(|v| dot(normal, v).resize())
            }
        }
    }
}

impl ImagePlane {
    /// The side from which the plane is seen: `Greater` if the plane's κ is positive. A face whose front is
    /// seen has a positive κ from an eye, and a negative κ along parallel rays.
    pub(super) fn side(&self) -> Ordering {
        self.kappa.sign()
    }

    /// The line of the rays that meet both planes in one point. If a ray meets a face's plane ahead, at a
    /// point in front of the other plane, the line has the sign of the face's κ at that ray.
    pub(super) fn cut(&self, other: &Self) -> ExactLine {
        std::array::from_fn(|i| {
            let ahead: Int<6> = self.kappa.times(&other.phi[i]);
            let behind: Int<6> = other.kappa.times(&self.phi[i]);
            ahead - behind
        })
    }
}

/// The side of a third line on which two lines meet, times the sign of the turn from the first line to the
/// second.
pub(super) fn orientation([a, b, c]: [&ExactLine; 3]) -> Ordering {
    let minor =
        |i: usize, j: usize| -> Int<12> { a[i].times::<6, 12>(&b[j]) - a[j].times::<6, 12>(&b[i]) };
    let term = |i: usize, minor: Int<12>| -> Int<17> { minor.times(&c[i]) };
    (term(0, minor(1, 2)) + term(1, minor(2, 0)) + term(2, minor(0, 1))).sign()
}

/// The side of a line on which a point ahead of the eye lies.
pub(super) fn side_at(line: &ExactLine, image: &Image) -> Ordering {
    value_at(line, image).sign()
}

/// The value of a line at a point, times the point's weight.
pub(super) fn value_at(line: &ExactLine, image: &Image) -> Int<11> {
    let term = |i: usize| line[i].times(&image[i]);
    term(0) + term(1) + term(2)
}

/// A total order of lines, regardless of their direction. Lines are compared by the first coefficient that is
/// not 0, slopes first, and then by the ratios of the other coefficients to that coefficient.
pub(super) fn compare(a: &ExactLine, b: &ExactLine) -> Ordering {
    let order = [1, 2, 0];
    let [first, second] = [a, b].map(|line| order.iter().position(|&i| line[i].sign().is_ne()));
    let (Some(lead), Ordering::Equal) = (first, first.cmp(&second)) else {
        return first.cmp(&second);
    };
    let of = order[lead];
    let is_flipped = a[of].sign() != b[of].sign();
    let ratios = order[lead + 1..].iter().map(|&i| {
        let sign = (a[i].times::<6, 12>(&b[of]) - b[i].times::<6, 12>(&a[of])).sign();
        if is_flipped { sign.reverse() } else { sign }
    });
    ratios.fold(Ordering::Equal, Ordering::then)
}

/// Whether two equal lines have coefficients of opposite signs.
pub(super) fn is_opposite(a: &ExactLine, b: &ExactLine) -> bool {
    (0..3).any(|i| a[i].sign().is_ne() && a[i].sign() != b[i].sign())
}

/// The point where two lines meet, each coordinate rounded three times; NaN for parallel lines.
pub(super) fn meeting([a, b]: [&ExactLine; 2]) -> [f64; 2] {
    let minor = |i: usize, j: usize| {
        let minor = a[i].times::<6, 12>(&b[j]) - a[j].times::<6, 12>(&b[i]);
        minor.to_f64()
    };
    let turn = minor(1, 2);
    [minor(2, 0) / turn, minor(0, 1) / turn]
}

fn product(a: [i64; 3], b: [i64; 3]) -> [i128; 3] {
    std::array::from_fn(|i| {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        i128::from(a[j]) * i128::from(b[k]) - i128::from(a[k]) * i128::from(b[j])
    })
}

/// The relative error of one rounding.
pub(super) const ROUNDING: f64 = f64::EPSILON / 2.0;

/// Lines whose error in floats is above this, in pixels, are computed from integers. Too small: integers
/// compute more lines. Too large: integers decide more sides.
const FINE: f64 = 1.0 / (1u64 << 32) as f64;

/// A line in floats, scaled so that the larger component of its slope is near 1.
#[derive(Clone, Copy, Debug)]
pub(super) struct Rounded {
    pub(super) k: [f64; 3],
    /// A bound on the error of the line's values in the picture, computed as `k[0] + x·k[1] + y·k[2]`. This
    /// number also bounds the error of each component of the slope, times the picture's shorter side.
    pub(super) error: f64,
    /// An upper bound on the length of the line's slope.
    pub(super) slope: f64,
}

impl Rounded {
    /// Rounds exact coefficients, for a picture of this size.
    pub(super) fn new(exact: &ExactLine, reach: [f64; 2]) -> Self {
        let k = exact.each_ref().map(|c| c.to_f64());
        let sum = k[0].abs() + k[1].abs() * reach[0] + k[2].abs() * reach[1];
        Self::scaled(k, 8.0 * ROUNDING * sum)
    }

    pub(super) fn scaled(k: [f64; 3], error: f64) -> Self {
        let size = k[1].abs().max(k[2].abs());
        // Scaling by a power of two is exact. (A line without slope may have any scale.)
        let scale = if size > 0.0 { scaled(1.0, -exponent_of(size)) } else { 1.0 };
        Self { k: k.map(|c| c * scale), error: error * scale, slope: 1.01 * 1.42 * size * scale }
    }

    /// The same line with its signs changed, if `flip`.
    pub(super) fn flipped(self, flip: bool) -> Self {
        if flip { Self { k: self.k.map(|c| -c), ..self } } else { self }
    }

    /// Whether the error is so small that integers are not needed to evaluate the line.
    pub(super) fn is_fine(&self) -> bool {
        self.error < FINE
    }

    /// The value at a point, rounded.
    #[inline]
    pub(super) fn at(&self, [x, y]: [f64; 2]) -> f64 {
        self.k[0] + (self.k[1] * x + self.k[2] * y)
    }
}

mod merge;
#[cfg(test)]
pub(super) mod tests;
