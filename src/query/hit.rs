//! Where a ray hits a polygon.

use std::cmp::Ordering;

use glam::DVec3;

use super::chord::Spot;
use crate::exact::eye::{ExactRay, Parameter};
use crate::ray::Ray;
use crate::tree::{BspTree, Fragment};

/// Where a ray hits a polygon: [`BspTree::hits`].
#[derive(Clone, Copy)]
pub struct Hit<'t> {
    pub(super) tree: &'t BspTree,
    pub(super) ray: Ray,
    pub(super) fragment: u32,
    pub(super) spot: Spot,
    pub(super) facing: Ordering,
}

impl<'t> Hit<'t> {
    /// The fragment that is hit. Where several fragments of the polygon meet in the point, it is one
    /// of them.
    pub fn fragment(&self) -> Fragment<'t> {
        self.tree.fragment(self.fragment)
    }

    /// The index, in the input, of the polygon that is hit.
    pub fn polygon(&self) -> usize {
        self.fragment().polygon()
    }

    /// The side of the fragment that is hit, exactly: `Greater` if it is the front, `Less` if it is the
    /// back, `Equal` if the ray lies in the fragment's plane. It depends on the ray's direction alone,
    /// so it is the same for a ray that begins on the fragment.
    pub fn facing(&self) -> Ordering {
        self.facing
    }

    /// How far along the ray the point is: it is at `from + parameter * direction`. It is the `f64` that is
    /// nearest to the exact fraction, or its neighbour where these are about as near; infinite if `f64`
    /// cannot hold it.
    ///
    /// Computed at each call, about 0.1 µs.
    pub fn parameter(&self) -> f64 {
        let exact = self.exact();
        exact.map_or(f64::NAN, |(ray, t)| ray.parameter(&t))
    }

    /// The point. It is rounded as a fragment's vertices are: each coordinate is within 2⁻⁵¹ of the
    /// scene's extent plus one step of `f64` of its exact value, however far away the ray begins and
    /// however flat it comes in.
    ///
    /// Computed at each call, about 0.2 µs.
    pub fn point(&self) -> DVec3 {
        let exact = self.exact();
        exact.map_or(DVec3::NAN, |(ray, t)| self.tree.faces.lattice().to_world(ray.point(&t)))
    }

    /// How far two hits of the same ray are along it: `Less` if this one is nearer. It is exact, where
    /// [`parameter`](Self::parameter) and [`point`](Self::point) may have been rounded to the same.
    /// Hits of different rays, or of different trees, do not compare in any useful way.
    pub fn compare(&self, other: &Self) -> Ordering {
        match (self.exact(), other.exact()) {
            (Some((_, t)), Some((_, other))) => t.compare(&other),
            _ => Ordering::Equal,
        }
    }

    /// The exact point, by what defines it: three points of the tree's [grid](BspTree::grid). The hit is
    /// where the ray meets the plane through them: mostly that of the fragment; for a ray that lies in the
    /// fragment's plane, one through an edge. `None` if it is an end of the ray, which is then within the
    /// polygon: its beginning if [`parameter`](Self::parameter) is 0.
    ///
    /// With the ray as it is given (see [`Ray`]) this is the point exactly, as a fraction: with n the
    /// vector product of q − p and r − p, its parameter is n·(p − from) / n·direction.
    pub fn grid_points(&self) -> Option<[[i64; 3]; 3]> {
        self.spot.grid_points(&self.tree.faces)
    }

    /// The point by what defines it: a plane, mostly that of the face, and the ray.
    #[doc(hidden)]
    pub fn spot(&self) -> Spot {
        self.spot
    }

    /// The ray in integers, and the parameter. There is no hit without.
    fn exact(&self) -> Option<(ExactRay, Parameter)> {
        let faces = &self.tree.faces;
        let ray = ExactRay::new(self.ray, faces.lattice())?;
        Some((ray, self.spot.parameter(&ray, faces)))
    }
}

impl std::fmt::Debug for Hit<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Hit")
            .field("polygon", &self.polygon())
            .field("fragment", &self.fragment)
            .field("parameter", &self.parameter())
            .field("point", &self.point())
            .field("facing", &self.facing)
            .finish()
    }
}
