//! Trees whose small sets were divided after trials of subtrees.

use binspace::glam::{DQuat, DVec2, EulerRot};
use binspace::{BuildOptions, ErrorKind};
use testkit::judge::judge;
use testkit::prelude::*;
use testkit::snapshot::Snapshot;

#[test]
fn trees_are_exact_after_trials() {
    let strategy = (hard::scene(), 2..10_usize);
    let [trees, fewer] = tally(file!(), 192, strategy, |seen: &mut [usize; 2], (scene, planes)| {
        let options = scene.options(Heuristic::Auto);
        let tree = options.clone().with_trials(planes).build(&scene.polygons).map_err(fail)?;
        judge(&tree, &scene.polygons).map_err(fail)?;
        seen[0] += 1;
        seen[1] += usize::from(tree.len() < options.build(&scene.polygons).map_err(fail)?.len());
        Ok::<_, _>(())
    });
    enough!(trees > 150, fewer > 3; "{trees} {fewer}");
}

/// The more planes are tried, the fewer fragments: not in every scene, but in these.
#[test]
fn trials_cut_less() {
    let scenes =
        [scene::random_triangles(500, 4), scene::random_triangles(1500, 1), scene::teapot(12)];
    for scene in scenes {
        let fragments = [0, 1, 4, 16].map(|planes| {
            let options = BuildOptions::DEFAULT.with_trials(planes);
            let tree = options.build(scene.polygons()).expect("within budget");
            tree.validate().expect("a valid tree");
            tree.len() as f64 / scene.len() as f64
        });
        let [none, one, four, more] = fragments;
        assert!(
            none == one && four < 0.995 * none && more < four,
            "{}: {fragments:?}",
            scene.name()
        );
    }
}

/// Enough triangles for several jobs, small enough to cross only a few others.
#[test]
fn trials_give_the_same_tree_on_any_number_of_threads() {
    let triangles: Vec<[DVec3; 3]> = scene::random_triangles(6000, 2)
        .polygons()
        .map(|polygon| {
            let [a, b, c] = [0, 1, 2].map(|i| polygon.points()[i]);
            [a, a + 0.2 * (b - a), a + 0.2 * (c - a)]
        })
        .collect();
    let build = |planes: usize, threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
        let options = BuildOptions::DEFAULT.with_trials(planes);
        pool.install(|| options.build(&triangles)).expect("within budget")
    };
    let one = build(3, 1);
    assert!(one.len() > 9000 && one.len() < build(0, 1).len(), "{}", one.len());
    for threads in [2, 8] {
        assert!(Snapshot::of(&one) == Snapshot::of(&build(3, threads)), "{threads}");
    }
}

/// What trials cut does not count.
#[test]
fn a_budget_counts_the_tree_alone() {
    let scene = scene::random_triangles(400, 3);
    let options = BuildOptions::DEFAULT.with_trials(4);
    let len = options.build(scene.polygons()).expect("within budget").len();
    let options = options.with_max_fragments(len);
    assert_eq!(options.build(scene.polygons()).expect("within budget").len(), len);
    let error =
        options.with_max_fragments(len - 1).build(scene.polygons()).expect_err("over budget");
    assert_eq!(error.kind(), ErrorKind::OverBudget);
}

#[test]
fn trials_report_their_work_and_can_be_cancelled() {
    let scene = scene::random_triangles(400, 3);
    let calls = |planes: usize, most: usize| {
        let mut calls = 0;
        let options = BuildOptions::DEFAULT.with_trials(planes);
        let tree = options.build_with_progress(scene.polygons(), |_| {
            calls += 1;
            if calls < most { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
        });
        (calls, tree.map_err(|error| error.kind()).err())
    };
    let [(few, none), (many, done)] = [0, 64].map(|planes| calls(planes, usize::MAX));
    assert!(none.is_none() && done.is_none() && many > 4 * few, "{few} {many}");
    for at in [2 * few, many / 2] {
        assert_eq!(calls(64, at), (at, Some(ErrorKind::Cancelled)));
    }
}

/// Small cards on a square in `f32`, among triangles that cross all of them: wherever a card covers the square, it comes
/// after it.
#[test]
fn coplanar_polygons_keep_their_order_after_trials() {
    let (mut pairs, mut tried) = (0, 0);
    for seed in seeds(60) {
        let dice = &mut Dice(seed);
        let angles = dice.point(-3.0, 3.0);
        let turn = DQuat::from_euler(EulerRot::XYZ, angles.x, angles.y, angles.z);
        let at = |x: f64, y: f64| (turn * dvec3(x, y, 0.3)).as_vec3();
        let square = |x: f64, y: f64, size: f64| {
            [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]
                .map(|[u, v]| at(x + size * u, y + size * v))
                .to_vec()
        };
        let mut polygons = vec![square(-1.0, -1.0, 2.0)];
        for _ in 0..12 {
            polygons.push(square(
                dice.range(-0.9, 0.6),
                dice.range(-0.9, 0.6),
                dice.range(0.02, 0.3),
            ));
        }
        let cards = polygons.len();
        for _ in 0..25 {
            let middle = turn * dvec3(dice.range(-0.9, 0.9), dice.range(-0.9, 0.9), 0.3);
            polygons
                .push([(); 3].map(|()| (middle + 0.5 * dice.point(-1.0, 1.0)).as_vec3()).to_vec());
        }
        let options = BuildOptions::DEFAULT.with_trials(6);
        let tree = options.build(&polygons).expect("within budget");
        tried += usize::from(tree.len() != BspTree::build(&polygons).expect("within budget").len());
        let flat = |p: DVec3| (turn.inverse() * p).truncate();
        let outlines: Vec<Vec<DVec2>> =
            tree.fragments().map(|f| f.vertices().map(flat).collect()).collect();
        let inside = |outline: &[DVec2], p: DVec2| {
            let turns = (0..outline.len()).map(|i| {
                let (a, b) = (outline[i], outline[(i + 1) % outline.len()]);
                (b - a).perp_dot(p - a) / (b - a).length()
            });
            let (low, high) = turns.fold((f64::MAX, f64::MIN), |(l, h), t| (l.min(t), h.max(t)));
            low > 1e-4 || high < -1e-4
        };
        for z in [1.0, -1.0] {
            let order = tree.back_to_front(Viewpoint::direction(turn * dvec3(0.1, 0.2, z)));
            let mut rank = vec![0; tree.len()];
            order.enumerate().for_each(|(i, fragment)| rank[fragment.index() as usize] = i);
            for card in tree.fragments().filter(|f| (1..cards).contains(&f.polygon())) {
                let outline = &outlines[card.index() as usize];
                let middle = outline.iter().sum::<DVec2>() / outline.len() as f64;
                let under = tree.fragments().filter(|f| {
                    f.polygon() < card.polygon() && inside(&outlines[f.index() as usize], middle)
                });
                for other in under {
                    pairs += 1;
                    let [below, above] = [&other, &card].map(|f| rank[f.index() as usize]);
                    assert!(below < above, "{seed}: {} over {}", other.polygon(), card.polygon());
                }
            }
        }
    }
    enough!(pairs > 700, tried > 20; "{pairs} {tried}");
}
