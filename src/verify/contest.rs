//! Which wrong pixels the tolerance excuses, given the planes of a tree.

use crate::paint::Buffers;
use crate::raster::{Comparison, Image, Rays, Verdict, covers, is_open};
use crate::tree::BspTree;

/// Counts wrong pixels as contested if the tolerance, at the plane between the two fragments,
/// leaves open which of them is painted last.
pub(super) fn contest(
    tree: &BspTree,
    rays: &Rays,
    [painted, truth]: [&Image; 2],
    comparison: &mut Comparison,
) {
    let mut by_face: Vec<(u32, u32)> = tree.fragments().map(|f| (f.face(), f.index())).collect();
    by_face.sort_unstable();
    let mut buffers = Buffers::default();
    // The fragment of a face that covers a pixel.
    let mut fragment_at = |face: u32, pixel| {
        let first = by_face.partition_point(|&(other, _)| other < face);
        let of_face = by_face[first..].iter().take_while(|&&(other, _)| other == face);
        let mut fragments = of_face.map(|&(_, fragment)| fragment);
        fragments.find(|&fragment| {
            let piece = buffers.piece(&tree.fragment(fragment));
            covers(rays, tree.faces(), piece, pixel)
        })
    };
    let width = rays.size()[0] as usize;
    for (i, verdict) in comparison.verdicts.iter_mut().enumerate() {
        if *verdict != Verdict::WrongOrder {
            continue;
        }
        let pixel = [(i % width) as u32, (i / width) as u32];
        let met = [truth.faces()[i], painted.faces()[i]];
        let [nearest, other] = met.map(|face| fragment_at(face, pixel));
        let plane = nearest.zip(other).and_then(|(a, b)| tree.plane_between(a, b));
        if plane.is_some_and(|plane| is_open(rays, tree.faces(), plane, met, pixel)) {
            *verdict = Verdict::Contested;
            comparison.wrong_order -= 1;
            comparison.contested += 1;
        }
    }
}
