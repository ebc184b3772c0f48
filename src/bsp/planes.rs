//! On which sides of a tree's planes an eye is.

use std::cmp::Ordering;

use glam::{DVec4, Vec4};

use super::BspTree;
use super::node::Node;
use crate::geom::{Eye, Faces, Kernel, LATTICE_LIMIT, Viewpoint, parallel};

/// So many planes stand together, and so many signs in a word.
const GROUP: usize = 4;
const WORD: usize = 32;

/// So many groups are made by one thread at a time.
const PART: usize = 1024;

/// The rounded planes of a tree's nodes, in the order of the nodes and by fours: the three
/// coordinates of their unit normals, and their distances from the lattice's origin in 2⁵¹ lattice
/// units. The last group is filled up with zeros.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Planes(Vec<[Vec4; 4]>);

impl Planes {
    pub(super) fn new(faces: &Faces, nodes: &[Node]) -> Self {
        let group = |nodes: &[Node]| {
            let mut group = [Vec4::ZERO; 4];
            for (i, node) in nodes.iter().enumerate() {
                let plane = faces.plane(node.plane);
                let (normal, offset) = (plane.normal_f64(), plane.offset_f64());
                let all = normal.extend(offset / LATTICE_LIMIT) / normal.length();
                for (part, value) in group.iter_mut().zip(all.as_vec4().to_array()) {
                    part[i] = value;
                }
            }
            group
        };
        let parts = parallel::map(nodes.chunks(PART * GROUP).collect(), |nodes| {
            nodes.chunks(GROUP).map(group).collect::<Vec<_>>()
        });
        Self(parts.concat())
    }

    /// How many words the signs of all planes take, and one more to read past the end.
    pub(super) fn words(&self) -> usize {
        self.0.len().div_ceil(WORD / GROUP) + 1
    }

    /// The resident size in bytes, apart from its own.
    pub(super) fn bytes(&self) -> usize {
        size_of_val(&*self.0)
    }
}

/// A viewpoint made ready for a tree's nodes.
#[derive(Clone, Copy, Debug)]
pub(super) struct View {
    eye: Eye,
    /// In 2⁵¹ lattice units, homogeneous, the largest coordinate 1.
    point: Vec4,
    /// What a rounded distance may be off by.
    bound: f32,
}

impl View {
    pub(super) fn new<K: Kernel>(tree: &BspTree<K>, viewpoint: Viewpoint) -> Self {
        let eye = Eye::new(viewpoint, tree.faces.lattice());
        let (e, w) = eye.homogeneous();
        let point = DVec4::new(e[0], e[1], e[2], w * LATTICE_LIMIT);
        let point = (point / point.abs().max_element()).as_vec4();
        // Normal, eye, their products and three sums are each off by 2⁻²⁴ of themselves. The
        // normal's coordinates are at most 1, the offset √3.
        let size = point.x.abs() + point.y.abs() + point.z.abs() + 2.0 * point.w;
        Self { eye, point, bound: size * 4.0 * f32::EPSILON }
    }

    /// The rounded distances of the eye from four planes.
    #[inline]
    fn distances(&self, [x, y, z, offset]: &[Vec4; 4]) -> Vec4 {
        let p = self.point;
        *x * p.x + *y * p.y + *z * p.z - *offset * p.w
    }

    /// Whether the eye is in front of a node's plane; certified.
    pub(super) fn is_in_front<K: Kernel>(&self, tree: &BspTree<K>, node: usize) -> bool {
        let distance = self.distances(&tree.planes.0[node / GROUP])[node % GROUP];
        if distance.abs() > self.bound { distance > 0.0 } else { self.decide(tree, node) }
    }

    /// Writes for every node whether the eye is in front of its plane, a bit each; certified.
    pub(super) fn write_signs<K: Kernel>(&self, tree: &BspTree<K>, words: &mut [u32]) {
        for (w, (word, groups)) in
            words.iter_mut().zip(tree.planes.0.chunks(WORD / GROUP)).enumerate()
        {
            let (mut front, mut sure) = (0, 0);
            for (g, group) in groups.iter().enumerate() {
                let distances = self.distances(group);
                let bound = Vec4::splat(self.bound);
                front |= distances.cmpgt(bound).bitmask() << (GROUP * g);
                sure |= distances.abs().cmpgt(bound).bitmask() << (GROUP * g);
            }
            *word = front;
            let nodes = WORD * w..tree.nodes.len().min(WORD * (w + 1));
            let all = u32::MAX >> (WORD - nodes.len());
            if sure & all != all {
                *word |= self.decide_rest(tree, nodes.start, !sure & all);
            }
        }
    }

    /// Decides on the nodes from `first` on that have a bit in `unsure`.
    #[cold]
    fn decide_rest<K: Kernel>(&self, tree: &BspTree<K>, first: usize, mut unsure: u32) -> u32 {
        let mut front = 0;
        while unsure != 0 {
            let bit = unsure.trailing_zeros();
            unsure &= unsure - 1;
            front |= u32::from(self.decide(tree, first + bit as usize)) << bit;
        }
        front
    }

    #[cold]
    fn decide<K: Kernel>(&self, tree: &BspTree<K>, node: usize) -> bool {
        let plane = tree.nodes[node].plane;
        tree.kernel.eye_side(&tree.faces, plane, &self.eye) == Ordering::Greater
    }
}
