//! Pictures by exact coverage.

use std::collections::HashMap;

use binspace::paint::paint_tree;
use binspace::raster::{NONE, Rays};

use crate::draw::{View, WHITE, figures, views};
use crate::png_picture::Picture;
use crate::run::{CROSSING, Folder};
use crate::svg_picture::Svg;

/// Samples each way in a pixel of the exact picture.
const SAMPLES: usize = 16;

/// The mean of the colours of all samples of each pixel, by their numbers.
fn sampled(view: &View, fills: &HashMap<usize, [u8; 3]>) -> Vec<[f64; 3]> {
    let (tree, camera) = (view.tree(), view.camera());
    let rays = Rays::sampled(&camera, tree.faces(), SAMPLES as u32).unwrap();
    let image = paint_tree(&tree, camera.viewpoint(), &rays);
    let width = view.pixels[0] as usize;
    let faces = tree.faces();
    let fill = |face: u32| if face == NONE { WHITE } else { fills[&faces.polygon(face)] };
    let mut sums = vec![[0.0; 3]; width * view.pixels[1] as usize];
    let mut add = |pixel: usize, face: u32, samples: usize| {
        let (sum, fill) = (&mut sums[pixel], fill(face).map(f64::from));
        (0..3).for_each(|i| sum[i] += fill[i] * samples as f64 / (SAMPLES * SAMPLES) as f64);
    };
    for (at, row) in image.faces().chunks_exact(SAMPLES).enumerate() {
        let pixel = at / (width * SAMPLES) * width + at % width;
        if row == [row[0]; SAMPLES] {
            add(pixel, row[0], SAMPLES);
        } else {
            row.iter().for_each(|&face| add(pixel, face, 1));
        }
    }
    sums
}

#[test]
fn pixels_are_the_means_of_many_samples() {
    let folder = Folder::new("png_exact");
    let (mut edges, mut sum, mut worst) = (0, 0.0, 0.0f64);
    let (mut inner, mut inner_sum) = (0, 0.0);
    for view in views() {
        let command = format!("draw {} --colours polygon", view.arguments());
        let output = folder.run(&format!("{command} -o a.png --json")).good();
        let picture = Picture::read(&folder.path("a.png"));
        assert_eq!(picture.size, view.pixels);
        let length = std::fs::metadata(folder.path("a.png")).unwrap().len();
        assert_eq!(figures(&output)["bytes"], length);
        assert_eq!(figures(&output)["paths"], 0);
        folder.run(&format!("{command} -o a.svg --ids --min-size 0")).good();
        let paths = Svg::read(&folder.path("a.svg")).paths;
        let fills = paths.iter().map(|path| (path.polygon.unwrap(), path.fill)).collect();
        for (found, expected) in picture.rgb.chunks_exact(3).zip(sampled(&view, &fills)) {
            let difference = |i: usize| (f64::from(found[i]) - expected[i]).abs();
            let error = (0..3).map(difference).fold(0.0, f64::max);
            if expected.iter().any(|c| c.fract() != 0.0) {
                edges += 1;
                sum += error;
            } else {
                // All samples have one colour: everything else lies between two rows of samples.
                assert!(error < 255.0 / 16.0, "{command}: {found:?} {expected:?}");
                inner += 1;
                inner_sum += error;
            }
            worst = worst.max(error);
        }
    }
    let mean = sum / f64::from(edges);
    assert!(edges > 6_000 && mean < 1.0 && worst < 8.0, "{edges} {mean} {worst}");
    let mean = inner_sum / f64::from(inner);
    assert!(inner > 20_000 && mean < 0.01, "{inner} {mean}");
}

/// Where many parts of one colour meet, their areas add up to whole pixels.
#[test]
fn a_wall_of_one_colour_has_no_seams() {
    let folder = Folder::new("png_seams");
    folder.write("m.mtl", "newmtl grey\nKd 0.2 0.4 0.3\n");
    let mut text = String::from("mtllib m.mtl\nusemtl grey\n");
    // Rows of triangles. Their corners lie between the corners of the next row.
    for row in 0..12 {
        for column in 0..12 {
            let (x, y) = (f64::from(column) + 0.25 * f64::from(row % 4), f64::from(row));
            for corners in [
                [[x, y], [x + 1.0, y], [x + 1.0, y + 1.0]],
                [[x, y], [x + 1.0, y + 1.0], [x, y + 1.0]],
            ] {
                corners.iter().for_each(|[x, y]| text += &format!("v {x} {y} 0\n"));
                text += "f -3 -2 -1\n";
            }
        }
    }
    folder.write("s.obj", text);
    for camera in [
        "--direction=0.31,0.22,-1 --up=0.3,1,0 --target=6,6,0",
        "--eye=5.3,4.1,9 --target=6,6,0 --up=0.2,1,0 --colours material",
    ] {
        folder.run(&format!("draw s.obj {camera} --size 300x240 -o a.png")).good();
        folder.run(&format!("draw s.obj {camera} --size 300x240 -o a.svg")).good();
        let crisp = Svg::read(&folder.path("a.svg")).picture();
        let picture = Picture::read(&folder.path("a.png"));
        let at = |picture: &Picture, x: usize, y: usize| {
            [0, 1, 2].map(|i| picture.rgb[3 * (y * 300 + x) + i])
        };
        let is_parallel = camera.starts_with("--direction");
        let wall = at(&picture, 150, 120);
        let mut pixels = 0;
        for (x, y) in (2..298).flat_map(|x| (2..238).map(move |y| (x, y))) {
            let around = |k: usize| at(&crisp, x + k % 5 - 2, y + k / 5 - 2);
            if (0..25).any(|k| around(k) == WHITE) {
                continue;
            }
            let found = at(&picture, x, y);
            if is_parallel {
                assert_eq!(found, wall, "{x} {y}");
            } else {
                // Shades of neighbours differ; the background's share would be far lighter.
                let lightest = (0..25).map(around).map(|c| c[0]).max().unwrap();
                assert!(found[0] <= lightest, "{x} {y} {found:?}");
            }
            pixels += 1;
        }
        assert!(pixels > 10_000, "{camera}: {pixels}");
    }
}

#[test]
fn pngs_go_to_standard_output_and_are_as_large_as_asked() {
    let folder = Folder::new("png_output");
    folder.write("s.obj", CROSSING);
    folder.run("draw s.obj -o a.png").good();
    let piped = folder.pipe("draw - -o - --format png", CROSSING).stdout;
    assert!(piped == std::fs::read(folder.path("a.png")).unwrap());
    for size in ["1x1", "3000x2", "2x3000", "2100x1100"] {
        folder.run(&format!("draw s.obj -o b.png --size {size}")).good();
        let picture = Picture::read(&folder.path("b.png"));
        assert_eq!(format!("{}x{}", picture.size[0], picture.size[1]), size);
        assert!(picture.rgb.chunks_exact(3).any(|pixel| pixel != WHITE), "{size}");
    }
    // An empty drawing shows the background.
    folder.run("draw s.obj --eye=0,0,50 --target=0,0,90 -o a.png").good();
    assert_eq!(Picture::read(&folder.path("a.png")).count(WHITE), 640 * 480);
}
