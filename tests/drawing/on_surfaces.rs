//! Lines and points that lie on polygons within the tolerance of their overlay: visible from both sides, and
//! painted after the polygons.

use super::between::covers;
use super::map_of;
use binspace::drawing::{DisplayItem, Drawing, LineRun, Path};
use binspace::overlay::{Overlay, Shapes};
use testkit::prelude::*;

/// The share of a list of lines that is hidden.
fn hidden_share(runs: &[LineRun]) -> f64 {
    let length = |run: &LineRun| DVec2::from(run.ends[0]).distance(run.ends[1].into());
    let hidden = runs.iter().filter(|run| !run.is_visible);
    hidden.map(length).sum::<f64>() / runs.iter().map(length).sum::<f64>()
}

/// How an overlay appears: the hidden share of its lines, the hidden points, and the share of places on lines and
/// points over which a polygon is painted later.
fn seen(tree: &BspTree, overlay: &Overlay, camera: &Camera) -> (f64, usize, f64) {
    let map = map_of(tree, camera);
    let lines = hidden_share(&map.lines(overlay, Hidden::Keep).unwrap());
    let markers = map.markers(overlay).unwrap();
    let points = markers.iter().filter(|marker| !marker.is_visible).count();
    let drawing = Drawing::translucent(tree, camera, &ViewOptions::DEFAULT, Some(overlay)).unwrap();
    let (mut over, mut all) = (0, 0);
    let mut later: Vec<Path<'_>> = drawing.paths().collect();
    later.reverse();
    for item in drawing.display_list() {
        let places = match item {
            DisplayItem::Path(_) => {
                later.pop();
                continue;
            }
            DisplayItem::Line(run) => {
                let [a, b] = run.ends.map(DVec2::from);
                (0..8).map(|k| a.lerp(b, (f64::from(k) + 0.5) / 8.0).to_array()).collect()
            }
            DisplayItem::Marker(marker) => vec![marker.position],
            _ => unreachable!(),
        };
        for at in places {
            all += 1;
            over += usize::from(later.iter().any(|path| covers(path, at, -1.0) == Some(true)));
        }
    }
    (lines, points, f64::from(over as u32) / f64::from(all as u32))
}

/// The tolerance of an overlay in `f32` exceeds that of a tree in `f64`. It decides for lines and points, as it does
/// in orders. On a tree with a tolerance of 0, the rounding of the lines decides.
#[test]
fn shapes_in_f32_are_on_a_wall_in_f64() {
    let slope = |x: f64, y: f64| 0.3 * x + 0.2 * y;
    let wall = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
    let wall = wall.map(|[x, y]| DVec3::new(x, y, slope(x, y)));
    let mut dice = Dice(1);
    let mut hidden = [0; 2];
    for options in [BuildOptions::DEFAULT, BuildOptions::DEFAULT.with_tolerance(0.0)] {
        let tree = options.build([wall]).unwrap();
        for _ in 0..times(20) {
            let at = DVec2::new(dice.range(-0.9, 0.7), dice.range(-0.9, 0.7));
            for off in [0.0, 1e-5] {
                let corner = |at: DVec2| at.extend(slope(at.x, at.y) + off).as_vec3();
                let line = [corner(at), corner(at + DVec2::new(0.1, 0.07))];
                let mut overlay = Overlay::new(&tree);
                let shapes = Shapes::NONE.with_lines([line]).with_points(line);
                overlay.replace_with(&tree, shapes).unwrap();
                for z in [1.0, -1.0] {
                    let camera =
                        Camera::parallel(DVec3::NEG_Z * z, DVec3::Y, DVec3::ZERO, 3.0, [300, 300]);
                    let found = seen(&tree, &overlay, &camera.unwrap());
                    if off > 0.0 {
                        let expected = if z > 0.0 { (0.0, 0, 0.0) } else { (1.0, 2, 1.0) };
                        assert_eq!(found, expected, "{line:?}");
                    } else if options == BuildOptions::DEFAULT {
                        assert_eq!(found, (0.0, 0, 0.0), "{line:?}");
                        hidden[0] += 1;
                    } else {
                        hidden[1] += usize::from(found.0 > 0.0);
                    }
                }
            }
        }
    }
    enough!(hidden[0] >= 40, hidden[1] > 15; "{hidden:?}");
}
