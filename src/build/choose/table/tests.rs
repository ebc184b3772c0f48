//! Tables against classification.

use glam::DVec3;

use super::super::cost::{Cost, Counts};
use super::super::set::Set;
use super::super::tests::{Fixture, grid, triangles};
use super::{Chosen, Divided, Mask, Sides, Table};
use crate::build::BuildOptions;
use crate::build::choose::ChooseContext;
use crate::build::choose::tuning::Tuning;
use crate::build::piece::{Division, Piece, Splitter};
use crate::exact::{PlaneId, Side};
use crate::progress::Watch;
use crate::random::SplitMix64;

/// Sets of every kind: apart, crossing, in groups, connected, and so flat that only integers decide.
fn fixtures() -> Vec<Fixture> {
    let mut random = SplitMix64::new(1);
    let mut fixtures = vec![];
    for tolerance in [0.0, 1e-9, 1e-2] {
        for (count, size) in [(2, 1.0), (3, 2.0), (17, 0.5), (64, 0.3), (65, 0.02), (256, 0.05)] {
            fixtures.push(Fixture::new(&triangles(&mut random, count, size), tolerance));
        }
        // Two groups apart, in each of which all planes cut.
        let mut groups = triangles(&mut random, 40, 2.0);
        groups
            .iter_mut()
            .flatten()
            .zip(0..)
            .for_each(|(p, corner)| p.x += f64::from(corner % 6 / 3) * 9.0);
        fixtures.push(Fixture::new(&groups, tolerance));
        for height in [1e-1, 1e-8, 1e-13] {
            let rough = grid(8, |_| height * random.point(-1.0, 1.0).x);
            fixtures.push(Fixture::new(&rough, tolerance));
        }
    }
    fixtures
}

/// The whole sets, and the halves of sets that were cut.
fn for_each_set(mut see: impl FnMut(&Fixture)) {
    for mut fixture in fixtures() {
        see(&fixture);
        for (axis, side) in [(0, Side::Front), (1, Side::Back), (2, Side::Front)] {
            fixture.keep(PlaneId::axis(axis, 0), side);
            if fixture.pieces.is_empty() {
                break;
            }
            see(&fixture);
        }
    }
}

fn choose(table: &mut Table, set: &Set<'_>, part: &Mask, tuning: &Tuning) -> Chosen {
    let (options, watch) = (BuildOptions::DEFAULT, Watch::default());
    table.choose(&ChooseContext::new(&options, tuning, &watch), set, part).unwrap()
}

/// Whether a plane at the end of a set does not count as dividing it, unless pieces lie on the plane.
fn all_on_one_side(table: &mut Table, set: &Set<'_>, part: &Mask, tuning: &Tuning) -> bool {
    let (options, watch) = (BuildOptions::DEFAULT, Watch::default());
    let rules = ChooseContext::new(&options, tuning, &watch);
    let starts = || set.pieces.iter().filter(|piece| piece.min_is_corner(0));
    let Some(first) = starts().min_by(|a, b| a.min[0].total_cmp(&b.min[0])) else { return true };
    if first.min[0] > set.min[0] {
        return true;
    }
    let corner = first.corner_at(set.faces, 0, first.min[0]).expect("a corner");
    let divided = table.divide(&rules, set, part, PlaneId::axis(0, corner)).unwrap();
    divided.is_none_or(|divided| !divided.sides.on.is_empty())
}

/// Asserts that all sides of a part are those of classification. Returns how often each side was found.
fn assert_sides(table: &Table, set: &Set<'_>, part: &Mask) -> [usize; 4] {
    let mut found = [0; 4];
    for row in part.iter() {
        let Sides { front, back, on } = table.sides(row, part);
        assert_eq!(front | back | on, *part);
        for piece in part.iter() {
            let expected = table.pieces[piece].side(set.faces, table.plane(row), set.arena);
            let side = match (front.contains(piece), back.contains(piece)) {
                (true, true) => Side::Spanning,
                (true, false) => Side::Front,
                (false, true) => Side::Back,
                (false, false) => Side::Coplanar,
            };
            assert_eq!(side, expected, "{piece} at {row} of {}", set.len());
            found[side as usize] += 1;
            let is_cut = table.rows[piece].cut_by.contains(row);
            assert_eq!(is_cut, side == Side::Spanning, "{piece} at {row}");
        }
    }
    found
}

#[test]
fn a_table_has_the_sides_that_classification_finds() {
    let (mut table, mut found) = (Table::default(), [0; 4]);
    for_each_set(|fixture| {
        let set = fixture.set();
        let part = table.fill(&set);
        assert_eq!(part.count(), set.len());
        let mut faces: Vec<u32> = table.pieces.iter().map(|piece| piece.face).collect();
        faces.sort_unstable();
        assert!(faces.iter().eq(set.pieces.iter().map(|piece| &piece.face)));
        let sides = assert_sides(&table, &set, &part);
        (0..4).for_each(|side| found[side] += sides[side]);
    });
    assert!(found.iter().all(|&count| count > 10_000), "{found:?}");
}

/// Without a weight of risk, the cost of a plane is the work left on both sides.
#[test]
fn the_cheapest_plane_leaves_the_least_work() {
    let (mut table, mut one_sided, mut compared) = (Table::default(), 0, 0);
    for_each_set(|fixture| {
        let set = fixture.set();
        table.fill(&set);
        let counts = |own: usize| {
            let mut division = Division::default();
            set.divide(set.own_plane(own), usize::MAX, &mut division);
            Counts::of(&division)
        };
        let counts: Vec<_> = (0..set.len()).map(counts).collect();
        let is_one_sided = |c: &&Counts| c.splits == 0 && c.front.min(c.back) == 0;
        let expected = counts.iter().filter(is_one_sided).count();
        assert_eq!(table.one_sided(), expected);
        one_sided += expected;
        let amounts = counts.iter().map(|counts| Cost::of(counts).amount);
        let careless = Tuning { risk: 0.0, ..Tuning::DEFAULT };
        let best = table.cheapest(&careless).unwrap();
        assert_eq!((best.amount, best.reward), (amounts.fold(f64::INFINITY, f64::min), 0.0));
        assert_eq!(best.amount, Cost::of(&counts[best.piece]).amount);
        let best = table.cheapest(&Tuning::DEFAULT).unwrap();
        assert_eq!(best.amount, Cost::of(&counts[best.piece]).amount);
        compared += usize::from(best.reward > 0.0);
    });
    assert!(one_sided > 500 && compared > 40, "{one_sided} {compared}");
    table.fill(&Set::new(&Fixture::new::<3>(&[], 0.0).faces, &[], &[]));
    assert!(table.cheapest(&Tuning::DEFAULT).is_none() && table.one_sided() == 0);
}

/// Divides sets as the builder does, by any planes, down to single pieces.
#[test]
fn after_every_cut_the_table_has_the_sides_of_the_parts() {
    let (mut random, mut splitter) = (SplitMix64::new(2), Splitter::default());
    let (mut table, mut cuts, mut parts, mut of_axes) = (Table::default(), 0, 0, 0);
    for_each_set(|fixture| {
        let mut arena = fixture.arena.clone();
        let whole = Set::new(&fixture.faces, &fixture.pieces, &arena);
        if whole.len() > 100 {
            return;
        }
        let mut stack = vec![(table.fill(&whole), vec![])];
        while let Some((part, cut)) = stack.pop() {
            let set = Set::new(&fixture.faces, &[], &arena);
            for (place, piece, before) in cut {
                table.replace(&set, (place, piece), before, &part);
            }
            parts += 1;
            assert_sides(&table, &set, &part);
            let row = part.iter().nth(random.next() as usize % part.count()).unwrap();
            let mut divided = table.divided(row, &part);
            if random.next().is_multiple_of(2) {
                divided = match choose(&mut table, &set, &part, &Tuning::DEFAULT) {
                    Chosen::Row(row) => table.divided(row, &part),
                    Chosen::Axis(divided) => {
                        of_axes += 1;
                        divided
                    }
                };
            }
            let Divided { plane, sides: Sides { front, back, .. } } = divided;
            let mut of_front: Vec<(usize, Piece, _)> = vec![];
            let mut of_back = vec![];
            for place in (front & back).iter() {
                let piece = table.pieces[place];
                let [a, b] = splitter.cut(&fixture.faces, &plane, &piece, &mut arena).unwrap();
                let before = table.cut_by(place, &part);
                of_front.push((place, a, before));
                of_back.push((place, b, before));
                cuts += 1;
            }
            for (side, cut) in [(back, of_back), (front, of_front)] {
                if side.count() > 1 {
                    stack.push((side, cut));
                }
            }
        }
    });
    assert!(cuts > 1000 && parts > 1500 && of_axes > 5, "{cuts} {parts} {of_axes}");
}

/// Without rewards and with no look at the next planes, no plane costs less than the one that is chosen, if it cuts
/// as little. An axis plane is chosen only if every row cuts.
#[test]
fn the_best_plane_costs_least() {
    let tuning = Tuning { risk: 0.0, pairs: 1, ..Tuning::DEFAULT };
    let mut table = Table::default();
    let (mut clean, mut cutting, mut of_axes) = (0, 0, 0);
    for_each_set(|fixture| {
        let set = fixture.set();
        let part = table.fill(&set);
        assert!(all_on_one_side(&mut table, &set, &part, &tuning));
        let cost = |sides: Sides| Cost::of(&sides.counts());
        let least = part.iter().map(|row| cost(table.sides(row, &part))).min_by(Cost::cmp).unwrap();
        let chosen = choose(&mut table, &set, &part, &tuning);
        let (options, watch) = (BuildOptions::DEFAULT, Watch::default());
        let rules = ChooseContext::new(&options, &tuning, &watch);
        let axis = match table.axis_plane(&rules, &set, &part).unwrap() {
            Some(axis) => table.divide(&rules, &set, &part, axis.plane).unwrap(),
            None => None,
        };
        match chosen {
            Chosen::Row(row) => {
                assert_eq!(cost(table.sides(row, &part)), least);
                let worse = |axis: Divided| !cost(axis.sides).is_less(&least);
                assert!(!least.cuts || axis.is_none_or(worse));
                let rows = table.rows_of_low_cost(4);
                assert_eq!(rows.is_empty(), !least.cuts);
                assert!(rows.iter().all(|&row| part.contains(row)));
                *(if least.cuts { &mut cutting } else { &mut clean }) += 1;
            }
            Chosen::Axis(Divided { plane, sides }) => {
                assert_eq!(axis.map(|axis| axis.plane.id()), Some(plane.id()));
                for piece in part.iter() {
                    let expected = table.pieces[piece].side(set.faces, &plane, set.arena);
                    let found = [sides.front, sides.back].map(|side| side.contains(piece));
                    let reaches = |side| expected == side || expected == Side::Spanning;
                    assert_eq!(found, [Side::Front, Side::Back].map(reaches), "{piece}");
                }
                assert!(least.cuts && cost(sides).is_less(&least));
                of_axes += 1;
            }
        }
    });
    assert!(clean > 35 && cutting > 5 && of_axes > 4, "{clean} {cutting} {of_axes}");
}

/// A wall that every other plane cuts is used before its cheaper neighbours.
#[test]
fn a_piece_that_many_planes_cut_is_used_early() {
    let mut random = SplitMix64::new(3);
    let mut polygons = triangles(&mut random, 40, 0.7);
    polygons.push([DVec3::new(-3.0, 0.01, -3.0), DVec3::new(3.0, 0.02, -3.0), DVec3::Z * 3.0]);
    let (fixture, mut table) = (Fixture::new(&polygons, 0.0), Table::default());
    let wall = |risk: f64| {
        let tuning = Tuning { risk, pairs: 1, ..Tuning::DEFAULT };
        let part = table.fill(&fixture.set());
        match choose(&mut table, &fixture.set(), &part, &tuning) {
            Chosen::Row(row) => table.pieces[row].face == 40,
            Chosen::Axis(..) => false,
        }
    };
    assert_eq!([0.0, 4.0].map(wall), [false, true]);
}

/// A square on the axis plane between two groups, and another square that is coplanar with the first: its distance from
/// the axis plane is more than the tolerance, but less than twice the tolerance.
#[test]
fn a_free_plane_does_not_separate_coplanar_pieces() {
    const TOLERANCE: f64 = 0.04;
    let square = |x: f64, size: f64, middle: [f64; 2]| {
        [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]]
            .map(|[a, b]| DVec3::new(x, middle[0] + size * a, middle[1] + size * b))
    };
    for (second, overlaps, is_free) in
        [(1.8, false, true), (1.8, true, false), (0.8, true, true), (3.6, true, true)]
    {
        let large = square(0.9 * TOLERANCE, 1.0, [0.0; 2]);
        let second = square(second * TOLERANCE, 0.5, if overlaps { [0.25; 2] } else { [3.0; 2] });
        let group = |x: f64| square(x, 1.5, [0.5; 2]);
        let all = [group(-8.0), group(-6.0), group(-4.0), group(0.0), large, second];
        let fixture = Fixture::new(&all, TOLERANCE);
        let set = fixture.set();
        let (mut table, tuning) = (Table::default(), Tuning::DEFAULT);
        let part = table.fill(&set);
        let (options, watch) = (BuildOptions::DEFAULT, Watch::default());
        let rules = ChooseContext::new(&options, &tuning, &watch);
        let gap = table.axis_plane(&rules, &set, &part).unwrap().expect("a gap");
        let gap = table.divide(&rules, &set, &part, gap.plane).unwrap();
        assert_eq!(gap.is_some(), is_free, "{overlaps}");
    }
}

#[test]
fn masks_are_sets_of_places() {
    let mut random = SplitMix64::new(4);
    for n in [0, 1, 63, 64, 65, 128, 255, 256] {
        let first = Mask::first(n);
        assert!(first.iter().eq(0..n) && first.count() == n && first.is_empty() == (n == 0));
        let mut some = Mask::default();
        let chosen: Vec<usize> = (0..n).filter(|_| random.next().is_multiple_of(5)).collect();
        chosen.iter().for_each(|&place| some.set(place, true));
        assert!(some.iter().eq(chosen.iter().copied()));
        assert_eq!((first & !some).count(), n - chosen.len());
        let words = some.words();
        assert!(chosen.iter().all(|place| words.contains(&(place / 64))), "{words:?}");
    }
}
