//! Segments and points behind the faces of a finished scene.

use super::Preparer;
use crate::Error;
use crate::error::Shape;
use crate::exact::faces::{Face, Frame};
use crate::exact::{Faces, LATTICE_LIMIT, MAX_LABELS, cross};
use crate::faces::listener::Listener;
use crate::input::{Point, Polygon};
use crate::memory::reserve;

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
        listener: &dyn Listener,
    ) -> Result<(), Error> {
        numbers.clear();
        self.read_thin(faces, lines, Shape::Line, listener)?;
        let mut points = Vec::new();
        for line in 0..self.input.len() {
            let given = self.input.polygon(line);
            listener.work(given.len())?;
            points.clear();
            reserve(&mut points, given.len())?;
            points.extend(given.iter().map(|&point| faces.lattice.snap(point)));
            reserve(numbers, points.len())?;
            for (k, ends) in points.windows(2).enumerate() {
                if ends[0] == ends[1] {
                    continue;
                }
                let neighbours = [points.get(k + 2), k.checked_sub(1).map(|k| &points[k])];
                let third = third_corner([ends[0], ends[1]], neighbours.into_iter().flatten());
                push(faces, &[ends[0], ends[1], third], line as u32, Frame::TRIANGLE)?;
                numbers.push(k as u32);
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
        listener: &dyn Listener,
    ) -> Result<(), Error> {
        let points = points.into_iter().map(|point| [point]);
        self.read_thin(faces, points, Shape::Point, listener)?;
        for number in 0..self.input.len() {
            let at = self.input.polygon(number).iter().map(|&point| faces.lattice.snap(point));
            let at = at.collect::<smallvec::SmallVec<[_; 1]>>();
            push(faces, &at, number as u32, Frame::POINT)?;
        }
        faces.thin.points = self.input.len();
        Ok(())
    }

    fn read_thin<P: Polygon>(
        &mut self,
        faces: &Faces,
        shapes: impl IntoIterator<Item = P>,
        kind: Shape,
        listener: &dyn Listener,
    ) -> Result<(), Error> {
        self.input.read(shapes, usize::MAX, listener).map_err(|error| error.of(kind))?;
        match self.input.first_off(&faces.lattice) {
            Some(number) => Err(Error::off_grid(number).of(kind)),
            None => Ok(()),
        }
    }
}

/// A lattice point that is not on the line through two others.
///
/// It is that of a neighbour, if one is: of a line that lies in a plane, all segments then have that
/// plane, and none of them cuts another.
fn third_corner<'a>(
    [p, q]: [[f64; 3]; 2],
    neighbours: impl Iterator<Item = &'a [f64; 3]>,
) -> [f64; 3] {
    // Upright planes, where there is no neighbour: seen from above, they cut each other as lines of the
    // plane do, which makes fewer pieces than planes in all directions.
    let along = |axis: usize| {
        let mut third = p;
        third[axis] -= if p[axis] < 0.0 { -ARM } else { ARM };
        third
    };
    let is_off = |third: &[f64; 3]| cross(p, q, *third) != [0; 3];
    let mut candidates = neighbours.copied().chain([along(2)]);
    candidates.find(is_off).unwrap_or_else(|| along(0))
}

fn push(faces: &mut Faces, corners: &[[f64; 3]], shape: u32, frame: Frame) -> Result<(), Error> {
    let start = faces.corners.len();
    if start + corners.len() >= MAX_LABELS {
        return Err(Error::too_many_corners(MAX_LABELS));
    }
    reserve(&mut faces.corners, corners.len())?;
    reserve(&mut faces.faces, 1)?;
    faces.corners.extend_from_slice(corners);
    faces.faces.push(Face { start: start as u32, polygon: shape, frame });
    Ok(())
}
