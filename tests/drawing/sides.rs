//! The polygon's edges along which sides of paths run, against the edges projected by the camera.

use super::scenes::cameras;
use binspace::drawing::Path;
use testkit::prelude::*;

/// The distance of a point from a segment, in pixels.
pub(super) fn distance(at: DVec2, [a, b]: [DVec2; 2]) -> f64 {
    let along = ((at - a).dot(b - a) / (b - a).length_squared()).clamp(0.0, 1.0);
    (a + (b - a) * along).distance(at)
}

#[derive(Debug, Default)]
struct Score {
    own: usize,
    others: usize,
    unsure: usize,
}

/// Checks that a side runs along the edge that contains the side's middle, and along none if no edge contains
/// the middle.
fn check(path: Path<'_>, corners: &[DVec3], camera: &Camera, score: &mut Score) {
    let projected: Option<Vec<DVec2>> =
        corners.iter().map(|&corner| camera.project(corner).map(DVec2::from)).collect();
    // Polygons that reach behind the eye are left out.
    let Some(projected) = projected else { return };
    let edge = |k: usize| [projected[k], projected[(k + 1) % projected.len()]];
    for (outline, edges) in path.outlines().zip(path.edges()) {
        assert_eq!(outline.len(), edges.len());
        for (i, found) in edges.iter().enumerate() {
            let [a, b] = [i, (i + 1) % outline.len()].map(|i| DVec2::from(outline[i]));
            let off = |k: usize| distance((a + b) * 0.5, edge(k));
            if let Some(k) = found.map(|k| k as usize) {
                let line = (edge(k)[1] - edge(k)[0]).normalize_or_zero();
                let beside = [a, b].map(|end| line.perp_dot(end - edge(k)[0]).abs());
                assert!(
                    beside[0].max(beside[1]) < 1e-3 && off(k) < 1e-3,
                    "{} {i} {k}",
                    path.polygon()
                );
                score.own += 1;
                continue;
            }
            // Another polygon's edge may run along an edge of this polygon, and a short side may be near any
            // edge.
            let is_on = |k: usize| [a, b].iter().all(|&end| distance(end, edge(k)) < 1e-7);
            // If an edge of a bent polygon is seen end-on, a diagonal and the next edge coincide in the
            // picture.
            let is_end_on = |k: usize| edge(k)[0].distance(edge(k)[1]) < 1e-6;
            let all = 0..projected.len();
            let size = camera.size().map(f64::from);
            let on_border = |c: f64, i: usize| c.abs().min((c - size[i]).abs()) < 1e-9;
            let is_border = (0..2).any(|i| on_border(a[i], i) && on_border(b[i], i));
            let is_along = !is_border
                && all.clone().any(is_on)
                && a.distance(b) > 1.0
                && !all.clone().any(is_end_on);
            assert!(!is_along, "{} {i}: on an edge, {a} {b}", path.polygon());
            let nearest = all.map(off).fold(f64::MAX, f64::min);
            *if nearest > 1e-2 { &mut score.others } else { &mut score.unsure } += 1;
        }
    }
}

#[test]
fn sides_of_paths_have_the_edges_along_which_they_run() {
    let mut score = Score::default();
    for builtin in Builtin::ALL {
        let scene = builtin.build(builtin.default_size().map(|size| size.min(200)), 3);
        let tree = BspTree::build(scene.polygons()).unwrap();
        for (i, camera) in cameras(&scene, 4, [160, 120]).iter().enumerate() {
            let drawing = match i % 3 {
                0 => tree.visibility(camera, &ViewOptions::DEFAULT).unwrap().drawing(),
                1 => {
                    let opacity = |polygon: usize| [1.0, 0.5, 1.0][polygon % 3];
                    let options = with_opacities(&tree, opacity);
                    tree.visibility(camera, &options).unwrap().drawing()
                }
                _ => Drawing::translucent(&tree, camera, &ViewOptions::DEFAULT, None),
            };
            for path in drawing.unwrap().paths() {
                check(path, scene.polygon(path.polygon()), camera, &mut score);
            }
        }
    }
    enough!(score.own > 20_000, score.others > 500; "{score:?}");
    assert!(score.unsure < score.own / 20, "{score:?}");
}

/// Two teeth of a comb end on one line. Each side has the number of the edge of its own tooth.
#[test]
fn edges_on_one_line_are_told_apart() {
    let comb = [
        [0.0, 0.0],
        [7.0, 0.0],
        [7.0, 3.0],
        [5.0, 3.0],
        [5.0, 1.0],
        [2.0, 1.0],
        [2.0, 3.0],
        [0.0, 3.0],
    ];
    let comb = comb.map(|[x, y]| DVec3::new(x, y, 0.0));
    let tree = BspTree::build([comb]).unwrap();
    let camera =
        Camera::parallel(DVec3::NEG_Z, DVec3::Y, DVec3::new(3.5, 1.5, 0.0), 8.0, [80, 80]).unwrap();
    let map = tree.visibility(&camera, &ViewOptions::DEFAULT).unwrap();
    let drawing = map.drawing().unwrap();
    let path = drawing.paths().next().unwrap();
    let (outline, edges) = (path.outlines().next().unwrap(), path.edges().next().unwrap());
    let mut found: Vec<_> =
        outline.iter().zip(edges).map(|(at, edge)| (edge.unwrap(), *at)).collect();
    found.sort_by_key(|(edge, _)| *edge);
    assert_eq!(found.len(), 8);
    for (edge, at) in found {
        // The polygon is clockwise in the picture, so a side ends where its edge begins.
        let ends =
            [edge as usize, (edge as usize + 1) % 8].map(|k| camera.project(comb[k]).unwrap());
        let off = ends.map(|end| DVec2::from(end).distance(at.into()));
        assert!(off[0].min(off[1]) < 1e-6, "{edge}: {at:?}, not one of {ends:?}");
    }
}
