//! The exact kernel against exact rationals, on scenes that are hard to decide.

use binspace::internals::{Exact, Faces, Kernel, Piece, PlaneId, Side, Vertex, split};
use num_traits::Signed;
use proptest::prelude::*;
use proptest::sample::Index;
use proptest::strategy::ValueTree;
use proptest::test_runner::{TestCaseError, TestRunner};
use testkit::effort::{cases, times};
use testkit::enough;
use testkit::hard::{self, HardScene};
use testkit::model::{self, Face};
use testkit::rational::{self, Point, Rational};

type ExactVertex = <Exact as Kernel>::Vertex;
type Outcome<T> = Result<T, TestCaseError>;

/// What a run of tests went through.
#[derive(Clone, Copy, Debug, Default)]
struct Tally {
    /// Vertices held against planes.
    signs: usize,
    /// Those that the filter left to the integers.
    undecided: usize,
    /// Those exactly on the plane.
    on_plane: usize,
    /// Pieces held against planes, and those cut.
    pieces: usize,
    cuts: usize,
    /// Vertices made by two cuts.
    inside: usize,
    /// Pieces of faces that are planar by definition only.
    moved: usize,
    /// Pieces for which the tolerance alone decided.
    tolerated: usize,
    /// Pieces as far from a plane as the tolerance to within its rounding.
    ambiguous: usize,
    /// Those that a rounded distance alone would put on the wrong side.
    wrong: usize,
    /// The largest error of a coordinate, in lattice units.
    worst_position: f64,
}

/// One face, cut by one plane after the other; one of the two parts is followed.
struct Walk<'a> {
    faces: &'a Faces,
    face: u32,
    exact: Face,
    piece: Vec<ExactVertex>,
    outline: Vec<model::Vertex>,
    whole: bool,
    tally: &'a mut Tally,
}

impl<'a> Walk<'a> {
    fn new(faces: &'a Faces, face: u32, tally: &'a mut Tally) -> Self {
        let exact = Face::new(faces, face);
        let corners = 0..faces.corners(face).len() as u32;
        let piece = corners.map(|k| Exact.corner(faces, face, k)).collect();
        let outline = exact.outline();
        Self { faces, face, exact, piece, outline, whole: true, tally }
    }

    fn step(&mut self, plane: PlaneId, keep_back: bool) -> Outcome<()> {
        let splitter = Exact.splitter(self.faces, plane);
        let by = model::plane(self.faces, plane);
        let values: Vec<Rational> = self.outline.iter().map(|v| by.at(&v.point)).collect();
        for (vertex, value) in self.piece.clone().iter().zip(&values) {
            let side = Exact.side(self.faces, &splitter, self.face, vertex);
            prop_assert_eq!(side, rational::sign(value), "{:?} at {:?}", vertex, plane);
            self.check_distance(plane, &splitter, vertex, value)?;
        }
        let cut = (!self.whole).then_some(&*self.piece);
        let side = Exact.classify(self.faces, &splitter, Piece { face: self.face, cut });
        let allowed = self.exact.classify((self.faces, self.face), (plane, &by), &values);
        prop_assert!(allowed.contains(&side), "{side:?} and not {allowed:?} of {plane:?}");
        self.tally.pieces += 1;
        self.tally.moved += usize::from(self.exact.moved);
        self.tally.ambiguous += usize::from(allowed.iter().any(|other| other != &side));
        let spans =
            values.iter().any(Signed::is_positive) && values.iter().any(Signed::is_negative);
        self.tally.tolerated += usize::from(spans && side != Side::Spanning);
        if side == Side::Spanning {
            self.cut(plane, &splitter, &values, keep_back)?;
        }
        Ok(())
    }

    fn cut(
        &mut self,
        plane: PlaneId,
        splitter: &<Exact as Kernel>::Splitter,
        values: &[Rational],
        keep_back: bool,
    ) -> Outcome<()> {
        self.tally.cuts += 1;
        let (mut front, mut back) = (Vec::new(), Vec::new());
        split(&Exact, self.faces, splitter, self.face, &self.piece, &mut front, &mut back);
        let parts = [false, true].map(|behind| model::clip(&self.outline, values, plane, behind));
        self.check_part(&front, &parts[0])?;
        self.check_part(&back, &parts[1])?;
        let areas = [&front, &back, &self.piece].map(|piece| rational::area(&self.resolve(piece)));
        prop_assert_eq!(rational::sum(&areas[0], &areas[1]), areas[2].clone());
        let [exact_front, exact_back] = parts;
        (self.piece, self.outline) =
            if keep_back { (back, exact_back) } else { (front, exact_front) };
        self.whole = false;
        Ok(())
    }

    fn resolve(&self, piece: &[ExactVertex]) -> Vec<Point> {
        piece.iter().map(|v| self.exact.resolve(self.faces, v.symbol())).collect()
    }

    fn check_part(&mut self, part: &[ExactVertex], expected: &[model::Vertex]) -> Outcome<()> {
        prop_assert!(part.len() >= 3);
        prop_assert_eq!(part.len(), expected.len());
        for ((vertex, point), expected) in part.iter().zip(self.resolve(part)).zip(expected) {
            prop_assert_eq!(vertex.line(), expected.line);
            prop_assert_eq!(&point, &expected.point, "{:?}", vertex.symbol());
            let error = rational::distance_to_rounded(&point, vertex.position());
            self.tally.worst_position = self.tally.worst_position.max(error);
            prop_assert!(error <= 0.77, "{vertex:?} is {error} off");
            let stored = Exact.store(vertex);
            let restored = Exact.restore(self.faces, self.face, &stored);
            prop_assert_eq!(restored.position(), vertex.position());
            prop_assert_eq!((restored.symbol(), restored.line()), (vertex.symbol(), vertex.line()));
            let by_two_cuts =
                matches!(vertex.symbol().kind(), binspace::internals::SymbolKind::Inside(..));
            self.tally.inside += usize::from(by_two_cuts);
        }
        Ok(())
    }

    fn check_distance(
        &mut self,
        plane: PlaneId,
        splitter: &<Exact as Kernel>::Splitter,
        vertex: &ExactVertex,
        exact: &Rational,
    ) -> Outcome<()> {
        let rounded = splitter.distance(vertex.position());
        let bound = stated_bound(self.faces, plane);
        if self.faces.tolerance() == 0.0 {
            // Without a tolerance the slack is the bound that the filter goes by.
            prop_assert!(splitter.slack() >= bound * (1.0 - 1e-12));
        }
        if rounded != 0.0 && rational::sign(&rational::exact(rounded)) != rational::sign(exact) {
            let error = rounded.abs() / bound;
            prop_assert!(error <= 1.0, "{error} of the bound for {vertex:?} at {plane:?}");
            self.tally.wrong += 1;
        }
        self.tally.signs += 1;
        self.tally.undecided += usize::from(rounded.abs() <= bound);
        self.tally.on_plane += usize::from(rational::sign(exact).is_eq());
        Ok(())
    }
}

/// The bound of a distance of the wrong sign: 9.2 επm, π the sum of the magnitudes of the products
/// that the normal is made of; for an axis 3.05 εm.
fn stated_bound(faces: &Faces, plane: PlaneId) -> f64 {
    let unit = 2f64.powi(-53) * 2f64.powi(51);
    let binspace::internals::PlaneKind::Face(face) = plane.kind() else { return 3.05 * unit };
    let [p, q, r] = faces.reference_triangle(face).map(|c| faces.corner(c));
    let product = |i: usize, j: usize| ((q[i] - p[i]) * (r[j] - p[j])).abs();
    let pairs = [(0, 1), (1, 0), (1, 2), (2, 1), (2, 0), (0, 2)];
    let size: f64 = pairs.into_iter().map(|(i, j)| product(i, j)).sum();
    9.2 * unit * size
}

/// Which face to cut, and by what: a face's plane, or perpendicular to an axis through a corner.
#[derive(Clone, Debug)]
struct Plan {
    face: Index,
    cuts: Vec<(Option<usize>, Index, bool)>,
}

fn plan() -> impl Strategy<Value = Plan> {
    let axis = prop_oneof![2 => Just(None), 1 => (0..3usize).prop_map(Some)];
    let cuts = prop::collection::vec((axis, any::<Index>(), any::<bool>()), 1..14);
    (any::<Index>(), cuts).prop_map(|(face, cuts)| Plan { face, cuts })
}

fn follow(scene: &HardScene, plan: &Plan, tally: &mut Tally) -> Outcome<()> {
    let (faces, _) = Faces::new(&scene.polygons, scene.tolerance()).expect("finite");
    if faces.is_empty() {
        return Ok(());
    }
    let mut walk = Walk::new(&faces, plan.face.index(faces.len()) as u32, tally);
    let corners = (0..faces.len() as u32).map(|face| faces.corners(face).len()).sum();
    for &(axis, index, keep_back) in &plan.cuts {
        let plane = match axis {
            None => PlaneId::face(index.index(faces.len()) as u32),
            Some(axis) => PlaneId::axis(axis, index.index(corners) as u32),
        };
        walk.step(plane, keep_back)?;
    }
    Ok(())
}

proptest! {
    #![proptest_config(cases(1500, file!()))]

    #[test]
    fn pieces_are_those_of_exact_rationals(scene in hard::scene(), plan in plan()) {
        follow(&scene, &plan, &mut Tally::default())?;
    }
}

/// Guards the generators: scenes that floats alone could decide would prove nothing.
#[test]
fn hard_scenes_reach_the_integers() {
    let mut runner = TestRunner::deterministic();
    let mut tally = Tally::default();
    let samples = (hard::scene(), plan());
    for _ in 0..times(1000) {
        let (scene, plan) = samples.new_tree(&mut runner).expect("no rejection").current();
        follow(&scene, &plan, &mut tally).expect("as in rationals");
    }
    let share = |part: usize, of: usize| part as f64 / of as f64;
    assert!(share(tally.undecided, tally.signs) > 0.2, "{tally:?}");
    assert!(share(tally.undecided - tally.on_plane, tally.signs) > 0.002, "{tally:?}");
    assert!(share(tally.wrong, tally.signs) > 0.005, "{tally:?}");
    assert!(share(tally.cuts, tally.pieces) > 0.05, "{tally:?}");
    assert!(share(tally.moved, tally.pieces) > 0.05, "{tally:?}");
    assert!(share(tally.tolerated, tally.pieces) > 0.01, "{tally:?}");
    assert!(share(tally.ambiguous, tally.pieces) < 0.01, "{tally:?}");
    enough!(tally.inside > 500; "{tally:?}");
}
