//! Seams between neighbours in SVG files, as a viewer shows them, against exact samples.

use std::collections::HashMap;
use std::fmt::Write as _;

use binspace::BspTree;
use binspace::glam::DVec3;
use binspace::raster::Rays;
use binspace::scene::{Builtin, Scene};
use binspace::view::Camera;

use crate::draw::{View, WHITE, views};
use crate::draw_translucent::write_scene;
use crate::png_picture::Picture;
use crate::run::Folder;
use crate::svg_picture::Svg;
use testkit::fragment_pixels::for_each_pixel;

/// Samples each way in a pixel of the exact picture.
const SAMPLES: usize = 16;

/// The visible polygons at samples, blended one over the other.
struct Sampled {
    size: [usize; 2],
    /// The mean colour of each pixel.
    means: Vec<[f64; 3]>,
    /// The number of lists of polygons, one behind the other, that show in each pixel.
    kinds: Vec<usize>,
    /// Whether the background alone shows in a part of it.
    is_open: Vec<bool>,
    /// The largest difference of colours in it.
    contrasts: Vec<f64>,
}

/// How polygons look.
struct Look<'a> {
    fills: &'a HashMap<usize, [u8; 3]>,
    opacity: &'a dyn Fn(usize) -> f64,
}

impl Sampled {
    fn new(tree: &BspTree, camera: &Camera, look: &Look<'_>) -> Self {
        let rays = Rays::sampled(camera, tree.faces(), SAMPLES as u32).unwrap();
        let size = camera.size().map(|side| side as usize);
        let across = size[0] * SAMPLES;
        // Lists of polygons, one behind the other, have numbers; the background alone is number 0.
        let mut colours = vec![WHITE.map(f32::from)];
        let mut longer: HashMap<(u32, usize), u32> = HashMap::new();
        let mut samples = vec![0; across * size[1] * SAMPLES];
        for fragment in tree.back_to_front(camera.viewpoint()) {
            let polygon = fragment.polygon();
            let opacity = (look.opacity)(polygon) as f32;
            // Polygons that are seen edge-on, and hidden in the drawing, have no sample.
            let Some(fill) = look.fills.get(&polygon) else { continue };
            let mut last = (u32::MAX, 0);
            for_each_pixel(tree, &fragment, &rays, |sample| {
                let list = samples[sample];
                if list != last.0 {
                    let below = if opacity == 1.0 { 0 } else { list };
                    let number = longer.entry((below, polygon)).or_insert_with(|| {
                        let old = colours[below as usize];
                        let blend = |i| old[i] * (1.0 - opacity) + f32::from(fill[i]) * opacity;
                        colours.push([0, 1, 2].map(blend));
                        colours.len() as u32 - 1
                    });
                    last = (list, *number);
                }
                samples[sample] = last.1;
            });
        }
        let mut sampled =
            Self { size, means: vec![], kinds: vec![], is_open: vec![], contrasts: vec![] };
        for pixel in 0..size[0] * size[1] {
            let start = pixel / size[0] * SAMPLES * across + pixel % size[0] * SAMPLES;
            let rows = (0..SAMPLES).map(|y| &samples[start + y * across..][..SAMPLES]);
            let first = samples[start];
            if rows.clone().all(|row| row == [first; SAMPLES]) {
                sampled.contrasts.push(0.0);
                sampled.means.push(colours[first as usize].map(f64::from));
                sampled.is_open.push(first == 0);
                sampled.kinds.push(1);
                continue;
            }
            // How often each is there.
            let mut kinds: Vec<(u32, f64)> = vec![];
            for run in rows.flat_map(|row| row.chunk_by(|a, b| a == b)) {
                let count = run.len() as f64;
                match kinds.iter_mut().find(|(kind, _)| *kind == run[0]) {
                    Some((_, total)) => *total += count,
                    None => kinds.push((run[0], count)),
                }
            }
            let span = |i: usize| {
                let channel = kinds.iter().map(|&(kind, _)| colours[kind as usize][i]);
                let ends = channel.fold([f32::MAX, f32::MIN], |[l, h], c| [l.min(c), h.max(c)]);
                f64::from(ends[1] - ends[0])
            };
            sampled.contrasts.push((0..3).map(span).fold(0.0, f64::max));
            let mean = |i: usize| {
                let light =
                    |&(kind, count): &(u32, f64)| f64::from(colours[kind as usize][i]) * count;
                kinds.iter().map(light).sum::<f64>() / (SAMPLES * SAMPLES) as f64
            };
            sampled.means.push([0, 1, 2].map(mean));
            sampled.is_open.push(kinds.iter().any(|&(kind, _)| kind == 0));
            sampled.kinds.push(kinds.len());
        }
        sampled
    }

    /// The errors of a picture in some pixels.
    fn errors(&self, picture: &Picture, choose: impl Fn(usize) -> bool) -> Errors {
        assert_eq!(picture.size.map(|side| side as usize), self.size);
        let mut errors = Errors::default();
        for (i, found) in picture.rgb.chunks_exact(3).enumerate().filter(|(i, _)| choose(*i)) {
            let off = |k: usize| (f64::from(found[k]) - self.means[i][k]).abs();
            errors.pixels += 1;
            errors.sum += (0..3).map(off).fold(0.0, f64::max);
            errors.contrast += self.contrasts[i];
        }
        errors
    }

    /// Where two lists of polygons meet, and nothing else.
    fn is_edge(&self, pixel: usize) -> bool {
        self.kinds[pixel] == 2 && !self.is_open[pixel]
    }

    /// Where one meets the background.
    fn is_silhouette(&self, pixel: usize) -> bool {
        self.kinds[pixel] == 2 && self.is_open[pixel]
    }
}

#[derive(Clone, Copy, Debug, Default)]
struct Errors {
    pixels: usize,
    sum: f64,
    contrast: f64,
}

impl Errors {
    fn add(&mut self, other: Self) {
        self.pixels += other.pixels;
        self.sum += other.sum;
        self.contrast += other.contrast;
    }

    fn mean(&self) -> f64 {
        self.sum / self.pixels as f64
    }

    /// As a share of the difference of colours there.
    fn share(&self) -> f64 {
        self.sum / self.contrast
    }
}

/// A ball of wood in a ball of glass, of many faces.
fn write_balls(folder: &Folder) {
    let materials = "newmtl glass\nKd .1 .3 .9\nd 0.25\nnewmtl wood\nKd .8 .5 .2\n";
    folder.write("m.mtl", materials);
    let ball = Builtin::Sphere.build(Some(300), 1);
    let mut text = "mtllib m.mtl\n".to_owned();
    for (material, scale) in [("glass", 1.0), ("wood", 0.5)] {
        writeln!(text, "usemtl {material}").unwrap();
        for polygon in ball.polygons() {
            for corner in polygon.points().iter().map(|&corner| corner * scale) {
                writeln!(text, "v {:?} {:?} {:?}", corner.x, corner.y, corner.z).unwrap();
            }
            let numbers: String =
                (1..=polygon.points().len()).rev().map(|k| format!(" -{k}")).collect();
            writeln!(text, "f{numbers}").unwrap();
        }
    }
    folder.write("s.obj", text);
}

/// The fill of each polygon, in a drawing where nothing is hidden.
fn fills(folder: &Folder, scene: &str) -> HashMap<usize, [u8; 3]> {
    folder.run(&format!("draw {scene} -o all.svg --ids --translucent")).good();
    let paths = Svg::read(&folder.path("all.svg")).paths;
    paths.iter().map(|path| (path.polygon.unwrap(), path.fill)).collect()
}

/// A scene, and the exact picture of a view of it.
struct Case {
    arguments: String,
    sampled: Sampled,
}

/// A view of an opaque scene.
fn opaque(folder: &Folder, view: &View) -> Case {
    let (tree, camera, arguments) = (view.tree(), view.camera(), view.arguments());
    let fills = fills(folder, &arguments);
    let sampled = Sampled::new(&tree, &camera, &Look { fills: &fills, opacity: &|_| 1.0 });
    Case { arguments, sampled }
}

/// A view of the scene in `s.obj`.
fn of_file(folder: &Folder) -> Case {
    let (scene, _) = Scene::read_obj(folder.path("s.obj")).unwrap();
    let tree = BspTree::build(scene.polygons()).unwrap();
    let arguments =
        "s.obj --eye=2.4,-3.1,2.2 --target=.2,.1,.3 --up=z --fov=45 --size 240x180".to_owned();
    let [eye, target] = [[2.4, -3.1, 2.2], [0.2, 0.1, 0.3]].map(DVec3::from);
    let camera =
        Camera::perspective(eye, target, DVec3::Z, 45f64.to_radians(), [240, 180]).unwrap();
    let fills = fills(folder, &arguments);
    let opacity = |polygon: usize| f64::from(scene.material(polygon).opacity);
    let sampled = Sampled::new(&tree, &camera, &Look { fills: &fills, opacity: &opacity });
    Case { arguments, sampled }
}

fn drawn(folder: &Folder, case: &Case, seams: &str) -> Picture {
    let options = format!("-o a.svg --min-size 0 --seams {seams}");
    folder.run(&format!("draw {} {options}", case.arguments)).good();
    Svg::read(&folder.path("a.svg")).smooth_picture()
}

/// Surfaces of one material, opaque and of glass.
#[test]
fn regions_that_are_added_up_have_no_seams() {
    let folder = Folder::new("seams_regions");
    write_balls(&folder);
    for (case, floor) in [(opaque(&folder, &views()[2]), 600), (of_file(&folder), 2_000)] {
        let errors = |seams: &str| {
            let picture = drawn(&folder, &case, seams);
            case.sampled.errors(&picture, |pixel| case.sampled.is_edge(pixel))
        };
        let [none, added] = ["none", "plus-lighter"].map(errors);
        let figures = format!("{}: {none:?} {added:?}", case.arguments);
        assert!(added.pixels > floor && added.mean() < 1.5, "{figures}");
        assert!(2.0 * added.mean() < none.mean(), "{figures}");
    }
}

/// Where colours differ much, viewers round the coverage of an edge: here on both of its sides, at
/// silhouettes on one.
#[test]
fn regions_of_many_colours_are_as_exact_as_silhouettes() {
    let folder = Folder::new("seams_colours");
    let (mut edges, mut silhouettes, mut plain) =
        (Errors::default(), Errors::default(), Errors::default());
    let mut cases: Vec<Case> = views().iter().map(|view| opaque(&folder, view)).collect();
    write_scene(&folder, 40);
    cases.push(of_file(&folder));
    for case in &cases {
        let sampled = &case.sampled;
        let [none, added] = ["none", "plus-lighter"].map(|seams| drawn(&folder, case, seams));
        edges.add(sampled.errors(&added, |pixel| sampled.is_edge(pixel)));
        plain.add(sampled.errors(&none, |pixel| sampled.is_edge(pixel)));
        silhouettes.add(sampled.errors(&none, |pixel| sampled.is_silhouette(pixel)));
    }
    let figures = format!("{edges:?} {silhouettes:?} {plain:?}");
    assert!(edges.pixels > 3_000 && silhouettes.pixels > 1_500, "{figures}");
    assert!(edges.share() < 1.42 * silhouettes.share(), "{figures}");
    assert!(2.0 * edges.share() < plain.share(), "{figures}");
}

/// Pixels of translucent polygons, by the areas of cells.
#[test]
fn pixels_of_translucent_polygons_are_the_means_of_many_samples() {
    let folder = Folder::new("seams_png");
    for write in [|folder: &Folder| write_scene(folder, 40), write_balls] {
        write(&folder);
        let case = of_file(&folder);
        for options in ["", "--translucent"] {
            folder.run(&format!("draw {} -o a.png {options}", case.arguments)).good();
            let picture = Picture::read(&folder.path("a.png"));
            let sampled = &case.sampled;
            let edges = sampled.errors(&picture, |pixel| sampled.kinds[pixel] > 1);
            let inner = sampled.errors(&picture, |pixel| sampled.kinds[pixel] == 1);
            let figures = format!("{edges:?} {inner:?}");
            assert!(edges.pixels > 2_000 && edges.mean() < 1.0, "{figures}");
            assert!(inner.pixels > 10_000 && inner.mean() < 0.3, "{figures}");
        }
    }
}
