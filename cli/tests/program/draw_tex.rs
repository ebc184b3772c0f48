//! Drawings as TikZ: the effect of its commands.

use std::fs;

use crate::draw::{CARDS, CARDS_MATERIALS, CARDS_VIEW};
use crate::run::{CROSSING, Folder};
use crate::svg_picture::Svg;

const BEGIN: &str = "\\begin{tikzpicture}[x=1bp,y=-1bp,line join=round]\n";
const END: &str = "\\end{tikzpicture}%\n\\binspaceend\n";

/// The attributes in SVG of options of TikZ.
fn attributes(options: &str) -> String {
    let mut all = String::new();
    let mut classes = Vec::new();
    let mut depth = 0;
    let options = options.split(|c| {
        depth += i32::from(c == '{') - i32::from(c == '}');
        c == ',' && depth == 0
    });
    for option in options.filter(|option| !option.is_empty()) {
        let (key, value) = option.split_once('=').unwrap_or((option, ""));
        let length = |text: &str| text.trim().strip_suffix("bp").unwrap().to_owned();
        all += &match key {
            "fill" | "draw" => {
                let channels = value.split(|c: char| !c.is_ascii_digit());
                let channels = channels.filter_map(|number| number.parse::<u8>().ok()).skip(1);
                let colour: String = channels.map(|channel| format!("{channel:02x}")).collect();
                format!(" {}=\"#{colour}\"", if key == "fill" { "fill" } else { "stroke" })
            }
            "fill opacity" => format!(" fill-opacity=\"{value}\""),
            "draw opacity" => format!(" stroke-opacity=\"{value}\""),
            "line width" => format!(" stroke-width=\"{}\"", length(value)),
            "line cap" => format!(" stroke-linecap=\"{value}\""),
            "dash pattern" => {
                let (dash, gap) = value.strip_prefix("on ").unwrap().split_once(" off ").unwrap();
                format!(" stroke-dasharray=\"{} {}\"", length(dash), length(gap))
            }
            style => {
                let class = style.strip_prefix("binspace/").and_then(|s| s.strip_suffix("/.try"));
                classes.push(class.unwrap_or_else(|| panic!("{style}")));
                String::new()
            }
        };
    }
    if classes.is_empty() { all } else { format!("{all} class=\"{}\"", classes.join(" ")) }
}

/// The options of a command, and the rest of it.
fn options(command: &str) -> (String, &str) {
    match command.strip_prefix('[').and_then(|rest| rest.split_once(']')) {
        Some((options, rest)) => (attributes(options), rest),
        None => (String::new(), command),
    }
}

/// The painted content, as SVG. A file that is not as TeX reads it panics.
fn as_svg(text: &str, [width, height]: [u32; 2]) -> String {
    let (head, rest) = text.split_once(BEGIN).unwrap();
    // The document ends only if the file began it.
    assert!(head.contains("\\ifdefined\\tikzpicture\n\\let\\binspaceend\\relax\n\\else\n"));
    let begin = "\\documentclass[tikz]{standalone}\n\\begin{document}\n\
                 \\def\\binspaceend{\\end{document}}\n\\fi\n";
    assert!(head.ends_with(begin), "{head}");
    let commands = rest.strip_suffix(END).unwrap();
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\">\
         <g stroke-linejoin=\"round\">"
    );
    let mut is_clipped = false;
    let mut command = String::new();
    for line in commands.lines() {
        if !line.ends_with(';') && !line.starts_with("\\begin") && !line.starts_with("\\end") {
            // A path of several lines.
            command = command + line + " ";
            continue;
        }
        let line = &(std::mem::take(&mut command) + line);
        if line == "\\end{scope}" {
            svg += "</g>";
            continue;
        }
        if let Some(rest) = line.strip_prefix("\\begin{scope}") {
            svg += &format!("<g{}>", options(rest).0);
            continue;
        }
        let rectangle = format!("(0,0) rectangle ({width},{height});");
        if *line == format!("\\clip {rectangle}") {
            is_clipped = true;
            continue;
        }
        let (name, rest) = line.split_at(line.find(['[', ' ']).unwrap());
        let (attributes, path) = options(rest);
        let kind = match name {
            "\\fill" => "",
            "\\draw" => " fill=\"none\"",
            _ => panic!("{line}"),
        };
        let data = match path.strip_prefix(' ').unwrap() {
            path if path == rectangle => format!("M0 0H{width}V{height}H0z"),
            path => {
                let path = path.strip_suffix(';').unwrap().replace("--cycle", "z");
                let path = path
                    .replace(" --", "--")
                    .replace("--(", "L")
                    .replace(" (", "M")
                    .replace(')', " ");
                format!("M{}", path.strip_prefix('(').unwrap())
            }
        };
        svg += &format!("<path{kind}{attributes} d=\"{data}\"/>");
    }
    assert!(is_clipped && command.is_empty());
    svg + "</g></svg>"
}

#[test]
fn tikz_paints_what_the_svg_does() {
    let folder = Folder::new("tex_same");
    folder.write("s.obj", CROSSING);
    folder.write("m.mtl", "newmtl glass\nKd 0.2 0.4 1\nd 0.4\n");
    folder.write("glass.obj", format!("mtllib m.mtl\nusemtl glass\n{CROSSING}"));
    let mut classes = 0;
    for (options, size) in [
        ("s.obj --eye=3,2.5,6 --target=0,0,0 --size 300x200", [300, 200]),
        ("glass.obj --eye=3,2.5,6 --target=0,0,0 --size 300x200 --translucent", [300, 200]),
        ("teapot:5 --edges creases --hidden layers", [640, 480]),
        ("random:200 --lines --edges all --hidden dashed --size 200x150", [200, 150]),
        ("newell --eye=0,0,50 --target=0,0,90", [640, 480]),
    ] {
        for name in ["a.svg", "a.tex"] {
            folder.run(&format!("draw {options} -o {name}")).good();
        }
        let svg = Svg::read(&folder.path("a.svg"));
        let painted = as_svg(&fs::read_to_string(folder.path("a.tex")).unwrap(), size);
        folder.write("b.svg", &painted);
        let painted = Svg::parse(&painted);
        // The background is a fill too.
        assert_eq!(painted.paths.len(), svg.paths.len() + 1, "{options}");
        let kinds = |svg: &Svg| -> Vec<Vec<String>> {
            svg.lines.iter().map(|lines| lines.classes.clone()).collect()
        };
        assert_eq!(kinds(&painted), kinds(&svg), "{options}");
        classes += kinds(&svg).len();
        let [found, expected] = [painted, svg].map(|svg| svg.smooth_picture());
        assert_eq!(found.size, expected.size);
        let wrong = found.rgb.iter().zip(&expected.rgb).filter(|(a, b)| a.abs_diff(**b) > 2);
        let wrong = wrong.count();
        assert!(2_000 * wrong <= found.rgb.len(), "{options}: {wrong} of {}", found.rgb.len());
    }
    assert!(classes > 10, "{classes}");
}

/// All of a small picture: paths from back to front, hidden lines before visible ones.
#[test]
fn paths_have_their_places_colours_and_lines() {
    let folder = Folder::new("tex_paths");
    folder.write("cards.obj", CARDS);
    folder.write("cards.mtl", CARDS_MATERIALS);
    let look = "--translucent --background #ffeecc --edges all --hidden layers --line-width 2";
    folder.run(&format!("draw {CARDS_VIEW} {look} -o a.tex")).good();
    let text = fs::read_to_string(folder.path("a.tex")).unwrap();
    let (_, rest) = text.split_once(BEGIN).unwrap();
    let line = "draw={rgb,255:red,0;green,0;blue,0},line width=";
    let expected = format!(
        r"\clip (0,0) rectangle (100,50);
\fill[fill={{rgb,255:red,255;green,238;blue,204}},binspace/background/.try] (0,0) rectangle (100,50);
\begin{{scope}}[fill={{rgb,255:red,255;green,0;blue,0}}]
\fill (74.8,33)--(77.2,29)--(77.2,33)--cycle;
\fill (70,35)--(80,15)--(80,35)--cycle;
\end{{scope}}
\fill[fill={{rgb,255:red,0;green,0;blue,255}}] (10,45)--(10,5)--(90,5)--(90,45)--cycle;
\fill[fill={{rgb,255:red,0;green,255;blue,0}},fill opacity=0.4] (30,35)--(30,15)--(50,15)--(50,35)--cycle;
\begin{{scope}}[{line}1.2bp,dash pattern=on 4bp off 6bp,binspace/hidden/.try,binspace/layers-2/.try]
\draw[binspace/border/.try] (74.8,33)--(77.2,33)--(77.2,29)--cycle;
\end{{scope}}
\begin{{scope}}[{line}1.2bp,dash pattern=on 6bp off 4bp,binspace/hidden/.try]
\draw[binspace/border/.try] (70,35)--(80,15)--(80,35)--cycle;
\end{{scope}}
\begin{{scope}}[{line}2bp,line cap=round,binspace/visible/.try]
\draw[binspace/border/.try] (10,5)--(10,45)--(90,45)--(90,5)--cycle
(30,15)--(30,35)--(50,35)--(50,15)--cycle;
\end{{scope}}
"
    );
    assert_eq!(rest.strip_suffix(END).unwrap(), expected);
    // The page is as large as the drawing to scale, in big points.
    folder.run("draw cards.obj --view front --up y --scale 10 --margin 0 -o a.tex").good();
    let text = fs::read_to_string(folder.path("a.tex")).unwrap();
    // 40 by 20 mm.
    assert!(text.contains("\\clip (0,0) rectangle (114,57);\n"), "{text}");
}

#[test]
fn tikz_goes_to_standard_output_too() {
    let folder = Folder::new("tex_output");
    folder.write("s.obj", CROSSING);
    folder.run("draw s.obj -o a.tex").good();
    let kept = fs::read(folder.path("a.tex")).unwrap();
    assert!(folder.pipe("draw - -o - --format tex", CROSSING).stdout == kept);
    folder.run("draw s.obj -o a.tex --size 20000x10").refused();
    folder.run("draw s.obj -o a.tex --seams plus-lighter").refused();
    assert!(fs::read(folder.path("a.tex")).unwrap() == kept);
}
