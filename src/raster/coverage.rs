//! Decides the pixels that a piece of a face covers.
//!
//! A pixel is covered if its ray meets the piece: if the ray passes inside all lines that bound the piece. A
//! ray that meets a line exactly is treated as moved by an infinitesimal step, the same for all lines (see
//! [`Seen::tie`]; Edelsbrunner & Mücke, "Simulation of simplicity", 1990). So each pixel of a face is in
//! exactly one piece of the face. In the picture of a closed surface, no pixel is missed or covered twice
//! along the edge between two adjacent faces. The moved ray lies in no partition plane, not even in a plane
//! that contains the eye, so the piece that is nearer at the pixel is also later in a back-to-front order.
//! Faces seen exactly edge-on cover nothing.
//!
//! The functions of lines are in homogeneous coordinates, so that nothing is clipped at the eye:
//! Olano & Greer, "Triangle scan conversion using 2D homogeneous coordinates" (1997).

use std::ops::Range;

use smallvec::SmallVec;

use super::exact::Plane;
use super::line::{Boundary, Seen, Sheet, Source};
use super::rays::{Rays, Window};
use crate::exact::{EdgeLine, Faces, PlaneId};

/// The largest number of columns of a window in which every pixel is tested. In wider windows the lines first
/// narrow each row. Too small: the narrowing takes more time than the narrower windows save. Too large: more
/// pixels are tested.
const NARROW: u32 = 8;

/// A piece of a face, for drawing.
#[derive(Clone, Copy, Debug)]
pub struct Piece<'a> {
    /// The face.
    pub face: u32,
    /// The part of the face.
    pub outline: Outline<'a>,
}

/// The part of a face that a piece covers.
#[derive(Clone, Copy, Debug)]
pub enum Outline<'a> {
    /// The whole face.
    Whole,
    /// The part on the inner side of each of these lines; exact, however small the piece.
    Lines {
        /// The lines that bound the piece: edges of the face, and cuts.
        lines: &'a [EdgeLine],
        /// The piece's vertices in lattice units, each coordinate off by at most 2. These positions only
        /// limit the pixels to test.
        vertices: &'a [[f64; 3]],
    },
    /// The convex polygon of these vertices, in lattice units and in the face's orientation. The vertices are
    /// rounded to the lattice. This variant is for algorithms that do not store the lines.
    Vertices(&'a [[f64; 3]]),
}

/// A piece of a face, prepared to test pixels.
#[derive(Debug)]
pub(super) struct Coverage<'a> {
    pub(super) seen: Seen<'a>,
    pub(super) lines: SmallVec<[Boundary; 8]>,
    pub(super) window: Window,
}

impl<'a> Coverage<'a> {
    /// A piece's coverage; `None` if the piece covers nothing.
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
        // Where a ray meets the plane behind the eye, all sides are reversed. No point lies outside all edges
        // of a convex face, so the ray is not inside all edges. The lines of other pieces may also bound a
        // mirror image behind the eye, so rays must be restricted to the half-space ahead.
        if rays.is_perspective() && !matches!(outline, Outline::Whole) {
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
            // A pixel certainly outside one line is outside the piece, whatever the other lines.
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

    /// Calls `run` with the row and the columns of all covered pixels, row by row from the top.
    pub(super) fn for_each_run(&self, run: &mut impl FnMut(u32, Range<u32>)) {
        let columns = self.window.columns.clone();
        for y in self.window.rows.clone() {
            let (outer, inner) = if columns.len() > NARROW as usize {
                self.narrow(y)
            } else {
                (columns.clone(), columns.end..columns.end)
            };
            self.single(y, outer.start..inner.start.min(outer.end), run);
            if !inner.is_empty() {
                run(y, inner.clone());
            }
            self.single(y, inner.end.max(outer.start)..outer.end, run);
        }
    }

    fn single(&self, y: u32, columns: Range<u32>, run: &mut impl FnMut(u32, Range<u32>)) {
        let mut start = None;
        for x in columns.clone() {
            match (self.covers(x, y), start) {
                (true, None) => start = Some(x),
                (false, Some(first)) => {
                    run(y, first..x);
                    start = None;
                }
                _ => {}
            }
        }
        if let Some(first) = start {
            run(y, first..columns.end);
        }
    }

    /// Two ranges of columns of a row: no pixel outside the first range is covered, and every pixel inside
    /// the second range is covered. The second range lies inside the first range, or is empty and lies at the
    /// end of the first range.
    fn narrow(&self, y: u32) -> (Range<u32>, Range<u32>) {
        let Range { start, end } = self.window.columns;
        let (mut outer, mut inner) =
            ([f64::from(start), f64::from(end)], [f64::from(start), f64::from(end)]);
        for line in &self.lines {
            let [k0, kx, ky] = line.k;
            let value = k0 + f64::from(y) * ky;
            if kx == 0.0 || !kx.is_finite() || !value.is_finite() {
                if value < -line.bound && kx == 0.0 {
                    outer[1] = outer[0];
                } else if !(value > line.bound && kx == 0.0) {
                    inner[1] = inner[0];
                }
                continue;
            }
            // A margin of one pixel is more than the rounding error of the division and of the bound.
            let (zero, margin) = (-value / kx, line.bound / kx.abs() + 1.0);
            if kx > 0.0 {
                outer[0] = outer[0].max((zero - margin).floor());
                inner[0] = inner[0].max((zero + margin).ceil());
            } else {
                outer[1] = outer[1].min((zero + margin).ceil());
                inner[1] = inner[1].min((zero - margin).floor());
            }
        }
        let range = |[low, high]: [f64; 2]| {
            let bound = |c: f64| c.clamp(f64::from(start), f64::from(end)) as u32;
            bound(low)..bound(high)
        };
        let outer = range(outer);
        if outer.is_empty() {
            return (end..end, end..end);
        }
        let inner = range(inner);
        let inner = if inner.is_empty() { outer.end..outer.end } else { inner };
        (outer, inner)
    }
}

/// Coordinates of a rounded piece's vertices are clamped to this; larger coordinates would overflow the
/// integers.
const LARGEST: f64 = (1u64 << 51) as f64;

impl<'a> Seen<'a> {
    /// A face as seen by the rays; `None` if the rays are parallel to the face's plane, or if only fronts are
    /// visible and the rays see the back.
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

    /// The edge of the face from the face's corner `k` to the next corner.
    fn edge_source(&self, k: usize) -> Source {
        let corners = self.faces.corners(self.face);
        let ends = [corners[k], corners[if k + 1 == corners.len() { 0 } else { k + 1 }]];
        match self.faces.moved_axis(self.face) {
            None => Source::Edge(ends),
            Some(axis) => Source::Upright(ends, axis),
        }
    }
}
