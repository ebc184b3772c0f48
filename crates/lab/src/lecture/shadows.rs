//! Shadows.

use binspace::glam::{DVec3, dvec3};
use binspace::raster::Rays;
use binspace::view::Camera;
use binspace::{BspTree, BuildOptions};
use binspace_evidence::shadows::{Zone, courtyard, is_umbra, lamp, seen_points, zone};

use super::chapter::{Chapter, Picture, percent};
use super::{radiosity, shadow_pieces};
use binspace_cli::failure::Failure;

pub(super) const SIZE: [u32; 2] = [240, 180];
/// Points along a side of the lamp: first only its corners, then more between them.
const SIDES: [u32; 4] = [2, 3, 5, 7];

pub(super) fn fill(chapter: &mut Chapter) -> Result<(), Failure> {
    chapter.text(
        "A point is in shadow if the lamp does not see it. So shadows are hidden surfaces, seen from another \
         eye. A point lamp makes two zones, lit and umbra. A lamp with an extent adds the penumbra, from \
         which a part of the lamp is visible. The tree decides each sight line exactly: does any polygon \
         contain an inner point of the segment? One tree of the scene serves all lamps and all points.",
    );
    chapter.text(
        "The tested points are the surface points in the pixels, rounded to whole numbers. All surfaces are \
         level or upright, so these points lie exactly in the planes of the surfaces. The tests compare a \
         million such sight lines, many along boundaries of polygons, with integers of 128 bits: none is \
         wrong.",
    );
    let scene = courtyard();
    let build = BuildOptions::DEFAULT.with_tolerance(0.0).build(scene.polygons());
    let tree = build.map_err(|error| Failure::about("a tree", error))?;
    let view = |error| Failure::about("a view", error);
    let (eye, target) = (dvec3(6100.0, -2700.0, 4300.0), dvec3(2150.0, 1850.0, 150.0));
    let camera = Camera::perspective(eye, target, DVec3::Z, 0.62, SIZE).map_err(view)?;
    let rays = Rays::new(&camera, tree.faces()).map_err(view)?;
    let points = seen_points(&camera, eye, &rays, &tree);
    let middle = [dvec3(2093.0, 2231.0, 2999.0)];
    let by_point = zones(&tree, &points, &middle);
    let all = SIDES.map(|side| zones(&tree, &points, &lamp(side)));
    table(chapter, &all);
    let corners = lamp(2);
    let seen = points.iter().zip(&all[3]);
    let umbra = seen.clone().filter(|(_, zone)| **zone == Some(Zone::Umbra));
    let certain = umbra.filter(|(p, _)| p.is_some_and(|p| is_umbra(&tree, p, &corners)));
    chapter.text(format!(
        "Only the given points of the lamp are tested. A polygon that hides only other parts of the \
         lamp is missed. So the zones lit and umbra of a rectangular lamp are wrong in a strip along \
         their boundaries. The strip becomes narrower with more points. The zone penumbra is always \
         right. Of the {} points in the umbra, {} are certain: for each of these, one convex polygon \
         is between the point and all four corners of the lamp, so this polygon hides the whole lamp.",
        count(&all[3], Zone::Umbra),
        certain.count(),
    ));
    chapter.pictures([
        Picture::new(SIZE, shown(&by_point), "A point lamp: lit and umbra"),
        Picture::new(SIZE, shown(&all[0]), "A rectangle by its corners"),
        Picture::new(SIZE, shown(&all[3]), "The rectangle by 49 points"),
    ]);
    shadow_pieces::fill(chapter, &tree, &camera, &middle, &all[0])?;
    radiosity::fill(chapter)
}

/// The zone of each pixel that shows a surface.
fn zones(tree: &BspTree, points: &[Option<DVec3>], lamp: &[DVec3]) -> Vec<Option<Zone>> {
    let at = |point: &Option<DVec3>| point.map(|point| zone(tree, point, lamp));
    points.iter().map(at).collect()
}

fn count(zones: &[Option<Zone>], wanted: Zone) -> usize {
    zones.iter().filter(|zone| **zone == Some(wanted)).count()
}

fn table(chapter: &mut Chapter, all: &[Vec<Option<Zone>>; 4]) {
    let rows = SIDES.into_iter().zip(all).map(|(side, zones)| {
        let points = zones.iter().flatten().count();
        let other = zones.iter().zip(&all[3]).filter(|(a, b)| a != b).count();
        [
            (side * side).to_string(),
            (points * (side * side) as usize).to_string(),
            count(zones, Zone::Lit).to_string(),
            count(zones, Zone::Penumbra).to_string(),
            count(zones, Zone::Umbra).to_string(),
            format!("{other} ({})", percent(other as f64, points as f64)),
        ]
    });
    chapter.table(
        [
            "points of the lamp",
            "sight lines",
            "lit",
            "penumbra",
            "umbra",
            "zone differs with 49 points",
        ],
        rows,
    );
}

fn shown(zones: &[Option<Zone>]) -> Vec<u8> {
    zones.iter().flat_map(|zone| zone.map_or([255; 3], colour)).collect()
}

pub(super) fn colour(zone: Zone) -> [u8; 3] {
    match zone {
        Zone::Lit => [250, 228, 160],
        Zone::Penumbra => [140, 150, 175],
        Zone::Umbra => [50, 45, 65],
    }
}
