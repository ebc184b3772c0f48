//! BSP trees as methods: the library's tree, and trees of rounded numbers.

use std::time::{Duration, Instant};

use super::{Method, MethodError, Painted, Prepared, Space};
use crate::{Accuracy, Tree, accuracy};
use binspace::internals::{Faces, Tuning, tree_of};
use binspace::paint::paint_order;
use binspace::raster::{Outline, Painter, Piece, Rays};
use binspace::view::Camera;
use binspace::{BspTree, BuildOptions, Preparation};

/// A BSP tree (Fuchs, Kedem & Naylor 1980).
///
/// Fragments of the exact tree are bounded by their lines; fragments of rounded trees are bounded by their
/// rounded vertices.
#[derive(Clone, Debug)]
pub struct Bsp {
    options: BuildOptions,
    arithmetic: Arithmetic,
}

#[derive(Clone, Copy, Debug)]
enum Arithmetic {
    Exact,
    /// A tree of `f64` with this epsilon, a share of half the scene's extent.
    Double(f64),
    Single(f64),
}

impl Bsp {
    /// Creates the library's tree: no decision is ever wrong. The tolerance is the faces' tolerance.
    pub fn exact(options: BuildOptions) -> Self {
        Self { options, arithmetic: Arithmetic::Exact }
    }

    /// Creates a tree of `f64`; see [`Tree::with_epsilon`]. Of the options, only the budget of fragments is
    /// used.
    pub fn double(options: BuildOptions, epsilon: f64) -> Self {
        Self { options, arithmetic: Arithmetic::Double(epsilon) }
    }

    /// Creates a tree of `f32`; otherwise as [`double`](Self::double).
    pub fn single(options: BuildOptions, epsilon: f64) -> Self {
        Self { options, arithmetic: Arithmetic::Single(epsilon) }
    }
}

impl Method for Bsp {
    fn name(&self) -> String {
        match self.arithmetic {
            Arithmetic::Exact => "bsp exact".into(),
            Arithmetic::Double(epsilon) => format!("bsp f64 {epsilon:e}"),
            Arithmetic::Single(epsilon) => format!("bsp f32 {epsilon:e}"),
        }
    }

    fn space(&self) -> Space {
        Space::Object
    }

    fn prepare<'a>(&'a self, faces: &'a Faces) -> Result<Box<dyn Prepared + 'a>, MethodError> {
        let (options, faces) = (&self.options, faces.clone());
        let limit = options.max_fragments;
        let tree = match self.arithmetic {
            Arithmetic::Exact => {
                let tree = tree_of(options, &Tuning::DEFAULT, faces, Preparation::default())?;
                return Ok(Box::new(Ready { tree, order: Vec::new() }));
            }
            Arithmetic::Double(epsilon) => Tree::with_epsilon::<f64>(faces, epsilon, limit),
            Arithmetic::Single(epsilon) => Tree::with_epsilon::<f32>(faces, epsilon, limit),
        };
        let tree = tree.ok_or(MethodError::pieces(limit))?;
        Ok(Box::new(Ready { tree, order: Vec::new() }))
    }
}

/// A tree, and a list that each picture reuses.
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
        self.tree.memory_usage() - self.tree.faces().memory_usage() + self.order_bytes()
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
        Some(accuracy(&Tree::from(&self.tree)))
    }
}

impl Prepared for Ready<Tree> {
    fn paint(&mut self, camera: &Camera, rays: &Rays) -> Result<Painted, MethodError> {
        let begin = Instant::now();
        self.tree.back_to_front_into(camera.viewpoint(), &mut self.order);
        let order: Duration = begin.elapsed();
        let mut painter = Painter::new(rays, self.tree.faces());
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
