//! Coverage masks compared with exact pictures.

use crate::walk::trees;
use binspace::occlusion::CoverageMask;
use binspace::paint::paint_order;
use binspace::paint::paint_tree;
use binspace::view;
use binspace::{Flow, Part};
use testkit::prelude::*;
use testkit::scenes::cells;

/// The fragments that a mask lets through, back to front, and the number of visited parts.
fn unhidden(tree: &BspTree, camera: &Camera, rays: &Rays, cell: u32) -> (Vec<u32>, usize) {
    let mut mask = CoverageMask::new(tree, rays, cell);
    let (mut found, mut visited) = (Vec::new(), 0);
    let _ = tree.order(camera.viewpoint()).front_to_back().walk(|part| {
        visited += 1;
        match part {
            Part::Subtree(node) if mask.hides(node.bounds()) => return Flow::Skip,
            Part::Fragment(fragment) if mask.cover(&fragment) => found.push(fragment.index()),
            _ => {}
        }
        if mask.is_full() { Flow::Break(()) } else { Flow::Descend }
    });
    found.reverse();
    (found, visited)
}

#[test]
fn no_polygon_that_owns_a_pixel_is_hidden() {
    let [mut skipped, mut all, mut hidden] = [0; 3];
    for tree in trees().into_iter().filter(|tree| tree.len() > 1) {
        let bounds = tree.bounds().unwrap();
        for camera in view::views(bounds, DVec3::Z, 4, [67, 41], 9).unwrap() {
            for fronts in [false, true] {
                let Ok(rays) = Rays::new(&camera, tree.faces()) else { continue };
                let rays = if fronts { rays.with_front_faces_only() } else { rays };
                let whole = paint_tree(&tree, camera.viewpoint(), &rays);
                for cell in [1, 3, 8, 64] {
                    let (found, visited) = unhidden(&tree, &camera, &rays, cell);
                    let picture = paint_order(&tree, &found, &rays);
                    assert_eq!(picture.faces(), whole.faces(), "{cell}");
                    let parts = tree.len() + tree.stats().nodes;
                    skipped += usize::from(visited < parts);
                    all += 1;
                    if cell == 1 {
                        // Each remaining fragment is visible in a pixel: without it, the picture differs.
                        for gone in (0..found.len()).step_by(17) {
                            let mut rest = found.clone();
                            rest.remove(gone);
                            assert_ne!(
                                paint_fragments(&tree, &rest, &rays),
                                paint_fragments(&tree, &found, &rays)
                            );
                            hidden += 1;
                        }
                    }
                }
            }
        }
    }
    assert!(skipped * 2 > all && hidden > 500, "{skipped} of {all}, {hidden}");
}

/// The visible fragment in each pixel.
fn paint_fragments(tree: &BspTree, order: &[u32], rays: &Rays) -> Vec<u32> {
    // The number of fragments that cover each pixel is stored too, because fragments of one face look the
    // same.
    let image = paint_order(tree, order, rays);
    let mut shown = image.faces().to_vec();
    shown.push(image.drawn() as u32);
    shown
}

/// A mask with cells of one pixel knows exactly which pixels are covered: a fragment passes if one of its own pixels is
/// open, wherever other pixels of its rows are open.
#[test]
fn a_fragment_passes_if_one_of_its_pixels_is_open() {
    let mut outcomes = [0; 2];
    for tree in trees().into_iter().filter(|tree| tree.len() > 1) {
        let bounds = tree.bounds().unwrap();
        for camera in view::views(bounds, DVec3::Z, 2, [131, 29], 9).unwrap() {
            let Ok(rays) = Rays::new(&camera, tree.faces()) else { continue };
            let mut mask = CoverageMask::new(&tree, &rays, 1);
            let mut is_covered = vec![false; 131 * 29];
            let order = tree.order(camera.viewpoint()).front_to_back();
            for fragment in order.into_iter().take(300) {
                let alone = paint_order(&tree, &[fragment.index()], &rays);
                let owned = alone.faces().iter().map(|&face| face == fragment.face());
                let passes =
                    owned.clone().zip(&is_covered).any(|(owned, &covered)| owned && !covered);
                assert_eq!(mask.cover(&fragment), passes, "{}", fragment.index());
                owned.zip(&mut is_covered).for_each(|(owned, covered)| *covered |= owned);
                outcomes[usize::from(passes)] += 1;
            }
        }
    }
    assert!(outcomes.iter().all(|&count| count > 500), "{outcomes:?}");
}

#[test]
fn walls_save_most_visits() {
    let tree = BspTree::build(cells(10, &mut Dice(10))).unwrap();
    let parts = tree.len() + tree.stats().nodes;
    let eye = DVec3::new(5.4, 5.6, 5.3);
    for k in 0..6 {
        let look = DVec3::new((f64::from(k)).cos(), (f64::from(k)).sin(), -0.05);
        let camera = Camera::perspective(eye, eye + look, DVec3::Z, 1.0, [160, 90]).unwrap();
        let rays = Rays::new(&camera, tree.faces()).unwrap();
        let (found, visited) = unhidden(&tree, &camera, &rays, 1);
        assert!(visited * 4 < parts, "{visited} of {parts}");
        let picture = paint_order(&tree, &found, &rays);
        assert_eq!(picture.faces(), paint_tree(&tree, camera.viewpoint(), &rays).faces());
    }
}
