//! Vectors and planes of exact numbers: big integers, rationals, and integers of 128 bits if these are
//! large enough.

use dashu_int::IBig;
use dashu_ratio::RBig;
use num_traits::{Signed, Zero};
use std::cmp::Ordering;

/// A point or a vector.
pub type Vector<T> = [T; 3];

/// The components of exact vectors.
pub trait Number: Sized {
    fn plus(&self, other: &Self) -> Self;
    fn minus(&self, other: &Self) -> Self;
    fn times(&self, other: &Self) -> Self;
    fn sign(&self) -> Ordering;
    fn size(&self) -> Self;
}

macro_rules! number {
    ($number:ty) => {
        impl Number for $number {
            fn plus(&self, other: &Self) -> Self {
                self + other
            }

            fn minus(&self, other: &Self) -> Self {
                self - other
            }

            fn times(&self, other: &Self) -> Self {
                self * other
            }

            fn sign(&self) -> Ordering {
                self.cmp(&Self::zero())
            }

            fn size(&self) -> Self {
                self.abs()
            }
        }
    };
}

number!(i128);
number!(IBig);
number!(RBig);

pub fn sum<T: Number>(a: &Vector<T>, b: &Vector<T>) -> Vector<T> {
    std::array::from_fn(|i| a[i].plus(&b[i]))
}

pub fn difference<T: Number>(a: &Vector<T>, b: &Vector<T>) -> Vector<T> {
    std::array::from_fn(|i| a[i].minus(&b[i]))
}

/// Returns the scalar product.
pub fn scalar<T: Number>(a: &Vector<T>, b: &Vector<T>) -> T {
    a[0].times(&b[0]).plus(&a[1].times(&b[1])).plus(&a[2].times(&b[2]))
}

/// Returns the vector product.
pub fn product<T: Number>(a: &Vector<T>, b: &Vector<T>) -> Vector<T> {
    std::array::from_fn(|i| {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        a[j].times(&b[k]).minus(&a[k].times(&b[j]))
    })
}

/// Returns the sign of a number.
pub fn sign<T: Number>(value: &T) -> Ordering {
    value.sign()
}

pub fn is_zero<T: Number>(vector: &Vector<T>) -> bool {
    vector.iter().all(|c| c.sign().is_eq())
}

/// Returns the first of the axes along which a vector is longest.
pub fn main_axis<T: Number + Ord>(vector: &Vector<T>) -> usize {
    let size = |axis: usize| vector[axis].size();
    (1..3).fold(0, |best, axis| if size(axis) > size(best) { axis } else { best })
}

/// A plane. Its value at a point is positive in front.
#[derive(Clone, Debug)]
pub struct Plane<T> {
    pub normal: Vector<T>,
    pub offset: T,
}

impl<T: Number> Plane<T> {
    /// Creates the plane through a point, perpendicular to a normal.
    pub fn new(normal: Vector<T>, point: &Vector<T>) -> Self {
        let offset = scalar(&normal, point);
        Self { normal, offset }
    }

    /// Creates the plane in front of which the three points run counter-clockwise.
    pub fn through([p, q, r]: [&Vector<T>; 3]) -> Self {
        Self::new(product(&difference(q, p), &difference(r, p)), p)
    }

    /// Returns the distance of a point, times the length of the normal.
    pub fn at(&self, x: &Vector<T>) -> T {
        scalar(&self.normal, x).minus(&self.offset)
    }
}
