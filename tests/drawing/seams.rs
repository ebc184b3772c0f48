//! Outlines of regions and paths go around areas, and never along a line within an area. Nearly everything in
//! these scenes lies on a grid. So cuts coincide with edges of other polygons, and edges coincide with
//! borders of the picture's tiles.

use super::sheets::{Corners, Sheet, from_above, stack, tree_of};
use super::{map_of, map_with};
use binspace::drawing::Drawing;
use std::collections::{BTreeMap, BTreeSet};
use testkit::prelude::*;

type Outline = Vec<[f64; 2]>;

fn sides(outlines: &[Outline]) -> impl Iterator<Item = [[f64; 2]; 2]> + Clone {
    let sides = |outline: &'_ Outline| {
        let next = outline[1..].iter().chain(&outline[..1]);
        outline.iter().zip(next).map(|(a, b)| [*a, *b]).collect::<Vec<_>>()
    };
    outlines.iter().flat_map(sides).collect::<Vec<_>>().into_iter()
}

fn length([a, b]: [[f64; 2]; 2]) -> f64 {
    (b[0] - a[0]).hypot(b[1] - a[1])
}

/// The length of the longest seam. A seam is the common part of two sides of outlines that run in opposite
/// directions.
fn seam(outlines: &[Outline]) -> f64 {
    let mut longest = 0.0_f64;
    for (i, one) in sides(outlines).enumerate().filter(|(_, side)| length(*side) > 1e-3) {
        let [from, to] = one;
        let way = [0, 1].map(|axis: usize| (to[axis] - from[axis]) / length(one));
        let along = |at: [f64; 2]| way[0] * (at[0] - from[0]) + way[1] * (at[1] - from[1]);
        let beside = |at: [f64; 2]| way[0] * (at[1] - from[1]) - way[1] * (at[0] - from[0]);
        for [a, b] in sides(outlines).skip(i + 1) {
            if along(b) < along(a) && beside(a).abs() < 1e-6 && beside(b).abs() < 1e-6 {
                longest = longest.max(along(a).min(length(one)) - along(b).max(0.0));
            }
        }
    }
    longest
}

/// All outlines of a drawn view, grouped by the fill, with a description.
fn outlines(tree: &BspTree, camera: &Camera, opacities: &[f64]) -> Vec<(String, Vec<Outline>)> {
    let map = map_with(tree, camera, |polygon| opacities[polygon]);
    let copy = |outlines: &mut dyn Iterator<Item = &[[f64; 2]]>| {
        outlines.map(<[_]>::to_vec).collect::<Vec<Outline>>()
    };
    let mut all = Vec::new();
    for region in map.regions().unwrap() {
        let name = format!("region {:?}", region.polygons());
        all.push((name, copy(&mut region.outlines())));
    }
    let drawings = [
        map.drawing().unwrap(),
        Drawing::translucent(tree, camera, &ViewOptions::DEFAULT, None).unwrap(),
    ];
    for path in drawings.iter().flat_map(Drawing::paths) {
        all.push((format!("path of {}", path.polygon()), copy(&mut path.outlines())));
    }
    all
}

/// The fault of a view's outlines: seams, and outlines of less than three corners.
fn fault(tree: &BspTree, camera: &Camera, opacities: &[f64]) -> Option<String> {
    outlines(tree, camera, opacities).into_iter().find_map(|(name, outlines)| {
        let seam = seam(&outlines);
        let least = outlines.iter().map(Vec::len).min();
        (seam > 1e-3 || least < Some(3)).then(|| format!("{name}: {seam} px, {outlines:?}"))
    })
}

fn from_the_south() -> Camera {
    let (eye, target) = (DVec3::new(4.5, -17.0, 19.0), DVec3::new(4.0, 4.0, 0.0));
    Camera::perspective_by_slope(eye, target, DVec3::Z, 0.25, [250, 250]).unwrap()
}

/// A cut of one polygon lies on an edge of another polygon.
#[test]
fn a_region_has_no_seam_along_a_cut_on_an_edge() {
    let polygons = [
        [[4.0, 0.0, -2.0], [8.0, 0.0, -2.0], [8.0, 4.0, -2.0], [4.0, 4.0, -2.0]],
        [[4.0, 0.0, 2.0], [8.0, 0.0, 2.0], [8.0, 4.0, -2.0], [4.0, 4.0, -2.0]],
        [[4.0, 0.0, -1.0], [8.0, 0.0, -1.0], [8.0, 8.0, -1.0], [4.0, 8.0, -1.0]],
    ];
    let tree = tree_of(&polygons.map(Vec::from));
    assert_eq!(fault(&tree, &from_the_south(), &[0.5; 3]), None);
}

#[test]
fn a_clipped_path_has_no_seam_along_a_cut_on_an_edge() {
    let polygons = [
        [[0.0, 0.0, 9.0], [8.0, 0.0, 1.0], [8.0, 8.0, 1.0], [0.0, 8.0, 9.0]],
        [[4.0, 0.0, 2.0], [8.0, 0.0, 2.0], [8.0, 4.0, 2.0], [4.0, 4.0, 2.0]],
        [[0.0, 0.0, 3.0], [8.0, 0.0, 3.0], [8.0, 8.0, -5.0], [0.0, 8.0, -5.0]],
        [[4.0, 0.0, 1.0], [8.0, 0.0, 1.0], [8.0, 4.0, 5.0], [4.0, 4.0, 5.0]],
    ];
    let tree = tree_of(&polygons.map(Vec::from));
    assert_eq!(fault(&tree, &from_the_south(), &[1.0; 4]), None);
}

/// A corner lies half a step of a fine grid from each of the two places to which it may be rounded.
#[test]
fn a_corner_that_rounds_both_ways_leaves_a_region_in_one_piece() {
    let polygons = vec![
        vec![[0.0, 0.0, 0.0], [8.0, 0.0, 0.0], [8.0, 4.0, 0.0], [0.0, 4.0, 0.0]],
        vec![
            [3.5000009536743164, 4.0, 1.0],
            [3.1234247254436696, 2.5773512721061707, 1.0],
            [5.712984659171809, 1.1837414503097534, 1.0],
        ],
    ];
    let tree = tree_of(&polygons);
    let camera = from_above(8.0, [64, 64]);
    let map = map_of(&tree, &camera);
    // The rectangle, and the triangle, which touches the border of the rectangle with a corner.
    let regions = map.regions().unwrap();
    assert_eq!(regions[0].outlines().map(<[_]>::len).collect::<BTreeSet<_>>(), [3, 4].into());
    assert_eq!(fault(&tree, &camera, &[1.0; 2]), None);
}

/// Halves of squares.
type Area = BTreeSet<[i64; 2]>;

/// The length of an area's border, in halves of squares, and its number of corners.
fn border(area: &Area) -> [usize; 2] {
    let is_in = |x: i64, y: i64| area.contains(&[x, y]);
    let (mut length, mut corners) = (0, 0);
    for &[x, y] in area {
        for [dx, dy] in [[1, 0], [0, 1], [-1, 0], [0, -1]] {
            let beside = [is_in(x + dx, y + dy), is_in(x - dy, y + dx)];
            length += usize::from(!beside[0]);
            // At the corner between the two.
            let is_corner = match beside {
                [false, false] => true,
                [true, true] => !is_in(x + dx - dy, y + dy + dx),
                _ => false,
            };
            corners += usize::from(is_corner);
        }
    }
    [length, corners]
}

/// Checks that outlines go around an area, and along no line inside it.
fn expect_border(outlines: &[Outline], area: &Area, pixels: f64, what: &str) {
    let [expected, corners] = border(area);
    let length: f64 = sides(outlines).map(length).sum();
    assert!((length - expected as f64 * pixels).abs() < 1e-6 * length, "{what}: {outlines:?}");
    assert_eq!(outlines.iter().map(Vec::len).sum::<usize>(), corners, "{what}: {outlines:?}");
}

#[test]
fn sheets_over_a_grid_have_the_borders_of_their_squares() {
    let mut dice = Dice(24);
    let (mut regions, mut clipped) = (0, 0);
    for round in 0..times(600) {
        let sheets: Vec<Sheet> = (0..2 + dice.below(6)).map(|_| Sheet::new(&mut dice)).collect();
        let tree = tree_of(&sheets.iter().map(Sheet::corners).collect::<Vec<_>>());
        // Borders of pixels are on the grid, on halves of squares, or on neither. Borders of the picture are
        // around the scene or within it.
        let [height, side] = [[8.0, 64.0], [16.0, 37.0], [8.0, 1.0], [9.75, 50.0]][round % 4];
        let camera = from_above(height, [side as u32; 2]);
        let opacity = |polygon: usize| if sheets[polygon].is_opaque { 1.0 } else { 0.5 };
        let map = map_with(&tree, &camera, opacity);
        let opaque = tree.visibility(&camera, &ViewOptions::DEFAULT).unwrap();
        // The polygons visible over each half of a square, front to back. (Of several polygons in one plane,
        // the last one comes first.)
        let mut stacks: BTreeMap<Vec<usize>, Area> = BTreeMap::new();
        let mut shown: BTreeMap<usize, Area> = BTreeMap::new();
        for at in (0..16).flat_map(|x| (0..16).map(move |y| [x, y])) {
            let stack = stack(&sheets, at);
            let Some(&first) = stack.first() else { continue };
            shown.entry(first).or_default().insert(at);
            let end = stack.iter().position(|&i| sheets[i].is_opaque);
            let stack = stack[..end.map_or(stack.len(), |end| end + 1)].to_vec();
            stacks.entry(stack).or_default().insert(at);
        }
        let pixels = side / height / 2.0;
        let what = format!("{round}: {sheets:?}");
        let found = map.regions().unwrap();
        assert!(found.iter().map(|region| region.polygons()).eq(stacks.keys()), "{what}");
        for region in found {
            let outlines: Vec<Outline> = region.outlines().map(<[_]>::to_vec).collect();
            expect_border(&outlines, &stacks[region.polygons()], pixels, &what);
            regions += 1;
        }
        for path in opaque.drawing().unwrap().paths().filter(|path| path.is_clipped()) {
            let outlines: Vec<Outline> = path.outlines().map(<[_]>::to_vec).collect();
            expect_border(&outlines, &shown[&path.polygon()], pixels, &what);
            clipped += 1;
        }
    }
    enough!(regions > 3_200, clipped > 120; "{regions} {clipped}");
}

/// The sheets of the test above, and walls, seen from all around.
#[test]
fn outlines_over_a_grid_have_no_seams() {
    let mut dice = Dice(7);
    let mut views = 0;
    for round in 0..1000 {
        let mut polygons: Vec<Corners> = Vec::new();
        for _ in 0..2 + dice.below(5) {
            let mut corners = Sheet::new(&mut dice).corners();
            let turn = dice.below(4);
            corners.iter_mut().for_each(|corner| corner.rotate_right(turn.saturating_sub(1)));
            polygons.push(corners);
        }
        let opacities: Vec<f64> = polygons.iter().map(|_| [1.0, 0.5][dice.below(2)]).collect();
        let tree = tree_of(&polygons);
        let [x, y, z] = [9, 17, 12].map(|n| dice.around_zero(n) + 0.5 * dice.around_zero(1));
        let (target, size) = (DVec3::splat(4.0), [[250, 250], [64, 64], [33, 90]][round % 3]);
        let eye = DVec3::new(x, y, z + 13.0);
        let camera = match round % 4 {
            0 => Camera::parallel(target - eye, DVec3::Z, target, 12.0, size),
            _ => Camera::perspective_by_slope(eye, target, DVec3::Z, 0.4, size),
        };
        // If the eye is right above the target, the up vector is invalid.
        let Ok(camera) = camera else { continue };
        let fault = fault(&tree, &camera, &opacities);
        assert_eq!(fault, None, "{round}: {polygons:?}, {opacities:?}, {camera:?}");
        views += 1;
    }
    assert!(views > 900, "{views}");
}
