//! Segments and points behind the faces of a finished scene.

use super::Preparer;
use super::corners::{Corner, keep_distinct};
use crate::error::{Error, InputFault, InputKind};
use crate::exact::faces::Frame;
use crate::exact::{Faces, LATTICE_LIMIT, cross};
use crate::input::{Point, Polygon};
use crate::memory::reserve;
use crate::progress::Watch;

/// How far the third corner of a segment is, if the segment's neighbours give none: a quarter of the
/// lattice. Any distance gives the same plane.
const ARM: f64 = LATTICE_LIMIT / 2.0;

impl Preparer {
    /// Appends the segments of lines, on the lattice of the faces, and lists their numbers in their
    /// lines. Segments whose ends are rounded to one lattice point are left out. There may be no points
    /// yet. After an error, some segments may have been appended.
    pub(crate) fn append_lines<P: Polygon>(
        &mut self,
        faces: &mut Faces,
        lines: impl IntoIterator<Item = P>,
        numbers: &mut Vec<u32>,
        watch: &Watch<'_>,
    ) -> Result<(), Error> {
        numbers.clear();
        self.read_thin(faces, lines, InputKind::Line, watch)?;
        let mut corners = Vec::new();
        for line in 0..self.input.len() {
            let given = self.input.polygon(line);
            watch.work(given.len())?;
            keep_distinct(given, &faces.lattice, &mut corners);
            reserve(numbers, corners.len())?;
            for (k, ends) in corners.windows(2).enumerate() {
                let [(from, number), (to, _)] = *ends else { continue };
                let third = third_corner([from, to], neighbours(&corners, k).into_iter().flatten());
                faces.push(line, [from, to, third].into_iter(), Frame::TRIANGLE)?;
                numbers.push(number);
            }
        }
        faces.thin.segments = numbers.len();
        Ok(())
    }

    /// Appends points, on the lattice of the faces. After an error, some may have been appended.
    pub(crate) fn append_points<P: Point>(
        &mut self,
        faces: &mut Faces,
        points: impl IntoIterator<Item = P>,
        watch: &Watch<'_>,
    ) -> Result<(), Error> {
        let points = points.into_iter().map(|point| [point]);
        self.read_thin(faces, points, InputKind::Point, watch)?;
        for number in 0..self.input.len() {
            let lattice = faces.lattice;
            let at = self.input.polygon(number).iter().map(|&point| lattice.snap(point));
            faces.push(number, at, Frame::POINT)?;
        }
        faces.thin.points = self.input.len();
        Ok(())
    }

    fn read_thin<P: Polygon>(
        &mut self,
        faces: &Faces,
        shapes: impl IntoIterator<Item = P>,
        kind: InputKind,
        watch: &Watch<'_>,
    ) -> Result<(), Error> {
        self.input.read(shapes, usize::MAX, watch).map_err(|error| error.of(kind))?;
        match self.input.first_off(&faces.lattice) {
            Some(number) => Err(InputFault::OffGrid.of_polygon(number).of(kind)),
            None => Ok(()),
        }
    }
}

/// The corner behind a segment's end, and the one ahead of its beginning. Where a line is closed, they
/// are those on the other side of the closing corner.
fn neighbours(corners: &[Corner], segment: usize) -> [Option<[f64; 3]>; 2] {
    let segments = corners.len() - 1;
    let is_closed = corners[0].0 == corners[segments].0;
    let after = match segment + 2 {
        next if next <= segments => Some(next),
        _ => is_closed.then_some(1),
    };
    let before = match segment.checked_sub(1) {
        None => is_closed.then_some(segments - 1),
        before => before,
    };
    [after, before].map(|corner| corner.map(|corner| corners[corner].0))
}

/// A lattice point that is not on the line through two others.
///
/// It is that of a neighbour, if one is: of a line that lies in a plane, all segments then have that
/// plane, and none of them cuts another.
fn third_corner([p, q]: [[f64; 3]; 2], neighbours: impl Iterator<Item = [f64; 3]>) -> [f64; 3] {
    // Upright planes, where there is no neighbour: seen from above, they cut each other as lines of the
    // plane do, which makes fewer pieces than planes in all directions.
    let along = |axis: usize| {
        let mut third = p;
        third[axis] -= if p[axis] < 0.0 { -ARM } else { ARM };
        third
    };
    let is_off = |third: &[f64; 3]| cross(p, q, *third) != [0; 3];
    neighbours.chain([along(2)]).find(is_off).unwrap_or_else(|| along(0))
}
