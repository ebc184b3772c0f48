//! A face cut again and again, each sign and each part against exact rationals.

use super::super::model::{self, Face};
use super::super::rational::{self, Rational};
use super::super::{decode, judge};
use arbitrary::{Result, Unstructured};
use binspace::internals::{Exact, Faces, Kernel, Piece, PlaneId, Side, Vertex, split};

type ExactVertex = <Exact as Kernel>::Vertex;

/// A scene of at most eight polygons, and up to sixteen cuts.
pub fn run(data: &[u8]) {
    // Bytes that run out end the cuts.
    let _ = try_run(&mut Unstructured::new(data));
}

fn try_run(bytes: &mut Unstructured<'_>) -> Result<()> {
    let tolerance = decode::options(bytes)?.tolerance;
    let polygons = decode::polygons(bytes, 8)?;
    let Ok((faces, _)) = Faces::new(&polygons, tolerance) else {
        let refused = polygons.iter().flatten().any(|corner| !corner.is_finite());
        // Without ear clipping, what is not convex is refused.
        assert!(refused, "{polygons:?}");
        return Ok(());
    };
    if faces.is_empty() {
        return Ok(());
    }
    let mut walk = Walk::new(&faces, bytes.int_in_range(0..=faces.len() - 1)? as u32);
    for _ in 0..16 {
        let plane = if bytes.int_in_range(0..=2u8)? == 0 {
            let corner = bytes.int_in_range(0..=faces.corner_count() - 1)?;
            PlaneId::axis(bytes.int_in_range(0..=2usize)?, corner as u32)
        } else {
            PlaneId::face(bytes.int_in_range(0..=faces.len() - 1)? as u32)
        };
        if let Err(what) = walk.step(plane, bytes.arbitrary()?) {
            panic!("{what}: face {} of {polygons:?}, {plane:?}", walk.face);
        }
    }
    Ok(())
}

/// One face, cut by one plane after the other; one of the two parts is followed.
struct Walk<'a> {
    faces: &'a Faces,
    face: u32,
    exact: Face,
    piece: Vec<ExactVertex>,
    outline: Vec<model::Vertex>,
    whole: bool,
}

impl<'a> Walk<'a> {
    fn new(faces: &'a Faces, face: u32) -> Self {
        let exact = Face::new(faces, face);
        let corners = 0..faces.corners(face).len() as u32;
        let piece = corners.map(|k| Exact.corner(faces, face, k)).collect();
        let outline = exact.outline();
        Self { faces, face, exact, piece, outline, whole: true }
    }

    fn step(&mut self, plane: PlaneId, keep_back: bool) -> judge::Verdict {
        let splitter = Exact.splitter(self.faces, plane);
        let by = model::plane(self.faces, plane);
        let values: Vec<Rational> = self.outline.iter().map(|v| by.at(&v.point)).collect();
        for (vertex, value) in self.piece.iter().zip(&values) {
            let side = Exact.side(self.faces, &splitter, self.face, vertex);
            judge::ensure(side == rational::sign(value), || format!("{vertex:?} is {side:?}"))?;
        }
        let cut = (!self.whole).then_some(&*self.piece);
        let side = Exact.classify(self.faces, &splitter, Piece { face: self.face, cut });
        let allowed = self.exact.classify((self.faces, self.face), (plane, &by), &values);
        judge::ensure(allowed.contains(&side), || format!("{side:?}, not {allowed:?}"))?;
        if side != Side::Spanning {
            return Ok(());
        }
        let (mut front, mut back) = (Vec::new(), Vec::new());
        split(&Exact, self.faces, &splitter, self.face, &self.piece, &mut front, &mut back);
        let parts = [false, true].map(|behind| model::clip(&self.outline, &values, plane, behind));
        self.check_part(&front, &parts[0])?;
        self.check_part(&back, &parts[1])?;
        self.check_area(&parts)?;
        let [exact_front, exact_back] = parts;
        (self.piece, self.outline) =
            if keep_back { (back, exact_back) } else { (front, exact_front) };
        self.whole = false;
        Ok(())
    }

    fn check_part(&self, part: &[ExactVertex], expected: &[model::Vertex]) -> judge::Verdict {
        let lines = expected.iter().map(|vertex| vertex.line);
        let proper = part.len() >= 3 && part.iter().map(Vertex::line).eq(lines);
        judge::ensure(proper, || format!("{part:?}, not {expected:?}"))?;
        for (vertex, expected) in part.iter().zip(expected) {
            let point = self.exact.resolve(self.faces, vertex.symbol());
            judge::ensure(point == expected.point, || format!("{vertex:?} is elsewhere"))?;
            let off = rational::distance_to_rounded(&point, vertex.position());
            judge::ensure(off <= 0.77, || format!("{vertex:?} is {off} off"))?;
        }
        Ok(())
    }

    fn check_area(&self, parts: &[Vec<model::Vertex>; 2]) -> judge::Verdict {
        let area = |outline: &[model::Vertex]| {
            let points: Vec<_> = outline.iter().map(|vertex| vertex.point.clone()).collect();
            rational::area(&points)
        };
        let sum = rational::sum(&area(&parts[0]), &area(&parts[1]));
        judge::ensure(sum == area(&self.outline), || "area is lost".into())
    }
}
