//! The resolving power of depth buffers of limited precision.

use super::oracle::{Meeting, meet};
use super::{Polygons, cameras, disjoint, faces, judge, polygons_of, show};
use crate::method::{DepthBuffer, DepthFormat, Interpolation, Method};
use binspace::raster::NONE;
use testkit::prelude::*;

use DepthFormat::{Float, FloatReversed, Integer, LinearFloat, LinearInteger};

const FORMATS: [DepthFormat; 6] =
    [Integer(16), Integer(24), Float, FloatReversed, LinearInteger(16), LinearFloat];

/// A camera at the origin that looks along −z.
fn ahead(size: [u32; 2]) -> Camera {
    Camera::perspective(DVec3::ZERO, DVec3::NEG_Z, DVec3::Y, 1.0, size).unwrap()
}

/// A square perpendicular to the direction of view at some depth, wider than the picture.
fn wall(depth: f64) -> Vec<DVec3> {
    let c = 2.0 * depth;
    [(-c, -c), (c, -c), (c, c), (-c, c)].map(|(x, y)| DVec3::new(x, y, -depth)).to_vec()
}

/// The number of pairs of walls, `gap` apart, in which the further wall is shown. The further wall is drawn
/// first.
fn mistaken(format: DepthFormat, gap: f64) -> usize {
    let camera = ahead([2, 2]);
    let method = DepthBuffer::new(format).with_range(1.0, 1000.0);
    let wrong = |i: &i32| {
        let depth = 500.0 + 0.37 * f64::from(*i);
        let faces = faces(&vec![wall(depth + gap), wall(depth)], Some(0.0));
        show(&method, &faces, &camera).image.faces()[0] == 0
    };
    (0..40).filter(wrong).count()
}

#[test]
fn precision_is_that_of_the_format() {
    // At depth 500 of 1 to 1000, z changes by 4e-6 per unit, and w by 1e-3 of its range. A step of 16 bits is
    // 15e-6 of z, or 0.0152 units of w.
    assert!(mistaken(Integer(16), 1.0) > 20);
    assert_eq!(mistaken(Integer(16), 4.0), 0);
    assert_eq!(mistaken(LinearInteger(16), 0.016), 0);
    assert!(mistaken(LinearInteger(16), 0.004) > 20);
    // A step of 24 bits is 6e-8 of z, or 0.015 units; a step of an f32 between ½ and 1 is the same.
    assert_eq!(mistaken(Integer(24), 0.016), 0);
    assert!(mistaken(Integer(24), 0.004) > 20);
    assert!(mistaken(Float, 0.004) > 20);
    // Reversed, z is about 1e-3, with steps of 1.2e-10: the steps of w itself, 3e-5, are larger.
    assert_eq!(mistaken(FloatReversed, 0.001), 0);
    assert_eq!(mistaken(LinearFloat, 0.001), 0);
    assert!(mistaken(FloatReversed, 1e-6) > 20 && mistaken(LinearFloat, 1e-6) > 20);
}

/// Whether a difference between two pictures in a pixel is excused: one of the two polygons has an edge
/// there, or both are at about the same depth.
fn is_excused(polygons: &Polygons, camera: &Camera, [x, y]: [u32; 2], shown: [u32; 2]) -> bool {
    let meeting = shown.map(|face| match face {
        NONE => Meeting::Nothing,
        face => meet(&polygons[face as usize], camera, x, y),
    });
    match meeting {
        [Meeting::Doubtful, _] | [_, Meeting::Doubtful] => true,
        [Meeting::At(a), Meeting::At(b)] => (a - b).abs() < 1e-5 * (1.0 + a.abs()),
        _ => false,
    }
}

#[test]
fn walks_along_edges_agree_with_edge_functions() {
    let scenes = [disjoint(4, 1), polygons_of(&scene::random_triangles(80, 2))];
    let (mut differ, mut compared) = ([0; 4], 0);
    for polygons in &scenes {
        let faces = faces(polygons, Some(0.0));
        for camera in cameras(polygons, [80, 60], 3) {
            for format in FORMATS {
                let pictures = Interpolation::ALL.map(|how| {
                    let method = DepthBuffer::new(format).with_interpolation(how);
                    show(&method, &faces, &camera).image
                });
                compared += pictures[0].covered();
                for (walk, picture) in pictures.iter().enumerate() {
                    let pairs = pictures[0].faces().iter().zip(picture.faces());
                    for (pixel, (&exact, &shown)) in (0u32..).zip(pairs) {
                        differ[walk] += usize::from(exact != shown);
                        let (at, both) = ([pixel % 80, pixel / 80], [exact, shown]);
                        // Vertices are rounded to 1/256 of a pixel: more than the uncertainty of a boundary.
                        let excused = exact == shown
                            || Interpolation::ALL[walk] == Interpolation::IntegerEdges
                            || is_excused(polygons, &camera, at, both);
                        assert!(excused, "{format} {walk}: {both:?} at {at:?} of {camera:?}");
                    }
                }
            }
        }
    }
    assert!(compared > 80_000, "{compared}");
    let [exact, incremental, trapezoids, integer] = differ;
    assert_eq!(exact, 0);
    assert!(incremental * 500 < compared && trapezoids * 500 < compared, "{differ:?} {compared}");
    assert!(integer * 200 < compared, "{differ:?} of {compared}");
}

#[test]
fn edge_functions_leave_holes_only_beyond_the_range_of_depths() {
    // A floor below the eye. At the least height, the eye is so near to the floor that its visible part is
    // outside the range of depths.
    let corners = [(-1.0, -1.0), (-1.0, 1.0), (1.0, 1.0), (1.0, -1.0)];
    let floor = corners.map(|(x, z)| DVec3::new(x, 0.0, z)).to_vec();
    let faces = faces(&vec![floor], Some(0.0));
    let found = |height: f64| {
        let eye = DVec3::new(0.1, height, 0.2);
        let camera = Camera::perspective(eye, eye - DVec3::Z, DVec3::Y, 1.0, [12, 12]).unwrap();
        judge(&DepthBuffer::new(Integer(24)), &faces, &camera)
    };
    for (height, holes) in [(1e-3, 0), (1e-9, 0), (1e-15, 72)] {
        let found = found(height);
        assert_eq!((found.covered, found.holes, found.spills), (72, holes, 0), "{height:e}");
    }
}

#[test]
fn rounded_sums_are_seldom_wrong() {
    let polygons = disjoint(4, 5);
    let faces = faces(&polygons, Some(0.0));
    for (format, how) in FORMATS.into_iter().flat_map(|f| Interpolation::ALL.map(|how| (f, how))) {
        let (mut wrong, mut covered) = (0, 0);
        for camera in cameras(&polygons, [80, 60], 5) {
            let method = DepthBuffer::new(format).with_interpolation(how);
            let result = judge(&method, &faces, &camera);
            wrong += result.wrong();
            covered += result.covered;
        }
        assert!(wrong * 200 < covered, "{format} {how:?}: {wrong} of {covered}");
    }
}

#[test]
fn only_pixels_with_near_depths_are_wrong() {
    let polygons = polygons_of(&scene::random_triangles(80, 6));
    let faces = faces(&polygons, Some(0.0));
    for camera in cameras(&polygons, [80, 60], 6) {
        let rays = Rays::new(&camera, &faces).unwrap();
        let truth = binspace::raster::zbuffer(&rays, &faces).into_image();
        let shown = show(&DepthBuffer::new(Integer(24)), &faces, &camera).image;
        for (pixel, (&a, &b)) in (0u32..).zip(shown.faces().iter().zip(truth.faces())) {
            let at = [pixel % 80, pixel / 80];
            assert_eq!(a == NONE, b == NONE, "coverage is exact");
            assert!(a == b || is_excused(&polygons, &camera, at, [a, b]), "{a} for {b} at {at:?}");
        }
    }
}

#[test]
fn planes_near_and_far_cut_off() {
    let polygons = vec![wall(2.0), wall(4.0)];
    let faces = faces(&polygons, Some(0.0));
    let shown = |near, far, how| {
        let method = DepthBuffer::new(Integer(16)).with_range(near, far).with_interpolation(how);
        let painted = show(&method, &faces, &ahead([4, 4]));
        let first = painted.image.faces()[0];
        assert!(painted.image.faces().iter().all(|&face| face == first));
        first
    };
    for how in Interpolation::ALL {
        assert_eq!(shown(1.0, 8.0, how), 0);
        assert_eq!(shown(3.0, 8.0, how), 1);
        assert_eq!(shown(5.0, 8.0, how), NONE);
        assert_eq!(shown(0.5, 1.0, how), NONE);
    }
}

#[test]
fn a_floor_is_cut_off_between_the_planes() {
    // The floor is 1 below the eye. The picture has 12 rows of height 0.577 / 6 = 0.0962 at depth 1. Row y
    // shows the floor at depth 1 / (0.0962 (y − 5.5)): 20.8, 6.9, 4.2, 3.0, 2.3, 1.9.
    let c = 100.0;
    let floor = [(-c, c), (c, c), (c, -c), (-c, -c)].map(|(x, z)| DVec3::new(x, -1.0, z)).to_vec();
    let faces = faces(&vec![floor], Some(0.0));
    let fov = std::f64::consts::FRAC_PI_3;
    let camera = Camera::perspective(DVec3::ZERO, DVec3::NEG_Z, DVec3::Y, fov, [5, 12]).unwrap();
    let rows = |method: DepthBuffer| {
        let painted = show(&method, &faces, &camera);
        let row = |y: &usize| painted.image.faces()[y * 5 + 2] == 0;
        (0..12).filter(row).collect::<Vec<usize>>()
    };
    for how in Interpolation::ALL {
        for format in FORMATS {
            let method = DepthBuffer::new(format).with_interpolation(how);
            assert_eq!(rows(method), [6, 7, 8, 9, 10, 11], "{method:?}");
            assert_eq!(rows(method.with_range(2.0, 5.0)), [8, 9, 10], "{method:?}");
            let near = DepthBuffer { near: Some(2.5), ..method };
            assert_eq!(rows(near), [6, 7, 8, 9], "{method:?}");
            let far = DepthBuffer { far: Some(5.0), ..method };
            assert_eq!(rows(far), [8, 9, 10, 11], "{method:?}");
        }
    }
}

#[test]
fn senseless_planes_are_errors() {
    let faces = faces(&vec![wall(2.0)], Some(0.0));
    let fails = |camera: &Camera, near, far| {
        let rays = Rays::new(camera, &faces).unwrap();
        let method = DepthBuffer { near, far, ..DepthBuffer::new(Integer(16)) };
        let result = method.prepare(&faces).unwrap().paint(camera, &rays);
        assert!(result.as_ref().err().is_none_or(|error| !error.is_over_budget()));
        result.is_err()
    };
    let camera = &ahead([4, 4]);
    assert!(fails(camera, Some(3.0), Some(2.0)) && fails(camera, Some(0.0), None));
    assert!(fails(camera, Some(f64::NAN), Some(2.0)) && fails(camera, None, Some(f64::INFINITY)));
    assert!(!fails(camera, Some(1e-9), None) && !fails(camera, None, Some(1e9)));
    assert!(!fails(camera, Some(1e9), None) && !fails(camera, None, Some(1e-9)));
    let parallel = Camera::parallel(DVec3::NEG_Z, DVec3::Y, DVec3::ZERO, 2.0, [4, 4]).unwrap();
    assert!(!fails(&parallel, Some(-3.0), Some(0.0)) && fails(&parallel, Some(1.0), Some(1.0)));
}
