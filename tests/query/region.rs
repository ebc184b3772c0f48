//! Compares the fragments that meet a region with every fragment clipped in rationals.

use binspace::{Culling, Frustum};
use proptest::prelude::*;
use testkit::hits::Oracle;
use testkit::prelude::*;
use testkit::rational::{Plane, Point};
use testkit::shapes::sheet;
use testkit::shots::Shots;

/// The counts of all pairs of a fragment and a region.
#[derive(Clone, Copy, Debug, Default)]
struct Score {
    pairs: usize,
    /// Pairs that meet.
    met: usize,
    /// Pairs that meet only at their borders.
    touching: usize,
    /// Pairs that do not meet, although the fragment is behind none of the planes.
    passed: usize,
    /// Pairs that culling keeps although they do not meet.
    kept_needlessly: usize,
}

/// The part of a polygon in front of planes.
fn clip(polygon: &[Point], planes: &[Plane]) -> Vec<Point> {
    let mut part = polygon.to_vec();
    for plane in planes {
        let values: Vec<_> = part.iter().map(|point| plane.at(point)).collect();
        let mut next = Vec::new();
        for i in 0..part.len() {
            let j = (i + 1) % part.len();
            let sides = [i, j].map(|k| rational::sign(&values[k]));
            if sides[0].is_ge() {
                next.push(part[i].clone());
            }
            if sides[0].is_ne() && sides[0] == sides[1].reverse() {
                next.push(rational::crossing([&part[i], &part[j]], [&values[i], &values[j]]));
            }
        }
        part = next;
    }
    part
}

/// Far out, offsets and coordinates cancel to the last digit; at the ends of `f64`, products are beyond
/// its range.
#[test]
fn regions_of_scenes_far_out_and_at_the_ends_of_numbers() {
    let count = |polygon: [[f64; 3]; 3], normal: DVec3, offset: f64| {
        let tree = BspTree::build([polygon]).unwrap();
        let region = Frustum::new([(normal, offset)]);
        tree.fragments_in(&region).count()
    };
    // The region x + n·y ≥ c, where c is n·y in floats. y is far out and the same for all corners. The
    // rounding of c may be far larger than the scene.
    for y in [1e10, 1e15, 1e30, 1.1e38, 1e40, 1e45, 1e60, 1e150, 1e300] {
        let polygon = [[1.0, y, 1.0], [2.0, y, 1.0], [1.0, y, 2.0]];
        for n in [1.0, 2.0, 3.0, 5.0, 7.0] {
            let exact = rational::exact(n) * rational::exact(y) - rational::exact(n * y);
            // The largest x is 2.
            let is_met = |x: f64| exact.clone() + rational::exact(x) >= rational::exact(0.0);
            for sign in [1.0, -1.0] {
                let found = count(polygon, DVec3::new(sign, sign * n, 0.0), sign * n * y);
                let expected = if sign > 0.0 {
                    is_met(2.0)
                } else {
                    !is_met(1.0) || exact == rational::exact(-1.0)
                };
                assert_eq!(found, usize::from(expected), "{y} {n} {sign}");
            }
        }
    }
    for x in [1e308, 1.2e308, 1.7e308] {
        let polygon = [[x, 0.0, 0.0], [x, 1.0, 0.0], [x, 0.0, 1.0]];
        for (normal, share, expected) in
            [(0.75, 1.02, 0), (0.75, 1.0, 1), (0.75, 0.98, 1), (-0.75, -0.98, 0), (1e-9, 1e3, 0)]
        {
            let offset = f64::abs(normal) * x * share;
            let found = count(polygon, DVec3::new(normal, 0.0, 0.0), offset);
            assert_eq!(found, expected, "{x} {normal} {share}");
        }
    }
    // The least numbers of `f64`.
    let u = 5e-324;
    let polygon = [[10.0 * u, 0.0, 0.0], [10.0 * u, 40.0 * u, 0.0], [10.0 * u, 0.0, 40.0 * u]];
    for (steps, expected) in [(19.0, 1), (20.0, 1), (21.0, 0)] {
        assert_eq!(count(polygon, DVec3::new(2.0, 0.0, 0.0), steps * u), expected, "{steps}");
    }
}

/// A region of a random kind that is hard to decide for a scene.
fn region(tree: &BspTree, shots: &Shots<'_>, dice: &mut Dice) -> Frustum {
    let normal = |dice: &mut Dice| dice.whole_point(2);
    let through = |normal: DVec3, point: DVec3| (normal, normal.dot(point));
    match dice.below(8) {
        // Boxes with sides through corners, some of them flat.
        0 | 1 => {
            let [a, b] = [shots.corner(dice), shots.corner(dice)];
            Frustum::from_box([a.min(b), a.max(b)])
        }
        2 => {
            let [a, b] = [shots.corner(dice), shots.around(1.1, dice)];
            Frustum::from_box([a.min(b), a.max(b)])
        }
        // Regions that are a point or a line.
        3 => {
            let face = dice.below(tree.faces().len()) as u32;
            let a =
                if dice.below(2) == 0 { shots.corner(dice) } else { shots.on_plane(face, dice) };
            let mut b = a;
            if dice.below(2) == 0 {
                let axis = dice.below(3);
                b[axis] = shots.around(1.0, dice)[axis];
            }
            Frustum::from_box([a.min(b), a.max(b)])
        }
        // A wedge or a pyramid with its apex at a corner.
        4 | 5 => {
            let (apex, count) = (shots.corner(dice), 1 + dice.below(4));
            Frustum::new((0..count).map(|_| through(normal(dice), apex)).collect::<Vec<_>>())
        }
        // A region between parallel planes through corners.
        6 => {
            let (normal, [a, b]) = (normal(dice), [shots.corner(dice), shots.corner(dice)]);
            Frustum::new([through(normal, a), through(-normal, b)])
        }
        // The rounded planes of polygons.
        _ => {
            let planes = (0..1 + dice.below(3)).map(|_| {
                let fragment = tree.fragment(dice.below(tree.len()) as u32);
                let v: Vec<DVec3> = fragment.vertices().take(3).collect();
                let normal = (v[1] - v[0]).cross(v[2] - v[0]);
                through(if dice.below(2) == 0 { normal } else { -normal }, v[0])
            });
            Frustum::new(planes.collect::<Vec<_>>())
        }
    }
}

fn check(oracle: &Oracle<'_>, region: &Frustum, score: &mut Score) -> Result<(), String> {
    let tree = oracle.tree();
    if region.planes().iter().any(|(normal, offset)| !normal.is_finite() || !offset.is_finite()) {
        return Ok(());
    }
    let found: Vec<u32> = tree.fragments_in(region).collect();
    let planes: Vec<Plane> = region.planes().iter().map(|&(n, d)| oracle.plane(n, d)).collect();
    let mut order = Vec::new();
    let culling = Culling::NONE.with_frustum(region.clone());
    tree.order(Viewpoint::Direction(DVec3::Z)).culled(&culling).write_into(&mut order);
    let mut truth = Vec::new();
    for fragment in 0..tree.len() as u32 {
        let polygon = oracle.vertices(fragment);
        let part = clip(&polygon, &planes);
        let is_behind =
            |plane: &Plane| polygon.iter().all(|point| rational::sign(&plane.at(point)).is_lt());
        if part.is_empty() {
            score.passed += usize::from(!planes.iter().any(is_behind));
            score.kept_needlessly += usize::from(order.contains(&fragment));
        } else {
            truth.push(fragment);
            let on = |plane: &Plane| {
                part.iter().all(|point| rational::sign(&plane.at(point)) == Ordering::Equal)
            };
            score.touching += usize::from(planes.iter().any(on));
            if !order.contains(&fragment) {
                return Err(format!("culled: {fragment} by {region:?}"));
            }
        }
        score.pairs += 1;
    }
    score.met += truth.len();
    if found == truth { Ok(()) } else { Err(format!("{region:?}: {found:?}, in truth {truth:?}")) }
}

#[test]
fn fragments_in_regions_agree_with_rationals() {
    let cases = (hard::scene(), hard::heuristic(), any::<u64>());
    let score = tally(file!(), 96, cases, |score: &mut Score, (scene, by, seed)| {
        let tree = scene.build(by).map_err(fail)?;
        if tree.is_empty() {
            return Ok(());
        }
        let (oracle, shots) = (Oracle::new(&tree), Shots::new(tree.faces()));
        let mut dice = Dice(seed);
        for _ in 0..1 + 150 / tree.len().max(10) {
            let region = region(&tree, &shots, &mut dice);
            check(&oracle, &region, score).map_err(fail)?;
        }
        Ok(())
    });
    enough!(score.pairs > 5000, score.met > 1500; "{score:?}");
    enough!(score.touching > 300, score.passed > 100; "{score:?}");
}

/// Larger scenes, in which blocks of fragments are rejected or accepted at once, and scenes far from the
/// origin.
#[test]
fn regions_of_larger_scenes_have_the_fragments_of_rationals() {
    let mut score = Score::default();
    for (scene, move_by) in [
        (scene::city(300, 1), DVec3::ZERO),
        (scene::terrain(900, 1), DVec3::new(1e7, -3e5, 0.0)),
        (scene::random_triangles(160, 3), DVec3::splat(1e3)),
    ] {
        let moved = scene.polygons().map(|polygon| {
            polygon.points().iter().map(|&corner| corner + move_by).collect::<Vec<_>>()
        });
        let tree = BspTree::build(moved).unwrap();
        let (oracle, shots) = (Oracle::new(&tree), Shots::new(tree.faces()));
        let mut dice = Dice(5);
        enough!(tree.len() > 256; "blocks of blocks: {}", tree.len());
        for _ in 0..times(12) {
            let region = region(&tree, &shots, &mut dice);
            check(&oracle, &region, &mut score).unwrap();
        }
    }
    enough!(score.pairs > 10_000, score.met > 2000, score.kept_needlessly > 4; "{score:?}");
}

#[test]
fn planes_of_odd_numbers_keep_everything_or_nothing() {
    for scale in [0, -660, 660, -1015].map(|exponent| 2f64.powi(exponent)) {
        let tree = BspTree::build([0.0, 1.0].map(|z| sheet(2, z * scale, 4.0 * scale))).unwrap();
        let count = |normal: DVec3, offset: f64| {
            tree.fragments_in(&Frustum::new([(normal, offset)])).count()
        };
        for odd in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            assert_eq!(count(DVec3::Z, odd), 2);
            assert_eq!(count(DVec3::new(0.0, odd, 1.0), 0.0), 2);
        }
        assert_eq!(count(DVec3::ZERO, 0.0), 2);
        assert_eq!([count(DVec3::ZERO, 1.0), count(DVec3::ZERO, -1.0)], [0, 2]);
        assert_eq!([count(DVec3::Z, f64::MAX), count(DVec3::Z, f64::MIN)], [0, 2]);
        // Normals of every length.
        for length in [1.0, 4.0, 2f64.powi(200)] {
            assert_eq!(count(DVec3::Z * length, scale * length), 1, "{scale} {length}");
            assert_eq!(count(DVec3::NEG_Z * length, -scale * length), 2, "{scale} {length}");
            assert_eq!(count(DVec3::Z * length, (scale * length).next_up()), 0);
        }
        assert_eq!(tree.fragments_in(&Frustum::default()).count(), 2);
    }
    let nothing = BspTree::build::<[[f64; 3]; 3]>([]).unwrap();
    assert_eq!(nothing.fragments_in(&Frustum::default()).count(), 0);
}

/// A corner that the tolerance moves counts at its exact place, between two points of the grid.
#[test]
fn a_moved_corner_is_where_its_plane_is() {
    let room = BuildOptions::DEFAULT.with_bounds(DVec3::splat(-1.0), DVec3::ONE);
    let step = 2f64.powi(room.build([[DVec3::X, DVec3::Y, DVec3::Z]]).unwrap().grid().exponent);
    // On the plane z = x / 3 of the other corners, the third corner is at z = 2/3, and is stored at 1.
    let corners = [[0.0, 0.0, 0.0], [3.0, 0.0, 1.0], [2.0, 2.0, 1.0], [0.0, 3.0, 0.0]];
    let tree = room.build([corners.map(|corner| corner.map(|c| c * step))]).unwrap();
    assert_eq!((tree.len(), tree.preparation().flattened), (1, 1));
    assert_eq!(tree.grid().exponent, step.log2() as i32);
    let far_end = (DVec3::Y, 1.9 * step);
    for (height, is_in) in [(0.66, true), (0.69, false), (0.9, false), (1.0, false)] {
        let above = Frustum::new([far_end, (DVec3::Z, height * step)]);
        assert_eq!(tree.fragments_in(&above).count(), usize::from(is_in), "{height}");
    }
}

/// Blocks that are not full end where the tree ends.
#[test]
fn all_fragments_of_trees_of_every_size_are_in_all_of_space() {
    for count in (1..70).chain([255, 256, 257, 271]) {
        let square =
            |k: u32| [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0]].map(|[x, y]| [x, y, f64::from(k)]);
        let tree = BspTree::build((0..count).map(square)).unwrap();
        let room = Frustum::from_box([DVec3::splat(-1.0), DVec3::splat(300.0)]);
        for region in [Frustum::EVERYWHERE, room] {
            assert!(tree.fragments_in(&region).eq(0..count), "{count}");
        }
    }
}
