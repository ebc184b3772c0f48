//! Meshes of trees: sharing, welding, and the order of written indices.

mod arrays;
mod closed;
mod exact;
mod junctions;
mod order;
mod tips;

use binspace::mesh::{Mesh, Triangles};
use std::collections::HashMap;

/// The directed edges of some fragments' triangles, from point to point. Each has the number of times that it
/// occurs, minus the number of times that its reverse occurs. Edges that cancel are left out.
fn open_edges(mesh: &Mesh, triangles: &Triangles, fragments: &[u32]) -> HashMap<[u32; 2], i32> {
    let mut edges: HashMap<[u32; 2], i32> = HashMap::new();
    for &fragment in fragments {
        for triangle in triangles.indices()[triangles.range(fragment)].chunks(3) {
            for k in 0..3 {
                let [a, b] = [triangle[k], triangle[(k + 1) % 3]].map(|v| mesh.vertex(v).point);
                let (key, step) = if a < b { ([a, b], 1) } else { ([b, a], -1) };
                *edges.entry(key).or_insert(0) += step;
            }
        }
    }
    edges.retain(|_, &mut count| count != 0);
    edges
}

/// Whether every directed edge occurs once, and its reverse occurs once.
fn is_closed_once(mesh: &Mesh) -> bool {
    let mut edges: HashMap<[u32; 2], u32> = HashMap::new();
    for triangle in mesh.triangles().indices().chunks(3) {
        for k in 0..3 {
            let ends = [triangle[k], triangle[(k + 1) % 3]].map(|v| mesh.vertex(v).point);
            *edges.entry(ends).or_insert(0) += 1;
        }
    }
    edges.iter().all(|(&[a, b], &count)| count == 1 && edges.get(&[b, a]) == Some(&1))
}
