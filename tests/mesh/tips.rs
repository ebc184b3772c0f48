//! Tips that a plane cuts off a face with moved corners, but would not cut off the given polygon; and cuts of such a face
//! at a small angle, which move along its edges.

use crate::mesh::exact::{Seen, check_moved};
use binspace::Fragment;
use testkit::prelude::*;

/// The distance of a quad's topmost given corner below the plane of the other corners: less than the
/// tolerance.
const OFF: f64 = 1.0 / 64.0;

/// A floor through the given topmost corner, triangles that cut the tip above it, and the quad.
fn polygons(triangles: usize, dice: &mut Dice) -> Vec<Vec<DVec3>> {
    let quad = [[2.0, 1.0, -2.625], [4.0, 4.0, -7.0], [1.0, 2.0, -2.625], [0.0, 0.0, -OFF]];
    let floor = [(-3.0, -3.0), (-2.0, -3.0), (-2.0, -2.0), (-3.0, -2.0)].map(|(x, y)| [x, y, -OFF]);
    let mut polygons = vec![floor.map(DVec3::from).to_vec()];
    for _ in 0..triangles {
        let share = 0.1 + 0.8 * dice.share();
        let at = DVec3::new(1.0 + share, 2.0 - share, -2.625) * (OFF / 2.625);
        let [u, v] = [(); 2].map(|()| DVec3::from([(); 3].map(|()| 2.0 * dice.share() - 1.0)));
        polygons.push(vec![at + u, at - u + v, at - u - v]);
    }
    polygons.push(quad.map(DVec3::from).to_vec());
    polygons
}

#[test]
fn triangles_fill_the_tips_of_moved_faces() {
    let (mut dice, mut seen) = (Dice(1), Seen::default());
    let options = BuildOptions::DEFAULT.with_heuristic(Heuristic::First).with_tolerance(OFF / 1.25);
    let mut tips = 0;
    for triangles in (1..8).cycle().take(40) {
        let polygons = polygons(triangles, &mut dice);
        let tree = options.build(&polygons).unwrap();
        let of_quad = tree.fragments().filter(|f| f.polygon() == triangles + 1);
        let is_tip = |f: &Fragment<'_>| f.vertices().any(|p| p.z > -OFF / 2.0);
        tips += of_quad.filter(is_tip).count();
        check_moved(&tree, &polygons, &mut seen).unwrap();
    }
    assert!(seen.triangles > 3000 && tips > 40, "{tips} tips, {seen:?}");
}

/// A quad with one corner .9 tolerances off the plane of the others. A plane cuts two of its edges at a small angle, where
/// a wall crosses it. In the mesh, the cuts are on the given edges, and the pieces still fill the given quad.
#[test]
fn cuts_of_a_moved_edge_are_on_the_given_edge() {
    let tolerance = 1e-3;
    let mut most: f64 = 0.0;
    for slope in [2.5, 5.0, 20.0] {
        let ramp = |x: f64, y: f64| dvec3(x, y, slope * tolerance * (x - 0.5));
        let wall = |y: f64, z: f64| dvec3(0.5 + 0.45 / slope, y, z);
        let quad = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.9 * tolerance], [0.0, 1.0, 0.0]];
        let quad = quad.map(DVec3::from);
        let polygons = [
            [ramp(-1.0, 2.0), ramp(2.0, 2.0), ramp(2.0, 5.0), ramp(-1.0, 5.0)],
            [wall(2.0, -3.0), wall(5.0, -3.0), wall(5.0, 3.0), wall(2.0, 3.0)],
            quad,
        ];
        for &heuristic in Heuristic::ALL {
            let options = BuildOptions::DEFAULT.with_tolerance(tolerance).with_heuristic(heuristic);
            let tree = options.build(polygons).expect("a tree");
            let mesh = tree.welded_mesh().expect("memory");
            let mut area = 0.0;
            for fragment in tree.fragments().filter(|fragment| fragment.polygon() == 2) {
                let range = mesh.triangles().range(fragment.index());
                let numbers = &mesh.triangles().indices()[range];
                for triangle in numbers.chunks(3) {
                    let [a, b, c] = [0, 1, 2].map(|k| mesh.vertex(triangle[k]).position);
                    area += 0.5 * (b - a).cross(c - a).z;
                }
                let vertices: Vec<DVec3> = fragment.vertices().collect();
                for vertex in numbers.iter().map(|&number| mesh.vertex(number)) {
                    let ends: Vec<DVec3> =
                        vertex.weights.iter().map(|(corner, _)| quad[*corner as usize]).collect();
                    let &[from, to] = &ends[..] else { continue };
                    // Cuts of an edge of the quad, not of the diagonal.
                    if (from - to).length() < 1.1 {
                        let along = (to - from).normalize();
                        let off = (vertex.position - from).reject_from(along).length();
                        assert!(off < 1e-9, "{slope} {heuristic}: {off}");
                        let near = vertices.iter().map(|p| p.distance(vertex.position));
                        most = most.max(near.fold(f64::INFINITY, f64::min) * slope);
                    }
                }
            }
            assert!((area - 1.0).abs() < 1e-5, "{slope} {heuristic}: {area}");
        }
    }
    // In tolerances divided by the sine of the angle.
    assert!((0.3..1.5).contains(&most), "{most}");
}
