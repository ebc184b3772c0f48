//! Rows of a picture, and several rays in each pixel.

use glam::DVec3;

use super::{Random, cameras, faces, ray};
use crate::raster::{Rays, zbuffer};

/// Triangles and quads anywhere, some through the eyes of [`cameras`] or behind them.
fn polygons(random: &mut Random) -> Vec<Vec<DVec3>> {
    let mut polygons: Vec<Vec<DVec3>> =
        (0..12).map(|_| (0..3).map(|_| random.point()).collect()).collect();
    polygons.extend((0..4).map(|_| (0..3).map(|_| random.grid(4) * 0.5).collect()));
    let far = |x: f64, y: f64| DVec3::new(x, y, 0.25) * 8.0;
    polygons.push(vec![far(-1.0, -1.0), far(1.0, -1.0), far(1.0, 1.0), far(-1.0, 1.0)]);
    polygons
}

#[test]
fn rows_together_are_the_whole_picture() {
    let mut random = Random::new(31);
    let (mut compared, mut covered) = (0, 0);
    for round in 0..30 {
        let faces = faces(&polygons(&mut random), Some(0.0));
        for camera in cameras(&mut random, 1.0, [23, 17]) {
            let samples = 1 + round % 3;
            let Ok(rays) = Rays::sampled(&camera, &faces, samples) else { continue };
            let rays = if round % 2 == 0 { rays } else { rays.with_front_faces_only() };
            let whole = zbuffer(&rays, &faces);
            let height = rays.size()[1];
            let (mut start, mut parts, mut depths) = (0, Vec::new(), Vec::new());
            while start < height {
                // Parts of parts; the last parts include rows that do not exist.
                let end = start + 1 + random.below(9) as u32;
                let lead = start.min(random.below(3) as u32);
                let part = rays.rows(start - lead..end + 2).rows(lead..lead + end - start);
                assert_eq!(part.size(), [rays.size()[0], end.min(height) - start]);
                let image = zbuffer(&part, &faces);
                depths.extend(image.depths());
                parts.extend_from_slice(image.image().faces());
                start = end;
            }
            assert_eq!(parts, whole.image().faces(), "{camera:?}");
            let error = whole.depths().zip(depths).map(|(a, b)| ((a - b) / a.abs().max(1.0)).abs());
            assert!(error.filter(|e| !e.is_nan()).all(|e| e < 1e-6), "{camera:?}");
            compared += parts.len();
            covered += whole.image().covered();
        }
    }
    assert!(compared > 200_000 && covered > 50_000, "{covered} of {compared}");
}

#[test]
fn no_rows_are_an_empty_picture() {
    let mut random = Random::new(32);
    let faces = faces(&polygons(&mut random), None);
    let camera = cameras(&mut random, 1.0, [23, 17])[0];
    let rays = Rays::new(&camera, &faces).unwrap();
    for rows in [3..3, 17..40, 90..99] {
        let none = rays.rows(rows);
        assert_eq!(none.size(), [23, 0]);
        assert!(zbuffer(&none, &faces).image().faces().is_empty());
    }
}

#[test]
fn the_rays_of_a_pixel_are_spread_evenly_over_it() {
    let mut random = Random::new(33);
    let mut seen = 0;
    for samples in [1, 2, 3, 8] {
        let faces = faces(&polygons(&mut random), None);
        for camera in cameras(&mut random, 1.0, [31, 20]) {
            let Ok(rays) = Rays::sampled(&camera, &faces, samples) else { continue };
            assert_eq!(rays.size(), [31 * samples, 20 * samples]);
            for [x, y] in [[0, 0], [31 * samples - 1, 3], [samples, 20 * samples - 1]] {
                // Also the same row of a part of the picture.
                for (rays, row) in [(&rays, y), (&rays.rows(y..y + 1), 0)] {
                    let [start, direction] = ray(rays, x, row)
                        .map(|v| DVec3::from_array(v.map(|c| c.to_string().parse().unwrap())));
                    let along = -start.dot(direction) / direction.length_squared();
                    let reach = direction.abs().max_element();
                    let step = if along > 0.0 { along } else { 2f64.powi(50) / reach };
                    let point = faces.lattice().to_world((start + direction * step).to_array());
                    let place = camera.project(point).unwrap();
                    for (found, number) in place.into_iter().zip([x, y]) {
                        let expected = (f64::from(number) + 0.5) / f64::from(samples);
                        assert!((found - expected).abs() < 1e-3, "{x} {y} of {camera:?}");
                    }
                }
                seen += 1;
            }
        }
    }
    assert!(seen > 50, "{seen}");
}

#[test]
fn samples_that_cannot_be_counted_are_an_error() {
    let mut random = Random::new(34);
    let faces = faces(&polygons(&mut random), None);
    let camera = cameras(&mut random, 1.0, [300, 200])[0];
    for samples in [0, u32::MAX, 1 << 24] {
        let error = Rays::sampled(&camera, &faces, samples).unwrap_err();
        assert!(error.to_string().contains("samples"), "{error}");
    }
}
