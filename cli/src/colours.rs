//! The colours of polygons.

use binspace::raster::colour_of;
use binspace::scene::Scene;
use clap::ValueEnum;

/// The background colour.
pub const BACKGROUND: [u8; 3] = [255, 255, 255];

/// The source of the colours of polygons.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum Colouring {
    /// The colour of the material; grey without a material
    #[default]
    Material,
    /// A different colour for each polygon
    Polygon,
}

/// The colours of a scene's polygons.
#[derive(Clone, Copy, Debug)]
pub struct Colours<'a> {
    scene: &'a Scene,
    by: Colouring,
    /// The numbers of the polygons in the whole scene; `None` unless `scene` is a part of a scene.
    numbers: Option<&'a [usize]>,
}

impl<'a> Colours<'a> {
    /// The colours of a scene.
    pub fn new(scene: &'a Scene, by: Colouring) -> Self {
        Self { scene, by, numbers: None }
    }

    /// The colours for a part of a scene. `numbers` are the numbers of the part's polygons in the whole
    /// scene.
    pub fn numbered(self, numbers: &'a [usize]) -> Self {
        Self { numbers: Some(numbers), ..self }
    }

    /// The colour of a polygon: red, green and blue.
    pub fn rgb(&self, polygon: usize) -> [u8; 3] {
        match self.by {
            Colouring::Material => {
                let colour = self.scene.material(polygon).color;
                colour.map(|channel| (channel * 255.0).round() as u8)
            }
            Colouring::Polygon => {
                colour_of(self.numbers.map_or(polygon, |numbers| numbers[polygon]))
            }
        }
    }

    /// Whether anything shows through a polygon.
    pub fn are_translucent(&self) -> bool {
        self.scene.materials().iter().any(|material| material.opacity < 1.0)
    }

    /// The opacity of a polygon, from 0, invisible, to 1, opaque.
    pub fn opacity(&self, polygon: usize) -> f32 {
        self.scene.material(polygon).opacity
    }
}
