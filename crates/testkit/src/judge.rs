//! Checks a tree's fragments in exact rationals.
//!
//! A fragment's vertices are computed from the lines that bound it, not from the library's definitions of
//! vertices, and every decision is made again.

use super::model::{self, Face};
use super::rational::{self, Point, Rational};
use binspace::glam::DVec3;
use binspace::internals::{EdgeLine, Lattice, Side, VertexId};
use binspace::{BspTree, Fragment};
use num_traits::Zero;

/// The fault, in words.
pub type Verdict = Result<(), String>;

/// The largest error of a library vertex, in lattice units, as documented: three roundings of a coordinate
/// slightly beyond 2⁵¹.
pub const POSITION_ERROR: f64 = 0.77;

/// A fragment in rationals.
struct Piece {
    points: Vec<Point>,
    lines: Vec<EdgeLine>,
}

/// A tree with its faces and fragments in rationals.
pub struct Judge<'t> {
    tree: &'t BspTree,
    faces: Vec<Face>,
    pieces: Vec<Piece>,
}

/// Fails with a message unless a condition holds.
pub fn ensure(condition: bool, message: impl FnOnce() -> String) -> Verdict {
    if condition { Ok(()) } else { Err(message()) }
}

/// Runs every check of this file on a tree. `polygons` are the polygons as given to the library.
pub fn judge(tree: &BspTree, polygons: &[Vec<DVec3>]) -> Verdict {
    tree.validate()?;
    let judge = Judge::new(tree);
    judge.outlines()?;
    judge.coverage()?;
    judge.sides()?;
    judge.weights(polygons)
}

/// Runs the checks of this file on the tree of a cell: all checks except that faces are complete.
pub fn judge_cell(tree: &BspTree, polygons: &[Vec<DVec3>]) -> Verdict {
    tree.validate()?;
    let judge = Judge::new(tree);
    judge.outlines()?;
    judge.sides()?;
    judge.weights(polygons)
}

/// The covered part of a face: twice its area, seen along an axis, and for each edge the covered intervals,
/// from 0 to 1.
#[derive(Clone, Debug, Default)]
pub struct Cover {
    area: Rational,
    runs: Vec<Vec<[Rational; 2]>>,
}

impl Cover {
    /// Adds another covered part of the same face.
    pub fn add(&mut self, other: &Self) {
        self.area += &other.area;
        self.runs.resize(other.runs.len().max(self.runs.len()), Vec::new());
        self.runs.iter_mut().zip(&other.runs).for_each(|(own, other)| own.extend_from_slice(other));
    }
}

impl<'t> Judge<'t> {
    pub fn new(tree: &'t BspTree) -> Self {
        let faces: Vec<Face> =
            (0..tree.faces().len() as u32).map(|face| Face::new(tree.faces(), face)).collect();
        let piece = |fragment: Fragment<'_>| {
            let lines: Vec<EdgeLine> = fragment.lines().collect();
            let corners = tree.faces().corners(fragment.face()).len() as u32;
            let vertex_id = |i: usize| {
                let before = lines[(i + lines.len() - 1) % lines.len()];
                meeting(before, lines[i], corners)
            };
            let face = &faces[fragment.face() as usize];
            let resolve = |i| face.resolve(tree.faces(), vertex_id(i));
            let points: Vec<Point> = (0..lines.len()).map(resolve).collect();
            Piece { points, lines }
        };
        let pieces = tree.fragments().map(piece).collect();
        Self { tree, faces, pieces }
    }

    fn with_pieces(&self) -> impl Iterator<Item = (Fragment<'t>, &Face, &Piece)> {
        let face = |fragment: &Fragment<'_>| &self.faces[fragment.face() as usize];
        self.tree.fragments().zip(&self.pieces).map(move |(f, piece)| (f, face(&f), piece))
    }

    /// Checks that every fragment is a convex piece with area, and that its rounded vertices are close to the
    /// exact vertices.
    fn outlines(&self) -> Verdict {
        for (fragment, face, piece) in self.with_pieces() {
            let n = piece.points.len();
            ensure(n >= 3 && n == fragment.vertex_count(), || {
                format!("{n} vertices: {fragment:?}")
            })?;
            for (exact, rounded) in piece.points.iter().zip(fragment.lattice_vertices()) {
                let off = rational::distance_to_rounded(exact, rounded);
                ensure(off <= POSITION_ERROR, || format!("off by {off}: {fragment:?}"))?;
            }
            let axis = model::main_axis(&face.plane);
            let facing = rational::sign(&face.plane.normal[axis]);
            let mut turns = 0;
            for i in 0..n {
                let corner = [0, 1, 2].map(|k| &piece.points[(i + k) % n]);
                let [before, after] =
                    [0, 1].map(|k| rational::difference(corner[k + 1], corner[k]));
                let turn = rational::sign(&rational::product(&before, &after)[axis]);
                let straight_on = turn.is_eq() && corner[0] != corner[1];
                ensure(turn == facing || straight_on, || {
                    format!("turns the wrong way at {}: {fragment:?}", (i + 1) % n)
                })?;
                turns += usize::from(turn.is_ne());
            }
            ensure(turns >= 3, || format!("without area: {fragment:?}"))?;
        }
        Ok(())
    }

    /// Checks that the fragments of a face have its area, exactly, and tile each of its edges from end to
    /// end.
    fn coverage(&self) -> Verdict {
        let mut covers = self.covers();
        covers.iter_mut().enumerate().try_for_each(|(face, cover)| self.is_covered(face, cover))
    }

    /// Returns the covered part of each face.
    pub fn covers(&self) -> Vec<Cover> {
        let empty = |face: &Face| Cover {
            area: Rational::zero(),
            runs: vec![Vec::new(); face.corners.len()],
        };
        let mut covers: Vec<Cover> = self.faces.iter().map(empty).collect();
        for (fragment, face, piece) in self.with_pieces() {
            let cover = &mut covers[fragment.face() as usize];
            let axis = model::main_axis(&face.plane);
            cover.area += &rational::area(&piece.points)[axis];
            for (i, line) in piece.lines.iter().enumerate() {
                let Some(edge) = line.as_edge() else { continue };
                let ends = [i, (i + 1) % piece.points.len()].map(|k| &piece.points[k]);
                cover.runs[edge as usize].push(ends.map(|end| along(face, edge as usize, end)));
            }
        }
        covers
    }

    /// Checks that a face is covered once.
    pub fn is_covered(&self, id: usize, cover: &mut Cover) -> Verdict {
        let face = &self.faces[id];
        let axis = model::main_axis(&face.plane);
        ensure(cover.area == rational::area(&face.corners)[axis], || {
            format!("the pieces of face {id} miss its area")
        })?;
        for (edge, runs) in cover.runs.iter_mut().enumerate() {
            runs.sort();
            let end = runs.iter().try_fold(Rational::zero(), |end, [from, to]| {
                (*from == end && to > from).then(|| to.clone())
            });
            ensure(end.is_some_and(|end| end.is_one()), || {
                format!("edge {edge} of face {id} is not tiled: {runs:?}")
            })?;
        }
        Ok(())
    }

    /// Checks that every fragment lies on the right side of every plane above it, by the rules of the
    /// library.
    fn sides(&self) -> Verdict {
        let faces = self.tree.faces();
        for node in self.tree.nodes() {
            let by = model::plane(faces, node.plane());
            let groups = [
                (node.on(), Side::Coplanar),
                (node.in_front(), Side::Front),
                (node.behind(), Side::Back),
            ];
            for (range, expected) in groups {
                for id in range {
                    let piece = &self.pieces[id as usize];
                    let face = self.tree.fragment(id).face();
                    let values: Vec<Rational> =
                        piece.points.iter().map(|point| by.at(point)).collect();
                    let exact = &self.faces[face as usize];
                    let allowed = exact.classify((faces, face), (node.plane(), &by), &values);
                    ensure(allowed.contains(&expected), || {
                        format!("fragment {id} is {allowed:?} at {node:?}")
                    })?;
                }
            }
        }
        Ok(())
    }

    /// Checks that weights sum to 1, that they give the vertices from the polygon's corners, and that
    /// reported edges of the polygon lie on edges of the polygon.
    fn weights(&self, polygons: &[Vec<DVec3>]) -> Verdict {
        let faces = self.tree.faces();
        let lattice = faces.lattice();
        // The tolerance moves a corner onto a plane along an axis. The angle between axis and normal has a
        // cosine of at least 1 / √3.
        let moved = 2.0 * lattice.length_to_world(faces.tolerance());
        let step = lattice.length_to_world(1.0);
        for (fragment, _, _) in self.with_pieces() {
            let corners = &polygons[fragment.polygon()];
            let size = corners.iter().fold(0.0, |m: f64, c| m.max(c.abs().max_element()));
            // Near 0, the least step of `f64` is larger than all these errors.
            let least = f64::from_bits(1);
            let allowed = 8.0 * (moved + step + size * f64::EPSILON + least);
            for (vertex, weights) in fragment.vertices().zip(fragment.weights()) {
                let total: f64 = weights.iter().map(|(_, weight)| weight).sum();
                ensure((total - 1.0).abs() < 1e-12, || format!("weights sum to {total}"))?;
                let largest = weights.iter().fold(1.0, |m: f64, (_, w)| m.max(w.abs()));
                let mean: DVec3 =
                    weights.iter().map(|&(k, weight)| corners[k as usize] * weight).sum();
                let off = (mean - vertex).abs().max_element();
                ensure(off <= allowed * largest, || {
                    format!("weights {weights:?} are {off:e} off {vertex} in {fragment:?}")
                })?;
            }
            // In lattice units, in which no length overflows.
            let vertices: Vec<_> = fragment.lattice_vertices().map(DVec3::from_array).collect();
            let allowed = 8.0 * (2.0 * faces.tolerance() + 1.0);
            for (i, edge) in fragment.edges().enumerate() {
                let Some(edge) = edge else { continue };
                let [a, b] = ends_of_edge(lattice, corners, edge as usize);
                let arm = (b - a).normalize_or_zero();
                for vertex in [vertices[i], vertices[(i + 1) % vertices.len()]] {
                    let off = (vertex - a - arm * (vertex - a).dot(arm)).length();
                    ensure(off <= allowed, || format!("{vertex} is {off:e} off edge {edge}"))?;
                }
            }
        }
        Ok(())
    }
}

/// An edge of a polygon on the lattice, from its corner to the next different corner.
fn ends_of_edge(lattice: &Lattice, corners: &[DVec3], edge: usize) -> [DVec3; 2] {
    let snapped = |corner: &DVec3| DVec3::from_array(lattice.snap(*corner));
    let a = snapped(&corners[edge]);
    let mut next = corners.iter().cycle().skip(edge + 1).take(corners.len()).map(snapped);
    [a, next.find(|&next| next != a).unwrap_or(a)]
}

/// The position of a point along an edge of a face: 0 to 1.
fn along(face: &Face, edge: usize, point: &Point) -> Rational {
    let [a, b] = [edge, (edge + 1) % face.corners.len()].map(|k| &face.corners[k]);
    let axis = (0..3).find(|&axis| a[axis] != b[axis]).expect("an edge of some length");
    (&point[axis] - &a[axis]) / (&b[axis] - &a[axis])
}

/// Returns the vertex where two consecutive lines around a piece meet.
pub fn meeting(before: EdgeLine, after: EdgeLine, corners: u32) -> VertexId {
    match (before.as_edge(), before.as_cut(), after.as_cut()) {
        (_, _, Some(plane)) => VertexId::crossing(before, plane),
        (_, Some(plane), None) => VertexId::crossing(after, plane),
        (Some(edge), _, None) => VertexId::corner((edge + 1) % corners),
        (None, None, None) => unreachable!("a line is an edge or a cut"),
    }
}
