//! An exact judge of lines and points: along rays from the eye, in rationals, which of two comes first.
//! It knows the faces, lines and points as they were rounded to the grid, and no plane that divides
//! them.

use binspace::glam::DVec3;
use binspace::{BspTree, Overlay, Shape, Viewpoint};
use num_traits::{One, Signed, ToPrimitive, Zero};
use std::cmp::Ordering;

use crate::support::model::Face;
use crate::support::rational::{self, Plane, Point, Rational};

type Verdict = Result<(), String>;

/// Shares and distances closer to an end or an edge than this are not judged, as what is compared has
/// rounded ends: a share of a segment, and of the grid.
const NEAR: f64 = 1e-7;
const GRID: f64 = (1u64 << 51) as f64;
/// How many places of each piece are looked at.
const PLACES: u32 = 3;
/// How many pieces of segments are held against polygons, about, of each order.
const MOST: usize = 60;

/// What was compared.
#[derive(Debug, Default)]
pub(crate) struct Counts {
    pub(crate) lines: usize,
    pub(crate) line_polygon: usize,
    pub(crate) line_on_polygon: usize,
    pub(crate) point_polygon: usize,
    pub(crate) point_on_polygon: usize,
    pub(crate) point_line: usize,
    pub(crate) points: usize,
    /// Pairs that lie in one plane with the eye, where the order is that of the input.
    pub(crate) edge_on: usize,
    pub(crate) pieces: usize,
    pub(crate) segments: usize,
}

/// What an overlay was given, on its grid.
pub(crate) struct Given {
    /// Each with its line, its number in the line, and its ends.
    pub(crate) segments: Vec<(usize, usize, [Point; 2])>,
    pub(crate) points: Vec<Point>,
    faces: Vec<Face>,
    /// The ends of the segments, rounded.
    rounded: Vec<[DVec3; 2]>,
    /// Of the faces, rounded.
    corners: Vec<Vec<DVec3>>,
}

impl Given {
    pub(crate) fn new(overlay: &Overlay, lines: &[Vec<DVec3>], points: &[DVec3]) -> Self {
        let lattice = *overlay.faces().lattice();
        let snap = |point: &DVec3| rational::point(lattice.snap(*point));
        let ends = |(line, corners): (usize, &Vec<DVec3>)| {
            let pairs: Vec<[Point; 2]> =
                corners.windows(2).map(|pair| [snap(&pair[0]), snap(&pair[1])]).collect();
            pairs.into_iter().enumerate().map(move |(k, pair)| (line, k, pair))
        };
        let segments = lines.iter().enumerate().flat_map(ends).filter(|(_, _, [p, q])| p != q);
        // Segments have faces too, which are not painted.
        let segments: Vec<_> = segments.collect();
        let count = overlay.faces().len() - segments.len() - points.len();
        let faces: Vec<Face> =
            (0..count as u32).map(|face| Face::new(overlay.faces(), face)).collect();
        let corners = faces.iter().map(|face| face.corners.iter().map(to_f64).collect()).collect();
        let rounded = segments.iter().map(|(_, _, ends)| ends.each_ref().map(to_f64)).collect();
        Self { segments, points: points.iter().map(snap).collect(), faces, rounded, corners }
    }
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

/// One order, taken apart.
struct Painted {
    segments: Vec<SegmentPiece>,
    /// By face.
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

    /// The piece of a segment around a share of it, if none ends near.
    fn piece_at(&self, segment: usize, share: f64) -> Option<&SegmentPiece> {
        let mut pieces = self.segments.iter().filter(|piece| piece.segment == segment);
        pieces.find(|piece| piece.shares[0] + NEAR < share && share < piece.shares[1] - NEAR)
    }

    /// The piece of a face around one of its points, if the point is not near an edge of any.
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

fn to_f64(point: &Point) -> DVec3 {
    DVec3::from_array(point.each_ref().map(|c| c.to_f64().expect("in range")))
}

fn between([p, q]: &[Point; 2], share: &Rational) -> Point {
    std::array::from_fn(|i| &p[i] + (&q[i] - &p[i]) * share)
}

/// How far along the ray from `eye` to `a` the point `b` of it is: 1 at `a`.
fn ratio(eye: &Point, a: &Point, b: &Point) -> Rational {
    let arm = rational::difference(a, eye);
    let axis = (0..3).find(|&i| !arm[i].is_zero()).expect("another point than the eye");
    (&b[axis] - &eye[axis]) / &arm[axis]
}

/// Where the ray from the eye meets both of two segments, as shares of these, and how much further the
/// second is; `None` if there is no such ray through the inside of both.
fn crossing(eye: &Point, a: &[Point; 2], b: &[Point; 2]) -> Option<([Rational; 2], Rational)> {
    let share = |of: &[Point; 2], by: &[Point; 2]| {
        let plane = Plane::through([eye, &by[0], &by[1]]);
        let [from, to] = of.each_ref().map(|end| plane.at(end));
        let is_crossed =
            rational::sign(&from).is_ne() && rational::sign(&from) == rational::sign(&to).reverse();
        is_crossed.then(|| &from / (&from - &to))
    };
    let (of_a, of_b) = (share(a, b)?, share(b, a)?);
    let ratio = ratio(eye, &between(a, &of_a), &between(b, &of_b));
    ratio.is_positive().then_some(([of_a, of_b], ratio))
}

/// Whether the ends of a segment are on different sides of the plane through the eye and another, if
/// floats tell: only to save time.
fn may_cross(eye: DVec3, of: [DVec3; 2], by: [DVec3; 2]) -> bool {
    let normal = (by[0] - eye).cross(by[1] - eye);
    let [from, to] = of.map(|end| normal.dot((end - eye).normalize_or_zero()) / GRID / GRID);
    (from < 1e-6 || to < 1e-6) && (from > -1e-6 || to > -1e-6)
}

/// The same of the ray from an eye through a point, and the inside of a face.
fn may_hit(eye: DVec3, through: DVec3, corners: &[DVec3]) -> bool {
    let ray = (through - eye).normalize_or_zero();
    let n = corners.len();
    let turns =
        (0..n).map(|k| (corners[k] - eye).cross(corners[(k + 1) % n] - eye).dot(ray) / GRID / GRID);
    let turns: Vec<f64> = turns.collect();
    turns.iter().all(|&turn| turn > -1e-6) || turns.iter().all(|&turn| turn < 1e-6)
}

/// Where the ray from the eye through a point meets the inside of a face: 1 at the point.
fn hit(eye: &Point, through: &Point, face: &Face) -> Option<Rational> {
    let (from, to) = (face.plane.at(eye), face.plane.at(through));
    if from.is_zero() || from == to {
        return None;
    }
    let ratio = &from / (&from - &to);
    if !ratio.is_positive() {
        return None;
    }
    let at = between(&[eye.clone(), through.clone()], &ratio);
    let n = face.corners.len();
    let is_inside = (0..n).all(|k| {
        let (a, b) = (&face.corners[k], &face.corners[(k + 1) % n]);
        let turn = rational::product(&rational::difference(b, a), &rational::difference(&at, a));
        rational::scalar(&turn, &face.plane.normal).is_positive()
    });
    is_inside.then_some(ratio)
}

/// Judges the order of an eye at a place of the grid; an eye that is rounded again is left out.
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
    overlay.back_to_front_into(tree, Viewpoint::Eye(world), &mut order).map_err(refused)?;
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
    /// The nearer must come later.
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
                let [of_a, of_b] = shares.map(|share| share.to_f64().expect("in range"));
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

    /// Holds a place of a segment, or a point, against all faces: how many it was on, and not on.
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
            // What goes through a face is on neither side of it there.
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

    /// Points in front of points, and of lines, as seen from an eye that is in line with both.
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
                let share = share.to_f64().expect("in range");
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

    /// Holds a point against a segment, or another point, that it may be in line with: how many were
    /// compared, and how many lie in one plane with it and the eye.
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
        // A plane that holds both holds the eye as well.
        if is_in_one_plane(overlay, &[x, &ends[0], &ends[1]]) {
            return Ok([0, 1]);
        }
        let (far, near) = if ratio > Rational::one() { (other, place) } else { (place, other) };
        self.ensure(far, near, || format!("a point and {:?}", ends.each_ref().map(to_f64)))?;
        Ok([1, 0])
    }
}

/// The share of a segment, which may be a point, that the line through the eye and a point goes
/// through.
fn share_in_line(eye: &Point, x: &Point, [p, q]: &[Point; 2]) -> Option<Rational> {
    let arm = rational::difference(x, eye);
    let off = |at: &Point| rational::product(&arm, &rational::difference(at, eye));
    let is_zero = |v: &Point| v.iter().all(Zero::is_zero);
    let (from, to) = (off(p), off(q));
    if p == q {
        return is_zero(&from).then(Rational::zero);
    }
    let axis = (0..3).find(|&i| from[i] != to[i])?;
    let share = &from[axis] / (&from[axis] - &to[axis]);
    let is_within = !share.is_negative() && share <= Rational::one();
    (is_within && is_zero(&off(&between(&[p.clone(), q.clone()], &share)))).then_some(share)
}

/// Whether some plane that may divide the overlay holds all of some points: a face's, a segment's, or
/// one perpendicular to an axis.
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

/// The shares of a piece's ends, where they are, and whether they were cut.
type SegmentEnds = ([f64; 2], [DVec3; 2], [bool; 2]);

/// Whether the pieces of each segment tile it, and share the bits of their ends.
pub(crate) fn tiles(
    tree: &BspTree,
    overlay: &Overlay,
    given: &Given,
    counts: &mut Counts,
) -> Verdict {
    let lattice = overlay.faces().lattice();
    let mut pieces: Vec<Vec<SegmentEnds>> = vec![vec![]; given.segments.len()];
    let mut markers = vec![0; given.points.len()];
    for number in tree.len()..tree.len() + overlay.len() {
        match overlay.shape(number as u32).expect("a shape") {
            Shape::Segment(piece) => {
                let name = (piece.line(), piece.number());
                let at = given.segments.binary_search_by_key(&name, |s| (s.0, s.1));
                let at = at.map_err(|_| format!("no segment {name:?}"))?;
                pieces[at].push((piece.shares(), piece.ends(), piece.cuts()));
            }
            Shape::Marker(marker) => {
                markers[marker.point()] += 1;
                let off = rational::distance_to_rounded(
                    &given.points[marker.point()],
                    lattice.to_lattice(marker.position()),
                );
                if off > 1.0 {
                    return Err(format!("{marker:?} is {off} off"));
                }
            }
            _ => {}
        }
    }
    if markers.iter().any(|&count| count != 1) {
        return Err("a point that does not come once".into());
    }
    for (pieces, (_, _, segment)) in pieces.iter_mut().zip(&given.segments) {
        counts.pieces += pieces.len();
        // From end to end: by their shares alone, pieces shorter than a rounding may seem out of order.
        let mut end = (0.0, None);
        while !pieces.is_empty() {
            let joins = |piece: &SegmentEnds| {
                piece.0[0] == end.0 && end.1.is_none_or(|point| point == piece.1[0])
            };
            let is_nothing =
                |piece: &SegmentEnds| piece.0[0] == piece.0[1] && piece.1[0] == piece.1[1];
            let next = pieces.iter().position(|piece| joins(piece) && is_nothing(piece));
            let next = next.or_else(|| pieces.iter().position(joins));
            let Some(next) = next else {
                return Err(format!("pieces do not tile: {end:?}, {pieces:?}"));
            };
            let (shares, ends, cuts) = pieces.swap_remove(next);
            if cuts != [shares[0] != 0.0, shares[1] != 1.0] {
                return Err(format!("cut or not: {shares:?}, {cuts:?}"));
            }
            for (share, point) in shares.into_iter().zip(ends) {
                let exact = between(segment, &rational::exact(share));
                let off = rational::distance_to_rounded(&exact, lattice.to_lattice(point));
                if off > 8.0 {
                    return Err(format!("an end is {off} off"));
                }
            }
            end = (shares[1], Some(ends[1]));
        }
        if end.0 != 1.0 {
            return Err(format!("the end of a segment is missing: {end:?}"));
        }
    }
    counts.segments += given.segments.len();
    Ok(())
}
