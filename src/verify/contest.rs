//! Which wrong pixels the tolerance excuses, given the planes of a tree.

use crate::paint::Pieces;
use crate::raster::{Comparison, Image, Rays, compare_by, covers, is_open};
use crate::tree::BspTree;

/// Compares a painted picture of a tree with a true one. Contested are ties, and pixels in which the
/// tolerance, at the plane between the two fragments, leaves open which of them is painted last.
pub(super) fn compare_by_planes(
    tree: &BspTree,
    rays: &Rays,
    painted: &Image,
    truth: &Image,
) -> Comparison {
    let faces = tree.faces();
    if faces.tolerance() == 0.0 {
        return compare_by(rays, faces, [painted, truth], 0.0, |_, _| false);
    }
    let mut sorted = None;
    let mut pieces = Pieces::default();
    // The fragment of a face that covers a pixel.
    let mut fragment_at = |face: u32, pixel| {
        let by_face: &Vec<(u32, u32)> = sorted.get_or_insert_with(|| {
            let mut by_face: Vec<_> = tree.fragments().map(|f| (f.face(), f.index())).collect();
            by_face.sort_unstable();
            by_face
        });
        let first = by_face.partition_point(|&(other, _)| other < face);
        let of_face = by_face[first..].iter().take_while(|&&(other, _)| other == face);
        let mut fragments = of_face.map(|&(_, fragment)| fragment);
        fragments.find(|&fragment| {
            let piece = pieces.of(&tree.fragment(fragment));
            covers(rays, faces, piece, pixel)
        })
    };
    compare_by(rays, faces, [painted, truth], 0.0, |met, pixel| {
        let [nearest, other] = met.map(|face| fragment_at(face, pixel));
        let parting = nearest.zip(other).and_then(|(a, b)| tree.parting(a, b));
        parting.is_some_and(|(plane, [near, far])| {
            is_open(rays, faces, plane, [(met[0], near), (met[1], far)], pixel)
        })
    })
}
