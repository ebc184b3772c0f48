//! Computes the eye's side of each partition plane, several planes at a time.

use std::cmp::Ordering;
use std::ops::Range;

use glam::{DVec3, DVec4, Vec4};

use crate::bits::bits;
use crate::exact::{Eye, Faces, LATTICE_LIMIT, PlaneId, PlaneKind};
use crate::memory::{collect, reserve};
use crate::tree::BspTree;
use crate::tree::node::NodeRecord;
use crate::viewpoint::Viewpoint;
use crate::{Error, parallel_map};

/// Error bound: a rounded distance of the wrong sign is at most `ERROR` · (|p| + 2w). Here p and w
/// are the eye's homogeneous coordinates, scaled so that the largest of the four is 1, and |p| is the
/// sum of the magnitudes of the first three.
///
/// Let u = 2⁻²⁴, n the unit normal, o ≤ √3 the offset, T = Σ |nᵢpᵢ|, and N = n·p. For a wrong sign, N is ow
/// up to rounding. Normal, eye and their products are off by 3uT. Offset, w and their product are off by
/// 3u|N|. The sums are off by u|n₀p₀ + n₁p₁| ≤ uT and u|N|, and their difference by almost nothing. The
/// coordinate that is 1 is not rounded, and neither is its product, so 2u of that product is subtracted.
///
/// - If w is 1: 4T + 2|N| ≤ 6T ≤ 6 √|p| ≤ 3(|p| + 1).
/// - If pₖ is 1: with T' the rest of T, at most √(1 − nₖ²) times the rest of |p|, and N ≤ √3 w: 2|nₖ| + 4T' +
///   4|N| ≤ 2 + 3(|p| − 1) + 6.93 w.
///
/// So the error is at most 3u(|p| + 2w), and less than 0.01u(|p| + 2w) more because normals are off by 2⁻³⁴
/// before they are rounded to `f32`, and offsets by as much. Too small: wrong signs pass. Too large:
/// integers decide eyes that floats could have decided.
const ERROR: f32 = 1.505 * f32::EPSILON;

/// A viewpoint, prepared to be compared with a tree's planes.
#[derive(Clone, Copy, Debug)]
pub(crate) struct View {
    eye: Eye,
    /// The homogeneous coordinates of the viewpoint, in units of 2⁵¹ lattice steps, scaled so that the
    /// largest coordinate is 1.
    point: Vec4,
    /// The largest error of a rounded distance.
    bound: f32,
}

impl View {
    pub(crate) fn new(tree: &BspTree, viewpoint: Viewpoint) -> Self {
        let eye = Eye::new(viewpoint, tree.faces.lattice());
        let (e, w) = eye.homogeneous();
        let point = DVec4::new(e[0], e[1], e[2], w * LATTICE_LIMIT);
        let point = (point / point.abs().max_element()).as_vec4();
        let size = point.x.abs() + point.y.abs() + point.z.abs() + 2.0 * point.w;
        Self { eye, point, bound: ERROR * size }
    }

    /// The viewpoint, rounded to the tree's lattice.
    pub(in crate::tree) fn eye(&self) -> &Eye {
        &self.eye
    }

    /// The rounded distances of the eye from four planes.
    #[inline]
    fn distances(&self, [x, y, z, offset]: &[Vec4; 4]) -> Vec4 {
        let p = self.point;
        *x * p.x + *y * p.y + *z * p.z - *offset * p.w
    }

    /// Whether the eye is in front of a node's plane: by floats if the bound allows, otherwise exactly.
    pub(in crate::tree) fn is_in_front(&self, tree: &BspTree, node: usize) -> bool {
        let [x, y, z, offset] = tree.planes.get(node).to_array();
        let p = self.point;
        let distance = x * p.x + y * p.y + z * p.z - offset * p.w;
        if distance.abs() > self.bound { distance > 0.0 } else { self.decide(tree, node) }
    }

    /// Whether the eye is in front of a plane. `rounded` is the result of the function
    /// [`rounded`](fn@rounded) for that plane.
    pub(crate) fn is_in_front_of(&self, faces: &Faces, plane: PlaneId, rounded: Vec4) -> bool {
        let [x, y, z, offset] = rounded.to_array();
        let p = self.point;
        let distance = x * p.x + y * p.y + z * p.z - offset * p.w;
        if distance.abs() > self.bound {
            return distance > 0.0;
        }
        faces.eye_side(plane, &self.eye) == Ordering::Greater
    }

    /// Returns two sets of bits for the planes of `run`, at most 16: the planes that certainly have the eye
    /// in front, and the planes that certainly have the eye behind.
    #[inline]
    pub(in crate::tree) fn sure_sides(&self, planes: &Planes, run: Range<u32>) -> [u32; 2] {
        let groups = run.start as usize / GROUP..(run.end as usize).div_ceil(GROUP);
        let (mut front, mut behind) = (0, 0);
        for (g, group) in planes.0[groups].iter().enumerate() {
            let (distances, bound) = (self.distances(group), Vec4::splat(self.bound));
            front |= distances.cmpgt(bound).bitmask() << (GROUP * g);
            behind |= distances.cmplt(-bound).bitmask() << (GROUP * g);
        }
        [front, behind].map(|bits| bits >> (run.start as usize % GROUP))
    }

    /// Writes the result of [`is_in_front`](Self::is_in_front) for all nodes: a bit for each node.
    pub(in crate::tree) fn write_signs(&self, tree: &BspTree, words: &mut [u32]) {
        let groups = tree.planes.0.chunks(WORD / GROUP);
        for (w, (word, groups)) in words.iter_mut().zip(groups).enumerate() {
            *word = self.signs(tree, w, groups);
        }
    }

    /// Whether another viewpoint is on the same side of every plane. Stops at the first plane between the two
    /// viewpoints.
    pub(super) fn agrees_with(&self, other: &Self, tree: &BspTree) -> bool {
        let mut groups = tree.planes.0.chunks(WORD / GROUP).enumerate();
        groups.all(|(w, groups)| self.signs(tree, w, groups) == other.signs(tree, w, groups))
    }

    /// The word `w` of signs: a bit for each node whose plane is in `groups`.
    #[inline]
    fn signs(&self, tree: &BspTree, w: usize, groups: &[[Vec4; 4]]) -> u32 {
        let (mut front, mut sure) = (0, 0);
        for (g, group) in groups.iter().enumerate() {
            let distances = self.distances(group);
            let bound = Vec4::splat(self.bound);
            // No early exit for doubtful planes: doubtful planes are rare, and a word at a time can be
            // decided without a branch.
            front |= distances.cmpgt(bound).bitmask() << (GROUP * g);
            sure |= distances.abs().cmpgt(bound).bitmask() << (GROUP * g);
        }
        let nodes = WORD * w..tree.nodes.len().min(WORD * (w + 1));
        // The padding of the last group has distance 0 and is never sure, so it is masked out.
        let all = u32::MAX >> (WORD - nodes.len());
        if sure & all != all {
            front |= self.decide_rest(tree, nodes.start, !sure & all);
        }
        front
    }

    /// Decides exactly for the nodes that have a bit in `unsure`; bit 0 stands for node `first`.
    #[cold]
    fn decide_rest(&self, tree: &BspTree, first: usize, unsure: u32) -> u32 {
        bits(unsure.into())
            .fold(0, |front, bit| front | u32::from(self.decide(tree, first + bit)) << bit)
    }

    #[cold]
    fn decide(&self, tree: &BspTree, node: usize) -> bool {
        let plane = tree.nodes[node].plane;
        tree.faces.eye_side(plane, &self.eye) == Ordering::Greater
    }
}

impl BspTree {
    /// Returns true if no partition plane lies between two viewpoints. Then the order of all fragments is the
    /// same for both viewpoints, and need not be written or uploaded again. If a partition plane lies between
    /// the viewpoints, the result is false, even if the two orders happen to be the same.
    ///
    /// [Culled](crate::Order::culled) orders also depend on the facing of polygons and on the frustum. So for
    /// culled orders, compare the two lists of numbers instead. For an overlay, use
    /// [`Overlay::same_order`](crate::overlay::Overlay::same_order).
    ///
    /// Takes O(nodes) time, or less: the search stops at the first plane between the viewpoints. Allocates
    /// nothing.
    ///
    /// ```
    /// use binspace::{BspTree, Viewpoint};
    ///
    /// let square = |z: f64| [[0.0, 0.0, z], [1.0, 0.0, z], [1.0, 1.0, z], [0.0, 1.0, z]];
    /// let tree = BspTree::build([square(2.0), square(0.0), square(1.0)])?;
    /// let eye = |z: f64| Viewpoint::eye([0.5, 0.5, z]);
    /// assert!(tree.same_order(eye(3.0), eye(9.0)));
    /// assert!(!tree.same_order(eye(-1.0), eye(9.0)));
    /// # Ok::<(), binspace::Error>(())
    /// ```
    pub fn same_order(&self, one: Viewpoint, other: Viewpoint) -> bool {
        View::new(self, one).agrees_with(&View::new(self, other), self)
    }
}

/// The number of planes in a group, and of signs in a word.
pub(super) const GROUP: usize = 4;
pub(super) const WORD: usize = 32;

/// The number of groups that one thread makes at a time.
const GROUPS_A_THREAD: usize = 1024;

/// The rounded planes of a tree's nodes, or of its fragments, in order and in groups of four: the three
/// coordinates of the planes' unit normals, and the planes' distances from the lattice's origin in 2⁵¹
/// lattice units. The last group is filled up with zeros.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Planes(pub(super) Vec<[Vec4; 4]>);

/// Up to [`GROUP`] planes, component by component.
fn group(planes: impl Iterator<Item = Vec4>) -> [Vec4; 4] {
    let mut group = [Vec4::ZERO; 4];
    for (i, plane) in planes.enumerate() {
        for (part, value) in group.iter_mut().zip(plane.to_array()) {
            part[i] = value;
        }
    }
    group
}

impl Planes {
    /// The rounded plane of a node, as returned by [`rounded`].
    pub(crate) fn get(&self, node: usize) -> Vec4 {
        let group = &self.0[node / GROUP];
        Vec4::from_array(group.map(|part| part[node % GROUP]))
    }

    pub(in crate::tree) fn clear(&mut self) {
        self.0.clear();
    }

    /// Replaces the planes by the planes of a tree's nodes.
    pub(in crate::tree) fn fill(
        &mut self,
        faces: &Faces,
        nodes: &[NodeRecord],
    ) -> Result<(), Error> {
        let group =
            |nodes: &[NodeRecord]| group(nodes.iter().map(|node| rounded(faces, node.plane)));
        self.0.clear();
        reserve(&mut self.0, nodes.len().div_ceil(GROUP))?;
        if nodes.len() <= GROUPS_A_THREAD * GROUP {
            self.0.extend(nodes.chunks(GROUP).map(group));
            return Ok(());
        }
        let parts = parallel_map::map(nodes.chunks(GROUPS_A_THREAD * GROUP).collect(), |nodes| {
            collect(nodes.chunks(GROUP).map(group))
        })?;
        parts.into_iter().for_each(|part| self.0.extend(part));
        Ok(())
    }

    /// The given rounded planes, in order.
    pub(in crate::tree) fn of(mut planes: impl ExactSizeIterator<Item = Vec4>) -> Self {
        let groups = 0..planes.len().div_ceil(GROUP);
        Self(groups.map(|_| group(planes.by_ref().take(GROUP))).collect())
    }

    /// The number of words for the signs of all planes, and one more word to read past the end.
    pub(in crate::tree) fn words(&self) -> usize {
        self.0.len().div_ceil(WORD / GROUP) + 1
    }

    /// The size of the heap memory in bytes.
    pub(in crate::tree) fn bytes(&self) -> usize {
        size_of_val(&*self.0)
    }
}

/// A plane, rounded: the unit normal, and the distance of the plane from the lattice's origin in 2⁵¹ lattice
/// units.
pub(crate) fn rounded(faces: &Faces, id: PlaneId) -> Vec4 {
    let plane = match id.kind() {
        // Computes the same numbers as for a face, but without integers and a square root.
        PlaneKind::Axis(axis, corner) => {
            DVec3::AXES[axis].extend(faces.corner(corner)[axis] / LATTICE_LIMIT)
        }
        PlaneKind::Face(face) => {
            let [point, ..] = faces.reference_triangle(face);
            let normal = faces.normal(face);
            let offset = normal.dot(DVec3::from(faces.corner(point)) / LATTICE_LIMIT);
            normal.extend(offset) / normal.length()
        }
    };
    plane.as_vec4()
}

#[cfg(test)]
mod tests;
