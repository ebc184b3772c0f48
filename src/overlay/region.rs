//! The parts of the trees that shapes descend: the overlay's tree, and the small trees of cells.

use std::ops::Range;
use std::sync::OnceLock;

use glam::Vec4;

use super::order::{Branch, SlotSide};
use crate::error::Error;
use crate::exact::{Faces, PlaneId};
use crate::tree::bounds::Bounds;
use crate::tree::node::{NodeRecord, Ranges, Sizes, finish, make_room};
use crate::tree::order::eye::rounded;
use crate::tree::parts::{Parts, Stored};
use crate::tree::{BspTree, Fragment};

/// A part of a tree: the fragments of a subtree, or of a leaf.
#[derive(Clone, Debug)]
pub(super) struct Region {
    pub(super) of: Whose,
    pub(super) node: Option<usize>,
    pub(super) fragments: Range<u32>,
}

/// The tree that a region is a part of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Whose {
    /// The overlay's tree, which is not changed.
    Tree,
    /// The small tree of the polygons that meet in one cell of the overlay's tree.
    Cell,
}

impl Region {
    /// A cell without fragments.
    pub(super) const EMPTY: Self = Self { of: Whose::Tree, node: None, fragments: 0..0 };

    /// The root of a tree of `nodes` nodes and `fragments` fragments.
    pub(super) fn root(of: Whose, nodes: usize, fragments: usize) -> Self {
        Self { of, node: (nodes > 0).then_some(0), fragments: 0..fragments as u32 }
    }

    /// Whether the region has polygons that are not placed yet.
    pub(super) fn has_pieces(&self) -> bool {
        self.of == Whose::Cell && !self.fragments.is_empty()
    }
}

/// The small tree of the polygons in a cell, while it cuts lines and points.
#[derive(Debug, Default)]
pub(super) struct CellTree {
    nodes: Vec<NodeRecord>,
    sizes: Vec<Sizes>,
    pub(super) parts: Parts,
    /// The boxes of the fragments, computed if a line or a point lies on a plane.
    bounds: OnceLock<Bounds>,
}

impl CellTree {
    /// Replaces the tree, and returns the whole tree as a region.
    pub(super) fn fill(&mut self, parts: Parts) -> Result<Region, Error> {
        make_room(parts.nodes.len(), &mut self.sizes, &mut self.nodes)?;
        finish(parts.nodes.iter().copied(), &mut self.sizes, &mut self.nodes);
        (self.parts, self.bounds) = (parts, OnceLock::new());
        Ok(Region::root(Whose::Cell, self.nodes.len(), self.parts.records.len()))
    }
}

/// The fragments of one of the trees that shapes descend.
#[derive(Clone, Copy)]
pub(super) enum Ground<'a> {
    Tree(&'a BspTree),
    Cell(&'a CellTree),
}

impl<'a> Ground<'a> {
    fn stored(self) -> Stored<'a> {
        match self {
            Self::Tree(tree) => tree.stored(),
            Self::Cell(cell) => cell.parts.stored(),
        }
    }

    pub(super) fn face(self, fragment: u32) -> u32 {
        self.stored().records[fragment as usize].face
    }

    /// A fragment; `faces` are those of the overlay.
    pub(super) fn fragment(self, faces: &'a Faces, fragment: u32) -> Fragment<'a> {
        Fragment::new(faces, self.stored(), fragment as usize, fragment)
    }

    /// The boxes of the fragments, computed at the first use.
    pub(super) fn boxes(self, faces: &Faces) -> &'a Bounds {
        match self {
            Self::Tree(tree) => tree.boxes(),
            Self::Cell(cell) => cell.bounds.get_or_init(|| {
                let stored = cell.parts.stored();
                let flat = |piece| Fragment::new(faces, stored, piece, 0).flat_bounds();
                Bounds::of_pieces(stored.records.len(), flat)
            }),
        }
    }
}

/// A region's plane, and the regions on both sides of the plane, without pieces.
pub(super) struct Opened {
    pub(super) branch: Branch,
    /// The fragments on the plane.
    pub(super) own: Range<u32>,
    pub(super) sides: [Region; 2],
}

impl Opened {
    /// The fragments on the plane, in front of it and behind it.
    pub(super) fn ranges(&self) -> Ranges {
        let [front, back] = self.sides.each_ref().map(|side| side.fragments.clone());
        Ranges { own: self.own.clone(), front, back }
    }

    /// A plane in a cell without fragments.
    pub(super) fn empty(faces: &Faces, plane: PlaneId) -> Self {
        Self::new(rounded(faces, plane), plane, 0..0, [Region::EMPTY; 2])
    }

    #[inline]
    fn new(rounded: Vec4, plane: PlaneId, own: Range<u32>, sides: [Region; 2]) -> Self {
        // Fragments of a cell are pieces, which are attached one by one.
        let of_tree = |fragments: &Range<u32>| match sides[0].of {
            Whose::Tree => fragments.len(),
            Whose::Cell => 0,
        };
        let [front, back] = sides.each_ref().map(|side| SlotSide::empty(of_tree(&side.fragments)));
        let on_plane = of_tree(&own) as u32;
        let pieces = SlotSide::empty(0);
        let branch = Branch { rounded, plane, own: on_plane, pieces, front, back };
        Self { branch, own, sides }
    }

    /// Opens a region; `None` for an empty cell. The plane of a leaf is its fragment's plane, so that no
    /// piece crosses the fragment.
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
