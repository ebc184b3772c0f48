//! A face cut by one plane after the other; each sign and each part is compared with exact rationals.

use super::judge::{POSITION_ERROR, Verdict, ensure};
use super::model::{self, Face};
use super::rational::{self, Point, Rational};
use binspace::internals::{
    Faces, PlaneId, PlaneKind, PreparedPlane, Side, Vertex, VertexKind, split,
};
use num_traits::Signed;

/// The counts of a run of tests.
#[derive(Clone, Copy, Debug, Default)]
pub struct Tally {
    /// Vertices compared with planes.
    pub signs: usize,
    /// Vertices that the filter left to the integers.
    pub undecided: usize,
    /// Vertices exactly on the plane.
    pub on_plane: usize,
    /// Pieces compared with planes, and pieces cut.
    pub pieces: usize,
    pub cuts: usize,
    /// Vertices made by two cuts.
    pub inside: usize,
    /// Pieces of faces that are planar by definition only.
    pub moved: usize,
    /// Pieces that the tolerance alone decided.
    pub tolerated: usize,
    /// Pieces whose distance from a plane equals the tolerance, up to rounding.
    pub ambiguous: usize,
    /// Vertices that a rounded distance alone would put on the wrong side.
    pub wrong: usize,
    /// The largest error of a coordinate, in lattice units.
    pub worst_position: f64,
}

/// A face that is cut by one plane after the other. After each cut, one of the two parts is kept.
pub struct Walk<'a> {
    faces: &'a Faces,
    face: u32,
    exact: Face,
    piece: Vec<Vertex>,
    outline: Vec<model::Vertex>,
    whole: bool,
    tally: &'a mut Tally,
}

impl<'a> Walk<'a> {
    pub fn new(faces: &'a Faces, face: u32, tally: &'a mut Tally) -> Self {
        let exact = Face::new(faces, face);
        let piece = Vertex::corners(faces, face).collect();
        let outline = exact.outline();
        Self { faces, face, exact, piece, outline, whole: true, tally }
    }

    /// Compares the piece with a plane, and cuts it if the plane does.
    pub fn step(&mut self, plane: PlaneId, keep_back: bool) -> Verdict {
        let prepared = PreparedPlane::new(self.faces, plane);
        let by = model::plane(self.faces, plane);
        let values: Vec<Rational> = self.outline.iter().map(|v| by.at(&v.point)).collect();
        for (vertex, value) in self.piece.clone().iter().zip(&values) {
            let side = prepared.side(self.faces, self.face, vertex);
            let is_right = side == rational::sign(value);
            ensure(is_right, || format!("{vertex:?} is {side:?} of {plane:?}"))?;
            self.check_distance(plane, &prepared, vertex, value)?;
        }
        let cut = (!self.whole).then_some(&*self.piece);
        let side = prepared.classify(self.faces, self.face, cut);
        let allowed = self.exact.classify((self.faces, self.face), (plane, &by), &values);
        ensure(allowed.contains(&side), || format!("{side:?} and not {allowed:?} of {plane:?}"))?;
        self.tally.pieces += 1;
        self.tally.moved += usize::from(self.exact.moved);
        self.tally.ambiguous += usize::from(allowed.iter().any(|other| other != &side));
        let spans =
            values.iter().any(Signed::is_positive) && values.iter().any(Signed::is_negative);
        self.tally.tolerated += usize::from(spans && side != Side::Spanning);
        if side == Side::Spanning {
            self.cut(plane, &prepared, &values, keep_back)?;
        }
        Ok(())
    }

    fn cut(
        &mut self,
        plane: PlaneId,
        prepared: &PreparedPlane,
        values: &[Rational],
        keep_back: bool,
    ) -> Verdict {
        self.tally.cuts += 1;
        let (mut front, mut back) = (Vec::new(), Vec::new());
        split(self.faces, prepared, self.face, &self.piece, &mut front, &mut back);
        let parts = [false, true].map(|behind| model::clip(&self.outline, values, plane, behind));
        self.check_part(&front, &parts[0])?;
        self.check_part(&back, &parts[1])?;
        let areas = [&front, &back, &self.piece].map(|piece| rational::area(&self.resolve(piece)));
        let sum = rational::sum(&areas[0], &areas[1]);
        ensure(sum == areas[2], || "area is lost".into())?;
        let [exact_front, exact_back] = parts;
        (self.piece, self.outline) =
            if keep_back { (back, exact_back) } else { (front, exact_front) };
        self.whole = false;
        Ok(())
    }

    fn resolve(&self, piece: &[Vertex]) -> Vec<Point> {
        piece.iter().map(|v| self.exact.resolve(self.faces, v.vertex_id())).collect()
    }

    fn check_part(&mut self, part: &[Vertex], expected: &[model::Vertex]) -> Verdict {
        let is_proper = part.len() >= 3 && part.len() == expected.len();
        ensure(is_proper, || format!("{part:?}, not {expected:?}"))?;
        for ((vertex, point), expected) in part.iter().zip(self.resolve(part)).zip(expected) {
            let is_same = vertex.line() == expected.line && point == expected.point;
            ensure(is_same, || format!("{vertex:?}, not {expected:?}"))?;
            let error = rational::distance_to_rounded(&point, vertex.position());
            self.tally.worst_position = self.tally.worst_position.max(error);
            ensure(error <= POSITION_ERROR, || format!("{vertex:?} is {error} off"))?;
            let stored = vertex.stored();
            let restored = stored.restored(self.faces, self.face);
            let parts = |v: &Vertex| (v.position(), v.vertex_id(), v.line());
            ensure(parts(&restored) == parts(vertex), || format!("{vertex:?} is not stored"))?;
            let by_two_cuts = matches!(vertex.vertex_id().kind(), VertexKind::Inside(..));
            self.tally.inside += usize::from(by_two_cuts);
        }
        Ok(())
    }

    fn check_distance(
        &mut self,
        plane: PlaneId,
        prepared: &PreparedPlane,
        vertex: &Vertex,
        exact: &Rational,
    ) -> Verdict {
        let rounded = prepared.distance(vertex.position());
        let bound = stated_bound(self.faces, plane);
        if self.faces.tolerance() == 0.0 {
            // Without a tolerance the slack is the bound of the filter.
            let is_enough = prepared.slack() >= bound * (1.0 - 1e-12);
            ensure(is_enough, || format!("the slack at {plane:?}"))?;
        }
        if rounded != 0.0 && rational::sign(&rational::exact(rounded)) != rational::sign(exact) {
            let error = rounded.abs() / bound;
            ensure(error <= 1.0, || format!("{error} of the bound for {vertex:?} at {plane:?}"))?;
            self.tally.wrong += 1;
        }
        self.tally.signs += 1;
        self.tally.undecided += usize::from(rounded.abs() <= bound);
        self.tally.on_plane += usize::from(rational::sign(exact).is_eq());
        Ok(())
    }
}

/// The bound of a distance with the wrong sign: 9.2 επm, with π the sum of the magnitudes of the products
/// in the normal; for an axis 3.05 εm.
fn stated_bound(faces: &Faces, plane: PlaneId) -> f64 {
    let unit = 2f64.powi(-53) * 2f64.powi(51);
    let PlaneKind::Face(face) = plane.kind() else { return 3.05 * unit };
    let [p, q, r] = faces.reference_triangle(face).map(|c| faces.corner(c));
    let product = |i: usize, j: usize| ((q[i] - p[i]) * (r[j] - p[j])).abs();
    let pairs = [(0, 1), (1, 0), (1, 2), (2, 1), (2, 0), (0, 2)];
    let size: f64 = pairs.into_iter().map(|(i, j)| product(i, j)).sum();
    9.2 * unit * size
}
