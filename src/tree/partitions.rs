//! The partition planes of a tree, to be looked at.

use std::iter::FusedIterator;
use std::ops::Range;

use glam::DVec3;

use super::BspTree;
use super::node::Ranges;
use super::walk::{Visit, Walk};
use crate::exact::{Faces, PlaneId, PlaneKind};

/// A partition plane, and which fragments lie on which side of it; see [`BspTree::partitions`].
///
/// The plane holds the points p with `normal.dot(p) == offset`; its front is where the left side is
/// larger. Both are rounded. The tree itself decides by the exact plane.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Partition {
    /// The unit normal, which points to the front.
    pub normal: DVec3,
    /// The distance of the plane from the origin along the normal, in the polygons' unit. Infinite
    /// if it is too large for `f64`.
    pub offset: f64,
    /// How many planes there are on the path from the root to this one, both included.
    pub depth: usize,
    /// The numbers of the fragments on the plane.
    pub on: Range<u32>,
    /// The numbers of all fragments in front, down to the leaves.
    pub front: Range<u32>,
    /// The numbers of all fragments behind, down to the leaves.
    pub back: Range<u32>,
    plane: PlaneId,
}

impl Partition {
    fn new(tree: &BspTree, visit: Visit) -> Self {
        let node = &tree.nodes[visit.node];
        let (normal, offset) = rounded(&tree.faces, node.plane);
        let (depth, plane) = (visit.depth, node.plane);
        let Visit { own: on, in_front: front, behind: back, .. } = visit;
        Self { normal, offset, depth, on, front, back, plane }
    }

    /// The plane's exact name, by a face or corner of [`BspTree::faces`].
    #[doc(hidden)]
    pub fn plane(&self) -> PlaneId {
        self.plane
    }
}

/// A plane's unit normal and offset in the polygons' unit.
fn rounded(faces: &Faces, plane: PlaneId) -> (DVec3, f64) {
    let corner = match plane.kind() {
        PlaneKind::Face(face) => faces.reference_triangle(face)[0],
        PlaneKind::Axis(_, corner) => corner,
    };
    let point = faces.lattice().to_world(faces.corner(corner));
    let normal = faces.plane(plane).normal_f64().normalize();
    (normal, normal.dot(point))
}

/// The partition planes of a tree, depth first: [`BspTree::partitions`].
#[derive(Clone, Debug)]
pub struct Partitions<'t> {
    tree: &'t BspTree,
    walk: Walk,
    left: usize,
}

impl Iterator for Partitions<'_> {
    type Item = Partition;

    fn next(&mut self) -> Option<Partition> {
        let visit = self.walk.next(self.tree)?;
        self.left -= 1;
        Some(Partition::new(self.tree, visit))
    }

    fn size_hint(&self) -> (usize, Option<usize>) {
        (self.left, Some(self.left))
    }
}

impl DoubleEndedIterator for Partitions<'_> {
    fn next_back(&mut self) -> Option<Partition> {
        let visit = self.walk.next_back(self.tree)?;
        self.left -= 1;
        Some(Partition::new(self.tree, visit))
    }
}

impl ExactSizeIterator for Partitions<'_> {}
impl FusedIterator for Partitions<'_> {}

impl BspTree {
    /// The partition planes, depth first, those in front of each before those behind it: to draw,
    /// measure or check a tree. O(nodes) for all of them.
    pub fn partitions(&self) -> Partitions<'_> {
        Partitions { tree: self, walk: Walk::new(self), left: self.nodes.len() }
    }

    /// The partition plane that parts two fragments, or that both lie on; `None` if both are in one
    /// leaf, which a fragment in a leaf is with itself. O(depth).
    ///
    /// # Panics
    ///
    /// If there are no such fragments.
    #[doc(hidden)]
    pub fn plane_between(&self, a: u32, b: u32) -> Option<PlaneId> {
        let high = a.max(b);
        assert!((high as usize) < self.records.len(), "no fragment {high}");
        let (mut index, mut fragments) = (0, 0..self.records.len() as u32);
        loop {
            let node = &self.nodes[index];
            let Ranges { front, back, .. } = node.ranges(fragments);
            let has_both = |side: &Range<u32>| side.contains(&a) && side.contains(&b);
            let (child, side) = if has_both(&front) {
                (node.front_node(index), front)
            } else if has_both(&back) {
                (node.back_node(index), back)
            } else {
                return Some(node.plane);
            };
            // Without a node both are in one leaf.
            (index, fragments) = (child?, side);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::SplitMix64;
    use crate::{BuildOptions, Heuristic, scene};

    /// The plane between any two fragments by the ranges of all partitions, in a table: a pair that
    /// is not on one side of a plane is parted there, and nowhere else.
    fn table(tree: &BspTree) -> Vec<Vec<Option<PlaneId>>> {
        let mut table = vec![vec![None; tree.len()]; tree.len()];
        for partition in tree.partitions() {
            let plane = partition.plane();
            let Partition { on, front, back, .. } = partition;
            for (one, other) in [(&on, &on), (&on, &front), (&on, &back), (&front, &back)] {
                for a in one.clone() {
                    for b in other.clone() {
                        let known = [(a, b), (b, a)]
                            .map(|(a, b)| table[a as usize][b as usize].replace(plane));
                        assert!(one == other || known == [None; 2], "{a} and {b} are parted twice");
                    }
                }
            }
        }
        table
    }

    /// Triangles at random, some on planes of others, some twice.
    fn soup(seed: u64) -> Vec<[glam::DVec3; 3]> {
        let mut random = SplitMix64::new(seed);
        let mut triangles: Vec<[glam::DVec3; 3]> = Vec::new();
        for k in 0..4 + seed % 40 {
            let triangle = std::array::from_fn(|_| random.point(-1.0, 1.0));
            let of_before = triangles.get((random.next() % (k + 1)) as usize).copied();
            triangles.push(match (of_before, random.next() % 4) {
                (Some(other), 0) => other,
                // In the same plane, if it is one of constant z.
                (_, 1) => triangle.map(|p| p.with_z((4.0 * triangle[0].z).round() / 4.0)),
                _ => triangle,
            });
        }
        triangles
    }

    #[test]
    fn the_plane_between_two_fragments_is_the_one_that_parts_them() {
        let (mut pairs, mut in_one_leaf, mut on_one_plane, mut most) = (0, 0, 0, 0);
        let mut check = |tree: &BspTree, case: &str| {
            let table = table(tree);
            for a in 0..tree.len() as u32 {
                for b in 0..tree.len() as u32 {
                    let expected = table[a as usize][b as usize];
                    assert_eq!(tree.plane_between(a, b), expected, "{a} and {b}, {case}");
                    pairs += usize::from(a != b);
                    in_one_leaf += usize::from(expected.is_none());
                }
            }
            on_one_plane += tree.partitions().filter(|p| p.on.len() > 1).count();
            most = most.max(tree.len());
        };
        for seed in 0..40 {
            for &heuristic in Heuristic::ALL {
                let options = BuildOptions::DEFAULT.with_heuristic(heuristic);
                let tree = options.build(soup(seed)).unwrap();
                check(&tree, &format!("seed {seed}, {heuristic}"));
            }
        }
        for scene in [scene::chain(60), scene::random_triangles(40, 2), scene::newell_bars()] {
            check(&BspTree::build(scene.polygons()).unwrap(), scene.name());
        }
        assert!(pairs > 1_000_000 && most > 200, "{pairs} pairs, trees up to {most} fragments");
        assert!(in_one_leaf > 1000 && on_one_plane > 1000, "{in_one_leaf}, {on_one_plane}");
    }
}
