//! Judges the order of pages at points of the screen, by the exact depths of the given layers.

use super::oracle::{Point2, Truth, covers, number};
use super::{Given, layers_of, order, outlines, page_of, wild};
use binspace::layers::Layers;
use testkit::pages::{Page, SCREEN};
use testkit::prelude::*;
use testkit::rational::exact;

/// Points nearer to an edge than this share of a layer are not judged. Depths that differ by less than this,
/// in pixels, are not judged either: the tolerance is 2·10⁻⁶ pixels, and steep layers magnify it.
const MARGIN: f64 = 1e-4;

#[derive(Default, Debug)]
struct Tally {
    compared: usize,
    coplanar: usize,
    hits: usize,
}

/// A layer's depth and place at a point that it covers; an error if the point is too near its edge.
fn depth(truth: &Truth, at: &Point2) -> Result<Option<(Point2, Rational)>, ()> {
    let Some((local, depth)) = truth.seen_at(at) else { return Ok(None) };
    match truth.inside(&local) {
        inside if inside > MARGIN => Ok(Some((local, depth))),
        inside if inside < -MARGIN => Ok(None),
        _ => Err(()),
    }
}

fn judge(given: &[Given], page: &Layers, points: usize, dice: &mut Dice, tally: &mut Tally) {
    let truths: Vec<Truth> = given.iter().map(Given::truth).collect();
    let outlines = outlines(page);
    assert_eq!(outlines.len(), page.len());
    'points: for _ in 0..points {
        // Half of the points are in the middle, where the layers are, and half are anywhere.
        let scale = if dice.below(2) == 0 { 1.0 } else { 0.4 };
        let screen = SCREEN.map(|side| side * (0.5 + scale * (dice.share() - 0.5)));
        let at = screen.map(exact);
        let mut depths = Vec::new();
        for truth in &truths {
            let Ok(depth) = depth(truth, &at) else { continue 'points };
            depths.push(depth);
        }
        let painted: Vec<usize> = outlines
            .iter()
            .filter(|(_, outline)| covers(outline, screen.into(), &at))
            .map(|&(layer, _)| layer)
            .collect();
        // Each layer once; fewer only if the point is on a cut.
        let mut layers = painted.clone();
        layers.sort_unstable();
        layers.dedup();
        let covering: Vec<usize> = (0..given.len()).filter(|&k| depths[k].is_some()).collect();
        assert_eq!(layers.len(), painted.len(), "painted twice");
        assert_eq!(layers, covering, "at {screen:?}");
        for pair in painted.windows(2) {
            let [far, near] = [pair[0], pair[1]].map(|k| &depths[k].as_ref().unwrap().1);
            let rise = number(&(near - far));
            if rise.abs() < 1e-6 {
                assert!(pair[0] < pair[1], "coplanar layers out of order: {pair:?}");
                tally.coplanar += 1;
            } else {
                assert!(rise > -MARGIN, "{rise} {pair:?} at {screen:?}");
                tally.compared += 1;
            }
        }
        let hits: Vec<(usize, [f64; 2])> = page.hits(screen).collect();
        let listed = hits.iter().rev().map(|&(layer, _)| layer);
        assert!(listed.eq(painted.iter().copied()), "{hits:?}, painted {painted:?}");
        assert_eq!(page.hit(screen), hits.first().copied());
        for (layer, local) in hits {
            let (exactly, _) = depths[layer].as_ref().unwrap();
            let off = (0..2).map(|k| number(&(&exactly[k] - exact(local[k])).abs()));
            assert!(off.fold(0.0, f64::max) < 1e-6);
            tally.hits += 1;
        }
    }
}

#[test]
fn pages_are_painted_by_depth() {
    let mut dice = Dice(21);
    for page in Page::ALL {
        let mut tally = Tally::default();
        for (count, seed) in [(12, 1), (12, 2), (30, 3), (30, 4), (60, 5)] {
            let count = if page == Page::Crossing { count.min(30) } else { count };
            let layers = layers_of(page, count, seed);
            let drawn = page_of(&layers);
            assert!(drawn.visible() <= count && drawn.len() >= drawn.visible());
            match page {
                // Layers that do not meet are not cut. This is known without reading any piece.
                Page::Stack => assert_eq!((drawn.len(), drawn.visible()), (count, count)),
                Page::Carousel | Page::Crossing => assert!(drawn.len() > drawn.visible()),
                Page::Cubes => assert_eq!(drawn.visible(), count),
            }
            judge(&layers, &drawn, times(30), &mut dice, &mut tally);
        }
        let Tally { compared, coplanar, hits } = tally;
        enough!(compared > 50, hits > 100; "{page:?} {tally:?}");
        assert!(coplanar > 10 || page != Page::Stack, "{coplanar}");
    }
}

#[test]
fn layers_that_reach_behind_the_eye_are_painted_by_depth() {
    let (mut dice, mut tally) = (Dice(22), Tally::default());
    for _ in 0..times(20) {
        let layers: Vec<Given> = (0..20).map(|_| wild(&mut dice)).collect();
        judge(&layers, &page_of(&layers), 20, &mut dice, &mut tally);
    }
    enough!(tally.compared > 120, tally.hits > 300; "{tally:?}");
}

#[test]
fn front_to_back_is_the_reverse() {
    let page = page_of(&layers_of(Page::Crossing, 12, 6));
    let mut forwards = order(&page);
    forwards.reverse();
    assert_eq!(page.back_to_front().rev().map(|piece| piece.layer()).collect::<Vec<_>>(), forwards);
    assert!(forwards.len() > 12 && page.back_to_front().len() == page.len());
}
