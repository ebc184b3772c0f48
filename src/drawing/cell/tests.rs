use super::Corner;
use crate::drawing::frame::meeting;
use crate::drawing::half::Half;
use crate::drawing::lines::tests::{all_lines, quads};
use crate::random::SplitMix64;
use crate::tree::BspTree;
use crate::view::Camera;
use glam::DVec3;

/// Corners are where lines of a picture meet in integers, as near as they say; and where floats tell on which side of a
/// third line one is, it is there.
#[test]
fn corners_are_as_near_as_they_say_and_on_the_sides_that_floats_tell() {
    let mut random = SplitMix64::new(3);
    let (mut corners, mut sides, mut rough) = (0, 0, 0);
    for round in 0..12 {
        let size = [1.0, 1e5][round % 2];
        let tree = BspTree::build(quads(&mut random, size, DVec3::ZERO)).unwrap();
        let eye = random.point(-1.0, 1.0) * size * [2.0, 1e3, 1e6][round % 3];
        let fov = [1.5, 3e-3, 3e-6][round % 3];
        let camera = Camera::perspective(eye, DVec3::ZERO, DVec3::Z, fov, [320, 200]).unwrap();
        let rims = all_lines(&tree, &camera).unwrap();
        let lines = &rims.lines;
        let halves: Vec<Half> = (0..lines.len() as u32).map(Half::of).collect();
        for (i, &a) in halves.iter().enumerate() {
            for &b in &halves[..i] {
                let exact = [a, b].map(|half| lines.exact(half));
                let at = meeting(exact.each_ref());
                if !lines.shows(at) {
                    continue;
                }
                let corner = Corner::of(lines, [a, b]);
                let off = (corner.at[0] - at[0]).hypot(corner.at[1] - at[1]);
                // That is itself rounded three times.
                assert!(off <= corner.radius + 3e-13, "{off:e}, {corner:?}");
                corners += 1;
                rough += usize::from(corner.radius > 1e-9);
                for &half in halves.iter().step_by(7) {
                    let line = lines.rounded(half);
                    let value = line.at(corner.at);
                    if value.abs() > line.error + line.slope * corner.radius {
                        let turn = lines.rounded(a).k[1] * lines.rounded(b).k[2]
                            - lines.rounded(a).k[2] * lines.rounded(b).k[1];
                        let side = lines.exact_side(half, [a, b]);
                        let side = if turn > 0.0 { side } else { side.reverse() };
                        assert_eq!(side, value.total_cmp(&0.0), "{corner:?}, {line:?}");
                        sides += 1;
                    }
                }
            }
        }
    }
    assert!(corners > 10_000 && sides > 100_000 && rough > 50, "{corners} {sides} {rough}");
}
