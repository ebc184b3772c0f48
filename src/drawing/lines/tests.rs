use glam::DVec3;

use super::{HalfPlane, Key, LineTable, Rounded, STEPS, compare};
use crate::BuildOptions;
use crate::drawing::map::drawing_rays;
use crate::drawing::primitives::Primitives;
use crate::progress::Watch;
use crate::random::SplitMix64;
use crate::tree::BspTree;
use crate::view::Camera;

const SIZE: [u32; 2] = [320, 200];

impl LineTable<'_> {
    /// The number of lines, without borders.
    pub(in crate::drawing) fn len(&self) -> usize {
        self.keys.len()
    }
}

/// All lines of all pieces that a camera sees.
pub(in crate::drawing) fn all_lines<'t>(
    tree: &'t BspTree,
    camera: &Camera,
) -> Option<Primitives<'t>> {
    let rays = drawing_rays(tree, camera, false).ok()?;
    Some(Primitives::new(tree, rays, vec![], &Watch::default()).unwrap())
}

/// Whether the difference of two lines in floats, in the picture, is within their errors.
fn agree(a: &Rounded, b: &Rounded, reach: [f64; 2]) -> bool {
    let [_, ax, ay] = a.k;
    let axis = if ax.abs() > ay.abs() { 1 } else { 2 };
    // The scales are powers of two: equal, or adjacent.
    let ratio = (a.k[axis] / b.k[axis]).log2().round().exp2();
    let error = 1.001 * (a.error + ratio * b.error);
    let corners = [[-1.0, -1.0], [-1.0, reach[1]], [reach[0], -1.0], reach];
    let slope = error / reach[0].min(reach[1]);
    corners.iter().all(|&at| (a.at(at) - ratio * b.at(at)).abs() <= error)
        && (1..3).all(|i| (a.k[i] - ratio * b.k[i]).abs() <= slope)
}

/// Quads in a cube of this size at this distance from the origin, most of them bent a little, so that
/// they are flattened.
pub(in crate::drawing) fn quads(random: &mut SplitMix64, size: f64, off: DVec3) -> Vec<[DVec3; 4]> {
    let quad = |_| {
        let [a, u, v] = [(); 3].map(|()| random.point(-size, size));
        let bend = random.point(-size, size) * 1e-8;
        [a, a + u, a + u + v + bend, a + v].map(|corner| corner + off)
    };
    (0..12).map(quad).collect()
}

/// Planar and slightly bent rings. They have so many corners that some edges pass through moved corners.
fn rings(random: &mut SplitMix64, size: f64, off: DVec3) -> Vec<Vec<DVec3>> {
    let ring = |_| {
        let [middle, u, v] = [(); 3].map(|()| random.point(-size, size));
        let mut corner = |k: u32| {
            let (sin, cos) = (f64::from(k) * std::f64::consts::TAU / 12.0).sin_cos();
            middle + u * cos + v * sin + random.point(-size, size) * 1e-10 + off
        };
        (0..12).map(&mut corner).collect()
    };
    (0..3).map(ring).collect()
}

#[test]
fn lines_in_floats_are_as_near_as_they_say() {
    let mut random = SplitMix64::new(7);
    let (mut lines, mut kinds) = (0, [0; 3]);
    for round in 0..60 {
        let size = [1.0, 1e-20, 1e9][round % 3];
        let off = random.point(-size, size) * [0.0, 3.0, 1e5][round / 3 % 3];
        let quads = quads(&mut random, size, off);
        let quads = quads.into_iter().map(Vec::from);
        let polygons: Vec<_> = quads.chain(rings(&mut random, size, off)).collect();
        let tree = BspTree::build(&polygons).unwrap();
        let towards = random.point(-1.0, 1.0) * size;
        let distance = [0.1, 3.0, 1e3, 1e6][round % 4];
        let eye = off + random.point(-1.0, 1.0) * size * distance;
        let perspective =
            Camera::perspective(eye, off + towards, DVec3::Z, 1.0 / distance.max(1.0), SIZE);
        let parallel = Camera::parallel(towards, DVec3::Z, off, 3.0 * size, SIZE);
        for camera in [perspective, parallel] {
            let Some(primitives) = all_lines(&tree, &camera.unwrap()) else { continue };
            let LineTable { keys, rounded, reach, .. } = &primitives.lines;
            for (key, rounded) in keys.iter().zip(rounded) {
                let exact = Rounded::new(&primitives.lines.exact_of(*key), *reach);
                assert!(agree(rounded, &exact, *reach), "{key:?}: {rounded:?}, not {exact:?}");
                lines += 1;
                kinds[match key {
                    Key::Edge(_) => 0,
                    Key::Upright(..) => 1,
                    Key::Cut(..) => 2,
                }] += 1;
            }
        }
    }
    assert!(lines > 5000 && kinds.iter().all(|&count| count > 100), "{lines}, {kinds:?}");
}

#[test]
fn edges_on_one_line_are_one() {
    // Walls side by side on the ground, and a beam along all walls, which shares no corners with the walls.
    let corner = |x: f64, z: f64| DVec3::new(x, 0.0, z);
    let wall = |x: f64, w: f64, z: f64, h: f64| {
        [corner(x, z), corner(x + w, z), corner(x + w, z + h), corner(x, z + h)]
    };
    let mut walls: Vec<_> = (0..7).map(|i| wall(f64::from(i), 1.0, 0.0, 2.0)).collect();
    walls.push(wall(0.25, 6.5, 2.0, 0.25));
    let tree = BspTree::build(&walls).unwrap();
    let eye = DVec3::new(1.3, -9.7, 0.6);
    let camera = Camera::perspective(eye, DVec3::new(3.0, 0.0, 1.0), DVec3::Z, 1.2, SIZE).unwrap();
    let primitives = all_lines(&tree, &camera).unwrap();
    // The ground, the common line and the upper edge of the beam; eight ends of walls and two of the beam.
    assert_eq!(primitives.lines.keys.len(), 3 + 8 + 2);
    let halves = |face: u32| primitives.outline(face);
    for face in 0..7 {
        // Walls are above the ground and below the beam; neighbouring walls share an edge from two sides.
        assert_eq!([halves(face)[0], halves(face)[2]], [halves(0)[0], halves(0)[2]]);
        let beam: HalfPlane = halves(7)[0];
        assert_eq!(halves(face)[2], beam.flipped(true));
    }
    assert_eq!(halves(2)[1], halves(3)[3].flipped(true));
}

/// Rectangles on a grid, level or with a slope of 1, and upright walls; edges and cuts lie on few lines.
fn squares() -> BspTree {
    let places = (0..12).flat_map(|x| (0..12).map(move |y| [x, y]));
    let square = |[x, y]: [i32; 2]| {
        let [x0, y0] = [x, y].map(f64::from);
        let [x1, y1] = [x0 + 1.0, y0 + 2.0];
        let slope = f64::from((x + y) % 3 - 1);
        [[x0, y0], [x1, y0], [x1, y1], [x0, y1]].map(|[x, y]| DVec3::new(x, y, slope * (x - 6.0)))
    };
    let walls = (0..12)
        .map(f64::from)
        .map(|x| [[x, 0.0, -7.0], [x, 13.0, -7.0], [x, 13.0, 7.0], [x, 0.0, 7.0]].map(DVec3::from));
    let polygons: Vec<_> = places.map(square).chain(walls).collect();
    BuildOptions::DEFAULT.with_tolerance(0.0).build(&polygons).unwrap()
}

/// The number of lines of a picture; asserts that no two lines are equal and that no line is a border.
fn lines(tree: &BspTree, camera: &Camera) -> usize {
    let primitives = all_lines(tree, camera).unwrap();
    let lines = &primitives.lines;
    let exact: Vec<_> = lines.keys.iter().map(|key| lines.exact_of(*key)).collect();
    for (i, line) in exact.iter().enumerate() {
        // Only lines in the picture.
        let at = lines.rounded[i].at(lines.reach.map(|side| 0.5 * side));
        if at.abs() > lines.reach[0] + lines.reach[1] {
            continue;
        }
        let other = exact[..i].iter().position(|other| compare(line, other).is_eq());
        assert_eq!(other, None, "{:?}", lines.keys[i]);
        let axis = usize::from(line[1].sign().is_eq());
        let [k0, k] = [line[0], line[axis + 1]].map(|k| k.to_f64());
        let border = lines.exact(HalfPlane::beyond(axis, (-k0 / k * STEPS).round() as i64));
        assert!(compare(line, &border).is_ne(), "{:?}", lines.keys[i]);
    }
    exact.len()
}

#[test]
fn edges_cuts_and_borders_on_one_line_are_one() {
    let (tree, middle) = (squares(), DVec3::new(6.0, 6.5, 0.0));
    for (height, size) in [(16.0, 64), (16.0, 37), (4.0, 1), (13.7, 50)] {
        let camera = Camera::parallel(DVec3::NEG_Z, DVec3::Y, middle, height, [size; 2]).unwrap();
        lines(&tree, &camera);
    }
    for eye in
        [DVec3::new(6.0, 6.5, 30.0), DVec3::new(9.3, -4.1, 22.0), DVec3::new(6.0, -20.0, 0.5)]
    {
        let camera = Camera::perspective(eye, middle, DVec3::X, 0.8, [320, 240]).unwrap();
        lines(&tree, &camera);
    }
}

/// All lines of the scene are closer to one another than feet can distinguish.
#[test]
fn more_lines_than_a_few_in_one_place_are_told_apart() {
    let corner = |x: i32, y: i32| DVec3::new(f64::from(x), f64::from(y), 0.0);
    let places = (0..20).flat_map(|x| (0..20).map(move |y| (x, y)));
    let tile = |(x, y)| [corner(x, y), corner(x + 1, y), corner(x + 1, y + 1), corner(x, y + 1)];
    let tree = BspTree::build(places.map(tile)).unwrap();
    let eye = DVec3::new(3.0, -5.0, 9.0) * (1u64 << 26) as f64;
    let camera = Camera::perspective(eye, DVec3::ZERO, DVec3::Z, 1.0, [64, 64]).unwrap();
    assert_eq!(lines(&tree, &camera), 42);
}
