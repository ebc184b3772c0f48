//! Cycles of a graph, and the minimal feedback vertex set.

/// The largest number of vertices whose subsets are all tried.
pub(super) const SEARCHED: usize = 22;

/// The strongly connected components of two or more vertices, from the transitive closure of the graph, a row
/// of bits for each vertex (S. Warshall, "A theorem on Boolean matrices", 1962). O(n³ / 64).
pub(super) fn components(next: &[Vec<u32>]) -> Vec<Vec<u32>> {
    let (count, words) = (next.len(), next.len().div_ceil(64));
    let mut reach = vec![vec![0u64; words]; count];
    for (from, list) in next.iter().enumerate() {
        list.iter().for_each(|&to| reach[from][to as usize / 64] |= 1 << (to % 64));
    }
    let leads = |reach: &[Vec<u64>], a: usize, b: usize| reach[a][b / 64] >> (b % 64) & 1 == 1;
    for by in 0..count {
        let row = reach[by].clone();
        for from in 0..count {
            if leads(&reach, from, by) {
                reach[from].iter_mut().zip(&row).for_each(|(word, more)| *word |= more);
            }
        }
    }
    let mut found = Vec::new();
    for a in 0..count {
        let all: Vec<u32> = (0..count)
            .filter(|&b| leads(&reach, a, b) && leads(&reach, b, a))
            .map(|b| b as u32)
            .collect();
        if all.first() == Some(&(a as u32)) {
            found.push(all);
        }
    }
    found
}

/// The smallest number of these vertices whose removal breaks all cycles among them; all subsets are tried.
/// `None` for too many vertices.
pub(super) fn fewest_removed(next: &[Vec<u32>], vertices: &[u32]) -> Option<usize> {
    if vertices.len() > SEARCHED {
        return None;
    }
    let place = |vertex: &u32| vertices.iter().position(|v| v == vertex);
    let mask = |&vertex: &u32| {
        let leads = next[vertex as usize].iter().filter_map(place);
        leads.fold(0u32, |mask, place| mask | 1 << place)
    };
    let leads: Vec<u32> = vertices.iter().map(mask).collect();
    let all = (1u32 << vertices.len()) - 1;
    let enough = |removed: &u32| !has_cycle(&leads, all & !removed);
    (0..=all).filter(enough).map(|removed| removed.count_ones() as usize).min()
}

/// Whether these vertices, one bit each, contain a cycle. Vertices without an edge to the remaining vertices
/// are removed as long as there are any.
fn has_cycle(leads: &[u32], mut left: u32) -> bool {
    loop {
        let ends = (0..leads.len()).filter(|&v| left >> v & 1 == 1 && leads[v] & left == 0);
        let ends = ends.fold(0u32, |mask, v| mask | 1 << v);
        if ends == 0 {
            return left != 0;
        }
        left &= !ends;
    }
}
