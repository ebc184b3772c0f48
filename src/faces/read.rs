//! Reads the corners of all polygons.

use glam::DVec3;

use crate::error::{Error, Kind};
use crate::exact::{LATTICE_LIMIT, Lattice, MAX_NAMES};
use crate::input::{MAX_CORNERS, Polygon};
use crate::memory::{push, reserve};
use crate::progress::{PIECES_AT_ONCE, Watch};

const _: () = assert!(MAX_CORNERS.is_multiple_of(PIECES_AT_ONCE), "so that it is noticed");

/// The most polygons for which memory is reserved on the word of an iterator's size hint. Too large:
/// a wrong hint wastes memory; too small: polygons are copied more often as lists grow.
const TRUSTED: usize = 1 << 16;

/// An iterator's hint that it has too many polygons is believed after this many polygons. Too small: a
/// hint that is wrong is an error more often; too large: an iterator without end is noticed later.
const DOUBTED: usize = 1 << 20;

/// A polygon with at most this many corners by its size hint is read at once. Too large: memory is reserved
/// on the word of a wrong hint.
const AT_HAND: usize = 64;

/// All corners, and where those of each polygon end.
#[derive(Debug, Default)]
pub(super) struct InputPolygons {
    points: Vec<DVec3>,
    ends: Vec<u32>,
    /// The largest of the polygons' [`precision`](Polygon::precision): how far corners may be off.
    pub(super) precision: f64,
    /// That of each polygon.
    precisions: Vec<f64>,
}

impl InputPolygons {
    /// The number of polygons.
    pub(super) fn len(&self) -> usize {
        self.ends.len()
    }

    pub(super) fn corner_count(&self) -> usize {
        self.points.len()
    }

    /// The corners of a polygon.
    pub(super) fn polygon(&self, polygon: usize) -> &[DVec3] {
        let start = polygon.checked_sub(1).map_or(0, |before| self.ends[before]);
        &self.points[start as usize..self.ends[polygon] as usize]
    }

    /// The [`precision`](Polygon::precision) of a polygon.
    pub(super) fn precision_of(&self, polygon: usize) -> f64 {
        self.precisions[polygon]
    }

    /// The corners of the bounding box of the polygons and the corners of a box, if one is given;
    /// zero if there is nothing.
    pub(super) fn bounds(&self, room: Option<[DVec3; 2]>) -> [DVec3; 2] {
        let first = self.points.first().copied().or(room.map(|[corner, _]| corner));
        let start = [first.unwrap_or_default(); 2];
        let points = self.points.iter().chain(room.iter().flatten());
        points.fold(start, |[min, max], &p| [min.min(p), max.max(p)])
    }

    /// The first polygon with a corner beyond the ends of a lattice.
    pub(super) fn first_off(&self, lattice: &Lattice) -> Option<usize> {
        let is_off = |point: &DVec3| lattice.snap(*point).iter().any(|c| c.abs() > LATTICE_LIMIT);
        (0..self.len()).find(|&polygon| self.polygon(polygon).iter().any(is_off))
    }

    /// Replaces the polygons by those of an iterator; more than `limit` is an error.
    pub(super) fn read<P: Polygon>(
        &mut self,
        polygons: impl IntoIterator<Item = P>,
        limit: usize,
        watch: &Watch<'_>,
    ) -> Result<(), Error> {
        let mut polygons = polygons.into_iter();
        let too_many = match limit <= MAX_NAMES {
            true => Kind::PolygonsOfBudget(limit),
            false => Kind::Polygons(MAX_NAMES),
        };
        let limit = limit.min(MAX_NAMES);
        let expected = polygons.size_hint().0;
        self.points.clear();
        self.ends.clear();
        self.precision = 0.0;
        self.precisions.clear();
        reserve(&mut self.points, 3 * expected.min(TRUSTED))?;
        reserve(&mut self.ends, expected.min(TRUSTED))?;
        reserve(&mut self.precisions, expected.min(TRUSTED))?;
        let mut index = 0;
        while let Some(polygon) = polygons.next() {
            if index == limit {
                return Err(too_many.error());
            }
            if index == DOUBTED && polygons.size_hint().0 >= limit - index {
                return Err(too_many.error());
            }
            if index % PIECES_AT_ONCE == 0 {
                watch.expect(index)?;
            }
            self.add(index, &polygon, watch)?;
            index += 1;
        }
        Ok(())
    }

    fn add<P: Polygon>(
        &mut self,
        index: usize,
        polygon: &P,
        watch: &Watch<'_>,
    ) -> Result<(), Error> {
        let mut corners = polygon.corners();
        let mut read = 0;
        if let (least, Some(most)) = corners.size_hint()
            && least == most
            && most <= AT_HAND
        {
            reserve(&mut self.points, most)?;
            let before = self.points.len();
            self.points.extend(corners.by_ref().take(most));
            // Infinity and NaN times 0 are NaN.
            let zero = self.points[before..].iter().fold(DVec3::ZERO, |sum, &p| sum + p * 0.0);
            if zero != DVec3::ZERO {
                return Err(Kind::NonFinite.of_polygon(index));
            }
            read = self.points.len() - before;
        }
        // All corners, or those beyond the size hint.
        for (corner, point) in (read..).zip(corners) {
            if corner % PIECES_AT_ONCE == 0 && corner > 0 {
                if corner == MAX_CORNERS {
                    return Err(Kind::Corners(MAX_CORNERS).of_polygon(index));
                }
                self.check_count()?;
                watch.expect(index)?;
            }
            if !point.is_finite() {
                return Err(Kind::NonFinite.of_polygon(index));
            }
            push(&mut self.points, point)?;
        }
        self.end(polygon)
    }

    /// Ends a polygon, whose corners are read.
    fn end<P: Polygon>(&mut self, polygon: &P) -> Result<(), Error> {
        self.check_count()?;
        // Of NaN and the other, `max` returns the other.
        let precision = polygon.precision().max(0.0);
        push(&mut self.precisions, precision)?;
        self.precision = self.precision.max(precision);
        push(&mut self.ends, self.points.len() as u32)
    }

    /// An error if there are more corners than can be named.
    fn check_count(&self) -> Result<(), Error> {
        if self.points.len() > MAX_NAMES {
            return Err(Kind::CornersInAll(MAX_NAMES).error());
        }
        Ok(())
    }
}
