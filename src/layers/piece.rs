//! Layers, the pieces that a page is painted with, and the vertices of pieces.

use glam::{DMat4, DVec2, DVec3, DVec4, Mat4};

use crate::tree::Fragment;

/// A convex piece of a layer, or the whole visible part of a layer.
#[derive(Clone, Copy, Debug)]
pub struct LayerPiece<'p> {
    pub(super) number: usize,
    pub(super) layer: &'p Layer,
    /// The clipped layer that the fragment is a piece of.
    pub(super) outline: &'p [ClippedCorner],
    pub(super) fragment: Fragment<'p>,
    pub(super) is_whole: bool,
}

impl<'p> LayerPiece<'p> {
    /// Returns the index of the piece's layer in the list passed to
    /// [`Layers::update`](super::Layers::update).
    pub fn layer(&self) -> usize {
        self.number
    }

    /// Returns whether the piece is the whole visible part of its layer: no other layer cuts that part.
    pub fn is_whole(&self) -> bool {
        self.is_whole
    }

    /// Returns the vertices of the piece. They are listed in the direction of the rotation from the u axis to
    /// the v axis. This direction is clockwise on the screen if the layer is seen from its front.
    ///
    /// Pieces of one layer that share a vertex have bit for bit the same position of the vertex. The place
    /// (u, v) of a vertex that a cut made is interpolated with correct perspective.
    pub fn vertices(&self) -> impl ExactSizeIterator<Item = LayerVertex> + use<'p> {
        let Self { layer, outline, fragment, .. } = *self;
        fragment.vertices().zip(fragment.weights()).map(move |(position, weights)| {
            if let [(corner, _)] = weights[..] {
                return outline[corner as usize].vertex;
            }
            interpolated(layer, outline, position, &weights)
        })
    }

    /// Returns, for each edge of the piece, the number of the layer's edge that contains the edge of the
    /// piece. Edges of the piece are in the order of the [vertices](Self::vertices), and each leads from a
    /// vertex to the next vertex. [Antialias](super#antialiasing) only edges with a number: where pieces of
    /// one layer meet, antialiasing would let the background through.
    ///
    /// | number | edge |
    /// |---|---|
    /// | 0 | the edge of the layer's rectangle from the low corner along u |
    /// | 1 | the next edge, along v |
    /// | 2, 3 | the two edges back to the low corner |
    /// | 4 to 7 | the four edges of the first ancestor added by [`clipped_by`](Layer::clipped_by), in the same order |
    /// | 8 to 255 | four edges for each further ancestor, up to the 63rd |
    /// | `None` | an edge made by a cut, by the viewport, or by an ancestor after the 63rd |
    pub fn edges(&self) -> impl ExactSizeIterator<Item = Option<u8>> + use<'p> {
        let outline = self.outline;
        self.fragment.edges().map(move |edge| outline[edge? as usize].edge)
    }

    /// Whether a point of the screen is in the bounding box of the visible part of the piece's layer, or
    /// within `slack` of that box.
    pub(super) fn is_near(&self, at: DVec2, slack: f64) -> bool {
        let corners = self.outline.iter().map(|corner| corner.vertex.position.truncate());
        let empty = [DVec2::INFINITY, DVec2::NEG_INFINITY];
        let bounds = corners.fold(empty, |[low, high], to| [low.min(to), high.max(to)]);
        at.cmpge(bounds[0] - slack).all() && at.cmple(bounds[1] + slack).all()
    }

    /// Whether the piece covers a point of the screen, or is within `slack` of the point.
    ///
    /// The piece covers the point if the outline crosses a ray along x from the point an odd number of times.
    /// Sides of lines are not tested: an edge no longer than its rounding error may have any direction.
    pub(super) fn covers(&self, at: DVec2, slack: f64) -> bool {
        let mut vertices = self.vertices().map(|vertex| vertex.position.truncate());
        let Some(first) = vertices.next() else { return false };
        let (mut from, mut is_inside) = (first, false);
        for to in vertices.chain([first]) {
            let (edge, arm) = (to - from, at - from);
            // The nearest point of the edge; NaN for an edge without length.
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

/// A corner of a piece.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LayerVertex {
    /// The position on the screen and the depth: (x/w, y/w, z/w).
    pub position: DVec3,
    /// The positive w by which the coordinates were divided.
    pub w: f64,
    /// The position (u, v) in the layer's own rectangle.
    pub local: DVec2,
}

impl LayerVertex {
    /// Returns (x, y, z, w), for a GPU, which divides by w itself.
    pub fn homogeneous(&self) -> DVec4 {
        (self.position * self.w).extend(self.w)
    }

    /// Returns (u/w, v/w, 1/w). These three numbers are linear over the piece on the screen, unlike u and v.
    /// Interpolate them, then divide the first two by the third.
    pub fn perspective(&self) -> DVec3 {
        self.local.extend(1.0) / self.w
    }
}

/// A corner of a clipped layer.
#[derive(Clone, Copy, Debug)]
pub(super) struct ClippedCorner {
    pub(super) vertex: LayerVertex,
    /// The edge that begins at this corner: an edge of the rectangle or of an ancestor's rectangle. `None` if
    /// the box made the edge.
    pub(super) edge: Option<u8>,
}

/// The vertex at a point of the screen, given the point's weights over corners.
pub(super) fn interpolated(
    layer: &Layer,
    outline: &[ClippedCorner],
    position: DVec3,
    weights: &[(u32, f64)],
) -> LayerVertex {
    let corner = |k: u32| outline[k as usize].vertex;
    // Each w is a multiple of one corner's w, so that no w is too small or too large.
    let unit = weights.first().map_or(1.0, |&(k, _)| corner(k).w);
    let term =
        |&(k, weight): &(u32, f64)| corner(k).local.extend(1.0) * (weight * (unit / corner(k).w));
    let sum: DVec3 = weights.iter().map(term).sum();
    let local = layer.clamp(sum.truncate() / sum.z);
    LayerVertex { position, w: unit / sum.z, local }
}

/// A rectangle in its own coordinates, and a matrix that maps the rectangle to the screen. Rectangles of
/// ancestors may cut the layer: see [`clipped_by`](Self::clipped_by).
///
/// Two layers are equal if all their numbers are equal. If the layers of a frame equal the layers of the
/// previous frame, [`Layers::update`](super::Layers::update) does nothing.
#[derive(Clone, Debug, PartialEq)]
pub struct Layer {
    low: DVec2,
    high: DVec2,
    /// The coefficients of u, v and 1 in x, y, z and w.
    rows: [DVec3; 4],
    /// The machine epsilon of the matrix's number type.
    step: f64,
    /// Half-planes that cut the rectangle: the points whose products with (u, v, 1) are not negative.
    clips: Vec<DVec3>,
}

/// Returns the matrix of CSS `perspective` for the children of an element: the eye is `distance` in front of
/// the point `origin` of the element (CSS `perspective-origin`, by default its middle). The distance must be
/// positive.
pub fn perspective(distance: f64, origin: [f64; 2]) -> DMat4 {
    let mut matrix = DMat4::IDENTITY;
    matrix.z_axis.w = -1.0 / distance;
    about(origin, matrix)
}

/// Returns a matrix that transforms about the point `origin` as `matrix` transforms about (0, 0). With the
/// `transform-origin` of CSS as `origin`, by default the middle of the element's box, this is the matrix of
/// CSS `transform`.
pub fn about([x, y]: [f64; 2], matrix: DMat4) -> DMat4 {
    let origin = DVec3::new(x, y, 0.0);
    DMat4::from_translation(origin) * matrix * DMat4::from_translation(-origin)
}

impl Layer {
    /// Creates a layer: the rectangle from `low` to `high`, in the layer's own coordinates (u, v), and a
    /// matrix from (u, v, 0, 1) to homogeneous screen coordinates (x, y, z, w). The matrix's z column is not
    /// used.
    pub fn new([low, high]: [[f64; 2]; 2], matrix: DMat4) -> Self {
        Self::with_step([low, high], matrix, f64::EPSILON)
    }

    /// Creates a layer with the rectangle from (0, 0) to (width, height): the box of a CSS element, with u to
    /// the right and v downwards from its upper left corner. [The module](super#matrices) shows how to
    /// compute the matrix of an element.
    pub fn rect([width, height]: [f64; 2], matrix: DMat4) -> Self {
        Self::new([[0.0, 0.0], [width, height]], matrix)
    }

    /// Creates a layer like [`new`](Self::new), with a matrix that was computed in `f32`. Layers that are in
    /// one plane up to the rounding of `f32` count as coplanar.
    pub fn from_f32([low, high]: [[f64; 2]; 2], matrix: Mat4) -> Self {
        Self::with_step([low, high], matrix.as_dmat4(), f64::from(f32::EPSILON))
    }

    fn with_step([low, high]: [[f64; 2]; 2], matrix: DMat4, step: f64) -> Self {
        let row = |k: usize| DVec3::new(matrix.x_axis[k], matrix.y_axis[k], matrix.w_axis[k]);
        let rows = [0, 1, 2, 3].map(row);
        Self { low: low.into(), high: high.into(), rows, step, clips: Vec::new() }
    }

    /// Cuts the layer by the rectangle of an ancestor with hidden overflow (CSS `overflow: hidden`), and by
    /// the rectangles that cut the ancestor. Call this method again for further ancestors. The ancestor
    /// itself is painted only if it is also in the list of layers.
    ///
    /// | relation of layer and ancestor | visible part of the layer |
    /// |---|---|
    /// | they have the same matrix | the intersection of both outlines, exact |
    /// | they lie in one plane, but have different matrices (CSS flattens the content of such an ancestor into its plane) | the intersection of both outlines, rounded to `f64` |
    /// | they lie in different planes | the part inside the ancestor's outline on the screen |
    /// | the ancestor is seen edge-on | none |
    ///
    /// ```
    /// use binspace::glam::{DMat4, DVec3};
    /// use binspace::layers::{Layer, Layers};
    ///
    /// let place = DMat4::from_translation(DVec3::new(20.0, 20.0, 0.0));
    /// let window = Layer::rect([100.0, 50.0], place);
    /// let scrolled = place * DMat4::from_translation(DVec3::new(0.0, -300.0, 0.0));
    /// let text = Layer::rect([100.0, 1000.0], scrolled).clipped_by(&window);
    ///
    /// let mut page = Layers::new([[0.0, 0.0], [640.0, 480.0]]);
    /// page.update(&[window, text])?;
    /// assert_eq!(page.hit([30.0, 30.0]), Some((1, [10.0, 310.0])));
    /// assert_eq!(page.hit([30.0, 80.0]), None);
    /// # Ok::<(), binspace::Error>(())
    /// ```
    #[must_use]
    pub fn clipped_by(mut self, ancestor: &Self) -> Self {
        let Self { low, high, .. } = *ancestor;
        let sides = [
            DVec3::new(0.0, 1.0, -low.y),
            DVec3::new(-1.0, 0.0, high.x),
            DVec3::new(0.0, -1.0, high.y),
            DVec3::new(1.0, 0.0, -low.x),
        ];
        let sides = sides.into_iter().chain(ancestor.clips.iter().copied());
        if self.shares_plane(ancestor) {
            self.clips.extend(sides);
            return self;
        }
        let [([x, y, _, w], _), (own, _)] = [ancestor.scaled_rows(), self.scaled_rows()];
        // The inverse of the ancestor's matrix, times its determinant.
        let inverse = [y.cross(w), w.cross(x), x.cross(y)];
        let determinant = x.dot(inverse[0]);
        if determinant == 0.0 {
            self.clips.push(DVec3::NEG_Z);
            return self;
        }
        for side in sides {
            // The side's line on the screen, as coefficients of x, y and w.
            let line = inverse.map(|column| side.dot(column) * determinant.signum());
            self.clips.push(own[0] * line[0] + own[1] * line[1] + own[3] * line[2]);
        }
        self
    }

    /// Half-planes that cut the rectangle: the points whose products with (u, v, 1) are not negative.
    pub(super) fn clips(&self) -> &[DVec3] {
        &self.clips
    }

    /// Returns the point (u, v) of the layer's plane that appears at a point of the screen, for drawing a
    /// layer pixel by pixel. The point (u, v) may be outside the layer's rectangle. Returns `None` if the
    /// plane does not appear at the point of the screen, or is seen edge-on.
    ///
    /// Without perspective, u and v are linear over the screen; otherwise u/w, v/w and 1/w are linear.
    pub fn local(&self, [x, y]: [f64; 2]) -> Option<[f64; 2]> {
        let [of_x, of_y, _, of_w] = self.rows;
        // The products of both factors with (u, v, 1) are 0: the two lines meet in the point.
        let point = (of_x - of_w * x).cross(of_y - of_w * y);
        let local = point.truncate() / point.z;
        let is_seen = of_w.dot(local.extend(1.0)) > 0.0 && local.is_finite();
        is_seen.then_some(local.to_array())
    }

    /// A number that is equal for layers of [one plane](Self::shares_plane), and rarely equal for other
    /// layers.
    pub(super) fn plane_key(&self) -> u64 {
        let numbers = self.rows.iter().flat_map(|row| row.to_array());
        // 0 and −0 are equal.
        let add = |key: u64, number: f64| {
            (key.rotate_left(5) ^ (number + 0.0).to_bits()).wrapping_mul(0x9e37_79b9_7f4a_7c15)
        };
        numbers.fold(0, add)
    }

    /// Whether two layers are in one plane by definition: their matrices are equal.
    pub(super) fn shares_plane(&self, other: &Self) -> bool {
        self.rows == other.rows
    }

    /// The corners (u, v) of the rectangle; edge k leads from corner k to the next.
    pub(super) fn corners(&self) -> [DVec2; 4] {
        let Self { low, high, .. } = *self;
        [low, DVec2::new(high.x, low.y), high, DVec2::new(low.x, high.y)]
    }

    /// (u, v), moved into the rectangle if rounding put it outside.
    pub(super) fn clamp(&self, local: DVec2) -> DVec2 {
        local.clamp(self.low, self.high)
    }

    /// Whether the layer's numbers, and the numbers computed from them, are finite.
    pub(super) fn is_finite(&self) -> bool {
        let numbers = self.low.is_finite() && self.high.is_finite();
        let clips = self.clips.iter().all(|clip| clip.is_finite());
        numbers
            && clips
            && self.rows.iter().all(|row| row.is_finite() && self.size_of(*row).is_finite())
    }

    /// Whether the rectangle has no area.
    pub(super) fn is_empty(&self) -> bool {
        !(self.low.x < self.high.x && self.low.y < self.high.y)
    }

    /// The largest sum of the absolute terms of a row in the rectangle.
    fn size_of(&self, row: DVec3) -> f64 {
        let largest = self.low.abs().max(self.high.abs()).extend(1.0);
        row.abs().dot(largest)
    }

    /// The coefficients of (x, y, z, w), scaled by a power of two so that the largest is about 1 and no
    /// product overflows, and the scale. The scale of homogeneous coordinates does not matter.
    pub(super) fn scaled_rows(&self) -> ([DVec3; 4], f64) {
        let largest = self.rows.iter().fold(0.0, |size: f64, &row| size.max(self.size_of(row)));
        let exponent = largest.log2().floor().clamp(-1000.0, 1000.0);
        let scale = (-exponent).exp2();
        (self.rows.map(|row| row * scale), scale)
    }

    /// Bounds on the terms of a [centred](Self::centred) row.
    pub(super) fn terms(&self, row: DVec3) -> DVec3 {
        let half = self.high * 0.5 - self.low * 0.5;
        (row.truncate().abs() * half).extend(self.size_of(row))
    }

    /// Rows with the middle of the rectangle as origin and its half sides as units.
    pub(super) fn centred(&self, rows: [DVec3; 4]) -> [DVec3; 4] {
        let (middle, half) = (self.low * 0.5 + self.high * 0.5, self.high * 0.5 - self.low * 0.5);
        rows.map(|row| (row.truncate() * half).extend(row.dot(middle.extend(1.0))))
    }

    /// Bounds on the rounding error of x, y, z and w at a point, for rows that are not centred.
    pub(super) fn rounding(&self, rows: [DVec3; 4], local: DVec2) -> DVec4 {
        let largest = local.abs().extend(1.0);
        DVec4::from_array(rows.map(|row| row.abs().dot(largest))) * self.step
    }

    /// The machine epsilon of the matrix's number type.
    pub(super) fn step(&self) -> f64 {
        self.step
    }
}
