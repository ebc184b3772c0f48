//! Triangles in place of faces that are not convex or not planar.

use glam::DVec3;

/// Ear clipping was needed and is compiled out.
#[derive(Debug)]
pub(super) struct Unavailable;

/// Triangles, as corner numbers, of a polygon that is convex seen along some axis: a quad is cut
/// along its shorter diagonal, others fan out from their first corner.
pub(super) fn convex(corners: &[[f64; 3]]) -> Vec<[usize; 3]> {
    let diagonal = |a: usize, b: usize| DVec3::from(corners[a]).distance_squared(corners[b].into());
    if corners.len() == 4 && diagonal(1, 3) < diagonal(0, 2) {
        return vec![[1, 2, 3], [1, 3, 0]];
    }
    (1..corners.len() - 1).map(|k| [0, k, k + 1]).collect()
}

/// Triangles, as corner numbers, of any polygon, facing as it does: by ear clipping in the
/// projection along the main axis of its vector area (Newell's normal). A polygon that crosses
/// itself is covered as far as ear clipping goes.
#[cfg(feature = "triangulate")]
pub(super) fn any(corners: &[[f64; 3]]) -> Result<Vec<[usize; 3]>, Unavailable> {
    let next = corners.iter().cycle().skip(1);
    let area: DVec3 = corners.iter().zip(next).map(|(&a, &b)| DVec3::from(a).cross(b.into())).sum();
    let drop = area.abs().max_position();
    let (x, y) = ((drop + 1) % 3, (drop + 2) % 3);
    let flat: Vec<[f64; 2]> = corners.iter().map(|corner| [corner[x], corner[y]]).collect();
    let mut indices: Vec<u32> = Vec::new();
    earcut::Earcut::new().earcut_slice(&flat, &[], &mut indices);
    let oriented = |triple: &[u32]| {
        let [a, b, c] = [triple[0] as usize, triple[1] as usize, triple[2] as usize];
        let side = |p: usize, q: usize| (flat[p][0] - flat[a][0]) * (flat[q][1] - flat[a][1]);
        let faces_up = side(b, c) > side(c, b);
        if faces_up == (area[drop] > 0.0) { [a, b, c] } else { [a, c, b] }
    };
    Ok(indices.chunks_exact(3).map(oriented).collect())
}

/// Ear clipping is compiled out.
#[cfg(not(feature = "triangulate"))]
pub(super) fn any(_: &[[f64; 3]]) -> Result<Vec<[usize; 3]>, Unavailable> {
    Err(Unavailable)
}
