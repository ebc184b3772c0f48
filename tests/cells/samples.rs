//! NaN and infinite samples do not affect the planes, and no sample makes a plane outside the scene.

use binspace::partition::{Extent, Partition};
use testkit::prelude::*;

#[test]
fn samples_that_are_not_finite_choose_nothing() {
    let mut extent = Extent::default();
    extent.include(&[DVec3::ZERO, DVec3::splat(8.0)]);
    let good: Vec<DVec3> =
        (0..9).map(|k| DVec3::new(f64::from(k), f64::from(k % 3), f64::from(k % 2))).collect();
    let chosen = |samples: Vec<DVec3>| {
        BuildOptions::DEFAULT.partition(&extent, samples, 5).expect("a finite extent")
    };
    let expected = chosen(good.clone());
    for bad in [f64::NAN, -f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        for axis in 0..3 {
            let mut point = DVec3::splat(4.0);
            point[axis] = bad;
            // More bad samples than good ones: in front, between and behind.
            let mut samples = vec![point; 7];
            samples.extend(good.iter().flat_map(|&good| [good, point]));
            assert_eq!(chosen(samples), expected, "{bad} along {axis}");
            // Only bad samples count as no samples.
            assert_eq!(chosen(vec![point; 9]), chosen(vec![]));
        }
    }
    let eye = Viewpoint::eye([9.0, 9.0, 9.0]);
    assert_eq!(expected.back_to_front(eye).len(), 5);
}

/// Samples beyond the extent, on all sides of it. A file of the partition can be read, and each cell has room.
#[test]
fn samples_outside_the_scene_count_as_on_its_border() {
    let mut extent = Extent::default();
    extent.include(&[DVec3::ZERO, DVec3::splat(8.0)]);
    for seed in seeds(40) {
        let dice = &mut Dice(seed);
        let samples: Vec<DVec3> = (0..dice.below(12)).map(|_| dice.point(-20.0, 30.0)).collect();
        for cells in [2, 3, 8] {
            let found = BuildOptions::DEFAULT.partition(&extent, samples.clone(), cells);
            let found = found.expect("finite samples");
            let mut file = Vec::new();
            found.write(&mut file).expect("a list takes all");
            assert_eq!(Partition::read(&file[..]).expect("a file of a partition"), found, "{seed}");
            let inside = samples.iter().map(|sample| sample.clamp(DVec3::ZERO, DVec3::splat(8.0)));
            let inside = BuildOptions::DEFAULT.partition(&extent, inside, cells);
            assert_eq!(inside.expect("finite samples"), found, "{seed}");
        }
    }
}
