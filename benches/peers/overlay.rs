//! Moving polygons, lines, points and a body in a fixed tree: the cost of a frame, against a full rebuild and
//! against the order of the tree alone.

use binspace::glam::{DMat3, DVec3};
use binspace::overlay::{Overlay, Shapes};
use binspace::{BspTree, BuildOptions, Viewpoint, scene};
use std::time::{Duration, Instant};
use support::{SEED, Table, check, ratio, scene as named, time, viewpoints};
use testkit::dice::Dice;

const SCENES: [&str; 7] = [
    "city:10000",
    "terrain:10000",
    "city:100000",
    "terrain:100000",
    "sphere:100000",
    "engine.obj",
    "level_large.obj",
];
const MOVERS: usize = 200;
const FRAMES: usize = 20;

/// The number of lines, the number of segments in each, and the number of points.
const LINES: usize = 200;
const SEGMENTS: usize = 50;
const POINTS: usize = 1000;
/// The approximate number of faces of a body.
const BODY: u32 = 10_000;

pub(crate) fn run() {
    moving();
    lines_and_bodies();
}

fn moving() {
    let table = Table::new(
        "Moving polygons",
        &[
            "scene",
            "fragments",
            "pieces / mover",
            "rebuild",
            "replace",
            "replace ÷ rebuild",
            "order",
            "merged",
            "merged ÷ order",
            "empty ÷ order",
        ],
    );
    for name in SCENES {
        let scene = named(name);
        let (low, high) = scene.bounds().expect("a scene with polygons");
        let margin = (high - low) * 0.1;
        let options = BuildOptions::DEFAULT.with_bounds(low - margin, high + margin);
        let start = Instant::now();
        let tree = options.build(scene.polygons()).expect("within budget");
        let rebuild = start.elapsed();
        check(&tree, &scene);
        let mut overlay = Overlay::new(&tree);
        let (mut replacing, mut ordering) = (Duration::ZERO, [Duration::ZERO; 3]);
        let (mut pieces, viewpoints) = (0, viewpoints(&scene));
        for frame in 0..FRAMES {
            let movers = movers(low, high, frame);
            let eye = viewpoints[frame % viewpoints.len()];
            let empty = orders(&mut overlay, &tree, &[], eye).1[1];
            let (replaced, [alone, merged]) = orders(&mut overlay, &tree, &movers, eye);
            judge(&overlay, &tree, eye);
            pieces += overlay.len();
            replacing += replaced;
            [alone, merged, empty].iter().zip(&mut ordering).for_each(|(one, sum)| *sum += *one);
        }
        let mean = |sum: Duration| sum / FRAMES as u32;
        let [alone, merged, empty] = ordering.map(mean);
        table.row(&[
            name.to_owned(),
            tree.len().to_string(),
            format!("{:.2}", pieces as f64 / (MOVERS * FRAMES) as f64),
            time(rebuild),
            time(mean(replacing)),
            ratio(mean(replacing), rebuild),
            time(alone),
            time(merged),
            ratio(merged, alone),
            ratio(empty, alone),
        ]);
    }
}

/// Squares of a hundredth of the extent that move through the scene and turn.
fn movers(low: DVec3, high: DVec3, frame: usize) -> Vec<[DVec3; 4]> {
    let size = (high - low).max_element() * 0.005;
    let mut dice = Dice(SEED);
    let mover = |_| {
        let [x, y, z, turn] = [0; 4].map(|_| dice.range(0.0, 1.0));
        let angle = turn * 6.0 + frame as f64 * 0.2;
        let way = DVec3::new(angle.cos(), angle.sin(), 0.3 * (2.0 * angle).sin()) * 0.02;
        let share = (DVec3::new(x, y, z) + way).clamp(DVec3::ZERO, DVec3::ONE);
        let turned = DMat3::from_rotation_z(angle) * DMat3::from_rotation_x(turn * 9.0);
        let at = low + (high - low) * share;
        [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]]
            .map(|[x, y]| at + turned * DVec3::new(x, y, 0.0) * size)
    };
    (0..MOVERS).map(mover).collect()
}

/// The shortest times of replacing the contents, of the tree's own order, and of the order of both.
fn orders(
    overlay: &mut Overlay,
    tree: &BspTree,
    movers: &[[DVec3; 4]],
    eye: Viewpoint,
) -> (Duration, [Duration; 2]) {
    let (mut alone, mut both) = (Vec::new(), Vec::new());
    let (mut replacing, mut ordering) = (Duration::MAX, [Duration::MAX; 2]);
    for _ in 0..7 {
        let start = Instant::now();
        overlay.replace(tree, movers).expect("on the grid");
        replacing = replacing.min(start.elapsed());
        let start = Instant::now();
        tree.back_to_front_into(eye, &mut alone);
        ordering[0] = ordering[0].min(start.elapsed());
        let start = Instant::now();
        overlay.order(tree, eye).expect("its own tree").write_into(&mut both);
        ordering[1] = ordering[1].min(start.elapsed());
    }
    let of_tree = both.iter().copied().filter(|&number| (number as usize) < tree.len());
    assert!(of_tree.eq(alone), "the tree's own order");
    (replacing, ordering)
}

/// Checks that both forms of the order agree, and that each piece occurs once.
fn judge(overlay: &Overlay, tree: &BspTree, eye: Viewpoint) {
    let mut order = Vec::new();
    overlay.order(tree, eye).expect("its own tree").write_into(&mut order);
    let listed = overlay.order(tree, eye).expect("its own tree");
    assert!(listed.into_iter().map(|fragment| fragment.index()).eq(order.iter().copied()));
    order.sort_unstable();
    assert!(order.into_iter().eq(0..(tree.len() + overlay.len()) as u32));
}

/// The cost of an overlay with shapes of one kind, which are anywhere in a scene, or all in one leaf.
fn lines_and_bodies() {
    let table = Table::new(
        "Moving lines, points and bodies",
        &[
            "scene",
            "overlay",
            "shapes",
            "pieces",
            "rebuild",
            "replace",
            "order",
            "merged",
            "merged ÷ order",
        ],
    );
    for name in ["empty", "city:100000", "terrain:100000", "sphere:100000"] {
        let still =
            if name == "empty" { scene::Scene::new("empty", DVec3::Z) } else { named(name) };
        let (low, high) = still.bounds().unwrap_or((DVec3::ZERO, DVec3::ONE));
        let margin = (high - low).max_element() * 0.1;
        let options = BuildOptions::DEFAULT.with_bounds(low - margin, high + margin);
        let start = Instant::now();
        let tree = options.build(still.polygons()).expect("within budget");
        let rebuild = start.elapsed();
        let eye = Viewpoint::Eye(low - (high - low) * 0.3);
        let (lines, points) = curves(low, high);
        let body = |at: DVec3| {
            let size = margin * 0.4;
            let place = move |corner: &DVec3| at + *corner * size;
            let sphere = scene::sphere(BODY);
            let faces =
                sphere.polygons().map(|face| face.points().iter().map(place).collect::<Vec<_>>());
            faces.collect::<Vec<_>>()
        };
        let (none, no_lines): (Vec<Vec<DVec3>>, &[Vec<DVec3>]) = (vec![], &[]);
        let no_points: &[DVec3] = &[];
        let above =
            DVec3::new((low.x + high.x) / 2.0, (low.y + high.y) / 2.0, high.z + margin / 2.0);
        let kinds = [
            ("lines", &none, &lines[..], no_points),
            ("points", &none, no_lines, &points[..]),
            ("body, above", &body(above), no_lines, no_points),
            ("body, inside", &body((low + high) / 2.0), no_lines, no_points),
        ];
        for (kind, polygons, lines, points) in kinds {
            let mut overlay = Overlay::new(&tree);
            let shapes = Shapes::NONE.with_polygons(polygons).with_lines(lines);
            let shapes = shapes.with_points(points.iter().copied());
            let count = polygons.len() + lines.len() * SEGMENTS + points.len();
            let (mut alone, mut both) = (Vec::new(), Vec::new());
            let [mut replacing, mut ordering, mut merging] = [Duration::MAX; 3];
            for _ in 0..7 {
                let start = Instant::now();
                overlay.replace_with(&tree, shapes.clone()).expect("on the grid");
                replacing = replacing.min(start.elapsed());
                let start = Instant::now();
                tree.back_to_front_into(eye, &mut alone);
                ordering = ordering.min(start.elapsed());
                let start = Instant::now();
                overlay.order(&tree, eye).expect("its own tree").write_into(&mut both);
                merging = merging.min(start.elapsed());
            }
            judge(&overlay, &tree, eye);
            table.row(&[
                name.to_owned(),
                kind.to_owned(),
                count.to_string(),
                overlay.len().to_string(),
                time(rebuild),
                time(replacing),
                time(ordering),
                time(merging),
                ratio(merging, ordering),
            ]);
        }
    }
}

/// Curves that wind through a box, and points anywhere in it.
fn curves(low: DVec3, high: DVec3) -> (Vec<Vec<DVec3>>, Vec<DVec3>) {
    let mut dice = Dice(SEED);
    let mut any = || DVec3::from_array([0; 3].map(|_| dice.range(0.0, 1.0)));
    let place = |share: DVec3| low + (high - low) * share.clamp(DVec3::ZERO, DVec3::ONE);
    let curve = |_| {
        let (at, turn) = (any(), any());
        let point = |k: usize| {
            let along = k as f64 / SEGMENTS as f64;
            let angle = turn * (2.0 + 6.0 * along);
            place(at + DVec3::new(angle.x.cos(), angle.y.sin(), (2.0 * angle.z).cos()) * 0.1)
        };
        (0..=SEGMENTS).map(point).collect()
    };
    let lines = (0..LINES).map(curve).collect();
    (lines, (0..POINTS).map(|_| place(any())).collect())
}
