//! Small cards of one plane, whose corners are rounded by less than the tolerance. No heuristic cuts a card
//! by the plane of another card if the two lie in one plane within the tolerance.

use binspace::glam::{DQuat, EulerRot};
use binspace::internals::PlaneKind;
use std::collections::HashMap;
use std::f64::consts::TAU;
use testkit::prelude::*;
use testkit::rational::{exact, scalar};
use testkit::scenes::trees;

/// About four steps of `f32`.
const TOLERANCE: f64 = 4.8e-7;

type Card = [DVec3; 4];

struct Cards {
    all: Vec<Card>,
    /// The number of cards in one plane, which come first, and the plane's axes.
    level: usize,
    axes: [DVec3; 3],
}

/// Cards of several sizes in one plane, rounded to `f32` or moved by a fifth of the tolerance. There may be
/// other cards that cross this plane.
fn cards(dice: &mut Dice, others: usize) -> Cards {
    let mut between = |low: f64, high: f64| low + (high - low) * dice.share();
    let mut turn = || {
        let mut angle = || between(-3.0, 3.0);
        DQuat::from_euler(EulerRot::XYZ, angle(), angle(), angle())
    };
    let (plane, turns) = (turn(), [(); 8].map(|()| turn()));
    let at = DVec3::new(between(-0.3, 0.3), between(-0.3, 0.3), between(-0.3, 0.3));
    let (level, is_single) = (2 + dice.below(11), dice.below(2) == 0);
    let mut all = Vec::new();
    for k in 0..level {
        let mut between = |low: f64, high: f64| low + (high - low) * dice.share();
        let size = [0.01, 0.6, 10f64.powf(between(-2.5, 0.0))][if k < 2 { k } else { 2 }];
        let middle = DVec2::new(between(-0.6, 0.6), between(-0.6, 0.6));
        let u = DVec2::from_angle(between(0.0, 6.3)) * size;
        let v = u.perp() * between(0.3, 1.0);
        let corners = [middle - u - v, middle + u - v, middle + u + v, middle - u + v];
        all.push(corners.map(|corner| {
            let corner = at + plane * corner.extend(0.0);
            let mut noise = || 0.2 * TOLERANCE * dice.around_zero(1);
            let moved = corner + plane * DVec3::new(0.0, 0.0, noise());
            if is_single { corner.as_vec3().as_dvec3() } else { moved }
        }));
    }
    let first = dice.below(level);
    all.swap(0, first);
    for turn in turns.into_iter().take(others) {
        let mut between = |low: f64, high: f64| low + (high - low) * dice.share();
        let size = 10f64.powf(between(-1.5, 0.0));
        let middle = DVec3::new(between(-0.6, 0.6), between(-0.6, 0.6), between(-0.6, 0.6));
        let signs = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
        all.push(signs.map(|[x, y]| middle + turn * DVec3::new(x, y, 0.0) * size));
    }
    Cards { all, level, axes: [plane * DVec3::X, plane * DVec3::Y, plane * DVec3::Z] }
}

/// Whether all corners of a face are clearly within the tolerance of another's plane.
fn is_on(faces: &Faces, face: u32, other: u32) -> bool {
    let plane = model::plane(faces, PlaneId::face(other));
    let most = exact(faces.tolerance()) * exact(1.0 - 1e-6);
    let most = &most * &most * scalar(&plane.normal, &plane.normal);
    model::Face::new(faces, face).corners.iter().all(|corner| {
        let off: Rational = plane.at(corner);
        &off * &off <= most
    })
}

/// The number of pairs of fragments that overlap, seen along the plane's normal, and are not in input order.
fn exchanged(tree: &BspTree, cards: &Cards) -> usize {
    let [x, y, z] = cards.axes;
    let flat = |p: DVec3| DVec2::new(p.dot(x), p.dot(y));
    let inside = |outline: &[DVec2], at: DVec2| {
        let next = outline.iter().cycle().skip(1);
        let sides = outline.iter().zip(next).map(|(&a, &b)| (b - a).normalize().perp_dot(at - a));
        let (low, high) =
            sides.fold((f64::MAX, f64::MIN), |(low, high), s| (low.min(s), high.max(s)));
        low > 1e-4 || high < -1e-4
    };
    let mut found = 0;
    for direction in [z, -z] {
        let order = tree.back_to_front(Viewpoint::direction(direction.to_array()));
        let pieces: Vec<(usize, Vec<DVec2>)> =
            order.map(|f| (f.polygon(), f.vertices().map(flat).collect())).collect();
        for (k, (earlier, outline)) in pieces.iter().enumerate() {
            for (later, other) in &pieces[k + 1..] {
                let middle =
                    |outline: &[DVec2]| outline.iter().sum::<DVec2>() / outline.len() as f64;
                let [a, b] = [outline, other].map(|outline| middle(outline));
                let overlap = (0..=8).any(|step| {
                    let at = a.lerp(b, f64::from(step) / 8.0);
                    inside(outline, at) && inside(other, at)
                });
                found += usize::from(later < earlier && overlap);
            }
        }
    }
    found
}

/// The two cards of the original fault: one card has a hundredth of the other's size, and its plane cut the
/// other.
#[test]
fn a_frame_does_not_cut_a_card_by_a_small_one_in_its_plane() {
    let small: [[f32; 3]; 4] = [
        [0.07435414, 0.04701618, 0.38188425],
        [0.06429868, 0.019585103, 0.36612988],
        [0.07316165, 0.013837662, 0.37048024],
        [0.0832171, 0.04126874, 0.38623464],
    ];
    let large = [
        [-0.41155723, 0.64058316, 0.23210758],
        [-0.81692785, -0.4652595, -0.40300676],
        [0.033688046, -1.0168657, 0.014516396],
        [0.43905866, 0.08897696, 0.6496307],
    ];
    let mut frames = FrameBuilder::new(BuildOptions::DEFAULT);
    let tree = frames.build([small, large]).unwrap();
    for z in [1.0, -1.0] {
        let order = tree.back_to_front(Viewpoint::direction([0.0, 0.0, z]));
        assert_eq!(order.map(|f| f.polygon()).collect::<Vec<_>>(), [0, 1]);
    }
    for &heuristic in Heuristic::ALL {
        let options = BuildOptions::DEFAULT.with_heuristic(heuristic);
        assert_eq!(options.build([small, large]).unwrap().len(), 2, "{heuristic}");
    }
}

#[test]
fn a_polygon_is_not_cut_by_the_plane_of_one_that_lies_on_its_own() {
    let mut dice = Dice(61);
    let (mut cuts, mut pairs) = (0, 0);
    for round in 0..60 {
        let cards = cards(&mut dice, round % 4 * 2);
        for (name, tree) in trees(&cards.all, BuildOptions::DEFAULT.with_tolerance(TOLERANCE)) {
            let faces = tree.faces();
            let mut known = HashMap::new();
            let mut is_on = |face, other| {
                *known.entry((face, other)).or_insert_with(|| is_on(faces, face, other))
            };
            for fragment in tree.fragments() {
                let planes = fragment.lines().filter_map(|line| line.as_cut());
                for plane in planes {
                    let PlaneKind::Face(by) = plane.kind() else { continue };
                    cuts += 1;
                    assert!(!is_on(by, fragment.face()), "{name}: {by} cuts {}", fragment.face());
                }
            }
            pairs += usize::from(cards.level == cards.all.len());
        }
    }
    assert!(cuts > 3000 && pairs > 100, "{cuts} {pairs}");
}

/// If, of any two cards, one lies on the plane of the other, no card is cut. The default heuristic and frames
/// use the planes of large cards, so small cards keep their order too.
#[test]
fn cards_of_one_plane_stay_whole_by_every_heuristic() {
    let mut dice = Dice(62);
    let mut whole = 0;
    for _ in 0..60 {
        let cards = cards(&mut dice, 0);
        let faces = Faces::new(&cards.all, Some(TOLERANCE)).unwrap().0;
        assert_eq!(faces.len(), cards.level);
        let numbers = || 0..cards.level as u32;
        let pairs = numbers().flat_map(|a| numbers().take(a as usize).map(move |b| [a, b]));
        let is_flat = pairs.clone().all(|[a, b]| is_on(&faces, a, b) || is_on(&faces, b, a));
        for (name, tree) in trees(&cards.all, BuildOptions::DEFAULT.with_tolerance(TOLERANCE)) {
            if !is_flat {
                continue;
            }
            assert_eq!(tree.len(), cards.level, "{name}");
            if name == "auto" || name == "frame" {
                assert_eq!(exchanged(&tree, &cards), 0, "{name}");
            }
            whole += 1;
        }
    }
    assert!(whole > 180, "{whole}");
}

/// A rectangle with its middle, half its size and its height.
fn layer(middle: [f64; 2], half: [f64; 2], z: f64) -> Card {
    [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]]
        .map(|[x, y]| dvec3(middle[0] + x * half[0], middle[1] + y * half[1], z))
}

/// The given polygons in the order of a tree, seen from a side.
fn seen(tree: &BspTree, direction: DVec3, polygons: &[usize]) -> Vec<usize> {
    let order = tree.back_to_front(Viewpoint::direction(direction.to_array()));
    order.map(|fragment| fragment.polygon()).filter(|i| polygons.contains(i)).collect()
}

const WIDE: f64 = 1e-3;

/// Other polygons above three layers: none, few or many more layers, walls that reach down to just below the
/// lowest layer, so that only the planes of the two others cut them, or a ring that is taken apart side by side.
fn others(kind: usize) -> Vec<Card> {
    let upright = |[a, b]: [DVec2; 2], low: f64, high: f64| {
        [a.extend(low), b.extend(low), b.extend(high), a.extend(high)]
    };
    let pile = |count| (1..=count).map(|k| layer([0.3; 2], [1.0; 2], f64::from(k))).collect();
    match kind {
        0 => vec![],
        1 => pile(2),
        2 => pile(290),
        3 => (0..8)
            .map(|k| {
                let ends = [1.5, 4.0].map(|x| DVec2::new(x, -0.8 + 0.2 * f64::from(k)));
                upright(ends, -0.2 * WIDE, 1.0)
            })
            .collect(),
        _ => (0..300)
            .map(|k| {
                let at = |k: u32| DVec2::from_angle(f64::from(k % 300) / 300.0 * TAU) * 5.0;
                upright([at(k), at(k + 1)], 1.0, 2.0)
            })
            .collect(),
    }
}

/// The largest of three layers is within the tolerance of the others, which are almost twice the tolerance apart.
/// Its plane holds all three.
#[test]
fn layers_above_and_below_a_larger_one_keep_their_order_with_it() {
    let layers = [
        layer([0.0; 2], [1.0; 2], 0.0),
        layer([0.0; 2], [2.0; 2], 0.95 * WIDE),
        // It is not parallel, so its own plane holds none of the others.
        layer([0.0; 2], [0.9; 2], 0.0).map(|p| p.with_z((1.6 + 0.33 * p.x) * WIDE)),
    ];
    let mut whole = 0;
    for (turn, kind) in (0..12).flat_map(|turn| (0..5).map(move |kind| (turn, kind))) {
        let mut three = layers;
        three.rotate_left(turn % 3);
        if turn % 6 > 2 {
            three.swap(0, 1);
        }
        let side = if turn < 6 { 1.0 } else { -1.0 };
        let largest = (0..3).find(|&i| three[i][1].x > 1.5).expect("one of the three");
        let all = three.into_iter().chain(others(kind));
        let all: Vec<Card> = all.map(|card| card.map(|p| p.with_z(side * p.z))).collect();
        for tilt in [DQuat::IDENTITY, DQuat::from_euler(EulerRot::XYZ, 0.3, 0.5, 0.7)] {
            let tilted: Vec<Card> = all.iter().map(|card| card.map(|p| tilt * p)).collect();
            for (name, tree) in trees(&tilted, BuildOptions::DEFAULT.with_tolerance(WIDE)) {
                for (other, z) in (0..3).flat_map(|other| [(other, 1.0), (other, -1.0)]) {
                    if other == largest {
                        continue;
                    }
                    let pair = [other.min(largest), other.max(largest)];
                    let found = seen(&tree, tilt * (z * DVec3::Z), &pair);
                    // A plane across both separates their parts.
                    if found.len() == 2 {
                        assert_eq!(found, pair, "{name}: {turn}, {side}, {tilt}, {}", all.len());
                        whole += 1;
                    }
                }
            }
        }
    }
    assert!(whole > 1500, "{whole}");
}

/// Many cards lie on a small card's plane, and so does a strip that begins far from all of them. More cards lie on the
/// strip alone, all together at one end. The plane of the strip cuts a wall, but that of a card does not.
#[test]
fn cards_on_a_long_strip_keep_their_order_among_many_others() {
    let low = -0.2 * WIDE;
    let wall = [[8.5, low], [9.5, low], [9.5, 1.0], [8.5, 1.0]];
    let mut all: Vec<Card> = (0..46)
        .map(|k| layer([f64::from(k), 0.0], [0.3; 2], 0.0))
        .chain([wall.map(|[x, z]| dvec3(x, 5.0, z))])
        .chain((0..16).map(|k| layer([50.0 + f64::from(k), 0.0], [0.3; 2], 1.9 * WIDE)))
        .collect();
    all.push(layer([0.0, 0.0], [70.0, 6.0], 0.95 * WIDE));
    let on_strip: Vec<usize> = (47..64).collect();
    let mut whole = 0;
    for side in [1.0, -1.0] {
        let all: Vec<Card> = all.iter().map(|card| card.map(|p| p.with_z(side * p.z))).collect();
        for (name, tree) in trees(&all, BuildOptions::DEFAULT.with_tolerance(WIDE)) {
            for direction in [DVec3::Z, DVec3::NEG_Z] {
                let found = seen(&tree, direction, &on_strip);
                // Free planes may cut the strip.
                if found.len() == 17 {
                    assert_eq!(found[16], 63, "{name}: {found:?}");
                    whole += 1;
                }
            }
        }
    }
    assert!(whole > 20, "{whole}");
}

/// The planes of small cards leave a wall by far more than the tolerance, each on another side. Only the wall's
/// plane holds all.
#[test]
fn a_wall_holds_all_its_cards() {
    let mut dice = Dice(63);
    for last in [false, true] {
        let mut all: Vec<Card> = (0..40)
            .map(|k| {
                let size = 0.02 * f64::from(k + 1);
                let middle = [0; 2].map(|_| dice.range(-1.0, 1.0));
                let card = layer(middle, [size; 2], 0.0);
                // Three corners in the card's plane, so that the fourth is in it, too.
                let [u, v] = [0; 2].map(|_| dice.range(-0.45, 0.45) * WIDE);
                let heights = [0.0, u, u + v, v];
                [0, 1, 2, 3].map(|i| card[i] + heights[i] * DVec3::Z)
            })
            .collect();
        all.insert(if last { 40 } else { 0 }, layer([0.0; 2], [2.0; 2], 0.0));
        for (name, tree) in trees(&all, BuildOptions::DEFAULT.with_tolerance(WIDE)) {
            assert_eq!((tree.len(), tree.stats().nodes), (41, 1), "{name}");
        }
    }
}

/// The plane of each card holds all smaller cards, but not the next larger one.
#[test]
fn the_largest_of_many_nested_cards_holds_all() {
    let card = |k: i32| {
        let half = 0.02 * 1.5f64.powi(k);
        let slope = if k % 2 == 0 { 0.45 } else { -0.45 } * WIDE / half;
        layer([0.0; 2], [half; 2], 0.0).map(|p| p.with_z(slope * p.x))
    };
    let mut all: Vec<Card> = (0..12).map(card).collect();
    for _ in 0..12 {
        all.rotate_left(1);
        for (name, tree) in trees(&all, BuildOptions::DEFAULT.with_tolerance(WIDE)) {
            assert_eq!((tree.len(), tree.stats().nodes), (12, 1), "{name}");
        }
    }
}

/// The plane of each strip holds the smaller strip that overlaps its beginning, but the larger strip that overlaps its
/// end leaves it. So planes give way to the next many times, up to the plane of the largest strip, which holds all.
#[test]
fn the_largest_of_many_strips_that_overlap_end_to_end_holds_all() {
    let length = |k: i32| 0.01 * 1.5f64.powi(k);
    let strip = |k: i32| {
        let start: f64 = (0..k).map(|i| 0.9 * length(i)).sum();
        let half = if k < 19 { 0.45 * WIDE } else { 0.0 };
        [[0.0, -0.1], [1.0, -0.1], [1.0, 0.1], [0.0, 0.1]]
            .map(|[share, y]| dvec3(start + share * length(k), y, half * (2.0 * share - 1.0)))
    };
    let mut all: Vec<Card> = (0..20).map(strip).collect();
    for _ in 0..20 {
        all.rotate_left(1);
        for (name, tree) in trees(&all, BuildOptions::DEFAULT.with_tolerance(WIDE)) {
            assert_eq!((tree.len(), tree.stats().nodes), (20, 1), "{name}");
        }
    }
}

/// The larger of two neighbours nearly in one plane has the more certain plane. It replaces the first plane only if
/// the two overlap by more than the tolerance.
#[test]
fn a_plane_gives_way_only_to_a_card_that_overlaps() {
    for (overlap, gives_way) in [(-2.0, false), (0.0, false), (0.5, false), (3.0, true)] {
        let small = layer([-1.0, 0.0], [1.0; 2], 0.0);
        let from = -overlap * WIDE;
        // It rises to 2 tolerances, so it is not on the small card's plane.
        let large = layer([from + 3.0, 0.0], [3.0, 2.0], 0.0)
            .map(|p| dvec3(p.x, p.y, 2.0 * WIDE * (p.x - from) / 6.0));
        let options = BuildOptions::DEFAULT.with_tolerance(WIDE).with_heuristic(Heuristic::First);
        let tree: BspTree = options.build([small, large]).expect("finite");
        let root = tree.root().expect("a node").plane();
        assert_eq!(root, PlaneId::face(u32::from(gives_way)), "{overlap}");
    }
}
