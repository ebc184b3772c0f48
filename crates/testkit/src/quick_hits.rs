//! What a ray hits, as in `hits`, a hundred times as fast: in integers over one denominator, which are
//! never reduced, and with balls around runs of faces, to pass over most of them.

use super::hits::{Rough, Score};
use super::rays::{Vector, vector};
use super::vector::{Plane, main_axis, scalar, sign};
use binspace::glam::DVec3;
use binspace::internals::Faces;
use binspace::{Bounds, BspTree, Hit, Ray};
use num_bigint::BigInt;
use num_traits::{One, Signed, ToPrimitive, Zero};
use std::cmp::Ordering;

/// How many faces in a row have a ball.
const RUN: usize = 16;

/// A tree's faces, made ready for many rays.
pub struct QuickOracle<'t> {
    tree: &'t BspTree,
    bounds: Bounds,
    faces: Vec<Face>,
    rough: Vec<Rough>,
    balls: Vec<Rough>,
    /// Where the lattice's origin is, and the exponent of the length of its steps.
    origin: DVec3,
    step: i32,
    middle: DVec3,
}

struct Face {
    normal: Vector,
    offset: BigInt,
    corners: Vec<Vector>,
    /// The two axes along which it is looked at.
    seen: [usize; 2],
    polygon: usize,
}

/// A number over another that is above 0.
#[derive(Clone, Debug)]
struct Fraction {
    over: BigInt,
    under: BigInt,
}

/// A ray: its points are (from + u · direction) / 2^bits in lattice units, and its parameter is u · 2^up.
struct Line {
    from: Vector,
    direction: Vector,
    bits: u32,
    up: i32,
    end: Option<Fraction>,
}

struct Chord {
    face: usize,
    enter: Fraction,
    leave: Fraction,
    facing: Ordering,
}

impl Fraction {
    fn new(over: BigInt, under: BigInt) -> Self {
        if under.is_negative() { Self { over: -over, under: -under } } else { Self { over, under } }
    }

    fn whole(number: i32) -> Self {
        Self { over: number.into(), under: BigInt::one() }
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

/// A number as a whole number times a power of two.
fn parts(value: f64) -> (i64, i32) {
    let bits = value.abs().to_bits();
    let (exponent, digits) = ((bits >> 52) as i32, (bits & ((1 << 52) - 1)) as i64);
    let (digits, exponent) =
        if exponent == 0 { (digits, -1074) } else { (digits | 1 << 52, exponent - 1075) };
    (if value < 0.0 { -digits } else { digits }, exponent)
}

/// The least exponent of some numbers; of zeros, a large one.
fn least(values: impl IntoIterator<Item = f64>) -> i32 {
    let exponent = |value: f64| {
        let (digits, exponent) = parts(value);
        if digits == 0 { 2000 } else { exponent + digits.trailing_zeros() as i32 }
    };
    values.into_iter().map(exponent).min().expect("numbers")
}

/// A number in units of a power of two that divides it.
fn whole(value: f64, unit: i32) -> BigInt {
    let (digits, exponent) = parts(value);
    if digits == 0 {
        return BigInt::zero();
    }
    let zeros = digits.trailing_zeros();
    BigInt::from(digits >> zeros)
        << u32::try_from(exponent + zeros as i32 - unit).expect("a multiple")
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

    /// Which way the border turns from a corner to the next around a point `at` / `under`, for all.
    fn turns(&self, at: [&BigInt; 2], under: &BigInt) -> Vec<Ordering> {
        let [i, j] = self.seen;
        let next = self.corners.iter().cycle().skip(1);
        let turn = |(a, b): (&Vector, &Vector)| {
            let [x, y] = [at[0] - &a[i] * under, at[1] - &a[j] * under];
            sign(&((&b[i] - &a[i]) * y - (&b[j] - &a[j]) * x))
        };
        self.corners.iter().zip(next).map(turn).collect()
    }

    fn has(&self, at: [&BigInt; 2], under: &BigInt) -> bool {
        let turns = self.turns(at, under);
        !(turns.contains(&Ordering::Less) && turns.contains(&Ordering::Greater))
    }

    /// What a line has in common with the face, ends left aside.
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

    /// The same of a line in the plane: from the least to the largest of where it meets the border.
    fn along(&self, line: &Line) -> Option<[Fraction; 2]> {
        let [i, j] = self.seen;
        let [dx, dy] = [&line.direction[i], &line.direction[j]];
        if dx.is_zero() && dy.is_zero() {
            let one = BigInt::one() << line.bits;
            let inside = self.has([&line.from[i], &line.from[j]], &one);
            return inside.then(|| [Fraction::whole(0), Fraction::whole(0)]);
        }
        // Corners relative to the beginning, and on which side of the line they are.
        let arms: Vec<[BigInt; 2]> = self
            .corners
            .iter()
            .map(|c| self.seen.map(|axis| (&c[axis] << line.bits) - &line.from[axis]))
            .collect();
        let sides: Vec<BigInt> = arms.iter().map(|[x, y]| dx * y - dy * x).collect();
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

impl<'t> QuickOracle<'t> {
    pub fn new(tree: &'t BspTree) -> Self {
        let faces = tree.faces();
        let all = || 0..faces.len() as u32;
        let rough: Vec<Rough> = all().map(|face| Rough::new(faces, face)).collect();
        let balls: Vec<Rough> = rough.chunks(RUN).map(Rough::around).collect();
        let step = faces.lattice().length_to_world(1.0);
        let (digits, exponent) = parts(step);
        assert_eq!(digits.count_ones(), 1, "a power of two");
        Self {
            tree,
            bounds: tree.bounds().expect("memory"),
            faces: all().map(|face| Face::new(faces, face)).collect(),
            middle: Rough::around(&balls).centre,
            rough,
            balls,
            origin: faces.lattice().to_world([0.0; 3]),
            step: exponent + digits.trailing_zeros() as i32,
        }
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
                let bits = (self.step - unit) as u32;
                Line { from, direction, bits, up: 0, end: Some(Fraction::whole(1)) }
            }
            Ray::Endless { from, direction } => {
                let unit = least(from.to_array().into_iter().chain(origin)).min(self.step);
                let own = least(direction.to_array());
                let direction = direction.to_array().map(|c| whole(c, own));
                let bits = (self.step - unit) as u32;
                Line { from: place(from, unit), direction, bits, up: unit - own, end: None }
            }
        }
    }

    /// The faces that a line may meet: looked for from where it is nearest to the scene, so that floats lose
    /// little.
    fn near(&self, line: &Line) -> Vec<usize> {
        let number = |c: &BigInt| c.to_f64().unwrap_or(f64::NAN);
        let unit = 2f64.powi(-(line.bits as i32));
        let [from, direction] =
            [&line.from, &line.direction].map(|v| DVec3::from_array(v.each_ref().map(number)));
        let way = direction.dot(self.middle / unit - from) / direction.length_squared();
        if !way.is_finite() && direction != DVec3::ZERO || unit == 0.0 {
            return (0..self.faces.len()).collect();
        }
        let (digits, exponent) = parts(if way.is_finite() { way } else { 0.0 });
        let at = |i: usize| {
            let step = &line.direction[i] * digits;
            if exponent >= 0 {
                number(&(&line.from[i] + (step << exponent as u32))) * unit
            } else {
                number(&(&line.from[i] + (step >> -exponent as u32))) * unit
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

    /// One for each connected part of a polygon, the nearest first.
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

    /// Compares what the tree says of a ray with what it should.
    pub fn check(&self, ray: Ray, score: &mut Score) -> Result<(), String> {
        let line = self.line(ray);
        let chords = self.chords(&line);
        let is_inside =
            |u: &Fraction| u.over.is_positive() && line.end.as_ref().is_none_or(|end| u < end);
        let is_blocked =
            chords.iter().any(|chord| chord.enter < chord.leave || is_inside(&chord.enter));
        let truth = self.hits(chords);
        let most = 2 * truth.len() + 9;
        let found: Vec<Hit<'_>> = self.tree.hits(ray).take(most).collect();
        let fault = |what: &str| {
            let truth: Vec<_> = truth.iter().map(|hit| (hit.face, hit.facing)).collect();
            format!("{what}: {ray:?}\nfound {found:#?}\nin truth {truth:?}")
        };
        let expected = || truth.iter().map(|hit| (hit.face, hit.facing));
        let said = |hit: Hit<'_>| (hit.fragment().face() as usize, hit.facing());
        if !found.iter().map(|hit| said(*hit)).eq(expected()) {
            return Err(fault("wrong hits"));
        }
        if !self.bounds.hits(self.tree, ray).take(most).map(said).eq(expected()) {
            return Err(fault("wrong hits by boxes"));
        }
        if [self.tree.is_blocked(ray), self.bounds.is_blocked(self.tree, ray)] != [is_blocked; 2] {
            return Err(fault("wrongly blocked, or not"));
        }
        for (hit, truth) in found.iter().zip(&truth) {
            let Fraction { over, under } = &truth.enter;
            let rough = over.to_f64().unwrap_or(f64::NAN) / under.to_f64().unwrap_or(f64::NAN);
            let t = rough * 2f64.powi(line.up.clamp(-1000, 1000));
            let is_known = t.is_normal() && line.up.abs() <= 1000;
            if is_known && (hit.parameter() - t).abs() > t.abs() * 2f64.powi(-50) {
                return Err(fault("wrong parameter"));
            }
        }
        for (pair, truths) in found.windows(2).zip(truth.windows(2)) {
            let order = truths[0].enter.cmp(&truths[1].enter);
            if pair[0].compare(&pair[1]) != order {
                return Err(fault("wrong comparison"));
            }
            score.ties += usize::from(order.is_eq());
        }
        score.rays += 1;
        score.hits += found.len();
        score.in_plane += found.iter().filter(|hit| hit.facing().is_eq()).count();
        let is_end =
            |hit: &&Chord| hit.enter.over.is_zero() || line.end.as_ref() == Some(&hit.enter);
        score.at_ends += truth.iter().filter(is_end).count();
        score.blocked += usize::from(is_blocked);
        score.clear += usize::from(!is_blocked);
        Ok(())
    }
}
