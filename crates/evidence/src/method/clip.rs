//! The part of a polygon that a picture can show.

use glam::DVec3;

use super::space::{CameraSpace, Vertex};
use binspace::internals::Faces;

/// A range of depths. Everything nearer or further is cut off.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Range {
    pub(super) near: f64,
    pub(super) far: f64,
}

impl Range {
    /// Everything in front of the eye. Parts of polygons that are nearer to the eye's plane than 2⁻⁴⁴ of the
    /// scene's furthest depth are cut off. Too large: polygons near the eye go missing. Too small:
    /// coordinates on the picture lose their digits.
    ///
    /// `None` if nothing is in front of the eye.
    pub(super) fn ahead(space: &CameraSpace, faces: &Faces) -> Option<Self> {
        let mut range = Self { near: f64::INFINITY, far: f64::NEG_INFINITY };
        for face in 0..faces.len() as u32 {
            for &corner in faces.corners(face) {
                range.include(space.place(corner).z);
            }
        }
        if space.perspective {
            range.near = range.near.max(range.far * 2f64.powi(-44));
            (range.far > 0.0).then_some(range)
        } else {
            (range.far >= range.near).then_some(range)
        }
    }

    pub(super) fn include(&mut self, depth: f64) {
        self.near = self.near.min(depth);
        self.far = self.far.max(depth);
    }
}

/// Clips convex polygons to the space that a picture shows (Sutherland & Hodgman 1974), in `f64`.
#[derive(Clone, Debug)]
pub(super) struct Clipper {
    /// Inside is where normal · place + offset is not negative.
    planes: [(DVec3, f64); 6],
    kept: Vec<Vertex>,
    spare: Vec<Vertex>,
}

/// The margin kept beyond the sides of the picture, in pixels, so that the cuts cross no pixel's centre.
const MARGIN: f64 = 1.0;

impl Clipper {
    pub(super) fn new(space: &CameraSpace, range: Range) -> Self {
        let [x, y] = space.size.map(|c| (0.5 * f64::from(c) + MARGIN) * space.pixel);
        let side = |normal: DVec3, half: f64| {
            if space.perspective { (normal + DVec3::Z * half, 0.0) } else { (normal, half) }
        };
        let planes = [
            (DVec3::Z, -range.near),
            (DVec3::NEG_Z, range.far),
            side(DVec3::X, x),
            side(DVec3::NEG_X, x),
            side(DVec3::Y, y),
            side(DVec3::NEG_Y, y),
        ];
        Self { planes, kept: Vec::new(), spare: Vec::new() }
    }

    /// The part of a polygon inside; an empty list if there is none.
    pub(super) fn clip(&mut self, corners: impl IntoIterator<Item = Vertex>) -> &[Vertex] {
        self.kept.clear();
        self.kept.extend(corners);
        for plane in self.planes {
            let inside = |vertex: &Vertex| plane.0.dot(vertex.at) + plane.1;
            if self.kept.iter().all(|vertex| inside(vertex) >= 0.0) {
                continue;
            }
            self.spare.clear();
            keep(&self.kept, inside, &mut self.spare);
            std::mem::swap(&mut self.kept, &mut self.spare);
        }
        if self.kept.len() < 3 {
            self.kept.clear();
        }
        &self.kept
    }

    /// The part of a face inside.
    pub(super) fn clip_face(&mut self, space: &CameraSpace, faces: &Faces, face: u32) -> &[Vertex] {
        self.clip(faces.corners(face).iter().map(|&corner| space.vertex(corner)))
    }
}

/// The part of a convex polygon where `inside` is not negative.
fn keep(polygon: &[Vertex], inside: impl Fn(&Vertex) -> f64, kept: &mut Vec<Vertex>) {
    for (i, here) in polygon.iter().enumerate() {
        let next = &polygon[if i + 1 == polygon.len() { 0 } else { i + 1 }];
        let (a, b) = (inside(here), inside(next));
        if a >= 0.0 {
            kept.push(*here);
        }
        // Computed from the inner end, whatever the direction of the edge: so neighbours get the same vertex.
        if a > 0.0 && b < 0.0 {
            kept.push(Vertex::between(here, next, a / (a - b)));
        } else if a < 0.0 && b > 0.0 {
            kept.push(Vertex::between(next, here, b / (b - a)));
        }
    }
}
