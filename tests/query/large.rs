//! Scenes of hundreds and thousands of faces.

use binspace::glam::DMat3;
use rayon::prelude::*;
use testkit::hits::{Oracle, Score};
use testkit::prelude::*;
use testkit::scenes::{cells, polygons};
use testkit::shapes;
use testkit::shots::Shots;

type Polygons = Vec<Vec<DVec3>>;

/// Squares through one line.
fn sheaf(n: u32) -> Polygons {
    let wing = |k: u32| {
        let arm = DVec3::new(f64::from(2 * k) - f64::from(n), f64::from(n), 0.0);
        vec![-arm, arm, arm + DVec3::Z * 40.0, DVec3::Z * 40.0 - arm]
    };
    (0..n).map(wing).collect()
}

/// Layers with holes and thin gaps between the layers. Every polygon is coplanar with others.
fn sheets(layers: usize, gap: f64, dice: &mut Dice) -> Polygons {
    let mut polygons = Vec::new();
    for at in 0..36 * layers {
        if dice.below(3) > 0 {
            let (x, y, z) = (at % 6, at / 6 % 6, at / 36);
            let centre = DVec3::new(2.0 * x as f64, 2.0 * y as f64, gap * z as f64);
            polygons.push(shapes::square(DMat3::IDENTITY, centre));
        }
    }
    // Some twice, and some reversed.
    for k in 0..polygons.len() / 8 {
        let mut copy = polygons[8 * k].clone();
        if k % 2 == 0 {
            copy.reverse();
        }
        polygons.push(copy);
    }
    polygons
}

/// Stars and bent squares, which are triangulated.
fn stars(n: usize, dice: &mut Dice) -> Polygons {
    let star = |_| {
        let centre = dice.whole_point(20);
        let bend = dice.below(2) as f64;
        let corner = |k: usize| {
            let turn = shapes::regular(10, DMat3::IDENTITY, DVec3::ZERO)[k];
            let lift = if k == 3 { bend } else { 0.0 };
            centre + turn * if k.is_multiple_of(2) { 6.0 } else { 2.0 } + DVec3::Z * lift
        };
        (0..10).map(corner).collect()
    };
    (0..n).map(star).collect()
}

/// Scenes, with the number of rays shot at each.
fn scenes() -> Vec<(&'static str, Polygons, usize)> {
    let mut dice = Dice(3);
    vec![
        ("cells", cells(8, &mut dice), 300),
        ("sheaf", sheaf(40), 300),
        ("sheets", sheets(30, 1e-7, &mut dice), 300),
        ("stars", stars(60, &mut dice), 300),
        ("random", polygons(&scene::random_triangles(250, 1)), 300),
        ("city", polygons(&scene::city(3000, 1)), 300),
        ("terrain", polygons(&scene::terrain(4000, 1)), 300),
        ("sphere", polygons(&scene::sphere(3000)), 300),
        ("teapot", polygons(&scene::teapot(4)), 300),
        ("crossing", polygons(&scene::crossing(24)), 200),
        ("chain", polygons(&scene::chain(300)), 100),
    ]
}

#[test]
fn rays_through_large_scenes_agree_with_integers() {
    let shoot = |(name, polygons, rays): &(&'static str, Polygons, usize)| {
        let mut score = Score::default();
        for (tolerance, heuristic, rays) in [
            (None, Heuristic::Auto, *rays),
            (Some(0.0), Heuristic::FreePlanes, rays / 12),
            (Some(1e-3), Heuristic::Sampled { candidates: 16 }, rays / 12),
        ] {
            let options = BuildOptions::DEFAULT.with_heuristic(heuristic);
            let options = tolerance.map_or(options.clone(), |t: f64| options.with_tolerance(t));
            let tree = options.build(polygons).unwrap();
            let (oracle, shots) = (Oracle::new(&tree), Shots::new(tree.faces()));
            let mut dice = Dice(23);
            for _ in 0..times(rays) {
                let judged = oracle.check(shots.ray(&mut dice), &mut score);
                judged
                    .unwrap_or_else(|what| panic!("{name} by {heuristic}, {tolerance:?}: {what}"));
            }
        }
        (*name, score)
    };
    let scores: Vec<(&str, Score)> = scenes().par_iter().map(shoot).collect();
    let all = scores.iter().map(|(_, score)| *score).fold(Score::default(), Score::plus);
    enough!(all.rays > 3000, all.hits > 11_700; "{scores:#?}");
    enough!(all.in_plane > 1170, all.ties > 4_000, all.at_ends > 1170; "{scores:#?}");
    assert!(all.blocked.min(all.clear) > 470, "{scores:#?}");
}

/// The hits do not depend on how the tree was built.
#[test]
fn hits_are_the_same_in_every_tree() {
    let scene = polygons(&scene::random_triangles(120, 5));
    let trees: Vec<BspTree> = Heuristic::ALL
        .iter()
        .map(|&heuristic| BuildOptions::DEFAULT.with_heuristic(heuristic).build(&scene).unwrap())
        .collect();
    let (shots, mut dice, mut hits) = (Shots::new(trees[0].faces()), Dice(9), 0);
    for _ in 0..times(2000) {
        let ray = shots.ray(&mut dice);
        let of = |tree: &BspTree| -> Vec<(usize, f64, [f64; 3])> {
            let hits = tree.hits(ray);
            hits.map(|hit| (hit.polygon(), hit.parameter(), hit.point().to_array())).collect()
        };
        let first = of(&trees[0]);
        hits += first.len();
        assert!(trees.iter().all(|tree| of(tree) == first), "{ray:?}");
    }
    enough!(hits > 2000; "{hits}");
}
