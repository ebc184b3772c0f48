//! The accuracy figures of trees, against rationals: every figure is computed again from the definitions of
//! vertices and planes.

use binspace::Preparation;
use binspace::internals::{Side, Tuning, VertexId, VertexKind, tree_of};
use binspace_evidence::{Family, Precision, Tree, accuracy};
use proptest::prelude::*;
use proptest::strategy::ValueTree;
use testkit::model::Face;
use testkit::prelude::*;
use testkit::rational::{Plane, Point};
use testkit::scenes::polygons;

/// The figures of a tree.
#[derive(Debug, Default)]
struct Figures {
    vertices: usize,
    /// The count for the exact tolerance, and the count for the tolerance rounded down to an integer in the
    /// unit of each plane's equation. The library's count is one of these or between them.
    misplaced: [usize; 2],
    undefined: usize,
    torn: usize,
    drift_max: f64,
    drift_mean: f64,
}

/// The exact position of a vertex, and whether it is on a wrong side.
struct Placed {
    point: Point,
    misplaced: [bool; 2],
}

/// The place of a vertex; `None` if the planes that define it are parallel.
fn place(faces: &Faces, face: &Face, vertex: VertexId) -> Option<Point> {
    let is_defined = match vertex.kind() {
        VertexKind::Corner(_) => true,
        VertexKind::OnEdge(k, by) => {
            let (k, by) = (k as usize, model::plane(faces, by));
            let ends = [k, (k + 1) % face.corners.len()].map(|k| by.at(&face.corners[k]));
            ends[0] != ends[1]
        }
        VertexKind::Inside(g, h) => {
            let [g, h] = [g, h].map(|id| model::plane(faces, id).normal);
            !rational::scalar(&face.plane.normal, &rational::product(&g, &h)).is_zero()
        }
    };
    is_defined.then(|| face.resolve(faces, vertex))
}

/// The distance of a position from the exact one; infinite for NaN and for positions further than any scene
/// reaches.
fn drift(point: &Point, position: [f64; 3]) -> f64 {
    let reach = 2f64.powi(59);
    if position.iter().any(|c| c.is_nan() || c.abs() > reach) {
        return f64::INFINITY;
    }
    rational::distance_to_rounded(point, position)
}

fn figures(tree: &Tree) -> Figures {
    let faces = tree.faces();
    let models: Vec<Face> = (0..faces.len() as u32).map(|face| Face::new(faces, face)).collect();
    let (mut figures, mut sum) = (Figures::default(), 0.0);
    let mut pieces: Vec<Vec<Option<Placed>>> = Vec::new();
    for fragment in 0..tree.len() as u32 {
        let mut piece = Vec::new();
        for (vertex_id, position) in tree.vertex_ids(fragment).zip(tree.lattice_vertices(fragment))
        {
            let point = place(faces, &models[tree.face(fragment) as usize], vertex_id);
            if let Some(point) = &point {
                let off = drift(point, position);
                figures.drift_max = figures.drift_max.max(off);
                sum += off;
            }
            piece.push(point.map(|point| Placed { point, misplaced: [false; 2] }));
        }
        figures.vertices += piece.len();
        figures.undefined += piece.iter().filter(|vertex| vertex.is_none()).count();
        pieces.push(piece);
    }
    figures.drift_mean = sum / figures.vertices.max(1) as f64;
    figures.torn =
        (0..).zip(&models).filter(|&(id, face)| is_torn(tree, id, face, &pieces)).count();
    for (plane, ranges) in tree.partitions() {
        let by = model::plane(faces, plane);
        let limits = model::band(faces.tolerance(), &by);
        for (range, side) in ranges.into_iter().zip([Side::Coplanar, Side::Front, Side::Back]) {
            for id in range {
                let is_own = plane == PlaneId::face(tree.face(id));
                for vertex in pieces[id as usize].iter_mut().flatten() {
                    let wrong = if is_own {
                        [side != Side::Coplanar; 2]
                    } else {
                        wrong_sides(vertex, &by, side, &limits)
                    };
                    (0..2).for_each(|i| vertex.misplaced[i] |= wrong[i]);
                }
            }
        }
    }
    for vertex in pieces.iter().flatten().flatten() {
        (0..2).for_each(|i| figures.misplaced[i] += usize::from(vertex.misplaced[i]));
    }
    figures
}

/// Whether a vertex is on another side of a plane than its fragment, by more than each limit.
fn wrong_sides(vertex: &Placed, by: &Plane, side: Side, limits: &[Rational; 2]) -> [bool; 2] {
    let distance = by.at(&vertex.point);
    let sign = rational::sign(&distance);
    let is_wrong = match side {
        Side::Front => sign == Ordering::Less,
        Side::Back => sign == Ordering::Greater,
        _ => sign != Ordering::Equal,
    };
    if !is_wrong {
        return [false; 2];
    }
    let size = distance.abs();
    [&limits[1], &limits[0]].map(|limit| size > *limit)
}

/// Whether the areas of a face's pieces do not add up to the face's area.
fn is_torn(tree: &Tree, id: u32, face: &Face, pieces: &[Vec<Option<Placed>>]) -> bool {
    let axis = model::main_axis(&face.plane);
    let own = rational::area(&face.corners)[axis].clone();
    let mut sum = Rational::zero();
    for (fragment, piece) in (0..).zip(pieces).filter(|&(f, _)| tree.face(f) == id) {
        if tree.is_whole(fragment) {
            sum += &own;
            continue;
        }
        let points: Option<Vec<Point>> =
            piece.iter().map(|vertex| Some(vertex.as_ref()?.point.clone())).collect();
        let Some(points) = points else { return true };
        sum += &rational::area(&points)[axis];
    }
    sum != own
}

/// The number of comparisons, and the number of errors in the trees themselves.
#[derive(Debug, Default)]
struct Tally {
    trees: usize,
    vertices: usize,
    misplaced: usize,
    /// Trees with vertices that are misplaced by one limit and not by the other.
    unclear: usize,
    undefined: usize,
    torn: usize,
    drifted: usize,
    /// The most faces of a scene.
    faces: usize,
}

impl Tally {
    fn compare(&mut self, tree: &Tree) -> Result<Figures, String> {
        let (found, expected) = (accuracy(tree), figures(tree));
        let counts = (found.vertices, found.undefined, found.torn);
        let close = |found: f64, expected: f64, share: f64| {
            found == expected || (found - expected).abs() <= share * (1.0 + expected)
        };
        let [least, most] = expected.misplaced;
        if counts != (expected.vertices, expected.undefined, expected.torn)
            || !(least..=most).contains(&found.misplaced)
            || !close(found.drift_max, expected.drift_max, 8.0 * f64::EPSILON)
            || !close(found.drift_mean, expected.drift_mean, 1e-12)
        {
            return Err(format!("{found:?}\n{expected:?}\n{tree:?}"));
        }
        self.trees += 1;
        self.vertices += found.vertices;
        self.misplaced += usize::from(found.misplaced > 0);
        self.unclear += usize::from(least != most);
        self.undefined += usize::from(found.undefined > 0);
        self.torn += usize::from(found.torn > 0);
        self.drifted += usize::from(found.drift_max > 100.0);
        self.faces = self.faces.max(tree.faces().len());
        Ok(expected)
    }

    /// Compares a rounded tree, unless it exceeds its budget.
    fn compare_rounded<T: Precision>(
        &mut self,
        options: BuildOptions,
        epsilon: f64,
        polygons: &[Vec<DVec3>],
    ) -> Result<(), String> {
        let (faces, _) = Faces::new(polygons, options.tolerance).map_err(|e| e.to_string())?;
        let tree = Tree::with_epsilon::<T>(faces, epsilon, 2000);
        tree.map_or(Ok(()), |tree| self.compare(&tree).map(drop))
    }

    fn compare_all(
        &mut self,
        options: BuildOptions,
        polygons: &[Vec<DVec3>],
    ) -> Result<(), String> {
        self.compare_rounded::<f64>(options.clone(), 1e-12, polygons)?;
        self.compare_rounded::<f64>(options.clone(), 5e-2, polygons)?;
        self.compare_rounded::<f32>(options, 0.0, polygons)
    }
}

/// Asserts in rationals that the library's tree misplaces nothing, and that its vertices are within three
/// roundings.
fn assert_exact(options: BuildOptions, polygons: &[Vec<DVec3>]) -> Result<(), String> {
    let (faces, _) = Faces::new(polygons, options.tolerance).map_err(|e| e.to_string())?;
    let tree = tree_of(&options, &Tuning::DEFAULT, faces, Preparation::default())
        .map_err(|error| error.to_string())?;
    let found = Tally::default().compare(&Tree::from(&tree))?;
    let is_right = found.misplaced[0] + found.undefined + found.torn == 0 && found.drift_max <= 1.5;
    if is_right { Ok(()) } else { Err(format!("{found:?}")) }
}

fn scenes() -> Vec<(String, Vec<Vec<DVec3>>)> {
    let mut scenes: Vec<(String, Vec<Vec<DVec3>>)> = [
        scene::crossing(12),
        scene::random_triangles(150, 4),
        scene::layers(40, 1e-4),
        scene::newell_bars(),
        scene::city(150, 3),
    ]
    .iter()
    .map(|scene| (scene.name().to_string(), polygons(scene)))
    .collect();
    for family in Family::ALL {
        for &difficulty in family.sweep(true) {
            let scene = family.scene(difficulty, 3);
            if scene.len() <= 40 {
                scenes.push((format!("{family} {difficulty:e}"), polygons(&scene)));
            }
        }
    }
    scenes
}

#[test]
fn exact_trees_of_large_scenes_misplace_nothing_according_to_rationals() {
    let mut trees = 0;
    for (name, polygons) in scenes() {
        let options = BuildOptions::DEFAULT.with_tolerance(0.0);
        assert_exact(options, &polygons).unwrap_or_else(|error| panic!("{name}: {error}"));
        trees += 1;
    }
    enough!(trees > 30; "{trees}");
}

#[test]
fn a_corner_behind_a_plane_is_misplaced_if_it_is_further_than_the_tolerance() {
    let ground = [[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [1.0, 1.0, 0.0], [-1.0, 1.0, 0.0]];
    let above = [[0.0, 0.5, 1.0], [0.0, -0.5, 1.0], [0.0, 0.0, -0.015]];
    let polygons: [&[[f64; 3]]; 2] = [&ground, &above];
    for (tolerance, misplaced) in [(0.0, 1), (0.01, 1), (0.0149, 1), (0.0151, 0), (0.02, 0)] {
        let options = BuildOptions::DEFAULT.with_tolerance(tolerance);
        let (faces, _) = Faces::new(polygons, options.tolerance).expect("finite");
        let tree = Tree::with_epsilon::<f64>(faces, 0.1, 100).expect("two polygons");
        assert_eq!((tree.len(), accuracy(&tree).misplaced), (2, misplaced), "{tolerance}");
    }
}

#[test]
fn rationals_count_the_same_errors_of_rounded_trees_of_large_scenes() {
    let mut tally = Tally::default();
    for (name, polygons) in scenes() {
        let options = BuildOptions::DEFAULT.with_tolerance(0.0);
        tally.compare_all(options, &polygons).unwrap_or_else(|error| panic!("{name}: {error}"));
    }
    assert_eq!(tally.unclear, 0, "{tally:?}");
    enough!(tally.trees > 90, tally.faces >= 150; "{tally:?}");
    enough!(tally.misplaced > 40, tally.torn >= 3, tally.drifted > 20; "{tally:?}");
}

#[test]
fn rationals_count_the_same_errors_of_rounded_trees_of_hard_scenes() {
    let mut runner = proptest::test_runner::TestRunner::deterministic();
    let mut tally = Tally::default();
    for _ in 0..times(100) {
        let scene = hard::scene().new_tree(&mut runner).expect("a scene").current();
        let options = scene.options(Heuristic::default());
        assert_exact(options.clone(), &scene.polygons).unwrap_or_else(|e| panic!("{scene:?}: {e}"));
        tally.compare_all(options, &scene.polygons).unwrap_or_else(|e| panic!("{scene:?}: {e}"));
    }
    assert!(tally.trees > 250 && tally.unclear * 10 < tally.trees, "{tally:?}");
    enough!(tally.misplaced > 50, tally.undefined > 0, tally.torn > 7; "{tally:?}");
}
