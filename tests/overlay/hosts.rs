//! Shapes on a flat wall of several polygons whose planes differ by rounding. A shape within a larger polygon of the
//! wall comes after that polygon, even if it also lies on the plane of a smaller one.

use super::numbers::Numbers;
use binspace::glam::{DQuat, DVec2, EulerRot, dvec2};
use binspace::overlay::{Overlay, Shape, Shapes};
use std::f64::consts::TAU;
use testkit::prelude::*;
use testkit::rational::{exact, scalar};
use testkit::scenes::trees;

/// The plane of the first triangle holds the card, but the large triangle is behind it.
#[test]
fn a_card_on_a_large_triangle_and_on_the_plane_of_a_small_one() {
    let walls = [
        [
            [-2.1337218_f32, -2.2949183, 1.526358],
            [-2.3060207, -2.080527, 1.707231],
            [-2.4403617, -1.7868811, 2.2706523],
        ],
        [
            [-2.4403617, -1.7868811, 2.2706523],
            [-1.5958664, -2.2375739, 3.3881772],
            [-1.0210027, -2.8887575, 2.9988248],
        ],
        [
            [-1.6056488, -1.3677948, 2.9943402],
            [-0.55537224, -2.3880506, 2.8488884],
            [-0.75134426, -2.5650582, 1.6491834],
        ],
    ];
    let card = [
        [-2.3046045_f32, -1.8723917, 2.4066896],
        [-2.325413, -1.860593, 2.3814704],
        [-2.3284426, -1.8481044, 2.4137669],
    ];
    for &heuristic in Heuristic::ALL {
        let tree = BuildOptions::DEFAULT.with_heuristic(heuristic).build(walls).expect("a tree");
        let mut overlay = Overlay::new(&tree);
        overlay.replace(&tree, [card]).expect("on the grid");
        let direction = [-0.43352870230296614, -1.07209176435204, -0.26036517897751944];
        for sign in [1.0, -1.0] {
            let view = Viewpoint::direction(direction.map(|c| sign * c));
            let order = overlay.order(&tree, view).expect("its own tree").into_iter();
            let order: Vec<usize> = order.filter_map(|s| Some(s.fragment()?.polygon())).collect();
            let place =
                |wanted| order.iter().position(|&polygon| polygon == wanted).expect("painted");
            assert!(place(1) < place(3), "{heuristic} {sign}: {order:?}");
        }
    }
}

fn square(x: f64, y: f64, size: f64, z: f64) -> [DVec3; 4] {
    [[0.0, 0.0], [size, 0.0], [size, size], [0.0, size]].map(|[a, b]| dvec3(x + a, y + b, z))
}

/// Text lies on a label on a plane of the tree, and beyond the label's border on a polygon of the tree behind that plane.
#[test]
fn text_on_a_label_goes_with_the_wall_beyond_it() {
    let tolerance = 1e-3;
    let options = BuildOptions::DEFAULT.with_tolerance(tolerance).with_heuristic(Heuristic::First);
    let options = options.with_bounds(DVec3::splat(-50.0), DVec3::splat(50.0));
    for side in [1.0, -1.0] {
        let height = |height: f64| side * height * tolerance;
        let wall = square(0.0, 0.0, 10.0, height(-1.4));
        let tree = options.build([square(40.0, 40.0, 1.0, 0.0), wall]).expect("a tree");
        let mut overlay = Overlay::new(&tree);
        let label = square(10.0, 0.0, 20.0, height(0.5));
        let text = square(8.0, 2.0, 4.0, height(-0.45));
        overlay.replace(&tree, [label, text]).expect("on the grid");
        for z in [1.0, -1.0] {
            let order = overlay.order(&tree, Viewpoint::direction([0.1, 0.2, z]));
            let pieces = order.expect("its own tree").into_iter().filter_map(|s| s.fragment());
            let mut sides = [vec![], vec![]];
            for piece in pieces.filter(|piece| piece.polygon() > 0) {
                let middle = piece.vertices().map(|p| p.x).sum::<f64>() / 4.0;
                sides[usize::from(middle > 10.0)].push(piece.polygon());
            }
            assert_eq!(sides, [vec![1, 3], vec![2, 3]], "{side} {z}");
        }
    }
}

/// A plane of the tree has cut the smaller label, and a part of it counts as on the plane. The larger label is in front.
/// Text on both follows each where it lies.
#[test]
fn text_on_a_part_of_a_label_on_the_plane_that_cut_the_label() {
    let wall = [
        [-0.060139645_f32, -0.061698545, 0.013010305],
        [-0.06139083, -0.061812498, 0.012895642],
        [-0.062556334, -0.0620316, 0.012465314],
        [-0.06354972, -0.062339608, 0.011751238],
        [-0.06429732, -0.06271367, 0.010806373],
        [-0.064743675, -0.06312605, 0.009700797],
        [-0.06485569, -0.06354616, 0.0085165035],
        [-0.064625055, -0.06394284, 0.007341326],
        [-0.064068876, -0.06428669, 0.006262424],
        [-0.0632284, -0.06455217, 0.005359813],
        [-0.06216596, -0.064719625, 0.0047004363],
        [-0.06096036, -0.06477662, 0.0043331967],
        [-0.059701003, -0.06471893, 0.0042853304],
        [-0.0584813, -0.06455084, 0.004560388],
        [-0.057391703, -0.06428481, 0.0051379693],
        [-0.056513026, -0.06394057, 0.005975238],
        [-0.05591044, -0.06354365, 0.007010097],
        [-0.055628628, -0.06312349, 0.008165797],
        [-0.055688497, -0.062711254, 0.0093566235],
        [-0.0560856, -0.06233751, 0.010494259],
        [-0.056790497, -0.062029984, 0.01149433],
        [-0.0577509, -0.061811477, 0.012282667],
        [-0.05889558, -0.0616982, 0.012800801],
    ];
    let [larger, label, text] = [
        [
            [0.02606721223976, -0.0265739026939, 0.09902469224854],
            [-0.1259505475419, -0.01770451558731, 0.15015017024944],
            [-0.14858046497673, -0.04111689058303, 0.08692345703401],
            [0.00343729480493, -0.04998627768962, 0.03579797903311],
        ],
        [
            [-0.00341854354419, -0.04339333504538, 0.05584101594629],
            [-0.08591374783296, -0.03858020069631, 0.08358518714117],
            [-0.1177623877138, -0.0715300469404, -0.00539811674612],
            [-0.03526718342503, -0.07634318128947, -0.033142287941],
        ],
        [
            [-0.0382325946594, -0.04471143007539, 0.05795661862124],
            [-0.04248563476422, -0.04446328894291, 0.05938696931598],
            [-0.0463113000924, -0.0484212314113, 0.04869827611772],
            [-0.04205825998757, -0.04866937254378, 0.04726792542298],
        ],
    ];
    let (low, high) = (dvec3(-0.2, -0.1, -0.1), dvec3(0.1, 0.0, 0.2));
    let tree = BuildOptions::DEFAULT.with_bounds(low, high).build([wall]).expect("a tree");
    let mut overlay = Overlay::new(&tree);
    overlay.replace(&tree, [larger, label, text]).expect("on the grid");
    let corners = text.map(DVec3::from);
    let point = (corners[0] + corners[1]) * 0.05 + (corners[2] + corners[3]) * 0.45;
    let [along, other] = [corners[1] - corners[0], corners[3] - corners[0]];
    let flat = |p: DVec3| dvec2((p - point).dot(along), (p - point).dot(other));
    for direction in [1.0, -1.0].map(|sign| along.cross(other) * sign) {
        let order = overlay.order(&tree, Viewpoint::direction(direction)).expect("its own tree");
        let pieces = order.into_iter().filter_map(|shape| shape.fragment());
        let over: Vec<usize> = pieces
            .filter(|piece| {
                let corners: Vec<DVec2> = piece.vertices().map(flat).collect();
                let sides = corners.iter().zip(corners.iter().cycle().skip(1));
                let turns: Vec<f64> = sides.map(|(a, b)| a.perp_dot(*b)).collect();
                turns.iter().all(|turn| *turn > 0.0) || turns.iter().all(|turn| *turn < 0.0)
            })
            .map(|piece| piece.polygon())
            .filter(|polygon| *polygon > 0)
            .collect();
        assert_eq!(over, [2, 3]);
    }
}

/// Text lies across two labels, half a tolerance and 1.4 tolerances above or below a plane of the tree.
#[test]
fn text_across_two_labels_comes_after_both() {
    let tolerance = 1e-3;
    let options = BuildOptions::DEFAULT.with_tolerance(tolerance);
    let options = options.with_bounds(DVec3::splat(-50.0), DVec3::splat(50.0));
    let tree = options.build([square(40.0, 40.0, 1.0, 0.0)]).expect("a tree");
    let mut overlay = Overlay::new(&tree);
    for side in [1.0, -1.0] {
        let height = |height: f64| side * height * tolerance;
        let [first, second] =
            [square(0.0, 0.0, 15.0, height(0.5)), square(15.0, 0.0, 14.0, height(1.4))];
        let text = square(14.0, 3.0, 2.0, height(0.95));
        let shapes = Shapes::NONE.with_polygons([first, second, text]);
        overlay.replace_with(&tree, shapes.with_lines([[text[0], text[2]]])).expect("on the grid");
        for z in [1.0, -1.0] {
            let order = overlay.order(&tree, Viewpoint::direction([0.1, 0.2, z]));
            // The shapes whose parts are on the left and on the right of the border between the labels.
            let mut sides = [vec![], vec![]];
            for shape in order.expect("its own tree") {
                let (name, points) = match shape {
                    Shape::Fragment(f) if f.polygon() > 0 => {
                        (f.polygon(), f.vertices().collect::<Vec<DVec3>>())
                    }
                    Shape::Segment(piece) => (4, piece.ends().to_vec()),
                    _ => continue,
                };
                let middle = points.iter().map(|p| p.x).sum::<f64>() / points.len() as f64;
                sides[usize::from(middle > 15.0)].push(name);
            }
            assert_eq!(sides, [vec![1, 3, 4], vec![2, 3, 4]], "{side} {z}");
        }
    }
}

/// A card lies over a small square and over a large one that is one and a half tolerances above or below. It is cut at
/// the border, unless the squares are on one side of each plane.
#[test]
fn a_card_on_two_polygons_comes_after_both() {
    let mut cut = 0;
    for (side, is_reversed) in [(1.0, false), (1.0, true), (-1.0, false), (-1.0, true)] {
        let mut still = vec![square(0.0, 0.0, 1.0, 0.0), square(1.0, 0.0, 9.0, 1.5e-3 * side)];
        if is_reversed {
            still.reverse();
        }
        for (name, tree) in trees(&still, BuildOptions::DEFAULT.with_tolerance(1e-3)) {
            let mut overlay = Overlay::new(&tree);
            overlay.replace(&tree, [square(0.6, 0.3, 0.5, 0.75e-3 * side)]).expect("on the grid");
            cut += usize::from(overlay.len() == 2);
            for z in [1.0, -1.0] {
                let view = Viewpoint::direction([0.1, 0.2, z]);
                let mut seen = [false; 2];
                for shape in overlay.order(&tree, view).expect("its own tree") {
                    let Shape::Fragment(fragment) = shape else { panic!("{shape:?}") };
                    let xs = fragment.vertices().map(|p| p.x);
                    let [low, high] = xs.fold([f64::INFINITY, 0.0], |[low, high], x| {
                        [f64::min(low, x), f64::max(high, x)]
                    });
                    let is_card = fragment.polygon() == 2;
                    let is_over = [low < 0.99, high > 1.01];
                    for part in [0, 1].into_iter().filter(|&part| is_over[part]) {
                        assert!(seen[part] || !is_card, "{name} {side} {z}: {part}");
                        seen[part] |= !is_card;
                    }
                }
            }
        }
    }
    enough!(cut > 10; "{cut}");
}

/// A wall lies almost the tolerance above the plane of a small triangle beside it, and cards almost the tolerance above
/// the wall. Many cards move to one side of a plane at once.
#[test]
fn one_card_or_many_on_a_wall_that_lies_on_another_plane() {
    for side in [1.0, -1.0] {
        let still = [square(40.0, 0.0, 1.0, 0.0), square(0.0, 0.0, 30.0, 0.9e-3 * side)];
        let options = BuildOptions::DEFAULT.with_tolerance(1e-3).with_heuristic(Heuristic::First);
        let tree = options.build(still).expect("a tree");
        let mut overlay = Overlay::new(&tree);
        for count in [1, 800] {
            let card = |k: usize| {
                let (x, y) = ((k % 29) as f64, (k / 29) as f64);
                square(x + 0.2, y + 0.2, 0.5, 1.8e-3 * side)
            };
            overlay.replace(&tree, (0..count).map(card)).expect("on the grid");
            for z in [1.0, -1.0] {
                let direction = Viewpoint::direction([0.1, 0.2, z]);
                let order = overlay.order(&tree, direction).expect("its own tree").into_iter();
                let order: Vec<u32> = order.map(|shape| shape.index()).collect();
                let wall = order
                    .iter()
                    .position(|&i| tree.fragments().any(|f| f.index() == i && f.polygon() == 1));
                let card = order.iter().position(|&i| i as usize >= tree.len());
                assert!(wall.expect("painted") < card.expect("painted"), "{count} {side} {z}");
                assert_eq!(order.len(), count + 2);
            }
        }
    }
}

const TAU_OF_SQUARES: f64 = 1e-3;

/// The tree of one small square at z = 0, with much room beside it.
fn beside_a_square() -> BspTree {
    let options = BuildOptions::DEFAULT.with_tolerance(TAU_OF_SQUARES);
    let options = options.with_bounds(DVec3::splat(-50.0), DVec3::splat(50.0));
    options.build([square(40.0, 40.0, 1.0, 0.0)]).expect("a tree")
}

/// The numbers of polygons, `l` and `p` for lines and points, in the order from below or from above.
fn painted(tree: &BspTree, overlay: &Overlay, z: f64) -> Vec<String> {
    names(tree, overlay, Viewpoint::direction([0.1, 0.2, z]))
}

/// The same from any viewpoint.
fn names(tree: &BspTree, overlay: &Overlay, view: Viewpoint) -> Vec<String> {
    let name = |shape: Shape<'_>| match shape {
        Shape::Fragment(fragment) => fragment.polygon().to_string(),
        Shape::Segment(_) => "l".to_owned(),
        _ => "p".to_owned(),
    };
    overlay.order(tree, view).expect("its own tree").into_iter().map(name).collect()
}

/// Whether each piece of a shape comes after a piece of another, one by one.
fn is_after(order: &[String], shape: &str, other: &str) -> bool {
    let places = |wanted: &str| {
        let named = order.iter().enumerate().filter(|(_, name)| *name == wanted);
        named.map(|(place, _)| place).collect::<Vec<_>>()
    };
    let [pieces, others] = [shape, other].map(places);
    assert_eq!(pieces.len(), others.len(), "{order:?}");
    !pieces.is_empty() && pieces.iter().zip(&others).all(|(piece, other)| piece > other)
}

/// A plane across cuts a card. Each of its pieces lies on a wall and on the plane of a small square beside it.
#[test]
fn each_piece_of_a_cut_shape_lies_on_the_wall() {
    let t = TAU_OF_SQUARES;
    let divider = [[-40.0, -20.0], [40.0, -20.0], [40.0, 20.0], [-40.0, 20.0]];
    let still = [
        divider.map(|[y, z]| dvec3(0.0, y, z)),
        square(-41.0, 0.0, 1.0, 0.0),
        square(40.0, 0.0, 1.0, 0.0),
        square(-30.0, -30.0, 60.0, 0.9 * t),
    ];
    let card = square(-1.0, -1.0, 2.5, 1.8 * t);
    for (name, tree) in trees(&still, BuildOptions::DEFAULT.with_tolerance(t)) {
        let mut overlay = Overlay::new(&tree);
        for z in [1.0, -1.0] {
            overlay.replace(&tree, [card]).expect("on the grid");
            let order = painted(&tree, &overlay, z);
            assert!(is_after(&order, "4", "3"), "{name} {z}: {order:?}");
            let line = Shapes::NONE.with_lines([[card[0], card[2]]]);
            overlay.replace_with(&tree, line).expect("on the grid");
            let order = painted(&tree, &overlay, z);
            assert!(is_after(&order, "l", "3"), "{name} {z}: {order:?}");
        }
    }
}

/// A plane of the tree passes between shapes of the overlay that lie on one another.
#[test]
fn shapes_on_one_another_follow_the_larger_one() {
    let t = TAU_OF_SQUARES;
    let tree = beside_a_square();
    let mut overlay = Overlay::new(&tree);
    for (side, z) in [(1.0, 1.0), (1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0)] {
        for [large, small] in [[0.9, 1.8], [1.5, 0.7]].map(|heights| heights.map(|h| side * h * t))
        {
            // Also so many that they are sorted.
            for count in [1, 50] {
                let cards = (0..count).map(|k| square(0.1 + 0.19 * f64::from(k), 1.0, 1.0, small));
                let all = [square(0.0, 0.0, 15.0, large)].into_iter().chain(cards);
                overlay.replace(&tree, all).expect("on the grid");
                let order = painted(&tree, &overlay, z);
                for pair in (1..=count as usize).map(|k| [k, k + 1]) {
                    let [first, second] = [1, 2].map(|i| pair[i - 1].to_string());
                    assert!(is_after(&order, &second, &first), "{large} {small} {z}: {order:?}");
                }
            }
            let shapes = Shapes::NONE.with_polygons([square(0.0, 0.0, 15.0, large)]);
            let shapes = shapes.with_lines([[dvec3(1.0, 1.0, small), dvec3(3.0, 2.0, small)]]);
            let shapes = shapes.with_points([dvec3(2.0, 3.0, small)]);
            overlay.replace_with(&tree, shapes).expect("on the grid");
            let order = painted(&tree, &overlay, z);
            assert!(is_after(&order, "l", "1") && is_after(&order, "p", "l"), "{order:?}");
        }
    }
}

/// A card sticks out of the square on which it lies, and a still larger square begins where the card ends.
#[test]
fn a_card_does_not_follow_a_larger_shape_beside_it() {
    let t = TAU_OF_SQUARES;
    let tree = beside_a_square();
    let mut overlay = Overlay::new(&tree);
    for (side, z) in [(1.0, 1.0), (1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0)] {
        let [low, high] = [0.9, 1.8].map(|height| side * height * t);
        let beside = square(15.5, -10.0, 20.0, high);
        let all = [beside, square(0.0, 0.0, 15.0, low), square(14.5, 1.0, 1.0, high)];
        overlay.replace(&tree, all).expect("on the grid");
        let order = painted(&tree, &overlay, z);
        assert!(is_after(&order, "3", "2"), "{side} {z}: {order:?}");
    }
}

/// The plane of the tree cuts the larger of two polygons of the overlay, but not the small one that lies on it.
#[test]
fn a_plane_that_cuts_the_larger_shape_leaves_the_smaller_one_whole() {
    let t = TAU_OF_SQUARES;
    let tree = beside_a_square();
    let tilted = |square: [DVec3; 4]| square.map(|p| p.with_z(t * (p.x / 5.0 - 1.5)));
    let large = tilted(square(0.0, 0.0, 15.0, 0.0));
    let mut overlay = Overlay::new(&tree);
    for x in (0..45).map(|k| 0.1 + 0.3 * f64::from(k)) {
        overlay.replace(&tree, [large, tilted(square(x, 2.0, 1.0, 0.0))]).expect("on the grid");
        let small = (0..overlay.len() as u32).map(|k| overlay.piece(tree.len() as u32 + k));
        let small = small.flatten().filter(|piece| piece.polygon() == 2);
        let areas = small.map(|piece| {
            let corners: Vec<DVec3> = piece.vertices().collect();
            let halves =
                (2..corners.len()).map(|i| area(&[corners[0], corners[i - 1], corners[i]]));
            halves.sum::<f64>() / 2.0
        });
        let sum: f64 = areas.sum();
        assert!((sum - 1.0).abs() < 1e-6, "{x}: {sum}");
    }
}

/// The tree's first plane cuts a host at a small angle. A card at the cut lies on both parts, and entirely within the
/// tolerance of the plane.
#[test]
fn a_plane_that_cuts_a_host_cuts_the_shape_on_both_parts() {
    let t = TAU_OF_SQUARES;
    let tilted = |square: [DVec3; 4], lift: f64| {
        square.map(|p| p.with_z(t * (0.8 * (p.x - 7.5) + lift))).to_vec()
    };
    let still = [square(30.0, 30.0, 1.0, 0.0).to_vec(), tilted(square(0.0, 0.0, 15.0, 0.0), 0.0)];
    let options = BuildOptions::DEFAULT.with_tolerance(t).with_heuristic(Heuristic::First);
    let tree = options.build(still).expect("a tree");
    assert_eq!(tree.len(), 3);
    let mut overlay = Overlay::new(&tree);
    for lift in [0.0, 0.3, -0.3] {
        let card = tilted(square(7.0, 2.0, 1.0, 0.0), lift);
        for z in [1.0, -1.0] {
            overlay.replace(&tree, [&card]).expect("on the grid");
            assert_eq!(painted(&tree, &overlay, z), ["1", "2", "0", "1", "2"], "{lift}");
            let line = Shapes::NONE.with_lines([[card[0], card[2]]]);
            overlay.replace_with(&tree, line).expect("on the grid");
            assert_eq!(painted(&tree, &overlay, z), ["1", "l", "0", "1", "l"], "{lift}");
        }
    }
}

/// A disc of many corners lies on a square. The box of a larger triangle beside it contains the disc.
#[test]
fn a_polygon_of_many_corners_has_its_own_host() {
    let t = TAU_OF_SQUARES;
    let triangle = [[30.0, 0.0], [30.0, 30.0], [0.0, 30.0]].map(|[x, y]| dvec3(x, y, 1.6 * t));
    let still = [
        square(-9.0, -9.0, 1.0, 0.0).to_vec(),
        square(0.0, 0.0, 4.0, 0.9 * t).to_vec(),
        triangle.to_vec(),
    ];
    let bounds = [DVec3::splat(-50.0), DVec3::splat(50.0)];
    let options = BuildOptions::DEFAULT.with_tolerance(t).with_bounds(bounds[0], bounds[1]);
    let tree = options.with_heuristic(Heuristic::First).build(still).expect("a tree");
    let mut overlay = Overlay::new(&tree);
    for corners in [8, 2000] {
        let corner = |k: usize| {
            let angle = k as f64 / corners as f64 * TAU;
            dvec3(2.0 + angle.cos(), 2.0 + angle.sin(), 1.2 * t)
        };
        overlay.replace(&tree, [(0..corners).map(corner).collect::<Vec<_>>()]).expect("a disc");
        for z in [1.0, -1.0] {
            let order = painted(&tree, &overlay, z);
            assert!(is_after(&order, "3", "1"), "{corners} {z}: {order:?}");
        }
    }
}

/// A line on a large square of the overlay, beside small squares, all in an empty tree: in `f32`, the large square
/// leaves the planes of the small ones.
#[test]
fn a_line_on_a_polygon_of_the_overlay_comes_after_it() {
    let mut near = 0;
    for seed in seeds(300) {
        let dice = &mut Dice(seed);
        let mut angle = || dice.range(0.0, TAU);
        let turn = DQuat::from_euler(EulerRot::XYZ, angle(), angle(), angle());
        let middle = turn * DVec3::Z * dice.range(-2.0, 2.0);
        let at = |x: f64, y: f64| (middle + turn * dvec3(x, y, 0.0)).as_vec3();
        let square = |x: f64, y: f64, size: f64| {
            [at(x, y), at(x + size, y), at(x + size, y + size), at(x, y + size)]
        };
        let n = 4 + dice.below(20);
        let size = 1.0 / n as f64;
        let small = |i: usize| square((i % n) as f64 * size - 1.0, (i / n) as f64 * size, size);
        let mut polygons: Vec<_> = (0..n * n).step_by(1 + dice.below(4)).map(small).collect();
        polygons.push(square(0.0, 0.0, 1.0));
        let mut inside = || at(dice.range(0.01, 0.2), dice.range(0.05, 0.95));
        let (line, point) = ([inside(), inside()], inside());
        let room = BuildOptions::DEFAULT.with_bounds(DVec3::splat(-5.0), DVec3::splat(5.0));
        let tree = room.build([[DVec3::ZERO; 3]; 0]).expect("a tree");
        let mut overlay = Overlay::new(&tree);
        let shapes = Shapes::NONE.with_polygons(&polygons).with_lines([line]);
        overlay.replace_with(&tree, shapes.with_points([point])).expect("on the grid");
        let large = (polygons.len() - 1).to_string();
        for z in [1.0, -1.0] {
            let view = Viewpoint::direction(turn * dvec3(0.1, 0.2, z));
            let order = names(&tree, &overlay, view);
            assert!(is_after(&order, "l", &large) && is_after(&order, "p", &large), "{seed} {z}");
            near += usize::from(order.last().is_some_and(|last| last != "p"));
        }
    }
    enough!(near > 30; "{near}");
}

/// A flat polygon in triangles, a small grid of squares, or both; with small cards on it, and some other triangles.
fn wall(dice: &mut Dice, at: impl Fn(f64, f64) -> DVec3) -> Vec<Corners> {
    let mut all: Vec<Corners> = Vec::new();
    if dice.below(4) > 0 {
        let mut angles: Vec<f64> = (0..4 + dice.below(7)).map(|_| dice.share() * TAU).collect();
        angles.sort_by(f64::total_cmp);
        let corners: Vec<DVec3> = angles.iter().map(|a| at(a.cos(), a.sin())).collect();
        let (mut low, mut high) = (0, corners.len() - 1);
        while high - low > 1 {
            let middle = if dice.below(2) == 0 { low + 1 } else { high - 1 };
            all.push([low, middle, high].map(|i| corners[i]).into());
            if middle == low + 1 { low += 1 } else { high -= 1 }
        }
    } else {
        let n = 2 + dice.below(10);
        for i in 0..n * n {
            let at = |x: usize, y: usize| at(2.0 * x as f64 / n as f64, 2.0 * y as f64 / n as f64);
            let (x, y) = (i % n, i / n);
            all.push(vec![at(x, y), at(x + 1, y), at(x + 1, y + 1), at(x, y + 1)]);
        }
    }
    for _ in 0..dice.below(5) {
        all.push((0..3).map(|_| dice.point(-1.5, 1.5)).collect());
    }
    for _ in 0..dice.below(4) {
        let (x, y, size) = (dice.range(-0.7, 0.7), dice.range(-0.7, 0.7), dice.range(0.02, 0.3));
        let mut corner = || at(x + size * dice.around_zero(4) / 4.0, y + size * dice.share());
        all.push(vec![corner(), corner(), corner()]);
    }
    all
}

/// Whether all given corners are clearly within the tolerance of a face's plane.
fn are_on(faces: &Faces, face: u32, corners: &[[f64; 3]]) -> bool {
    let plane = model::plane(faces, PlaneId::face(face));
    let most = exact(faces.tolerance()) * exact(1.0 - 1e-6);
    let most = &most * &most * scalar(&plane.normal, &plane.normal);
    corners.iter().all(|corner| {
        let off: Rational = plane.at(&corner.map(exact));
        &off * &off <= most
    })
}

/// Whether a plane separates the host from a larger polygon under the shape: the shape then follows the larger one.
/// `flat` maps points of the wall to its plane.
fn is_apart(
    tree: &BspTree,
    host: u32,
    polygons: &[Corners],
    shape: &[DVec3],
    flat: impl Fn(DVec3) -> DVec2,
) -> bool {
    let size = |polygon: usize| -> f64 {
        let [first, rest @ ..] = &polygons[polygon][..] else { return 0.0 };
        rest.windows(2).map(|pair| area(&[*first, pair[0], pair[1]])).sum()
    };
    let is_under = |polygon: usize| {
        let corners: Vec<DVec2> = polygons[polygon].iter().map(|p| flat(*p)).collect();
        let turns = |a: DVec2, b: DVec2, p: DVec2| (b - a).perp_dot(p - a) / (b - a).length();
        let middle = corners.iter().sum::<DVec2>() / corners.len() as f64;
        (0..corners.len()).all(|i| {
            let (a, b) = (corners[i], corners[(i + 1) % corners.len()]);
            let inside = turns(a, b, middle).signum();
            shape.iter().any(|p| inside * turns(a, b, flat(*p)) >= -tree.stats().tolerance)
        })
    };
    let own = size(tree.fragment(host).polygon());
    let on_grid: Vec<[f64; 3]> = shape.iter().map(|p| tree.faces().lattice().snap(*p)).collect();
    tree.fragments()
        .filter(|other| size(other.polygon()) > own && is_under(other.polygon()))
        .filter(|other| are_on(tree.faces(), other.face(), &on_grid))
        .any(|other| tree.plane_between(host, other.index()).is_some())
}

/// Twice the area of a triangle.
fn area(corners: &[DVec3]) -> f64 {
    (corners[1] - corners[0]).cross(corners[2] - corners[0]).length()
}

/// The width of a triangle, at most.
fn width(corners: &[DVec3]) -> f64 {
    let sides = (0..3).map(|i| corners[i].distance(corners[(i + 1) % 3]));
    area(corners) / sides.fold(0.0, f64::max)
}

#[derive(Default)]
struct Judged {
    /// Shapes that were judged: polygons, lines, points.
    shapes: [usize; 3],
    /// Those that also lie on the plane of another polygon, which the host leaves on one side.
    on_two_planes: usize,
    /// Shapes that were left out, because they follow a larger polygon elsewhere.
    apart: usize,
}

/// Puts shapes inside polygons of a wall, and judges the order of each shape and the polygon.
fn judge(dice: &mut Dice, numbers: Numbers, judged: &mut Judged) {
    let mut angle = || dice.range(0.0, TAU);
    let turn = DQuat::from_euler(EulerRot::XYZ, angle(), angle(), angle());
    let middle = turn * DVec3::Z * dice.range(-2.0, 2.0);
    let at = |x: f64, y: f64| middle + turn * dvec3(x, y, 0.0);
    let polygons: Vec<Corners> = wall(dice, at)
        .into_iter()
        .map(|polygon| polygon.into_iter().map(|p| numbers.round(p)).collect::<Corners>())
        .filter(|polygon| area(polygon) > 1e-7)
        .collect();
    let heuristic = Heuristic::ALL[dice.below(Heuristic::ALL.len())];
    let tree = numbers.tree(BuildOptions::DEFAULT.with_heuristic(heuristic), &polygons);
    let mut overlay = Overlay::new(&tree);
    for _ in 0..8 {
        let fragment = tree.fragment(dice.below(tree.len()) as u32);
        let (host, corners) = (fragment.face(), &polygons[fragment.polygon()]);
        // Narrow polygons may lie on planes at large angles.
        let is_narrow = |width: f64| width.is_nan() || width <= 20.0 * tree.stats().tolerance;
        if is_narrow(width(corners)) {
            continue;
        }
        // A plane of the tree that cuts the host separates parts within the tolerance of that plane.
        if tree.fragments().filter(|f| f.face() == host).count() > 1 {
            continue;
        }
        let [p, q, r] = [0, 1, 2].map(|i| corners[i]);
        let (x, y, size) = (dice.range(0.1, 0.8), dice.range(0.1, 0.8), 0.1 * dice.share());
        let mut inside = || {
            let [x, y] = [x + size * dice.share(), y + size * dice.share()];
            let [x, y] = if x + y < 0.97 { [x, y] } else { [0.97 - y, 0.97 - x].map(|c| c.abs()) };
            numbers.round(p + (q - p) * x + (r - p) * y)
        };
        let card = [inside(), inside(), inside()];
        let kind = dice.below(3);
        if is_narrow([width(&card), card[0].distance(card[1]), f64::INFINITY][kind]) {
            continue;
        }
        let used = &card[..3 - kind];
        let (shape, none): ([Corners; 1], &[Corners]) = ([used.to_vec()], &[]);
        let is_on_grid = match kind {
            0 => numbers.replace(&mut overlay, &tree, [&shape, none], &[]),
            1 => numbers.replace(&mut overlay, &tree, [none, &shape], &[]),
            _ => numbers.replace(&mut overlay, &tree, [none; 2], used),
        };
        if !is_on_grid || overlay.is_empty() {
            continue;
        }
        let faces = overlay.faces();
        let on_grid = used.iter().map(|p| faces.lattice().snap(*p));
        let on_grid: Vec<[f64; 3]> = on_grid.collect();
        if !are_on(faces, host, &on_grid) {
            continue;
        }
        let leaves = |other: u32| {
            other != host
                && are_on(faces, other, &on_grid)
                && !are_on(faces, other, faces.corners(host))
        };
        let flat = |p: DVec3| (turn.inverse() * (p - middle)).truncate();
        if is_apart(&tree, fragment.index(), &polygons, used, flat) {
            judged.apart += 1;
            continue;
        }
        judged.shapes[kind] += 1;
        judged.on_two_planes += usize::from((0..tree.faces().len() as u32).any(leaves));
        for sign in [1.0, -1.0] {
            let direction = sign * (turn * DVec3::Z + 0.3 * dice.point(-1.0, 1.0));
            let order = overlay.order(&tree, Viewpoint::direction(direction)).expect("its tree");
            let mut is_behind = false;
            for shape in order {
                is_behind |= matches!(shape, Shape::Fragment(f) if f.index() == fragment.index());
                let is_own = shape.index() as usize >= tree.len();
                assert!(is_behind || !is_own, "{numbers:?} {heuristic} {card:?} {polygons:?}");
            }
        }
    }
}

#[test]
fn shapes_within_a_polygon_of_a_wall_come_after_it() {
    for numbers in [Numbers::Single, Numbers::Decimal(4), Numbers::Decimal(6)] {
        let mut judged = Judged::default();
        for seed in seeds(700) {
            judge(&mut Dice(seed), numbers, &mut judged);
        }
        let Judged { shapes, on_two_planes, apart } = judged;
        enough!(shapes.iter().all(|&n| n > 250), on_two_planes > 60; "{shapes:?} {on_two_planes}");
        let all = apart + shapes.iter().sum::<usize>();
        assert!(8 * apart < all, "{apart} of {all}");
    }
}
