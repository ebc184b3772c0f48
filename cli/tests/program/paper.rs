//! Drawings for people: views by name, a scale, margins, line widths and backgrounds.

use std::fs;

use serde_json::Value;

use crate::png_picture::Picture;
use crate::run::Folder;
use crate::svg_picture::Svg;

/// A block of 2 by 1 by 3 units. Its faces, from 0: below, above, in front (least y), right, behind, left.
const BLOCK: &str = "\
v 0 0 0\nv 2 0 0\nv 2 1 0\nv 0 1 0\nv 0 0 3\nv 2 0 3\nv 2 1 3\nv 0 1 3\n\
f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";

/// The numbers of the polygons in a drawing, ascending.
fn polygons(svg: &Svg) -> Vec<usize> {
    let mut numbers: Vec<usize> = svg.paths.iter().map(|path| path.polygon.unwrap()).collect();
    numbers.sort_unstable();
    numbers
}

fn draw(folder: &Folder, options: &str) -> Svg {
    folder.run(&format!("draw block.obj -o a.svg --ids {options}")).good();
    Svg::read(&folder.path("a.svg"))
}

#[test]
fn views_by_name_show_the_sides_of_their_names() {
    let folder = Folder::new("paper_views");
    folder.write("block.obj", BLOCK);
    for (view, shown) in [
        ("--up z --view front", &[2][..]),
        ("--up z --view top", &[1]),
        ("--up z --view right", &[3]),
        ("--up z --view iso", &[1, 2, 3]),
        // The front is at the largest z then, and above at the largest y.
        ("--up y --view front", &[1]),
        ("--up y --view top", &[4]),
        ("--up y --view right", &[3]),
        ("--up y --view iso", &[1, 3, 4]),
        ("--up -z --view top", &[0]),
    ] {
        assert_eq!(polygons(&draw(&folder, view)), shown, "{view}");
    }
    // An isometric view shows all three directions alike: the edges of a cube have one length.
    folder.write(
        "block.obj",
        BLOCK.replace("v 2", "v 1").replace(" 3\nv", " 1\nv").replace(" 3\nf 4", " 1\nf 4"),
    );
    let svg = draw(&folder, "--up z --view iso --lines --edges all --size 500x500");
    let lengths = svg.lines.iter().map(|line| {
        // A point, and the way from it.
        let data = line.data.replace('-', " -");
        let numbers = data.split([' ', 'm']).filter(|part| !part.is_empty());
        let numbers: Vec<f64> = numbers.map(|number| number.parse().unwrap()).collect();
        assert_eq!(numbers.len(), 4, "{data}");
        numbers[2].hypot(numbers[3])
    });
    let lengths: Vec<f64> = lengths.collect();
    assert!(
        lengths.len() >= 9 && lengths.iter().all(|l| (l / lengths[0] - 1.0).abs() < 1e-3),
        "{lengths:?}"
    );
}

#[test]
fn vectors_may_be_three_arguments() {
    let folder = Folder::new("paper_vectors");
    folder.write("block.obj", BLOCK);
    let [one, three] = ["--eye=9,-4,3 --target=0,0,1", "--eye 9 -4 3 --target 0 0 1"]
        .map(|view| draw(&folder, view).text);
    assert_eq!(one, three);
    let order = |eye: &str| folder.run(&format!("order block.obj {eye}")).good();
    assert_eq!(order("--eye=9,-4,3 --eye=1,2,-3"), order("--eye 9 -4 3 --eye 1 2 -3"));
}

#[test]
fn a_scale_decides_the_size_of_the_paper() {
    let folder = Folder::new("paper_scale");
    folder.write("block.obj", BLOCK);
    let size = |options: &str| -> String {
        let text = draw(&folder, options).text;
        text.split("viewBox=\"0 0 ").nth(1).unwrap().split('"').next().unwrap().to_owned()
    };
    // 2 and 3 units of 10 mm, in pixels of 1/96 inch; and with a tenth of the paper left free on each side.
    assert_eq!(size("--up z --view front --scale 10 --margin 0"), "76 114");
    assert_eq!(size("--up z --view front --scale 10 --margin 10"), "95 142");
    assert_eq!(size("--direction=0,0,-1 --up y --scale 10 --margin 0"), "76 38");
    // In points of 1/72 inch.
    folder.run("draw block.obj --up z --view front --scale 10 --margin 0 -o a.pdf").good();
    let pdf = fs::read(folder.path("a.pdf")).unwrap();
    assert!(String::from_utf8_lossy(&pdf).contains("/MediaBox [0 0 57 86]"));
}

#[test]
fn margins_widths_and_backgrounds_are_as_asked_for() {
    let folder = Folder::new("paper_look");
    folder.write("block.obj", BLOCK);
    let picture = |options: &str| {
        folder.run(&format!("draw block.obj --up z --view front -o a.png {options}")).good();
        Picture::read(&folder.path("a.png"))
    };
    let cream = [255, 238, 204];
    // The block is 2 by 3: without a margin it fills the picture.
    let full = picture("--size 80x120 --margin 0 --background #ffeecc");
    assert_eq!(full.count(cream), 0);
    let free = picture("--size 80x120 --margin 25 --background fec");
    assert_eq!(free.count(cream), 80 * 120 - 40 * 60);
    let svg = |options: &str| draw(&folder, options).text;
    assert!(
        svg("--background fec").contains("<rect width=\"640\" height=\"480\" fill=\"#ffeecc\"/>")
    );
    assert!(svg("").contains("<rect") && !svg("--background none").contains("<rect"));
    // A frame of lines around the front, with half of their width outside of it.
    let black = |width: &str| {
        let lines = picture(&format!("--size 200x200 --lines --line-width {width}"));
        (0..200 * 200).map(|i| 255 - u64::from(lines.rgb[3 * i])).sum::<u64>() as f64 / 255.0
    };
    let [thin, thick] = [black("1"), black("4")];
    assert!((thick / thin - 4.0).abs() < 0.1, "{thin} {thick}");
    // In fiftieths of a pixel.
    let svg = svg("--view iso --line-width 2.5 --lines --hidden dashed");
    assert!(svg.contains("stroke-width=\"125\"") && svg.contains("stroke-width=\"75\""), "{svg}");
}

#[test]
fn colours_are_spelled_both_ways() {
    let folder = Folder::new("paper_colours");
    folder.write("block.obj", BLOCK);
    assert_eq!(draw(&folder, "--colors polygon").text, draw(&folder, "--colours polygon").text);
}

#[test]
fn threads_change_no_result() {
    let folder = Folder::new("paper_general");
    let order =
        |threads: &str| folder.run(&format!("order random:200 --eye=9,9,9 {threads}")).good();
    assert_eq!(order("--threads 1"), order("--threads 3"));
    folder.run("stats random:200 --threads 0").refused();
}

#[test]
fn verify_prints_objects() {
    let folder = Folder::new("paper_json");
    folder.write("block.obj", BLOCK);
    let out = folder.run("verify block.obj --views 3 --size 40x30 --json").good();
    let lines: Vec<Value> = out.lines().map(|line| serde_json::from_str(line).unwrap()).collect();
    assert_eq!(lines.len(), 4, "{out}");
    let covered = |line: &Value| line["covered"].as_u64().unwrap();
    assert_eq!(covered(&lines[3]), lines[..3].iter().map(covered).sum::<u64>());
    assert!(covered(&lines[3]) > 100 && lines[3]["view"].is_null());
    for (number, line) in (1..).zip(&lines[..3]) {
        assert_eq!((&line["view"], &line["is_right"]), (&Value::from(number), &Value::from(true)));
        assert!(line["from"] == "around" || line["from"] == "inside", "{line}");
    }
}
