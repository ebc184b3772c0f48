//! Visible and hidden crossings of polygons, compared with rays in rationals.

use super::on_grid;
use super::overlay::{between, place_in};
use super::sightlines::{Sightlines, common};
use super::{map_of, map_with};
use binspace::drawing::{EdgeKind, EdgeRun};
use testkit::hard::bounds;
use testkit::model::Face;
use testkit::prelude::*;
use testkit::rational::Point;
use testkit::scenes::triangles;
use testkit::shapes::rectangle;

fn length(run: &EdgeRun) -> f64 {
    let [[ax, ay], [bx, by]] = run.ends;
    (bx - ax).hypot(by - ay)
}

/// Whether a run's middle is on a segment, up to a hundred thousandth of a pixel.
fn is_between([p, q]: [[f64; 2]; 2], [from, to]: [[f64; 2]; 2]) -> bool {
    let [from, to] = [from, to].map(DVec2::from);
    let arm = (DVec2::from(p) + DVec2::from(q)) * 0.5 - from;
    let share = (arm.dot(to - from) / (to - from).length_squared()).clamp(0.0, 1.0);
    (arm - (to - from) * share).length() < 1e-5
}

/// Two cards that cross behind bars. Each run between the ends of bars has its number of layers.
#[test]
fn bars_before_the_crossing_of_two_cards_are_counted() {
    let cards = [
        [[-2.0, -2.0, -2.0], [2.0, -2.0, 2.0], [2.0, 2.0, 2.0], [-2.0, 2.0, -2.0]],
        [[-2.0, -2.0, 2.0], [2.0, -2.0, -2.0], [2.0, 2.0, -2.0], [-2.0, 2.0, 2.0]],
    ];
    let mut polygons: Vec<Vec<DVec3>> =
        cards.iter().map(|card| card.map(DVec3::from).to_vec()).collect();
    polygons.push(rectangle([-3.0, -1.5], [3.0, 1.0], 3.0));
    polygons.push(rectangle([-3.0, -0.5], [3.0, 0.5], 4.0));
    // This polygon is behind both cards, and no card crosses it.
    polygons.push(rectangle([-3.0, -3.0], [3.0, 3.0], -3.0));
    let camera = Camera::parallel(DVec3::NEG_Z, DVec3::Y, DVec3::ZERO, 8.0, [80, 80]).unwrap();
    let tree = BspTree::build(&polygons).unwrap();
    let map = tree.visibility(&camera, &ViewOptions::DEFAULT).unwrap();
    let mut runs = map.crossings(Hidden::Count).unwrap();
    runs.sort_by(|a, b| a.ends[0][1].min(a.ends[1][1]).total_cmp(&b.ends[0][1].min(b.ends[1][1])));
    let found: Vec<(Option<u32>, f64)> =
        runs.iter().map(|run| (run.layers, (length(run) * 1e6).round() / 1e6)).collect();
    // Runs are listed from the top, because y points down in the picture.
    let expected = [(0, 10.0), (1, 5.0), (2, 10.0), (1, 10.0), (0, 5.0)];
    assert_eq!(found, expected.map(|(layers, length)| (Some(layers), length)));
    for run in &runs {
        assert_eq!((run.polygon, run.kind, run.edge), (0, EdgeKind::Crossing(1), None));
        assert_eq!(run.is_visible, run.layers == Some(0));
    }
    // The background is visible through glass.
    let glass = |polygon: usize| if polygon == 2 || polygon == 3 { 0.5 } else { 1.0 };
    let map = map_with(&tree, &camera, glass);
    let runs = map.crossings(Hidden::Count).unwrap();
    assert!(runs.iter().all(|run| run.is_visible && run.layers == Some(0)), "{runs:?}");
    assert!((runs.iter().map(length).sum::<f64>() - 40.0).abs() < 1e-6, "{runs:?}");
}

#[test]
fn crossings_have_as_many_layers_as_rays_meet() {
    let mut dice = Dice(8);
    let (mut judged, mut most, mut pairs, mut unsure, mut on_lines) = ([0; 4], 0, 0, 0, 0);
    for (count, edge, is_parallel) in
        [(40, 0.8, false), (40, 0.8, true), (120, 0.5, false), (250, 0.25, true)]
    {
        let polygons = triangles(&mut dice, count, [-1.0, 1.0], edge);
        let tree = BuildOptions::DEFAULT.with_tolerance(0.0).build(&polygons).unwrap();
        let faces: Vec<Face> =
            (0..tree.faces().len() as u32).map(|face| Face::new(tree.faces(), face)).collect();
        assert_eq!(faces.len(), polygons.len());
        // Rationals are slow, so only triangles whose boxes overlap are compared.
        let boxes: Vec<[DVec3; 2]> =
            polygons.chunks(1).map(|corners| bounds(corners).expect("corners")).collect();
        let mut crossing: Vec<(usize, usize, [Point; 2])> = vec![];
        for i in 0..faces.len() {
            for j in i + 1..faces.len() {
                let ([a, b], [c, d]) = (boxes[i], boxes[j]);
                if a.cmple(d).all() && c.cmple(b).all() {
                    crossing.extend(common(&faces[i], &faces[j]).map(|ends| (i, j, ends)));
                }
            }
        }
        pairs += crossing.len();
        for far in [3.0, 0.4] {
            let place = dice.point(-1.0, 1.0).normalize() * far;
            let eye = on_grid(&tree, place);
            let camera = match is_parallel {
                true => Camera::parallel(eye, DVec3::Z, DVec3::ZERO, 1.5 * far, [320, 240]),
                false => Camera::perspective(eye, DVec3::ZERO, DVec3::Z, 0.8, [320, 240]),
            };
            let camera = camera.unwrap();
            let Some(sightlines) = Sightlines::of(&tree, &camera) else { continue };
            let map = map_of(&tree, &camera);
            let runs = map.crossings(Hidden::Count).unwrap();
            let mut judged_runs = 0;
            let shown = map.crossings(Hidden::Skip).unwrap();
            let visible: f64 = shown.iter().map(length).sum();
            let same: f64 = runs.iter().filter(|run| run.is_visible).map(length).sum();
            assert!((visible - same).abs() < 1e-3, "{visible} {same}");
            for &(i, j, ref ends) in &crossing {
                let own = |run: &&EdgeRun| (run.polygon, run.kind) == (i, EdgeKind::Crossing(j));
                let [runs, shown] = [&runs, &shown].map(|runs| runs.iter().filter(own));
                let (runs, shown): (Vec<_>, Vec<_>) = (runs.collect(), shown.collect());
                judged_runs += runs.len();
                // Runs are on the line where they cross.
                if let [Some(from), Some(to)] = ends.each_ref().map(|end| sightlines.place_of(end))
                {
                    for run in runs.iter().chain(&shown) {
                        assert!(is_between(run.ends, [from, to]), "{run:?} {from:?} {to:?}");
                        on_lines += 1;
                    }
                }
                for k in 0..6 {
                    let point = between(ends, 0.071 + 0.16 * f64::from(k));
                    let Some(at) = sightlines.place_of(&point) else { continue };
                    let mut here = runs.iter().filter(|run| place_in(run.ends, at).is_some());
                    let run = here.next().unwrap_or_else(|| panic!("{i} {j} {at:?}"));
                    if place_in(run.ends, at) != Some(true) {
                        unsure += 1;
                        continue;
                    }
                    let layers = sightlines.polygons_before(&point).len();
                    assert_eq!(run.layers, Some(layers as u32), "{run:?} {at:?} {camera:?}");
                    assert_eq!(run.is_visible, layers == 0);
                    let is_shown = shown.iter().any(|run| place_in(run.ends, at).is_some());
                    assert_eq!(is_shown, run.is_visible, "{run:?} {at:?} {camera:?}");
                    judged[layers.min(3)] += 1;
                    most = most.max(layers);
                }
            }
            assert_eq!(judged_runs, runs.len(), "of polygons that cross");
        }
    }
    assert!(judged.iter().all(|&count| count > 50) && most > 4, "{judged:?} {most}");
    assert!(pairs > 200 && on_lines > 100, "{pairs} {on_lines}");
    assert!(unsure * 20 < judged.iter().sum::<usize>(), "{unsure} {judged:?}");
}

/// A floor in the middle plane of many walls that cross it, all behind a screen. No wall is lost when the set
/// of walls is halved.
#[test]
fn a_floor_in_the_middle_of_walls_crosses_all_of_them() {
    let quad = |corners: [[f64; 3]; 4]| corners.map(DVec3::from).to_vec();
    let mut polygons =
        vec![quad([[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [1.0, 1.0, 0.0], [-1.0, 1.0, 0.0]])];
    polygons.extend((0..40).map(|k| {
        let [low, high] = [0.0, 0.01].map(|lean| -0.95 + 0.045 * f64::from(k) + lean);
        quad([[low, -0.9, -1.0], [low, 0.9, -1.0], [high, 0.9, 1.0], [high, -0.9, 1.0]])
    }));
    polygons.push(quad([
        [-1.0, -1.0, -1.0],
        [1.0, -1.0, -1.0],
        [1.0, -1.0, 1.0],
        [-1.0, -1.0, 1.0],
    ]));
    let tree = BspTree::build(&polygons).unwrap();
    let eye = DVec3::new(0.1, -5.0, 0.7);
    let camera = Camera::perspective(eye, DVec3::ZERO, DVec3::Z, 0.7, [300, 300]).unwrap();
    let map = map_of(&tree, &camera);
    let mut walls: Vec<usize> = map
        .crossings(Hidden::Keep)
        .unwrap()
        .iter()
        .map(|run| match run.kind {
            EdgeKind::Crossing(other) => run.polygon.max(other),
            _ => unreachable!("crossings alone"),
        })
        .collect();
    walls.sort_unstable();
    walls.dedup();
    assert!(walls.into_iter().eq(1..=40));
}

/// A floor of two cards, the second lower by half the tolerance. A wall reaches down through the first card's plane,
/// and below the second card by less than the tolerance. A bar hides the middle of the second crossing.
#[test]
fn a_crossing_that_shows_on_both_sides_of_a_bar_is_hidden_behind_it() {
    let tolerance = 1e-3;
    let floor = |from: f64, to: f64, z: f64| rectangle([from, -2.0], [to, 2.0], z);
    let wall = |z: f64| {
        let at = |x: f64, z: f64| dvec3(x, 0.0, z);
        vec![at(-2.9, z), at(1.9, z), at(1.9, 1.0), at(-2.9, 1.0)]
    };
    // The line of sight falls as far as it leads forward.
    let bar = rectangle([0.5, -4.0], [1.0, -1.5], 2.0);
    let camera = Camera::parallel(dvec3(0.0, 1.0, -1.0), DVec3::Z, DVec3::ZERO, 8.0, [80, 80]);
    let camera = camera.unwrap();
    for reach in [1.2, 3.0] {
        let polygons = [
            floor(-3.0, 0.0, 0.0),
            floor(0.0, 2.0, -0.5 * tolerance),
            wall(-reach * tolerance),
            bar.clone(),
        ];
        // The plane of the first card divides the wall.
        let options = BuildOptions::DEFAULT.with_heuristic(Heuristic::First);
        let tree = options.with_tolerance(tolerance).build(&polygons).unwrap();
        let runs = map_of(&tree, &camera).crossings(Hidden::Keep).unwrap();
        let own = |run: &&EdgeRun| (run.polygon, run.kind) == (1, EdgeKind::Crossing(2));
        let of = |is_visible: bool| {
            let own = runs.iter().filter(own).filter(|run| run.is_visible == is_visible);
            own.map(length).sum::<f64>()
        };
        let [visible, hidden] = [true, false].map(of);
        assert!((visible - 14.0).abs() < 1e-2, "{reach}: {visible}, {runs:?}");
        assert!((hidden - 5.0).abs() < 1e-2, "{reach}: {hidden}, {runs:?}");
    }
}
