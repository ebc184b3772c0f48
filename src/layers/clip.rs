//! Clips a layer to its polygon on the screen.

use glam::{DVec2, DVec3, DVec4};
use smallvec::SmallVec;

use super::piece::{ClippedCorner, Layer, LayerVertex};

/// A layer counts as seen edge-on if its area on the screen is less than this many rounding errors of its
/// matrix. Too small: cards turned by a rounded right angle cut other cards. Too large: thin cards vanish.
const EDGE_ON: f64 = 8.0;
/// The number of rounding errors of a matrix by which a corner may be off its plane; see
/// `Polygon::precision`. Too small: cards that matrices put into one plane cut each other. Too large: thin
/// layers are merged.
const STEPS: f64 = 4.0;

/// A point of the layer's plane in the clipper.
#[derive(Clone, Copy)]
struct Point {
    local: DVec2,
    edge: Option<u8>,
}

/// Six half-planes clip a rectangle to at most ten corners; each side of an ancestor adds one corner.
pub(super) const MOST_CORNERS: usize = 10;

type Points = SmallVec<[Point; MOST_CORNERS]>;

/// Appends the corners of a layer's part in a box of the screen. Returns the largest distance by which
/// rounding may have moved a corner off the layer's plane. Returns `None`, and appends nothing, if no part is
/// visible.
///
/// Rounding may put a corner slightly outside the box. The corner is moved onto the sides that lie in
/// `viewport`, but not onto sides that are a million sizes of the viewport away. At such a side, the last bit
/// of the corner's place in the layer is a tenth of a pixel on the screen, so a move would put the corner off
/// the layer's plane by a tenth of a pixel.
///
/// The layer is clipped in its own plane, where every side of the box is a half-plane. So all corners lie in
/// one plane, up to one rounding, whichever sides of the box clipped the layer.
pub(super) fn clip(
    layer: &Layer,
    limits: [DVec3; 2],
    viewport: Option<[DVec2; 2]>,
    corners: &mut Vec<ClippedCorner>,
) -> Option<f64> {
    if layer.is_empty() {
        return None;
    }
    let (rows, scale) = layer.scaled_rows();
    let plane = plane(layer, rows)?;
    let points = clipped(layer, rows, limits)?;
    let mut precision = 0.0f64;
    let begin = corners.len();
    for Point { local, edge } in points {
        let at = local.extend(1.0);
        let [x, y, z, w] = rows.map(|row| row.dot(at));
        let mut position = DVec3::new(x, y, z) / w;
        // Such a w, and such a distance from the box, are due to rounding: the layer is in the plane of the eye.
        let beyond = (limits[0] - position).max(position - limits[1]);
        let is_near = beyond.cmple(limits[1] - limits[0]).all();
        if w <= 0.0 || !(w / scale).is_normal() || !is_near {
            corners.truncate(begin);
            return None;
        }
        if let Some([low, high]) = viewport {
            position = position.truncate().clamp(low, high).extend(position.z);
        }
        precision = precision.max(plane.abs().dot(layer.rounding(rows, local)) / w);
        let vertex = LayerVertex { position, w: w / scale, local };
        corners.push(ClippedCorner { vertex, edge });
    }
    Some(STEPS * precision)
}

/// The plane of a layer in homogeneous coordinates, its normal of length 1; `None` if the layer is seen
/// edge-on, or has no plane.
fn plane(layer: &Layer, rows: [DVec3; 4]) -> Option<DVec4> {
    let [x, y, z, w] = layer.centred(rows);
    let terms = [rows[0], rows[1], rows[3]].map(|row| layer.terms(row));
    // The area on the screen, and a bound on its rounding error.
    let area = determinant([x, y, w]);
    let is_seen = area.abs() > EDGE_ON * layer.step() * permanent(terms);
    let plane =
        DVec4::new(determinant([y, z, w]), determinant([z, x, w]), area, determinant([x, z, y]));
    is_seen.then(|| plane / plane.truncate().length())
}

fn determinant([a, b, c]: [DVec3; 3]) -> f64 {
    a.dot(b.cross(c))
}

/// The permanent: the determinant with every sign positive. If all numbers are absolute values, the permanent
/// bounds the sum of the determinant's terms.
fn permanent([a, b, c]: [DVec3; 3]) -> f64 {
    let sums = DVec3::new(b.y * c.z + b.z * c.y, b.z * c.x + b.x * c.z, b.x * c.y + b.y * c.x);
    a.dot(sums)
}

/// The part of the layer's rectangle inside the ancestors' rectangles and the box; `None` if this part is
/// empty.
fn clipped(layer: &Layer, [x, y, z, w]: [DVec3; 4], limits: [DVec3; 2]) -> Option<Points> {
    let corners = layer.corners();
    let [low, high] = limits;
    // Two opposite sides together imply w ≥ 0.
    let sides = [
        x - w * low.x,
        w * high.x - x,
        y - w * low.y,
        w * high.y - y,
        z - w * low.z,
        w * high.z - z,
    ];
    let start = (0..4).map(|k| Point { local: corners[k as usize], edge: Some(k) });
    let mut points: Points = start.collect();
    for (k, &side) in layer.clips().iter().enumerate() {
        points = keep_inside(points, side, u8::try_from(4 + k).ok());
    }
    for side in sides {
        points = keep_inside(points, side, None);
    }
    (points.len() >= 3).then_some(points)
}

/// The part of a convex polygon where side · (u, v, 1) is not negative (Sutherland & Hodgman 1974). `made`
/// labels the edges on that side.
fn keep_inside(points: Points, side: DVec3, made: Option<u8>) -> Points {
    let at: SmallVec<[f64; MOST_CORNERS]> =
        points.iter().map(|p| side.dot(p.local.extend(1.0))).collect();
    if at.iter().all(|&at| at >= 0.0) {
        return points;
    }
    let mut kept = Points::new();
    for (i, &here) in points.iter().enumerate() {
        let k = if i + 1 < points.len() { i + 1 } else { 0 };
        let (next, a, b) = (points[k], at[i], at[k]);
        if a >= 0.0 {
            kept.push(here);
        }
        if (a >= 0.0) != (b >= 0.0) {
            // A mean weighted by the distances, not a step from one end: the result is the same from either
            // end.
            let mut local = here.local * (b / (b - a)) + next.local * (a / (a - b));
            // Points on sides along u or v are exact.
            if side.y == 0.0 {
                local.x = -side.z / side.x;
            } else if side.x == 0.0 {
                local.y = -side.z / side.y;
            }
            // Where the outline leaves the inside, an edge made by clipping begins.
            let edge = if a >= 0.0 { made } else { here.edge };
            kept.push(Point {
                local: local.clamp(here.local.min(next.local), here.local.max(next.local)),
                edge,
            });
        }
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::{determinant, permanent};
    use glam::DVec3;

    #[test]
    fn the_permanent_has_all_six_terms() {
        let rows = [[1.0, 2.0, 3.0], [4.0, 5.0, 6.0], [7.0, 8.0, 10.0]].map(DVec3::from);
        assert_eq!(permanent(rows), 50.0 + 48.0 + 84.0 + 96.0 + 80.0 + 105.0);
        assert_eq!(determinant(rows), 50.0 - 48.0 + 84.0 - 105.0 + 96.0 - 80.0);
    }
}
