//! Polygons that lie in one plane by definition.

use glam::DVec3;

use super::Faces;
use crate::exact::PlaneId;

/// A large square, and a small square with its front on the other side. At the end of the large square, the
/// small square's plane is off by more than the tolerance.
#[test]
fn polygons_put_into_one_plane_share_it_and_keep_their_fronts() {
    let square = |x: f64, size: f64| {
        [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]].map(|[u, v]| {
            let (x, y) = (x + u * size, v * size);
            DVec3::new(x, y, 0.3 * x + 0.7 * y)
        })
    };
    for reversed in 0..2 {
        let mut squares = [square(0.1, 1e-7), square(-1.0, 2.0)];
        squares[reversed].reverse();
        let mut faces = Faces::new(squares, Some(1e-9)).unwrap().0;
        let front = |faces: &Faces, face| faces.plane(PlaneId::face(face)).normal_f64().normalize();
        let before = [0, 1].map(|face| front(&faces, face));
        faces.put_into_one_plane(&[0, 1]).unwrap();
        let [a, b] = [0, 1].map(|face| {
            let mut triangle = faces.reference_triangle(face);
            triangle.sort_unstable();
            triangle
        });
        assert_eq!(a, b);
        for (face, before) in (0..).zip(before) {
            assert!(front(&faces, face).dot(before) > 0.9, "{face}");
        }
    }
}
