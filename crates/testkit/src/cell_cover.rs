//! Checks that each point of each polygon is in one cell, by the areas and edges of all cells together, in
//! rationals.

use std::collections::BTreeMap;

use binspace::glam::DVec3;
use binspace::{BspTree, BuildOptions};

use super::divided::Divided;
use super::judge::{Cover, Judge, ensure};

/// A face of a scene: its polygon, and the numbers of its corners.
type Name = (usize, Vec<u32>);

fn name(tree: &BspTree, face: u32, polygon: usize) -> Name {
    let corners = 0..tree.faces().corners(face).len() as u32;
    (polygon, corners.map(|k| tree.faces().corner_number(face, k)).collect())
}

/// Checks the cover. Returns the number of faces that planes of cells cut.
pub fn check(scene: &Divided, options: BuildOptions) -> Result<usize, String> {
    let mut covers: BTreeMap<Name, (Cover, usize)> = BTreeMap::new();
    for (number, cell) in scene.cells.iter().enumerate() {
        let [low, high] = scene.partition.bounds(number);
        // The tolerance, and the rounding error of vertices.
        let step = cell.tree.faces().lattice().length_to_world(1.0);
        let slack = DVec3::splat(4.0 * (scene.partition.tolerance() + step));
        for fragment in cell.tree.fragments() {
            for vertex in fragment.vertices() {
                let is_in = vertex.cmpge(low - slack).all() && vertex.cmple(high + slack).all();
                ensure(is_in, || format!("{vertex} is not in {low} … {high}"))?;
            }
        }
        for (face, cover) in Judge::new(&cell.tree).covers().iter().enumerate() {
            let polygon = cell.given[cell.tree.faces().polygon(face as u32)];
            let (all, cells) = covers.entry(name(&cell.tree, face as u32, polygon)).or_default();
            all.add(cover);
            *cells += 1;
        }
    }
    let whole = options.build(&scene.polygons).map_err(|error| error.to_string())?;
    let judge = Judge::new(&whole);
    for face in 0..whole.faces().len() {
        let name = name(&whole, face as u32, whole.faces().polygon(face as u32));
        let (mut cover, _) = covers.get(&name).cloned().ok_or(format!("face {face} is lost"))?;
        judge.is_covered(face, &mut cover)?;
    }
    ensure(covers.len() == whole.faces().len(), || {
        "there are other faces than in one tree".into()
    })?;
    Ok(covers.values().filter(|(_, cells)| *cells > 1).count())
}
