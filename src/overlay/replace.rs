//! The shapes that replace the contents of an overlay.

use std::ops::ControlFlow;

use glam::DVec3;

use super::Overlay;
use crate::error::Error;
use crate::exact::VertexKind;
use crate::input::{Point, Polygon};
use crate::progress::{Progress, Watch, one_at_a_time};
use crate::tree::{BspTree, Fragment};

impl Overlay {
    /// Replaces the overlay's contents by polygons, and cuts the polygons by the planes of the tree, from the
    /// root to the leaves.
    ///
    /// # Errors
    ///
    /// As for [`BspTree::build`]; if a polygon reaches beyond the tree's [grid](crate::BspTree#exactness);
    /// or if the tree is neither the tree that the overlay was made for nor a clone of it. After an error
    /// the overlay is empty. If a polygon caused the error, [`Error::polygon`] is its index in `polygons`,
    /// from 0.
    pub fn replace<P: Polygon>(
        &mut self,
        tree: &BspTree,
        polygons: impl IntoIterator<Item = P>,
    ) -> Result<(), Error> {
        self.replace_with(tree, Shapes::NONE.with_polygons(polygons))
    }

    /// Replaces the overlay's contents by polygons, lines and points, and cuts these shapes by the planes of
    /// the tree, from the root to the leaves.
    ///
    /// # Errors
    ///
    /// As for [`replace`](Self::replace). If a line or a point caused the error, [`Error::line`] or
    /// [`Error::point`] is its number.
    pub fn replace_with<P, L, Q>(
        &mut self,
        tree: &BspTree,
        shapes: Shapes<P, L, Q>,
    ) -> Result<(), Error>
    where
        P: IntoIterator<Item: Polygon>,
        L: IntoIterator<Item: Polygon>,
        Q: IntoIterator<Item: Point>,
    {
        self.refill(tree, shapes, &Watch::default())
    }

    /// Replaces the contents like [`replace_with`](Self::replace_with), and reports progress to a callback
    /// that can cancel, as in
    /// [`BuildOptions::build_with_progress`](crate::BuildOptions::build_with_progress).
    ///
    /// # Errors
    ///
    /// As for [`replace_with`](Self::replace_with), and if the callback cancels. After an error or a panic of
    /// the callback the overlay is empty.
    pub fn replace_with_progress<P, L, Q>(
        &mut self,
        tree: &BspTree,
        shapes: Shapes<P, L, Q>,
        progress: impl FnMut(Progress) -> ControlFlow<()> + Send,
    ) -> Result<(), Error>
    where
        P: IntoIterator<Item: Polygon>,
        L: IntoIterator<Item: Polygon>,
        Q: IntoIterator<Item: Point>,
    {
        let progress = one_at_a_time(progress);
        self.refill(tree, shapes, &Watch::new(&progress))
    }

    fn refill<P, L, Q>(
        &mut self,
        tree: &BspTree,
        shapes: Shapes<P, L, Q>,
        watch: &Watch<'_>,
    ) -> Result<(), Error>
    where
        P: IntoIterator<Item: Polygon>,
        L: IntoIterator<Item: Polygon>,
        Q: IntoIterator<Item: Point>,
    {
        self.clear();
        self.expect(tree)?;
        let filling = Filling(self);
        let Overlay {
            faces,
            base,
            preparer,
            placer,
            pieces,
            insertions,
            preparation,
            segments,
            ..
        } = &mut *filling.0;
        let Shapes { polygons, lines, points } = shapes;
        if faces.is_empty() {
            *faces = tree.faces.try_clone()?;
        }
        *preparation = preparer.append(faces, polygons, base.polygons, usize::MAX, watch)?;
        preparer.append_lines(faces, lines, segments, watch)?;
        preparer.append_points(faces, points, watch)?;
        watch.expect(faces.len() - base.faces)?;
        placer.place(tree, faces, pieces, insertions, watch)?;
        watch.end()?;
        std::mem::forget(filling);
        Ok(())
    }
}

/// An overlay that is being filled. If filling ends early, `drop` empties the overlay: after an error, or if
/// the caller's callback or iterators panic.
struct Filling<'a>(&'a mut Overlay);

impl Drop for Filling<'_> {
    fn drop(&mut self) {
        self.0.clear();
    }
}

/// Polygons, lines and points for [`Overlay::replace_with`](crate::overlay::Overlay::replace_with).
///
/// ```
/// use binspace::overlay::Shapes;
///
/// let axis = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0]];
/// let curve: Vec<_> = (0..9).map(|k| [0.1 * f64::from(k), 0.5, 0.0]).collect();
/// let shapes = Shapes::NONE.with_lines([&axis[..], &curve]).with_points(curve.iter().copied());
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Shapes<P, L, Q> {
    pub(super) polygons: P,
    pub(super) lines: L,
    pub(super) points: Q,
}

impl Shapes<[[DVec3; 3]; 0], [[DVec3; 2]; 0], [DVec3; 0]> {
    /// No shapes.
    pub const NONE: Self = Self { polygons: [], lines: [], points: [] };
}

impl<P, L, Q> Shapes<P, L, Q> {
    /// Sets the polygons: an iterator of any type of [`Polygon`](crate::Polygon).
    #[must_use]
    pub fn with_polygons<T>(self, polygons: T) -> Shapes<T, L, Q> {
        let Self { lines, points, .. } = self;
        Shapes { polygons, lines, points }
    }

    /// Sets the lines: an iterator of any type of [`Polygon`](crate::Polygon). A line joins the corners of
    /// such a polygon in order, but not the last corner to the first. To close a line, repeat the line's
    /// first corner. A single corner makes no line.
    #[must_use]
    pub fn with_lines<T>(self, lines: T) -> Shapes<P, T, Q> {
        let Self { polygons, points, .. } = self;
        Shapes { polygons, lines, points }
    }

    /// Sets the points: an iterator of any type of [`Point`](crate::Point).
    #[must_use]
    pub fn with_points<T>(self, points: T) -> Shapes<P, L, T> {
        let Self { polygons, lines, .. } = self;
        Shapes { polygons, lines, points }
    }
}

/// An item of an [`OverlayOrder`](super::OverlayOrder): a fragment of the tree, a [piece](Overlay#contents)
/// of a polygon or of a line of the overlay, or a point of the overlay.
#[derive(Clone, Copy, Debug)]
#[non_exhaustive]
pub enum Shape<'a> {
    /// A fragment of the tree, or a piece of one of the overlay's polygons.
    Fragment(Fragment<'a>),
    /// A piece of a segment of a line.
    Segment(Segment<'a>),
    /// A point.
    Marker(Marker),
}

impl<'a> Shape<'a> {
    /// Returns the number of the fragment, piece or point, as in
    /// [`OverlayOrder::write_into`](super::OverlayOrder::write_into).
    pub fn index(&self) -> u32 {
        match self {
            Self::Fragment(fragment) => fragment.index(),
            Self::Segment(segment) => segment.index(),
            Self::Marker(marker) => marker.index(),
        }
    }

    /// Returns the fragment or the piece of a polygon; `None` for segments and markers.
    pub fn fragment(self) -> Option<Fragment<'a>> {
        match self {
            Self::Fragment(fragment) => Some(fragment),
            _ => None,
        }
    }
}

/// A [piece](Overlay#contents) of a segment. A segment joins two consecutive corners of a line of an
/// [`Overlay`].
#[derive(Clone, Copy, Debug)]
pub struct Segment<'a> {
    /// Two vertices on the segment's face.
    piece: Fragment<'a>,
    number: u32,
}

impl Segment<'_> {
    /// Returns the piece's number, as in [`OverlayOrder::write_into`](super::OverlayOrder::write_into).
    pub fn index(&self) -> u32 {
        self.piece.index()
    }

    /// Returns the index of the line, in input order.
    pub fn line(&self) -> usize {
        self.piece.polygon()
    }

    /// Returns the number of the segment in its line: segment `k` joins the corners `k` and `k + 1`.
    pub fn number(&self) -> usize {
        self.number as usize
    }

    /// Returns the two ends of the piece, in the direction of the line. An end at a corner of the line is
    /// the corner, rounded to the tree's [grid](crate::BspTree#exactness). An end at a cut is rounded like
    /// [`Fragment::vertices`]. Two pieces that meet at a cut have bit for bit the same end there.
    pub fn ends(&self) -> [DVec3; 2] {
        let mut ends = self.piece.vertices();
        [(); 2].map(|()| ends.next().unwrap_or_default())
    }

    /// Returns the positions of the piece's two ends along the segment: 0 is the segment's first corner, and
    /// 1 is its second corner. The positions are rounded. If a piece is shorter than the rounding error, its
    /// first position may be larger than its second position.
    pub fn shares(&self) -> [f64; 2] {
        let mut ends = self.piece.weights().map(|weights| {
            weights.iter().map(|&(corner, weight)| f64::from(corner) * weight).sum()
        });
        [(); 2].map(|()| ends.next().unwrap_or_default())
    }

    /// Returns, for each end, whether a cut made the end. Otherwise the end is a corner of the line.
    pub fn cuts(&self) -> [bool; 2] {
        let mut ends = self.piece.vertex_ids();
        [(); 2]
            .map(|()| ends.next().is_some_and(|end| !matches!(end.kind(), VertexKind::Corner(_))))
    }
}

/// A point of an [`Overlay`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Marker {
    index: u32,
    point: u32,
    position: DVec3,
}

impl Marker {
    /// Returns the point's number, as in [`OverlayOrder::write_into`](super::OverlayOrder::write_into).
    pub fn index(&self) -> u32 {
        self.index
    }

    /// Returns the index of the point, in input order.
    pub fn point(&self) -> usize {
        self.point as usize
    }

    /// Returns the given point, rounded to the tree's [grid](crate::BspTree#exactness).
    pub fn position(&self) -> DVec3 {
        self.position
    }
}

impl Overlay {
    /// Returns the piece or point that has a given number in orders. Returns `None` if a fragment of the
    /// tree, or no shape, has this number.
    pub fn shape(&self, number: u32) -> Option<Shape<'_>> {
        let face = self.record(number)?.face;
        let piece = self.stored(number);
        Some(if self.faces.has_area(face) {
            Shape::Fragment(piece)
        } else if (face as usize) < self.faces.first_point() {
            let at = face as usize - self.faces.first_thin();
            Shape::Segment(Segment { piece, number: self.segments[at] })
        } else {
            let position = piece.vertices().next().unwrap_or_default();
            let point = self.faces.polygon(face) as u32;
            Shape::Marker(Marker { index: number, point, position })
        })
    }

    /// Returns the piece of a polygon that has a given number in orders; `None` if no piece of a polygon has
    /// this number.
    pub fn piece(&self, number: u32) -> Option<Fragment<'_>> {
        self.shape(number)?.fragment()
    }
}
