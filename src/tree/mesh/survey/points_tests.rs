//! The order of points along lines of faces whose corners were moved.

use std::cmp::Ordering;

use glam::DVec3;

use crate::random::SplitMix64;
use crate::tree::BspTree;
use crate::tree::mesh::survey::{Points, Survey, by_line, compare};
use crate::{BuildOptions, Heuristic};

/// The distance of the quad's topmost corner below the plane of its other corners.
const OFF: f64 = 1.0 / 64.0;

/// A quad, a floor, and triangles. The quad's topmost corner is given below the plane of its other corners,
/// by less than the tolerance, so it is moved up onto that plane. The floor goes through that corner as
/// given, so it cuts off a tip of the moved quad, but nothing of the given quad. The triangles cut the tip.
fn tip(triangles: usize, random: &mut SplitMix64) -> BspTree {
    let quad = [[2.0, 1.0, -2.625], [4.0, 4.0, -7.0], [1.0, 2.0, -2.625], [0.0, 0.0, -OFF]];
    let floor = [(-3.0, -3.0), (-2.0, -3.0), (-2.0, -2.0), (-3.0, -2.0)].map(|(x, y)| [x, y, -OFF]);
    let mut polygons = vec![floor.map(DVec3::from).to_vec()];
    for _ in 0..triangles {
        // A point at this height between the two ends of the cut.
        let share = random.range(0.1, 0.9);
        let at = DVec3::new(1.0 + share, 2.0 - share, -2.625) * (OFF / 2.625);
        let [u, v] = [(); 2].map(|()| random.point(-1.0, 1.0));
        polygons.push(vec![at + u, at - u + v, at - u - v]);
    }
    // The quad is last, so that all other polygons cut it.
    polygons.push(quad.map(DVec3::from).to_vec());
    let options = BuildOptions::DEFAULT.with_heuristic(Heuristic::First);
    options.with_tolerance(OFF / 1.25).build(polygons).unwrap()
}

/// Asserts that any three ends on each line compare like numbers. Returns the number of pairs of ends that
/// are one point although they are at different places of their line.
fn check(tree: &BspTree) -> usize {
    let survey = Survey::new(tree.mesh_source()).unwrap();
    let points = Points::new(&survey).unwrap();
    let (all, starts) = by_line(&survey).unwrap();
    let mut apart = 0;
    for (line, range) in starts.windows(2).enumerate() {
        let ends = &all[range[0] as usize..range[1] as usize];
        let order = |a: usize, b: usize| compare(&survey, line, &ends[a], &ends[b]);
        for a in 0..ends.len() {
            for b in 0..ends.len() {
                assert_eq!(order(a, b), order(b, a).reverse(), "line {line}");
                let is_one = points.root(ends[a].node) == points.root(ends[b].node);
                apart += usize::from(is_one && order(a, b).is_ne());
                for c in 0..ends.len().min(60) {
                    let [ab, bc, ac] = [order(a, b), order(b, c), order(a, c)];
                    if ab != Ordering::Greater && bc != Ordering::Greater {
                        assert_eq!(ac, ab.min(bc), "line {line}");
                    }
                }
            }
        }
    }
    apart
}

#[test]
fn ends_on_a_line_of_a_face_with_moved_corners_have_a_total_order() {
    let mut random = SplitMix64::new(1);
    let mut apart = 0;
    for triangles in [1, 1, 1, 2, 2, 3, 3, 4, 6] {
        apart += check(&tip(triangles, &mut random));
    }
    assert!(apart > 0, "no point has two places on a line");
}

/// With this many ends, a sort would panic if the order contradicted itself.
#[test]
fn a_face_with_moved_corners_does_not_make_a_sort_panic() {
    for (triangles, seed) in [(8, 8), (9, 10), (10, 10), (11, 10)] {
        let tree = tip(triangles, &mut SplitMix64::new(seed));
        tree.mesh().unwrap();
        tree.welded_mesh().unwrap();
    }
}
