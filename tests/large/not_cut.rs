//! What must not be cut.

use binspace::glam::DVec3;
use binspace::{Heuristic, Viewpoint};

use super::round_bodies;
use super::scene::{Scene, tilt};
use testkit::dice::Dice;

/// Squares that overlap, in a plane that is tilted.
fn squares(count: usize) -> Scene {
    let mut dice = Dice(5);
    let square = |_| {
        let [x, y] = [0; 2].map(|_| dice.below(3000) as i64);
        [[x, y, 7], [x + 40, y, 7], [x + 40, y + 40, 7], [x, y + 40, 7]].map(tilt).to_vec()
    };
    Scene::new("squares", (0..count).map(square).collect())
}

#[test]
fn coplanar_sets_are_not_cut() {
    for count in [450, 500, 5000] {
        let scene = squares(count);
        let above = DVec3::from_array(tilt([0, 0, 1_000_000]).map(|c| c as f64));
        for &heuristic in Heuristic::ALL {
            let tree = scene.build(heuristic, 100 * count).expect("within budget");
            assert_eq!((tree.len(), tree.stats().nodes), (count, 1), "{heuristic}");
            for eye in [above, -above] {
                let order = tree.back_to_front(Viewpoint::Eye(eye)).map(|f| f.polygon());
                assert!(order.eq(0..count), "{heuristic}");
            }
        }
    }
}

#[test]
fn convex_bodies_are_not_cut_by_auto() {
    for count in [450, 2000, 5000] {
        let sphere = round_bodies::sphere(&mut Dice(1), count);
        let tree = sphere.build(Heuristic::Auto, 100 * count).expect("within budget");
        assert_eq!(tree.len(), sphere.len());
        assert!(tree.len() > count * 9 / 10);
    }
}
