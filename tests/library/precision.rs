//! The default tolerance follows the precision of the input, and merges nothing that the input
//! distinguishes.

use binspace::Tolerance;
use binspace::glam::{Mat4, Quat, Vec3, vec3};
use testkit::prelude::*;
use testkit::shapes::{Claim, rectangle};

/// The number of rotations of the cards.
const TURNS: u64 = 24;

fn turn(number: u64) -> Mat4 {
    let angle = |k: u64| (number * (2 * k + 3)) as f32 * 0.61 + k as f32;
    let turn = Quat::from_euler(binspace::glam::EulerRot::XYZ, angle(0), angle(1), angle(2));
    Mat4::from_rotation_translation(turn, vec3(0.3, -0.2, 0.1))
}

/// Overlapping cards in parallel planes, moved by a matrix in `f32`.
fn cards(count: usize, gap: f32, turn: Mat4) -> Vec<[Vec3; 4]> {
    let card = |i: usize| {
        let [x, y] = [0.037, 0.023].map(|step| step * i as f32 - 0.7);
        let z = gap * i as f32;
        let corners = [[0.0, 0.0], [0.4, 0.0], [0.4, 0.3], [0.0, 0.3]];
        corners.map(|[u, v]| turn.transform_point3(vec3(x + u, y + v, z)))
    };
    (0..count).map(card).collect()
}

fn order(tree: &BspTree, direction: DVec3) -> Vec<usize> {
    tree.back_to_front(Viewpoint::direction(direction)).map(|f| f.polygon()).collect()
}

#[test]
fn cards_in_one_plane_out_of_a_matrix_of_f32_stay_whole_and_in_input_order() {
    let mut cut_without = 0;
    for number in 0..TURNS {
        let turn = turn(number);
        let cards = cards(40, 0.0, turn);
        let tree = BspTree::build(&cards).unwrap();
        assert_eq!(tree.len(), 40, "turn {number}");
        let normal = turn.transform_vector3(Vec3::Z).as_dvec3();
        let input: Vec<usize> = (0..40).collect();
        assert_eq!(order(&tree, normal), input, "turn {number}");
        assert_eq!(order(&tree, -normal), input, "turn {number}");
        let finer = BuildOptions::DEFAULT.with_relative_tolerance(1e-9).build(&cards).unwrap();
        cut_without += usize::from(finer.len() > 40);
    }
    enough!(cut_without > 12; "only {cut_without} of the scenes tell one tolerance from another");
}

/// The planes of small cards have the largest rounding errors. Further away from the cards, they differ by
/// more than the tolerance.
#[test]
fn small_cards_of_one_plane_keep_their_order_in_frames_too() {
    for size in [0.4, 0.1, 0.01] {
        let compared: usize = (0..1200).map(|number| pairs_in_order(number, size)).sum();
        enough!(compared > 400; "{compared} of size {size}");
    }
}

/// The plane of a small card has a far larger rounding error than the plane of the page on which it lies. For
/// any place of the card and either order, the page's plane shows that the two are coplanar.
#[test]
fn a_page_and_a_small_card_keep_their_order() {
    let mut dice = Dice(4);
    for number in 0..400 {
        let turn = turn(number);
        let place = dice.point(-0.95, 0.95);
        let card = |[x, y]: [f64; 2], size: f64| {
            let corners = [[0.0, 0.0], [size, 0.0], [size, size], [0.0, size]];
            corners.map(|[u, v]| turn.transform_point3(vec3((x + u) as f32, (y + v) as f32, 0.0)))
        };
        let page = card([-1.0, -1.0], 2.0);
        let small = card([place.x, place.y], 0.04 * (1.0 + dice.point(0.0, 1.0).x) / 2.0);
        let normal = turn.transform_vector3(Vec3::Z).as_dvec3();
        for both in [[page, small], [small, page]] {
            let tree = BspTree::build(both).unwrap();
            assert_eq!(order(&tree, normal), [0, 1], "turn {number}");
            assert_eq!(order(&tree, -normal), [0, 1], "turn {number}");
        }
    }
}

/// Most cards are far smaller than the page, also the first one. The plane of any small card would cut other
/// cards.
#[test]
fn a_page_of_cards_of_every_size_is_not_cut() {
    let mut dice = Dice(2);
    for number in 0..20 {
        let turn = turn(number);
        let card = |_| {
            let mut some = |low: f64, high: f64| dice.range(low, high) as f32;
            let (x, y, size) = (some(-1.0, 1.0), some(-1.0, 1.0), some(-8.0, -1.0).exp());
            let corners = [[x, y], [x + size, y], [x + size, y + size], [x, y + size]];
            corners.map(|[x, y]| turn.transform_point3(vec3(x, y, 0.0)))
        };
        let mut cards: Vec<[Vec3; 4]> = (0..500).map(card).collect();
        cards.sort_by(|a, b| a[0].distance(a[1]).total_cmp(&b[0].distance(b[1])));
        for heuristic in [Heuristic::FreePlanes, Heuristic::Auto] {
            let tree = BuildOptions::DEFAULT.with_heuristic(heuristic).build(&cards).unwrap();
            assert_eq!(tree.len(), tree.face_count(), "page {number}, {heuristic}");
        }
    }
}

/// Builds a page of cards that are not thin. Half of them lie on the card before. Returns the number of pairs
/// of overlapping cards in input order.
fn pairs_in_order(number: u64, size: f64) -> usize {
    let (turn, mut dice) = (turn(number), Dice(number));
    let mut low = Vec3::ZERO;
    let mut rectangle = |i: usize| {
        let mut some = |low: f64, high: f64| dice.range(low, high) as f32;
        low = match i % 2 {
            0 => vec3(some(-1.0, 1.0), some(-1.0, 1.0), 0.0),
            _ => low + Vec3::splat(0.05 * size as f32).with_z(0.0),
        };
        [low, low + vec3(some(0.3, 1.1), some(0.3, 1.1), 0.0) * size as f32]
    };
    let rectangles: Vec<[Vec3; 2]> = (0..40).map(&mut rectangle).collect();
    let card = |&[a, b]: &[Vec3; 2]| {
        [a, vec3(b.x, a.y, 0.0), b, vec3(a.x, b.y, 0.0)].map(|p| turn.transform_point3(p))
    };
    let cards: Vec<[Vec3; 4]> = rectangles.iter().map(card).collect();
    let overlaps = |earlier: usize, later: usize| {
        let [[a, b], [c, d]] = [rectangles[earlier], rectangles[later]];
        let common = b.min(d) - a.max(c);
        common.x.min(common.y) > 0.01 * size as f32
    };
    let normal = turn.transform_vector3(Vec3::Z).as_dvec3();
    let mut frames = FrameBuilder::new(BuildOptions::DEFAULT);
    let mut compared = 0;
    for tree in [&BspTree::build(&cards).unwrap(), frames.build(&cards).unwrap()] {
        for direction in [normal, -normal] {
            let order = order(tree, direction);
            for (place, &first) in order.iter().enumerate() {
                for &second in order[place + 1..].iter().filter(|&&second| overlaps(first, second))
                {
                    assert!(first < second, "page {number} of {size}: {first} before {second}");
                    compared += 1;
                }
            }
        }
    }
    compared
}

#[test]
fn layers_some_steps_of_f32_apart_keep_their_order() {
    // Twice the default tolerance, plus the rounding of both layers.
    let gap = 12.0 * f32::EPSILON;
    for number in 0..TURNS {
        let turn = turn(number);
        let cards = cards(30, gap, turn);
        let normal = turn.transform_vector3(Vec3::Z).as_dvec3();
        let tree = BspTree::build(&cards).unwrap();
        let order = order(&tree, -normal);
        // Neighbours overlap, so only the input order, from below upwards, is right.
        let first = |polygon| order.iter().position(|&p| p == polygon).unwrap();
        let last = |polygon| order.iter().rposition(|&p| p == polygon).unwrap();
        for upper in 1..30 {
            assert!(last(upper - 1) < first(upper), "turn {number}: {order:?}");
        }
    }
}

#[test]
fn a_polygon_reports_its_precision() {
    let single = [[0.5_f32, -3.0, 0.25], [1.0; 3], [0.0; 3]];
    let expected = 4.0 * f64::from(f32::EPSILON) * 3.0;
    assert_eq!(single.precision(), expected);
    assert_eq!(single.map(Vec3::from).to_vec().precision(), expected);
    let double = single.map(|point| point.map(f64::from));
    assert_eq!(double.precision(), 4.0 * f64::EPSILON * 3.0);
    assert_eq!(double[..].precision(), double.precision());
}

/// Two squares of side 1, one a little above the other.
fn tolerance_of(precision: f64, options: BuildOptions) -> f64 {
    let square = |z: f64| Claim { corners: rectangle([0.0; 2], [1.0; 2], z), precision };
    let squares = [0.0, 1e-3].map(square);
    options.build(squares).unwrap().stats().tolerance
}

#[test]
fn the_tolerance_follows_the_precision_within_bounds_or_the_option() {
    let near = |found: f64, expected: f64| {
        assert!((found - expected).abs() <= 1e-12 * expected, "{found}, not {expected}");
    };
    let default = BuildOptions::DEFAULT;
    for (precision, expected) in [
        (0.0, 1e-9),
        (1e-12, 1e-9),
        (1e-7, 1e-7),
        (1e-2, 1e-5),
        (f64::INFINITY, 1e-5),
        (f64::NAN, 1e-9),
        (-1.0, 1e-9),
    ] {
        near(tolerance_of(precision, default.clone()), expected);
    }
    near(tolerance_of(1e-7, default.clone().with_tolerance(1e-4)), 1e-4);
    near(tolerance_of(1e-7, default.clone().with_relative_tolerance(1e-3)), 1e-3);
    assert_eq!(tolerance_of(1e-7, default.clone().with_tolerance(0.0)), 0.0);
    assert_eq!(tolerance_of(1e-7, default.clone().with_relative_tolerance(0.0)), 0.0);
    let largest = tolerance_of(0.0, default.clone().with_tolerance(f64::INFINITY));
    near(tolerance_of(0.0, default.clone().with_relative_tolerance(f64::INFINITY)), largest);
    assert!((1.0 / 256.0..=1.0 / 128.0).contains(&largest), "{largest}");
    for wrong in [-1e-9, f64::NAN] {
        let error =
            default.clone().with_relative_tolerance(wrong).build([[[0.0; 3]; 3]]).unwrap_err();
        assert!(error.to_string().contains("tolerance"), "{error}");
    }
    assert_eq!(Tolerance::from(None), Tolerance::Default);
    assert_eq!(Tolerance::from(Some(2.0)), Tolerance::Length(2.0));
}

#[test]
fn bent_flattened_and_nearly_coplanar_polygons_are_counted_and_measured() {
    // Three corners are in a level plane, and the fourth is off this plane by `off`.
    let quad = |off: f64| {
        [[0.0, 0.0, 0.0], [4.0, 0.0, off], [4.0, 4.0, 0.0], [0.0, 4.0, 0.0]].map(DVec3::from)
    };
    let near = |found: f64, expected: f64| {
        assert!((found - expected).abs() <= 1e-3 * expected, "{found}, not {expected}");
    };
    let build = |tolerance, polygons: &[[DVec3; 4]]| {
        // The next plane comes from the first remaining polygon.
        let options = BuildOptions::DEFAULT.with_heuristic(Heuristic::First);
        options.with_tolerance(tolerance).build(polygons).unwrap()
    };
    let quads = [quad(0.0), quad(3e-7), quad(2e-6), quad(0.5)];
    let found = *build(1e-6, &quads).preparation();
    assert_eq!((found.flattened, found.bent, found.triangulated), (1, 1, 2));
    near(found.flattened_by, 3e-7);
    near(found.bent_by, 2e-6);
    let found = *build(0.0, &quads).preparation();
    assert_eq!((found.flattened, found.flattened_by, found.bent), (0, 0.0, 2));
    near(found.bent_by, 2e-6);

    let level = |z: f64| quad(0.0).map(|corner| corner + DVec3::Z * z);
    let layers = [level(0.0), level(1e-7), level(0.0), level(1.0)];
    let found = build(1e-6, &layers).stats();
    assert_eq!(found.nearly_coplanar, 1);
    near(found.nearly_coplanar_by, 1e-7);
    let found = build(1e-8, &layers).stats();
    assert_eq!((found.nearly_coplanar, found.nearly_coplanar_by), (0, 0.0));
}
