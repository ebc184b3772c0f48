//! Trees, as a method: the one of this library, and the same with rounded decisions.

use std::time::{Duration, Instant};

use super::{Method, MethodError, Painted, Prepared};
use crate::bsp::{Accuracy, BspTree, BuildOptions};
use crate::geom::{Exact, Faces, Float, Kernel, Preparation};
use crate::raster::Rays;
use crate::verify::paint_order;
use crate::view::Camera;

/// A BSP tree (Fuchs, Kedem & Naylor 1980), whose decisions a kernel makes.
///
/// Fragments of the exact kernel are drawn as the lines around them bound them, those of others as
/// their rounded vertices do.
#[derive(Clone, Debug)]
pub struct Bsp<K: Kernel> {
    /// What it is called.
    pub name: String,
    /// How the tree is built; the tolerance is that of the faces.
    pub options: BuildOptions,
    /// What decides on which side of a plane a vertex lies.
    pub kernel: K,
}

impl Bsp<Exact> {
    /// The tree that the library builds: no decision is ever wrong.
    pub fn exact(options: BuildOptions) -> Self {
        Self { name: "bsp exact".into(), options, kernel: Exact }
    }
}

impl Bsp<Float<f64>> {
    /// With decisions in `f64`; vertices no further from a plane than `epsilon` times half the
    /// scene's extent count as on it.
    pub fn double(options: BuildOptions, epsilon: f64) -> Self {
        Self { name: format!("bsp f64 {epsilon:e}"), options, kernel: Float::new(epsilon) }
    }
}

impl Bsp<Float<f32>> {
    /// With decisions in `f32`; vertices no further from a plane than `epsilon` times half the
    /// scene's extent count as on it.
    pub fn single(options: BuildOptions, epsilon: f64) -> Self {
        Self { name: format!("bsp f32 {epsilon:e}"), options, kernel: Float::new(epsilon) }
    }
}

impl<K: Kernel> Method for Bsp<K> {
    fn name(&self) -> String {
        self.name.clone()
    }

    fn prepare<'a>(&'a self, faces: &'a Faces) -> Result<Box<dyn Prepared + 'a>, MethodError> {
        let preparation = Preparation::default();
        let tree = self.options.build_faces(self.kernel, faces.clone(), preparation)?;
        Ok(Box::new(Ready { tree, order: Vec::new() }))
    }
}

struct Ready<K: Kernel> {
    tree: BspTree<K>,
    order: Vec<u32>,
}

impl<K: Kernel> Prepared for Ready<K> {
    fn paint(&mut self, camera: &Camera, rays: &Rays) -> Result<Painted, MethodError> {
        let begin = Instant::now();
        self.tree.back_to_front_into(camera.viewpoint(), &mut self.order);
        let order: Duration = begin.elapsed();
        let image = paint_order(&self.tree, &self.order, rays);
        Ok(Painted { image, order, draw: begin.elapsed() - order, pieces: self.order.len() })
    }

    fn bytes(&self) -> usize {
        self.tree.bytes() - self.tree.faces().bytes() + self.order.capacity() * size_of::<u32>()
    }

    fn for_each_piece(&self, visit: &mut dyn FnMut(u32, &[[f64; 3]])) {
        let mut vertices = Vec::new();
        for fragment in self.tree.fragments() {
            vertices.clear();
            vertices.extend(fragment.lattice_vertices());
            visit(fragment.face(), &vertices);
        }
    }

    fn accuracy(&self) -> Option<Accuracy> {
        Some(self.tree.accuracy())
    }
}
