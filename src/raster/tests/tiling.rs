//! Pieces made by exact cuts tile their face.

use glam::DVec3;

use super::{Random, cameras, faces, oracle};
use crate::exact::{EdgeLine, Faces, PlaneId, PreparedPlane, Vertex, split};
use crate::raster::coverage::Coverage;
use crate::raster::{Outline, Rays};

/// The sides are powers of two, so that rays along an axis pass through points of a binary grid.
const PIXELS: [u32; 2] = [64, 32];

struct Tile {
    lines: Vec<EdgeLine>,
    vertices: Vec<[f64; 3]>,
}

/// The pieces of face 0 after cuts by the given planes.
fn tiles(faces: &Faces, planes: &[PlaneId]) -> Vec<Tile> {
    let mut pieces: Vec<Vec<Vertex>> = vec![Vertex::corners(faces, 0).collect()];
    for &plane in planes {
        let plane = PreparedPlane::new(faces, plane);
        let mut next = Vec::new();
        for piece in pieces {
            let sides = piece.iter().map(|vertex| plane.side(faces, 0, vertex));
            let (front, back) =
                sides.fold((false, false), |(f, b), side| (f | side.is_gt(), b | side.is_lt()));
            if front && back {
                let (mut ahead, mut behind) = (Vec::new(), Vec::new());
                split(faces, &plane, 0, &piece, &mut ahead, &mut behind);
                next.extend([ahead, behind]);
            } else {
                next.push(piece);
            }
        }
        pieces = next;
    }
    let tile = |piece: Vec<Vertex>| Tile {
        lines: piece.iter().map(Vertex::line).collect(),
        vertices: piece.iter().map(Vertex::position).collect(),
    };
    pieces.into_iter().map(tile).collect()
}

fn check(faces: &Faces, planes: &[PlaneId], random: &mut Random, size: f64) -> usize {
    let tiles = tiles(faces, planes);
    let mut met = 0;
    for camera in cameras(random, size, PIXELS) {
        let Ok(rays) = Rays::new(&camera, faces) else { continue };
        let mut counts = vec![0; (PIXELS[0] * PIXELS[1]) as usize];
        let add = |outline, step: i32, counts: &mut Vec<i32>| {
            if let Some(coverage) = Coverage::new(&rays, faces, 0, outline) {
                coverage.for_each_run(&mut |y, columns| {
                    columns.for_each(|x| counts[(y * PIXELS[0] + x) as usize] += step);
                });
            }
        };
        for Tile { lines, vertices } in &tiles {
            add(Outline::Lines { lines, vertices }, 1, &mut counts);
        }
        let covered = counts.clone();
        add(Outline::Whole, -1, &mut counts);
        assert!(counts.iter().all(|&count| count == 0), "{camera:?}: {counts:?}");
        met += covered.iter().filter(|&&count| count > 0).count();
        // A sample compared with the rationals.
        for _ in 0..40 {
            let (x, y) = (random.below(64) as u32, random.below(32) as u32);
            let Tile { lines, vertices } = &tiles[random.below(tiles.len() as u64) as usize];
            let outline = Outline::Lines { lines, vertices };
            let got = Coverage::new(&rays, faces, 0, outline).is_some_and(|coverage| {
                coverage.window.columns.contains(&x)
                    && coverage.window.rows.contains(&y)
                    && coverage.covers(x, y)
            });
            let expected = oracle::meets_piece(&rays, faces, 0, lines, [x, y]);
            assert_eq!(got, expected, "{lines:?} at {x}, {y} of {camera:?}");
        }
    }
    met
}

fn square(half: f64, size: f64) -> Vec<DVec3> {
    [(-half, -half), (half, -half), (half, half), (-half, half)]
        .map(|(x, y)| DVec3::new(x, y, 0.0) * size)
        .to_vec()
}

#[test]
fn random_cuts_tile_a_square() {
    let mut met = 0;
    for (seed, size) in [(1, 1.0), (2, 1e-30), (3, 1e8), (4, 1.0)] {
        let mut random = Random::new(seed);
        let mut polygons = vec![square(1.0, size)];
        polygons.extend((0..12).map(|_| (0..3).map(|_| random.point() * size).collect::<Vec<_>>()));
        let faces = faces(&polygons, Some(0.0));
        let mut planes: Vec<PlaneId> = (1..faces.len() as u32).map(PlaneId::face).collect();
        planes.extend((0..6).map(|i| PlaneId::axis(i % 3, 7 + i as u32)));
        met += check(&faces, &planes, &mut random, size);
    }
    assert!(met > 4000, "only {met} pixels covered");
}

#[test]
fn cuts_on_a_grid_tile_a_square() {
    let mut met = 0;
    for seed in 1..8 {
        let mut random = Random::new(seed);
        let mut polygons = vec![square(0.9375, 1.0)];
        polygons
            .extend((0..14).map(|_| (0..3).map(|_| random.grid(16) / 16.0).collect::<Vec<_>>()));
        let faces = faces(&polygons, Some(0.0));
        let mut planes: Vec<PlaneId> = (1..faces.len() as u32).map(PlaneId::face).collect();
        planes.extend((0..6).map(|i| PlaneId::axis(i % 3, 7 + i as u32)));
        planes.reverse();
        planes.truncate(3 * seed as usize);
        met += check(&faces, &planes, &mut random, 1.0);
    }
    assert!(met > 4000, "only {met} pixels covered");
}

#[test]
fn cuts_tile_a_polygon_that_is_planar_within_the_tolerance() {
    let mut met = 0;
    for seed in 1..7 {
        let mut random = Random::new(seed);
        let turn = glam::DQuat::from_axis_angle(random.point().normalize(), 1.0 + seed as f64);
        let ring = (0..7).map(|k| {
            let (sin, cos) = (f64::from(k) * 0.9).sin_cos();
            turn * DVec3::new(cos, sin, 1e-7 * random.unit())
        });
        let mut polygons = vec![ring.collect::<Vec<_>>()];
        polygons.extend((0..10).map(|_| (0..3).map(|_| random.point()).collect::<Vec<_>>()));
        let faces = faces(&polygons, Some(1e-6));
        assert!(faces.moved_axis(0).is_some());
        let planes: Vec<PlaneId> = (1..faces.len() as u32).map(PlaneId::face).collect();
        met += check(&faces, &planes, &mut random, 1.0);
    }
    assert!(met > 4000, "only {met} pixels covered");
}
