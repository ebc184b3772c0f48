//! Polygons that move, beside a tree that stays as it is.

mod indices;
mod order;
mod place;
mod skeleton;

use std::fmt;

pub use order::Overlaid;
use place::Placer;
use skeleton::Skeleton;

use crate::error::Error;
use crate::exact::{ExactStored, Faces};
use crate::faces::{Preparation, Preparer};
use crate::input::Polygon;
use crate::tree::parts::{Parts, Stored};
use crate::tree::{BspTree, Fragment};

/// Polygons that move, in one exact order with a tree that stays as it is: doors, characters, a
/// cursor.
///
/// # Use
///
/// Make an overlay once, replace its polygons whenever they move, and ask it for the order of both:
///
/// ```
/// use binspace::{BspTree, Overlay, Viewpoint};
///
/// let square = |z: f64| [[0.0, 0.0, z], [1.0, 0.0, z], [1.0, 1.0, z], [0.0, 1.0, z]];
/// let tree = BspTree::build([square(0.0), square(2.0)])?;
/// let from_above = Viewpoint::direction([0.0, 0.0, -1.0]);
///
/// let mut overlay = Overlay::new(&tree);
/// let mut order = Vec::new();
/// for (z, expected) in [(0.5, [0, 2, 1]), (1.5, [0, 2, 1]), (2.5, [0, 1, 2])] {
///     overlay.replace(&tree, [square(z)])?;
///     overlay.back_to_front_into(&tree, from_above, &mut order)?;
///     let polygons = order.iter().map(|&number| match overlay.piece(number) {
///         Some(piece) => piece.polygon(),
///         None => tree.fragment(number).polygon(),
///     });
///     assert!(polygons.eq(expected)); // 2 is the first polygon after those of the tree
/// }
/// # let tall = [[0.0, 0.0, 0.0], [0.0, 0.0, 9.0], [1.0, 0.0, 0.0]];
/// # assert!(overlay.replace(&tree, [tall]).is_err_and(|error| error.polygon() == Some(0)));
/// # assert!(overlay.is_empty());
/// # Ok::<(), binspace::Error>(())
/// ```
///
/// # What it holds
///
/// Each polygon is cut by the planes of the tree on the way to the leaves that it lies in. Pieces
/// that meet in one leaf are ordered by a small tree of their own. The tree itself is never cut or
/// changed. A piece is a [`Fragment`]; pieces are numbered from the tree's
/// [`len`](BspTree::len) on, and their polygons from the number of the tree's polygons on, as if
/// they had been given after these. All numbers are valid until the next
/// [`replace`](Self::replace).
///
/// # Order
///
/// As exact as the tree's: what the page of [`BspTree`](BspTree#order) says of polygons holds for
/// those of both. Coplanar polygons come in input order, those of the overlay after those of the
/// tree. The tree's fragments come in the tree's own order, with pieces between them.
///
/// | | time |
/// |---|---|
/// | [`replace`](Self::replace) | O(p · depth) for p pieces, and small trees where they meet |
/// | [`back_to_front_into`](Self::back_to_front_into) | that of the tree, and a copy of its list |
/// | [`back_to_front`](Self::back_to_front), an iterator | O(n + p) if read to its end |
///
/// The overlay's polygons are rounded to the tree's grid, and have the tree's tolerance. The grid is
/// a cube about the middle of the tree's bounding box, with sides at least as long as the longest of
/// the box. A polygon that reaches beyond it is an error:
/// [`BuildOptions::with_bounds`](crate::BuildOptions::with_bounds) makes the grid of a tree larger.
///
/// An overlay keeps a copy of the tree's polygons: 24 bytes a corner and 24 a polygon.
pub struct Overlay {
    /// The faces of the tree, and those of the overlay after them: planes of both have names in one
    /// space.
    faces: Faces,
    base: Base,
    preparer: Preparer,
    placer: Placer,
    pieces: Parts<ExactStored>,
    skeleton: Skeleton,
    preparation: Preparation,
}

/// What tells whether a tree is the one that an overlay was made for.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Base {
    polygons: usize,
    faces: usize,
    corners: usize,
    fragments: usize,
    nodes: usize,
}

impl Base {
    fn of(tree: &BspTree) -> Self {
        Self {
            polygons: tree.preparation.polygons,
            faces: tree.faces.len(),
            corners: tree.faces.corner_count(),
            fragments: tree.len(),
            nodes: tree.nodes.len(),
        }
    }
}

impl Overlay {
    /// An overlay of nothing for a tree, whose polygons it copies. O(n).
    pub fn new(tree: &BspTree) -> Self {
        let faces = tree.faces.clone();
        Self {
            faces,
            base: Base::of(tree),
            preparer: Preparer::default(),
            placer: Placer::default(),
            pieces: Parts::default(),
            skeleton: Skeleton::new(tree.len()),
            preparation: Preparation::default(),
        }
    }

    /// Replaces the overlay's polygons, and cuts them down to the leaves of the tree. (It is made for
    /// what a frame moves: it has no budget, and cannot be cancelled.)
    ///
    /// # Errors
    ///
    /// As for [`BspTree::build`]; if a polygon reaches beyond the tree's grid; or if the tree is not
    /// the one that the overlay was made for. The overlay is empty then. The error names the polygon
    /// where one is to blame, counted from 0.
    pub fn replace<P: Polygon>(
        &mut self,
        tree: &BspTree,
        polygons: impl IntoIterator<Item = P>,
    ) -> Result<(), Error> {
        self.clear();
        self.expect(tree)?;
        let replaced = self.fill(tree, polygons);
        if replaced.is_err() {
            self.clear();
        }
        replaced
    }

    fn fill<P: Polygon>(
        &mut self,
        tree: &BspTree,
        polygons: impl IntoIterator<Item = P>,
    ) -> Result<(), Error> {
        let Self { faces, base, preparer, placer, pieces, skeleton, .. } = self;
        self.preparation = preparer.append(faces, polygons, base.polygons)?;
        placer.begin_at(base.faces);
        placer.place(tree, faces, pieces, skeleton)
    }

    /// Removes all polygons.
    pub fn clear(&mut self) {
        self.faces.truncate(self.base.faces);
        self.pieces.clear();
        self.skeleton.clear(self.base.fragments);
        self.preparation = Preparation::default();
    }

    /// How many pieces there are.
    pub fn len(&self) -> usize {
        self.pieces.records.len()
    }

    /// Whether there are no pieces.
    pub fn is_empty(&self) -> bool {
        self.pieces.records.is_empty()
    }

    /// The piece of a number; `None` if it is that of a fragment of the tree, or of nothing.
    pub fn piece(&self, number: u32) -> Option<Fragment<'_>> {
        let record = (number as usize).checked_sub(self.base.fragments)?;
        let Self { faces, pieces: Parts { records, vertices, positions, .. }, .. } = self;
        let is_piece = record < records.len();
        is_piece
            .then(|| Fragment::new(faces, Stored { records, vertices, positions }, record, number))
    }

    /// How many of the overlay's polygons were dropped or triangulated. (Duplicates are not counted.)
    pub fn preparation(&self) -> &Preparation {
        &self.preparation
    }

    /// The faces of the tree, and those of the overlay behind them.
    #[doc(hidden)]
    pub fn faces(&self) -> &Faces {
        &self.faces
    }

    /// An error if the tree is not the one that the overlay was made for, as far as its size tells.
    fn expect(&self, tree: &BspTree) -> Result<(), Error> {
        let is_same = self.base == Base::of(tree)
            && self.faces.lattice() == tree.faces.lattice()
            && self.faces.tolerance() == tree.faces.tolerance();
        if is_same { Ok(()) } else { Err(Error::overlaid_tree()) }
    }
}

impl fmt::Debug for Overlay {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Overlay")
            .field("tree_fragments", &self.base.fragments)
            .field("polygons", &self.preparation.polygons)
            .field("pieces", &self.pieces.records.len())
            .field("planes", &self.skeleton.branches.len())
            .finish_non_exhaustive()
    }
}
