//! Lines and points between translucent polygons, against rays in rationals.

use super::on_grid;
use super::overlay::{between, for_each_crowd, hard_shapes, place_in};
use super::sightlines::Sightlines;
use binspace::drawing::{DisplayItem, Drawing, LineRun, Path};
use binspace::overlay::{Overlay, Shapes};
use proptest::prelude::*;
use testkit::prelude::*;
use testkit::rational::Point;
use testkit::shapes::rectangle;

/// The counts of comparisons.
#[derive(Debug, Default)]
struct Score {
    /// Paths painted before points of lines, and paths painted after them.
    below: usize,
    above: usize,
    marker_below: usize,
    marker_above: usize,
    runs: usize,
    segments: usize,
}

/// Outlines nearer to a point than this, in pixels, are not compared.
const NEAR: f64 = 0.01;

/// The value of `through` for scenes whose corners may be nearer to each other than rounding errors. There,
/// no outline can be classified.
const UNTOLD: f64 = -1.0;

/// Whether a path covers a point, with its inside or with an outline no further than `through`. `None` if an
/// outline is further than `through`, but too near to decide.
pub(crate) fn covers(path: &Path<'_>, [x, y]: [f64; 2], through: f64) -> Option<bool> {
    let (mut winding, mut nearest) = (0, f64::INFINITY);
    for outline in path.outlines() {
        for (i, a) in outline.iter().enumerate() {
            let b = outline[(i + 1) % outline.len()];
            let way = [b[0] - a[0], b[1] - a[1]];
            let square = way[0] * way[0] + way[1] * way[1];
            let along = ((x - a[0]) * way[0] + (y - a[1]) * way[1]) / square.max(1e-300);
            let share = along.clamp(0.0, 1.0);
            let off = [a[0] + way[0] * share - x, a[1] + way[1] * share - y];
            nearest = nearest.min(off[0].hypot(off[1]));
            let side = way[0] * (y - a[1]) - way[1] * (x - a[0]);
            if a[1] <= y && y < b[1] && side > 0.0 {
                winding += 1;
            } else if b[1] <= y && y < a[1] && side < 0.0 {
                winding -= 1;
            }
        }
    }
    let is_on_outline = nearest <= through;
    (is_on_outline || nearest >= NEAR).then_some(is_on_outline || winding != 0)
}

/// Judges the order of a drawing at some points of each part of its lines, and at its points. For `through`,
/// see `covers`.
fn check(
    tree: &BspTree,
    camera: &Camera,
    lines: &[Vec<DVec3>],
    points: &[DVec3],
    (dice, each, through): (&mut Dice, usize, f64),
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
    let lattice = *tree.faces().lattice();
    let snap = |point: DVec3| rational::point(lattice.snap(point));
    let drawing =
        Drawing::translucent(tree, camera, &ViewOptions::DEFAULT, Some(&overlay)).map_err(text)?;
    let paths: Vec<Path<'_>> = drawing.paths().collect();
    // The number of paths that must come before a point, and the number that must not.
    let judge = |point: &Point, at: [f64; 2], below: usize| -> Result<[usize; 2], String> {
        let before = sightlines.polygons_before(point);
        let mut judged = [0; 2];
        for (number, path) in paths.iter().enumerate() {
            // One face of a bent polygon may be behind a line, and another face in front of it.
            if covers(path, at, through) != Some(true)
                || sightlines.faces_of(path.polygon()).len() > 1
            {
                continue;
            }
            let is_before = before.contains(&path.polygon());
            if is_before == (number < below) {
                return Err(format!("path {number} of {path:?}, {below} at {at:?}, {camera:?}"));
            }
            judged[usize::from(is_before)] += 1;
        }
        Ok(judged)
    };
    let mut below = 0;
    let mut runs: Vec<LineRun> = vec![];
    let mut markers = 0;
    for step in drawing.display_list() {
        match step {
            DisplayItem::Path(path) => {
                assert_eq!(path.polygon(), paths[below].polygon());
                below += 1;
            }
            DisplayItem::Line(run) => {
                let ends = [run.segment, run.segment + 1].map(|k| snap(lines[run.line][k]));
                for _ in 0..each {
                    let share = dice.below(1 << 12) as f64 / f64::from(1 << 12);
                    let point: Point = between(&ends, share);
                    let Some(at) = sightlines.project(&point) else { continue };
                    if place_in(run.ends, at) == Some(true) {
                        let judged = judge(&point, at, below)?;
                        score.below += judged[0];
                        score.above += judged[1];
                    }
                }
                runs.push(run);
            }
            DisplayItem::Marker(marker) => {
                let judged = judge(&snap(points[marker.point]), marker.position, below)?;
                score.marker_below += judged[0];
                score.marker_above += judged[1];
                markers += 1;
            }
            _ => unreachable!(),
        }
    }
    assert_eq!(below, paths.len());
    // All visible parts of lines and points are drawn.
    let map = tree.visibility(camera, &ViewOptions::DEFAULT).map_err(text)?;
    assert_eq!(map.markers(&overlay).map_err(text)?.len(), markers);
    let length = |runs: &[LineRun]| -> f64 {
        runs.iter()
            .map(|run| (run.ends[1][0] - run.ends[0][0]).hypot(run.ends[1][1] - run.ends[0][1]))
            .sum()
    };
    let all = map.lines(&overlay, Hidden::Keep).map_err(text)?;
    let [expected, found] = [length(&all), length(&runs)];
    if (expected - found).abs() > 1e-4 {
        return Err(format!("{found} pixels of lines, not {expected}, {camera:?}"));
    }
    let mut names: Vec<(usize, usize)> = all.iter().map(|run| (run.line, run.segment)).collect();
    names.dedup();
    score.segments += names.len();
    score.runs += runs.len();
    Ok(())
}

/// A line through three walls, one behind another, is in four parts. A line in front of the walls, on the
/// first, between two or behind all is in one part. If the line goes through the planes of two walls beyond
/// their edges, it is cut only by the third wall.
#[test]
fn a_line_is_cut_only_where_it_goes_through() {
    let walls = [-1.0, 0.0, 1.0].map(|z| rectangle([-2.0, -2.0], [2.0, 2.0], z));
    let options = BuildOptions::DEFAULT.with_bounds(DVec3::splat(-9.0), DVec3::splat(9.0));
    let tree = options.build(walls).unwrap();
    let camera = Camera::parallel(DVec3::NEG_Z, DVec3::Y, DVec3::ZERO, 8.0, [80, 80]).unwrap();
    for (line, expected) in [
        ([[-3.0, 0.0, 3.0], [3.0, 0.0, 3.0]], &[3][..]),
        ([[-3.0, 0.0, 1.0], [3.0, 0.0, 1.0]], &[3]),
        ([[-3.0, 0.0, 0.5], [3.0, 0.0, 0.5]], &[2]),
        ([[-3.0, 0.0, 0.0], [3.0, 0.0, 0.0]], &[2]),
        ([[-3.0, 0.0, -2.0], [3.0, 0.0, -2.0]], &[0]),
        ([[-1.9, 0.0, -1.9], [1.9, 0.0, 1.9]], &[0, 1, 2, 3]),
        // The line passes the other two walls beyond their edges.
        ([[-7.0, 0.0, -3.5], [1.0, 0.0, 0.5]], &[1, 2]),
    ] {
        let mut overlay = Overlay::new(&tree);
        overlay
            .replace_with(&tree, Shapes::NONE.with_lines([line]).with_points([line[0]]))
            .unwrap();
        let drawing =
            Drawing::translucent(&tree, &camera, &ViewOptions::DEFAULT, Some(&overlay)).unwrap();
        let (mut paths, mut found) = (0, vec![]);
        for step in drawing.display_list() {
            match step {
                DisplayItem::Path(path) => {
                    assert_eq!(path.polygon(), paths);
                    paths += 1;
                }
                DisplayItem::Line(run) => {
                    assert_eq!((run.line, run.segment), (0, 0));
                    found.push(paths);
                }
                _ => {}
            }
        }
        assert_eq!(found, expected, "{line:?}");
    }
}

/// Two squares are side by side in the picture, on both sides of a wall that is seen edge-on. A line and a
/// point are on their common border: one square is behind both, and the other is in front. Nothing else
/// requires that the square behind comes first.
#[test]
fn lines_and_points_come_between_polygons_that_touch() {
    let camera = Camera::parallel(DVec3::NEG_Z, DVec3::Y, DVec3::ZERO, 8.0, [80, 80]).unwrap();
    let wall = [[-2.0, -2.0], [-2.0, 2.0], [2.0, 2.0], [2.0, -2.0]].map(|[y, z]| [0.0, y, z]);
    let wall: Vec<DVec3> = wall.map(DVec3::from).to_vec();
    let (mut score, mut dice) = (Score::default(), Dice(1));
    for [left, right] in [[-1.0, 1.0], [1.0, -1.0]] {
        let left = rectangle([-2.0, -2.0], [0.0, 2.0], left);
        let right = rectangle([0.0, -2.0], [2.0, 2.0], right);
        let squares = [wall.clone(), left, right];
        for (heuristic, y) in
            Heuristic::ALL.iter().zip([[-2.0, 2.0], [-1.0, 1.0], [1.5, -3.0]].iter().cycle())
        {
            let tree = BuildOptions::DEFAULT.with_heuristic(*heuristic).build(&squares).unwrap();
            let line = y.map(|y| DVec3::new(0.0, y, 0.0));
            let (lines, points) = ([line.to_vec()], [DVec3::ZERO]);
            check(&tree, &camera, &lines, &[], (&mut dice, 20, 1e-9), &mut score).unwrap();
            check(&tree, &camera, &[], &points, (&mut dice, 20, 1e-9), &mut score).unwrap();
        }
    }
    let trees = 2 * Heuristic::ALL.len();
    assert_eq!([score.marker_below, score.marker_above, score.runs, score.segments], [trees; 4]);
    enough!(score.below > 12 * trees, score.above > 12 * trees; "{score:?}");
}

/// All edges of three of the polygons lie on one line of the picture, and polygons are cut along it. One
/// polygon has a piece on each side that is painted before the line. These pieces must not be joined with
/// pieces that are painted after it.
#[test]
fn lines_come_between_pieces_that_were_cut_along_them() {
    let polygons = [
        vec![[-3.0, 3.0, 0.0], [1.0, 1.0, -1.0], [-1.0, -2.0, -1.0]],
        vec![[1.0, 1.0, -1.0], [-1.0, 1.0, -1.0], [-3.0, 3.0, 0.0]],
        vec![[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [1.0, 1.0, -1.0], [-1.0, 1.0, -1.0]],
        vec![[0.0, 4.0, 1.0], [-3.0, -2.0, 1.0], [1.0, 2.0, -1.0], [6.0, 4.0, -5.0]],
    ];
    let (eye, direction) = (DVec3::new(-2.0, 8.0, 5.0), DVec3::new(3.0, -7.0, -7.0));
    let camera =
        Camera::perspective_by_slope(eye, eye + direction, DVec3::Y, 0.3, [40, 60]).unwrap();
    let line = [[0.0, 4.0, 1.0], [-1.0, -2.0, -1.0]].map(DVec3::from).to_vec();
    let (mut score, mut dice) = (Score::default(), Dice(1));
    for heuristic in Heuristic::ALL {
        let tree = BuildOptions::DEFAULT.with_heuristic(*heuristic).build(&polygons).unwrap();
        check(&tree, &camera, std::slice::from_ref(&line), &[], (&mut dice, 200, 1e-7), &mut score)
            .unwrap();
    }
    enough!(score.below > 20, score.above > 20; "{score:?}");
}

#[test]
fn lines_come_between_hard_polygons() {
    let cases = (hard::scene(), any::<u64>());
    let score = tally(file!(), 64, cases, |score: &mut Score, (scene, seed)| {
        let mut dice = Dice(seed);
        let Some([low, high]) = scene.bounds() else { return Ok(()) };
        let (middle, reach) = ((low + high) * 0.5, (high - low).max_element() * 4.0);
        let options = BuildOptions::DEFAULT.with_tolerance(0.0);
        let options = options.with_bounds(middle - reach, middle + reach);
        let Ok(tree) = options.build(&scene.polygons) else { return Ok(()) };
        let off = DVec3::from([(); 3].map(|()| dice.around_zero(3)));
        let eye = middle + off * (high - low) * 0.5;
        let eye = on_grid(&tree, eye);
        let up = DVec3::new(0.1, 0.2, 0.9);
        let (lines, points) = hard_shapes(&scene.polygons, eye, &mut dice);
        let at = Camera::perspective(eye, middle, up, 1.0, [96, 72]);
        let direction = DVec3::from([(); 3].map(|()| dice.around_zero(2)));
        let along = Camera::parallel(direction, up, middle, reach, [96, 72]);
        for camera in [at, along].into_iter().flatten() {
            let result = check(&tree, &camera, &lines, &points, (&mut dice, 3, UNTOLD), score);
            result.map_err(fail)?;
        }
        Ok(())
    });
    enough!(score.below > 1000, score.above > 1000; "{score:?}");
    enough!(score.marker_below > 120, score.marker_above > 120; "{score:?}");
}

#[test]
fn lines_come_between_triangles() {
    let mut score = Score::default();
    for_each_crowd(6, |tree, camera, lines, points, dice| {
        check(tree, camera, lines, points, (dice, 15, UNTOLD), &mut score).unwrap();
    });
    enough!(score.below > 500, score.above > 1000; "{score:?}");
    enough!(score.marker_below > 20, score.marker_above > 40; "{score:?}");
    // Most segments pass several triangles, and are cut fewer times.
    assert!(score.runs > score.segments && score.runs < 4 * score.segments, "{score:?}");
}
