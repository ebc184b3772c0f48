//! Polygons of four corners, as most are: decided by rounded numbers where these are certain.

use glam::DVec3;

use crate::Error;
use crate::exact::faces::Frame;
use crate::exact::{Faces, Flattener, RoundedNormal, turns_one_way};
use crate::memory::push;

/// A convex quadrilateral with its frame, as the general rules make it.
#[derive(Debug)]
pub(super) struct Quad {
    corners: [[f64; 3]; 4],
    /// The corners that span the plane together with corner 0.
    second: usize,
    third: usize,
    /// The axis in which the plane is least steep.
    axis: usize,
}

impl Quad {
    /// The quadrilateral of four lattice points, if it is certain that they are one.
    pub(super) fn of(corners: [[f64; 3]; 4]) -> Option<Self> {
        let [second, third] = widest(&corners);
        let plane = RoundedNormal::through([0, second, third].map(|k| corners[k]));
        let quad = Self { corners, second, third, axis: plane.certain_axis()? };
        // Seen along the axis.
        let (x, y) = ((quad.axis + 1) % 3, (quad.axis + 2) % 3);
        turns_one_way(corners.map(|corner| [corner[x], corner[y]])).then_some(quad)
    }
}

/// Two corners that span a large triangle with corner 0, as `widest_triangle` chooses them.
fn widest(corners: &[[f64; 3]; 4]) -> [usize; 2] {
    let [origin, arms @ ..] = corners.map(DVec3::from);
    let [a, b, c] = arms.map(|corner| corner - origin);
    let [aa, bb, cc] = [a, b, c].map(DVec3::length_squared);
    let areas = |arm: DVec3, one: DVec3, other: DVec3| {
        arm.cross(one).length_squared() > arm.cross(other).length_squared()
    };
    if cc >= aa && cc >= bb {
        if areas(c, a, b) { [1, 3] } else { [2, 3] }
    } else if bb >= aa {
        if areas(b, a, c) { [1, 2] } else { [2, 3] }
    } else if areas(a, b, c) {
        [1, 2]
    } else {
        [1, 3]
    }
}

impl Quad {
    /// Adds itself as one face, if no corner is further than `bend` off the plane of the others; gives
    /// how far one is.
    pub(super) fn push(
        &self,
        polygon: usize,
        faces: &mut Faces,
        bend: f64,
    ) -> Result<Option<f64>, Error> {
        let Self { mut corners, second, third, axis } = *self;
        let spare = 6 - second - third;
        let given = corners[spare];
        let flattener = Flattener::new([0, second, third].map(|k| corners[k]), axis);
        let off = flattener.off(&given);
        if off.distance > bend {
            return Ok(None);
        }
        let start = faces.corners.len();
        corners[spare][axis] -= off.steps;
        let frame = Frame::new(second, third, (off.distance > 0.0).then_some(axis));
        faces.push(polygon, corners.into_iter(), frame)?;
        if off.steps != 0.0 {
            push(&mut faces.moved, ((start + spare) as u32, given))?;
        }
        Ok(Some(off.distance))
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::{Faces, Quad};
    use crate::random::SplitMix64;

    /// Four corners around a point: flat but for noise of any size, bent, not convex, on small integers
    /// where sizes are equal, or all but on one line.
    fn corners(random: &mut SplitMix64) -> [DVec3; 4] {
        let [at, u, v] = [(); 3].map(|()| random.point(-1.0, 1.0));
        let noise = 2f64.powf(random.range(-60.0, -10.0));
        let signs = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
        let kind = random.next() % 6;
        let v = if kind == 1 { u + v * noise } else { v };
        let mut quad = signs.map(|[x, y]| at + x * u + y * v + random.point(-noise, noise));
        match kind {
            2 => quad[2] = quad[0].lerp(quad[2], random.range(-0.5, 0.9)),
            3 => quad.swap(1, 2),
            4 => quad = quad.map(|corner| (2.0 * corner).round()),
            5 => quad = signs.map(|[x, y]| DVec3::new(x, y, x * y * noise)),
            _ => {}
        }
        quad
    }

    /// A fifth corner, the same as the first, is dropped, but not by the rules for four.
    #[test]
    fn quads_become_the_faces_that_the_general_rules_make() {
        let mut random = SplitMix64::new(9);
        let (mut taken, mut moved, mut bent) = (0, 0, 0);
        for _ in 0..20_000 {
            let quad = corners(&mut random);
            let [a, b, c, d] = quad;
            let tolerance = Some(2f64.powf(random.range(-55.0, -8.0)));
            let (faces, report) = Faces::new([quad], tolerance).unwrap();
            let (others, general) = Faces::new([[a, b, c, d, a]], tolerance).unwrap();
            assert_eq!(report, general, "{quad:?}");
            assert_eq!(
                (&faces.corners, &faces.moved),
                (&others.corners, &others.moved),
                "{quad:?}"
            );
            let frame =
                |faces: &Faces| faces.faces.iter().map(|face| face.frame).collect::<Vec<_>>();
            assert_eq!(frame(&faces), frame(&others), "{quad:?}");
            taken += usize::from(Quad::of(quad.map(|p| faces.lattice().snap(p))).is_some());
            moved += faces.moved.len();
            bent += report.triangulated;
        }
        assert!(taken > 8000 && moved > 3000 && bent > 2000, "{taken} {moved} {bent}");
    }
}
