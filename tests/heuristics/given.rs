//! Planes that a function of the caller chooses: good planes, bad planes, and panics.

use super::divided::{Divided, Piece, nodes};
use super::{build, scene};
use binspace::choose::{PieceSet, Side, SplitPlane};
use binspace::{BuildOptions, ErrorKind};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicUsize, Ordering::Relaxed};
use std::sync::{Arc, Mutex};
use testkit::judge::{self, judge};
use testkit::prelude::*;
use testkit::shapes;
use testkit::snapshot::Snapshot;

fn axis(axis: usize, coordinate: f64) -> Option<SplitPlane> {
    Some(SplitPlane::Axis { axis, coordinate })
}

fn with_threads<T: Send>(threads: usize, work: impl FnOnce() -> T + Send) -> T {
    rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads").install(work)
}

/// The plane of the piece with the lowest score. Of equal scores, the first piece counts.
fn least(
    set: &PieceSet<'_>,
    candidates: usize,
    score: impl Fn(usize, [f64; 2]) -> [f64; 2],
) -> Option<SplitPlane> {
    let n = set.piece_count();
    let count = candidates.min(n);
    let scored = (0..count).map(|i| i * n / count).map(|piece| {
        let mut counts = [0.0; 3];
        for side in set.sides(SplitPlane::OfPiece(piece)).expect("a plane") {
            match side {
                Side::Front => counts[0] += 1.0,
                Side::Back => counts[1] += 1.0,
                Side::Spanning => counts[2] += 1.0,
                Side::Coplanar => {}
            }
        }
        let [front, back, splits] = counts;
        (score(piece, [splits, f64::abs(front - back)]), piece)
    });
    let best = scored.min_by(|(a, _), (b, _)| a.partial_cmp(b).expect("numbers"));
    best.map(|(_, piece)| SplitPlane::OfPiece(piece))
}

/// Five built-in heuristics, written against the public interface.
fn rewritten(by: Heuristic, set: &PieceSet<'_>) -> Option<SplitPlane> {
    let weighted = |candidates, [splits, balance, axial]: [f64; 3]| {
        least(set, candidates, |piece, [cut, uneven]| {
            let [low, high] = set.bounds(piece);
            let is_axial = low.cmpeq(high).any();
            let bonus = if is_axial { axial * set.piece_count() as f64 } else { 0.0 };
            [splits * cut + balance * uneven - bonus, 0.0]
        })
    };
    match by {
        Heuristic::First => {
            (0..set.piece_count()).min_by_key(|&i| set.polygon(i)).map(SplitPlane::OfPiece)
        }
        Heuristic::FewestSplits => least(set, 96, |_, [cut, uneven]| [cut, uneven]),
        Heuristic::Balanced => least(set, 96, |_, [cut, uneven]| [uneven, cut]),
        Heuristic::Weighted { splits, balance, axial } => weighted(96, [splits, balance, axial]),
        Heuristic::Sampled { candidates } => weighted(candidates as usize, [8.0, 1.0, 0.0]),
        _ => panic!("{by} has no copy here"),
    }
}

#[test]
fn built_in_heuristics_written_against_the_interface_build_the_same_trees() {
    for by in [
        Heuristic::First,
        Heuristic::FewestSplits,
        Heuristic::Balanced,
        Heuristic::Weighted { splits: 2.0, balance: 1.0, axial: 0.5 },
        Heuristic::Sampled { candidates: 3 },
    ] {
        let (mut nodes, mut cuts) = (0, 0);
        for seed in 0..24 {
            let scene = scene(&mut Dice(seed), 4 + seed as usize * 3);
            let options = BuildOptions::DEFAULT.with_tolerance(0.0);
            // If the function declined, this heuristic would choose another plane, and the trees would
            // differ.
            let options = options.with_heuristic(Heuristic::FreePlanes);
            let own = options.with_chooser(move |set| rewritten(by, set));
            let own = own.build(&scene).expect("a tree");
            let built_in = build(&scene, by);
            assert_eq!(Snapshot::of(&own), Snapshot::of(&built_in), "{by}, seed {seed}");
            nodes += own.nodes().len();
            cuts += own.len() - own.faces().len();
        }
        enough!(nodes > 500, cuts > 200; "{by}: {nodes} nodes, {cuts} cuts");
    }
}

/// The number of answers of each kind.
type Answers = [AtomicUsize; 9];

/// Decides by a hash of the set, so that it is a pure function.
fn adversary(seed: u64, answers: &Answers, set: &PieceSet<'_>) -> Option<SplitPlane> {
    let n = set.piece_count();
    let mut dice = Dice(seed ^ (n as u64) << 32 ^ set.depth() as u64);
    for piece in 0..n.min(50) {
        dice.0 ^= (set.polygon(piece) as u64) << 17 ^ set.bounds(piece)[0].x.to_bits();
        dice.roll();
    }
    let (piece, across) = (dice.below(n), dice.below(3));
    let [low, high] = set.bounds(piece);
    let kind = dice.below(answers.len());
    answers[kind].fetch_add(1, Relaxed);
    match kind {
        0 => Some(SplitPlane::OfPiece(piece)),
        1 => Some(SplitPlane::OfPiece([n, n + 1, 1 << 32, usize::MAX][dice.below(4)])),
        2 => axis(across, [f64::NAN, f64::INFINITY, f64::NEG_INFINITY][dice.below(3)]),
        3 => axis(across, [1e300, -1e300, f64::MAX, 1e9][dice.below(4)]),
        4 => axis([3, 255, usize::MAX][dice.below(3)], low.x),
        5 => axis(across, low[across]),
        6 => axis(across, high[across]),
        7 => axis(across, low.lerp(high, dice.share())[across]),
        _ => None,
    }
}

#[test]
fn trees_are_exact_whatever_the_function_returns() {
    let answers = Arc::new(Answers::default());
    let strategy = (hard::scene(), hard::heuristic(), proptest::prelude::any::<u64>());
    let [trees, fragments, over] =
        tally(file!(), 192, strategy, |seen: &mut [usize; 3], (scene, by, seed)| {
            let counted = answers.clone();
            let options = scene.options(by).with_max_fragments(3000);
            let options = options.with_chooser(move |set| adversary(seed, &counted, set));
            match options.build(&scene.polygons) {
                Ok(tree) => {
                    judge(&tree, &scene.polygons).map_err(fail)?;
                    seen[0] += 1;
                    seen[1] += tree.len();
                }
                Err(error) if error.kind() == ErrorKind::OverBudget => seen[2] += 1,
                Err(error) => return Err(fail(error)),
            }
            Ok::<_, _>(())
        });
    enough!(trees > 150, fragments > 1500, over < 20; "{trees} {fragments} {over}");
    let counts = answers.each_ref().map(|count| count.load(Relaxed));
    enough!(counts.iter().all(|&count| count > 20); "{counts:?}");
}

#[test]
fn an_adversary_gets_the_same_tree_on_any_number_of_threads() {
    let scenes = [scene::city(6000, 2), scene::terrain(4000, 1), scene::random_triangles(300, 4)];
    for (seed, scene) in scenes.iter().enumerate() {
        let build = |threads: usize| {
            let answers = Answers::default();
            let options = BuildOptions::DEFAULT
                .with_max_fragments(400_000)
                .with_chooser(move |set| adversary(seed as u64, &answers, set));
            with_threads(threads, || options.build(scene.polygons())).expect("within budget")
        };
        let [one, two, eight] = [1, 2, 8].map(build);
        one.validate().expect("a valid tree");
        assert!(one.len() > scene.polygons().len(), "{}: nothing was cut", scene.name());
        let expected = Snapshot::of(&one);
        assert!(expected == Snapshot::of(&two), "{}", scene.name());
        assert!(expected == Snapshot::of(&eight), "{}", scene.name());
    }
}

/// The scene is in general position, so only planes beyond all corners have all pieces on one side.
#[test]
fn an_invalid_or_useless_plane_counts_as_none() {
    let scene = scene::random_triangles(150, 3);
    for by in [Heuristic::Auto, Heuristic::First] {
        let options = BuildOptions::DEFAULT.with_heuristic(by);
        let none = options.clone().with_chooser(|_| None);
        let expected = Snapshot::of(&none.build(scene.polygons()).expect("a tree"));
        for answer in [
            Some(SplitPlane::OfPiece(usize::MAX)),
            axis(0, f64::NAN),
            axis(1, f64::INFINITY),
            axis(1, -1e300),
            axis(2, 1e300),
            axis(3, 0.0),
            axis(usize::MAX, 0.0),
        ] {
            let calls = Arc::new(AtomicUsize::new(0));
            let counted = calls.clone();
            let options = options.clone().with_chooser(move |_| {
                counted.fetch_add(1, Relaxed);
                answer
            });
            let tree = options.build(scene.polygons()).expect("a tree");
            assert!(Snapshot::of(&tree) == expected, "{by}, {answer:?}");
            assert!(calls.load(Relaxed) > 100, "{by}, {answer:?}");
        }
        // A plane at the least x of a set has all pieces on one side, except a piece in the plane.
        let scene = scene::random_triangles(60, 3);
        let options = options.with_chooser(|set| {
            axis(0, (0..set.piece_count()).map(|i| set.bounds(i)[0].x).fold(f64::MAX, f64::min))
        });
        judge(
            &options.build(scene.polygons()).expect("a tree"),
            &scene.polygons().map(|polygon| polygon.points().to_vec()).collect::<Vec<_>>(),
        )
        .expect("an exact tree");
    }
}

/// The side of the plane through three points on which a fourth point is. All coordinates are multiples of a
/// quarter.
fn side_of([p, q, r]: [DVec3; 3], at: DVec3) -> i128 {
    let [a, b, c] = [q - p, r - p, at - p].map(|arm| (arm * 4.0).to_array().map(|c| c as i128));
    a[0] * (b[1] * c[2] - b[2] * c[1])
        + a[1] * (b[2] * c[0] - b[0] * c[2])
        + a[2] * (b[0] * c[1] - b[1] * c[0])
}

fn side(values: impl Iterator<Item = i128>) -> Side {
    let values: Vec<i128> = values.collect();
    match (values.iter().any(|&v| v > 0), values.iter().any(|&v| v < 0)) {
        (true, true) => Side::Spanning,
        (true, false) => Side::Front,
        (false, true) => Side::Back,
        (false, false) => Side::Coplanar,
    }
}

/// Tests sets at the root, for scenes on a grid of quarters, where integers give the right contents of a set.
#[test]
fn a_set_shows_its_polygons_and_the_sides_on_which_they_lie() {
    let mut found = [0; 4];
    for seed in 0..24 {
        let scene = scene(&mut Dice(seed), 6 + seed as usize);
        let scene: Vec<Corners> = scene
            .into_iter()
            .filter(|p| build(std::slice::from_ref(p), Heuristic::First).len() == 1)
            .collect();
        let seen = Arc::new(Mutex::new([0; 4]));
        let (given, counted) = (scene.clone(), seen.clone());
        let options = BuildOptions::DEFAULT.with_tolerance(0.0).with_chooser(move |set| {
            if set.depth() > 0 {
                assert!(set.piece_count() >= 2);
                return None;
            }
            assert_eq!(set.piece_count(), given.len());
            for (piece, corners) in given.iter().enumerate() {
                assert_eq!((set.polygon(piece), set.cuts(piece)), (piece, 0));
                assert!(set.vertices(piece).eq(corners.iter().copied()));
                let [low, high] = [DVec3::min, DVec3::max]
                    .map(|f| corners.iter().copied().reduce(f).expect("a corner"));
                assert_eq!(set.bounds(piece), [low, high]);
                let normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]).normalize();
                assert!(set.normal(piece).abs_diff_eq(normal, 1e-14));
                let triangle = [corners[0], corners[1], corners[2]];
                let sides = set.sides(SplitPlane::OfPiece(piece)).expect("a plane");
                for (other, found) in given.iter().zip(sides) {
                    let expected = side(other.iter().map(|&p| side_of(triangle, p)));
                    assert_eq!(found, expected);
                    counted.lock().unwrap()[found as usize] += 1;
                }
            }
            for axis in 0..3 {
                for coordinate in [-9.2, -1.4, 0.3, 0.8, 3.45] {
                    let distance = |at: f64| (at - coordinate).abs();
                    let along = given.iter().flatten().map(|corner| corner[axis]);
                    let nearest = along
                        .reduce(|a, b| if distance(b) < distance(a) { b } else { a })
                        .expect("a corner");
                    let plane = SplitPlane::Axis { axis, coordinate };
                    for (other, found) in given.iter().zip(set.sides(plane).expect("a plane")) {
                        let along = other.iter().map(|p| (4.0 * (p[axis] - nearest)) as i128);
                        assert_eq!(found, side(along), "{plane:?}");
                    }
                }
            }
            let none = [axis(3, 0.0), axis(0, f64::NAN), axis(0, f64::INFINITY)];
            assert!(none.into_iter().flatten().all(|plane| set.sides(plane).is_none()));
            assert!(set.sides(SplitPlane::OfPiece(set.piece_count())).is_none());
            None
        });
        options.build(&scene).expect("a tree");
        for (sum, count) in found.iter_mut().zip(*seen.lock().unwrap()) {
            *sum += count;
        }
    }
    enough!(found.iter().all(|&count| count > 100); "{found:?}");
}

/// What a set says of one of its pieces.
struct Seen {
    polygon: usize,
    cuts: usize,
    bounds: [DVec3; 2],
    vertices: Vec<DVec3>,
    normal: DVec3,
    /// The sides of all pieces of the set on the plane of this piece.
    sides: Vec<Side>,
}

/// All pieces of a set, and their sides on the planes across the axes at some coordinate.
struct SeenSet {
    depth: usize,
    coordinate: f64,
    pieces: Vec<Seen>,
    sides: [Vec<Side>; 3],
}

impl SeenSet {
    /// Calls every method of a set.
    fn new(set: &PieceSet<'_>, coordinate: f64) -> Self {
        let sides = |plane| set.sides(plane).expect("a plane").collect();
        let piece = |piece: usize| {
            let vertices: Vec<DVec3> = set.vertices(piece).collect();
            let mut reversed: Vec<DVec3> = set.vertices(piece).rev().collect();
            reversed.reverse();
            assert_eq!(vertices, reversed);
            assert_eq!(vertices.len(), set.vertices(piece).len());
            let (polygon, cuts) = (set.polygon(piece), set.cuts(piece));
            let (bounds, normal) = (set.bounds(piece), set.normal(piece));
            Seen {
                polygon,
                cuts,
                bounds,
                vertices,
                normal,
                sides: sides(SplitPlane::OfPiece(piece)),
            }
        };
        Self {
            depth: set.depth(),
            coordinate,
            pieces: (0..set.piece_count()).map(piece).collect(),
            sides: [0, 1, 2].map(|axis| sides(SplitPlane::Axis { axis, coordinate })),
        }
    }

    /// For each piece, the piece of a divided set with the same vertices; `None` if the sets differ.
    fn same_as<'d>(&self, node: &'d Divided<'_>) -> Option<Vec<&'d Piece>> {
        let mut left: Vec<&Piece> = node.set.iter().collect();
        let is_same = self.depth == node.depth && self.pieces.len() == left.len();
        let found = self.pieces.iter().take_while(|_| is_same).map_while(|seen| {
            let is_seen = |piece: &&Piece| {
                let polygon = node.faces.polygon(piece.face);
                polygon == seen.polygon && starts(&seen.vertices, &world(node, piece)).is_some()
            };
            Some(left.swap_remove(left.iter().position(is_seen)?))
        });
        let found: Vec<_> = found.collect();
        (is_same && found.len() == self.pieces.len()).then_some(found)
    }
}

/// The vertices of a piece in the unit of the polygons.
fn world(node: &Divided<'_>, piece: &Piece) -> Vec<DVec3> {
    let lattice = node.faces.lattice();
    let rounded = |c: &Rational| c.to_f64().value();
    piece.outline.iter().map(|v| lattice.to_world(v.point.each_ref().map(rounded))).collect()
}

/// The vertex of an outline that is the first vertex of another outline, with the same vertices up to
/// rounding, in the same direction.
fn starts(outline: &[DVec3], of: &[DVec3]) -> Option<usize> {
    let n = of.len();
    let is_start = |&k: &usize| (0..n).all(|i| outline[(k + i) % n].abs_diff_eq(of[i], 1e-12));
    (outline.len() == n).then(|| (0..n).find(is_start))?
}

/// Planes of pieces and planes across an axis, by a hash of the set.
fn any_plane(set: &PieceSet<'_>) -> Option<SplitPlane> {
    let low = set.bounds(0)[0];
    let mut dice = Dice(low.x.to_bits() ^ low.y.to_bits() << 9 ^ set.piece_count() as u64);
    dice.roll();
    let piece = dice.below(set.piece_count());
    let [low, high] = set.bounds(piece);
    match dice.below(4) {
        across @ 0..3 => axis(across, (low + high)[across] / 2.0),
        _ => Some(SplitPlane::OfPiece(piece)),
    }
}

/// Reading the vertices of a cut piece used to panic. All sets that a function sees, at every depth, are
/// compared with the sets cut again in rationals.
#[test]
fn a_set_of_cut_pieces_shows_them_at_every_depth() {
    let [mut sets, mut cut, mut deep] = [0; 3];
    let mut sides = [0; 4];
    for seed in 0..24 {
        let scene = scene(&mut Dice(seed), 6 + seed as usize);
        let seen = Arc::new(Mutex::new(vec![]));
        let list = seen.clone();
        let options = BuildOptions::DEFAULT.with_tolerance(0.0).with_chooser(move |set| {
            let coordinate = [-1.4, 0.3, 0.8][set.depth() % 3];
            list.lock().unwrap().push(SeenSet::new(set, coordinate));
            any_plane(set)
        });
        let tree = options.build(&scene).expect("a tree");
        let seen = seen.lock().unwrap();
        nodes(&tree, |node| {
            if node.set.len() < 2 {
                return;
            }
            let same = seen.iter().find_map(|set| Some((set, set.same_as(node)?)));
            let (set, pieces) = same.expect("a set that the function saw");
            sets += 1;
            deep = deep.max(set.depth);
            let exact_sides = |plane: &rational::Plane| {
                pieces.iter().map(|piece| side_of_values(&piece.values(plane))).collect::<Vec<_>>()
            };
            for (seen, piece) in set.pieces.iter().zip(&pieces) {
                assert_eq!(seen.cuts, piece.cuts);
                cut += usize::from(seen.cuts > 0);
                let plane = model::plane(node.faces, PlaneId::face(piece.face));
                let normal = plane.normal.each_ref().map(|c| c.to_f64().value());
                let normal = DVec3::from(normal).normalize();
                assert!(seen.normal.abs_diff_eq(normal, 1e-14));
                let corners = world(node, piece);
                let ends = [DVec3::min, DVec3::max]
                    .map(|f| corners.iter().copied().reduce(f).expect("a corner"));
                for (found, expected) in seen.bounds.iter().zip(ends) {
                    assert!(found.abs_diff_eq(expected, 1e-12));
                }
                let expected = exact_sides(&plane);
                assert_eq!(seen.sides, expected);
                expected.iter().for_each(|&side| sides[side as usize] += 1);
            }
            for (axis, found) in set.sides.iter().enumerate() {
                let at = DVec3::splat(set.coordinate).to_array();
                let at = node.faces.lattice().to_lattice(at.into())[axis];
                let at = rational::exact(at);
                let distance = |c: &Rational| (c.clone() - at.clone()).abs();
                let along = node.exact.iter().flat_map(|face| &face.corners).map(|c| &c[axis]);
                let nearest = along
                    .min_by(|a, b| distance(a).cmp(&distance(b)).then(a.cmp(b)))
                    .expect("a corner");
                let corner = [nearest.clone(), nearest.clone(), nearest.clone()];
                assert_eq!(*found, exact_sides(&rational::perpendicular_to_axis(axis, &corner)));
            }
        });
    }
    enough!(sets > 300, cut > 500, deep > 6; "{sets} sets, {cut} cut pieces, depth {deep}");
    enough!(sides.iter().all(|&count| count > 100); "{sides:?}");
}

fn side_of_values(values: &[Rational]) -> Side {
    side(values.iter().map(|value| rational::sign(value) as i128))
}

/// Flattened quads, triangles of bent polygons, and `f32`, at the default tolerance.
#[test]
fn cut_pieces_lie_in_their_bounds_and_planes_and_turn_left() {
    let mut dice = Dice(11);
    let mut boxes = vec![];
    for _ in 0..12 {
        let turn = shapes::rotation([0; 3].map(|_| dice.range(-3.0, 3.0)));
        let mut sides = shapes::cuboid(turn, dice.point(-1.0, 1.0), dice.point(0.3, 1.0));
        sides[0][2] += dice.point(-0.1, 0.1);
        boxes.extend(sides);
    }
    let as_f32: Vec<Vec<[f32; 3]>> =
        boxes.iter().map(|side| side.iter().map(|p| p.as_vec3().to_array()).collect()).collect();
    for is_single in [false, true] {
        let cut = Arc::new(AtomicUsize::new(0));
        let counted = cut.clone();
        let near = if is_single { 1e-5 } else { 1e-8 };
        let options = BuildOptions::DEFAULT.with_chooser(move |set| {
            for piece in 0..set.piece_count() {
                let vertices: Vec<DVec3> = set.vertices(piece).collect();
                let n = vertices.len();
                assert!(n >= 3);
                let [low, high] = [DVec3::min, DVec3::max]
                    .map(|f| vertices.iter().copied().reduce(f).expect("a vertex"));
                assert_eq!(set.bounds(piece), [low, high]);
                let normal = set.normal(piece);
                for k in 0..n {
                    let [a, b, c] = [k, k + 1, k + 2].map(|k| vertices[k % n]);
                    assert!((b - a).dot(normal).abs() < near, "off the plane");
                    assert!((b - a).cross(c - b).dot(normal) > -near, "a turn to the right");
                }
                let area =
                    vertices.windows(2).map(|e| (e[0] - vertices[0]).cross(e[1] - vertices[0]));
                assert!(area.sum::<DVec3>().dot(normal) > -near, "clockwise");
                counted.fetch_add(usize::from(set.cuts(piece) > 0), Relaxed);
            }
            any_plane(set)
        });
        let tree = match is_single {
            true => options.build(&as_f32),
            false => options.build(&boxes),
        };
        assert!(tree.expect("a tree").preparation().flattened > 0);
        enough!(cut.load(Relaxed) > 300; "{} cut pieces", cut.load(Relaxed));
    }
}

/// Planes through the middle of the set, regardless of cuts.
fn middle(set: &PieceSet<'_>) -> Option<SplitPlane> {
    let across = set.depth() % 3;
    let mut middles: Vec<f64> = (0..set.piece_count())
        .map(|piece| 0.5 * (set.bounds(piece)[0][across] + set.bounds(piece)[1][across]))
        .collect();
    middles.sort_by(f64::total_cmp);
    axis(across, middles[middles.len() / 2])
}

#[test]
fn budgets_and_cancellation_end_a_build_by_a_function() {
    let scene = scene::random_triangles(1000, 1);
    let options = BuildOptions::DEFAULT.with_chooser(middle);
    let full = options.build(scene.polygons()).expect("within budget");
    assert!(full.len() > 4000, "{}", full.len());
    for options in [
        options.clone().with_max_fragments(full.len() - 1),
        options.clone().with_max_fragments(2500),
        options.clone().with_max_depth(full.stats().depth_max - 1),
        options.clone().with_max_depth(3),
    ] {
        let error = options.build(scene.polygons()).expect_err("over budget");
        assert_eq!(error.kind(), ErrorKind::OverBudget);
    }
    for at in [1, 2, 4, 8] {
        let mut calls = 0;
        let tree = options.build_with_progress(scene.polygons(), |_| {
            calls += 1;
            if calls < at { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
        });
        assert_eq!(tree.expect_err("cancelled").kind(), ErrorKind::Cancelled);
        assert_eq!(calls, at);
    }
}

#[test]
fn a_function_that_panics_ends_its_own_build_alone() {
    let scene = scene::city(4500, 1);
    let expected = BuildOptions::DEFAULT.with_chooser(middle).build(scene.polygons());
    let expected = Snapshot::of(&expected.expect("a tree"));
    for threads in [1, 4] {
        for at in [0, 1, 40, 700] {
            let calls = Arc::new(AtomicUsize::new(0));
            let counted = calls.clone();
            let options = BuildOptions::DEFAULT.with_chooser(move |set| {
                let call = counted.fetch_add(1, Relaxed);
                assert!(call != at, "the caller's fault");
                middle(set)
            });
            let build = || with_threads(threads, || options.build(scene.polygons()));
            let panic = catch_unwind(AssertUnwindSafe(build)).expect_err("the function's panic");
            assert_eq!(*panic.downcast_ref::<&str>().expect("a message"), "the caller's fault");
            // The panic is printed before other threads are stopped, so they may call the function meanwhile.
            let after = calls.load(Relaxed);
            assert!(threads > 1 || after == at + 1, "{after} calls, panicked at {at}");
            // Later calls do not panic.
            if at == 0 || at == 700 {
                let tree = build().expect("a tree");
                assert!(Snapshot::of(&tree) == expected);
            }
        }
    }
}

#[test]
fn frames_take_the_function_and_outlive_its_panic() {
    let mut dice = Dice(5);
    let calls = Arc::new(AtomicUsize::new(0));
    let counted = calls.clone();
    let own = BuildOptions::DEFAULT.with_chooser(move |set| {
        assert!(counted.fetch_add(1, Relaxed) != 300, "the caller's fault");
        middle(set)
    });
    let mut builder = FrameBuilder::new(own.clone());
    let (mut panics, mut cuts) = (0, [0; 2]);
    for _ in 0..40 {
        let scene = scene(&mut dice, 24);
        let build = || builder.build(&scene).expect("a tree").clone();
        match catch_unwind(AssertUnwindSafe(build)) {
            Ok(tree) => {
                judge(&tree, &scene).expect("an exact tree");
                let fresh = FrameBuilder::new(own.clone()).build(&scene).expect("a tree").clone();
                assert_eq!(Snapshot::of(&tree), Snapshot::of(&fresh));
                cuts[0] += tree.len() - tree.faces().len();
                let auto = BspTree::build(&scene).expect("a tree");
                cuts[1] += auto.len() - auto.faces().len();
            }
            Err(_) => {
                assert!(builder.tree().is_empty(), "a tree of half a frame");
                panics += 1;
            }
        }
    }
    assert!(panics == 1 && cuts[0] > cuts[1], "{panics} {cuts:?}");
}

#[test]
fn cells_take_the_function() {
    let scene = scene::random_triangles(200, 6);
    let polygons: Vec<Corners> =
        scene.polygons().map(|polygon| polygon.points().to_vec()).collect();
    let mut extent = binspace::partition::Extent::default();
    polygons.iter().for_each(|polygon| extent.include(polygon));
    let options = BuildOptions::DEFAULT.with_chooser(middle);
    let corners = polygons.iter().map(|polygon| polygon[0]);
    let partition = options.partition(&extent, corners, 5).expect("cells");
    for cell in 0..partition.cells() {
        let tree = options.build_cell(&partition, cell, &polygons).expect("a tree");
        judge::judge_cell(&tree, &polygons).expect("an exact tree");
        assert!(tree.len() > 20);
    }
}

#[test]
fn options_are_equal_if_their_functions_are_one() {
    let [one, other] = [(); 2].map(|()| BuildOptions::DEFAULT.with_chooser(|_| None));
    assert!(one == one.clone() && one != other && one != BuildOptions::DEFAULT);
    assert!(format!("{one:?}").contains("chooser"));
}
