//! The faces that the search for casters skips, and the number of faces that it tests.

use super::pieces::pieces_by;
use super::{Piece, Pieces, courtyard, lamp, pieces};
use binspace::internals::{SplitMix64, cuboid};
use binspace::scene::random_triangles;
use testkit::prelude::*;

/// A floor with `side`² posts of random heights.
fn posts(side: u32) -> Scene {
    let mut scene = Scene::new("posts", DVec3::Z);
    let (mut random, width) = (SplitMix64::new(3), 64.0 * f64::from(side));
    let floor = [[0.0, 0.0], [width, 0.0], [width, width], [0.0, width]];
    scene.push(floor.map(|[x, y]| DVec3::new(x, y, 0.0)), 0);
    for k in 0..side * side {
        let foot = DVec3::new(f64::from(k % side), f64::from(k / side), 0.0) * 64.0 + 20.0;
        let top = foot + DVec3::new(16.0, 16.0, random.range(8.0, 48.0).round());
        cuboid(foot.with_z(0.0), top).into_iter().for_each(|quad| scene.push(quad, 0));
    }
    scene
}

fn tree(scene: &Scene) -> BspTree {
    BuildOptions::DEFAULT.with_tolerance(0.0).build(scene.polygons()).unwrap()
}

/// Trying every face as a caster gives exactly the same pieces as the casters that the boxes find.
#[test]
fn skipped_faces_throw_no_shadow() {
    let over = [DVec3::new(0.3, 0.2, 4.0), DVec3::new(0.1, -0.2, 4.0)];
    let low = [DVec3::new(100.0, 90.0, 40.0), DVec3::new(130.0, 70.0, 30.0)];
    for (scene, lamp) in
        [(courtyard(), lamp(2)), (random_triangles(40, 2), over.to_vec()), (posts(4), low.to_vec())]
    {
        let tree = tree(&scene);
        let found = pieces(&tree, &lamp);
        let all = pieces_by(tree.faces(), &lamp, |_, _| (0..tree.faces().len() as u32).collect());
        let told = |pieces: &Pieces| {
            let told = |piece: &Piece| {
                let corners: Vec<_> = piece.exact_corners().collect();
                (piece.face, piece.sees.clone(), piece.is_umbra, corners)
            };
            pieces.pieces.iter().map(told).collect::<Vec<_>>()
        };
        assert_eq!(told(&found), told(&all), "{}", scene.name());
        assert!(2 * found.tried < all.tried, "{}: {} {}", scene.name(), found.tried, all.tried);
    }
}

/// All posts throw shadows on the floor, and few on one another.
#[test]
fn the_work_is_not_quadratic_in_the_faces() {
    let tried = [2, 4, 6].map(|side| {
        let tree = tree(&posts(side));
        let sun = DVec3::new(-40_000.0, -23_000.0, 52_000.0);
        (tree.faces().len(), pieces(&tree, &[sun]).tried)
    });
    for pair in tried.windows(2) {
        let ([faces, more_faces], [few, many]) = ([pair[0].0, pair[1].0], [pair[0].1, pair[1].1]);
        assert!(many * faces < 2 * few * more_faces, "{tried:?}");
    }
    assert!(tried[2].1 < 12 * tried[2].0, "{tried:?}");
}
