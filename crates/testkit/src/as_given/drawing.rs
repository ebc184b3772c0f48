//! A tree's fragments as a painter draws them: only by their rounded vertices.

use super::exact::Plane;
use super::ray::Targets;
use super::scene::world;
use crate::judge::{Verdict, ensure};
use crate::prelude::*;
use binspace::Fragment;

/// The largest allowed error of a vertex, as a share of the scene's size. Each rounding of a vertex has an
/// error of 2⁻⁵² of this size.
const OFF: f64 = 1.0 / (1u64 << 46) as f64;

/// Whether a point is in a fragment, as far as rounded vertices can decide.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Within {
    Surely,
    Perhaps,
    No,
}

/// A fragment seen along the axis in which its polygon is least steep.
struct Outline {
    fragment: u32,
    vertices: Vec<[f64; 2]>,
}

/// The fragments of each polygon.
pub struct Drawing<'t> {
    targets: &'t Targets<'t>,
    outlines: Vec<Vec<Outline>>,
    /// The largest error of a vertex's coordinate.
    off: f64,
}

impl<'t> Drawing<'t> {
    pub fn new(targets: &'t Targets<'t>, tree: &BspTree) -> Self {
        let mut outlines: Vec<Vec<Outline>> = targets.planes.iter().map(|_| Vec::new()).collect();
        for fragment in tree.fragments() {
            let polygon = fragment.polygon();
            let plane = &targets.planes[polygon];
            let vertices = fragment.vertices().map(|vertex| flat(plane, vertex)).collect();
            outlines[polygon].push(Outline { fragment: fragment.index(), vertices });
        }
        let off = targets.scene.size() as f64 * OFF;
        Self { targets, outlines, off }
    }

    /// Returns the fragments of a polygon that a point may be in. If the point is certainly in one fragment,
    /// returns only this fragment.
    pub fn fragments_at(&self, polygon: usize, point: [f64; 3]) -> Vec<(u32, Within)> {
        let at = flat(&self.targets.planes[polygon], DVec3::from(point));
        let within = |outline: &Outline| (outline.fragment, self.within(outline, at));
        let found = self.outlines[polygon].iter().map(within);
        found.filter(|&(_, within)| within != Within::No).collect()
    }

    fn within(&self, outline: &Outline, at: [f64; 2]) -> Within {
        let (vertices, off) = (&outline.vertices, self.off);
        for axis in 0..2 {
            let (low, high) = range(vertices.iter().map(|vertex| vertex[axis]));
            if at[axis] < low - 4.0 * off || at[axis] > high + 4.0 * off {
                return Within::No;
            }
        }
        let mut within = Within::Surely;
        for (i, a) in vertices.iter().enumerate() {
            let b = &vertices[(i + 1) % vertices.len()];
            let (u, v) = ([b[0] - a[0], b[1] - a[1]], [at[0] - a[0], at[1] - a[1]]);
            let value = u[0] * v[1] - u[1] * v[0];
            let size = |w: [f64; 2]| w[0].abs() + w[1].abs() + off;
            // Each of four differences is off by 2 · `off`, and the products are rounded.
            let bound = 8.0 * off * (size(u) + size(v));
            if value < -bound {
                return Within::No;
            }
            if value <= bound {
                within = Within::Perhaps;
            }
        }
        within
    }

    /// Checks that the fragments of every polygon have its area, lie on its plane and within it, and on the
    /// right sides of the planes and edges that are reported to bound them.
    pub fn check(&self, tree: &BspTree) -> Verdict {
        for (polygon, outlines) in self.outlines.iter().enumerate() {
            let plane = &self.targets.planes[polygon];
            let corners: Vec<[f64; 2]> = self.targets.scene.polygons[polygon]
                .iter()
                .map(|&p| flat(plane, world(p)))
                .collect();
            let (whole, around) = (area(&corners), girth(&corners));
            let total: f64 = outlines.iter().map(|outline| area(&outline.vertices)).sum();
            let bound = 8.0 * self.off * (around + self.off) * outlines.len() as f64;
            ensure(outlines.is_empty() || (total - whole).abs() <= bound, || {
                format!("polygon {polygon} has an area of {whole}, its fragments {total}")
            })?;
            ensure(!outlines.is_empty(), || format!("polygon {polygon} has no fragment"))?;
            let outer = Outline { fragment: 0, vertices: corners };
            for outline in outlines {
                for &vertex in &outline.vertices {
                    ensure(self.within(&outer, vertex) != Within::No, || {
                        format!("fragment {} reaches out of polygon {polygon}", outline.fragment)
                    })?;
                }
            }
        }
        tree.fragments().try_for_each(|fragment| self.check_bounds(tree, fragment))
    }

    fn check_bounds(&self, tree: &BspTree, fragment: Fragment<'_>) -> Verdict {
        let polygon = fragment.polygon();
        let corners = &self.targets.scene.polygons[polygon];
        let vertices: Vec<DVec3> = fragment.vertices().collect();
        let value = |plane: &Plane, vertex: DVec3| {
            let [a, b, c, d] = plane.rounded;
            (a * vertex.x + b * vertex.y + c * vertex.z - d) / plane.length()
        };
        let wrong = |what: &str| format!("{what}: {fragment:?}");
        let bound = 8.0 * self.off;
        for &vertex in &vertices {
            let off = value(&self.targets.planes[polygon], vertex);
            ensure(off.abs() <= bound, || wrong("a vertex is off its polygon's plane"))?;
        }
        for (i, line) in fragment.lines().enumerate() {
            let ends = [vertices[i], vertices[(i + 1) % vertices.len()]];
            let Some(id) = line.as_cut() else { continue };
            let plane = self.targets.named(tree, id);
            let towards = if line.is_behind() { -1.0 } else { 1.0 };
            let is_inside = |&vertex: &DVec3| towards * value(&plane, vertex) >= -bound;
            ensure(vertices.iter().all(is_inside), || wrong("on the other side of a line"))?;
            let is_on = |&vertex: &DVec3| value(&plane, vertex).abs() <= bound;
            ensure(ends.iter().all(is_on), || wrong("a line that is somewhere else"))?;
        }
        for (i, edge) in fragment.edges().enumerate() {
            let Some(edge) = edge else { continue };
            let [a, b] = [0, 1].map(|k| world(corners[(edge as usize + k) % corners.len()]));
            let arm = (b - a).normalize();
            for vertex in [vertices[i], vertices[(i + 1) % vertices.len()]] {
                let away = arm.cross(vertex - a).length();
                ensure(away <= bound, || wrong("an edge that is somewhere else"))?;
            }
        }
        Ok(())
    }
}

/// A point in a projection along the main axis of a plane, so that the front runs counter-clockwise.
fn flat(plane: &Plane, point: DVec3) -> [f64; 2] {
    let axis = plane.main_axis();
    let (u, v) = (point[(axis + 1) % 3], point[(axis + 2) % 3]);
    if plane.rounded[axis] < 0.0 { [v, u] } else { [u, v] }
}

fn range(values: impl Iterator<Item = f64>) -> (f64, f64) {
    values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)))
}

fn pairs(outline: &[[f64; 2]]) -> impl Iterator<Item = [[f64; 2]; 2]> {
    let first = outline[0];
    let from_first = move |p: [f64; 2]| [p[0] - first[0], p[1] - first[1]];
    (0..outline.len())
        .map(move |i| [from_first(outline[i]), from_first(outline[(i + 1) % outline.len()])])
}

fn area(outline: &[[f64; 2]]) -> f64 {
    pairs(outline).map(|[a, b]| a[0] * b[1] - a[1] * b[0]).sum::<f64>() / 2.0
}

fn girth(outline: &[[f64; 2]]) -> f64 {
    pairs(outline).map(|[a, b]| (b[0] - a[0]).abs() + (b[1] - a[1]).abs()).sum()
}
