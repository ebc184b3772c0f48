//! Searches for eyes that a smaller error bound would put on the wrong side of a plane.

use std::cmp::Ordering;

use glam::DVec3;

use super::{ERROR, View};
use crate::exact::LATTICE_LIMIT;
use crate::random::mix;
use crate::viewpoint::Viewpoint;
use crate::{BspTree, BuildOptions, Heuristic};

/// The largest coordinate of a scene in which the length 1 is 2⁵⁰ lattice units.
const ALMOST_TWO: f64 = 2.0 - 1e-9;

/// A stream of numbers from −1 to 1, many of them at the ends.
struct Numbers(u64);

impl Numbers {
    fn roll(&mut self) -> u64 {
        self.0 += 1;
        mix(self.0)
    }

    fn number(&mut self) -> f64 {
        let x = (self.roll() >> 11) as f64 / (1u64 << 52) as f64 - 1.0;
        if self.roll() & 3 == 0 { x.signum() * (1.0 - x.abs() * 0.01) } else { x }
    }

    fn point(&mut self) -> DVec3 {
        DVec3::new(self.number(), self.number(), self.number())
    }
}

/// A tree whose first plane is the plane of a triangle in a corner of a scene that fills its lattice: planes
/// far from the middle have the largest errors.
fn tree(numbers: &mut Numbers) -> BspTree {
    let corner = DVec3::ONE.copysign(numbers.point()) * ALMOST_TWO;
    let triangle = [0; 3].map(|_| corner * (DVec3::ONE - numbers.point().abs() * 0.5));
    let all = [DVec3::NEG_ONE, DVec3::ONE, DVec3::new(1.0, -1.0, 0.0)].map(|p| p * ALMOST_TWO);
    let options = BuildOptions::DEFAULT.with_heuristic(Heuristic::First).with_tolerance(0.0);
    options.build([triangle, all]).expect("finite")
}

/// The rounded distance of an eye from the first plane, in the unit of the bound, if its sign is wrong;
/// otherwise 0.
fn error(tree: &BspTree, eye: Viewpoint) -> f64 {
    let view = View::new(tree, eye);
    let distance = view.distances(&tree.planes.0[0])[0];
    let rounded = distance.total_cmp(&0.0);
    let exact = tree.faces.eye_side(tree.nodes[0].plane, &view.eye);
    assert_eq!(view.is_in_front(tree, 0), exact == Ordering::Greater, "{eye:?}");
    let mut words = vec![0; tree.planes.words()];
    view.write_signs(tree, &mut words);
    assert_eq!(words[0] & 1 == 1, exact == Ordering::Greater, "{eye:?}");
    let p = view.point.as_dvec4().abs();
    let size = p.x + p.y + p.z + 2.0 * p.w;
    if rounded == exact { 0.0 } else { f64::from(distance.abs()) / size }
}

/// Moves a place into the first plane, up to rounding. Returns it as an eye, in 2⁵¹ lattice units, or as a
/// direction parallel to the plane.
fn in_plane(tree: &BspTree, place: DVec3, is_far: bool, nudge: f64) -> Viewpoint {
    let plane = tree.faces.plane(tree.nodes[0].plane);
    let length = plane.normal_f64().length();
    let unit = plane.normal_f64() / length;
    let offset = if is_far { 0.0 } else { plane.offset_f64() / length / LATTICE_LIMIT };
    let most = unit.abs().max_position();
    let mut at = place;
    at[most] += (offset - unit.dot(at)) / unit[most] + nudge;
    if is_far { Viewpoint::Direction(at) } else { Viewpoint::Eye(at * 2.0) }
}

#[test]
fn a_bound_of_a_quarter_would_put_eyes_on_the_wrong_side() {
    let (mut numbers, mut worst, mut wrong) = (Numbers(1), [0f64; 2], 0);
    for _ in 0..300 {
        let tree = tree(&mut numbers);
        for (kind, worst) in worst.iter_mut().enumerate() {
            let mut best = (0.0, numbers.point());
            for turn in 0..1000 {
                // Hill climbing from the best of some samples.
                let size = 10f64.powf(-4.0 - 3.0 * numbers.number());
                let near = best.1 + best.1 * numbers.point() * size;
                // Also beyond the scene, up to half its size away.
                let place = if turn < 200 { numbers.point() * 1.5 } else { near };
                let nudge = 1e-15 * numbers.number();
                let found = error(&tree, in_plane(&tree, place, kind == 1, nudge));
                wrong += usize::from(found > 0.0);
                if found > best.0 {
                    best = (found, place);
                }
            }
            *worst = worst.max(best.0);
        }
    }
    assert!(wrong > 20_000, "{wrong}");
    let shares = worst.map(|worst| worst / f64::from(ERROR));
    assert!(shares.iter().all(|&share| share > 0.25), "{shares:?}");
    assert!(shares.iter().all(|&share| share < 1.0), "{shares:?}");
}
