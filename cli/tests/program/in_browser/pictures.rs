//! The script of a page paints as the library does.

use binspace::BspTree;
use binspace::glam::DVec3;
use binspace::internals::LATTICE_LIMIT;
use binspace::paint::paint_tree;
use binspace::raster::{NONE, Rays};
use binspace::view::{Camera, Projection, views};

use super::{PAINTED, PAINTERS, page_and_tree};
use crate::run::Folder;
use testkit::browser::{browser, said};

/// Cameras around a tree and inside it, and a parallel one twice; each with whether backs are left out.
fn cameras(tree: &BspTree) -> Vec<(Camera, bool)> {
    let corners = tree.fragments().flat_map(|fragment| fragment.vertices());
    let [low, high] = corners
        .fold([DVec3::MAX, DVec3::MIN], |[low, high], corner| [low.min(corner), high.max(corner)]);
    let size = [320, 180];
    let mut cameras = views([low, high], DVec3::Z, 4, size, 5).unwrap();
    let (middle, extent) = (0.5 * (low + high), (high - low).length());
    let direction = DVec3::new(-1.0, -2.0, -1.5);
    let parallel = Camera::parallel(direction, DVec3::Z, middle, extent, size).unwrap();
    cameras.extend([parallel, parallel]);
    cameras.into_iter().enumerate().map(|(i, camera)| (camera, i == 2 || i == 5)).collect()
}

/// Paints with a camera, each polygon in its own colour, and returns the polygon of each pixel.
fn script_of_picture(tree: &BspTree, camera: &Camera, culls_backs: bool) -> String {
    let lattice = tree.faces().lattice();
    let units = |length: f64| lattice.length_to_lattice(length) / LATTICE_LIMIT;
    let (target, distance, slope) = match *camera.projection() {
        Projection::Perspective { eye, half_height } => (eye, 0.0, half_height),
        Projection::Parallel { centre, height, .. } => (
            centre + camera.forward() * lattice.length_to_world(LATTICE_LIMIT),
            1.0,
            units(0.5 * height),
        ),
    };
    let target = lattice.to_lattice(target).map(|c| c / LATTICE_LIMIT);
    let [forward, left, up] =
        [camera.forward(), -camera.right(), camera.up()].map(|v| v.to_array());
    let [width, height] = camera.size();
    let is_parallel = distance > 0.0;
    format!(
        "(() => {{
            camera = {{ base: [{forward:?}, {left:?}, {up:?}], yaw: 0, pitch: 0, target: {target:?},
                distance: {distance:?}, slope: {slope:?}, isParallel: {is_parallel} }};
            const colours = Float32Array.from({{ length: 3 * TREE.fragments }},
                (_, i) => (TREE.polygons[Math.floor(i / 3)] >> 8 * (i % 3)) & 255);
            const opacities = new Float64Array(TREE.fragments).fill(1);
            const style = {{ colours, opacities, background: [255, 255, 255], cullsBacks: {culls_backs} }};
            return Array.from(painted({width}, {height}, style), pixel => pixel & 0xffffff).join(' ');
        }})()"
    )
}

/// The polygon of each pixel by the library's painter, which decides pixels by exact lines.
fn picture_of_library(tree: &BspTree, camera: &Camera, culls_backs: bool) -> Vec<u32> {
    let rays = Rays::new(camera, tree.faces()).unwrap();
    let rays = if culls_backs { rays.with_front_faces_only() } else { rays };
    let image = paint_tree(tree, camera.viewpoint(), &rays);
    let polygon = |&face: &u32| match face {
        NONE => BACKGROUND,
        face => tree.faces().polygon(face) as u32,
    };
    image.faces().iter().map(polygon).collect()
}

const BACKGROUND: u32 = 0xff_ffff;

/// The page rounds vertices: a pixel may differ if its centre lies within a rounding of an edge. WebGL rounds
/// corners to a sixteenth of a pixel.
#[test]
#[ignore = "needs Chromium"]
fn pictures_are_those_of_the_library() {
    let browser = browser();
    let folder = Folder::new("page_pictures");
    let (mut shown, mut differ) = (0, [0; 2]);
    for scene in ["teapot:6", "random:200", "city:500", "cornell"] {
        let (page, tree) = page_and_tree(&folder, scene);
        let cameras = cameras(&tree);
        let pictures: Vec<Vec<u32>> = cameras
            .iter()
            .map(|(camera, culls)| picture_of_library(&tree, camera, *culls))
            .collect();
        let scripts: Vec<String> = cameras
            .iter()
            .map(|(camera, culls)| script_of_picture(&tree, camera, *culls))
            .collect();
        let differences = |page: &str, painter: &str| -> usize {
            let scripts = scripts.join(", ");
            let script = format!("graphics = {painter}; {PAINTED} return [{scripts}].join(';');");
            let said = said(browser, &folder.path(""), page, &script);
            let found =
                said.split(';').map(|picture| picture.split(' ').map(|id| id.parse().unwrap()));
            let found: Vec<Vec<u32>> = found.map(Iterator::collect).collect();
            assert!(found.iter().map(Vec::len).eq(pictures.iter().map(Vec::len)));
            let pixels = found.iter().flatten().zip(pictures.iter().flatten());
            pixels.filter(|(found, right)| found != right).count()
        };
        for (differ, painter) in differ.iter_mut().zip(PAINTERS) {
            *differ += differences(&page, painter);
        }
        shown += pictures.iter().flatten().filter(|&&polygon| polygon != BACKGROUND).count();
        if scene == "random:200" {
            // A copy that takes the near side for the far one is found out.
            let broken = page.replace("const isFront = ", "const isFront = !");
            assert_ne!(broken, page);
            assert!(PAINTERS.iter().all(|painter| differences(&broken, painter) > 10_000));
        }
    }
    assert!(shown > 400_000, "{shown}");
    assert!(differ[0] <= 10 && differ[1] <= shown / 200, "{differ:?}");
}

/// A tenth of the pixels of lines may differ: WebGL rounds corners to a sixteenth of a pixel.
#[test]
#[ignore = "needs Chromium"]
fn both_painters_draw_the_same_lines() {
    let browser = browser();
    let folder = Folder::new("page_lines");
    for scene in ["teapot:6", "random:200", "cornell"] {
        let (page, _) = page_and_tree(&folder, scene);
        // The pixels of lines, and the pixels in which the painters differ.
        let counts = |page: &str| -> [usize; 2] {
            let [first, second] = PAINTERS;
            let script = format!(
                "{PAINTED}
                const colours = new Float32Array(3 * TREE.fragments).fill(200);
                const opacities = new Float64Array(TREE.fragments).fill(1);
                const plain = {{ colours, opacities, background: [255, 255, 255] }};
                const lined = {{ ...plain, edges: [0, 0, 0], cuts: [255, 0, 0] }};
                const pixels = (painter, style) => {{
                    graphics = painter;
                    return Array.from(painted(320, 180, style), pixel => pixel & 0xffffff);
                }};
                const differ = (a, b) => a.filter((pixel, i) => pixel !== b[i]).length;
                const lines = pixels({first}, lined);
                return [differ(lines, pixels({first}, plain)),
                    differ(lines, pixels({second}, lined))].join(' ');"
            );
            let said = said(browser, &folder.path(""), page, &script);
            let numbers: Vec<usize> = said.split(' ').map(|n| n.parse().unwrap()).collect();
            numbers.try_into().unwrap()
        };
        let [lines, differ] = counts(&page);
        assert!(lines > 1_000 && 10 * differ < lines, "{scene}: {differ} of {lines}");
        // A copy whose WebGL draws wider lines is found out.
        let broken = page.replace("0.5 * lineWidth *", "1.5 * lineWidth *");
        assert_ne!(broken, page);
        let [lines, differ] = counts(&broken);
        assert!(differ > lines, "{scene}: {differ} of {lines}");
    }
}
