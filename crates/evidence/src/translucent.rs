//! Translucent polygons: colours blended in an order, against all layers of a pixel sorted exactly.

use binspace::BspTree;
use binspace::internals::Faces;
use binspace::raster::{Outline, Piece, Rays, for_each_run};

use crate::layers::Layers;
use binspace::Viewpoint;
use binspace::internals::Pieces;
use binspace::view::Camera;

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
    /// The colour of this surface over the colour behind it: "over" (Porter & Duff 1984).
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

/// Blends the fragments of a tree in its order, back to front.
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

/// Blends whole faces in the order of a list.
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

/// Blends the layers of each pixel, the furthest first: the truth.
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

/// Blends the nearest layers of each pixel, the furthest of these first: depth peeling (C. Everitt,
/// "Interactive order-independent transparency", 2001) that stops after some passes. Its depth tests are
/// exact here.
pub fn by_nearest_layers(
    faces: &Faces,
    layers: &Layers,
    passes: usize,
    look: impl Fn(usize) -> Look,
    background: Colour,
) -> Vec<Colour> {
    let blend = |layers: &[u32]| {
        let nearest = layers[..layers.len().min(passes)].iter().rev();
        nearest.map(|&face| look(faces.polygon(face))).fold(background, |behind, l| l.over(behind))
    };
    layers.pixels().map(blend).collect()
}

/// The weights of [`by_weights`], by the numbers of their equations in the paper. A weight depends on the
/// distance z of a layer from the eye. In equations 7 to 9, distances are scaled so that the furthest corner
/// is at 500. In equation 10, d is the depth after the perspective divide, from 0 at the nearest corner to 1
/// at the furthest.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Weight {
    /// 10 / (10⁻⁵ + (z/5)² + (z/200)⁶).
    Equation7,
    /// 10 / (10⁻⁵ + (z/10)³ + (z/200)⁶).
    Equation8,
    /// 0.03 / (10⁻⁵ + (z/200)⁴).
    Equation9,
    /// 3·10³ (1 − d)³.
    Equation10,
}

impl Weight {
    /// All weights.
    pub const ALL: [Self; 4] =
        [Self::Equation7, Self::Equation8, Self::Equation9, Self::Equation10];

    /// The weight at a distance between the nearest and the furthest.
    fn at(self, z: f64, [near, far]: [f64; 2]) -> f64 {
        let scaled = 500.0 * z / far;
        let weight = match self {
            Self::Equation7 => 10.0 / (1e-5 + (scaled / 5.0).powi(2) + (scaled / 200.0).powi(6)),
            Self::Equation8 => 10.0 / (1e-5 + (scaled / 10.0).powi(3) + (scaled / 200.0).powi(6)),
            Self::Equation9 => 0.03 / (1e-5 + (scaled / 200.0).powi(4)),
            Self::Equation10 => {
                let depth = (1.0 / near - 1.0 / z) / (1.0 / near - 1.0 / far);
                3e3 * (1.0 - depth).powi(3)
            }
        };
        weight.clamp(1e-2, 3e3)
    }
}

/// Blends layers without an order (M. McGuire and L. Bavoil, "Weighted blended order-independent
/// transparency", 2013). Each pixel is the mean of the layers' colours, weighted by opacity and `weight`,
/// over the background. The share of the background that remains is the product of the layers'
/// transparencies.
///
/// # Panics
///
/// If the camera is parallel.
pub fn by_weights(
    faces: &Faces,
    layers: &Layers,
    camera: &Camera,
    weight: Weight,
    look: impl Fn(usize) -> Look,
    background: Colour,
) -> Vec<Colour> {
    let Viewpoint::Eye(eye) = camera.viewpoint() else { panic!("a perspective camera") };
    // The plane of a face, from the eye.
    let plane = |face: u32| {
        let lattice = faces.lattice();
        let corner = |k| lattice.to_world(faces.corner(k)) - eye;
        let [a, b, c] = faces.reference_triangle(face).map(corner);
        let normal = (b - a).cross(c - a);
        (normal, normal.dot(a))
    };
    let planes: Vec<_> = (0..faces.len() as u32).map(plane).collect();
    let distances = (0..faces.len() as u32)
        .flat_map(|face| faces.corners(face))
        .map(|&corner| (faces.lattice().to_world(corner) - eye).dot(camera.forward()));
    let range = distances
        .fold([f64::INFINITY, 0.0], |[low, high]: [f64; 2], z| [low.min(z.max(1e-3)), high.max(z)]);
    let ([width, height], pixel) = (camera.size(), camera.pixel_size());
    let blend = |(number, layers): (usize, &[u32])| {
        let (x, y) = (number as u32 % width, number as u32 / width);
        let across = (f64::from(x) + 0.5 - 0.5 * f64::from(width)) * pixel[0];
        let up = (0.5 * f64::from(height) - f64::from(y) - 0.5) * pixel[1];
        let ray = camera.forward() + camera.right() * across + camera.up() * up;
        let (mut sum, mut weights, mut revealed) = ([0.0; 3], 0.0, 1.0);
        for &face in layers {
            let look = look(faces.polygon(face));
            let (normal, offset) = planes[face as usize];
            let share = weight.at(offset / normal.dot(ray), range) as f32 * look.opacity;
            sum = [0, 1, 2].map(|i| sum[i] + look.colour[i] * share);
            weights += share;
            revealed *= 1.0 - look.opacity;
        }
        let mean = sum.map(|c| c / f32::max(weights, 1e-5));
        [0, 1, 2].map(|i| mean[i] * (1.0 - revealed) + background[i] * revealed)
    };
    layers.pixels().enumerate().map(blend).collect()
}

/// Returns the number of pixels that differ in at least one bit.
pub fn differences(a: &[Colour], b: &[Colour]) -> usize {
    let bits = |colour: &Colour| colour.map(f32::to_bits);
    a.iter().zip(b).filter(|(a, b)| bits(a) != bits(b)).count()
}

/// Returns the picture with 8 bits per channel.
pub fn rgb(pixels: &[Colour]) -> Vec<u8> {
    pixels.iter().flatten().map(|c| (255.0 * c).round() as u8).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::method::centroid_order;
    use binspace::glam::DVec3;
    use binspace::scene;
    use binspace::view;
    use binspace::{BuildOptions, Heuristic};

    fn look(polygon: usize) -> Look {
        let colour = binspace::raster::colour_of(polygon).map(|c| f32::from(c) / 255.0);
        Look { colour, opacity: 0.2 + 0.1 * (polygon % 7) as f32 }
    }

    /// Two squares that fill a picture. The nearer square is red with opacity 0.5, the further square is
    /// green with opacity 0.25, and the background is white.
    #[test]
    fn blends_without_an_order_match_hand_computation() {
        let square = |z: f64| [[-9., -9., z], [9., -9., z], [9., 9., z], [-9., 9., z]];
        let (faces, _) = Faces::new([square(-1.0), square(-2.0)], Some(0.0)).unwrap();
        let (eye, middle) = (DVec3::ZERO, DVec3::NEG_Z);
        let camera = Camera::perspective(eye, middle, DVec3::Y, 1.0, [4, 4]).unwrap();
        let layers = Layers::new(&Rays::new(&camera, &faces).unwrap(), &faces);
        let look = |polygon| match polygon {
            0 => Look { colour: [1.0, 0.0, 0.0], opacity: 0.5 },
            _ => Look { colour: [0.0, 1.0, 0.0], opacity: 0.25 },
        };
        let all_near = |found: Vec<Colour>, expected: Colour| {
            assert_eq!(found.len(), 16);
            for (found, expected) in found.as_flattened().iter().zip(expected.repeat(16)) {
                assert!((found - expected).abs() < 1e-5, "{found} {expected}");
            }
        };
        let white = [1.0; 3];
        let peeled = |passes| by_nearest_layers(&faces, &layers, passes, look, white);
        all_near(peeled(1), [1.0, 0.5, 0.5]);
        all_near(peeled(2), [0.875, 0.5, 0.375]);
        assert_eq!(peeled(2), by_layers(&faces, &layers, look, white));
        // The distances 1 and 2 count as 250 and 500; 0.375 of the white remains.
        let weights = [0.03 / (1e-5 + 1.25_f64.powi(4)), 0.03 / (1e-5 + 2.5_f64.powi(4))];
        let share = weights[0] * 0.5 / (weights[0] * 0.5 + weights[1].max(0.01) * 0.25);
        let [red, green] = [share, 1.0 - share].map(|share| (0.625 * share + 0.375) as f32);
        let found = by_weights(&faces, &layers, &camera, Weight::Equation9, look, white);
        all_near(found, [red, green, 0.375]);
        // The nearest depth d is 0 and the furthest is 1, where the weight is at its limit.
        let share = 3e3 * 0.5 / (3e3 * 0.5 + 0.01 * 0.25);
        let [red, green] = [share, 1.0 - share].map(|share: f64| (0.625 * share + 0.375) as f32);
        let found = by_weights(&faces, &layers, &camera, Weight::Equation10, look, white);
        all_near(found, [red, green, 0.375]);
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
