use crate::drawing::primitives::*;
use crate::random::SplitMix64;
use crate::scene::Builtin;
use crate::tree::BspTree;

/// Those by floats are as near to those by integers as they say, and nearly all are by floats: also of triangles
/// that are nearly in one plane, and of needles.
#[test]
fn vertices_are_as_near_as_they_say() {
    let mut random = SplitMix64::new(3);
    let mut crossing = |flat: f64, thin: f64| -> Vec<Vec<glam::DVec3>> {
        let mut point = |size: f64| {
            let mut point = random.point(-size, size);
            point.z *= flat;
            point
        };
        (0..60)
            .map(|_| {
                let (a, b) = (point(1.0), point(1.0));
                vec![a, b, a + (b - a) * 0.5 + point(thin)]
            })
            .collect()
    };
    let mut scenes = vec![
        Builtin::Random
            .build(Some(150), 5)
            .polygons()
            .map(|polygon| polygon.points().to_vec())
            .collect(),
    ];
    for (flat, thin) in [(1.0, 1.0), (1e-6, 1.0), (1e-12, 1.0), (1.0, 1e-6), (1e-4, 1e-9)] {
        scenes.push(crossing(flat, thin));
    }
    // Flattened: their edges are not straight through their corners.
    let flattened = (0..40).map(|_| {
        let [a, u, v, bend] = [1.0, 1.0, 1.0, 1e-8].map(|size| random.point(-size, size));
        vec![a, a + u, a + u + v + bend, a + v]
    });
    scenes.push(flattened.collect());
    let (mut all, mut by_floats, mut upright) = (0, 0, 0);
    for polygons in scenes {
        let tree = BspTree::build(&polygons).unwrap();
        let faces = tree.faces();
        for fragment in tree.fragments() {
            let is_upright = faces.moved_axis(fragment.face()).is_some();
            for (vertex_id, exact) in fragment.vertex_ids().zip(fragment.lattice_vertices()) {
                upright +=
                    u32::from(is_upright && matches!(vertex_id.kind(), VertexKind::OnEdge(..)));
                all += 1;
                let Some(near) = near_vertex(faces, fragment.face(), vertex_id) else {
                    continue;
                };
                by_floats += 1;
                let off = difference(near, exact).map(f64::abs);
                assert!(
                    off.iter().all(|off| *off <= NEAR_VERTEX),
                    "{vertex_id:?}: {near:?}, not {exact:?}"
                );
            }
        }
    }
    assert!(all > 10_000 && by_floats * 5 > all * 4, "{by_floats} of {all}");
    assert!(upright > 50, "{upright}");
}
