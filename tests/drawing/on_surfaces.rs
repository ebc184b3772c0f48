//! Lines and points that lie on polygons within the tolerance of their overlay: visible from both sides, and
//! painted after the polygons.

use super::between::covers;
use super::map_of;
use super::overlay::place_in;
use binspace::drawing::{DisplayItem, Drawing, LineRun, Path};
use binspace::glam::{DQuat, EulerRot};
use binspace::overlay::{Overlay, Shapes};
use testkit::prelude::*;
use testkit::scenes::triangles;

/// The share of a list of lines that is hidden.
fn hidden_share(runs: &[LineRun]) -> f64 {
    let length = |run: &LineRun| DVec2::from(run.ends[0]).distance(run.ends[1].into());
    let hidden = runs.iter().filter(|run| !run.is_visible);
    hidden.map(length).sum::<f64>() / runs.iter().map(length).sum::<f64>()
}

/// How an overlay appears: the hidden share of its lines, the hidden points, and the share of places on lines and
/// points over which a polygon is painted later.
fn seen(tree: &BspTree, overlay: &Overlay, camera: &Camera) -> (f64, usize, f64) {
    let map = map_of(tree, camera);
    let lines = hidden_share(&map.lines(overlay, Hidden::Keep).unwrap());
    let markers = map.markers(overlay).unwrap();
    let points = markers.iter().filter(|marker| !marker.is_visible).count();
    let drawing = Drawing::translucent(tree, camera, &ViewOptions::DEFAULT, Some(overlay)).unwrap();
    let (mut over, mut all) = (0, 0);
    let mut later: Vec<Path<'_>> = drawing.paths().collect();
    later.reverse();
    for item in drawing.display_list() {
        let places = match item {
            DisplayItem::Path(_) => {
                later.pop();
                continue;
            }
            DisplayItem::Line(run) => {
                let [a, b] = run.ends.map(DVec2::from);
                (0..8).map(|k| a.lerp(b, (f64::from(k) + 0.5) / 8.0).to_array()).collect()
            }
            DisplayItem::Marker(marker) => vec![marker.position],
            _ => unreachable!(),
        };
        for at in places {
            let covered = later.iter().map(|path| covers(path, at, -1.0));
            // Nothing, near an outline, or inside an outline.
            let most =
                covered.map(|found| found.map_or(1, |is_inside| 2 * u32::from(is_inside))).max();
            all += u32::from(most != Some(1));
            over += u32::from(most == Some(2));
        }
    }
    (lines, points, f64::from(over) / f64::from(all))
}

/// The tolerance of an overlay in `f32` exceeds that of a tree in `f64`. It decides for lines and points, as it does
/// in orders. On a tree with a tolerance of 0, the rounding of the lines decides.
#[test]
fn shapes_in_f32_are_on_a_wall_in_f64() {
    let slope = |x: f64, y: f64| 0.3 * x + 0.2 * y;
    let wall = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
    let wall = wall.map(|[x, y]| DVec3::new(x, y, slope(x, y)));
    let mut dice = Dice(1);
    let mut hidden = [0; 2];
    for options in [BuildOptions::DEFAULT, BuildOptions::DEFAULT.with_tolerance(0.0)] {
        let tree = options.build([wall]).unwrap();
        for _ in 0..times(20) {
            let at = DVec2::new(dice.range(-0.9, 0.7), dice.range(-0.9, 0.7));
            for off in [0.0, 1e-5] {
                let corner = |at: DVec2| at.extend(slope(at.x, at.y) + off).as_vec3();
                let line = [corner(at), corner(at + DVec2::new(0.1, 0.07))];
                let mut overlay = Overlay::new(&tree);
                let shapes = Shapes::NONE.with_lines([line]).with_points(line);
                overlay.replace_with(&tree, shapes).unwrap();
                for z in [1.0, -1.0] {
                    let camera =
                        Camera::parallel(DVec3::NEG_Z * z, DVec3::Y, DVec3::ZERO, 3.0, [300, 300]);
                    let found = seen(&tree, &overlay, &camera.unwrap());
                    if off > 0.0 {
                        let expected = if z > 0.0 { (0.0, 0, 0.0) } else { (1.0, 2, 1.0) };
                        assert_eq!(found, expected, "{line:?}");
                    } else if options == BuildOptions::DEFAULT {
                        assert_eq!(found, (0.0, 0, 0.0), "{line:?}");
                        hidden[0] += 1;
                    } else {
                        hidden[1] += usize::from(found.0 > 0.0);
                    }
                }
            }
        }
    }
    enough!(hidden[0] >= 40, hidden[1] > 15; "{hidden:?}");
}

/// A flat wall of small triangles whose corners are rounded to five decimals or to `f32`: the planes of the triangles
/// differ, and at the ends of a line across the wall most of them are further from the line than the tolerance. Only
/// the part of the line over a triangle decides.
#[test]
fn lines_across_a_flat_wall_of_small_triangles_are_on_it() {
    /// Triangles along a side of the wall, two for a square.
    const COUNT: usize = 20;
    let mut dice = Dice(2);
    let (mut planes, mut judged) = (0, 0);
    for step in [Some(1e-5), None] {
        for _ in 0..times(1) {
            let mut angle = || dice.range(-3.0, 3.0);
            let turn = DQuat::from_euler(EulerRot::XYZ, angle(), angle(), angle());
            let middle = dice.point(-1.0, 1.0);
            let rounded = |p: DVec3| match step {
                Some(step) => (p / step).round() * step,
                None => p.as_vec3().as_dvec3(),
            };
            let at = |x: f64, y: f64, z: f64| middle + turn * DVec3::new(x, y, z);
            let side = |k: usize| 2.0 * k as f64 / COUNT as f64 - 1.0;
            let corner = |x: usize, y: usize| rounded(at(side(x), side(y), 0.0));
            let squares = (0..COUNT * COUNT).map(|i| (i % COUNT, i / COUNT));
            let wall: Vec<[DVec3; 3]> = squares
                .flat_map(|(x, y)| {
                    let corners =
                        [[x, y], [x + 1, y], [x + 1, y + 1], [x, y + 1]].map(|[x, y]| corner(x, y));
                    let [a, b, c, d] = corners;
                    [[a, b, c], [a, c, d]]
                })
                .collect();
            let tolerance = step.map_or(4.0 * f64::from(f32::EPSILON) * 2.0, |step| 4.0 * step);
            let tree = BuildOptions::DEFAULT.with_tolerance(tolerance).build(&wall).unwrap();
            let ends = [
                DVec2::new(dice.range(-0.9, -0.5), dice.range(-0.9, 0.9)),
                DVec2::new(dice.range(0.5, 0.9), dice.range(-0.9, 0.9)),
            ];
            for off in [0.0, 0.01] {
                let line = ends.map(|end| rounded(at(end.x, end.y, off)));
                for triangle in &wall {
                    let [a, b, c] = *triangle;
                    let normal = (b - a).cross(c - a).normalize();
                    let far = line.iter().any(|end| normal.dot(end - a).abs() > tolerance);
                    planes += usize::from(off == 0.0 && far);
                }
                let mut overlay = Overlay::new(&tree);
                let shapes = Shapes::NONE.with_lines([line]).with_points(line);
                overlay.replace_with(&tree, shapes).unwrap();
                for sign in [1.0, -1.0] {
                    let way = turn * DVec3::new(0.2, 0.1, -sign);
                    let (up, size) = (turn * DVec3::Y, [300, 300]);
                    let parallel = Camera::parallel(way, up, middle, 3.0, size).unwrap();
                    let eye = middle - way * 3.0;
                    let at = Camera::perspective(eye, middle, up, 0.9, size).unwrap();
                    for camera in [parallel, at] {
                        let found = seen(&tree, &overlay, &camera);
                        let is_behind = off > 0.0 && sign < 0.0;
                        let expected = if is_behind { (1.0, 2, 1.0) } else { (0.0, 0, 0.0) };
                        assert_eq!(found, expected, "{off} {sign} {line:?} {tolerance}");
                        judged += 1;
                    }
                }
            }
        }
    }
    enough!(planes > 300, judged >= 16; "{planes} {judged}");
}

/// The counts of comparisons: places with this number of layers, up to three.
#[derive(Debug, Default)]
struct Score {
    layers: [usize; 4],
    /// Places of segments that pass a polygon within the tolerance only at that polygon.
    near: usize,
    unsure: usize,
}

/// Where a segment passes a triangle, in floats: a share of the segment.
struct Over {
    /// The distances of the ends behind the plane, as the camera sees it.
    depths: [f64; 2],
    part: [f64; 2],
}

impl Over {
    fn new(triangle: [DVec3; 3], ends: [DVec3; 2], camera: &Camera) -> Option<Self> {
        let [a, b, c] = triangle;
        let normal = (b - a).cross(c - a).normalize();
        let (facing, side): (f64, Box<dyn Fn(DVec3, DVec3) -> DVec3>) = match camera.viewpoint() {
            Viewpoint::Eye(eye) => {
                (normal.dot(a - eye), Box::new(move |p, q| (p - eye).cross(q - eye)))
            }
            Viewpoint::Direction(way) => {
                (normal.dot(way), Box::new(move |p, q| (q - p).cross(way)))
            }
        };
        let away = if facing > 0.0 { normal } else { -normal };
        let mut part = [0.0f64, 1.0];
        let mut clip = |[from, to]: [f64; 2]| {
            let at = from / (from - to);
            match (from < 0.0, to < 0.0) {
                (true, true) => part = [1.0, 0.0],
                (true, false) => part[0] = part[0].max(at),
                (false, true) => part[1] = part[1].min(at),
                (false, false) => {}
            }
        };
        for [p, q, inner] in [[a, b, c], [b, c, a], [c, a, b]] {
            let plane = side(p, q);
            let value = |x: DVec3| plane.dot(x - p) * plane.dot(inner - p).signum();
            clip(ends.map(value));
        }
        if let Viewpoint::Eye(eye) = camera.viewpoint() {
            clip(ends.map(|end| camera.forward().dot(end - eye)));
        }
        let depths = ends.map(|end| away.dot(end - a));
        (part[0] < part[1]).then_some(Self { depths, part })
    }

    fn depth(&self, share: f64) -> f64 {
        self.depths[0] + (self.depths[1] - self.depths[0]) * share
    }

    /// Whether the triangle is in front of the segment at a share; `None` if a margin does not decide.
    fn is_in_front(&self, share: f64, tolerance: f64, near: &mut bool) -> Option<bool> {
        const MARGIN: f64 = 1e-9;
        let [from, to] = self.part;
        if (share - from).abs().min((share - to).abs()) < 1e-6 {
            return None;
        }
        if share < from || share > to {
            return Some(false);
        }
        let over = self.part.map(|end| self.depth(end));
        let all = [over[0], over[1], self.depths[0], self.depths[1]];
        let is_close = |depth: f64| (depth.abs() - tolerance).abs() < MARGIN;
        if all.into_iter().any(is_close) || self.depth(share).abs() < MARGIN {
            return None;
        }
        let [deepest, nearest] =
            [self.depths[0].max(self.depths[1]), self.depths[0].min(self.depths[1])];
        if deepest < tolerance {
            return Some(false);
        }
        if over[0].max(over[1]) < tolerance {
            *near = true;
            return Some(false);
        }
        // A segment that reaches further than the tolerance on one side only is on that side.
        Some(nearest > -tolerance || self.depth(share) > 0.0)
    }
}

/// Segments among triangles, with a large tolerance. Many reach through a plane beyond a triangle, and pass the
/// triangle itself within the tolerance.
#[test]
fn polygons_are_in_front_where_the_part_over_them_is_beyond_the_tolerance() {
    let (mut score, mut dice) = (Score::default(), Dice(4));
    for (count, edge, tolerance) in [(40, 0.8, 0.015), (150, 0.3, 0.005), (150, 0.3, 0.0)] {
        let triangles: Vec<[DVec3; 3]> = triangles(&mut dice, count, [-1.0, 1.0], edge)
            .iter()
            .map(|corners| [corners[0], corners[1], corners[2]])
            .collect();
        let bounded = BuildOptions::DEFAULT.with_bounds(DVec3::splat(-9.0), DVec3::splat(9.0));
        let tree = bounded.with_tolerance(tolerance).build(&triangles).unwrap();
        // Lines nearly parallel to a triangle, and lines through a triangle.
        let most = f64::max(tolerance, 0.005);
        let lines: Vec<[DVec3; 2]> = (0..times(60))
            .map(|k| {
                let [a, b, c] = triangles[dice.below(count)];
                let [u, v] = [dice.share(), dice.share()];
                let (from, way) = (a.lerp(b, u), b.lerp(c, v) - a.lerp(b, u));
                let mut off = || dice.point(-1.0, 1.0) * most * [1.0, 3.0, 20.0][k % 3];
                [from - way * 0.5 + off(), from + way * 1.5 + off()]
            })
            .collect();
        let mut overlay = Overlay::new(&tree);
        overlay.replace_with(&tree, Shapes::NONE.with_lines(&lines)).unwrap();
        let eye = dice.point(-1.0, 1.0).normalize() * 4.0;
        for camera in [
            Camera::perspective(eye, DVec3::ZERO, DVec3::Z, 0.8, [320, 240]),
            Camera::perspective(eye * 0.1, DVec3::ZERO, DVec3::Z, 0.8, [320, 240]),
            Camera::parallel(-eye, DVec3::Z, DVec3::ZERO, 2.5, [320, 240]),
        ] {
            let camera = camera.unwrap();
            let runs = map_of(&tree, &camera).lines(&overlay, Hidden::Count).unwrap();
            for same in runs.chunk_by(|a, b| a.line == b.line) {
                let ends = lines[same[0].line];
                let over: Vec<Over> = triangles
                    .iter()
                    .filter_map(|triangle| Over::new(*triangle, ends, &camera))
                    .collect();
                for _ in 0..4 {
                    let share = dice.share();
                    let Some(at) = camera.project(ends[0].lerp(ends[1], share)) else { continue };
                    let run = same.iter().find(|run| place_in(run.ends, at) == Some(true));
                    let Some(run) = run else { continue };
                    let mut near = false;
                    let in_front: Option<Vec<bool>> =
                        over.iter().map(|o| o.is_in_front(share, tolerance, &mut near)).collect();
                    let Some(in_front) = in_front else {
                        score.unsure += 1;
                        continue;
                    };
                    let layers = in_front.iter().filter(|is_in_front| **is_in_front).count();
                    assert_eq!(run.layers, Some(layers as u32), "{run:?} {share} {camera:?}");
                    score.layers[layers.min(3)] += 1;
                    score.near += usize::from(near);
                }
            }
        }
    }
    let judged: usize = score.layers.iter().sum();
    enough!(score.layers.iter().all(|&count| count > 50), score.near > 80; "{score:?}");
    assert!(score.unsure * 10 < judged, "{score:?}");
}
