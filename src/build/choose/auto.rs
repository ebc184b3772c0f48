//! The default heuristic: candidates of two kinds, free planes and own ones, and one cost.

use super::cost::Cost;
use super::own::{Candidate, Terms};
use super::peel;
use super::set::Set;
use super::sketch::{LANES, Sketch};
use super::{Choice, Chooser};
use crate::exact::{Kernel, PlaneId, Side};

impl Chooser<'_> {
    /// A plane that cuts nothing, if one is found, else the best of free planes and own ones.
    pub(super) fn auto<K: Kernel>(&mut self, set: &Set<'_, K>, is_peeled: bool) -> Choice {
        self.sketch.reset(set);
        let tuning = self.tuning;
        if let Some(plane) = common_plane(set, &self.sketch) {
            return Choice::Split(plane);
        }
        let free = if set.len() < tuning.clean_below {
            self.sweep.clean(set, tuning)
        } else {
            self.sweep.best(set, tuning, self.watch)
        };
        let free = free.and_then(|free| Some((free, free.id(set)?)));
        match free {
            Some((free, plane)) if !free.cost.cuts => return Choice::Split(plane),
            _ => {}
        }
        let free = free.map(|(free, plane)| Rival { plane, cost: free.cost });
        if set.len() < tuning.small {
            self.best_of_small(set, free, is_peeled)
        } else {
            self.best_of_large(set, free)
        }
    }

    /// The best own plane of a small set, which is sketched.
    fn own_of_small<K: Kernel>(&mut self, set: &Set<'_, K>) -> Option<Candidate> {
        let tuning = self.tuning;
        self.sketch.extend(set, spread(set.len()));
        self.contest.enter(set, &self.sketch, tuning.own_planes);
        let (terms, mut rest) = (Terms::small(set, tuning), std::iter::empty());
        self.contest.begin(set, &mut self.sketch, &mut rest, &terms, tuning);
        self.contest.best(set, &mut self.sketch, &mut rest, &terms, tuning)
    }

    fn best_of_small<K: Kernel>(
        &mut self,
        set: &Set<'_, K>,
        free: Option<Rival>,
        is_peeled: bool,
    ) -> Choice {
        let tuning = self.tuning;
        let own = self.own_of_small(set);
        if let Some(own) = &own
            && own.cost.divides_evenly(set.len(), tuning.uneven)
        {
            return Choice::Split(set.own_plane(own.piece));
        }
        let mut places = self.contest.one_sided_places().peekable();
        if !is_peeled
            && places.peek().is_some()
            && let Some(peeled) = self.peeler.search(set, &self.sketch, places, tuning, self.watch)
        {
            return Choice::Peel(peeled);
        }
        best_of(set, own, free)
    }

    fn best_of_large<K: Kernel>(&mut self, set: &Set<'_, K>, free: Option<Rival>) -> Choice {
        let tuning = self.tuning;
        let terms = Terms::large(set, tuning);
        let mut order = self.begin_large(set, &terms);
        if self.contest.one_sided() >= tuning.one_sided_needed {
            self.sketch.clear();
            self.sketch.extend(set, peel::arrange(set, tuning.groups_per_box).into_iter());
            let all = 0..set.len();
            if let Some(peeled) = self.peeler.search(set, &self.sketch, all, tuning, self.watch) {
                return Choice::Peel(peeled);
            }
            // The sketch has another order now, in which the first are no sample.
            order = self.begin_large(set, &terms);
        }
        let own = self.contest.best(set, &mut self.sketch, &mut order, &terms, tuning);
        // Own planes of large sets are compared by amount alone, so the free plane is too.
        best_of(
            set,
            own,
            free.map(|free| Rival { cost: Cost { cuts: false, ..free.cost }, ..free }),
        )
    }

    /// Sketches a sample of a large set, and compares own planes with it; gives the order of the
    /// rest.
    fn begin_large<K: Kernel>(
        &mut self,
        set: &Set<'_, K>,
        terms: &Terms,
    ) -> impl Iterator<Item = usize> + use<K> {
        let mut order = spread(set.len());
        let count = self.tuning.few_own_planes;
        self.sketch.clear();
        self.sketch.extend(set, order.by_ref().take(count.next_multiple_of(LANES)));
        self.contest.enter(set, &self.sketch, count);
        self.contest.begin(set, &mut self.sketch, &mut order, terms, self.tuning);
        order
    }
}

/// A free plane with what it costs.
struct Rival {
    plane: PlaneId,
    cost: Cost,
}

/// The better of an own plane and a free one; any, if there are none.
fn best_of<K: Kernel>(set: &Set<'_, K>, own: Option<Candidate>, free: Option<Rival>) -> Choice {
    Choice::Split(match (own, free) {
        (Some(own), Some(free)) if free.cost.is_less(&own.cost) => free.plane,
        (Some(own), _) => set.own_plane(own.piece),
        (None, Some(free)) => free.plane,
        (None, None) => set.own_plane(0),
    })
}

/// The plane on which all pieces lie, if the first one's is such a plane.
fn common_plane<K: Kernel>(set: &Set<'_, K>, sketch: &Sketch) -> Option<PlaneId> {
    // The last is likely to be far from the first.
    let pieces = || (0..set.len()).rev();
    if !pieces().all(|piece| sketch.may_be_on(set, 0, piece)) {
        return None;
    }
    let plane = set.own_plane(0);
    let splitter = set.splitter(plane);
    pieces().all(|piece| set.classify(&splitter, piece) == Side::Coplanar).then_some(plane)
}

/// The numbers below `n`, so that however many of the first are taken, they are spread evenly.
fn spread(n: usize) -> impl Iterator<Item = usize> {
    let step = coprime(n);
    let mut next = 0;
    (0..n).map(move |_| {
        let here = next;
        next += step;
        next -= if next < n { 0 } else { n };
        here
    })
}

/// A number without a common divisor with `n`, near the golden section of it: its multiples are the
/// most evenly spread.
fn coprime(n: usize) -> usize {
    let section = (n as f64 * 0.618_034) as usize;
    (section.max(1)..n.max(2)).find(|&step| gcd(step, n) == 1).unwrap_or(1)
}

fn gcd(mut a: usize, mut b: usize) -> usize {
    while b > 0 {
        (a, b) = (b, a % b);
    }
    a
}

#[cfg(test)]
mod tests {
    use super::super::sketch::Sketch;
    use super::super::tests::{Fixture, grid};
    use super::{common_plane, spread};
    use crate::random::SplitMix64;

    #[test]
    fn a_common_plane_is_one_exactly_or_within_the_tolerance() {
        for (height, tolerance, expected) in
            [(0.0, 1e-12, true), (1e-9, 0.0, false), (1e-9, 1e-8, true), (1e-3, 1e-8, false)]
        {
            let mut random = SplitMix64::new(1);
            let polygons = grid(4, |_| height * random.point(-1.0, 1.0).x);
            let fixture = Fixture::new(&polygons, tolerance);
            let (set, mut sketch) = (fixture.set(), Sketch::default());
            sketch.reset(&set);
            let name = format!("{height} within {tolerance}");
            assert_eq!(common_plane(&set, &sketch).is_some(), expected, "{name}");
        }
    }

    #[test]
    fn every_number_comes_once_and_the_first_are_spread_evenly() {
        for n in (0..100).chain([255, 256, 1000, 4096]) {
            let mut numbers: Vec<usize> = spread(n).collect();
            let first = numbers.len().min(16);
            let mut sample = numbers[..first].to_vec();
            sample.sort_unstable();
            for pair in sample.windows(2) {
                assert!(pair[1] - pair[0] <= 4 * n / first + 2, "{n}: {sample:?}");
            }
            numbers.sort_unstable();
            assert!(numbers.iter().copied().eq(0..n));
        }
    }
}
