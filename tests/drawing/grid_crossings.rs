//! Crossings of polygons whose corners are on a small grid, so that nearly everything coincides somewhere:
//! edges on planes, corners on edges, polygons in one plane, eyes in planes. Compared with rationals.

use super::bent::{at, do_cross, sides_at};
use super::overlay::between;
use super::sightlines::{Cover, Origin, Sightlines, common};
use binspace::Ray;
use binspace::drawing::EdgeKind;
use testkit::fill::ray;
use testkit::model::Face;
use testkit::prelude::*;
use testkit::rational::Point;

/// The number of corners along each axis.
const GRID: f64 = 4.0;
fn corner(dice: &mut Dice) -> DVec3 {
    DVec3::from_array([(); 3].map(|()| dice.range(0.0, GRID).floor()))
}

/// Triangles, parallelograms, and bent quads. Some share corners with others.
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

#[derive(Debug, Default)]
struct Score {
    visible: usize,
    hidden: usize,
    touched: usize,
    unsure: usize,
    runs: usize,
}

fn check(tree: &BspTree, camera: &Camera, score: &mut Score) {
    let lattice = *tree.faces().lattice();
    let Some(sightlines) = Sightlines::of(tree, camera) else { return };
    let map = tree.visibility(camera, &ViewOptions::DEFAULT).unwrap();
    let (all, shown) = (map.crossings(Hidden::Keep).unwrap(), map.crossings(Hidden::Skip).unwrap());
    let is_edge_on = |face: &Face| match &sightlines.origin {
        Origin::Eye(eye) => face.plane.at(eye).is_zero(),
        Origin::Along(way) => rational::scalar(&face.plane.normal, way).is_zero(),
    };
    let world = |point: &Point| lattice.to_world(point.each_ref().map(|c| c.to_f64().value()));
    // The lines along which polygons cross, or may cross.
    let mut lines: Vec<([usize; 2], [DVec3; 2])> = vec![];
    for (i, (p, a)) in sightlines.faces.iter().enumerate() {
        for (q, b) in &sightlines.faces[i + 1..] {
            let pair = [*p, *q];
            if p == q || is_edge_on(a) || is_edge_on(b) {
                continue;
            }
            let Some(ends) = common(a, b) else { continue };
            let along = rational::difference(&ends[1], &ends[0]);
            for share in [0.137, 0.391, 0.613, 0.871] {
                let point = between(&ends, share);
                let sides =
                    pair.map(|polygon| sides_at(&sightlines.faces_of(polygon), &along, &point));
                let has_edge_on =
                    pair.into_iter().flat_map(|polygon| sightlines.faces_of(polygon)).any(|face| {
                        face.plane.at(&point).is_zero()
                            && face.place(&point).is_ge()
                            && is_edge_on(face)
                    });
                let is_crossed = do_cross(&along, &sides);
                if is_crossed != Some(false) {
                    lines.push((pair, ends.each_ref().map(world)));
                }
                let Some(is_crossed) = is_crossed.filter(|_| !has_edge_on) else { continue };
                let Some(place) = sightlines.place_of(&point) else { continue };
                let here: Vec<_> = at(&all, pair, place).collect();
                if !is_crossed {
                    // Another crossing of the same polygons may be visible there.
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
    // All runs are crossings: the line of sight through the middle of a run meets a crossing.
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
fn crossings_of_polygons_on_a_grid_agree_with_rationals() {
    let (mut dice, mut score) = (Dice(23), Score::default());
    for round in 0..times(50) {
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
    enough!(score.visible > 350, score.hidden > 175, score.touched > 350; "{score:?}");
    enough!(score.runs > 200; "{score:?}");
    assert!(score.unsure * 10 < score.visible + score.hidden, "{score:?}");
}
