//! The colours of polygons.

use binspace::raster::colour_of;
use binspace::scene::{Material, Scene};

/// The background colour.
pub(crate) const BACKGROUND: [u8; 3] = [255, 255, 255];

/// The colours of a scene's polygons.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Colours<'a> {
    scene: &'a Scene,
    by_material: bool,
}

impl<'a> Colours<'a> {
    /// The colours of the scene's materials; if none is defined, one for each polygon.
    pub(crate) fn of(scene: &'a Scene) -> Self {
        let is_coloured = |material: &Material| {
            material.color != Material::DEFAULT.color
                || material.opacity != Material::DEFAULT.opacity
        };
        Self { scene, by_material: scene.materials().iter().any(is_coloured) }
    }

    /// Red, green and blue.
    pub(crate) fn rgb(&self, polygon: usize) -> [u8; 3] {
        if self.by_material {
            let colour = self.scene.material(polygon).color;
            colour.map(|channel| (channel * 255.0).round() as u8)
        } else {
            colour_of(polygon)
        }
    }

    /// Whether anything shows through a polygon.
    pub(crate) fn are_translucent(&self) -> bool {
        self.scene.materials().iter().any(|material| material.opacity < 1.0)
    }

    /// From 0, invisible, to 1, opaque.
    pub(crate) fn opacity(&self, polygon: usize) -> f32 {
        self.scene.material(polygon).opacity
    }
}
