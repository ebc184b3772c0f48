//! Cuts polygons by the planes of a tree, down to its leaves.

use std::ops::Range;

use super::skeleton::{self, Branch, Place, Skeleton};
use crate::build::cell::CellBuilder;
use crate::build::knife::Knife;
use crate::build::live::Live;
use crate::error::Error;
use crate::exact::{Exact, ExactStored, ExactVertex, Faces, Kernel, PlaneId, Side, Vertex};
use crate::memory::reserve;
use crate::tree::BspTree;
use crate::tree::node_record::Ranges;
use crate::tree::order::planes::rounded;
use crate::tree::parts::{Parts, Record};

/// A part of the tree, by its fragments: below a node, or a leaf.
#[derive(Clone, Debug)]
struct Region {
    node: Option<usize>,
    fragments: Range<u32>,
}

/// A set of pieces that is still to be divided: a range of the stack of pieces.
#[derive(Debug)]
struct Pending {
    pieces: Range<usize>,
    /// The length of the arena that it needs.
    arena: usize,
    region: Region,
    place: Place,
}

/// Places polygons in a tree; its lists are kept to be used again.
#[derive(Default)]
pub(super) struct Placer {
    cells: CellBuilder,
    /// A stack of the sets still to be divided, the next one on top.
    pieces: Vec<Live>,
    /// The vertices of cut pieces, in the order of the cuts.
    arena: Vec<ExactVertex>,
    pending: Vec<Pending>,
    front: Vec<Live>,
    own: Vec<Live>,
    knife: Knife<ExactVertex>,
    /// The face to begin with: those before it are the tree's.
    first: u32,
}

impl Placer {
    /// Begins with the face of this number.
    pub(super) fn begin_at(&mut self, first: usize) {
        self.first = first as u32;
    }

    /// Places all faces behind the tree's.
    pub(super) fn place(
        &mut self,
        tree: &BspTree,
        faces: &Faces,
        pieces: &mut Parts<ExactStored>,
        skeleton: &mut Skeleton,
    ) -> Result<(), Error> {
        let mut work = Work { tree, faces, placer: self, pieces, skeleton };
        work.begin()?;
        while let Some(pending) = work.placer.pending.pop() {
            work.placer.pieces.truncate(pending.pieces.end);
            work.placer.arena.truncate(pending.arena);
            work.step(pending)?;
        }
        work.skeleton.finish();
        Ok(())
    }
}

/// What one placing reads and writes.
struct Work<'a> {
    tree: &'a BspTree,
    faces: &'a Faces,
    placer: &'a mut Placer,
    pieces: &'a mut Parts<ExactStored>,
    skeleton: &'a mut Skeleton,
}

impl Work<'_> {
    fn begin(&mut self) -> Result<(), Error> {
        let Placer { pieces, arena, pending, first, .. } = &mut *self.placer;
        pieces.clear();
        arena.clear();
        pending.clear();
        let new = *first..self.faces.len() as u32;
        if new.is_empty() {
            return Ok(());
        }
        reserve(pieces, new.len())?;
        pieces.extend(new.map(|face| Live::whole(self.faces, face)));
        let node = (!self.tree.nodes.is_empty()).then_some(0);
        let region = Region { node, fragments: 0..self.tree.len() as u32 };
        pending.push(Pending { pieces: 0..pieces.len(), arena: 0, region, place: Place::Root });
        Ok(())
    }

    /// Divides a set of at least one piece by the plane of its region, and puts both sides on the
    /// stack.
    fn step(&mut self, pending: Pending) -> Result<(), Error> {
        let Pending { pieces, region, place, .. } = pending;
        let start = pieces.start;
        let Some((mut branch, sides)) = self.open(&region) else {
            return self.fill_cell(start, place);
        };
        self.divide(start, branch.plane)?;
        // Coplanar polygons are painted in input order.
        self.placer.own.sort_by_key(|piece| piece.face);
        let first = self.pieces.records.len() as u32;
        for i in 0..self.placer.own.len() {
            self.store(self.placer.own[i])?;
        }
        branch.pieces = self.skeleton.group(first..self.pieces.records.len() as u32)?;
        let number = self.skeleton.push(place, branch)?;
        let Placer { pieces, arena, pending, front, .. } = &mut *self.placer;
        let [in_front, behind] = sides;
        if pieces.len() > start {
            let place = Place::Back(number);
            let pieces = start..pieces.len();
            pending.push(Pending { pieces, arena: arena.len(), region: behind, place });
        }
        if !front.is_empty() {
            let (start, place) = (pieces.len(), Place::Front(number));
            reserve(pieces, front.len())?;
            pieces.extend_from_slice(front);
            let pieces = start..pieces.len();
            pending.push(Pending { pieces, arena: arena.len(), region: in_front, place });
        }
        Ok(())
    }

    /// The plane of a region, with both sides as they are without pieces; `None` for an empty cell.
    /// The plane of a leaf is that of its fragment, so that no piece crosses it.
    fn open(&self, region: &Region) -> Option<(Branch, [Region; 2])> {
        let (tree, faces) = (self.tree, self.faces);
        let all = region.fragments.clone();
        let (plane, rounded, own, sides) = if let Some(index) = region.node {
            let node = &tree.nodes[index];
            let Ranges { own, front, back } = node.ranges(all);
            let front = Region { node: node.front_node(index), fragments: front };
            let back = Region { node: node.back_node(index), fragments: back };
            (node.plane, tree.planes.get(index), own, [front, back])
        } else {
            let record = tree.records[all.clone().next()? as usize];
            let plane = PlaneId::face(record.face);
            let nothing = Region { node: None, fragments: all.end..all.end };
            (plane, rounded(faces, plane), all, [nothing.clone(), nothing])
        };
        let [front, back] =
            sides.each_ref().map(|side| skeleton::Side::still(side.fragments.len()));
        let (own, pieces) = (own.len() as u32, skeleton::Side::still(0));
        Some((Branch { rounded, plane, own, pieces, front, back }, sides))
    }

    /// Divides the set on top of the stack: pieces behind stay on the stack, pieces in front go to
    /// `front`, and pieces on the plane to `own`.
    fn divide(&mut self, start: usize, plane: PlaneId) -> Result<(), Error> {
        let Placer { pieces, arena, front, own, knife, .. } = &mut *self.placer;
        let splitter = Exact.splitter(self.faces, plane);
        front.clear();
        own.clear();
        let mut back = start;
        for i in start..pieces.len() {
            let piece = pieces[i];
            let behind = match Exact.classify(self.faces, &splitter, piece.piece(arena)) {
                Side::Back => piece,
                Side::Front => {
                    front.push(piece);
                    continue;
                }
                Side::Coplanar => {
                    own.push(piece);
                    continue;
                }
                Side::Spanning => {
                    let parts = knife.cut(&Exact, self.faces, &splitter, &piece, arena)?;
                    front.push(parts[0]);
                    parts[1]
                }
            };
            // Moved down in place: `back` never overtakes `i`, so nothing unread is lost.
            pieces[back] = behind;
            back += 1;
        }
        pieces.truncate(back);
        Ok(())
    }

    /// Puts the set on top of the stack, of at least one piece, into a cell without fragments.
    fn fill_cell(&mut self, start: usize, place: Place) -> Result<(), Error> {
        let first = self.pieces.records.len() as u32;
        if self.placer.pieces.len() == start + 1 {
            self.store(self.placer.pieces[start])?;
            let side = self.skeleton.group(first..first + 1)?;
            self.skeleton.hang(place, side);
            return Ok(());
        }
        let Placer { cells, pieces, arena, .. } = &mut *self.placer;
        let tree = cells.build(self.faces, &pieces[start..], arena)?;
        let numbers = skeleton::append(self.pieces, &tree)?;
        self.skeleton.graft(place, self.faces, &tree, numbers.start)?;
        cells.keep(tree);
        Ok(())
    }

    /// Adds a piece to those that are in place.
    fn store(&mut self, live: Live) -> Result<(), Error> {
        let Parts { records, vertices, positions, .. } = &mut *self.pieces;
        reserve(records, 1)?;
        records.push(Record { face: live.face, vertices: vertices.len() as u32 });
        let cut = live.piece(&self.placer.arena).cut.unwrap_or_default();
        reserve(vertices, cut.len())?;
        vertices.extend(cut.iter().map(|vertex| Exact.store(vertex)));
        reserve(positions, cut.len())?;
        positions.extend(cut.iter().map(Vertex::position));
        Ok(())
    }
}
