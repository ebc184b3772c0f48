//! Peeling against brute force with exact decisions.

use glam::{DQuat, DVec3, EulerRot};

use super::super::set::PackedPieces;
use super::super::tests::{Fixture, grid, triangles};
use super::{Peeled, Peeler, arrange};
use crate::build::choose::set::Set;
use crate::build::choose::tuning::Tuning;
use crate::exact::Side;
use crate::progress::Watch;
use crate::random::SplitMix64;

fn arranged(set: &Set<'_>, groups_per_box: usize) -> Vec<usize> {
    let mut order = vec![];
    arrange(set, groups_per_box, &mut order);
    order
}

fn peel(set: &Set<'_>, tuning: &Tuning) -> Option<Peeled> {
    let mut sketch = PackedPieces::default();
    sketch.reset(set);
    sketch.extend(set, arranged(set, tuning.groups_per_box).into_iter());
    Peeler::default().search(set, &sketch, tuning, &Watch::default())
}

/// Asserts that each layer has all remaining pieces on its declared side, and that its own pieces are all
/// pieces on its plane. Returns the remaining pieces.
fn assert_layers(name: &str, set: &Set<'_>, peeled: Option<&Peeled>) -> Vec<bool> {
    let mut left = vec![true; set.len()];
    let layers =
        peeled.into_iter().flat_map(|peeled| peeled.layers().iter().map(move |l| (peeled, l)));
    for (i, (peeled, layer)) in layers.enumerate() {
        assert!(!peeled.pieces(layer).is_empty(), "{name}: nothing in layer {i}");
        let prepared = set.prepare(layer.plane);
        for &piece in peeled.pieces(layer) {
            assert!(left[piece as usize], "{name}: {piece} is taken twice");
            assert_eq!(set.classify(&prepared, piece as usize), Side::Coplanar, "{name}: {i}");
            left[piece as usize] = false;
        }
        for other in (0..set.len()).filter(|&other| left[other]) {
            assert_eq!(set.classify(&prepared, other), layer.rest, "{name}: {other} at {i}");
        }
    }
    left
}

/// Returns the pieces that remain after each has been tried once, in order.
fn brute_force(set: &Set<'_>, order: &[usize]) -> Vec<bool> {
    let mut left = vec![true; set.len()];
    for &piece in order {
        if !left[piece] || left.iter().filter(|&&is_left| is_left).count() < 2 {
            continue;
        }
        let prepared = set.prepare(set.own_plane(piece));
        let sides: Vec<_> = (0..set.len()).map(|other| set.classify(&prepared, other)).collect();
        let reaches = |side| {
            (0..set.len()).any(|i| left[i] && (sides[i] == side || sides[i] == Side::Spanning))
        };
        if !reaches(Side::Front) || !reaches(Side::Back) {
            (0..set.len()).for_each(|i| left[i] &= sides[i] != Side::Coplanar);
        }
    }
    left
}

fn assert_like_brute_force(name: &str, fixture: &Fixture) -> usize {
    let set = fixture.set();
    let mut taken = 0;
    for groups_per_box in [1, 2, 64] {
        let expected = brute_force(&set, &arranged(&set, groups_per_box));
        let name = format!("{name}, boxes of {groups_per_box}");
        let peeled = peel(&set, &Tuning { groups_per_box, ..Tuning::DEFAULT });
        let left = assert_layers(&name, &set, peeled.as_ref());
        assert_eq!(left, expected, "{name}");
        taken = left.iter().filter(|&&is_left| !is_left).count();
    }
    taken
}

/// Triangles on a sphere, with shared corners.
fn sphere(rings: u32) -> Vec<[DVec3; 3]> {
    let point = |i: u32, j: u32| {
        let (a, b) = (f64::from(i % (2 * rings)), f64::from(j));
        let (a, b) = [a, b].map(|c| c * std::f64::consts::PI / f64::from(rings)).into();
        DVec3::new(a.cos() * b.sin(), a.sin() * b.sin(), b.cos())
    };
    let mut triangles = vec![];
    for i in 0..2 * rings {
        for j in 0..rings {
            let [a, b, c, d] = [point(i, j), point(i, j + 1), point(i + 1, j + 1), point(i + 1, j)];
            triangles.extend((j + 1 < rings).then_some([a, b, c]));
            triangles.extend((j > 0).then_some([a, c, d]));
        }
    }
    triangles
}

/// A rotated cube, each side a grid.
fn cube(side: u32) -> Vec<[DVec3; 3]> {
    let one = grid(side, |_| 0.0);
    let back = DQuat::from_euler(EulerRot::XYZ, 0.3, 0.5, 0.7);
    let turns =
        [0.0, 1.0, 2.0, 3.0].map(|k| DQuat::from_rotation_x(k * 0.5 * std::f64::consts::PI));
    let others = [0.5, 1.5].map(|k| DQuat::from_rotation_y(k * std::f64::consts::PI));
    let middle = DVec3::new(0.5, 0.5, 0.5);
    let turned = turns.into_iter().chain(others).flat_map(|turn| {
        let place = move |p: DVec3| back * (turn * (back.inverse() * p - middle));
        one.iter().map(move |corners| corners.map(place))
    });
    turned.collect()
}

#[test]
fn random_sets_are_peeled_as_by_brute_force() {
    let mut random = SplitMix64::new(1);
    let mut taken = 0;
    for n in [2, 3, 4, 5, 9, 17, 40] {
        for size in [0.1, 0.5, 2.0] {
            for tolerance in [0.0, 1e-3] {
                let fixture = Fixture::new(&triangles(&mut random, n, size), tolerance);
                let name = format!("{n} of {size} within {tolerance}");
                taken += assert_like_brute_force(&name, &fixture);
            }
        }
    }
    assert!(taken > 30, "{taken}");
}

/// Heights that single precision does not see decide which pieces can be separated.
#[test]
fn what_is_near_is_decided_exactly() {
    let mut taken = 0;
    for seed in 0..10 {
        for height in [1e-13, 1e-10, 1e-8] {
            let mut random = SplitMix64::new(seed);
            let rough = grid(4, |_| height * random.point(-1.0, 1.0).x);
            taken += assert_like_brute_force("rough", &Fixture::new(&rough, 0.0));
        }
    }
    assert!(taken > 0);
    let bowl = grid(5, |at| 1e-8 * (at - DVec3::new(0.5, 0.5, 0.0)).length_squared());
    assert_like_brute_force("a bowl", &Fixture::new(&bowl, 0.0));
}

#[test]
fn pieces_in_one_plane_are_taken_together() {
    let fixture = Fixture::new(&cube(3), 1e-9);
    let set = fixture.set();
    let peeled = peel(&set, &Tuning::DEFAULT).unwrap();
    let left = assert_layers("a cube", &set, Some(&peeled));
    let layers = peeled.layers();
    assert!(layers.len() <= 6 && !left.contains(&true), "{} layers", layers.len());
    for layer in layers {
        assert_eq!(peeled.pieces(layer).len(), 2 * 3 * 3);
    }
}

#[test]
fn convex_sets_come_apart_whatever_their_size() {
    for rings in [3, 6, 20] {
        let fixture = Fixture::new(&sphere(rings), 1e-9);
        let set = fixture.set();
        for tuning in [Tuning::DEFAULT, Tuning { groups_per_box: 2, ..Tuning::DEFAULT }] {
            let peeled = peel(&set, &tuning);
            let left = assert_layers(&format!("{rings} rings"), &set, peeled.as_ref());
            assert!(left.iter().filter(|&&is_left| is_left).count() <= 1, "{rings} rings");
        }
    }
}

/// More than one box, with and without peelable pieces.
#[test]
fn large_sets_are_peeled_as_by_brute_force() {
    let mut random = SplitMix64::new(2);
    let mut polygons = sphere(9);
    polygons.extend(triangles(&mut random, 60, 0.1).iter().map(|p| p.map(|c| c * 0.4)));
    let fixture = Fixture::new(&polygons, 1e-9);
    assert!(fixture.pieces.len() > 4 * Tuning::DEFAULT.groups_per_box);
    let taken = assert_like_brute_force("a sphere around a heap", &fixture);
    assert!(taken >= sphere(9).len(), "{taken}");
}

/// The boxes of separated pieces are empty, and boxes may contain only remaining pieces.
#[test]
fn a_pile_is_taken_off_from_one_end() {
    let mut random = SplitMix64::new(3);
    let pile: Vec<_> = (0..100)
        .map(|i| {
            let at = random.point(-0.1, 0.1) + DVec3::Z;
            [DVec3::X, DVec3::Y, DVec3::NEG_ONE].map(|p| (p + at).with_z(f64::from(i)))
        })
        .collect();
    let turned: Vec<_> = pile.iter().map(|&[a, b, c]| [a, c, b]).collect();
    for polygons in [pile, turned] {
        let taken = assert_like_brute_force("a pile", &Fixture::new(&polygons, 0.0));
        assert!(taken >= 99, "{taken}");
    }
}

/// A set with boxes, and then another set without boxes.
#[test]
fn nothing_is_left_of_the_search_before() {
    let mut random = SplitMix64::new(4);
    let mut polygons: Vec<_> = sphere(9).iter().map(|p| p.map(|c| c * 0.01)).collect();
    let small = polygons.len();
    polygons.extend(triangles(&mut random, 40, 0.3));
    let mut fixture = Fixture::new(&polygons, 0.0);
    let others = fixture.pieces.split_off(small);
    let (mut peeler, tuning) = (Peeler::default(), &Tuning::DEFAULT);
    for pieces in [fixture.pieces.clone(), others] {
        fixture.pieces = pieces;
        let (set, mut sketch) = (fixture.set(), PackedPieces::default());
        sketch.reset(&set);
        let order = arranged(&set, tuning.groups_per_box);
        sketch.extend(&set, order.iter().copied());
        let peeled = peeler.search(&set, &sketch, tuning, &Watch::default());
        let left = assert_layers("one after the other", &set, peeled.as_ref());
        assert_eq!(left, brute_force(&set, &order));
    }
}
