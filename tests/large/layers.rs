//! Layered scenes: thin, coplanar and noisy layers, walls of bricks.

use testkit::as_given::scene::{Point, Scene, add, between, each, tilt, times};
use testkit::prelude::*;

/// Rectangles in the planes z = 0, 1, 2, …, a thousand times as wide as the distance of the planes. With few
/// planes, each contains many rectangles.
fn rectangles(dice: &mut Dice, count: usize, planes: usize) -> Vec<Vec<Point>> {
    let rectangle = |k: usize| {
        let [x, y] = [0; 2].map(|_| between(dice, -4000, 4000));
        let [w, h] = [0; 2].map(|_| between(dice, 200, 2000));
        let z = (k % planes) as i64 - planes as i64 / 2;
        vec![[x, y, z], [x + w, y, z], [x + w, y + h, z], [x, y + h, z]]
    };
    (0..count).map(rectangle).collect()
}

pub(crate) fn parallel(dice: &mut Dice, n: usize) -> Scene {
    Scene::new("layers", rectangles(dice, n, n / 2)).shuffled(dice)
}

pub(crate) fn tilted(dice: &mut Dice, n: usize) -> Scene {
    Scene::new("tilted layers", each(rectangles(dice, n, n / 2), tilt)).shuffled(dice)
}

/// Triangles a thousand times as wide as high, each of which crosses the layers of others.
pub(crate) fn nearly_parallel(dice: &mut Dice, n: usize) -> Scene {
    let triangle = |k: usize| {
        let [x, y] = [0; 2].map(|_| between(dice, -20_000, 20_000));
        let z = (k % 50) as i64;
        let mut corner = |u: i64, v: i64| tilt([x + u, y + v, z + between(dice, -2, 2)]);
        vec![corner(-1000, 0), corner(900, -800), corner(300, 1100)]
    };
    Scene::new("nearly parallel", (0..n).map(triangle).collect()).shuffled(dice)
}

/// A few planes that cross, each full of rectangles that overlap.
pub(crate) fn crossing_planes(dice: &mut Dice, n: usize) -> Scene {
    let mut polygons = Vec::new();
    let turns: [fn(Point) -> Point; 3] = [|p| p, |[x, y, z]| [y, z, x], |p| tilt(p)];
    for (i, turn) in turns.into_iter().enumerate() {
        let planes = [1, 1, 3][i];
        polygons.extend(each(rectangles(dice, n / 3, planes), turn));
    }
    Scene::new("crossing planes", polygons).shuffled(dice)
}

/// Squares in one tilted plane, edge to edge and one over the other.
pub(crate) fn one_plane(dice: &mut Dice, n: usize) -> Scene {
    let across = n.isqrt() as i64;
    let square = |k: i64| {
        let (x, y) = (10 * (k % across), 10 * (k / across));
        let size = [10, 10, 10, 25][dice.below(4)];
        vec![[x, y, 1], [x + size, y, 1], [x + size, y + size, 1], [x, y + size, 1]]
    };
    let squares = (0..n as i64).map(square).collect();
    Scene::new("one plane", each(squares, tilt)).shuffled(dice)
}

/// The squares of `one_plane` as triangles whose corners are moved by up to one unit along each axis. The
/// tolerance is two units. Some triangles are off the plane by a few times the tolerance, and some stand on
/// it.
pub(crate) fn noisy_plane(dice: &mut Dice, n: usize) -> Scene {
    let across = n.isqrt() as i64;
    let triangle = |k: i64| {
        let (x, y) = (100 * (k % across), 100 * (k / across));
        let height = if dice.below(8) == 0 { between(dice, 5, 80) } else { 0 };
        let rough = if dice.below(4) == 0 { 6 } else { 1 };
        let mut corner = |u: i64, v: i64, z: i64| {
            let noise = [0; 3].map(|_| between(dice, -rough, rough));
            add(tilt(add([x, y, 0], [u, v, z])), noise)
        };
        vec![corner(0, 0, height), corner(180, 20, -height), corner(60, 150, 0)]
    };
    let triangles = (0..n as i64).map(triangle).collect();
    Scene::new("noisy plane", triangles).shuffled(dice).with_tolerance(2.0)
}

/// Noisy layers whose distance is between one and two tolerances.
pub(crate) fn noisy_layers(dice: &mut Dice, n: usize) -> Scene {
    let triangle = |k: usize| {
        let [x, y] = [0; 2].map(|_| between(dice, -2000, 2000));
        let z = (k % 40) as i64;
        let mut corner = |u: i64, v: i64| {
            let noise = [0; 3].map(|_| between(dice, -1, 1));
            add(tilt([x + u, y + v, z]), noise)
        };
        vec![corner(-300, 0), corner(200, -300), corner(100, 400)]
    };
    Scene::new("noisy layers", (0..n).map(triangle).collect()).shuffled(dice).with_tolerance(4.5)
}

/// Boxes side by side and one on the other. Each row is shifted, so sides coincide, and edges end in the
/// middle of other edges.
pub(crate) fn bricks(dice: &mut Dice, n: usize) -> Scene {
    let across = ((n / 6) as f64).cbrt().ceil() as i64;
    let mut polygons = Vec::new();
    for k in 0..n as i64 / 6 {
        let [x, y, z] = [k % across, k / across % across, k / across / across];
        let low = [4 * x + 2 * (z % 2), 3 * y + z % 3, 2 * z];
        let size = if dice.below(5) == 0 { [2, 3, 2] } else { [4, 3, 2] };
        polygons.extend(cuboid(low, size));
    }
    Scene::new("bricks", each(polygons, tilt)).shuffled(dice)
}

fn cuboid(low: Point, size: Point) -> Vec<Vec<Point>> {
    let corner = |i: usize| std::array::from_fn(|k| low[k] + size[k] * (i as i64 >> k & 1));
    let sides =
        [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    sides.map(|side| side.map(corner).to_vec()).to_vec()
}

/// Triangles, and other triangles that touch an edge of these in its middle or at its thirds.
pub(crate) fn t_junctions(dice: &mut Dice, n: usize) -> Scene {
    let mut polygons: Vec<Vec<Point>> = Vec::new();
    let across = ((n / 4) as f64).cbrt().ceil() as i64;
    for k in 0..n as i64 / 4 {
        let place = times(20, [k % across, k / across % across, k / across / across]);
        let mut corner = || add(place, times(6, [0; 3].map(|_| between(dice, -2, 2))));
        let [a, b, c, apex] = std::array::from_fn(|_| corner());
        let part = |t: i64| std::array::from_fn(|i| a[i] + (b[i] - a[i]) / 6 * t);
        let t = 1 + dice.below(5) as i64;
        polygons.extend([vec![a, b, c], vec![part(t), a, apex], vec![b, part(t), apex]]);
        polygons.push(vec![part(1), part(4), add(apex, [0, 0, 6])]);
    }
    Scene::new("T-junctions", super::heaps::with_area(polygons)).shuffled(dice)
}
