//! The painter's algorithm with one depth per face.

use std::time::Instant;

use super::front_faces::shown;
use super::space::CameraSpace;
use super::{Method, MethodError, Painted, Prepared, Space};
use binspace::internals::Faces;
use binspace::raster::{Outline, Painter, Piece, Rays};
use binspace::view::Camera;

/// Paints faces in the order of the depths of their centroids, the means of their corners, the furthest
/// first. Most programs for plots and vector graphics do this.
///
/// Depth is measured along the camera's direction of view. Nothing is split, so faces that overlap in depth
/// may be in the wrong order. If two faces have the same depth, the later one is painted later.
#[derive(Clone, Copy, Debug, Default)]
pub struct Centroid;

impl Method for Centroid {
    fn name(&self) -> String {
        "centroid".into()
    }

    fn space(&self) -> Space {
        Space::Both
    }

    fn prepare<'a>(&'a self, faces: &'a Faces) -> Result<Box<dyn Prepared + 'a>, MethodError> {
        Ok(Box::new(Ready { faces, centroids: centroids(faces), keys: Vec::new() }))
    }
}

/// Returns all faces in the order that [`Centroid`] paints them in.
pub fn centroid_order(faces: &Faces, camera: &Camera) -> Vec<u32> {
    let mut keys = Vec::new();
    sort(&centroids(faces), &CameraSpace::new(camera, faces.lattice()), &|_| true, &mut keys);
    keys.into_iter().map(|(_, face)| face).collect()
}

fn centroids(faces: &Faces) -> Vec<[f64; 3]> {
    let centroid = |face| {
        let corners = faces.corners(face);
        std::array::from_fn(|i| corners.iter().map(|c| c[i]).sum::<f64>() / corners.len() as f64)
    };
    (0..faces.len() as u32).map(centroid).collect()
}

/// Sorts the shown faces by their depths, the furthest first.
fn sort(
    centroids: &[[f64; 3]],
    space: &CameraSpace,
    is_shown: &dyn Fn(u32) -> bool,
    keys: &mut Vec<(f64, u32)>,
) {
    keys.clear();
    let depths = centroids.iter().map(|&centroid| space.place(centroid).z);
    keys.extend(depths.zip(0..).filter(|&(_, face)| is_shown(face)));
    keys.sort_unstable_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
}

struct Ready<'a> {
    faces: &'a Faces,
    centroids: Vec<[f64; 3]>,
    /// Depths, each with its face.
    keys: Vec<(f64, u32)>,
}

impl Prepared for Ready<'_> {
    fn paint(&mut self, camera: &Camera, rays: &Rays) -> Result<Painted, MethodError> {
        let begin = Instant::now();
        let space = CameraSpace::new(camera, self.faces.lattice());
        sort(&self.centroids, &space, &shown(rays, self.faces), &mut self.keys);
        let order = begin.elapsed();
        let mut painter = Painter::new(rays, self.faces);
        for &(_, face) in &self.keys {
            painter.draw(Piece { face, outline: Outline::Whole });
        }
        let (image, pieces) = (painter.finish(), self.keys.len());
        Ok(Painted { image, order, draw: begin.elapsed() - order, pieces, removed: 0 })
    }

    fn bytes(&self) -> usize {
        size_of_val(&*self.centroids) + self.keys.capacity() * size_of::<(f64, u32)>()
    }
}
