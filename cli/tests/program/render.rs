use std::fs;

use crate::png_picture::Picture;
use crate::run::{CROSSING, Folder};

const WHITE: [u8; 3] = [255; 3];

/// A PNG of the crossing squares.
fn picture(folder: &Folder, options: &str) -> Picture {
    folder.write("s.obj", CROSSING);
    folder.run(&format!("render s.obj -o p.png --size 120x80 {options}")).good();
    Picture::read(&folder.path("p.png"))
}

#[test]
fn without_a_camera_all_of_the_scene_is_shown() {
    let folder = Folder::new("render_whole");
    for size in ["120x80", "80x120", "300x20"] {
        folder.run(&format!("render teapot:3 -o p.png --size {size}")).good();
        let Picture { size: [width, height], rgb } = Picture::read(&folder.path("p.png"));
        assert_eq!(format!("{width}x{height}"), size);
        let is_set = |x: u32, y: u32| rgb[3 * (y * width + x) as usize..][..3] != WHITE;
        let columns: Vec<u32> = (0..width).filter(|&x| (0..height).any(|y| is_set(x, y))).collect();
        let rows: Vec<u32> = (0..height).filter(|&y| (0..width).any(|x| is_set(x, y))).collect();
        // Free on all sides, in the middle, and filling one of the two directions.
        let span = |found: &[u32], side: u32| (found[0], side - 1 - found[found.len() - 1]);
        let ((left, right), (top, bottom)) = (span(&columns, width), span(&rows, height));
        assert!(left.min(right).min(top).min(bottom) > 0 || size == "300x20", "{size}");
        assert!(left.abs_diff(right) <= 2 && top.abs_diff(bottom) <= 2, "{size}");
        assert!(left * 10 < width || top * 10 < height, "{size} {left} {top}");
    }
}

#[test]
fn the_kinds_of_picture_differ_and_the_first_two_do_not() {
    let folder = Folder::new("render_kinds");
    let painter = picture(&folder, "");
    assert_eq!(painter.size, [120, 80]);
    assert!(painter.count(WHITE) > 100 && painter.colours() > 3);
    assert_eq!(picture(&folder, "--z-buffer"), painter);
    let difference = picture(&folder, "--difference");
    let said = folder.run("render s.obj -o p.png --size 120x80 --difference").err;
    assert!(said.contains(" covered, 0 contested; 0 wrong (0 wrong order, 0 holes"), "{said}");
    for wrong in [[255, 40, 40], [255, 230, 0], [255, 0, 255], [70, 130, 255]] {
        assert_eq!(difference.count(wrong), 0);
    }
    let depth = picture(&folder, "--depth");
    assert!(depth.rgb.chunks_exact(3).all(|p| p[0] == p[1] && p[1] == p[2]));
    assert_eq!(depth.count([0; 3]), painter.count(WHITE));
    assert_eq!(picture(&folder, "--depth=near"), depth);
    // The other way round, with nothing as dark as before.
    let far = picture(&folder, "--depth=far");
    let sums = depth.rgb.iter().zip(&far.rgb).map(|(&a, &b)| u32::from(a) + u32::from(b));
    assert!(sums.clone().all(|sum| sum == 0 || (294..=295).contains(&sum)));
    assert!(depth != far && far.count([0; 3]) == painter.count(WHITE));
}

#[test]
fn cameras_are_where_they_are_asked_to_be() {
    let folder = Folder::new("render_camera");
    // The big square alone fills the picture from near by; from behind the same.
    let near = picture(&folder, "--eye 0,0,-2.5 --target 0,0,-3 --up y");
    assert_eq!(near.count(WHITE), 0);
    let wide = picture(&folder, "--eye=0,0,-0.5 --target=0,0,-3 --up=0,1,0 --fov 120");
    assert!(wide.count(WHITE) > 0);
    // Along the z axis, which is along the scene's own up for z-up scenes; another is found.
    folder.run("render newell -o p.png --direction 0,0,-1").good();
    folder.run("render newell -o p.png --eye=0,0,9 --target=0,0,0").good();
    assert!(picture(&folder, "--direction=-1,-1,-1").count(WHITE) > 0);
    assert!(picture(&folder, "--target=0,0,-3").count(WHITE) > 0);
    let centred = picture(&folder, "--direction=0,0,-1 --target=50,0,0");
    assert_eq!(centred.count(WHITE), 120 * 80);
}

#[test]
fn colours_are_those_of_the_material_library() {
    let folder = Folder::new("render_colours");
    folder.write("m.mtl", "newmtl red\nKd 1 0 0\n");
    folder.write("m.obj", format!("mtllib m.mtl\nusemtl red\n{CROSSING}"));
    folder.run("render m.obj -o p.png --direction 0,0,-1 --size 50x50").good();
    let red = Picture::read(&folder.path("p.png"));
    assert!(red.count([255, 0, 0]) > 1000, "{}", red.colours());
}

#[test]
fn without_materials_all_is_grey_unless_polygons_are_asked_for() {
    let folder = Folder::new("render_grey");
    folder.write("grey.mtl", "newmtl grey\nKd 0.8 0.8 0.8\n");
    folder.write("plain.obj", CROSSING);
    folder.write("grey.obj", format!("mtllib grey.mtl\nusemtl grey\n{CROSSING}"));
    let picture = |scene: &str, options: &str| {
        folder
            .run(&format!("render {scene} -o p.png --direction 1,2,-3 --size 50x50 {options}"))
            .good();
        Picture::read(&folder.path("p.png"))
    };
    for scene in ["plain.obj", "grey.obj"] {
        let grey = picture(scene, "");
        assert!(grey.rgb.chunks_exact(3).all(|rgb| rgb[0] == rgb[1] && rgb[1] == rgb[2]));
        // Shades of grey by the angle, and the background.
        assert!(grey.colours() > 2, "{scene}: {}", grey.colours());
        let coloured = picture(scene, "--colours polygon");
        assert!(coloured.rgb.chunks_exact(3).any(|rgb| rgb[0] != rgb[1]), "{scene}");
    }
}

#[test]
fn what_is_behind_glass_shines_through_in_the_png_too() {
    let folder = Folder::new("render_opacity");
    folder.write("m.mtl", "newmtl glass\nKd 0 0 1\nd 0.25\nnewmtl red\nKd 1 0 0\n");
    let square = |z: i32| format!("v -1 -1 {z}\nv 1 -1 {z}\nv 1 1 {z}\nv -1 1 {z}\n");
    let faces = "usemtl glass\nf 1 2 3 4\nusemtl red\nf 5 6 7 8\n";
    folder.write("s.obj", format!("mtllib m.mtl\n{}{}{faces}", square(1), square(0)));
    let picture = |options: &str| {
        let size = "--size 40x40 --direction";
        folder.run(&format!("render s.obj -o p.png {size}={options}")).good();
        Picture::read(&folder.path("p.png"))
    };
    // From the front a quarter is blue; from the back all is red.
    assert!(picture("0,0,-1").count([191, 0, 64]) > 1000);
    assert!(picture("0,0,1 --z-buffer").count([255, 0, 0]) > 1000);
    assert!(picture("0,0,-1 --z-buffer").count([0, 0, 255]) > 1000);
}

#[test]
fn what_cannot_be_written_is_said_at_once() {
    let folder = Folder::new("render_unwritable");
    for (options, problem) in [
        ("-o p.gif", "ends in .png"),
        ("-o missing/p.png", "cannot be written"),
        ("-o p.pdf", "p.pdf: `binspace render` writes only .png: use `binspace draw`"),
        ("-o p.SVG", "use `binspace draw`"),
        ("-o p.png --cull front", "--cull"),
        ("-o p.png --samples 0", "1..=16"),
        ("-o p.png --samples 17", "1..=16"),
        ("-o p.png --samples=-1", "--samples"),
        ("-o p.png --samples inf", "--samples"),
        ("-o p.png --samples 2 --depth", "one sample per pixel"),
        ("-o p.png --samples 2 --difference", "one sample per pixel"),
        ("-o p.png --depth --z-buffer", "cannot be used with"),
        ("-o p.png --direction=0,0,1 --eye=0,0,1", "cannot be used with"),
        ("-o p.png --eye=0,0,0 --target=0,0,0", "no direction of view"),
        ("-o p.png --eye=0,0,9 --target=0,0,0 --up z", "up vector"),
        ("-o p.png --eye=0,0,1e300 --target=0,0,0", "too far"),
        ("", "--output"),
    ] {
        let message = folder.run(&format!("render newell {options}")).refused();
        assert!(message.contains(problem), "{options}: {message}");
    }
    assert!(folder.files().is_empty(), "{:?}", folder.files());
    fs::create_dir(folder.path("d.png")).unwrap();
    assert!(folder.run("render newell -o d.png").refused().contains("d.png: cannot be written"));
}
