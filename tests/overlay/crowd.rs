//! A crowd of shapes goes to one side of a plane at once, by its box, only if each shape alone would go
//! there.

use binspace::glam::DMat3;
use binspace::overlay::{Overlay, Shape, Shapes};
use testkit::prelude::*;

/// The number of polygons above each other, each slightly tilted, and the number of lines: enough that the
/// builder tests their box.
const LAYERS: usize = 140;

/// Returns, for each polygon and then for each line, whether it has pieces before and after the only polygon
/// of the tree in the order, seen from above and from below.
fn sides(tree: &BspTree, polygons: &[[DVec3; 3]], lines: &[[DVec3; 2]]) -> Vec<[[bool; 2]; 2]> {
    let mut overlay = Overlay::new(tree);
    let shapes = Shapes::NONE.with_polygons(polygons).with_lines(lines);
    overlay.replace_with(tree, shapes).expect("on the grid");
    let mut sides = vec![[[false; 2]; 2]; polygons.len() + lines.len()];
    let down = -tree.root().expect("a node").normal();
    for (view, direction) in [down, -down].into_iter().enumerate() {
        let viewpoint = Viewpoint::direction(direction);
        let mut side = 0;
        for shape in overlay.order(tree, viewpoint).expect("its own tree") {
            match shape {
                Shape::Fragment(floor) if floor.polygon() == 0 => side = 1,
                Shape::Fragment(piece) => sides[piece.polygon() - 1][view][side] = true,
                Shape::Segment(piece) => sides[polygons.len() + piece.line()][view][side] = true,
                _ => unreachable!(),
            }
        }
    }
    sides
}

/// The lowest polygon reaches a plane, or misses it or goes through it by any length. Polygons of the crowd
/// are cut as if each were alone.
#[test]
fn polygons_of_a_crowd_are_cut_as_if_each_were_alone() {
    let turns = [DMat3::IDENTITY, DMat3::from_rotation_y(1.0), DMat3::from_rotation_x(2.3)];
    let (mut compared, mut cut) = (0, 0);
    for (turn, tolerance) in turns.into_iter().flat_map(|turn| [0.0, 1e-3].map(|t| (turn, t))) {
        let floor = [(-1.0, -1.0), (2.0, -1.0), (2.0, 2.0), (-1.0, 2.0)];
        let floor = floor.map(|(x, y)| turn * dvec3(x, y, 0.0));
        let options = BuildOptions::DEFAULT.with_tolerance(tolerance);
        let room = DVec3::splat(300.0);
        let tree = options.with_bounds(-room, room).build([floor]).expect("a tree");
        for depth in [0.0, 1e-13, 1e-10, 1e-5, 0.9e-3, 1.1e-3, 1e-2, 0.1, 0.3, 5.3] {
            for (sign, above) in [-1.0, 1.0].into_iter().flat_map(|s| [(s, 1.0), (s, -1.0)]) {
                let at = |k: usize, x: f64, y: f64, z: f64| {
                    turn * dvec3(x, y, above * (k as f64 + z + sign * depth))
                };
                let triangle = |k: usize| {
                    let rise = [0.0, 0.2][k % 2];
                    [at(k, 0.0, 0.0, 0.0), at(k, 1.0, 0.0, rise), at(k, 0.0, 1.0, 2.0 * rise)]
                };
                let line = |k| [at(k, 0.5, 0.1, 0.0), at(k, 0.1, 0.5, 0.3)];
                let polygons: Vec<_> = (0..LAYERS).map(triangle).collect();
                let lines: Vec<_> = (0..LAYERS).map(line).collect();
                let together = sides(&tree, &polygons, &lines);
                for k in 0..LAYERS {
                    let alone = sides(&tree, &polygons[k..=k], &lines[k..=k]);
                    let found = [together[k], together[LAYERS + k]];
                    assert_eq!(alone, found, "{k} {depth} {sign} {above} {tolerance}");
                    cut += alone.iter().filter(|sides| sides[0] == [true; 2]).count();
                }
                compared += 1;
            }
        }
    }
    assert!(compared == 240 && (60..240).contains(&cut), "{cut} in {compared}");
}

/// The place of one crowd does not decide the place of the next.
#[test]
fn crowds_in_several_leaves_are_placed_each_by_its_own_box() {
    let wall =
        |x: f64| [[-1.0, -1.0], [9.0, -1.0], [9.0, 9.0], [-1.0, 9.0]].map(|[y, z]| dvec3(x, y, z));
    let walls = [0.0, 10.0, 20.0, 30.0, 40.0].map(wall);
    let room = DVec3::splat(100.0);
    let tree = BuildOptions::DEFAULT.with_bounds(-room, room).build(walls).expect("a tree");
    let mut overlay = Overlay::new(&tree);
    let mut checked = 0;
    // The slabs between walls in which the crowds are.
    for slabs in [vec![0, 2], vec![2, 0], vec![3, 1], vec![0, 1, 2, 3], vec![3, 2, 1, 0]] {
        let of_slab = |&slab: &usize| {
            (0..300).map(move |k| {
                let at = dvec3(10.0 * slab as f64 + 1.0, 0.01 * f64::from(k), 0.0);
                [at, at + dvec3(8.0, 0.001, 0.0), at + dvec3(4.0, 0.0, 1.0)]
            })
        };
        let crowds: Vec<[DVec3; 3]> = slabs.iter().flat_map(of_slab).collect();
        overlay.replace(&tree, &crowds).expect("on the grid");
        // Along x: wall 0, all of slab 0, wall 1, and so on.
        let view = Viewpoint::direction([-1.0, 0.0, 0.0]);
        let mut behind = 0;
        for shape in overlay.order(&tree, view).expect("its own tree") {
            let fragment = shape.fragment().expect("a polygon");
            match fragment.polygon().checked_sub(walls.len()) {
                None => behind = fragment.polygon() + 1,
                Some(moving) => {
                    assert_eq!(slabs[moving / 300] + 1, behind, "{slabs:?}: {moving}");
                    checked += 1;
                }
            }
        }
    }
    enough!(checked >= 5 * 600; "{checked}");
}

/// A crowd of points on one side of a polygon of the overlay, and another polygon on the other side.
#[test]
fn polygons_across_a_plane_from_a_crowd_stay() {
    let room = DVec3::splat(9.0);
    let none: [[DVec3; 3]; 0] = [];
    let tree = BuildOptions::DEFAULT.with_bounds(-room, room).build(none).expect("a tree");
    for (side, is_turned) in [1.0, -1.0].into_iter().flat_map(|side| [(side, false), (side, true)])
    {
        let square = |height: f64| {
            let mut corners = [(0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (0.0, 4.0)];
            if is_turned {
                corners.reverse();
            }
            corners.map(|(x, y)| dvec3(x, y, side * height))
        };
        let crowd = (0..300).map(|k| dvec3(0.01 * f64::from(k), 1.0, side * 5.0));
        let mut overlay = Overlay::new(&tree);
        let shapes = Shapes::NONE.with_polygons([1.0, 0.0, 2.0].map(square)).with_points(crowd);
        overlay.replace_with(&tree, shapes).expect("on the grid");
        let toward_crowd = Viewpoint::direction([0.0, 0.0, -side]);
        let order = overlay.order(&tree, toward_crowd).expect("its own tree");
        let polygons =
            order.into_iter().map(|shape| shape.fragment().map(|polygon| polygon.polygon()));
        let expected = [1, 0, 2].map(Some).into_iter().chain([None; 300]);
        assert!(polygons.eq(expected), "{side} {is_turned}");
    }
}
