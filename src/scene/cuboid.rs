//! The rectangles of a box.

use glam::DVec3;

/// The six rectangles of an axis-aligned box, counter-clockwise from outside, in the order −x +x −y
/// +y −z +z.
pub fn cuboid(low: DVec3, high: DVec3) -> [[DVec3; 4]; 6] {
    let corner = |x: bool, y: bool, z: bool| {
        DVec3::new(
            if x { high.x } else { low.x },
            if y { high.y } else { low.y },
            if z { high.z } else { low.z },
        )
    };
    let (o, i) = (false, true);
    [
        [corner(o, o, o), corner(o, o, i), corner(o, i, i), corner(o, i, o)],
        [corner(i, o, o), corner(i, i, o), corner(i, i, i), corner(i, o, i)],
        [corner(o, o, o), corner(i, o, o), corner(i, o, i), corner(o, o, i)],
        [corner(o, i, o), corner(o, i, i), corner(i, i, i), corner(i, i, o)],
        [corner(o, o, o), corner(o, i, o), corner(i, i, o), corner(i, o, o)],
        [corner(o, o, i), corner(i, o, i), corner(i, i, i), corner(o, i, i)],
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_face_looks_outwards() {
        let outward = [DVec3::NEG_X, DVec3::X, DVec3::NEG_Y, DVec3::Y, DVec3::NEG_Z, DVec3::Z];
        let faces = cuboid(DVec3::ZERO, DVec3::ONE);
        for ([a, b, c, d], normal) in faces.into_iter().zip(outward) {
            assert_eq!((b - a).cross(c - b), normal);
            assert_eq!(a - b + c - d, DVec3::ZERO, "a parallelogram");
        }
    }
}
