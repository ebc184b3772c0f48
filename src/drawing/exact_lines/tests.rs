use super::*;
use crate::drawing::cell::Corner;
use crate::drawing::map::VisibilityMap;
use crate::raster::Rays;
use crate::scene::Builtin;
use crate::tree::BspTree;
use crate::view::Camera;

/// Where floats cannot tell in the picture of a teapot, whose quads are not quite flat, pairs of floats do, and
/// as integers.
#[test]
fn pairs_of_floats_decide_in_a_drawing() {
    let scene = Builtin::Teapot.build(Some(6), 1);
    let tree = BspTree::build(scene.polygons()).unwrap();
    let (low, high) = scene.bounds().unwrap();
    let camera = Camera::looking_at_all([low, high], scene.up(), [320, 240]).unwrap();
    let map = VisibilityMap::of(&tree, Rays::new(&camera, tree.faces()).unwrap()).unwrap();
    let lines = &map.rims.lines;
    let is_twofold =
        |half: &HalfPlane| half.number().is_some_and(|n| lines.twofold.contains_key(&n));
    let (mut asked, mut decided) = (0, 0);
    for leaf in &map.leaves {
        // All lines in a tile against all corners there.
        let cells = || leaf.cells.iter().map(|visible| &visible.cell.sides);
        let mut halves: Vec<HalfPlane> = cells().flatten().map(|side| side.half).collect();
        halves.sort();
        halves.dedup_by_key(|half| half.line());
        let corners = cells().flat_map(|sides| {
            let before = sides.iter().cycle().skip(sides.len() - 1);
            sides.iter().zip(before).map(|(side, before)| (side.start, [before.half, side.half]))
        });
        for (Corner { at, radius }, [first, second]) in corners {
            for &half in &halves {
                let (line, all) = (lines.rounded(half), [first, second, half]);
                let is_clear = line.at(at).abs() > line.error + line.slope * radius;
                let is_end = half.line() == first.line() || half.line() == second.line();
                if is_clear || is_end || lines.share_point(all) || !all.iter().any(is_twofold) {
                    continue;
                }
                asked += 1;
                if let Some(side) = lines.twofold_side(all) {
                    let exact = all.map(|half| lines.exact(half));
                    assert_eq!(side, orientation(exact.each_ref()));
                    decided += 1;
                }
            }
        }
    }
    assert!(asked > 10_000 && decided * 5 > asked * 4, "{decided} of {asked}");
}
