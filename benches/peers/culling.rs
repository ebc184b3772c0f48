//! Orders of the fragments in view, against whole orders: a level of rooms with about one in a hundred of its
//! polygons in view.

use binspace::glam::DVec3;
use binspace::raster::Rays;
use binspace::view::Camera;
use binspace::{BspTree, Culling, Facing, Frustum};
use binspace_evidence::culling::unhidden;
use binspace_evidence::interior::{HEIGHT, ROOM, rooms};
use std::time::{Duration, Instant};
use support::{Table, ratio, time};

/// The rooms on a side of each level.
const SIDES: [usize; 3] = [40, 100, 200];

/// Eyes of a level.
const EYES: usize = 8;

pub(crate) fn run() {
    let table = Table::new(
        "Fragments in view",
        &[
            "rooms",
            "polygons",
            "fragments",
            "share in view",
            "order",
            "in view",
            "in view ÷ order",
            "fronts in view",
        ],
    );
    let mut steps = Vec::new();
    for side in SIDES {
        let level = rooms(side);
        let tree = BspTree::build(&level).expect("memory");
        let (mut share, mut times) = (0.0, [Duration::ZERO; 3]);
        for k in 0..EYES {
            let camera = camera(side, k);
            if k == 0 {
                steps.push(left_by_steps(&tree, &camera, side));
            }
            let (kept, measured) = measure(&tree, &camera);
            share += kept as f64 / tree.len() as f64 / EYES as f64;
            times.iter_mut().zip(measured).for_each(|(sum, time)| *sum += time / EYES as u32);
        }
        table.row(&[
            (side * side).to_string(),
            level.len().to_string(),
            tree.len().to_string(),
            format!("{:.2} %", 100.0 * share),
            time(times[0]),
            time(times[1]),
            ratio(times[1], times[0]),
            time(times[2]),
        ]);
    }
    let table = Table::new(
        "Steps of culling",
        &[
            "rooms",
            "all",
            "in view",
            "time in view",
            "fronts",
            "time of fronts",
            "not hidden",
            "time of not hidden",
        ],
    );
    steps.iter().for_each(|row| table.row(row));
}

/// The size of the picture, in pixels.
const PICTURE: [u32; 2] = [320, 180];

/// The numbers of fragments that are in view, that also show their front, and that are visible in a pixel,
/// each with the time to find them.
fn left_by_steps(tree: &BspTree, camera: &Camera, side: usize) -> [String; 8] {
    let (viewpoint, frustum) = (camera.viewpoint(), camera.frustum());
    let culling = Culling::NONE.with_frustum(frustum.clone());
    let fronts = culling.clone().with_facing(Facing::Front);
    let mut lists = [vec![], vec![]];
    let mut times = [Duration::MAX; 3];
    for _ in 0..5 {
        for ((list, culling), shortest) in lists.iter_mut().zip([&culling, &fronts]).zip(&mut times)
        {
            let begin = Instant::now();
            tree.order(viewpoint).culled(culling).write_into(list);
            *shortest = begin.elapsed().min(*shortest);
        }
    }
    let begin = Instant::now();
    let rays = Rays::new(camera, tree.faces()).expect("a picture");
    let mut seen = Vec::new();
    unhidden(tree, camera, &rays, |_| true, &mut seen);
    times[2] = begin.elapsed();
    let [in_view, of_fronts] = lists.map(|list| list.len());
    let seen = seen.len();
    assert!(seen <= in_view && of_fronts <= in_view && seen > 0);
    [
        (side * side).to_string(),
        tree.len().to_string(),
        in_view.to_string(),
        time(times[0]),
        of_fronts.to_string(),
        time(times[1]),
        seen.to_string(),
        time(times[2]),
    ]
}

/// A camera in a room. The angle of view is chosen so that about a hundredth of the level is in view.
fn camera(side: usize, k: usize) -> Camera {
    let turn = k as f64 / EYES as f64 * std::f64::consts::TAU;
    let middle = DVec3::new(0.5, 0.5, 0.0) * (side as f64 * ROOM) + DVec3::Z * (0.55 * HEIGHT);
    let eye = middle + DVec3::new(turn.cos(), turn.sin(), 0.0) * (0.2 * side as f64 * ROOM);
    // Looks outwards: the boundary is 0.3 sides away, and a wedge of 0.115 radians is about a hundredth of
    // the square.
    let target = eye + (eye - middle).with_z(0.0);
    Camera::perspective(eye, target, DVec3::Z, 0.065, PICTURE).expect("a camera")
}

/// The number of fragments in view; the shortest times of the whole order, of the order of fragments in view,
/// and of the order of fragments in view without back faces.
fn measure(tree: &BspTree, camera: &Camera) -> (usize, [Duration; 3]) {
    let (viewpoint, frustum) = (camera.viewpoint(), camera.frustum());
    let culling = Culling::NONE.with_frustum(frustum.clone());
    let fronts = culling.clone().with_facing(Facing::Front);
    let (mut order, mut seen, mut shown) = (Vec::new(), Vec::new(), Vec::new());
    let mut shortest = [Duration::MAX; 3];
    for _ in 0..(5_000_000 / tree.len()).clamp(7, 60) {
        let mut take = |place: usize, work: &mut dyn FnMut()| {
            let begin = Instant::now();
            work();
            shortest[place] = shortest[place].min(begin.elapsed());
        };
        take(0, &mut || tree.back_to_front_into(viewpoint, &mut order));
        take(1, &mut || tree.order(viewpoint).culled(&culling).write_into(&mut seen));
        take(2, &mut || tree.order(viewpoint).culled(&fronts).write_into(&mut shown));
    }
    check(tree, &frustum, &order, &seen);
    let is_front = |&fragment: &u32| tree.fragment(fragment).facing(viewpoint) == Facing::Front;
    assert!(seen.iter().copied().filter(is_front).eq(shown));
    (seen.len(), shortest)
}

/// Checks that the list is the whole order without the fragments whose vertices are all outside one plane. A
/// fragment so near to a plane that rounding decides may be in the list.
fn check(tree: &BspTree, frustum: &Frustum, order: &[u32], seen: &[u32]) {
    let [low, high] = tree.bounds().expect("a level");
    let margin = 1e-6 * (high - low).max_element();
    let mut seen = seen.iter().peekable();
    for &fragment in order {
        // The polygons are perpendicular to axes, so the box of a polygon is outside if the polygon is.
        let vertices: Vec<DVec3> = tree.fragment(fragment).vertices().collect();
        let (low, high) = vertices
            .iter()
            .fold((DVec3::MAX, DVec3::MIN), |(low, high), &p| (low.min(p), high.max(p)));
        let furthest = frustum.planes().iter().map(|(normal, offset)| {
            let far = DVec3::select(normal.cmpgt(DVec3::ZERO), high, low);
            (normal.dot(far) - offset) / normal.length()
        });
        let furthest = furthest.fold(f64::INFINITY, f64::min);
        let is_seen = seen.next_if(|&&other| other == fragment).is_some();
        assert!(
            is_seen == (furthest >= 0.0) || is_seen && furthest > -margin,
            "{fragment}: {furthest:e}"
        );
    }
    assert_eq!(seen.next(), None);
}
