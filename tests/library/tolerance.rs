//! Tests the statements of `docs/guide/exact.md` on orders that the coplanar tolerance leaves open.

use binspace::internals::LATTICE_LIMIT;
use testkit::prelude::*;

/// A rectangle at a height.
fn layer(low: DVec2, high: DVec2, z: f64) -> [DVec3; 4] {
    [low, DVec2::new(high.x, low.y), high, DVec2::new(low.x, high.y)].map(|corner| corner.extend(z))
}

/// Whether a ray meets a convex polygon.
fn is_met(outline: &[DVec3], eye: DVec3, target: DVec3) -> bool {
    let side = |i: usize| {
        let (from, to) = (outline[i], outline[(i + 1) % outline.len()]);
        (from - eye).cross(to - eye).dot(target - eye)
    };
    let sides: Vec<f64> = (0..outline.len()).map(side).collect();
    sides.iter().all(|&side| side > 0.0) || sides.iter().all(|&side| side < 0.0)
}

/// The polygon visible from an eye at a target: the last painted polygon.
fn shown(tree: &BspTree, eye: DVec3, target: DVec3) -> usize {
    let mut painted = Vec::new();
    for fragment in tree.back_to_front(Viewpoint::Eye(eye)) {
        let outline: Vec<DVec3> = fragment.vertices().collect();
        if is_met(&outline, eye, target) {
            painted.push(fragment.polygon());
        }
    }
    enough!(painted.len() > 1; "nothing to confuse: {painted:?}");
    *painted.last().unwrap()
}

fn built(polygons: &[[DVec3; 4]], tolerance: Option<f64>) -> BspTree {
    let options = BuildOptions::DEFAULT.with_heuristic(Heuristic::First);
    let options = tolerance.map_or(options.clone(), |length| options.with_tolerance(length));
    options.build(polygons).unwrap()
}

/// One layer is above the plane of a third polygon, and another is below it, both by less than the tolerance.
#[test]
fn only_layers_up_to_twice_the_tolerance_apart_may_be_exchanged() {
    let tolerance = 1e-3;
    let wide = [DVec2::splat(-1.0), DVec2::splat(1.0)];
    let aside = layer(DVec2::splat(5.0), DVec2::splat(6.0), 0.0);
    let shown_at = |gap: f64, tolerance: f64| {
        let [upper, lower] = [0.5, -0.5].map(|half| layer(wide[0], wide[1], half * gap));
        let tree = built(&[aside, upper, lower], Some(tolerance));
        shown(&tree, dvec3(0.1, 0.2, 50.0), dvec3(0.1, 0.2, 0.0))
    };
    let (upper, lower) = (1, 2);
    assert_eq!(shown_at(1.9 * tolerance, tolerance), lower, "in input order, as if coplanar");
    assert_eq!(shown_at(2.1 * tolerance, tolerance), upper);
    assert_eq!(shown_at(1.9 * tolerance, 0.0), upper);
}

/// A near wall reaches below the plane of a floor, and a far wall reaches above it, both by less than the
/// tolerance. The eye is a hundred tolerances away from this plane, but its ray stays within the tolerance of
/// the plane from one wall to the other.
#[test]
fn polygons_far_apart_may_be_exchanged_along_a_ray_that_keeps_within_the_tolerance_of_a_plane() {
    let unit = 1e-3;
    let wall = |x: f64, low: f64, high: f64| {
        [dvec3(x, -1.0, low), dvec3(x, 1.0, low), dvec3(x, 1.0, high), dvec3(x, -1.0, high)]
    };
    let floor = layer(DVec2::new(3.0, 5.0), DVec2::new(4.0, 6.0), 0.0);
    let polygons = [floor, wall(1.0, -0.5 * unit, 1.0), wall(2.0, -1.0, 0.5 * unit)];
    let (near, far) = (1, 2);
    // The ray goes from 0.4 units below the plane at the near wall to 0.4 units above the plane at the far
    // wall.
    let rise = 0.8 * unit;
    let eye = |distance: f64| dvec3(1.0 - distance, 0.1, -0.4 * unit - distance * rise);
    let target = dvec3(1.0, 0.1, -0.4 * unit);
    let eye = eye(125.0);
    assert!(eye.z < -100.0 * unit);
    assert_eq!(shown(&built(&polygons, Some(unit)), eye, target), far);
    assert_eq!(shown(&built(&polygons, Some(0.0)), eye, target), near);
    // A steeper ray meets both walls in the right order.
    let (above, target) = (dvec3(-1.0, 0.1, 0.8), dvec3(2.0, 0.1, -0.1));
    assert_eq!(shown(&built(&polygons, Some(unit)), above, target), near);
}

/// In metres: the layers are a millimetre apart, and the stray vertex is a thousand kilometres away.
#[test]
fn a_stray_vertex_makes_thin_layers_interchangeable_by_default() {
    let wide = [DVec2::splat(-1.0), DVec2::splat(1.0)];
    let [upper, lower] = [1e-3, 0.0].map(|z| layer(wide[0], wide[1], z));
    let mut stray = layer(DVec2::splat(5.0), DVec2::splat(6.0), 2.0);
    let look = |polygons: &[[DVec3; 4]], tolerance| {
        shown(&built(polygons, tolerance), dvec3(0.1, 0.2, 50.0), dvec3(0.1, 0.2, 0.0))
    };
    assert_eq!(look(&[upper, lower, stray], None), 0);
    stray[2].x = 1.000_01e6;
    assert_eq!(look(&[upper, lower, stray], None), 1, "in input order, as if coplanar");
    // A tolerance given as a length avoids this.
    assert_eq!(look(&[upper, lower, stray], Some(1e-9)), 0);
    assert_eq!(look(&[upper, lower, stray], Some(0.0)), 0);
}

/// Layers whose distance is at most the effective tolerance count as coplanar, so they come in input order
/// from below.
#[test]
fn a_tolerance_is_limited_to_a_share_of_the_extent() {
    let wide = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
    let layer = |z: f64| wide.map(|[x, y]| [x, y, z]);
    let is_coplanar = |gap: f64, tolerance: f64| {
        let options = BuildOptions::DEFAULT.with_tolerance(tolerance);
        let tree = options.build([layer(0.0), layer(gap)]).unwrap();
        tree.root().unwrap().on().len() == 2
    };
    for tolerance in [0.5, 1.0, 1e300, f64::INFINITY] {
        assert!(is_coplanar(1.0 / 257.0, tolerance), "{tolerance}");
        assert!(!is_coplanar(1.0 / 127.0, tolerance), "{tolerance}");
    }
    assert!(!is_coplanar(1.0 / 257.0, 1e-9) && !is_coplanar(1.0 / 257.0, 0.0));
    // On the grid, a 128th of half its side.
    let on_grid = |tolerance: f64| Faces::new([layer(0.0)], Some(tolerance)).unwrap().0;
    for tolerance in [1.0, 1e300, f64::INFINITY] {
        assert_eq!(on_grid(tolerance).tolerance(), LATTICE_LIMIT / 128.0);
    }
    let largest = on_grid(1.0 / 128.0);
    assert_eq!(largest.lattice().length_to_world(largest.tolerance()), 1.0 / 128.0);
}
