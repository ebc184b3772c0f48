//! Crossings of polygons whose corners are on a small grid, so that nearly everything coincides somewhere: edges on
//! planes, corners on edges, polygons in one plane, eyes in planes; against rationals.

use super::bent::{at, do_cross, sides_at};
use super::overlay::{between, origin, project};
use super::sightlines::{Cover, Origin, Sightlines};
use binspace::drawing::{EdgeKind, VisibilityMap};
use binspace::glam::DVec3;
use binspace::raster::Rays;
use binspace::view::Camera;
use binspace::{BspTree, BuildOptions, Ray};
use num_traits::{Signed, ToPrimitive, Zero};
use testkit::dice::Dice;
use testkit::effort::times;
use testkit::enough;
use testkit::fill::ray;
use testkit::model::Face;
use testkit::rational::{self, Point};

/// So many corners along each axis.
const GRID: f64 = 4.0;
fn corner(dice: &mut Dice) -> DVec3 {
    DVec3::from_array([(); 3].map(|()| dice.range(0.0, GRID).floor()))
}

/// Triangles, parallelograms, and quads that are bent; some with corners of others.
fn polygons(dice: &mut Dice, count: usize) -> Vec<Vec<DVec3>> {
    let mut polygons: Vec<Vec<DVec3>> = vec![];
    while polygons.len() < count {
        let mut corners: Vec<DVec3> = (0..4).map(|_| corner(dice)).collect();
        if let Some(other) = polygons.last()
            && dice.range(0.0, 1.0) < 0.3
        {
            corners[..2].copy_from_slice(&other[..2]);
        }
        match dice.range(0.0, 3.0) as u32 {
            0 => corners.truncate(3),
            1 => corners[3] = corners[0] + corners[2] - corners[1],
            _ => {}
        }
        polygons.push(corners);
    }
    polygons
}

/// The segment that two faces have in common, if they are not in one plane.
fn common(a: &Face, b: &Face) -> Option<[Point; 2]> {
    let along = rational::product(&a.plane.normal, &b.plane.normal);
    let mut found: Vec<Point> = vec![];
    for (one, other) in [(a, b), (b, a)] {
        for k in 0..one.corners.len() {
            let ends = [&one.corners[k], &one.corners[(k + 1) % one.corners.len()]];
            let values = ends.map(|end| other.plane.at(end));
            if values[0].is_zero() {
                found.push(ends[0].clone());
            } else if (&values[0] * &values[1]).is_negative() {
                found.push(rational::crossing(ends, [&values[0], &values[1]]));
            }
        }
    }
    found.retain(|point| is_in(a, point) && is_in(b, point));
    let place = |point: &Point| rational::scalar(&along, point);
    let low = found.iter().min_by_key(|point| place(point))?.clone();
    let high = found.iter().max_by_key(|point| place(point))?.clone();
    (low != high && along.iter().any(|c| !c.is_zero())).then_some([low, high])
}

fn is_in(face: &Face, point: &Point) -> bool {
    let n = face.corners.len();
    (0..n).all(|k| {
        let (a, b) = (&face.corners[k], &face.corners[(k + 1) % n]);
        let turn = rational::product(&rational::difference(b, a), &rational::difference(point, a));
        !rational::scalar(&turn, &face.plane.normal).is_negative()
    })
}

#[derive(Debug, Default)]
struct Score {
    visible: usize,
    hidden: usize,
    touched: usize,
    unsure: usize,
    runs: usize,
}

fn check(tree: &BspTree, camera: &Camera, score: &mut Score) {
    let (faces, lattice) = (tree.faces(), *tree.faces().lattice());
    let Some(origin) = origin(tree, camera) else { return };
    let sightlines = Sightlines::new(faces, origin);
    let map = VisibilityMap::of(tree, Rays::new(camera, faces).unwrap()).unwrap();
    let (all, shown) = (map.crossings_with_hidden().unwrap(), map.crossings().unwrap());
    let models: Vec<Face> = (0..faces.len() as u32).map(|face| Face::new(faces, face)).collect();
    let is_edge_on = |face: &Face| match &sightlines.origin {
        Origin::Eye(eye) => face.plane.at(eye).is_zero(),
        Origin::Along(way) => rational::scalar(&face.plane.normal, way).is_zero(),
    };
    let of = |polygon: usize| {
        let own = (0..faces.len() as u32).filter(move |&face| faces.polygon(face) == polygon);
        own.map(|face| &models[face as usize]).collect::<Vec<_>>()
    };
    let world =
        |point: &Point| lattice.to_world(point.each_ref().map(|c| c.to_f64().expect("in range")));
    // Where polygons cross, or may do so.
    let mut lines: Vec<([usize; 2], [DVec3; 2])> = vec![];
    for (i, a) in models.iter().enumerate() {
        for (j, b) in models.iter().enumerate().skip(i + 1) {
            let pair = [i, j].map(|face| faces.polygon(face as u32));
            if pair[0] == pair[1] || is_edge_on(a) || is_edge_on(b) {
                continue;
            }
            let Some(ends) = common(a, b) else { continue };
            let along = rational::difference(&ends[1], &ends[0]);
            for share in [0.137, 0.391, 0.613, 0.871] {
                let point = between(&ends, share);
                let sides = pair.map(|polygon| sides_at(&of(polygon), &along, &point));
                let has_edge_on = pair.into_iter().flat_map(of).any(|face| {
                    face.plane.at(&point).is_zero() && is_in(face, &point) && is_edge_on(face)
                });
                let is_crossed = do_cross(&along, &sides);
                if is_crossed != Some(false) {
                    lines.push((pair, ends.each_ref().map(world)));
                }
                let Some(is_crossed) = is_crossed.filter(|_| !has_edge_on) else { continue };
                let is_ahead = match &sightlines.origin {
                    Origin::Eye(eye) => {
                        let arm = rational::difference(&point, eye);
                        rational::scalar(&arm, &rational::point(camera.forward())).is_positive()
                    }
                    Origin::Along(_) => true,
                };
                let Some(place) = is_ahead.then(|| project(camera, &lattice, &point)).flatten()
                else {
                    continue;
                };
                if !(0.0 < place[0] && place[0] < 319.0 && 0.0 < place[1] && place[1] < 239.0) {
                    continue;
                }
                let here: Vec<_> = at(&all, pair, place).collect();
                if !is_crossed {
                    // Another of their crossings may be seen there.
                    score.touched += usize::from(here.is_empty());
                    continue;
                }
                assert!(!here.is_empty(), "{pair:?} at {place:?} is missing, {camera:?}");
                let cover = sightlines.cover(&point, pair);
                let is_inside = |&(_, is_inside): &(_, bool)| is_inside;
                if cover == Cover::Unsure || !here.iter().all(is_inside) || here.len() > 1 {
                    score.unsure += 1;
                    continue;
                }
                let is_visible = cover == Cover::None;
                assert_eq!(here[0].0.is_visible, is_visible, "{pair:?} {place:?} {camera:?}");
                let is_shown = at(&shown, pair, place).any(|(_, is_inside)| is_inside);
                assert_eq!(is_shown, is_visible, "{pair:?} {place:?} {camera:?}");
                *if is_visible { &mut score.visible } else { &mut score.hidden } += 1;
            }
        }
    }
    score.runs += all.len();
    // Nothing but crossings: the line of sight through the middle of a run meets one.
    for run in &all {
        let middle = [0, 1].map(|i: usize| 0.5 * (run.ends[0][i] + run.ends[1][i]));
        let Ray::Endless { from, direction } = ray(camera, middle) else { panic!("no end") };
        let EdgeKind::Crossing(other) = run.kind else { panic!("{run:?}") };
        let is_met = lines.iter().any(|(pair, [a, b])| {
            let across = direction.cross(*b - *a);
            let off = (*a - from).dot(across) / across.length();
            pair.iter().all(|polygon| [run.polygon, other].contains(polygon)) && off.abs() < 1e-5
        });
        assert!(is_met, "{run:?} {camera:?}");
    }
}

#[test]
fn crossings_of_polygons_on_a_grid_are_those_of_rationals() {
    let (mut dice, mut score) = (Dice(23), Score::default());
    for round in 0..times(100) {
        let polygons = polygons(&mut dice, 2 + round % 5);
        let options = match round % 3 {
            0 => BuildOptions::DEFAULT,
            _ => BuildOptions::DEFAULT.with_tolerance(0.0),
        };
        let Ok(tree) = options.build(&polygons) else { continue };
        for _ in 0..2 {
            let eye = corner(&mut dice) * 3.0 - DVec3::splat(4.0);
            let target = corner(&mut dice) + DVec3::new(0.25, 0.125, 0.0);
            let up = DVec3::new(0.25, 0.5, 1.0);
            let perspective = Camera::perspective(eye, target, up, 0.9, [320, 240]);
            let middle = DVec3::splat(0.5 * GRID);
            let parallel = Camera::parallel(eye - corner(&mut dice), up, middle, 8.0, [320, 240]);
            for camera in [perspective, parallel].into_iter().flatten() {
                check(&tree, &camera, &mut score);
            }
        }
    }
    enough!(score.visible > 700, score.hidden > 350, score.touched > 700; "{score:?}");
    assert!(score.runs > 400 && score.unsure * 10 < score.visible + score.hidden, "{score:?}");
}
