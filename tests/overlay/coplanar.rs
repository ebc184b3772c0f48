//! Coplanar polygons, lines and points come in input order. An empty overlay changes nothing.

use binspace::overlay::{Overlay, Shape, Shapes};
use testkit::prelude::*;

fn square(x: f64, z: f64) -> Vec<DVec3> {
    let point = |a: f64, b: f64| dvec3(x + a, b, z);
    vec![point(0.0, 0.0), point(2.0, 0.0), point(2.0, 2.0), point(0.0, 2.0)]
}

/// A decal lies over coplanar polygons, from both sides, in leaves and on planes of nodes.
#[test]
fn decals_come_after_the_polygon_below() {
    let still: Vec<_> = (0..40).map(|k| square(f64::from(k), f64::from(k % 3))).collect();
    let bounds = [DVec3::splat(-1.0), DVec3::splat(50.0)];
    let options = BuildOptions::DEFAULT.with_bounds(bounds[0], bounds[1]);
    let tree = options.build(&still).expect("a tree");
    let mut overlay = Overlay::new(&tree);
    let mut reversed = square(7.5, 1.0);
    reversed.reverse();
    let decals = [square(6.5, 1.0), square(7.0, 1.0), reversed, square(6.0, 1.0 + 1e-9)];
    overlay.replace(&tree, &decals).expect("on the grid");
    for z in [9.0, -9.0] {
        for viewpoint in [Viewpoint::eye([7.0, 1.0, z]), Viewpoint::direction([0.0, 0.1, -z])] {
            let order = overlay.order(&tree, viewpoint).expect("its own tree");
            let order = order.into_iter().filter_map(Shape::fragment);
            let layer = |z: f64| (z - 1.0).abs() < 1e-6;
            let level = order.filter(|f| layer(f.vertices().next().expect("a vertex").z));
            let near = level.filter(|f| (5..=8).contains(&f.polygon()) || f.polygon() >= 40);
            let polygons: Vec<usize> = near.map(|f| f.polygon()).collect();
            let place = |wanted: usize| {
                let mut places = (0..polygons.len()).filter(move |&at| polygons[at] == wanted);
                [places.clone().next(), places.next_back()].map(|place| place.expect("a place"))
            };
            let place = |wanted| place.clone()(wanted);
            for pair in [7, 40, 41, 42, 43].windows(2) {
                assert!(place(pair[0])[1] < place(pair[1])[0], "{pair:?} from {viewpoint:?}");
            }
        }
    }
}

#[test]
fn an_overlay_of_nothing_gives_the_order_of_the_tree() {
    for scene in [scene::city(400, 2), scene::random_triangles(60, 3), scene::chain(1)] {
        let tree = BspTree::build(scene.polygons()).expect("within budget");
        let mut overlay = Overlay::new(&tree);
        let (mut order, mut still) = (Vec::new(), Vec::new());
        for round in 0..4 {
            let eye = Viewpoint::eye([f64::from(round), 2.0, 3.0]);
            let moving = (round == 2).then(|| scene.polygons().next().expect("a polygon"));
            overlay.replace(&tree, moving).expect("on the grid");
            overlay.order(&tree, eye).expect("its own tree").write_into(&mut order);
            tree.back_to_front_into(eye, &mut still);
            assert_eq!(overlay.is_empty(), round != 2);
            assert_eq!(order == still, round != 2, "{}", scene.name());
            let listed = overlay.order(&tree, eye).expect("its own tree");
            assert!(listed.into_iter().map(|f| f.index()).eq(order.iter().copied()));
        }
    }
}

/// If the tree is empty, the overlay orders its contents alone.
#[test]
fn an_empty_tree_can_have_an_overlay() {
    let bounds = [DVec3::splat(-5.0), DVec3::splat(5.0)];
    let options = BuildOptions::DEFAULT.with_bounds(bounds[0], bounds[1]);
    let tree = options.build(Vec::<[DVec3; 3]>::new()).expect("a tree of nothing");
    let mut overlay = Overlay::new(&tree);
    overlay.replace(&tree, [square(0.0, 0.5), square(0.0, 0.25), square(0.0, 0.75)]).expect("fits");
    let order = overlay.order(&tree, Viewpoint::direction([0.0, 0.0, -1.0])).expect("own");
    assert!(order.into_iter().filter_map(Shape::fragment).map(|f| f.polygon()).eq([1, 0, 2]));
}

/// Names in the order of painting: polygons, lines as `l`, points as `p`.
fn painted(tree: &BspTree, overlay: &Overlay, viewpoint: Viewpoint) -> String {
    let name = |shape: Shape<'_>| match shape {
        Shape::Fragment(fragment) => fragment.polygon().to_string(),
        Shape::Segment(segment) => format!("l{}", segment.line()),
        Shape::Marker(marker) => format!("p{}", marker.point()),
        _ => unreachable!(),
    };
    let order = overlay.order(tree, viewpoint).expect("its own tree");
    order.into_iter().map(name).collect::<Vec<_>>().join(" ")
}

const BOTH_SIDES: [f64; 2] = [9.0, -9.0];

fn from(z: f64) -> Viewpoint {
    Viewpoint::eye([0.5, 0.25, z])
}

fn tree_of(squares: &[f64], tolerance: f64) -> BspTree {
    let options = BuildOptions::DEFAULT.with_tolerance(tolerance);
    let options = options.with_bounds(DVec3::splat(-4.0), DVec3::splat(4.0));
    options.build(squares.iter().map(|&z| square(0.0, z))).expect("a tree")
}

#[test]
fn lines_and_points_of_a_plane_come_after_its_polygons_in_input_order() {
    let tree = tree_of(&[0.0], 0.0);
    let mut overlay = Overlay::new(&tree);
    let mut decal = square(1.0, 0.0);
    decal.reverse();
    let cross = [
        [dvec3(0.0, 0.0, 0.0), dvec3(2.0, 2.0, 0.0)],
        [dvec3(0.0, 2.0, 0.0), dvec3(2.0, 0.0, 0.0)],
    ];
    // Points beyond the polygons but in their plane, and a point on a corner.
    let points = [dvec3(3.0, 3.0, 0.0), dvec3(1.0, 1.0, 0.0), dvec3(0.0, 0.0, 0.0)];
    let shapes = Shapes::NONE.with_polygons([decal]).with_lines(cross).with_points(points);
    overlay.replace_with(&tree, shapes).expect("on the grid");
    for z in BOTH_SIDES {
        assert_eq!(painted(&tree, &overlay, from(z)), "0 1 l0 l1 p0 p1 p2");
    }
    // The order is the same if the polygons move and the tree is empty, so all is in one cell.
    let tree = tree_of(&[], 0.0);
    let mut overlay = Overlay::new(&tree);
    let shapes = Shapes::NONE.with_polygons([square(0.0, 0.0), square(1.0, 0.0)]);
    let shapes = shapes.with_lines(cross).with_points(points);
    overlay.replace_with(&tree, shapes).expect("on the grid");
    for z in BOTH_SIDES {
        assert_eq!(painted(&tree, &overlay, from(z)), "0 1 l0 l1 p0 p1 p2");
    }
    // Lines and points without a polygon.
    let shapes = Shapes::NONE.with_lines(cross).with_points(points);
    overlay.replace_with(&tree, shapes).expect("on the grid");
    for z in BOTH_SIDES {
        assert_eq!(painted(&tree, &overlay, from(z)), "l0 l1 p0 p1 p2");
    }
}

/// A flat drawing needs no cuts, wherever its lines cross, even if its plane is tilted and rounded.
#[test]
fn lines_of_one_plane_do_not_cut_each_other() {
    let tree = tree_of(&[], 1e-9);
    let (u, v) = (dvec3(0.3, 0.8, -0.1), dvec3(-0.7, 0.2, 0.55));
    let star: Vec<DVec3> = (0..=25)
        .map(|k| {
            let angle = f64::from(k * 7 % 25) / 25.0 * std::f64::consts::TAU;
            u * angle.cos() + v * angle.sin()
        })
        .collect();
    let mut overlay = Overlay::new(&tree);
    let rules = (0..9).map(|k| {
        let at = 0.25 * f64::from(k) - 1.0;
        vec![dvec3(at, -1.0, 1.5), dvec3(at, 1.0, 1.5)]
    });
    let across = rules.clone().map(|ends| ends.iter().map(|p| dvec3(p.y, p.x, p.z)).collect());
    let lines: Vec<Vec<DVec3>> = [star].into_iter().chain(rules).chain(across).collect();
    overlay.replace_with(&tree, Shapes::NONE.with_lines(&lines)).expect("on the grid");
    assert_eq!(overlay.len(), 25 + 18);
}

#[test]
fn a_line_goes_through_a_polygon_in_two_pieces() {
    let tree = tree_of(&[0.0], 0.0);
    let mut overlay = Overlay::new(&tree);
    let post = [dvec3(1.0, 1.0, -1.0), dvec3(1.0, 1.5, 3.0)];
    let shapes = Shapes::NONE.with_lines([post]).with_points([dvec3(1.0, 1.125, 0.0)]);
    overlay.replace_with(&tree, shapes).expect("on the grid");
    for (z, shares) in [(9.0, [[0.0, 0.25], [0.25, 1.0]]), (-9.0, [[0.25, 1.0], [0.0, 0.25]])] {
        let order = overlay.order(&tree, from(z)).expect("its own tree");
        let mut found = Vec::new();
        for shape in order {
            if let Shape::Segment(piece) = shape {
                assert_eq!((piece.line(), piece.number()), (0, 0));
                let at = |share: f64| post[0] + (post[1] - post[0]) * share;
                assert_eq!(piece.ends(), piece.shares().map(at));
                assert_eq!(piece.cuts(), piece.shares().map(|share| share == 0.25));
                found.push(piece.shares());
            }
        }
        assert_eq!(found, shares);
        assert_eq!(painted(&tree, &overlay, from(z)), "l0 0 p0 l0");
    }
}

/// A polygon that reaches no further from a plane than the tolerance lies on the plane. A polygon that
/// reaches further on one side is not cut if it reaches less than the tolerance on the other side.
#[test]
fn the_tolerance_counts_for_lines_and_points_as_for_polygons() {
    let tree = tree_of(&[0.0], 0.01);
    let mut overlay = Overlay::new(&tree);
    let line = |low: f64, high: f64| [dvec3(0.5, 0.5, low), dvec3(1.5, 1.5, high)];
    for (ends, [above, below]) in [
        ([-0.009, 0.009], ["0 l0", "0 l0"]),
        ([-0.009, -0.009], ["0 l0", "0 l0"]),
        ([-0.009, 0.5], ["0 l0", "l0 0"]),
        ([-0.5, 0.009], ["l0 0", "0 l0"]),
        ([0.011, 0.011], ["0 l0", "l0 0"]),
        ([-0.011, 0.011], ["l0 0 l0", "l0 0 l0"]),
    ] {
        let shapes = Shapes::NONE.with_lines([line(ends[0], ends[1])]);
        overlay.replace_with(&tree, shapes).expect("on the grid");
        assert_eq!(painted(&tree, &overlay, from(9.0)), above, "{ends:?}");
        assert_eq!(painted(&tree, &overlay, from(-9.0)), below, "{ends:?}");
    }
    for (z, [above, below]) in
        [(0.009, ["0 p0", "0 p0"]), (-0.009, ["0 p0", "0 p0"]), (0.011, ["0 p0", "p0 0"])]
    {
        let shapes = Shapes::NONE.with_points([dvec3(1.0, 1.0, z)]);
        overlay.replace_with(&tree, shapes).expect("on the grid");
        assert_eq!(painted(&tree, &overlay, from(9.0)), above, "{z}");
        assert_eq!(painted(&tree, &overlay, from(-9.0)), below, "{z}");
    }
}

#[test]
fn lines_of_no_length_have_no_piece() {
    let tree = tree_of(&[0.0], 0.0);
    let mut overlay = Overlay::new(&tree);
    let at = dvec3(1.0, 1.0, 1.0);
    let lines: [Vec<DVec3>; 4] =
        [vec![], vec![at], vec![at, at], vec![at, at, at + DVec3::X, at + DVec3::X]];
    overlay.replace_with(&tree, Shapes::NONE.with_lines(&lines)).expect("on the grid");
    assert_eq!(overlay.len(), 1);
    let Some(Shape::Segment(piece)) = overlay.shape(1) else { panic!("no segment") };
    assert_eq!((piece.line(), piece.number(), piece.index()), (3, 1, 1));
    assert!(overlay.piece(1).is_none() && overlay.shape(0).is_none() && overlay.shape(2).is_none());
}

/// The corners of a card in `f32` are further behind a wall in `f64` than the tree's tolerance. So are lines and
/// points.
#[test]
fn shapes_of_single_precision_lie_on_a_wall_of_double_precision() {
    let wall = [[-1.0, -1.0, -0.5], [1.0, -1.0, 0.1], [1.0, 1.0, 0.5], [-1.0, 1.0, -0.1]];
    let at = |x: f64, y: f64| [x as f32, y as f32, (0.3 * x + 0.2 * y) as f32];
    let mut judged = 0;
    for (options, is_on) in
        [(BuildOptions::DEFAULT, true), (BuildOptions::DEFAULT.with_tolerance(0.0), false)]
    {
        let tree = options.build([wall]).expect("a tree");
        let mut overlay = Overlay::new(&tree);
        let mut dice = Dice(4);
        let mut behind = 0;
        for _ in 0..60 {
            let [x, y] = [(); 2].map(|()| dice.range(-0.9, 0.7));
            let card = [at(x, y), at(x + 0.1, y), at(x + 0.1, y + 0.1), at(x, y + 0.1)];
            let shapes = Shapes::NONE.with_polygons([card]).with_lines([[card[0], card[2]]]);
            overlay.replace_with(&tree, shapes.with_points([card[1]])).expect("on the grid");
            for eye in [[0.1, 0.2, 5.0], [0.1, 0.2, -5.0]] {
                let mut order = Vec::new();
                overlay.order(&tree, Viewpoint::eye(eye)).expect("its tree").write_into(&mut order);
                let is_after = order.first() == Some(&0);
                assert!(is_after || !is_on, "{card:?} from {eye:?}: {order:?}");
                behind += usize::from(!is_after);
                judged += 1;
            }
        }
        assert!(is_on || behind > 30, "{behind}");
    }
    assert_eq!(judged, 240);
}
