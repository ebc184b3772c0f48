//! Polygons that planes of cells cross, and that lie in them.

use testkit::prelude::*;

/// Random triangles with integer corners from −n to n.
pub(crate) fn triangles(dice: &mut Dice, count: usize, n: u32) -> Vec<Corners> {
    let mut corner = || dice.whole_point(n);
    (0..count).map(|_| vec![corner(), corner(), corner()]).collect()
}

/// Squares in planes x, y or z = integer, side by side and one above the other. Each of them lies in a plane
/// of cells for some division.
pub(crate) fn tiles(dice: &mut Dice, count: usize) -> Vec<Corners> {
    let tile = |_| {
        let axis = dice.below(3);
        let at = [0; 3].map(|_| dice.around_zero(3));
        let side = 1.0 + dice.below(2) as f64;
        let corner = |[u, v]: [f64; 2]| {
            let mut corner = DVec3::from_array(at);
            corner[(axis + 1) % 3] += u * side;
            corner[(axis + 2) % 3] += v * side;
            corner
        };
        [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]].map(corner).to_vec()
    };
    (0..count).map(tile).collect()
}

/// Stars in any orientation. They are not convex, so they are triangulated.
pub(crate) fn stars(dice: &mut Dice, count: usize) -> Vec<Corners> {
    let star = |_| {
        let mut some = || dice.whole_point(8);
        let (middle, u, v) = (some() * 2.0, some(), some());
        let around = [[4, 0], [1, 1], [0, 4], [-1, 1], [-4, 0], [-1, -1], [0, -4], [1, -1]];
        around.map(|[a, b]| middle + u * f64::from(a) + v * f64::from(b)).to_vec()
    };
    (0..count).map(star).collect()
}
