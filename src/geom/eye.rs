//! Where the viewer is.

use glam::DVec3;

use super::Lattice;

/// Where a picture is seen from: a point, or, for a parallel projection, a direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Viewpoint {
    /// An eye point.
    Eye(DVec3),
    /// The direction in which the viewer looks, of any length but zero, from infinitely far away.
    Direction(DVec3),
}

impl Viewpoint {
    /// An eye point.
    pub fn eye(point: impl Into<DVec3>) -> Self {
        Self::Eye(point.into())
    }

    /// The direction in which the viewer looks, from infinitely far away.
    pub fn direction(direction: impl Into<DVec3>) -> Self {
        Self::Direction(direction.into())
    }
}

/// A viewpoint in lattice units, rounded once: (integer · 2^shift), or, without a shift, the
/// direction in which the eye is infinitely far away.
///
/// Within about 500 extents of the scene the rounding is that of the lattice itself, 2⁻⁵² of the
/// extent; beyond, one part in 2⁶¹ of the distance. Directions are rounded to one part in 2⁵² of
/// their largest component, and so are eyes beyond 2³⁶⁰ lattice units, of which the direction alone
/// counts. A direction along a plane is on the side of the lattice's origin. A coordinate that is
/// not a number counts as 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Eye {
    integer: [i64; 3],
    shift: Option<u32>,
    float: [f64; 3],
}

/// Eyes are integers up to this.
const NEAR: f64 = (1u64 << 61) as f64;
/// Beyond 2^FAR lattice units an eye's distance decides before the planes' offsets do.
const FAR: u32 = 360;

impl Eye {
    /// A viewpoint on a scene's lattice.
    pub fn new(viewpoint: Viewpoint, lattice: &Lattice) -> Self {
        match viewpoint {
            Viewpoint::Eye(point) => Self::at(lattice.to_lattice(point).map(number)),
            Viewpoint::Direction(direction) => {
                Self::towards(direction.to_array().map(|c| -number(c)))
            }
        }
    }

    /// The eye at a point in lattice units.
    pub(crate) fn at(point: [f64; 3]) -> Self {
        let size = largest(point);
        let mut shift = 0;
        let mut unit = 1.0;
        while size * unit > NEAR {
            shift += 1;
            unit *= 0.5;
            if shift > FAR {
                return Self::towards(point);
            }
        }
        let integer = point.map(|c| (c * unit).round() as i64);
        Self { integer, shift: Some(shift), float: integer.map(|c| c as f64 / unit) }
    }

    /// An eye infinitely far away in a direction.
    fn towards(direction: [f64; 3]) -> Self {
        // An infinite component outweighs all finite ones.
        let finite = if largest(direction).is_infinite() {
            direction.map(|c| if c.is_infinite() { c.signum() } else { 0.0 })
        } else {
            direction
        };
        let size = largest(finite);
        let unit = if size > 0.0 { finite.map(|c| c / size) } else { [0.0, 0.0, 1.0] };
        let integer = unit.map(|c| (c * (1i64 << 52) as f64).round() as i64);
        Self { integer, shift: None, float: unit }
    }

    /// The integer part: lattice units over 2^shift, or a direction.
    pub(crate) fn integer(&self) -> [i64; 3] {
        self.integer
    }

    /// The power of two that the integer part is to be multiplied by; `None` at infinity.
    pub(crate) fn shift(&self) -> Option<u32> {
        self.shift
    }

    /// The eye in lattice units, and 1; or the direction towards it, and 0: homogeneous.
    pub(crate) fn homogeneous(&self) -> ([f64; 3], f64) {
        (self.float, if self.shift.is_some() { 1.0 } else { 0.0 })
    }
}

fn largest(v: [f64; 3]) -> f64 {
    v.into_iter().fold(0.0, |max, c| max.max(c.abs()))
}

fn number(c: f64) -> f64 {
    if c.is_nan() { 0.0 } else { c }
}
