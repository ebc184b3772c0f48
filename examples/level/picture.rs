//! The picture: a frame, and a map of the visited polygons.

use std::f64::consts::FRAC_PI_8;

use binspace::glam::DVec3;
use binspace::view::Camera;
use binspace::{Fragment, Viewpoint};

use crate::canvas::Canvas;
use crate::rooms::{Kind, ROOM};
use crate::{Frame, Level, MAP, ROOMS, VIEW};

fn colour(kind: Kind) -> [f64; 3] {
    match kind {
        Kind::Floor => [0.66, 0.58, 0.48],
        Kind::Ceiling => [0.80, 0.80, 0.78],
        Kind::Wall => [0.86, 0.78, 0.62],
        Kind::Pillar => [0.45, 0.60, 0.70],
        Kind::Crate => [0.75, 0.45, 0.25],
    }
}

/// The colour of the door.
const DOOR: [f64; 3] = [0.55, 0.22, 0.20];

/// Paints the frame on the left: the visible part of the level, and the door.
pub(crate) fn paint_view(canvas: &mut Canvas, level: &Level, camera: &Camera, frame: &Frame) {
    let Viewpoint::Eye(eye) = camera.viewpoint() else { return };
    for &number in &frame.order {
        let piece = level.overlay.piece(number);
        let fragment = piece.unwrap_or_else(|| level.tree.fragment(number));
        let colour = level.polygons.get(fragment.polygon()).map_or(DOOR, |&(kind, _)| colour(kind));
        let vertices: Vec<DVec3> = fragment.vertices().collect();
        let middle = vertices.iter().sum::<DVec3>() / vertices.len() as f64;
        let normal = fragment.normal();
        // Faces are lit from two sides, and are darker at a larger distance.
        let light = 0.72 + 0.18 * normal.x.abs() + 0.10 * normal.z.abs();
        let light = light / (1.0 + (middle - eye).length() / 45.0);
        let [r, g, b] = colour.map(|c| c * light);
        canvas.fill(&camera.clip(&vertices), |_| [r, g, b, 1.0]);
    }
}

/// Paints the level from above on the right. Painted polygons are bright.
pub(crate) fn paint_map(canvas: &mut Canvas, level: &Level, camera: &Camera, frame: &Frame) {
    let Level { tree, polygons, .. } = level;
    let scale = (MAP - 20.0) / (ROOMS as f64 * ROOM);
    let place = |p: DVec3| [f64::from(VIEW[0]) + 10.0 + p.x * scale, MAP - 10.0 - p.y * scale];
    let mut draw = |fragment: Fragment<'_>, is_seen: bool| {
        let kind = polygons[fragment.polygon()].0;
        let vertices: Vec<DVec3> = fragment.vertices().collect();
        let share = if is_seen { 1.0 } else { 0.3 };
        let [r, g, b] = colour(kind).map(|c| c * share);
        match kind {
            Kind::Ceiling => {}
            // Above a door.
            Kind::Wall if vertices.iter().all(|p| p.z > 0.0) => {}
            Kind::Floor => {
                let outline: Vec<[f64; 2]> = vertices.into_iter().map(place).collect();
                canvas.fill(&outline, |_| [0.7 * r, 0.7 * g, 0.7 * b, 1.0]);
            }
            _ => {
                let (low, high) = vertices
                    .iter()
                    .fold((DVec3::MAX, DVec3::MIN), |(low, high), &p| (low.min(p), high.max(p)));
                let ([x0, y1], [x1, y0]) = (place(low), place(high));
                let outline = [
                    [x0 - 0.8, y0 - 0.8],
                    [x1 + 0.8, y0 - 0.8],
                    [x1 + 0.8, y1 + 0.8],
                    [x0 - 0.8, y1 + 0.8],
                ];
                canvas.fill(&outline, |_| [r, g, b, 1.0]);
            }
        }
    };
    let is_floor = |f: &Fragment<'_>| polygons[f.polygon()].0 == Kind::Floor;
    let seen: Vec<Fragment<'_>> = frame.seen.iter().map(|&index| tree.fragment(index)).collect();
    // Floors are painted first, because on a map, walls stand on floors.
    tree.fragments().filter(is_floor).for_each(|f| draw(f, false));
    seen.iter().filter(|f| is_floor(f)).for_each(|&f| draw(f, true));
    tree.fragments().filter(|f| !is_floor(f)).for_each(|f| draw(f, false));
    seen.iter().filter(|f| !is_floor(f)).for_each(|&f| draw(f, true));
    if let Viewpoint::Eye(eye) = camera.viewpoint() {
        let [x, y] = place(eye);
        let ring: Vec<[f64; 2]> = (0..16)
            .map(|k| (f64::from(k) * FRAC_PI_8).sin_cos())
            .map(|(s, c)| [x + 4.0 * s, y - 4.0 * c])
            .collect();
        canvas.fill(&ring, |_| [0.95, 0.2, 0.2, 1.0]);
    }
}
