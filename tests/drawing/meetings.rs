//! Walls whose parts meet in hard ways: fans of hundreds of triangles at a corner, and T-junctions. They hide
//! everything behind them, until a part is missing.

use super::map_with;
use testkit::fill::{Score, check};
use testkit::layered::{Layers, check_mixed};
use testkit::prelude::*;

fn camera() -> Camera {
    let eye = DVec3::new(3.0, 5.0, 900.0);
    Camera::perspective(eye, DVec3::ZERO, DVec3::Y, 0.9, [96, 72]).unwrap()
}

/// Whether a square is visible behind a wall. Checks the visible polygons of the wall, and that cells cover
/// the picture.
fn square_shows(wall: &[Vec<DVec3>]) -> bool {
    let square = [[-40.0, -40.0], [40.0, -40.0], [40.0, 40.0], [-40.0, 40.0]]
        .map(|[x, y]| DVec3::new(x, y, -500.0));
    let polygons: Vec<Vec<DVec3>> = wall.iter().cloned().chain([square.to_vec()]).collect();
    let tree = BspTree::build(&polygons).unwrap();
    check(&tree, &camera(), &mut Score::default()).unwrap();
    // The same scene behind a pane.
    let pane = [[-90.0, -90.0], [90.0, -90.0], [0.0, 90.0]].map(|[x, y]| DVec3::new(x, y, 300.0));
    let panes: Vec<Vec<DVec3>> = polygons.iter().cloned().chain([pane.to_vec()]).collect();
    let behind_glass = BspTree::build(&panes).unwrap();
    let opacity = |polygon: usize| if polygon == panes.len() - 1 { 0.5 } else { 1.0 };
    check_mixed(&behind_glass, &camera(), &opacity, &mut Layers::default()).unwrap();
    let through = map_with(&behind_glass, &camera(), opacity);
    let map = tree.visibility(&camera(), &ViewOptions::DEFAULT).unwrap();
    let is_shown =
        |map: &VisibilityMap<'_>| map.polygons().any(|shown| shown.polygon == wall.len());
    assert_eq!(is_shown(&map), is_shown(&through));
    is_shown(&map)
}

/// Removes some parts, one at a time. Parts in the middle hide a part of the square.
fn check_parts(wall: &[Vec<DVec3>], missing: impl Iterator<Item = usize>) {
    assert!(!square_shows(wall));
    for part in missing {
        let mut rest = wall.to_vec();
        rest.remove(part);
        assert!(square_shows(&rest), "{part}");
    }
}

/// A cone of triangles whose apex is nearest to the eye, and a cone whose apex is furthest.
#[test]
fn fans_of_hundreds_of_triangles_hide_polygons_behind() {
    const COUNT: usize = 300;
    for depth in [200.0, -200.0, 0.0] {
        let apex = DVec3::new(7.0, -3.0, depth);
        let rim = |k: usize| {
            let angle = std::f64::consts::TAU * (k % COUNT) as f64 / COUNT as f64;
            // The corners are whole numbers, and not all in one plane.
            let z = if k.is_multiple_of(2) { 0.0 } else { 11.0 };
            DVec3::new((600.0 * angle.cos()).round(), (600.0 * angle.sin()).round(), z)
        };
        let fan: Vec<Vec<DVec3>> = (0..COUNT).map(|k| vec![apex, rim(k), rim(k + 1)]).collect();
        check_parts(&fan, [0, 1, 77, 150].into_iter());
    }
}

/// Bricks in a tilted plane. Each row is shifted against the next, so corners are in the middle of edges.
#[test]
fn walls_with_t_junctions_hide_polygons_behind() {
    // A rectangle of width 30 and height 20, in a plane with whole numbers.
    let corner = |x: i32, y: i32| {
        let [x, y] = [f64::from(x), f64::from(y)];
        DVec3::new(x, y, 0.0) + DVec3::new(0.0, 0.0, 2.0 * x - y)
    };
    for shift in [10, 7] {
        let mut wall = Vec::new();
        for row in -10..10 {
            for column in -9..9 {
                let (x, y) = (30 * column + shift * (row & 1), 20 * row);
                let brick = [[x, y], [x + 30, y], [x + 30, y + 20], [x, y + 20]];
                wall.push(brick.map(|[x, y]| corner(x, y)).to_vec());
            }
        }
        let middle = |row: usize, column: usize| 18 * row + column;
        check_parts(&wall, [middle(10, 9), middle(9, 8), middle(10, 8)].into_iter());
    }
}
