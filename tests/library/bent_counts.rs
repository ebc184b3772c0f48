//! Whether a polygon counts as bent does not depend on the other polygons: all are built at once, one after
//! the other, or in cells.

use binspace::Preparation;
use binspace::partition::Extent;
use testkit::prelude::*;
use testkit::shapes::Claim;

/// A quad with a corner off the plane of the others.
fn quad(at: f64, off: f64, precision: f64) -> Claim {
    let corners = [[0.0, 0.0, 0.0], [1.0, 0.0, off], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
    let corners = corners.map(|corner| DVec3::from(corner) + DVec3::X * at).to_vec();
    Claim { corners, precision }
}

/// Quads in a scene of some extent, bent from much less to much more than 10⁻⁵ of it.
fn quads(extent: f64) -> Vec<Claim> {
    let mut quads = Vec::new();
    for k in 0..60 {
        let off = extent * 1e-6 * 1.1f64.powi(k);
        let at = (extent - 1.0) * f64::from(k) / 59.0;
        quads.push(quad(at, off, 0.0));
        // Some have coarse coordinates, so that bends are within their precision.
        quads.push(quad(at, 8.0 * off, extent * 1e-4));
    }
    quads
}

fn bent(found: &Preparation) -> (usize, f64, usize) {
    (found.bent, found.bent_by, found.triangulated)
}

#[test]
fn bent_polygons_are_counted_alike_at_once_one_by_one_and_in_cells() {
    // Extents just above and below powers of two, and between them.
    for extent in [4.0, 4.1, 5.5, 7.9, 8.0, 8.1, 100.0] {
        let quads = quads(extent);
        let (low, high) = (DVec3::ZERO, DVec3::new(extent, 1.0, 1.0));
        let options = BuildOptions::DEFAULT.with_tolerance(0.0).with_bounds(low, high);
        let expected = *options.build(&quads).expect("within budget").preparation();
        assert!(expected.bent > 40 && expected.bent < quads.len() - 20, "{expected:?}");
        let mut tree = options.build(&quads[..1]).expect("within budget");
        for some in quads[1..].chunks(7) {
            options.extend(&mut tree, some).expect("on the grid");
        }
        assert_eq!(bent(tree.preparation()), bent(&expected), "{extent}, one by one");
        let mut extents = Extent::default();
        quads.iter().for_each(|quad| extents.include(quad));
        let samples = quads.iter().flat_map(|quad| quad.corners.clone());
        let partition = options.partition(&extents, samples, 3).expect("cells");
        assert_eq!(bent(&partition.preparation(&quads).expect("memory")), bent(&expected));
        for cell in 0..3 {
            let tree = options.build_cell(&partition, cell, &quads).expect("within budget");
            assert_eq!(bent(tree.preparation()), bent(&expected), "{extent}, cell {cell}");
        }
        // One quad alone in a scene of the same extent.
        let alone =
            quads.iter().map(|quad| *options.build([quad]).expect("within budget").preparation());
        assert_eq!(alone.map(|found| found.bent).sum::<usize>(), expected.bent);
    }
}

/// Thousands of slightly bent quads with coarse coordinates: they are prepared in parts.
#[test]
fn bent_quads_of_all_parts_are_counted() {
    let quad = |k: usize| {
        let at = DVec3::new((k % 50) as f64, (k / 50) as f64, 0.0);
        let lift = if k % 5 == 2 { 1e-5 } else { 0.0 };
        [[0.0, 0.0, 0.0], [0.75, 0.0, 0.0], [0.75, 0.75, lift], [0.0, 0.75, 0.0]]
            .map(|corner| (at + DVec3::from(corner)).as_vec3().to_array())
    };
    let options = BuildOptions::DEFAULT.with_tolerance(1e-9);
    let bent = |numbers: std::ops::Range<usize>| {
        let quads: Vec<[[f32; 3]; 4]> = numbers.map(quad).collect();
        let tree = options.build(&quads).unwrap();
        (tree.preparation().bent, tree.preparation().bent_by)
    };
    let (all, by) = bent(0..5000);
    // The same count as for scenes that are prepared as one part, except for rounding.
    assert_eq!(all, 5000 / 5, "bent by {by}");
    assert!(by > 1e-6 && by < 1e-5, "{by}");
}
