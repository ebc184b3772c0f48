//! Layers that separate matrices put into one plane, seen nearly along this plane and near the eye. Tests
//! what the tolerance guarantees for two such layers.

use super::oracle::{Truth, covers, number};
use super::{Given, order, page_on};
use binspace::glam::{DMat4, Mat4};
use binspace::layers::{Layer, LayerVertex, Layers};
use testkit::prelude::*;
use testkit::rational::exact;

/// The longer side of the viewport.
const SIZE: f64 = 640.0;

/// The options of a page.
#[derive(Clone, Copy, Debug)]
struct Kind {
    is_single: bool,
    is_clipped: bool,
}

impl Kind {
    fn page(self, given: &[Given]) -> Layers {
        let layer = |given: &Given| match self.is_single {
            true => Layer::from_f32(given.rect, given.matrix.as_mat4()),
            false => given.layer(),
        };
        page_on([[0.0; 2], [SIZE, 480.0]], self.is_clipped, given.iter().map(layer))
    }

    fn step(self) -> f64 {
        if self.is_single { f64::from(f32::EPSILON) } else { f64::EPSILON }
    }
}

/// A plane at a grazing angle to the line of sight, and cards of every size: most in the plane, some beside
/// it. If `is_single`, matrices are multiplied in `f32`, as a program in `f32` does.
fn cards(dice: &mut Dice, is_single: bool) -> Vec<Given> {
    let mut between = |low: f64, high: f64| low + (high - low) * dice.share();
    let mut perspective = DMat4::IDENTITY;
    perspective.z_axis.w = -1.0 / 1000.0;
    let grazing = 10f64.powf(between(-6.0, -0.3)) * between(-1.0, 1.0).signum();
    let at = dvec3(between(-200.0, 200.0), between(-200.0, 200.0), between(-300.0, 300.0));
    let plane = [
        DMat4::from_translation(dvec3(320.0, 240.0, 0.0)),
        perspective,
        DMat4::from_translation(at),
        DMat4::from_rotation_z(between(0.0, 6.3)),
        DMat4::from_rotation_x(std::f64::consts::FRAC_PI_2 + grazing),
    ];
    let count = between(3.0, 9.0) as usize;
    let mut card = || {
        let beside = 10f64.powf(between(0.0, 2.0)) * between(-1.0, 1.0).signum();
        let off = if between(0.0, 1.0) < 0.8 { 0.0 } else { beside };
        let place = dvec3(between(-600.0, 600.0), between(-600.0, 600.0), off);
        let factors = plane
            .iter()
            .copied()
            .chain([DMat4::from_translation(place), DMat4::from_rotation_z(between(0.0, 6.3))]);
        let matrix = match is_single {
            true => factors.map(|m| m.as_mat4()).fold(Mat4::IDENTITY, |m, by| m * by).as_dmat4(),
            false => factors.fold(DMat4::IDENTITY, |m, by| m * by),
        };
        let half = [10f64.powf(between(0.7, 3.2)), 10f64.powf(between(0.4, 3.2))];
        Given { rect: [half.map(|side| -side), half], matrix }
    };
    (0..count).map(|_| card()).collect()
}

/// The plane of a layer on the screen, in homogeneous coordinates, with a normal of length 1.
struct Plane {
    exactly: [Rational; 4],
    length: f64,
}

impl Plane {
    fn of(truth: &Truth) -> Self {
        let exactly = truth.plane();
        let [x, y, z, _] = exactly.each_ref().map(number);
        Self { exactly, length: DVec3::new(x, y, z).length() }
    }

    fn distance(&self, p: DVec3) -> f64 {
        let [x, y, z] = p.to_array().map(exact);
        let [a, b, c, d] = &self.exactly;
        number(&(a * x + b * y + c * z + d)).abs() / self.length
    }

    /// The largest distance of the plane from a vertex of its layer if each number of the matrix is off by
    /// a step.
    fn rounding(&self, given: &Given, vertex: &LayerVertex, step: f64) -> f64 {
        let DVec2 { x: u, y: v } = vertex.local.abs();
        let [of_u, of_v, _, of_1] = given.matrix.to_cols_array_2d();
        let term = |k: usize| {
            let terms = of_u[k].abs() * u + of_v[k].abs() * v + of_1[k].abs();
            (number(&self.exactly[k]) / self.length).abs() * terms
        };
        (0..4).map(term).sum::<f64>() * step / vertex.w
    }
}

/// A piece of a layer.
struct Piece {
    layer: usize,
    vertices: Vec<LayerVertex>,
    outline: Vec<DVec2>,
}

fn pieces(page: &Layers) -> Vec<Piece> {
    let piece = |piece: binspace::layers::LayerPiece<'_>| {
        let vertices: Vec<LayerVertex> = piece.vertices().collect();
        let outline = vertices.iter().map(|vertex| vertex.position.truncate()).collect();
        Piece { layer: piece.layer(), vertices, outline }
    };
    page.back_to_front().map(piece).collect()
}

/// A point well inside of two outlines.
fn overlap(dice: &mut Dice, [a, b]: [&Piece; 2]) -> Option<DVec2> {
    let at = |dice: &mut Dice, piece: &Piece| {
        let shares: Vec<f64> = piece.outline.iter().map(|_| 0.05 + dice.share()).collect();
        let sum: f64 = shares.iter().sum();
        piece.outline.iter().zip(shares).map(|(p, share)| *p * (share / sum)).sum::<DVec2>()
    };
    let is_inside = |piece: &Piece, at: DVec2| {
        let near =
            |(a, b): (&DVec2, &DVec2)| (*b - *a).perp_dot(at - *a).abs() / a.distance(*b) < 1e-5;
        let next = piece.outline.iter().cycle().skip(1);
        !piece.outline.iter().zip(next).any(near)
            && covers(&piece.outline, at, &at.to_array().map(exact))
    };
    let points: Vec<DVec2> = (0..8).map(|k| at(dice, if k % 2 == 0 { a } else { b })).collect();
    points.into_iter().find(|&at| is_inside(a, at) && is_inside(b, at))
}

#[derive(Debug, Default)]
struct Tally {
    in_list_order: usize,
    by_depth: usize,
    beside_a_third: usize,
    /// Pairs that are not in list order; they occur in pages that are not clipped.
    exchanged: usize,
}

/// Judges all pairs of pieces whose order is documented.
fn judge(given: &[Given], kind: Kind, dice: &mut Dice, tally: &mut Tally) {
    let truths: Vec<Truth> = given.iter().map(Given::truth).collect();
    let planes: Vec<Plane> = truths.iter().map(Plane::of).collect();
    let pieces = pieces(&kind.page(given));
    let vertices = || pieces.iter().flat_map(|p| p.vertices.iter().map(|vertex| (p.layer, vertex)));
    let rounding = vertices().map(|(k, vertex)| planes[k].rounding(&given[k], vertex, kind.step()));
    let least = 4.0 * rounding.fold(0.0, f64::max);
    let reach = vertices().map(|(_, vertex)| vertex.position.abs().max_element());
    let largest = least.max(reach.fold(0.0, f64::max) * 2f64.powi(-45));
    // The tolerance has these lower and upper limits.
    let [least, largest] = [least, largest].map(|t| t.clamp(1e-9 * SIZE, 1e-5 * SIZE));
    let mut known = vec![vec![None; planes.len()]; planes.len()];
    let mut off = |plane: usize, layer: usize| {
        *known[plane][layer].get_or_insert_with(|| {
            let of_layer = vertices().filter(|&(k, _)| k == layer);
            of_layer.map(|(_, vertex)| planes[plane].distance(vertex.position)).fold(0.0, f64::max)
        })
    };
    for (k, later) in pieces.iter().enumerate() {
        for earlier in &pieces[..k] {
            let [a, b] = [earlier.layer, later.layer];
            if a == b {
                continue;
            }
            let Some(at) = overlap(dice, [earlier, later]) else { continue };
            let depth = |k: usize| Some(truths[k].seen_at(&at.to_array().map(exact))?.1);
            let (Some(far), Some(near)) = (depth(a), depth(b)) else { continue };
            // The plane of a third layer may come between them.
            let mut is_third = |c: &usize| {
                let passes = planes[*c].distance(at.extend(number(&far))) <= 2.0 * largest;
                passes && [a, b].iter().any(|&k| off(*c, k).max(off(k, *c)) > 0.99 * least)
            };
            if (0..given.len()).filter(|&c| c != a && c != b).any(|c| is_third(&c)) {
                tally.beside_a_third += 1;
                continue;
            }
            if off(a, b).max(off(b, a)) <= 0.99 * least {
                let is_far = !kind.is_clipped && !kind.is_single;
                assert!(
                    a < b || is_far,
                    "{b} is painted over {a} of its plane, at {at}: {kind:?} {given:?}"
                );
                tally.in_list_order += 1;
                tally.exchanged += usize::from(a > b);
                continue;
            }
            let behind = number(&(far - near));
            let slope = [a, b].map(|k| number(&planes[k].exactly[2]).abs() / planes[k].length);
            let is_apart = behind.abs() * slope[0].min(slope[1]) > 2.01 * largest;
            assert!(behind < 0.0 || !is_apart, "{b} is {behind} behind {a}: {kind:?} {given:?}");
            tally.by_depth += usize::from(is_apart);
        }
    }
}

#[test]
fn layers_nearly_in_one_plane_come_in_the_order_of_the_list_and_others_by_depth() {
    for is_single in [false, true] {
        for is_clipped in [false, true] {
            let (mut dice, mut tally) = (Dice(101), Tally::default());
            // If the grid set no least tolerance, some unclipped page in `f64` would fail.
            let pages = if is_single || is_clipped { 200 } else { 600 };
            let mut exchanged = 0;
            for _ in 0..times(pages) {
                let (given, before) = (cards(&mut dice, is_single), tally.exchanged);
                judge(&given, Kind { is_single, is_clipped }, &mut dice, &mut tally);
                exchanged += usize::from(tally.exchanged > before);
            }
            assert!(exchanged <= times(pages) / 1000, "{exchanged} pages");
            let Tally { in_list_order, by_depth, beside_a_third, .. } = tally;
            let most = 2 * (in_list_order + by_depth);
            assert!(beside_a_third < most, "too many are excused: {tally:?}");
            enough!(in_list_order > 40, by_depth > 40; "{is_single} {is_clipped} {tally:?}");
        }
    }
}

/// Three cards that separate matrices put into a plane seen nearly edge-on. The second card reaches so near
/// to the eye that the plane of the first, small card misses it by more than the tolerance.
#[test]
fn a_small_card_does_not_come_between_two_others_of_its_plane() {
    let z = [0.737760532083408, -0.675144008569573, -0.0007473646955752207, 7.473646955752207e-7];
    let card = |half: [f64; 2], [x, y, w]: [[f64; 4]; 3]| Given {
        rect: [half.map(|side| -side), half],
        matrix: DMat4::from_cols_array_2d(&[x, y, z, w]),
    };
    let cards = [
        card(
            [7.770427417446198, 2.8732026678589415],
            [
                [
                    -0.29743921899356,
                    -0.21652474993050314,
                    0.999476531375196,
                    -0.0009994765313751958,
                ],
                [-0.6853023480949908, -0.7449144919788724, 0.0323435414916, -3.234354149160037e-5],
                [59.6769478340276, 4.759467608135509, 434.9990272632779, 0.565000972736722],
            ],
        ),
        card(
            [590.8305729362821, 1472.5006565350589],
            [
                [0.7444921882567944, 0.7750091959259301, -0.351139942765995, 0.000351139942765995],
                [
                    -0.06197401814161091,
                    0.033783337947156,
                    0.936322691191614,
                    -0.0009363226911916135,
                ],
                [134.54430966111, 80.66796011026167, 380.9760773685391, 0.6190239226314609],
            ],
        ),
        card(
            [45.19637975580784, 37.65519191979736],
            [
                [-0.4820706328936, -0.5714039277027736, -0.414652363683408, 0.00041465236368340804],
                [0.5707164814525417, 0.5246695332287286, -0.909979592484235, 0.0009099795924842351],
                [194.59667010134237, 156.18962365012402, 472.68794216535616, 0.5273120578346439],
            ],
        ),
    ];
    let kind = Kind { is_single: false, is_clipped: true };
    assert_eq!(order(&kind.page(&cards)), [0, 1, 2]);
}

/// The box ends at a million times the size of the viewport. There, the last bit of a place in the rectangle
/// is a tenth of a pixel on the screen.
#[test]
fn the_end_of_the_box_does_not_move_a_corner_off_its_plane() {
    let mut dice = Dice(102);
    let mut far = 0;
    for round in 0..300 {
        let kind = Kind { is_single: false, is_clipped: round % 2 == 0 };
        for given in cards(&mut dice, false) {
            let plane = Plane::of(&given.truth());
            for vertex in pieces(&kind.page(&[given])).iter().flat_map(|piece| &piece.vertices) {
                let off = plane.distance(vertex.position);
                let rounding = 4.0 * plane.rounding(&given, vertex, kind.step());
                let most = rounding.max(1e-9 * SIZE);
                assert!(off <= most, "{off} {most} {vertex:?} {given:?}");
                far += usize::from(vertex.position.abs().max_element() > 1e8);
            }
        }
    }
    assert!(far > 100, "{far}");
}
