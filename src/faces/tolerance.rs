//! Chooses the coplanar tolerance of a scene: the user's, or a default from the extent and the precision of
//! the input.

use glam::DVec3;

use crate::error::{Error, Kind};
use crate::exact::lattice::MAX_TOLERANCE;
use crate::exact::{Faces, LATTICE_LIMIT, Lattice};
use crate::input::STEPS;

/// The least default tolerance as a share of the scene's extent, the longest side of its bounding
/// box; see [`Tolerance::Default`].
///
/// Too large: thin layers that are meant to be apart count as coplanar. Too small: faces that are coplanar
/// except for the rounding of a computation in `f64` cut each other into slivers.
pub const DEFAULT_TOLERANCE: f64 = 1e-9;

/// The largest default tolerance as a share of the extent, except for the rounding of a number type (see
/// [`Precision`]). Too large: layers of coarsely written coordinates are merged although they differ. Too
/// small: polygons bent by coarse rounding are triangulated.
const LARGEST_ROUNDING: f64 = 1e-5;

/// The coplanar tolerance, a distance: a polygon counts as lying on a plane if no corner is further from the
/// plane than the tolerance.
///
/// With 0, only exactly coplanar polygons count as coplanar. A negative tolerance or NaN is an error. The
/// largest tolerance is between 1/256 and 1/128 of the extent, depending on the scene; larger tolerances,
/// infinity included, are reduced to this largest tolerance. [`BspTree`](crate::BspTree#which-tolerance)
/// helps to choose a tolerance.
///
/// The extent is the longest side of the bounding box of all corners. One stray vertex makes the extent
/// larger. If stray vertices can occur, set a length.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub enum Tolerance {
    /// The largest [`precision`](crate::Polygon::precision) of the polygons, clamped to between 10⁻⁹ and 10⁻⁵
    /// of the extent. A *step* of a coordinate is the distance to the next larger number of its type.
    ///
    /// | input | default |
    /// |---|---|
    /// | `f64` | 10⁻⁹ of the extent |
    /// | `f32` | four steps of the largest coordinate: between 2·10⁻⁷ and 5·10⁻⁷ of the extent |
    /// | a scene read from an OBJ file | four units in the last decimal that the file's coordinates need (trailing zeros do not count), at most 10⁻⁵ of the extent, wherever the scene lies |
    ///
    /// Far from the origin, `f32` and `f64` have coarser steps. There the default is four steps of the
    /// largest coordinate, even if this length exceeds 10⁻⁵ of the extent. For `f64`, the default exceeds
    /// 10⁻⁹ of the extent if the scene is more than a million extents away from the origin. For example, the
    /// default is 9·10⁻⁷ for a cube of side 1 at 10⁹. (An OBJ file is treated as `f32` if nearly all its
    /// numbers are `f32`, written with more digits than an `f32` has.)
    #[default]
    Default,
    /// A length, in the polygons' unit.
    Length(f64),
    /// A share of the extent.
    Relative(f64),
}

impl From<Option<f64>> for Tolerance {
    /// Converts a length, or `None` for the default.
    fn from(length: Option<f64>) -> Self {
        length.map_or(Self::Default, Self::Length)
    }
}

impl Tolerance {
    pub(super) fn check(self) -> Result<(), Error> {
        match self {
            Self::Length(value) | Self::Relative(value) if value.is_nan() || value < 0.0 => {
                Err(Kind::Tolerance(value).error())
            }
            _ => Ok(()),
        }
    }
}

/// The precision of polygons.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Precision {
    /// The largest distance of a corner from its intended plane, in world units.
    length: f64,
    /// Whether `length` is the rounding of the number type. Numbers of this type cannot express finer
    /// lengths, so the default tolerance has no upper limit. Otherwise the precision is only stated by the
    /// polygons, and the default tolerance has an upper limit.
    is_of_numbers: bool,
}

impl Precision {
    /// The precision of polygons with this largest [`precision`](crate::Polygon::precision), in a box.
    pub(crate) fn new(length: f64, [min, max]: [DVec3; 2]) -> Self {
        let largest = min.abs().max(max.abs()).max_element();
        let [single, double] =
            [f64::from(f32::EPSILON), f64::EPSILON].map(|step| STEPS * step * largest);
        Self { length, is_of_numbers: length == single || length <= double }
    }
}

/// The lattice and the tolerances by which the polygons of a scene are prepared.
#[derive(Clone, Copy, Debug)]
pub(super) struct SnapParams {
    pub(super) lattice: Lattice,
    /// The tolerance, in lattice units.
    pub(super) tolerance: f64,
    /// A convex polygon becomes one face if no corner is further than this length, in lattice units, from the
    /// plane of the other corners.
    pub(super) bend: f64,
}

impl SnapParams {
    /// The parameters of finished faces.
    pub(super) fn of(faces: &Faces) -> Self {
        let Faces { lattice, tolerance, .. } = *faces;
        Self { lattice, tolerance, bend: tolerance }
    }

    /// The parameters for corners inside the box `[min, max]`, given with this precision.
    pub(super) fn new(
        lattice: Lattice,
        [min, max]: [DVec3; 2],
        tolerance: Tolerance,
        precision: Precision,
    ) -> Self {
        let size = DVec3::from(lattice.snap(max)) - DVec3::from(lattice.snap(min));
        let extent = size.max_element();
        let rounding = LARGEST_ROUNDING * extent;
        let length = lattice.length_to_lattice(precision.length);
        let tolerance = match tolerance {
            Tolerance::Default => {
                let most = if precision.is_of_numbers { f64::INFINITY } else { rounding };
                length.min(most).max(DEFAULT_TOLERANCE * extent)
            }
            Tolerance::Length(length) => lattice.length_to_lattice(length),
            Tolerance::Relative(share) => share * extent,
        };
        let tolerance = tolerance.min(MAX_TOLERANCE);
        Self { lattice, tolerance, bend: tolerance }
    }

    /// The largest distance from the plane of other corners that a corner has in a planar polygon: the
    /// tolerance, or the rounding of the polygon's coordinates. `size` is the size of the polygon, in lattice
    /// units.
    pub(super) fn planar(&self, precision: f64, size: f64) -> f64 {
        /// Rounding does not exceed this share of the polygon's size. Too large: bodies of small bent
        /// polygons in coarsely written files are not closed. Too small: polygons that are meant to cross
        /// themselves are not counted as such if their coordinates are coarse.
        const ROUNDED_SHARE: f64 = 1.0 / 64.0;
        let rounding = self.lattice.length_to_lattice(precision).min(ROUNDED_SHARE * size);
        self.bend.max(rounding.min(LARGEST_ROUNDING * 2.0 * LATTICE_LIMIT))
    }

    /// Whether rounding can be the reason that a corner is off the plane of the other corners, by `off`
    /// lattice units. The result depends on neither the other polygons nor the extent, so the result is the
    /// same in every part of a scene.
    pub(super) fn may_be_rounding(&self, off: f64, precision: f64) -> bool {
        let coarse = self.lattice.length_to_lattice(precision).min(MAX_TOLERANCE);
        off > 0.0 && off <= coarse.max(LARGEST_ROUNDING * 2.0 * LATTICE_LIMIT)
    }
}

/// An empty set of faces, with the grid and the tolerance of a scene whose polygons fill a box.
///
/// # Errors
///
/// If a corner of the box is infinite or NaN, or the tolerance negative or NaN.
pub(crate) fn empty_faces(
    bounds: [DVec3; 2],
    tolerance: Tolerance,
    precision: Precision,
) -> Result<Faces, Error> {
    tolerance.check()?;
    if bounds.iter().any(|corner| !corner.is_finite()) {
        return Err(Kind::Bounds.error());
    }
    let lattice = Lattice::new(bounds[0], bounds[1]);
    let SnapParams { tolerance, .. } = SnapParams::new(lattice, bounds, tolerance, precision);
    Ok(Faces { lattice, tolerance, ..Faces::default() })
}
