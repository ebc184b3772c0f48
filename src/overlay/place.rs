//! Places an overlay's polygons, lines and points: the planes of a tree cut them, from the root to the
//! leaves.

use std::ops::Range;

use glam::DVec3;

use super::following::{Beside, Following};
use super::order::{InsertionTree, Place, SlotSide};
use super::region::{CellTree, Ground, Opened, Region, Whose};
use super::thin::{Anchors, between};
use crate::build::frames::OverlayBuilder;
use crate::build::piece::{Piece, Splitter};
use crate::error::{Error, Kind};
use crate::exact::{Faces, PreparedPlane, Side, StoredVertex, Vertex};
use crate::progress::Watch;
use crate::tree::BspTree;
use crate::tree::node::MOST_FRAGMENTS;
use crate::tree::parts::{Parts, Record};

/// A set of at least this many pieces moves to one side of a plane at once if the set's box lies on that
/// side. Too small: time to test boxes of scattered pieces. Too large: time to test the pieces of a body one
/// by one.
const CROWD: usize = 256;

/// The placing of polygons, lines and points in a tree, with lists that are reused.
#[derive(Default)]
pub(super) struct Placer {
    cells: OverlayBuilder,
    cell: CellTree,
    anchors: Anchors,
    following: Following,
    /// A stack of the sets still to be divided, with the next set on top. Each set is in the order of faces:
    /// polygons, then lines, then points.
    pieces: Vec<Piece>,
    /// The vertices of cut pieces, in the order of the cuts.
    arena: Vec<Vertex>,
    pending: Vec<Pending>,
    front: Vec<Piece>,
    own: Vec<Piece>,
    /// The side of each piece of a set.
    sides: Vec<Side>,
    /// The box of the set on top of the stack, if that set moved to one side of a plane as a whole.
    crowd: Option<[DVec3; 2]>,
    splitter: Splitter,
}

/// A set of pieces that is still to be divided: a range of the stack of pieces.
#[derive(Debug)]
struct Pending {
    pieces: Range<usize>,
    /// The length of the arena that the set needs.
    arena: usize,
    region: Region,
    place: Place,
}

/// The data that one placing reads and writes.
struct Work<'a> {
    tree: &'a BspTree,
    faces: &'a mut Faces,
    /// The first face without area.
    thin: u32,
    placer: &'a mut Placer,
    pieces: &'a mut Parts,
    insertions: &'a mut InsertionTree,
    watch: &'a Watch<'a>,
}

impl Placer {
    /// Places all faces that follow the tree's faces in the list.
    pub(super) fn place(
        &mut self,
        tree: &BspTree,
        faces: &mut Faces,
        pieces: &mut Parts,
        insertions: &mut InsertionTree,
        watch: &Watch<'_>,
    ) -> Result<(), Error> {
        let thin = faces.first_thin() as u32;
        let mut work = Work { tree, faces, thin, placer: self, pieces, insertions, watch };
        work.begin()?;
        while let Some(pending) = work.placer.pending.pop() {
            work.placer.pieces.truncate(pending.pieces.end);
            work.placer.arena.truncate(pending.arena);
            work.step(pending)?;
        }
        work.insertions.finish();
        Ok(())
    }
}

impl Work<'_> {
    fn begin(&mut self) -> Result<(), Error> {
        let (tree, faces, thin, watch) = (self.tree, &*self.faces, self.thin, self.watch);
        let Placer { pieces, arena, pending, anchors, following, crowd, .. } = &mut *self.placer;
        anchors.fill(faces, watch)?;
        following.reset();
        pieces.clear();
        arena.clear();
        pending.clear();
        *crowd = None;
        let first = tree.faces.len() as u32;
        pieces.extend((first..thin).map(|face| Piece::whole(faces, face)));
        for face in thin..faces.len() as u32 {
            let start = arena.len();
            arena.extend(Vertex::corners(faces, face));
            pieces.push(Piece::thin(face, &arena[start..], start));
        }
        let all = 0..pieces.len();
        self.push(Place::Root, Region::root(Whose::Tree, tree.nodes.len(), tree.len()), all);
        Ok(())
    }

    /// Pushes a set onto the stack of sets to divide, unless it has no pieces to place.
    fn push(&mut self, place: Place, region: Region, pieces: Range<usize>) {
        let Placer { arena, pending, .. } = &mut *self.placer;
        if !pieces.is_empty() || region.has_pieces() {
            pending.push(Pending { pieces, arena: arena.len(), region, place });
        }
    }

    /// Divides a set by the plane of its region, and puts both sides on the stack.
    fn step(&mut self, pending: Pending) -> Result<(), Error> {
        let Pending { pieces, region, place, .. } = pending;
        let mut start = pieces.start;
        self.placer.front.clear();
        self.placer.own.clear();
        // The box belongs to this set only: the parts of the set have other boxes.
        let crowd = self.placer.crowd.take();
        self.watch.work(pieces.len())?;
        if self.tree.len() + self.pieces.records.len() > MOST_FRAGMENTS {
            return Err(Kind::Fragments(MOST_FRAGMENTS).error());
        }
        if pieces.is_empty() && region.node.is_none() {
            // Polygons of a cell that no line or point reaches.
            let pieces = self.store_all(region.fragments);
            self.insertions.attach(place, pieces);
            return Ok(());
        }
        let opened = Opened::of(region, self.tree, &self.placer.cell, self.faces);
        let opened = if opened.is_some() { opened } else { self.enter_cell(start, place)? };
        let Some(opened) = opened else { return Ok(()) };
        let prepared = PreparedPlane::new(self.faces, opened.branch.plane);
        let side = self.side_of_all(start, crowd, &prepared);
        if side.is_none() {
            self.divide(start, &prepared, &opened)?;
        }
        let Opened { mut branch, own, sides: [in_front, behind] } = opened;
        let own = if in_front.of == Whose::Cell { own } else { 0..0 };
        branch.pieces = self.store_all(own);
        let number = self.insertions.push(place, branch);
        let is_all_in_front = side == Some(Side::Front);
        let end = if is_all_in_front { start } else { self.placer.pieces.len() };
        self.push(Place::Back(number), behind, start..end);
        let Placer { pieces, front, .. } = &mut *self.placer;
        if !is_all_in_front {
            start = pieces.len();
            pieces.extend_from_slice(front);
        }
        let rest = start..pieces.len();
        self.push(Place::Front(number), in_front, rest);
        Ok(())
    }

    /// The side of a plane on which the whole crowd on top of the stack certainly lies, if any.
    fn side_of_all(
        &mut self,
        start: usize,
        known: Option<[DVec3; 2]>,
        prepared: &PreparedPlane,
    ) -> Option<Side> {
        let Placer { pieces, crowd, .. } = &mut *self.placer;
        let set = &pieces[start..];
        if set.len() < CROWD {
            return None;
        }
        let union = |[low, high]: [DVec3; 2], piece: &Piece| {
            [low.min(piece.min.into()), high.max(piece.max.into())]
        };
        let nothing = [DVec3::INFINITY, DVec3::NEG_INFINITY];
        let bounds = known.unwrap_or_else(|| set.iter().fold(nothing, union));
        let side = prepared.side_of_box(bounds.map(|corner| corner.to_array()));
        *crowd = side.map(|_| bounds);
        side
    }

    /// Divides the topmost set of the stack: pieces behind stay on the stack, pieces in front go to `front`,
    /// and pieces on the plane to `own`. Pieces near the plane [follow](Following) the polygons on which they lie.
    fn divide(
        &mut self,
        start: usize,
        prepared: &PreparedPlane,
        opened: &Opened,
    ) -> Result<(), Error> {
        let Placer { cell, pieces, arena, front, own, sides, splitter, following, .. } =
            &mut *self.placer;
        let (tree, faces, watch) = (self.tree, &mut *self.faces, self.watch);
        let ground = match opened.sides[0].of {
            Whose::Tree => Ground::Tree(tree),
            Whose::Cell => Ground::Cell(cell),
        };
        let node = &opened.ranges();
        let beside = Beside { ground, plane: prepared, node, watch };
        let may_follow = faces.tolerance() > 0.0
            && !(node.own.is_empty() && node.front.is_empty() && node.back.is_empty());
        following.begin();
        sides.clear();
        for (piece, place) in pieces[start..].iter().zip(0..) {
            let cut = piece.cut_vertices(arena);
            let (mut side, reaches) = prepared.classify_and_reach(faces, piece.face, cut);
            if may_follow && reaches {
                let of_hosts = following.add(faces, &beside, (place, piece, arena), side)?;
                side = of_hosts.unwrap_or(side);
            }
            sides.push(side);
        }
        following.settle(faces, &beside, (pieces, start, sides), (arena, splitter))?;
        let mut back = start;
        for (i, &side) in (start..).zip(&*sides) {
            let piece = pieces[i];
            let behind = match side {
                Side::Back => Some(piece),
                Side::Front => {
                    front.push(piece);
                    None
                }
                Side::Coplanar => {
                    own.push(piece);
                    None
                }
                Side::Spanning => {
                    let parts = splitter.cut(faces, prepared, &piece, arena)?;
                    front.push(parts[0]);
                    Some(parts[1])
                }
            };
            let Some(behind) = behind else { continue };
            // Moved down in place: `back` never overtakes `i`, so nothing unread is lost.
            pieces[back] = behind;
            back += 1;
        }
        pieces.truncate(back);
        Ok(())
    }

    /// Moves the topmost set of the stack into a cell without fragments, or returns a plane that divides the
    /// set. The set has at least one piece.
    fn enter_cell(&mut self, start: usize, place: Place) -> Result<Option<Opened>, Error> {
        let Placer { cells, cell, anchors, pieces, arena, own, .. } = &mut *self.placer;
        let set = &pieces[start..];
        if let [piece] = *set {
            own.push(piece);
            let side = self.store_all(0..0);
            self.insertions.attach(place, side);
            return Ok(None);
        }
        let polygons = set.partition_point(|piece| piece.face < self.thin);
        if polygons == 0 {
            let plane = between(self.faces, anchors, set, arena);
            return Ok(Some(Opened::empty(self.faces, plane)));
        }
        let tree = cells.build(self.faces, &set[..polygons], arena, self.watch)?;
        if polygons < set.len() {
            // Lines and points descend the small tree, which also stores its fragments until they are placed.
            pieces.drain(start..start + polygons);
            cells.keep(std::mem::take(&mut cell.parts));
            let region = cell.fill(tree)?;
            return Ok(Opened::of(region, self.tree, cell, self.faces));
        }
        let first = self.store_tree(&tree);
        self.insertions.attach_tree(place, self.faces, &tree, first);
        self.placer.cells.keep(tree);
        Ok(None)
    }

    /// Adds fragments of the cell's tree to the placed pieces, and then the pieces of `own`, in input order.
    fn store_all(&mut self, fragments: Range<u32>) -> SlotSide {
        let first = self.pieces.records.len() as u32;
        for fragment in fragments {
            let fragment = fragment as usize;
            let Parts { records, vertices, positions, .. } = &self.placer.cell.parts;
            let end =
                records.get(fragment + 1).map_or(vertices.len(), |next| next.vertices as usize);
            let range = records[fragment].vertices as usize..end;
            let (vertex_ids, places) = (&vertices[range.clone()], &positions[range]);
            let face = records[fragment].face;
            add(self.pieces, face, vertex_ids.iter().copied(), places.iter().copied());
        }
        let Placer { own, arena, .. } = &*self.placer;
        // Coplanar polygons are painted in input order, which sets keep when they are divided.
        debug_assert!(own.is_sorted_by_key(|piece| piece.face), "in input order");
        for piece in own {
            let cut = piece.cut_vertices(arena).unwrap_or_default();
            let vertex_ids = cut.iter().map(|vertex| vertex.stored());
            add(self.pieces, piece.face, vertex_ids, cut.iter().map(Vertex::position));
            self.watch.finish(piece.cuts);
        }
        self.insertions.group(first..self.pieces.records.len() as u32)
    }

    /// Appends the fragments of a small tree to the overlay's pieces, and returns the number of the first
    /// fragment.
    fn store_tree(&mut self, tree: &Parts) -> u32 {
        let pieces = &mut *self.pieces;
        let first = pieces.records.len() as u32;
        let shift = pieces.vertices.len() as u32;
        let moved = |record: &Record| Record { vertices: record.vertices + shift, ..*record };
        pieces.records.extend(tree.records.iter().map(moved));
        pieces.vertices.extend_from_slice(&tree.vertices);
        pieces.positions.extend_from_slice(&tree.positions);
        first
    }
}

/// Adds a piece to the placed pieces.
fn add(
    pieces: &mut Parts,
    face: u32,
    vertex_ids: impl Iterator<Item = StoredVertex>,
    places: impl Iterator<Item = [f64; 3]>,
) {
    let Parts { records, vertices, positions, .. } = pieces;
    records.push(Record { face, vertices: vertices.len() as u32 });
    vertices.extend(vertex_ids);
    positions.extend(places);
}

/// A segment of a line before any cut.
#[cfg(feature = "drawing")]
#[derive(Clone, Copy, Debug)]
pub(crate) struct GivenSegment {
    pub(crate) line: usize,
    /// The number of the segment in its line.
    pub(crate) number: usize,
    /// The ends of the segment on the grid.
    pub(crate) ends: [[f64; 3]; 2],
}

/// The whole lines and points of an overlay, for drawings.
#[cfg(feature = "drawing")]
impl super::Overlay {
    /// Returns an error if the overlay was made for another tree, or has polygons.
    pub(crate) fn expect_no_polygons(&self, tree: &BspTree) -> Result<(), Error> {
        self.expect(tree)?;
        if self.base.faces < self.faces.first_thin() {
            let number = self.faces.polygon(self.base.faces as u32) - self.base.polygons;
            return Err(crate::error::Kind::InOverlay.of_polygon(number));
        }
        Ok(())
    }

    /// All segments of the overlay's lines, in input order.
    pub(crate) fn given_segments(&self) -> impl ExactSizeIterator<Item = GivenSegment> {
        let first = self.faces.first_thin();
        (0..self.faces.thin.segments).map(move |i| {
            let face = (first + i) as u32;
            let corners = self.faces.corners(face);
            let (line, number) = (self.faces.polygon(face), self.segments[i] as usize);
            GivenSegment { line, number, ends: [corners[0], corners[1]] }
        })
    }

    /// All points of the overlay on the grid, in input order.
    pub(crate) fn given_points(&self) -> impl ExactSizeIterator<Item = [f64; 3]> {
        let first = self.faces.first_point();
        (0..self.faces.thin.points).map(move |i| self.faces.corners((first + i) as u32)[0])
    }
}
