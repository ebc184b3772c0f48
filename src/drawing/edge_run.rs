//! Runs of edges and of crossings: what a drawing of lines is made of.

/// What a line is in a drawing of lines.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum EdgeKind {
    /// No other polygon has the same edge, or several do.
    Border,
    /// One polygon at the edge is seen from its front, the other from behind, or one of them edge-on; or so
    /// are two parts of one polygon that is not planar: a body ends there, as seen from the eye. (Of two whose
    /// fronts are not on one side of the surface, one is turned round for this.)
    Silhouette,
    /// Two polygons meet at this angle, in radians: 0 where they lie in one plane, π where one is folded
    /// back on the other.
    Crease(f64),
    /// The polygon and another one, of this number, go through one another there.
    Crossing(usize),
}

/// A part of an edge or of a crossing, visible or hidden from one end to the other.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct EdgeRun {
    /// A polygon that has the edge, and shows a side to the camera.
    pub polygon: usize,
    /// The number, within that polygon, of the corner where the edge begins; `None` of a crossing, and of a
    /// silhouette inside a polygon that is not planar.
    pub edge: Option<u32>,
    /// What the line is.
    pub kind: EdgeKind,
    /// Where the run begins and ends in the picture, in pixels from the centre of the first one: in the direction
    /// in which the polygon runs along the edge; a crossing has either.
    pub ends: [[f64; 2]; 2],
    /// Whether it shows.
    pub is_visible: bool,
    /// How many polygons lie in front of it; `None` if they were not counted. Of a visible run that is 0: what it
    /// is seen through does not count.
    pub layers: Option<u32>,
}

/// Runs and gaps shorter than this, in pixels, are what rounding has left.
pub(super) const SHORTEST: f64 = 1e-6;
