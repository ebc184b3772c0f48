//! Lines and points of an overlay in a picture, by hand and against rays in rationals.

use super::map_of;
use super::on_grid;
use super::sightlines::Sightlines;
use binspace::drawing::{LineRun, MarkerView};
use binspace::overlay::{Overlay, Shapes};
use proptest::prelude::*;
use testkit::prelude::*;
use testkit::rational::Point;
use testkit::scenes::triangles;
use testkit::shapes::rectangle;

/// The counts of comparisons.
#[derive(Debug, Default)]
struct Score {
    pictures: usize,
    visible: usize,
    hidden: usize,
    /// Points hidden by more than one polygon.
    deeper: usize,
    runs: usize,
    shown_points: usize,
    hidden_points: usize,
    /// Points too near to the end of a run.
    unsure: usize,
}

/// Places nearer to the end of a run than this, in pixels, are not judged: rays are rounded by up to a
/// thousandth of a pixel.
const NEAR: f64 = 2.1e-3;

/// Compares a map's lines and points with the polygons that hide them, at a number of points of each run.
fn check(
    tree: &BspTree,
    camera: &Camera,
    lines: &[Vec<DVec3>],
    points: &[DVec3],
    (dice, each): (&mut Dice, usize),
    score: &mut Score,
) -> Result<(), String> {
    let text = |error: binspace::Error| error.to_string();
    let mut overlay = Overlay::new(tree);
    let shapes = Shapes::NONE.with_lines(lines).with_points(points.iter().copied());
    overlay.replace_with(tree, shapes).map_err(text)?;
    if Rays::new(camera, tree.faces()).is_err() {
        return Ok(());
    }
    let Some(sightlines) = Sightlines::of(tree, camera) else { return Ok(()) };
    let map = tree.visibility(camera, &ViewOptions::DEFAULT).map_err(text)?;
    let lattice = *tree.faces().lattice();
    let snap = |point: DVec3| rational::point(lattice.snap(point));
    let runs = map.lines(&overlay, Hidden::Keep).map_err(text)?;
    score.pictures += 1;
    for run in map.lines(&overlay, Hidden::Count).map_err(text)? {
        let ends = [run.segment, run.segment + 1].map(|k| snap(lines[run.line][k]));
        for _ in 0..each {
            // Not where borders of polygons with integer corners may meet: one may end where another begins.
            let share = (dice.below(1 << 12) as f64 + 0.37) / f64::from(1 << 12);
            let point: Point = between(&ends, share);
            let Some(at) = sightlines.project(&point) else { continue };
            match place_in(run.ends, at) {
                Some(true) => {}
                Some(false) => {
                    score.unsure += 1;
                    continue;
                }
                None => continue,
            }
            let hiding = sightlines.polygons_before(&point);
            if Some(hiding.len() as u32) != run.layers || run.is_visible != hiding.is_empty() {
                return Err(format!("{run:?} at {share}, {at:?}: {hiding:?}, {camera:?}"));
            }
            *if run.is_visible { &mut score.visible } else { &mut score.hidden } += 1;
            score.deeper += usize::from(hiding.len() > 1);
        }
    }
    score.runs += runs.len();
    check_tiling(&runs)?;
    for MarkerView { point, position: at, is_visible, .. } in map.markers(&overlay).map_err(text)? {
        let exact = snap(points[point]);
        let projected = sightlines.project(&exact).expect("ahead of the eye");
        if (0..2).any(|i| (projected[i] - at[i]).abs() > 1.1e-3) {
            return Err(format!("point {point}: {at:?}, not {projected:?}, {camera:?}"));
        }
        let hiding = sightlines.polygons_before(&exact);
        if hiding.is_empty() != is_visible {
            return Err(format!("point {point} at {at:?}: {hiding:?}, {camera:?}"));
        }
        *if is_visible { &mut score.shown_points } else { &mut score.hidden_points } += 1;
    }
    Ok(())
}

/// Each run of a segment begins where the previous run ends, and visible and hidden runs alternate.
fn check_tiling(runs: &[LineRun]) -> Result<(), String> {
    for pair in runs.windows(2) {
        let [before, run] = [pair[0], pair[1]];
        if (before.line, before.segment) > (run.line, run.segment) {
            return Err(format!("{run:?} after {before:?}"));
        }
        let goes_on = (before.line, before.segment) == (run.line, run.segment);
        if goes_on && (before.ends[1] != run.ends[0] || before.is_visible == run.is_visible) {
            return Err(format!("{run:?} after {before:?}"));
        }
    }
    Ok(())
}

pub(crate) fn between([a, b]: &[Point; 2], share: f64) -> Point {
    let share = rational::exact(share);
    std::array::from_fn(|i| &a[i] + (&b[i] - &a[i]) * &share)
}

/// Whether a point is well inside a run; `None` if it is outside the run.
pub(crate) fn place_in(ends: [[f64; 2]; 2], at: [f64; 2]) -> Option<bool> {
    let way = [0, 1].map(|i: usize| ends[1][i] - ends[0][i]);
    let arm = [0, 1].map(|i: usize| at[i] - ends[0][i]);
    let length = way[0].hypot(way[1]);
    let place = (arm[0] * way[0] + arm[1] * way[1]) / length;
    let inside = place.min(length - place);
    (inside > -NEAR).then_some(inside > NEAR)
}

/// The runs of one line over polygons, seen from above with ten pixels per unit: the length of each run along
/// x, and whether it is visible.
fn from_above(polygons: &[Vec<DVec3>], line: &[[f64; 3]]) -> Vec<(f64, bool)> {
    let tree = BuildOptions::DEFAULT.with_bounds(DVec3::splat(-9.0), DVec3::splat(9.0));
    let tree = tree.with_tolerance(0.0).build(polygons).unwrap();
    let camera = Camera::parallel(DVec3::NEG_Z, DVec3::Y, DVec3::ZERO, 8.0, [80, 80]).unwrap();
    let mut overlay = Overlay::new(&tree);
    overlay.replace_with(&tree, Shapes::NONE.with_lines([line])).unwrap();
    let map = map_of(&tree, &camera);
    let runs = map.lines(&overlay, Hidden::Keep).unwrap();
    let rounded = |x: f64| (x * 1e6).round() / 1e6;
    runs.iter()
        .map(|run| (rounded((run.ends[1][0] - run.ends[0][0]) / 10.0), run.is_visible))
        .collect()
}

#[test]
fn lines_are_seen_on_polygons_and_hidden_behind_them() {
    let wall = rectangle([-1.0, -1.0], [1.0, 1.0], 0.0);
    let one = |line: &[[f64; 3]]| from_above(std::slice::from_ref(&wall), line);
    // A line on the wall, above the wall, and below the wall.
    assert_eq!(one(&[[-2.0, 0.0, 0.0], [2.0, 0.0, 0.0]]), [(4.0, true)]);
    assert_eq!(one(&[[-2.0, 0.0, 1.0], [2.0, 0.0, 1.0]]), [(4.0, true)]);
    let behind = [(1.0, true), (2.0, false), (1.0, true)];
    assert_eq!(one(&[[-2.0, 0.0, -1.0], [2.0, 0.0, -1.0]]), behind);
    // A line through the wall, and lines that end on the wall from either side.
    assert_eq!(
        one(&[[-2.0, 0.0, -2.0], [2.0, 0.0, 2.0]]),
        [(1.0, true), (1.0, false), (2.0, true)]
    );
    assert_eq!(one(&[[-2.0, 0.0, -2.0], [0.0, 0.0, 0.0]]), [(1.0, true), (1.0, false)]);
    assert_eq!(one(&[[-2.0, 0.0, 2.0], [0.0, 0.0, 0.0]]), [(2.0, true)]);
    // A line on an edge of the wall, a line below the edge, which the edge hides, and a line below a corner.
    assert_eq!(one(&[[-2.0, 1.0, 0.0], [2.0, 1.0, 0.0]]), [(4.0, true)]);
    assert_eq!(one(&[[-2.0, 1.0, -1.0], [2.0, 1.0, -1.0]]), behind);
    assert_eq!(one(&[[0.0, 2.0, -1.0], [2.0, 0.0, -1.0]]), [(2.0, true)]);
    // The line goes through the edge, in one point.
    assert_eq!(
        one(&[[-2.0, 1.0, -1.0], [2.0, 1.0, 1.0]]),
        [(1.0, true), (1.0, false), (2.0, true)]
    );
    // A line with a vertical segment, and a line that is seen end-on.
    let bent = [[-2.0, 0.0, 1.0], [0.0, 0.0, 1.0], [0.0, 0.0, -1.0], [3.0, 0.0, -1.0]];
    assert_eq!(one(&bent), [(2.0, true), (1.0, false), (2.0, true)]);
    assert_eq!(one(&[[0.0, 0.0, 5.0], [0.0, 0.0, -5.0]]), []);
}

/// There is no crack where two walls meet. A line along the corner of a room is visible on both walls.
#[test]
fn lines_in_cracks_and_corners() {
    let halves =
        [rectangle([-1.0, -1.0], [1.0, 0.0], 0.0), rectangle([-1.0, 0.0], [1.0, 1.0], 0.0)];
    let line = [[-2.0, 0.0, -1.0], [2.0, 0.0, -1.0]];
    assert_eq!(from_above(&halves, &line), [(1.0, true), (2.0, false), (1.0, true)]);
    // A valley whose upper edges are nearest to the eye, in every input order of its sides and a wall through
    // it.
    let [left, right] = [-1.0, 1.0].map(|y| {
        let side = [[-1.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, y, 1.0], [-1.0, y, 1.0]];
        side.map(DVec3::from).to_vec()
    });
    let wall = [[-1.0, 0.0, -3.0], [1.0, 0.0, -3.0], [1.0, 0.0, 0.0], [-1.0, 0.0, 0.0]];
    let wall = wall.map(DVec3::from).to_vec();
    let floor = rectangle([-3.0, -3.0], [3.0, 3.0], 0.0);
    let all = [left, right, wall, floor];
    for first in 0..4 {
        for second in 0..4 {
            let mut polygons = all.to_vec();
            polygons.swap(0, first);
            polygons.swap(1, second);
            let line = [[-2.0, 0.0, 0.0], [2.0, 0.0, 0.0]];
            assert_eq!(from_above(&polygons, &line), [(4.0, true)], "{first} {second}");
            let below = [[-2.0, 0.0, -0.5], [2.0, 0.0, -0.5]];
            assert_eq!(from_above(&polygons, &below), [(4.0, false)], "{first} {second}");
        }
    }
}

/// A line from far behind the eye, close past the eye, to far ahead is straight where it is visible.
#[test]
fn lines_across_the_eye_end_with_the_picture() {
    let wall = rectangle([-9.0, -9.0], [9.0, 9.0], -90.0);
    let bounded = BuildOptions::DEFAULT.with_bounds(DVec3::splat(-1e6), DVec3::splat(1e6));
    let tree = bounded.build([wall]).unwrap();
    let camera = Camera::perspective(DVec3::ZERO, DVec3::NEG_Z, DVec3::Y, 1.6, [200, 100]).unwrap();
    let map = map_of(&tree, &camera);
    let mut overlay = Overlay::new(&tree);
    let line = [[0.001, 0.0, 1e6], [0.001, 0.0, -1e6]];
    let behind = [[5.0, 1.0, 1.0], [-5.0, 1.0, 1.0]];
    let through = [[0.0, 0.0, 5.0], [0.0, 0.0, -50.0]];
    overlay.replace_with(&tree, Shapes::NONE.with_lines([line, behind, through])).unwrap();
    let runs = map.lines(&overlay, Hidden::Keep).unwrap();
    let [seen, hidden] = runs[..] else { panic!("{runs:?}") };
    assert!(seen.is_visible && !hidden.is_visible && seen.line == 0);
    // The line goes from the right end of the picture to the vanishing point, up to a thousandth of a pixel.
    let [_, pixel] = camera.pixel_size();
    let expected = [200.0, 100.0 + 0.001 / 90.0 / pixel, 100.0 + 0.001 / 1e6 / pixel];
    for (at, x) in [seen.ends[0], seen.ends[1], hidden.ends[1]].into_iter().zip(expected) {
        assert!((at[0] - x).abs() < 1.1e-3 && (at[1] - 50.0).abs() < 1.1e-3, "{at:?} {x}");
    }
}

#[test]
fn overlays_of_other_trees_and_polygons_are_refused() {
    let tree = BspTree::build([rectangle([-1.0, -1.0], [1.0, 1.0], 0.0)]).unwrap();
    let other = BspTree::build([[DVec3::ZERO, DVec3::X, DVec3::Y]]).unwrap();
    let camera = Camera::parallel(DVec3::NEG_Z, DVec3::Y, DVec3::ZERO, 8.0, [80, 80]).unwrap();
    let map = map_of(&tree, &camera);
    assert!(map.lines(&Overlay::new(&other), Hidden::Keep).is_err());
    let mut overlay = Overlay::new(&tree);
    assert_eq!(map.lines(&overlay, Hidden::Keep), Ok(vec![]));
    assert_eq!(map.markers(&overlay), Ok(vec![]));
    let line = [DVec3::ZERO, DVec3::X];
    // A polygon without area does not count.
    let polygons = [[DVec3::ZERO; 3], [DVec3::ZERO, DVec3::X * 0.5, DVec3::Y * 0.5]];
    let shapes = Shapes::NONE.with_lines([line]);
    overlay.replace_with(&tree, shapes.with_polygons(&polygons[..1])).unwrap();
    assert_eq!(map.lines(&overlay, Hidden::Keep).unwrap().len(), 1);
    overlay.replace_with(&tree, Shapes::NONE.with_polygons(polygons).with_lines([line])).unwrap();
    let error = map.lines(&overlay, Hidden::Keep).unwrap_err();
    assert!(error.polygon() == Some(1) && error.to_string().contains("polygon 1"), "{error}");
    assert_eq!(map.markers(&overlay).unwrap_err(), error);
}

/// Lines and points that are hard to decide: along and through edges, through corners, in planes, and in line
/// with the eye.
pub(crate) fn hard_shapes(
    polygons: &[Vec<DVec3>],
    eye: DVec3,
    dice: &mut Dice,
) -> (Vec<Vec<DVec3>>, Vec<DVec3>) {
    let corner = |dice: &mut Dice| {
        let polygon = &polygons[dice.below(polygons.len())];
        polygon[dice.below(polygon.len())]
    };
    let some = |dice: &mut Dice| {
        let polygon = &polygons[dice.below(polygons.len())];
        let k = dice.below(polygon.len());
        let (a, b) = (polygon[k], polygon[(k + 1) % polygon.len()]);
        match dice.below(5) {
            0 => a,
            1 => (a + b) * 0.5,
            2 => a + (b - a) * 2.0,
            3 => (a + corner(dice)) * 0.5,
            // Seen through the corner of another polygon.
            _ => eye + (a - eye) * [0.5, 2.0, 0.75, 1.5, 1.0][dice.below(5)],
        }
    };
    let lines = (0..8).map(|_| (0..2 + dice.below(2)).map(|_| some(dice)).collect());
    let lines = lines.collect();
    (lines, (0..8).map(|_| some(dice)).collect())
}

#[test]
fn hard_lines_and_points_are_hidden_as_rays_are() {
    let cases = (hard::scene(), any::<u64>());
    let score = tally(file!(), 64, cases, |score: &mut Score, (scene, seed)| {
        let mut dice = Dice(seed);
        let Some([low, high]) = scene.bounds() else { return Ok(()) };
        let (middle, size) = ((low + high) * 0.5, high - low);
        let reach = DVec3::splat(size.max_element() * 4.0);
        let options = BuildOptions::DEFAULT.with_tolerance(0.0);
        let options = options.with_bounds(middle - reach, middle + reach);
        let Ok(tree) = options.build(&scene.polygons) else { return Ok(()) };
        for _ in 0..3 {
            // Also on planes of the scene, and in the middle of the scene.
            let off = [(); 3].map(|()| dice.around_zero(3));
            let eye = middle + DVec3::from(off) * size * 0.5;
            let eye = on_grid(&tree, eye);
            let direction = DVec3::from([(); 3].map(|()| dice.around_zero(2)));
            let along =
                Camera::parallel(direction, DVec3::new(0.1, 0.2, 0.9), middle, reach.x, [48, 36]);
            let up = DVec3::new(0.1, 0.2, 0.9);
            let at = Camera::perspective(eye, middle, up, 1.0, [48, 36]);
            let (lines, points) = hard_shapes(&scene.polygons, eye, &mut dice);
            for camera in [at, along].into_iter().flatten() {
                let result = check(&tree, &camera, &lines, &points, (&mut dice, 2), score);
                result.map_err(fail)?;
            }
        }
        Ok(())
    });
    enough!(score.visible > 2500, score.hidden > 1000, score.deeper > 150; "{score:?}");
    enough!(score.shown_points > 1000, score.hidden_points > 300; "{score:?}");
}

/// Calls a function with trees of random triangles, a camera before the triangles and a camera among them,
/// and lines and points. Half of the lines and points are hard to decide.
pub(crate) fn for_each_crowd(
    seed: u64,
    mut check: impl FnMut(&BspTree, &Camera, &[Vec<DVec3>], &[DVec3], &mut Dice),
) {
    let (mut random, mut dice) = (Dice(seed), Dice(seed));
    for (count, edge) in [(40, 0.8), (150, 0.3), (300, 0.1)] {
        let triangles = triangles(&mut random, count, [-1.0, 1.0], edge);
        let exact = BuildOptions::DEFAULT.with_tolerance(0.0);
        let bounded = exact.with_bounds(DVec3::splat(-9.0), DVec3::splat(9.0));
        let tree = bounded.build(&triangles).unwrap();
        for far in [4.0, 0.5] {
            let eye = random.point(-1.0, 1.0).normalize() * far;
            let eye = on_grid(&tree, eye);
            let camera = Camera::perspective(eye, DVec3::ZERO, DVec3::Z, 0.8, [320, 240]).unwrap();
            let mut lines: Vec<Vec<DVec3>> =
                (0..20).map(|_| (0..4).map(|_| random.point(-2.0, 2.0)).collect()).collect();
            lines.extend(hard_shapes(&triangles, eye, &mut dice).0);
            let points: Vec<DVec3> = (0..40).map(|_| random.point(-1.0, 1.0)).collect();
            check(&tree, &camera, &lines, &points, &mut dice);
        }
    }
}

#[test]
fn lines_and_points_among_triangles_are_hidden_as_rays_are() {
    let mut score = Score::default();
    for_each_crowd(5, |tree, camera, lines, points, dice| {
        check(tree, camera, lines, points, (dice, 10), &mut score).unwrap();
    });
    enough!(score.visible > 1000, score.hidden > 500, score.deeper > 150; "{score:?}");
}

/// Half-transparent polygons hide neither points nor lines. Polygons of opacity 0 have no edges.
#[test]
fn lines_and_points_behind_glass_are_visible() {
    let polygons =
        [rectangle([-1.0, -1.0], [1.0, 1.0], 0.0), rectangle([-1.0, -1.0], [1.0, 1.0], 2.0)];
    let tree = BspTree::build(&polygons).unwrap();
    let mut overlay = Overlay::new(&tree);
    let line = [DVec3::new(0.0, 0.0, 1.0), DVec3::new(0.5, 0.2, 1.0)];
    let shapes = Shapes::NONE.with_lines([line]).with_points([DVec3::new(0.1, 0.1, 1.0)]);
    overlay.replace_with(&tree, shapes).unwrap();
    let eye = DVec3::new(0.1, 0.2, 9.0);
    let camera = Camera::perspective(eye, DVec3::ZERO, DVec3::Y, 0.6, [100, 100]).unwrap();
    for (opacity, is_visible) in [(1.0, false), (0.5, true), (0.0, true)] {
        let options = ViewOptions::DEFAULT.with_opacities(vec![1.0, opacity]);
        let map = tree.visibility(&camera, &options).unwrap();
        assert_eq!(map.markers(&overlay).unwrap()[0].is_visible, is_visible, "{opacity}");
        let lines = map.lines(&overlay, Hidden::Keep).unwrap();
        assert!(lines.iter().all(|run| run.is_visible == is_visible), "{opacity}");
        let edges = map.edges(Hidden::Keep).unwrap();
        assert_eq!(edges.iter().any(|run| run.polygon == 1), opacity > 0.0, "{opacity}");
    }
}

/// Lines under the edges of a fan, seen from above: each is hidden all along.
#[test]
fn lines_under_the_edges_of_a_fan_are_hidden() {
    let triangles: Vec<Vec<DVec3>> = (0..200)
        .map(|k| {
            let rim = |k: usize| {
                let (sin, cos) = (k as f64 * std::f64::consts::TAU / 200.0).sin_cos();
                DVec3::new(cos, sin, 1.0)
            };
            vec![DVec3::Z, rim(k), rim((k + 1) % 200)]
        })
        .collect();
    let options = BuildOptions::DEFAULT.with_bounds(DVec3::splat(-2.0), DVec3::splat(2.0));
    let tree = options.build(&triangles).unwrap();
    let mut overlay = Overlay::new(&tree);
    let lines: Vec<[DVec3; 2]> =
        triangles.iter().map(|corners| [DVec3::ZERO, corners[1] - DVec3::Z]).collect();
    overlay.replace_with(&tree, Shapes::NONE.with_lines(&lines)).unwrap();
    let camera = Camera::parallel(DVec3::NEG_Z, DVec3::Y, DVec3::ZERO, 2.2, [300, 300]).unwrap();
    let runs = map_of(&tree, &camera).lines(&overlay, Hidden::Count).unwrap();
    assert!(runs.iter().all(|run| !run.is_visible), "{runs:?}");
    assert!(runs.len() >= lines.len());
}
