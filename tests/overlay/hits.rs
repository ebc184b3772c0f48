//! Compares the hits of rays on a tree and an overlay with integers: every ray with every polygon.

use binspace::overlay::{Overlay, Shapes};
use binspace::{ErrorKind, Ray};
use proptest::prelude::*;
use testkit::hits::{Oracle, Score};
use testkit::prelude::*;
use testkit::scenes::polygons;
use testkit::shapes::rectangle;
use testkit::shots::Shots;

use super::{Divided, divide};

/// The score, the number of hits of the overlay's polygons, and how many of these hits are between two hits
/// of the tree's polygons.
#[derive(Debug, Default)]
struct Counts {
    score: Score,
    of_overlay: usize,
    between: usize,
}

#[test]
fn rays_agree_with_integers() {
    let cases = (hard::scene(), any::<u64>(), hard::heuristic(), any::<u64>());
    let counts = tally(file!(), 256, cases, |counts: &mut Counts, (scene, bits, by, seed)| {
        let Divided { tree, moving, all } = divide(&scene, bits, by)?;
        // Rays are aimed at polygons, and the judge has only polygons.
        let mut polygons = Overlay::new(&tree);
        polygons.replace(&tree, &moving).map_err(fail)?;
        if polygons.faces().is_empty() {
            return Ok(());
        }
        // Other contents come first, so that remains of them would be hit. Lines and points are never hit.
        let mut overlay = Overlay::new(&tree);
        overlay.replace(&tree, &all).map_err(fail)?;
        let _ = overlay.is_occluded(&tree, Ray::between(DVec3::ZERO, DVec3::ONE));
        let lines = moving.iter().chain(&all).take(9);
        let points = all.iter().take(9).map(|polygon| polygon[0]);
        let shapes = Shapes::NONE.with_polygons(&moving).with_lines(lines).with_points(points);
        overlay.replace_with(&tree, shapes).map_err(fail)?;
        let oracle = Oracle::with_overlay(&tree, &overlay, polygons.faces());
        let (shots, mut dice) = (Shots::new(polygons.faces()), Dice(seed));
        for _ in 0..50 {
            let ray = shots.ray(&mut dice);
            oracle.check(ray, &mut counts.score).map_err(fail)?;
            let hits = overlay.hits(&tree, ray).map_err(fail)?;
            let is_of_overlay =
                hits.map(|hit| hit.polygon() >= all.len() - moving.len()).collect::<Vec<_>>();
            counts.of_overlay += is_of_overlay.iter().filter(|&&is| is).count();
            counts.between +=
                is_of_overlay.windows(3).filter(|w| *w == [false, true, false]).count();
        }
        Ok(())
    });
    let Counts { score, of_overlay, between } = counts;
    enough!(score.rays > 10_000, score.hits > 10_000, of_overlay > 5000, between > 200; "{counts:?}");
    enough!(score.in_plane > 2000, score.ties > 2000, score.at_ends > 2000; "{counts:?}");
    assert!(score.blocked.min(score.clear) > 3000, "{counts:?}");
}

/// Thousands of pieces, so that boxes are grouped in boxes on several levels.
#[test]
fn rays_at_large_overlays_agree_with_integers() {
    let body = polygons(&scene::sphere(3000));
    let still = polygons(&scene::random_triangles(300, 8));
    let all: Vec<_> = still.iter().chain(&body).cloned().collect();
    let [low, high] = hard::bounds(&all).expect("corners");
    let tree = BuildOptions::DEFAULT.with_bounds(low, high).build(&still).expect("a tree");
    let mut overlay = Overlay::new(&tree);
    overlay.replace(&tree, &body).expect("in the grid");
    enough!(overlay.len() > 16 * 16 * 16; "{}", overlay.len());
    let oracle = Oracle::with_overlay(&tree, &overlay, overlay.faces());
    let (shots, mut dice, mut score) = (Shots::new(overlay.faces()), Dice(7), Score::default());
    for _ in 0..2000 {
        oracle.check(shots.ray(&mut dice), &mut score).expect("right");
    }
    enough!(score.hits > 2000, score.in_plane > 100, score.ties > 1000; "{score:?}");
}

/// At one point, the tree's polygons come before the overlay's polygons.
#[test]
fn ties_come_in_input_order() {
    let square = |z: f64| rectangle([0.0, 0.0], [4.0, 4.0], z);
    let tree = BspTree::build([square(0.0), square(1.0), square(0.0)]).unwrap();
    let mut overlay = Overlay::new(&tree);
    overlay.replace(&tree, [square(0.0), square(0.5), square(1.0)]).unwrap();
    let hits = |from: f64| -> Vec<usize> {
        let ray = Ray::between([1.0, 1.0, from], [1.0, 1.0, -from]);
        overlay.hits(&tree, ray).unwrap().map(|hit| hit.polygon()).collect()
    };
    assert_eq!(hits(9.0), [1, 5, 4, 0, 2, 3]);
    assert_eq!(hits(-9.0), [0, 2, 3, 4, 1, 5]);
    let ray = Ray::between([1.0, 1.0, 9.0], [1.0, 1.0, -9.0]);
    let hit = overlay.hits(&tree, ray).unwrap().nth(2).unwrap();
    assert_eq!((hit.polygon(), hit.point()), (4, DVec3::new(1.0, 1.0, 0.5)));
    assert_eq!(overlay.piece(hit.fragment().index()).unwrap().polygon(), 4);
}

#[test]
fn cleared_overlays_empty_trees_and_other_trees() {
    let square = |z: f64| rectangle([0.0, 0.0], [4.0, 4.0], z);
    let tree = BspTree::build([square(0.0), square(2.0)]).unwrap();
    let down = Ray::new([1.0, 1.0, 9.0], [0.0, 0.0, -1.0]);
    let near = Ray::between([1.0, 1.0, 1.5], [1.0, 1.0, 0.5]);
    let mut overlay = Overlay::new(&tree);
    let count = |overlay: &Overlay, tree: &BspTree| overlay.hits(tree, down).unwrap().count();
    assert_eq!(count(&overlay, &tree), 2);
    overlay.replace(&tree, [square(1.0)]).unwrap();
    assert_eq!(count(&overlay, &tree), 3);
    assert!(overlay.is_occluded(&tree, near).unwrap());
    overlay.replace(&tree, [square(0.25)]).unwrap();
    assert!(!overlay.is_occluded(&tree, near).unwrap(), "the boxes belong to the current pieces");
    overlay.clear();
    assert_eq!(count(&overlay, &tree), 2);
    let options = BuildOptions::DEFAULT.with_bounds(DVec3::ZERO, DVec3::splat(4.0));
    let empty = options.build::<[[f64; 3]; 3]>([]).unwrap();
    let mut alone = Overlay::new(&empty);
    alone.replace(&empty, [square(1.0), square(2.0)]).unwrap();
    assert!(alone.hits(&empty, down).unwrap().map(|hit| hit.polygon()).eq([1, 0]));
    let kinds = [alone.hits(&tree, down).err(), alone.is_occluded(&tree, down).err()];
    assert!(kinds.iter().all(|error| error.as_ref().unwrap().kind() == ErrorKind::OtherTree));
}
