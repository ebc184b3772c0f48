//! Polygons added to a finished tree.

use binspace::ErrorKind;
use testkit::prelude::*;
use testkit::scenes::polygons;
use testkit::snapshot::Snapshot;

/// Options that give a part of a scene the grid and the tolerance of the whole scene.
fn options(scene: &Scene, by: Heuristic) -> BuildOptions {
    let (low, high) = scene.bounds().expect("corners");
    BuildOptions::DEFAULT.with_bounds(low, high).with_heuristic(by).with_tolerance(1e-6)
}

#[test]
fn an_extended_tree_equals_the_tree_of_all_polygons() {
    for scene in [scene::random_triangles(120, 3), scene::city(400, 2), scene::crossing(9)] {
        let all = polygons(&scene);
        for &by in Heuristic::ALL {
            let options = options(&scene, by);
            let expected = options.build(&all).expect("within budget");
            for start in [0, 1, all.len() / 2, all.len()] {
                let mut tree = options.build(&all[..start]).expect("within budget");
                options.extend(&mut tree, &all[start..]).expect("on the grid");
                assert_eq!(Snapshot::of(&tree), Snapshot::of(&expected), "{} {by}", scene.name());
            }
        }
    }
}

#[test]
fn an_extension_keeps_dropped_triangulated_and_moved_polygons() {
    let flat = |points: &[[f64; 3]]| points.iter().map(|&p| DVec3::from(p)).collect::<Corners>();
    let line = flat(&[[0.0, 0.0, 0.0], [1.0, 1.0, 1.0], [2.0, 2.0, 2.0]]);
    let arrow = flat(&[[0.0, 0.0, 0.5], [4.0, 1.0, 0.5], [0.0, 2.0, 0.5], [1.0, 1.0, 0.5]]);
    let bent = flat(&[[0.0, 0.0, 1.0], [4.0, 0.0, 1.0], [4.0, 4.0, 1.0 + 5e-7], [0.0, 4.0, 1.0]]);
    let all = [line.clone(), arrow.clone(), bent.clone(), arrow, line, bent];
    let options = BuildOptions::DEFAULT.with_tolerance(1e-6);
    let options = options.with_bounds(DVec3::ZERO, DVec3::splat(4.0));
    let expected = options.build(&all).expect("within budget");
    let mut tree = options.build(&all[..3]).expect("within budget");
    for polygon in &all[3..] {
        options.extend(&mut tree, [polygon]).expect("on the grid");
    }
    assert_eq!(Snapshot::of(&tree), Snapshot::of(&expected));
    assert!(tree.dropped().eq([0, 4]));
    let (found, wanted) = (*tree.preparation(), *expected.preparation());
    assert_eq!((found.polygons, found.dropped, found.triangulated), (6, 2, 2));
    assert_eq!((found.flattened, found.flattened_by), (2, wanted.flattened_by));
    assert!(found.flattened_by > 1e-7 && found.flattened_by < 1e-6, "{found:?}");
}

#[test]
fn a_failed_extension_does_not_change_the_tree() {
    let scene = scene::city(100, 1);
    let mut tree = BspTree::build(scene.polygons()).expect("within budget");
    let before = Snapshot::of(&tree);
    let at = |x: f64| [[x, 0.0, 0.0], [1.0, 0.0, 1.0], [0.0, 1.0, 1.0]];
    let error = tree.extend([at(0.0), at(f64::NAN)]).expect_err("not finite");
    assert_eq!(error.polygon(), Some(1));
    let error = tree.extend([at(0.0), at(0.5), at(1e9)]).expect_err("beyond the grid");
    assert_eq!(error.polygon(), Some(2));
    assert!(error.to_string().contains("with_bounds"), "{error}");
    let few = BuildOptions::DEFAULT.with_max_fragments(scene.len());
    assert!(
        few.extend(&mut tree, [at(0.0)]).expect_err("a budget").kind() == ErrorKind::OverBudget
    );
    let never = BuildOptions::DEFAULT
        .extend_with_progress(&mut tree, [at(0.0)], |_| ControlFlow::Break(()));
    assert!(never.is_err_and(|error| error.kind() == ErrorKind::Cancelled));
    assert_eq!(Snapshot::of(&tree), before);
    tree.extend([at(0.0)]).expect("on the grid");
    assert_eq!(tree.preparation().polygons, scene.len() + 1);
}

/// New polygons are duplicates of each other or of old polygons. They are whole or triangulated, start at any
/// corner, run in either direction, have repeated corners, or have corners that the tolerance moves.
#[test]
fn duplicates_of_old_and_new_polygons_are_counted() {
    let mut dice = Dice(3);
    let (mut counted, mut triangulated) = (0, 0);
    for round in seeds(60) {
        let mut all: Vec<Corners> = Vec::new();
        for _ in 0..30 {
            let count = 3 + dice.below(4);
            all.push(match dice.below(4) {
                // Bent polygons.
                0 => {
                    let around = [[3, 0], [2, 2], [0, 3], [-2, 2], [-3, 0], [0, -3]];
                    let lift = |[x, y]: [i32; 2]| {
                        DVec3::new(f64::from(x), f64::from(y), dice.around_zero(1))
                    };
                    around[..count].iter().copied().map(lift).collect()
                }
                // Flat polygons, moved by less than the tolerance.
                1 => {
                    let at = dice.whole_point(3);
                    let lift = DVec3::Z * dice.share() * 5e-7;
                    vec![at, at + DVec3::X, at + DVec3::ONE - DVec3::Z + lift, at + DVec3::Y]
                }
                // An arrow.
                2 => {
                    let at = dice.whole_point(3);
                    let corners = [[0.0, 0.0], [4.0, 1.0], [0.0, 2.0], [1.0, 1.0]];
                    corners.map(|[x, y]| at + DVec3::new(x, y, 0.0)).to_vec()
                }
                _ => {
                    let earlier = all.len();
                    if earlier == 0 { continue } else { all[dice.below(earlier)].clone() }
                }
            });
            let last = all.len() - 1;
            let polygon = &mut all[last];
            let turn = dice.below(polygon.len());
            polygon.rotate_left(turn);
            if dice.below(2) == 0 {
                polygon.reverse();
            }
            if dice.below(4) == 0 {
                let again = dice.below(polygon.len());
                polygon.insert(again, polygon[again]);
            }
        }
        let options = BuildOptions::DEFAULT.with_tolerance(1e-6);
        let options = options.with_bounds(DVec3::splat(-8.0), DVec3::splat(8.0));
        let expected = options.build(&all).expect("within budget");
        let mut tree = options.build(&all[..dice.below(all.len())]).expect("within budget");
        while tree.preparation().polygons < all.len() {
            let start = tree.preparation().polygons;
            let end = all.len().min(start + 1 + dice.below(12));
            options.extend(&mut tree, &all[start..end]).expect("on the grid");
        }
        assert_eq!(tree.preparation(), expected.preparation(), "round {round}");
        assert_eq!(tree.duplicates(), expected.duplicates(), "round {round}");
        counted += expected.duplicates();
        triangulated += expected.preparation().triangulated;
    }
    enough!(counted > 200, triangulated > 300; "{counted} {triangulated}");
}
