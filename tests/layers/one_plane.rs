//! Layers of one matrix lie in one plane, and come in the order of the list.

use super::oracle::{Truth, covers, number};
use super::{Given, Rect, VIEWPORT, order, outlines, page_on, wild};
use binspace::glam::DMat4;
use binspace::layers::{Layer, Layers};
use testkit::prelude::*;
use testkit::rational::exact;

/// A camera a thousand pixels in front of a page of 640 × 480.
fn camera() -> DMat4 {
    let mut perspective = DMat4::IDENTITY;
    perspective.z_axis.w = -1.0 / 1000.0;
    DMat4::from_translation(dvec3(320.0, 240.0, 0.0)) * perspective
}

fn page(is_clipped: bool, rects: &[Rect], matrix: DMat4) -> Layers {
    let layers = rects.iter().map(|&rect| Layer::new(rect, matrix));
    page_on([[0.0, 0.0], [640.0, 480.0]], is_clipped, layers)
}

/// The plane of the card, extended over the floor, has the rounding error of the card's corners times the
/// ratio of both sizes.
#[test]
fn a_card_on_a_floor_that_reaches_behind_the_eye_does_not_cut_it() {
    for (down, along) in [(100.0, -900.0), (100.0, 0.0), (200.0, 100.0), (300.0, 500.0)] {
        let matrix =
            camera() * DMat4::from_translation(dvec3(0.0, down, 0.0)) * DMat4::from_rotation_x(1.5);
        let card = [[100.0, along], [193.0, along + 219.0]];
        let floor = [[-2000.0, -2000.0], [2000.0, 2000.0]];
        assert_eq!(order(&page(false, &[card, floor], matrix)), [0, 1]);
        assert_eq!(order(&page(false, &[floor, card], matrix)), [0, 1]);
    }
}

/// After clipping, the floor still reaches a million times the size of the viewport into the depth.
#[test]
fn a_floor_that_nearly_passes_through_the_eye_covers_a_card_listed_before_it() {
    let floor = DMat4::from_cols_array(&[
        1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, -1.0, 0.0, 0.0, 0.0, 0.01, 0.0, 1.0,
    ]);
    let card = [[0.18, 999.333333], [0.193333, 999.714286]];
    let page = page(true, &[card, [[-1000.0, -1000.0], [1000.0, 1000.0]]], camera() * floor);
    assert_eq!(order(&page), [0, 1]);
    assert_eq!(page.hit([619.9998, 256.0824]).map(|(layer, _)| layer), Some(1));
}

/// A matrix of a floor that passes near the eye, or of any plane.
fn matrix(dice: &mut Dice) -> DMat4 {
    if dice.below(3) == 0 {
        return wild(dice).matrix;
    }
    let mut between = |low: f64, high: f64| low + (high - low) * dice.share();
    let down = 10f64.powf(between(-4.0, 2.5));
    super::camera()
        * DMat4::from_translation(dvec3(0.0, down, between(-300.0, 300.0)))
        * DMat4::from_rotation_x(std::f64::consts::FRAC_PI_2 + between(-0.1, 0.1))
        * DMat4::from_rotation_z(between(-1.0, 1.0))
}

/// Rectangles of every size and shape, some of each matrix.
fn layers(dice: &mut Dice) -> Vec<Given> {
    let matrices: Vec<DMat4> = (0..1 + dice.below(3)).map(|_| matrix(dice)).collect();
    let count = 3 + dice.below(6);
    let layer = |_| {
        let matrix = matrices[dice.below(matrices.len())];
        let mut between = |low: f64, high: f64| low + (high - low) * dice.share();
        let half = DVec2::new(1.0, 10f64.powf(between(-1.0, 1.0))) * 10f64.powf(between(-1.0, 3.5));
        let middle = DVec2::new(between(-900.0, 900.0), between(-900.0, 900.0));
        Given { rect: [(middle - half).to_array(), (middle + half).to_array()], matrix }
    };
    (0..count).map(layer).collect()
}

/// A point of the screen where two rectangles of one matrix overlap, well inside both.
fn overlap(dice: &mut Dice, [a, b]: [&Given; 2], [one, other]: [&Truth; 2]) -> Option<DVec2> {
    let low = DVec2::from(a.rect[0]).max(b.rect[0].into());
    let high = DVec2::from(a.rect[1]).min(b.rect[1].into());
    let local = low + (high - low) * DVec2::new(dice.share(), dice.share());
    if !low.cmplt(high).all() {
        return None;
    }
    let [x, y, _, w] = one.homogeneous(&local.to_array().map(exact));
    if number(&w) < 1e-6 {
        return None;
    }
    let at = DVec2::new(number(&(x / &w)), number(&(y / &w)));
    let is_inside = |truth: &Truth| {
        let seen = truth.seen_at(&at.to_array().map(exact));
        seen.is_some_and(|(local, _)| truth.inside(&local) > 1e-3)
    };
    (is_inside(one) && is_inside(other)).then_some(at)
}

#[test]
fn layers_of_one_matrix_come_in_the_order_of_the_list() {
    let mut dice = Dice(71);
    let mut judged = [0; 2];
    for round in 0..240 {
        let is_clipped = round % 2 == 0;
        let given = layers(&mut dice);
        let truths: Vec<Truth> = given.iter().map(Given::truth).collect();
        let page = page_on(VIEWPORT, is_clipped, given.iter().map(Given::layer));
        let pieces = outlines(&page);
        for (a, b) in (0..given.len()).flat_map(|b| (0..b).map(move |a| (a, b))) {
            if given[a].matrix != given[b].matrix {
                continue;
            }
            for _ in 0..4 {
                let pair = [&given[a], &given[b]];
                let Some(at) = overlap(&mut dice, pair, [&truths[a], &truths[b]]) else { continue };
                let place = |layer: usize| {
                    let covers = |(of, outline): &(usize, Vec<DVec2>)| {
                        *of == layer && covers(outline, at, &at.to_array().map(exact))
                    };
                    pieces.iter().position(covers)
                };
                // The point is outside the viewport, or on a cut.
                let (Some(first), Some(second)) = (place(a), place(b)) else { continue };
                assert!(first < second, "{b} before {a} at {at} in round {round}");
                judged[usize::from(is_clipped)] += 1;
            }
        }
    }
    assert!(judged[0] > 600 && judged[1] > 100, "{judged:?}");
}

/// A layer in the plane of other layers is cut where the others are not. At a cut, the place in the rectangle
/// must match the place on the screen.
#[test]
fn cut_layers_of_one_matrix_know_their_places() {
    let mut dice = Dice(72);
    let mut inner = 0;
    for _ in 0..120 {
        let tilt = |dice: &mut Dice| {
            DMat4::from_rotation_y(1.6 * dice.share() - 0.8)
                * DMat4::from_rotation_x(1.6 * dice.share() - 0.8)
        };
        let (plane, others) = (camera() * tilt(&mut dice), [(); 2].map(|()| tilt(&mut dice)));
        let mut rect = |size: f64| {
            let low = [(); 2].map(|()| -size * dice.share());
            [low, low.map(|low| low + size)]
        };
        let mut layers = vec![
            Given { rect: rect(200.0), matrix: plane },
            Given { rect: rect(50.0), matrix: plane },
        ];
        let across = DMat4::from_rotation_y(1.2);
        layers.extend(
            others.map(|turn| Given { rect: rect(150.0), matrix: camera() * turn * across }),
        );
        let page = page_on([[0.0, 0.0], [640.0, 480.0]], true, layers.iter().map(Given::layer));
        for piece in page.back_to_front() {
            let truth = layers[piece.layer()].truth();
            for (vertex, is_own) in piece.vertices().zip(piece.edges()) {
                let [x, y, z, w] = truth.homogeneous(&vertex.local.to_array().map(exact));
                let seen = [x, y, z].map(|c| number(&(c / &w)));
                let off = (dvec3(seen[0], seen[1], seen[2]) - vertex.position).length();
                assert!(off < 1e-9, "{off} {vertex:?}");
                assert!((vertex.w - number(&w)).abs() < 1e-12);
                inner += usize::from(!piece.is_whole() && is_own.is_none());
            }
        }
    }
    assert!(inner > 300, "{inner}");
}

/// The plane of a strip is uncertain in the direction of its width, so it misses the other strip.
#[test]
fn strips_of_one_matrix_that_cross_are_not_cut() {
    let mut dice = Dice(103);
    for _ in 0..100 {
        let mut between = |low: f64, high: f64| low + (high - low) * dice.share();
        let (x, z) = (between(-1.0, 1.0), between(-3.0, 3.0));
        let matrix = camera() * DMat4::from_rotation_x(x) * DMat4::from_rotation_z(z);
        let strips = [[[-300.0, -1e-8], [300.0, 1e-8]], [[-1e-8, -300.0], [1e-8, 300.0]]];
        for is_clipped in [true, false] {
            assert_eq!(order(&page(is_clipped, &strips, matrix)), [0, 1], "{x} {z}");
        }
    }
}
