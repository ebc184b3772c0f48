//! The points and edges that faces share.

use super::lines::Table;
use crate::Error;
use crate::exact::Faces;
use crate::memory::place;
use crate::progress::Watch;

/// Numbers for the points and the edges of all faces. Corners at one point have one number, and so have edges
/// between the same two points. The positions are the given ones, from before the tolerance moved corners.
#[derive(Debug, Default)]
pub(super) struct Adjacency {
    /// The number of the point of each corner, counted over all faces.
    points: Vec<u32>,
    /// The number of the edge from each corner to the face's next corner.
    edges: Vec<u32>,
    /// The position of each point.
    at: Vec<[f64; 3]>,
    edge_count: usize,
}

/// The number of faces between two polls for cancellation.
const STRETCH: usize = 256;
/// The cost of the corners of one face, in pieces that a build examines.
const NUMBERED: usize = 8;

impl Adjacency {
    pub(super) fn of(faces: &Faces, watch: &Watch<'_>) -> Result<Self, Error> {
        let count = faces.corner_count();
        place(2 * count)?;
        let (mut points, mut edges) = (vec![0; count], vec![0; count]);
        let mut at: Vec<[f64; 3]> = Vec::new();
        // In a closed mesh of quads, four corners are one point, and two edges of faces are one edge.
        let mut by_place: Table<(u64, u64, u64), u32> = Table::default();
        by_place.reserve(count / 4);
        let mut by_ends: Table<u64, u32> = Table::default();
        by_ends.reserve(count / 2);
        let mut moved = faces.moved.iter().peekable();
        for face in 0..faces.len() as u32 {
            if (face as usize).is_multiple_of(STRETCH) {
                watch.work(STRETCH * NUMBERED)?;
            }
            let range = faces.corner_range(face);
            for corner in range.clone() {
                let given = match moved.next_if(|moved| moved.0 as usize == corner) {
                    Some(&(_, given)) => given,
                    None => faces.corner(corner as u32),
                };
                let [x, y, z] = given.map(|c| (c + 0.0).to_bits());
                points[corner] = *by_place.entry((x, y, z)).or_insert_with(|| {
                    at.push(given);
                    at.len() as u32 - 1
                });
            }
            for corner in range.clone() {
                let next = if corner + 1 == range.end { range.start } else { corner + 1 };
                let [a, b] = [corner, next].map(|corner| u64::from(points[corner]));
                let new = by_ends.len() as u32;
                edges[corner] = *by_ends.entry(a.min(b) << 32 | a.max(b)).or_insert(new);
            }
        }
        Ok(Self { points, edges, at, edge_count: by_ends.len() })
    }

    /// The positions of all points, by their numbers.
    pub(super) fn points(&self) -> &[[f64; 3]] {
        &self.at
    }

    /// The number of the point of a corner, counted over all faces.
    pub(super) fn point(&self, corner: u32) -> u32 {
        self.points[corner as usize]
    }

    /// The number of the point to which a corner off its face's plane was moved. No edge of another face ends
    /// at this point.
    pub(super) fn moved(&self, corner: u32) -> u32 {
        self.at.len() as u32 + corner
    }

    /// The position of a point.
    pub(super) fn at(&self, point: u32, faces: &Faces) -> [f64; 3] {
        let point = point as usize;
        self.at.get(point).copied().unwrap_or_else(|| faces.corners[point - self.at.len()])
    }

    /// The number of the edge from a corner, counted over all faces, to the face's next corner.
    pub(super) fn edge(&self, corner: u32) -> u32 {
        self.edges[corner as usize]
    }

    /// The number of edges.
    pub(super) fn edge_count(&self) -> usize {
        self.edge_count
    }
}

#[cfg(test)]
mod tests {
    use super::Adjacency;
    use crate::progress::Watch;
    use crate::tree::BspTree;
    use glam::DVec3;

    /// A grid of bent quads, so that corners are moved, and a quad that turns the other way.
    #[test]
    fn quads_of_a_grid_share_points_and_edges() {
        let n = 5;
        let at = |x: i32, y: i32| {
            let bend = f64::from(x * x * 3 + y * x + y * y * y).sin() * 1e-12;
            DVec3::new(f64::from(x), f64::from(y), bend)
        };
        let places = (0..n).flat_map(|x| (0..n).map(move |y| (x, y)));
        let mut quads: Vec<[DVec3; 4]> =
            places.map(|(x, y)| [at(x, y), at(x + 1, y), at(x + 1, y + 1), at(x, y + 1)]).collect();
        let mut turned = quads[7];
        turned.reverse();
        quads.push(turned);
        let tree = BspTree::build(&quads).unwrap();
        let faces = tree.faces();
        assert!(faces.len() == quads.len() && !faces.moved.is_empty());
        let adjacency = Adjacency::of(faces, &Watch::default()).unwrap();
        let n = n as usize;
        assert_eq!(adjacency.at.len(), (n + 1) * (n + 1));
        assert_eq!(adjacency.edge_count(), 2 * n * (n + 1));
        // The oracle: corners and edges compared in pairs by the input.
        let given = |corner: u32| quads[corner as usize / 4][corner as usize % 4];
        let ends = |corner: u32| {
            let next = corner / 4 * 4 + (corner + 1) % 4;
            let mut ends = [corner, next].map(|corner| given(corner).to_array());
            ends.sort_by(|a, b| a.partial_cmp(b).unwrap());
            ends
        };
        // Each face begins with its polygon's first corner.
        for a in 0..4 * quads.len() as u32 {
            let at = adjacency.at(adjacency.point(a), faces);
            assert_eq!(at, faces.given_corner(a));
            assert_eq!(adjacency.at(adjacency.moved(a), faces), faces.corner(a));
            for b in 0..a {
                assert_eq!(adjacency.point(a) == adjacency.point(b), given(a) == given(b));
                assert_eq!(adjacency.edge(a) == adjacency.edge(b), ends(a) == ends(b));
            }
        }
    }
}
