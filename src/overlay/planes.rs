//! Regions of a tree that an overlay reaches, and planes between lines and points in one of them.

use std::ops::Range;

use glam::Vec4;
use smallvec::SmallVec;

use super::skeleton::{Anchors, Branch, SlotSide};
use crate::Error;
use crate::build::piece::Piece;
use crate::exact::{Faces, PlaneId, PreparedPlane, Side, Vertex, VertexKind};
use crate::tree::BspTree;
use crate::tree::node::{NodeRecord, Ranges, Sizes, finish, make_room};
use crate::tree::order::eye::rounded;
use crate::tree::parts::Parts;

/// How many pieces of a set a plane is tried on, spread evenly over the set. More: time; fewer: worse
/// planes for large sets.
const SAMPLE: usize = 64;
/// How many planes of segments are tried. More: time; fewer: more cuts where lines cross each other in
/// a tangle.
const OWN: usize = 6;
/// A cut costs as much as this many pieces more on one side. Smaller: more pieces; larger: trees that
/// are lists, and take the square of the time.
const CUT: usize = 4;

type Sample<'a> = SmallVec<[&'a Piece; SAMPLE]>;

/// Chooses the plane that divides a set of pieces, not none, without area. On either side there are
/// fewer pieces than in the set.
pub(super) fn between(
    faces: &Faces,
    anchors: &Anchors,
    pieces: &[Piece],
    arena: &[Vertex],
) -> PlaneId {
    let sample: Sample<'_> = spread(pieces, SAMPLE).collect();
    let first = own_plane(faces, sample[0].face);
    let own = spread(pieces, OWN).skip(1).map(|piece| own_plane(faces, piece.face));
    let own = medians(faces, &sample, arena).chain(own);
    let plain = cheapest(faces, &sample, arena, [first].into_iter().chain(own));
    // All of the sample lie in one plane.
    if let Some((0, plane)) = plain {
        return plane;
    }
    let anchored = anchored(anchors, pieces, arena).map(PlaneId::face);
    let best = cheapest(faces, &sample, arena, anchored).or(plain);
    best.map_or(first, |(_, plane)| plane)
}

/// The cheapest of some planes, with what it costs.
fn cheapest(
    faces: &Faces,
    sample: &Sample<'_>,
    arena: &[Vertex],
    planes: impl Iterator<Item = PlaneId>,
) -> Option<(usize, PlaneId)> {
    let mut best: Option<(usize, PlaneId)> = None;
    for plane in planes {
        let cost = cost(faces, sample, arena, plane).unwrap_or(usize::MAX);
        if best.is_none_or(|(least, _)| cost < least) {
            best = Some((cost, plane));
        }
        // Cheap enough: both sides are left with few of the sample.
        if cost <= sample.len() / 2 {
            break;
        }
    }
    best
}

/// So many pieces of a set, or all, spread evenly.
fn spread(pieces: &[Piece], most: usize) -> impl Iterator<Item = &Piece> {
    let count = pieces.len().min(most);
    (0..count).map(move |i| &pieces[i * pieces.len() / count])
}

/// Some segments that end at points of the set, if there are any.
fn anchored(anchors: &Anchors, pieces: &[Piece], arena: &[Vertex]) -> impl Iterator<Item = u32> {
    let points = anchors.points(pieces);
    let parts = points.chunks(points.len().div_ceil(OWN).max(1));
    parts
        .filter_map(move |part| part.iter().find_map(|point| anchors.segment(point, pieces, arena)))
}

/// A plane that a segment or a point lies in.
fn own_plane(faces: &Faces, face: u32) -> PlaneId {
    if faces.reach(face) > 1 {
        PlaneId::face(face)
    } else {
        PlaneId::axis(2, faces.corner_range(face).start as u32)
    }
}

/// The planes perpendicular to the axes through the median of the corners in the cell.
fn medians<'a>(
    faces: &'a Faces,
    sample: &Sample<'_>,
    arena: &'a [Vertex],
) -> impl Iterator<Item = PlaneId> + 'a {
    let mut corners: SmallVec<[u32; 2 * SAMPLE]> = SmallVec::new();
    for piece in sample {
        let start = faces.corner_range(piece.face).start as u32;
        for vertex in piece.cut_vertices(arena).unwrap_or_default() {
            if let VertexKind::Corner(k) = vertex.vertex_id().kind() {
                corners.push(start + k);
            }
        }
    }
    let axes = if corners.is_empty() { 0..0 } else { 0..3 };
    axes.map(move |axis| {
        let middle = corners.len() / 2;
        let at = |corner: &u32| faces.corner(*corner)[axis];
        corners.select_nth_unstable_by(middle, |a, b| at(a).total_cmp(&at(b)));
        PlaneId::axis(axis, corners[middle])
    })
}

/// What it costs to divide a set by a plane; `None` if as many are left on a side.
fn cost(faces: &Faces, sample: &Sample<'_>, arena: &[Vertex], plane: PlaneId) -> Option<usize> {
    let prepared = PreparedPlane::new(faces, plane);
    let (mut front, mut back, mut cuts) = (0, 0, 0);
    for piece in sample {
        match piece.side(faces, &prepared, arena) {
            Side::Front => front += 1,
            Side::Back => back += 1,
            Side::Spanning => cuts += 1,
            Side::Coplanar => {}
        }
    }
    let divides = front.max(back) + cuts < sample.len();
    divides.then_some(front.max(back) + CUT * cuts)
}

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
