//! The areas of the cells of a closed room add up to the picture.

use super::scenes::cameras;
use super::{map_of, map_with};
use testkit::prelude::*;
use testkit::scenes::triangles;

/// Six walls around some triangles.
fn room() -> Scene {
    let mut scene = Scene::new("room", DVec3::Z);
    let mut dice = Dice(4);
    for axis in 0..3 {
        for side in [-1.0, 1.0] {
            let corner = |u: f64, v: f64| {
                let mut at = [0.0; 3];
                (at[axis], at[(axis + 1) % 3], at[(axis + 2) % 3]) = (side, u, v);
                DVec3::from(at) * 40.0
            };
            scene.push(
                [corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)],
                0,
            );
        }
    }
    let triangles = triangles(&mut dice, times(150), [-4.0, 4.0], 1.0);
    triangles.into_iter().for_each(|triangle| scene.push(triangle, 0));
    scene
}

#[test]
fn areas_add_up_to_the_picture() {
    let scene = room();
    let tree = BspTree::build(scene.polygons()).unwrap();
    let eyes = [DVec3::new(3.0, 1.0, 2.0), DVec3::new(-20.0, 9.0, 5.0), DVec3::new(0.1, 0.2, 0.3)];
    let mut pictures = 0;
    for (eye, size) in
        eyes.into_iter().flat_map(|eye| [[1, 1], [320, 200], [3000, 7]].map(|size| (eye, size)))
    {
        let camera =
            binspace::view::Camera::perspective(eye, DVec3::ZERO, DVec3::Z, 1.1, size).unwrap();
        let whole = f64::from(size[0]) * f64::from(size[1]);
        let map = tree.visibility(&camera, &ViewOptions::DEFAULT).unwrap();
        let sum: f64 = map.polygons().map(|shown| shown.area).sum();
        assert!((sum / whole - 1.0).abs() < 1e-9, "{size:?} {sum}");
        // Through translucent triangles, the walls are visible everywhere.
        let glass = |polygon: usize| if polygon < 6 { 1.0 } else { 0.3 };
        let map = map_with(&tree, &camera, glass);
        let walls: f64 = map.polygons().filter(|s| s.polygon < 6).map(|s| s.area).sum();
        assert!((walls / whole - 1.0).abs() < 1e-9, "{size:?} {walls}");
        let regions: f64 = map.regions().unwrap().iter().map(|region| region.area()).sum();
        assert!((regions / whole - 1.0).abs() < 1e-4, "{size:?} {regions}");
        pictures += 1;
    }
    assert_eq!(pictures, 9);
    // From outside the room, the areas are at most the picture.
    for camera in cameras(&scene, 3, [200, 150]) {
        let map = map_of(&tree, &camera);
        let sum: f64 = map.polygons().map(|shown| shown.area).sum();
        assert!(sum < 30_000.0 * (1.0 + 1e-9), "{sum}");
    }
}
