//! Compares winding numbers with signed crossings of rays in integers. The directions are chosen so that rays
//! meet no edge.

use testkit::prelude::*;

type Point = [i128; 3];

fn minus(a: Point, b: Point) -> Point {
    std::array::from_fn(|i| a[i] - b[i])
}

fn cross(a: Point, b: Point) -> Point {
    std::array::from_fn(|i| {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        a[j] * b[k] - a[k] * b[j]
    })
}

fn dot(a: Point, b: Point) -> i128 {
    (0..3).map(|i| a[i] * b[i]).sum()
}

/// Convex polygons of whole numbers.
#[derive(Default)]
struct Bodies(Vec<Vec<Point>>);

/// Coordinates of points are multiples of 1 / `PARTS` of the polygons' unit.
const PARTS: i128 = 64;

impl Bodies {
    /// Adds a convex body, given as polygons of corner numbers, with fronts outwards, or with all fronts
    /// inwards.
    fn push(&mut self, corners: &[Point], polygons: &[&[usize]], is_inwards: bool) {
        for polygon in polygons {
            let mut outline: Vec<Point> = polygon.iter().map(|&k| corners[k]).collect();
            if is_inwards {
                outline.reverse();
            }
            self.0.push(outline);
        }
    }

    fn cuboid(&mut self, [a, b]: [Point; 2], is_inwards: bool) {
        let corner = |k: usize| -> Point {
            std::array::from_fn(|i| if k >> i & 1 == 1 { a[i].max(b[i]) } else { a[i].min(b[i]) })
        };
        let corners: Vec<Point> = (0..8).map(corner).collect();
        let sides: [&[usize]; 6] = [
            &[0, 2, 3, 1],
            &[4, 5, 7, 6],
            &[0, 1, 5, 4],
            &[2, 6, 7, 3],
            &[0, 4, 6, 2],
            &[1, 3, 7, 5],
        ];
        self.push(&corners, &sides, is_inwards);
    }

    fn tetrahedron(&mut self, mut corners: [Point; 4], is_inwards: bool) {
        let [a, b, c, d] = corners;
        if dot(cross(minus(b, a), minus(c, a)), minus(d, a)) < 0 {
            corners.swap(0, 1);
        }
        let sides: [&[usize]; 4] = [&[0, 2, 1], &[0, 1, 3], &[0, 3, 2], &[1, 2, 3]];
        self.push(&corners, &sides, is_inwards);
    }

    fn tree(&self, heuristic: Heuristic) -> BspTree {
        let polygon = |outline: &Vec<Point>| -> Vec<[f64; 3]> {
            outline.iter().map(|corner| corner.map(|c| c as f64)).collect()
        };
        let options = BuildOptions::DEFAULT.with_heuristic(heuristic);
        options.build(self.0.iter().map(polygon)).unwrap()
    }

    /// The winding number around a point in parts of the unit; `None` on the boundary.
    fn winding(&self, point: Point, dice: &mut Dice) -> Option<i32> {
        'directions: loop {
            let ahead: Point = [0; 3].map(|_| i128::from(dice.around_zero(1000) as i64));
            let mut winding = 0;
            for outline in &self.0 {
                let corners: Vec<Point> =
                    outline.iter().map(|&corner| minus(corner.map(|c| c * PARTS), point)).collect();
                let normal = cross(minus(corners[1], corners[0]), minus(corners[2], corners[0]));
                let (way, off) = (dot(normal, ahead), dot(normal, corners[0]));
                let edges = || corners.iter().zip(corners.iter().cycle().skip(1));
                if off == 0 {
                    // Around the point, seen along the normal.
                    if edges().all(|(&a, &b)| dot(normal, cross(a, b)) >= 0) {
                        return None;
                    }
                    // The point is in the plane, beside the polygon. A ray that leaves the plane does not
                    // return.
                    if way == 0 {
                        continue 'directions;
                    }
                    continue;
                }
                let sides: Vec<i128> =
                    edges().map(|(&a, &b)| dot(ahead, cross(a, b)).signum()).collect();
                let is_ahead = way.signum() == off.signum();
                if sides.iter().all(|&side| side > 0) || sides.iter().all(|&side| side < 0) {
                    if is_ahead && way != 0 {
                        winding += way.signum() as i32;
                    }
                } else if sides.contains(&0) {
                    continue 'directions;
                }
            }
            return Some(winding);
        }
    }
}

#[test]
fn winding_numbers_agree_with_rays_in_integers() {
    let mut dice = Dice(29);
    let [mut boundary, mut inside, mut outside, mut overlaps, mut negative] = [0; 5];
    for round in 0..times(12) {
        let mut bodies = Bodies::default();
        let mut corner = || [0; 3].map(|_| i128::from(dice.around_zero(20) as i64));
        for k in 0..4 {
            let (a, b) = (corner(), corner());
            if (0..3).all(|i| a[i] != b[i]) {
                bodies.cuboid([a, b], k == 3);
            }
            let corners = [corner(), corner(), corner(), corner()];
            let [a, b, c, d] = corners;
            if dot(cross(minus(b, a), minus(c, a)), minus(d, a)) != 0 {
                bodies.tetrahedron(corners, k == 2);
            }
        }
        let tree =
            bodies.tree([Heuristic::Auto, Heuristic::First, Heuristic::FreePlanes][round % 3]);
        assert_eq!(tree.open_edges().count(), 0);
        for k in 0..400 {
            let outline = &bodies.0[dice.below(bodies.0.len())];
            let [a, b, c] = [0, 1, 2].map(|i| outline[i].map(|c| c * PARTS));
            let [u, v] = [minus(b, a), minus(c, a)];
            let point: Point = match k % 6 {
                0 => a,
                1 => std::array::from_fn(|i| a[i] + u[i] / 2),
                2 => std::array::from_fn(|i| a[i] + (u[i] + v[i]) / 4),
                3 => {
                    let [s, t] = [0; 2].map(|_| i128::from(dice.around_zero(3) as i64));
                    std::array::from_fn(|i| a[i] + s * u[i] + t * v[i])
                }
                // Above and below corners and edges, where the ray meets them.
                4 => [a[0], a[1], a[2] + i128::from(dice.around_zero(900) as i64)],
                // Between two corners, mostly of two bodies.
                _ => {
                    let other = bodies.0[dice.below(bodies.0.len())][0];
                    std::array::from_fn(|i| (a[i] + other[i] * PARTS) / 2)
                }
            };
            let expected = bodies.winding(point, &mut dice);
            let found = tree.winding_number(point.map(|c| c as f64 / PARTS as f64)).unwrap();
            assert_eq!(found, expected, "round {round}: {point:?} / {PARTS}");
            match expected {
                None => boundary += 1,
                Some(0) => outside += 1,
                Some(winding) => {
                    inside += 1;
                    overlaps += usize::from(winding.abs() > 1);
                    negative += usize::from(winding < 0);
                }
            }
        }
    }
    enough!(boundary > 800, inside > 200, outside > 500; "{boundary} {inside} {outside}");
    enough!(overlaps > 20, negative > 30; "{overlaps} {negative}");
}

/// Curved bodies of a generator, with poles, and large coordinates.
#[test]
fn a_sphere_is_closed_and_has_an_inside() {
    let tree = BspTree::build(scene::sphere(500).polygons()).unwrap();
    assert_eq!(tree.open_edges().count(), 0);
    let [low, high] = tree.bounds().unwrap();
    let (middle, radius) = ((low + high) * 0.5, (high - low).max_element() * 0.5);
    let mut dice = Dice(30);
    for _ in 0..times(300) {
        let way = dice.point(-1.0, 1.0).normalize_or(DVec3::X);
        assert_eq!(tree.winding_number(middle + way * (0.9 * radius)), Ok(Some(1)), "{way}");
        assert_eq!(tree.winding_number(middle + way * (1.1 * radius)), Ok(Some(0)), "{way}");
    }
    assert_eq!(tree.winding_number([f64::NAN; 3]), Ok(Some(0)));
    assert_eq!(tree.winding_number([1e300; 3]), Ok(Some(0)));
}

#[test]
fn open_edges_are_named() {
    let mut bodies = Bodies::default();
    bodies.cuboid([[0, 0, 0], [2, 2, 2]], false);
    bodies.cuboid([[5, 5, 5], [9, 9, 9]], false);
    // Without the top of the second body: polygon 7 of 12.
    bodies.0.remove(7);
    let tree = bodies.tree(Heuristic::Auto);
    let open: Vec<(usize, usize)> = tree.open_edges().collect();
    assert_eq!(open.len(), 4);
    for &(polygon, corner) in &open {
        let outline = &bodies.0[polygon];
        let ends = [outline[corner], outline[(corner + 1) % outline.len()]];
        assert!(polygon >= 6 && ends.iter().all(|end| end[2] == 9), "{polygon} {ends:?}");
    }
    let error = tree.winding_number([1.0; 3]).unwrap_err();
    assert_eq!(error.polygon(), Some(open[0].0));
    assert!(error.to_string().contains("open edge"), "{error}");
    // A sheet inside a body does not close it twice.
    bodies.0.push(vec![[5, 5, 9], [9, 5, 9], [9, 9, 9], [5, 9, 9]]);
    let tree = bodies.tree(Heuristic::Auto);
    assert_eq!(tree.winding_number([6.0, 7.0, 8.0]), Ok(Some(1)));
    bodies.0.push(vec![[6, 6, 6], [7, 6, 6], [6, 7, 6]]);
    assert_eq!(bodies.tree(Heuristic::Auto).open_edges().count(), 3);
    // If the same faces are given a second time, each edge is open twice.
    bodies.0.push(vec![[6, 6, 6], [7, 6, 6], [6, 7, 6]]);
    assert_eq!(bodies.tree(Heuristic::Auto).open_edges().count(), 6);
}

/// Along an open edge, all edges of its direction are open. An edge that an equal edge closes is open where a
/// third edge runs along it.
#[test]
fn all_edges_of_the_more_frequent_direction_are_open() {
    let (a, b) = ([0, 0, 0], [4, 0, 0]);
    let there = |z: i128| vec![a, b, [2, 3, z]];
    let back = |z: i128| vec![b, a, [2, 3, z]];
    let named = |polygons: &[Vec<Point>]| -> Vec<usize> {
        let tree = Bodies(polygons.to_vec()).tree(Heuristic::Auto);
        let along_x = |&(polygon, corner): &(usize, usize)| {
            let outline = &polygons[polygon];
            outline[corner][1] == 0 && outline[(corner + 1) % outline.len()][1] == 0
        };
        tree.open_edges().filter(along_x).map(|(polygon, _)| polygon).collect()
    };
    assert_eq!(named(&[there(1), back(2)]), []);
    assert_eq!(named(&[there(1), back(2), there(3)]), [0, 2]);
    assert_eq!(named(&[there(1), back(2), there(3), back(4), back(5)]), [1, 3, 4]);
    assert_eq!(named(&[there(1), there(2), back(3), back(4)]), []);
    // From −4 to 8, along the edge from 0 to 4.
    let long = vec![[-4, 0, 0], [8, 0, 0], [2, 3, 9]];
    assert_eq!(named(&[there(1), back(2), long.clone()]), [0, 2]);
    let half = vec![[2, 0, 0], a, [2, 3, 8]];
    assert_eq!(named(&[there(1), half.clone()]), [0]);
    let other_half = vec![b, [2, 0, 0], [2, 3, 8]];
    assert_eq!(named(&[there(1), half, other_half]), []);
}

/// A hexahedron of eight corners: a cube whose corners are moved so that its quads are bent.
fn hexahedron(dice: &mut Dice, is_wild: bool) -> Vec<Vec<[f64; 3]>> {
    let corners: Vec<[f64; 3]> = (0..8)
        .map(|k| {
            [0, 1, 2].map(|axis| match is_wild {
                true => dice.around_zero(40),
                false => f64::from(2 * (k >> axis & 1) - 1) * 24.0 + dice.around_zero(7),
            })
        })
        .collect();
    let sides =
        [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    sides.map(|side| side.map(|k: usize| corners[k]).to_vec()).to_vec()
}

/// Many of the bent quads overlap themselves in the projection along their main axis. Rays in integers decide
/// the winding numbers, from the triangles that the library made.
#[test]
fn hexahedra_of_bent_quads_are_closed() {
    let mut dice = Dice(31);
    let (mut closed, mut crossing, mut inside, mut outside) = ([0; 2], 0, 0, 0);
    for round in 0..times(2400) {
        let is_wild = round % 2 == 0;
        let quads = hexahedron(&mut dice, is_wild);
        let single: Vec<Vec<[f32; 3]>> =
            quads.iter().map(|quad| quad.iter().map(|p| p.map(|c| c as f32)).collect()).collect();
        let tree = match round / 2 % 3 {
            0 => BuildOptions::DEFAULT.build(&quads),
            1 => BuildOptions::DEFAULT.build(&single),
            _ => BuildOptions::DEFAULT.with_tolerance(0.0).build(&quads),
        }
        .expect("a tree");
        if tree.preparation().crossing > 0 {
            // A quad that is planar and crosses itself.
            crossing += 1;
            continue;
        }
        assert_eq!(tree.open_edges().count(), 0, "{quads:?}");
        closed[usize::from(is_wild)] += 1;
        if round % 16 > 1 {
            continue;
        }
        let faces = tree.faces();
        let whole = |&corner: &[f64; 3]| -> Point {
            faces.lattice().to_world(corner).to_array().map(|c| c as i128)
        };
        let faces = (0..faces.len() as u32).map(|f| faces.corners(f).iter().map(whole).collect());
        let body = Bodies(faces.collect());
        for _ in 0..40 {
            let point: Point = [0; 3].map(|_| dice.around_zero(40 * PARTS as u32) as i128);
            let expected = body.winding(point, &mut dice);
            let found = tree.winding_number(point.map(|c| c as f64 / PARTS as f64));
            assert_eq!(found, Ok(expected), "{point:?} / {PARTS} in {quads:?}");
            assert!(is_wild || matches!(expected, None | Some(0 | 1)), "{quads:?}");
            inside += usize::from(expected.is_some_and(|times| times != 0));
            outside += usize::from(expected == Some(0));
        }
        if !is_wild {
            assert_eq!(tree.winding_number([0.0; 3]), Ok(Some(1)));
            assert_eq!(tree.winding_number([0.0, 0.0, 40.0]), Ok(Some(0)));
        }
    }
    enough!(closed.iter().all(|&count| count > 1000), crossing < 20; "{closed:?} {crossing}");
    enough!(inside > 1000, outside > 1000; "{inside} {outside}");
}

/// Nearer to a side than boxes are wide.
#[test]
fn points_next_to_a_side_are_inside_or_outside() {
    let mut bodies = Bodies::default();
    bodies.cuboid([[0, 0, 0], [2, 2, 2]], false);
    let tree = bodies.tree(Heuristic::Auto);
    for axis in 0..3 {
        for near in [1e-3, 1e-7, 1e-10, 1e-14] {
            for (at, expected) in [(near, 1), (-near, 0), (2.0 - near, 1), (2.0 + near, 0)] {
                let mut point = [0.75; 3];
                point[axis] = at;
                assert_eq!(tree.winding_number(point), Ok(Some(expected)), "{point:?}");
            }
        }
    }
}

/// A prism with a corner in the middle of an edge of the top. The top is bent or not convex, and its
/// triangles skip this corner. In another case, a side is in two halves beside an undivided edge of the top.
#[test]
fn corners_on_straight_edges_keep_a_body_closed() {
    // The outline of the top has a corner in the middle of its first edge, and a dent.
    let outline = [[0, 0], [2, 0], [4, 0], [4, 4], [2, 2], [0, 4]].map(|[x, y]| [x, y, 0]);
    for (top, splits) in
        [(vec![0, 1, 2, 3, 4, 5], 2), (vec![0, 2, 3, 4, 5], 2), (vec![0, 2, 3, 4, 5], 1)]
    {
        let mut bodies = Bodies::default();
        let raised = |p: Point| [p[0], p[1], 3];
        bodies.0.push(top.iter().map(|&k| raised(outline[k])).collect());
        bodies.0.push(top.iter().rev().map(|&k| outline[k]).collect());
        let way: Vec<usize> =
            if splits == 2 { vec![0, 1, 2, 3, 4, 5] } else { vec![0, 2, 3, 4, 5] };
        for (i, &k) in way.iter().enumerate() {
            let (a, b) = (outline[k], outline[way[(i + 1) % way.len()]]);
            bodies.0.push(vec![a, b, raised(b), raised(a)]);
        }
        for heuristic in [Heuristic::Auto, Heuristic::First] {
            let tree = bodies.tree(heuristic);
            assert_eq!(tree.open_edges().count(), 0, "{top:?} {splits}");
            for x in 0..9 {
                for y in 0..9 {
                    let at = [f64::from(x) * 0.5 + 0.125, f64::from(y) * 0.5 + 0.25, 1.5];
                    let is_inside = at[0] < 4.0 && at[1] < 4.0 && at[1] < 2.0 + (at[0] - 2.0).abs();
                    let expected = Some(i32::from(is_inside));
                    assert_eq!(tree.winding_number(at), Ok(expected), "{at:?} {top:?}");
                }
            }
        }
        // Without one of the two halves of a side, the whole edge of the top is open.
        bodies.0.remove(2);
        assert!(bodies.tree(Heuristic::Auto).open_edges().count() > 0);
    }
}

/// A box whose side at x = 1 has a corner off the plane, by less than the tolerance. The side is nearly
/// upright, or it leans. After flattening, it has almost no area seen from below, and its plane may meet a
/// line along z anywhere. The neighbours of the side have the given corner.
#[test]
fn a_flattened_side_closes_a_body_for_points_far_below() {
    let mut flattened = 0;
    for (off, lean) in [(4e-4, 0.0), (4e-4, 1e-6), (4e-4, -1e-6), (-4e-4, 1e-6), (-4e-4, -1e-6)] {
        for first in 0..4 {
            let bottom = [[0.0, 0.0, 0.0], [1.0, -0.2, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
            let top =
                [[0.0, 0.0, 1.0], [1.0 + lean, 0.0, 1.0], [1.0 + off, 1.0, 1.0], [0.0, 1.0, 1.0]];
            let mut polygons = vec![top.to_vec(), bottom.into_iter().rev().collect()];
            for k in 0..4 {
                let next = (k + 1) % 4;
                let side = [bottom[k], bottom[next], top[next], top[k]];
                // The first side is not planar, so it becomes triangles.
                let parts = if k == 0 {
                    vec![vec![0, 1, 2], vec![0, 2, 3]]
                } else {
                    vec![vec![0, 1, 2, 3]]
                };
                for mut part in parts {
                    if part.len() == 4 {
                        part.rotate_left(first);
                    }
                    polygons.push(part.into_iter().map(|k| side[k]).collect());
                }
            }
            let tree = BuildOptions::DEFAULT.with_tolerance(1e-3).build(&polygons).unwrap();
            assert_eq!(tree.open_edges().count(), 0);
            flattened += tree.preparation().flattened;
            assert_eq!(tree.winding_number([0.5, 0.5, 0.5]), Ok(Some(1)));
            for share in 1..20 {
                let x = 1.0 + off * f64::from(share) / 16.0;
                for (y, z) in [0.1, 0.5, 0.9]
                    .into_iter()
                    .flat_map(|y| [-3.0, -90.0, 2.0, 300.0].map(|z| (y, z)))
                {
                    let found = tree.winding_number([x, y, z]);
                    assert_eq!(found, Ok(Some(0)), "{off} {lean} {first}: {x} {y} {z}");
                }
            }
        }
    }
    assert!(flattened >= 20, "{flattened}");
}
