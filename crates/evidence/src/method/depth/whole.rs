//! A whole picture, at once or section by section.

use std::ops::Range;
use std::sync::Mutex;
use std::sync::atomic::{AtomicU32, Ordering};

use super::super::clip::Range as Depths;
use super::super::space::CameraSpace;
use super::format::{Interpolation, Scale};
use super::frame::Frame;
use super::options::{DepthBuffer, Sections};
use super::pass::Pass;
use super::rules::Comparison;
use super::{integer_edges, scanline, trapezoids, walk};
use crate::Precision;
use binspace::internals::Faces;
use binspace::raster::Rays;

/// The common state of all sections of a picture.
pub(super) struct Whole<'a> {
    pub(super) method: &'a DepthBuffer,
    pub(super) space: CameraSpace,
    pub(super) range: Depths,
    pub(super) faces: &'a Faces,
    pub(super) rays: &'a Rays,
}

impl Whole<'_> {
    /// Draws all faces, and returns the numbers of visible faces and of drawn pixels.
    ///
    /// No section depends on another, and each has its own rows in `faces`. The picture is the same for any
    /// number of rows and threads.
    pub(super) fn draw<P: Precision>(
        &self,
        faces: &mut [u32],
        keys: &mut Vec<Vec<u32>>,
    ) -> (usize, u64) {
        let [width, height] = self.space.size;
        let Some(Sections { rows, threads }) = self.method.sections else {
            keys.resize_with(1, Vec::new);
            return self.section::<P>(0..height, faces, &mut keys[0]);
        };
        let rows = rows.max(1);
        keys.resize_with(threads.max(1), Vec::new);
        let parts: Vec<_> =
            faces.chunks_mut(width as usize * rows as usize).map(Mutex::new).collect();
        let next = AtomicU32::new(0);
        let run = |keys: &mut Vec<u32>| {
            let (mut most, mut all) = (0, 0);
            loop {
                let number = next.fetch_add(1, Ordering::Relaxed);
                let Some(part) = parts.get(number as usize) else { return (most, all) };
                let first = number * rows;
                let mut part = part.lock().expect("no thread panics");
                let section = first..(first + rows).min(height);
                let (pieces, drawn) = self.section::<P>(section, &mut part, keys);
                (most, all) = (most.max(pieces), all + drawn);
            }
        };
        std::thread::scope(|scope| {
            let started: Vec<_> = keys.iter_mut().map(|keys| scope.spawn(|| run(keys))).collect();
            let ended = started.into_iter().map(|thread| thread.join().expect("no thread panics"));
            ended.fold((0, 0), |(most, all), (pieces, drawn)| (most.max(pieces), all + drawn))
        })
    }

    /// Draws some rows, and writes the faces of their pixels to `faces`.
    fn section<P: Precision>(
        &self,
        rows: Range<u32>,
        faces: &mut [u32],
        keys: &mut Vec<u32>,
    ) -> (usize, u64) {
        let Self { method, space, range, .. } = *self;
        let scale = Scale::<P>::new(method.format, range, space.perspective);
        let comparison = Comparison::new(method.rules, scale.ends());
        let frame = Frame::new(space.size[0], rows.clone(), comparison, std::mem::take(keys));
        let rays = &self.rays.rows(rows);
        let mut pass = Pass { space, range, scale, faces: self.faces, rays, frame };
        let pieces = match method.interpolation {
            Interpolation::EdgeFunctions => pass.by_edge_functions(0..self.faces.len() as u32),
            Interpolation::Incremental => walk::draw(&mut pass, &mut scanline::Walk::default()),
            Interpolation::Trapezoids => walk::draw(&mut pass, &mut trapezoids::Walk),
            Interpolation::IntegerEdges => walk::draw(&mut pass, &mut integer_edges::Walk),
        };
        let (shown, drawn, used) = pass.frame.finish();
        faces.copy_from_slice(&shown);
        *keys = used;
        (pieces, drawn)
    }
}
