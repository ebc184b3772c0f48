//! Tips that a plane cuts off a face with moved corners, but would not cut off the given polygon.

use crate::mesh::exact::{Seen, check_moved};
use binspace::Fragment;
use testkit::prelude::*;

/// The distance of a quad's topmost given corner below the plane of the other corners: less than the
/// tolerance.
const OFF: f64 = 1.0 / 64.0;

/// A floor through the given topmost corner, triangles that cut the tip above it, and the quad.
fn polygons(triangles: usize, dice: &mut Dice) -> Vec<Vec<DVec3>> {
    let quad = [[2.0, 1.0, -2.625], [4.0, 4.0, -7.0], [1.0, 2.0, -2.625], [0.0, 0.0, -OFF]];
    let floor = [(-3.0, -3.0), (-2.0, -3.0), (-2.0, -2.0), (-3.0, -2.0)].map(|(x, y)| [x, y, -OFF]);
    let mut polygons = vec![floor.map(DVec3::from).to_vec()];
    for _ in 0..triangles {
        let share = 0.1 + 0.8 * dice.share();
        let at = DVec3::new(1.0 + share, 2.0 - share, -2.625) * (OFF / 2.625);
        let [u, v] = [(); 2].map(|()| DVec3::from([(); 3].map(|()| 2.0 * dice.share() - 1.0)));
        polygons.push(vec![at + u, at - u + v, at - u - v]);
    }
    polygons.push(quad.map(DVec3::from).to_vec());
    polygons
}

#[test]
fn triangles_fill_the_tips_of_moved_faces() {
    let (mut dice, mut seen) = (Dice(1), Seen::default());
    let options = BuildOptions::DEFAULT.with_heuristic(Heuristic::First).with_tolerance(OFF / 1.25);
    let mut tips = 0;
    for triangles in (1..8).cycle().take(40) {
        let polygons = polygons(triangles, &mut dice);
        let tree = options.build(&polygons).unwrap();
        let of_quad = tree.fragments().filter(|f| f.polygon() == triangles + 1);
        let is_tip = |f: &Fragment<'_>| f.vertices().any(|p| p.z > -OFF / 2.0);
        tips += of_quad.filter(is_tip).count();
        check_moved(&tree, &polygons, &mut seen).unwrap();
    }
    assert!(seen.triangles > 3000 && tips > 40, "{tips} tips, {seen:?}");
}
