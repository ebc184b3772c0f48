//! Where polygons go through one another, by hand and against rays.

use binspace::drawing::{EdgeKind, EdgeRun, VisibilityMap};
use binspace::glam::DVec3;
use binspace::raster::Rays;
use binspace::view::{Camera, views};
use binspace::{BspTree, BuildOptions, Heuristic, Viewpoint};
use testkit::dice::Dice;
use testkit::enough;
use testkit::fill::ray;
use testkit::scenes::triangles;

fn crossings(tree: &BspTree, camera: &Camera) -> Vec<EdgeRun> {
    let rays = Rays::new(camera, tree.faces()).unwrap();
    VisibilityMap::of(tree, rays).unwrap().crossings().unwrap()
}

/// A third polygon begins on the line in which two cross: its edge cuts what is beyond its ends as well.
#[test]
fn crossings_go_on_where_an_edge_of_a_third_polygon_lies_on_them() {
    let floor = vec![[-2.0, -2.0, 0.0], [2.0, -2.0, 0.0], [2.0, 2.0, 0.0], [-2.0, 2.0, 0.0]];
    let wall = vec![[0.0, -2.0, -2.0], [0.0, 2.0, -2.0], [0.0, 2.0, 2.0], [0.0, -2.0, 2.0]];
    let flap = vec![[0.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 0.5, 1.0]];
    let polygons = [floor, wall, flap];
    let eye = DVec3::new(6.0, -0.5, 5.0);
    let camera = Camera::perspective(eye, DVec3::ZERO, DVec3::Z, 0.8, [320, 240]).unwrap();
    let at = |y: f64| camera.project(DVec3::new(0.0, y, 0.0)).unwrap().map(|c| c - 0.5);
    let distance = |[a, b]: [[f64; 2]; 2]| (a[0] - b[0]).hypot(a[1] - b[1]);
    for order in [[0, 1, 2], [2, 0, 1], [1, 2, 0], [2, 1, 0]] {
        for by in Heuristic::ALL {
            let options = BuildOptions::DEFAULT.with_heuristic(*by);
            let tree = options.build(order.map(|i: usize| &polygons[i])).unwrap();
            let [floor, wall] = [0, 1].map(|i| order.iter().position(|&o| o == i).unwrap());
            let kind = EdgeKind::Crossing(floor.max(wall));
            let all = crossings(&tree, &camera);
            let runs = all.iter().filter(|run| run.polygon == floor.min(wall) && run.kind == kind);
            let length: f64 = runs.map(|run| distance(run.ends)).sum();
            let flap = distance([at(0.0), at(1.0)]);
            let expected = distance([at(-2.0), at(2.0)]) - flap;
            assert!((length - expected).abs() < 1e-3, "{order:?}, {by:?}: {length}, {expected}");
            // The flap only touches the others.
            assert!(all.iter().all(|run| run.polygon == floor.min(wall) && run.kind == kind));
        }
    }
}

/// A pane goes through a wall, and in the picture edges of two others lie on parts of the line.
#[test]
fn crossings_show_beside_edges_that_lie_on_them_in_the_picture() {
    let wall = vec![[-2.0, 0.0, -2.0], [2.0, 0.0, -2.0], [2.0, 0.0, 2.0], [-2.0, 0.0, 2.0]];
    let pane = vec![[-2.0, -2.0, -2.0], [2.0, -2.0, -2.0], [2.0, 2.0, 2.0], [-2.0, 2.0, 2.0]];
    let flap = vec![[-1.0, -3.0, 0.0], [0.0, -3.0, 0.0], [0.0, -3.0, 2.0]];
    // From below, on another part of the line.
    let other = vec![[0.5, -3.0, 0.0], [1.0, -3.0, 0.0], [0.5, -3.0, -2.0]];
    let polygons = [wall, pane, flap, other];
    let eye = DVec3::new(0.0, -10.0, 0.0);
    let camera = Camera::perspective(eye, DVec3::ZERO, DVec3::Z, 0.5, [320, 240]).unwrap();
    // Of four units those that the edges of the flaps, at seven tenths of the distance, do not cover.
    let at = |x: f64| camera.project(DVec3::new(x, 0.0, 0.0)).unwrap()[0];
    let hidden = |from: f64, to: f64| at(to / 0.7) - at(from / 0.7);
    let expected = at(2.0) - at(-2.0) - hidden(-1.0, 0.0) - hidden(0.5, 1.0);
    for order in [[0, 1, 2, 3], [3, 2, 0, 1], [1, 3, 2, 0], [2, 1, 3, 0]] {
        for by in Heuristic::ALL {
            let options = BuildOptions::DEFAULT.with_heuristic(*by);
            let tree = options.build(order.map(|i: usize| &polygons[i])).unwrap();
            let opacity = |i: usize| if order[i] == 1 { 0.5 } else { 1.0 };
            let rays = Rays::new(&camera, tree.faces()).unwrap();
            let map = VisibilityMap::with_opacities(&tree, rays, opacity).unwrap();
            let length = |runs: Vec<EdgeRun>| -> f64 {
                let shown = runs.iter().filter(|run| run.is_visible);
                shown.map(|run| (run.ends[1][0] - run.ends[0][0]).abs()).sum()
            };
            let found = [map.crossings(), map.crossings_with_hidden(), map.crossings_in_layers()]
                .map(|runs| length(runs.unwrap()));
            let are_right = found.iter().all(|length| (length - expected).abs() < 1e-6);
            assert!(are_right, "{order:?}, {by:?}: {found:?}, {expected}");
        }
    }
}

/// A pane that lies on a board goes through it nowhere, though a third polygon goes through both there.
#[test]
fn polygons_of_one_plane_do_not_cross() {
    let square = [[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [2.0, 2.0, 0.0], [0.0, 2.0, 0.0]];
    let fin = [[1.0, 0.2, -1.0], [1.0, 1.8, -1.0], [1.0, 1.8, 1.0], [1.0, 0.2, 1.0]];
    let eye = DVec3::new(3.0, -2.0, 4.0);
    let camera = Camera::perspective(eye, DVec3::X + DVec3::Y, DVec3::Z, 0.8, [320, 240]).unwrap();
    for by in Heuristic::ALL {
        let options = BuildOptions::DEFAULT.with_heuristic(*by);
        let tree = options.build([square, square, fin]).unwrap();
        let rays = Rays::new(&camera, tree.faces()).unwrap();
        let opacity = |polygon: usize| if polygon == 1 { 0.5 } else { 1.0 };
        let map = VisibilityMap::with_opacities(&tree, rays, opacity).unwrap();
        let runs = map.crossings().unwrap();
        assert!(!runs.is_empty() && runs.iter().all(|run| run.kind == EdgeKind::Crossing(2)));
    }
}

/// Three planes through one line: each pair goes through one another there.
#[test]
fn planes_through_one_line_cross_in_it() {
    let card = |x: f64, y: f64| [[-x, -y, -1.0], [x, y, -1.0], [x, y, 1.0], [-x, -y, 1.0]];
    let cards = [card(1.0, 0.0), card(0.0, 1.0), card(1.0, 1.0)];
    let mut seen = 0;
    for turn in 0..16 {
        let angle = std::f64::consts::TAU * (f64::from(turn) + 0.3) / 16.0;
        let eye = DVec3::new(3.0 * angle.cos(), 3.0 * angle.sin(), 0.5);
        let camera = Camera::perspective(eye, DVec3::ZERO, DVec3::Z, 0.8, [320, 240]).unwrap();
        for by in Heuristic::ALL {
            let tree = BuildOptions::DEFAULT.with_heuristic(*by).build(cards).unwrap();
            let runs = crossings(&tree, &camera);
            // Two of the cards show at the line, one on each side: of all of it that is in the picture.
            let pairs: Vec<_> = runs.iter().map(|run| (run.polygon, run.kind)).collect();
            assert_eq!(pairs.len(), 1, "{turn}, {by:?}: {runs:?}");
            seen += 1;
        }
    }
    assert_eq!(seen, 16 * Heuristic::ALL.len());
}

/// Two upright cards that cross, and a bar before the middle of their crossing.
#[test]
fn cards_cross_in_a_line_and_a_bar_hides_its_middle() {
    let cards = [
        [[-2.0, -2.0, -2.0], [2.0, -2.0, 2.0], [2.0, 2.0, 2.0], [-2.0, 2.0, -2.0]],
        [[-2.0, -2.0, 2.0], [2.0, -2.0, -2.0], [2.0, 2.0, -2.0], [-2.0, 2.0, 2.0]],
        [[-3.0, -0.5, 3.0], [3.0, -0.5, 3.0], [3.0, 0.5, 3.0], [-3.0, 0.5, 3.0]],
    ];
    let camera = Camera::parallel(DVec3::NEG_Z, DVec3::Y, DVec3::ZERO, 8.0, [80, 80]).unwrap();
    for by in Heuristic::ALL {
        for (count, expected) in [(2, vec![40.0]), (3, vec![15.0, 15.0])] {
            let tree = BuildOptions::DEFAULT.with_heuristic(*by).build(&cards[..count]).unwrap();
            let runs = crossings(&tree, &camera);
            let lengths = runs.iter().map(|run| (run.ends[1][1] - run.ends[0][1]).abs());
            let lengths: Vec<f64> = lengths.map(|length| (length * 1e6).round() / 1e6).collect();
            assert_eq!(lengths, expected, "{by:?}");
            for run in runs {
                assert_eq!((run.polygon, run.kind), (0, EdgeKind::Crossing(1)));
                assert!(run.is_visible && run.edge.is_none());
                assert!(run.ends.iter().all(|end| (end[0] - 39.5).abs() < 1e-9));
            }
        }
    }
}

/// A wall through a floor of tiles: a run for each tile, and one for two walls in a line with a gap
/// between them.
#[test]
fn a_wall_crosses_every_tile_of_a_floor() {
    let count = 2_000;
    let mut polygons: Vec<[[f64; 3]; 4]> = (0..count)
        .map(|i| {
            let x = f64::from(i);
            [[x, -1.0, 0.0], [x + 1.0, -1.0, 0.0], [x + 1.0, 1.0, 0.0], [x, 1.0, 0.0]]
        })
        .collect();
    let end = f64::from(count) + 1.0;
    polygons.push([[-1.0, 0.0, -1.0], [end, 0.0, -1.0], [end, 0.0, 1.0], [-1.0, 0.0, 1.0]]);
    let tree = BspTree::build(&polygons).unwrap();
    let centre = DVec3::new(0.5 * end, 0.0, 0.0);
    let direction = DVec3::new(0.0, 1.0, -1.0);
    let camera = Camera::parallel(direction, DVec3::Z, centre, 0.4 * end, [800, 200]).unwrap();
    let runs = crossings(&tree, &camera);
    // The picture shows four fifths of the floor's length.
    let tiles: Vec<usize> = runs.iter().map(|run| run.polygon).collect();
    assert!(runs.len() > 1_500 && tiles.is_sorted_by(|a, b| a < b), "{}", runs.len());
    assert!(runs.iter().all(|run| run.kind == EdgeKind::Crossing(count as usize)));
}

/// A wall that stands on a floor touches it, and two walls meet at a corner: nothing is crossed.
#[test]
fn what_only_touches_does_not_cross() {
    let floor = [[-2.0, 0.0, -2.0], [2.0, 0.0, -2.0], [2.0, 0.0, 2.0], [-2.0, 0.0, 2.0]];
    let wall = [[-1.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 2.0, 0.0], [-1.0, 2.0, 0.0]];
    let other = [[1.0, 0.0, 0.0], [1.0, 0.0, 2.0], [1.0, 2.0, 2.0], [1.0, 2.0, 0.0]];
    let tree = BspTree::build([floor, wall, other]).unwrap();
    let eye = DVec3::new(-3.0, 4.0, 5.0);
    let camera = Camera::perspective(eye, DVec3::ZERO, DVec3::Y, 0.9, [200, 150]).unwrap();
    assert_eq!(crossings(&tree, &camera), []);
}

/// The segment that two triangles have in common, in floats.
fn common(a: &[DVec3; 3], b: &[DVec3; 3]) -> Option<[DVec3; 2]> {
    let normal = |[p, q, r]: &[DVec3; 3]| (*q - *p).cross(*r - *p);
    let along = normal(a).cross(normal(b));
    // Where the edges of one meet the plane of the other.
    let ends = |of: &[DVec3; 3], other: &[DVec3; 3]| {
        let n = normal(other);
        let value = of.map(|p| n.dot(p - other[0]));
        let cut = |i: usize| {
            let j = (i + 1) % 3;
            let share = value[i] / (value[i] - value[j]);
            ((value[i] < 0.0) != (value[j] < 0.0)).then(|| of[i].lerp(of[j], share))
        };
        let mut cuts: Vec<DVec3> = (0..3).filter_map(cut).collect();
        cuts.sort_by(|p, q| along.dot(*p).total_cmp(&along.dot(*q)));
        <[DVec3; 2]>::try_from(cuts).ok()
    };
    let ([a0, a1], [b0, b1]) = (ends(a, b)?, ends(b, a)?);
    let low = if along.dot(a0) > along.dot(b0) { a0 } else { b0 };
    let high = if along.dot(a1) < along.dot(b1) { a1 } else { b1 };
    (along.dot(low) < along.dot(high)).then_some([low, high])
}

/// Where a point is in the picture.
fn project(camera: &Camera, point: DVec3) -> Option<[f64; 2]> {
    let Viewpoint::Eye(eye) = camera.viewpoint() else { panic!("an eye") };
    let [width, height] = camera.size().map(f64::from);
    let arm = point - eye;
    let depth = arm.dot(camera.forward()) * camera.pixel_size();
    let x = arm.dot(camera.right()) / depth + 0.5 * width - 0.5;
    let y = 0.5 * height - 0.5 - arm.dot(camera.up()) / depth;
    let is_in = depth > 0.0 && x > 0.0 && y > 0.0 && x < width - 1.0 && y < height - 1.0;
    is_in.then_some([x, y])
}

/// How far a point is from a segment, and from its nearer end.
fn distances([[ax, ay], [bx, by]]: [[f64; 2]; 2], [x, y]: [f64; 2]) -> [f64; 2] {
    let (ux, uy) = (bx - ax, by - ay);
    let share = (((x - ax) * ux + (y - ay) * uy) / (ux * ux + uy * uy)).clamp(0.0, 1.0);
    let off = (x - ax - share * ux).hypot(y - ay - share * uy);
    [off, (x - ax).hypot(y - ay).min((x - bx).hypot(y - by))]
}

#[derive(Debug, Default)]
struct Score {
    visible: usize,
    hidden: usize,
    unsure: usize,
    on_runs: usize,
}

fn check(triangles: &[[DVec3; 3]], camera: &Camera, score: &mut Score) {
    let tree = BspTree::build(triangles).unwrap();
    let runs = crossings(&tree, camera);
    for i in 0..triangles.len() {
        for j in i + 1..triangles.len() {
            let Some([from, to]) = common(&triangles[i], &triangles[j]) else { continue };
            for k in 0..5 {
                let point = from.lerp(to, 0.09 + 0.2 * f64::from(k));
                let Some(at) = project(camera, point) else { continue };
                let Viewpoint::Eye(eye) = camera.viewpoint() else { panic!("an eye") };
                let depth = point.distance(eye);
                // A little to all sides something nearer hides it, or nothing does.
                let is_hidden = |off: [f64; 2], margin: f64| {
                    let ray = ray(camera, [at[0] + off[0], at[1] + off[1]]);
                    let binspace::Ray::Endless { direction, .. } = ray else { panic!("no end") };
                    let limit = depth / direction.length() * margin;
                    let others = |polygon: usize| polygon != i && polygon != j;
                    tree.hits(ray)
                        .take_while(|hit| hit.parameter() < limit)
                        .any(|hit| hit.parameter() > 0.0 && others(hit.polygon()))
                };
                let offs = [[0.0, 0.0], [0.01, 0.0], [-0.01, 0.0], [0.0, 0.01], [0.0, -0.01]];
                let answers = offs.map(|off| is_hidden(off, 0.999));
                // A third that is as far passes through, nearly.
                let is_near = is_hidden([0.0; 2], 1.001) && !answers[0];
                let of_pair = |run: &EdgeRun| (run.polygon, run.kind) == (i, EdgeKind::Crossing(j));
                let mut nearest = [f64::INFINITY; 2];
                for run in runs.iter().filter(|run| of_pair(run)) {
                    let [off, end] = distances(run.ends, at);
                    nearest = [nearest[0].min(off), nearest[1].min(end)];
                }
                let is_torn = answers.contains(&true) && answers.contains(&false);
                if is_near || is_torn || nearest[1] < 0.02 {
                    score.unsure += 1;
                    continue;
                }
                let is_on_run = nearest[0] < 1e-6;
                assert_eq!(is_on_run, !answers[0], "{i} and {j} at {at:?}: {nearest:?}");
                score.visible += usize::from(is_on_run);
                score.hidden += usize::from(!is_on_run);
            }
        }
    }
    // No long run but on a crossing.
    for run in &runs {
        let [[ax, ay], [bx, by]] = run.ends;
        let EdgeKind::Crossing(other) = run.kind else { panic!("{run:?}") };
        let [from, to] = common(&triangles[run.polygon], &triangles[other]).expect("they cross");
        let middle = [(ax + bx) / 2.0, (ay + by) / 2.0];
        if let (Some(from), Some(to)) = (project(camera, from), project(camera, to)) {
            assert!(distances([from, to], middle)[0] < 1e-5, "{run:?}");
            score.on_runs += 1;
        }
    }
}

#[test]
fn rays_agree_with_crossings() {
    let (mut score, mut dice) = (Score::default(), Dice(5));
    for (count, edge) in [(60, 0.8), (150, 0.4), (300, 0.2)] {
        let triangles: Vec<[DVec3; 3]> = triangles(&mut dice, count, [0.0, 1.0], edge)
            .into_iter()
            .map(|triangle| triangle.try_into().expect("three corners"))
            .collect();
        let bounds = [-DVec3::splat(edge), DVec3::splat(1.0 + edge)];
        for camera in views(bounds, DVec3::Z, 4, [320, 240], 7).unwrap() {
            check(&triangles, &camera, &mut score);
        }
    }
    enough!(score.visible > 500, score.hidden > 5000, score.on_runs > 500; "{score:?}");
    assert!(score.unsure * 20 < score.visible + score.hidden, "{score:?}");
}
