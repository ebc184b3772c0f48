//! Area that is lost when polygons are cut.

use glam::DVec3;

use binspace::internals::Faces;

/// The difference between the areas of pieces and the areas of their faces.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct AreaError {
    /// Pieces.
    pub pieces: usize,
    /// The largest difference between a face's area and the area of its pieces, as a share of the face's
    /// area.
    pub worst: f64,
    /// The sum of these differences over all faces, as a share of the total area.
    pub total: f64,
}

/// Compares the areas of pieces, given by their face and their vertices in lattice units, with the areas of
/// the faces. `for_each` must pass every piece to its argument. Returns `None` if there is no piece.
///
/// Areas are computed in `f64` from the rounded vertices, so even correct pieces give a relative error of
/// some 1e-16.
pub fn area_error(
    faces: &Faces,
    for_each: impl FnOnce(&mut dyn FnMut(u32, &[[f64; 3]])),
) -> Option<AreaError> {
    let mut areas = vec![0.0; faces.len()];
    let mut pieces = 0;
    for_each(&mut |face, vertices| {
        pieces += 1;
        areas[face as usize] += area(vertices);
    });
    if pieces == 0 {
        return None;
    }
    let (mut worst, mut lost, mut all) = (0.0f64, 0.0, 0.0);
    for (face, &found) in (0..).zip(&areas) {
        let whole = area(faces.corners(face));
        let difference = (found - whole).abs();
        worst = worst.max(difference / whole);
        lost += difference;
        all += whole;
    }
    Some(AreaError { pieces, worst, total: lost / all })
}

fn area(vertices: &[[f64; 3]]) -> f64 {
    let Some((&first, rest)) = vertices.split_first() else { return 0.0 };
    let arm = |vertex: [f64; 3]| DVec3::from_array(vertex) - DVec3::from_array(first);
    let sum: DVec3 = rest.windows(2).map(|pair| arm(pair[0]).cross(arm(pair[1]))).sum();
    0.5 * sum.length()
}
