//! Bounding boxes of a tree's subtrees and fragments.

pub(crate) mod boxes;
pub(crate) mod half_space;
pub(super) mod normals;

use std::cmp::Ordering;
use std::ops::Range;

use glam::DVec3;

use super::order::planes::{Planes, rounded};
use super::{BspTree, Child, Fragment, Node};
use crate::Error;
use crate::exact::{Eye, Lattice, PlaneId, StoredVertex, SymbolKind};
use crate::memory::{collect, reserve};
use crate::parallel_map;
use crate::viewpoint::Viewpoint;
use boxes::{BLOCK, Block, Flat, NOTHING, in_lattice, outwards, union};
use normals::{Arms, Normals};

/// Bounding boxes of a tree's subtrees and fragments, and what their normals have in common:
/// [`BspTree::bounds`].
///
/// A tree has none of its own: make them once if you need them, and keep them beside the tree. They
/// take about 90 bytes a fragment. Once the tree is built anew or [extended](BspTree::extend) they are
/// stale: make them again too. Bounds of another tree than the one that they are used with are refused by
/// a panic; a [clone](Clone) of a tree is the same tree.
///
/// Boxes are `[low, high]` in the polygons' unit, rounded outwards: each contains the exact vertices
/// of its fragments, and those that [`Fragment::vertices`] gives. They are stored in `f32`, from the
/// scene's middle, so one is larger than needed by at most 2⁻²³ of the scene's extent, and three steps of
/// `f64`, on each side.
#[derive(Clone, Debug)]
pub struct Bounds {
    /// That of their tree.
    generation: u64,
    lattice: Lattice,
    fragments: u32,
    /// Of each node's subtree.
    pub(crate) nodes: Vec<Flat>,
    normals: Vec<Normals>,
    /// Of each fragment; then of each [`BLOCK`] fragments with consecutive numbers, of each
    /// [`BLOCK`] of these, and so on, up to a single block.
    pub(crate) levels: Vec<Vec<Block>>,
    /// Of each fragment.
    pub(super) planes: Planes,
}

/// How many fragments one thread takes at a time: whole blocks.
const FRAGMENTS_A_THREAD: usize = 256 * BLOCK;

/// A cut vertex is within three roundings of its exact position, each at most this share of a
/// coordinate, and `STEP` lattice units, which is more than `POSITION_OFF`.
const SHARE: f64 = 2.0 * f64::EPSILON;
const STEP: f64 = 1.0 / 64.0;
/// Stored is the lattice point that is nearest to a moved corner.
const MOVED: f64 = 0.5;

impl BspTree {
    /// The bounding boxes of all subtrees and fragments. O(n).
    ///
    /// # Errors
    ///
    /// If there is not enough memory.
    pub fn bounds(&self) -> Result<Bounds, Error> {
        let blocks = self.fragment_bounds()?;
        let mut nodes = Vec::new();
        reserve(&mut nodes, self.nodes.len())?;
        nodes.resize(self.nodes.len(), NOTHING);
        let mut normals = Vec::new();
        reserve(&mut normals, self.nodes.len())?;
        normals.resize(self.nodes.len(), Normals::NONE);
        let mut faces = Vec::new();
        reserve(&mut faces, self.faces.len())?;
        faces.extend(
            (0..self.faces.len() as u32).map(|face| rounded(&self.faces, PlaneId::face(face))),
        );
        let planes = Planes::of(self.records.iter().map(|record| faces[record.face as usize]))?;
        // Children come after their parents, so they are summed up before them from the last on.
        for node in self.nodes().rev() {
            let index = node.index();
            let parts = [node.front(), Child::Leaf(node.on()), node.back()];
            for part in parts {
                match part {
                    Child::Node(child) => {
                        nodes[index] = union(nodes[index], nodes[child.index()]);
                        normals[index] = normals[index].union(normals[child.index()]);
                    }
                    Child::Leaf(run) => {
                        for fragment in run.start as usize..run.end as usize {
                            let bounds = blocks[fragment / BLOCK].get(fragment % BLOCK);
                            let normal = faces[self.records[fragment].face as usize].truncate();
                            nodes[index] = union(nodes[index], bounds);
                            normals[index] = normals[index].union(Normals::of(normal));
                        }
                    }
                }
            }
        }
        let (mut levels, mut len) = (vec![blocks], self.len());
        while let Some(last) = levels.last().filter(|last| last.len() > 1) {
            let mut next = Vec::new();
            reserve(&mut next, last.len().div_ceil(BLOCK))?;
            next.extend((0..last.len()).step_by(BLOCK).map(|first| {
                let blocks = last.iter().zip((0..len).step_by(BLOCK)).skip(first);
                Block::new(blocks.map(|(block, first)| block.all(len - first)))
            }));
            len = last.len();
            levels.push(next);
        }
        let (lattice, fragments) = (*self.faces.lattice(), self.len() as u32);
        let generation = self.generation;
        Ok(Bounds { generation, lattice, fragments, nodes, normals, levels, planes })
    }

    fn fragment_bounds(&self) -> Result<Vec<Block>, Error> {
        let mut blocks = Vec::new();
        reserve(&mut blocks, self.len().div_ceil(BLOCK))?;
        let starts = (0..self.len()).step_by(FRAGMENTS_A_THREAD);
        let parts = parallel_map::map(starts.collect(), |start| {
            let end = (start + FRAGMENTS_A_THREAD).min(self.len());
            let boxes =
                |first: usize| (first..end).map(|number| self.fragment(number as u32).bounds());
            collect((start..end).step_by(BLOCK).map(|first| Block::new(boxes(first))))
        })?;
        parts.into_iter().for_each(|part| blocks.extend(part));
        Ok(blocks)
    }
}

impl Fragment<'_> {
    fn bounds(&self) -> Flat {
        let faces = self.faces;
        let moved = faces.upright_axis(self.face);
        let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
        let mut stored = self.stored().iter();
        for vertex in self.lattice_vertices() {
            let symbol = stored.next().map(StoredVertex::symbol);
            let is_cut = symbol.is_some_and(|s| !matches!(s.kind(), SymbolKind::Corner(_)));
            let off = rounding(vertex, is_cut, moved);
            for axis in 0..3 {
                low[axis] = low[axis].min(vertex[axis] - off[axis]);
                high[axis] = high[axis].max(vertex[axis] + off[axis]);
            }
        }
        outwards(low, high)
    }
}

/// How far the rounded place of a vertex, in lattice units, may be from the exact one along each axis: by
/// whether a cut made it, and along which axis its face's corners were moved, if they were.
pub(crate) fn rounding(vertex: [f64; 3], is_cut: bool, moved: Option<usize>) -> [f64; 3] {
    std::array::from_fn(|axis| {
        let rounded = if is_cut { vertex[axis].abs() * SHARE + STEP } else { 0.0 };
        if moved == Some(axis) { rounded + MOVED } else { rounded }
    })
}

/// Bounds of two trees are equal if their boxes are.
impl PartialEq for Bounds {
    fn eq(&self, other: &Self) -> bool {
        let Self { generation: _, lattice, fragments, nodes, normals, levels, planes } = self;
        (lattice, fragments, nodes) == (&other.lattice, &other.fragments, &other.nodes)
            && (normals, levels, planes) == (&other.normals, &other.levels, &other.planes)
    }
}

impl Bounds {
    /// Panics if the bounds belong to another tree: stale boxes would leave out fragments that are visible
    /// or hit.
    pub(crate) fn expect(&self, tree: &BspTree) {
        assert!(
            self.generation == tree.generation,
            "the bounds are not those of the tree: make them again by BspTree::bounds"
        );
    }

    /// The box of a subtree: of all fragments on a node's plane and on its sides. O(1).
    ///
    /// # Panics
    ///
    /// If the node is of another tree.
    pub fn of(&self, node: Node<'_>) -> [DVec3; 2] {
        self.expect(node.tree);
        self.in_world(&self.nodes[node.index()])
    }

    /// The box of a fragment, by its number. O(1).
    ///
    /// # Panics
    ///
    /// If there is no such fragment.
    pub fn of_fragment(&self, fragment: u32) -> [DVec3; 2] {
        assert!(fragment < self.fragments, "there is no fragment {fragment}");
        self.in_world(&self.get(0, fragment))
    }

    /// The box of all fragments; `None` if there are none.
    pub fn all(&self) -> Option<[DVec3; 2]> {
        let top = self.levels.len() - 1;
        let block = self.levels[top].first()?;
        Some(self.in_world(&block.all(self.len_of(top))))
    }

    fn in_world(&self, bounds: &Flat) -> [DVec3; 2] {
        let [low, high] = in_lattice(bounds);
        self.lattice.enclose(low, high)
    }

    /// Which side all fragments of a subtree show to a viewpoint, if their normals and their box
    /// tell at once: `Greater` is the front. It is the exact [`Fragment::facing`] of each of them.
    /// O(1).
    ///
    /// # Panics
    ///
    /// If the node is of another tree.
    pub fn facing(&self, node: Node<'_>, viewpoint: Viewpoint) -> Option<Ordering> {
        self.expect(node.tree);
        let lattice = node.tree.faces.lattice();
        self.seen(node.index(), &Arms::new(&Eye::new(viewpoint, lattice)))
    }

    pub(super) fn seen(&self, node: usize, arms: &Arms) -> Option<Ordering> {
        self.normals[node].facing(arms, &self.nodes[node])
    }

    /// The box of one of the blocks of a level, or of a fragment at level 0.
    #[inline]
    pub(crate) fn get(&self, level: usize, number: u32) -> Flat {
        self.levels[level][number as usize / BLOCK].get(number as usize % BLOCK)
    }

    /// How many boxes a level has.
    #[inline]
    pub(super) fn len_of(&self, level: usize) -> usize {
        (self.fragments as usize).div_ceil(BLOCK.pow(level as u32))
    }

    /// The largest aligned block that begins with a run of fragments and is within it: its level,
    /// and how many fragments it has.
    pub(crate) fn block(&self, run: &Range<u32>) -> (usize, u32) {
        let (mut level, mut len) = (0, 1_u32);
        while level + 1 < self.levels.len()
            && run.start.is_multiple_of(len * BLOCK as u32)
            && run.end - run.start >= len * BLOCK as u32
        {
            (level, len) = (level + 1, len * BLOCK as u32);
        }
        (level, len)
    }

    /// The size in bytes, heap included.
    pub fn bytes(&self) -> usize {
        size_of::<Self>()
            + size_of_val(&*self.nodes)
            + size_of_val(&*self.normals)
            + self.levels.iter().map(|level| size_of_val(&**level)).sum::<usize>()
            + self.planes.bytes()
    }
}
