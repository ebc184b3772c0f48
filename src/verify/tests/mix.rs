//! The method of engines: opaque polygons in any order with a depth buffer, then translucent polygons in the
//! tree's order, with the depth test on and depth writes off. The expected colour of a pixel is computed from
//! all polygons that an exact ray meets, sorted by their exact distances.

use std::collections::HashMap;

use dashu_ratio::RBig;

use super::cameras;
use crate::exact::Faces;
use crate::paint::Pieces;
use crate::raster::tests::oracle::Target;
use crate::raster::{Rays, for_each_run};
use crate::scene::Scene;
use crate::tree::BspTree;
use crate::{BuildOptions, Heuristic, Viewpoint, scene};

type Colour = [f64; 3];

const BACKGROUND: Colour = [0.2, 0.3, 0.5];

fn is_opaque(polygon: usize) -> bool {
    polygon.is_multiple_of(4)
}

/// Paints a polygon over a colour. Each polygon has a different colour and opacity.
fn paint(over: &mut Colour, polygon: usize) {
    let opacity =
        if is_opaque(polygon) { 1.0 } else { 0.3 + 0.4 * (polygon as f64 * 0.61).fract() };
    for (k, channel) in over.iter_mut().enumerate() {
        let colour = (polygon as f64 * [0.37, 0.59, 0.83][k]).fract();
        *channel = *channel * (1.0 - opacity) + colour * opacity;
    }
}

/// For each pixel, every face that its ray meets, and its distance.
type Hits = Vec<HashMap<u32, RBig>>;

fn hits(rays: &Rays, faces: &Faces) -> Hits {
    let [width, height] = rays.size();
    let pixels = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
    let all = Target::all(faces);
    let of_pixel = |(x, y)| {
        let numbered = all.iter().zip(0..);
        numbered.filter_map(|(target, face)| Some((face, target.meets(rays, x, y)?))).collect()
    };
    pixels.map(of_pixel).collect()
}

/// The picture by sorting: the nearest opaque polygon, and all polygons in front of it. At the same distance,
/// translucent polygons are over opaque polygons, and later over earlier polygons.
fn sorted_picture(faces: &Faces, hits: &Hits) -> Vec<Colour> {
    let of_pixel = |hits: &HashMap<u32, RBig>| {
        let mut all: Vec<(&RBig, bool, usize)> = hits
            .iter()
            .map(|(&face, distance)| {
                let polygon = faces.polygon(face);
                (distance, is_opaque(polygon), polygon)
            })
            .collect();
        all.sort_by(|a, b| b.0.cmp(a.0).then(b.1.cmp(&a.1)).then(a.2.cmp(&b.2)));
        let mut colour = BACKGROUND;
        all.iter().for_each(|&(_, _, polygon)| paint(&mut colour, polygon));
        colour
    };
    hits.iter().map(of_pixel).collect()
}

/// The picture as an engine draws it, with the translucent fragments in a given order.
fn mixed_picture(tree: &BspTree, rays: &Rays, hits: &Hits, translucent: &[u32]) -> Vec<Colour> {
    let faces = tree.faces();
    let width = rays.size()[0];
    let mut colours = vec![BACKGROUND; hits.len()];
    let mut depths: Vec<Option<RBig>> = vec![None; hits.len()];
    let mut opaque: Vec<u32> = (0..tree.len() as u32).collect();
    opaque.retain(|&fragment| is_opaque(tree.fragment(fragment).polygon()));
    opaque.sort_by_key(|&fragment| tree.fragment(fragment).polygon());
    let mut pieces = Pieces::default();
    for (fragments, writes_depth) in [(&opaque[..], true), (translucent, false)] {
        for &index in fragments {
            let fragment = tree.fragment(index);
            let (face, polygon) = (fragment.face(), fragment.polygon());
            for_each_run(rays, faces, pieces.of(&fragment), |y, columns| {
                for pixel in columns.map(|x| (y * width + x) as usize) {
                    let distance = &hits[pixel][&face];
                    if depths[pixel].as_ref().is_some_and(|nearest| distance > nearest) {
                        continue;
                    }
                    paint(&mut colours[pixel], polygon);
                    if writes_depth {
                        depths[pixel] = Some(distance.clone());
                    }
                }
            });
        }
    }
    colours
}

/// The translucent fragments in the order of the indices that a mesh writes.
fn written(tree: &BspTree, viewpoint: Viewpoint) -> Vec<u32> {
    let mesh = tree.welded_mesh().unwrap();
    let triangles = mesh.triangles_of(|polygon| !is_opaque(polygon)).unwrap();
    let mut owners: HashMap<&[u32], u32> = HashMap::new();
    for fragment in 0..tree.len() as u32 {
        let range = triangles.range(fragment);
        triangles.indices()[range].chunks(3).for_each(|triangle| {
            assert!(owners.insert(triangle, fragment).is_none(), "a triangle of two fragments");
        });
    }
    let (mut order, mut indices) = (Vec::new(), vec![0; triangles.indices().len()]);
    triangles.write_back_to_front(tree, viewpoint, &mut order, &mut indices).unwrap();
    let mut fragments: Vec<u32> = indices.chunks(3).map(|triangle| owners[triangle]).collect();
    fragments.dedup();
    fragments
}

fn scenes() -> [Scene; 3] {
    [scene::random_triangles(24, 3), scene::crossing(7), scene::newell_bars()]
}

#[test]
fn opaque_by_depth_and_translucent_in_tree_order_is_the_exact_picture() {
    let (mut pixels, mut deep, mut wrong_unsorted) = (0, 0, 0);
    for scene in scenes() {
        let trees = [Heuristic::Auto, Heuristic::Random { seed: 4 }].map(|heuristic| {
            let options = BuildOptions::DEFAULT.with_heuristic(heuristic).with_tolerance(0.0);
            (heuristic, options.build(scene.polygons()).unwrap())
        });
        // Both trees have the same faces.
        let faces = trees[0].1.faces();
        for camera in cameras(&scene, 2) {
            let rays = Rays::new(&camera, faces).unwrap();
            let hits = hits(&rays, faces);
            let truth = sorted_picture(faces, &hits);
            for (heuristic, tree) in &trees {
                let order = written(tree, camera.viewpoint());
                let mixed = mixed_picture(tree, &rays, &hits, &order);
                let differ = truth.iter().zip(&mixed).filter(|(a, b)| a != b).count();
                assert_eq!(differ, 0, "{} by {heuristic} from {camera:?}", scene.name());
                pixels += hits.iter().filter(|hits| !hits.is_empty()).count();
                deep += hits.iter().filter(|hits| hits.len() > 2).count();
                let mut unsorted = order;
                unsorted.sort_unstable();
                let unsorted = mixed_picture(tree, &rays, &hits, &unsorted);
                wrong_unsorted += truth.iter().zip(&unsorted).filter(|(a, b)| a != b).count();
            }
        }
    }
    assert!(pixels > 13_000 && deep > 2600, "{pixels} pixels, {deep} of three faces or more");
    assert!(wrong_unsorted > 600, "the order does not matter: {wrong_unsorted}");
}
