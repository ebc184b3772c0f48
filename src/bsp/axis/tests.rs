//! The search for free planes against brute force.

use glam::DVec3;

use super::super::cost::{price, work};
use super::super::live::Live;
use super::super::progress::Watch;
use super::{CROWD, Sweep, UNEVEN};
use crate::geom::Faces;
use crate::random::SplitMix64;

/// The least cost of all planes perpendicular to an axis through a corner, by looking at every
/// piece for each.
fn least(pieces: &[Live], axis: usize, tolerance: f64) -> f64 {
    let coordinates = pieces.iter().flat_map(|piece| [piece.min[axis], piece.max[axis]]);
    coordinates.map(|c| at(pieces, axis, c, tolerance)).fold(f64::INFINITY, f64::min)
}

/// What a plane costs; infinite if it leaves all pieces on one side.
fn at(pieces: &[Live], axis: usize, c: f64, tolerance: f64) -> f64 {
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
    if divides { work(in_front) + work(behind) + price(splits) } else { f64::INFINITY }
}

/// Asserts that the plane found is the best of the axes that have to be searched.
fn assert_best(name: &str, polygons: &[[DVec3; 3]], tolerance: f64) {
    let (faces, _) = Faces::new(polygons, Some(tolerance)).unwrap();
    let pieces: Vec<Live> = (0..faces.len() as u32).map(|face| Live::whole(&faces, face)).collect();
    let (n, watch) = (pieces.len(), Watch::default());
    let found = Sweep::default().best(&pieces, faces.tolerance(), &watch);
    let costs = [0, 1, 2].map(|axis| least(&pieces, axis, faces.tolerance()));
    if tolerance == 0.0 {
        let clean = Sweep::default().clean(&pieces, 0.0);
        let cost = clean.map(|plane| at(&pieces, plane.axis, plane.coordinate, 0.0));
        assert!(cost.is_none_or(|cost| cost < price(1)), "{name}: {clean:?} cuts");
        assert_eq!(cost.is_some(), costs.iter().any(|&cost| cost < price(1)), "{name}: {clean:?}");
    }
    let expected = costs.into_iter().fold(f64::INFINITY, f64::min);
    let found = found.map_or(f64::INFINITY, |plane| plane.cost);
    let enough = work(n / UNEVEN) + work(n - n / UNEVEN);
    let good_enough = found <= enough && costs.contains(&found);
    assert!(found == expected || good_enough, "{name}: {found}, not one of {costs:?}");
}

fn triangles(random: &mut SplitMix64, count: usize, size: f64, within: f64) -> Vec<[DVec3; 3]> {
    let mut triangle = || {
        let at = random.point(-within, within);
        [(); 3].map(|()| at + random.point(-size, size))
    };
    (0..count).map(|_| triangle()).collect()
}

#[test]
fn the_best_plane_is_found_whatever_the_size() {
    let mut random = SplitMix64::new(1);
    for count in [1, 2, 3, 5, 8, 13, 40, 100, 300] {
        for size in [0.003, 0.05, 1.0] {
            let polygons = triangles(&mut random, count, size, 1.0);
            assert_best(&format!("{count} of {size}"), &polygons, 0.0);
            assert_best(&format!("{count} of {size}, within 0.01"), &polygons, 0.01);
        }
    }
}

#[test]
fn on_a_lattice_planes_touch_many() {
    let mut random = SplitMix64::new(2);
    for count in [10, 60, 250] {
        let polygons = triangles(&mut random, count, 2.0, 6.0);
        let rounded: Vec<_> = polygons.iter().map(|corners| corners.map(DVec3::round)).collect();
        assert_best(&format!("{count}"), &rounded, 0.0);
        assert_best(&format!("{count}, within 1"), &rounded, 1.0);
    }
}

/// Most of it is in two small parts of the whole, so that few bins hold nearly all.
#[test]
fn crowds_are_divided_again() {
    let mut random = SplitMix64::new(3);
    let mut polygons = triangles(&mut random, CROWD / 2, 1e-6, 1e-3);
    let apart = DVec3::new(0.4, 0.3, 0.7);
    polygons.extend(
        triangles(&mut random, CROWD / 2, 2e-4, 3e-4)
            .iter()
            .map(|corners| corners.map(|p| p + apart)),
    );
    polygons.extend(triangles(&mut random, 20, 0.5, 1.0));
    assert_best("crowds", &polygons, 0.0);
    polygons.truncate(CROWD / 2);
    polygons.push([DVec3::NEG_ONE, DVec3::X, DVec3::ONE]);
    assert_best("a crowd", &polygons, 0.0);
}
