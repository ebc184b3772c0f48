//! The depth resolution of formats: the stored number of a depth, and the depth that it stands for.

use super::format::{DepthFormat, Scale};
use crate::Precision;
use crate::method::clip::Range;

/// The stored value of a depth in a depth buffer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stored {
    /// The stored number: 0 at the near plane and 1 at the far plane, or the reverse for
    /// [`DepthFormat::FloatReversed`].
    pub value: f64,
    /// The depth that this number stands for.
    pub depth: f64,
}

impl DepthFormat {
    /// Returns the stored value in a perspective picture's buffer, for a depth between the near and the far
    /// plane.
    pub fn store(self, planes: [f64; 2], depth: f64) -> Stored {
        if self.is_float() {
            self.store_in::<f32>(planes, depth)
        } else {
            self.store_in::<f64>(planes, depth)
        }
    }

    fn store_in<P: Precision>(self, [near, far]: [f64; 2], depth: f64) -> Stored {
        let scale = Scale::<P>::new(self, Range { near, far }, true);
        let key = scale.key(scale.value(P::round(depth)));
        let of_bits = |bits: u32| f64::from(f32::from_bits(bits));
        let value = match self {
            Self::Integer(_) | Self::LinearInteger(_) => f64::from(key) / scale.steps(),
            Self::Float => of_bits(key),
            Self::FloatReversed => of_bits(!key),
            Self::LinearFloat => (of_bits(key) - near) / (far - near),
        };
        let depth = match self {
            Self::Integer(_) | Self::Float => near * far / (far - value * (far - near)),
            Self::FloatReversed => near * far / (near + value * (far - near)),
            Self::LinearInteger(_) | Self::LinearFloat => near + value * (far - near),
        };
        Stored { value, depth }
    }

    /// Returns the largest difference between a depth and its stored value, over depths that differ from
    /// `depth` by at most a share `share`.
    pub fn largest_error(self, planes: [f64; 2], depth: f64, share: f64) -> f64 {
        // Samples at irregular distances, so that their pattern differs from the regular steps of the format.
        let golden = |i: u32| (f64::from(i) * 0.618_033_988_749_894_9).fract() * 2.0 - 1.0;
        let near = |i: u32| (depth * (1.0 + share * golden(i))).clamp(planes[0], planes[1]);
        let error = |i| (self.store(planes, near(i)).depth - near(i)).abs();
        (0..LOOKED_AT).map(error).fold(0.0, f64::max)
    }

    /// Returns the difference of two depths near `depth` whose stored numbers are a step apart. It is
    /// computed by the formula: a step times the slope of w over the stored number. For z the slope is w² (f
    /// − n) / (f n).
    ///
    /// The step of an `f32` depends on the power of two of the stored number.
    pub fn step(self, [near, far]: [f64; 2], depth: f64) -> f64 {
        let slope = depth * depth * (far - near) / (far * near);
        let of_bits = |bits: u8| 1.0 / (2f64.powi(i32::from(bits.clamp(1, 32))) - 1.0);
        let of_float = |value: f64| 2f64.powi(value.log2().floor() as i32 - 23);
        let z = far * (depth - near) / (depth * (far - near));
        match self {
            Self::Integer(bits) => of_bits(bits) * slope,
            Self::Float => of_float(z) * slope,
            Self::FloatReversed => of_float(near * (far - depth) / (depth * (far - near))) * slope,
            Self::LinearInteger(bits) => of_bits(bits) * (far - near),
            Self::LinearFloat => of_float(depth),
        }
    }
}

/// The number of depths sampled for an error. Too small: the largest error is missed. Too large: the search
/// takes longer.
const LOOKED_AT: u32 = 2000;

#[cfg(test)]
mod tests {
    use super::DepthFormat::{Float, FloatReversed, Integer, LinearFloat, LinearInteger};

    const PLANES: [f64; 2] = [1.0, 200.0];

    #[test]
    fn half_of_the_values_go_to_depths_below_twice_the_near_plane() {
        for (depth, value) in
            [(1.0, 0.0), (200.0, 1.0), (2.0, 100.0 / 199.0), (100.0, 0.99 / 0.995)]
        {
            assert!((Integer(24).store(PLANES, depth).value - value).abs() < 1e-7);
            assert!((Float.store(PLANES, depth).value - value).abs() < 1e-6);
            assert!((FloatReversed.store(PLANES, depth).value - (1.0 - value)).abs() < 1e-6);
            let linear = LinearInteger(16).store(PLANES, depth).value;
            assert!((linear - (depth - 1.0) / 199.0).abs() < 1e-5);
        }
    }

    #[test]
    fn errors_of_integers_are_half_a_step_by_the_formula() {
        let mut compared = 0;
        for format in [Integer(12), Integer(16), Integer(24), LinearInteger(12), LinearInteger(16)]
        {
            for depth in [1.5, 2.0, 5.0, 10.0, 30.0, 70.0, 120.0, 180.0] {
                let step = format.step(PLANES, depth);
                // Samples as wide as a few steps, and samples so narrow that they are almost equal.
                let share = 3.0 * step / depth;
                if share > 0.01 {
                    continue;
                }
                let error = format.largest_error(PLANES, depth, share) / (0.5 * step);
                assert!((0.97..1.03).contains(&error), "{format} at {depth}: {error}");
                compared += 1;
            }
        }
        assert!(compared >= 30, "{compared}");
    }

    #[test]
    fn errors_of_floats_are_within_the_sum_of_their_roundings() {
        let [near, far] = PLANES;
        let unit = 2f64.powi(-24);
        for depth in [1.5, 2.0, 5.0, 10.0, 30.0, 70.0, 120.0, 180.0] {
            let slope = depth * depth * (far - near) / (far * near);
            let z = far * (depth - near) / (depth * (far - near));
            // a w + b over w: each of a, b, w, the product, the sum and the quotient is rounded.
            let [a, b] = [far / (far - near), near * far / (far - near)];
            let most = unit * (3.0 * a + b / depth + 3.0 * z) * slope;
            let a = near / (far - near);
            let most_reversed = unit * (3.0 * a + b / depth + 3.0 * (1.0 - z)) * slope;
            let cases =
                [(Float, most), (FloatReversed, most_reversed), (LinearFloat, 4.0 * unit * depth)];
            for (format, most) in cases {
                let error = format.largest_error(PLANES, depth, 1e-3);
                let least = 0.4 * format.step(PLANES, depth);
                assert!(error <= most, "{format} at {depth}: {error:e} > {most:e}");
                assert!(error >= least, "{format} at {depth}: {error:e} < {least:e}");
            }
        }
    }
}
