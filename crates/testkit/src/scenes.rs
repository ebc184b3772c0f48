//! Scenes from a seed, and generated ones as lists of corners.

use super::dice::Dice;
use super::shapes::Corners;
use binspace::glam::DVec3;
use binspace::scene::Scene;
use binspace::{BspTree, BuildOptions, FrameBuilder, Heuristic, Polygon};

/// Returns the corners of all polygons.
pub fn polygons(scene: &Scene) -> Vec<Corners> {
    scene.polygons().map(|polygon| polygon.points().to_vec()).collect()
}

/// Returns a scene of some polygons; up is z.
pub fn scene_of(
    name: impl Into<String>,
    polygons: impl IntoIterator<Item: Into<Corners>>,
) -> Scene {
    let mut scene = Scene::new(name, DVec3::Z);
    polygons.into_iter().for_each(|polygon| scene.push(polygon.into(), 0));
    scene
}

/// Returns a tree by each heuristic, one after trials, and one of a frame, all with their names.
pub fn trees<P: Polygon>(polygons: &[P], options: BuildOptions) -> Vec<(String, BspTree)> {
    let frame = FrameBuilder::new(options.clone()).build(polygons).expect("a frame").clone();
    let tree = |&heuristic: &Heuristic| {
        let tree = options.clone().with_heuristic(heuristic).build(polygons).expect("a tree");
        (heuristic.to_string(), tree)
    };
    let tried = options.clone().with_trials(4).build(polygons).expect("a tree");
    let others = [("trials".to_owned(), tried), ("frame".to_owned(), frame)];
    Heuristic::ALL.iter().map(tree).chain(others).collect()
}

/// Triangles around points whose coordinates are between two numbers, with corners up to `edge` off these
/// along each axis.
pub fn triangles(dice: &mut Dice, count: usize, [low, high]: [f64; 2], edge: f64) -> Vec<Corners> {
    let triangle = |_| {
        let centre = dice.point(low, high);
        (0..3).map(|_| centre + dice.point(-1.0, 1.0) * edge).collect()
    };
    (0..count).map(triangle).collect()
}

/// Returns unit squares of a cubic lattice: most of the walls between its cells. Rays meet many squares at
/// once.
pub fn cells(n: usize, dice: &mut Dice) -> Vec<Corners> {
    let mut polygons = Vec::new();
    for at in 0..n * n * n {
        let corner = [at % n, at / n % n, at / n / n].map(|c| c as f64);
        for axis in 0..3 {
            if dice.below(4) > 0 {
                let [u, v] = [DVec3::AXES[(axis + 1) % 3], DVec3::AXES[(axis + 2) % 3]];
                let corner = DVec3::from_array(corner);
                polygons.push(vec![corner, corner + u, corner + u + v, corner + v]);
            }
        }
    }
    polygons
}
