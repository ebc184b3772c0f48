//! Layers that are meant to be in one plane, and layers that pass near the eye.

use super::{Given, VIEWPORT, camera, layers_of, order, page_on};
use binspace::glam::{DMat4, Mat4, Quat, vec3};
use binspace::layers::Layer;
use testkit::pages::Page;
use testkit::prelude::*;

/// A page's camera, computed in `f32`, product by product.
fn single_camera() -> Mat4 {
    let mut perspective = Mat4::IDENTITY;
    perspective.z_axis.w = -1.0 / 1200.0;
    Mat4::from_translation(vec3(960.0, 540.0, 0.0)) * perspective
}

/// Each card has a separate matrix: the product of its place in a tilted plane and the matrix of the plane.
#[test]
fn forty_cards_put_into_one_tilted_plane_by_f32_matrices_stay_whole() {
    let mut dice = Dice(41);
    let mut rounded = 0;
    for _ in 0..times(60) {
        let mut turn = || 1.2 * (dice.share() as f32 - 0.5);
        let tilt = Quat::from_rotation_x(turn()) * Quat::from_rotation_y(turn());
        let plane = single_camera()
            * Mat4::from_rotation_translation(tilt, vec3(0.3, -7.7, -210.4) * turn());
        let matrices: Vec<Mat4> = (0..40)
            .map(|_| {
                let at = vec3(dice.share() as f32, dice.share() as f32, 0.5) * 700.0 - 350.0;
                plane * Mat4::from_translation(at) * Mat4::from_rotation_z(dice.share() as f32)
            })
            .collect();
        let card = [[0.0, 0.0], [120.3, 80.7]];
        let page = page_on(VIEWPORT, true, matrices.iter().map(|&m| Layer::from_f32(card, m)));
        assert_eq!((page.len(), page.visible()), (40, 40));
        assert_eq!(order(&page), (0..40).collect::<Vec<_>>());
        // As `f64` matrices, the same numbers are not in one plane, so the test is effective.
        let exact = matrices.iter().map(|m| Layer::new(card, m.as_dmat4()));
        let page = page_on(VIEWPORT, true, exact);
        rounded += usize::from(page.len() > 40 || order(&page) != (0..40).collect::<Vec<_>>());
    }
    enough!(rounded > 50; "{rounded}");
}

#[test]
fn cards_put_into_one_plane_by_f64_matrices_stay_whole() {
    let mut dice = Dice(42);
    for _ in 0..times(60) {
        let tilt = DMat4::from_rotation_x(1.4 * dice.share() - 0.7)
            * DMat4::from_rotation_y(1.4 * dice.share() - 0.7);
        let card = |_| {
            let at = dvec3(700.0 * dice.share() - 350.0, 700.0 * dice.share() - 350.0, 0.0);
            let turned = DMat4::from_rotation_z(dice.share());
            let matrix = camera() * tilt * DMat4::from_translation(at) * turned;
            Layer::new([[0.0, 0.0], [120.3, 80.7]], matrix)
        };
        let page = page_on(VIEWPORT, true, (0..40).map(card));
        assert_eq!(order(&page), (0..40).collect::<Vec<_>>());
    }
}

/// Layers a thousandth of a pixel apart keep their order beside a layer that passes through the eye.
#[test]
fn a_layer_through_the_eye_does_not_merge_thin_layers() {
    let card = [[-100.0, -60.0], [100.0, 60.0]];
    let at = |z: f64| Layer::new(card, camera() * DMat4::from_translation(dvec3(0.0, 0.0, z)));
    for tilt in [0.0, 1e-9, 1e-6, 1e-3] {
        // A wall along the line of sight, from far behind the screen to behind the eye.
        let wall = DMat4::from_rotation_y(std::f64::consts::FRAC_PI_2 + tilt);
        let wall = Layer::new([[-3000.0, 100.0], [3000.0, 200.0]], camera() * wall);
        for unclipped in [false, true] {
            let page = page_on(VIEWPORT, !unclipped, [wall.clone(), at(0.002), at(0.0), at(0.001)]);
            let reach = 1920.0 * f64::from(1 << 20);
            for vertex in page.back_to_front().flat_map(|piece| piece.vertices()) {
                assert!(vertex.position.z.abs() <= 1.001 * reach, "{tilt} {}", vertex.position);
            }
            // The wall may cut the cards. Then all parts on one side of the wall come first.
            let mut cards: Vec<usize> =
                order(&page).into_iter().filter(|&layer| layer > 0).collect();
            cards.dedup();
            let is_right = cards.chunks(3).all(|side| side == [2, 3, 1]);
            assert!(cards.len() >= 3 && is_right, "{tilt} {unclipped} {cards:?}");
        }
    }
}

/// A layer of `f32` whose rounding error near the eye is many pixels sets the tolerance, but to a hundredth
/// of a pixel at most.
#[test]
fn a_coarse_layer_through_the_eye_does_not_merge_layers_a_tenth_of_a_pixel_apart() {
    let card = [[-100.0, -60.0], [100.0, 60.0]];
    let at = |z: f64| Layer::new(card, camera() * DMat4::from_translation(dvec3(0.0, 0.0, z)));
    let wall = camera() * DMat4::from_rotation_y(1.5);
    let wall = Layer::from_f32([[-3000.0, 100.0], [3000.0, 200.0]], wall.as_mat4());
    let page = page_on(VIEWPORT, false, [wall, at(0.2), at(0.0), at(0.1)]);
    // The wall may cut the cards.
    let mut cards: Vec<usize> = order(&page).into_iter().filter(|&layer| layer > 0).collect();
    cards.dedup();
    let is_right = cards.chunks(3).all(|side| side == [2, 3, 1]);
    assert!(cards.len() >= 3 && is_right, "{cards:?}");
}

/// Cards in one plane keep the order of the document, although a floor reaches behind the eye.
#[test]
fn a_floor_behind_the_eye_does_not_exchange_cards_of_one_plane() {
    let mut compared = 0;
    for seed in seeds(200) {
        let mut dice = Dice(seed);
        let mut some = |size: f64| size * (dice.share() - 0.5);
        let turn = DMat4::from_rotation_x(some(1.6)) * DMat4::from_rotation_y(some(1.6));
        let plane = camera() * turn;
        let at = DMat4::from_translation(dvec3(0.0, 300.0 + some(100.0), some(200.0)));
        let floor = camera() * at * DMat4::from_rotation_x(1.5 + some(0.1));
        let cards: Vec<[[f64; 2]; 2]> = (0..12)
            .map(|_| {
                let [x, y] = [some(500.0), some(400.0)];
                [[x - 60.0, y - 40.0], [x + 60.0, y + 40.0]]
            })
            .collect();
        let mut layers = vec![Layer::new([[-3000.0; 2], [3000.0; 2]], floor)];
        layers.extend(cards.iter().map(|&card| Layer::new(card, plane)));
        // A small page: its least tolerance is small, but the grid is as coarse as for a large page.
        let page = page_on([[640.0, 360.0], [1280.0, 720.0]], false, layers.iter().cloned());
        for _ in 0..40 {
            let [x, y] = [some(600.0), some(480.0)];
            let has = |card: &[[f64; 2]; 2]| {
                let [[left, low], [right, high]] = *card;
                (left + 0.5..right - 0.5).contains(&x) && (low + 0.5..high - 0.5).contains(&y)
            };
            let Some(last) = cards.iter().rposition(has) else { continue };
            let on_screen = plane * dvec3(x, y, 0.0).extend(1.0);
            let found = page.hit([on_screen.x / on_screen.w, on_screen.y / on_screen.w]);
            // The floor may hide all cards, but a card may hide only earlier cards. (Near an edge, the hit
            // may be a card that `has` left out.)
            match found {
                Some((layer, _)) if layer > 0 => assert!(layer > last, "{layer}, not {last}"),
                _ => continue,
            }
            compared += 1;
        }
    }
    enough!(compared > 500; "{compared}");
}

#[test]
fn without_clipping_the_same_page_has_the_same_order_on_the_screen() {
    let mut dice = Dice(43);
    let mut compared = 0;
    for page in Page::ALL {
        let layers: Vec<Layer> = layers_of(page, 30, 8).iter().map(Given::layer).collect();
        let [clipped, unclipped] =
            [true, false].map(|is_clipped| page_on(VIEWPORT, is_clipped, layers.iter().cloned()));
        for _ in 0..400 {
            let at = [1920.0 * dice.share(), 1080.0 * dice.share()];
            let [a, b] = [&clipped, &unclipped].map(|page| page.hit(at).map(|(layer, _)| layer));
            assert_eq!(a, b);
            compared += usize::from(a.is_some());
        }
    }
    enough!(compared > 100; "{compared}");
    // The layer beside the screen is present and whole.
    let beside = Layer::new([[-900.0, 50.0], [-100.0, 90.0]], DMat4::IDENTITY);
    let page = page_on(VIEWPORT, false, [beside]);
    let corners = page.back_to_front().flat_map(|piece| piece.vertices());
    assert!(corners.map(|corner| corner.position.x).eq([-900.0, -100.0, -100.0, -900.0]));
}
