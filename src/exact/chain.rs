//! Sums of directed edges: which edges are left where the same edges in the opposite direction do not cancel
//! them.

use super::{cross, gcd};

/// An edge between lattice points: the start, the end, and the edge's name.
pub(crate) type Edge = ([i64; 3], [i64; 3], [u32; 2]);

/// The names of the open edges, in ascending order. An edge is open if more edges traverse some stretch of it
/// in its direction than in the opposite direction. Edges without length are not open. Takes O(n log n) time.
pub(crate) fn open_edges(mut edges: Vec<Edge>) -> Vec<[u32; 2]> {
    edges.retain(|(a, b, _)| a != b);
    let ends = |&(a, b, _): &Edge| (a.min(b), a.max(b));
    edges.sort_unstable_by_key(|edge| (ends(edge), edge.0 < edge.1));
    // Nearly all edges have an equal edge in the opposite direction. On a line where all edges do, none is
    // open. The other edges may be closed by several collinear edges, for example if a corner is on a
    // neighbour's edge.
    let equal = |one: &Edge, other: &Edge| ends(one) == ends(other);
    let is_closed = |equal: &&[Edge]| {
        let falling = equal.partition_point(|edge| edge.0 > edge.1);
        2 * falling == equal.len()
    };
    let unclosed = edges.chunk_by(equal).filter(|equal| !is_closed(equal));
    let mut lines: Vec<Line> = unclosed.map(|equal| line(&equal[0])).collect();
    lines.sort_unstable();
    lines.dedup();
    if lines.is_empty() {
        return vec![];
    }
    let mut on_lines: Vec<(usize, Edge)> = vec![];
    for equal in edges.chunk_by(equal) {
        if let Ok(line) = lines.binary_search(&line(&equal[0])) {
            on_lines.extend(equal.iter().map(|&edge| (line, edge)));
        }
    }
    on_lines.sort_unstable();
    let mut open = Vec::new();
    for edges in on_lines.chunk_by(|one, other| one.0 == other.0) {
        open.extend(open_along(edges));
    }
    open.sort_unstable();
    open
}

/// A line: its direction, and the moment of its points about the origin. The direction's coordinates have no
/// common divisor, and the first coordinate that is not 0 is positive.
type Line = ([i64; 3], [i128; 3]);

/// The line of an edge.
fn line(&(a, b, _): &Edge) -> Line {
    let way: [i64; 3] = std::array::from_fn(|i| b[i] - a[i]);
    let divisor = way.iter().fold(0, |divisor, c| gcd(divisor, c.unsigned_abs())) as i64;
    let sign = way.iter().find(|&&c| c != 0).map_or(1, |c| c.signum());
    let way = way.map(|c| c / divisor.max(1) * sign);
    // Lattice coordinates are exact in `f64`.
    (way, cross([0.0; 3], a.map(|c| c as f64), way.map(|c| c as f64)))
}

/// The open edges among collinear edges: an edge is open if more edges traverse some stretch of the edge
/// forwards than backwards.
fn open_along(edges: &[(usize, Edge)]) -> Vec<[u32; 2]> {
    // Points of a line have the same order as their coordinates, compared one after the other.
    let mut ends: Vec<([i64; 3], i32)> = Vec::with_capacity(2 * edges.len());
    for &(_, (a, b, _)) in edges {
        ends.extend([(a, 1), (b, -1)]);
    }
    ends.sort_unstable();
    // Before each end, the numbers of earlier stretches with a surplus of upward and of downward edges.
    let (mut surplus, mut counts) = (0, vec![[0, 0]]);
    for (i, &(end, step)) in ends.iter().enumerate() {
        surplus += step;
        let is_stretch = ends.get(i + 1).is_some_and(|next| next.0 != end);
        let [mut up, mut down] = counts[i];
        up += usize::from(is_stretch && surplus > 0);
        down += usize::from(is_stretch && surplus < 0);
        counts.push([up, down]);
    }
    let place = |point: [i64; 3]| ends.partition_point(|end| end.0 < point);
    let is_open = |&&(_, (a, b, _)): &&(usize, Edge)| {
        let way = usize::from(a > b);
        counts[place(a.max(b))][way] > counts[place(a.min(b))][way]
    };
    edges.iter().filter(is_open).map(|(_, edge)| edge.2).collect()
}

#[cfg(test)]
mod tests {
    use std::collections::HashMap;

    use super::open_edges;
    use crate::random::SplitMix64;

    /// Edges of whole steps on a few lines, counted step by step.
    #[test]
    fn an_edge_is_open_if_a_step_of_it_has_a_surplus_in_its_direction() {
        let lines = [[[0, 0, 0], [1, 0, 0]], [[0, 0, 0], [1, 2, -1]], [[1, 0, 3], [-2, 2, 4]]];
        let mut random = SplitMix64::new(1);
        let mut below = |limit: u64| (random.next() >> 8) as i64 % limit as i64;
        let mut counts = [0; 2];
        for _ in 0..20_000 {
            let count = 1 + below(8);
            let edges: Vec<(usize, i64, i64)> =
                (0..count).map(|_| (below(3) as usize, below(5), below(5))).collect();
            let mut surplus: HashMap<(usize, i64), i64> = HashMap::new();
            for &(line, from, to) in &edges {
                for step in from.min(to)..from.max(to) {
                    *surplus.entry((line, step)).or_default() += (to - from).signum();
                }
            }
            let is_open = |&(line, from, to): &(usize, i64, i64)| {
                let mut steps = from.min(to)..from.max(to);
                steps.any(|step| surplus[&(line, step)] * (to - from) > 0)
            };
            let expected: Vec<[u32; 2]> = (0..)
                .zip(&edges)
                .filter(|(_, edge)| is_open(edge))
                .map(|(name, _)| [name, 7])
                .collect();
            let at = |line: usize, place: i64| {
                let [origin, way] = lines[line];
                [0, 1, 2].map(|i: usize| origin[i] + place * way[i])
            };
            let given = (0..).zip(&edges);
            let given = given.map(|(name, &(line, a, b))| (at(line, a), at(line, b), [name, 7]));
            assert_eq!(open_edges(given.collect()), expected, "{edges:?}");
            counts[usize::from(expected.is_empty())] += 1;
        }
        assert!(counts.iter().all(|&count| count > 500), "{counts:?}");
    }
}
