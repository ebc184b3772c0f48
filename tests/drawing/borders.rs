//! Edges over a grid. Many lie along borders of the picture and of its tiles, and on cuts of other polygons.

use super::sheets::{Sheet, from_above, stack, tree_of};
use super::{map_of, map_with};
use std::collections::BTreeMap;
use testkit::prelude::*;

/// The ends of an edge, the lower first.
type Ends = [[i64; 3]; 2];

/// A corner of a sheet.
fn corner(sheet: &Sheet, k: usize) -> [i64; 3] {
    sheet.corners()[k % 4].map(|c| c as i64)
}

fn ends(sheet: &Sheet, k: usize) -> Ends {
    let mut ends = [corner(sheet, k), corner(sheet, k + 1)];
    ends.sort();
    ends
}

/// The middles of halves of the grid's sides between two places, in quarters.
fn halves([a, b]: [[i64; 2]; 2]) -> impl Iterator<Item = [i64; 2]> {
    let count = (b[0] - a[0]).abs().max((b[1] - a[1]).abs()) / 2;
    let way = [0, 1].map(|axis: usize| (b[axis] - a[axis]).signum());
    (0..count).map(move |i| [0, 1].map(|axis: usize| a[axis] + (2 * i + 1) * way[axis]))
}

/// The halves of edges in the picture, by edge and middle, and whether each is visible. The sheet of an edge
/// covers half of a square beside each half of the edge. The half of the edge is in the picture, or visible,
/// if this half of the square is. Two sheets side by side in one plane have no edge between them.
fn expected(sheets: &[Sheet], picture: [i64; 2]) -> BTreeMap<(Ends, [i64; 2]), bool> {
    let mut found = BTreeMap::new();
    let is_inside_a_plane = |common: &Ends| {
        let numbered = sheets.iter().flat_map(|sheet| (0..4).map(move |k| (sheet, k)));
        let own: Vec<_> = numbered.filter(|&(sheet, k)| ends(sheet, k) == *common).collect();
        let plane = |sheet: &Sheet| (sheet.slope, sheet.height);
        matches!(own[..], [(a, i), (b, k)] if plane(a) == plane(b) && i != k)
    };
    for (i, sheet) in sheets.iter().enumerate() {
        for k in 0..4 {
            let ends = ends(sheet, k);
            if is_inside_a_plane(&ends) {
                continue;
            }
            for [x, y] in halves(ends.map(|[x, y, _]| [4 * x, 4 * y])) {
                let inside = match k {
                    0 => [x - 1, y],
                    1 => [x - 2, y - 1],
                    2 => [x - 1, y - 2],
                    _ => [x, y - 1],
                };
                let at = inside.map(|c| c / 2);
                if at.iter().any(|c| !(picture[0]..picture[1]).contains(c)) {
                    continue;
                }
                let stack = stack(sheets, at);
                let before = stack.iter().take_while(|&&other| other != i);
                let shows = before.filter(|&&other| sheets[other].is_opaque).count() == 0;
                *found.entry((ends, [x, y])).or_default() |= shows;
            }
        }
    }
    found
}

#[test]
fn edges_over_a_grid_are_hidden_only_by_polygons_over_them() {
    let mut dice = Dice(11);
    let (mut visible, mut hidden) = (0, 0);
    for round in 0..2000 {
        let mut sheets: Vec<Sheet> =
            (0..1 + dice.below(6)).map(|_| Sheet::new(&mut dice)).collect();
        if round % 5 == 0 {
            sheets.iter_mut().for_each(|sheet| sheet.high = sheet.low.map(|c| c + 1));
        }
        let tree = tree_of(&sheets.iter().map(Sheet::corners).collect::<Vec<_>>());
        // Pictures of the whole grid and of its middle. Polygons end exactly on the border only if rays are
        // not rounded.
        let (height, side) = [(8, 64), (4, 64), (4, 1), (8, 1), (12, 37), (2, 4)][round % 6];
        let camera = from_above(f64::from(height), [side; 2]);
        let opacity = |polygon: usize| if sheets[polygon].is_opaque { 1.0 } else { 0.5 };
        let map = map_with(&tree, &camera, opacity);
        let mut found = BTreeMap::new();
        for run in map.edges(Hidden::Keep).unwrap() {
            // In quarters.
            let scale = 4.0 * f64::from(height) / f64::from(side);
            let middle = 0.5 * f64::from(side);
            let place = |[x, y]: [f64; 2]| [x - middle, middle - y].map(|c| 16.0 + c * scale);
            let places = run.ends.map(place);
            assert!(places.iter().flatten().all(|c| (c - c.round()).abs() < 1e-6), "{places:?}");
            let edge = ends(&sheets[run.polygon], run.edge.unwrap() as usize);
            for middle in halves(places.map(|place| place.map(|c| c.round() as i64))) {
                *if run.is_visible { &mut visible } else { &mut hidden } += 1;
                let before = found.insert((edge, middle), run.is_visible);
                assert_eq!(before, None, "{round}: {sheets:?}");
            }
        }
        let reach = i64::from(height);
        let expected = expected(&sheets, [8 - reach, 8 + reach]);
        assert_eq!(found, expected, "{round}: {sheets:?}");
    }
    assert!(visible > 10_000 && hidden > 5_000, "{visible} {hidden}");
}

/// A roof, and a plank that goes through it along its ridge. If the ridge is on a border of the picture, the
/// picture shows only one side of it.
#[test]
fn a_crossing_along_a_border_is_not_in_the_picture() {
    let roof = [[2.0, 2.0, 0.0], [4.0, 8.0, -1.0], [2.0, 5.0, 0.0], [0.0, 8.0, -1.0]];
    let plank = [[0.0, 3.0, -1.5], [4.0, 3.0, 1.5], [4.0, 4.0, 1.5], [0.0, 4.0, -1.5]];
    let tree = tree_of(&[roof, plank].map(Vec::from));
    for (height, count) in [(8.0, 1), (4.0, 0)] {
        let camera = from_above(height, [64; 2]);
        let map = map_of(&tree, &camera);
        let (shown, all) =
            (map.crossings(Hidden::Skip).unwrap(), map.crossings(Hidden::Keep).unwrap());
        assert_eq!([shown.len(), all.len()], [count; 2], "{all:?}");
    }
}
