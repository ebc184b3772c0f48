//! The search for free planes against brute force.

use glam::DVec3;

use super::super::cost::{Cost, PricedPlane, work};
use super::super::tests::Fixture;
use super::FreePlanes;
use crate::build::choose::set::Set;
use crate::build::choose::tuning::Tuning;
use crate::build::piece::Piece;
use crate::exact::{Faces, PlaneId, PlaneKind, Side};
use crate::progress::Watch;
use crate::random::SplitMix64;

/// The lowest cost of all planes through a corner and perpendicular to an axis, found by testing every piece.
fn least(pieces: &[Piece], axis: usize, tolerance: f64) -> Cost {
    let coordinates = pieces.iter().flat_map(|piece| [piece.min[axis], piece.max[axis]]);
    coordinates.map(|c| at(pieces, axis, c, tolerance)).min_by(Cost::cmp).unwrap_or(Cost::MOST)
}

/// The cost of a plane; infinite if it leaves all pieces on one side.
fn at(pieces: &[Piece], axis: usize, c: f64, tolerance: f64) -> Cost {
    let (mut in_front, mut behind, mut splits) = (0, 0, 0);
    for piece in pieces {
        let begun = piece.min[axis] + tolerance < c;
        let ended = piece.max[axis] - tolerance <= c;
        let flat = piece.max[axis] - piece.min[axis] <= 2.0 * tolerance;
        in_front += usize::from(!ended);
        behind += usize::from(begun);
        splits += usize::from(begun && !ended && !flat);
    }
    let divides = in_front < pieces.len() && behind < pieces.len();
    let cost = Cost { cuts: splits > 0, amount: work(in_front) + work(behind) };
    if divides { cost } else { Cost::MOST }
}

/// Asserts that the plane found is nearly the best, and that its cost is right.
fn assert_good(name: &str, polygons: &[[DVec3; 3]], tolerance: f64) {
    let (faces, _) = Faces::new(polygons, Some(tolerance)).unwrap();
    let pieces: Vec<Piece> =
        (0..faces.len() as u32).map(|face| Piece::whole(&faces, face)).collect();
    let watch = Watch::default();
    let set = Set::new(&faces, &pieces, &[]);
    let found = FreePlanes::default().best(&set, &watch).unwrap();
    let costs = [0, 1, 2].map(|axis| least(&pieces, axis, faces.tolerance()));
    let best = costs.into_iter().min_by(Cost::cmp).unwrap_or(Cost::MOST);
    let clean = FreePlanes::default().clean(&set);
    assert_eq!(clean.is_some(), !best.cuts, "{name}: {clean:?}, {best:?}");
    let cost_of = |found: &PricedPlane| {
        let PlaneKind::Axis(axis, corner) = found.plane.kind() else { panic!("{found:?}") };
        at(&pieces, axis, faces.corner(corner)[axis], faces.tolerance())
    };
    assert!(clean.is_none_or(|clean| !cost_of(&clean).cuts), "{name}: {clean:?} cuts");
    assert!(found.is_none_or(|found| cost_of(&found) == found.cost), "{name}: {found:?}");
    // By bins, the found plane may cost slightly more than the best plane. Sets small enough for `clean` are
    // not checked.
    let found = found.map_or(Cost::MOST, |plane| plane.cost);
    let is_good = found == best || found.amount <= 1.02 * best.amount;
    assert!(is_good || pieces.len() < Tuning::DEFAULT.clean_below, "{name}: {found:?}, {best:?}");
}

fn triangles(random: &mut SplitMix64, count: usize, size: f64, within: f64) -> Vec<[DVec3; 3]> {
    let mut triangle = || {
        let at = random.point(-within, within);
        [(); 3].map(|()| at + random.point(-size, size))
    };
    (0..count).map(|_| triangle()).collect()
}

#[test]
fn a_good_plane_is_found_whatever_the_size() {
    let mut random = SplitMix64::new(1);
    for count in [1, 2, 3, 5, 8, 13, 40, 100, 300] {
        for size in [0.003, 0.05, 1.0] {
            let polygons = triangles(&mut random, count, size, 1.0);
            assert_good(&format!("{count} of {size}"), &polygons, 0.0);
            assert_good(&format!("{count} of {size}, within 1e-6"), &polygons, 1e-6);
        }
    }
}

#[test]
fn on_a_lattice_planes_touch_many() {
    let mut random = SplitMix64::new(2);
    for count in [10, 60, 250] {
        let polygons = triangles(&mut random, count, 2.0, 6.0);
        let rounded: Vec<_> = polygons.iter().map(|corners| corners.map(DVec3::round)).collect();
        assert_good(&format!("{count}"), &rounded, 0.0);
    }
}

/// Planes between rows of vertices cut a row of pieces; planes through the vertices cut fewer pieces, or
/// none.
#[test]
fn planes_go_through_rows_of_vertices() {
    let rows = 9;
    for shift in [0.0, 0.37] {
        let at = |i: usize, k: usize| DVec3::new(i as f64, k as f64 + shift * i as f64, 0.0);
        let cells = (0..rows * rows).map(|cell| (cell % rows, cell / rows));
        let polygons: Vec<_> = cells
            .flat_map(|(i, k)| {
                let [a, b, c, d] = [at(i, k), at(i + 1, k), at(i + 1, k + 1), at(i, k + 1)];
                [[a, b, c], [a, c, d]]
            })
            .collect();
        let fixture = Fixture::new(&polygons, 0.0);
        let found = FreePlanes::default().best(&fixture.set(), &Watch::default()).unwrap().unwrap();
        assert!(!found.cost.cuts && found.cost.amount < 1.01 * 2.0 * work(81), "{found:?}");
    }
}

/// Most pieces are in two small parts of the whole, so that few bins contain nearly all pieces.
#[test]
fn crowds_are_searched_like_others() {
    const CROWD: usize = 2000;
    let mut random = SplitMix64::new(3);
    let mut polygons = triangles(&mut random, CROWD, 1e-6, 1e-3);
    let apart = DVec3::new(0.4, 0.3, 0.7);
    polygons.extend(
        triangles(&mut random, CROWD, 2e-4, 3e-4).iter().map(|corners| corners.map(|p| p + apart)),
    );
    polygons.extend(triangles(&mut random, 20, 0.5, 1.0));
    assert_good("crowds", &polygons, 0.0);
    polygons.truncate(CROWD);
    polygons.push([DVec3::NEG_ONE, DVec3::X, DVec3::ONE]);
    assert_good("a crowd", &polygons, 0.0);
}

/// A triangle with this extent along an axis, and from −1 to 1 along the other axes.
fn reaching([begin, end]: [f64; 2], axis: usize) -> [DVec3; 3] {
    let middle = 0.5 * (begin + end);
    [[begin, -1.0, -1.0], [middle, 1.0, -1.0], [end, 1.0, 1.0]].map(|mut p| {
        p.rotate_right(axis);
        DVec3::from_array(p)
    })
}

fn axis_of(found: &PricedPlane) -> usize {
    let PlaneKind::Axis(axis, _) = found.plane.kind() else { panic!("{found:?}") };
    axis
}

/// Two groups that overlap by no more than the tolerance.
#[test]
fn groups_that_overlap_within_the_tolerance_are_separated_without_a_cut() {
    const TOLERANCE: f64 = 1e-3;
    for axis in 0..3 {
        let of = |ends: [f64; 2], begins: [f64; 2]| {
            let low = ends.map(|end| reaching([-1.0, end], axis));
            let high = begins.map(|begin| reaching([begin, 1.0], axis));
            [low, high].concat()
        };
        let even = Cost { cuts: false, amount: 2.0 * work(2) };
        // In total by less than the tolerance.
        let fixture = Fixture::new(&of([4e-4, 4e-4], [-4e-4, -4e-4]), TOLERANCE);
        let clean = FreePlanes::default().clean(&fixture.set());
        assert_eq!(clean.map(|clean| (axis_of(&clean), clean.cost)), Some((axis, even)));
        // On each side of a plane by less than the tolerance.
        let fixture = Fixture::new(&of([7e-4, 0.0], [-7e-4, 0.0]), TOLERANCE);
        let found = FreePlanes::default().best(&fixture.set(), &Watch::default()).unwrap();
        assert_eq!(found.map(|found| (axis_of(&found), found.cost)), Some((axis, even)));
    }
}

/// The pieces on the other side begin at cuts, so no corner at their beginnings names a plane.
#[test]
fn a_plane_is_found_where_pieces_only_end() {
    let floor = [DVec3::NEG_Y, DVec3::new(0.0, -1.0, 1.0), DVec3::new(1.0, -1.0, 0.0)];
    let ending = reaching([0.0, 1.0], 0);
    let beginning = [[1.5, -1.5, 0.0], [3.0, 1.0, -1.0], [3.0, 1.0, 1.0]].map(DVec3::from);
    let mut polygons = vec![floor];
    polygons.extend([[ending; 4], [beginning; 4]].concat());
    let mut fixture = Fixture::new(&polygons, 0.0);
    fixture.keep(PlaneId::face(0), Side::Front);
    let found = FreePlanes::default().best(&fixture.set(), &Watch::default()).unwrap();
    let even = Cost { cuts: false, amount: 2.0 * work(4) };
    assert_eq!(found.map(|found| (axis_of(&found), found.cost)), Some((0, even)));
}

#[test]
fn a_tolerance_may_be_wider_than_bins() {
    let mut random = SplitMix64::new(4);
    let fixture = Fixture::new(&triangles(&mut random, 3000, 1e-3, 1.0), 0.01);
    let found = FreePlanes::default().best(&fixture.set(), &Watch::default()).unwrap();
    assert!(found.is_some());
}

/// Some pieces were cut. Where a piece ends at a cut, no corner names a plane.
#[test]
fn planes_go_through_the_corners_that_name_them() {
    let mut random = SplitMix64::new(5);
    let mut named = 0;
    for round in 0..300 {
        let count = 4 + round % 12;
        let mut fixture = Fixture::new(&triangles(&mut random, count, 0.4, 1.0), 0.0);
        fixture.keep(PlaneId::face(0), Side::Front);
        if fixture.pieces.len() < 2 {
            continue;
        }
        let set = fixture.set();
        let clean = FreePlanes::default().clean(&set);
        let best = FreePlanes::default().best(&set, &Watch::default()).unwrap();
        for found in [clean, best].into_iter().flatten() {
            let PlaneKind::Axis(axis, corner) = found.plane.kind() else { panic!("{found:?}") };
            let coordinate = fixture.faces.corner(corner)[axis];
            assert_eq!(at(&fixture.pieces, axis, coordinate, 0.0), found.cost, "{round}");
            named += 1;
        }
    }
    assert!(named > 300, "{named}");
}

#[test]
fn the_best_of_the_planes_that_cut_nothing_is_found() {
    let mut random = SplitMix64::new(6);
    for count in [2, 3, 5, 8, 13, 40, 60] {
        for size in [0.003, 0.02, 0.1] {
            let fixture = Fixture::new(&triangles(&mut random, count, size, 1.0), 0.0);
            let Some(clean) = FreePlanes::default().clean(&fixture.set()) else {
                continue;
            };
            let costs = [0, 1, 2].map(|axis| least(&fixture.pieces, axis, 0.0));
            let best = costs.into_iter().min_by(Cost::cmp).unwrap_or(Cost::MOST);
            assert_eq!(clean.cost, best, "{count} of {size}: {clean:?}, {costs:?}");
        }
    }
}
