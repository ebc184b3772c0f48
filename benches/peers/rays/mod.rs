//! Rays: the nearest hit, and whether a line of sight is blocked, against the ray casts of `parry3d` (in
//! `f64` and in `f32`) and of `bvh` (in `f64`), on the same triangles with the same rays, one thread. A
//! second table has rays through corners and edges, and the number of wrong answers.

mod peers;

use binspace::glam::DVec3;
use binspace::{BspTree, Ray};
use peers::{Bvh, Parry32, Parry64, Peer};
use std::hint::black_box;
use std::time::Instant;
use support::{Table, Target, against, check, scene, triangulated};
use testkit::dice::Dice;
use testkit::hits::Oracle;

const SCENES: [&str; 10] = [
    "random:1000",
    "terrain:10000",
    "terrain:100000",
    "sphere:100000",
    "city:100000",
    "bunny_4k.obj",
    "doom_map12_big.obj",
    "teapot_quads_32k.obj",
    "chessboard_63k.obj",
    "maple_tree_166k.obj",
];

/// Rays of each kind that are timed, and rays that are judged.
const TIMED: usize = 20_000;
const JUDGED: usize = 2_000;

pub(crate) fn run() {
    let scenes: Vec<Case> = SCENES.iter().filter_map(|name| Case::new(name)).collect();
    times(&scenes);
    errors(&scenes);
}

/// A scene as triangles, and a tree of them.
struct Case {
    name: String,
    tree: BspTree,
    triangles: Vec<[DVec3; 3]>,
}

impl Case {
    fn new(name: &str) -> Option<Self> {
        let scene = triangulated(&scene(name)?);
        let tree = BspTree::build(scene.polygons()).expect("within budget");
        check(&tree, &scene);
        // As in the tree, so that all libraries get the same triangles.
        let (faces, lattice) = (tree.faces(), tree.faces().lattice());
        let triangle = |face: u32| {
            let corners = faces.corners(face);
            [0, 1, 2].map(|k| lattice.to_world(corners[k]))
        };
        let triangles = (0..faces.len() as u32).map(triangle).collect();
        Some(Self { name: name.to_owned(), tree, triangles })
    }

    fn extent(&self) -> [DVec3; 2] {
        self.tree.bounds().expect("triangles")
    }

    fn nearest(&self, [from, direction]: [DVec3; 2]) -> Option<f64> {
        Some(self.tree.hits(Ray::new(from, direction)).next()?.parameter())
    }
}

/// Points of a box from a seed.
struct Points {
    dice: Dice,
    bounds: [DVec3; 2],
}

impl Points {
    fn new(bounds: [DVec3; 2]) -> Self {
        Self { dice: Dice(support::SEED), bounds }
    }

    /// A point of the box, enlarged.
    fn next(&mut self, by: f64) -> DVec3 {
        let [low, high] = self.bounds;
        let share = self.dice.point(0.5 - 0.5 * by, 0.5 + 0.5 * by);
        low + (high - low) * share
    }

    fn below(&mut self, n: usize) -> usize {
        self.dice.below(n)
    }
}

fn times(cases: &[Case]) {
    let columns = [
        "scene",
        "triangles",
        "fragments",
        "ns / nearest hit",
        "parry3d f64",
        "f32",
        "bvh f64",
        "ratio",
        "target",
        "met",
        "ns / sight",
        "parry3d f64",
        "f32",
        "bvh f64",
        "ratio",
        "target",
        "met",
    ];
    let table = Table::new("Rays, one thread, against parry3d and bvh", &columns);
    for case in cases {
        let mut points = Points::new(case.extent());
        // From around the scene through it, and between points in it.
        let rays: Vec<[DVec3; 2]> = (0..TIMED)
            .map(|_| {
                let (from, to) = (points.next(2.0), points.next(1.0));
                [from, to - from]
            })
            .collect();
        let sights: Vec<[DVec3; 2]> =
            (0..TIMED).map(|_| [points.next(1.0), points.next(1.0)]).collect();
        let peers: [Box<dyn Peer>; 3] = [
            Box::new(Parry64::new(&case.triangles)),
            Box::new(Parry32::new(&case.triangles)),
            Box::new(Bvh::new(&case.triangles)),
        ];
        let nearest = measure(
            &rays,
            |ray| black_box(case.nearest(ray)).is_some(),
            &peers,
            |peer, ray| black_box(peer.nearest(ray)).is_some(),
        );
        let sight = measure(
            &sights,
            |[from, to]| case.tree.is_occluded(Ray::between(from, to)),
            &peers,
            |peer, ends| peer.is_occluded(ends),
        );
        let mut row =
            vec![case.name.clone(), case.triangles.len().to_string(), case.tree.len().to_string()];
        for times in [nearest, sight] {
            row.extend(times.iter().map(|time| format!("{time:.0}")));
            let fastest = times[1..].iter().copied().fold(f64::INFINITY, f64::min);
            row.extend(against(times[0] / fastest, Target::AtMost(3.0)));
        }
        table.row(&row);
    }
}

/// The shortest times of a query in nanoseconds, ours and the peers', taken in turns.
fn measure(
    questions: &[[DVec3; 2]],
    ours: impl Fn([DVec3; 2]) -> bool,
    peers: &[Box<dyn Peer>; 3],
    theirs: impl Fn(&dyn Peer, [DVec3; 2]) -> bool,
) -> [f64; 4] {
    let mut shortest = [f64::INFINITY; 4];
    let mut yes = [0; 4];
    for _ in 0..5 {
        for (k, shortest) in shortest.iter_mut().enumerate() {
            let begin = Instant::now();
            yes[k] = questions
                .iter()
                .filter(|&&question| match k.checked_sub(1) {
                    None => black_box(ours(question)),
                    Some(peer) => black_box(theirs(&*peers[peer], question)),
                })
                .count();
            let each = begin.elapsed().as_secs_f64() * 1e9 / questions.len() as f64;
            *shortest = shortest.min(each);
        }
    }
    // Their answers agree, except for a few rays.
    let off = yes[1..].iter().map(|&other| other.abs_diff(yes[0])).max().unwrap_or(0);
    assert!(off * 100 <= questions.len(), "{yes:?}");
    shortest
}

fn errors(cases: &[Case]) {
    let columns = [
        "scene",
        "rays",
        "hits in truth",
        "wrong",
        "parry3d f64 wrong",
        "f32 wrong",
        "bvh f64 wrong",
    ];
    let table = Table::new("Nearest hits of rays through corners and edges", &columns);
    for case in cases.iter().filter(|case| case.triangles.len() < 30_000) {
        let oracle = Oracle::new(&case.tree);
        let mut points = Points::new(case.extent());
        let peers: [Box<dyn Peer>; 3] = [
            Box::new(Parry64::new(&case.triangles)),
            Box::new(Parry32::new(&case.triangles)),
            Box::new(Bvh::new(&case.triangles)),
        ];
        let (mut hits, mut wrong) = (0, [0; 4]);
        for k in 0..JUDGED {
            let triangle = case.triangles[points.below(case.triangles.len())];
            let target = match k % 4 {
                0 | 1 => triangle[points.below(3)],
                2 => (triangle[0] + triangle[1]) * 0.5,
                _ => triangle[1] * 0.25 + triangle[2] * 0.75,
            };
            // From a point around the scene, or straight along an axis.
            let from =
                if k % 3 == 0 { target.with_z(points.next(2.0).z) } else { points.next(2.0) };
            let ray = [from, target - from];
            let expected = oracle.nearest(Ray::new(ray[0], ray[1]));
            hits += usize::from(expected.is_some());
            let found = [
                case.nearest(ray),
                peers[0].nearest(ray),
                peers[1].nearest(ray),
                peers[2].nearest(ray),
            ];
            for (wrong, found) in wrong.iter_mut().zip(found) {
                *wrong += usize::from(!agree(expected, found));
            }
        }
        assert_eq!(wrong[0], 0, "{}", case.name);
        let mut row = vec![case.name.clone(), JUDGED.to_string(), hits.to_string()];
        row.extend(wrong.map(|wrong| wrong.to_string()));
        table.row(&row);
    }
}

/// Both hit nothing, or the same place within a tolerance far above rounding: the ray's length to the target
/// is 1.
fn agree(expected: Option<f64>, found: Option<f64>) -> bool {
    match (expected, found) {
        (Some(expected), Some(found)) => (expected - found).abs() < 1e-4 * (1.0 + expected),
        (expected, found) => expected.is_none() && found.is_none(),
    }
}
