//! The comparison of own planes against brute force with exact decisions.

use glam::DVec3;

use super::super::cost::work;
use super::super::tests::{Fixture, triangles};
use super::{Candidates, CostModel, Sample};
use crate::build::choose::set::Set;
use crate::build::choose::tuning::Tuning;
use crate::exact::{PlaneId, PlaneKind, Side};
use crate::random::SplitMix64;

/// Every plane is compared with every piece.
const ALL: Tuning =
    Tuning { own_planes: usize::MAX, first_sample: usize::MAX >> 1, ..Tuning::DEFAULT };

fn best(set: &Set<'_>, tuning: &Tuning) -> (PlaneId, f64) {
    let (mut sample, mut candidates) = (Sample::default(), Candidates::default());
    sample.sketch.reset(set);
    sample.sketch.extend(set, 0..set.len());
    let terms = CostModel::of(set, tuning);
    candidates.begin(set, &mut sample, tuning.own_planes, &terms, tuning);
    candidates.best(set, &mut sample, &terms, tuning, f64::INFINITY).unwrap()
}

/// The face whose plane was found.
fn piece(found: &(PlaneId, f64)) -> usize {
    let PlaneKind::Face(face) = found.0.kind() else { panic!("{found:?}") };
    face as usize
}

fn cost(set: &Set<'_>, own: usize) -> f64 {
    let prepared = set.prepare(set.own_plane(own));
    let sides: Vec<_> = (0..set.len()).map(|piece| set.classify(&prepared, piece)).collect();
    let count = |side| sides.iter().filter(|&&other| other == side).count();
    let splits = count(Side::Spanning);
    let piece = &set.pieces[own];
    let mut shares = [0, 1, 2].map(|axis| (piece.max[axis] - piece.min[axis]) / set.size()[axis]);
    shares.sort_by(f64::total_cmp);
    let reward = Tuning::DEFAULT.reward * set.len() as f64 * shares[1] * shares[2];
    work(count(Side::Front) + splits) + work(count(Side::Back) + splits) - reward
}

#[test]
fn the_least_cost_wins_where_all_are_compared_with_all() {
    let mut random = SplitMix64::new(1);
    for n in [2, 3, 5, 16, 17, 60] {
        for size in [0.1, 0.5, 2.0] {
            let fixture = Fixture::new(&triangles(&mut random, n, size), 0.0);
            let set = fixture.set();
            let found = best(&set, &ALL);
            let costs: Vec<_> = (0..n).map(|own| cost(&set, own)).collect();
            let least = costs.iter().copied().fold(f64::INFINITY, f64::min);
            assert!((found.1 - least).abs() < 1e-9, "{n} of {size}: {found:?}");
            assert!((costs[piece(&found)] - least).abs() < 1e-9, "{n} of {size}");
        }
    }
}

#[test]
fn of_equals_the_earliest_wins() {
    let square =
        |z: f64| [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]].map(|[x, y]| DVec3::new(x, y, z));
    let fixture = Fixture::new(&[0.0, 1.0, 3.0, 2.0].map(square), 0.0);
    // The second and the last are in the middle.
    assert_eq!(piece(&best(&fixture.set(), &ALL)), 1);
    let fixture = Fixture::new(&[0.0, 1.0].map(square), 0.0);
    assert_eq!(piece(&best(&fixture.set(), &ALL)), 0);
}

/// Comparing few planes with few pieces finds nearly as good planes.
#[test]
fn halving_finds_a_good_plane() {
    let mut random = SplitMix64::new(2);
    for n in [60, 120, 250] {
        let fixture = Fixture::new(&triangles(&mut random, n, 0.5), 0.0);
        let set = fixture.set();
        let (found, least) = (best(&set, &Tuning::DEFAULT), best(&set, &ALL));
        let exact = cost(&set, piece(&found));
        assert!((found.1 - exact).abs() < 1e-9, "compared with all in the end");
        assert!(exact <= 1.2 * least.1, "{n}: {exact:?}, {least:?}");
    }
}

/// Candidates that are all compared with the first sample.
fn begun(set: &Set<'_>, tuning: &Tuning) -> Candidates {
    let (mut sample, mut candidates) = (Sample::default(), Candidates::default());
    sample.sketch.reset(set);
    sample.sketch.extend(set, 0..set.len());
    let terms = CostModel::of(set, tuning);
    candidates.begin(set, &mut sample, tuning.own_planes, &terms, tuning);
    candidates
}

#[test]
fn halving_keeps_the_best_in_their_order() {
    let mut random = SplitMix64::new(3);
    for n in [5, 60, 121] {
        let fixture = Fixture::new(&triangles(&mut random, n, 0.5), 0.0);
        let mut candidates = begun(&fixture.set(), &Tuning::DEFAULT);
        let field = candidates.field.clone();
        let mut best: Vec<usize> = (0..field.len()).collect();
        best.sort_by(|&a, &b| field[a].cost.total_cmp(&field[b].cost));
        best.truncate(field.len().div_ceil(4));
        best.sort_unstable();
        candidates.halve(4);
        let expected = best.into_iter().map(|place| field[place].piece);
        assert!(candidates.field.iter().map(|c| c.piece).eq(expected), "{n}");
    }
}

#[test]
fn one_sided_are_those_with_all_others_on_one_side() {
    let mut random = SplitMix64::new(5);
    let mut found = 0;
    for n in [2, 5, 16] {
        for size in [0.1, 0.5] {
            let fixture = Fixture::new(&triangles(&mut random, n, size), 0.0);
            let set = fixture.set();
            let is_one_sided = |&own: &usize| {
                let prepared = set.prepare(set.own_plane(own));
                let sides: Vec<_> = (0..n).map(|piece| set.classify(&prepared, piece)).collect();
                [Side::Front, Side::Back]
                    .iter()
                    .any(|side| sides.iter().all(|other| [*side, Side::Coplanar].contains(other)))
            };
            let expected: Vec<_> = (0..n).filter(is_one_sided).collect();
            let candidates = begun(&set, &ALL);
            assert_eq!(candidates.one_sided(), expected, "{n} of {size}");
            found += expected.len();
        }
    }
    assert!(found > 10, "{found}");
}
