//! The last decimal that a file writes is its precision.

use std::fmt::Write;
use testkit::prelude::*;

use super::{read, with_corners};

/// Quads with a common normal, written with a number format. Their distance is `units` units of the last of
/// six decimals.
fn layers(count: usize, units: f64, write: impl Fn(f64) -> String) -> (Scene, DVec3) {
    let normal = DVec3::new(1.0, 2.0, 3.0).normalize();
    let (across, along) = normal.any_orthonormal_pair();
    let mut text = String::new();
    for i in 0..count {
        let turn = DVec2::from_angle(i as f64);
        let (x, y) = (across * turn.x + along * turn.y, along * turn.x - across * turn.y);
        let middle = normal * (units * 1e-6 * i as f64) + across * (0.013 * i as f64);
        for [u, v] in [[-0.5, -0.4], [0.5, -0.4], [0.5, 0.4], [-0.5, 0.4]] {
            let [x, y, z] = (middle + x * u + y * v).to_array().map(&write);
            writeln!(text, "v {x} {y} {z}").unwrap();
        }
        let first = 4 * i + 1;
        writeln!(text, "f {first} {} {} {}", first + 1, first + 2, first + 3).unwrap();
    }
    (read(text).unwrap().0, normal)
}

#[test]
fn it_is_four_units_in_the_last_decimal() {
    let of = |text: &str| read(text).unwrap().0.precision();
    assert_eq!(of(&with_corners("f 1 2 3")), 4.0);
    assert_eq!(of("v 0 0 0\nv 1.50 0 0\nv 0 1 0.125\nf 1 2 3"), 4e-3);
    assert_eq!(of("v 0.000000 0 0\nv 1.500000 0 0\nv 0 1.000000 0.125000\nf 1 2 3"), 4e-3);
    assert_eq!(binspace::scene::crossing(2).precision(), 0.0);
}

#[test]
fn quads_that_only_the_decimals_bend_stay_whole() {
    let (scene, _) = layers(60, 1000.0, |c| format!("{c:.6}"));
    assert_eq!(scene.precision(), 4e-6);
    let prepared = *BspTree::build(scene.polygons()).unwrap().preparation();
    enough!(prepared.flattened > 40; "{prepared:?}");
    assert!(prepared.triangulated == 0, "{prepared:?}");
    // If the same numbers count as exact, most quads are triangulated.
    let exact: Vec<Vec<DVec3>> =
        scene.polygons().map(|polygon| polygon.points().to_vec()).collect();
    let prepared = *BspTree::build(&exact).unwrap().preparation();
    enough!(prepared.triangulated > 30; "{prepared:?}");
    assert_eq!(prepared.bent, prepared.triangulated);
}

/// The forms in which files write six decimals: directly, padded with zeros, and with occasional strays
/// that have as many digits as an `f64`.
fn writers() -> [Box<dyn Fn(f64) -> String>; 4] {
    let written = std::cell::Cell::new(0_u32);
    [
        Box::new(|c| format!("{c:.6}")),
        Box::new(|c| format!("{c:.6}0000")),
        Box::new(move |c| {
            written.set(written.get() + 1);
            let c: f64 = format!("{c:.6}").parse().unwrap();
            if written.get().is_multiple_of(150) {
                format!("{:.17}", c * (1.0 + 1e-9))
            } else {
                c.to_string()
            }
        }),
        // Each writer adds the noise of a computation.
        Box::new(|c| {
            let c: f64 = format!("{c:.6}").parse().unwrap();
            f64::from_bits(c.to_bits() + 1).to_string()
        }),
    ]
}

#[test]
fn neither_zeros_at_the_end_nor_strays_raise_it() {
    for (k, write) in writers().iter().enumerate() {
        let (scene, _) = layers(60, 1000.0, write);
        assert_eq!(scene.precision(), 4e-6, "{k}");
        let prepared = *BspTree::build(scene.polygons()).unwrap().preparation();
        assert!(prepared.flattened > 40 && prepared.triangulated == 0, "{k}: {prepared:?}");
    }
}

/// Layers further apart than the precision are distinguished, from both sides.
#[test]
fn layers_some_units_apart_keep_their_order() {
    for (write, units) in writers().iter().flat_map(|w| [6.0, 10.0, 30.0].map(|units| (w, units))) {
        let (scene, normal) = layers(30, units, write);
        layers_are_in_order(&scene, normal, units);
    }
}

/// Cards of one tilted plane, computed by a matrix and written with six decimals. No card is cut, and
/// overlapping cards come in the file's order.
#[test]
fn cards_of_one_plane_keep_their_order() {
    let mut random = testkit::dice::Dice(5);
    let mut compared = 0;
    for page in 0..60 {
        let normal = (random.point(-1.0, 1.0) + DVec3::splat(1e-3)).normalize();
        let (across, along) = normal.any_orthonormal_pair();
        let (mut text, mut cards) = (String::new(), Vec::new());
        for i in 0..40 {
            let mut some = |low, high| random.range(low, high);
            let low = DVec2::new(some(-3.0, 3.0), some(-3.0, 3.0));
            let high = low + DVec2::new(some(0.5, 2.0), some(0.5, 2.0));
            for [u, v] in [[low.x, low.y], [high.x, low.y], [high.x, high.y], [low.x, high.y]] {
                let p = normal + across * u + along * v;
                writeln!(text, "v {:.6} {:.6} {:.6}", p.x, p.y, p.z).unwrap();
            }
            writeln!(text, "f {} {} {} {}", 4 * i + 1, 4 * i + 2, 4 * i + 3, 4 * i + 4).unwrap();
            cards.push([low, high]);
        }
        let tree = BspTree::build(read(text).unwrap().0.polygons()).unwrap();
        assert_eq!(tree.len(), 40, "page {page}");
        for direction in [normal, -normal] {
            let viewpoint = Viewpoint::direction(direction);
            let order: Vec<usize> = tree.back_to_front(viewpoint).map(|f| f.polygon()).collect();
            for (place, &first) in order.iter().enumerate() {
                for &second in &order[place + 1..] {
                    let common = cards[first][1].min(cards[second][1])
                        - cards[first][0].max(cards[second][0]);
                    if common.min_element() > 0.01 {
                        assert!(first < second, "page {page}: {first} before {second}");
                        compared += 1;
                    }
                }
            }
        }
    }
    enough!(compared > 5000; "{compared}");
}

/// Integers padded with zeros, and two thin layers over a floor. The numbers of the layers are few, but they
/// are not strays.
#[test]
fn few_thin_layers_among_short_numbers_keep_their_order() {
    let mut text = String::new();
    for z in (0..300).map(|k| -f64::from(k)).rev().chain([0.0005, 0.001]) {
        for [x, y] in [[0, 0], [9, 0], [9, 9], [0, 9]] {
            writeln!(text, "v {x}.000000 {y}.000000 {z:.6}").unwrap();
        }
        text += "f -4 -3 -2 -1\n";
    }
    let (scene, _) = read(text).unwrap();
    assert_eq!(scene.precision(), 4e-4);
    let tree = BspTree::build(scene.polygons()).unwrap();
    let order: Vec<usize> = tree
        .back_to_front(Viewpoint::direction(DVec3::Z))
        .map(|fragment| fragment.polygon())
        .collect();
    assert!(order.iter().rev().copied().eq(0..302), "{order:?}");
}

fn layers_are_in_order(scene: &Scene, normal: DVec3, units: f64) {
    let tree = BspTree::build(scene.polygons()).unwrap();
    assert!(tree.stats().tolerance >= 1e-6, "{:?}", tree.stats());
    for side in [1.0, -1.0] {
        let order: Vec<usize> = tree
            .back_to_front(Viewpoint::direction(normal * -side))
            .map(|fragment| fragment.polygon())
            .collect();
        let place = |polygon| order.iter().position(|&p| p == polygon).unwrap();
        let last = |polygon| order.iter().rposition(|&p| p == polygon).unwrap();
        for upper in 1..30 {
            let (far, near) = if side > 0.0 { (upper - 1, upper) } else { (upper, upper - 1) };
            assert!(last(far) < place(near), "{units} units: {order:?}");
        }
    }
}
