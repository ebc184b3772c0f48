//! Moving polygons, lines and points beside a tree that does not change.

mod following;
mod hosts;
mod order;
pub(crate) mod place;
mod region;
mod replace;
mod thin;

use std::fmt::{self, Debug};
use std::iter::FusedIterator;
use std::sync::OnceLock;

use order::InsertionTree;
pub use order::{Overlaid, OverlayOrder};
use place::Placer;
pub use replace::{Marker, Segment, Shape, Shapes};

use crate::error::{Error, Kind};
use crate::exact::Faces;
use crate::faces::{Preparation, Preparer};
use crate::query::{Hit, Pieces, Targets};
use crate::tree::bounds::Bounds;
use crate::tree::parts::{Parts, Record};
use crate::tree::{BspTree, Fragment, Mesh, Source};
use crate::viewpoint::Ray;

/// A set of moving polygons, lines and points that are painted in one exact order with a static tree.
/// Examples are doors, characters and cursors, or the axes, curves, markers and labels of a plot.
///
/// # Use
///
/// Make an overlay once. Replace its polygons whenever they move. Then write one order of the tree's polygons
/// and the overlay's polygons:
///
/// ```
/// use binspace::overlay::Overlay;
/// use binspace::{BspTree, Viewpoint};
///
/// let square = |z: f64| [[0.0, 0.0, z], [1.0, 0.0, z], [1.0, 1.0, z], [0.0, 1.0, z]];
/// let tree = BspTree::build([square(0.0), square(2.0)])?;
/// let from_above = Viewpoint::direction([0.0, 0.0, -1.0]);
///
/// let mut overlay = Overlay::new(&tree);
/// let mut order = Vec::new();
/// for (z, expected) in [(0.5, [0, 2, 1]), (1.5, [0, 2, 1]), (2.5, [0, 1, 2])] {
///     overlay.replace(&tree, [square(z)])?;
///     overlay.order(&tree, from_above)?.write_into(&mut order);
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
/// [`replace_with`](Self::replace_with) also takes lines and points. An order is an iterator over [`Shape`]s:
///
/// ```
/// use binspace::overlay::{Overlay, Shape, Shapes};
/// use binspace::{BspTree, Viewpoint};
///
/// let square = |z: f64| [[0.0, 0.0, z], [2.0, 0.0, z], [2.0, 2.0, z], [0.0, 2.0, z]];
/// let tree = BspTree::build([square(0.0), square(2.0)])?;
/// let post = [[1.0, 1.0, 0.0], [1.0, 1.0, 1.0], [1.0, 1.0, 2.0]];
/// let mut overlay = Overlay::new(&tree);
/// overlay.replace_with(&tree, Shapes::NONE.with_lines([post]).with_points([post[1]]))?;
///
/// let from_above = Viewpoint::direction([0.0, 0.0, -1.0]);
/// let mut painted = Vec::new();
/// for shape in overlay.order(&tree, from_above)? {
///     painted.push(match shape {
///         Shape::Fragment(fragment) => format!("polygon {}", fragment.polygon()),
///         Shape::Segment(segment) => format!("line {}.{}", segment.line(), segment.number()),
///         Shape::Marker(marker) => format!("point {}", marker.point()),
///         _ => unreachable!(),
///     });
/// }
/// assert_eq!(painted[0], "polygon 0");
/// assert_eq!(painted[4], "polygon 1");
/// # assert_eq!(painted.len(), 5);
/// # Ok::<(), binspace::Error>(())
/// ```
///
/// # Queries
///
/// [`hits`](Self::hits) returns the polygons of the tree and of the overlay along a ray, nearest first.
/// [`is_occluded`](Self::is_occluded) returns whether a polygon of the tree or of the overlay blocks the line
/// of sight between two points. [`welded_mesh`](Self::welded_mesh) returns the overlay's polygons as vertices
/// and triangles for a renderer.
///
/// # Contents
///
/// Each polygon of the overlay passes down the tree, from the root to the leaves that the polygon reaches.
/// The partition planes that the polygon crosses cut the polygon into *pieces*. Where several pieces reach
/// one leaf, a small separate tree orders these pieces. The static tree itself never changes.
///
/// Lines and points pass down the tree in the same way. A line consists of *segments*, each between two
/// consecutive corners, and planes cut the segments into pieces. Lines and points never cause a cut of a
/// polygon. Segments without length have no pieces.
///
/// | item | method | numbers |
/// |---|---|---|
/// | polygon of the overlay | [`Fragment::polygon`] | follow the numbers of the tree's polygons |
/// | line | [`Segment::line`] | from 0, in input order |
/// | point | [`Marker::point`] | from 0, in input order |
/// | piece of a polygon or of a line, or a point, in an order | [`Shape::index`] | follow the numbers of the tree's fragments: the first number is the tree's [`len`](BspTree::len) |
///
/// All numbers are valid until the next [`replace`](Self::replace).
///
/// # Order
///
/// The order is as exact as the tree's order: the rules on the page of [`BspTree`](BspTree#order) apply to
/// the polygons of the tree and of the overlay. Coplanar polygons are painted in input order: first the
/// tree's polygons, then the overlay's polygons. The tree's [fragments](BspTree#contents) keep the order
/// that they have without the overlay, and the overlay's pieces are inserted between them.
///
/// A line or a point, and another shape, are painted in this order:
///
/// | both shapes | painted |
/// |---|---|
/// | overlap in the picture, but do not touch in space | the nearer shape later |
/// | lie in one plane and touch in space | polygons, then lines in input order, then points |
/// | lie, within the tolerance, in one *dividing plane* that is seen edge-on | polygons, then lines in input order, then points, even if the shape painted first is nearer |
///
/// So an axis drawn on a wall is painted over the wall. A line that crosses a plane is cut at the plane, and
/// a point at the cut is painted between the two parts. The dividing planes are
///
/// - the planes of the tree ([`BspTree::nodes`]), and the planes of the overlay's polygons;
/// - in a part of space that contains lines or points but no polygon: planes perpendicular to an axis through
///   a corner or a point, and planes through segments. The plane through a segment contains the next corner
///   of the line, or, if that corner is collinear with the segment, the corner before the segment. If both
///   corners are collinear with the segment, the plane is parallel to the z axis, or for a segment along z to
///   the x axis.
///
/// The third row never applies to an eye that lies in no plane of a polygon or segment and shares no x, y or
/// z coordinate with a corner or point. (If a grid of markers is seen exactly along a plane of the grid, the
/// nearest marker may be painted first. Move the eye a little, or pass the markers in another order.)
///
/// A point at a corner of a line is painted after the two pieces of the line that meet at the corner, under
/// two conditions: no polygon's plane passes through the corner, and no other point lies at the line's
/// previous or next corner. Closed lines and repeated corners follow the same rule. If more than two segments
/// meet at a point, some segments may be painted after the point.
///
/// The tolerance of an overlay is the tree's [tolerance](BspTree#exactness) or the [default
/// tolerance](crate::Tolerance::Default) of the overlay's shapes, whichever is larger. So a decal in `f32` lies
/// on a wall in `f64`. If the tree's tolerance is 0, so is the overlay's. The tolerance also applies to lines
/// and points:
///
/// - a segment or point that reaches no further from a plane than the tolerance lies on the plane;
/// - a segment that reaches further than the tolerance on only one side of a plane counts as entirely on that
///   side.
///
/// Orders ignore the widths of lines and the sizes of markers, which exist in the picture only. A wide line
/// may extend over a polygon that the line itself only touches, such as one of two walls that meet at the
/// line. That polygon may be painted over the line's border.
///
/// | | time |
/// |---|---|
/// | [`replace_with`](Self::replace_with) | O(p · d) for p pieces and a tree of depth d, plus the build of small trees where pieces meet, plus the time for pieces near planes |
/// | [`order`](Self::order), written or read | the time of the tree's order, plus a copy of its list |
/// | [`hits`](Self::hits), [`is_occluded`](Self::is_occluded) | the time of the tree's query, plus the time for the bounding boxes of the overlay's pieces that the ray crosses; the first call computes the bounding boxes of the tree and of the pieces, in O(n) for n fragments and pieces |
/// | [`welded_mesh`](Self::welded_mesh) | O(n + m log m) for n corners of the tree's polygons and m vertices of the overlay's pieces |
///
/// A piece near a plane and along it goes where the polygons are on which it lies: those of the overlay, the largest first,
/// and beyond them those of the tree. If their planes differ by rounding and a plane of the tree passes between them, the
/// piece is cut at their borders: a label over n small squares of a flat wall in `f32` can become some n pieces. To find the polygons takes the time of a [region
/// query](BspTree::fragments_in) of the piece's bounding box at each such plane; the first query computes the bounding
/// boxes of the tree, in O(n) for n fragments. If pieces near a plane go to different sides, each is compared with the
/// larger polygons whose bounding boxes touch its own: O(k²) for k polygons over one another.
///
/// A body of many polygons passes down the tree in little time: if its bounding box lies on one side of a
/// plane, all polygons move to that side at once. Each `replace` builds the small tree of the body again,
/// which takes milliseconds for a body of thousands of polygons.
///
/// All coordinates are rounded to the tree's [grid](BspTree#exactness). The grid is a cube around the middle
/// of the tree's bounding box, with sides at least as long as the longest side of the box. A shape that
/// reaches beyond the grid is an error. To make the grid of a tree larger, build the tree with
/// [`BuildOptions::with_bounds`](crate::BuildOptions::with_bounds).
///
/// An overlay keeps a copy of the tree's polygons: 24 bytes per corner and 12 per polygon. The first
/// `replace` makes this copy, in O(n) for n corners.
pub struct Overlay {
    /// The faces of the tree, then the faces of the overlay: planes of both are numbered together.
    faces: Faces,
    base: Base,
    preparer: Preparer,
    placer: Placer,
    pieces: Parts,
    insertions: InsertionTree,
    preparation: Preparation,
    /// For each face that is a segment, the number of the segment in its line.
    segments: Vec<u32>,
    /// The boxes of the pieces, computed by the first ray or culled order.
    bounds: OnceLock<Bounds>,
}

/// The tree that an overlay was made for.
#[derive(Clone, Copy, Debug)]
struct Base {
    generation: u64,
    polygons: usize,
    faces: usize,
    fragments: usize,
    /// The tolerance of the tree, in lattice units.
    tolerance: f64,
}

impl Base {
    fn of(tree: &BspTree) -> Self {
        Self {
            generation: tree.generation,
            polygons: tree.preparation.polygons,
            faces: tree.faces.len(),
            fragments: tree.len(),
            tolerance: tree.faces.tolerance(),
        }
    }
}

impl Overlay {
    /// Makes an empty overlay for a tree. O(1): the first `replace` copies the tree's polygons.
    pub fn new(tree: &BspTree) -> Self {
        Self {
            faces: tree.faces.without_faces(),
            base: Base::of(tree),
            preparer: Preparer::for_overlays(),
            placer: Placer::default(),
            pieces: Parts::default(),
            insertions: InsertionTree::new(tree.len()),
            preparation: Preparation::default(),
            segments: vec![],
            bounds: OnceLock::new(),
        }
    }

    /// Removes all polygons, lines and points.
    pub fn clear(&mut self) {
        self.faces.truncate(self.base.faces);
        self.faces.tolerance = self.base.tolerance;
        self.pieces.clear();
        self.insertions.clear(self.base.fragments);
        self.preparation = Preparation::default();
        self.segments.clear();
        self.bounds.take();
    }

    /// Returns the number of [pieces](Self#contents) and points.
    pub fn len(&self) -> usize {
        self.pieces.records.len()
    }

    /// Returns whether there is no piece and no point.
    pub fn is_empty(&self) -> bool {
        self.pieces.records.is_empty()
    }

    fn record(&self, number: u32) -> Option<&Record> {
        self.pieces.records.get((number as usize).checked_sub(self.base.fragments)?)
    }

    /// The piece with a number, as a fragment.
    fn stored(&self, number: u32) -> Fragment<'_> {
        let record = number as usize - self.base.fragments;
        Fragment::new(&self.faces, self.pieces.stored(), record, number)
    }

    /// Returns the polygons of the tree and of the overlay that a ray or a segment hits, nearest first. The
    /// overlay's polygons are numbered after the tree's. Lines and points are not hit.
    ///
    /// ```
    /// use binspace::overlay::Overlay;
    /// use binspace::{BspTree, Ray};
    ///
    /// let square = |z: f64| [[0.0, 0.0, z], [1.0, 0.0, z], [1.0, 1.0, z], [0.0, 1.0, z]];
    /// let tree = BspTree::build([square(0.0), square(2.0)])?;
    /// let mut overlay = Overlay::new(&tree);
    /// overlay.replace(&tree, [square(1.0)])?;
    ///
    /// let down = Ray::new([0.5, 0.5, 3.0], [0.0, 0.0, -1.0]);
    /// assert!(overlay.hits(&tree, down)?.map(|hit| hit.polygon()).eq([1, 2, 0]));
    /// assert!(overlay.is_occluded(&tree, Ray::between([0.5, 0.5, 0.5], [0.5, 0.5, 1.5]))?);
    /// # Ok::<(), binspace::Error>(())
    /// ```
    ///
    /// The rules of [`BspTree::hits`] apply to all polygons, and hits are exact. If the ray hits several
    /// polygons at one point, the tree's polygons precede the overlay's polygons. All hits of the overlay
    /// are found first, in time proportional to the number of bounding boxes of the overlay's pieces that
    /// the ray crosses. The first call after a [`replace`](Self::replace) computes the bounding boxes of all
    /// pieces, in time proportional to the number of pieces. The first call for a tree also computes the
    /// bounding boxes of the tree, in O(n) for n fragments, like [`BspTree::bounds`].
    ///
    /// # Errors
    ///
    /// If the tree is neither the tree that the overlay was made for nor a clone of it.
    pub fn hits<'a>(
        &'a self,
        tree: &'a BspTree,
        ray: Ray,
    ) -> Result<impl FusedIterator<Item = Hit<'a>> + Clone + Debug, Error> {
        Ok(self.targets(tree)?.hits(ray))
    }

    /// Returns whether a polygon of the tree or of the overlay blocks a line of sight, by the rules of
    /// [`BspTree::is_occluded`]. [`Ray::between`] makes the line of sight between two points.
    ///
    /// # Errors
    ///
    /// As for [`hits`](Self::hits).
    pub fn is_occluded(&self, tree: &BspTree, ray: Ray) -> Result<bool, Error> {
        Ok(self.targets(tree)?.is_occluded(ray))
    }

    /// Returns the pieces of the overlay's polygons as vertices and triangles, without
    /// [T-junctions](BspTree#t-junctions) between pieces.
    ///
    /// The mesh is separate from the tree's [mesh](BspTree::welded_mesh). The two meshes share no vertices,
    /// so there can be T-junctions between the overlay's pieces and the tree's fragments. Pieces have the
    /// same numbers as in an [order](Self::order), from the tree's [`len`](BspTree::len) on. The overlay's
    /// polygons are numbered after the tree's polygons.
    ///
    /// [`Triangles::write_order_with`](crate::mesh::Triangles::write_order_with) writes one list of indices
    /// for both meshes:
    ///
    /// ```
    /// use binspace::overlay::Overlay;
    /// use binspace::{BspTree, Viewpoint};
    ///
    /// let square = |z: f64| [[0.0, 0.0, z], [1.0, 0.0, z], [1.0, 1.0, z], [0.0, 1.0, z]];
    /// let tree = BspTree::build([square(0.0), square(2.0)])?;
    /// let level = tree.welded_mesh()?; // its vertices go to the device once
    /// let mut overlay = Overlay::new(&tree);
    ///
    /// // When something has moved: its vertices go after the level's, in the same buffer.
    /// overlay.replace(&tree, [square(1.0)])?;
    /// let moved = overlay.welded_mesh()?;
    /// assert_eq!((level.len(), moved.len()), (8, 4));
    ///
    /// // Every frame:
    /// let (mut order, mut indices) = (vec![], vec![0; 18]);
    /// overlay.order(&tree, Viewpoint::eye([0.5, 0.5, 9.0]))?.write_into(&mut order);
    /// let count = level.triangles().write_order_with(moved.triangles(), &order, &mut indices)?;
    /// assert_eq!(count, 18);
    /// assert_eq!(indices[6..12], [8, 9, 10, 8, 10, 11]);
    /// # Ok::<(), binspace::Error>(())
    /// ```
    ///
    /// Takes O(n + m log m) for n corners of the tree's polygons and m vertices of the overlay's pieces.
    ///
    /// # Errors
    ///
    /// As for [`BspTree::mesh`].
    pub fn welded_mesh(&self) -> Result<Mesh, Error> {
        let Self { faces, base, pieces, .. } = self;
        let first_corner = match base.faces < faces.len() {
            true => faces.corner_range(base.faces as u32).start,
            false => faces.corner_count(),
        };
        let (stored, generation, first) = (pieces.stored(), base.generation, base.fragments);
        Mesh::new(Source { faces, stored, generation, first, first_corner }, true)
    }

    fn targets<'a>(&'a self, tree: &'a BspTree) -> Result<Targets<'a>, Error> {
        self.expect(tree)?;
        let pieces = (!self.is_empty()).then(|| {
            let (faces, stored) = (&self.faces, self.pieces.stored());
            Pieces { faces, stored, bounds: self.boxes() }
        });
        Ok(Targets { tree, pieces })
    }

    /// The boxes of the pieces, computed at the first use.
    fn boxes(&self) -> &Bounds {
        let flat = |piece| Fragment::new(&self.faces, self.pieces.stored(), piece, 0).flat_bounds();
        self.bounds.get_or_init(|| Bounds::of_pieces(self.len(), flat))
    }

    /// Returns how many of the overlay's polygons were dropped or triangulated.
    pub fn preparation(&self) -> &Preparation {
        &self.preparation
    }

    /// Returns the faces of the tree, then the faces of the overlay.
    #[doc(hidden)]
    pub fn faces(&self) -> &Faces {
        &self.faces
    }

    /// Returns an error if the tree is neither the tree that the overlay was made for nor a clone of it.
    fn expect(&self, tree: &BspTree) -> Result<(), Error> {
        let is_same = self.base.generation == tree.generation;
        if is_same { Ok(()) } else { Err(Kind::OverlaidTree.error()) }
    }
}

impl fmt::Debug for Overlay {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Overlay")
            .field("tree_fragments", &self.base.fragments)
            .field("polygons", &self.preparation.polygons)
            .field("segments", &self.segments.len())
            .field("points", &self.faces.thin.points)
            .field("pieces", &self.pieces.records.len())
            .field("planes", &self.insertions.branches.len())
            .finish_non_exhaustive()
    }
}
