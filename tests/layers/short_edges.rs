//! Pieces with an edge so short that rounding decides its direction.

use super::oracle::{Truth, number};
use super::{Given, camera, outlines, page_on};
use binspace::glam::DMat4;
use testkit::prelude::*;
use testkit::rational::exact;

/// Cards around one point, which is a corner of some cards and on an edge of others. The screen is far from
/// the origin, so cuts miss the point by a rounding error.
fn cards(dice: &mut Dice, off: f64) -> Vec<Given> {
    let mut between = |low: f64, high: f64| low + (high - low) * dice.share();
    let pivot = dvec3(between(0.0, 100.0), between(0.0, 100.0), between(0.0, 100.0));
    let place =
        DMat4::from_translation(dvec3(off, off, 0.0)) * camera() * DMat4::from_translation(pivot);
    let mut card = |k: usize| {
        let turn = DMat4::from_rotation_z(between(0.0, 6.3))
            * DMat4::from_rotation_y(between(0.0, 6.3))
            * DMat4::from_rotation_x(between(0.0, 6.3));
        let (width, height) = (between(50.0, 300.0), between(50.0, 300.0));
        let low = if k.is_multiple_of(2) { 0.0 } else { -height };
        Given { rect: [[0.0, low], [width, height]], matrix: place * turn }
    };
    (0..6).map(&mut card).collect()
}

/// The layer nearest to the viewer at a point, by exact depths; `None` too near to an edge or another layer.
fn nearest(truths: &[Truth], at: DVec2) -> Option<Option<usize>> {
    let mut best: Option<(f64, usize)> = None;
    for (layer, truth) in truths.iter().enumerate() {
        let Some((local, depth)) = truth.seen_at(&at.to_array().map(exact)) else { continue };
        let (inside, depth) = (truth.inside(&local), number(&depth));
        if inside < -1e-5 {
            continue;
        }
        if inside < 1e-5 || best.is_some_and(|(other, _)| (depth - other).abs() < 1e-3) {
            return None;
        }
        if best.is_none_or(|(other, _)| depth > other) {
            best = Some((depth, layer));
        }
    }
    Some(best.map(|(_, layer)| layer))
}

#[test]
fn a_hit_does_not_look_through_a_piece_with_a_very_short_edge() {
    let off = 1e6;
    let mut dice = Dice(81);
    let (mut short, mut judged) = (0, 0);
    for _ in 0..60 {
        let given = cards(&mut dice, off);
        let truths: Vec<Truth> = given.iter().map(Given::truth).collect();
        let page = page_on(
            [[off, off], [off + 1920.0, off + 1080.0]],
            true,
            given.iter().map(Given::layer),
        );
        for (_, outline) in outlines(&page) {
            let next = outline.iter().cycle().skip(1);
            if !outline.iter().zip(next).any(|(a, b)| a.distance(*b) < 1e-8) {
                continue;
            }
            short += 1;
            let middle = outline.iter().sum::<DVec2>() / outline.len() as f64;
            for corner in &outline {
                for share in [0.1, 0.4, 0.7] {
                    let at = middle.lerp(*corner, share);
                    let Some(expected) = nearest(&truths, at) else { continue };
                    assert_eq!(page.hit(at.to_array()).map(|hit| hit.0), expected, "{at}");
                    judged += 1;
                }
            }
        }
    }
    assert!(short > 50 && judged > 500, "{short} {judged}");
}
