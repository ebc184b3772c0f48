//! The conventions, on examples drawn by hand.

use super::{Rect, VIEWPORT, camera, order, page_on};
use binspace::glam::DMat4;
use binspace::layers::{Layer, Layers, about, perspective};
use std::f64::consts::FRAC_PI_2;
use testkit::prelude::*;

/// Half sides 100 and 60.
const CARD: Rect = [[-100.0, -60.0], [100.0, 60.0]];

fn page(layers: &[Layer]) -> Layers {
    page_on(VIEWPORT, true, layers.iter().cloned())
}

/// The eye is 1200 pixels in front of (960, 540). A card 600 in front of the screen appears twice as large. A
/// card 1200 behind the screen appears half as large.
#[test]
fn x_runs_right_y_down_and_z_towards_the_viewer() {
    let at = |z: f64| Layer::new(CARD, camera() * DMat4::from_translation(dvec3(30.0, 15.0, z)));
    let page = page(&[at(600.0), at(-1200.0), at(0.0)]);
    assert_eq!(order(&page), [1, 2, 0]);
    let corners = |k: usize| -> Vec<DVec2> {
        page.back_to_front().nth(k).unwrap().vertices().map(|v| v.position.truncate()).collect()
    };
    // Clockwise from the top left, as (u, v) runs.
    let expected = |x: f64, y: f64, w: f64, h: f64| {
        let (low, high) =
            (dvec2(960.0 + x - w, 540.0 + y - h), dvec2(960.0 + x + w, 540.0 + y + h));
        [low, dvec2(high.x, low.y), high, dvec2(low.x, high.y)]
    };
    let near = |found: &[DVec2], wanted: [DVec2; 4]| {
        found.len() == 4 && found.iter().zip(wanted).all(|(a, b)| (a - b).length() < 1e-9)
    };
    assert!(near(&corners(0), expected(15.0, 7.5, 50.0, 30.0)), "{:?}", corners(0));
    assert!(near(&corners(1), expected(30.0, 15.0, 100.0, 60.0)));
    assert!(near(&corners(2), expected(60.0, 30.0, 200.0, 120.0)));
    let nearest = page.back_to_front().next_back().unwrap();
    for (vertex, local) in nearest.vertices().zip([[-100.0, -60.0], [100.0, -60.0]]) {
        assert_eq!((vertex.w, vertex.local.to_array()), (0.5, local));
        // z/w = 600/0.5.
        assert!((vertex.position.z - 1200.0).abs() < 1e-9);
        let h = vertex.homogeneous();
        assert!((h.w, h.z) == (0.5, 600.0) && (h.x / h.w - vertex.position.x).abs() < 1e-9);
        assert_eq!(vertex.perspective(), DVec3::new(2.0 * local[0], 2.0 * local[1], 2.0));
    }
    assert_eq!(nearest.edges().collect::<Vec<_>>(), [Some(0), Some(1), Some(2), Some(3)]);
    // The point below and to the right of the card's middle is further along u and v.
    let (layer, [u, v]) = page.hit([1030.0, 580.0]).unwrap();
    assert!(layer == 0 && (u - 5.0).abs() < 1e-9 && (v - 5.0).abs() < 1e-9);
    // No layer is left of the nearest card.
    assert_eq!(page.hit([815.0, 540.0]), None);
}

/// Also without perspective, the right side of a card turned by rotateY(60°) is away from the viewer. So a
/// flat card covers the turned card on the right, and is covered by it on the left.
#[test]
fn a_card_turned_about_y_shows_its_left_half() {
    let middle = DMat4::from_translation(dvec3(960.0, 540.0, 0.0));
    let turned = middle * DMat4::from_rotation_y(60f64.to_radians());
    let page = page(&[Layer::new(CARD, middle), Layer::new(CARD, turned)]);
    assert_eq!((page.len(), page.visible()), (3, 2));
    let above = |x: f64| page.hit([x, 540.0]).unwrap();
    assert_eq!([930.0, 955.0, 965.0, 990.0].map(|x| above(x).0), [1, 1, 0, 0]);
    assert!((above(930.0).1[0] + 60.0).abs() < 1e-9);
    for piece in page.back_to_front() {
        let inner = piece.edges().filter(Option::is_none).count();
        assert_eq!(inner, usize::from(!piece.is_whole()));
    }
}

/// CSS: a page of 1920 by 1080 with `perspective: 1200px`, and in it a box of 200 by 120 at (300, 100), which
/// `rotateX(90deg)` lays down about its upper edge.
#[test]
fn matrices_agree_with_css() {
    let page = perspective(1200.0, [960.0, 540.0]);
    let from_the_middle = page * DMat4::from_translation(dvec3(960.0, 540.0, 0.0));
    assert!(from_the_middle.abs_diff_eq(camera(), 1e-9));
    let turned = about([100.0, 0.0], DMat4::from_rotation_x(FRAC_PI_2));
    let place = page * DMat4::from_translation(dvec3(300.0, 100.0, 0.0)) * turned;
    let shown = self::page(&[Layer::rect([200.0, 120.0], place)]);
    let piece = shown.back_to_front().next().unwrap();
    // The lower edge is 120 in front of the screen, where w is 0.9.
    let near = |x: f64, y: f64| [960.0 + (x - 960.0) / 0.9, 540.0 + (y - 540.0) / 0.9];
    let expected = [[300.0, 100.0], [500.0, 100.0], near(500.0, 100.0), near(300.0, 100.0)];
    let found = piece.vertices().map(|v| v.position.truncate());
    let off = found.zip(expected).map(|(found, expected)| found.distance(expected.into()));
    assert!(off.fold(0.0, f64::max) < 1e-9, "{:?}", piece.vertices().collect::<Vec<_>>());
}

#[test]
fn layers_in_one_plane_come_in_the_order_of_the_list_from_both_sides() {
    for turn in [0.0, 0.3, 2.0, 3.1] {
        let matrix = camera() * DMat4::from_rotation_y(turn);
        let badge = [[20.0, -50.0], [90.0, 10.0]];
        let page =
            page(&[Layer::new(CARD, matrix), Layer::new(badge, matrix), Layer::new(CARD, matrix)]);
        assert_eq!(order(&page), [0, 1, 2], "{turn}");
    }
}

/// A floor 500 pixels below the eye reaches from far behind the screen to far behind the eye. It fills the
/// lower part of the screen, up to the screen's border.
#[test]
fn a_floor_that_reaches_behind_the_eye_is_clipped() {
    let floor = [[-1e4, -1e4], [1e4, 1e4]];
    let lying = DMat4::from_translation(dvec3(0.0, 500.0, 0.0)) * DMat4::from_rotation_x(FRAC_PI_2);
    let page = page(&[Layer::new(floor, camera() * lying)]);
    let piece = page.back_to_front().next().unwrap();
    let ys: Vec<f64> = piece.vertices().map(|v| v.position.y).collect();
    // The floor's far edge is 10 000 behind the screen, so it appears 500 · 1200/11 200 below the middle.
    let top = ys.iter().copied().fold(f64::INFINITY, f64::min);
    assert!((top - 540.0 - 500.0 * 1200.0 / 11_200.0).abs() < 1e-3, "{top}");
    assert!((ys.iter().copied().fold(0.0, f64::max) - 1080.0).abs() < 1e-9);
    assert_eq!(piece.edges().filter(Option::is_none).count(), 3);
    assert!(piece.is_whole());
}

/// The same floor. Its horizon is 540 pixels down. Only its mirror image behind the eye would be above the
/// horizon.
#[test]
fn a_plane_is_seen_on_one_side_of_its_horizon() {
    let lying = DMat4::from_translation(dvec3(0.0, 500.0, 0.0)) * DMat4::from_rotation_x(FRAC_PI_2);
    let floor = Layer::new([[-1e4, -1e4], [1e4, 1e4]], camera() * lying);
    let [u, v] = floor.local([960.0, 1040.0]).unwrap();
    assert!(u.abs() < 1e-6 && v.abs() < 1e-3, "{u} {v}");
    assert_eq!(floor.local([960.0, 100.0]), None);
    let edge_on = camera() * DMat4::from_rotation_y(0.0) * DMat4::from_scale(dvec3(0.0, 1.0, 1.0));
    assert_eq!(Layer::new(CARD, edge_on).local([100.0, 100.0]), None);
}
