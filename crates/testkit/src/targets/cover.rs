//! Checks that a tree's fragments cover its faces.

use super::super::judge::{Verdict, ensure};
use binspace::BspTree;
use binspace::glam::DVec3;

/// Checks that the fragments of each face have its vector area, up to the rounding of their vertices.
pub fn covers(tree: &BspTree) -> Verdict {
    let area = |corners: &mut dyn Iterator<Item = [f64; 3]>| {
        let corners: Vec<DVec3> = corners.map(DVec3::from).collect();
        let arms = corners.windows(2).map(|pair| [pair[0] - corners[0], pair[1] - corners[0]]);
        arms.map(|[a, b]| a.cross(b)).sum::<DVec3>()
    };
    let faces = 0..tree.faces().len() as u32;
    let whole = |face| area(&mut tree.faces().corners(face).iter().copied());
    let mut missing: Vec<(DVec3, f64)> = faces.map(|face| (whole(face), 1.0)).collect();
    for fragment in tree.fragments() {
        let missing = &mut missing[fragment.face() as usize];
        missing.0 -= area(&mut fragment.lattice_vertices());
        missing.1 += 1.0;
    }
    // The outline of a fragment is shorter than 2⁵⁵ steps of the lattice, and its vertices are off
    // by less than two.
    let allowed = 2f64.powi(57);
    let wrong = missing.iter().position(|(area, n)| area.abs().max_element() > allowed * n);
    ensure(wrong.is_none(), || format!("the pieces of face {wrong:?} miss its area"))
}
