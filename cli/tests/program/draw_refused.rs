//! Scenes and options that `binspace draw` refuses, and its messages.

use std::fs;

use binspace::BspTree;
use binspace::glam::DVec3;
use binspace::scene::{Material, Scene};

use crate::run::{CROSSING, Folder, Run};
use crate::svg_picture::Svg;

#[test]
fn opacities_that_are_none_are_refused_or_left_out() {
    let folder = Folder::new("draw_opacities");
    folder.write("s.obj", format!("mtllib m.mtl\nusemtl odd\n{CROSSING}"));
    // When a file is read, NaN is skipped, and other values are clamped to 0 to 1.
    for (opacity, is_drawn) in
        [("nan", true), ("inf", true), ("-1", false), ("7", true), ("0", false), ("1", true)]
    {
        folder.write("m.mtl", format!("newmtl odd\nKd 1 0 0\nd {opacity}\n"));
        folder.run("draw s.obj -o a.svg").good();
        let svg = Svg::read(&folder.path("a.svg"));
        assert_eq!(!svg.paths.is_empty(), is_drawn, "{opacity}");
        assert!(!svg.text.contains("opacity"), "{opacity}");
    }
    // A saved scene may hold any value.
    for wrong in [f32::NAN, 1.5, -0.5] {
        let mut scene = Scene::new("odd", DVec3::Z);
        let odd = scene.add_material(Material::new("odd", [1.0; 3]).with_opacity(wrong));
        scene.push([DVec3::ZERO, DVec3::X, DVec3::Y], odd);
        let mut saved = Vec::new();
        BspTree::build(scene.polygons()).unwrap().write(&mut saved).unwrap();
        scene.write(&mut saved).unwrap();
        folder.write("b.bsp", saved);
        for options in ["-o b.svg", "-o b.svg --translucent", "-o b.png"] {
            let message = folder.run(&format!("draw b.bsp {options}")).refused();
            assert!(message.contains(&format!("has opacity {wrong}")), "{message}");
        }
        folder.run("draw b.bsp -o b.svg --opaque").good();
    }
}

#[test]
fn what_cannot_be_drawn_is_said_at_once() {
    let folder = Folder::new("draw_bad");
    for (options, problem) in [
        ("", "--output"),
        ("-o p.gif", "p.gif: name a file that ends in one of .svg, .pdf, .tex, .dxf, .png"),
        (
            "-o p",
            "p: name a file that ends in one of .svg, .pdf, .tex, .dxf, .png, or give --format",
        ),
        ("-o p.svg --format pdf", "p.svg: the file's name and --format disagree"),
        ("-o p.svg --format gif", "--format"),
        ("-o p.svg --lines --edges none", "--lines and DXF need edges to draw"),
        ("-o p.svg --lines --hidden dotted", "--hidden"),
        ("-o p.svg --lines --colours polygon", "cannot be used with"),
        ("-o p.svg --edges creases=x", "from 0 to 180 degrees, as in creases=20"),
        ("-o p.svg --edges outlines", "none, all, creases, creases=DEG or silhouettes"),
        ("-o p.png --ids", "--ids works only in an SVG"),
        ("-o p.pdf --ids", "--ids works only in an SVG"),
        ("-o p.png --background none", "a PNG needs a background"),
        ("-o p.svg --background red", "such as #ffeecc"),
        ("-o p.svg --margin 50", "0 to 45 percent"),
        ("-o p.svg --line-width 0", "0.01 to 1000 pixels"),
        ("-o p.png --line-width 1e-6", "0.01 to 1000 pixels"),
        ("-o p.tex --line-width 17000", "0.01 to 1000 pixels"),
        ("-o p.svg --margin -5", "0 to 45 percent"),
        ("-o p.pdf --view top --scale -1", "a number above 0"),
        ("-o p.pdf --scale 2", "not provided:\n  <--direction <X,Y,Z>|--view <NAME>>"),
        ("-o p.pdf --scale 2 --view top --size 9x9", "cannot be used with"),
        ("-o p.pdf --scale 1e9 --view top", "4294967295"),
        ("-o p.svg --view top --fov 9", "cannot be used with"),
        ("-o p.svg --view top --eye 9 -4 3", "cannot be used with"),
        ("-o p.svg --view back", "front, top, right, iso"),
        ("-o p.svg --eye 1,2", "as in 9,-4,3 or 9 -4 3, not 2"),
        ("-o p.pdf --size 14401x2", "pages of PDF and TeX are at most 14400 points wide and high"),
        ("-o missing/p.pdf", "cannot be written"),
        ("-o missing/p.png", "cannot be written"),
        ("-o missing/p.svg", "cannot be written"),
        ("-o - --json", "standard output: the drawing and the object"),
        ("-o p.svg --samples 2", "--samples"),
        ("-o p.svg --z-buffer", "--z-buffer"),
        ("-o p.svg --depth", "--depth"),
        ("-o p.svg --cull front", "--cull"),
        ("-o p.svg --min-size=-1", "0 or more"),
        ("-o p.svg --min-size nan", "not a finite number"),
        ("-o p.svg --min-size", "--min-size"),
        ("-o p.svg --direction=0,0,1 --eye=0,0,1", "cannot be used with"),
        ("-o p.svg --direction=0,0,1 --fov 30", "cannot be used with"),
        ("-o p.svg --eye=0,0,0 --target=0,0,0", "no direction of view"),
        ("-o p.svg --eye=0,0,9 --target=0,0,0 --up z", "up vector"),
        ("-o p.svg --eye=0,0,1e300 --target=0,0,0", "too far"),
        ("-o p.svg --size 0x5", "such as 640x480"),
        ("-o p.svg --max-fragments 3", "fragments"),
    ] {
        let message = folder.run(&format!("draw newell {options}")).refused();
        assert!(message.contains(problem), "{options}: {message}");
    }
    assert!(folder.files().is_empty(), "{:?}", folder.files());
}

#[test]
fn a_drawing_is_written_completely_or_not_at_all() {
    let folder = Folder::new("draw_whole");
    folder.write("s.obj", CROSSING);
    let piped = Run::new(&folder.pipe("draw - -o -", CROSSING)).good();
    folder.run("draw s.obj -o a.SVG").good();
    let kept = fs::read_to_string(folder.path("a.SVG")).unwrap();
    assert_eq!(kept, piped);
    for scene in ["missing.obj", "random --max-fragments 10", "s.obj --eye=0,0,1e300"] {
        folder.run(&format!("draw {scene} -o a.SVG")).refused();
        assert_eq!(fs::read_to_string(folder.path("a.SVG")).unwrap(), kept);
    }
    assert_eq!(folder.files(), ["a.SVG", "s.obj"]);
}

/// Without a scale, the size of a page is known before the scene is read.
#[test]
fn a_page_too_large_is_refused_before_the_scene_is_read() {
    let folder = Folder::new("draw_page");
    for name in ["p.pdf", "p.tex"] {
        let message = folder.run(&format!("draw missing.obj -o {name} --size 14401x2")).refused();
        assert!(message.contains("at most 14400 points wide and high"), "{message}");
    }
}
