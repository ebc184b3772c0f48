//! Flat colours.

/// A flat colour. There is no lighting.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Material {
    /// A name for people; need not be unique.
    pub name: String,
    /// Red, green, blue from 0 to 1, sRGB-encoded: the value to display, as it stands.
    pub color: [f32; 3],
    /// From 0, invisible, to 1, opaque.
    pub opacity: f32,
}

impl Material {
    /// Light grey, opaque, without a name: for polygons without a material.
    pub const DEFAULT: Self = Self { name: String::new(), color: [0.8; 3], opacity: 1.0 };

    /// An opaque material.
    pub fn new(name: impl Into<String>, color: [f32; 3]) -> Self {
        Self { name: name.into(), color, opacity: 1.0 }
    }

    /// The same material with an opacity from 0, invisible, to 1, opaque.
    #[must_use]
    pub fn with_opacity(self, opacity: f32) -> Self {
        Self { opacity, ..self }
    }

    /// Eight colours that stay distinct for colour-blind eyes: Okabe and Ito, "Color Universal
    /// Design", 2008, with grey in place of black.
    pub fn palette() -> impl Iterator<Item = Self> {
        const PALETTE: [(&str, [u8; 3]); 8] = [
            ("orange", [230, 159, 0]),
            ("sky blue", [86, 180, 233]),
            ("bluish green", [0, 158, 115]),
            ("yellow", [240, 228, 66]),
            ("blue", [0, 114, 178]),
            ("vermilion", [213, 94, 0]),
            ("reddish purple", [204, 121, 167]),
            ("grey", [153, 153, 153]),
        ];
        PALETTE.iter().map(|&(name, rgb)| Self::new(name, rgb.map(|byte| f32::from(byte) / 255.0)))
    }
}
