//! Triangles so thin that rounding destroys their normals: the tolerance is a length at their planes too.
//! Trees are judged by exact distances.

use binspace::Ray;
use binspace::glam::Vec3;
use std::collections::BTreeMap;
use std::fmt::Write;
use testkit::prelude::*;
use testkit::scenes::trees;
use testkit::slivers::{Point, Sliver, along, whole};

fn square(half: f64, z: f64) -> Vec<[f64; 3]> {
    vec![[-half, -half, z], [half, -half, z], [half, half, z], [-half, half, z]]
}

#[test]
fn a_sliver_does_not_make_squares_coplanar() {
    let sliver = [
        [-1.0, -1.0, 0.0],
        [0.719_638_576_572_251_9, 0.75, 0.0],
        [0.931_029_674_363_226_3, 0.965_123_355_671_395_6, 0.0],
    ];
    let slope = [[-1.0, -1.0, -1.0], [1.0, -1.0, 1.0], [1.0, 1.0, 1.0], [-1.0, 1.0, -1.0]];
    let polygons = [sliver.to_vec(), square(0.5, -0.125), square(0.5, 0.125), slope.to_vec()];
    for &heuristic in Heuristic::ALL {
        let tree = BuildOptions::DEFAULT.with_heuristic(heuristic).build(&polygons).unwrap();
        let stats = tree.stats();
        assert!(stats.nearly_coplanar_by <= stats.tolerance, "{heuristic}: {stats:?}");
        let above = Viewpoint::eye([0.0, 0.0, 5.0]);
        let order: Vec<usize> = tree.back_to_front(above).map(|f| f.polygon()).collect();
        let place = |polygon| order.iter().position(|&other| other == polygon);
        assert!(place(1) < place(2), "{heuristic}: {order:?}");
    }
}

#[test]
fn rays_meet_a_square_beside_a_sliver() {
    const S: f64 = (1_u64 << 50) as f64;
    let sliver = [
        [0.0, 0.0, 0.0],
        [511_543_759_645_776.0, 544_836_935_578_157.0, 0.0],
        [748_061_801_583_472.0, 796_748_453_895_795.0, 0.0],
    ];
    let wall = [[-S, -S, -S], [-S, S, -S], [-S, S, S], [-S, -S, S]];
    let polygons = [sliver.to_vec(), square(S, 0.1 * S), square(S, -0.1 * S), wall.to_vec()];
    for &heuristic in Heuristic::ALL {
        let tree = BuildOptions::DEFAULT.with_heuristic(heuristic).build(&polygons).unwrap();
        // The ray ends before it reaches the sliver's plane.
        let down = Ray::between([0.3 * S, 0.1 * S, S], [0.3 * S, 0.1 * S, 0.05 * S]);
        let hits: Vec<usize> = tree.hits(down).map(|hit| hit.polygon()).collect();
        assert_eq!(hits, [1], "{heuristic}");
        assert!(tree.is_occluded(down), "{heuristic}");
    }
}

/// The counts of comparisons.
#[derive(Debug, Default)]
struct Score {
    on: usize,
    /// Faces that lie on a plane within the tolerance, but not exactly.
    nearly_on: usize,
    beside: usize,
    /// Planes whose normal has a wrong length if it is computed in floats.
    lost: usize,
}

/// Checks by exact distances that all fragments on a plane are within the tolerance of it, and that fragments
/// on a side reach no further beyond the plane than the tolerance, up to a share of 10⁻⁹.
fn judge(tree: &BspTree, score: &mut Score) -> Result<(), String> {
    let faces = tree.faces();
    let share = |share: f64| rational::exact(faces.tolerance()) * rational::exact(share);
    let limits = [1.0 - 1e-9, 1.0 + 1e-9].map(share);
    let mut pieces = BTreeMap::<u32, usize>::new();
    tree.fragments().for_each(|f| *pieces.entry(f.face()).or_default() += 1);
    for node in tree.nodes() {
        let plane = model::plane(faces, node.plane());
        let square = rational::scalar(&plane.normal, &plane.normal);
        score.lost += usize::from(is_lost(tree, node.plane(), &square));
        // Whether a corner is beyond a limit on a side. Squares are compared, because lengths are not
        // rational.
        let beyond = |corner: [f64; 3], limit: &Rational, side: i32| {
            let value = plane.at(&corner.map(rational::exact)) * Rational::from(side);
            rational::sign(&value).is_gt() && &value * &value > limit * limit * &square
        };
        for id in node.on() {
            let face = tree.fragment(id).face();
            score.on += 1;
            for &corner in faces.corners(face) {
                let is_off = [-1, 1].iter().any(|&side| beyond(corner, &limits[1], side));
                let off = || plane.at(&corner.map(rational::exact)).to_f64().value().abs();
                if is_off {
                    let length = square.to_f64().value().sqrt();
                    let off = off() / length / faces.tolerance();
                    return Err(format!("face {face} is on {:?}, {off} τ off", node.plane()));
                }
            }
            let is_off = |corner: &[f64; 3]| beyond(*corner, &Rational::from(0), 1);
            score.nearly_on += usize::from(faces.corners(face).iter().any(is_off));
        }
        for (range, side) in [(node.in_front(), 1), (node.behind(), -1)] {
            for face in range.map(|id| tree.fragment(id).face()).filter(|face| pieces[face] == 1) {
                score.beside += 1;
                let corners = faces.corners(face);
                if corners.iter().any(|&corner| beyond(corner, &limits[1], -side)) {
                    return Err(format!("face {face} reaches across {:?}", node.plane()));
                }
                if !corners.iter().any(|&corner| beyond(corner, &limits[0], side)) {
                    return Err(format!("face {face} is beside {:?}, not on it", node.plane()));
                }
            }
        }
    }
    tree.validate()
}

/// Whether floats give the normal of a face's triangle a wrong length.
fn is_lost(tree: &BspTree, plane: binspace::internals::PlaneId, square: &Rational) -> bool {
    let binspace::internals::PlaneKind::Face(face) = plane.kind() else { return false };
    let triangle = tree.faces().reference_triangle(face);
    let [p, q, r] = triangle.map(|corner| DVec3::from(tree.faces().corner(corner)));
    let length = square.to_f64().value().sqrt();
    ((q - p).cross(r - p).length() - length).abs() > 1e-9 * length
}

/// Slivers, polygons in their planes, polygons a few tolerances off these planes, and some polygons anywhere.
fn scene(dice: &mut Dice, size: i64, near: i64) -> Vec<Vec<Point>> {
    let mut polygons = Vec::new();
    for _ in 0..1 + dice.below(2) {
        let Sliver { corners, steps } = Sliver::new(dice, size);
        polygons.push(corners.to_vec());
        for _ in 0..dice.below(4) {
            // Along the steps, and slightly off, corner by corner or as a whole.
            let off = [0; 3].map(|_| whole(dice, near));
            let is_rough = dice.below(2) == 0;
            let corner = |_: usize| {
                let at = along(corners[0], steps, [0; 2].map(|_| whole(dice, size / 16)));
                let off = if is_rough { [0; 3].map(|_| whole(dice, near)) } else { off };
                std::array::from_fn(|i| at[i] + off[i])
            };
            polygons.push((0..3).map(corner).collect());
        }
    }
    for _ in 0..4 {
        polygons.push((0..3).map(|_| [0; 3].map(|_| whole(dice, size))).collect());
    }
    dice.shuffle(&mut polygons);
    polygons
}

fn doubles(polygons: &[Vec<Point>]) -> Vec<Vec<[f64; 3]>> {
    polygons.iter().map(|polygon| polygon.iter().map(|p| p.map(|c| c as f64)).collect()).collect()
}

/// A sliver in `f32`, where products of integers are exact. The sliver has a corner next to the middle of its
/// long side, with far smaller numbers.
fn singles(dice: &mut Dice) -> Vec<[Vec3; 3]> {
    const SIZE: f64 = (1 << 22) as f64;
    let mut point = |size: f64| dice.point(-1.0, 1.0) * size;
    let long = point(SIZE).as_vec3();
    let middle = long * (point(1e-5).x as f32);
    let (axis, off) = (long.as_dvec3(), middle.as_dvec3());
    let across = (off - axis * (off.dot(axis) / axis.dot(axis))).normalize() * SIZE;
    let mut polygons = vec![[long, -long, middle]];
    for k in 0..7 {
        // Three polygons in its plane, up to rounding or a bit more.
        let corner = |_: usize| match k {
            0..3 => {
                let [s, t] = point(1.0).truncate().to_array();
                (axis * s + across * t + point(f64::from(k) * 0.5)).as_vec3()
            }
            _ => point(SIZE).as_vec3(),
        };
        polygons.push([0, 1, 2].map(corner));
    }
    polygons.rotate_right(dice.below(8));
    polygons
}

fn file(polygons: &[Vec<Point>]) -> Scene {
    let mut text = String::new();
    for polygon in polygons {
        for [x, y, z] in polygon {
            writeln!(text, "v {x} {y} {z}").unwrap();
        }
        writeln!(text, "f -3 -2 -1").unwrap();
    }
    Scene::from_obj("slivers", text.as_bytes(), |_| None).unwrap().0
}

/// Judges the trees of the polygons by all heuristics, and of frames.
fn judge_all<P: binspace::Polygon>(polygons: &[P], name: &str, score: &mut Score) {
    for (by, tree) in &trees(polygons, BuildOptions::DEFAULT) {
        judge(tree, score).unwrap_or_else(|what| panic!("{name}, {by}: {what}"));
    }
}

#[test]
fn nothing_further_off_than_the_tolerance_is_coplanar() {
    for (number, rounds) in [(0, 60), (1, 40), (2, 30)] {
        let mut score = Score::default();
        for seed in 0..rounds {
            let mut dice = Dice(seed << 2 | number);
            let name = format!("numbers of kind {number}, seed {seed}");
            match number {
                0 => {
                    let size = 1 << (20 + dice.below(30));
                    let polygons = scene(&mut dice, size, (size >> 28).max(2));
                    judge_all(&doubles(&polygons), &name, &mut score);
                }
                1 => judge_all(&singles(&mut dice), &name, &mut score),
                _ => {
                    let polygons = scene(&mut dice, 1_900_000_000, 16);
                    let scene = file(&polygons);
                    let polygons: Vec<_> = scene.polygons().collect();
                    judge_all(&polygons, &name, &mut score);
                }
            }
        }
        assert!(score.nearly_on > 50 && score.beside > 500 && score.lost > 20, "{score:?}");
    }
}
