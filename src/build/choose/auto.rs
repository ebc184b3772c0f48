//! The default heuristic. One cost compares two kinds of candidates: free planes and the pieces' own planes.

use super::axis_planes::FreePlanes;
use super::cost::{Cost, Counts, PricedPlane, work};
use super::frame_planes::find_own;
use super::peel::{Peeler, arrange};
use super::set::{PackedPieces, Set};
use super::table::Table;
use super::{Choice, ChooseContext};
use crate::Error;
use crate::build::piece::{Division, Piece};
use crate::exact::{PlaneId, Side};
use crate::progress::PIECES_AT_ONCE;

/// Chooses by the default heuristic, with reused lists.
#[derive(Debug, Default)]
pub(super) struct Auto {
    pub(super) free: FreePlanes,
    sketch: PackedPieces,
    /// The sampled pieces of a large set, and their numbers.
    sampled: Vec<Piece>,
    numbers: Vec<usize>,
    /// The sides of the sampled pieces at their planes.
    table: Table,
    peeler: Peeler,
    /// The numbers of a large set's pieces, sorted for peeling.
    arranged: Vec<usize>,
}

/// The number of pieces of which the largest is tested for the common plane of all. Too small: the piece tested may be
/// too small to define the plane. Too large: time.
const LARGE_OF: usize = 16;

impl Auto {
    /// Returns the first of the following that exists: in frames, an own plane that is good enough; the plane
    /// on which all pieces lie; in a set of two pieces, the plane of a piece that does not cut the other
    /// piece; a free plane that cuts nothing; in a small set, a table; pieces that can be peeled off; the plane
    /// with the lowest cost. Writes the plane and the pieces' sides to `division`, if the sides are known.
    pub(super) fn choose(
        &mut self,
        rules: &ChooseContext<'_>,
        set: &Set<'_>,
        division: &mut Division,
    ) -> Result<Choice, Error> {
        let tuning = rules.tuning;
        if let Some(frames) = &tuning.frames
            && set.len() <= tuning.small
            && let Some(plane) = find_own(set, frames, division)
        {
            return Ok(Choice::Split(plane));
        }
        division.plane = None;
        if let Some(plane) = self.common_plane(set) {
            return Ok(Choice::Split(plane));
        }
        if set.len() == 2
            && let Some(plane) = plane_of_pair(set)
        {
            return Ok(Choice::Split(plane));
        }
        let free = self.free.find(set, rules)?;
        if let Some(free) = free
            && !free.cost.cuts
        {
            return Ok(Choice::Split(free.plane));
        }
        if Table::holds(set, tuning) {
            Ok(Choice::Table)
        } else {
            self.best_of_large(rules, set, free, division)
        }
    }

    /// Returns the plane on which all pieces lie, if a large piece defines that plane. A single piece has
    /// such a plane.
    pub(super) fn common_plane(&mut self, set: &Set<'_>) -> Option<PlaneId> {
        let sketch = &mut self.sketch;
        sketch.reset(set);
        // The planes of small pieces may miss the other pieces because of rounding.
        let size = |&piece: &usize| {
            let Piece { min, max, .. } = set.pieces[piece];
            (0..3).map(|axis| max[axis] - min[axis]).fold(0.0, f64::max)
        };
        let large = set.sample(LARGE_OF).max_by(|a, b| size(a).total_cmp(&size(b)))?;
        // The last piece is likely to be far from the first.
        let pieces = || (0..set.len()).rev();
        if !pieces().all(|piece| sketch.may_be_on(set, large, piece)) {
            return None;
        }
        let plane = set.own_plane(large);
        let prepared = set.prepare(plane);
        pieces().all(|piece| set.classify(&prepared, piece) == Side::Coplanar).then_some(plane)
    }

    /// Chooses between an axis plane and the best plane of a sample of the set's pieces. A table compares the
    /// planes of the sample by their effect on the sample; the cost of the best is then counted over the whole set.
    fn best_of_large(
        &mut self,
        rules: &ChooseContext<'_>,
        set: &Set<'_>,
        free: Option<PricedPlane>,
        division: &mut Division,
    ) -> Result<Choice, Error> {
        let ChooseContext { tuning, watch, .. } = *rules;
        watch.work(tuning.sample * tuning.sample)?;
        self.numbers.clear();
        self.numbers.extend(Table::fitting(set, set.sample(tuning.sample)));
        self.sampled.clear();
        self.sampled.extend(self.numbers.iter().map(|&piece| set.pieces[piece]));
        self.table.fill(&set.over(&self.sampled));
        let one_sided = self.table.one_sided() as f64;
        if one_sided >= tuning.one_sided_needed * self.numbers.len() as f64 {
            self.sketch.reset(set);
            arrange(set, tuning.groups_per_box, &mut self.arranged);
            watch.work(set.len())?;
            for part in self.arranged.chunks(PIECES_AT_ONCE) {
                self.sketch.extend(set, part.iter().copied());
                watch.work(part.len())?;
            }
            if let Some(peeled) = self.peeler.search(set, &self.sketch, tuning, watch) {
                return Ok(Choice::Peel(peeled));
            }
        }
        let Some(best) = self.table.cheapest(tuning) else {
            return Ok(Choice::Split(free.map_or(set.own_plane(0), |free| free.plane)));
        };
        let own = set.own_plane(self.numbers[best.piece]);
        // Work is a power of the number of pieces, so costs over the sample are costs over the set times one factor.
        let scale = work(set.len()) / work(self.numbers.len());
        let Some(free) = free else { return Ok(Choice::Split(own)) };
        if free.cost.amount < scale * (best.amount - best.reward) {
            return Ok(Choice::Split(free.plane));
        }
        watch.work(set.len())?;
        set.divide(own, usize::MAX, division);
        let cost = Cost::of(&Counts::of(division)).amount - scale * best.reward;
        Ok(Choice::Split(if free.cost.amount < cost { free.plane } else { own }))
    }
}

/// The plane of one of two pieces, if that plane does not cut the other piece. No plane is better, so no
/// search is needed.
fn plane_of_pair(set: &Set<'_>) -> Option<PlaneId> {
    [0, 1].into_iter().find_map(|own| {
        let plane = set.own_plane(own);
        (set.classify(&set.prepare(plane), 1 - own) != Side::Spanning).then_some(plane)
    })
}

#[cfg(test)]
mod tests {
    use super::super::tests::{Fixture, grid, triangles};
    use super::{Auto, Choice, ChooseContext, Cost, Counts, Division, FreePlanes, plane_of_pair};
    use crate::build::BuildOptions;
    use crate::build::choose::tuning::Tuning;
    use crate::exact::{PlaneKind, Side};
    use crate::progress::Watch;
    use crate::random::SplitMix64;

    #[test]
    fn two_pieces_are_divided_by_the_plane_of_one_unless_both_planes_cut() {
        let mut random = SplitMix64::new(9);
        let mut found = [0; 3];
        for _ in 0..300 {
            let fixture = Fixture::new(&triangles(&mut random, 2, 1.0), 0.0);
            let set = fixture.set();
            let is_whole = |own: usize| {
                let prepared = set.prepare(set.own_plane(own));
                set.classify(&prepared, 1 - own) != Side::Spanning
            };
            let expected = [0, 1].into_iter().find(|&own| is_whole(own));
            assert_eq!(plane_of_pair(&set), expected.map(|own| set.own_plane(own)));
            found[expected.unwrap_or(2)] += 1;
        }
        assert!(found.iter().all(|&count| count > 30), "{found:?}");
    }

    /// Without a reward for planes of pieces that are cut often. The plane of a piece looks better in the sample than it
    /// is, if it is the best of many.
    #[test]
    fn the_plane_of_a_large_set_leaves_no_more_work_than_an_axis_plane() {
        let (options, watch) = (BuildOptions::DEFAULT, Watch::default());
        let careless = Tuning { risk: 0.0, ..Tuning::DEFAULT };
        let rules = ChooseContext::new(&options, &careless, &watch);
        let (mut random, mut found) = (SplitMix64::new(7), [0; 2]);
        for round in 0..40 {
            let size = [0.05, 0.3, 1.0, 4.0][round % 4];
            let fixture = Fixture::new(&triangles(&mut random, 300 + 20 * round, size), 0.0);
            let set = fixture.set();
            let free = FreePlanes::default().find(&set, &rules).unwrap().expect("an axis plane");
            let mut division = Division::default();
            let choice = Auto::default().choose(&rules, &set, &mut division).unwrap();
            let Choice::Split(plane) = choice else { panic!("{choice:?}") };
            if let PlaneKind::Face(_) = plane.kind() {
                assert!(division.plane.is_some_and(|divided| divided.id() == plane));
                assert!(Cost::of(&Counts::of(&division)).amount <= free.cost.amount, "{round}");
            } else {
                assert_eq!(plane, free.plane);
            }
            found[usize::from(plane == free.plane)] += 1;
        }
        assert!(found.iter().all(|&count| count >= 5), "{found:?}");
    }

    #[test]
    fn a_common_plane_is_one_exactly_or_within_the_tolerance() {
        for (height, tolerance, expected) in
            [(0.0, 1e-12, true), (1e-9, 0.0, false), (1e-9, 1e-8, true), (1e-3, 1e-8, false)]
        {
            let mut random = SplitMix64::new(1);
            let polygons = grid(4, |_| height * random.point(-1.0, 1.0).x);
            let fixture = Fixture::new(&polygons, tolerance);
            let plane = Auto::default().common_plane(&fixture.set());
            assert_eq!(plane.is_some(), expected, "{height} within {tolerance}");
        }
    }

    /// The odd piece is so near the plane that single precision cannot decide. This piece is noticed at every
    /// place in the set.
    #[test]
    fn one_piece_beside_the_plane_of_all_others_is_noticed() {
        let flat = grid(4, |_| 0.0);
        for odd in 0..flat.len() {
            let mut polygons = flat.clone();
            polygons[odd] = polygons[odd].map(|corner| corner + 1e-9);
            let fixture = Fixture::new(&polygons, 1e-12);
            assert_eq!(Auto::default().common_plane(&fixture.set()), None, "{odd}");
        }
        let fixture = Fixture::new(&flat, 1e-12);
        assert!(Auto::default().common_plane(&fixture.set()).is_some());
    }
}
