//! Size hints are only hints: every iterator with a wrong size hint is read completely.

use binspace::scene::Material;
use binspace::{ErrorKind, Frustum};
use testkit::hinted::{Hint, Hinted};
use testkit::prelude::*;

const MOST: usize = usize::MAX;

/// Hints that are too small or too large, in one bound or in both, and bounds that contradict each other.
const HINTS: [Hint; 13] = [
    (0, None),
    (0, Some(0)),
    (1, Some(1)),
    (2, Some(2)),
    (2, None),
    (40, Some(40)),
    (1000, Some(1000)),
    (1 << 40, Some(1 << 40)),
    (0, Some(MOST)),
    (MOST, None),
    (MOST, Some(MOST)),
    (MOST, Some(0)),
    (9, Some(2)),
];

/// Convex polygons of 3 to 70 corners, one above the other, each rotated; and a polygon that cuts some of
/// them.
fn outlines() -> Vec<Vec<DVec3>> {
    let ring = |(k, count): (u32, u32)| {
        let at = move |i: u32| {
            let angle = f64::from(k) + f64::from(i) / f64::from(count) * std::f64::consts::TAU;
            DVec3::new(angle.cos(), angle.sin(), f64::from(k))
        };
        (0..count).map(at).collect::<Vec<_>>()
    };
    let upright = [[0.1, -2.0, -0.5], [0.1, 2.0, -0.5], [0.1, 2.0, 2.5], [0.1, -2.0, 2.5]];
    let flat = (0..).zip([3, 4, 5, 8, 64, 65, 70]).map(ring);
    flat.chain([upright.map(DVec3::from).to_vec()]).collect()
}

/// All polygons of a tree.
fn pieces(tree: &BspTree) -> Vec<(usize, Vec<DVec3>)> {
    tree.fragments().map(|piece| (piece.polygon(), piece.vertices().collect())).collect()
}

#[test]
fn iterators_that_are_wrong_about_their_size_are_read_all_the_same() {
    let outlines = outlines();
    let right = pieces(&BspTree::build(&outlines).unwrap());
    assert!(right.len() > outlines.len());
    let options = BuildOptions::DEFAULT.with_max_fragments(60);
    let large = BuildOptions::DEFAULT.with_bounds(DVec3::splat(-9.0), DVec3::splat(9.0));
    let (first, rest) = outlines.split_at(3);
    let extended = {
        let mut tree = large.build(first).unwrap();
        tree.extend(rest).unwrap();
        pieces(&tree)
    };
    let mut compared = 0;
    for of_polygons in HINTS {
        for of_corners in HINTS {
            let hinted = |outlines: &[Vec<DVec3>]| {
                let outline = |corners: &Vec<DVec3>| Hinted {
                    items: corners.clone().into_iter(),
                    hint: of_corners,
                };
                let items: Vec<_> = outlines.iter().map(outline).collect();
                Hinted { items: items.into_iter(), hint: of_polygons }
            };
            let name = format!("{of_polygons:?} polygons of {of_corners:?} corners");
            let mut frames = FrameBuilder::new(options.clone());
            let goes_on = |_| ControlFlow::Continue(());
            for tree in [
                &BspTree::build(hinted(&outlines)).unwrap(),
                &options.build(hinted(&outlines)).unwrap(),
                &options.build_with_progress(hinted(&outlines), goes_on).unwrap(),
                frames.build(hinted(&outlines)).unwrap(),
            ] {
                assert_eq!(tree.preparation().polygons, outlines.len(), "{name}");
                assert_eq!(pieces(tree).len(), right.len(), "{name}");
                compared += 1;
            }
            let mut trees = [0; 3].map(|_| large.build(hinted(first)).unwrap());
            trees[0].extend(hinted(rest)).unwrap();
            options.extend(&mut trees[1], hinted(rest)).unwrap();
            options.extend_with_progress(&mut trees[2], hinted(rest), goes_on).unwrap();
            for tree in &trees {
                assert_eq!(pieces(tree), extended, "{name}");
                compared += 1;
            }
            let (faces, _) = Faces::new(hinted(&outlines), None).unwrap();
            assert_eq!(faces.len(), BspTree::build(&outlines).unwrap().faces().len(), "{name}");
            // The limit applies to the polygons read, not to the hint.
            let most = options.clone().with_max_fragments(outlines.len() - 1);
            assert!(
                most.build(hinted(&outlines)).unwrap_err().kind() == ErrorKind::OverBudget,
                "{name}"
            );
        }
    }
    assert_eq!(compared, 7 * HINTS.len() * HINTS.len());
}

#[test]
fn wrong_size_hints_do_not_change_frusta_and_scenes() {
    let planes = [(DVec3::X, 1.0), (DVec3::Y, 2.0), (DVec3::Z, 3.0)];
    let triangle = [DVec3::ZERO, DVec3::X, DVec3::Y];
    for hint in HINTS {
        let hinted = Hinted { items: planes.into_iter(), hint };
        assert_eq!(Frustum::new(hinted), Frustum::new(planes), "{hint:?}");
        let mut scene = Scene::new("hinted", DVec3::Z);
        let material = scene.add_material(Material::DEFAULT);
        scene.push(Hinted { items: triangle.into_iter(), hint }, material);
        assert_eq!(scene.polygons().next().unwrap().points().len(), 3, "{hint:?}");
    }
}
