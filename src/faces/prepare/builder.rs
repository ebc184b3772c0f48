//! Makes faces of polygons, one after the other.

use std::ops::Range;

use glam::DVec3;
use smallvec::SmallVec;

use super::collect::Collected;
use super::corners::Corners;
use super::lattice_and_tolerance::Ground;
use super::preparation::Preparation;
use super::quad::Quad;
use crate::Error;
use crate::exact::faces::{Frame, INNER};
use crate::exact::{Faces, Plane, cross};
use crate::faces::triangulate;
use crate::memory::reserve;
use crate::progress::{PIECES_AT_ONCE, Watch};

/// What became of a polygon.
enum Outcome {
    /// One face, with a corner so far off the plane of the others, in lattice units.
    Whole {
        off: f64,
    },
    /// Triangles; of a convex polygon, a corner is so far off the plane of the others.
    Triangulated {
        crosses_itself: bool,
        off: f64,
    },
    Dropped,
}

/// Makes faces of polygons, one after the other.
#[derive(Debug, Default)]
pub(super) struct FaceBuilder {
    pub(super) faces: Faces,
    /// The corners of the current polygon.
    pub(super) corners: Corners,
}

impl FaceBuilder {
    pub(super) fn new(ground: &Ground) -> Self {
        let Ground { lattice, tolerance, .. } = *ground;
        let faces = Faces { lattice, tolerance, ..Faces::default() };
        Self { faces, ..Self::default() }
    }

    /// Adds a range of the input's polygons.
    pub(super) fn add_all(
        &mut self,
        ground: &Ground,
        input: &Collected,
        polygons: Range<usize>,
        watch: &Watch<'_>,
    ) -> Result<Preparation, Error> {
        let snap = |point| ground.lattice.snap(point);
        let mut report = Preparation::default();
        for polygon in polygons {
            report.polygons += 1;
            let points = input.polygon(polygon);
            if let &[a, b, c, d] = points
                && let Some(quad) = Quad::of([snap(a), snap(b), snap(c), snap(d)])
                && let Some(off) = quad.push(polygon, &mut self.faces, ground.bend)?
            {
                report.flattened += usize::from(off > 0.0);
                report.flattened_by = report.flattened_by.max(off);
                continue;
            }
            match self.add(polygon, points, ground.bend, watch)? {
                Outcome::Whole { off } => {
                    report.flattened += usize::from(off > 0.0);
                    report.flattened_by = report.flattened_by.max(off);
                }
                Outcome::Triangulated { crosses_itself, off } => {
                    report.triangulated += 1;
                    report.crossing += usize::from(crosses_itself);
                    if ground.may_be_rounding(off, input.precision_of(polygon)) {
                        report.bent += 1;
                        report.bent_by = report.bent_by.max(off);
                    }
                }
                Outcome::Dropped => report.dropped += 1,
            }
        }
        Ok(report)
    }

    fn add(
        &mut self,
        polygon: usize,
        points: &[DVec3],
        bend: f64,
        watch: &Watch<'_>,
    ) -> Result<Outcome, Error> {
        watch.work(points.len())?;
        self.corners.keep_distinct(points, &self.faces.lattice);
        let Some(widest) = self.corners.widest_triangle() else {
            return Ok(Outcome::Dropped);
        };
        if self.corners.kept.len() == 3 {
            self.push(polygon, 0..3, Frame::TRIANGLE)?;
            return Ok(Outcome::Whole { off: 0.0 });
        }
        let plane = Plane::through([0, widest[0], widest[1]].map(|k| self.corners.kept[k].0));
        let axis = plane.main_axis();
        let convex = self.corners.is_convex(axis);
        let mut off = 0.0;
        if convex && self.corners.kept.len() <= Frame::MAX_CORNERS {
            off = self.push_flat(polygon, widest, axis)?;
            if off <= bend {
                return Ok(Outcome::Whole { off });
            }
            self.faces.truncate(self.faces.len() - 1);
        } else if convex {
            off = self.corners.off_plane(&plane, [0, widest[0], widest[1]]);
        }
        let crosses_itself = self.triangulate(polygon, convex, &plane, watch)?;
        Ok(crosses_itself.map_or(Outcome::Dropped, |crosses_itself| Outcome::Triangulated {
            crosses_itself,
            off,
        }))
    }

    /// Adds the polygon as one face, with its corners moved along an axis onto its plane, and gives how
    /// far the furthest was off it.
    fn push_flat(
        &mut self,
        polygon: usize,
        [second, third]: [usize; 2],
        axis: usize,
    ) -> Result<f64, Error> {
        reserve(&mut self.faces.moved, self.corners.kept.len())?;
        self.push(polygon, 0..self.corners.kept.len(), Frame::new(second, third, None))?;
        let off = self.faces.flatten_last(axis);
        if off > 0.0
            && let Some(face) = self.faces.faces.last_mut()
        {
            face.frame = Frame::new(second, third, Some(axis));
        }
        Ok(off)
    }

    /// Adds triangles in place of a polygon; tells whether it crosses itself, or nothing if there
    /// are no triangles with area.
    fn triangulate(
        &mut self,
        polygon: usize,
        convex: bool,
        plane: &Plane,
        watch: &Watch<'_>,
    ) -> Result<Option<bool>, Error> {
        let corners: Vec<_> = self.corners.kept.iter().map(|&(point, _)| point).collect();
        let found = if convex {
            triangulate::convex(&corners)
        } else {
            triangulate::any(&corners, plane, watch)?
        };
        self.corners.find_runs();
        let before = self.faces.len();
        for some in found.triangles.chunks(PIECES_AT_ONCE) {
            watch.work(some.len())?;
            for triple in some {
                let triple = triple.map(|k| k as usize);
                let [p, q, r] = triple.map(|k| corners[k]);
                if cross(p, q, r) != [0; 3] {
                    self.push(polygon, triple.into_iter(), Frame::TRIANGLE)?;
                }
            }
        }
        Ok((self.faces.len() > before).then_some(found.crosses_itself))
    }

    /// Adds a face made of some of the polygon's kept corners, in order around it.
    fn push(
        &mut self,
        polygon: usize,
        kept: impl ExactSizeIterator<Item = usize> + Clone,
        frame: Frame,
    ) -> Result<(), Error> {
        let corners = kept.clone().map(|k| self.corners.kept[k].0);
        self.faces.push(polygon, corners, frame)?;
        // Most polygons become one face with the same corners, which needs no numbers.
        if kept.len() < self.corners.given {
            self.number_last(kept)?;
        }
        Ok(())
    }

    /// Numbers the corners of the last face, if they are not the first of the polygon in order, with
    /// its edges for edges.
    fn number_last(
        &mut self,
        kept: impl ExactSizeIterator<Item = usize> + Clone,
    ) -> Result<(), Error> {
        let Some(first) = kept.clone().next() else { return Ok(()) };
        let number = |(from, to): (usize, usize)| {
            self.corners.kept[from].1 | if self.corners.is_outline(from, to) { 0 } else { INNER }
        };
        let ends = kept.clone().skip(1).chain([first]);
        let numbers = kept.clone().zip(ends).map(number);
        if (0..).zip(numbers.clone()).all(|(k, number)| number == k) {
            return Ok(());
        }
        let numbers: SmallVec<[u32; 8]> = numbers.collect();
        let faces = &mut self.faces;
        reserve(&mut faces.numbered, 1)?;
        reserve(&mut faces.numbers, kept.len())?;
        faces.numbered.push((faces.faces.len() as u32 - 1, faces.numbers.len() as u32));
        faces.numbers.extend(numbers);
        Ok(())
    }
}
