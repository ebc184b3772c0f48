//! What all parts of a scene have to agree on.

use glam::DVec3;

use crate::input::Polygon;

/// The bounding box of a scene, and how precise it is: what those who build its cells have to agree on.
///
/// Each may gather it of its own polygons; together they are [merged](Self::merge), in any order.
///
/// ```
/// use binspace::partition::Extent;
///
/// let mut extent = Extent::default();
/// extent.include(&[[0.0, 1.0, 2.0], [3.0, 0.0, 0.0], [0.0, 0.0, 1.0]]);
/// assert_eq!(extent.high.to_array(), [3.0, 1.0, 2.0]);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Extent {
    /// The least coordinates; infinite if there is no corner, NaN if a coordinate is infinite or NaN.
    pub low: DVec3,
    /// The largest coordinates; −∞ if there is no corner.
    pub high: DVec3,
    /// The largest [`precision`](Polygon::precision) of the polygons.
    pub precision: f64,
}

impl Default for Extent {
    /// That of nothing.
    fn default() -> Self {
        Self { low: DVec3::INFINITY, high: DVec3::NEG_INFINITY, precision: 0.0 }
    }
}

impl Extent {
    /// Includes a polygon.
    pub fn include(&mut self, polygon: &(impl Polygon + ?Sized)) {
        for corner in polygon.corners() {
            let box_of_it = if corner.is_finite() { [corner; 2] } else { [DVec3::NAN; 2] };
            self.include_box(box_of_it);
        }
        self.precision = self.precision.max(polygon.precision());
    }

    /// Includes what another has.
    pub fn merge(&mut self, other: &Self) {
        self.include_box([other.low, other.high]);
        self.precision = self.precision.max(other.precision);
    }

    fn include_box(&mut self, [low, high]: [DVec3; 2]) {
        // Not `min` and `max` of the type, which pass over NaN.
        for axis in 0..3 {
            if low[axis] < self.low[axis] || low[axis].is_nan() {
                self.low[axis] = low[axis];
            }
            if high[axis] > self.high[axis] || high[axis].is_nan() {
                self.high[axis] = high[axis];
            }
        }
    }
}
