//! A picture on which the examples paint convex polygons, one over the other.

use std::error::Error;
use std::fs::File;
use std::io::BufWriter;

/// Samples along each side of a pixel, for antialiased edges.
const SAMPLES: usize = 4;

/// Red, green, blue and opacity, from 0 to 1.
pub(crate) type Colour = [f64; 4];

pub(crate) struct Canvas {
    size: [usize; 2],
    /// Colours of all samples, row by row.
    samples: Vec<[f64; 3]>,
}

impl Canvas {
    pub(crate) fn new(size: [usize; 2], background: [f64; 3]) -> Self {
        let samples = vec![background; size[0] * size[1] * SAMPLES * SAMPLES];
        Self { size: size.map(|side| side * SAMPLES), samples }
    }

    /// Paints a convex polygon, given in pixels, in the colour of each of its points. Polygons that
    /// share an edge, bit for bit, paint every sample on it exactly once.
    pub(crate) fn fill(&mut self, outline: &[[f64; 2]], colour: impl Fn([f64; 2]) -> Colour) {
        let outline: Vec<[f64; 2]> =
            outline.iter().map(|point| point.map(|x| x * SAMPLES as f64 - 0.5)).collect();
        let [width, height] = self.size;
        for row in 0..height {
            let [from, to] = span(&outline, row as f64).map(|x| x.ceil().clamp(0.0, width as f64));
            for column in from as usize..to as usize {
                let point = [column, row].map(|at| (at as f64 + 0.5) / SAMPLES as f64);
                let [r, g, b, alpha] = colour(point);
                let sample = &mut self.samples[row * width + column];
                *sample = [0, 1, 2].map(|k| sample[k] + ([r, g, b][k] - sample[k]) * alpha);
            }
        }
    }

    /// The mean of the samples of a pixel.
    pub(crate) fn pixel(&self, [x, y]: [usize; 2]) -> [u8; 3] {
        let mut sum = [0.0; 3];
        for k in 0..SAMPLES * SAMPLES {
            let (column, row) = (x * SAMPLES + k % SAMPLES, y * SAMPLES + k / SAMPLES);
            let sample = self.samples[row * self.size[0] + column];
            sum = [0, 1, 2].map(|k| sum[k] + sample[k]);
        }
        sum.map(|sum| (255.0 * sum / (SAMPLES * SAMPLES) as f64).round() as u8)
    }

    pub(crate) fn write_png(&self, path: &str) -> Result<(), Box<dyn Error>> {
        let [width, height] = self.size.map(|side| side / SAMPLES);
        let pixels = (0..width * height).flat_map(|k| self.pixel([k % width, k / width]));
        let file = BufWriter::new(File::create(path)?);
        let mut encoder = png::Encoder::new(file, width as u32, height as u32);
        encoder.set_color(png::ColorType::Rgb);
        encoder.write_header()?.write_image_data(&pixels.collect::<Vec<u8>>())?;
        Ok(())
    }
}

/// The x at which a line y = constant enters and leaves a convex outline.
fn span(outline: &[[f64; 2]], y: f64) -> [f64; 2] {
    let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
    for (i, &a) in outline.iter().enumerate() {
        let b = outline[(i + 1) % outline.len()];
        // Each edge is computed from its upper end, so that both polygons at the edge get the same x.
        let [a, b] = if a[1] <= b[1] { [a, b] } else { [b, a] };
        if a[1] <= y && y < b[1] {
            let x = a[0] + (b[0] - a[0]) * ((y - a[1]) / (b[1] - a[1]));
            (low, high) = (low.min(x), high.max(x));
        }
    }
    [low, high]
}
