//! Layers cut by ancestors, compared with exact rationals of all rectangles and matrices.

use super::oracle::Truth;
use super::{Given, VIEWPORT, camera, page_on, wild};
use binspace::glam::DMat4;
use binspace::layers::{Layer, LayerPiece, Layers};
use testkit::prelude::*;
use testkit::rational::exact;

/// Points nearer to an outline than this share of a layer are not judged.
const MARGIN: f64 = 1e-6;

/// A layer and its ancestors, from the outermost to the parent. Each is clipped by the one before.
struct Nested {
    ancestors: Vec<Given>,
    own: Given,
    layer: Layer,
}

/// The matrix from a child layer to its parent. The child is in the plane of the parent, or sometimes outside
/// this plane.
fn step(dice: &mut Dice) -> DMat4 {
    let mut between = |low: f64, high: f64| low + (high - low) * dice.share();
    let shift = dvec3(between(-150.0, 150.0), between(-150.0, 150.0), 0.0);
    let scale = dvec3(between(0.5, 1.5), between(-1.5, -0.5), 1.0);
    let turn = DMat4::from_rotation_z(between(0.0, 6.3));
    let place = DMat4::from_translation(shift) * turn;
    match (between(0.0, 8.0)) as u32 {
        0 | 1 => DMat4::IDENTITY,
        2 => place * DMat4::from_rotation_x(between(-0.5, 0.5)),
        3 | 4 => place * DMat4::from_scale(scale),
        _ => place,
    }
}

fn nested(dice: &mut Dice) -> Nested {
    let rect = |dice: &mut Dice| {
        let low = [0; 2].map(|_| dice.range(-400.0, -50.0));
        [low, [0; 2].map(|_| dice.range(50.0, 400.0))]
    };
    let mut matrix = wild(dice).matrix;
    let mut ancestors = Vec::new();
    for _ in 0..1 + dice.below(3) {
        ancestors.push(Given { rect: rect(dice), matrix });
        matrix *= step(dice);
    }
    let own = Given { rect: rect(dice), matrix };
    let parent = ancestors[1..]
        .iter()
        .fold(ancestors[0].layer(), |outer, ancestor| ancestor.layer().clipped_by(&outer));
    Nested { layer: own.layer().clipped_by(&parent), ancestors, own }
}

/// A point of the screen that shows a point in or near the rectangle of a layer.
fn point_of(given: &Given, dice: &mut Dice) -> Option<[f64; 2]> {
    let [low, high] = given.rect;
    let local = [0, 1].map(|k: usize| dice.range(low[k] - 100.0, high[k] + 100.0));
    let h = given.matrix * dvec3(local[0], local[1], 0.0).extend(1.0);
    let [x, y] = [h.x / h.w, h.y / h.w];
    let [_, [width, height]] = VIEWPORT;
    let is_seen = h.w > 0.05 && x > 1.0 && x < width - 1.0 && y > 1.0 && y < height - 1.0;
    is_seen.then_some([x, y])
}

/// Whether a layer covers a point; `None` if the point is too near its outline.
fn covers(truth: &Truth, at: &[Rational; 2]) -> Option<bool> {
    let Some((local, _)) = truth.seen_at(at) else { return Some(false) };
    let inside = truth.inside(&local);
    (inside.abs() > MARGIN).then_some(inside > 0.0)
}

#[test]
fn a_layer_is_seen_inside_all_its_ancestors() {
    let mut dice = Dice(71);
    let (mut seen, mut hidden, mut cut) = (0, 0, 0);
    for _ in 0..times(60) {
        // The nested layers are on one page with other layers, which cut them.
        let mut all: Vec<Nested> = (0..4).map(|_| nested(&mut dice)).collect();
        for _ in 0..3 {
            let own = wild(&mut dice);
            all.push(Nested { ancestors: Vec::new(), layer: own.layer(), own });
        }
        let page = page_on(VIEWPORT, true, all.iter().map(|nested| nested.layer.clone()));
        cut += page.len() - page.visible();
        let truths: Vec<Vec<Truth>> = all
            .iter()
            .map(|nested| nested.ancestors.iter().chain([&nested.own]).map(Given::truth).collect())
            .collect();
        'points: for round in 0..40 {
            let Some(screen) = point_of(&all[round % 4].own, &mut dice) else { continue };
            let at = screen.map(exact);
            let mut expected = Vec::new();
            for (number, outlines) in truths.iter().enumerate() {
                let covered: Option<Vec<bool>> =
                    outlines.iter().map(|outline| covers(outline, &at)).collect();
                let Some(covered) = covered else { continue 'points };
                if covered.iter().all(|&is| is) {
                    expected.push(number);
                }
                hidden += usize::from(covered.last() == Some(&true) && covered.contains(&false));
            }
            let mut found: Vec<usize> = page.hits(screen).map(|(layer, _)| layer).collect();
            assert_eq!(found.first().copied(), page.hit(screen).map(|(layer, _)| layer));
            found.sort_unstable();
            assert_eq!(found, expected, "at {screen:?}");
            seen += expected.len();
        }
    }
    enough!(seen > 250, hidden > 300, cut > 10; "{seen} {hidden} {cut}");
}

/// Every edge with a number lies on the edge of the layer or ancestor that has this number.
#[test]
fn edges_made_by_ancestors_have_their_numbers() {
    let mut dice = Dice(72);
    let (mut own, mut of_ancestors) = (0, 0);
    for _ in 0..times(300) {
        let Nested { ancestors, own: given, layer } = nested(&mut dice);
        let page = page_on(VIEWPORT, true, [layer]);
        for piece in page.back_to_front() {
            let corners: Vec<DVec2> = piece.vertices().map(|v| v.position.truncate()).collect();
            for (k, edge) in piece.edges().enumerate() {
                let Some(edge) = edge else { continue };
                let (owner, side) = (usize::from(edge) / 4, usize::from(edge) % 4);
                let of = match owner {
                    0 => &given,
                    // The parent first.
                    _ => &ancestors[ancestors.len() - owner],
                };
                let middle = (corners[k] + corners[(k + 1) % corners.len()]) * 0.5;
                let (local, _) = of.truth().seen_at(&middle.to_array().map(exact)).unwrap();
                let [u, v] = [0, 1].map(|k: usize| local[k].to_f64().value());
                let [[u0, v0], [u1, v1]] = of.rect;
                let off = [v - v0, u - u1, v - v1, u - u0][side].abs();
                // Planes seen at a flat angle magnify a rounding error on the screen.
                assert!(off < 1e-3, "{off} of edge {edge}");
                own += usize::from(owner == 0);
                of_ancestors += usize::from(owner > 0);
            }
        }
    }
    enough!(own > 200, of_ancestors > 300; "{own} {of_ancestors}");
}

/// Drawn by hand: a square rotated by 45° in a square window is an octagon.
#[test]
fn a_turned_square_in_a_window_is_an_octagon() {
    let middle = DMat4::from_translation(dvec3(960.0, 540.0, 0.0));
    let square = [[-100.0; 2], [100.0; 2]];
    let window = Layer::new(square, middle);
    let turned = middle * DMat4::from_rotation_z(std::f64::consts::FRAC_PI_4);
    let page = page_on(VIEWPORT, true, [Layer::new(square, turned).clipped_by(&window)]);
    let piece = page.back_to_front().next().unwrap();
    // The corners are 100 from the middle in one direction, and 100 (√2 − 1) in the other.
    let along = 100.0 * (2f64.sqrt() - 1.0);
    let mut found: Vec<[f64; 2]> =
        piece.vertices().map(|v| [v.position.x - 960.0, v.position.y - 540.0]).collect();
    let mut expected = Vec::new();
    for (x, y) in [(100.0, along), (along, 100.0)] {
        expected.extend([[x, y], [-x, y], [x, -y], [-x, -y]]);
    }
    for corners in [&mut found, &mut expected] {
        corners.sort_by(|a, b| a[1].atan2(a[0]).total_cmp(&b[1].atan2(b[0])));
    }
    assert_eq!(found.len(), 8);
    let off =
        found.iter().zip(&expected).map(|(a, b)| (a[0] - b[0]).abs().max((a[1] - b[1]).abs()));
    assert!(off.fold(0.0, f64::max) < 1e-9, "{found:?}");
    let mut edges: Vec<Option<u8>> = piece.edges().collect();
    edges.sort_unstable();
    assert_eq!(edges, (0..8).map(Some).collect::<Vec<_>>());
}

/// With one matrix, corners equal the corners of the ancestor, bit for bit.
#[test]
fn in_a_window_of_the_same_matrix_a_layer_ends_exactly_at_its_sides() {
    let mut dice = Dice(73);
    for _ in 0..100 {
        let matrix = camera() * DMat4::from_rotation_y(dice.range(-1.0, 1.0));
        let low = [0; 2].map(|_| dice.range(-90.0, -10.0));
        let high = [0; 2].map(|_| dice.range(10.0, 90.0));
        let window = Layer::new([low, high], matrix);
        let large = Layer::new([[-100.0; 2], [100.0; 2]], matrix).clipped_by(&window);
        let outline = |layer: Layer| -> Vec<_> {
            let page = page_on(VIEWPORT, true, [layer]);
            let piece: LayerPiece<'_> = page.back_to_front().next().unwrap();
            let mut corners: Vec<_> = piece.vertices().map(|v| v.local.to_array()).collect();
            corners.sort_by(|a, b| a.partial_cmp(b).unwrap());
            corners
        };
        assert_eq!(outline(large), outline(window));
    }
}

#[test]
fn ancestors_that_are_no_window() {
    let card = || Layer::new([[-100.0, -60.0], [100.0, 60.0]], camera());
    let pieces = |layer: Layer| page_on(VIEWPORT, true, [card(), layer]).len() - 1;
    assert_eq!(pieces(card().clipped_by(&card())), 1);
    let turned = camera() * DMat4::from_rotation_y(0.4);
    for matrix in [camera(), turned] {
        let empty = Layer::new([[10.0, 0.0], [-10.0, 50.0]], matrix);
        assert_eq!(pieces(card().clipped_by(&empty)), 0);
        let beside = Layer::new([[300.0, 0.0], [400.0, 50.0]], matrix);
        assert_eq!(pieces(card().clipped_by(&beside)), 0);
    }
    let flat = camera() * DMat4::from_scale(dvec3(0.0, 1.0, 1.0));
    assert_eq!(pieces(card().clipped_by(&Layer::new([[-9.0; 2], [9.0; 2]], flat))), 0);
    for bad in [camera() * f64::NAN, camera() * f64::INFINITY] {
        let layer = card().clipped_by(&Layer::new([[-9.0; 2], [9.0; 2]], bad));
        let error = Layers::new(VIEWPORT).update(&[card(), layer]).unwrap_err();
        assert_eq!(error.polygon(), Some(1), "{error}");
    }
    // More ancestors than edges have numbers.
    let deep = (0..100).fold(card(), |layer, k| {
        let inset = f64::from(k) * 0.1;
        let window = [[-100.0 + inset, -60.0 + inset], [100.0 - inset, 60.0 - inset]];
        layer.clipped_by(&Layer::new(window, turned))
    });
    let page = page_on(VIEWPORT, true, [deep]);
    assert_eq!((page.len(), page.visible()), (1, 1));
    assert!(page.back_to_front().all(|piece| piece.edges().all(|edge| edge.is_none())));
}
