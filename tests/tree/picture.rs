//! Compares the painter's picture of a hard scene with the picture of a depth buffer, which uses no tree.

use binspace::paint::paint_tree;
use binspace::raster::{Image, Verdict, zbuffer};
use binspace::verify::{Verification, verify};
use binspace::view::views;
use proptest::prelude::*;
use proptest::test_runner::TestCaseError;
use testkit::hard::{HardScene, Tolerance};
use testkit::prelude::*;
use testkit::rays::Rays;
use testkit::views::some_view;

const SIZE: [u32; 2] = [40, 30];

/// Cameras around the scene and inside it.
fn cameras(scene: &HardScene, count: usize, seed: u64) -> Vec<Camera> {
    let bounds = scene.bounds().expect("a corner");
    views(bounds, DVec3::Z, count, SIZE, seed).unwrap_or_default()
}

/// A camera that looks at a fragment, with its eye in a plane or at a corner.
fn awkward_camera(tree: &BspTree, dice: &mut Dice) -> Option<Camera> {
    let rays = Rays::new(tree);
    let view = some_view(tree.faces(), &rays, dice);
    let target = tree.faces().lattice().to_world(rays.some_point(dice).to_array());
    let up = DVec3::new(0.1, 0.2, 1.0);
    match view.viewpoint {
        binspace::Viewpoint::Eye(eye) => Camera::perspective(eye, target, up, 1.2, SIZE).ok(),
        binspace::Viewpoint::Direction(direction) => {
            let height = hard::extent(&[tree.fragment(0).vertices().collect()]);
            Camera::parallel(direction, up, target, height, SIZE).ok()
        }
    }
}

fn check(tree: &BspTree, camera: &Camera) -> Result<Option<Verification>, TestCaseError> {
    // A scene may be so small that its grid is too coarse for a camera.
    let Ok(result) = verify(tree, camera) else { return Ok(None) };
    let [holes, spills] = [result.comparison.holes, result.comparison.spills];
    let wrong = (result.comparison.wrong_order, holes, spills);
    prop_assert_eq!(wrong, (0, 0, 0), "wrong order, holes, spills from {:?}", camera);
    prop_assert_eq!(result.miscounted, 0, "painted more than once or never from {:?}", camera);
    prop_assert!(result.is_right(), "{:?} from {:?}", result.orders, camera);
    Ok(Some(result))
}

/// The counts of compared pictures and pixels.
#[derive(Default)]
struct Compared {
    pictures: usize,
    pixels: usize,
    contested: usize,
}

impl Compared {
    fn add(&mut self, result: Option<&Verification>) {
        let Some(result) = result else { return };
        let covered = |verdict: &&Verdict| **verdict != Verdict::Empty;
        self.pictures += 1;
        self.pixels += result.comparison.verdicts.iter().filter(covered).count();
        let contested = |verdict: &&Verdict| **verdict == Verdict::Contested;
        self.contested += result.comparison.verdicts.iter().filter(contested).count();
    }

    /// Asserts at least this many pictures. At least a tenth of their pixels must be neither empty nor
    /// contested.
    fn assert_floor(&self, pictures: usize) {
        let clear = self.pixels - self.contested;
        let least = pictures * (SIZE[0] * SIZE[1]) as usize / 10;
        let Self { pictures: found, contested, .. } = self;
        let text = format!("{found} pictures, {clear} pixels, and {contested} contested");
        assert!(*found >= pictures && clear >= least, "{text}");
    }
}

#[test]
fn the_painter_agrees_with_the_depth_buffer() {
    let cases = (hard::scene(), hard::heuristic(), any::<u64>(), any::<bool>());
    let compared: Compared = tally(file!(), 96, cases, |compared: &mut Compared, case| {
        let (scene, by, seed, exactly) = case;
        let tolerance = if exactly { Tolerance::Share(0.0) } else { Tolerance::Default };
        let scene = scene.with_tolerance(tolerance);
        let tree = scene.build(by).map_err(fail)?;
        for camera in cameras(&scene, 4, seed) {
            compared.add(check(&tree, &camera)?.as_ref());
        }
        Ok(())
    });
    compared.assert_floor(250);
}

#[test]
fn the_painter_is_right_from_eyes_in_planes_and_corners() {
    let cases = (hard::scene(), hard::heuristic(), any::<u64>());
    let compared: Compared = tally(file!(), 96, cases, |compared: &mut Compared, case| {
        let (scene, by, seed) = case;
        let tree = scene.with_tolerance(Tolerance::Share(0.0)).build(by).map_err(fail)?;
        let mut dice = Dice(seed);
        for _ in 0..if tree.is_empty() { 0 } else { 4 } {
            if let Some(camera) = awkward_camera(&tree, &mut dice) {
                compared.add(check(&tree, &camera)?.as_ref());
            }
        }
        Ok(())
    });
    compared.assert_floor(150);
}

/// The eye and the ray lie in the plane of the last polygon. This plane cuts the nearest polygon, and another
/// polygon touches the plane there. In an earlier version, these two polygons were put on different sides of
/// the plane.
#[test]
fn the_painter_is_right_along_a_partition_plane() {
    let points = |corners: &[[f64; 3]]| -> Vec<DVec3> {
        corners.iter().map(|&corner| DVec3::from_array(corner)).collect()
    };
    let polygons = [
        points(&[[0., 0., 1.], [0., 0., 0.], [0., 2., 0.]]),
        points(&[[3., 0., 2.999997], [-2., -1., 0.], [2., 0., -1.], [0., 2., 3.], [0., 0., 3.]]),
        points(&[
            [0., 4., 3.],
            [0., 0., -2.],
            [0., -0.059, 1.],
            [0., 4., 3.],
            [3., 0., 0.],
            [0., 1., 1.],
            [0., -1., 0.],
        ]),
        points(&[[0., 0., 0.], [-5., 5., 2.], [3., 0., 0.]]),
    ];
    let eye = DVec3::new(-4.0, 0.0, 0.0);
    let camera = Camera::perspective_by_slope(eye, DVec3::ZERO, DVec3::Y, 0.5, [1, 1]).unwrap();
    for seed in 0..100 {
        let tree = BuildOptions::default()
            .with_heuristic(Heuristic::Random { seed })
            .build(&polygons)
            .unwrap();
        check(&tree, &camera).unwrap();
        let rays = binspace::raster::Rays::new(&camera, tree.faces()).unwrap();
        let painted = paint_tree(&tree, camera.viewpoint(), &rays);
        let polygon = |image: &Image| tree.faces().polygon(image.faces()[0]);
        assert_eq!(polygon(&painted), polygon(zbuffer(&rays, tree.faces()).image()), "{seed}");
    }
}

/// Without ties, the input order does not matter.
#[test]
fn shuffled_polygons_give_the_same_picture() {
    let shuffled = hard::scene().prop_flat_map(|scene| {
        let indices: Vec<usize> = (0..scene.polygons.len()).collect();
        (Just(scene), Just(indices).prop_shuffle())
    });
    let cases = (shuffled, hard::heuristic(), any::<u64>());
    let same = tally(file!(), 96, cases, |same: &mut usize, ((scene, shuffle), by, seed)| {
        let scene = scene.with_tolerance(Tolerance::Share(0.0));
        let mut other = scene.clone();
        other.polygons = shuffle.iter().map(|&i| scene.polygons[i].clone()).collect();
        let trees = (scene.build(by).map_err(fail)?, other.build(by).map_err(fail)?);
        for camera in cameras(&scene, 2, seed) {
            let (Some(a), Some(b)) = (check(&trees.0, &camera)?, check(&trees.1, &camera)?) else {
                continue;
            };
            let pixels = a.comparison.verdicts.iter().zip(&b.comparison.verdicts);
            let faces = a.painted.faces().iter().zip(b.painted.faces());
            for ((p, q), (&f, &g)) in pixels.zip(faces) {
                let tied = [p, q].contains(&&Verdict::Contested);
                prop_assert!(tied || (p == &Verdict::Empty) == (q == &Verdict::Empty));
                if p == &Verdict::Right && q == &Verdict::Right {
                    let (f, g) = (trees.0.faces().polygon(f), trees.1.faces().polygon(g));
                    let is_same = f == shuffle[g];
                    *same += usize::from(is_same);
                    prop_assert!(is_same || is_tie(&scene, f, shuffle[g]));
                }
            }
        }
        Ok(())
    });
    enough!(same > 10_000; "{same} pixels show the same polygon");
}

/// Whether two polygons may be equally far in a pixel: they have a common point, up to rounding.
fn is_tie(scene: &HardScene, a: usize, b: usize) -> bool {
    let bounds = |k: usize| hard::bounds(std::slice::from_ref(&scene.polygons[k]));
    let (Some([a_min, a_max]), Some([b_min, b_max])) = (bounds(a), bounds(b)) else { return false };
    a_min.cmple(b_max).all() && b_min.cmple(a_max).all()
}
