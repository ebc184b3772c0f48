//! Colours and texture coordinates in a painter's picture.

use super::depth::gradient::{Gradient, Sample};
use super::space::CameraSpace;
use binspace::BspTree;
use binspace::raster::{Outline, Piece, Rays, for_each_run};
use binspace::view::Camera;

/// The interpolation of attributes from the vertices of a piece to the pixels within it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Across {
    /// As linear functions on the picture. This is right only for pieces perpendicular to the direction of
    /// view. On other pieces, straight patterns look bent, and do not fit together at splits.
    Picture,
    /// As linear functions on the polygon (Heckbert & Moreton 1991): attribute / w and 1 / w are
    /// linear on the picture, and their quotient is the attribute.
    Polygon,
}

/// Paints a tree from back to front, and returns the attributes of the visible polygon in each pixel, row by
/// row from the top left; `None` for an empty pixel.
///
/// `attributes` are the attributes of each polygon's corners. Vertices made by cuts interpolate them with
/// their [weights](binspace::Fragment::weights) over the corners. The polygons must be ahead of a perspective
/// camera.
pub fn paint_attributes<const N: usize>(
    tree: &BspTree,
    camera: &Camera,
    rays: &Rays,
    attributes: &[Vec<[f64; N]>],
    across: Across,
) -> Vec<Option<[f64; N]>> {
    let space = CameraSpace::new(camera, tree.faces().lattice());
    let width = space.size[0] as usize;
    let mut shown = vec![None; width * space.size[1] as usize];
    let mut order = Vec::new();
    tree.back_to_front_into(camera.viewpoint(), &mut order);
    for fragment in order.into_iter().map(|index| tree.fragment(index)) {
        let lines: Vec<_> = fragment.lines().collect();
        let vertices: Vec<_> = fragment.lattice_vertices().collect();
        let corners = &attributes[fragment.polygon()];
        let mut samples: [Vec<Sample>; N] = std::array::from_fn(|_| Vec::new());
        let mut nearness: Vec<Sample> = Vec::new();
        for (&vertex, weights) in vertices.iter().zip(fragment.weights()) {
            let at = space.place(vertex);
            let [x, y] = space.project(at);
            let near =
                if across == Across::Polygon && space.perspective { 1.0 / at.z } else { 1.0 };
            nearness.push(Sample { x, y, value: near });
            for (n, samples) in samples.iter_mut().enumerate() {
                let value: f64 = weights.iter().map(|&(k, w)| w * corners[k as usize][n]).sum();
                samples.push(Sample { x, y, value: value * near });
            }
        }
        let nearness = Gradient::<f64>::new(&nearness);
        let values = samples.map(|samples| Gradient::<f64>::new(&samples));
        let outline = Outline::Lines { lines: &lines, vertices: &vertices };
        let piece = Piece { face: fragment.face(), outline };
        for_each_run(rays, tree.faces(), piece, |y, columns| {
            let at = |gradient: &Gradient<f64>, x| gradient.at(gradient.row(y), x);
            for x in columns {
                let near = at(&nearness, x);
                let found = values.each_ref().map(|gradient| at(gradient, x) / near);
                shown[y as usize * width + x as usize] = Some(found);
            }
        });
    }
    shown
}
