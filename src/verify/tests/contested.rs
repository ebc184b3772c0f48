//! The pixels that a tree's planes excuse, compared with exact rays and the ranges of the tree's nodes.

use std::cmp::Ordering;

use crate::exact::{EdgeLine, PlaneId};
use crate::paint::paint_list;
use crate::random::SplitMix64;
use crate::raster::tests::oracle::{Height, height, meets, meets_piece};
use crate::raster::{Painter, Rays, Verdict, compare_by, zbuffer};
use crate::tree::BspTree;
use crate::verify::{PaintedRuns, compare_by_planes};
use crate::view::Camera;
use crate::{BuildOptions, Heuristic};
use glam::DVec3;

/// The allowed addition to the tolerance for rounded corners, in lattice units.
const ROUNDED_CORNERS: f64 = 4.0;

/// The plane between two fragments, and the side of each fragment. The plane and the sides are found from the
/// ranges of all nodes.
fn parting(tree: &BspTree, a: u32, b: u32) -> Option<(PlaneId, [Ordering; 2])> {
    let mut parting = tree.nodes().filter_map(|node| {
        let side = |f: u32| {
            let sides = [
                (node.behind(), Ordering::Less),
                (node.on(), Ordering::Equal),
                (node.in_front(), Ordering::Greater),
            ];
            sides.into_iter().find(|(range, _)| range.contains(&f)).map(|(_, side)| side)
        };
        let (a, b) = (side(a)?, side(b)?);
        (a != b || a.is_eq()).then(|| (node.plane(), [a, b]))
    });
    let first = parting.next();
    assert!(parting.next().is_none(), "{a} and {b} are parted twice");
    first
}

/// The rule of the tolerance, exactly. A ray meets the nearer of two fragments within the tolerance of the
/// plane between them. The ray also meets the other fragment, or starts, within the tolerance of that plane.
/// And the ray meets one of the two fragments on the wrong side of that plane, or off that plane.
fn is_excused(tree: &BspTree, rays: &Rays, [near, far]: [u32; 2], pixel: [u32; 2]) -> bool {
    let faces = tree.faces();
    let [near_face, far_face] = [near, far].map(|id| tree.fragment(id).face());
    let [x, y] = pixel;
    let depth = |face| meets(rays, faces, face, x, y).expect("a face that is met");
    assert!(depth(near_face) < depth(far_face), "{near} does not hide {far} in {pixel:?}");
    let reach = faces.tolerance() + ROUNDED_CORNERS;
    parting(tree, near, far).is_some_and(|(plane, sides)| {
        let height = |face| height(rays, faces, (face, pixel), plane);
        let heights = [near_face, far_face].map(|face| height(Some(face)).unwrap());
        let is_beyond = |(height, side): (&Height, Ordering)| height.sign == side.reverse();
        let is_off = |(height, side): (&Height, Ordering)| side.is_eq() && height.sign.is_ne();
        let pieces = || heights.iter().zip(sides);
        let [near, far] = heights.each_ref().map(|height| height.is_within(reach));
        let begins = height(None).is_some_and(|height| height.is_within(reach));
        near && (far || begins) && (pieces().any(is_beyond) || pieces().any(is_off))
    })
}

/// The fragment of a face that the ray of a pixel meets.
fn fragment_of(tree: &BspTree, rays: &Rays, face: u32, pixel: [u32; 2]) -> u32 {
    let mut met = tree.fragments().filter(|fragment| {
        let lines: Vec<EdgeLine> = fragment.lines().collect();
        fragment.face() == face && meets_piece(rays, tree.faces(), face, &lines, pixel)
    });
    let first = met.next().expect("a fragment that is met").index();
    assert!(met.next().is_none(), "two fragments of face {face} are met in {pixel:?}");
    first
}

/// Compares the verdict on every pixel of an order with the rule, and counts excused and other pixels.
fn check(tree: &BspTree, camera: &Camera, order: &[u32], counts: &mut [usize; 2]) {
    let faces = tree.faces();
    let rays = Rays::new(camera, faces).unwrap();
    let painted = paint_list(Painter::new(&rays, tree.faces()), tree, order, None);
    let truth = zbuffer(&rays, faces).into_image();
    let strict = compare_by(&rays, faces, [&painted, &truth], 0.0, |_, _| false);
    let by_planes = compare_by_planes(tree, &rays, &painted, &truth);
    let verdicts = strict.verdicts.iter().zip(&by_planes.verdicts).enumerate();
    let mut excused = 0;
    for (i, (before, after)) in verdicts {
        if *before != Verdict::WrongOrder {
            assert_eq!(before, after);
            continue;
        }
        let width = rays.size()[0] as usize;
        let pixel = [(i % width) as u32, (i / width) as u32];
        let met = [truth.faces()[i], painted.faces()[i]];
        let met = met.map(|face| fragment_of(tree, &rays, face, pixel));
        let is_excused = is_excused(tree, &rays, met, pixel);
        assert_eq!(*after == Verdict::Contested, is_excused, "{pixel:?} from {camera:?}");
        excused += usize::from(is_excused);
        counts[usize::from(!is_excused)] += 1;
    }
    assert_eq!(by_planes.contested, strict.contested + excused);
    assert_eq!(by_planes.wrong_order, strict.wrong_order - excused);
}

/// A floor at the side, and around it walls and slopes that reach across its plane by less than the
/// tolerance, from above or from below.
fn walls(random: &mut SplitMix64, tolerance: f64) -> Vec<[DVec3; 4]> {
    let floor = [(3.0, 5.0), (4.0, 5.0), (4.0, 6.0), (3.0, 6.0)];
    let mut polygons = vec![floor.map(|(x, y)| DVec3::new(x, y, 0.0))];
    for _ in 0..8 {
        let across = tolerance * random.range(-0.2, 0.99);
        let (low, high) = [(-across, 1.0), (-1.0, across)][(random.next() % 2) as usize];
        let (near, lean) = (random.range(0.5, 3.0), random.range(-0.3, 0.3));
        let end = |y: f64, z: f64| DVec3::new(near + lean * z, y * 0.9, z);
        polygons.push([end(-1.0, low), end(1.0, low), end(1.0, high), end(-1.0, high)]);
    }
    polygons
}

#[test]
fn exact_rays_confirm_the_pixels_that_planes_excuse() {
    let mut random = SplitMix64::new(1);
    let mut counts = [0, 0];
    let first = BuildOptions::DEFAULT.with_heuristic(Heuristic::First);
    for round in 0..36 {
        let tolerance = [1e-2, 1e-3, 1e-5][round % 3];
        let tree =
            first.clone().with_tolerance(tolerance).build(walls(&mut random, tolerance)).unwrap();
        let eye = DVec3::new(-1.0, 0.0, tolerance * random.range(-2.0, 2.0));
        let target = DVec3::new(1.0, 0.0, tolerance * random.range(-2.0, 2.0));
        let size = [6, 40];
        // Along rays that hardly rise, the tolerance ends between two walls.
        let level = DVec3::new(1.0, 0.0, tolerance * random.range(-0.1, 0.1));
        let cameras = [
            Camera::perspective(eye, target, DVec3::Z, 3.0 * tolerance, size),
            Camera::parallel(target - eye, DVec3::Z, target, 6.0 * tolerance, size),
            Camera::parallel(level, DVec3::Z, target, 6.0 * tolerance, size),
        ];
        for camera in cameras {
            let camera = camera.unwrap();
            let (mut order, mut right) = (Vec::new(), [0, 0]);
            tree.back_to_front_into(camera.viewpoint(), &mut order);
            check(&tree, &camera, &order, &mut right);
            assert_eq!(right[1], 0, "pixels that are not excused are wrong");
            counts[0] += right[0];
            // A completely wrong order: the same places are excused.
            order.reverse();
            check(&tree, &camera, &order, &mut counts);
        }
    }
    assert!(counts[0] > 300 && counts[1] > 300, "{counts:?} pixels excused and not");
}

/// Walls that cut a floor into strips. Every pixel of the floor is looked up, twice.
#[test]
fn fragments_are_painted_once_however_many_pixels_are_contested() {
    let mut met = 0;
    for walls in [10, 20, 40_u32] {
        let wall = |k: u32| {
            let x = f64::from(k) + 0.5;
            [[x, -9.0, 0.0], [x, -8.0, 0.0], [x, -8.0, 1.0], [x, -9.0, 1.0]]
        };
        let far = f64::from(walls);
        let floor = [[0.0, 0.0, 0.0], [far, 0.3, 0.0], [far, 9.0, 0.0], [0.0, 9.0, 0.0]];
        let polygons = (0..walls).map(wall).chain([floor]);
        let first = BuildOptions::DEFAULT.with_heuristic(Heuristic::First);
        let tree = first.build(polygons).unwrap();
        let is_floor = |fragment: &crate::Fragment<'_>| fragment.polygon() == walls as usize;
        let strips: Vec<_> = tree.fragments().filter(is_floor).collect();
        assert_eq!(strips.len(), walls as usize + 1);
        let middle = DVec3::new(0.5 * far, 4.0, 0.0);
        let size = [24, 16];
        let camera = Camera::parallel(-DVec3::Z, DVec3::Y, middle, 12.0, size).unwrap();
        let rays = Rays::new(&camera, tree.faces()).unwrap();
        let mut runs = PaintedRuns::new(&tree, &rays);
        let face = strips[0].face();
        for pixel in (0..2 * size[0] * size[1]).map(|i| [i % size[0], i / size[0] % size[1]]) {
            let expected = meets(&rays, tree.faces(), face, pixel[0], pixel[1])
                .map(|_| fragment_of(&tree, &rays, face, pixel));
            assert_eq!(runs.fragment_at(face, pixel), expected, "{pixel:?}");
            met += usize::from(expected.is_some());
        }
        assert_eq!(runs.painted, strips.len());
    }
    assert!(met > 1000, "{met}");
}
