//! The traits of input points and polygons.

use glam::{DVec3, Vec3, Vec3A};

/// The largest number of corners of one polygon, about 4 million. Too large: an endless polygon takes more
/// memory before it is rejected. Too small: the caller has to divide long outlines, such as coastlines.
pub const MAX_CORNERS: usize = 1 << 22;

/// A point of an input polygon.
pub trait Point: Copy {
    /// The relative precision of a coordinate: the distance from 1 to the next larger number of the
    /// coordinate's type. Use `f32::EPSILON` for `f64` coordinates that were converted from `f32`.
    const PRECISION: f64;

    /// Returns the point in `f64`.
    fn to_dvec3(self) -> DVec3;
}

macro_rules! impl_point {
    ($($type:ty, $number:ident: $self:ident => $value:expr;)*) => {
        $(impl Point for $type {
            const PRECISION: f64 = $number::EPSILON as f64;

            fn to_dvec3($self) -> DVec3 { $value }
        })*
    };
}

impl_point! {
    [f32; 3], f32: self => Vec3::from_array(self).as_dvec3();
    [f64; 3], f64: self => DVec3::from_array(self);
    Vec3, f32: self => self.as_dvec3();
    Vec3A, f32: self => self.as_dvec3();
    DVec3, f64: self => self;
}

#[cfg(feature = "mint")]
impl_point! {
    mint::Point3<f32>, f32: self => Vec3::from(self).as_dvec3();
    mint::Point3<f64>, f64: self => DVec3::from(self);
}

/// An input polygon: its corners in order. The first corner is not repeated at the end.
///
/// The front of a polygon is the side from which its corners are counter-clockwise. Implement the trait for
/// your own type to build a tree without copying your mesh first:
///
/// ```
/// use binspace::{BspTree, Polygon};
///
/// struct Mesh { positions: Vec<[f32; 3]>, quads: Vec<[usize; 4]> }
/// struct Quad<'a>(&'a Mesh, usize);
///
/// impl Polygon for Quad<'_> {
///     // The type of the points decides the default tolerance: here the default for `f32`.
///     type Point = [f32; 3];
///
///     fn corners(&self) -> impl Iterator<Item = [f32; 3]> {
///         self.0.quads[self.1].into_iter().map(|i| self.0.positions[i])
///     }
/// }
///
/// # let mesh = Mesh { positions: vec![[0.0; 3], [1.0, 0.0, 0.0], [1.0; 3], [0.0, 1.0, 1.0]],
/// #     quads: vec![[0, 1, 2, 3]] };
/// let tree = BspTree::build((0..mesh.quads.len()).map(|i| Quad(&mesh, i)))?;
/// # assert_eq!(tree.len(), 1);
/// # Ok::<(), binspace::Error>(())
/// ```
pub trait Polygon {
    /// A corner.
    type Point: Point;

    /// Returns the corners, in order around the polygon. More than 2²² (4 194 304) corners are an error, so
    /// an endless iterator is an error too.
    fn corners(&self) -> impl Iterator<Item = Self::Point>;

    /// Returns how far rounding may have moved a corner off the polygon's intended plane, a length. The
    /// default tolerance depends on this length: see [`Tolerance::Default`](crate::Tolerance::Default).
    ///
    /// By default the result is 4 · [`Point::PRECISION`] · the polygon's largest coordinate. That is about
    /// the rounding error of a point that was multiplied by a matrix.
    fn precision(&self) -> f64 {
        // Not `f64::max`, which takes more instructions because of NaN.
        let larger = |most: f64, c: f64| if c > most { c } else { most };
        let [x, y, z] = self.corners().fold([0.0; 3], |[x, y, z], point| {
            let point = point.to_dvec3().abs();
            [larger(x, point.x), larger(y, point.y), larger(z, point.z)]
        });
        STEPS * Self::Point::PRECISION * larger(larger(x, y), z)
    }
}

/// The largest distance of a computed point from its intended plane, in steps of the polygon's largest
/// coordinate. Too small: cards that a matrix put into one plane cut each other. Too large: thin layers are
/// merged.
pub(crate) const STEPS: f64 = 4.0;

impl<P: Point> Polygon for [P] {
    type Point = P;

    fn corners(&self) -> impl Iterator<Item = P> {
        self.iter().copied()
    }
}

impl<P: Point, const N: usize> Polygon for [P; N] {
    type Point = P;

    fn corners(&self) -> impl Iterator<Item = P> {
        self.iter().copied()
    }
}

impl<P: Point> Polygon for Vec<P> {
    type Point = P;

    fn corners(&self) -> impl Iterator<Item = P> {
        self.iter().copied()
    }
}

impl<T: Polygon + ?Sized> Polygon for &T {
    type Point = T::Point;

    fn corners(&self) -> impl Iterator<Item = T::Point> {
        (**self).corners()
    }

    fn precision(&self) -> f64 {
        (**self).precision()
    }
}
