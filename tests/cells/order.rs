//! Checks with rays in big integers that the orders of cells, one after the other, are an order of the scene.

use crate::cells::polygons::{stars, tiles, triangles};
use proptest::prelude::*;
use testkit::cell_orders::{Score, judge, places, shoot};
use testkit::divided::Divided;
use testkit::prelude::*;
use testkit::rays::{Ray, Rays};
use testkit::views::View;

#[test]
fn triangles_tiles_and_stars_come_far_before_near() {
    let mut total = Score::default();
    for cells in 1..10 {
        let mut dice = Dice(cells as u64);
        for polygons in [triangles(&mut dice, 24, 40), tiles(&mut dice, 40), stars(&mut dice, 6)] {
            let exact = BuildOptions::DEFAULT.with_tolerance(0.0);
            let scene = Divided::new(polygons, exact, cells).unwrap();
            judge(&scene, 77 + cells as u64, 12, &mut total)
                .unwrap_or_else(|what| panic!("{cells} cells: {what}"));
        }
    }
    assert_eq!(total.excused, 0);
    enough!(total.pairs > 10_000, total.apart > 5_000, total.coplanar > 50; "{total:?}");
}

#[test]
fn hard_scenes_come_far_before_near() {
    let cases = (hard::scene(), 1..10_usize, any::<u64>());
    let total = tally(file!(), 100, cases, |total: &mut Score, (scene, cells, seed)| {
        let options = scene.options(Heuristic::default());
        let divided = Divided::new(scene.polygons, options, cells).expect("a tree of each");
        judge(&divided, seed, 4, total).map_err(fail)
    });
    enough!(total.scenes >= 100, total.pairs > 3_000, total.apart > 500; "{total:?}");
    enough!(total.empty_cells > 20; "{total:?}");
    // The tolerance excuses few pairs, even of pairs in different cells.
    assert!(total.excused * 50 < total.apart, "{total:?}");
}

/// The judge finds a reversed order of cells.
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
