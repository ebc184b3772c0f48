//! Back faces for eyes that are so far away, and so close to the polygons' planes, that rounded normals give
//! the wrong side.

use binspace::{Culling, Facing};
use testkit::prelude::*;
use testkit::rational::Plane;
use testkit::views::View;

/// Parallel squares, one behind the other and beside each other.
fn tiles(normal: DVec3) -> Vec<[DVec3; 4]> {
    let (u, v) = normal.any_orthonormal_pair();
    let tile = |k: u32| {
        let [x, y, z] = [k % 3, k / 3 % 3, k / 9].map(f64::from);
        let corner = u * x + v * y + normal * (0.1 * z);
        [corner, corner + u * 0.9, corner + (u + v) * 0.9, corner + v * 0.9]
    };
    (0..27).map(tile).collect()
}

#[test]
fn fronts_are_exact_where_normals_of_f32_are_not() {
    let mut dice = Dice(41);
    let mut misleading = 0;
    for _ in 0..times(60) {
        let normal = dice.point(-0.5, 0.5).normalize();
        let tree = BspTree::build(tiles(normal)).unwrap();
        let faces = tree.faces();
        let planes: Vec<Plane> =
            tree.fragments().map(|f| model::plane(faces, PlaneId::face(f.face()))).collect();
        let (u, v) = normal.any_orthonormal_pair();
        for _ in 0..12 {
            let (sin, cos) = (dice.share() * std::f64::consts::TAU).sin_cos();
            let way = (u * cos + v * sin) * 1e9;
            let above = (dice.share() - 0.5) * 60.0;
            let world = way + normal * above;
            let view = View::eye(faces, DVec3::from(faces.lattice().to_lattice(world)));
            let sides: Vec<Ordering> = planes.iter().map(|plane| view.side(plane)).collect();
            for (shown, side) in
                [(Facing::Front, Ordering::Greater), (Facing::Back, Ordering::Less)]
            {
                let mut found = Vec::new();
                let culling = Culling::NONE.with_facing(shown);
                tree.order(view.viewpoint).culled(&culling).write_into(&mut found);
                found.sort_unstable();
                let all = 0..tree.len() as u32;
                assert!(found.into_iter().eq(all.filter(|&f| sides[f as usize] == side)));
            }
            // The side that `f32` normals give, if all polygons are at about the same height.
            let rounded = tree.fragment(0).normal().as_vec3().as_dvec3();
            let eye = way + normal * above;
            misleading += usize::from(rounded.dot(eye) * above < 0.0 && above.abs() > 2.0);
        }
    }
    enough!(misleading > 50; "{misleading} views");
}
