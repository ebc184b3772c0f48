//! Whatever makes a line of the picture, it has one number.

use glam::DVec3;

use super::tests::all_lines;
use crate::BuildOptions;
use crate::drawing::exact_lines::compare;
use crate::drawing::lines::{HalfPlane, STEPS};
use crate::tree::BspTree;
use crate::view::Camera;

/// Squares on a grid, level or upright or with a slope of 1, with edges and cuts on few lines.
fn squares() -> BspTree {
    let places = (0..12).flat_map(|x| (0..12).map(move |y| [x, y]));
    let square = |[x, y]: [i32; 2]| {
        let [x0, y0] = [x, y].map(f64::from);
        let [x1, y1] = [x0 + 1.0, y0 + 2.0];
        let slope = f64::from((x + y) % 3 - 1);
        [[x0, y0], [x1, y0], [x1, y1], [x0, y1]].map(|[x, y]| DVec3::new(x, y, slope * (x - 6.0)))
    };
    let walls = (0..12)
        .map(f64::from)
        .map(|x| [[x, 0.0, -7.0], [x, 13.0, -7.0], [x, 13.0, 7.0], [x, 0.0, 7.0]].map(DVec3::from));
    let polygons: Vec<_> = places.map(square).chain(walls).collect();
    BuildOptions::DEFAULT.with_tolerance(0.0).build(&polygons).unwrap()
}

/// How many lines a picture has; no two are one, and none is a border.
fn lines(tree: &BspTree, camera: &Camera) -> usize {
    let primitives = all_lines(tree, camera).unwrap();
    let lines = &primitives.lines;
    let exact: Vec<_> = lines.keys.iter().map(|key| lines.exact_of(*key)).collect();
    for (i, line) in exact.iter().enumerate() {
        // Of what the picture shows.
        let at = lines.rounded[i].at(lines.reach.map(|side| 0.5 * side));
        if at.abs() > lines.reach[0] + lines.reach[1] {
            continue;
        }
        let other = exact[..i].iter().position(|other| compare(line, other).is_eq());
        assert_eq!(other, None, "{:?}", lines.keys[i]);
        let axis = usize::from(line[1].sign().is_eq());
        let [k0, k] = [line[0], line[axis + 1]].map(|k| k.to_f64());
        let border = lines.exact(HalfPlane::beyond(axis, (-k0 / k * STEPS).round() as i64));
        assert!(compare(line, &border).is_ne(), "{:?}", lines.keys[i]);
    }
    exact.len()
}

#[test]
fn edges_cuts_and_borders_on_one_line_are_one() {
    let (tree, middle) = (squares(), DVec3::new(6.0, 6.5, 0.0));
    for (height, size) in [(16.0, 64), (16.0, 37), (4.0, 1), (13.7, 50)] {
        let camera = Camera::parallel(DVec3::NEG_Z, DVec3::Y, middle, height, [size; 2]).unwrap();
        lines(&tree, &camera);
    }
    for eye in
        [DVec3::new(6.0, 6.5, 30.0), DVec3::new(9.3, -4.1, 22.0), DVec3::new(6.0, -20.0, 0.5)]
    {
        let camera = Camera::perspective(eye, middle, DVec3::X, 0.8, [320, 240]).unwrap();
        lines(&tree, &camera);
    }
}

/// All lines of the scene are nearer to one another than feet of lines can tell.
#[test]
fn more_lines_than_a_few_in_one_place_are_told_apart() {
    let corner = |x: i32, y: i32| DVec3::new(f64::from(x), f64::from(y), 0.0);
    let places = (0..20).flat_map(|x| (0..20).map(move |y| (x, y)));
    let tile = |(x, y)| [corner(x, y), corner(x + 1, y), corner(x + 1, y + 1), corner(x, y + 1)];
    let tree = BspTree::build(places.map(tile)).unwrap();
    let eye = DVec3::new(3.0, -5.0, 9.0) * (1u64 << 26) as f64;
    let camera = Camera::perspective(eye, DVec3::ZERO, DVec3::Z, 1.0, [64, 64]).unwrap();
    assert_eq!(lines(&tree, &camera), 42);
}
