//! The plane between two fragments.

use std::cmp::Ordering;
use std::ops::Range;

use super::BspTree;
use super::node::Ranges;
use crate::exact::PlaneId;

impl BspTree {
    /// The partition plane that parts two fragments, or that both lie on; `None` if both are in one
    /// leaf, which a fragment in a leaf is with itself. O(depth).
    ///
    /// # Panics
    ///
    /// If there are no such fragments.
    #[doc(hidden)]
    pub fn plane_between(&self, a: u32, b: u32) -> Option<PlaneId> {
        self.parting(a, b).map(|(plane, _)| plane)
    }

    /// The same, with the side of the plane to which each of the two belongs: `Greater` is the front,
    /// `Equal` the plane itself.
    pub(crate) fn parting(&self, a: u32, b: u32) -> Option<(PlaneId, [Ordering; 2])> {
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
                let side = |fragment: u32| {
                    let is_in_front = front.contains(&fragment);
                    is_in_front.cmp(&back.contains(&fragment))
                };
                return Some((node.plane, [a, b].map(side)));
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

    /// For a pair of fragments: the plane between them, and on which side of it each is.
    type Entry = Option<(PlaneId, [Ordering; 2])>;

    /// The plane between any two fragments by the ranges of all nodes, in a table: a pair that
    /// is not on one side of a plane is parted there, and nowhere else.
    fn table(tree: &BspTree) -> Vec<Vec<Entry>> {
        let mut table = vec![vec![None; tree.len()]; tree.len()];
        for node in tree.nodes() {
            let plane = node.plane();
            let on = (node.on(), Ordering::Equal);
            let front = (node.in_front(), Ordering::Greater);
            let back = (node.behind(), Ordering::Less);
            for (one, other) in [(&on, &on), (&on, &front), (&on, &back), (&front, &back)] {
                for a in one.0.clone() {
                    for b in other.0.clone() {
                        let known = [(a, one.1, b, other.1), (b, other.1, a, one.1)].map(
                            |(a, of_a, b, of_b)| {
                                let entry = &mut table[a as usize][b as usize];
                                entry.replace((plane, [of_a, of_b]))
                            },
                        );
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
                    assert_eq!(tree.parting(a, b), expected, "{a} and {b}, {case}");
                    let plane = expected.map(|(plane, _)| plane);
                    assert_eq!(tree.plane_between(a, b), plane, "{a} and {b}, {case}");
                    pairs += usize::from(a != b);
                    in_one_leaf += usize::from(expected.is_none());
                }
            }
            on_one_plane += tree.nodes().filter(|node| node.on().len() > 1).count();
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
