//! Coverage and depth against the rational oracle.

use glam::DVec3;

use super::{Random, cameras, faces, oracle};
use crate::exact::{EdgeLine, Faces, PlaneId};
use crate::raster::coverage::Coverage;
use crate::raster::exact::Plane;
use crate::raster::line::Seen;
use crate::raster::{Outline, Rays, zbuffer};
use crate::view::Camera;

const PIXELS: [u32; 2] = [12, 6];
const ROUNDS: u64 = 40;

/// Triangles and quads: in general position, on a coarse grid, planar only within the tolerance, or
/// slivers; prepared with a suitable tolerance.
fn scene(random: &mut Random, kind: u64, size: f64) -> Faces {
    let mut polygons = Vec::new();
    for _ in 0..6 {
        let place = |v: DVec3| v * size;
        polygons.push(match kind {
            0 => (0..3).map(|_| place(random.point())).collect(),
            1 => (0..3).map(|_| place(random.grid(2) / 2.0)).collect(),
            2 => {
                let (a, u, v) = (random.point(), random.point(), random.point());
                let corners = [a, a + u, a + u + v, a + v];
                corners.map(|p| place(p + random.point() * 1e-7)).to_vec()
            }
            3 => {
                let (a, u) = (random.point(), random.point());
                let off = random.point() * 1e-9;
                [a, a + u, a + u * 0.5 + off].map(place).to_vec()
            }
            _ => {
                let (a, u, v) = (random.grid(2), random.grid(1), random.grid(1));
                [a, a + u, a + u + v, a + v].map(|p| place(p / 2.0)).to_vec()
            }
        });
    }
    faces(&polygons, Some(if kind == 2 { 1e-6 * size } else { 0.0 }))
}

/// A camera whose eye is in the plane of the first face, except for rounding.
fn in_plane(random: &mut Random, faces: &Faces) -> Option<Camera> {
    if faces.is_empty() {
        return None;
    }
    let [a, b, c] = faces.reference_triangle(0).map(|c| faces.lattice().to_world(faces.corner(c)));
    let eye = a + (b - a) * random.unit() + (c - a) * random.unit();
    Camera::perspective(eye, a, DVec3::new(0.1, 0.7, 0.3), 1.0, PIXELS).ok()
}

fn for_each_case(seed: u64, mut check: impl FnMut(&Rays, &Faces, &str)) {
    let mut random = Random::new(seed);
    for round in 0..ROUNDS {
        let (kind, size) = (round % 5, [1.0, 1e-30, 1e30, 64.0][round as usize % 4]);
        let faces = scene(&mut random, kind, size);
        let mut cameras = cameras(&mut random, size, PIXELS);
        cameras.extend(in_plane(&mut random, &faces));
        for (i, camera) in cameras.iter().enumerate() {
            let Ok(rays) = Rays::new(camera, &faces) else { continue };
            let rays = if random.below(4) == 0 { rays.with_front_faces_only() } else { rays };
            check(&rays, &faces, &format!("round {round} camera {i}: {camera:?}"));
        }
    }
}

#[test]
fn a_face_covers_the_pixels_whose_rays_meet_it() {
    let mut met = 0;
    for_each_case(1, |rays, faces, case| {
        for face in 0..faces.len() as u32 {
            let target = oracle::Target::new(faces, face);
            let mut covered = [[false; PIXELS[0] as usize]; PIXELS[1] as usize];
            if let Some(coverage) = Coverage::new(rays, faces, face, Outline::Whole) {
                coverage.for_each_run(&mut |y, columns| {
                    columns.for_each(|x| covered[y as usize][x as usize] = true);
                });
            }
            for (y, row) in covered.iter().enumerate() {
                for (x, &covered) in row.iter().enumerate() {
                    let expected = target.meets(rays, x as u32, y as u32).is_some();
                    assert_eq!(covered, expected, "face {face} at {x}, {y} of {case}");
                    met += usize::from(expected);
                }
            }
        }
    });
    assert!(met > 3300, "only {met} pixels covered");
}

#[test]
fn the_filter_never_contradicts_the_integers() {
    let mut decided = [0, 0];
    for_each_case(2, |rays, faces, case| {
        for face in 0..faces.len() as u32 {
            let plane = PlaneId::face((face + 1) % faces.len() as u32);
            let lines = [
                EdgeLine::cut(plane, false),
                EdgeLine::cut(PlaneId::axis(1, 2), true),
                EdgeLine::edge(1),
            ];
            let whole = Outline::Lines { lines: &lines, vertices: faces.corners(face) };
            let side = Plane::of(faces, face).kappa(rays).sign();
            let seen = Seen::new(rays, faces, face);
            assert!(seen.is_none_or(|seen| seen.positive == side.is_gt()), "{face} of {case}");
            assert!(seen.is_none() || side.is_ne(), "{face} of {case}");
            let Some(coverage) = Coverage::new(rays, faces, face, whole) else { continue };
            for (line, (x, y)) in coverage.lines.iter().flat_map(|line| {
                (0..PIXELS[0])
                    .flat_map(|x| (0..PIXELS[1]).map(move |y| (x, y)))
                    .map(move |p| (line, p))
            }) {
                let [k0, kx, ky] = line.k;
                let value = k0 + f64::from(y) * ky + f64::from(x) * kx;
                decided[usize::from(value.abs() > line.bound)] += 1;
                if value.abs() > line.bound {
                    let exact = coverage.seen.exact(line.source, x, y);
                    assert_eq!(value.total_cmp(&0.0), exact, "{line:?} at {x}, {y} of {case}");
                }
            }
        }
    });
    assert!(decided[0] > 1000 && decided[1] > 10_000, "{decided:?}");
}

#[test]
fn the_depth_buffer_is_brute_force_ray_casting() {
    let mut shown = 0;
    for_each_case(3, |rays, faces, case| {
        let (depth, targets) = (zbuffer(rays, faces), oracle::Target::all(faces));
        for (i, &face) in depth.image().faces().iter().enumerate() {
            let (x, y) = (i as u32 % PIXELS[0], i as u32 / PIXELS[0]);
            let expected = oracle::nearest(rays, &targets, x, y);
            let face = (face != crate::raster::NONE).then_some(face);
            assert_eq!(face, expected, "at {x}, {y} of {case}");
            shown += usize::from(face.is_some());
        }
    });
    assert!(shown > 1300, "only {shown} pixels covered");
}
