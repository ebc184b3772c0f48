//! Strips along a side of a polygon, inside of its neighbours.

use super::{Outline, cross, double_area, sides};

/// How far a polygon reaches under a neighbour, in pixels. Smaller: the background shows where a
/// viewer's pixels and the edge meet obliquely; larger: more corners are cut by the neighbour's ends.
pub(super) const WIDTH: f64 = 1.0;
/// At most this share of the neighbour's height, so that nothing comes out on its other side.
const SHARE: f64 = 0.6;
/// Sides this near to one another, in pixels, are one edge. Smaller: rounded corners tear edges apart;
/// larger: sides that only pass each other are taken for edges.
pub(super) const NEAR: f64 = 0.02;

/// Coordinates along a side and outwards from it.
pub(super) struct Frame {
    start: [f64; 2],
    length: f64,
    along: [f64; 2],
    out: [f64; 2],
}

impl Frame {
    /// Of a side of an outline that turns in some sense; `None` if it has no length.
    pub(super) fn outside_of([start, end]: [[f64; 2]; 2], turn: f64) -> Option<Self> {
        let step = [end[0] - start[0], end[1] - start[1]];
        let length = step[0].hypot(step[1]);
        let along = step.map(|c| c / length);
        let out = [turn * along[1], -turn * along[0]];
        (length > NEAR).then_some(Self { start, length, along, out })
    }

    fn local(&self, point: [f64; 2]) -> [f64; 2] {
        let arm = [point[0] - self.start[0], point[1] - self.start[1]];
        [self.along, self.out].map(|axis| axis[0] * arm[0] + axis[1] * arm[1])
    }

    pub(super) fn world(&self, [along, out]: [f64; 2]) -> [f64; 2] {
        [0, 1].map(|axis| self.start[axis] + self.along[axis] * along + self.out[axis] * out)
    }

    /// From where to where a neighbour's side, in local coordinates, lies along this one: on it, or
    /// inwards by less than a strip is wide, so that the neighbour's edge is blended with what is below both.
    fn along(&self, [a, b]: [[f64; 2]; 2]) -> Option<[f64; 2]> {
        let [low, high] = [a[0].min(b[0]).max(0.0), a[0].max(b[0]).min(self.length)];
        if high - low <= NEAR {
            return None;
        }
        let out = |along: f64| a[1] + (b[1] - a[1]) * ((along - a[0]) / (b[0] - a[0]));
        let is_along = [low, high].map(out).iter().all(|out| (-WIDTH..=NEAR).contains(out));
        is_along.then_some([low, high])
    }
}

/// The least share of a strip that a triangle in its place has to have. Smaller: the background shows near
/// the ends of edges; larger: most neighbours get strips, which have one corner more.
const ENOUGH: f64 = 0.85;
/// Strips with less area than this, in square pixels, are left out. Larger: seams of small polygons show;
/// smaller: drawings of small polygons have many corners for nothing that is seen.
const SMALLEST: f64 = 0.1;

/// What lies outside of a side and inside of a convex neighbour, along the edges that both have in common:
/// its corners in local coordinates, from the lower to the upper end along the side.
pub(super) fn strip(frame: &Frame, neighbour: &[[f64; 2]]) -> Option<Outline> {
    let corners: Outline = neighbour.iter().map(|&corner| frame.local(corner)).collect();
    let strip = band(frame, &corners)?;
    if 0.5 * double_area(&strip).abs() < SMALLEST {
        return None;
    }
    Some(triangle(&corners, &strip).unwrap_or(strip))
}

/// A triangle on the edge of a strip that covers nearly as much of it, and reaches further into the
/// neighbour. It makes drawings shorter.
fn triangle(neighbour: &[[f64; 2]], strip: &[[f64; 2]]) -> Option<Outline> {
    let [low, high] = [*strip.first()?, *strip.last()?];
    let length = high[0] - low[0];
    let far: Outline = neighbour.iter().copied().filter(|corner| corner[1] > NEAR).collect();
    // From the middle of the edge to that of the corners which are not on it.
    let apex = [0, 1].map(|axis: usize| {
        let end = far.iter().map(|corner| corner[axis]).sum::<f64>() / far.len() as f64;
        let start = 0.5 * (low[axis] + high[axis]);
        start + SHARE * (end - start)
    });
    let width = strip.iter().map(|corner| corner[1]).fold(0.0, f64::max);
    let covered = if apex[1] > width {
        length * width * (1.0 - 0.5 * width / apex[1])
    } else {
        0.5 * length * apex[1]
    };
    let is_enough = covered >= ENOUGH * 0.5 * double_area(strip).abs();
    is_enough.then(|| vec![low, apex, high])
}

/// A strip along the common edges, as far as it is in the neighbour, which is given in local coordinates.
fn band(frame: &Frame, corners: &[[f64; 2]]) -> Option<Outline> {
    let turn = double_area(corners).signum();
    let height = corners.iter().map(|corner| corner[1]).fold(0.0, f64::max);
    let common = |ends: [[f64; 2]; 2]| {
        let is_outside = turn * (ends[1][0] - ends[0][0]) > 0.0;
        frame.along(ends).filter(|_| is_outside)
    };
    let hull = sides(corners).filter_map(common);
    let [low, high] = hull.reduce(|a, b| [a[0].min(b[0]), a[1].max(b[1])])?;
    if height <= NEAR {
        return None;
    }
    let width = WIDTH.min(SHARE * height);
    let mut strip = vec![[low, 0.0], [low, width], [high, width], [high, 0.0]];
    for [a, b] in sides(corners).filter(|&ends| common(ends).is_none()) {
        strip = inside(&strip, a, b, turn);
    }
    // The corners on the side are its ends, all others come in between.
    let n = strip.len();
    let last = (0..n)
        .filter(|&i| strip[i][1] == 0.0)
        .max_by(|&i, &j| strip[i][0].total_cmp(&strip[j][0]))?;
    strip.rotate_left((last + 1) % n);
    strip.dedup();
    (strip.len() > 2 && strip[0][1] == 0.0).then_some(strip)
}

/// What of a convex outline is on the inner side of a line.
fn inside(outline: &[[f64; 2]], a: [f64; 2], b: [f64; 2], turn: f64) -> Outline {
    let side = |p: [f64; 2]| turn * cross([b[0] - a[0], b[1] - a[1]], [p[0] - a[0], p[1] - a[1]]);
    let mut inner = Outline::new();
    for (i, &to) in outline.iter().enumerate() {
        let from = outline[(i + outline.len() - 1) % outline.len()];
        let [before, after] = [side(from), side(to)];
        if (before < 0.0) != (after < 0.0) {
            let share = before / (before - after);
            inner.push([0, 1].map(|axis| from[axis] + (to[axis] - from[axis]) * share));
        }
        if after >= 0.0 {
            inner.push(to);
        }
    }
    inner
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn strips_are_inside_of_the_neighbour() {
        // The side from (1, 2) to (5, 2) of what is below it, with y up.
        let frame = Frame::outside_of([[5.0, 2.0], [1.0, 2.0]], 1.0).unwrap();
        let strip = |outline: &[[f64; 2]]| {
            let corners: Outline = outline.iter().map(|&corner| frame.local(corner)).collect();
            band(&frame, &corners)
        };
        let triangle = [[1.0, 2.0], [5.0, 2.0], [3.0, 12.0]];
        assert_eq!(frame.along([[0.0, 0.0], [4.0, 0.0]]), Some([0.0, 4.0]));
        assert_eq!(frame.along([[4.0, 0.0], [2.0, 10.0]]), None);
        // Inwards by less than a pixel, and outwards by more than a rounding.
        assert_eq!(frame.along([[-4.0, -0.8], [3.0, -0.5]]), Some([0.0, 3.0]));
        assert_eq!(frame.along([[0.0, 0.5], [3.0, 0.5]]), None);
        let found = strip(&triangle).unwrap();
        assert_eq!(found.len(), 4);
        for (found, expected) in found.iter().zip([[0.0, 0.0], [0.2, 1.0], [3.8, 1.0], [4.0, 0.0]])
        {
            assert!((0..2).all(|axis| (found[axis] - expected[axis]).abs() < 1e-12), "{found:?}");
        }
        assert_eq!(frame.world([0.5, 1.0]), [4.5, 3.0]);
        // The other way round; a low neighbour has a narrow strip.
        let low = [[3.0, 2.5], [4.0, 2.0], [2.0, 2.0]];
        let found = strip(&low).unwrap();
        assert!(found.iter().all(|corner| corner[1] <= 0.3 + 1e-12), "{found:?}");
        assert_eq!(found.first(), Some(&[1.0, 0.0]));
        assert_eq!(found.last(), Some(&[3.0, 0.0]));
        // A wedge along the side that leaves it on the other side of its tip.
        let wedge = [[0.9, 2.01], [4.0, 1.5], [30.0, 9.0], [3.0, 2.005]];
        let found = strip(&wedge).unwrap();
        assert!(found.iter().all(|corner| corner[1] < 0.01), "{found:?}");
        // On the same side of the edge there is nothing to reach under.
        assert_eq!(strip(&[[1.0, 2.0], [5.0, 2.0], [3.0, -9.0]]), None);
    }

    #[test]
    fn a_triangle_stands_for_a_strip_that_it_nearly_covers() {
        let frame = Frame::outside_of([[5.0, 2.0], [1.0, 2.0]], 1.0).unwrap();
        let found = strip(&frame, &[[1.0, 2.0], [5.0, 2.0], [3.0, 12.0]]).unwrap();
        assert_eq!(found.len(), 3);
        for (found, expected) in found.iter().zip([[0.0, 0.0], [2.0, 6.0], [4.0, 0.0]]) {
            assert!((0..2).all(|axis| (found[axis] - expected[axis]).abs() < 1e-12), "{found:?}");
        }
        // Of a low neighbour it would leave out too much near the ends.
        let low = [[1.0, 2.0], [5.0, 2.0], [5.0, 2.8], [1.0, 2.8]];
        assert_eq!(strip(&frame, &low).unwrap().len(), 4);
    }
}
