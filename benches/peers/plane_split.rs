//! Building and ordering by `plane-split`, which gets triangles and quads one after the other. Both libraries
//! run on one thread and build the same number of times.

use binspace::scene::Scene;
use binspace::{BspTree, Viewpoint};
use euclid::default::Point3D;
use plane_split::BspSplitter;
use std::thread;
use support::{Table, best, check, ratio, scene, threads, time};

const NAMES: [&str; 3] = ["random", "city", "sphere"];
const COUNTS: [u32; 3] = [100, 1000, 10_000];
const DIRECTION: [f64; 3] = [0.3, 0.5, -0.8];

/// The stack for `plane-split`. Its recursion is as deep as its tree, which is a list for a sphere.
const THEIR_STACK: usize = 4 << 30;

pub(crate) fn run() {
    let table = Table::new(
        "Build against plane-split",
        &[
            "scene",
            "our build",
            "its build",
            "its build ÷ ours",
            "our order",
            "its order",
            "our pieces",
            "its pieces",
            "its pieces ÷ ours",
        ],
    );
    for count in COUNTS {
        if count == 100 {
            measure(&table, &scene("random quads:100"));
        }
        // 10 000 random triangles become 2 million fragments here, and 8 million pieces in `plane-split`.
        for name in NAMES.into_iter().filter(|&name| name != "random" || count < 10_000) {
            measure(&table, &scene(&format!("{name}:{count}")));
        }
    }
}

fn measure(table: &Table, scene: &Scene) {
    let ours = threads(1).install(|| time_ours(scene));
    let theirs = time_theirs(scene);
    table.row(&[
        scene.name().to_owned(),
        time(ours.build),
        time(theirs.build),
        ratio(theirs.build, ours.build),
        time(ours.order),
        time(theirs.order),
        ours.pieces.to_string(),
        theirs.pieces.to_string(),
        format!("{:.2}", theirs.pieces as f64 / ours.pieces as f64),
    ]);
}

struct Measured {
    build: std::time::Duration,
    order: std::time::Duration,
    pieces: usize,
}

fn time_ours(scene: &Scene) -> Measured {
    let (build, tree) = best(|| BspTree::build(scene.polygons()).expect("within budget"));
    check(&tree, scene);
    let mut indices = Vec::new();
    let viewpoint = Viewpoint::direction(DIRECTION);
    let (order, ()) = best(|| tree.back_to_front_into(viewpoint, &mut indices));
    assert_eq!(indices.len(), tree.len());
    Measured { build, order, pieces: tree.len() }
}

fn time_theirs(scene: &Scene) -> Measured {
    let work = || {
        let polygons: Vec<_> =
            scene.polygons().enumerate().map(|(i, corners)| polygon(i, corners.points())).collect();
        let mut splitter = BspSplitter::<usize>::new();
        let (build, ()) = best(|| {
            splitter.reset();
            for polygon in &polygons {
                splitter.add(polygon.clone());
            }
        });
        let view = euclid::vec3(-DIRECTION[0], -DIRECTION[1], -DIRECTION[2]);
        let (order, pieces) = best(|| splitter.sort(view).len());
        assert!(pieces >= polygons.len());
        Measured { build, order, pieces }
    };
    thread::scope(|scope| {
        let thread = thread::Builder::new().stack_size(THEIR_STACK).spawn_scoped(scope, work);
        thread.expect("a thread").join().expect("plane-split does not panic here")
    })
}

/// A triangle is a quad with a corner twice.
fn polygon(index: usize, corners: &[binspace::glam::DVec3]) -> plane_split::Polygon<usize> {
    let point = |k: usize| {
        let corner = corners[k % corners.len()];
        Point3D::new(corner.x, corner.y, corner.z)
    };
    assert!(corners.len() <= 4);
    let points = [point(0), point(1), point(2), point(3)];
    plane_split::Polygon::from_points(points, index).expect("it has an area")
}
