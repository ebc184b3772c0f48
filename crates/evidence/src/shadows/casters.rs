//! The faces that may throw a shadow on a face.

use binspace::glam::DVec3;
use binspace::{BspTree, Frustum};

/// The distance by which the sides of a pyramid are moved outwards, as a share of the cube of the largest
/// coordinate. The equation of a side is a product of three lengths, each with an error of some 10⁻¹⁵ of this
/// coordinate. Too large: more faces are tried without effect. Too small: a face that casts a shadow is lost.
const WIDER: f64 = 1e-11;

/// The faces of a tree that have a point between a lamp and a face with the given corners, in ascending
/// order. The list may contain some other faces.
///
/// Every caster of a shadow on a face intersects the pyramid between the lamp and the face. The tree's boxes
/// find the candidates; doubtful ones are kept, so no shadow is lost.
pub(super) fn casters(tree: &BspTree, corners: &[DVec3], lamp: DVec3) -> Vec<u32> {
    let within = tree.fragments_in(&pyramid(corners, lamp));
    let mut faces: Vec<u32> = within.map(|fragment| tree.fragment(fragment).face()).collect();
    faces.sort_unstable();
    faces.dedup();
    faces
}

/// The pyramid from a point to a convex polygon, a little wider.
fn pyramid(corners: &[DVec3], lamp: DVec3) -> Frustum {
    let middle = corners.iter().sum::<DVec3>() / corners.len() as f64;
    let reach = corners.iter().fold(lamp.abs(), |reach, corner| reach.max(corner.abs()));
    let ease = WIDER * reach.max_element().powi(3);
    let next = corners.iter().cycle().skip(1);
    let sides = corners.iter().zip(next).map(|(&p, &q)| (p - lamp).cross(q - lamp));
    let inwards = |normal: DVec3, inside: DVec3| match normal.dot(inside - lamp) < 0.0 {
        true => -normal,
        false => normal,
    };
    let sides = sides.map(|normal| inwards(normal, middle)).map(|n| (n, n.dot(lamp) - ease));
    let arms = corners.windows(2).map(|pair| (pair[0] - middle).cross(pair[1] - middle));
    // The polygon's own plane, with the lamp in front.
    let base = -inwards(arms.sum(), middle);
    Frustum::new(sides.chain([(base, base.dot(middle) - ease)]))
}
