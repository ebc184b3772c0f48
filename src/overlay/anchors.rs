//! Points at corners of lines.

use crate::build::live::Live;
use crate::error::Error;
use crate::exact::{ExactVertex, Faces, Vertex};
use crate::memory::reserve;

/// For each point, a segment that it is an end of, if there is one.
///
/// A mark on a curve is to be painted over the curve. If a plane came between the two segments that
/// meet at the mark, one of them would come later than the mark. The plane of the one that ends there
/// has the next one on it as well (see `third_corner`), and the point.
#[derive(Debug, Default)]
pub(super) struct Anchors {
    /// By the points' numbers.
    segments: Vec<Option<u32>>,
    /// The points' places, sorted, with their numbers.
    places: Vec<([f64; 3], u32)>,
    /// The first point's face.
    first: u32,
}

impl Anchors {
    /// Finds the segments of all points.
    pub(super) fn fill(&mut self, faces: &Faces) -> Result<(), Error> {
        let Self { segments, places, first } = self;
        let count = faces.thin.points;
        *first = (faces.len() - count) as u32;
        segments.clear();
        reserve(segments, count)?;
        segments.resize(count, None);
        places.clear();
        if faces.thin.segments == 0 {
            return Ok(());
        }
        reserve(places, count)?;
        places.extend((0..count as u32).map(|number| (faces.corners(*first + number)[0], number)));
        // Lattice coordinates have one form of 0, so equal places are equal in this order.
        let order = |a: &[f64; 3], b: &[f64; 3]| {
            a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])).then(a[2].total_cmp(&b[2]))
        };
        places.sort_unstable_by(|(a, _), (b, _)| order(a, b));
        // Beginnings first, so that a segment that ends at a point is preferred.
        for end in [0, 1] {
            for face in *first - faces.thin.segments as u32..*first {
                let corner = faces.corners(face)[end];
                let start = places.partition_point(|(place, _)| order(place, &corner).is_lt());
                let equal = places[start..].iter().take_while(|(place, _)| *place == corner);
                equal.for_each(|&(_, number)| segments[number as usize] = Some(face));
            }
        }
        Ok(())
    }

    /// Where the points begin in a set of pieces, which is in the order of faces.
    pub(super) fn points<'p>(&self, pieces: &'p [Live]) -> &'p [Live] {
        &pieces[pieces.partition_point(|piece| piece.face < self.first)..]
    }

    /// The segment of a point, if the piece of it that ends there is in the same set.
    pub(super) fn segment(
        &self,
        point: &Live,
        pieces: &[Live],
        arena: &[ExactVertex],
    ) -> Option<u32> {
        let face = self.segments[(point.face - self.first) as usize]?;
        let start = pieces.partition_point(|piece| piece.face < face);
        let mut parts = pieces[start..].iter().take_while(|piece| piece.face == face);
        let ends = |piece: &Live| piece.piece(arena).cut.unwrap_or_default();
        let touches = |piece: &Live| ends(piece).iter().any(|end| end.position() == point.min);
        parts.any(touches).then_some(face)
    }
}
