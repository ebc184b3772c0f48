//! The fragments that have points in a convex region.

use std::fmt::Debug;
use std::iter::FusedIterator;
use std::ops::Range;

use smallvec::SmallVec;

use super::ray::upright;
use crate::exact::half_space::{self, ExactHalfSpace, LineValues};
use crate::exact::{EdgeLine, Faces, VertexKind};
use crate::tree::bounds::Bounds;
use crate::tree::{BspTree, Flat, Fragment, HalfSpace, rounding};
use crate::viewpoint::Frustum;

/// The numbers of the fragments that have points in a region: [`BspTree::fragments_in`].
#[derive(Clone, Debug)]
struct FragmentsIn<'t> {
    tree: &'t BspTree,
    bounds: &'t Bounds,
    sides: SmallVec<[RegionPlane; 6]>,
    rest: Range<u32>,
    /// Fragments that are inside the region and precede `rest`.
    inside: Range<u32>,
}

/// A plane of a region.
#[derive(Clone, Debug)]
struct RegionPlane {
    exact: ExactHalfSpace,
    /// A box behind this half-space has no point in front of the plane or on it.
    outer: HalfSpace,
    /// A box behind this half-space is in front of the plane.
    inner: HalfSpace,
}

impl<'t> FragmentsIn<'t> {
    fn new(tree: &'t BspTree, region: &Frustum) -> Self {
        let lattice = tree.faces.lattice();
        let side = |&(normal, offset): &(glam::DVec3, f64)| {
            let of = |plane| HalfSpace::new(plane, lattice);
            let exact = ExactHalfSpace::new(normal, offset, lattice)?;
            Some(RegionPlane { exact, outer: of((normal, offset)), inner: of((-normal, -offset)) })
        };
        let sides = region.planes().iter().filter_map(side).collect();
        Self { tree, bounds: tree.boxes(), sides, rest: 0..tree.len() as u32, inside: 0..0 }
    }

    /// Whether a fragment has a point in the region. The decision is exact.
    fn meets(&self, number: u32) -> bool {
        let (fragment, faces) = (self.tree.fragment(number), &self.tree.faces);
        let bounds = &self.bounds.get(0, number);
        // Planes that the whole fragment is in front of need not be tested.
        let crossed = self.sides.iter().filter(|side| !side.inner.is_behind(bounds));
        let crossed: SmallVec<[&ExactHalfSpace; 6]> = crossed.map(|side| &side.exact).collect();
        match guess(&fragment, faces, &crossed) {
            Some(meets) => meets,
            None => half_space::meets(faces, fragment.face(), outline(&fragment, faces), &crossed),
        }
    }
}

/// Whether a fragment has a point in the intersection of some half-spaces, if the rounded positions of the
/// fragment's vertices decide this: one vertex is inside all half-spaces, or all vertices are outside one
/// half-space.
fn guess(fragment: &Fragment<'_>, faces: &Faces, sides: &[&ExactHalfSpace]) -> Option<bool> {
    let mut is_out = SmallVec::<[bool; 6]>::from_elem(true, sides.len());
    let moved = faces.moved_axis(fragment.face());
    for (vertex, vertex_id) in fragment.lattice_vertices().zip(fragment.vertex_ids()) {
        let is_cut = !matches!(vertex_id.kind(), VertexKind::Corner(_));
        let off = rounding(vertex, is_cut, moved);
        let mut is_in = true;
        for (side, is_out) in sides.iter().zip(&mut is_out) {
            let [least, most] = side.range(&vertex, off);
            is_in &= least > 0.0;
            *is_out &= most < 0.0;
        }
        if is_in {
            return Some(true);
        }
    }
    is_out.contains(&true).then_some(false)
}

/// The vertices of a fragment, with the line from each vertex to the next.
fn outline<'f>(
    fragment: &Fragment<'f>,
    faces: &'f Faces,
) -> impl Iterator<Item = (crate::exact::VertexId, LineValues)> + use<'f> {
    let face = fragment.face();
    let triangle = faces.triangle(face);
    let values = move |line: EdgeLine| {
        let plane = match line.as_cut() {
            Some(plane) => faces.plane(plane),
            None => upright(faces, face, line.as_edge().unwrap_or(0) as usize).0,
        };
        triangle.map(|point| plane.at(&point))
    };
    fragment.vertex_ids().zip(fragment.lines().map(values))
}

impl Iterator for FragmentsIn<'_> {
    type Item = u32;

    fn next(&mut self) -> Option<u32> {
        loop {
            if let Some(number) = self.inside.next() {
                return Some(number);
            }
            let sides = &self.sides;
            let (block, is_inside) = self.bounds.next_block(&mut self.rest, |bounds: &Flat| {
                if sides.iter().any(|side| side.outer.is_behind(bounds)) {
                    Some(false)
                } else {
                    sides.iter().all(|side| side.inner.is_behind(bounds)).then_some(true)
                }
            })?;
            if is_inside || self.meets(block.start) {
                self.inside = block;
            }
        }
    }
}

impl FusedIterator for FragmentsIn<'_> {}

impl BspTree {
    /// Returns the numbers of the fragments that have a point in a region, in ascending order. The region is
    /// a box, or the points in front of several planes ([`Frustum`]). The result is exact: a fragment that
    /// touches the region's boundary is included, and a fragment outside the region is not.
    /// ([`Culling`](crate::Culling) tests only boxes, so it is faster, but keeps some fragments outside.)
    ///
    /// ```
    /// use binspace::glam::DVec3;
    /// use binspace::{BspTree, Frustum};
    ///
    /// let slanted = |x: f64| [[x, 0.0, 0.0], [x + 8.0, 0.0, 8.0], [x, 1.0, 0.0]];
    /// let tree = BspTree::build([slanted(0.0), slanted(4.0)])?;
    /// // The region is in the bounding boxes of both triangles, but only one triangle meets it.
    /// let region = Frustum::from_box([DVec3::new(6.0, 0.0, 1.0), DVec3::new(7.0, 1.0, 2.5)]);
    /// let inside: Vec<u32> = tree.fragments_in(&region).collect();
    /// assert_eq!(inside.len(), 1);
    /// assert_eq!(tree.fragment(inside[0]).polygon(), 1);
    /// # Ok::<(), binspace::Error>(())
    /// ```
    ///
    /// The test uses the polygons as stored in the tree: corners are rounded to the tree's
    /// [grid](Self#exactness), and corners that were off the polygon's plane by less than the tolerance are
    /// moved onto the plane. The region is used as given, except for very small digits: digits of a normal
    /// below 2⁻¹¹⁵ of the normal's largest coordinate, and digits of an offset below 2⁻¹¹⁵ of the scene's
    /// extent (the longest side of the scene's bounding box). A plane with an infinite or NaN number excludes
    /// nothing.
    ///
    /// The time is mostly proportional to the number of fragments found, plus the number of fragments close
    /// to the region's boundary. The first call computes the tree's boxes, in O(n) time
    /// ([`bounds`](Self::bounds)).
    pub fn fragments_in<'t>(
        &'t self,
        region: &Frustum,
    ) -> impl FusedIterator<Item = u32> + Clone + Debug + use<'t> {
        FragmentsIn::new(self, region)
    }
}
