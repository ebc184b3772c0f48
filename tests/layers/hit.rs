//! Layers under a point of the screen, near edges, and on a screen of another size.

use super::{Given, VIEWPORT, layers_of, outlines, page_on};
use binspace::glam::DMat4;
use binspace::layers::{Layer, Layers};
use testkit::pages::Page;
use testkit::prelude::*;

/// A rectangle far from its own origin, where (u, v) are rounded coarsely. A painted point is hit if its
/// distance from the edges is more than 10⁻⁹ of the viewport.
#[test]
fn a_point_beside_an_edge_is_hit_however_far_the_rectangle_is_from_its_origin() {
    let mut dice = Dice(51);
    let mut tried = 0;
    for exponent in [0, 6, 9, 11] {
        for _ in 0..200 {
            let origin = 10f64.powi(exponent) * (1.0 + dice.share());
            let matrix = DMat4::from_translation(dvec3(960.0, 540.0, 0.0))
                * DMat4::from_rotation_z(6.3 * dice.share())
                * DMat4::from_translation(dvec3(-origin, 0.0, 0.0));
            let layer = Layer::new([[origin, 0.0], [origin + 120.0, 80.0]], matrix);
            let page = page_on(VIEWPORT, true, [layer]);
            let piece = page.back_to_front().next().unwrap();
            let corners: Vec<DVec2> = piece.vertices().map(|v| v.position.truncate()).collect();
            for (k, &a) in corners.iter().enumerate() {
                let along = corners[(k + 1) % corners.len()] - a;
                // Points to the right of the edge, because y points down.
                let inwards = along.perp().normalize();
                let on_edge = a + along * (0.1 + 0.8 * dice.share());
                let beside = |distance: f64| (on_edge + inwards * distance).to_array();
                // 10⁻⁹ of 1920 is 1.92 · 10⁻⁶.
                assert_eq!(page.hit(beside(2e-6)).map(|hit| hit.0), Some(0), "10^{exponent}");
                assert_eq!(page.hit(beside(-2e-6)), None, "10^{exponent}");
                tried += 1;
            }
        }
    }
    enough!(tried > 3000; "{tried}");
}

/// A page that gets another viewport equals a page made for this viewport.
#[test]
fn another_viewport_makes_another_page() {
    let layers: Vec<Layer> = layers_of(Page::Carousel, 12, 3).iter().map(Given::layer).collect();
    let mut page = Layers::new(VIEWPORT);
    let mut seen = Vec::new();
    for viewport in [VIEWPORT, [[100.0, 100.0], [900.0, 500.0]], [[0.0, 0.0], [400.0, 1080.0]]] {
        page.set_viewport(viewport);
        assert!(page.is_empty() && page.visible() == 0 && page.hit([960.0, 540.0]).is_none());
        assert!(page.update(&layers).unwrap());
        // The same viewport again is no change.
        page.set_viewport(viewport);
        assert!(!page.update(&layers).unwrap());
        let mut new = Layers::new(viewport);
        new.update(&layers).unwrap();
        assert_eq!(outlines(&page), outlines(&new));
        assert!(!seen.contains(&outlines(&page)), "{viewport:?} shows nothing");
        seen.push(outlines(&page));
    }
}

/// A row through two corners of a diamond, and a row through its lowest corner.
#[test]
fn a_point_in_a_row_with_corners_is_hit_if_it_is_inside() {
    let mut diamond = DMat4::IDENTITY;
    (diamond.x_axis.y, diamond.y_axis.x) = (1.0, -1.0);
    let middle = DMat4::from_translation(dvec3(960.0, 540.0, 0.0));
    let page =
        page_on(VIEWPORT, true, [Layer::new([[-50.0, -50.0], [50.0, 50.0]], middle * diamond)]);
    // The corners of the diamond are 100 to the right, below, to the left and above.
    for x in [-99.0, -50.0, 0.0, 50.0, 99.0] {
        assert!(page.hit([960.0 + x, 540.0]).is_some(), "{x}");
    }
    for (x, y) in [(-101.0, 0.0), (101.0, 0.0), (-5.0, 100.0), (5.0, 100.0), (-5.0, -100.0)] {
        assert!(page.hit([960.0 + x, 540.0 + y]).is_none(), "{x} {y}");
    }
}

/// A card that another card cuts is hit once where its two pieces meet.
#[test]
fn a_layer_in_pieces_is_hit_once() {
    let middle = DMat4::from_translation(dvec3(960.0, 540.0, 0.0));
    let card = [[-50.0, -50.0], [50.0, 50.0]];
    let turned = |angle: f64| Layer::new(card, middle * DMat4::from_rotation_y(angle));
    let page = page_on(VIEWPORT, true, [turned(0.5), turned(-0.5)]);
    assert!(page.back_to_front().count() > 2, "no card is cut");
    for y in [-40.0, 0.0, 30.0] {
        let mut hits: Vec<usize> = page.hits([960.0, 540.0 + y]).map(|hit| hit.0).collect();
        hits.sort_unstable();
        assert_eq!(hits, [0, 1], "{y}");
    }
}
