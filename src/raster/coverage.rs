//! Decides which pixels a piece of a face covers.
//!
//! A pixel is covered if its ray meets the piece, which is so if it passes inside all lines that
//! bound the piece. A ray that meets a line exactly is treated as moved by an infinitesimal step, the
//! same for all lines (see [`Seen::tie`]; Edelsbrunner & Mücke, "Simulation of simplicity", 1990). So
//! the pieces of a face tile it, and the faces of a closed surface tile its picture: no pixel is left
//! out, none is covered twice. The moved ray lies in no partition plane, not even in one that
//! contains the eye, so the piece that is nearer at the pixel is also later in a back-to-front order.
//! Faces seen exactly edge-on cover nothing.
//!
//! The functions of lines are in homogeneous coordinates, so that nothing is clipped at the eye:
//! Olano & Greer, "Triangle scan conversion using 2D homogeneous coordinates" (1997).

use smallvec::SmallVec;

use super::bounds::Window;
use super::exact::Plane;
use super::line::{Boundary, Seen, Source};
use super::piece::Outline;
use super::rays::Rays;
use super::sheet::Sheet;
use crate::exact::{Faces, PlaneId};

/// A piece of a face, prepared to test pixels.
#[derive(Debug)]
pub(super) struct Coverage<'a> {
    pub(super) seen: Seen<'a>,
    pub(super) lines: SmallVec<[Boundary; 8]>,
    pub(super) window: Window,
}

impl<'a> Coverage<'a> {
    /// A piece's coverage; `None` if it covers nothing.
    pub(super) fn new(
        rays: &'a Rays,
        faces: &'a Faces,
        face: u32,
        outline: Outline<'_>,
    ) -> Option<Self> {
        let corners = faces.corners(face);
        let window = rays.window(match outline {
            Outline::Whole => corners,
            Outline::Lines { vertices, .. } | Outline::Vertices(vertices) => vertices,
        })?;
        let seen = Seen::new(rays, faces, face)?;
        let mut lines: SmallVec<[Boundary; 8]> = SmallVec::new();
        let mut add = |source| lines.push(seen.boundary(source));
        match outline {
            Outline::Whole => (0..corners.len()).for_each(|k| add(seen.edge_source(k))),
            Outline::Lines { lines, .. } => lines.iter().for_each(|&line| {
                add(match line.as_edge() {
                    Some(k) => seen.edge_source(k as usize),
                    None => Source::Cut(line),
                });
            }),
            Outline::Vertices(vertices) => {
                let snap = |v: [f64; 3]| v.map(|c| c.round().clamp(-LARGEST, LARGEST));
                for (k, &vertex) in vertices.iter().enumerate() {
                    let next = vertices[if k + 1 == vertices.len() { 0 } else { k + 1 }];
                    add(Source::Edge([snap(vertex), snap(next)]));
                }
            }
        }
        // The edges of a planar face are planes through the eye that bound a cone in front of it.
        // The lines of other pieces may also bound a mirror image of the piece behind the eye, so
        // rays must be restricted to the half-space ahead.
        let whole = matches!(outline, Outline::Whole);
        let cone = whole && faces.upright_axis(face).is_none();
        if rays.is_perspective() && !cone {
            add(Source::Ahead);
        }
        Some(Self { seen, lines, window })
    }

    /// Whether a pixel is covered.
    #[inline]
    pub(super) fn covers(&self, x: u32, y: u32) -> bool {
        let (column, row) = (f64::from(x), f64::from(y));
        let mut certain = true;
        for line in &self.lines {
            let [k0, kx, ky] = line.k;
            // Certainly outside one line is outside the piece, whatever the other lines say.
            let value = k0 + row * ky + column * kx;
            if value < -line.bound {
                return false;
            }
            certain &= value > line.bound;
        }
        certain || self.covers_exactly(x, y)
    }

    #[cold]
    fn covers_exactly(&self, x: u32, y: u32) -> bool {
        self.lines.iter().all(|line| {
            let side = self.seen.exact(line.source, x, y);
            side.is_gt() || side.is_eq() && self.seen.tie(line.source).is_gt()
        })
    }
}

/// Coordinates of a rounded piece's vertices are limited to this; beyond, the integers overflow.
const LARGEST: f64 = (1u64 << 51) as f64;

impl<'a> Seen<'a> {
    /// A face as the rays see it; `None` if they run along it, or see its back and only fronts are
    /// to be seen.
    pub(super) fn new(rays: &'a Rays, faces: &'a Faces, face: u32) -> Option<Self> {
        let sheet = Sheet::new(rays, faces, PlaneId::face(face));
        let side =
            sheet.certain_side().unwrap_or_else(|| Plane::of(faces, face).kappa(rays).sign());
        let positive = side.is_gt();
        let front = positive == rays.is_perspective();
        if side.is_eq() || rays.front_only && !front {
            return None;
        }
        Some(Self { rays, faces, face, sheet, positive })
    }

    /// The edge of the face from its corner `k` to the next.
    fn edge_source(&self, k: usize) -> Source {
        let corners = self.faces.corners(self.face);
        let ends = [corners[k], corners[if k + 1 == corners.len() { 0 } else { k + 1 }]];
        match self.faces.upright_axis(self.face) {
            None => Source::Edge(ends),
            Some(axis) => Source::Upright(ends, axis),
        }
    }
}
