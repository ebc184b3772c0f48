//! The orders of cells, one after the other, are an order of the scene: held against rays, in big
//! integers.

use proptest::prelude::*;
use proptest::test_runner::{Config, RngAlgorithm, TestRng, TestRunner};
use testkit::effort::times;
use testkit::enough;

use binspace::BuildOptions;
use binspace::glam::DVec3;

use crate::cells::polygons::{stars, tiles, triangles};
use testkit::cell_orders::{Score, judge, places, shoot};
use testkit::dice::Dice;
use testkit::divided::Divided;
use testkit::hard;
use testkit::rays::{Ray, Rays};
use testkit::shapes::Corners;
use testkit::views::View;

fn judged(polygons: Vec<Corners>, tolerance: Option<f64>, cells: usize, seed: u64) -> Score {
    let mut score = Score::default();
    let mut options = BuildOptions::DEFAULT;
    if let Some(length) = tolerance {
        options = options.with_tolerance(length);
    }
    let scene = Divided::new(polygons, options, cells).unwrap();
    judge(&scene, seed, 12, &mut score).unwrap_or_else(|what| panic!("{cells} cells: {what}"));
    score
}

#[test]
fn triangles_tiles_and_stars_come_far_before_near() {
    let mut total = Score::default();
    for cells in 1..10 {
        let mut dice = Dice(cells as u64);
        for polygons in [triangles(&mut dice, 24, 40), tiles(&mut dice, 40), stars(&mut dice, 6)] {
            let score = judged(polygons, Some(0.0), cells, 77 + cells as u64);
            total.pairs += score.pairs;
            total.apart += score.apart;
            total.coplanar += score.coplanar;
            total.excused += score.excused;
        }
    }
    assert_eq!(total.excused, 0);
    enough!(total.pairs > 10_000, total.apart > 5_000, total.coplanar > 50; "{total:?}");
}

#[test]
fn hard_scenes_come_far_before_near() {
    // The bounds below are of these very scenes.
    let rng = TestRng::deterministic_rng(RngAlgorithm::ChaCha);
    let mut runner = TestRunner::new_with_rng(Config { cases: 100, ..Config::default() }, rng);
    let total = std::cell::RefCell::new(Score::default());
    let scenes = (hard::scene(), 1..10_usize, any::<u64>());
    let judged = runner.run(&scenes, |(scene, cells, seed)| {
        let mut options = BuildOptions::DEFAULT;
        if let Some(length) = scene.tolerance() {
            options = options.with_tolerance(length);
        }
        let divided = Divided::new(scene.polygons, options, cells).expect("a tree of each");
        let verdict = judge(&divided, seed, 4, &mut total.borrow_mut());
        prop_assert!(verdict.is_ok(), "{}", verdict.unwrap_err());
        Ok(())
    });
    judged.unwrap();
    let total = total.into_inner();
    assert!(total.scenes == 100 && total.pairs > 3_000 && total.apart > 500, "{total:?}");
    enough!(total.empty_cells > 20; "{total:?}");
    // What the tolerance excuses is the exception, also of pairs in different cells.
    assert!(total.excused * 50 < total.apart, "{total:?}");
}

/// An order of cells that is the wrong way round is found.
#[test]
fn the_judge_sees_a_wrong_order_of_cells() {
    let scene =
        Divided::new(triangles(&mut Dice(3), 30, 40), BuildOptions::DEFAULT.with_tolerance(0.0), 5);
    let scene = scene.unwrap();
    let mut rays: Vec<Rays<'_>> = scene.cells.iter().map(|cell| Rays::new(&cell.tree)).collect();
    let (mut dice, mut wrong) = (Dice(9), 0);
    for _ in 0..times(10) {
        let view = View::direction(DVec3::new(0.3, 0.2 + dice.share(), 0.5));
        let mut places = places(&scene, view.viewpoint).unwrap();
        let first: Vec<usize> =
            places.iter().map(|cell| cell.iter().copied().min().unwrap()).collect();
        let all = scene.fragments();
        for (cell, first) in places.iter_mut().zip(first) {
            let len = cell.len();
            cell.iter_mut().for_each(|place| *place = *place - first + (all - first - len));
        }
        for _ in 0..20 {
            let target = rays[dice.below(5)].some_point(&mut dice);
            let Some(ray) = Ray::through(target, &view) else { continue };
            wrong += usize::from(
                shoot(&scene, &mut rays, &ray, &places, &mut Score::default()).is_err(),
            );
        }
    }
    enough!(wrong > 50; "{wrong}");
}
