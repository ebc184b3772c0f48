//! Computes the hits of a ray exactly from the faces alone: in integers over one denominator, which are never
//! reduced. Balls around runs of faces exclude most faces.

use super::model;
use super::rational::{self, Point, Rational};
use super::rays::{Vector, vector};
use super::vector::{Plane, main_axis, scalar, sign};
use binspace::glam::DVec3;
use binspace::internals::Faces;
use binspace::overlay::Overlay;
use binspace::{BspTree, Facing, Hit, Ray};
use dashu_int::IBig;
use num_traits::{One, Signed, Zero};
use std::cmp::Ordering;
use std::sync::OnceLock;

/// The number of consecutive faces that share a ball.
const RUN: usize = 16;

/// The faces of a tree, or of a tree and an overlay, prepared for rays.
pub struct Oracle<'t> {
    tree: &'t BspTree,
    overlay: Option<&'t Overlay>,
    given: &'t Faces,
    faces: Vec<Face>,
    /// The faces in rationals, computed on demand.
    models: Vec<OnceLock<model::Face>>,
    /// Each face in floats, with a bounding ball.
    rough: Vec<Rough>,
    /// Bounding balls of [`RUN`] consecutive faces.
    balls: Vec<Rough>,
    /// The lattice's origin, and the exponent of the length of its steps.
    origin: DVec3,
    step: i32,
    middle: DVec3,
}

/// A face in floats, or the contents of a ball.
struct Rough {
    corners: Vec<DVec3>,
    centre: DVec3,
    radius: f64,
}

struct Face {
    normal: Vector,
    offset: IBig,
    corners: Vec<Vector>,
    /// The two axes of the face's projection.
    seen: [usize; 2],
    polygon: usize,
}

/// A fraction with a denominator above 0.
#[derive(Clone, Debug)]
struct Fraction {
    over: IBig,
    under: IBig,
}

/// A ray: its points are (from + u · direction) / 2^bits in lattice units, and its parameter is u · 2^up.
struct Line {
    from: Vector,
    direction: Vector,
    bits: usize,
    up: i32,
    end: Option<Fraction>,
}

#[derive(Debug)]
struct Chord {
    face: usize,
    enter: Fraction,
    leave: Fraction,
    facing: Ordering,
}

/// The counts of comparisons.
#[derive(Clone, Copy, Debug, Default)]
pub struct Score {
    pub rays: usize,
    pub hits: usize,
    /// Hits of rays in the polygon's plane.
    pub in_plane: usize,
    /// Hits at the same point as the hit before.
    pub ties: usize,
    /// Hits at an end of the ray.
    pub at_ends: usize,
    pub blocked: usize,
    pub clear: usize,
}

impl Score {
    pub fn plus(self, other: Self) -> Self {
        Self {
            rays: self.rays + other.rays,
            hits: self.hits + other.hits,
            in_plane: self.in_plane + other.in_plane,
            ties: self.ties + other.ties,
            at_ends: self.at_ends + other.at_ends,
            blocked: self.blocked + other.blocked,
            clear: self.clear + other.clear,
        }
    }
}

impl Fraction {
    fn new(over: IBig, under: IBig) -> Self {
        if under.is_negative() { Self { over: -over, under: -under } } else { Self { over, under } }
    }

    fn whole(number: i32) -> Self {
        Self { over: number.into(), under: IBig::one() }
    }
}

impl PartialEq for Fraction {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other).is_eq()
    }
}

impl Eq for Fraction {}

impl PartialOrd for Fraction {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Fraction {
    fn cmp(&self, other: &Self) -> Ordering {
        (&self.over * &other.under).cmp(&(&other.over * &self.under))
    }
}

/// A number as a whole number and the exponent of a power of two.
fn parts(value: f64) -> (i64, i32) {
    let bits = value.abs().to_bits();
    let (exponent, digits) = ((bits >> 52) as i32, (bits & ((1 << 52) - 1)) as i64);
    let (digits, exponent) =
        if exponent == 0 { (digits, -1074) } else { (digits | 1 << 52, exponent - 1075) };
    (if value < 0.0 { -digits } else { digits }, exponent)
}

/// The least exponent of some numbers. Zeros count as a number with the exponent 2000.
fn least(values: impl IntoIterator<Item = f64>) -> i32 {
    let exponent = |value: f64| {
        let (digits, exponent) = parts(value);
        if digits == 0 { 2000 } else { exponent + digits.trailing_zeros() as i32 }
    };
    values.into_iter().map(exponent).min().expect("numbers")
}

/// A number in units of a power of two. The number must be a multiple of this unit.
fn whole(value: f64, unit: i32) -> IBig {
    let (digits, exponent) = parts(value);
    if digits == 0 {
        return IBig::zero();
    }
    let zeros = digits.trailing_zeros();
    IBig::from(digits >> zeros)
        << usize::try_from(exponent + zeros as i32 - unit).expect("a multiple")
}

impl Face {
    fn new(faces: &Faces, face: u32) -> Self {
        let [p, q, r] = faces.reference_triangle(face).map(|corner| vector(faces.corner(corner)));
        let Plane { normal, offset } = Plane::through([&p, &q, &r]);
        let axis = main_axis(&normal);
        Self {
            offset,
            normal,
            corners: faces.corners(face).iter().map(|&corner| vector(corner)).collect(),
            seen: [(axis + 1) % 3, (axis + 2) % 3],
            polygon: faces.polygon(face),
        }
    }

    /// For each corner, the direction in which the border turns around the point `at` / `under` on the way to
    /// the next corner.
    fn turns(&self, at: [&IBig; 2], under: &IBig) -> Vec<Ordering> {
        let [i, j] = self.seen;
        let next = self.corners.iter().cycle().skip(1);
        let turn = |(a, b): (&Vector, &Vector)| {
            let [x, y] = [at[0] - &a[i] * under, at[1] - &a[j] * under];
            sign(&((&b[i] - &a[i]) * y - (&b[j] - &a[j]) * x))
        };
        self.corners.iter().zip(next).map(turn).collect()
    }

    fn has(&self, at: [&IBig; 2], under: &IBig) -> bool {
        let turns = self.turns(at, under);
        !(turns.contains(&Ordering::Less) && turns.contains(&Ordering::Greater))
    }

    /// The common part of a line and the face, without its ends.
    fn chord(&self, line: &Line) -> Option<([Fraction; 2], Ordering)> {
        let slope = scalar(&self.normal, &line.direction);
        let start = scalar(&self.normal, &line.from) - (&self.offset << line.bits);
        let facing = sign(&slope).reverse();
        if slope.is_zero() {
            return if start.is_zero() { Some((self.along(line)?, facing)) } else { None };
        }
        let u = Fraction::new(-start, slope);
        let at = self.seen.map(|i| &line.from[i] * &u.under + &line.direction[i] * &u.over);
        let under = &u.under << line.bits;
        self.has([&at[0], &at[1]], &under).then(|| ([u.clone(), u], facing))
    }

    /// The common part of a line in the plane: from the least to the largest intersection with the border.
    fn along(&self, line: &Line) -> Option<[Fraction; 2]> {
        let [i, j] = self.seen;
        let [dx, dy] = [&line.direction[i], &line.direction[j]];
        if dx.is_zero() && dy.is_zero() {
            let one = IBig::one() << line.bits;
            let inside = self.has([&line.from[i], &line.from[j]], &one);
            return inside.then(|| [Fraction::whole(0), Fraction::whole(0)]);
        }
        // Corners relative to the start of the line, and the sides of the line on which they are.
        let arms: Vec<[IBig; 2]> = self
            .corners
            .iter()
            .map(|c| self.seen.map(|axis| (&c[axis] << line.bits) - &line.from[axis]))
            .collect();
        let sides: Vec<IBig> = arms.iter().map(|[x, y]| dx * y - dy * x).collect();
        let (k, d) = if dx.is_zero() { (1, dy) } else { (0, dx) };
        let mut met = Vec::new();
        for a in 0..arms.len() {
            let b = (a + 1) % arms.len();
            if sides[a].is_zero() {
                met.push(Fraction::new(arms[a][k].clone(), d.clone()));
            } else if sign(&sides[a]) == sign(&sides[b]).reverse() {
                let over = &sides[a] * &arms[b][k] - &sides[b] * &arms[a][k];
                met.push(Fraction::new(over, (&sides[a] - &sides[b]) * d));
            }
        }
        Some([met.iter().min()?.clone(), met.iter().max()?.clone()])
    }
}

impl Line {
    /// A point of the hit, in lattice units.
    fn at(&self, u: &Fraction) -> Point {
        let under = &u.under << self.bits;
        std::array::from_fn(|i| {
            let over = &self.from[i] * &u.under + &self.direction[i] * &u.over;
            Rational::from_parts_signed(over, under.clone())
        })
    }

    /// The parameter of the ray at this point.
    fn parameter(&self, u: &Fraction) -> f64 {
        let bits = self.up.unsigned_abs() as usize;
        let t = match self.up >= 0 {
            true => Rational::from_parts_signed(&u.over << bits, u.under.clone()),
            false => Rational::from_parts_signed(u.over.clone(), &u.under << bits),
        };
        t.to_f64().value()
    }
}

impl<'t> Oracle<'t> {
    pub fn new(tree: &'t BspTree) -> Self {
        Self::of(tree, None, tree.faces())
    }

    /// Creates the oracle of an overlay's hits, from the faces of the tree and of the overlay's polygons.
    pub fn with_overlay(tree: &'t BspTree, overlay: &'t Overlay, faces: &'t Faces) -> Self {
        Self::of(tree, Some(overlay), faces)
    }

    fn of(tree: &'t BspTree, overlay: Option<&'t Overlay>, faces: &'t Faces) -> Self {
        /// The length of 2^`MANY` steps fits an `f64`, however small the scene is.
        const MANY: i32 = 100;
        let all = || 0..faces.len() as u32;
        let rough: Vec<Rough> = all().map(|face| Rough::new(faces, face)).collect();
        let balls: Vec<Rough> = rough.chunks(RUN).map(Rough::around).collect();
        let length = |exponent: i32| parts(faces.lattice().length_to_world(2f64.powi(exponent)));
        let many = if faces.lattice().length_to_world(1.0) < 1.0 { MANY } else { 0 };
        let (digits, exponent) = length(many);
        assert_eq!(digits.count_ones(), 1, "a power of two");
        Self {
            tree,
            overlay,
            given: faces,
            faces: all().map(|face| Face::new(faces, face)).collect(),
            models: all().map(|_| OnceLock::new()).collect(),
            middle: Rough::around(&balls).centre,
            rough,
            balls,
            origin: faces.lattice().to_world([0.0; 3]),
            step: exponent + digits.trailing_zeros() as i32 - many,
        }
    }

    pub fn tree(&self) -> &'t BspTree {
        self.tree
    }

    pub fn faces(&self) -> &'t Faces {
        self.given
    }

    /// Returns a face in rationals.
    pub fn model(&self, face: u32) -> &model::Face {
        self.models[face as usize].get_or_init(|| model::Face::new(self.faces(), face))
    }

    /// Returns the plane of the points p of the world with `normal.dot(p) == offset`, in lattice units.
    pub fn plane(&self, normal: DVec3, offset: f64) -> rational::Plane {
        let (normal, step) = (rational::point(normal), rational::step(self.faces().lattice()));
        let origin = rational::point(self.origin);
        let offset = rational::exact(offset) - rational::scalar(&normal, &origin);
        rational::Plane { normal: normal.map(|c| c * &step), offset }
    }

    /// Returns the exact vertices of a fragment.
    pub fn vertices(&self, fragment: u32) -> Vec<Point> {
        let piece = self.overlay.and_then(|overlay| overlay.piece(fragment));
        let fragment = piece.unwrap_or_else(|| self.tree.fragment(fragment));
        let face = self.model(fragment.face());
        // A piece of the overlay may be cut by planes that are no face of a polygon.
        let faces = self.overlay.map_or(self.faces(), |overlay| overlay.faces());
        fragment.vertex_ids().map(|vertex_id| face.resolve(faces, vertex_id)).collect()
    }

    fn line(&self, ray: Ray) -> Line {
        let origin = self.origin.to_array();
        let place = |point: DVec3, unit: i32| -> Vector {
            std::array::from_fn(|i| whole(point[i], unit) - whole(origin[i], unit))
        };
        match ray {
            Ray::Segment { from, to } => {
                let numbers = [from, to].map(|point| point.to_array()).into_iter().flatten();
                let unit = least(numbers.chain(origin)).min(self.step);
                let [from, to] = [from, to].map(|point| place(point, unit));
                let direction = std::array::from_fn(|i| &to[i] - &from[i]);
                let bits = (self.step - unit) as usize;
                Line { from, direction, bits, up: 0, end: Some(Fraction::whole(1)) }
            }
            Ray::Endless { from, direction } => {
                let unit = least(from.to_array().into_iter().chain(origin)).min(self.step);
                let own = least(direction.to_array());
                let direction = direction.to_array().map(|c| whole(c, own));
                let bits = (self.step - unit) as usize;
                Line { from: place(from, unit), direction, bits, up: unit - own, end: None }
            }
        }
    }

    /// The faces that a line may meet. They are tested from the point of the line that is nearest to the
    /// scene, so that floats lose little precision.
    fn near(&self, line: &Line) -> Vec<usize> {
        let number = |c: &IBig| c.to_f64().value();
        let unit = 2f64.powi(-(line.bits as i32));
        let [from, direction] =
            [&line.from, &line.direction].map(|v| DVec3::from_array(v.each_ref().map(number)));
        let square = direction.length_squared();
        let way = direction.dot(self.middle / unit - from) / square;
        let is_told = way.is_finite() && square.is_normal() || direction == DVec3::ZERO;
        if !is_told || unit == 0.0 {
            return (0..self.faces.len()).collect();
        }
        let (digits, exponent) = parts(if way.is_finite() { way } else { 0.0 });
        let at = |i: usize| {
            let step = &line.direction[i] * digits;
            if exponent >= 0 {
                number(&(&line.from[i] + (step << exponent as usize))) * unit
            } else {
                number(&(&line.from[i] + (step >> -exponent as usize))) * unit
            }
        };
        let (from, direction) =
            (DVec3::from_array([at(0), at(1), at(2)]), direction.normalize_or_zero());
        if !from.is_finite() {
            return (0..self.faces.len()).collect();
        }
        let balls = self.balls.iter().enumerate().filter(|(_, ball)| ball.is_near(from, direction));
        let faces = balls.flat_map(|(k, _)| k * RUN..self.faces.len().min((k + 1) * RUN));
        faces.filter(|&face| self.rough[face].is_near(from, direction)).collect()
    }

    fn chords(&self, line: &Line) -> Vec<Chord> {
        let zero = Fraction::whole(0);
        let mut chords = Vec::new();
        for face in self.near(line) {
            let Some(([enter, leave], facing)) = self.faces[face].chord(line) else { continue };
            let enter = enter.max(zero.clone());
            let leave = match &line.end {
                Some(end) => leave.min(end.clone()),
                None => leave,
            };
            if enter <= leave {
                chords.push(Chord { face, enter, leave, facing });
            }
        }
        chords
    }

    /// One hit for each connected part of a polygon, the nearest first.
    fn hits(&self, mut chords: Vec<Chord>) -> Vec<Chord> {
        let polygon = |chord: &Chord| self.faces[chord.face].polygon;
        chords.sort_by(|a, b| {
            let by_place = || a.enter.cmp(&b.enter).then(a.face.cmp(&b.face));
            polygon(a).cmp(&polygon(b)).then_with(by_place)
        });
        let mut hits: Vec<Chord> = Vec::new();
        for chord in chords {
            match hits.last_mut() {
                Some(hit) if polygon(hit) == polygon(&chord) && chord.enter <= hit.leave => {
                    if chord.leave > hit.leave {
                        hit.leave = chord.leave;
                    }
                }
                _ => hits.push(chord),
            }
        }
        hits.sort_by(|a, b| a.enter.cmp(&b.enter).then_with(|| polygon(a).cmp(&polygon(b))));
        hits
    }

    /// Returns the parameter of the nearest hit.
    pub fn nearest(&self, ray: Ray) -> Option<f64> {
        let line = self.line(ray);
        let first = self.chords(&line).into_iter().map(|chord| chord.enter).min()?;
        Some(line.parameter(&first))
    }

    /// Whether a point of the ray is so far from the scene that the ray may miss it; see `Ray`.
    fn may_miss(&self, ray: Ray) -> bool {
        let faces = self.given;
        let corners = (0..faces.len() as u32).flat_map(|face| faces.corners(face));
        let corners = corners.map(|&corner| faces.lattice().to_world(corner));
        let empty = [DVec3::INFINITY, DVec3::NEG_INFINITY];
        let [low, high] = corners.fold(empty, |[low, high], c| [low.min(c), high.max(c)]);
        let far = (high - low).max_element() * 2f64.powi(68);
        let points = match ray {
            Ray::Endless { from, .. } => [from; 2],
            Ray::Segment { from, to } => [from, to],
        };
        points.iter().any(|&point| (low - point).max(point - high).max_element() > far)
    }

    /// Compares the tree's answers for a ray with the right answers.
    pub fn check(&self, ray: Ray, score: &mut Score) -> Result<(), String> {
        let line = self.line(ray);
        let chords = self.chords(&line);
        let is_inside =
            |u: &Fraction| u.over.is_positive() && line.end.as_ref().is_none_or(|end| u < end);
        let is_occluded =
            chords.iter().any(|chord| chord.enter < chord.leave || is_inside(&chord.enter));
        let truth = self.hits(chords);
        let most = 2 * truth.len() + 9;
        let hits: Vec<Hit<'_>> = match self.overlay {
            Some(overlay) => overlay.hits(self.tree, ray).expect("its tree").take(most).collect(),
            None => self.tree.hits(ray).take(most).collect(),
        };
        let fault = |what: &str| format!("{what}: {ray:?}\nfound {hits:#?}\nin truth {truth:#?}");
        let said = |hit: &Hit<'_>| (hit.polygon(), hit.fragment().face() as usize, hit.facing());
        let expected =
            truth.iter().map(|hit| (self.faces[hit.face].polygon, hit.face, hit.facing.into()));
        if !hits.iter().map(said).eq(expected) {
            let is_excused = hits.is_empty() && self.may_miss(ray);
            return if is_excused { Ok(()) } else { Err(fault("wrong hits")) };
        }
        let found = match self.overlay {
            Some(overlay) => overlay.is_occluded(self.tree, ray).expect("its tree"),
            None => self.tree.is_occluded(ray),
        };
        if found != is_occluded {
            return Err(fault("wrongly blocked, or not"));
        }
        for (hit, truth) in hits.iter().zip(&truth) {
            self.check_place(&line, hit, &truth.enter).map_err(|what| fault(&what))?;
            // The rationals of a fragment's vertices are large, so only some fragments are tested.
            let has_point = || {
                let axis = main_axis(&self.faces[truth.face].normal);
                let vertices = self.vertices(hit.fragment().index());
                contains(&vertices, &line.at(&truth.enter), axis)
            };
            if score.rays.is_multiple_of(8) && !has_point() {
                return Err(fault("the fragment does not have the point"));
            }
        }
        for (pair, truths) in hits.windows(2).zip(truth.windows(2)) {
            let order = truths[0].enter.cmp(&truths[1].enter);
            if pair[0].compare(&pair[1]) != order {
                return Err(fault("wrong comparison"));
            }
            score.ties += usize::from(order.is_eq());
        }
        score.rays += 1;
        score.hits += hits.len();
        score.in_plane += hits.iter().filter(|hit| hit.facing() == Facing::EdgeOn).count();
        let is_end =
            |hit: &&Chord| hit.enter.over.is_zero() || line.end.as_ref() == Some(&hit.enter);
        score.at_ends += truth.iter().filter(is_end).count();
        score.blocked += usize::from(is_occluded);
        score.clear += usize::from(!is_occluded);
        Ok(())
    }

    /// Checks that the errors of the parameter and of the point are within the documented bounds.
    fn check_place(&self, line: &Line, hit: &Hit<'_>, u: &Fraction) -> Result<(), String> {
        let (exact, rounded) = (line.parameter(u), hit.parameter());
        if (rounded - exact).abs() > exact.abs() * 2f64.powi(-52) && exact.is_normal() {
            return Err(format!("the parameter is {rounded:e}, not {exact:e}"));
        }
        let own = self.step - line.bits as i32;
        for (axis, found) in hit.point().to_array().into_iter().enumerate() {
            let ulp = found.abs().next_up() - found.abs();
            // All numbers are in units of a power of two, times the parameter's denominator.
            let unit = own.min(least([found, ulp]));
            let from = &line.from[axis] + whole(self.origin[axis], own);
            let place =
                (from * &u.under + &line.direction[axis] * &u.over) << (own - unit) as usize;
            let off = (whole(found, unit) * &u.under - place).abs();
            // A step of the lattice is at most 2⁻⁵¹ of the extent.
            let step = IBig::one() << (self.step - unit) as usize;
            if off > (step + whole(ulp, unit)) * &u.under {
                return Err(format!("the point is off along axis {axis}"));
            }
        }
        Ok(())
    }
}

impl Rough {
    fn new(faces: &Faces, face: u32) -> Self {
        let corners: Vec<DVec3> = faces.corners(face).iter().map(|&c| DVec3::from(c)).collect();
        let centre = corners.iter().sum::<DVec3>() / corners.len() as f64;
        let radius = corners.iter().map(|c| c.distance(centre)).fold(0.0, f64::max);
        Self { corners, centre, radius }
    }

    /// A ball around other balls.
    fn around(others: &[Self]) -> Self {
        let centre = others.iter().map(|other| other.centre).sum::<DVec3>() / others.len() as f64;
        let reach = |other: &Self| other.centre.distance(centre) + other.radius;
        let radius = others.iter().map(reach).fold(0.0, f64::max);
        Self { corners: vec![], centre, radius }
    }

    /// Whether a line may meet the face, with a margin.
    fn is_near(&self, from: DVec3, direction: DVec3) -> bool {
        let size = from.abs().max_element() + self.centre.abs().max_element() + self.radius;
        let slack = 1e-9 * size;
        let length = direction.length();
        let arm = self.centre - from;
        if length == 0.0 || !length.is_normal() {
            return arm.length() <= self.radius * 1.001 + slack;
        }
        let along = direction / length;
        if along.cross(arm).length() > self.radius * 1.001 + slack {
            return false;
        }
        if self.corners.is_empty() {
            return true;
        }
        let mut seen = [false; 2];
        for (k, &a) in self.corners.iter().enumerate() {
            let b = self.corners[(k + 1) % self.corners.len()];
            let (a, b) = (a - from, b - from);
            let turn = along.dot(a.cross(b));
            let margin = 1e-9 * size * (a.length() + b.length() + size);
            seen[0] |= turn > margin;
            seen[1] |= turn < -margin;
        }
        seen != [true; 2]
    }
}

/// Whether a convex outline contains a point of its plane, seen along an axis.
fn contains(outline: &[Point], point: &Point, axis: usize) -> bool {
    let [i, j] = [(axis + 1) % 3, (axis + 2) % 3];
    let turn = |(a, b): (&Point, &Point)| {
        sign(&((&b[i] - &a[i]) * (&point[j] - &a[j]) - (&b[j] - &a[j]) * (&point[i] - &a[i])))
    };
    let turns: Vec<Ordering> =
        outline.iter().zip(outline.iter().cycle().skip(1)).map(turn).collect();
    !(turns.contains(&Ordering::Less) && turns.contains(&Ordering::Greater))
}
