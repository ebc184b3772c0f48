//! NaN and infinite samples do not affect the planes.

use binspace::partition::Extent;
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
