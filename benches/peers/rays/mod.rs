//! Rays: the nearest hit, and whether a line of sight is blocked, against the ray casts of `parry3d` (in
//! `f64` and in `f32`) and of `bvh` (in `f64`), on the same triangles with the same rays, one thread. A
//! second table has rays through corners and edges, and the number of wrong answers. At the boundary of an
//! open mesh, rounding decides between a hit and a miss. Such rays are counted separately from rays through a
//! closed surface.

mod peers;

use binspace::glam::DVec3;
use binspace::{BspTree, Ray};
use peers::{Bvh, Parry32, Parry64, Peer};
use std::collections::{HashMap, HashSet};
use std::hint::black_box;
use std::time::Instant;
use support::{Table, check, scene, triangulated};
use testkit::dice::Dice;
use testkit::hits::Oracle;

const SCENES: [&str; 9] = [
    "random:1000",
    "terrain:10000",
    "terrain:100000",
    "sphere:100000",
    "city:100000",
    "bunny.obj",
    "dragon.obj",
    "engine.obj",
    "level_large.obj",
];

/// Rays of each kind that are timed, and rays that are judged.
const TIMED: usize = 20_000;
const JUDGED: usize = 2_000;

pub(crate) fn run() {
    let scenes: Vec<Case> = SCENES.iter().map(|name| Case::new(name)).collect();
    times(&scenes);
    errors(&scenes);
}

/// A scene as triangles, and the tree of the triangles.
struct Case {
    name: String,
    tree: BspTree,
    triangles: Vec<[DVec3; 3]>,
}

impl Case {
    fn new(name: &str) -> Self {
        let scene = triangulated(&scene(name));
        let tree = BspTree::build(scene.polygons()).expect("within budget");
        check(&tree, &scene);
        // Corners are rounded as in the tree, so that all libraries get the same triangles.
        let (faces, lattice) = (tree.faces(), tree.faces().lattice());
        let triangle = |face: u32| {
            let corners = faces.corners(face);
            [0, 1, 2].map(|k| lattice.to_world(corners[k]))
        };
        let triangles = (0..faces.len() as u32).map(triangle).collect();
        Self { name: name.to_owned(), tree, triangles }
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

    /// A random point of the box, which is enlarged by a factor.
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
        "hit",
        "hit: parry3d f64",
        "hit: parry3d f32",
        "hit: bvh f64",
        "hit: fastest ÷ ours",
        "sight",
        "sight: parry3d f64",
        "sight: parry3d f32",
        "sight: bvh f64",
        "sight: fastest ÷ ours",
    ];
    let table = Table::new("Rays", &columns);
    for case in cases {
        let mut points = Points::new(case.extent());
        // Rays from outside through the scene, and between points in the scene.
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
            row.push(format!("{:.2}", fastest / times[0]));
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
    // The answers of the peers agree with ours, except for a few rays.
    let off = yes[1..].iter().map(|&other| other.abs_diff(yes[0])).max().unwrap_or(0);
    assert!(off * 100 <= questions.len(), "{yes:?}");
    shortest
}

fn errors(cases: &[Case]) {
    let columns = [
        "scene",
        "through",
        "rays",
        "our wrong",
        "parry3d f64 wrong",
        "parry3d f32 wrong",
        "bvh f64 wrong",
    ];
    let table = Table::new("Rays through corners and edges", &columns);
    for case in cases.iter().filter(|case| case.triangles.len() < 30_000) {
        let oracle = Oracle::new(&case.tree);
        let mut points = Points::new(case.extent());
        let peers: [Box<dyn Peer>; 3] = [
            Box::new(Parry64::new(&case.triangles)),
            Box::new(Parry32::new(&case.triangles)),
            Box::new(Bvh::new(&case.triangles)),
        ];
        let boundary = boundary(&case.triangles);
        let ends: HashSet<Bits> = boundary.iter().flatten().copied().collect();
        let (mut rays, mut wrong) = ([0; 2], [[0; 4]; 2]);
        for k in 0..JUDGED {
            let triangle = case.triangles[points.below(case.triangles.len())];
            let at = points.below(3);
            let (a, b) = (triangle[at], triangle[(at + 1) % 3]);
            let target = [a, a, (a + b) * 0.5, a * 0.25 + b * 0.75][k % 4];
            let is_open =
                if k % 4 < 2 { ends.contains(&bits(a)) } else { boundary.contains(&edge(a, b)) };
            let kind = usize::from(is_open);
            // Rays from a point around the scene, or straight along an axis.
            let from =
                if k % 3 == 0 { target.with_z(points.next(2.0).z) } else { points.next(2.0) };
            let ray = [from, target - from];
            let expected = oracle.nearest(Ray::new(ray[0], ray[1]));
            rays[kind] += 1;
            let found = [
                case.nearest(ray),
                peers[0].nearest(ray),
                peers[1].nearest(ray),
                peers[2].nearest(ray),
            ];
            for (wrong, found) in wrong[kind].iter_mut().zip(found) {
                *wrong += usize::from(!agree(expected, found));
            }
        }
        for (kind, name) in ["closed surface", "boundary"].into_iter().enumerate() {
            assert_eq!(wrong[kind][0], 0, "{}", case.name);
            if rays[kind] > 0 {
                let mut row = vec![case.name.clone(), name.to_owned(), rays[kind].to_string()];
                row.extend(wrong[kind].map(|wrong| wrong.to_string()));
                table.row(&row);
            }
        }
    }
}

/// A point, to compare exactly.
type Bits = [u64; 3];

fn bits(point: DVec3) -> Bits {
    point.to_array().map(|c| (c + 0.0).to_bits())
}

fn edge(a: DVec3, b: DVec3) -> [Bits; 2] {
    let mut ends = [a, b].map(bits);
    ends.sort_unstable();
    ends
}

/// The edges of exactly one triangle.
fn boundary(triangles: &[[DVec3; 3]]) -> HashSet<[Bits; 2]> {
    let mut uses: HashMap<[Bits; 2], u32> = HashMap::new();
    for [a, b, c] in triangles {
        for (a, b) in [(a, b), (b, c), (c, a)] {
            *uses.entry(edge(*a, *b)).or_default() += 1;
        }
    }
    uses.into_iter().filter(|&(_, count)| count == 1).map(|(edge, _)| edge).collect()
}

/// Whether both hit nothing, or both hit the same place within a tolerance far above rounding. The ray's
/// length to the target is 1.
fn agree(expected: Option<f64>, found: Option<f64>) -> bool {
    match (expected, found) {
        (Some(expected), Some(found)) => (expected - found).abs() < 1e-4 * (1.0 + expected),
        (expected, found) => expected.is_none() && found.is_none(),
    }
}
