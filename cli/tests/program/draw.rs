//! Vector pictures with one path a polygon, as a viewer shows them.

use binspace::BspTree;
use binspace::drawing::{ViewOptions, VisiblePolygon};
use binspace::glam::DVec3;
use binspace::paint::paint_tree;
use binspace::raster::{NONE, Rays};
use binspace::scene::Builtin;
use binspace::view::Camera;
use serde_json::Value;

use crate::png_picture::Picture;
use crate::run::{CROSSING, Folder};
use crate::svg_picture::Svg;

pub(crate) const WHITE: [u8; 3] = [255; 3];
/// Samples each way in a pixel of the exact picture: a centre is away from edges if the samples around
/// it agree with it. Viewers round corners to 1/64 of a pixel or so.
const SAMPLES: usize = 21;

/// A green card of glass in front of a blue plate of 4 by 2 units, and behind the plate a red triangle that hides a
/// smaller one.
pub(crate) const CARDS: &str = "\
mtllib cards.mtl\nusemtl blue\nv 0 0 0\nv 4 0 0\nv 4 2 0\nv 0 2 0\nf 1 2 3 4\n\
usemtl glass\nv 1 0.5 1\nv 2 0.5 1\nv 2 1.5 1\nv 1 1.5 1\nf 5 6 7 8\n\
usemtl red\nv 3 0.5 -1\nv 3.5 0.5 -1\nv 3.5 1.5 -1\nf 9 10 11\n\
v 3.24 0.6 -2\nv 3.36 0.6 -2\nv 3.36 0.8 -2\nf 12 13 14\n";
pub(crate) const CARDS_MATERIALS: &str =
    "newmtl blue\nKd 0 0 1\nnewmtl glass\nKd 0 1 0\nd 0.4\nnewmtl red\nKd 1 0 0\n";
/// A view of these from in front: a unit is 20 pixels, and the plate is 10 pixels from the left, and 5 from below.
pub(crate) const CARDS_VIEW: &str = "cards.obj --direction=0,0,-1 --up y --margin 10 --size 100x50";

/// A built-in scene and a camera.
pub(crate) struct View {
    scene: Builtin,
    size: u32,
    eye: DVec3,
    target: DVec3,
    up: DVec3,
    fov: f64,
    pub(crate) pixels: [u32; 2],
}

impl View {
    fn new(scene: Builtin, size: u32, eye: [f64; 3], target: [f64; 3]) -> Self {
        let [eye, target] = [eye, target].map(DVec3::from);
        Self { scene, size, eye, target, up: DVec3::Z, fov: 45.0, pixels: [150, 110] }
    }

    /// The equivalent command-line arguments.
    pub(crate) fn arguments(&self) -> String {
        let vector = |v: DVec3| format!("{:?},{:?},{:?}", v.x, v.y, v.z);
        let scene = match self.size {
            0 => self.scene.to_string(),
            size => format!("{}:{size}", self.scene),
        };
        format!(
            "{scene} --eye={} --target={} --up={} --fov={:?} --size={}x{}",
            vector(self.eye),
            vector(self.target),
            vector(self.up),
            self.fov,
            self.pixels[0],
            self.pixels[1],
        )
    }

    pub(crate) fn tree(&self) -> BspTree {
        let size = (self.size > 0).then_some(self.size);
        BspTree::build(self.scene.build(size, 1).polygons()).unwrap()
    }

    /// The number of corners of each polygon.
    pub(crate) fn corners(&self) -> Vec<usize> {
        let size = (self.size > 0).then_some(self.size);
        self.scene.build(size, 1).polygons().map(|polygon| polygon.points().len()).collect()
    }

    pub(crate) fn camera(&self) -> Camera {
        let fov = self.fov.to_radians();
        Camera::perspective(self.eye, self.target, self.up, fov, self.pixels).unwrap()
    }

    /// The visible polygons, by the library.
    fn shown(&self) -> Vec<VisiblePolygon> {
        let tree = self.tree();
        tree.visibility(&self.camera(), &ViewOptions::DEFAULT).unwrap().polygons().collect()
    }

    /// The polygon at each pixel's centre; `None` near an edge.
    pub(crate) fn truth(&self) -> Vec<Option<Option<usize>>> {
        let (tree, camera) = (self.tree(), self.camera());
        let rays = Rays::sampled(&camera, tree.faces(), SAMPLES as u32).unwrap();
        let [width, height] = self.pixels.map(|side| side as usize);
        let mut truth = Vec::new();
        for y in 0..height {
            let start = y * SAMPLES + SAMPLES / 2 - 1;
            let rows = rays.rows(start as u32..start as u32 + 3);
            let image = paint_tree(&tree, camera.viewpoint(), &rows);
            let polygon = |row: usize, column: usize| {
                let face = image.faces()[row * width * SAMPLES + column];
                (face != NONE).then(|| tree.faces().polygon(face))
            };
            for x in 0..width {
                let column = x * SAMPLES + SAMPLES / 2;
                let centre = polygon(1, column);
                let agree = (0..9).all(|k| polygon(k / 3, column + k % 3 - 1) == centre);
                truth.push(agree.then_some(centre));
            }
        }
        truth
    }
}

pub(crate) fn views() -> Vec<View> {
    vec![
        View::new(Builtin::Newell, 0, [2.0, -4.0, 9.0], [0.0, 0.0, 0.0]),
        View::new(Builtin::Cornell, 0, [278.0, 273.0, 100.0], [250.0, 150.0, 559.0]),
        View::new(Builtin::Teapot, 5, [7.0, -6.0, 4.0], [0.0, 0.0, 1.2]),
        View::new(Builtin::Random, 300, [1.5, 2.0, 1.8], [0.5, 0.5, 0.5]),
        View::new(Builtin::Random, 300, [0.5, 0.4, 0.5], [0.9, 0.9, 0.4]),
        View::new(Builtin::Crossing, 6, [2.5, 2.0, 1.5], [0.0, 0.0, 0.0]),
    ]
}

pub(crate) fn figures(output: &str) -> Value {
    assert_eq!(output.lines().count(), 1, "{output}");
    serde_json::from_str(output).unwrap()
}

#[test]
fn the_file_shows_what_the_exact_picture_shows() {
    let folder = Folder::new("draw_exact");
    let (mut compared, mut covered, mut near, mut clipped, mut paths) = (0, 0, 0, 0, 0);
    for view in views() {
        let command = format!(
            "draw {} -o a.svg --ids --json --colours polygon --min-size 0",
            view.arguments()
        );
        let figures = figures(&folder.run(&command).good());
        let svg = Svg::read(&folder.path("a.svg"));
        // One path for each polygon that shows.
        let mut drawn: Vec<usize> = svg.paths.iter().map(|path| path.polygon.unwrap()).collect();
        drawn.sort_unstable();
        let shown: Vec<usize> = view.shown().iter().map(|shown| shown.polygon).collect();
        assert_eq!(drawn, shown, "{command}");
        let tree = view.tree();
        for (key, number) in [
            ("polygons", tree.preparation().polygons),
            ("fragments", tree.len()),
            ("visible", shown.len()),
            ("paths", shown.len()),
            ("bytes", svg.text.len()),
        ] {
            assert_eq!(figures[key], number, "{command} {key}");
        }
        assert!(figures["tree_seconds"].as_f64().unwrap() > 0.0);
        assert!(figures["draw_seconds"].as_f64().unwrap() > 0.0);
        clipped += figures["clipped"].as_u64().unwrap();
        paths += shown.len();
        let picture = svg.picture();
        assert_eq!(picture.size, view.pixels);
        let fill = |polygon: usize| {
            let path = svg.paths.iter().find(|path| path.polygon == Some(polygon));
            path.unwrap_or_else(|| panic!("{command}: no path of {polygon}")).fill
        };
        for (i, (found, expected)) in picture.rgb.chunks_exact(3).zip(view.truth()).enumerate() {
            let Some(expected) = expected else {
                near += 1;
                continue;
            };
            let [x, y] = [i % view.pixels[0] as usize, i / view.pixels[0] as usize];
            assert_eq!(found, expected.map_or(WHITE, fill), "{command}: {x} {y} {expected:?}");
            compared += 1;
            covered += usize::from(expected.is_some());
        }
    }
    let counts = format!("{compared} {covered} {near} {clipped} {paths}");
    assert!(compared > 80_000 && covered > 30_000 && near < compared / 10, "{counts}");
    assert!(clipped > 10 && paths > 500, "{counts}");
}

/// Along a direction brightness is the same all over a polygon, so the drawing has the colours of
/// the painter's PNG.
#[test]
fn colours_are_those_of_render() {
    let folder = Folder::new("draw_colours");
    folder.write("m.mtl", "newmtl red\nKd 1 0 0\nnewmtl blue\nKd 0.2 0.3 0.9\n");
    let coloured = CROSSING.replace("f 5", "usemtl blue\nf 5");
    folder.write("s.obj", format!("mtllib m.mtl\nusemtl red\n{coloured}"));
    let mut compared = 0;
    for options in [
        "s.obj --direction=0.3,0.2,-1",
        "s.obj --direction=0.3,0.2,-1 --colours polygon",
        "terrain:300 --direction=-2,3,-1",
        "sphere:300 --direction=-2,3,-1 --cull back --colours polygon",
        "city:300 --direction=1,2,-1 --cull back",
        "newell --direction=1,2,-9",
    ] {
        folder.run(&format!("draw {options} -o a.svg --size 80x60")).good();
        folder.run(&format!("render {options} -o a.png --size 720x540")).good();
        let drawn = Svg::read(&folder.path("a.svg")).picture();
        let painted = Picture::read(&folder.path("a.png"));
        let at = |x: usize, y: usize| &painted.rgb[3 * (y * 720 + x)..][..3];
        for (i, found) in drawn.rgb.chunks_exact(3).enumerate() {
            let [x, y] = [9 * (i % 80) + 4, 9 * (i / 80) + 4];
            let around = |k: usize| at(x + k % 3 - 1, y + k / 3 - 1);
            if (0..9).all(|k| around(k) == at(x, y)) {
                let differs = found.iter().zip(at(x, y)).any(|(a, b)| a.abs_diff(*b) > 1);
                assert!(!differs, "{options}: {found:?} at {x} {y}, not {:?}", at(x, y));
                compared += usize::from(at(x, y) != WHITE);
            }
        }
    }
    assert!(compared > 6_600, "{compared}");
}

#[test]
fn names_are_escaped_and_groups_keep_the_order() {
    let folder = Folder::new("draw_names");
    let name = "a<b>&\"c\"'\u{1}é";
    folder.write("m.mtl", format!("newmtl {name}\nKd 1 0 0\nnewmtl plain\nKd 0 0 1\n"));
    let text = CROSSING.replace("f 5", "usemtl plain\nf 5");
    folder.write("s.obj", format!("mtllib m.mtl\nusemtl {name}\n{text}"));
    let draw = |options: &str| {
        folder.run(&format!("draw s.obj --eye=3,2.5,6 --target=0,0,0 -o a.svg {options}")).good();
        Svg::read(&folder.path("a.svg"))
    };
    let named = draw("--ids");
    let plain = draw("");
    assert_eq!(named.paths.len(), 3);
    assert_eq!(named.picture(), plain.picture());
    for path in &named.paths {
        let expected = if path.polygon == Some(0) { "a<b>&\"c\"'\u{fffd}é" } else { "plain" };
        assert_eq!(path.material.as_deref(), Some(expected));
    }
    assert!(!plain.text.contains("data-"), "{}", plain.text);
    let fills = |svg: &Svg| svg.paths.iter().map(|path| path.fill).collect::<Vec<_>>();
    assert_eq!(fills(&named), fills(&plain));
}

#[test]
fn what_shows_too_little_is_left_out() {
    let folder = Folder::new("draw_small");
    let view = &views()[3];
    let shown = view.shown();
    let (mut left_out, mut kept) = (0, 0);
    for side in [0.0, 1.0, 2.5, 1000.0] {
        let command = format!("draw {} -o a.svg --ids --json", view.arguments());
        let figures = figures(&folder.run(&format!("{command} --min-size {side}")).good());
        let svg = Svg::read(&folder.path("a.svg"));
        let mut drawn: Vec<usize> = svg.paths.iter().map(|path| path.polygon.unwrap()).collect();
        drawn.sort_unstable();
        let large = shown.iter().filter(|shown| shown.area >= side * side);
        assert_eq!(drawn, large.map(|shown| shown.polygon).collect::<Vec<_>>(), "{side}");
        assert_eq!(figures["visible"], shown.len());
        assert_eq!(figures["paths"], drawn.len());
        kept += drawn.len();
        left_out += shown.len() - drawn.len();
    }
    assert!(left_out > 100 && kept > 300, "{left_out} {kept}");
}

#[test]
fn what_is_behind_glass_is_drawn_and_what_is_behind_wood_is_not() {
    let folder = Folder::new("draw_glass");
    let materials = "newmtl glass\nKd 0 0 1\nd 0.25\nnewmtl red\nKd 1 0 0\nnewmtl air\nd 0\n";
    folder.write("m.mtl", materials);
    let square = |z: i32| format!("v -1 -1 {z}\nv 1 -1 {z}\nv 1 1 {z}\nv -1 1 {z}\n");
    let faces = "usemtl red\nf 5 6 7 8\nusemtl glass\nf 1 2 3 4\nusemtl air\nf 9 10 11 12\n";
    folder.write("s.obj", format!("mtllib m.mtl\n{}{}{}{faces}", square(1), square(0), square(2)));
    let (red, blue) = (Some(0), Some(1));
    for (options, expected) in [
        ("0,0,-1", vec![red, blue]),
        ("0,0,1", vec![red]),
        ("0,0,1 --translucent", vec![blue, red]),
        ("0,0,-1 --translucent", vec![red, blue]),
        ("0,0,-1 --opaque", vec![Some(2)]),
        ("0,0,-1 --seams plus-lighter", vec![None]),
        ("0,0,1 --seams plus-lighter", vec![red]),
    ] {
        folder.run(&format!("draw s.obj -o a.svg --ids --direction={options}")).good();
        let paths = Svg::read(&folder.path("a.svg")).paths;
        let found: Vec<Option<usize>> = paths.iter().map(|path| path.polygon).collect();
        assert_eq!(found, expected, "{options}");
    }
    folder.run("draw s.obj -o a.svg --ids --direction=0,0,-1 --seams plus-lighter").good();
    let text = Svg::read(&folder.path("a.svg")).text;
    assert!(text.contains("data-polygons=\"1 0\"") && text.contains("#bf0040"), "{text}");
}

#[test]
fn walls_that_turn_their_backs_are_left_out() {
    let folder = Folder::new("draw_cull");
    folder.run("draw cornell --eye=278,900,1500 --target=278,200,280 -o a.svg --cull back").good();
    let inside = Svg::read(&folder.path("a.svg"));
    folder.run("draw cornell --eye=278,900,1500 --target=278,200,280 -o a.svg").good();
    let outside = Svg::read(&folder.path("a.svg"));
    assert!(inside.paths.len() > outside.paths.len(), "{}", inside.text);
    assert_ne!(inside.picture(), outside.picture());
}

#[test]
fn views_of_nothing_and_of_one_pixel_are_drawn() {
    let folder = Folder::new("draw_edge");
    folder.write("s.obj", CROSSING);
    let draw = |options: &str| {
        let output = folder.run(&format!("draw s.obj -o a.svg --json {options}")).good();
        (figures(&output), Svg::read(&folder.path("a.svg")))
    };
    let (nothing, svg) = draw("--eye=0,0,50 --target=0,0,90");
    assert_eq!((&nothing["visible"], &nothing["bytes"]), (&0.into(), &svg.text.len().into()));
    assert_eq!(svg.picture().count(WHITE), 640 * 480);
    let (_, small) = draw("--size 1x1 --direction=0.1,0.1,-1");
    assert_eq!(small.picture().size, [1, 1]);
    assert!(!small.paths.is_empty());
    // On a polygon, which is seen edge-on.
    let (on, _) = draw("--eye=0,0,0.1 --target=0,0,-3 --up y --size 65535x3");
    assert!(on["visible"].as_u64() > Some(0));
}

/// A wall of many parts, all of one colour. Where they meet, neither the background nor earlier paint shows.
#[test]
fn the_background_does_not_show_in_seams() {
    let folder = Folder::new("draw_seams");
    folder.write("m.mtl", "newmtl grey\nKd 0.2 0.4 0.3\n");
    // Rows of quads, triangles and darts. Corners of one row lie between the corners of the next.
    let mut text = String::from("mtllib m.mtl\nusemtl grey\n");
    let mut face = |corners: &[[f64; 2]]| {
        corners.iter().for_each(|[x, y]| text += &format!("v {x} {y} 0\n"));
        let numbers = (1..=corners.len()).rev().map(|k| format!(" -{k}")).collect::<String>();
        text += &format!("f{numbers}\n");
    };
    for row in 0..8 {
        let (y, shift) = (f64::from(row), f64::from(row % 3) * 0.25);
        for column in 0..8 {
            let x = f64::from(column) + shift;
            let [a, b, c, d] = [[x, y], [x + 1.0, y], [x + 1.0, y + 1.0], [x, y + 1.0]];
            let middle = [x + 0.375, y + 0.25];
            match (row + column) % 3 {
                0 => face(&[a, b, c, d]),
                1 => [[a, b, c], [a, c, d]].iter().for_each(|triangle| face(triangle)),
                _ => [[a, b, c, middle], [c, d, a, middle]].iter().for_each(|dart| face(dart)),
            }
        }
    }
    folder.write("s.obj", text);
    let camera = "--direction=0.31,0.22,-1 --up=0.3,1,0 --target=4,4,0 --size 200x160";
    folder.run(&format!("draw s.obj -o a.svg {camera}")).good();
    let svg = Svg::read(&folder.path("a.svg"));
    let wall = svg.paths[0].fill;
    assert!(svg.paths.len() > 80 && svg.paths.iter().all(|path| path.fill == wall));
    let Picture { size: [width, height], rgb } = svg.smooth_picture();
    // Not in the outermost pixels of the wall.
    let crisp = svg.picture().rgb;
    let covered = |x: u32, y: u32| crisp[3 * (y * width + x) as usize..][..3] == wall;
    let (mut pixels, mut sum, mut worst) = (0, 0, 0);
    for y in 2..height - 2 {
        for x in 2..width - 2 {
            if !(0..25).all(|k| covered(x + k % 5 - 2, y + k / 5 - 2)) {
                continue;
            }
            let found = &rgb[3 * (y * width + x) as usize..][..3];
            let error = found.iter().zip(wall).map(|(a, b)| a.abs_diff(b)).max().unwrap();
            (pixels, sum) = (pixels + 1, sum + u32::from(error));
            worst = worst.max(error);
        }
    }
    assert!(pixels > 10_000, "{pixels}");
    assert!(f64::from(sum) < 0.2 * f64::from(pixels), "{sum} in {pixels} pixels, {worst}");
}

/// The statements of `docs/guide/drawings.md`.
#[test]
fn figures_of_the_guide_are_so() {
    let folder = Folder::new("draw_guide");
    for (arguments, expected) in [
        ("random:500 -o a.svg", [("fragments", 3110), ("paths", 282), ("lines", 0)]),
        ("city:2000 -o a.svg", [("fragments", 2001), ("paths", 649), ("lines", 0)]),
        ("teapot --lines -o a.svg", [("paths", 0), ("runs", 428), ("lines", 65)]),
    ] {
        let output = folder.run(&format!("draw {arguments} --json")).good();
        for (name, value) in expected {
            assert_eq!(figures(&output)[name], value, "{arguments}: {name}");
        }
    }
}
