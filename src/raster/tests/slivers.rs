//! Triangles so thin that rounding takes their normals.

use glam::DVec3;

use crate::exact::Faces;
use crate::raster::picture::flat_normal;

/// In floats, the vector product of its edges is 0.
#[test]
fn the_normal_of_a_sliver_is_that_of_its_plane() {
    let sliver = [
        [-281_474_976_710_656, -140_737_488_355_328, -140_737_488_355_328],
        [121_780_518_933_211, -326_184_141_481_648, -44_014_312_109_210],
        [-450_158_144_636_571, -63_164_512_243_349, -181_197_127_361_614],
    ]
    .map(|corner: [i64; 3]| corner.map(|c| c as f64));
    let (faces, _) = Faces::new([sliver], Some(0.0)).unwrap();
    let off = flat_normal(&faces, 0) - DVec3::new(-2.0, -8.0, -7.0).normalize();
    assert!(off.length() < 1e-9, "{off}");
}
