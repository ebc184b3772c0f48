//! Objects made from one tree and used with another tree of the same size are refused, or give right results.

use binspace::occlusion::CoverageMask;
use binspace::overlay::Overlay;
use binspace::raster::{Painter, compare, picture, zbuffer};
use binspace::{Ray, paint, raster};
use std::panic::{AssertUnwindSafe, catch_unwind};
use testkit::prelude::*;
use testkit::shapes::sheet;

/// The number of squares of a frame, one above another.
const CARDS: usize = 5;

fn square(height: f64) -> [[f64; 3]; 4] {
    sheet(2, height, 4.0)
}

/// The squares from the lowest to the highest, or reversed.
fn frame(is_turned: bool) -> impl Iterator<Item = [[f64; 3]; 4]> {
    (0..CARDS).map(move |card| square(if is_turned { CARDS - 1 - card } else { card } as f64))
}

/// Two frames with equal counts, grids and tolerances, and the first frame again.
fn frames() -> Vec<[BspTree; 3]> {
    let options = BuildOptions::DEFAULT.with_heuristic(Heuristic::First);
    let build = |is_turned| options.build(frame(is_turned)).expect("within budget");
    let mut builder = FrameBuilder::new(options.clone());
    let mut rebuild = |is_turned| builder.build(frame(is_turned)).expect("within budget").clone();
    let frames = vec![[false, true, false].map(build), [false, true, false].map(&mut rebuild)];
    for [one, other, _] in &frames {
        let counts = |tree: &BspTree| {
            let faces = tree.faces();
            let sizes = [tree.len(), tree.nodes().len(), faces.len(), faces.corner_count()];
            (sizes, tree.preparation().polygons, tree.grid(), faces.tolerance())
        };
        assert_eq!(counts(one), counts(other), "they would be refused anyway");
        let order = |tree: &BspTree| {
            let order = tree.back_to_front(ABOVE);
            order.map(|fragment| fragment.polygon()).collect::<Vec<_>>()
        };
        assert_ne!(order(one), order(other), "so that something could go wrong");
    }
    frames
}

/// The result must not be returned.
fn ignore<T>(_: T) {}

const ABOVE: Viewpoint = Viewpoint::Direction(DVec3::NEG_Z);

/// The message of the panic in which a call ends.
fn panic_of(call: impl FnOnce()) -> String {
    let panic = catch_unwind(AssertUnwindSafe(call)).expect_err("it is of another tree");
    panic
        .downcast_ref::<&str>()
        .map(|message| (*message).to_owned())
        .unwrap_or_else(|| panic.downcast_ref::<String>().cloned().expect("a message"))
}

#[test]
fn an_overlay_of_another_frame_is_refused() {
    for [one, other, _] in &frames() {
        let mut overlay = Overlay::new(one);
        overlay.replace(one, [square(2.5)]).expect("on the grid");
        let mut order = Vec::new();
        assert!(overlay.order(other, ABOVE).is_err());
        let error = overlay.replace(other, [square(2.5)]).expect_err("another frame");
        assert!(error.to_string().contains("make an overlay for this tree"), "{error}");
        overlay.replace(&one.clone(), [square(2.5)]).expect("a copy is the same");
        overlay.order(one, ABOVE).expect("its own").write_into(&mut order);
        assert_eq!(order.len(), CARDS + 1);
        // An overlay without contents.
        assert!(Overlay::new(one).order(other, ABOVE).is_err());
    }
}

/// Boxes belong to a tree, and stay right through copies, extensions and frames.
#[test]
fn boxes_belong_to_the_current_polygons_of_the_tree() {
    let mut tree = BspTree::build([square(0.0)]).expect("within budget");
    let [_, high] = tree.bounds().expect("a polygon");
    let copy = tree.clone();
    assert!((0.0..1e-5).contains(&high.z) && copy.bounds() == tree.bounds());
    BuildOptions::DEFAULT.extend(&mut tree, [square(2.0)]).expect("within budget");
    let [_, high] = tree.bounds().expect("polygons");
    assert!((2.0..2.001).contains(&high.z) && copy.bounds() != tree.bounds());
    let mut builder = FrameBuilder::new(BuildOptions::DEFAULT);
    for z in [1.0, 7.0, 3.0] {
        let frame = builder.build([square(z), square(0.0)]).expect("within budget");
        let [_, high] = frame.bounds().expect("polygons");
        assert!((z..z + 0.001).contains(&high.z), "{z}");
        let ray = Ray::new([1.0, 1.0, 9.0], [0.0, 0.0, -1.0]);
        let hits: Vec<usize> = frame.hits(ray).map(|hit| hit.polygon()).collect();
        assert!(hits == [0, 1] && frame.is_occluded(ray), "{z}: {hits:?}");
    }
    builder.build::<[[f64; 3]; 3]>([]).expect("nothing");
    assert_eq!(builder.tree().bounds(), None);
}

/// Each frame tests again whether bodies are closed.
#[test]
fn open_edges_belong_to_the_current_polygons_of_the_frame() {
    let [a, b, c, d] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let body = [[a, c, b], [a, b, d], [a, d, c], [b, c, d]];
    let mut builder = FrameBuilder::new(BuildOptions::DEFAULT);
    for count in [4, 3, 4] {
        let frame = builder.build(&body[..count]).expect("within budget");
        assert_eq!(frame.open_edges().len(), if count == 4 { 0 } else { 3 });
        assert_eq!(frame.winding_number([0.1, 0.2, 0.3]).is_ok(), count == 4);
    }
}

#[test]
fn triangles_of_another_frame_are_refused() {
    for [one, other, again] in &frames() {
        let mesh = one.mesh().expect("memory");
        let (mut order, mut indices) = (Vec::new(), vec![7; mesh.triangles().indices().len()]);
        for triangles in [mesh.triangles(), &mesh.triangles_of(|_| true).expect("memory")] {
            let error = triangles.write_back_to_front(other, ABOVE, &mut order, &mut indices);
            let error = error.expect_err("another frame").to_string();
            assert!(error.contains("make the mesh of this tree"), "{error}");
            assert!(indices.iter().all(|&index| index == 7), "nothing is written");
            assert!(order.is_empty(), "{order:?}");
        }
        let copy = one.clone();
        let written = mesh.triangles().write_back_to_front(&copy, ABOVE, &mut order, &mut indices);
        assert_eq!(written, Ok(2 * 3 * CARDS));
        let mesh_again = again.mesh().expect("memory");
        assert_eq!(mesh_again.triangles(), mesh.triangles(), "whichever tree they are of");
        assert_ne!(mesh.triangles_of(|polygon| polygon > 0).as_ref(), Ok(mesh.triangles()));
    }
}

/// Earlier objects do not belong to the tree that is extended, read again or refilled.
#[test]
fn a_tree_that_changes_is_another_one() {
    let mut tree = BspTree::build(frame(false)).expect("within budget");
    let mut overlay = Overlay::new(&tree);
    let mut file = Vec::new();
    tree.write(&mut file).expect("a list takes all");
    let read = BspTree::read(&file[..]).expect("its own file");
    assert!(overlay.replace(&read, [square(2.5)]).is_err());
    // A file does not store its identity.
    let mut again = Vec::new();
    BspTree::build(frame(false)).expect("within budget").write(&mut again).expect("a list");
    assert_eq!(file, again);
    // If the extension fails, the tree stays the same tree.
    assert!(tree.extend([square(1e9)]).is_err());
    overlay.replace(&tree, [square(2.5)]).expect("unchanged");
    // A polygon without area adds no fragment.
    let before = tree.len();
    tree.extend([[[1.0; 3]; 3]]).expect("on the grid");
    assert_eq!(tree.len(), before);
    assert!(overlay.order(&tree, ABOVE).is_err());
    let mut builder = FrameBuilder::new(BuildOptions::DEFAULT);
    let overlay = Overlay::new(builder.build(frame(false)).expect("within budget"));
    assert!(overlay.order(builder.tree(), ABOVE).is_ok());
    let copy = builder.clone();
    assert!(overlay.order(builder.build(frame(false)).expect("built"), ABOVE).is_err());
    assert!(overlay.order(copy.tree(), ABOVE).is_ok());
    assert!(builder.build([[[f64::NAN; 3]; 3]]).is_err());
    assert!(overlay.order(builder.tree(), ABOVE).is_err());
}

fn camera() -> Camera {
    let (eye, target) = (DVec3::new(2.0, -3.0, 9.0), DVec3::new(2.0, 2.0, 2.0));
    Camera::perspective(eye, target, DVec3::Z, 0.9, [32, 24]).expect("a camera")
}

/// Rays are numbers on a grid. Trees with the same grid share rays; other trees would show another picture.
#[test]
fn rays_of_another_grid_are_refused() {
    let tree = BspTree::build(frame(false)).expect("within budget");
    let moved = frame(false).map(|square| square.map(|[x, y, z]| [x + 0.75, y, z]));
    let moved = BspTree::build(moved).expect("within budget");
    assert_ne!(tree.grid(), moved.grid());
    let (rays, faces) = (Rays::new(&camera(), tree.faces()).expect("near"), moved.faces());
    let own = Rays::new(&camera(), faces).expect("near");
    let truth = zbuffer(&own, faces);
    let image = truth.image();
    let piece = || raster::Piece { face: 0, outline: raster::Outline::Whole };
    let calls: [&dyn Fn(); 10] = [
        &|| ignore(zbuffer(&rays, faces)),
        &|| ignore(Painter::new(&rays, faces)),
        &|| ignore(compare(&rays, faces, image, image)),
        &|| ignore(picture(&rays, faces, image, raster::colour_of, [0; 3])),
        &|| raster::for_each_run(&rays, faces, piece(), |_, _| {}),
        &|| ignore(paint::paint_tree(&moved, ABOVE, &rays)),
        &|| ignore(paint::paint_order(&moved, &[0], &rays)),
        &|| ignore(paint::paint_tree_in_colour(&moved, ABOVE, &rays, |_| ([0; 3], 1.0), [0; 3])),
        &|| paint::for_each_painted(&moved, ABOVE, &rays, |_| ([0; 3], 1.0), |_, _, _| {}),
        &|| ignore(CoverageMask::new(&moved, &rays, 1)),
    ];
    for (k, call) in calls.into_iter().enumerate() {
        let message = panic_of(call);
        assert!(message.contains("Rays::new"), "{k}: {message}");
    }
    let mut mask = CoverageMask::new(&tree, &rays, 1);
    panic_of(|| ignore(mask.cover(&moved.fragment(0))));
    // Rays for some rows, and rays for fronts only, still have the same grid.
    panic_of(|| ignore(zbuffer(&rays.rows(3..9).with_front_faces_only(), faces)));
}

/// A fragment of another frame, or a piece of an overlay, covers its own pixels, not the pixels of a face
/// with the same number in the mask's tree.
#[test]
fn a_mask_covers_the_pixels_of_a_fragment_of_another_frame() {
    let build = |sizes: [f64; 2]| {
        let lower = |(size, z): (f64, f64)| square(z).map(|[x, y, z]| [x * size, y * size, z]);
        let options = BuildOptions::DEFAULT.with_bounds(DVec3::ZERO, DVec3::splat(4.0));
        options.build(sizes.into_iter().zip([0.0, 1.0]).map(lower)).expect("within budget")
    };
    let (tree, other) = (build([0.25, 0.25]), build([0.25, 1.0]));
    let (eye, target) = (DVec3::new(2.0, 2.0, 9.0), DVec3::new(2.0, 2.0, 0.0));
    let camera = Camera::perspective(eye, target, DVec3::Y, 0.1, [32, 24]).expect("a camera");
    let rays = Rays::new(&camera, tree.faces()).expect("near");
    let mut overlay = Overlay::new(&tree);
    overlay.replace(&tree, [square(2.0)]).expect("on the grid");
    let piece = overlay.piece(tree.len() as u32).expect("a piece");
    let large = other.fragments().find(|fragment| fragment.polygon() == 1).expect("a fragment");
    for fragment in [large, piece] {
        let mut mask = CoverageMask::new(&tree, &rays, 1);
        assert!(tree.fragments().all(|fragment| !mask.cover(&fragment)), "beside the picture");
        assert!(mask.cover(&fragment) && mask.is_full());
    }
}
