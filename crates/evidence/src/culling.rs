//! The fragments of a scene that remain after each step of culling.

use std::collections::BTreeSet;
use std::time::{Duration, Instant};

use binspace::glam::{DVec3, dvec3};
use binspace::occlusion::CoverageMask;
use binspace::paint::paint_order;
use binspace::raster::{Rays, compare, zbuffer};
use binspace::view::Camera;
use binspace::{BspTree, Culling, Error, Facing, Flow, Fragment, Part};

/// The result of a step.
#[derive(Clone, Debug)]
pub struct Step {
    /// The name of the polygons that this step leaves out.
    pub name: &'static str,
    /// The fragments that are left, back to front.
    pub left: Vec<u32>,
    /// The time for this step and the steps before it together.
    pub time: Duration,
}

/// Runs the steps of culling for a camera. They leave out nothing, polygons outside the view volume, back
/// faces, and hidden polygons; each step includes the steps before it.
///
/// Back faces may be left out only if all bodies are closed and seen from outside. Hidden polygons are found
/// on one front-to-back traversal, which skips subtrees that the other steps leave out.
pub fn steps(tree: &BspTree, camera: &Camera, rays: &Rays) -> Vec<Step> {
    // Boxes are made once, before the frames that are timed.
    tree.bounds();
    let viewpoint = camera.viewpoint();
    let in_view = Culling::NONE.with_frustum(camera.frustum());
    let fronts = in_view.clone().with_facing(Facing::Front);
    let step = |name, find: &dyn Fn(&mut Vec<u32>)| {
        let (mut left, begin) = (Vec::new(), Instant::now());
        find(&mut left);
        Step { name, left, time: begin.elapsed() }
    };
    vec![
        step("nothing", &|left| tree.back_to_front_into(viewpoint, left)),
        step("outside of the view volume", &|left| {
            tree.order(viewpoint).culled(&in_view).write_into(left);
        }),
        step("and seen from behind", &|left| {
            tree.order(viewpoint).culled(&fronts).write_into(left);
        }),
        step("and hidden", &|left| {
            let is_front = |fragment: &Fragment<'_>| fragment.facing(viewpoint) == Facing::Front;
            unhidden(tree, camera, rays, is_front, left);
        }),
    ]
}

/// The figures of a step.
#[derive(Clone, Debug)]
pub struct Left {
    /// The name of the polygons that this step leaves out.
    pub name: &'static str,
    /// The polygons that are left.
    pub polygons: usize,
    /// The time for this step and the steps before it together.
    pub time: Duration,
    /// The number of pixels drawn to paint the remaining polygons.
    pub drawn: u64,
    /// The number of wrong pixels of this picture.
    pub wrong: usize,
}

/// Measures the steps of culling. Each picture is compared with the exact picture of all polygons.
pub fn measure(tree: &BspTree, camera: &Camera, rays: &Rays) -> Vec<Left> {
    let truth = zbuffer(rays, tree.faces());
    let left = |Step { name, left, time }| {
        let painted = paint_order(tree, &left, rays);
        let wrong = compare(rays, tree.faces(), &painted, truth.image()).wrong();
        let polygons: BTreeSet<usize> =
            left.iter().map(|&fragment| tree.fragment(fragment).polygon()).collect();
        Left { name, polygons: polygons.len(), time, drawn: painted.drawn(), wrong }
    };
    steps(tree, camera, rays).into_iter().map(left).collect()
}

/// Creates a camera over a street crossing of the city, above the highest roof.
///
/// # Errors
///
/// No error is known.
pub fn over_the_city(size: [u32; 2]) -> Result<Camera, Error> {
    let eye = dvec3(2400.0, 2400.0, 130.0);
    Camera::perspective(eye, eye + dvec3(1.0, 0.8, -0.3), DVec3::Z, 1.0, size)
}

/// Sets `left` to the wanted fragments that are visible in at least one pixel, back to front. Returns the
/// number of subtrees that were entered to find them.
///
/// One front-to-back traversal finds them: it skips subtrees that are out of view or hidden by earlier
/// fragments. The mask alone would skip most subtrees out of view, but not all.
pub fn unhidden(
    tree: &BspTree,
    camera: &Camera,
    rays: &Rays,
    is_wanted: impl Fn(&Fragment<'_>) -> bool,
    left: &mut Vec<u32>,
) -> usize {
    left.clear();
    let mut entered = 0;
    let (viewpoint, frustum) = (camera.viewpoint(), camera.frustum());
    let mut mask = CoverageMask::new(tree, rays, 1);
    let _ = tree.order(viewpoint).front_to_back().walk(|part| {
        match part {
            Part::Subtree(node) => {
                let region = node.bounds();
                if !frustum.meets(region) || mask.hides(region) {
                    return Flow::Skip;
                }
                entered += 1;
            }
            Part::Fragment(fragment) if is_wanted(&fragment) => {
                if mask.cover(&fragment) {
                    left.push(fragment.index());
                }
            }
            Part::Fragment(_) => {}
        }
        if mask.is_full() { Flow::Break(()) } else { Flow::Descend }
    });
    left.reverse();
    entered
}

#[cfg(test)]
mod tests {
    use super::*;
    use binspace::internals::SplitMix64;
    use binspace::raster::NONE;
    use binspace::scene;

    /// Compares every step with the exact picture of all polygons, and the last step with the set of visible
    /// fragments.
    fn check(tree: &BspTree, camera: &Camera) -> Vec<usize> {
        let rays = Rays::new(camera, tree.faces()).unwrap();
        let truth = zbuffer(&rays, tree.faces());
        let steps = steps(tree, camera, &rays);
        for step in &steps {
            let picture = paint_order(tree, &step.left, &rays);
            let found = compare(&rays, tree.faces(), &picture, truth.image());
            assert_eq!((found.wrong(), found.contested), (0, 0), "{}", step.name);
        }
        let all = |step: &Step| step.left.iter().copied().collect::<BTreeSet<u32>>();
        assert!(steps.windows(2).all(|pair| all(&pair[1]).is_subset(&all(&pair[0]))));
        let polygons = |left: &[u32]| -> BTreeSet<usize> {
            left.iter().map(|&fragment| tree.fragment(fragment).polygon()).collect()
        };
        let shown = truth.image().faces().iter().filter(|&&face| face != NONE);
        let owners: BTreeSet<usize> = shown.map(|&face| tree.faces().polygon(face)).collect();
        assert_eq!(polygons(&steps[3].left), owners);
        steps.iter().map(|step| polygons(&step.left).len()).collect()
    }

    #[test]
    fn pictures_do_not_change_and_remaining_polygons_own_a_pixel() {
        let tree = BspTree::build(scene::city(3000, 1).polygons()).unwrap();
        let mut random = SplitMix64::new(3);
        let mut sums = [0; 4];
        for _ in 0..12 {
            // Eyes are over the streets or just above the roofs, never in a house.
            let street = dvec3(
                1.0 + random.range(0.0, 23.0).floor(),
                1.0 + random.range(0.0, 23.0).floor(),
                0.0,
            );
            let eye = street * 30.0 + DVec3::Z * random.range(2.0, 200.0);
            let target = eye + random.point(-1.0, 1.0) * dvec3(1.0, 1.0, 0.3);
            let camera = Camera::perspective(eye, target, DVec3::Z, 1.0, [80, 60]).unwrap();
            let counts = check(&tree, &camera);
            sums.iter_mut().zip(counts).for_each(|(sum, count)| *sum += count);
        }
        assert!(sums.windows(2).all(|pair| pair[1] < pair[0]), "{sums:?}");
        assert!(sums[3] * 20 < sums[0], "{sums:?}");
    }

    /// The number of subtrees entered if only the mask detects subtrees out of view, and the remaining
    /// fragments.
    fn entered_by_the_mask_alone(
        tree: &BspTree,
        camera: &Camera,
        rays: &Rays,
    ) -> (usize, Vec<u32>) {
        let mut mask = CoverageMask::new(tree, rays, 1);
        let (mut entered, mut left) = (0, Vec::new());
        let _ = tree.order(camera.viewpoint()).front_to_back().walk(|part| {
            match part {
                Part::Subtree(node) if mask.hides(node.bounds()) => return Flow::Skip,
                Part::Subtree(_) => entered += 1,
                Part::Fragment(fragment) if mask.cover(&fragment) => left.push(fragment.index()),
                Part::Fragment(_) => {}
            }
            if mask.is_full() { Flow::Break(()) } else { Flow::Descend }
        });
        left.reverse();
        (entered, left)
    }

    #[test]
    fn subtrees_out_of_view_are_not_entered() {
        let tree = BspTree::build(scene::city(3000, 1).polygons()).unwrap();
        let mut random = SplitMix64::new(4);
        let (mut entered, mut by_mask, mut left) = (0, 0, Vec::new());
        for _ in 0..12 {
            let eye = dvec3(360.0, 360.0, random.range(2.0, 200.0));
            let target = eye + random.point(-1.0, 1.0) * dvec3(1.0, 1.0, 0.3);
            let camera = Camera::perspective(eye, target, DVec3::Z, 1.0, [80, 60]).unwrap();
            let rays = Rays::new(&camera, tree.faces()).unwrap();
            entered += unhidden(&tree, &camera, &rays, |_| true, &mut left);
            let (others, same) = entered_by_the_mask_alone(&tree, &camera, &rays);
            assert_eq!(left, same);
            by_mask += others;
        }
        // Only 7 of 2450 more: most subtrees out of view cover no pixel of the mask, so the mask skips them.
        assert!(entered + 5 <= by_mask && entered > 1000, "{entered} of {by_mask}");
    }

    #[test]
    #[ignore = "2.6 million polygons: some seconds in release, and 2 GB"]
    fn a_scene_of_2_600_000_polygons() {
        let scene = scene::city(2_600_000, 1);
        let tree = BspTree::build(scene.polygons()).unwrap();
        let eye = dvec3(3000.0, 3000.0, 40.0);
        let target = eye + dvec3(1.0, 0.7, -0.05);
        let camera = Camera::perspective(eye, target, DVec3::Z, 1.0, [320, 240]).unwrap();
        let counts = check(&tree, &camera);
        assert!(counts[0] > 2_590_000 && counts[3] < 5_000, "{counts:?}");
    }
}
