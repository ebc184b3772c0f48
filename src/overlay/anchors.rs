//! Points at corners of lines.

use std::cmp::Ordering;

use crate::build::piece::Piece;
use crate::build::progress::Watch;
use crate::error::Error;
use crate::exact::{Faces, Vertex};
use crate::memory::reserve;

/// For each point, a segment that it is an end of, if there is one.
///
/// A mark on a curve is to be painted over the curve. If a plane came between the two segments that
/// meet at the mark, one of them would come later than the mark. The plane of the one that ends there
/// has the next one on it as well (see `third_corner`), and the point.
#[derive(Debug, Default)]
pub(super) struct Anchors {
    /// The points, sorted by where they are, with their numbers.
    points: Vec<([f64; 3], u32)>,
    /// The different places of points, sorted, and a segment that has an end there.
    places: Vec<([f64; 3], Option<u32>)>,
    /// For each point the number of its place.
    place_of: Vec<u32>,
    /// The first point's face.
    first: u32,
}

/// Lattice coordinates have one form of 0, so equal places are equal in this order.
fn order(a: &[f64; 3], b: &[f64; 3]) -> Ordering {
    a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])).then(a[2].total_cmp(&b[2]))
}

impl Anchors {
    /// Finds the segments of all points. Of the segments that meet where many points are, each is looked
    /// at once, not once for each point.
    pub(super) fn fill(&mut self, faces: &Faces, watch: &Watch<'_>) -> Result<(), Error> {
        self.find_places(faces)?;
        if self.places.is_empty() {
            return Ok(());
        }
        // Beginnings first, so that a segment that ends at a point is preferred.
        for end in [0, 1] {
            for face in self.first - faces.thin.segments as u32..self.first {
                watch.work(1)?;
                let corner = faces.corners(face)[end];
                if let Ok(at) = self.places.binary_search_by(|(place, _)| order(place, &corner)) {
                    self.places[at].1 = Some(face);
                }
            }
        }
        Ok(())
    }

    /// Lists the places of the points.
    fn find_places(&mut self, faces: &Faces) -> Result<(), Error> {
        let Self { points, places, place_of, first } = self;
        let count = faces.thin.points;
        *first = (faces.len() - count) as u32;
        points.clear();
        places.clear();
        place_of.clear();
        reserve(points, count)?;
        points.extend((0..count as u32).map(|number| (faces.corners(*first + number)[0], number)));
        points.sort_unstable_by(|(a, _), (b, _)| order(a, b));
        reserve(places, count)?;
        reserve(place_of, count)?;
        place_of.resize(count, 0);
        for &(at, number) in &*points {
            if places.last().is_none_or(|&(last, _)| last != at) {
                places.push((at, None));
            }
            place_of[number as usize] = places.len() as u32 - 1;
        }
        Ok(())
    }

    /// Where the points begin in a set of pieces, which is in the order of faces.
    pub(super) fn points<'p>(&self, pieces: &'p [Piece]) -> &'p [Piece] {
        &pieces[pieces.partition_point(|piece| piece.face < self.first)..]
    }

    /// The segment of a point, if the piece of it that ends there is in the same set.
    pub(super) fn segment(&self, point: &Piece, pieces: &[Piece], arena: &[Vertex]) -> Option<u32> {
        let place = self.place_of[(point.face - self.first) as usize];
        let face = self.places[place as usize].1?;
        let start = pieces.partition_point(|piece| piece.face < face);
        let mut parts = pieces[start..].iter().take_while(|piece| piece.face == face);
        let ends = |piece: &Piece| piece.cut_vertices(arena).unwrap_or_default();
        let touches = |piece: &Piece| ends(piece).iter().any(|end| end.position() == point.min);
        parts.any(touches).then_some(face)
    }
}
