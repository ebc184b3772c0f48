//! Input that is wrong, degenerate or extreme.

use super::{Given, Rect, VIEWPORT, camera, page_on, wild};
use binspace::glam::{DMat4, DVec4, Mat4};
use binspace::layers::{Layer, Layers};
use testkit::prelude::*;

const CARD: Rect = [[-100.0, -60.0], [100.0, 60.0]];

fn flat() -> Layer {
    Layer::new(CARD, camera())
}

/// The number of pieces of a layer between two fixed others.
fn pieces(layer: Layer) -> usize {
    let mut page = Layers::new(VIEWPORT);
    let front = Layer::new(CARD, camera() * DMat4::from_translation(dvec3(0.0, 0.0, 50.0)));
    page.update(&[flat(), layer, front]).unwrap();
    let found: Vec<usize> = page.back_to_front().map(|piece| piece.layer()).collect();
    // Numbers refer to the list, even if a layer has no piece.
    assert!(found.contains(&0) && found.contains(&2), "{found:?}");
    found.len() - 2
}

#[test]
fn nan_is_an_error_that_names_the_layer() {
    let mut bad = Vec::new();
    for value in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        for k in 0..4 {
            let mut rect = CARD;
            rect[k / 2][k % 2] = value;
            bad.push(Layer::new(rect, camera()));
            for column in [0, 1, 3] {
                let mut matrix = camera();
                matrix.col_mut(column)[k] = value;
                bad.push(Layer::new(CARD, matrix));
                bad.push(Layer::from_f32(CARD, matrix.as_mat4()));
            }
        }
    }
    // Finite numbers whose products are not finite.
    bad.push(Layer::new(CARD, camera() * 1e308));
    bad.push(Layer::new([[-1e300; 2], [1e300; 2]], camera() * 1e10));
    let mut page = Layers::new(VIEWPORT);
    for (k, layer) in bad.iter().enumerate() {
        page.update(&[flat(), flat()]).unwrap();
        let error = page.update(&[flat(), layer.clone(), flat()]).unwrap_err();
        assert_eq!(error.polygon(), Some(1), "{k}: {error}");
        assert!(error.to_string().contains("layer 1"), "{error}");
        // The page is empty, and is not equal to a page with these layers.
        assert!(page.is_empty() && page.visible() == 0 && page.back_to_front().next().is_none());
        assert!(page.update(&[flat(), layer.clone(), flat()]).is_err());
        assert!(page.update(&[]).unwrap());
    }
    assert!(bad.len() > 80);
    // The z column is not used: a layer has no thickness.
    let mut matrix = camera();
    matrix.z_axis = DVec4::NAN;
    assert_eq!(pieces(Layer::new([[200.0, 0.0], [300.0, 90.0]], matrix)), 1);
}

#[test]
fn an_invalid_viewport_is_an_error_and_an_empty_one_shows_nothing() {
    for bad in [f64::NAN, f64::INFINITY, 1e305] {
        let mut page = Layers::new([[0.0, 0.0], [bad, 100.0]]);
        let error = page.update(&[flat()]).unwrap_err();
        assert!(error.to_string().contains("viewport") && error.polygon().is_none(), "{error}");
    }
    for empty in [[[0.0; 2]; 2], [[900.0, 0.0], [100.0, 1080.0]], [[9.0; 2], [-9.0; 2]]] {
        let mut page = Layers::new(empty);
        assert!(page.update(&[flat()]).unwrap() && page.is_empty());
        let mut page = Layers::new(empty).unclipped();
        assert!(page.update(&[flat()]).is_ok());
    }
}

#[test]
fn layers_without_area_on_the_screen_have_no_pieces() {
    let at = |x: f64, y: f64, z: f64| camera() * DMat4::from_translation(dvec3(x, y, z));
    let quarter = std::f64::consts::FRAC_PI_2;
    let mut vanished = vec![
        ("behind the eye", Layer::new(CARD, at(0.0, 0.0, 1300.0))),
        ("in the eye's plane", Layer::new(CARD, at(0.0, 0.0, 1200.0))),
        ("left of the screen", Layer::new(CARD, at(-2000.0, 0.0, 0.0))),
        ("below the screen", Layer::new(CARD, at(0.0, 900.0, 0.0))),
        ("no width", Layer::new([[5.0, -60.0], [5.0, 60.0]], camera())),
        ("no height", Layer::new([[-5.0, 6.0], [5.0, 6.0]], camera())),
        ("exchanged", Layer::new([[5.0, 6.0], [-5.0, -6.0]], camera())),
        ("zeros", Layer::new(CARD, DMat4::ZERO)),
        ("f32 zeros", Layer::from_f32(CARD, Mat4::ZERO)),
        ("a line", Layer::new(CARD, at(0.0, 0.0, 0.0) * DMat4::from_scale(dvec3(1.0, 0.0, 1.0)))),
        ("a point", Layer::new(CARD, at(0.0, 0.0, 0.0) * DMat4::from_scale(dvec3(0.0, 0.0, 1.0)))),
        ("w of zeros", Layer::new(CARD, DMat4::from_diagonal(DVec4::new(1.0, 1.0, 1.0, 0.0)))),
        ("w negative", Layer::new(CARD, camera() * -1.0)),
        ("beyond the depth", Layer::new(CARD, DMat4::from_translation(dvec3(500.0, 500.0, 3e9)))),
        ("beyond it behind", Layer::new(CARD, DMat4::from_translation(dvec3(500.0, 500.0, -3e9)))),
        ("tiny", Layer::new(CARD, camera() * 1e-318)),
    ];
    for k in [1.0, -1.0, 3.0] {
        // On the middle axis, a layer turned by 90° is seen edge-on.
        let edge_on = at(0.0, 0.0, -100.0) * DMat4::from_rotation_y(k * quarter);
        vanished.push(("edge-on", Layer::new(CARD, edge_on)));
        vanished.push(("edge-on, f32", Layer::from_f32(CARD, edge_on.as_mat4())));
        let edge_on = at(0.0, 0.0, 0.0) * DMat4::from_rotation_x(k * quarter);
        vanished.push(("edge-on", Layer::new(CARD, edge_on)));
    }
    for (name, layer) in vanished {
        assert_eq!(pieces(layer), 0, "{name}");
    }
    // A layer that touches the viewport from outside is clipped to a line.
    let mut page = Layers::new(VIEWPORT);
    let beside = [[[-90.0, 50.0], [0.0, 90.0]], [[1920.0, 50.0], [1999.0, 90.0]]];
    page.update(&beside.map(|rect| Layer::new(rect, DMat4::IDENTITY))).unwrap();
    assert_eq!((page.len(), page.visible(), page.is_empty()), (0, 0, true));
    // A card slightly beside the axis is visible, and so is a card that is thin on the screen.
    let thin = at(1.0, 0.0, -100.0) * DMat4::from_rotation_y(quarter);
    assert!(pieces(Layer::new(CARD, thin)) >= 1);
    assert!(
        pieces(Layer::new(CARD, at(0.0, 0.0, -9.0) * DMat4::from_rotation_y(quarter - 1e-9))) >= 1
    );
}

/// Pairs of layers: one with a number just beyond a limit, one with the number just within the limit.
#[test]
fn layers_too_far_or_too_small_have_no_piece_and_slightly_nearer_or_larger_ones_have() {
    let at = |x: f64, y: f64, z: f64| DMat4::from_translation(dvec3(x, y, z));
    let middle = at(960.0, 540.0, 0.0);
    // A rotated card of this size, with its low corner at (low, low) but shown in the middle.
    let turned = |low: f64, size: f64| {
        let matrix = camera() * DMat4::from_rotation_y(0.7) * at(-low, -low, 0.0);
        Layer::new([[low, low], [low + size, low + size]], matrix)
    };
    let sized = |size: f64| Layer::new([[0.0, 0.0], [size, size]], middle);
    let depth = 1920.0 * f64::from(1 << 20);
    let cases = [
        ("depth", Layer::new(CARD, at(960.0, 540.0, 1e18)), at(960.0, 540.0, 0.99 * depth)),
        (
            "depth behind",
            Layer::new(CARD, at(960.0, 540.0, -1e18)),
            at(960.0, 540.0, -0.99 * depth),
        ),
        (
            "depth after w",
            Layer::new(CARD, camera() * at(0.0, 0.0, -1e18)),
            camera() * at(0.0, 0.0, -1e6),
        ),
        ("right", Layer::new(CARD, at(1e18, 540.0, 0.0)), at(2019.0, 540.0, 0.0)),
        ("above", Layer::new(CARD, at(960.0, -1e18, 0.0)), at(960.0, -59.0, 0.0)),
        ("small matrix", Layer::new(CARD, middle * 1e-310), middle * 1e-300),
        ("small matrix of a camera", Layer::new(CARD, camera() * 1e-310), camera() * 1e-300),
    ];
    for (name, layer, not_so) in cases {
        assert_eq!(pieces(layer), 0, "{name}");
        assert!(pieces(Layer::new(CARD, not_so)) > 0, "{name}, a little less so");
    }
    let cases = [
        ("small rectangle", sized(1e-170), sized(1e-6)),
        ("below the grid", sized(1e-14), sized(1e-6)),
        ("far from its origin", turned(1e18, 1000.0), turned(1e8, 1000.0)),
    ];
    for (name, layer, not_so) in cases {
        assert_eq!(pieces(layer), 0, "{name}");
        assert!(pieces(not_so) > 0, "{name}, a little less so");
    }
}

/// The depth of such a layer's corners is rounded to 10⁵⁰ pixels and more. A page that included this depth in its
/// extent would round all other layers to points.
#[test]
fn a_layer_whose_depth_is_lost_by_rounding_leaves_other_layers_visible() {
    let columns = |[x, y, z, w]: [[f64; 3]; 4]| {
        let column = |k: usize| DVec4::new(x[k], y[k], z[k], w[k]);
        DMat4::from_cols(column(0), column(1), DVec4::ZERO, column(2))
    };
    let lost = columns([
        [-1.0, 1e99, -1.0],
        [1e-95, 1.0, -1000.0],
        [1000.0, 1000.0, 1.0],
        [1e192, -1e51, 1e-65],
    ]);
    for rect in [[[-1.0, 1.0], [999.0, 1001.0]], [[-1.0, 1.5], [99.0, 700.0]]] {
        assert_eq!(pieces(Layer::new(rect, lost)), 0, "{rect:?}");
    }
}

/// Homogeneous coordinates mean the same at any scale.
#[test]
fn the_scale_of_a_matrix_does_not_matter() {
    let mut dice = Dice(31);
    let mut compared = 0;
    for _ in 0..times(40) {
        let Given { rect, matrix } = wild(&mut dice);
        let mut pages = [1.0, 2f64.powi(600), 2f64.powi(-600), 2f64.powi(-900)].map(|scale| {
            let page = page_on(VIEWPORT, true, [Layer::new(rect, matrix * scale)]);
            let piece = page.back_to_front().next();
            piece.map_or(Vec::new(), |p| p.vertices().map(|v| (v.position, v.local)).collect())
        });
        let first = std::mem::take(&mut pages[0]);
        assert!(pages[1..].iter().all(|other| *other == first));
        compared += first.len();
    }
    enough!(compared > 60; "{compared}");
}

/// Numbers of every size: no panic, only finite numbers, every vertex on the screen.
#[test]
fn extreme_numbers_do_no_harm() {
    let mut dice = Dice(32);
    let (mut seen, mut errors) = (0, 0);
    let mut page = Layers::new(VIEWPORT);
    for round in seeds(3000) {
        let largest = if round % 2 == 0 { 300 } else { 8 };
        let mut any = || {
            let sizes =
                [0.0, 1.0, 10f64.powf(dice.around_zero(largest)), 1.0 + f64::EPSILON, 1000.0];
            let size = sizes[dice.below(5)];
            if dice.below(2) == 0 { size } else { -size }
        };
        let mut layer = || {
            let (low, matrix) = ([any(), any()], DMat4::from_cols_array(&[0; 16].map(|_| any())));
            let rect = [low, [low[0] + any().abs(), low[1] + any().abs()]];
            if any() > 0.0 {
                Layer::new(rect, matrix)
            } else {
                Layer::from_f32(rect, matrix.as_mat4())
            }
        };
        let layers = [flat(), layer(), layer(), layer()];
        match page.update(&layers) {
            Err(error) => errors += usize::from(error.polygon().is_some()),
            Ok(_) => {
                assert!(page.back_to_front().any(|piece| piece.layer() == 0));
                for vertex in page.back_to_front().flat_map(|piece| piece.vertices()) {
                    assert!(vertex.position.is_finite() && vertex.local.is_finite());
                    assert!(vertex.w > 0.0);
                    let [x, y, _] = vertex.position.to_array();
                    assert!((-1e-3..=1920.001).contains(&x) && (-1e-3..=1080.001).contains(&y));
                    seen += 1;
                }
                page.hit([960.0, 540.0]);
            }
        }
    }
    enough!(seen > 8000, errors > 100; "{seen} {errors}");
}
