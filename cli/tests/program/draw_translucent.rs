//! Drawings of translucent polygons, as a viewer shows them, against the painter's picture.

use std::collections::HashSet;
use std::fmt::Write as _;
use std::fs;

use crate::draw::figures;
use crate::png_picture::Picture;
use crate::run::Folder;
use crate::svg_picture::Svg;
use testkit::dice::Dice;

/// Triangles that penetrate each other, of glass, of smoke and of wood.
pub(crate) fn write_scene(folder: &Folder, count: usize) {
    let materials = "newmtl glass\nKd .1 .3 .9\nd 0.25\nnewmtl smoke\nKd .4 .4 .4\nd 0.625\n\
                     newmtl wood\nKd .8 .5 .2\n";
    folder.write("m.mtl", materials);
    let (mut dice, mut text) = (Dice(7), "mtllib m.mtl\n".to_owned());
    for _ in 0..count {
        let centre = dice.point(0.0, 1.0);
        for _ in 0..3 {
            let corner = centre + dice.point(-1.0, 1.0) * 0.4;
            writeln!(text, "v {:.6} {:.6} {:.6}", corner.x, corner.y, corner.z).unwrap();
        }
    }
    for i in 0..count {
        let material = ["glass", "smoke", "wood"][i % 3];
        let [a, b, c] = [1, 2, 3].map(|k| 3 * i + k);
        writeln!(text, "usemtl {material}\nf {a} {b} {c}").unwrap();
    }
    folder.write("s.obj", text);
}

#[test]
fn what_shines_through_is_what_the_painter_blends() {
    let folder = Folder::new("draw_translucent");
    write_scene(&folder, 40);
    let view = "--direction=1,2,-.7 --size 300x240";
    let drawn =
        folder.run(&format!("draw s.obj -o a.svg --translucent --ids --json {view}")).good();
    let figures = figures(&drawn);
    folder.run(&format!("render s.obj -o a.png {view}")).good();
    let svg = Svg::read(&folder.path("a.svg"));
    assert_eq!(figures["visible"], 40);
    assert_eq!(figures["paths"], svg.paths.len());
    // Few more paths than polygons, though the tree cuts all of them.
    let fragments = figures["fragments"].as_u64().unwrap() as usize;
    assert!(svg.paths.len() >= 40 && 3 * svg.paths.len() < 2 * fragments, "{figures}");
    for opacity in ["0.25", "0.625"] {
        assert!(svg.text.contains(&format!("fill-opacity=\"{opacity}\"")), "{}", svg.text);
    }
    let (found, expected) = (svg.picture(), Picture::read(&folder.path("a.png")));
    let [width, height] = expected.size.map(|side| side as usize);
    let pixel = |picture: &Picture, x: usize, y: usize| -> [i32; 3] {
        [0, 1, 2].map(|channel| i32::from(picture.rgb[3 * (y * width + x) + channel]))
    };
    let (mut compared, mut wrong, mut colours) = (0, 0, HashSet::new());
    for y in 1..height - 1 {
        for x in 1..width - 1 {
            // Away from edges, which viewers round.
            let centre = pixel(&expected, x, y);
            let around = (0..9).map(|i| pixel(&expected, x + i % 3 - 1, y + i / 3 - 1));
            if around.into_iter().any(|other| other != centre) {
                continue;
            }
            let other = pixel(&found, x, y);
            // Each of many layers is rounded.
            let off = (0..3).map(|i| (other[i] - centre[i]).abs()).max();
            wrong += usize::from(off > Some(4));
            compared += 1;
            colours.insert(centre);
        }
    }
    assert!(compared > 20_000 && colours.len() > 50, "{compared} {}", colours.len());
    // A viewer shows some slivers that lie between the centres of pixels.
    assert!(2_000 * wrong < compared, "{wrong} of {compared}");
}

#[test]
fn a_pdf_has_the_opacities() {
    let folder = Folder::new("draw_translucent_pdf");
    write_scene(&folder, 12);
    folder.run("draw s.obj -o a.pdf --translucent").good();
    let bytes = fs::read(folder.path("a.pdf")).unwrap();
    let text = String::from_utf8_lossy(&bytes);
    for expected in ["/ca 0.25", "/ca 0.625", "/ca 1", "/ExtGState"] {
        assert!(text.contains(expected), "{expected}");
    }
    folder.run("draw s.obj -o b.pdf --opaque").good();
    let bytes = fs::read(folder.path("b.pdf")).unwrap();
    assert!(!String::from_utf8_lossy(&bytes).contains("/ca "));
}

#[test]
fn options_that_do_not_fit_are_refused() {
    let folder = Folder::new("draw_translucent_options");
    write_scene(&folder, 3);
    for (options, expected) in [
        ("-o a.pdf --seams plus-lighter", "works only in an SVG: use `--seams trap`"),
        ("-o a.svg --seams plus-lighter --translucent", "no hidden ones: omit --translucent, or"),
        ("-o a.svg --seams some", "--seams"),
    ] {
        let message = folder.run(&format!("draw s.obj {options}")).refused();
        assert!(message.contains(expected), "{options}: {message}");
    }
    assert_eq!(folder.files(), ["m.mtl", "s.obj"]);
    // Neither matters to lines, or to pixels.
    folder.run("draw s.obj -o l.svg --seams plus-lighter --translucent --lines").good();
    folder.run("draw s.obj -o a.png --seams plus-lighter --translucent").good();
    // Lines above them are visible lines.
    folder.run("draw s.obj -o a.svg --translucent --edges all --hidden dashed").good();
    let svg = Svg::read(&folder.path("a.svg"));
    assert!(!svg.lines.is_empty() && !svg.paths.is_empty());
}
