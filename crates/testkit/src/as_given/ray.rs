//! The hits of rays on the given polygons, exactly sorted.

use super::exact::{Big, Plane, Spot, Vector, big, float, product, scalar, sign, turn, wide};
use super::scene::{Point, Scene, minus, world};
use crate::prelude::*;
use binspace::internals::PlaneKind;
use dashu_int::IBig;

/// The points (origin / below) + s · direction, with s above 0, or with any s if the ray is endless.
#[derive(Clone, Debug)]
pub struct Ray {
    pub origin: Vector,
    pub below: i128,
    pub direction: Vector,
    pub endless: bool,
}

/// The point where a ray meets a polygon.
#[derive(Clone, Debug)]
pub struct Hit {
    pub polygon: usize,
    pub spot: Spot,
    /// The parameter of the ray: a fraction, the denominator above 0.
    depth: [IBig; 2],
    rounded: f64,
}

impl Hit {
    fn depth_order(&self, other: &Self) -> Ordering {
        let (a, b) = (self.rounded, other.rounded);
        if (a - b).abs() > 1e-12 * (a.abs() + b.abs()) {
            return a.total_cmp(&b);
        }
        (&self.depth[0] * &other.depth[1]).cmp(&(&other.depth[0] * &self.depth[1]))
    }
}

/// A scene prepared for rays.
pub struct Targets<'s> {
    pub scene: &'s Scene,
    pub planes: Vec<Plane>,
    /// Centres and radii of balls around the polygons, with a margin.
    balls: Vec<(DVec3, f64)>,
}

impl<'s> Targets<'s> {
    /// Panics unless all polygons are planar and have area, which the judge requires.
    pub fn new(scene: &'s Scene) -> Self {
        let planes: Vec<Plane> = scene.polygons.iter().map(|p| Plane::of(p)).collect();
        for (polygon, plane) in scene.polygons.iter().zip(&planes) {
            assert!(plane.is_proper(), "{}: {polygon:?} has no area", scene.name);
            assert!(
                polygon.iter().all(|&p| sign(&plane.at(p)).is_eq()),
                "{}: {polygon:?} is not planar",
                scene.name
            );
            assert!(is_convex(polygon, plane), "{}: {polygon:?} is not convex", scene.name);
        }
        let ball = |polygon: &Vec<Point>| {
            let sum: DVec3 = polygon.iter().map(|&p| world(p)).sum();
            let centre = sum / polygon.len() as f64;
            let radius = polygon.iter().map(|&p| world(p).distance(centre)).fold(0.0, f64::max);
            (centre, radius)
        };
        let balls = scene.polygons.iter().map(ball).collect();
        Self { scene, planes, balls }
    }

    /// Returns the plane with a name, computed from the given corners.
    pub fn named(&self, tree: &BspTree, id: PlaneId) -> Plane {
        let faces = tree.faces();
        match id.kind() {
            PlaneKind::Face(face) => self.planes[faces.polygon(face)].clone(),
            PlaneKind::Axis(axis, corner) => {
                let at = faces.lattice().to_world(faces.corner(corner))[axis];
                Plane::across(axis, at as i64)
            }
        }
    }

    /// Returns the hits of a ray, the furthest first; hits at the same point are in one list.
    pub fn hits(&self, ray: &Ray) -> Vec<Vec<Hit>> {
        let origin = DVec3::from_array(ray.origin.map(|c| c as f64 / ray.below as f64));
        let along = DVec3::from_array(ray.direction.map(|c| c as f64)).normalize();
        let mut hits = Vec::new();
        for (polygon, &(centre, radius)) in self.balls.iter().enumerate() {
            // A thousand times the rounding error of the coordinates of the origin and the centre.
            let slack = 1e-12 * (origin.abs().max_element() + centre.abs().max_element());
            if along.cross(centre - origin).length() <= radius * 1.001 + slack {
                hits.extend(self.hit(ray, polygon));
            }
        }
        hits.sort_by(|a, b| b.depth_order(a).then(a.polygon.cmp(&b.polygon)));
        let mut groups: Vec<Vec<Hit>> = Vec::new();
        for hit in hits {
            match groups.last_mut() {
                Some(group) if group[0].depth_order(&hit).is_eq() => group.push(hit),
                _ => groups.push(vec![hit]),
            }
        }
        groups
    }

    fn hit(&self, ray: &Ray, polygon: usize) -> Option<Hit> {
        let corners = &self.scene.polygons[polygon];
        let from_origin = |p: Point| -> Vector {
            std::array::from_fn(|i| i128::from(p[i]) * ray.below - ray.origin[i])
        };
        let arms: Vec<Vector> = corners.iter().map(|&p| from_origin(p)).collect();
        let mut seen = [false; 2];
        for (i, a) in arms.iter().enumerate() {
            match turn([&ray.direction, a, &arms[(i + 1) % arms.len()]]) {
                Ordering::Greater => seen[0] = true,
                Ordering::Less => seen[1] = true,
                Ordering::Equal => {}
            }
            if seen == [true; 2] {
                return None;
            }
        }
        let plane = &self.planes[polygon];
        let (origin, direction) = (big(ray.origin), big(ray.direction));
        let mut slope = scalar(&plane.normal, &direction);
        let mut start = &plane.offset * ray.below - scalar(&plane.normal, &origin);
        match sign(&slope) {
            // A polygon seen edge-on hides nothing.
            Ordering::Equal => return None,
            Ordering::Less => (slope, start) = (-slope, -start),
            Ordering::Greater => {}
        }
        if !ray.endless && sign(&start).is_le() {
            return None;
        }
        let numerators: Big = std::array::from_fn(|i| &origin[i] * &slope + &start * &direction[i]);
        let rounded = float(&start) / float(&slope);
        let spot = Spot::new(numerators, &slope * ray.below);
        Some(Hit { polygon, spot, depth: [start, slope], rounded })
    }
}

/// Whether all corners turn one way.
fn is_convex(polygon: &[Point], plane: &Plane) -> bool {
    let n = polygon.len();
    let arm = |k: usize| -> Big {
        let (a, b) = (polygon[k % n], polygon[(k + 1) % n]);
        big(wide(minus(b, a)))
    };
    (0..n).all(|k| {
        let turn = product(&arm(k), &arm(k + 1));
        sign(&scalar(&turn, &plane.normal)).is_ge()
    })
}

impl Ray {
    /// Returns whether the whole ray lies in a plane.
    pub fn is_in(&self, plane: &Plane) -> bool {
        let start = scalar(&plane.normal, &big(self.origin)) - &plane.offset * self.below;
        sign(&start).is_eq() && sign(&scalar(&plane.normal, &big(self.direction))).is_eq()
    }

    /// Returns the distance of the ray's start from a plane; `None` if the ray is endless.
    pub fn start_from(&self, plane: &Plane) -> Option<f64> {
        let eye = Spot::new(big(self.origin), self.below.into());
        (!self.endless).then(|| plane.distance(&eye))
    }
}
