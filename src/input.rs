//! The traits of input points and polygons.

use glam::{DVec3, Vec3, Vec3A};

/// A point of an input polygon.
pub trait Point: Copy {
    /// The point in `f64`.
    fn to_dvec3(self) -> DVec3;
}

macro_rules! impl_point {
    ($($type:ty: $self:ident => $value:expr;)*) => {
        $(impl Point for $type {
            fn to_dvec3($self) -> DVec3 { $value }
        })*
    };
}

impl_point! {
    [f32; 3]: self => Vec3::from_array(self).as_dvec3();
    [f64; 3]: self => DVec3::from_array(self);
    Vec3: self => self.as_dvec3();
    Vec3A: self => self.as_dvec3();
    DVec3: self => self;
}

/// An input polygon: its corners in order around it. The first corner is not repeated at the end.
///
/// The front of a polygon is the side from which its corners run counter-clockwise. Implement the
/// trait for a type of your own to build a tree without copying your mesh first:
///
/// ```
/// use binspace::{BspTree, Polygon, glam::DVec3};
///
/// struct Mesh { positions: Vec<DVec3>, quads: Vec<[usize; 4]> }
/// struct Quad<'a>(&'a Mesh, usize);
///
/// impl Polygon for Quad<'_> {
///     fn corners(&self) -> impl Iterator<Item = DVec3> {
///         self.0.quads[self.1].iter().map(|&i| self.0.positions[i])
///     }
/// }
///
/// # let mesh = Mesh { positions: vec![DVec3::ZERO, DVec3::X, DVec3::ONE, DVec3::Y + DVec3::Z],
/// #     quads: vec![[0, 1, 2, 3]] };
/// let tree = BspTree::build((0..mesh.quads.len()).map(|i| Quad(&mesh, i)))?;
/// # assert_eq!(tree.len(), 1);
/// # Ok::<(), binspace::Error>(())
/// ```
pub trait Polygon {
    /// The corners, in order around the polygon. More than [`MAX_CORNERS`](crate::MAX_CORNERS) are an
    /// error, so an endless iterator is one as well.
    fn corners(&self) -> impl Iterator<Item = DVec3>;
}

impl<P: Point> Polygon for [P] {
    fn corners(&self) -> impl Iterator<Item = DVec3> {
        self.iter().map(|point| point.to_dvec3())
    }
}

impl<P: Point, const N: usize> Polygon for [P; N] {
    fn corners(&self) -> impl Iterator<Item = DVec3> {
        self.as_slice().corners()
    }
}

impl<P: Point> Polygon for Vec<P> {
    fn corners(&self) -> impl Iterator<Item = DVec3> {
        self.as_slice().corners()
    }
}

impl<T: Polygon + ?Sized> Polygon for &T {
    fn corners(&self) -> impl Iterator<Item = DVec3> {
        (**self).corners()
    }
}
