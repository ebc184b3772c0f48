//! Scenes, views and opacities at their limits.

use super::map_with;
use binspace::overlay::{Overlay, Shapes};
use std::collections::BTreeSet;
use testkit::fill::{Score, check};
use testkit::layered::{Layers, check_mixed};
use testkit::prelude::*;
use testkit::shapes::rectangle;

fn square([x, y]: [f64; 2], half: f64, z: f64) -> Vec<DVec3> {
    rectangle([x - half, y - half], [x + half, y + half], z)
}

/// Forty thousand squares behind a wall of ten squares. With an effort of 25, a million squares, which take
/// some 20 seconds.
#[test]
fn ten_of_a_million_polygons_show() {
    let layers = times(4).min(100) as u32;
    let mut polygons: Vec<Vec<DVec3>> = Vec::new();
    for k in 0..10 {
        let [x, y] = [f64::from(k % 5) - 2.0, f64::from(k / 5) - 0.5];
        polygons.push(square([x * 400.0, y * 1000.0], 500.0, 100.0 + f64::from(k)));
    }
    for k in 0..layers * 10_000 {
        let [x, y] = [f64::from(k % 100), f64::from(k / 100 % 100)].map(|c| 2.0 * c - 100.0);
        polygons.push(square([x, y], 0.75, -f64::from(k / 10_000)));
    }
    let tree = BspTree::build(&polygons).unwrap();
    let eye = DVec3::new(10.0, 20.0, 2000.0);
    let camera = Camera::perspective(eye, DVec3::ZERO, DVec3::Y, 0.9, [640, 480]).unwrap();
    let all: Vec<usize> = (0..10).collect();
    let map = tree.visibility(&camera, &ViewOptions::DEFAULT).unwrap();
    assert_eq!(map.polygons().map(|shown| shown.polygon).collect::<Vec<_>>(), all);
    assert_eq!(map.drawing().unwrap().paths().len(), 10);
    // If the squares behind are translucent, still nothing is visible through the wall.
    let glass = |polygon: usize| if polygon < 10 { 1.0 } else { 0.5 };
    let map = map_with(&tree, &camera, glass);
    assert_eq!(map.polygons().map(|shown| shown.polygon).collect::<Vec<_>>(), all);
    assert_eq!(map.drawing().unwrap().paths().len(), 10);
    assert_eq!(map.regions().unwrap().len(), 10);
}

#[test]
fn opacities_are_numbers_from_0_to_1() {
    let tree = BspTree::build([square([0.0; 2], 1.0, 0.0), square([0.0; 2], 1.0, 1.0)]).unwrap();
    let eye = DVec3::new(0.1, 0.2, 5.0);
    let camera = Camera::perspective(eye, DVec3::ZERO, DVec3::Y, 0.9, [9, 7]).unwrap();
    for wrong in [f64::NAN, -0.001, 1.001, f64::INFINITY] {
        let opacity = |polygon: usize| if polygon == 1 { wrong } else { 0.5 };
        let options = with_opacities(&tree, opacity);
        let error = tree.visibility(&camera, &options).unwrap_err();
        assert_eq!(error.polygon(), Some(1));
        let expected =
            format!("the opacity of polygon 1 is {wrong}: expected a number from 0 to 1");
        assert_eq!(error.to_string(), expected);
    }
    let options = ViewOptions::DEFAULT.with_opacities(vec![0.5]);
    let error = tree.visibility(&camera, &options).unwrap_err();
    assert_eq!(
        error.to_string(),
        "there are 1 opacities, but 2 polygons: pass one for each polygon"
    );
    let shown = |opacities: [f64; 2]| -> Vec<usize> {
        let opacity = |polygon: usize| opacities[polygon];
        let map = map_with(&tree, &camera, opacity);
        let edges = map.edges(Hidden::Keep).unwrap();
        let shown: Vec<usize> = map.polygons().map(|shown| shown.polygon).collect();
        let visible = edges.iter().filter(|run| run.is_visible);
        let mut with_edges: Vec<usize> = visible.map(|run| run.polygon).collect();
        with_edges.dedup();
        // The square in front is larger in the picture, and hides all edges of the other.
        assert_eq!(with_edges, shown, "{opacities:?}");
        let drawn: Vec<usize> = map.drawing().unwrap().paths().map(|path| path.polygon()).collect();
        assert_eq!(drawn, shown, "{opacities:?}");
        drawn
    };
    for (opacities, expected) in [
        ([1.0, 1.0], vec![1]),
        ([1.0, 0.5], vec![0, 1]),
        ([0.5, 1.0], vec![1]),
        ([0.25, 0.5], vec![0, 1]),
        ([1.0, 0.0], vec![0]),
        ([1.0, -0.0], vec![0]),
        ([0.0, 0.5], vec![1]),
        ([0.0, 0.0], vec![]),
        ([f64::MIN_POSITIVE, 1.0f64.next_down()], vec![0, 1]),
    ] {
        assert_eq!(shown(opacities), expected, "{opacities:?}");
    }
}

/// An eye on a polygon sees the polygon edge-on, so nothing of it. An eye behind everything sees nothing. The
/// number of visible polygons is stated for two panes in front of walls, and for walls alone, which hide
/// more.
#[test]
fn eyes_on_polygons_and_away_from_all() {
    let polygons = [
        square([0.0; 2], 1.0, 0.0),
        square([0.5, 0.0], 1.0, -1.0),
        square([0.0, 0.5], 1.0, -2.0),
        square([0.0; 2], 3.0, -3.0),
    ];
    let tree = BspTree::build(&polygons).unwrap();
    let mut score = Layers::default();
    for (eye, target, expected) in [
        (DVec3::new(0.0, 0.0, 5.0), DVec3::ZERO, [4, 4]),
        (DVec3::new(0.2, 0.1, 0.0), DVec3::NEG_Z, [3, 2]),
        (DVec3::new(0.2, 0.1, -1.0), DVec3::NEG_Z * 2.0, [2, 2]),
        (DVec3::new(2.5, 0.5, 0.0), DVec3::ZERO, [3, 2]),
        (DVec3::new(0.0, 0.0, -50.0), DVec3::new(0.0, 0.0, -90.0), [0, 0]),
    ] {
        for size in [[1, 1], [50, 40], [300, 2]] {
            let camera = Camera::perspective(eye, target, DVec3::Y, 1.2, size).unwrap();
            let all = Drawing::translucent(&tree, &camera, &ViewOptions::DEFAULT, None).unwrap();
            check(&tree, &camera, &mut Score::default()).unwrap();
            for (opacities, expected) in [[0.5, 0.25, 1.0, 1.0], [1.0; 4]].into_iter().zip(expected)
            {
                let opacity = |polygon: usize| opacities[polygon];
                check_mixed(&tree, &camera, &opacity, &mut score).unwrap();
                let map = map_with(&tree, &camera, opacity);
                if size == [50, 40] {
                    assert_eq!(map.polygons().count(), expected, "{eye}, {opacities:?}");
                }
                assert!(all.paths().len() >= map.drawing().unwrap().paths().len());
            }
        }
    }
    enough!(score.polygons > 20; "{score:?}");
    let none = BspTree::build::<Vec<DVec3>>([]).unwrap();
    let camera = Camera::perspective(DVec3::Z, DVec3::ZERO, DVec3::Y, 1.0, [9, 9]).unwrap();
    let map = map_with(&none, &camera, |_| 0.5);
    assert!(map.regions().unwrap().is_empty() && map.drawing().unwrap().paths().len() == 0);
}

/// Without hidden runs, the visible runs do not change. Polygons of which little is visible have no paths.
#[test]
fn hidden_runs_and_small_polygons_are_left_out_on_request() {
    let scene = Builtin::Random.build(Some(60), 4);
    let tree = BspTree::build(scene.polygons()).unwrap();
    let (low, high) = scene.bounds().unwrap();
    let camera = Camera::looking_at_all([low, high], scene.up(), [200, 150]).unwrap();
    let map = map_with(&tree, &camera, |_| 1.0);
    let mut overlay = Overlay::new(&tree);
    overlay.replace_with(&tree, Shapes::NONE.with_lines([[low, high]])).unwrap();
    let mut edges = map.edges(Hidden::Keep).unwrap();
    let mut lines = map.lines(&overlay, Hidden::Keep).unwrap();
    let all = edges.len() + lines.len();
    edges.retain(|run| run.is_visible);
    lines.retain(|run| run.is_visible);
    assert!(edges.len() + lines.len() + 20 < all && !lines.is_empty(), "{all}");
    assert_eq!(map.edges(Hidden::Skip).unwrap(), edges);
    assert_eq!(map.lines(&overlay, Hidden::Skip).unwrap(), lines);

    let mixed = |polygon: usize| if polygon.is_multiple_of(2) { 0.5 } else { 1.0 };
    for options in [ViewOptions::DEFAULT, with_opacities(&tree, mixed)] {
        let least = 30.0;
        let drawn = |options: ViewOptions<'_>| {
            let map = tree.visibility(&camera, &options).unwrap();
            let large = |area: f64| area >= least;
            let polygons = map.polygons().filter(|polygon| large(polygon.area));
            let polygons: BTreeSet<usize> = polygons.map(|polygon| polygon.polygon).collect();
            let (drawing, regions) = (map.drawing().unwrap(), map.regions().unwrap());
            let paths: BTreeSet<usize> = drawing.paths().map(|path| path.polygon()).collect();
            (polygons, paths, regions.iter().filter(|r| large(r.area())).count(), regions.len())
        };
        let (large, all, large_regions, regions) = drawn(options.clone());
        assert!(large.len() + 3 < all.len() && large_regions + 3 < regions);
        assert_eq!(drawn(options.clone().with_least_area(f64::NAN)).1, all);
        let (_, paths, kept, of_all) = drawn(options.with_least_area(least));
        assert_eq!((paths, kept, of_all), (large, large_regions, large_regions));
    }
}
