//! Decides what becomes of each input polygon: one face, triangles, or nothing.

mod append;
mod builder;
mod collect;
mod corners;
mod lattice_and_tolerance;
mod lists;
mod preparation;
mod quad;
mod thin;

use glam::DVec3;

use builder::FaceBuilder;
use collect::Collected;
use lattice_and_tolerance::Ground;
pub use lattice_and_tolerance::{DEFAULT_TOLERANCE, Tolerance};
pub(crate) use lattice_and_tolerance::{Precision, empty_faces};
pub use preparation::Preparation;

use crate::Error;
use crate::exact::{Faces, Lattice};
use crate::input::Polygon;
use crate::memory::reserve;
use crate::parallel_map;
use crate::progress::Watch;

/// Polygons that one thread prepares as one job. Smaller: overhead per job; larger: threads wait
/// for each other.
const POLYGONS_A_THREAD: usize = 1024;
/// Polygons that are prepared before the jobs' faces are put together and a cancel is noticed.
/// Smaller: threads wait for each other; larger: a cancel takes longer, and more memory is used.
const POLYGONS_AT_ONCE: usize = 16 * POLYGONS_A_THREAD;

impl Faces {
    /// Prepares polygons: turns them into convex planar faces.
    ///
    /// Instead of a [`Tolerance`], a length may be given, or `None` for the default.
    ///
    /// # Errors
    ///
    /// If a coordinate is not finite, the tolerance is negative or NaN, a polygon has more than
    /// 2²² corners, there are more than 2²⁸ polygons or corners in total, or memory
    /// runs out.
    pub fn new<P: Polygon>(
        polygons: impl IntoIterator<Item = P>,
        tolerance: impl Into<Tolerance>,
    ) -> Result<(Self, Preparation), Error> {
        let mut faces = Self::default();
        let report = Preparer::default().prepare(
            &mut faces,
            polygons,
            tolerance.into(),
            usize::MAX,
            &Watch::default(),
        )?;
        faces.shrink_to_fit();
        Ok((faces, report))
    }
}

/// Prepares polygons; its lists are kept to be used again.
#[derive(Debug, Default)]
pub(crate) struct Preparer {
    input: Collected,
    builder: FaceBuilder,
    /// What the lattice has to hold besides the polygons.
    room: Option<[DVec3; 2]>,
    /// Whether all polygons are flat by definition.
    pub(crate) are_flat: bool,
}

impl Preparer {
    /// Replaces faces by those of some polygons, as [`Faces::new`] does, with a limit on the number of
    /// polygons, and with a watch. After an error there is no face.
    pub(crate) fn prepare<P: Polygon>(
        &mut self,
        faces: &mut Faces,
        polygons: impl IntoIterator<Item = P>,
        tolerance: Tolerance,
        limit: usize,
        watch: &Watch<'_>,
    ) -> Result<Preparation, Error> {
        let mut kept = std::mem::take(faces);
        kept.clear();
        tolerance.check()?;
        self.input.read(polygons, limit, watch)?;
        let [min, max] = self.input.bounds(self.room);
        // Room says nothing of how precise polygons are.
        let own = if self.room.is_some() { self.input.bounds(None) } else { [min, max] };
        let precision = Precision::new(self.input.precision, own);
        let lattice = Lattice::new(min, max);
        let ground = Ground::new(lattice, [min, max], tolerance, precision);
        let ground = if self.are_flat { ground.of_flat_polygons() } else { ground };
        self.builder.faces = kept;
        self.builder.faces.lattice = lattice;
        self.builder.faces.tolerance = ground.tolerance;
        let report = self.prepare_all(&ground, watch)?;
        *faces = std::mem::take(&mut self.builder.faces);
        Ok(report.in_world(&lattice))
    }

    /// Prepares all polygons: few on this thread, more in parts, which are put together in input
    /// order.
    fn prepare_all(&mut self, ground: &Ground, watch: &Watch<'_>) -> Result<Preparation, Error> {
        let Self { input, builder, .. } = self;
        reserve(&mut builder.faces.corners, input.corner_count())?;
        reserve(&mut builder.faces.faces, input.len())?;
        if input.len() <= POLYGONS_A_THREAD {
            watch.expect(input.len())?;
            return builder.add_all(ground, input, 0..input.len(), watch);
        }
        let mut report = Preparation::default();
        for start in (0..input.len()).step_by(POLYGONS_AT_ONCE) {
            watch.expect(input.len())?;
            let end = input.len().min(start + POLYGONS_AT_ONCE);
            let ranges = (start..end)
                .step_by(POLYGONS_A_THREAD)
                .map(|start| start..end.min(start + POLYGONS_A_THREAD));
            let parts = parallel_map::map(ranges.collect(), |range| {
                let mut part = FaceBuilder::new(ground);
                let report = part.add_all(ground, input, range, watch)?;
                Ok::<_, Error>((part.faces, report))
            })?;
            for (faces, part_report) in parts {
                builder.faces.append(faces)?;
                report.add(&part_report);
            }
        }
        Ok(report)
    }
}
