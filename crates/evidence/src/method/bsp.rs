//! BSP trees as methods: the library's tree, and the same with rounded decisions.

use std::time::{Duration, Instant};

use super::{Method, MethodError, Painted, Prepared, Space};
use crate::{Accuracy, Float, KernelTree, accuracy};
use binspace::internals::{Exact, Faces, Kernel, Tuning, tree_of};
use binspace::paint::paint_order;
use binspace::raster::{Order, Outline, Painter, Piece, Rays};
use binspace::view::Camera;
use binspace::{BspTree, BuildOptions, Preparation};

/// A BSP tree (Fuchs, Kedem & Naylor 1980) with the decisions of a kernel.
///
/// Fragments of the exact kernel are drawn as bounded by their lines, those of other kernels as
/// bounded by their rounded vertices.
#[derive(Clone, Debug)]
pub struct Bsp<K: Kernel> {
    /// The method's name.
    pub name: String,
    /// How the tree is built; the tolerance is that of the faces.
    pub options: BuildOptions,
    /// Decides on which side of a plane a vertex lies.
    pub kernel: K,
    /// Whether the tree is the library's own, whose fragments have exact lines.
    is_exact: bool,
}

impl Bsp<Exact> {
    /// The tree that the library builds: no decision is ever wrong.
    pub fn exact(options: BuildOptions) -> Self {
        Self { name: "bsp exact".into(), options, kernel: Exact, is_exact: true }
    }
}

impl Bsp<Float<f64>> {
    /// With decisions in `f64`; vertices no further from a plane than `epsilon` times half the
    /// scene's extent count as on it.
    pub fn double(options: BuildOptions, epsilon: f64) -> Self {
        Self {
            name: format!("bsp f64 {epsilon:e}"),
            options,
            kernel: Float::new(epsilon),
            is_exact: false,
        }
    }
}

impl Bsp<Float<f32>> {
    /// With decisions in `f32`; vertices no further from a plane than `epsilon` times half the
    /// scene's extent count as on it.
    pub fn single(options: BuildOptions, epsilon: f64) -> Self {
        Self {
            name: format!("bsp f32 {epsilon:e}"),
            options,
            kernel: Float::new(epsilon),
            is_exact: false,
        }
    }
}

impl<K: Kernel> Method for Bsp<K> {
    fn name(&self) -> String {
        self.name.clone()
    }

    fn space(&self) -> Space {
        Space::Object
    }

    fn prepare<'a>(&'a self, faces: &'a Faces) -> Result<Box<dyn Prepared + 'a>, MethodError> {
        let (options, faces) = (&self.options, faces.clone());
        if self.is_exact {
            let tree = tree_of(options, &Tuning::DEFAULT, faces, Preparation::default())?;
            return Ok(Box::new(Ready { tree, order: Vec::new() }));
        }
        let tree = KernelTree::build(self.kernel, options, faces)?;
        Ok(Box::new(Ready { tree, order: Vec::new() }))
    }
}

/// A tree, and a list that is used again for each picture.
struct Ready<T> {
    tree: T,
    order: Vec<u32>,
}

impl<T> Ready<T> {
    fn order_bytes(&self) -> usize {
        self.order.capacity() * size_of::<u32>()
    }
}

impl Prepared for Ready<BspTree> {
    fn paint(&mut self, camera: &Camera, rays: &Rays) -> Result<Painted, MethodError> {
        let begin = Instant::now();
        self.tree.back_to_front_into(camera.viewpoint(), &mut self.order);
        let order: Duration = begin.elapsed();
        let image = paint_order(&self.tree, &self.order, rays);
        let (draw, pieces) = (begin.elapsed() - order, self.order.len());
        Ok(Painted { image, order, draw, pieces, removed: 0 })
    }

    fn bytes(&self) -> usize {
        self.tree.bytes() - self.tree.faces().bytes() + self.order_bytes()
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
        Some(accuracy(&KernelTree::from(&self.tree)))
    }
}

impl<K: Kernel> Prepared for Ready<KernelTree<K>> {
    fn paint(&mut self, camera: &Camera, rays: &Rays) -> Result<Painted, MethodError> {
        let begin = Instant::now();
        self.tree.back_to_front_into(camera.viewpoint(), &mut self.order);
        let order: Duration = begin.elapsed();
        let mut painter = Painter::new(rays, self.tree.faces(), Order::BackToFront);
        let mut vertices = Vec::new();
        for &fragment in &self.order {
            vertices.clear();
            vertices.extend(self.tree.lattice_vertices(fragment));
            let outline = match self.tree.is_whole(fragment) {
                true => Outline::Whole,
                false => Outline::Vertices(&vertices),
            };
            painter.draw(Piece { face: self.tree.face(fragment), outline });
        }
        let image = painter.finish();
        let (draw, pieces) = (begin.elapsed() - order, self.order.len());
        Ok(Painted { image, order, draw, pieces, removed: 0 })
    }

    fn bytes(&self) -> usize {
        self.tree.bytes() + self.order_bytes()
    }

    fn for_each_piece(&self, visit: &mut dyn FnMut(u32, &[[f64; 3]])) {
        let mut vertices = Vec::new();
        for fragment in 0..self.tree.len() as u32 {
            vertices.clear();
            vertices.extend(self.tree.lattice_vertices(fragment));
            visit(self.tree.face(fragment), &vertices);
        }
    }

    fn accuracy(&self) -> Option<Accuracy> {
        Some(accuracy(&self.tree))
    }
}
