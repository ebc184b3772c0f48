//! The ray casts of other libraries.

use binspace::glam::DVec3;
use bvh::aabb::{Aabb, Bounded};
use bvh::bounding_hierarchy::BHShape;
use nalgebra::{Point3, Vector3};
use parry3d::query::RayCast as _;
use parry3d_f64::query::RayCast as _;

pub(crate) trait Peer {
    /// The parameter of the nearest hit of a ray, which is given by a point and a direction.
    fn nearest(&self, ray: [DVec3; 2]) -> Option<f64>;

    /// Whether something lies between two points.
    fn is_occluded(&self, ends: [DVec3; 2]) -> bool;
}

pub(crate) struct Parry64(parry3d_f64::shape::TriMesh);

impl Parry64 {
    pub(crate) fn new(triangles: &[[DVec3; 3]]) -> Self {
        let corners = triangles.as_flattened().iter().map(|c| c.to_array().into()).collect();
        Self(parry3d_f64::shape::TriMesh::new(corners, indices(triangles)).expect("a mesh"))
    }
}

impl Peer for Parry64 {
    fn nearest(&self, [from, direction]: [DVec3; 2]) -> Option<f64> {
        let [from, direction] = [from, direction].map(|v| v.to_array().into());
        self.0.cast_local_ray(&parry3d_f64::query::Ray::new(from, direction), f64::MAX, true)
    }

    fn is_occluded(&self, [from, to]: [DVec3; 2]) -> bool {
        let [from, direction] = [from, to - from].map(|v| v.to_array().into());
        self.0.intersects_local_ray(&parry3d_f64::query::Ray::new(from, direction), 1.0)
    }
}

pub(crate) struct Parry32(parry3d::shape::TriMesh);

impl Parry32 {
    pub(crate) fn new(triangles: &[[DVec3; 3]]) -> Self {
        let corners = triangles.as_flattened().iter().map(|c| c.as_vec3().to_array().into());
        Self(parry3d::shape::TriMesh::new(corners.collect(), indices(triangles)).expect("a mesh"))
    }
}

impl Peer for Parry32 {
    fn nearest(&self, [from, direction]: [DVec3; 2]) -> Option<f64> {
        let [from, direction] = [from, direction].map(|v| v.as_vec3().to_array().into());
        let ray = parry3d::query::Ray::new(from, direction);
        Some(self.0.cast_local_ray(&ray, f32::MAX, true)?.into())
    }

    fn is_occluded(&self, [from, to]: [DVec3; 2]) -> bool {
        let [from, direction] = [from, to - from].map(|v| v.as_vec3().to_array().into());
        self.0.intersects_local_ray(&parry3d::query::Ray::new(from, direction), 1.0)
    }
}

fn indices(triangles: &[[DVec3; 3]]) -> Vec<[u32; 3]> {
    (0..triangles.len() as u32).map(|k| [3 * k, 3 * k + 1, 3 * k + 2]).collect()
}

/// A hierarchy of boxes, and the triangles in them. The triangle test of `bvh` leaves out back faces, so each
/// triangle is tested with the winding that faces the ray.
pub(crate) struct Bvh {
    hierarchy: bvh::bvh::Bvh<f64, 3>,
    triangles: Vec<Triangle>,
}

struct Triangle {
    corners: [Point3<f64>; 3],
    normal: Vector3<f64>,
    bounds: Aabb<f64, 3>,
    node: usize,
}

impl Triangle {
    fn meets(&self, ray: &bvh::ray::Ray<f64, 3>) -> f64 {
        let [a, b, c] = &self.corners;
        let is_front = self.normal.dot(&ray.direction) < 0.0;
        let (b, c) = if is_front { (b, c) } else { (c, b) };
        ray.intersects_triangle(a, b, c).distance
    }
}

impl Bounded<f64, 3> for Triangle {
    fn aabb(&self) -> Aabb<f64, 3> {
        self.bounds
    }
}

impl BHShape<f64, 3> for Triangle {
    fn set_bh_node_index(&mut self, index: usize) {
        self.node = index;
    }

    fn bh_node_index(&self) -> usize {
        self.node
    }
}

impl Bvh {
    pub(crate) fn new(triangles: &[[DVec3; 3]]) -> Self {
        let triangle = |corners: &[DVec3; 3]| {
            let corners = corners.map(|c| Point3::from(c.to_array()));
            let bounds = corners.iter().fold(Aabb::empty(), |bounds, point| bounds.grow(point));
            let normal = (corners[1] - corners[0]).cross(&(corners[2] - corners[0]));
            Triangle { corners, normal, bounds, node: 0 }
        };
        let mut triangles: Vec<Triangle> = triangles.iter().map(triangle).collect();
        let hierarchy = bvh::bvh::Bvh::build(&mut triangles);
        Self { hierarchy, triangles }
    }

    fn ray([from, direction]: [DVec3; 2]) -> bvh::ray::Ray<f64, 3> {
        bvh::ray::Ray::new(Point3::from(from.to_array()), Vector3::from(direction.to_array()))
    }
}

impl Peer for Bvh {
    fn nearest(&self, ray: [DVec3; 2]) -> Option<f64> {
        let length = ray[1].length();
        let ray = Self::ray(ray);
        let mut best = f64::INFINITY;
        // Boxes are sorted by distance: a box behind the best hit cannot contain a nearer hit.
        for triangle in self.hierarchy.nearest_traverse_iterator(&ray, &self.triangles) {
            let entry = ray.intersection_slice_for_aabb(&triangle.bounds);
            if entry.is_some_and(|(entry, _)| entry > best) {
                break;
            }
            best = best.min(triangle.meets(&ray));
        }
        best.is_finite().then_some(best / length)
    }

    fn is_occluded(&self, [from, to]: [DVec3; 2]) -> bool {
        let length = (to - from).length();
        let ray = Self::ray([from, to - from]);
        let mut met = self.hierarchy.traverse_iterator(&ray, &self.triangles);
        met.any(|triangle| triangle.meets(&ray) <= length)
    }
}
