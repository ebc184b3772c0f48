//! Whether two pieces cross.

use glam::DVec3;

use crate::build::live::Live;
use crate::exact::{Faces, Vertex};

/// Whether two pieces cross: any tree has to cut one of the two.
///
/// Each is cut by the plane of the other along a segment of the line in which the two planes meet
/// (Möller, “A fast triangle-triangle intersection test”, 1997).
pub(in crate::build) fn cross<V: Vertex>(faces: &Faces, arena: &[V], a: &Live, b: &Live) -> bool {
    let [normal, other] = [a, b].map(|live| faces.normal(live.face));
    let line = normal.cross(other);
    let [low, high] = segment(faces, arena, a, (b.point(faces, arena), other), line);
    let [other_low, other_high] = segment(faces, arena, b, (a.point(faces, arena), normal), line);
    low.max(other_low) < high.min(other_high)
}

/// From where to where a piece reaches along a line of a plane, where that cuts it.
fn segment<V: Vertex>(
    faces: &Faces,
    arena: &[V],
    live: &Live,
    (point, normal): (DVec3, DVec3),
    line: DVec3,
) -> [f64; 2] {
    let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
    let mut see = |[from, to]: [DVec3; 2], [before, after]: [f64; 2]| {
        let here = line.dot(from + (to - from) * (before / (before - after)));
        (low, high) = (low.min(here), high.max(here));
    };
    let mut first = None;
    let mut last = (DVec3::ZERO, 0.0);
    live.for_each_vertex(faces, arena, |vertex| {
        let vertex = DVec3::from_array(vertex);
        let off = normal.dot(vertex - point);
        if first.is_none() {
            first = Some((vertex, off));
        } else if (off > 0.0) != (last.1 > 0.0) {
            see([last.0, vertex], [last.1, off]);
        }
        last = (vertex, off);
    });
    if let Some((vertex, off)) = first
        && (off > 0.0) != (last.1 > 0.0)
    {
        see([last.0, vertex], [last.1, off]);
    }
    [low, high]
}

#[cfg(test)]
mod tests {
    use glam::{DQuat, DVec3, EulerRot};

    use super::super::tests::Fixture;

    /// A square of side 2 in the plane z = 0, and one in the plane x = 0, moved along y and z.
    #[test]
    fn pieces_cross_where_their_segments_overlap() {
        let turn = DQuat::from_euler(EulerRot::XYZ, 0.3, 0.5, 0.7);
        let square = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
        let level = square.map(|[x, y]| turn * DVec3::new(x, y, 0.0));
        for (y, z, expected) in [
            (0.0, 0.0, true),
            (0.0, 0.9, true),
            (1.9, 0.0, true),
            (-1.9, -0.9, true),
            (0.0, 1.1, false),
            (2.1, 0.0, false),
            (-2.1, 0.9, false),
            (2.1, -1.1, false),
        ] {
            let upright = square.map(|[u, v]| turn * DVec3::new(0.0, u + y, v + z));
            for polygons in [[level, upright], [upright, level]] {
                let fixture = Fixture::new(&polygons, 1e-9);
                assert_eq!(fixture.set().cross(0, 1), expected, "{y} {z}");
            }
        }
    }
}
