//! What placing works on.

use std::ops::Range;

use super::anchors::Anchors;
use super::region::{CellTree, Region};
use super::skeleton::{Place, Skeleton};
use crate::build::frames::OverlayBuilder;
use crate::build::piece::{Piece, Splitter};
use crate::build::progress::Watch;
use crate::exact::{Faces, Vertex};
use crate::tree::BspTree;
use crate::tree::parts::Parts;

/// A set of pieces that is still to be divided: a range of the stack of pieces.
#[derive(Debug)]
pub(super) struct Pending {
    pub(super) pieces: Range<usize>,
    /// The length of the arena that it needs.
    pub(super) arena: usize,
    pub(super) region: Region,
    pub(super) place: Place,
}

/// Places polygons, lines and points in a tree; its lists are kept to be used again.
#[derive(Default)]
pub(super) struct Placer {
    pub(super) cells: OverlayBuilder,
    pub(super) cell: CellTree,
    pub(super) anchors: Anchors,
    /// A stack of the sets still to be divided, the next one on top. Each is in the order of faces:
    /// polygons, then lines, then points.
    pub(super) pieces: Vec<Piece>,
    /// The vertices of cut pieces, in the order of the cuts.
    pub(super) arena: Vec<Vertex>,
    pub(super) pending: Vec<Pending>,
    pub(super) front: Vec<Piece>,
    pub(super) own: Vec<Piece>,
    /// The box of the set on top of the stack, if it went to one side of a plane as a whole.
    pub(super) crowd: Option<[[f64; 3]; 2]>,
    pub(super) splitter: Splitter,
    /// The face to begin with: those before it are the tree's.
    pub(super) first: u32,
    /// The first face without area.
    pub(super) thin: u32,
}

/// What one placing reads and writes.
pub(super) struct Work<'a> {
    pub(super) tree: &'a BspTree,
    pub(super) faces: &'a Faces,
    pub(super) placer: &'a mut Placer,
    pub(super) pieces: &'a mut Parts,
    pub(super) skeleton: &'a mut Skeleton,
    pub(super) watch: &'a Watch<'a>,
}
