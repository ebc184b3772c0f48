//! Seams between neighbours in SVG files, as a viewer shows them, against exact samples.

use std::collections::{HashMap, HashSet};
use std::fmt::Write as _;

use binspace::internals::Line;
use binspace::raster::{Outline, Piece, Rays, for_each_run};
use binspace::scene::{Builtin, Scene};
use binspace::view::Camera;
use binspace::{BspTree, Fragment};

use crate::draw::{WHITE, figures, views};
use crate::draw_translucent::write_scene;
use crate::png_picture::Picture;
use crate::run::Folder;
use crate::svg_picture::Svg;

/// Samples each way in a pixel of the exact picture.
const SAMPLES: usize = 16;

/// What is seen at samples, blended one over the other.
struct Sampled {
    size: [usize; 2],
    /// The mean colour of each pixel.
    means: Vec<[f64; 3]>,
    /// How many lists of polygons, one behind the other, show in each pixel.
    kinds: Vec<usize>,
    /// Whether the background alone shows in a part of it.
    is_open: Vec<bool>,
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
        let white = WHITE.map(f32::from);
        let mut samples: Vec<([f32; 3], u64)> = vec![(white, 0); across * size[1] * SAMPLES];
        for fragment in tree.back_to_front(camera.viewpoint()) {
            let polygon = fragment.polygon();
            let opacity = (look.opacity)(polygon) as f32;
            // Of what is seen edge-on, and hidden in the drawing, there is no sample.
            let Some(fill) = look.fills.get(&polygon) else { continue };
            for_each_sample(tree, &fragment, &rays, |sample| {
                let (colour, kind) = &mut samples[sample];
                for (old, &new) in colour.iter_mut().zip(fill) {
                    *old = *old * (1.0 - opacity) + f32::from(new) * opacity;
                }
                let below = if opacity == 1.0 { 0 } else { *kind };
                *kind = (below ^ (polygon as u64 + 1)).wrapping_mul(0x9e37_79b9_7f4a_7c15);
            });
        }
        let mut sampled = Self { size, means: vec![], kinds: vec![], is_open: vec![] };
        for pixel in 0..size[0] * size[1] {
            let start = pixel / size[0] * SAMPLES * across + pixel % size[0] * SAMPLES;
            let own =
                (0..SAMPLES * SAMPLES).map(|k| samples[start + k / SAMPLES * across + k % SAMPLES]);
            let kinds: HashSet<u64> = own.clone().map(|(_, kind)| kind).collect();
            let mean = own.fold([0.0; 3], |sum, (colour, _)| {
                [0, 1, 2].map(|i: usize| sum[i] + f64::from(colour[i]))
            });
            sampled.means.push(mean.map(|sum| sum / (SAMPLES * SAMPLES) as f64));
            sampled.is_open.push(kinds.contains(&0));
            sampled.kinds.push(kinds.len());
        }
        sampled
    }

    /// The errors of a picture where two kinds meet, and no background; where more do; of all pixels.
    fn errors(&self, picture: &Picture) -> [Errors; 3] {
        assert_eq!(picture.size.map(|side| side as usize), self.size);
        let mut errors = [Errors::default(); 3];
        for (i, found) in picture.rgb.chunks_exact(3).enumerate() {
            let off = |k: usize| (f64::from(found[k]) - self.means[i][k]).abs();
            let error = (0..3).map(off).fold(0.0, f64::max);
            let inner = [self.kinds[i] == 2, self.kinds[i] > 2].map(|is| is && !self.is_open[i]);
            for (errors, is_so) in errors.iter_mut().zip([inner[0], inner[1], true]) {
                if is_so {
                    errors.pixels += 1;
                    errors.sum += error;
                    errors.worst = errors.worst.max(error);
                }
            }
        }
        errors
    }
}

#[derive(Clone, Copy, Debug, Default)]
struct Errors {
    pixels: usize,
    sum: f64,
    worst: f64,
}

impl Errors {
    fn mean(&self) -> f64 {
        self.sum / self.pixels as f64
    }
}

fn for_each_sample(
    tree: &BspTree,
    fragment: &Fragment<'_>,
    rays: &Rays,
    mut see: impl FnMut(usize),
) {
    let width = rays.size()[0] as usize;
    let lines: Vec<Line> = fragment.lines().collect();
    let vertices: Vec<[f64; 3]> = fragment.lattice_vertices().collect();
    let outline = match fragment.is_whole() {
        true => Outline::Whole,
        false => Outline::Lines { lines: &lines, vertices: &vertices },
    };
    let piece = Piece { face: fragment.face(), outline };
    for_each_run(rays, tree.faces(), piece, |y, columns| {
        columns.for_each(|x| see(y as usize * width + x as usize));
    });
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
            for corner in polygon.iter().map(|&corner| corner * scale) {
                writeln!(text, "v {:?} {:?} {:?}", corner.x, corner.y, corner.z).unwrap();
            }
            let numbers: String = (1..=polygon.len()).rev().map(|k| format!(" -{k}")).collect();
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

#[test]
fn regions_that_are_added_up_have_no_seams() {
    let folder = Folder::new("seams_regions");
    let mut compared = [0, 0];
    for (i, view) in views().iter().enumerate() {
        let scene = view.arguments();
        let (tree, camera) = (view.tree(), view.camera());
        let fills = fills(&folder, &scene);
        let sampled = Sampled::new(&tree, &camera, &Look { fills: &fills, opacity: &|_| 1.0 });
        check(&folder, &scene, &sampled, &mut compared[0]);
        let _ = i;
    }
    for (which, size) in [("triangles", "300x240"), ("balls", "240x240")] {
        match which {
            "triangles" => write_scene(&folder, 40),
            _ => write_balls(&folder),
        }
        let (scene, _) = Scene::read_obj(folder.path("s.obj")).unwrap();
        let tree = BspTree::build(scene.polygons()).unwrap();
        let arguments =
            format!("s.obj --eye=2.4,-3.1,2.2 --target=.2,.1,.3 --up=z --fov=45 --size {size}");
        let pixels: Vec<u32> = size.split('x').map(|side| side.parse().unwrap()).collect();
        let [eye, target] = [[2.4, -3.1, 2.2], [0.2, 0.1, 0.3]].map(binspace::glam::DVec3::from);
        let up = binspace::glam::DVec3::Z;
        let camera =
            Camera::perspective(eye, target, up, 45f64.to_radians(), [pixels[0], pixels[1]])
                .unwrap();
        let fills = fills(&folder, &arguments);
        let opacity = |polygon: usize| f64::from(scene.material(polygon).opacity);
        let sampled = Sampled::new(&tree, &camera, &Look { fills: &fills, opacity: &opacity });
        check(&folder, &arguments, &sampled, &mut compared[1]);
    }
    assert!(compared[0] > 2_000 && compared[1] > 2_000, "{compared:?}");
}

fn check(folder: &Folder, scene: &str, sampled: &Sampled, compared: &mut usize) {
    for seams in ["none", "trap", "plus-lighter"] {
        let arguments = format!("draw {scene} -o a.svg --json --min-size 0 --seams {seams}");
        let output = folder.run(&arguments).good();
        let svg = Svg::read(&folder.path("a.svg"));
        let [two, more, all] = sampled.errors(&svg.smooth_picture());
        eprintln!(
            "{arguments}: {} {} bytes\n   two {:.2} more {:.2} all {:.3} worst {:?} of {:?}",
            svg.paths.len(),
            figures(&output)["bytes"],
            two.mean(),
            more.mean(),
            all.mean(),
            [two.worst, more.worst, all.worst],
            [two.pixels, more.pixels]
        );
        let _ = &compared;
    }
}
