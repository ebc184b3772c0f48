//! Drawings as DXF: its structure, and its lines.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;

use binspace::glam::DVec3;

use crate::draw::{CARDS, CARDS_MATERIALS, CARDS_VIEW, figures};
use crate::run::{CROSSING, Folder};
use crate::svg_picture::Svg;

/// A file: its extent, the dashes and gaps of each layer, and its lines.
#[derive(Default)]
struct Dxf {
    extent: [f64; 2],
    layers: BTreeMap<String, Vec<f64>>,
    lines: Vec<Line>,
}

struct Line {
    layer: String,
    is_closed: bool,
    points: Vec<[f64; 2]>,
}

impl Line {
    /// The data of a path of an SVG.
    fn data(&self) -> String {
        let points: Vec<String> = self.points.iter().map(|[x, y]| format!("{x} {y}")).collect();
        format!("M{}{}", points.join("L"), if self.is_closed { "z" } else { "" })
    }
}

/// The groups of a file, each a code and a value, in parts that begin with the code 0.
fn parts(text: &str) -> Vec<Vec<(u32, &str)>> {
    let mut parts: Vec<Vec<(u32, &str)>> = Vec::new();
    let mut lines = text.lines();
    while let Some(code) = lines.next() {
        let group = (code.parse().unwrap(), lines.next().unwrap());
        if group.0 == 0 {
            parts.push(Vec::new());
        }
        parts.last_mut().unwrap().push(group);
    }
    parts
}

impl Dxf {
    /// A file of release 12, in which all layers and types of lines that are used are defined, and counted.
    fn parse(text: &str) -> Self {
        let mut dxf = Self::default();
        let mut types = BTreeMap::new();
        let (mut open, mut line, mut entries) = (Vec::new(), None, [0.0; 2]);
        for part in parts(text) {
            let all = |code: u32| part.iter().filter(move |group| group.0 == code);
            let value =
                |code: u32| all(code).next().unwrap_or_else(|| panic!("{code}: {part:?}")).1;
            let number = |code: u32| value(code).parse::<f64>().unwrap();
            let layer = || dxf.layers.contains_key(value(8)).then(|| value(8).to_owned()).unwrap();
            match value(0) {
                "SECTION" => {
                    open.push(value(2));
                    if value(2) == "HEADER" {
                        let corners: Vec<(u32, &str)> = part[4..].to_vec();
                        let [low, high] = [&corners[..4], &corners[4..]];
                        assert_eq!(low, [(9, "$EXTMIN"), (10, "0.0"), (20, "0.0"), (30, "0.0")]);
                        let &[(9, "$EXTMAX"), (10, x), (20, y), (30, "0.0")] = high else {
                            panic!("{high:?}")
                        };
                        dxf.extent = [x, y].map(|c| c.parse().unwrap());
                    }
                }
                "TABLE" => {
                    open.push(value(2));
                    entries = [number(70), 0.0];
                }
                "ENDTAB" => {
                    assert!(entries[0] == entries[1] && open.pop().is_some(), "{entries:?}");
                }
                "ENDSEC" => assert!(open.pop().is_some()),
                "EOF" => assert!(open.is_empty()),
                "LTYPE" => {
                    assert_eq!(open, ["TABLES", "LTYPE"]);
                    entries[1] += 1.0;
                    let lengths = all(49).map(|group| group.1.parse::<f64>().unwrap());
                    let lengths: Vec<f64> = lengths.collect();
                    assert_eq!([number(72), number(73)], [65.0, lengths.len() as f64]);
                    assert_eq!(number(40), lengths.iter().map(|length| length.abs()).sum::<f64>());
                    assert!(types.insert(value(2), lengths).is_none());
                }
                "LAYER" => {
                    assert_eq!(open, ["TABLES", "LAYER"]);
                    entries[1] += 1.0;
                    let name = value(2).to_owned();
                    // Black on white, and neither frozen nor locked.
                    assert_eq!([value(62), value(70)], ["7", "0"]);
                    assert!(dxf.layers.insert(name, types[value(6)].clone()).is_none());
                }
                "POLYLINE" => {
                    assert_eq!(open, ["ENTITIES"]);
                    // Vertices follow, up to the end of the sequence.
                    assert_eq!(value(66), "1");
                    assert!(value(70) == "0" || value(70) == "1");
                    let new = Line { layer: layer(), is_closed: value(70) == "1", points: vec![] };
                    assert!(line.replace(new).is_none());
                }
                "VERTEX" => {
                    let line = line.as_mut().unwrap();
                    assert_eq!(line.layer, layer());
                    line.points.push([number(10), number(20)]);
                }
                "SEQEND" => {
                    assert_eq!(line.as_ref().unwrap().layer, layer());
                    dxf.lines.extend(line.take());
                }
                other => panic!("{other}"),
            }
        }
        assert!(line.is_none() && text.ends_with("0\nEOF\n") && text.contains("\nAC1009\n"));
        dxf
    }

    fn as_svg(&self, [width, height]: [u32; 2]) -> String {
        let mut svg = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\">\
             <rect width=\"{width}\" height=\"{height}\" fill=\"#fff\"/>\
             <g fill=\"none\" stroke=\"#000\" stroke-linejoin=\"round\" \
             transform=\"matrix(1 0 0 -1 0 {height})\">"
        );
        // The lines of a layer together, as in an SVG: where they cross, they are no darker.
        for lines in self.lines.chunk_by(|a, b| a.layer == b.layer) {
            let dashes: Vec<String> =
                self.layers[&lines[0].layer].iter().map(|c| c.abs().to_string()).collect();
            let (cap, wide) = if dashes.is_empty() { ("round", 1.0) } else { ("butt", 0.6) };
            let dashes = if dashes.is_empty() { "none".to_owned() } else { dashes.join(" ") };
            let data: String = lines.iter().map(Line::data).collect();
            svg += &format!(
                "<path stroke-width=\"{wide}\" stroke-linecap=\"{cap}\" \
                 stroke-dasharray=\"{dashes}\" d=\"{data}\"/>"
            );
        }
        svg + "</g></svg>"
    }
}

#[test]
fn a_dxf_has_the_lines_of_the_svg_in_layers_by_kind() {
    let folder = Folder::new("dxf_same");
    folder.write("s.obj", CROSSING);
    let (mut layers, mut closed) = (BTreeSet::new(), 0);
    for (options, size) in [
        ("s.obj --eye=3,2.5,6 --target=0,0,0 --size 300x200", [300, 200]),
        ("teapot:5 --hidden layers", [640, 480]),
        ("random:200 --edges all --hidden dashed --size 200x150", [200, 150]),
        ("newell --edges silhouettes", [640, 480]),
        ("newell --eye=0,0,50 --target=0,0,90", [640, 480]),
    ] {
        folder.run(&format!("draw {options} --lines -o a.svg")).good();
        let numbers = figures(&folder.run(&format!("draw {options} -o a.dxf --json")).good());
        let text = fs::read_to_string(folder.path("a.dxf")).unwrap();
        assert_eq!(numbers["bytes"], text.len(), "{options}");
        let dxf = Dxf::parse(&text);
        assert_eq!(numbers["lines"], dxf.lines.len(), "{options}");
        let svg = Svg::read(&folder.path("a.svg"));
        // Layers are named for the classes of the SVG.
        let name = |classes: &Vec<String>| {
            let [visible, kind] = &classes[..] else { panic!("{classes:?}") };
            let kind = kind.to_uppercase();
            match visible.split_once(" layers-") {
                Some((_, depth)) => format!("HIDDEN{depth}_{kind}"),
                None if visible == "hidden" => format!("HIDDEN_{kind}"),
                None => kind,
            }
        };
        let expected: Vec<String> = svg.lines.iter().map(|lines| name(&lines.classes)).collect();
        let used: BTreeSet<&String> = dxf.lines.iter().map(|line| &line.layer).collect();
        assert_eq!(used, expected.iter().collect(), "{options}");
        closed += dxf.lines.iter().filter(|line| line.is_closed).count();
        layers.extend(expected);
        let drawn = dxf.as_svg(size);
        folder.write("b.svg", &drawn);
        let [found, expected] = [Svg::parse(&drawn), svg].map(|svg| svg.smooth_picture());
        // An SVG rounds coordinates to fiftieths, and dashes begin there.
        let wrong = found.rgb.iter().zip(&expected.rgb).filter(|(a, b)| a.abs_diff(**b) > 16);
        let wrong = wrong.count();
        assert!(100 * wrong <= found.rgb.len(), "{options}: {wrong} of {}", found.rgb.len());
    }
    assert!(layers.len() > 8 && closed > 0, "{layers:?}, {closed} closed");
}

#[test]
fn a_dxf_has_lines_alone() {
    let folder = Folder::new("dxf_lines");
    folder.write("s.obj", CROSSING);
    folder.run("draw s.obj -o a.dxf").good();
    let kept = fs::read(folder.path("a.dxf")).unwrap();
    assert!(folder.pipe("draw - -o - --format dxf --lines", CROSSING).stdout == kept);
    // What a DXF has no polygons for makes no difference.
    let looks = "--colours polygon --background none";
    for options in ["--edges creases", "--seams trap", "--translucent", looks] {
        folder.run(&format!("draw s.obj -o b.dxf {options}")).good();
        assert!(fs::read(folder.path("b.dxf")).unwrap() == kept, "{options}");
    }
    let message = folder.run("draw s.obj -o a.dxf --ids").refused();
    assert!(message.contains("--ids works only in an SVG"), "{message}");
    let message = folder.run("draw s.obj -o a.dxf --edges none").refused();
    assert!(message.contains("DXF need edges to draw"), "{message}");
    assert!(fs::read(folder.path("a.dxf")).unwrap() == kept);
}

/// All of a small drawing, with y upwards: lines from the most hidden to the visible ones, each kind in its layer.
#[test]
fn lines_have_their_places_layers_and_dashes() {
    let folder = Folder::new("dxf_cards");
    folder.write("cards.obj", CARDS);
    folder.write("cards.mtl", CARDS_MATERIALS);
    let drawn = |options: &str| {
        folder.run(&format!("draw {CARDS_VIEW} {options} -o a.dxf")).good();
        Dxf::parse(&fs::read_to_string(folder.path("a.dxf")).unwrap())
    };
    let layers = |dxf: &Dxf| -> Vec<(String, Vec<f64>)> {
        dxf.layers.iter().map(|(name, dashes)| (name.clone(), dashes.clone())).collect()
    };
    let named = |name: &str, dashes: &[f64]| (name.to_owned(), dashes.to_vec());
    // Corners to the right of each other from the lower left one on, wherever the pen begins.
    let lines = |dxf: &Dxf| -> Vec<(String, Vec<[f64; 2]>)> {
        let lines = dxf.lines.iter().map(|line| {
            assert!(line.is_closed);
            let (mut points, order) =
                (line.points.clone(), |a: &[f64; 2], b: &[f64; 2]| a.partial_cmp(b).unwrap());
            let first = (0..points.len()).min_by(|&a, &b| order(&points[a], &points[b])).unwrap();
            points.rotate_left(first);
            let [second, last] = [points[1], points[points.len() - 1]];
            if (second[1] - points[0][1]).abs() > (last[1] - points[0][1]).abs() {
                points[1..].reverse();
            }
            (line.layer.clone(), points)
        });
        lines.collect()
    };
    let line = |layer: &str, points: &[[f64; 2]]| (layer.to_owned(), points.to_vec());
    let small = [[74.8, 17.0], [77.2, 17.0], [77.2, 21.0]];
    let large = [[70.0, 15.0], [80.0, 15.0], [80.0, 35.0]];
    let plate = [[10.0, 5.0], [90.0, 5.0], [90.0, 45.0], [10.0, 45.0]];
    let card = [[30.0, 15.0], [50.0, 15.0], [50.0, 35.0], [30.0, 35.0]];
    let visible = [line("BORDER", &plate), line("BORDER", &card)];
    // Dashes are of lines a pixel wide, whatever the width of lines in pictures.
    for width in ["1", "2"] {
        let dxf = drawn(&format!("--hidden layers --line-width {width}"));
        assert_eq!(dxf.extent, [100.0, 50.0]);
        let expected = [
            named("0", &[]),
            named("BORDER", &[]),
            named("HIDDEN2_BORDER", &[2.0, -3.0]),
            named("HIDDEN_BORDER", &[3.0, -2.0]),
        ];
        assert_eq!(layers(&dxf), expected);
        let hidden = [line("HIDDEN2_BORDER", &small), line("HIDDEN_BORDER", &large)];
        assert_eq!(lines(&dxf), [&hidden[..], &visible].concat());
    }
    let dxf = drawn("--hidden dashed");
    assert_eq!(layers(&dxf)[1..], [named("BORDER", &[]), named("HIDDEN_BORDER", &[3.0, -2.0])]);
    assert!(dxf.lines[..2].iter().all(|line| line.layer == "HIDDEN_BORDER"));
    let dxf = drawn("");
    assert_eq!(layers(&dxf)[1..], [named("BORDER", &[])]);
    assert_eq!(lines(&dxf), visible);
}

/// A square of 3 units is 30 mm at 10 mm for each unit.
#[test]
fn a_dxf_to_scale_is_in_millimetres_of_paper() {
    let folder = Folder::new("dxf_scale");
    folder.write("s.obj", "v 0 0 0\nv 3 0 0\nv 3 3 0\nv 0 3 0\nf 1 2 3 4\n");
    folder.run("draw s.obj -o a.dxf --direction=0,0,-1 --up 0,1,0 --scale 10").good();
    let dxf = Dxf::parse(&fs::read_to_string(folder.path("a.dxf")).unwrap());
    let [line] = &dxf.lines[..] else { panic!("{} lines", dxf.lines.len()) };
    assert!(line.is_closed && line.points.len() == 4);
    for axis in [0, 1] {
        let along = line.points.iter().map(|point| point[axis]);
        let extent = along.clone().fold(f64::MIN, f64::max) - along.fold(f64::MAX, f64::min);
        assert!((extent - 30.0).abs() < 1e-4, "{extent}");
    }
}

/// Also without a margin, where the outline would be on the border of the paper.
#[test]
fn all_lines_are_drawn_to_scale() {
    let folder = Folder::new("dxf_all_lines");
    folder.write("cards.obj", CARDS);
    folder.write("cards.mtl", CARDS_MATERIALS);
    for scale in [10.0, 10.0625] {
        let view = "cards.obj --direction=0,0,-1 --up y --margin 0";
        folder.run(&format!("draw {view} --scale {scale} -o a.dxf")).good();
        let dxf = Dxf::parse(&fs::read_to_string(folder.path("a.dxf")).unwrap());
        // The plate has 4 by 2 units.
        for (axis, side) in [4.0, 2.0].into_iter().enumerate() {
            let places = dxf.lines.iter().flat_map(|line| &line.points).map(|point| point[axis]);
            let low = places.clone().fold(f64::MAX, f64::min);
            let high = places.fold(f64::MIN, f64::max);
            assert!((high - low - side * scale).abs() < 1e-4, "{scale}: from {low} to {high}");
        }
    }
}

/// A card across the view has its upper and lower edges along the border of a picture without a margin.
#[test]
fn edges_along_the_border_are_drawn_in_perspective() {
    let folder = Folder::new("dxf_border");
    // The view of a scene without a view of its own.
    let from = DVec3::new(0.45, -0.8, 0.4).normalize();
    let right = DVec3::Z.cross(from).normalize();
    let up = from.cross(right);
    for (width, height) in [(1.0, 1.0), (1.5, 1.0), (2.0, 1.3), (0.7, 1.1), (3.0, 3.0)] {
        let corners = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];
        let corners = corners.map(|(x, y)| right * (x * width) + up * (y * height));
        let text = corners.map(|DVec3 { x, y, z }| format!("v {x:?} {y:?} {z:?}\n")).concat();
        folder.write("s.obj", text + "f 1 2 3 4\n");
        let size = format!("{:.0}x{:.0}", 200.0 * width, 200.0 * height);
        folder.run(&format!("draw s.obj --up z --margin 0 --size {size} -o a.dxf")).good();
        let dxf = Dxf::parse(&fs::read_to_string(folder.path("a.dxf")).unwrap());
        let lengths = dxf.lines.iter().map(|line| {
            let mut points = line.points.clone();
            points.extend(line.is_closed.then(|| line.points[0]));
            points
                .windows(2)
                .map(|ends| (ends[1][0] - ends[0][0]).hypot(ends[1][1] - ends[0][1]))
                .sum::<f64>()
        });
        let (length, around) = (lengths.sum::<f64>(), 2.0 * (dxf.extent[0] + dxf.extent[1]));
        assert!((length / around - 1.0).abs() < 1e-4, "{size}: {length} of {around}");
    }
}
