//! Convex polygons in space, in floats: cut by planes, and their hulls.

use binspace::glam::DVec3;

/// The corners of a convex polygon, in either direction.
pub(super) type Outline = Vec<DVec3>;

/// The plane `normal · p = offset`. In front of it, `normal · p` is larger.
#[derive(Clone, Copy, Debug)]
pub(super) struct Plane {
    pub(super) normal: DVec3,
    pub(super) offset: f64,
}

impl Plane {
    /// The plane through a point.
    pub(super) fn new(normal: DVec3, point: DVec3) -> Self {
        Self { normal, offset: normal.dot(point) }
    }

    /// The distance of a point in front of the plane; negative behind it.
    pub(super) fn at(&self, point: DVec3) -> f64 {
        self.normal.dot(point) - self.offset
    }

    /// The same plane with the opposite front.
    pub(super) fn flipped(&self) -> Self {
        Self { normal: -self.normal, offset: -self.offset }
    }

    /// The plane moved backwards by a length.
    pub(super) fn eased(&self, by: f64) -> Self {
        Self { offset: self.offset - by, ..*self }
    }

    /// The least and the greatest of the values of some points.
    pub(super) fn range(&self, points: &[DVec3]) -> [f64; 2] {
        let values = points.iter().map(|&point| self.at(point));
        values.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], v| [low.min(v), high.max(v)])
    }

    /// A square on the plane around the foot of a point, its side four times as long as `reach`.
    pub(super) fn square(&self, point: DVec3, reach: f64) -> Outline {
        let foot = point - self.normal * self.at(point);
        let u = self.normal.any_orthonormal_vector();
        let v = self.normal.cross(u);
        let corner = |x: f64, y: f64| foot + (u * x + v * y) * (2.0 * reach);
        vec![corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)]
    }
}

/// The part of a polygon in front of a plane or on it; empty if fewer than three corners are left.
pub(super) fn clip(outline: &[DVec3], plane: &Plane) -> Outline {
    let mut kept = Vec::with_capacity(outline.len() + 1);
    for (k, &corner) in outline.iter().enumerate() {
        let next = outline[if k + 1 == outline.len() { 0 } else { k + 1 }];
        let [here, there] = [corner, next].map(|p| plane.at(p));
        if here >= 0.0 {
            kept.push(corner);
        }
        if (here > 0.0 && there < 0.0) || (here < 0.0 && there > 0.0) {
            kept.push(corner + (next - corner) * (here / (here - there)));
        }
    }
    if kept.len() < 3 { Vec::new() } else { kept }
}

/// The parts of a polygon in front of a plane and behind it. A polygon that reaches no further than `thin` to
/// a side has no part there. If this is so on both sides, the whole polygon counts as a part on each side.
pub(super) fn split(outline: &[DVec3], plane: &Plane, thin: f64) -> [Outline; 2] {
    let [low, high] = plane.range(outline);
    let is_on = low >= -thin && high <= thin;
    let part = |reach: f64, plane: &Plane| match reach > thin {
        _ if is_on => outline.to_vec(),
        true => clip(outline, plane),
        false => Vec::new(),
    };
    [part(high, plane), part(-low, &plane.flipped())]
}

/// The planes through the edges of a polygon, perpendicular to the polygon's plane, each with the polygon
/// behind it.
fn side_planes(outline: &[DVec3], plane: &Plane) -> impl Iterator<Item = Plane> {
    let middle = outline.iter().sum::<DVec3>() / outline.len() as f64;
    (0..outline.len()).filter_map(move |k| {
        let (from, to) = (outline[k], outline[(k + 1) % outline.len()]);
        let normal = (to - from).cross(plane.normal).try_normalize()?;
        let side = Plane::new(normal, from);
        Some(if side.at(middle) > 0.0 { side.flipped() } else { side })
    })
}

/// A lower bound of the distance of points from a polygon on a plane: the largest distance along the plane's
/// normal or across an edge. It is 0 or less if these directions give no bound.
pub(super) fn apart(points: &[DVec3], outline: &[DVec3], plane: &Plane) -> f64 {
    let [low, high] = plane.range(points);
    let beside = side_planes(outline, plane).map(|side| side.range(points)[0]);
    beside.fold(low.max(-high), f64::max)
}

/// The part of a polygon outside another polygon on the same plane, as convex pieces. Pieces thinner than
/// `thin` are left out.
pub(super) fn without(outline: Outline, gone: &[DVec3], plane: &Plane, thin: f64) -> Vec<Outline> {
    if side_planes(gone, plane).any(|side| side.range(&outline)[0] >= -thin) {
        return vec![outline];
    }
    let (mut rest, mut pieces) = (outline, Vec::new());
    for side in side_planes(gone, plane) {
        let [outside, inside] = split(&rest, &side, thin);
        if !outside.is_empty() {
            pieces.push(outside);
        }
        rest = inside;
        if rest.is_empty() {
            break;
        }
    }
    pieces
}

/// The convex hull of points on a plane.
pub(super) fn hull(mut points: Vec<DVec3>, plane: &Plane) -> Outline {
    let u = plane.normal.any_orthonormal_vector();
    let v = plane.normal.cross(u);
    let place = |p: &DVec3| [u.dot(*p), v.dot(*p)];
    points.sort_unstable_by(|a, b| {
        let ([ax, ay], [bx, by]) = (place(a), place(b));
        ax.total_cmp(&bx).then(ay.total_cmp(&by))
    });
    let turns = |a: &DVec3, b: &DVec3, c: &DVec3| {
        let ([ax, ay], [bx, by], [cx, cy]) = (place(a), place(b), place(c));
        (bx - ax) * (cy - ay) - (by - ay) * (cx - ax) > 0.0
    };
    // First one half of the hull, then the other (Andrew 1979).
    let chain = |points: &mut dyn Iterator<Item = DVec3>| {
        let mut chain: Vec<DVec3> = Vec::new();
        for point in points {
            while let [.., a, b] = &chain[..]
                && !turns(a, b, &point)
            {
                chain.pop();
            }
            chain.push(point);
        }
        chain.pop();
        chain
    };
    let mut hull = chain(&mut points.iter().copied());
    hull.extend(chain(&mut points.iter().rev().copied()));
    hull
}

/// Whether all points are in a polygon, or outside it by no more than `thin`. Points and polygon are on one
/// plane.
pub(super) fn holds(outline: &[DVec3], plane: &Plane, points: &[DVec3], thin: f64) -> bool {
    outline.len() > 2 && side_planes(outline, plane).all(|side| side.range(points)[1] <= thin)
}
