//! Several samples in each pixel, averaged.

/// The largest number of samples each way in a pixel. More are not visible in 8 bits a channel: 16 each way
/// already give 256 levels along an edge.
pub(crate) const MOST: u32 = 16;

/// The light of full white. Too large: an amount of light does not fit `u32`. Too small: two dark colours are
/// the same light.
const FULL: f64 = (1u32 << 24) as f64;

/// Converts between the 8-bit numbers of colours (sRGB) and amounts of light.
#[derive(Debug)]
struct Light {
    /// The light of each number.
    of: [u32; 256],
    /// For each number, the light above which the next number is nearer.
    above: [u32; 255],
}

impl Light {
    fn new() -> Self {
        let light = |number: f64| (FULL * linear(number / 255.0)).round() as u32;
        Self {
            of: std::array::from_fn(|number| light(number as f64)),
            above: std::array::from_fn(|number| light(number as f64 + 0.5)),
        }
    }

    /// The number whose light is nearest to a sum of `count` lights over `count`.
    fn number(&self, sum: u64, count: u64) -> u8 {
        self.above.partition_point(|&light| u64::from(light) * count <= sum) as u8
    }
}

/// The light of an sRGB value, both from 0 to 1 (IEC 61966-2-1).
pub(crate) fn linear(value: f64) -> f64 {
    if value <= 0.040_45 { value / 12.92 } else { ((value + 0.055) / 1.055).powf(2.4) }
}

/// Averages squares of `samples` by `samples` colours in a picture that is a multiple of
/// `samples` wide and high: the light of each pixel is the mean of the light of its samples.
///
/// Averages are of light and not of sRGB values, as screens and eyes average light: otherwise dark edges on a
/// bright ground would be too thick. Sums of integers do not depend on their order. The table of light is
/// rounded from `powf`, which may differ by 1 of 2²⁴ on another machine.
pub(crate) fn averaged(rgb: Vec<u8>, width: usize, samples: usize) -> Vec<u8> {
    if samples == 1 {
        return rgb;
    }
    let light = Light::new();
    let (row, count) = (3 * width * samples, (samples * samples) as u64);
    let mut averages = Vec::with_capacity(rgb.len() / (samples * samples));
    let mut sums = vec![0u64; 3 * width];
    for rows in rgb.chunks_exact(row * samples) {
        sums.fill(0);
        for line in rows.chunks_exact(row) {
            let pixels = sums.chunks_exact_mut(3).zip(line.chunks_exact(3 * samples));
            for (sum, colours) in pixels {
                for (i, &number) in colours.iter().enumerate() {
                    sum[i % 3] += u64::from(light.of[usize::from(number)]);
                }
            }
        }
        averages.extend(sums.iter().map(|&sum| light.number(sum, count)));
    }
    averages
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn samples_of_one_colour_are_that_colour() {
        for samples in 2..=MOST as usize {
            for number in 0..=255u8 {
                let pixel = [number, 255 - number, number / 2];
                let rgb = pixel.repeat(2 * samples * samples);
                assert_eq!(averaged(rgb, 2, samples), pixel.repeat(2), "{samples}");
            }
        }
    }

    /// Half white and half black is half the light: 188 of 255, not 128.
    #[test]
    fn light_is_averaged_not_numbers() {
        let (black, white) = ([0; 3], [255; 3]);
        let rows = [black, white, white, white, white, black, black, black].concat();
        assert_eq!(averaged(rows, 2, 2), [[188; 3], [188; 3]].concat());
        // Three quarters, and one.
        let rows = [white, white, black, black, white, black, black, white].concat();
        assert_eq!(averaged(rows, 2, 2), [[225; 3], [137; 3]].concat());
    }

    #[test]
    fn channels_and_pixels_are_apart() {
        let row = |a: [u8; 3], b: [u8; 3]| [[a; 3].concat(), [b; 3].concat()].concat();
        let rgb = row([1, 2, 3], [200, 100, 50]).repeat(3);
        assert_eq!(averaged(rgb, 2, 3), [1, 2, 3, 200, 100, 50]);
        assert_eq!(averaged(vec![7, 8, 9], 1, 1), [7, 8, 9]);
    }
}
