//! The true values of a layer, in exact rationals.

use super::Rect;
use binspace::glam::DMat4;
use testkit::prelude::*;
use testkit::rational::{exact, sign, total};

pub(crate) type Point2 = [Rational; 2];

/// A rectangle, and the coefficients of u, v and 1 in each of x, y, z and w.
pub(crate) struct Truth {
    pub(crate) rect: [Point2; 2],
    rows: [[Rational; 3]; 4],
}

impl Truth {
    pub(crate) fn new(rect: Rect, matrix: DMat4) -> Self {
        let columns = matrix.to_cols_array_2d();
        let row = |k: usize| [0, 1, 3].map(|column: usize| exact(columns[column][k]));
        Self { rect: rect.map(|corner| corner.map(exact)), rows: [0, 1, 2, 3].map(row) }
    }

    /// (x, y, z, w) of a point of the layer's plane.
    pub(crate) fn homogeneous(&self, [u, v]: &Point2) -> [Rational; 4] {
        self.rows.each_ref().map(|[a, b, c]| a * u + b * v + c)
    }

    /// The point of the plane that appears at a point of the screen, and its depth; by Cramer's rule.
    pub(crate) fn seen_at(&self, screen: &Point2) -> Option<(Point2, Rational)> {
        let [x, y, _, w] = &self.rows;
        let [a, b] = [(x, &screen[0]), (y, &screen[1])]
            .map(|(row, at)| [0, 1, 2].map(|k: usize| &row[k] - at * &w[k]));
        let determinant = &a[0] * &b[1] - &a[1] * &b[0];
        if determinant.is_zero() {
            return None;
        }
        let u = (&a[1] * &b[2] - &a[2] * &b[1]) / &determinant;
        let v = (&a[2] * &b[0] - &a[0] * &b[2]) / &determinant;
        let local = [u, v];
        let [_, _, z, w] = self.homogeneous(&local);
        w.is_positive().then(|| (local, z / w))
    }

    /// The plane on the screen, as coefficients of x, y, z and w.
    pub(crate) fn plane(&self) -> [Rational; 4] {
        let [x, y, z, w] = &self.rows;
        [[y, z, w], [z, x, w], [x, y, w], [x, z, y]].map(|[a, b, c]| {
            let minor = |i: usize, j: usize| &b[i] * &c[j] - &b[j] * &c[i];
            &a[0] * minor(1, 2) + &a[1] * minor(2, 0) + &a[2] * minor(0, 1)
        })
    }

    /// The distance of a point inside the rectangle, as a share of the smaller side; negative outside.
    pub(crate) fn inside(&self, local: &Point2) -> f64 {
        let [low, high] = &self.rect;
        let distances = (0..2).flat_map(|k| [&local[k] - &low[k], &high[k] - &local[k]]);
        let sides = (0..2).map(|k| number(&(&high[k] - &low[k])));
        let side = sides.fold(f64::INFINITY, f64::min);
        distances.map(|distance| number(&distance)).fold(f64::INFINITY, f64::min) / side
    }

    /// The part of the rectangle in a box of screen coordinates, in the layer's own coordinates. It is
    /// clipped in homogeneous coordinates, one side after the other.
    pub(crate) fn clipped(&self, low: [f64; 3], high: [f64; 3]) -> Vec<Point2> {
        let [[u0, v0], [u1, v1]] = self.rect.clone();
        let corners = [[u0.clone(), v0.clone()], [u1.clone(), v0], [u1, v1.clone()], [u0, v1]];
        let mut outline: Vec<(Point2, [Rational; 4])> =
            corners.map(|corner| (corner.clone(), self.homogeneous(&corner))).to_vec();
        for axis in 0..3 {
            for (limit, is_low) in [(low[axis], true), (high[axis], false)] {
                let limit = exact(limit);
                outline = keep(&outline, |h| {
                    let off = &h[axis] - &limit * &h[3];
                    if is_low { off } else { -off }
                });
            }
        }
        let mut outline = keep(&outline, |h| h[3].clone());
        outline.dedup();
        outline.into_iter().map(|(local, _)| local).collect()
    }
}

fn keep(
    outline: &[(Point2, [Rational; 4])],
    side: impl Fn(&[Rational; 4]) -> Rational,
) -> Vec<(Point2, [Rational; 4])> {
    let mut kept = Vec::new();
    for (i, here) in outline.iter().enumerate() {
        let next = &outline[(i + 1) % outline.len()];
        let [a, b] = [&here.1, &next.1].map(&side);
        if !a.is_negative() {
            kept.push(here.clone());
        }
        if sign(&a) as i8 * sign(&b) as i8 == -1 {
            let t = &a / (&a - &b);
            let mix = |from: &Rational, to: &Rational| from + (to - from) * &t;
            let local = [0, 1].map(|k: usize| mix(&here.0[k], &next.0[k]));
            kept.push((local, [0, 1, 2, 3].map(|k: usize| mix(&here.1[k], &next.1[k]))));
        }
    }
    kept
}

/// Twice the area of an outline, positive if it runs from u towards v.
pub(crate) fn area(outline: &[Point2]) -> Rational {
    let next = outline.iter().cycle().skip(1);
    total(outline.iter().zip(next).map(|(a, b)| &a[0] * &b[1] - &a[1] * &b[0]))
}

/// Whether a point is strictly inside a convex outline of either orientation.
pub(crate) fn covers(outline: &[DVec2], rounded: DVec2, at: &Point2) -> bool {
    // The unrounded numbers decide exactly whether the point is in the bounding box.
    let [low, high] =
        [DVec2::min, DVec2::max].map(|of| outline.iter().copied().reduce(of).unwrap());
    if rounded.clamp(low, high) != rounded {
        return false;
    }
    let outline: Vec<Point2> = outline.iter().map(|p| p.to_array().map(exact)).collect();
    let next = outline.iter().cycle().skip(1);
    let mut sides = outline.iter().zip(next).map(|(a, b)| {
        sign(&((&b[0] - &a[0]) * (&at[1] - &a[1]) - (&b[1] - &a[1]) * (&at[0] - &a[0])))
    });
    let first = sides.next().expect("an outline");
    first.is_ne() && sides.all(|side| side == first)
}

pub(crate) fn number(value: &Rational) -> f64 {
    value.to_f64().value()
}
