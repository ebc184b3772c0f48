//! Polygons that are not planar, and that others cross along the edge where they are bent. Compared with rays
//! in rationals.

use super::on_grid;
use super::overlay::{between, place_in};
use super::sightlines::Sightlines;
use super::{map_of, map_with};
use binspace::drawing::{EdgeKind, EdgeRun};
use std::collections::BTreeMap;
use testkit::model::Face;
use testkit::prelude::*;
use testkit::rational::Point;

/// A wall goes through the shorter diagonal of a quad, along which the quad is bent.
#[test]
fn a_wall_through_the_bend_of_a_quad_crosses_it() {
    let roof = [[-3.0, 0.0, -1.0], [0.0, -2.0, 0.0], [3.0, 0.0, -1.0], [0.0, 2.0, 0.0]];
    let wall = |low: f64| [[0.0, -1.0, low], [0.0, 1.0, low], [0.0, 1.0, 2.0], [0.0, -1.0, 2.0]];
    // A wall that reaches below the bend by less than the tolerance stands on it.
    for (low, expected, order) in [(-2.0, 2.0), (0.0, 0.0), (-5e-4, 0.0)]
        .into_iter()
        .flat_map(|(low, expected)| [[0, 1], [1, 0]].map(|order| (low, expected, order)))
    {
        let polygons = [roof, wall(low)];
        let options = BuildOptions::DEFAULT.with_tolerance(1e-3);
        let tree: BspTree = options.build(order.map(|i: usize| polygons[i])).unwrap();
        assert_eq!(tree.faces().len(), 3, "the roof is bent");
        let direction = DVec3::new(-1.0, 0.0, -1.0);
        let camera = Camera::parallel(direction, DVec3::Z, DVec3::ZERO, 8.0, [80, 80]).unwrap();
        let map = map_of(&tree, &camera);
        let in_layers = map.crossings(Hidden::Count).unwrap();
        assert_eq!(in_layers.len(), usize::from(expected > 0.0), "{in_layers:?}");
        for run in map.crossings(Hidden::Skip).unwrap().iter().chain(&in_layers) {
            assert_eq!((run.polygon, run.kind, run.is_visible), (0, EdgeKind::Crossing(1), true));
            let length = (run.ends[1][0] - run.ends[0][0]).abs();
            assert!((length - 10.0 * expected).abs() < 1e-6, "{run:?}");
        }
    }
}

/// A wall goes through an L-shaped polygon, along an edge that the triangulation of the L made.
#[test]
fn a_line_along_an_inner_edge_is_visible_or_hidden_once() {
    let l = [[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [1.0, 1.0], [1.0, 2.0], [0.0, 2.0]];
    let l = l.map(|[x, y]| [x, y, 0.0]).to_vec();
    let wall = vec![[-1.0, -1.0, -1.0], [3.0, 3.0, -1.0], [3.0, 3.0, 1.0], [-1.0, -1.0, 1.0]];
    for (turns, order) in (0..6).flat_map(|turns| [(turns, [0, 1]), (turns, [1, 0])]) {
        let mut turned = l.clone();
        turned.rotate_left(turns);
        let polygons = [turned, wall.clone()];
        let tree = BspTree::build(order.map(|i: usize| &polygons[i])).unwrap();
        for eye in [[9.0, -2.0, 8.0], [-5.0, -9.0, 3.0], [3.0, -9.0, 8.0], [2.0, -3.0, -5.0]] {
            let (eye, target) = (DVec3::from(eye), DVec3::new(1.0, 1.0, 0.0));
            let camera = Camera::perspective(eye, target, DVec3::Z, 0.8, [320, 240]).unwrap();
            let map = map_of(&tree, &camera);
            let [a, b] = [DVec3::ZERO, target].map(|end| DVec2::from(camera.project(end).unwrap()));
            let expected = a.distance(b);
            for runs in [
                map.crossings(Hidden::Skip),
                map.crossings(Hidden::Keep),
                map.crossings(Hidden::Count),
            ] {
                let runs = runs.unwrap();
                let length = |run: &EdgeRun| DVec2::from(run.ends[0]).distance(run.ends[1].into());
                let visible = runs.iter().all(|run| run.is_visible);
                let length: f64 = runs.iter().map(length).sum();
                assert!(visible && (length - expected).abs() < 1e-6, "{turns}, {eye}: {runs:?}");
            }
        }
    }
}

/// A multiple of 1/256.
fn number(dice: &mut Dice, most: f64) -> f64 {
    (dice.range(-most, most) * 256.0).round() / 256.0
}

fn vector(dice: &mut Dice, most: f64) -> DVec3 {
    DVec3::from_array([(); 3].map(|()| number(dice, most)))
}

/// Pairs of polygons around lines: at least one of each pair is bent along its line.
fn pairs(dice: &mut Dice, count: usize) -> Vec<Vec<DVec3>> {
    let mut polygons = vec![];
    for i in 0..count {
        // Quarters and eighths of `along` are numbers of few bits.
        let (from, along) = (vector(dice, 1.0), vector(dice, 0.25) * 2.0);
        let at = |share: f64| from + along * share;
        // Corners on both sides of the line, whose distance is larger than the length of the line. So the
        // line is the shorter diagonal.
        let mut sides = || {
            let away = vector(dice, 0.5);
            let away = away + away.signum() * 0.25;
            [at(0.5) + away, at(0.5) - away + vector(dice, 0.375)]
        };
        let ([a, b], [c, d]) = (sides(), sides());
        polygons.push(vec![at(0.0), a, at(1.0), b]);
        let other = match i % 4 {
            // The other polygon goes through the line, to beyond its ends or not.
            0 => vec![at(-0.25) + c - d, at(1.25) + c - d, at(1.25) - c + d, at(-0.25) - c + d],
            1 => vec![at(0.25) + c - d, at(0.75) + c - d, at(0.5) - c + d],
            // The other polygon ends at the line.
            2 => vec![at(0.0), at(0.75), c],
            // The other polygon is also bent along the line.
            _ => vec![at(0.125), c, at(1.0), d],
        };
        polygons.push(other);
        if i % 8 > 3 {
            let last = polygons.len() - 1;
            polygons.swap(last - 1, last);
        }
    }
    polygons
}

/// The directions in which a polygon leaves a line at a point of the line. There are two, or fewer if the
/// polygon ends there or does not contain the point.
pub(crate) fn sides_at(faces: &[&Face], along: &Point, point: &Point) -> Vec<Point> {
    let mut sides = vec![];
    for face in faces.iter().filter(|face| face.plane.at(point).is_zero()) {
        let n = face.corners.len();
        let turn = |k: usize| {
            let (a, b) = (&face.corners[k], &face.corners[(k + 1) % n]);
            let turn =
                rational::product(&rational::difference(b, a), &rational::difference(point, a));
            rational::sign(&rational::scalar(&turn, &face.plane.normal))
        };
        let turns: Vec<Ordering> = (0..n).map(turn).collect();
        if turns.contains(&Ordering::Less) {
            continue;
        }
        match turns.iter().position(|turn| turn.is_eq()) {
            Some(k) => sides.push(rational::difference(&face.corners[(k + 2) % n], point)),
            None => {
                let across = rational::product(&face.plane.normal, along);
                let zero = [(); 3].map(|()| Rational::zero());
                return vec![rational::difference(&zero, &across), across];
            }
        }
    }
    sides
}

/// A direction in two coordinates, as seen along a line.
fn flat(along: &Point, way: &Point) -> [Rational; 2] {
    // Any direction that is not parallel to the line spans the plane perpendicular to it.
    let axis = (0..3).find(|&i| !along[i].is_zero()).unwrap();
    let mut other = [(); 3].map(|()| Rational::zero());
    other[(axis + 1) % 3] = Rational::from(1);
    let x = rational::product(along, &other);
    let y = rational::product(along, &x);
    [rational::scalar(&x, way), rational::scalar(&y, way)]
}

/// Directions in the order of their angles.
fn by_angle(a: &[Rational; 2], b: &[Rational; 2]) -> Ordering {
    let is_upper = |[x, y]: &[Rational; 2]| y.is_positive() || y.is_zero() && x.is_positive();
    let turn = &a[0] * &b[1] - &a[1] * &b[0];
    is_upper(b).cmp(&is_upper(a)).then(Rational::zero().cmp(&turn))
}

/// Whether two polygons go through each other at a line; `None` if one polygon lies on the other there.
pub(crate) fn do_cross(along: &Point, [a, b]: &[Vec<Point>; 2]) -> Option<bool> {
    if a.len() < 2 || b.len() < 2 {
        return Some(false);
    }
    // A polygon that crosses itself may have more parts there.
    if a.len() > 2 || b.len() > 2 {
        return None;
    }
    let mut all: Vec<([Rational; 2], usize)> = vec![];
    for (whose, sides) in [a, b].into_iter().enumerate() {
        all.extend(sides.iter().map(|side| (flat(along, side), whose)));
    }
    all.sort_by(|(p, _), (q, _)| by_angle(p, q));
    let is_same = (0..4).any(|i| by_angle(&all[i].0, &all[(i + 1) % 4].0).is_eq());
    (!is_same).then(|| all[0].1 == all[2].1)
}

#[derive(Debug, Default)]
struct Score {
    /// Counts by the number of polygons in front: 0, 1, or more.
    crossed: [usize; 3],
    /// Places where polygons touch.
    touched: usize,
    /// Places where both polygons are bent.
    both: usize,
    unsure: usize,
}

/// The runs of two polygons on which a point is.
pub(crate) fn at(
    runs: &[EdgeRun],
    pair: [usize; 2],
    at: [f64; 2],
) -> impl Iterator<Item = (&EdgeRun, bool)> {
    let [one, other] = [pair[0].min(pair[1]), pair[0].max(pair[1])];
    let own = move |run: &&EdgeRun| (run.polygon, run.kind) == (one, EdgeKind::Crossing(other));
    runs.iter().filter(own).filter_map(move |run| {
        let [[ax, ay], [bx, by]] = run.ends;
        let off = (bx - ax) * (at[1] - ay) - (by - ay) * (at[0] - ax);
        let is_near = off.abs() < 1e-4 * (bx - ax).hypot(by - ay);
        place_in(run.ends, at).filter(|_| is_near).map(|is_inside| (run, is_inside))
    })
}

fn check(tree: &BspTree, camera: &Camera, opacity: f64, score: &mut Score) {
    let faces = tree.faces();
    let Some(sightlines) = Sightlines::of(tree, camera) else { return };
    let map = map_with(tree, camera, |_| opacity);
    let (runs, shown) =
        (map.crossings(Hidden::Count).unwrap(), map.crossings(Hidden::Skip).unwrap());
    for face in 0..faces.len() as u32 {
        let Some(k) = (0..3).find(|&k| faces.outline_edge(face, k).is_none()) else { continue };
        let polygon = faces.polygon(face);
        let other = polygon ^ 1;
        let corners = &sightlines.faces[face as usize].1.corners;
        let ends = [corners[k as usize].clone(), corners[(k as usize + 1) % 3].clone()];
        let along = rational::difference(&ends[1], &ends[0]);
        for i in 0..5 {
            let point = between(&ends, 0.061 + 0.19 * f64::from(i));
            let Some(place) = sightlines.place_of(&point) else { continue };
            let sides = [polygon, other]
                .map(|polygon| sides_at(&sightlines.faces_of(polygon), &along, &point));
            let Some(is_crossed) = do_cross(&along, &sides) else { continue };
            let here: Vec<(&EdgeRun, bool)> = at(&runs, [polygon, other], place).collect();
            if !is_crossed {
                assert!(here.iter().all(|(_, is_inside)| !is_inside), "{here:?}");
                score.touched += 1;
                continue;
            }
            let [(run, true)] = here[..] else {
                assert!(!here.is_empty(), "{polygon} and {other} at {place:?}: {camera:?}");
                score.unsure += 1;
                continue;
            };
            let before = match opacity == 1.0 {
                true => sightlines.polygons_before(&point).len(),
                false => 0,
            };
            assert_eq!(run.layers, Some(before as u32), "{run:?} {place:?} {camera:?}");
            assert_eq!(run.is_visible, before == 0);
            let is_shown = at(&shown, [polygon, other], place).any(|(_, is_inside)| is_inside);
            assert_eq!(is_shown, before == 0, "{place:?} {camera:?}");
            score.crossed[before.min(2)] += 1;
            score.both += usize::from(sightlines.faces_of(other).len() > 1);
        }
    }
}

#[test]
fn crossings_along_bends_agree_with_rays() {
    let (mut dice, mut score) = (Dice(14), Score::default());
    let exact = BuildOptions::DEFAULT.with_tolerance(0.0);
    for (count, rounds, options) in [
        (1, 24, exact.clone()),
        (8, 4, exact.clone()),
        (8, 4, BuildOptions::DEFAULT),
        (30, 1, exact),
    ] {
        for round in 0..rounds {
            let tree = options.build(pairs(&mut dice, count)).unwrap();
            let place = dice.point(-1.0, 1.0).normalize() * if round % 4 == 0 { 0.8 } else { 4.0 };
            let eye = on_grid(&tree, place);
            let perspective = Camera::perspective(eye, DVec3::ZERO, DVec3::Z, 0.8, [320, 240]);
            let parallel = Camera::parallel(eye, DVec3::Z, DVec3::ZERO, 3.0, [320, 240]);
            for camera in [perspective.unwrap(), parallel.unwrap()] {
                check(&tree, &camera, 1.0, &mut score);
                check(&tree, &camera, 0.5, &mut score);
            }
        }
    }
    assert!(score.crossed.iter().all(|&count| count > 50), "{score:?}");
    enough!(score.touched > 1000, score.both > 500; "{score:?}");
    assert!(score.unsure * 20 < score.crossed.iter().sum(), "{score:?}");
}

/// The total length of the visible crossings of each two polygons.
fn shown(runs: &[EdgeRun]) -> BTreeMap<(usize, usize), f64> {
    let mut lengths = BTreeMap::new();
    for run in runs.iter().filter(|run| run.is_visible) {
        let EdgeKind::Crossing(other) = run.kind else { panic!("{run:?}") };
        let [[ax, ay], [bx, by]] = run.ends;
        *lengths.entry((run.polygon, other)).or_insert(0.0) += (bx - ax).hypot(by - ay);
    }
    lengths
}

/// Within the tolerance, the ends of polygons and their bends are undecided.
#[test]
fn visible_crossings_are_the_same_with_and_without_hidden_ones() {
    let (mut dice, mut compared) = (Dice(15), 0);
    for tolerance in [0.0, 0.01, 0.05, 0.2] {
        for _ in 0..12 {
            let options = BuildOptions::DEFAULT.with_tolerance(tolerance);
            let tree = options.build(pairs(&mut dice, 8)).unwrap();
            let eye = dice.point(-1.0, 1.0).normalize() * 4.0;
            let camera = Camera::perspective(eye, DVec3::ZERO, DVec3::Z, 0.8, [320, 240]).unwrap();
            let map = map_of(&tree, &camera);
            let expected = shown(&map.crossings(Hidden::Skip).unwrap());
            let found = shown(&map.crossings(Hidden::Keep).unwrap());
            for (pair, length) in &expected {
                let other = found.get(pair).copied().unwrap_or_default();
                // (Slivers near the ends of crossings may occur in only one of the two results.)
                assert!((length - other).abs() < 0.05, "{pair:?}: {length} and {other}");
                compared += 1;
            }
        }
    }
    enough!(compared > 300; "{compared}");
}

/// In the picture, neighbours have their common edges at the given corners, although the tree moved corners
/// onto the planes of their quads. So nothing is visible between neighbours.
#[test]
fn a_closed_globe_of_bent_quads_has_no_gaps() {
    let scene = Builtin::Sphere.build(Some(2_000), 1);
    let tree = BspTree::build(scene.polygons()).unwrap();
    assert!(tree.preparation().flattened > 500, "{:?}", tree.preparation());
    let polygons: Vec<_> = scene.polygons().collect();
    let mut dice = Dice(28);
    for _ in 0..20 {
        let eye = dice.point(-1.0, 1.0).normalize() * (1.5 + 3.0 * dice.share());
        let up = DVec3::new(0.1, 0.2, 1.0);
        let camera = Camera::perspective(eye, DVec3::ZERO, up, 1.4, [320, 240]).unwrap();
        let map = map_of(&tree, &camera);
        for shown in map.polygons() {
            let corners = &polygons[shown.polygon];
            let [a, b, c] = [corners.points()[0], corners.points()[1], corners.points()[2]];
            let outwards = (c - a).cross(*corners.points().last().unwrap() - b).normalize();
            // The visibility of quads seen edge-on depends on rounding.
            assert!(outwards.dot((eye - a).normalize()) > -1e-9, "{eye}: {shown:?}");
        }
    }
}
