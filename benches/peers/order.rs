//! An order of a frame from the tree, against the sort of an engine: by one depth for each polygon, with
//! `radsort`. The time of the sort includes the depths, from centroids that are computed once. Both orders
//! are painted from one camera and compared with the exact depth buffer.

use binspace::glam::{DVec3, Vec3};
use binspace::paint::paint_tree;
use binspace::raster::{Rays, compare, zbuffer};
use binspace::scene::Scene;
use binspace::view::Camera;
use binspace::{BspTree, Viewpoint};
use binspace_evidence::method::{Centroid, Method as _};
use std::time::{Duration, Instant};
use support::{Table, check, ratio, scene, time, up, viewpoints};

const SCENES: [&str; 15] = [
    "random:700",
    "city:10000",
    "sphere:10000",
    "terrain:10000",
    "city:100000",
    "sphere:100000",
    "terrain:100000",
    "bunny.obj",
    "spider.obj",
    "person.obj",
    "dragon.obj",
    "dragon_large.obj",
    "engine.obj",
    "level.obj",
    "level_large.obj",
];
const SIZE: [u32; 2] = [640, 480];

pub(crate) fn run() {
    let table = Table::new(
        "Order of a frame",
        &[
            "scene",
            "polygons",
            "fragments",
            "order",
            "ns a fragment",
            "sort",
            "sort ÷ order",
            "pixels",
            "wrong",
            "wrong by sort",
        ],
    );
    for name in SCENES {
        let scene = scene(name);
        let tree = BspTree::build(scene.polygons()).expect("within budget");
        check(&tree, &scene);
        let viewpoints = viewpoints(&scene);
        let (mut ordering, mut sorting) = (Duration::ZERO, Duration::ZERO);
        for &viewpoint in &viewpoints {
            let (order, sort) = times(&tree, &scene, viewpoint);
            ordering += order / viewpoints.len() as u32;
            sorting += sort / viewpoints.len() as u32;
        }
        let [pixels, wrong, wrong_by_sort] = wrong_pixels(&tree, &scene, name);
        assert_eq!(wrong, 0, "{name}");
        table.row(&[
            name.to_owned(),
            scene.len().to_string(),
            tree.len().to_string(),
            time(ordering),
            format!("{:.1}", ordering.as_secs_f64() * 1e9 / tree.len() as f64),
            time(sorting),
            ratio(sorting, ordering),
            pixels.to_string(),
            wrong.to_string(),
            format!("{:.1} %", 100.0 * wrong_by_sort as f64 / pixels as f64),
        ]);
    }
}

/// The shortest times of an order and of a sort, taken in turns.
fn times(tree: &BspTree, scene: &Scene, viewpoint: Viewpoint) -> (Duration, Duration) {
    let Viewpoint::Eye(eye) = viewpoint else { unreachable!("only eyes are measured") };
    let eye = eye.as_vec3();
    let centroid =
        |points: &[DVec3]| (points.iter().sum::<DVec3>() / points.len() as f64).as_vec3();
    let centroids: Vec<Vec3> = scene.polygons().map(|corners| centroid(corners.points())).collect();
    let (mut order, mut keys) = (Vec::new(), Vec::with_capacity(centroids.len()));
    tree.back_to_front_into(viewpoint, &mut order);
    let (buffer, capacity) = (order.as_ptr(), order.capacity());

    let (mut ordering, mut sorting) = (Duration::MAX, Duration::MAX);
    let rounds = (5_000_000 / tree.len()).clamp(5, 100);
    for _ in 0..rounds {
        let begin = Instant::now();
        tree.back_to_front_into(viewpoint, &mut order);
        ordering = ordering.min(begin.elapsed());

        let begin = Instant::now();
        keys.clear();
        keys.extend(centroids.iter().map(|point| -point.distance_squared(eye)).zip(0_u32..));
        radsort::sort_by_key(&mut keys, |key| key.0);
        sorting = sorting.min(begin.elapsed());
    }

    assert!(keys.is_sorted_by_key(|key| key.0));
    assert_eq!((order.as_ptr(), order.capacity()), (buffer, capacity), "the buffer is kept");
    assert!(
        tree.back_to_front(viewpoint).map(|fragment| fragment.index()).eq(order.iter().copied())
    );
    order.sort_unstable();
    assert!(order.into_iter().eq(0..tree.len() as u32));
    (ordering, sorting)
}

/// The number of pixels that show a polygon, the number of wrong pixels by the tree, and the number of wrong
/// pixels by the sort.
fn wrong_pixels(tree: &BspTree, scene: &Scene, name: &str) -> [usize; 3] {
    let (low, high) = scene.bounds().expect("polygons");
    let camera = Camera::looking_at_all([low, high], up(name), SIZE).expect("a camera");
    let faces = tree.faces();
    let rays = Rays::new(&camera, faces).expect("a picture");
    let truth = zbuffer(&rays, faces);
    let painted = paint_tree(tree, camera.viewpoint(), &rays);
    let mut sorted = Centroid.prepare(faces).expect("memory");
    let sorted = sorted.paint(&camera, &rays).expect("memory").image;
    let wrong = [painted, sorted].map(|image| compare(&rays, faces, &image, truth.image()).wrong());
    let shown = truth.image().faces().iter().filter(|&&face| face != u32::MAX).count();
    [shown, wrong[0], wrong[1]]
}
