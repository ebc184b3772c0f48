//! Changes that must give the same tree, bit for bit.

use proptest::prelude::*;
use testkit::prelude::*;
use testkit::snapshot::{Snapshot, order};

#[test]
fn any_number_of_threads_builds_the_same_tree() {
    let scenes: [Scene; 3] = [scene::sphere(2500), scene::city(5000, 3), scene::teapot(12)];
    let by = [Heuristic::Auto, Heuristic::Sampled { candidates: 4 }];
    for scene in scenes {
        for heuristic in by {
            let build = |threads: usize| {
                let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
                let options = BuildOptions::DEFAULT.with_heuristic(heuristic);
                pool.install(|| options.build(scene.polygons())).unwrap()
            };
            let (one, two, eight) = (build(1), build(2), build(8));
            let snapshot = Snapshot::of(&one);
            assert!(snapshot == Snapshot::of(&two), "{} by {heuristic}", scene.name());
            assert!(snapshot == Snapshot::of(&eight), "{} by {heuristic}", scene.name());
            let eye = Viewpoint::eye([3.0, 1.0, 2.0]);
            assert_eq!(order(&one, eye), order(&two, eye));
        }
    }
}

#[test]
fn a_tree_that_is_built_twice_at_once_is_the_same() {
    let scene = scene::city(8000, 1);
    let build = || Snapshot::of(&BspTree::build(scene.polygons()).unwrap());
    let (a, b) = rayon::join(build, build);
    assert!(a == b);
}

proptest! {
    #![proptest_config(cases(128, file!()))]

    #[test]
    fn building_again_gives_the_same_tree(
        scene in hard::scene(), by in hard::heuristic(),
    ) {
        let build = || Snapshot::of(&scene.build(by).unwrap());
        prop_assert_eq!(build(), build());
    }

    /// The lattice and each `f64` operation on it scale without rounding.
    #[test]
    fn scaling_by_a_power_of_two_changes_nothing(
        scene in hard::scene(),
        by in hard::heuristic(),
        exponent in -200..200i32,
        eye in prop::array::uniform3(-3.0..3.0f64),
    ) {
        let factor = 2f64.powi(exponent);
        let scaled: Vec<Vec<DVec3>> = scene
            .polygons
            .iter()
            .map(|polygon| polygon.iter().map(|&corner| corner * factor).collect())
            .collect();
        // The smallest numbers have no room to be scaled.
        let back = scaled.iter().flatten().map(|&corner| corner / factor);
        prop_assume!(back.eq(scene.polygons.iter().flatten().copied()));
        let (tree, mut options) = (scene.build(by).unwrap(), scene.options(by));
        options.tolerance = scene.tolerance().map(|tolerance| tolerance * factor).into();
        let other = options.build(&scaled).unwrap();
        prop_assert_eq!(Snapshot::of(&tree), Snapshot::of(&other));
        let eye = DVec3::from_array(eye) * hard::extent(&scene.polygons);
        prop_assert_eq!(
            order(&tree, Viewpoint::Eye(eye)),
            order(&other, Viewpoint::Eye(eye * factor))
        );
        if eye != DVec3::ZERO {
            prop_assert_eq!(
                order(&tree, Viewpoint::Direction(eye)),
                order(&other, Viewpoint::Direction(eye * factor))
            );
        }
    }
}
