//! One integer ray for each pixel.

use std::ops::Range;

use glam::DVec3;

use crate::Error;
use crate::exact::{Eye, Faces, Lattice};
use crate::view::{Camera, Projection, refused};
use crate::viewpoint::Viewpoint;

/// The rays of a camera through a scene, in integer coordinates on a scene's [grid](crate::Grid).
///
/// In this table, x and y are the column and the row of a pixel. The vectors base, right and down depend on
/// the camera, and have integer components:
///
/// | camera | the ray through the centre of pixel (x, y) |
/// |---|---|
/// | perspective | from the eye, in direction base + x·right + y·down |
/// | parallel | through the point base + x·right + y·down, in the same direction for all pixels |
///
/// The rays *define* the picture: the camera is rounded once, and every later decision is exact. Rounding
/// moves a ray by less than a thousandth of a pixel, unless the camera is more than a million
/// [extents](crate::BspTree#exactness) of the scene away. Views too narrow for this precision are an error.
/// The eye and the direction are rounded as for orders; see [`Viewpoint`](crate::Viewpoint).
///
/// Rays belong to the [grid](crate::BspTree::grid) of the faces that they were made for. Trees of one grid,
/// such as the trees of the cells of a [partition](crate::partition), may share rays. A function that takes
/// rays and faces of different grids panics.
#[derive(Clone, Debug)]
pub struct Rays {
    lattice: Lattice,
    pub(super) size: [u32; 2],
    /// Both coordinates of the centre of the first pixel: 0, or ½ in drawings.
    first: f64,
    /// The height of the whole picture. These rays may be only some rows of that picture; `above` is the
    /// number of rows above the first of these rays.
    whole_height: u32,
    above: u32,
    /// Whether faces seen from behind are left out.
    pub(super) front_only: bool,
    viewpoint: Viewpoint,
    pub(crate) pencil: RayOrigin,
    pub(crate) base: [i64; 3],
    pub(crate) right: [i64; 3],
    pub(crate) down: [i64; 3],
    /// The parameter of the ray through the middle of the picture.
    middle: [i64; 3],
    /// Maps a point relative to the eye, or to the middle of the picture, to multiples of right, down, and
    /// the direction through the middle.
    to_picture: [DVec3; 3],
    /// The relative error of this map.
    rounding: f64,
    /// The world length of one unit of the third multiple.
    pub(super) depth_unit: f64,
}

/// The start or the direction of all rays.
#[derive(Clone, Copy, Debug)]
pub(crate) enum RayOrigin {
    /// All rays start at the eye: an integer times 2^shift.
    From { eye: [i64; 3], shift: u32 },
    /// All rays have this direction.
    Along { direction: [i64; 3] },
}

/// Per-pixel ray parameter: a direction (perspective) or a point (parallel).
#[derive(Clone, Copy, Debug)]
pub(super) enum Given {
    Point([i64; 3]),
    Step([i64; 3]),
}

/// The magnitude of directions.
///
/// With 52-bit coordinates, a normal has 105 bits, the value of a plane at the eye 189, the product of a
/// normal and a direction 168, and the product of these two numbers 358: every decision fits
/// [`Digits`](super::exact::Digits). Too large: in a wide view, directions leave the [`REGION`], because the
/// components of a direction, and the components of `right` and `down` times the picture's sides, add up to
/// three times this magnitude. Too small: narrow views are rejected.
const DIRECTION: f64 = (1u64 << 58) as f64;
/// The largest shift of a perspective eye: the eye's integers, of 61 bits, are multiplied by 2 to the shift.
/// Too large: the products above do not fit. Too small: distant eyes are rejected.
const FURTHEST: u32 = 20;
/// The magnitude of points on parallel rays, and of directions, is below this.
const REGION: f64 = (1u64 << 60) as f64;
/// The least size of a pixel, divided by the sum of the picture's width and height in rays. Components of
/// `right` and `down` are rounded by at most 1, and a ray is at most half the width and half the height away
/// from the middle. So a ray is off by at most √3/2 times the sum of width and height. An error e of a
/// direction d moves the ray, in pixels, by at most |e| · |d| / (h · σ): h is the distance of the picture's
/// plane from the eye, and σ the smallest singular value of the matrix with the columns `right` and `down`.
/// With the angle φ between `right` and `down`, σ² ≥ min(|right|, |down|)² · (1 − |cos φ|). (For square
/// pixels, equality holds.) Here σ is the pixel's size. Too small: rays are off by more than a thousandth of
/// a pixel. Too large: usable narrow views are rejected.
const FINEST: f64 = 1000.0;

impl Rays {
    /// Creates the rays of a camera through a scene.
    ///
    /// # Errors
    ///
    /// One of these:
    ///
    /// - a perspective camera is further from the scene than about 2³⁰ extents of the scene;
    /// - the picture of a parallel camera reaches 2⁹ extents away from the scene;
    /// - the view is so narrow that rays could be off by a thousandth of a pixel.
    ///
    /// Let n be the sum of the picture's width and height in pixels. In a perspective view, pixels of n ·
    /// 2⁻⁴⁶ radians are large enough. In a parallel view, pixels of n · 2⁻⁴⁰ of the scene's extent are large
    /// enough. For a picture of 1 000 by 1 000 pixels, that is a field of view of 3·10⁻⁸ radians, or a width
    /// of 2·10⁻⁶ of the extent. The size of a pixel is its shorter side. If the camera skews pixels, this
    /// size is multiplied by √(1 − |cos φ|), where φ is the angle between a pixel's sides.
    pub fn new(camera: &Camera, faces: &Faces) -> Result<Self, Error> {
        Self::sampled(camera, faces, 1)
    }

    /// Creates the rays of a camera through a scene with `samples` × `samples` rays in each pixel, evenly
    /// spread. The rays make a picture that is `samples` times as wide and as high as the camera's picture.
    /// Such a picture may be larger than the largest picture of a camera; use [`rows`](Self::rows) to draw
    /// the picture in parts.
    ///
    /// # Errors
    ///
    /// As for [`new`](Self::new), with pixels that are `samples` times smaller. Also if `samples` is 0, or if
    /// the picture's width or height does not fit `u32`.
    pub fn sampled(camera: &Camera, faces: &Faces, samples: u32) -> Result<Self, Error> {
        let sides = camera.size().map(|side| side.checked_mul(samples).filter(|&side| side > 0));
        let [Some(width), Some(height)] = sides else {
            return refused(format!(
                "a pixel has {samples} samples in each direction: expected 1 or more, and fewer than 2³² \
                 across the picture"
            ));
        };
        let size = [width, height];
        let lattice = *faces.lattice();
        let eye = Eye::new(camera.viewpoint(), &lattice);
        let pixel = camera.pixel_size().map(|side| side / f64::from(samples));
        match (camera.projection(), eye.shift()) {
            (Projection::Perspective { .. }, Some(shift)) if shift <= FURTHEST => {
                let reach = reach(camera);
                // A power of two, so that simple views of simple scenes have simple rays.
                let scale = (DIRECTION / reach).log2().floor().exp2();
                let pencil = RayOrigin::From { eye: eye.integer(), shift };
                let depth_unit = lattice.length_to_world(scale);
                let (middle, steps) = (camera.middle() * scale, pixel.map(|side| side * scale));
                let finest = finest(size, samples) * reach;
                Self::build(camera, lattice, size, pencil, middle, steps, finest, depth_unit)
            }
            (Projection::Parallel { centre, .. }, None) => {
                let direction = eye.integer().map(|c| -c);
                let centre = DVec3::from_array(lattice.to_lattice(*centre));
                // The middle of the picture, in the plane through the middle of the scene.
                let middle = centre - camera.forward() * centre.dot(camera.forward());
                let steps = pixel.map(|side| lattice.length_to_lattice(side));
                let depth_unit = lattice.length_to_world(float(direction).length());
                let pencil = RayOrigin::Along { direction };
                let finest = finest(size, samples);
                Self::build(camera, lattice, size, pencil, middle, steps, finest, depth_unit)
            }
            _ => refused("the eye is too far from the scene: use a parallel camera"),
        }
    }

    /// Rays with pixels of the width and height `steps`. Fails if the size of a pixel is less than `finest`.
    /// `middle` is the parameter of the middle ray.
    #[allow(clippy::too_many_arguments, reason = "both kinds of camera differ in all of them")]
    fn build(
        camera: &Camera,
        lattice: Lattice,
        size: [u32; 2],
        pencil: RayOrigin,
        middle: DVec3,
        steps: [f64; 2],
        finest: f64,
        depth_unit: f64,
    ) -> Result<Self, Error> {
        let [width, height] = size.map(f64::from);
        let (right, down) = (camera.right() * steps[0], camera.up() * -steps[1]);
        let reach = middle.abs() + right.abs() * width + down.abs() * height;
        let fits = reach.max_element() < REGION;
        if !fits {
            let problem =
                "the picture of the parallel camera, or its centre, is too far from the scene";
            return refused(problem);
        }
        let cosine = camera.right().dot(camera.up());
        if steps[0].min(steps[1]) * (1.0 - cosine.abs()).sqrt() < finest {
            let problem = "the camera's view is so narrow that rays would be off by a thousandth of a pixel: \
                           widen it";
            return refused(problem);
        }
        let integer = |v: DVec3| v.to_array().map(|c| c.round() as i64);
        // Even steps, so that half a step is an integer and the middle of the picture is exact for every
        // picture size.
        let even = |v: DVec3| integer(v * 0.5).map(|c| 2 * c);
        let (right, down, middle) = (even(right), even(down), integer(middle));
        let [columns, rows] = size.map(|c| i64::from(c) - 1);
        let base =
            std::array::from_fn(|i| middle[i] - (right[i] / 2) * columns - (down[i] / 2) * rows);
        let third = match pencil {
            RayOrigin::From { .. } => middle,
            RayOrigin::Along { direction } => direction,
        };
        let columns = [right, down, third].map(float);
        let (to_picture, rounding) = (inverse(columns), rounding(columns));
        Ok(Self {
            lattice,
            size,
            first: 0.0,
            whole_height: size[1],
            above: 0,
            front_only: false,
            viewpoint: camera.viewpoint(),
            pencil,
            base,
            right,
            down,
            middle,
            to_picture,
            rounding,
            depth_unit,
        })
    }

    /// Whether the rays were made for the grid of the given faces.
    pub(crate) fn are_for(&self, faces: &Faces) -> bool {
        self.lattice == *faces.lattice()
    }

    /// Panics unless the rays were made for the grid of the given faces.
    pub(crate) fn expect(&self, faces: &Faces) {
        assert!(
            self.are_for(faces),
            "the rays were made for a scene with another grid: make them for these faces by Rays::new"
        );
    }

    /// Restricts the rays to some rows of the picture: row 0 of the result is the first of these rows. So a
    /// large picture can be drawn in parts, each with little memory.
    ///
    /// Rows beyond the picture are left out.
    #[must_use]
    pub fn rows(&self, rows: Range<u32>) -> Self {
        let end = rows.end.min(self.size[1]);
        let start = rows.start.min(end);
        let base = std::array::from_fn(|i| self.base[i] + i64::from(start) * self.down[i]);
        let size = [self.size[0], end - start];
        Self { size, base, above: self.above + start, ..self.clone() }
    }

    /// Makes the rays ignore faces that they meet from behind, so that pictures show only the fronts of
    /// faces. A face's corners are counter-clockwise seen from its front.
    pub fn with_front_faces_only(self) -> Self {
        Self { front_only: true, ..self }
    }

    /// The same rays, with picture coordinates from the corner of the first pixel instead of the pixel's
    /// centre. The conversion is exact, because `right` and `down` are even.
    #[cfg(feature = "drawing")]
    pub(crate) fn with_corner_origin(self) -> Self {
        let base = std::array::from_fn(|i| self.base[i] - self.right[i] / 2 - self.down[i] / 2);
        Self { base, first: 0.5, ..self }
    }

    /// Returns whether the rays meet only the fronts of faces.
    pub fn is_front_only(&self) -> bool {
        self.front_only
    }

    /// Returns the picture's width and height in pixels.
    pub fn size(&self) -> [u32; 2] {
        self.size
    }

    /// Returns the camera's viewpoint, for ordering [fragments](crate::BspTree#contents).
    pub fn viewpoint(&self) -> Viewpoint {
        self.viewpoint
    }

    /// Returns the start and the direction of a pixel's ray, in steps of the [grid](crate::Grid). Use them to
    /// compute a picture with other arithmetic. The ray of a parallel camera is a whole line: it also extends
    /// behind its start.
    #[doc(hidden)]
    pub fn ray(&self, x: u32, y: u32) -> [[i128; 3]; 2] {
        let wide = |v: [i64; 3]| v.map(i128::from);
        match (self.pencil, self.pixel(x, y)) {
            (RayOrigin::From { eye, shift }, Given::Point(v) | Given::Step(v)) => {
                [wide(eye).map(|c| c << shift), wide(v)]
            }
            (RayOrigin::Along { direction }, Given::Point(v) | Given::Step(v)) => {
                [wide(v), wide(direction)]
            }
        }
    }

    /// Whether the rays start at an eye.
    pub(crate) fn is_perspective(&self) -> bool {
        matches!(self.pencil, RayOrigin::From { .. })
    }

    /// The ray of a pixel.
    pub(super) fn pixel(&self, x: u32, y: u32) -> Given {
        let v = std::array::from_fn(|i| {
            self.base[i] + i64::from(x) * self.right[i] + i64::from(y) * self.down[i]
        });
        match self.pencil {
            RayOrigin::From { .. } => Given::Step(v),
            RayOrigin::Along { .. } => Given::Point(v),
        }
    }

    /// The unit vector along the ray of a pixel, rounded.
    pub(super) fn direction(&self, x: u32, y: u32) -> DVec3 {
        match (self.pencil, self.pixel(x, y)) {
            (RayOrigin::Along { direction }, _) => float(direction).normalize(),
            (_, Given::Step(v) | Given::Point(v)) => float(v).normalize(),
        }
    }

    /// A point of the ray through a place in the picture, relative to a lattice point, and the ray's direction,
    /// rounded.
    #[cfg(feature = "drawing")]
    pub(crate) fn through(&self, [x, y]: [f64; 2], point: [f64; 3]) -> [DVec3; 2] {
        let [base, right, down] = [self.base, self.right, self.down].map(float);
        let step = right * x + down * y;
        let from = DVec3::from_array(self.origin_from(point));
        match self.pencil {
            RayOrigin::From { .. } => [from, base + step],
            RayOrigin::Along { direction } => [from + step, float(direction)],
        }
    }

    /// The eye, or for parallel rays the point of the first pixel's ray, relative to a lattice point. Each
    /// component is within 2.4 roundings.
    ///
    /// (An integer beyond 2⁵³ is rounded, and so is the difference of this integer and a coordinate of at
    /// most 2⁵¹.)
    #[inline]
    pub(crate) fn origin_from(&self, point: [f64; 3]) -> [f64; 3] {
        match self.pencil {
            RayOrigin::From { eye, shift: 0 } => std::array::from_fn(|i| eye[i] as f64 - point[i]),
            RayOrigin::From { eye, shift } => {
                let unit = (1u64 << shift) as f64;
                std::array::from_fn(|i| eye[i] as f64 * unit - point[i])
            }
            RayOrigin::Along { .. } => std::array::from_fn(|i| self.base[i] as f64 - point[i]),
        }
    }
}

/// Columns and rows of pixels.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Window {
    pub(crate) columns: Range<u32>,
    pub(crate) rows: Range<u32>,
}

/// The largest error of a vertex's coordinate, in lattice units: 2, and a margin for the rounding of
/// coordinates beyond 2⁵³.
const VERTEX_ERROR: f64 = 2.5;
/// Margin around a polygon's projection, in pixels, for the rounding of the projection.
const MARGIN: f64 = 1.0 / 256.0;

/// The place of a point in the picture, with bounds on its error.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Projected {
    /// A box around the point, if the point is ahead of the eye.
    around: [[f64; 2]; 2],
    /// For the left, right, upper and lower side of the picture, whether the point is certainly beyond it.
    is_beyond: [bool; 4],
    is_ahead: bool,
    is_behind: bool,
}

impl Projected {
    /// A box in the picture that contains the convex hull of points: the box's least and largest coordinates,
    /// in pixels, where the first pixel's centre is at `first`. `None` if the hull is outside the picture.
    /// The box is infinite if the hull reaches behind the eye.
    pub(crate) fn region(points: impl IntoIterator<Item = Self>) -> Option<[[f64; 2]; 2]> {
        let [mut low, mut high] = [[f64::INFINITY; 2], [f64::NEG_INFINITY; 2]];
        let (mut is_beyond, mut is_ahead, mut is_behind) = ([true; 4], true, true);
        for point in points {
            for axis in 0..2 {
                low[axis] = low[axis].min(point.around[0][axis]);
                high[axis] = high[axis].max(point.around[1][axis]);
            }
            for (all, is_beyond) in is_beyond.iter_mut().zip(point.is_beyond) {
                *all &= is_beyond;
            }
            is_ahead &= point.is_ahead;
            is_behind &= point.is_behind;
        }
        if is_behind || is_beyond.contains(&true) {
            return None;
        }
        Some(if is_ahead { [low, high] } else { [[f64::NEG_INFINITY; 2], [f64::INFINITY; 2]] })
    }
}

impl Rays {
    /// All pixels whose rays may meet the convex hull of these points, each given to within `VERTEX_ERROR`;
    /// `None` if there are no such pixels.
    ///
    /// A polygon that reaches behind the eye may be anywhere in the picture, unless it lies entirely beyond
    /// one of the picture's sides.
    pub(crate) fn window(&self, points: &[[f64; 3]]) -> Option<Window> {
        let points = points.iter().map(|&point| self.projected(point));
        let [[left, top], [right, bottom]] = Projected::region(points)?;
        let range = |axis: usize, low: f64, high: f64| {
            let first = low.ceil().max(0.0) as u32;
            let last = high.floor().min(f64::from(self.size[axis]) - 1.0);
            if last < 0.0 { 0..0 } else { first..last as u32 + 1 }
        };
        let window = Window { columns: range(0, left, right), rows: range(1, top, bottom) };
        if window.columns.is_empty() || window.rows.is_empty() { None } else { Some(window) }
    }

    /// The place in the picture of a point given to within `VERTEX_ERROR`.
    pub(crate) fn projected(&self, point: [f64; 3]) -> Projected {
        let [width, height] = self.size.map(f64::from);
        // The picture's sides, in pixels from the middle of the whole picture.
        let top = f64::from(self.above) - 0.5 * f64::from(self.whole_height);
        let sides = [[-0.5 * width, 0.5 * width], [top, top + height]];
        let (at, error) = self.in_picture(point);
        let (z, slack) = (at.z, error.z);
        let (mut around, mut is_beyond) = ([[0.0; 2]; 2], [false; 4]);
        for (axis, [first, last]) in sides.into_iter().enumerate() {
            let (p, e) = (at[axis], error[axis] + (first.abs().max(last.abs()) + 1.0) * slack);
            is_beyond[2 * axis] = p - (first - 1.0) * z < -e;
            is_beyond[2 * axis + 1] = (last + 1.0) * z - p < -e;
            // From the middle of the whole picture to the origin of coordinates.
            let position = p / z;
            let pad = (error[axis] + position.abs() * slack) / (z - slack) + MARGIN;
            let shift = self.first - 0.5 - first;
            (around[0][axis], around[1][axis]) = (position - pad + shift, position + pad + shift);
        }
        Projected { around, is_beyond, is_ahead: z > 4.0 * slack, is_behind: z < -slack }
    }

    /// A lattice point in homogeneous coordinates of the picture, rounded, with a bound on the error of each
    /// coordinate: x and y in pixels, as in [`Projected::region`], times the last coordinate, which is
    /// positive ahead of the eye.
    #[cfg(feature = "drawing")]
    pub(crate) fn project(&self, point: [f64; 3]) -> ([f64; 3], [f64; 3]) {
        let (at, error) = self.in_picture(point);
        let ([x, y, z], [ex, ey, ez]) = (at.to_array(), error.to_array());
        let top = f64::from(self.above) - 0.5 * f64::from(self.whole_height);
        let shift = [0.5 * f64::from(self.size[0]), -top].map(|from| from + self.first - 0.5);
        // Each product and each sum is rounded once.
        let off = |part: f64, error: f64, shift: f64| {
            error + shift.abs() * ez + 4.0 * f64::EPSILON * (part.abs() + (shift * z).abs())
        };
        let errors = [off(x, ex, shift[0]), off(y, ey, shift[1]), ez];
        ([x + shift[0] * z, y + shift[1] * z, z], errors)
    }

    /// A point, given to within `VERTEX_ERROR`, in multiples of right, down and the direction through the
    /// middle (the last multiple is 1 for parallel rays), with a bound on the error of each multiple.
    #[inline]
    fn in_picture(&self, point: [f64; 3]) -> (DVec3, DVec3) {
        let (arm, parallel) = match self.pencil {
            RayOrigin::From { .. } => (-DVec3::from_array(self.origin_from(point)), false),
            RayOrigin::Along { .. } => (DVec3::from_array(point) - float(self.middle), true),
        };
        let slack = VERTEX_ERROR + arm.abs().max_element() * self.rounding;
        let [a, b, c] = self.to_picture;
        let norm = |row: DVec3| row.abs().element_sum() * slack;
        let mut at = DVec3::new(a.dot(arm), b.dot(arm), c.dot(arm));
        let mut error = DVec3::new(norm(a), norm(b), norm(c));
        if parallel {
            at.z = 1.0;
            error.z = 0.0;
        }
        (at, error)
    }
}

/// The length of the longest line of sight in a perspective camera's picture, at distance 1; or, if larger,
/// the length that keeps rays in the [`REGION`]. (The second length is larger only if the camera is off-axis
/// or its pixels are skewed: see [`DIRECTION`].)
fn reach(camera: &Camera) -> f64 {
    let (middle, [x, y]) = (camera.middle(), camera.half_size());
    let (across, rise) = (camera.right() * x, camera.up() * y);
    let corners = [across + rise, across - rise];
    let lengths = corners.map(|to| (middle + to).length().max((middle - to).length()));
    let terms = middle.abs() + 2.0 * (across.abs() + rise.abs());
    lengths[0].max(lengths[1]).max(terms.max_element() / 3.5)
}

/// The least size of pixels, with `samples` samples per pixel in each direction.
fn finest(size: [u32; 2], samples: u32) -> f64 {
    let [width, height] = size.map(f64::from);
    FINEST * (width + height + 1.0) / f64::from(samples)
}

pub(super) fn float(v: [i64; 3]) -> DVec3 {
    DVec3::from_array(v.map(|c| c as f64))
}

/// The rows of the inverse of the matrix with these columns.
fn inverse([a, b, c]: [DVec3; 3]) -> [DVec3; 3] {
    let rows = [b.cross(c), c.cross(a), a.cross(b)];
    rows.map(|row| row / a.dot(rows[0]))
}

/// A bound on the relative error of a product of [`inverse`]'s matrix and a rounded vector, in the norms of
/// [`Rays::in_picture`].
///
/// Let ε = 2⁻⁵³, and V the volume that the columns span as unit vectors. Each component of the columns is
/// rounded by ε, of their vector products by 4 ε of the product of two lengths, and the determinant by 8 ε of
/// the product of three lengths. A row is at least V times the product of two lengths, so the row is off by
/// less than 24 ε / V of its length. The vector is off by 2.4 ε, so the product of row and vector is off by
/// less than (24 / V + 6) ε of the product of both lengths. As a multiple of the sum of the row's components
/// and the largest component of the vector, the error is √3 times as much. The error is less than 2⁻⁴⁶ if V ≥
/// 1/2, and less than 2⁻⁴⁷ / V otherwise.
fn rounding(columns: [DVec3; 3]) -> f64 {
    let [a, b, c] = columns.map(DVec3::normalize);
    let volume = a.dot(b.cross(c)).abs();
    2f64.powi(-46) * (0.5 / volume).max(1.0)
}
