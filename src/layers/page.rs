//! A page: the layers of a frame and their order.

use glam::{DVec2, DVec3};
use smallvec::SmallVec;

use super::clip::{MOST_CORNERS, clip};
use super::piece::{ClippedCorner, Layer, LayerPiece};
use crate::build::{BuildOptions, FrameBuilder};
use crate::error::{Error, Kind, Shape};
use crate::faces::DEFAULT_TOLERANCE;
use crate::input::Polygon;
use crate::viewpoint::Viewpoint;

/// The largest depth of a page's layers, in sizes of the viewport. If the page is not clipped to the
/// viewport, also the largest x and y. Too large: coordinates are rounded to more than the least tolerance.
/// Too small: layers that pass near the eye lose a visible part.
const REACH: f64 = (1 << 20) as f64;
/// The least and the largest tolerance, as shares of the viewport's size.
/// ([`Tolerance::Default`](crate::Tolerance::Default) has the same limits, as shares of the extent.) Too
/// small: cards meant to be in one plane cut each other. Too large: thin layers are merged. A single layer
/// with few digits can merge all thin layers of the page.
const TOLERANCES: [f64; 2] = [DEFAULT_TOLERANCE, 1e-5];
/// The least tolerance as a share of the largest coordinate: at least 32 steps of the grid, whose step is
/// 2⁻⁵² of the page's extent. This limit exceeds the limit of `TOLERANCES[0]` only if a layer reaches further
/// than 35 000 times the viewport's longer side. Too small: a step is more than the tolerance, and coplanar
/// layers whose matrices differ lose their document order (without this limit, in 8 of 2000 unclipped pages).
/// Too large: thin layers are merged.
const GRAIN: f64 = 1.0 / (1u64 << 45) as f64;
/// A point outside a piece counts as inside up to a distance of this share of the viewport's size. Too small:
/// points fall through between pieces. Too large: an edge is hit before it is reached.
const TOUCH: f64 = 1e-9;

/// The layers of a page, cut and in paint order. Memory is reused from frame to frame.
///
/// Pass every frame's layers to [`update`](Self::update), then read the pieces. Unchanged frames take no
/// time; other frames take the time of building a [`BspTree`](crate::BspTree) of as many polygons. [The
/// module](super) has an example and lists the result for every kind of layer.
#[derive(Clone, Debug)]
pub struct Layers {
    viewport: [DVec2; 2],
    is_clipped: bool,
    /// The layers of the last frame.
    layers: Vec<Layer>,
    /// The visible parts of the layers.
    outlines: Vec<Outline>,
    /// The corners of all outlines.
    corners: Vec<ClippedCorner>,
    /// All outlines; outlines in one plane are consecutive.
    by_plane: Vec<u32>,
    builder: FrameBuilder,
    /// Whether the builder's tree belongs to the last frame.
    is_built: bool,
    /// The tree's fragments, back to front.
    order: Vec<u32>,
    visible: usize,
}

/// A clipped layer: an input polygon of the tree.
#[derive(Clone, Debug)]
struct Outline {
    layer: usize,
    /// A number that is equal for layers of one plane.
    plane_key: u64,
    /// The first corner of the outline. The outline's corners end where the next outline's corners begin.
    corners: usize,
    pieces: usize,
}

impl Layers {
    /// Creates an empty page. The viewport is the rectangle of the screen from the corner `low` to the corner
    /// `high`. If the viewport has no area, no layer is visible.
    pub fn new([low, high]: [[f64; 2]; 2]) -> Self {
        Self {
            viewport: [low.into(), high.into()],
            is_clipped: true,
            layers: Vec::new(),
            outlines: Vec::new(),
            corners: Vec::new(),
            by_plane: Vec::new(),
            builder: FrameBuilder::new(BuildOptions::DEFAULT),
            is_built: false,
            order: Vec::new(),
            visible: 0,
        }
    }

    /// Turns off clipping to the viewport, for pages that are painted once and scrolled. The page becomes
    /// empty. Layers outside the viewport are cut as well, which takes time. The size of the viewport still
    /// determines the [tolerance](super#tolerance) and the limits of depth.
    #[must_use]
    pub fn unclipped(mut self) -> Self {
        self.clear();
        self.is_clipped = false;
        self
    }

    /// Sets the viewport: the rectangle from the corner `low` to the corner `high`. Call this method when a
    /// window is resized, for example. If the viewport changes, the page is empty until the next
    /// [`update`](Self::update). Memory is kept.
    pub fn set_viewport(&mut self, [low, high]: [[f64; 2]; 2]) {
        let viewport = [low.into(), high.into()];
        if self.viewport != viewport {
            self.clear();
            self.viewport = viewport;
        }
    }

    /// Sets the layers of a frame. Returns false, and does nothing, if the layers are equal to the
    /// previous frame's layers. Memory of the previous frame is reused.
    ///
    /// # Errors
    ///
    /// If a layer or the viewport has a number that is NaN, infinite or too large ([`Error::polygon`] is the
    /// layer's index), if there are more pieces than a tree may have, or if memory runs out. After an error
    /// the page has no pieces.
    pub fn update(&mut self, layers: &[Layer]) -> Result<bool, Error> {
        if self.is_built && self.layers == layers {
            return Ok(false);
        }
        // The page is empty until its tree is built, and so after an error.
        self.clear();
        self.replace(layers).map(|()| true)
    }

    fn clear(&mut self) {
        self.layers.clear();
        self.outlines.clear();
        self.corners.clear();
        self.order.clear();
        (self.is_built, self.visible) = (false, 0);
    }

    fn replace(&mut self, layers: &[Layer]) -> Result<(), Error> {
        if !self.limits().iter().all(|corner| corner.is_finite()) {
            return Err(Kind::Viewport.error());
        }
        self.layers.reserve(layers.len());
        self.layers.extend_from_slice(layers);
        let precision = self.clip()?;
        let [least, most] = TOLERANCES.map(|share| share * self.size());
        // Large coordinates are rounded to a coarse grid.
        let reach = self
            .corners
            .iter()
            .map(|corner| corner.vertex.position.abs().max_element())
            .fold(0.0, f64::max);
        self.build(precision.max(reach * GRAIN).clamp(least, most))?;
        let tree = self.builder.tree();
        tree.back_to_front_into(Viewpoint::Direction(DVec3::NEG_Z), &mut self.order);
        for fragment in tree.fragments() {
            self.outlines[fragment.polygon()].pieces += 1;
        }
        self.visible = self.outlines.iter().filter(|outline| outline.pieces > 0).count();
        self.is_built = true;
        Ok(())
    }

    /// Clips all layers. Returns the coarsest precision of any layer.
    fn clip(&mut self) -> Result<f64, Error> {
        let (limits, viewport) = (self.limits(), self.is_clipped.then_some(self.viewport));
        let mut coarsest = 0.0f64;
        for (layer, from) in self.layers.iter().enumerate() {
            if !from.is_finite() {
                return Err(Kind::Layer.of_polygon(layer).of(Shape::Layer));
            }
            self.corners.reserve(MOST_CORNERS + from.clips().len());
            let corners = self.corners.len();
            if let Some(precision) = clip(from, limits, viewport, &mut self.corners) {
                coarsest = coarsest.max(precision);
                let plane_key = from.plane_key();
                self.outlines.push(Outline { layer, plane_key, corners, pieces: 0 });
            }
        }
        Ok(coarsest)
    }

    /// Builds the tree of all outlines. No other method builds a tree.
    fn build(&mut self, tolerance: f64) -> Result<(), Error> {
        let Self { builder, layers, outlines, corners, by_plane, .. } = self;
        let polygons = (0..outlines.len()).map(|k| Clipped(corners_of(outlines, corners, k)));
        by_plane.clear();
        by_plane.reserve(outlines.len());
        by_plane.extend(0..outlines.len() as u32);
        by_plane.sort_unstable_by_key(|&k| outlines[k as usize].plane_key);
        let planes = by_plane.chunk_by(|&a, &b| {
            let [a, b] = [a, b].map(|k| &outlines[k as usize]);
            a.plane_key == b.plane_key && layers[a.layer].shares_plane(&layers[b.layer])
        });
        builder.set_options(BuildOptions::DEFAULT.with_tolerance(tolerance));
        builder.build_in_planes(polygons, planes)
    }

    fn corners_of(&self, outline: usize) -> &[ClippedCorner] {
        corners_of(&self.outlines, &self.corners, outline)
    }

    /// The viewport's longer side.
    fn size(&self) -> f64 {
        (self.viewport[1] - self.viewport[0]).max_element().max(0.0)
    }

    /// The box that layers are clipped to.
    fn limits(&self) -> [DVec3; 2] {
        let reach = REACH * self.size();
        let [low, high] = self.viewport;
        let across = if self.is_clipped { 0.0 } else { reach };
        [(low - across).extend(-reach), (high + across).extend(reach)]
    }

    /// Returns the number of visible layers, each with one piece or more. [The
    /// module](super#pieces-of-a-layer) lists the reasons why other layers have no pieces.
    pub fn visible(&self) -> usize {
        self.visible
    }

    /// Returns the number of pieces. If the number of pieces equals the number of [visible](Self::visible)
    /// layers, no layer is cut.
    pub fn len(&self) -> usize {
        self.order.len()
    }

    /// Returns whether no layer is visible.
    pub fn is_empty(&self) -> bool {
        self.order.is_empty()
    }

    /// Returns the pieces in paint order: no piece hides a later piece. Reverse the iterator with `rev()` for
    /// front to back.
    pub fn back_to_front(
        &self,
    ) -> impl DoubleEndedIterator<Item = LayerPiece<'_>> + ExactSizeIterator + Clone {
        self.order.iter().map(|&number| self.piece(number))
    }

    fn piece(&self, number: u32) -> LayerPiece<'_> {
        let fragment = self.builder.tree().fragment(number);
        let index = fragment.polygon();
        let &Outline { layer: number, pieces, .. } = &self.outlines[index];
        LayerPiece {
            number,
            layer: &self.layers[number],
            outline: self.corners_of(index),
            fragment,
            is_whole: pieces == 1,
        }
    }

    /// Returns the nearest layer at a point of the screen: the first of the [`hits`](Self::hits). The result
    /// is the index of the layer, and the point (u, v) of the layer that appears at the point of the screen.
    pub fn hit(&self, point: [f64; 2]) -> Option<(usize, [f64; 2])> {
        self.hits(point).next()
    }

    /// Returns all layers at a point of the screen, front to back. Each layer is returned once, as its index
    /// and the point (u, v) of the layer that appears at the point of the screen.
    ///
    /// The order is the exact order of the pieces. Whether a piece covers the point is decided in `f64`, from
    /// the piece's [vertices](LayerPiece::vertices). A point outside the piece counts as inside if it is
    /// closer to an edge than 10⁻⁹ of the viewport's longer side. If several pieces of one layer cover the
    /// point, the nearest piece determines the layer's place. Takes O(p) for p pieces of the page.
    pub fn hits(&self, [x, y]: [f64; 2]) -> impl Iterator<Item = (usize, [f64; 2])> {
        let slack = TOUCH * self.size();
        let at = DVec2::new(x, y);
        // Where two pieces of a layer meet, the point touches both.
        let mut listed: SmallVec<[usize; 8]> = SmallVec::new();
        self.back_to_front().rev().filter_map(move |piece| {
            // Most pieces are excluded by their layer, without computing a vertex.
            if !(piece.is_near(at, slack) && piece.covers(at, slack)) {
                return None;
            }
            if !piece.is_whole() {
                if listed.contains(&piece.number) {
                    return None;
                }
                listed.push(piece.number);
            }
            let local = piece.layer.local(at.to_array())?;
            Some((piece.number, piece.layer.clamp(local.into()).to_array()))
        })
    }
}

/// The corners of an outline.
fn corners_of<'a>(
    outlines: &[Outline],
    corners: &'a [ClippedCorner],
    outline: usize,
) -> &'a [ClippedCorner] {
    let end = outlines.get(outline + 1).map_or(corners.len(), |next| next.corners);
    &corners[outlines[outline].corners..end]
}

/// A clipped layer, as a polygon for the builder.
struct Clipped<'p>(&'p [ClippedCorner]);

impl Polygon for Clipped<'_> {
    type Point = DVec3;

    fn corners(&self) -> impl Iterator<Item = DVec3> {
        self.0.iter().map(|corner| corner.vertex.position)
    }

    /// Returns 0: a page sets its own tolerance, so the default is not used.
    fn precision(&self) -> f64 {
        0.0
    }
}
