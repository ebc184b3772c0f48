//! Triangulations compared with their outlines, piece by piece, and with counted steps.

mod shapes;

use std::collections::BTreeMap;
use std::ops::ControlFlow;

use super::sweep::{Point, area, turn};
use super::{PATIENCE, Triangulation, diagonal, in_plane};
use crate::progress::{PIECES_AT_ONCE, PULSE, Watch};
use crate::random::SplitMix64;
use shapes::{Family, large, random_points, simple};

fn run(corners: &[Point]) -> Triangulation {
    in_plane(corners, &Watch::default()).expect("memory")
}

/// The number of steps of a triangulation.
fn steps(corners: &[Point]) -> (Triangulation, usize) {
    let callback = |_: &Watch<'_>| ControlFlow::Continue(());
    let watch = Watch::new(&callback);
    let found = in_plane(corners, &watch).expect("memory");
    (found, watch.examined())
}

fn twice_area(corners: &[Point]) -> i128 {
    corners.windows(2).map(|pair| area(corners[0], pair[0], pair[1])).sum()
}

fn triangles<'a>(
    corners: &'a [Point],
    found: &'a Triangulation,
) -> impl Iterator<Item = [Point; 3]> + 'a {
    found.triangles.iter().map(|triple| triple.map(|k| corners[k as usize]))
}

/// Divides closed lines at all points on them. For each part, counts how often the lines traverse it, minus
/// how often in reverse. Two sets of lines with equal counts have the same winding numbers.
fn chain(points: &[Point], lines: impl Iterator<Item = [Point; 2]>) -> BTreeMap<[Point; 2], i32> {
    let mut chain = BTreeMap::new();
    for [a, b] in lines {
        let [low, high] = if a < b { [a, b] } else { [b, a] };
        let on_line = |p: &&Point| (low..=high).contains(p) && turn(low, high, **p).is_eq();
        let mut stops: Vec<Point> = points.iter().filter(on_line).copied().collect();
        stops.sort_unstable();
        stops.dedup();
        for pair in stops.windows(2) {
            *chain.entry([pair[0], pair[1]]).or_insert(0) += if a < b { 1 } else { -1 };
        }
    }
    chain.retain(|_, times| *times != 0);
    chain
}

fn outline(corners: &[Point]) -> impl Iterator<Item = [Point; 2]> {
    (0..corners.len()).map(|k| [corners[k], corners[(k + 1) % corners.len()]])
}

/// The triangles cover every point with a winding number other than 0, once, and nothing else.
fn covers(corners: &[Point], found: &Triangulation) -> Result<(), String> {
    if triangles(corners, found).any(|[a, b, c]| turn(a, b, c).is_le()) {
        return Err("a triangle is clockwise, or has no area".into());
    }
    let edges = triangles(corners, found).flat_map(|[a, b, c]| [[a, b], [b, c], [c, a]]);
    let mut covered = chain(corners, edges);
    if twice_area(corners) < 0 {
        covered.values_mut().for_each(|times| *times = -*times);
    }
    if covered == chain(corners, outline(corners)) {
        Ok(())
    } else {
        Err("the triangles' sides do not add up to the outline".into())
    }
}

fn assert_covers(corners: &[Point]) {
    let found = run(corners);
    assert!(!found.crosses_itself, "{corners:?}");
    covers(corners, &found).unwrap_or_else(|fault| panic!("{fault}: {corners:?}\n{found:?}"));
}

fn in_all_ways(corners: &[Point], mut check: impl FnMut(&[Point])) {
    let n = corners.len();
    for turn in 0..4 {
        let turned = corners.iter().map(|&[x, y]| match turn {
            0 => [x, y],
            1 => [-y, x],
            2 => [-x, -y],
            _ => [y, -x],
        });
        let mut polygon: Vec<Point> = turned.collect();
        for _ in 0..2 {
            check(&polygon);
            polygon.rotate_left(n / 3);
            polygon.reverse();
        }
    }
}

#[test]
fn simple_polygons_are_covered() {
    let mut random = SplitMix64::new(1);
    for round in 0..60 {
        for shape in Family::ALL {
            let corners = simple(shape, 4 + round * 2, &mut random);
            in_all_ways(&corners, assert_covers);
        }
    }
}

#[test]
fn a_hole_at_the_end_of_a_bridge_stays_a_hole() {
    let square = [[0, 0], [9, 0], [9, 9], [0, 9]];
    let hole = [[3, 3], [3, 6], [6, 6], [6, 3], [3, 3]];
    let small = [[7, 7], [7, 8], [8, 8], [8, 7], [7, 7]];
    // From a corner, from two corners, and along the same bridge.
    let keyhole = [&square[..1], &hole, &square].concat();
    let two = [&square[..1], &hole, &square[..3], &small, &square[2..]].concat();
    let row = [&square[..1], &hole[..3], &small, &hole[2..], &square].concat();
    for (corners, twice) in [(&keyhole, 144), (&two, 142), (&row, 142)] {
        assert_eq!(twice_area(corners), twice);
        in_all_ways(corners, assert_covers);
        // Far from the origin, where products use all their bits.
        let far = corners.iter().map(|p| p.map(|c| (c - 4) * (1 << 51) / 5)).collect::<Vec<_>>();
        in_all_ways(&far, assert_covers);
    }
}

#[test]
fn outlines_that_touch_themselves_are_covered() {
    let corner_on_side = [[0, 0], [8, 0], [8, 4], [4, 0], [0, 4]];
    let two_rooms = [
        [0, 0],
        [2, 0],
        [2, 2],
        [4, 2],
        [4, 0],
        [6, 0],
        [6, 4],
        [4, 4],
        [4, 2],
        [2, 2],
        [2, 4],
        [0, 4],
    ];
    let spur = [[0, 0], [6, 0], [6, 3], [9, 3], [6, 3], [6, 6], [3, 6], [3, 2], [3, 6], [0, 6]];
    let back_along_a_side = [[0, 0], [4, 0], [8, 0], [6, 0], [6, 4], [0, 4]];
    let petals = [[0, 0], [4, 1], [4, 2], [0, 0], [2, 4], [1, 4], [0, 0], [-3, 3], [-4, 2]];
    let sides_in_a_row =
        [[0, 0], [1, 0], [2, 0], [3, 0], [3, 1], [3, 2], [2, 2], [1, 2], [0, 2], [0, 1]];
    let shapes: [&[Point]; 6] =
        [&corner_on_side, &two_rooms, &spur, &back_along_a_side, &petals, &sides_in_a_row];
    for corners in shapes {
        in_all_ways(corners, assert_covers);
    }
}

#[test]
fn areas_wound_twice_are_covered_once_and_reported() {
    let square = [[0, 0], [4, 0], [4, 4], [0, 4]];
    for times in 2..5 {
        in_all_ways(&square.repeat(times), |corners| {
            let found = run(corners);
            assert!(found.crosses_itself);
            assert_eq!(found.triangles.len(), 2);
            assert_eq!(triangles(corners, &found).map(|[a, b, c]| area(a, b, c)).sum::<i128>(), 32);
        });
    }
}

/// Whether two sides cross between their ends.
fn sides_cross(corners: &[Point]) -> bool {
    let sides: Vec<_> = outline(corners).collect();
    let apart = |[a, b]: [Point; 2], [c, d]: [Point; 2]| {
        let [c, d] = [c, d].map(|p| turn(a, b, p) as i32);
        c * d < 0
    };
    sides.iter().any(|&s| sides.iter().any(|&t| apart(s, t) && apart(t, s)))
}

/// The winding number of an outline around the middle of a triangle.
fn winding(corners: &[Point], triangle: [Point; 3]) -> i32 {
    let middle: Point = [0, 1].map(|axis| triangle.iter().map(|p| p[axis]).sum());
    let sides = outline(corners).map(|side| side.map(|p| p.map(|c| 3 * c)));
    let around = sides.map(|[a, b]| match (a[1] <= middle[1], b[1] <= middle[1]) {
        (true, false) => i32::from(turn(a, b, middle).is_gt()),
        (false, true) => -i32::from(turn(a, b, middle).is_lt()),
        _ => 0,
    });
    around.sum()
}

/// Corners on a small grid: they touch, repeat and overlap in every way.
#[test]
fn polygons_on_a_small_grid_are_covered_or_reported_as_crossing() {
    let mut random = SplitMix64::new(2);
    let mut counts = [0; 3];
    for round in 0..60_000 {
        let n = 3 + round % 8;
        let size = 2 + round / 8 % 4;
        let corners = random_points(n, size as i64, &mut random);
        let found = run(&corners);
        assert!(triangles(&corners, &found).all(|[a, b, c]| turn(a, b, c).is_gt()));
        if !found.crosses_itself {
            counts[0] += usize::from(!found.triangles.is_empty());
            covers(&corners, &found).unwrap_or_else(|fault| panic!("{fault}: {corners:?}"));
            continue;
        }
        if sides_cross(&corners) {
            counts[1] += 1;
            continue;
        }
        counts[2] += 1;
        // The triangles are disjoint, so the covered area is the sum of the areas of some triangles.
        let windings =
            triangles(&corners, &found).map(|t| winding(&corners, t)).collect::<Vec<_>>();
        assert!(windings.iter().all(|&times| times != 0), "{corners:?}");
        assert!(windings.iter().any(|&times| times != windings[0] || times.abs() > 1));
    }
    assert!(counts.iter().all(|&count| count > 1000), "{counts:?}");
}

/// Outlines that do not cross themselves but have any winding numbers. The triangles, each repeated as often
/// as the outline winds around it, add up to the outline.
#[test]
fn areas_with_any_nonzero_winding_are_covered_once() {
    let mut random = SplitMix64::new(3);
    let mut count = 0;
    while count < 2000 {
        let corners = random_points(9, 3, &mut random);
        let found = run(&corners);
        if !found.crosses_itself || sides_cross(&corners) {
            continue;
        }
        count += 1;
        let all: Vec<_> = triangles(&corners, &found).collect();
        let edges = all.iter().flat_map(|&[a, b, c]| {
            let times = winding(&corners, [a, b, c]);
            let sides = if times > 0 { [[a, b], [b, c], [c, a]] } else { [[b, a], [c, b], [a, c]] };
            sides.repeat(times.unsigned_abs() as usize)
        });
        assert_eq!(chain(&corners, edges), chain(&corners, outline(&corners)), "{corners:?}");
    }
}

#[test]
fn large_polygons_take_n_log_n_steps() {
    for (name, corners) in large(30_000) {
        in_all_ways(&corners, |corners| {
            let (found, steps) = steps(corners);
            assert!(!found.crosses_itself, "{name}");
            assert_eq!(found.triangles.len(), corners.len() - 2, "{name}");
            let covered: i128 = triangles(corners, &found).map(|[a, b, c]| area(a, b, c)).sum();
            assert_eq!(covered, twice_area(corners).abs(), "{name}");
            assert!(steps < 4 * corners.len() * corners.len().ilog2() as usize, "{name}: {steps}");
        });
    }
}

#[test]
fn polygons_that_cross_themselves_come_to_an_end() {
    let mut random = SplitMix64::new(4);
    for n in [4, 5, 6, 10, 30, 100, 1000, 10_000] {
        for size in [n as i64 / 2 + 2, 1 << 20, 1 << 51] {
            let corners = random_points(n, size, &mut random);
            let (found, steps) = steps(&corners);
            assert!(!found.triangles.is_empty() && found.triangles.len() < 8 * n);
            assert!(triangles(&corners, &found).all(|[a, b, c]| turn(a, b, c).is_gt()));
            let budget = PATIENCE.max(n * 16);
            assert!(steps < 8 * budget * (2 * n).ilog2() as usize, "{n}: {steps} steps");
        }
    }
}

/// A few crossings change only their neighbourhood. In a spiral, two exchanged corners reach across all arms
/// of the spiral.
#[test]
fn a_loop_in_a_large_outline_is_a_small_fault() {
    let mut count = 0;
    let outlines = large(10_000).into_iter().filter(|(name, _)| !name.contains("spiral"));
    for (name, corners) in outlines {
        let whole = twice_area(&corners).abs();
        let before = run(&corners).triangles.len();
        for at in [1000, 2501, 5000, 7777] {
            let mut corners = corners.clone();
            corners.swap(at, at + 1);
            let found = run(&corners);
            if !found.crosses_itself {
                continue;
            }
            count += 1;
            let covered: i128 = triangles(&corners, &found).map(|[a, b, c]| area(a, b, c)).sum();
            assert!((covered - whole).abs() * 10 < whole, "{name}: {covered} of {whole}");
            assert!(found.triangles.len() + 4 > before, "{name}");
        }
    }
    assert!(count > 3, "{count} outlines cross themselves");
}

/// One of the two ways to join the ends would halve the square.
#[test]
fn sides_that_cross_near_their_ends_are_joined_there() {
    let square = [[0, 0], [1000, 0], [1000, 1000], [-5, 995], [-5, 1005]];
    in_all_ways(&square, |corners| {
        let found = run(corners);
        assert!(found.crosses_itself);
        let covered: i128 = triangles(corners, &found).map(|[a, b, c]| area(a, b, c)).sum();
        assert!((covered - 2_000_000).abs() < 40_000, "{covered}");
    });
}

#[test]
fn one_polygon_polls_for_cancellation() {
    for (name, corners) in large(50_000) {
        let (_, all) = steps(&corners);
        // Otherwise a run that is never cancelled would pass.
        assert!(all * 3 > 8 * (PULSE + 2 * PIECES_AT_ONCE), "{name}: {all}");
        for share in [0, 1, 3, 5] {
            let callback = |watch: &Watch<'_>| match watch.examined() * 8 > all * share {
                true => ControlFlow::Break(()),
                false => ControlFlow::Continue(()),
            };
            let watch = Watch::new(&callback);
            let stopped = in_plane(&corners, &watch);
            assert!(
                stopped.is_err_and(|error| error.kind() == crate::ErrorKind::Cancelled),
                "{name}"
            );
            assert!(
                watch.examined() * 8 < all * share + 8 * (PULSE + 2 * PIECES_AT_ONCE),
                "{name}"
            );
        }
    }
}

#[test]
fn an_outline_through_one_point_again_and_again_ends_as_fast() {
    // Petals that meet in the middle; one petal contains a triangle.
    let petal = |k: i64| [[0, 0], [1 << 20, 16 * k], [1 << 20, 16 * k + 8]];
    let corners: Vec<Point> = (0..30_000).flat_map(petal).collect();
    in_all_ways(&corners, |corners| {
        let (found, steps) = steps(corners);
        assert!(!found.crosses_itself);
        assert_eq!(found.triangles.len(), corners.len() / 3);
        assert!(steps < 4 * corners.len() * 17, "{steps}");
    });
    // To a point on one line and back, further each time.
    let row: Vec<Point> = (1..30_000).flat_map(|k| [[0, 0], [k, 0]]).chain([[5, 5]]).collect();
    in_all_ways(&row, |corners| {
        let (found, steps) = steps(corners);
        assert!(!found.crosses_itself);
        assert_eq!(found.triangles.len(), 29_999);
        assert!(steps < 4 * corners.len() * 17, "{steps}");
    });
}

/// The outline crosses itself in the projection along its main axis, but not along z.
#[test]
fn bent_polygons_keep_their_edges_if_any_projection_is_simple() {
    let polygon = [[0, 0, 0], [1, 0, 0], [2, 0, 3], [2, 1, 6], [1, 1, -6], [0, 1, -5]];
    let polygon = polygon.map(|corner: [i32; 3]| corner.map(f64::from));
    let tree = crate::BuildOptions::DEFAULT.build([polygon]).expect("valid");
    let mut edges: Vec<i32> = tree.arrays().expect("memory").edges;
    edges.retain(|&edge| edge >= 0);
    edges.sort_unstable();
    edges.dedup();
    assert_eq!(edges, [0, 1, 2, 3, 4, 5]);
    assert_eq!(tree.preparation().crossing, 0);
}

/// Compared with all pairs of corners. A large outline is divided near its middle.
#[test]
fn outlines_are_divided_by_their_shortest_diagonal() {
    let mut random = SplitMix64::new(7);
    for n in (5..90).chain([1000, 1001, 10_000]) {
        let corners: Vec<[f64; 3]> =
            (0..n).map(|_| random.point(-1e6, 1e6).round().to_array()).collect();
        let square = |[a, b]: [usize; 2]| -> i128 {
            (0..3).map(|i| (corners[a][i] as i128 - corners[b][i] as i128).pow(2)).sum()
        };
        let [a, b] = diagonal(&corners);
        let (low, high) = (a.min(b), a.max(b));
        let steps = (high - low).min(n - (high - low));
        if n > 90 {
            assert!(steps + 1 + 4096 / n >= n / 2, "{n}: {steps}");
            continue;
        }
        let pairs = (0..n).flat_map(|a| (a + 2..n).map(move |b| [a, b]));
        let diagonals = pairs.filter(|&[a, b]| b - a < n - 1);
        assert_eq!(diagonals.map(square).min(), Some(square([a, b])), "{n}");
        assert!(steps > 1, "{n}");
    }
}
