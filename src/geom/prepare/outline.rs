//! What the outline of the polygon at hand is like: decided exactly, on the lattice.

use glam::DVec3;

use super::Builder;
use crate::geom::exact::{Plane, cross};
use crate::geom::faces::Frame;

impl Builder {
    /// The numbers of two corners that, with corner 0, span the largest triangle found; `None` if
    /// all corners lie on one line.
    pub(super) fn widest_triangle(&self) -> Option<[usize; 2]> {
        let point = |k: usize| DVec3::from(self.kept[k].0);
        let (origin, n) = (self.kept.first().map(|_| point(0))?, self.kept.len());
        let distance = |&k: &usize| point(k).distance_squared(origin);
        let far = (1..n).max_by(|a, b| distance(a).total_cmp(&distance(b)))?;
        let arm = point(far) - origin;
        let area = |&k: &usize| arm.cross(point(k) - origin).length_squared();
        let exact = |k: usize| cross(self.kept[0].0, self.kept[far].0, self.kept[k].0) != [0; 3];
        let best = (1..n).filter(|&k| k != far).max_by(|a, b| area(a).total_cmp(&area(b)))?;
        // Rounded areas of nearly straight polygons may name a corner exactly on the line.
        let third = if exact(best) { best } else { (1..n).find(|&k| exact(k))? };
        Some([far.min(third), far.max(third)])
    }

    /// The frame of the polygon, if it is planar within the tolerance.
    pub(super) fn planar_frame(&self, second: usize, third: usize) -> Option<Frame> {
        let triangle = [0, second, third].map(|k| self.kept[k].0);
        let plane = Plane::through(triangle);
        let limit = self.faces.tolerance * plane.normal_f64().length();
        let mut exact = true;
        for (point, _) in &self.kept {
            let value = plane.at(point);
            if value.sign().is_ne() {
                exact = false;
                if value.to_f64().abs() > limit {
                    return None;
                }
            }
        }
        Some(Frame::new(second, third, if exact { None } else { Some(plane.main_axis()) }))
    }

    /// Whether the polygon, seen along the axis in which its plane is least steep, is convex and
    /// winds once. Exact.
    pub(super) fn is_convex(&self, second: usize, third: usize) -> bool {
        let at = |k: usize| self.kept[k % self.kept.len()].0;
        let drop = Plane::through([at(0), at(second), at(third)]).main_axis();
        let (x, y) = ((drop + 1) % 3, (drop + 2) % 3);
        let step = |k: usize| [at(k + 1)[x] - at(k)[x], at(k + 1)[y] - at(k)[y]];
        // Corners that the projection folds onto one another have no direction to turn from.
        let mut rises = 0;
        let mut turn = 0i8;
        let ascending = |s: [f64; 2]| s[0] > 0.0 || (s[0] == 0.0 && s[1] > 0.0);
        for k in 0..self.kept.len() {
            let (a, b) = (step(k), step(k + 1));
            if a == [0.0; 2] || b == [0.0; 2] {
                return false;
            }
            let product = |p: f64, q: f64| i128::from(p as i64) * i128::from(q as i64);
            let area = product(a[0], b[1]) - product(a[1], b[0]);
            let backwards = area == 0 && product(a[0], b[0]) + product(a[1], b[1]) < 0;
            let sign = area.signum() as i8;
            if backwards || sign * turn < 0 {
                return false;
            }
            turn |= sign;
            rises += u32::from(!ascending(a) && ascending(b));
        }
        // A polygon that turns one way only and goes up once goes round once.
        rises == 1
    }

    /// Whether the straight line from one corner to another is part of the outline: all corners in
    /// between lie on it.
    pub(super) fn is_outline(kept: &[([f64; 3], u32)], from: usize, to: usize) -> bool {
        let n = kept.len();
        let at = |k: usize| kept[k % n].0;
        let last = if to > from { to } else { to + n };
        (from + 1..last).all(|k| cross(at(from), at(k), at(to)) == [0; 3])
    }
}
