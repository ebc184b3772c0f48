//! Scenes from a seed, and generated ones as lists of corners.

use super::dice::Dice;
use super::shapes::Corners;
use binspace::glam::DVec3;
use binspace::scene::Scene;

/// The corners of all polygons.
pub fn polygons(scene: &Scene) -> Vec<Corners> {
    scene.polygons().map(|polygon| polygon.to_vec()).collect()
}

/// A scene of some polygons; up is z.
pub fn scene_of(
    name: impl Into<String>,
    polygons: impl IntoIterator<Item: Into<Corners>>,
) -> Scene {
    let mut scene = Scene::new(name, DVec3::Z);
    polygons.into_iter().for_each(|polygon| scene.push(polygon.into(), 0));
    scene
}

/// Triangles around points whose coordinates are between two numbers, with corners up to `edge` off these along each
/// axis.
pub fn triangles(dice: &mut Dice, count: usize, [low, high]: [f64; 2], edge: f64) -> Vec<Corners> {
    let triangle = |_| {
        let centre = dice.point(low, high);
        (0..3).map(|_| centre + dice.point(-1.0, 1.0) * edge).collect()
    };
    (0..count).map(triangle).collect()
}
