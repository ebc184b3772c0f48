//! The contest of own planes against brute force with the exact kernel.

use glam::DVec3;

use super::super::cost::{Candidate, Cost, work};
use super::super::sample::Sample;
use super::super::set::Set;
use super::super::tests::{Fixture, triangles};
use super::super::tuning::Tuning;
use super::{Contest, Terms};
use crate::exact::{Exact, PlaneKind, Side};
use crate::random::SplitMix64;

/// Every plane is compared with every piece.
const ALL: Tuning =
    Tuning { own_planes: usize::MAX, first_sample: usize::MAX >> 1, ..Tuning::DEFAULT };

fn best(set: &Set<'_, Exact>, tuning: &Tuning) -> Candidate {
    let (mut sample, mut contest) = (Sample::default(), Contest::default());
    sample.sketch.reset(set);
    sample.sketch.extend(set, 0..set.len());
    let terms = Terms::small(set, tuning);
    contest.begin(set, &mut sample, tuning.own_planes, &terms, tuning);
    contest.best(set, &mut sample, &terms, tuning).unwrap()
}

/// The whole face whose plane a candidate is.
fn piece(found: &Candidate) -> usize {
    let PlaneKind::Face(face) = found.plane.kind() else { panic!("{found:?}") };
    face as usize
}

fn cost(set: &Set<'_, Exact>, own: usize) -> Cost {
    let splitter = set.splitter(set.own_plane(own));
    let sides: Vec<_> = (0..set.len()).map(|piece| set.classify(&splitter, piece)).collect();
    let count = |side| sides.iter().filter(|&&other| other == side).count();
    let splits = count(Side::Spanning);
    let live = &set.pieces[own];
    let mut shares = [0, 1, 2].map(|axis| (live.max[axis] - live.min[axis]) / set.size()[axis]);
    shares.sort_by(f64::total_cmp);
    let reward = Tuning::DEFAULT.reward * set.len() as f64 * shares[1] * shares[2];
    let amount = work(count(Side::Front) + splits) + work(count(Side::Back) + splits) - reward;
    Cost { cuts: splits > 0, amount }
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
            let least = costs.iter().copied().min_by(Cost::cmp).unwrap();
            assert!((found.cost.amount - least.amount).abs() < 1e-9, "{n} of {size}: {found:?}");
            assert_eq!(found.cost.cuts, least.cuts, "{n} of {size}");
            assert!((costs[piece(&found)].amount - least.amount).abs() < 1e-9, "{n} of {size}");
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

/// Comparing few planes with few pieces finds nearly as good ones.
#[test]
fn halving_finds_a_good_plane() {
    let mut random = SplitMix64::new(2);
    for n in [60, 120, 250] {
        let fixture = Fixture::new(&triangles(&mut random, n, 0.5), 0.0);
        let set = fixture.set();
        let (found, least) = (best(&set, &Tuning::DEFAULT), best(&set, &ALL));
        let exact = cost(&set, piece(&found));
        assert!((found.cost.amount - exact.amount).abs() < 1e-9, "compared with all in the end");
        assert!(exact.amount <= 1.2 * least.cost.amount, "{n}: {exact:?}, {least:?}");
    }
}
