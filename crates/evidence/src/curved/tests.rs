//! Curved surfaces against exact rays.

use std::collections::BTreeMap;
use testkit::prelude::*;

use super::{Cast, Patch, Shared, Sphere, Surfaces, mesh, nearest};
use crate::panes::{panes, world_polygons};
use crate::plain::PlainView;
use binspace::raster::NONE;

const SIZE: [u32; 2] = [84, 63];

fn pixels() -> impl Iterator<Item = [u32; 2]> {
    (0..SIZE[1]).flat_map(|y| (0..SIZE[0]).map(move |x| [x, y]))
}

#[test]
fn a_sphere_beside_polygons_is_exact() {
    let view = PlainView::new(SIZE);
    let (mut compared, mut hidden) = (0, 0);
    for seed in 0..3 {
        let (integers, _) = panes(12, seed);
        let (faces, _) = Faces::new(world_polygons(&integers), Some(0.0)).unwrap();
        let rays = Rays::new(&view.camera(), &faces).unwrap();
        let mut picture = Shared::new(&rays, &faces);
        let sphere = Sphere { centre: [100, -60, -2000], radius: 600 };
        sphere.draw(&view, 99, &mut picture);
        for (pixel, &shown) in pixels().zip(picture.shown()) {
            let Some(layers) = view.layers(&integers, pixel) else { continue };
            let polygon = layers.first();
            let before = |depth| sphere.compare(&view, pixel, depth) == Ordering::Less;
            let is_nearest =
                sphere.is_met(&view, pixel) && polygon.is_none_or(|(_, depth)| before(depth));
            let expected = if is_nearest { 99 } else { polygon.map_or(NONE, |p| p.0) };
            assert_eq!(shown, expected, "{pixel:?}");
            compared += usize::from(shown == 99);
            hidden += usize::from(shown != 99 && sphere.is_met(&view, pixel));
        }
    }
    assert!(compared > 1000 && hidden > 200, "{compared} {hidden}");
}

#[test]
fn patches_are_where_exact_rays_meet_them() {
    let view = PlainView::new(SIZE);
    let empty = Shared {
        width: SIZE[0],
        depths: vec![f64::INFINITY; (SIZE[0] * SIZE[1]) as usize],
        shown: vec![NONE; (SIZE[0] * SIZE[1]) as usize],
    };
    for patch in Patch::pair() {
        let mut picture = empty.clone();
        patch.draw(&view, 7, &mut picture);
        let (mut met, mut missed, mut doubtful) = (0, 0, 0);
        for (i, pixel) in pixels().enumerate() {
            let (shown, depth) = (picture.shown[i], picture.depths[i]);
            match Cast::new(&patch, &view, pixel) {
                Cast::Misses => {
                    assert_eq!(shown, NONE, "{pixel:?}");
                    missed += 1;
                }
                Cast::Meets([low, high]) => {
                    assert!(
                        shown == 7 && low <= depth && depth <= high,
                        "{pixel:?} {low} {depth} {high}"
                    );
                    assert!(high - low < 0.2, "{low} {high}");
                    met += 1;
                }
                Cast::Doubtful => doubtful += 1,
            }
        }
        assert!(met > 500 && missed > 500 && doubtful * 5 < met, "{met} {missed} {doubtful}");
    }
}

#[test]
fn patches_are_cut_without_cracks_to_the_tolerance() {
    let view = PlainView::new(SIZE);
    for tolerance in [2.0, 0.5, 0.1] {
        let triangles: Vec<_> = mesh(&Patch::pair(), &view, tolerance).concat();
        let mut sides: BTreeMap<[[u64; 3]; 2], usize> = BTreeMap::new();
        for triangle in &triangles {
            let bits = triangle.corners.map(|corner| corner.to_array().map(f64::to_bits));
            for k in 0..3 {
                let mut ends = [bits[k], bits[(k + 1) % 3]];
                ends.sort_unstable();
                *sides.entry(ends).or_default() += 1;
            }
        }
        // Two triangles share each side, except on the boundary: six edges of the two patches.
        assert!(sides.values().all(|&count| count <= 2));
        let boundary: Vec<_> = sides.iter().filter(|(_, count)| **count == 1).collect();
        let mut ends: BTreeMap<[u64; 3], usize> = BTreeMap::new();
        boundary
            .iter()
            .flat_map(|(ends, _)| ends.iter())
            .for_each(|&end| *ends.entry(end).or_default() += 1);
        assert!(ends.values().all(|&count| count == 2), "the boundary is one closed line");
        // Euler: one piece without holes.
        let corners: std::collections::BTreeSet<_> = sides.keys().flatten().collect();
        assert_eq!(corners.len() + triangles.len() + 1, sides.len() + 2, "{tolerance}");
        assert_eq!(ends.len(), boundary.len());
        // Distances of middles from the patch, in pixels.
        let pixel = 2.0 / view.ray([0, 0])[2].abs() as f64;
        let mut largest = 0.0f64;
        for (patch, triangles) in Patch::pair().iter().zip(mesh(&Patch::pair(), &view, tolerance)) {
            for triangle in triangles {
                let [a, b, c] = triangle.parameters;
                let middle = [0, 1].map(|n: usize| (a[n] + b[n] + c[n]) / 3.0);
                let place = patch.at(middle[0], middle[1]);
                let mean = triangle.corners.iter().sum::<glam::DVec3>() / 3.0;
                let off = (mean - glam::DVec3::from_array(place)).length();
                largest = largest.max(off / (-place[2] * pixel));
            }
        }
        assert!(largest < tolerance && largest > 0.05 * tolerance, "{tolerance}: {largest}");
    }
}

/// An edge is divided as finely as the finer of its two patches needs. This holds also if only one of the
/// patches is bent across the edge, in either order.
#[test]
fn shared_edges_are_as_fine_as_either_patch_needs() {
    let view = PlainView::new(SIZE);
    let [bent, _] = Patch::pair();
    // A much flatter patch on the other side of the edge, in which each row is a moved copy of the edge.
    let edge = bent.0[3];
    let flat = Patch(std::array::from_fn(|i| edge.map(|[x, y, z]| [x, y, z - 4 * i as i64])));
    let points = |patches: &[Patch], which: usize| {
        let is_on_edge =
            |parameters: &[f64; 2]| parameters[0] == if which == 0 { 1.0 } else { 0.0 };
        let triangles = &mesh(patches, &view, 0.1)[usize::from(patches.len() > 1) * which];
        let corners = triangles.iter().flat_map(|t| t.parameters.iter().zip(&t.corners));
        let on_edge = corners.filter(|(parameters, _)| is_on_edge(parameters));
        let bits = on_edge.map(|(_, corner)| corner.to_array().map(f64::to_bits));
        bits.collect::<std::collections::BTreeSet<_>>()
    };
    let (of_bent, of_flat) = (points(&[bent], 0), points(&[flat], 1));
    assert!(of_bent.len() > of_flat.len() + 2, "{} {}", of_bent.len(), of_flat.len());
    assert_eq!(points(&[bent, flat], 0), of_bent);
    assert_eq!(points(&[bent, flat], 1), of_bent);
    let reversed = mesh(&[flat, bent], &view, 0.1);
    assert_eq!(reversed[1], mesh(&[bent], &view, 0.1)[0]);
}

#[test]
fn all_surfaces_share_a_depth_buffer() {
    let view = PlainView::new(SIZE);
    let (polygons, _) = panes(8, 2);
    let (faces, _) = Faces::new(world_polygons(&polygons), Some(0.0)).unwrap();
    let rays = Rays::new(&view.camera(), &faces).unwrap();
    let mut picture = Shared::new(&rays, &faces);
    let sphere = Sphere { centre: [100, -60, -1800], radius: 350 };
    let surfaces = Surfaces { polygons: &polygons, sphere, patches: &Patch::pair() };
    surfaces.draw(&view, &mut picture);
    let mut counts = [0; 3];
    let mut judged = 0;
    for (pixel, &shown) in pixels().zip(picture.shown()) {
        let Some(expected) = nearest(&surfaces, &view, pixel) else { continue };
        assert_eq!(shown, expected, "{pixel:?}");
        judged += 1;
        if shown >= 8 && shown != NONE {
            counts[shown as usize - 8] += 1;
        }
    }
    assert!(counts.iter().all(|&count| count > 150) && judged > 4400, "{counts:?} {judged}");
}
