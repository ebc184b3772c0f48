//! Compares the fragments that culled orders leave out with brute force in rationals and with exact pictures.

use crate::walk::{trees, viewpoints};
use binspace::paint::paint_order;
use binspace::paint::paint_tree;
use binspace::view;
use binspace::{Culling, Facing, Flow, Frustum, Part};
use proptest::prelude::*;
use testkit::prelude::*;
use testkit::rational::Plane;
use testkit::scenes::cells;
use testkit::shapes;
use testkit::snapshot::order;
use testkit::views::View;

/// Returns a culled order. Checks that it is a part of the whole order, and that all forms agree: read from
/// both ends, one by one, and walked.
fn culled(tree: &BspTree, viewpoint: Viewpoint, culling: &Culling) -> Vec<u32> {
    let mut found = vec![3; 5];
    tree.order(viewpoint).culled(culling).write_into(&mut found);
    let mut whole = order(tree, viewpoint).into_iter();
    assert!(found.iter().all(|&fragment| whole.any(|other| other == fragment)));
    let mut reverse = Vec::new();
    tree.order(viewpoint).culled(culling).front_to_back().write_into(&mut reverse);
    assert!(found.iter().rev().eq(&reverse));
    let order = tree.order(viewpoint).culled(culling);
    for (order, expected) in [(order, &found), (order.front_to_back(), &reverse)] {
        let one_by_one = order.into_iter();
        assert_eq!(one_by_one.len(), expected.len());
        assert!(one_by_one.map(|fragment| fragment.index()).eq(expected.iter().copied()));
        let mut walked = Vec::new();
        let _ = order.walk(|part| {
            if let Part::Fragment(fragment) = part {
                walked.push(fragment.index());
            }
            Flow::<()>::Descend
        });
        assert_eq!(&walked, expected);
    }
    found
}

/// A walk visits no subtree that is entirely outside, or turned away.
#[test]
fn a_culled_walk_skips_subtrees() {
    let tree = BspTree::build(scene::terrain(2000, 1).polygons()).unwrap();
    let [low, high] = tree.bounds().unwrap();
    let subtrees = |viewpoint: Viewpoint, culling: &Culling| {
        let (mut subtrees, mut fragments) = (0, 0);
        let _ = tree.order(viewpoint).culled(culling).walk(|part| {
            match part {
                Part::Subtree(_) => subtrees += 1,
                Part::Fragment(_) => fragments += 1,
            }
            Flow::<()>::Descend
        });
        (subtrees, fragments)
    };
    let above = Viewpoint::Direction(DVec3::NEG_Z);
    let all = subtrees(above, &Culling::NONE);
    assert_eq!(all, (tree.stats().nodes, tree.len()));
    let corner = Frustum::from_box([low, low + (high - low) * dvec3(0.1, 0.1, 1.0)]);
    let few = subtrees(above, &Culling::NONE.with_frustum(corner));
    assert!(few.0 * 4 < all.0 && few.1 > 10, "{few:?} of {all:?}");
    assert_eq!(subtrees(above, &Culling::NONE.with_facing(Facing::Front)), all);
    assert_eq!(subtrees(above, &Culling::NONE.with_facing(Facing::Back)), (0, 0));
}

/// Whether a fragment's box reaches over each plane of the region, exactly; `None` if the box misses by so
/// little that it may be kept.
fn must_be_kept(tree: &BspTree, fragment: u32, frustum: &Frustum) -> Option<bool> {
    let corners = tree.fragment(fragment).bounds();
    let [low, high] = tree.bounds().unwrap();
    let reach = low.abs().max(high.abs());
    let mut worst = Some(true);
    for &(normal, offset) in frustum.planes() {
        let furthest = (0..3).fold(-rational::exact(offset), |sum, axis| {
            let ends = corners.map(|c| rational::exact(c[axis]) * rational::exact(normal[axis]));
            let [a, b] = ends;
            sum + a.max(b)
        });
        let size = normal.abs().dot(reach) + offset.abs();
        let step = (high - low).max_element() * 1e-6 * normal.length();
        let slack = rational::exact(1e-14 * size) + rational::exact(step);
        if furthest < -slack {
            return Some(false);
        }
        if furthest < Rational::zero() {
            worst = None;
        }
    }
    worst
}

/// Regions around a tree: slabs, wedges from a point, planes through corners of boxes.
fn frusta(tree: &BspTree, dice: &mut Dice) -> Vec<Frustum> {
    let Some([low, high]) = tree.bounds() else { return vec![] };
    let size = (high - low).max(DVec3::splat((high - low).max_element() * 1e-3));
    let mut share = || dice.point(0.0, 1.0);
    let mut frusta = vec![Frustum::default()];
    for count in [1, 2, 4, 4, 5, 6, 40] {
        let apex = low + size * share();
        let planes: Vec<_> = (0..count)
            .map(|_| {
                let normal = (share() - 0.5) * 2.0;
                (normal, normal.dot(apex))
            })
            .collect();
        frusta.push(Frustum::new(planes));
    }
    // A small cell, and a cell whose bounds are exactly a box.
    for cell in [[low + size * 0.4, low + size * 0.5], tree.fragment(0).bounds()] {
        let [low, high] = cell;
        let sides = DVec3::AXES
            .into_iter()
            .flat_map(|axis| [(axis, axis.dot(low)), (-axis, -axis.dot(high))]);
        frusta.push(Frustum::new(sides));
    }
    frusta
}

#[test]
fn culling_agrees_with_a_test_of_every_box() {
    let mut dice = Dice(21);
    let [mut kept, mut left_out, mut doubtful] = [0; 3];
    for tree in trees() {
        for frustum in frusta(&tree, &mut dice) {
            // Only 32 planes are used.
            let used = Frustum::new(frustum.planes().iter().copied().take(32));
            let expected: Vec<Option<bool>> =
                (0..tree.len() as u32).map(|f| must_be_kept(&tree, f, &used)).collect();
            for viewpoint in viewpoints(&tree, &mut dice).into_iter().take(3) {
                let culling = Culling::NONE.with_frustum(frustum.clone());
                let found = culled(&tree, viewpoint, &culling);
                let mut is_found = vec![false; tree.len()];
                found.iter().for_each(|&fragment| is_found[fragment as usize] = true);
                for (index, (&found, &expected)) in is_found.iter().zip(&expected).enumerate() {
                    assert!(expected.is_none_or(|kept| kept == found), "{index} of {tree:?}");
                    match expected {
                        Some(true) => kept += 1,
                        Some(false) => left_out += 1,
                        None => doubtful += 1,
                    }
                }
            }
        }
    }
    assert!(kept > 10_000 && left_out > 10_000 && doubtful < 500, "{kept} {left_out} {doubtful}");
}

#[test]
fn sides_are_those_that_rationals_say() {
    let mut dice = Dice(22);
    let [mut fronts, mut backs, mut edge_on, mut whole] = [0; 4];
    for tree in trees().into_iter().filter(|tree| !tree.is_empty()) {
        let faces = tree.faces();
        let planes: Vec<Plane> =
            tree.fragments().map(|f| model::plane(faces, PlaneId::face(f.face()))).collect();
        let [low, high] = tree.bounds().unwrap();
        let at = |world: DVec3| View::eye(faces, DVec3::from(faces.lattice().to_lattice(world)));
        let mut views = vec![
            at(low + (high - low) * 0.3),
            at(high + (high - low) * 2.0),
            at(tree.fragment(0).vertices().next().unwrap()),
            View::direction(DVec3::new(0.3, -0.2, -1.0)),
            View::direction(DVec3::Y),
            // Rounding removes the small components of this direction.
            View::direction(DVec3::new(1e-19, 1.0, -1e-19)),
        ];
        views.extend((0..3).map(|_| at(low + (high - low) * dice.share())));
        for view in views {
            let sides: Vec<Ordering> = planes.iter().map(|plane| view.side(plane)).collect();
            let whole_order = order(&tree, view.viewpoint);
            for (shown, side, count) in [
                (Facing::Front, Ordering::Greater, &mut fronts),
                (Facing::Back, Ordering::Less, &mut backs),
                (Facing::EdgeOn, Ordering::Equal, &mut edge_on),
            ] {
                let culling = Culling::NONE.with_facing(shown);
                let found = culled(&tree, view.viewpoint, &culling);
                let shown = whole_order.iter().filter(|&&f| side == sides[f as usize]);
                assert!(found.iter().eq(shown), "{tree:?} {view:?}");
                *count += found.len();
            }
            let culling = Culling::NONE.with_frustum(Frustum::EVERYWHERE);
            assert_eq!(culled(&tree, view.viewpoint, &culling), whole_order);
            for node in tree.nodes() {
                if let Some(side) = node.facing_all(view.viewpoint) {
                    assert!(node.fragments().all(|f| side == sides[f as usize].into()), "{node:?}");
                    whole += usize::from(node.fragments().len() > 2);
                }
            }
        }
    }
    enough!(fronts > 5000, backs > 5000, edge_on > 100, whole > 500; "{fronts} {backs} {edge_on} {whole}");
}

/// A convex body: points on the circles of a sphere, moved, rotated and stretched.
fn body() -> impl Strategy<Value = Vec<Vec<DVec3>>> {
    let turn = prop::array::uniform3(-3.0..3.0f64);
    let size = prop::array::uniform3(0.1..10.0f64);
    (turn, size, 0..3).prop_map(|(turn, size, kind)| {
        let turn = shapes::rotation(turn);
        let place = |p: DVec3| turn * (p * DVec3::from(size));
        match kind {
            0 => shapes::cuboid(turn, DVec3::ONE, DVec3::from(size)).into_iter().collect(),
            1 => {
                let sphere = scene::sphere(200);
                sphere.polygons().map(|p| p.points().iter().map(|&p| place(p)).collect()).collect()
            }
            _ => {
                let [a, b, c, d] = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z].map(place);
                vec![vec![a, c, b], vec![a, b, d], vec![b, c, d], vec![c, a, d]]
            }
        }
    })
}

proptest! {
    #![proptest_config(cases(48, file!()))]

    /// For a convex body, the fronts alone make the picture, in any order.
    #[test]
    fn the_fronts_of_a_convex_body_are_its_picture(body in body(), seed in any::<u64>()) {
        let tree = BspTree::build(&body).unwrap();
        for camera in view::views(tree.bounds().unwrap(), DVec3::Z, 3, [60, 48], seed).unwrap() {
            let rays = Rays::new(&camera, tree.faces()).unwrap();
            let viewpoint = camera.viewpoint();
            let whole = paint_tree(&tree, viewpoint, &rays);
            let inside = tree.fragments().all(|f| f.facing(viewpoint) == Facing::Back);
            let shown = if inside { Facing::Back } else { Facing::Front };
            let mut found = culled(&tree, viewpoint, &Culling::NONE.with_facing(shown));
            prop_assert!(found.len() < tree.len() || inside);
            let ordered = paint_order(&tree, &found, &rays);
            // No face covers another.
            found.sort_unstable();
            let unordered = paint_order(&tree, &found, &rays);
            for picture in [ordered, unordered] {
                prop_assert_eq!(picture.faces(), whole.faces());
                prop_assert_eq!(picture.drawn(), whole.covered() as u64);
            }
        }
    }
}

/// Every pixel of the picture equals the pixel of the whole order, also with an eye on a corner, and in wide
/// and narrow views.
#[test]
fn no_polygon_that_owns_a_pixel_is_outside_a_cameras_frustum() {
    let [mut left_out, mut all, mut pictures] = [0; 3];
    for tree in trees().into_iter().filter(|tree| tree.len() > 1) {
        let [low, high] = tree.bounds().unwrap();
        let size = [64, 36];
        let mut cameras = view::views([low, high], DVec3::Z, 6, size, 5).unwrap();
        let corner = tree.fragment(0).vertices().next().unwrap();
        let (middle, extent) = ((low + high) * 0.5, (high - low).max_element());
        for fov in [1e-3, 0.3, 3.0] {
            cameras.extend(Camera::perspective(corner, middle, DVec3::Y, fov, size));
        }
        for share in [1.5, 0.2, 1e-3] {
            let look = DVec3::new(0.5, -0.7, 0.3);
            cameras.extend(Camera::parallel(look, DVec3::Z, middle, extent * share, size));
        }
        for camera in cameras {
            let Ok(rays) = Rays::new(&camera, tree.faces()) else { continue };
            let culling = Culling::NONE.with_frustum(camera.frustum());
            let found = culled(&tree, camera.viewpoint(), &culling);
            let whole = paint_tree(&tree, camera.viewpoint(), &rays);
            let picture = paint_order(&tree, &found, &rays);
            // The culled order contains every fragment that covers a pixel, also hidden fragments.
            assert_eq!((picture.faces(), picture.drawn()), (whole.faces(), whole.drawn()));
            left_out += tree.len() - found.len();
            all += tree.len();
            pictures += 1;
        }
    }
    assert!(pictures > 300 && left_out * 3 > all, "{pictures} {left_out} of {all}");
}

/// Within walls, few invisible fragments are visited. Floors, which lie in one plane with many others, are
/// left out too.
#[test]
fn indices_of_a_culled_order_follow_the_list() {
    let tree = BspTree::build(cells(12, &mut Dice(12))).unwrap();
    let mesh = tree.mesh().unwrap();
    let eye = DVec3::new(2.5, 2.5, 0.4);
    let camera = Camera::perspective(eye, eye + DVec3::X, DVec3::Z, 0.5, [160, 90]).unwrap();
    let culling = Culling::NONE.with_frustum(camera.frustum());
    let found = culled(&tree, camera.viewpoint(), &culling);
    assert!(!found.is_empty() && found.len() * 3 < tree.len(), "{} {}", found.len(), tree.len());
    let on_floor = |list: &[u32]| {
        list.iter().filter(|&&f| tree.fragment(f).vertices().all(|p| p.z == 0.0)).count()
    };
    let all: Vec<u32> = (0..tree.len() as u32).collect();
    assert!(on_floor(&found) * 3 < on_floor(&all));
    let triangles = mesh.triangles();
    let mut indices = vec![7; triangles.indices().len()];
    let count = triangles.write_order(&found, &mut indices).unwrap();
    let expected =
        found.iter().flat_map(|&fragment| &triangles.indices()[triangles.range(fragment)]);
    assert!(expected.eq(&indices[..count]));
    assert!(indices[count..].iter().all(|&place| place == 7));
    assert!(triangles.write_order(&found, &mut indices[..count - 1]).is_err());
}

/// The margin of a scene's boxes: at least a step of its grid, even where coordinates are 0 and nothing is
/// rounded, and at most the documented margin.
#[test]
fn boxes_count_as_larger_by_a_step_of_the_grid() {
    let flat = [[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [1.0, 1.0, 0.0], [-1.0, 1.0, 0.0]];
    let tree = BspTree::build([flat]).unwrap();
    let step = 2f64.powi(tree.grid().exponent);
    assert_eq!(tree.fragment(0).bounds().map(|corner| corner.z), [0.0; 2]);
    let is_kept = |normal: DVec3, offset: f64| {
        let culling = Culling::NONE.with_frustum(Frustum::new([(normal, offset)]));
        culled(&tree, Viewpoint::eye([0.0, 0.0, 5.0]), &culling).len() == 1
    };
    for normal in [DVec3::Z, DVec3::NEG_Z] {
        assert!(is_kept(normal, 0.0) && is_kept(normal, step), "{normal}");
        assert!(!is_kept(normal, 2e-6), "{normal}");
    }
}

/// Scenes of 1 to 40 fragments, so that marks need one to three words. Scenes are tiny, huge or far out, up
/// to the limits of `f64`. Planes go through the corners of boxes, or just beside them.
#[test]
fn scenes_of_every_size_are_culled_as_boxes_say() {
    let mut dice = Dice(33);
    let [mut kept, mut left_out, mut doubtful] = [0; 3];
    for (size, shift) in [
        (1.0, 0.0),
        (1.0, 1e9),
        (1e-3, -1e6),
        (1e-300, 0.0),
        (1e300, 0.0),
        (1e300, 1e300),
        (1e30, 1e-9),
    ] {
        for count in (1..=40).step_by(3) {
            let mut share = || dice.point(0.0, 1.0);
            let triangle = |_| {
                let at = share();
                [at, at + share() * 0.2, at + share() * 0.2].map(|p| p * size + DVec3::splat(shift))
            };
            let corners: Vec<_> = (0..count).map(triangle).collect();
            let tree = BspTree::build(corners).unwrap();
            for _ in 0..6 {
                let fragment = (dice.share() * tree.len() as f64) as u32;
                let mut share = || dice.share() - 0.5;
                let normal = DVec3::new(share(), share(), share());
                let normal = [normal, DVec3::X, DVec3::NEG_Y][(dice.share() * 3.0) as usize];
                let [low, high] = tree.fragment(fragment).bounds();
                let corner = DVec3::select(normal.cmpgt(DVec3::ZERO), high, low);
                // The box only touches the plane.
                let region = Frustum::new([(normal, normal.dot(corner))]);
                let culling = Culling::NONE.with_frustum(region.clone());
                let found = culled(&tree, Viewpoint::direction([0.1, 0.2, 1.0]), &culling);
                for fragment in 0..tree.len() as u32 {
                    let expected = must_be_kept(&tree, fragment, &region);
                    let is_found = found.contains(&fragment);
                    assert!(expected.is_none_or(|kept| kept == is_found), "{size} {shift} {count}");
                    match expected {
                        Some(true) => kept += 1,
                        Some(false) => left_out += 1,
                        None => doubtful += 1,
                    }
                }
                assert!(found.contains(&fragment), "{size:e} {shift:e}: {normal}");
            }
        }
    }
    assert!(kept > 3000 && left_out > 3000 && doubtful < 600, "{kept} {left_out} {doubtful}");
}

/// Planes through a corner of a distant box, exactly or up to a step of the offset. The terms of a plane's
/// equation there are a million times their sum, so rounding exceeds a step of the grid.
#[test]
fn a_box_is_kept_however_the_test_is_rounded() {
    let mut dice = Dice(31);
    let [mut kept, mut inexact] = [0; 2];
    for far in [1e3, 1e6, 1e9] {
        let mut share = || dice.point(0.0, 1.0);
        let shift = DVec3::new(far, -far, 0.7 * far) + share();
        let corners: Vec<[DVec3; 3]> =
            (0..24).map(|_| [shift + share(), shift + share(), shift + share()]).collect();
        let tree = BspTree::build(corners).unwrap();
        for fragment in 0..tree.len() as u32 {
            for _ in 0..4 {
                let [low, high] = tree.fragment(fragment).bounds();
                // The normal is nearly perpendicular to the direction of the box, so that the products
                // cancel.
                let normal = (share() - 0.5).cross(shift.normalize()) + share() * 1e-6;
                let corner = DVec3::select(normal.cmpgt(DVec3::ZERO), high, low);
                let [n, c] = [normal, corner].map(rational::point);
                let exact = rational::scalar(&n, &c);
                let mut offset = exact.to_f64().value();
                if rational::exact(offset) > exact {
                    offset = offset.next_down();
                }
                assert!(rational::exact(offset) <= exact);
                let [x, y, z] = (normal * corner).to_array();
                inexact += usize::from(x + y + z < offset);
                let region = Frustum::new([(normal, offset)]);
                assert!(region.meets([low, high]), "{normal} {offset}");
                let culling = Culling::NONE.with_frustum(region);
                let found = culled(&tree, Viewpoint::eye([0.0; 3]), &culling);
                assert!(found.contains(&fragment), "{normal} {offset}");
                kept += 1;
            }
        }
    }
    enough!(kept > 290, inexact > 90; "{inexact} of {kept}");
}

/// Of many coplanar polygons, whose boxes are tested in blocks, only the polygons in the region are drawn.
#[test]
fn blocks_that_a_plane_goes_through_are_looked_into() {
    let square = |k: u32| {
        let (x, y) = (f64::from(k % 40), f64::from(k / 40));
        [[x, y, 0.0], [x + 0.5, y, 0.0], [x + 0.5, y + 0.5, 0.0], [x, y + 0.5, 0.0]]
    };
    let wall = [[0.0, 0.0, 9.0], [1.0, 0.0, 9.0], [0.0, 1.0, 9.0], [0.0, 0.5, 9.0]];
    let options = BuildOptions::DEFAULT.with_heuristic(Heuristic::First);
    let tree = options.build((0..1600).map(square).chain([wall])).unwrap();
    assert_eq!(tree.root().unwrap().on().len(), 1600);
    let mut compared = 0;
    for (low, high) in [(3.2, 3.4), (7.6, 9.1), (0.2, 38.9), (11.7, 11.9), (-3.0, 20.3)] {
        for axis in [DVec3::X, DVec3::Y] {
            let region = Frustum::new([(axis, low), (-axis, -high)]);
            let culling = Culling::NONE.with_frustum(region);
            let mut found = culled(&tree, Viewpoint::eye([5.0, 3.0, 2.0]), &culling);
            found.sort_unstable();
            let is_in = |fragment: &u32| {
                let at = |p: DVec3| p.dot(axis);
                let ends = tree.fragment(*fragment).vertices().map(at);
                ends.clone().fold(-9.0, f64::max) >= low && ends.fold(99.0, f64::min) <= high
            };
            let expected: Vec<u32> = (0..tree.len() as u32).filter(is_in).collect();
            assert_eq!(found, expected, "{low} {high} {axis}");
            compared += expected.len();
        }
    }
    enough!(compared > 4000; "{compared}");
}

/// Of coplanar polygons that face either way and do not fill the last block, only the polygons of one side
/// are drawn.
#[test]
fn one_side_of_a_plane_of_both_is_drawn() {
    for count in (1..70).chain([255, 257, 1000]) {
        let square = |k: u32| {
            let (x, y) = (f64::from(k % 40), f64::from(k / 40));
            let mut square =
                [[x, y, 0.0], [x + 0.5, y, 0.0], [x + 0.5, y + 0.5, 0.0], [x, y + 0.5, 0.0]];
            if k.is_multiple_of(3) {
                square.reverse();
            }
            square
        };
        let tree = BspTree::build((0..count).map(square)).unwrap();
        for (sides, is_turned) in [(Facing::Front, false), (Facing::Back, true)] {
            let culling = Culling::NONE.with_facing(sides);
            let found = culled(&tree, Viewpoint::eye([5.0, 3.0, 2.0]), &culling);
            assert!(
                found.into_iter().eq((0..count).filter(|k| k.is_multiple_of(3) == is_turned)),
                "{count}"
            );
        }
    }
}

#[test]
fn the_first_32_planes_of_a_region_count() {
    let square = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
    let tree = BspTree::build([square]).unwrap();
    for place in [0, 30, 31, 32, 39] {
        let planes = (0..40).map(|k| (DVec3::X, if k == place { 2.0 } else { -1.0 }));
        let culling = Culling::NONE.with_frustum(Frustum::new(planes));
        let found = culled(&tree, Viewpoint::eye([5.0, 3.0, 2.0]), &culling);
        assert_eq!(found.is_empty(), place < 32, "{place}");
    }
}
