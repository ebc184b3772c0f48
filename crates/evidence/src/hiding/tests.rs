//! Tests `Hiding` against rays, permutations and pictures.

use binspace::internals::{Eye, SplitMix64};
use binspace::raster::{Outline, Painter, Piece, compare, zbuffer};
use dashu_int::IBig;
use dashu_ratio::RBig;
use num_traits::One;
use testkit::prelude::*;

use testkit::model::Face;
use testkit::vector::{difference, scalar};

use super::cone::Seen;
use super::{Hiding, overlaps_in_depth};
use crate::method::Newell;
use crate::{Family, place};

fn faces(scene: &Scene) -> Faces {
    Faces::new(scene.polygons(), Some(0.0)).unwrap().0
}

fn camera(scene: &Scene, from: DVec3) -> Camera {
    let (low, high) = scene.bounds().unwrap();
    let (centre, reach) = ((low + high) * 0.5, (high - low).max_element());
    let eye = centre + from.normalize() * 2.5 * reach;
    Camera::perspective(eye, centre, DVec3::new(0.1, 0.2, 1.0), 0.9, [160, 120]).unwrap()
}

type Vector = [RBig; 3];

/// The distance along a ray at which it meets the inside of a face, in rationals.
fn met(faces: &Faces, face: u32, from: &Vector, along: &Vector) -> Option<RBig> {
    let face = Face::new(faces, face);
    let speed = scalar(&face.plane.normal, along);
    if speed.is_zero() {
        return None;
    }
    let t = -face.plane.at(from) / speed;
    let at: Vector = std::array::from_fn(|i| &from[i] + &along[i] * &t);
    (face.place(&at).is_gt() && t.is_positive()).then_some(t)
}

/// Every detected pair is proved by a ray, in rationals: the ray through the middle of the part in which the
/// first face hides the second.
fn check_by_witnesses(faces: &Faces, eye: DVec3) -> usize {
    let viewpoint = Viewpoint::eye(eye);
    let hiding = Hiding::of(faces, viewpoint);
    let quad = place::eye(&Eye::new(viewpoint, faces.lattice()));
    let from: Vector = std::array::from_fn(|i| RBig::from(quad[i].clone()));
    let mut checked = 0;
    for a in 0..faces.len() as u32 {
        for b in (0..faces.len() as u32).filter(|&b| b != a) {
            let [p, q] = [a, b].map(|f| Seen::new(faces, f, &quad).unwrap());
            let part = p.within(&q);
            assert_eq!(part.is_empty(), q.within(&p).is_empty());
            if part.is_empty() {
                assert!(!hiding.hides(a, b));
                continue;
            }
            // Rays through the middle, and near each vertex: at 2⁻³⁰ of the way from the vertex to the
            // middle.
            let points: Vec<Vector> = part
                .iter()
                .map(|v| {
                    std::array::from_fn(|i| RBig::from_parts_signed(v[i].clone(), v[3].clone()))
                })
                .collect();
            let count = RBig::from(IBig::from(points.len()));
            let middle: Vector = std::array::from_fn(|i| {
                testkit::rational::total(points.iter().map(|p| p[i].clone())) / &count
            });
            let share = RBig::from_parts_signed(IBig::one(), IBig::one() << 30);
            let near = |p: &Vector| -> Vector {
                std::array::from_fn(|i| &p[i] + (&middle[i] - &p[i]) * &share)
            };
            let first = points.iter().map(near).chain([middle.clone()]).any(|target| {
                let along = difference(&target, &from);
                let [t, u] = [a, b].map(|face| met(faces, face, &from, &along).unwrap());
                t < u
            });
            assert_eq!(hiding.hides(a, b), first, "{a} {b}");
            checked += usize::from(first);
        }
    }
    let all = || 0..faces.len() as u32;
    let both =
        |a: u32| all().filter(|&b| b < a && hiding.hides(a, b) && hiding.hides(b, a)).count();
    let mutual: usize = all().map(both).sum();
    assert_eq!((hiding.mutual(), hiding.pairs()), (mutual, checked - mutual));
    checked
}

#[test]
fn hiding_agrees_with_single_rays() {
    let mut checked = 0;
    for seed in 1..4 {
        checked += check_by_witnesses(
            &faces(&Family::Penetration.scene(14.0, seed)),
            DVec3::new(9.0, 5.0, 7.0),
        );
    }
    checked += check_by_witnesses(&faces(&Family::Cycle.scene(5.0, 1)), DVec3::new(2.0, 1.0, 3.0));
    assert!(checked > 200, "{checked}");
}

/// Rays through the centres of pixels. In each pixel, the face in the judge's picture hides the face in the
/// judge's picture without the visible faces.
#[test]
fn nothing_that_hides_in_a_picture_is_overlooked() {
    let scene = Family::Penetration.scene(12.0, 5);
    let faces = faces(&scene);
    let camera = camera(&scene, DVec3::new(1.0, 2.0, 3.0));
    let hiding = Hiding::of(&faces, camera.viewpoint());
    let rays = Rays::new(&camera, &faces).unwrap();
    let truth = zbuffer(&rays, &faces);
    let mut found = 0;
    for a in 0..faces.len() as u32 {
        for b in 0..faces.len() as u32 {
            let draw = |only: &[u32]| {
                let mut painter = Painter::new(&rays, &faces);
                only.iter().for_each(|&face| painter.draw(Piece { face, outline: Outline::Whole }));
                painter.finish()
            };
            // A pixel that both cover and in which A is the visible face proves that A hides B.
            let (one, other) = (draw(&[a]), draw(&[b]));
            let pixels = one.faces().iter().zip(other.faces()).zip(truth.image().faces());
            let hides = pixels.filter(|((p, q), t)| **p == a && **q == b && **t == a).count();
            if a != b && hides > 0 {
                assert!(hiding.hides(a, b), "{a} {b}");
                found += 1;
            }
        }
    }
    assert!(found > 20, "{found}");
}

fn wrong(rays: &Rays, faces: &Faces, order: &[u32]) -> usize {
    let mut painter = Painter::new(rays, faces);
    order.iter().for_each(|&face| painter.draw(Piece { face, outline: Outline::Whole }));
    compare(rays, faces, &painter.finish(), zbuffer(rays, faces).image()).wrong()
}

/// All orders of this many faces.
fn orders(count: u32) -> Vec<Vec<u32>> {
    let mut all = vec![vec![]];
    for face in 0..count {
        let with = |order: &Vec<u32>| -> Vec<Vec<u32>> {
            let insert = |at: usize| {
                let mut longer = order.clone();
                longer.insert(at, face);
                longer
            };
            (0..=order.len()).map(insert).collect()
        };
        all = all.iter().flat_map(with).collect();
    }
    all
}

#[test]
fn scenes_without_cycles_are_painted_whole_and_those_with_one_in_no_order() {
    let (mut with, mut without) = (0, 0);
    for seed in 1..40 {
        let mut random = SplitMix64::new(seed);
        let mut scene = Scene::new("few", DVec3::Z);
        let material = scene.add_material(scene::Material::new("one", [1.0; 3]));
        for _ in 0..5 {
            let centre = random.point(-0.6, 0.6);
            scene.push(
                (0..3).map(|_| centre + random.point(-0.6, 0.6)).collect::<Vec<_>>(),
                material,
            );
        }
        let faces = faces(&scene);
        let camera = camera(&scene, random.point(-1.0, 1.0));
        let rays = Rays::new(&camera, &faces).unwrap();
        let hiding = Hiding::of(&faces, camera.viewpoint());
        let is_kept = |order: &[u32]| {
            let place = |face: u32| order.iter().position(|&f| f == face);
            order.iter().all(|&a| order.iter().all(|&b| !hiding.hides(a, b) || place(b) < place(a)))
        };
        // The largest number of faces that can be painted whole: the longest valid prefix of any order.
        let whole = |order: &Vec<u32>| (0..=5).filter(|&k| is_kept(&order[..k])).max().unwrap();
        let most = orders(5).iter().map(whole).max().unwrap();
        assert_eq!(hiding.fewest_cut(), Some(5 - most));
        let kept = orders(5).into_iter().filter(|order| is_kept(order)).count();
        match hiding.paint_order() {
            Some(order) => {
                without += 1;
                assert!(kept > 0 && is_kept(&order));
                assert_eq!(wrong(&rays, &faces, &order), 0);
                assert_eq!((hiding.cycles().len(), hiding.fewest_cut()), (0, Some(0)));
            }
            None => {
                with += 1;
                assert_eq!(kept, 0);
                assert!(!hiding.cycles().is_empty() && hiding.fewest_cut() > Some(0));
            }
        }
    }
    assert!(with >= 5 && without >= 5, "{with} {without}");
}

#[test]
fn bars_in_a_cycle_need_one_cut_and_no_order_is_right() {
    let scene = Family::Cycle.scene(5.0, 1);
    // Flat except for rounding: without a tolerance, a bar would be two triangles.
    let (faces, _) = Faces::new(scene.polygons(), None).unwrap();
    let camera = Family::Cycle.cameras(5.0, 1, [160, 120]).unwrap().remove(0);
    let hiding = Hiding::of(&faces, camera.viewpoint());
    assert_eq!((hiding.pairs(), hiding.mutual(), hiding.paint_order()), (5, 0, None));
    assert_eq!(hiding.cycles(), [[0, 1, 2, 3, 4]]);
    assert_eq!(hiding.fewest_cut(), Some(1));
    let rays = Rays::new(&camera, &faces).unwrap();
    assert!(orders(5).iter().all(|order| wrong(&rays, &faces, order) > 0));
}

#[test]
fn neither_newell_nor_the_tree_cuts_fewer_than_needed() {
    let mut needed = 0;
    for seed in 1..12 {
        let scene = Family::Penetration.scene(10.0, seed);
        let (faces, camera) = (faces(&scene), camera(&scene, DVec3::new(3.0, 1.0, 2.0)));
        let fewest = Hiding::of(&faces, camera.viewpoint()).fewest_cut().unwrap();
        let newell = Newell::DEFAULT.decisions(&faces, &camera).unwrap();
        assert!(newell.cuts >= fewest as u64, "{seed}: {newell:?} {fewest}");
        let tree = BspTree::build(scene.polygons()).unwrap();
        assert!(tree.len() - tree.face_count() >= fewest);
        needed += fewest;
    }
    assert!(needed > 10, "{needed}");
}

/// The scenes include a city, in which many polygons have the same extent in depth, or no extent in depth.
#[test]
fn overlaps_in_depth_match_a_count_over_all_pairs() {
    for (scene, least_ties) in [(scene::random_triangles(60, 2), 0), (scene::city(60, 2), 50)] {
        let faces = faces(&scene);
        let forward = DVec3::new(0.0, 0.0, 1.0);
        let extent = |face: u32| {
            let depths = faces.corners(face).iter().map(|c| c[2]);
            depths.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), d| (l.min(d), h.max(d)))
        };
        let (mut pairs, mut ties) = (0, 0);
        for a in 0..faces.len() as u32 {
            for b in 0..a {
                let ((l, h), (m, i)) = (extent(a), extent(b));
                pairs += usize::from(l < i && m < h);
                ties += usize::from(l == i || m == h);
            }
        }
        assert_eq!(overlaps_in_depth(&faces, forward), pairs);
        assert!(pairs > 50 && ties >= least_ties, "{pairs} {ties}");
    }
}
