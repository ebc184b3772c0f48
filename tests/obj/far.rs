//! Files far from the origin, such as geodata: their decimals define their precision, at any place.

use std::fmt::Write;
use testkit::prelude::*;

use super::read;

/// A ground of 100 m by 100 m at a place, not quite level, and two slabs on it whose distance is a given
/// number of decimal units.
fn site(at: [f64; 2], places: usize, units: [f64; 2]) -> String {
    let unit = 10f64.powi(-(places as i32));
    let mut text = String::new();
    let mut quad = |low: f64, high: f64, heights: [f64; 4]| {
        let corners = [[low, low], [high, low], [high, high], [low, high]];
        for ([x, y], z) in corners.into_iter().zip(heights) {
            let (x, y) = (at[0] + x, at[1] + y);
            writeln!(text, "v {x:.places$} {y:.places$} {z:.places$}").unwrap();
        }
        writeln!(text, "f -4 -3 -2 -1").unwrap();
    };
    quad(0.0, 100.0, [0.0; 4]);
    // The lower one comes last.
    let [lower, upper] = units.map(|units| units * unit);
    quad(20.0, 80.0, [upper; 4]);
    quad(30.0, 70.0, [lower; 4]);
    text
}

fn from_above(tree: &BspTree) -> Vec<usize> {
    tree.back_to_front(Viewpoint::direction(DVec3::NEG_Z)).map(|f| f.polygon()).collect()
}

#[test]
fn slabs_of_a_site_plan_keep_their_order_wherever_it_lies() {
    for at in [[0.0; 2], [500_000.0, 5_400_000.0], [-3.0e6, 7.5e6], [83_886.08, 0.0]] {
        for (places, units) in [(2, [3.0, 6.0]), (3, [4.0, 9.0]), (1, [1.0, 2.0]), (0, [1.0, 2.0])]
        {
            let (scene, _) = read(site(at, places, units)).unwrap();
            for &heuristic in Heuristic::ALL {
                let options = BuildOptions::DEFAULT.with_heuristic(heuristic);
                let tree = options.build(scene.polygons()).unwrap();
                let name = format!("{places} decimals at {at:?}, {heuristic}");
                assert_eq!(from_above(&tree), [0, 2, 1], "{name}");
                // The extent is 100 m.
                assert!(
                    tree.stats().tolerance <= 1e-3 * (1.0 + 1e-9),
                    "{name}: {:?}",
                    tree.stats()
                );
            }
        }
    }
}

/// Cards of a tilted plane, rotated by a matrix of `f32` far from the origin, and written with all digits of
/// an `f32`: the steps of these numbers count, however large a share of the extent they are.
#[test]
fn files_of_single_precision_far_out_are_as_precise_as_that() {
    let mut text = String::new();
    let (across, along) = (DVec3::new(0.8, 0.36, 0.48), DVec3::new(-0.6, 0.48, 0.64));
    let from = DVec3::new(4321.0, -3000.0, 1234.5);
    let mut largest = 0f32;
    for k in 0..30 {
        let low = across * f64::from(k) * 0.3 + along * f64::from(k * k % 7);
        for [u, v] in [[0.0, 0.0], [4.0, 0.0], [4.0, 3.0], [0.0, 3.0]] {
            let point = (from + low + across * u + along * v).as_vec3();
            largest = largest.max(point.abs().max_element());
            writeln!(text, "v {:.9e} {:.9e} {:.9e}", point.x, point.y, point.z).unwrap();
        }
        writeln!(text, "f -4 -3 -2 -1").unwrap();
    }
    let (scene, _) = read(text).unwrap();
    let tree = BspTree::build(scene.polygons()).unwrap();
    let four_steps = 4.0 * f64::from(f32::EPSILON) * f64::from(largest);
    assert!((tree.stats().tolerance / four_steps - 1.0).abs() < 1e-9, "{:?}", tree.stats());
    assert!(four_steps > 1e-5 * 20.0, "the limit of other files is less");
    assert_eq!((tree.len(), tree.preparation().triangulated), (30, 0));
}
