//! Views in which many planes and corners are in line with the eye, exactly or almost.

use super::{
    Polygons, covers_by_itself, cycle_that_no_plane_cuts, disjoint, faces, judge, polygons_of,
};
use crate::method::{Options, all};
use testkit::prelude::*;

/// Eyes at corners, in planes, just off them, and far away. Eyes that touch a face up to rounding are marked:
/// the face may fill the picture at distance 0, and any near plane cuts it off.
fn in_line(polygons: &Polygons, size: [u32; 2]) -> Vec<(bool, Camera)> {
    let corners = || polygons.iter().flatten();
    let centre = corners().sum::<DVec3>() / corners().count() as f64;
    let mut cameras = Vec::new();
    for polygon in polygons.iter().step_by(polygons.len() / 3) {
        let (a, b, c) = (polygon[0], polygon[1], polygon[2]);
        let normal = (b - a).cross(c - a).normalize();
        let (target, up) = (centre + normal * 1e-3, normal + DVec3::X);
        let within = a * 0.2 + b * 0.3 + c * 0.5;
        let eyes = [
            (true, within),
            (true, (a + b) * 0.5),
            (false, a),
            (false, within + normal * 1e-4),
            (false, a * 4.0 - b * 3.0),
            (false, centre + normal * 1e4),
            (false, centre + (b - a) * 1e5),
        ];
        for (touches, eye) in eyes {
            let span = 2.5 / (eye - centre).length();
            let fov = if span < 1e-2 { span } else { 1.4 };
            let camera = Camera::perspective(eye, target, up, fov, size).unwrap();
            cameras.push((touches, camera));
        }
        let along = Camera::parallel(b - a, normal, centre, 2.0, size).unwrap();
        cameras.push((false, along));
    }
    cameras
}

#[test]
fn views_in_line_with_many_planes_are_no_worse() {
    let scenes = [
        disjoint(3, 2),
        cycle_that_no_plane_cuts(),
        polygons_of(&scene::crossing(5)),
        polygons_of(&scene::cornell_box()),
    ];
    for (number, polygons) in scenes.iter().enumerate() {
        let faces = faces(polygons, Some(0.0));
        let methods = [Heuristic::Auto, Heuristic::Sampled { candidates: 8 }].map(|heuristic| {
            all(&Options::DEFAULT.with_build(BuildOptions::DEFAULT.with_heuristic(heuristic)))
        });
        for (touches, camera) in in_line(polygons, [40, 30]) {
            for method in methods.iter().flatten() {
                let (name, result) = (method.name(), judge(&**method, &faces, &camera));
                let at = format!("{name} on scene {number} of {camera:?}");
                if ["bsp exact", "z f64"].contains(&&*name) || name == "newell" && !touches {
                    assert_eq!(result.wrong(), 0, "{at}");
                }
                // A face that the eye touches is clipped off. If it was cut, it is drawn by rounded vertices,
                // so the eye may see it from the side.
                let is_seen_by_rounding = touches && name != "bsp exact";
                let own_coverage = covers_by_itself(&name) || name.starts_with("fronts");
                if !is_seen_by_rounding && !own_coverage {
                    assert_eq!(result.holes + result.spills, 0, "{at}");
                }
            }
        }
    }
}
