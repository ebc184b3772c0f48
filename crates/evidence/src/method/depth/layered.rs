//! Opaque polygons by depth, and translucent polygons over them in an order.

use super::super::MethodError;
use super::super::clip::{Clipper, Range};
use super::super::space::CameraSpace;
use super::format::Scale;
use super::frame::Frame;
use super::pass::Pass;
use super::rules::Comparison;
use super::{DepthBuffer, range};
use crate::Precision;
use binspace::BspTree;
use binspace::raster::{NONE, Outline, Piece, Rays};
use binspace::view::Camera;

/// The visible polygons of each pixel, row by row from the top left. In a pixel, the opaque polygon comes
/// first, if there is one. Then come all translucent polygons that passed the depth test, in the order in
/// which they were drawn.
pub type Layers = Vec<Vec<u32>>;

/// A picture of opaque and translucent polygons.
#[derive(Clone, Copy, Debug)]
pub struct Layered<'a> {
    /// The depth buffer. Its rule `writes` applies to the opaque polygons.
    pub buffer: DepthBuffer,
    /// The polygons, and the order of their fragments.
    pub tree: &'a BspTree,
    /// The camera.
    pub camera: &'a Camera,
    /// The camera's rays through the tree's faces.
    pub rays: &'a Rays,
    /// Which polygons are opaque, by number.
    pub opaque: &'a [bool],
    /// Whether translucent polygons write their depths; they should not.
    pub writes: bool,
}

impl Layered<'_> {
    /// Draws the opaque polygons by depth. Then draws the fragments of the translucent polygons in the given
    /// order, each where it passes the depth test.
    ///
    /// # Errors
    ///
    /// If the buffer's near and far planes do not suit the camera.
    pub fn draw(&self, order: &[u32]) -> Result<Layers, MethodError> {
        if self.buffer.format.is_float() {
            self.draw_in::<f32>(order)
        } else {
            self.draw_in::<f64>(order)
        }
    }

    fn draw_in<P: Precision>(&self, order: &[u32]) -> Result<Layers, MethodError> {
        let (buffer, faces) = (&self.buffer, self.tree.faces());
        let space = CameraSpace::new(self.camera, faces.lattice());
        let [width, height] = space.size;
        let mut layers = vec![Vec::new(); width as usize * height as usize];
        let Some(range) = range::of([buffer.near, buffer.far], &space, faces)? else {
            return Ok(layers);
        };
        let scale = Scale::<P>::new(buffer.format, range, space.perspective);
        let comparison = Comparison::new(buffer.rules, scale.ends());
        let frame = Frame::new(width, 0..height, comparison, Vec::new());
        let mut pass = Pass { space, range, scale, faces, rays: self.rays, frame };
        let is_opaque = |face: u32| self.opaque[faces.polygon(face)];
        pass.by_edge_functions((0..faces.len() as u32).filter(|&face| is_opaque(face)));
        for (list, &face) in layers.iter_mut().zip(pass.frame.faces()) {
            list.extend((face != NONE).then(|| faces.polygon(face) as u32));
        }
        self.add_fragments(&mut pass, range, order, &mut layers);
        Ok(layers)
    }

    fn add_fragments<P: Precision>(
        &self,
        pass: &mut Pass<'_, P>,
        range: Range,
        order: &[u32],
        layers: &mut Layers,
    ) {
        let width = pass.frame.width();
        let mut clipper = Clipper::new(&pass.space, range);
        for fragment in order.iter().map(|&index| self.tree.fragment(index)) {
            if self.opaque[fragment.polygon()] {
                continue;
            }
            let lines: Vec<_> = fragment.lines().collect();
            let vertices: Vec<_> = fragment.lattice_vertices().collect();
            let outline = Outline::Lines { lines: &lines, vertices: &vertices };
            let piece = Piece { face: fragment.face(), outline };
            pass.test(&mut clipper, piece, self.writes, |x, y| {
                layers[(y * width + x) as usize].push(fragment.polygon() as u32);
            });
        }
    }
}
