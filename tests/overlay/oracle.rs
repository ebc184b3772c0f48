//! An exact judge of lines and points. It decides in rationals, along rays from the eye, which of two shapes
//! is nearer. It uses only the faces, lines and points as they were rounded to the grid, and no partition
//! plane.

use binspace::overlay::{Overlay, Shape};
use num_traits::One;
use testkit::prelude::*;

use crate::overlay::sight::{
    GRID, between, crossing, hit, may_cross, may_hit, ratio, share_in_line, to_f64,
};
use crate::overlay::tiling::Given;
use testkit::rational::{Plane, Point};

type Verdict = Result<(), String>;

/// Places closer to an end or an edge than this are not judged, because compared ends are rounded. It is a
/// share of a segment, and of the grid.
const NEAR: f64 = 1e-7;
/// The number of judged places of each piece.
const PLACES: u32 = 3;
/// The approximate number of pieces of segments compared with polygons in each order.
const MOST: usize = 60;

/// The counts of comparisons.
#[derive(Debug, Default)]
pub(crate) struct Counts {
    pub(crate) lines: usize,
    pub(crate) line_polygon: usize,
    pub(crate) line_on_polygon: usize,
    pub(crate) point_polygon: usize,
    pub(crate) point_on_polygon: usize,
    pub(crate) point_line: usize,
    pub(crate) points: usize,
    /// Pairs that lie in one plane with the eye, where the input order decides.
    pub(crate) edge_on: usize,
    pub(crate) pieces: usize,
    pub(crate) segments: usize,
}

struct SegmentPiece {
    place: usize,
    segment: usize,
    shares: [f64; 2],
}

struct PolygonPiece {
    place: usize,
    vertices: Vec<DVec3>,
}

/// The parts of one order.
struct Painted {
    segments: Vec<SegmentPiece>,
    /// The pieces of each face.
    polygons: Vec<Vec<PolygonPiece>>,
    /// The places of points.
    points: Vec<usize>,
}

impl Painted {
    fn new(tree: &BspTree, overlay: &Overlay, given: &Given, order: &[u32]) -> Self {
        let mut painted = Self {
            segments: vec![],
            polygons: given.faces.iter().map(|_| vec![]).collect(),
            points: vec![usize::MAX; given.points.len()],
        };
        for (place, &number) in order.iter().enumerate() {
            match overlay.shape(number).unwrap_or_else(|| Shape::Fragment(tree.fragment(number))) {
                Shape::Fragment(fragment) => {
                    let vertices = fragment.lattice_vertices().map(DVec3::from).collect();
                    let pieces = &mut painted.polygons[fragment.face() as usize];
                    pieces.push(PolygonPiece { place, vertices });
                }
                Shape::Segment(piece) => {
                    let name = (piece.line(), piece.number());
                    let segment =
                        given.segments.binary_search_by_key(&name, |s| (s.0, s.1)).expect("one");
                    let shares = piece.shares();
                    painted.segments.push(SegmentPiece { place, segment, shares });
                }
                Shape::Marker(marker) => painted.points[marker.point()] = place,
                _ => unreachable!(),
            }
        }
        painted
    }

    /// The piece of a segment around a point, given as a share of the segment; `None` if a piece ends near
    /// the point.
    fn piece_at(&self, segment: usize, share: f64) -> Option<&SegmentPiece> {
        let mut pieces = self.segments.iter().filter(|piece| piece.segment == segment);
        pieces.find(|piece| piece.shares[0] + NEAR < share && share < piece.shares[1] - NEAR)
    }

    /// The piece of a face around a point of the face; `None` if the point is near an edge of a piece.
    fn fragment_at(&self, face: usize, point: &Point) -> Option<&PolygonPiece> {
        let at = to_f64(point);
        self.polygons[face].iter().find(|piece| {
            let (n, v) = (piece.vertices.len(), &piece.vertices);
            let normal: DVec3 = (1..n - 1).map(|k| (v[k] - v[0]).cross(v[k + 1] - v[0])).sum();
            let edges = (0..n).map(|k| (v[k], v[(k + 1) % n]));
            edges.filter(|(a, b)| a != b).all(|(a, b)| {
                let inwards = normal.cross(b - a).normalize_or_zero();
                inwards.dot(at - a) > NEAR * GRID
            })
        })
    }
}

/// Judges the order of an eye at a point of the grid. Eyes that would be rounded again are left out.
pub(crate) fn judge(
    tree: &BspTree,
    overlay: &Overlay,
    given: &Given,
    eye: [f64; 3],
    counts: &mut Counts,
) -> Verdict {
    let lattice = overlay.faces().lattice();
    let world = lattice.to_world(eye);
    if lattice.to_lattice(world) != eye {
        return Ok(());
    }
    let mut order = Vec::new();
    let refused = |error: binspace::Error| error.to_string();
    overlay.order(tree, Viewpoint::Eye(world)).map_err(refused)?.write_into(&mut order);
    let painted = Painted::new(tree, overlay, given, &order);
    let judge = Judge { given, painted: &painted, eye: rational::point(eye) };
    judge.lines(counts)?;
    judge.polygons(counts)?;
    judge.points(overlay, counts)
}

struct Judge<'a> {
    given: &'a Given,
    painted: &'a Painted,
    eye: Point,
}

impl Judge<'_> {
    /// Checks that the nearer shape comes later.
    fn ensure(&self, far: usize, near: usize, what: impl FnOnce() -> String) -> Verdict {
        if far < near { Ok(()) } else { Err(format!("{} from {:?}", what(), to_f64(&self.eye))) }
    }

    fn lines(&self, counts: &mut Counts) -> Verdict {
        let (segments, rounded) = (&self.given.segments, &self.given.rounded);
        let eye = to_f64(&self.eye);
        for (i, (_, _, a)) in segments.iter().enumerate() {
            for (j, (_, _, b)) in segments.iter().enumerate().skip(i + 1) {
                let may_cross = |i: usize, j: usize| may_cross(eye, rounded[i], rounded[j]);
                if !may_cross(i, j) || !may_cross(j, i) {
                    continue;
                }
                let Some((shares, ratio)) = crossing(&self.eye, a, b) else { continue };
                let [of_a, of_b] = shares.map(|share| share.to_f64().value());
                let pieces = (self.painted.piece_at(i, of_a), self.painted.piece_at(j, of_b));
                let (Some(a), Some(b)) = pieces else { continue };
                let (far, near) = match ratio.cmp(&Rational::one()) {
                    Ordering::Greater => (b, a),
                    Ordering::Less => (a, b),
                    Ordering::Equal => continue,
                };
                self.ensure(far.place, near.place, || format!("segments {i} and {j}"))?;
                counts.lines += 1;
            }
        }
        Ok(())
    }

    fn polygons(&self, counts: &mut Counts) -> Verdict {
        let step = 1 + self.painted.segments.len() / MOST;
        for piece in self.painted.segments.iter().step_by(step) {
            let ends = &self.given.segments[piece.segment].2;
            let [from, to] = piece.shares;
            if to - from < f64::from(PLACES + 1) * NEAR {
                continue;
            }
            for k in 1..=PLACES {
                let share = from + (to - from) * f64::from(k) / f64::from(PLACES + 1);
                let at = between(ends, &rational::exact(share));
                let [on, off] = self.against_faces(&at, piece.place, Some(ends))?;
                counts.line_on_polygon += on;
                counts.line_polygon += off;
            }
        }
        for (point, &place) in self.given.points.iter().zip(&self.painted.points) {
            let [on, off] = self.against_faces(point, place, None)?;
            counts.point_on_polygon += on;
            counts.point_polygon += off;
        }
        Ok(())
    }

    /// Compares a place of a segment, or a point, with all faces; returns how many contain it, and how many
    /// do not.
    fn against_faces(
        &self,
        at: &Point,
        place: usize,
        ends: Option<&[Point; 2]>,
    ) -> Result<[usize; 2], String> {
        let mut judged = [0; 2];
        if *at == self.eye {
            return Ok(judged);
        }
        let [eye, through] = [&self.eye, at].map(to_f64);
        for (number, face) in self.given.faces.iter().enumerate() {
            if !may_hit(eye, through, &self.given.corners[number]) {
                continue;
            }
            let Some(ratio) = hit(&self.eye, at, face) else { continue };
            let seen = between(&[self.eye.clone(), at.clone()], &ratio);
            let Some(fragment) = self.painted.fragment_at(number, &seen) else { continue };
            let is_on = ratio.is_one();
            // A segment that goes through a face is on neither side of the face there.
            let leaves = |ends: &[Point; 2]| ends.iter().any(|end| !face.plane.at(end).is_zero());
            if is_on && ends.is_some_and(leaves) {
                continue;
            }
            let (far, near) = if ratio < Rational::one() {
                (place, fragment.place)
            } else {
                (fragment.place, place)
            };
            self.ensure(far, near, || format!("face {number}, ratio {ratio}, {:?}", to_f64(at)))?;
            judged[usize::from(!is_on)] += 1;
        }
        Ok(judged)
    }

    /// Compares points with other points and with lines that are in line with them, as seen from the eye.
    fn points(&self, overlay: &Overlay, counts: &mut Counts) -> Verdict {
        let eye = to_f64(&self.eye);
        let points = self.given.points.iter().zip(&self.painted.points);
        for (i, (x, &place)) in points.clone().enumerate() {
            let near = to_f64(x);
            for (y, &other) in points.clone().skip(i + 1) {
                let arms = [near, to_f64(y)].map(|point| (point - eye).normalize_or_zero());
                if arms[0].cross(arms[1]).length() < 1e-6 {
                    let ends = [y, y].map(Point::clone);
                    let [off, on] = self.in_line(overlay, (x, place), (&ends, other))?;
                    counts.points += off;
                    counts.edge_on += on;
                }
            }
            for piece in &self.painted.segments {
                let ends = &self.given.segments[piece.segment].2;
                let [p, q] = self.given.rounded[piece.segment];
                let arms = [near, p, q].map(|point| (point - eye).normalize_or_zero());
                if arms[0].dot(arms[1].cross(arms[2])).abs() > 1e-6 {
                    continue;
                }
                let Some(share) = share_in_line(&self.eye, x, ends) else { continue };
                let share = share.to_f64().value();
                let [from, to] = piece.shares;
                if from + NEAR < share && share < to - NEAR {
                    let [off, on] = self.in_line(overlay, (x, place), (ends, piece.place))?;
                    counts.point_line += off;
                    counts.edge_on += on;
                }
            }
        }
        Ok(())
    }

    /// Compares a point with a segment or another point, if both are in line with the eye. Returns the number
    /// of comparisons, and the number of pairs that are left out because a plane contains both shapes.
    fn in_line(
        &self,
        overlay: &Overlay,
        (x, place): (&Point, usize),
        (ends, other): (&[Point; 2], usize),
    ) -> Result<[usize; 2], String> {
        if *x == self.eye {
            return Ok([0, 0]);
        }
        let Some(share) = share_in_line(&self.eye, x, ends) else { return Ok([0, 0]) };
        let ratio = ratio(&self.eye, x, &between(ends, &share));
        if !ratio.is_positive() || ratio.is_one() {
            return Ok([0, 0]);
        }
        // A plane that contains both also contains the eye.
        if is_in_one_plane(overlay, &[x, &ends[0], &ends[1]]) {
            return Ok([0, 1]);
        }
        let (far, near) = if ratio > Rational::one() { (other, place) } else { (place, other) };
        self.ensure(far, near, || format!("a point and {:?}", ends.each_ref().map(to_f64)))?;
        Ok([1, 0])
    }
}

/// Whether one plane that may divide the overlay contains all given points: a plane of a face, of a segment,
/// or perpendicular to an axis.
fn is_in_one_plane(overlay: &Overlay, points: &[&Point]) -> bool {
    let faces = overlay.faces();
    if (0..3).any(|axis| points.iter().all(|point| point[axis] == points[0][axis])) {
        return true;
    }
    let is_of = |face: u32| {
        let corners = faces.corners(face);
        let triangle = faces.reference_triangle(face);
        if corners.len() < 3 {
            return false;
        }
        let [p, q, r] = triangle.map(|corner| rational::point(faces.corner(corner)));
        let plane = Plane::through([&p, &q, &r]);
        points.iter().all(|point| plane.at(point).is_zero())
    };
    (0..faces.len() as u32).any(is_of)
}
