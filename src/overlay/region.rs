//! Parts of a tree on the way down to its leaves.

use std::ops::Range;

use glam::Vec4;

use super::skeleton::{Branch, SlotSide};
use crate::Error;
use crate::exact::{Faces, PlaneId};
use crate::tree::BspTree;
use crate::tree::node_record::{NodeRecord, Ranges, Sizes, finish, make_room};
use crate::tree::order::planes::rounded;
use crate::tree::parts::Parts;

/// A part of a tree, by its fragments: below a node, or a leaf.
#[derive(Clone, Debug)]
pub(super) struct Region {
    pub(super) of: Whose,
    pub(super) node: Option<usize>,
    pub(super) fragments: Range<u32>,
}

/// Whose part a region is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Whose {
    /// The tree's, that stays as it is.
    Tree,
    /// Of the small tree of the polygons that meet in one of its cells.
    Cell,
}

impl Region {
    /// A cell without fragments.
    pub(super) const EMPTY: Self = Self { of: Whose::Tree, node: None, fragments: 0..0 };

    /// The root of a tree of so many nodes and fragments.
    pub(super) fn root(of: Whose, nodes: usize, fragments: usize) -> Self {
        Self { of, node: (nodes > 0).then_some(0), fragments: 0..fragments as u32 }
    }

    /// Whether it has polygons that are still to be put in place.
    pub(super) fn has_pieces(&self) -> bool {
        self.of == Whose::Cell && !self.fragments.is_empty()
    }
}

/// The small tree of the polygons in a cell, as long as lines and points are cut by it.
#[derive(Debug, Default)]
pub(super) struct CellTree {
    nodes: Vec<NodeRecord>,
    sizes: Vec<Sizes>,
    pub(super) parts: Parts,
}

impl CellTree {
    /// Replaces the tree, and gives all of it as a region.
    pub(super) fn fill(&mut self, parts: Parts) -> Result<Region, Error> {
        make_room(parts.nodes.len(), &mut self.sizes, &mut self.nodes)?;
        finish(parts.nodes.iter().copied(), &mut self.sizes, &mut self.nodes);
        self.parts = parts;
        Ok(Region::root(Whose::Cell, self.nodes.len(), self.parts.records.len()))
    }
}

/// A region's plane, and both sides of it as they are without pieces.
pub(super) struct Opened {
    pub(super) branch: Branch,
    /// The fragments on the plane.
    pub(super) own: Range<u32>,
    pub(super) sides: [Region; 2],
}

impl Opened {
    /// A plane in a cell without fragments.
    pub(super) fn empty(faces: &Faces, plane: PlaneId) -> Self {
        Self::new(rounded(faces, plane), plane, 0..0, [Region::EMPTY; 2])
    }

    #[inline]
    fn new(rounded: Vec4, plane: PlaneId, own: Range<u32>, sides: [Region; 2]) -> Self {
        // Those of a cell are pieces, and are hung where they belong one by one.
        let still = |side: &Region| match side.of {
            Whose::Tree => side.fragments.len(),
            Whose::Cell => 0,
        };
        let [front, back] = sides.each_ref().map(|side| SlotSide::still(still(side)));
        let on_plane = if sides[0].of == Whose::Tree { own.len() as u32 } else { 0 };
        let pieces = SlotSide::still(0);
        let branch = Branch { rounded, plane, own: on_plane, pieces, front, back };
        Self { branch, own, sides }
    }

    /// `None` for an empty cell. The plane of a leaf is that of its fragment, so that no piece crosses
    /// it.
    #[inline]
    pub(super) fn of(
        region: Region,
        tree: &BspTree,
        cell: &CellTree,
        faces: &Faces,
    ) -> Option<Self> {
        let Region { of, node, fragments: all } = region;
        let (nodes, records) = match of {
            Whose::Tree => (&tree.nodes, &tree.records),
            Whose::Cell => (&cell.nodes, &cell.parts.records),
        };
        let Some(index) = node else {
            let plane = PlaneId::face(records[all.clone().next()? as usize].face);
            let nothing = Region { of, node: None, fragments: all.end..all.end };
            let sides = [nothing.clone(), nothing];
            return Some(Self::new(rounded(faces, plane), plane, all, sides));
        };
        let node = &nodes[index];
        let Ranges { own, front, back } = node.ranges(all);
        let front = Region { of, node: node.front_node(index), fragments: front };
        let back = Region { of, node: node.back_node(index), fragments: back };
        let rounded = match of {
            Whose::Tree => tree.planes.get(index),
            Whose::Cell => rounded(faces, node.plane),
        };
        Some(Self::new(rounded, node.plane, own, [front, back]))
    }
}
