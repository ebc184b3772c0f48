//! Attributes in pixels against exact interpolation.

use crate::method::{Across, paint_attributes};
use crate::panes::{panes, world_polygons};
use crate::plain::PlainView;
use testkit::prelude::*;

/// Texture coordinates of a parallelogram's corners, and a colour that is linear on the parallelogram.
const CORNERS: [[i64; 3]; 4] = [[0, 0, 10], [8, 0, 200], [8, 8, 250], [0, 8, 60]];

#[test]
fn attributes_match_the_polygon_after_all_cuts() {
    let view = PlainView::new([96, 72]);
    let camera = view.camera();
    let (mut compared, mut cut, mut squares) = (0, 0, [0; 2]);
    for seed in 0..4 {
        let (integers, _) = panes(24, seed);
        let polygons = world_polygons(&integers);
        let tree = BuildOptions::DEFAULT.with_tolerance(0.0).build(&polygons).unwrap();
        cut += tree.len() - polygons.len();
        let rays = Rays::new(&camera, tree.faces()).unwrap();
        let corners = CORNERS.map(|values| values.map(|value| value as f64)).to_vec();
        let attributes = vec![corners; polygons.len()];
        let shown = [Across::Polygon, Across::Picture]
            .map(|across| paint_attributes(&tree, &camera, &rays, &attributes, across));
        for i in 0..96 * 72 {
            let pixel = [i as u32 % 96, i as u32 / 96];
            let Some(layers) = view.layers(&integers, pixel) else { continue };
            let Some(&(nearest, _)) = layers.first() else {
                assert_eq!(shown[0][i], None);
                continue;
            };
            // The plane's attributes, from three of its corners.
            let [a, b, _, d] = integers[nearest as usize][..] else { panic!("a parallelogram") };
            let exact: [f64; 3] = std::array::from_fn(|n| {
                view.interpolate([a, b, d], [0, 1, 3].map(|k| CORNERS[k][n]), pixel)
            });
            let found = shown.each_ref().map(|shown| shown[i].unwrap());
            for n in 0..3 {
                assert!(
                    (found[0][n] - exact[n]).abs() < 1e-9,
                    "{pixel:?}: {:?} {exact:?}",
                    found[0]
                );
            }
            let square = |uv: [f64; 3]| (uv[0].floor() + uv[1].floor()).rem_euclid(2.0) == 0.0;
            for (found, wrong) in found.iter().zip(&mut squares) {
                *wrong += usize::from(square(*found) != square(exact));
            }
            compared += 1;
        }
    }
    assert!(compared > 10_000 && cut > 50, "{compared} {cut}");
    assert_eq!(squares[0], 0);
    assert!(squares[1] > compared / 50, "{squares:?} of {compared}");
}
