//! Results are the same on any number of threads, and for pictures of every size.

use super::map_with;
use super::scenes::cameras;
use testkit::prelude::*;

/// Every third polygon is translucent.
fn mixed(polygon: usize) -> f64 {
    if polygon.is_multiple_of(3) { 0.5 } else { 1.0 }
}

/// All outlines of a drawing, bit for bit.
fn bits(drawing: &Drawing) -> Vec<(usize, bool, Vec<[u64; 2]>)> {
    let path = |path: binspace::drawing::Path<'_>| {
        let corners = path.outlines().flatten().map(|corner| corner.map(f64::to_bits));
        (path.polygon(), path.is_clipped(), corners.collect())
    };
    drawing.paths().map(path).collect()
}

#[test]
fn drawings_do_not_depend_on_threads() {
    let scene = Builtin::Random.build(Some(400), 3);
    let tree = BspTree::build(scene.polygons()).unwrap();
    let mut paths = 0;
    for (camera, threads) in cameras(&scene, 2, [240, 180])[..4].iter().zip([2, 5, 2, 5]) {
        let on = |threads: usize| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| {
                let opaque = tree.visibility(camera, &ViewOptions::DEFAULT).unwrap();
                let map = map_with(&tree, camera, mixed);
                let cell = |cell: binspace::drawing::MapCell<'_>| {
                    let corners = cell.corners().map(|corner| corner.map(f64::to_bits));
                    (cell.polygon(), corners.collect::<Vec<_>>())
                };
                let cells: Vec<_> = opaque.cells().chain(map.cells()).map(cell).collect();
                let regions: Vec<_> = map.regions().unwrap();
                let regions: Vec<_> = regions
                    .iter()
                    .map(|region| (region.polygons().to_vec(), region.area().to_bits()))
                    .collect();
                let all = [
                    opaque.drawing().unwrap(),
                    map.drawing().unwrap(),
                    Drawing::translucent(&tree, camera, &ViewOptions::DEFAULT, None).unwrap(),
                ];
                (cells, regions, all.each_ref().map(bits))
            })
        };
        let alone = on(1);
        paths += alone.2.iter().map(Vec::len).sum::<usize>();
        assert!(on(threads) == alone, "{threads} threads");
    }
    enough!(paths > 2_000; "{paths}");
}

fn shown(tree: &BspTree, camera: &Camera) -> Vec<(usize, f64)> {
    let map = map_with(tree, camera, mixed);
    map.polygons().map(|shown| (shown.polygon, shown.area)).collect()
}

/// Scenes in pictures of one pixel and of the largest size: the same polygons are visible, with the same
/// shares.
#[test]
fn pictures_of_all_sizes_show_the_same_polygons() {
    let mut compared = 0;
    for builtin in [Builtin::City, Builtin::Random, Builtin::Newell] {
        let size = builtin.default_size().map(|size| size.min(300));
        let scene: Scene = builtin.build(size, 3);
        let tree = BspTree::build(scene.polygons()).unwrap();
        let of_size = |size: u32| -> Vec<Camera> { cameras(&scene, 3, [size; 2]) };
        for (i, camera) in of_size(128).iter().enumerate() {
            let expected = shown(&tree, camera);
            for size in [1, 5, 8192] {
                let found = shown(&tree, &of_size(size)[i]);
                assert_eq!(found.len(), expected.len(), "{builtin:?} {size}");
                let scale = (f64::from(size) / 128.0).powi(2);
                for (found, expected) in found.iter().zip(&expected) {
                    let off = (found.1 / scale - expected.1).abs();
                    assert!(found.0 == expected.0 && off < 1e-5, "{size} {found:?} {expected:?}");
                    compared += 1;
                }
            }
        }
    }
    enough!(compared > 3_000; "{compared}");
}
