//! What a page is painted by.

use glam::DVec2;

use super::layer::Layer;
use super::vertex::{ClippedCorner, LayerVertex, interpolated};
use crate::tree::Fragment;

/// A convex piece of a layer, or all that is seen of it.
#[derive(Clone, Copy, Debug)]
pub struct LayerPiece<'p> {
    pub(super) number: usize,
    pub(super) layer: &'p Layer,
    /// The layer as clipped, of which the fragment is a piece.
    pub(super) outline: &'p [ClippedCorner],
    pub(super) fragment: Fragment<'p>,
    pub(super) is_whole: bool,
}

impl<'p> LayerPiece<'p> {
    /// The index of its layer in the list.
    pub fn layer(&self) -> usize {
        self.number
    }

    /// Whether no other layer cuts its layer: it is all that is seen of it.
    pub fn is_whole(&self) -> bool {
        self.is_whole
    }

    /// The vertices, in the layer's own orientation: as u runs towards v, clockwise on the screen if
    /// the layer is seen from its front.
    ///
    /// Pieces of one layer that share a vertex get the same bits for its position. The place in the
    /// layer is u = Σ λ u/w ÷ Σ λ/w, with the weights λ of the vertex over the corners on the screen.
    pub fn vertices(&self) -> impl ExactSizeIterator<Item = LayerVertex> + use<'p> {
        let Self { layer, outline, fragment, .. } = *self;
        fragment.vertices().zip(fragment.weights()).map(move |(position, weights)| {
            if let [(corner, _)] = weights[..] {
                return outline[corner as usize].vertex;
            }
            interpolated(layer, outline, position, &weights)
        })
    }

    /// For each edge, from a vertex to the next: which edge of the layer's rectangle it lies on, or
    /// `None` if a cut or clipping made it. Edges of the layer are those to smooth: where pieces of
    /// one layer meet, smoothing would let the background through.
    ///
    /// Edge 0 runs from the rectangle's low corner along u, edge 1 along v, edges 2 and 3 back.
    pub fn edges(&self) -> impl ExactSizeIterator<Item = Option<u8>> + use<'p> {
        let outline = self.outline;
        self.fragment.edges().map(move |edge| outline[edge? as usize].edge)
    }

    /// Whether its layer's part on the screen has a point of the screen in its bounding box, or comes
    /// as near to it as `slack`.
    pub(super) fn is_near(&self, at: DVec2, slack: f64) -> bool {
        let corners = self.outline.iter().map(|corner| corner.vertex.position.truncate());
        let empty = [DVec2::INFINITY, DVec2::NEG_INFINITY];
        let bounds = corners.fold(empty, |[low, high], to| [low.min(to), high.max(to)]);
        at.cmpge(bounds[0] - slack).all() && at.cmple(bounds[1] + slack).all()
    }

    /// Whether it covers a point of the screen, or comes as near to it as `slack`.
    ///
    /// By a ray along x, which the outline crosses an odd number of times, and by distances from the
    /// edges: not by sides of lines, as that of an edge no longer than its rounding points anywhere.
    pub(super) fn covers(&self, at: DVec2, slack: f64) -> bool {
        let mut vertices = self.vertices().map(|vertex| vertex.position.truncate());
        let Some(first) = vertices.next() else { return false };
        let (mut from, mut is_inside) = (first, false);
        for to in vertices.chain([first]) {
            let (edge, arm) = (to - from, at - from);
            // Where on the edge the nearest point is; NaN of an edge without length.
            let share = (arm.dot(edge) / edge.length_squared()).clamp(0.0, 1.0);
            let nearest = if share > 0.0 { edge * share } else { DVec2::ZERO };
            if arm.distance_squared(nearest) <= slack * slack {
                return true;
            }
            let crosses = (from.y > at.y) != (to.y > at.y);
            is_inside ^= crosses && arm.x < edge.x * (arm.y / edge.y);
            from = to;
        }
        is_inside
    }
}
