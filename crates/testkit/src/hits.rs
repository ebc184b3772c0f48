//! What a ray hits, found from the faces alone, in rationals.

use super::model::{self, Face};
use super::rational::{self, Point, Rational};
use binspace::glam::DVec3;
use binspace::internals::Faces;
use binspace::{Bounds, BspTree, Hit, Ray};
use num_traits::{One, Signed, ToPrimitive, Zero};
use std::cmp::Ordering;

/// A tree's faces, made ready for rays.
pub struct Oracle<'t> {
    tree: &'t BspTree,
    bounds: Bounds,
    faces: Vec<Face>,
    /// The same in floats, with balls around them, to pass over what is far from a ray.
    rough: Vec<Rough>,
    /// The length of a lattice step, and the world coordinates of the lattice's origin.
    step: Rational,
    origin: Point,
}

/// A face in floats, or all that is in a ball.
pub struct Rough {
    corners: Vec<DVec3>,
    pub centre: DVec3,
    pub radius: f64,
}

/// A ray in lattice units: from a point, along a direction, up to a parameter.
#[derive(Clone, Debug)]
struct Line {
    from: Point,
    direction: Point,
    end: Option<Rational>,
}

/// What a ray and a face have in common.
#[derive(Clone, Debug)]
struct Chord {
    face: u32,
    enter: Rational,
    leave: Rational,
    facing: Ordering,
}

/// A hit as it should be.
#[derive(Clone, Debug, PartialEq)]
pub struct Truth {
    pub polygon: usize,
    pub face: u32,
    pub t: Rational,
    pub facing: Ordering,
}

/// What was compared.
#[derive(Clone, Copy, Debug, Default)]
pub struct Score {
    pub rays: usize,
    pub hits: usize,
    /// Hits of rays in the polygon's plane.
    pub in_plane: usize,
    /// Hits at the same point as the one before.
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

impl<'t> Oracle<'t> {
    pub fn new(tree: &'t BspTree) -> Self {
        let faces = tree.faces();
        let lattice = faces.lattice();
        let rough = |face: u32| Rough::new(faces, face);
        Self {
            tree,
            bounds: tree.bounds().expect("memory"),
            faces: (0..faces.len() as u32).map(|face| Face::new(faces, face)).collect(),
            rough: (0..faces.len() as u32).map(rough).collect(),
            step: rational::step(lattice),
            origin: rational::point(lattice.to_world([0.0; 3])),
        }
    }

    pub fn tree(&self) -> &'t BspTree {
        self.tree
    }

    pub fn faces(&self) -> &'t Faces {
        self.tree.faces()
    }

    /// A point of the world in lattice units.
    pub fn to_lattice(&self, point: DVec3) -> Point {
        let offset = rational::difference(&rational::point(point), &self.origin);
        offset.map(|c| c / &self.step)
    }

    /// The plane of the points p of the world with `normal.dot(p) == offset`, in lattice units.
    pub fn plane(&self, normal: DVec3, offset: f64) -> rational::Plane {
        let normal = rational::point(normal);
        let offset = rational::exact(offset) - rational::scalar(&normal, &self.origin);
        rational::Plane { normal: normal.map(|c| c * &self.step), offset }
    }

    /// The exact vertices of a fragment.
    pub fn vertices(&self, fragment: u32) -> Vec<Point> {
        let fragment = self.tree.fragment(fragment);
        let face = &self.faces[fragment.face() as usize];
        fragment.symbols().map(|symbol| face.resolve(self.faces(), symbol)).collect()
    }

    fn line(&self, ray: Ray) -> Line {
        match ray {
            Ray::Segment { from, to } => {
                let [from, to] = [from, to].map(|point| self.to_lattice(point));
                let direction = rational::difference(&to, &from);
                Line { from, direction, end: Some(Rational::one()) }
            }
            Ray::Endless { from, direction } => Line {
                from: self.to_lattice(from),
                direction: rational::point(direction).map(|c| c / &self.step),
                end: None,
            },
        }
    }

    /// What a ray should hit, in order, and whether it should be blocked.
    pub fn truth(&self, ray: Ray) -> (Vec<Truth>, bool) {
        let line = self.line(ray);
        let chords = self.chords(&line);
        let is_inside =
            |t: &Rational| t.is_positive() && line.end.as_ref().is_none_or(|end| t < end);
        let is_blocked =
            chords.iter().any(|chord| chord.enter < chord.leave || is_inside(&chord.enter));
        (self.merged(chords), is_blocked)
    }

    fn chords(&self, line: &Line) -> Vec<Chord> {
        let float =
            |p: &Point| DVec3::from_array(p.each_ref().map(|c| c.to_f64().expect("in range")));
        let (from, direction) = (float(&line.from), float(&line.direction));
        let near = (0..self.faces.len()).filter(|&face| self.rough[face].is_near(from, direction));
        near.filter_map(|face| self.chord(line, face as u32)).collect()
    }

    /// The exact plane of a face.
    pub fn face_plane(&self, face: u32) -> &rational::Plane {
        &self.faces[face as usize].plane
    }

    fn chord(&self, line: &Line, face: u32) -> Option<Chord> {
        let Face { plane, corners, .. } = &self.faces[face as usize];
        let slope = rational::scalar(&plane.normal, &line.direction);
        let start = plane.at(&line.from);
        let facing = rational::sign(&slope).reverse();
        let axis = model::main_axis(plane);
        let [enter, leave] = if !slope.is_zero() {
            let t = -start / slope;
            contains(corners, &line.at(&t), axis).then(|| [t.clone(), t])?
        } else if start.is_zero() {
            through(corners, line, axis)?
        } else {
            return None;
        };
        let enter = enter.max(Rational::zero());
        let leave = line.end.as_ref().map_or(leave.clone(), |end| leave.min(end.clone()));
        (enter <= leave).then_some(Chord { face, enter, leave, facing })
    }

    /// One hit for each connected part of what the ray has in common with a polygon.
    fn merged(&self, mut chords: Vec<Chord>) -> Vec<Truth> {
        let polygon = |chord: &Chord| self.faces().polygon(chord.face);
        chords.sort_by(|a, b| (polygon(a), &a.enter, a.face).cmp(&(polygon(b), &b.enter, b.face)));
        let mut hits: Vec<Truth> = Vec::new();
        let mut end = Rational::zero();
        for chord in chords {
            let polygon = polygon(&chord);
            let goes_on =
                hits.last().is_some_and(|hit| hit.polygon == polygon) && chord.enter <= end;
            if goes_on {
                end = end.max(chord.leave);
            } else {
                let Chord { face, enter, leave, facing } = chord;
                hits.push(Truth { polygon, face, t: enter, facing });
                end = leave;
            }
        }
        hits.sort_by(|a, b| (&a.t, a.polygon).cmp(&(&b.t, b.polygon)));
        hits
    }

    /// Compares what the tree says of a ray with what it should.
    pub fn check(&self, ray: Ray, score: &mut Score) -> Result<(), String> {
        let (truth, is_blocked) = self.truth(ray);
        let hits: Vec<Hit<'_>> = self.tree.hits(ray).take(2 * truth.len() + 9).collect();
        let fault = |what: &str| format!("{what}: {ray:?}\nfound {hits:#?}\nin truth {truth:#?}");
        let polygons = |hit: &Hit<'_>| (hit.polygon(), hit.fragment().face(), hit.facing());
        let expected = truth.iter().map(|hit| (hit.polygon, hit.face, hit.facing));
        if !hits.iter().map(polygons).eq(expected) {
            return Err(fault("wrong hits"));
        }
        // By boxes, the same.
        let same = |hit: &Hit<'_>| (hit.fragment().index(), hit.facing(), hit.spot());
        let by_boxes = self.bounds.hits(self.tree, ray).take(2 * truth.len() + 9);
        if !by_boxes.map(|hit| same(&hit)).eq(hits.iter().map(same)) {
            return Err(fault("wrong hits by boxes"));
        }
        if self.bounds.is_blocked(self.tree, ray) != is_blocked {
            return Err(fault("wrongly blocked by boxes, or not"));
        }
        if self.tree.is_blocked(ray) != is_blocked {
            return Err(fault(if is_blocked { "not blocked" } else { "blocked" }));
        }
        let line = self.line(ray);
        for (hit, truth) in hits.iter().zip(&truth) {
            self.check_place(&line, hit, truth).map_err(|what| fault(&what))?;
            // Rationals of a fragment's vertices are large, so only some are looked at.
            if score.rays.is_multiple_of(8) {
                self.check_fragment(&line, hit, truth).map_err(|what| fault(&what))?;
            }
        }
        for (pair, truths) in hits.windows(2).zip(truth.windows(2)) {
            if pair[0].compare(&pair[1]) != truths[0].t.cmp(&truths[1].t) {
                return Err(fault("wrong comparison"));
            }
        }
        score.rays += 1;
        score.hits += hits.len();
        score.in_plane += hits.iter().filter(|hit| hit.facing().is_eq()).count();
        score.ties += truth.windows(2).filter(|pair| pair[0].t == pair[1].t).count();
        let is_end = |hit: &&Truth| hit.t.is_zero() || line.end.as_ref() == Some(&hit.t);
        score.at_ends += truth.iter().filter(is_end).count();
        score.blocked += usize::from(is_blocked);
        score.clear += usize::from(!is_blocked);
        Ok(())
    }

    /// The parameter and the point are as near as is promised, and the fragment has the point.
    fn check_place(&self, line: &Line, hit: &Hit<'_>, truth: &Truth) -> Result<(), String> {
        let exact = truth.t.to_f64().expect("in range");
        let rounded = hit.parameter();
        if (rounded - exact).abs() > exact.abs() * 2f64.powi(-52) && exact.is_normal() {
            return Err(format!("the parameter is {rounded:e}, not {exact:e}"));
        }
        let place = line.at(&truth.t);
        let found = hit.point().to_array();
        for axis in 0..3 {
            let world = &place[axis] * &self.step + &self.origin[axis];
            let off = (rational::exact(found[axis]) - &world).abs();
            let ulp = rational::exact(found[axis].abs().next_up() - found[axis].abs());
            // A step of the lattice is at most 2⁻⁵¹ of the extent.
            if off > &self.step + ulp {
                return Err(format!("the point is off by {off} along axis {axis}"));
            }
        }
        Ok(())
    }

    /// The fragment has the point.
    fn check_fragment(&self, line: &Line, hit: &Hit<'_>, truth: &Truth) -> Result<(), String> {
        let face = &self.faces[truth.face as usize];
        let vertices = self.vertices(hit.fragment().index());
        if !contains(&vertices, &line.at(&truth.t), model::main_axis(&face.plane)) {
            return Err("the fragment does not have the point".into());
        }
        Ok(())
    }
}

impl Line {
    fn at(&self, t: &Rational) -> Point {
        std::array::from_fn(|i| &self.from[i] + &self.direction[i] * t)
    }
}

impl Rough {
    pub fn new(faces: &Faces, face: u32) -> Self {
        let corners: Vec<DVec3> = faces.corners(face).iter().map(|&c| DVec3::from(c)).collect();
        let centre = corners.iter().sum::<DVec3>() / corners.len() as f64;
        let radius = corners.iter().map(|c| c.distance(centre)).fold(0.0, f64::max);
        Self { corners, centre, radius }
    }

    /// A ball around others.
    pub fn around(others: &[Self]) -> Self {
        let centre = others.iter().map(|other| other.centre).sum::<DVec3>() / others.len() as f64;
        let reach = |other: &Self| other.centre.distance(centre) + other.radius;
        let radius = others.iter().map(reach).fold(0.0, f64::max);
        Self { corners: vec![], centre, radius }
    }

    /// Whether a line may meet the face: generous.
    pub fn is_near(&self, from: DVec3, direction: DVec3) -> bool {
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

/// The coordinates behind an axis.
fn flat(p: &Point, axis: usize) -> [&Rational; 2] {
    [&p[(axis + 1) % 3], &p[(axis + 2) % 3]]
}

/// Twice the area of a triangle, seen along an axis.
fn turn([a, b, c]: [&Point; 3], axis: usize) -> Rational {
    let [a, b, c] = [a, b, c].map(|p| flat(p, axis));
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

/// Whether a convex outline has a point of its plane.
fn contains(outline: &[Point], point: &Point, axis: usize) -> bool {
    let next = outline.iter().cycle().skip(1);
    let turns: Vec<Ordering> =
        outline.iter().zip(next).map(|(a, b)| rational::sign(&turn([a, b, point], axis))).collect();
    !(turns.contains(&Ordering::Less) && turns.contains(&Ordering::Greater))
}

/// Between which parameters a line in the plane of a convex outline is inside: the least and the largest
/// of where it meets the edges. A line without direction is a point.
fn through(outline: &[Point], line: &Line, axis: usize) -> Option<[Rational; 2]> {
    if line.direction.iter().all(Zero::is_zero) {
        return contains(outline, &line.from, axis).then(|| [Rational::zero(), Rational::zero()]);
    }
    let beyond = rational::sum(&line.from, &line.direction);
    let i = (0..3).find(|&i| !line.direction[i].is_zero()).expect("a direction");
    let parameter = |p: &Point| (&p[i] - &line.from[i]) / &line.direction[i];
    let mut met: Vec<Rational> = Vec::new();
    let next = outline.iter().cycle().skip(1);
    for (a, b) in outline.iter().zip(next) {
        let [at_a, at_b] = [a, b].map(|p| turn([&line.from, &beyond, p], axis));
        let (side_a, side_b) = (rational::sign(&at_a), rational::sign(&at_b));
        if side_a.is_eq() {
            met.push(parameter(a));
        }
        if side_a.is_ne() && side_a == side_b.reverse() {
            met.push(parameter(&rational::crossing([a, b], [&at_a, &at_b])));
        }
    }
    let (least, most) = (met.iter().min()?.clone(), met.iter().max()?.clone());
    Some([least, most])
}
