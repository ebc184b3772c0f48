use super::Family;
use testkit::prelude::*;

fn normal(polygon: &[DVec3]) -> DVec3 {
    (polygon[1] - polygon[0]).cross(polygon[2] - polygon[0]).normalize()
}

fn extent(scene: &Scene) -> f64 {
    let (low, high) = scene.bounds().unwrap();
    (high - low).max_element()
}

/// Checks the scene of each step of the sweeps of a family.
fn each_step(family: Family, mut check: impl FnMut(f64, &Scene)) {
    for quick in [true, false] {
        for &difficulty in family.sweep(quick) {
            check(difficulty, &family.scene(difficulty, 5));
        }
    }
}

fn assert_near(found: f64, expected: f64, share: f64) {
    let error = (found / expected - 1.0).abs();
    assert!(error < share, "{found:e} should be {expected:e}");
}

#[test]
fn names_are_read_as_they_are_written() {
    for family in Family::ALL {
        assert_eq!(family.to_string().parse(), Ok(family));
        assert!(family.description().len() > 20 && !family.parameter().is_empty());
        assert!(family.sweep(true).iter().all(|d| family.sweep(false).contains(d)));
    }
    let message = "angel".parse::<Family>().unwrap_err().to_string();
    assert!(message.contains("\"angel\"") && message.contains("angle, gap"), "{message}");
}

#[test]
fn a_seed_gives_one_scene_and_another_seed_another() {
    for family in Family::ALL {
        let difficulty = family.sweep(true)[1];
        let (scene, cameras) =
            (family.scene(difficulty, 3), family.cameras(difficulty, 3, [64, 48]).unwrap());
        assert_eq!(scene, family.scene(difficulty, 3));
        assert_eq!(cameras, family.cameras(difficulty, 3, [64, 48]).unwrap());
        assert_ne!(scene, family.scene(difficulty, 4), "{family}");
        assert!(cameras.len() >= 5, "{family}");
    }
}

#[test]
fn triangles_cross_at_the_angle() {
    each_step(Family::Angle, |angle, scene| {
        let normals: Vec<DVec3> =
            scene.polygons().map(|polygon| normal(polygon.points())).collect();
        let mut least = f64::INFINITY;
        for (i, p) in normals.iter().enumerate() {
            for q in &normals[..i] {
                least = least.min(p.cross(*q).length());
            }
        }
        assert_near(least, angle, 0.02);
    });
}

#[test]
fn layers_are_the_gap_apart() {
    each_step(Family::Gap, |gap, scene| {
        let up = normal(scene.polygon(0));
        let origin = scene.polygon(0)[0];
        let mut heights: Vec<f64> =
            scene.polygons().map(|p| (p.points()[0] - origin).dot(up)).collect();
        heights.sort_by(f64::total_cmp);
        let lowest = (heights[11] - heights[0]) / 11.0;
        assert_near(lowest / extent(scene), gap, 0.2);
        for pair in heights.windows(2) {
            assert_near(pair[1] - pair[0], lowest, 0.01);
        }
    });
}

#[test]
fn slivers_are_as_narrow_as_they_should_be() {
    each_step(Family::Sliver, |width, scene| {
        for polygon in scene.polygons() {
            let length = (polygon.points()[1] - polygon.points()[0]).length();
            let area = (polygon.points()[1] - polygon.points()[0])
                .cross(polygon.points()[2] - polygon.points()[0])
                .length();
            // A quarter of the length away, the base is 4/3 of the width, and more if the triangle is
            // rotated.
            assert!((1.2..1.7).contains(&(area / length / width)), "{width:e} {area:e}");
        }
    });
}

#[test]
fn the_cube_is_as_far_out_as_it_should_be() {
    each_step(Family::Offset, |distance, scene| {
        let near = scene
            .polygons()
            .filter(|p| p.points()[0].length() < 0.3 || p.points()[1].length() < 0.11);
        assert!(distance < 10.0 || near.count() == 1);
        let mean =
            scene.polygons().map(|p| p.points()[0].length()).sum::<f64>() / scene.len() as f64;
        assert_near(mean, distance, if distance < 10.0 { 0.3 } else { 0.05 });
        let largest =
            scene.polygons().map(|p| (p.points()[1] - p.points()[0]).length()).fold(0.0, f64::max);
        assert!(largest < 1.2, "{largest}");
    });
}

#[test]
fn the_scale_is_a_factor() {
    let one = extent(&Family::Scale.scene(1.0, 5));
    each_step(Family::Scale, |factor, scene| assert_near(extent(scene), one * factor, 1e-12));
}

#[test]
fn scenes_have_the_requested_counts() {
    each_step(Family::Nesting, |count, scene| {
        assert_eq!(scene.len(), count as usize + 1);
        let large = scene.polygons().max_by(|p, q| {
            let size = |p: &[DVec3]| (p[1] - p[0]).length();
            size(p.points()).total_cmp(&size(q.points()))
        });
        let plane = (large.unwrap().points()[0], normal(large.unwrap().points()));
        let pierces = |polygon: &[DVec3]| {
            let height = |p: &DVec3| (*p - plane.0).dot(plane.1);
            let low = polygon.iter().map(height).fold(f64::INFINITY, f64::min);
            low < -1e-3 / count.sqrt() && polygon.iter().map(height).any(|h| h > 0.0)
        };
        assert_eq!(scene.polygons().filter(|p| pierces(p.points())).count(), count as usize);
    });
    each_step(Family::Cycle, |count, scene| assert_eq!(scene.len(), count as usize));
    each_step(Family::Penetration, |count, scene| assert_eq!(scene.len(), count as usize));
}

#[test]
fn a_lattice_is_made_of_integers() {
    each_step(Family::Lattice, |side, scene| {
        assert_eq!(extent(scene), side);
        assert!(scene.polygons().flatten().all(|p| p.fract() == DVec3::ZERO));
        assert!(scene.len() as f64 > side * side * side, "{side}");
    });
}

#[test]
fn boxes_touch_except_for_rounding() {
    each_step(Family::Boxes, |side, scene| {
        let corners: Vec<DVec3> = scene.polygons().flatten().copied().collect();
        let (mut same, mut close) = (0, 0);
        for (i, p) in corners.iter().enumerate().take(200) {
            for q in &corners[..i] {
                let distance = (*p - *q).length();
                same += usize::from(distance == 0.0);
                close += usize::from(distance > 0.0 && distance < 1e-12);
            }
        }
        assert!(same > 0 && (close > 0 || side < 3.0), "{side}: {same} {close}");
    });
}

#[test]
fn bars_cover_each_other_in_a_cycle() {
    each_step(Family::Cycle, |count, scene| {
        // Each bar as a line from the middle of one end to the middle of the other end.
        let lines: Vec<[DVec3; 2]> = scene
            .polygons()
            .map(|p| [(p.points()[0] + p.points()[3]) * 0.5, (p.points()[1] + p.points()[2]) * 0.5])
            .collect();
        let centre = scene.polygons().flatten().sum::<DVec3>() / (4.0 * count);
        // Each bar rises along its length, but the slopes cancel in the sum over all bars.
        let across =
            |line: &[DVec3; 2]| ((line[0] + line[1]) * 0.5 - centre).cross(line[1] - line[0]);
        let up = lines.iter().map(across).sum::<DVec3>().normalize();
        let flat = |p: DVec3| p - up * p.dot(up);
        let mut covers = 0;
        for a in &lines {
            for b in &lines {
                // The points where the lines, seen along `up`, meet: their parameters and heights.
                let (u, v, w) = (flat(a[1] - a[0]), flat(b[1] - b[0]), flat(b[0] - a[0]));
                let d = u.cross(v).dot(up);
                if d.abs() < 1e-9 * u.length() * v.length() {
                    continue;
                }
                let (s, t) = (w.cross(v).dot(up) / d, w.cross(u).dot(up) / d);
                let at = |line: &[DVec3; 2], t: f64| line[0] + (line[1] - line[0]) * t;
                let inside = (0.0..1.0).contains(&s) && (0.0..1.0).contains(&t);
                covers += usize::from(inside && at(a, s).dot(up) > at(b, t).dot(up));
            }
        }
        assert_eq!(covers, count as usize, "each covers one");
    });
}

#[test]
fn triangles_penetrate_each_other() {
    let scene = Family::Penetration.scene(100.0, 5);
    let crossing = |p: &[DVec3], q: &[DVec3]| {
        let n = normal(p);
        let side = |c: &DVec3| (*c - p[0]).dot(n);
        q.iter().any(|c| side(c) > 0.0) && q.iter().any(|c| side(c) < 0.0)
    };
    let pairs = scene.polygons().enumerate().flat_map(|(i, p)| {
        scene
            .polygons()
            .take(i)
            .map(move |q| crossing(p.points(), q.points()) && crossing(q.points(), p.points()))
    });
    assert!(pairs.filter(|&cross| cross).count() > 500);
}

#[test]
fn depths_range_from_one_to_the_ratio() {
    each_step(Family::DepthRange, |ratio, scene| {
        let camera = Family::DepthRange.cameras(ratio, 5, [64, 48]).unwrap()[0];
        let depth = |p: &DVec3| p.dot(camera.forward());
        let depths = || scene.polygons().flatten().map(depth);
        assert_near(depths().fold(f64::INFINITY, f64::min), 1.0, 0.01);
        assert_near(depths().fold(0.0, f64::max), 1.1 * ratio, 0.01);
        assert_eq!(scene.len(), 19);
    });
}
