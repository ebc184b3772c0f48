//! Large scenes and deep trees: no recursion, no quadratic work, and budgets that hold.

use binspace::{Error, ErrorKind};
use std::thread;
use testkit::orders;
use testkit::prelude::*;
use testkit::scenes::scene_of;
use testkit::shapes::{rectangle, regular, rotation};

const LARGE: u32 = 100_000;

/// Runs in a thread with a stack of 2 MiB, rayon's threads included.
pub(crate) fn with_a_small_stack<T: Send>(work: impl FnOnce() -> T + Send) -> T {
    const STACK: usize = 2 << 20;
    thread::scope(|scope| {
        let small = thread::Builder::new().stack_size(STACK);
        let thread = small.spawn_scoped(scope, || {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(2).stack_size(STACK);
            pool.build().expect("a pool").install(work)
        });
        thread.expect("a thread").join().expect("no panic")
    })
}

/// Builds a tree, orders it in every form, validates it, and drops it.
fn go_through(scene: &Scene, options: BuildOptions) -> binspace::Stats {
    with_a_small_stack(|| {
        let tree = options.build(scene.polygons()).expect("within budget");
        for viewpoint in [Viewpoint::eye([0.1, 1000.3, 0.2]), Viewpoint::direction([1.0, 2.0, 3.0])]
        {
            assert_eq!(orders::check(&tree, viewpoint), Ok(()));
        }
        tree.stats()
    })
}

/// Asserts that the mean depth is at most a few times the logarithm of the size, so that the work is O(n log
/// n), and that no list is long.
fn assert_shallow(stats: &binspace::Stats) {
    let log = (stats.fragments.max(2) as f64).log2();
    assert!(stats.depth_mean <= 2.0 * log, "{stats:?}");
    assert!(stats.depth_max as f64 <= 16.0 * log, "{stats:?}");
}

fn validate(scene: &Scene, options: BuildOptions) {
    with_a_small_stack(|| {
        assert_eq!(options.build(scene.polygons()).expect("within budget").validate(), Ok(()));
    });
}

#[test]
fn a_chain_of_100_000_polygons_needs_a_small_stack_and_a_shallow_tree() {
    let chain = scene::chain(LARGE);
    let stats = go_through(&chain, BuildOptions::DEFAULT);
    assert_eq!(stats.fragments, LARGE as usize);
    assert_shallow(&stats);
    validate(&chain, BuildOptions::DEFAULT);
}

#[test]
fn a_sphere_of_100_000_faces_needs_a_small_stack_and_a_shallow_tree() {
    let sphere = scene::sphere(LARGE);
    let stats = go_through(&sphere, BuildOptions::DEFAULT);
    // The sphere is never cut: free planes separate its rings, and the rest of a ring is divided in a list.
    assert_eq!(stats.fragments, stats.faces, "{stats:?}");
    assert!(stats.depth_max < 1000, "{stats:?}");
    validate(&sphere, BuildOptions::DEFAULT);
}

/// By their own planes in input order, parallel squares make a linked list.
#[test]
fn a_list_of_10_000_nodes_is_built_ordered_validated_and_dropped_on_a_small_stack() {
    let chain = scene::chain(10_000);
    let options = BuildOptions::DEFAULT.with_heuristic(Heuristic::First);
    let stats = go_through(&chain, options.clone());
    enough!(stats.depth_max >= 9_999; "{stats:?}");
    validate(&scene::chain(3_000), options);
}

#[test]
fn a_convex_sphere_by_its_own_planes_is_a_list_that_needs_a_small_stack() {
    let sphere = scene::sphere(6_000);
    let stats = go_through(&sphere, BuildOptions::DEFAULT.with_heuristic(Heuristic::First));
    assert_eq!(stats.fragments, stats.faces);
    assert!(stats.depth_max + 2 >= stats.nodes, "{stats:?}");
}

/// Squares in one plane, side by side.
pub(crate) fn mosaic(across: u32) -> Scene {
    let square = |i: u32| {
        let at = [f64::from(i % across), f64::from(i / across)];
        rectangle(at, at.map(|c| c + 1.0), 0.5)
    };
    scene_of("mosaic", (0..across * across).map(square))
}

/// Squares in one plane, each inside the square before.
fn nested(count: u32) -> Scene {
    let half = |i: u32| f64::from(count - i);
    scene_of("nested", (0..count).map(|i| rectangle([-half(i); 2], [half(i); 2], 1.0)))
}

/// Random squares that overlap, or triangles, in a tilted plane that contains all corners exactly.
fn tilted(count: usize, are_squares: bool) -> Scene {
    let mut dice = Dice(count as u64);
    let mut place = |most: u32| [0; 2].map(|_| dice.around_zero(most));
    let tilt = |[x, y]: [f64; 2]| DVec3::new(x, y, x + 2.0 * y);
    let polygon = || {
        if !are_squares {
            return [0; 3].map(|_| tilt(place(40))).to_vec();
        }
        let [x, y] = place(1500);
        [[x, y], [x + 40.0, y], [x + 40.0, y + 40.0], [x, y + 40.0]].map(tilt).to_vec()
    };
    let has_area = |p: &Vec<DVec3>| (p[1] - p[0]).cross(p[2] - p[0]) != DVec3::ZERO;
    scene_of("tilted", std::iter::repeat_with(polygon).filter(has_area).take(count))
}

fn assert_input_order(scene: &Scene, options: BuildOptions) {
    let tree = options.build(scene.polygons()).unwrap();
    assert_eq!((tree.len(), tree.stats().nodes), (scene.len(), 1), "{options:?}");
    assert_eq!(tree.validate(), Ok(()));
    for z in [9.0, -9.0] {
        let order = tree.back_to_front(Viewpoint::eye([0.3, 0.2, z])).map(|f| f.polygon());
        assert!(order.eq(0..scene.len()), "{options:?}");
    }
}

#[test]
fn coplanar_polygons_share_one_node() {
    for &heuristic in Heuristic::ALL {
        let options = BuildOptions::DEFAULT.with_heuristic(heuristic);
        assert_input_order(&nested(10_000), options.clone());
        for (count, are_squares) in
            [(3, false), (30, false), (300, false), (450, true), (500, true), (5000, true)]
        {
            assert_input_order(&tilted(count, are_squares), options.clone().with_tolerance(0.0));
        }
    }
    let mosaic = mosaic(200);
    assert_eq!(BspTree::build(mosaic.polygons()).unwrap().validate(), Ok(()));
    for heuristic in [Heuristic::First, Heuristic::Sampled { candidates: 16 }] {
        assert_input_order(&mosaic, BuildOptions::DEFAULT.with_heuristic(heuristic));
    }
}

/// Their vertices are far more than those of the pieces that are left: they are removed while small sets are divided.
#[test]
fn polygons_of_many_corners_are_cut_as_often_as_polygons_of_few() {
    let discs = |corners: usize| {
        let mut dice = Dice(7);
        let mut disc = || {
            let turn = rotation(dice.point(-3.0, 3.0).to_array());
            regular(corners, turn, dice.point(-1.5, 1.5))
        };
        scene_of("discs", std::iter::repeat_with(&mut disc).take(200))
    };
    let [few, many] = [18, 150].map(|corners| {
        let tree = BspTree::build(discs(corners).polygons()).unwrap();
        assert_eq!(tree.validate(), Ok(()), "{corners} corners");
        tree.len()
    });
    assert!(few > 3000 && many < few + few / 8, "{few} and {many} fragments");
}

#[test]
fn a_hundred_thousand_duplicates_share_one_node() {
    let scene = scene_of("duplicates", (0..LARGE).map(|_| [DVec3::ZERO, DVec3::X, DVec3::ONE]));
    for &heuristic in Heuristic::ALL {
        let tree = BuildOptions::DEFAULT.with_heuristic(heuristic).build(scene.polygons()).unwrap();
        assert_eq!((tree.len(), tree.stats().nodes), (LARGE as usize, 1), "{heuristic}");
        for viewpoint in [Viewpoint::eye([0.3, 0.2, 4.0]), Viewpoint::direction([0.0, 0.1, 1.0])] {
            let order = tree.back_to_front(viewpoint).map(|f| f.polygon());
            assert!(order.eq(0..LARGE as usize), "{heuristic}");
        }
    }
}

#[test]
fn coplanar_crowds_across_another_crowd_stay_shallow() {
    // Two crossing planes full of squares: each piece is cut at most once.
    let mut scene = mosaic(100);
    for i in 0..10_000u32 {
        let (y, z) = (f64::from(i % 100), f64::from(i / 100) - 50.0);
        let corner = |u: f64, v: f64| DVec3::new(50.5, y + u, z + v);
        scene.push([corner(0.0, 0.0), corner(1.0, 0.0), corner(1.0, 1.0), corner(0.0, 1.0)], 0);
    }
    let stats = go_through(&scene, BuildOptions::DEFAULT);
    assert!(stats.fragments <= 20_100, "{stats:?}");
    assert_shallow(&stats);
}

fn error(scene: &Scene, options: BuildOptions) -> Error {
    with_a_small_stack(|| options.build(scene.polygons()).expect_err("over budget"))
}

#[test]
fn budgets_end_in_errors_that_say_the_limit() {
    let crowd = scene::random_triangles(2200, 5);
    for &heuristic in Heuristic::ALL {
        let options = BuildOptions::DEFAULT.with_heuristic(heuristic);
        for limit in [0, 1, 2199, 2500] {
            let error = error(&crowd, options.clone().with_max_fragments(limit));
            assert!(
                error.kind() == ErrorKind::OverBudget
                    && error.to_string().contains(&limit.to_string())
            );
        }
        for limit in [0, 1, 5] {
            let error = error(&crowd, options.clone().with_max_depth(limit));
            assert!(
                error.kind() == ErrorKind::OverBudget
                    && error.to_string().contains(&limit.to_string())
            );
        }
    }
    let list = BuildOptions::DEFAULT.with_heuristic(Heuristic::First).with_max_depth(1000);
    assert!(error(&scene::chain(10_000), list).kind() == ErrorKind::OverBudget);
}

#[test]
fn a_budget_that_just_suffices_is_no_error() {
    let crowd = scene::random_triangles(300, 5);
    for &heuristic in Heuristic::ALL {
        let options = BuildOptions::DEFAULT.with_heuristic(heuristic);
        let stats = options.build(crowd.polygons()).unwrap().stats();
        let exact = options.with_max_fragments(stats.fragments).with_max_depth(stats.depth_max);
        assert_eq!(exact.build(crowd.polygons()).unwrap().stats(), stats, "{heuristic}");
        for less in [
            exact.clone().with_max_fragments(stats.fragments - 1),
            exact.with_max_depth(stats.depth_max - 1),
        ] {
            assert!(less.build(crowd.polygons()).is_err(), "{heuristic}");
        }
    }
}

#[test]
fn a_tree_of_nothing_needs_no_depth() {
    let options = BuildOptions::DEFAULT.with_max_depth(0);
    let flat = [DVec3::X, DVec3::X, DVec3::Y];
    for polygons in [vec![], vec![flat]] {
        let tree = options.build(polygons).unwrap();
        assert!(tree.is_empty() && tree.stats().depth_max == 0);
    }
    assert!(
        options.build([[DVec3::X, DVec3::Y, DVec3::Z]]).unwrap_err().kind()
            == ErrorKind::OverBudget
    );
}
