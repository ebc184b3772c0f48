//! Compares the trees of one builder, scene after scene, with trees that are built alone.

use crate::tree::{heuristic, shoot};
use binspace::internals::{Tuning, tree_of};
use binspace::{Error, ErrorKind};
use proptest::prelude::*;
use testkit::prelude::*;
use testkit::rays::Rays;
use testkit::snapshot::{Snapshot, order};
use testkit::{orders, views};

fn assert_same(one: &BspTree, other: &BspTree, viewpoint: Viewpoint) {
    assert_eq!(Snapshot::of(one), Snapshot::of(other));
    assert_eq!(order(one, viewpoint), order(other, viewpoint));
}

/// The tree of one frame, built alone and kept.
fn alone<P: Polygon>(
    options: &BuildOptions,
    polygons: impl IntoIterator<Item = P>,
) -> Result<BspTree, Error> {
    let (faces, preparation) = Faces::new(polygons, options.tolerance)?;
    tree_of(options, &Tuning::FRAMES, faces, preparation)
}

#[test]
fn a_frame_has_the_tree_that_is_built_alone() {
    let scenes = (prop::collection::vec(hard::scene(), 1..5), heuristic(), any::<u64>());
    let [frames, cut] =
        tally(file!(), 128, scenes, |counts: &mut [usize; 2], (scenes, by, seed)| {
            let mut dice = Dice(seed);
            // Options belong to the builder, so all its scenes have one tolerance.
            let options = scenes[0].options(by);
            let mut builder = FrameBuilder::new(options.clone());
            for scene in &scenes {
                let alone = alone(&options, &scene.polygons).map_err(fail)?;
                let tree = builder.build(&scene.polygons).map_err(fail)?;
                tree.validate().map_err(fail)?;
                prop_assert_eq!(tree.preparation(), alone.preparation());
                if !tree.is_empty() {
                    let view = views::some_view(tree.faces(), &Rays::new(tree), &mut dice);
                    assert_same(tree, &alone, view.viewpoint);
                    orders::check(tree, view.viewpoint).map_err(fail)?;
                    shoot(tree, dice.roll())?;
                }
                counts[0] += 1;
                counts[1] += usize::from(tree.len() > tree.faces().len());
            }
            Ok(())
        });
    enough!(frames > 200, cut > 60; "{frames} frames, {cut} of them with cuts");
}

#[test]
fn after_an_error_the_tree_is_empty_and_the_builder_goes_on() -> Result<(), Error> {
    let square = |z: f64| [[0.0, 0.0, z], [1.0, 0.0, z], [1.0, 1.0, z], [0.0, 1.0, z]];
    let upright = [[0.5, -1.0, -9.0], [0.5, 2.0, -9.0], [0.5, 2.0, 9.0], [0.5, -1.0, 9.0]];
    let mut builder = FrameBuilder::new(BuildOptions::DEFAULT.with_max_fragments(5));
    for _ in 0..3 {
        assert_eq!(builder.build([square(0.0), square(1.0), upright])?.len(), 5);
        let many = (0..6).map(|i| square(f64::from(i)));
        let over = [many.clone().collect::<Vec<_>>(), vec![square(f64::NAN)]];
        // Scenes with too many polygons, with coordinates that are not finite, and with more pieces than
        // polygons.
        for polygons in
            over.into_iter().chain([vec![square(0.0), square(1.0), square(2.0), upright]])
        {
            assert!(builder.build(polygons).is_err());
            assert!(builder.tree().is_empty());
            assert!(builder.tree().back_to_front(Viewpoint::eye([0.0; 3])).next().is_none());
        }
    }
    Ok(())
}

/// Options apply from the next frame on, until they are set again.
#[test]
fn options_count_from_the_next_frame_on() {
    let square = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
    let room = BuildOptions::DEFAULT.with_bounds(DVec3::splat(-64.0), DVec3::splat(64.0));
    let mut builder = FrameBuilder::new(BuildOptions::DEFAULT);
    for options in
        [BuildOptions::DEFAULT, room.clone(), BuildOptions::DEFAULT.with_tolerance(0.5), room]
    {
        builder.set_options(options.clone());
        let tree = builder.build([square]).expect("a tree");
        let alone = options.build([square]).expect("a tree");
        assert_eq!(tree.grid(), alone.grid(), "{options:?}");
        assert_eq!(tree.stats().tolerance, alone.stats().tolerance, "{options:?}");
    }
}

/// The precision of a frame's numbers applies to that frame alone.
#[test]
fn the_default_tolerance_of_a_frame_follows_its_own_polygons() {
    let square = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
    let single = square.map(|corner| corner.map(|c| c as f32));
    let mut builder = FrameBuilder::new(BuildOptions::DEFAULT);
    for _ in 0..2 {
        let coarse = builder.build([single]).expect("a tree").stats().tolerance;
        assert_eq!(coarse, BspTree::build([single]).expect("a tree").stats().tolerance);
        let fine = builder.build([square]).expect("a tree").stats().tolerance;
        assert_eq!(fine, BspTree::build([square]).expect("a tree").stats().tolerance);
        assert!(coarse > 100.0 * fine, "{coarse} {fine}");
    }
}

/// More polygons than one thread prepares, and sets that are passed to other threads.
#[test]
fn large_scenes_are_built_as_well() -> Result<(), Box<dyn std::error::Error>> {
    let mut builder = FrameBuilder::new(BuildOptions::DEFAULT);
    for scene in [binspace::scene::terrain(9000, 1), binspace::scene::random_triangles(300, 2)] {
        let alone = alone(&BuildOptions::DEFAULT, scene.polygons())?;
        let tree = builder.build(scene.polygons())?;
        assert_same(tree, &alone, Viewpoint::eye([0.3, 0.2, 4.0]));
        tree.validate()?;
    }
    Ok(())
}

/// Cards that all cross each other. Their number goes up to beyond the size of small sets, for which all
/// planes are tried. Budgets count exactly every piece and node.
#[test]
fn crossing_cards_of_every_small_number_keep_their_budgets()
-> Result<(), Box<dyn std::error::Error>> {
    let mut dice = Dice(5);
    let mut some = |scale: f64| DVec3::from_array([(); 3].map(|()| scale * (dice.share() - 0.5)));
    let cards: Vec<[DVec3; 4]> = (0..40)
        .map(|_| {
            let (centre, u) = (some(1.0), some(4.0));
            let v = u.cross(some(4.0));
            [centre - u - v, centre + u - v, centre + u + v, centre - u + v]
        })
        .collect();
    for count in (2..40).filter(|count| count % 6 < 2 || (30..35).contains(count)) {
        let cards = &cards[..count];
        let options = BuildOptions::DEFAULT;
        let build = |options| FrameBuilder::new(options).build(cards).cloned();
        let tree = build(options.clone())?;
        tree.validate()?;
        let (pieces, depth) = (tree.len(), tree.stats().depth_max);
        let enough = options.clone().with_max_fragments(pieces).with_max_depth(depth);
        assert_eq!(build(enough)?.len(), pieces);
        for less in
            [options.clone().with_max_fragments(pieces - 1), options.with_max_depth(depth - 1)]
        {
            assert!(build(less).is_err_and(|error| error.kind() == ErrorKind::OverBudget));
        }
        if count > 25 {
            enough!(pieces > 300; "{pieces} pieces of {count}");
        }
    }
    Ok(())
}
