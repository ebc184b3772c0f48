//! Translucent polygons: colours blended in an order, against all layers of a pixel sorted exactly.

use binspace::BspTree;
use binspace::internals::Faces;
use binspace::raster::{Outline, Piece, Rays, for_each_run};

use crate::layers::Layers;
use binspace::internals::Pieces;

/// A colour, each channel from 0 to 1.
pub type Colour = [f32; 3];

/// The appearance of a polygon: its colour, and its opacity from 0 to 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Look {
    /// The colour.
    pub colour: Colour,
    /// The covered share of the background.
    pub opacity: f32,
}

impl Look {
    /// The view through a surface that looks like this: "over" (Porter & Duff 1984).
    fn over(self, behind: Colour) -> Colour {
        [0, 1, 2].map(|i| behind[i] * (1.0 - self.opacity) + self.colour[i] * self.opacity)
    }
}

/// A picture on which surfaces are blended one over another.
struct Canvas<'a, F> {
    rays: &'a Rays,
    faces: &'a Faces,
    look: F,
    pixels: Vec<Colour>,
}

impl<'a, F: Fn(usize) -> Look> Canvas<'a, F> {
    fn new(rays: &'a Rays, faces: &'a Faces, look: F, background: Colour) -> Self {
        let [width, height] = rays.size().map(|side| side as usize);
        Self { rays, faces, look, pixels: vec![background; width * height] }
    }

    fn draw(&mut self, piece: Piece<'_>) {
        let (width, look) = (self.rays.size()[0], (self.look)(self.faces.polygon(piece.face)));
        for_each_run(self.rays, self.faces, piece, |y, columns| {
            for x in columns {
                let pixel = &mut self.pixels[(y * width + x) as usize];
                *pixel = look.over(*pixel);
            }
        });
    }
}

/// The fragments of a tree blended in its order, back to front.
pub fn by_tree(
    tree: &BspTree,
    rays: &Rays,
    look: impl Fn(usize) -> Look,
    background: Colour,
) -> Vec<Colour> {
    let mut canvas = Canvas::new(rays, tree.faces(), look, background);
    let mut pieces = Pieces::default();
    for fragment in tree.back_to_front(rays.viewpoint()) {
        canvas.draw(pieces.of(&fragment));
    }
    canvas.pixels
}

/// Whole faces blended in the order of a list.
pub fn by_list(
    faces: &Faces,
    list: impl IntoIterator<Item = u32>,
    rays: &Rays,
    look: impl Fn(usize) -> Look,
    background: Colour,
) -> Vec<Colour> {
    let mut canvas = Canvas::new(rays, faces, look, background);
    list.into_iter().for_each(|face| canvas.draw(Piece { face, outline: Outline::Whole }));
    canvas.pixels
}

/// The layers of each pixel blended, the furthest first: the truth.
pub fn by_layers(
    faces: &Faces,
    layers: &Layers,
    look: impl Fn(usize) -> Look,
    background: Colour,
) -> Vec<Colour> {
    let blend = |layers: &[u32]| {
        let far_first = layers.iter().rev().map(|&face| look(faces.polygon(face)));
        far_first.fold(background, |behind, look| look.over(behind))
    };
    layers.pixels().map(blend).collect()
}

/// The number of pixels that differ in a bit.
pub fn differences(a: &[Colour], b: &[Colour]) -> usize {
    let bits = |colour: &Colour| colour.map(f32::to_bits);
    a.iter().zip(b).filter(|(a, b)| bits(a) != bits(b)).count()
}

/// The picture in 8 bits a channel.
pub fn rgb(pixels: &[Colour]) -> Vec<u8> {
    pixels.iter().flatten().map(|c| (255.0 * c).round() as u8).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::method::centroid_order;
    use binspace::scene;
    use binspace::view;
    use binspace::{BuildOptions, Heuristic};

    fn look(polygon: usize) -> Look {
        let colour = binspace::raster::colour_of(polygon).map(|c| f32::from(c) / 255.0);
        Look { colour, opacity: 0.2 + 0.1 * (polygon % 7) as f32 }
    }

    #[test]
    fn blending_in_the_order_of_a_tree_is_blending_sorted_layers() {
        let (mut compared, mut centroid_wrong) = (0, 0);
        for scene in [
            scene::random_triangles(60, 3),
            scene::crossing(7),
            scene::layers(5, 0.1),
            scene::newell_bars(),
        ] {
            let options = BuildOptions::DEFAULT.with_tolerance(0.0);
            for heuristic in [Heuristic::Auto, Heuristic::First] {
                let tree =
                    options.clone().with_heuristic(heuristic).build(scene.polygons()).unwrap();
                let (low, high) = scene.bounds().unwrap();
                for camera in view::views([low, high], scene.up(), 4, [64, 48], 7).unwrap() {
                    let rays = Rays::new(&camera, tree.faces()).unwrap();
                    let layers = Layers::new(&rays, tree.faces());
                    let truth = by_layers(tree.faces(), &layers, look, [1.0; 3]);
                    let found = by_tree(&tree, &rays, look, [1.0; 3]);
                    assert_eq!(differences(&found, &truth), 0, "{}", scene.name());
                    compared += layers.pixels().filter(|layers| layers.len() > 1).count();
                    let order = centroid_order(tree.faces(), &camera);
                    let guess = by_list(tree.faces(), order, &rays, look, [1.0; 3]);
                    centroid_wrong += differences(&guess, &truth);
                }
            }
        }
        // The comparison sees wrong orders.
        assert!(compared > 10_000 && centroid_wrong > 1_000, "{compared} {centroid_wrong}");
    }
}
