//! A scene that grows face by face as a file is read.

use std::collections::HashMap;

use binspace::glam::DVec3;
use binspace::internals::Decimals;
use binspace::scene::{Material, Scene};

/// No material: the polygon shows in the default colour.
const PLAIN: u32 = u32::MAX;

/// Red, green and blue in sRGB, and opacity, from 0 to 1.
pub(crate) type Colour = [f32; 4];

/// A scene to which a reader adds faces.
pub(crate) struct Mesh {
    scene: Scene,
    /// The numbers of materials, by red, green, blue and opacity.
    materials: HashMap<[u8; 4], u32>,
}

impl Mesh {
    pub(crate) fn new(name: &str, up: DVec3) -> Self {
        Self { scene: Scene::new(name, up), materials: HashMap::new() }
    }

    /// Adds a face.
    pub(crate) fn face(
        &mut self,
        corners: impl IntoIterator<Item = DVec3>,
        colour: Option<Colour>,
    ) {
        let material = colour.map_or(PLAIN, |colour| self.material(colour));
        self.scene.push(corners, material);
    }

    fn material(&mut self, colour: Colour) -> u32 {
        // `as` takes NaN as 0.
        let key = colour.map(|channel| (channel.clamp(0.0, 1.0) * 255.0).round() as u8);
        *self.materials.entry(key).or_insert_with(|| {
            let [r, g, b, opacity] = key.map(|byte| f32::from(byte) / 255.0);
            let name = format!("#{:02x}{:02x}{:02x}", key[0], key[1], key[2]);
            self.scene.add_material(Material::new(name, [r, g, b]).with_opacity(opacity))
        })
    }

    /// The scene of coordinates that were rounded to multiples of `unit`.
    pub(crate) fn finish(self, unit: f64) -> Scene {
        // As for OBJ files: corners off by half a unit move one off the plane of others by up to four.
        self.scene.with_precision(4.0 * unit)
    }
}

/// The precision of the coordinates read.
#[derive(Default)]
pub(crate) struct Precision {
    decimals: Decimals,
    /// The largest coordinate that was an `f32`.
    largest: f32,
}

impl Precision {
    /// A coordinate that is written as text, as a finite number.
    pub(crate) fn text(&mut self, word: &str) -> Option<f64> {
        let value = word.parse().ok().filter(|value: &f64| value.is_finite())?;
        self.decimals.see(word, value);
        Some(value)
    }

    /// A coordinate of 32 bits, as a finite number.
    pub(crate) fn single(&mut self, value: f32) -> Option<f64> {
        self.largest = self.largest.max(value.abs());
        value.is_finite().then(|| value.into())
    }

    /// A unit in the last place of the coordinates.
    pub(crate) fn unit(&self) -> f64 {
        self.decimals.unit().max(f64::from(f32::EPSILON) * f64::from(self.largest))
    }
}

/// The mean of colours; `None` if a colour is missing.
pub(crate) fn mean(colours: impl Iterator<Item = Option<Colour>>) -> Option<Colour> {
    let (mut sum, mut count) = ([0.0; 4], 0.0);
    for colour in colours {
        let colour = colour?;
        sum.iter_mut().zip(colour).for_each(|(sum, channel)| *sum += channel);
        count += 1.0;
    }
    (count > 0.0).then(|| sum.map(|sum| sum / count))
}
