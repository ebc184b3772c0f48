//! Drawings as PDF: the file's structure, and the effect of its operators.

use std::fs;

use miniz_oxide::inflate::decompress_to_vec_zlib;

use crate::run::{CROSSING, Folder};
use crate::svg_picture::Svg;

fn find(bytes: &[u8], text: &str) -> Option<usize> {
    bytes.windows(text.len()).position(|window| window == text.as_bytes())
}

fn number_after(bytes: &[u8], text: &str) -> usize {
    let start = find(bytes, text).unwrap_or_else(|| panic!("no {text}")) + text.len();
    let digits = bytes[start..].iter().skip_while(|b| b.is_ascii_whitespace());
    let digits: Vec<u8> = digits.take_while(|b| b.is_ascii_digit()).copied().collect();
    String::from_utf8(digits).unwrap().parse().unwrap()
}

/// The operators of the only page, of a file whose table of objects is right.
fn page(bytes: &[u8], [width, height]: [u32; 2]) -> String {
    assert!(bytes.starts_with(b"%PDF-1.7\n") && bytes.ends_with(b"%%EOF"), "{}", bytes.len());
    let table = number_after(bytes, "startxref");
    assert!(bytes[table..].starts_with(b"xref\n0 5\n"));
    let entries = &bytes[table + b"xref\n0 5\n".len()..];
    for object in 1..5 {
        let entry = std::str::from_utf8(&entries[20 * object..20 * object + 20]).unwrap();
        assert!(entry.ends_with(" 00000 n\r\n"), "{entry:?}");
        let at: usize = entry[..10].parse().unwrap();
        assert!(bytes[at..].starts_with(format!("{object} 0 obj").as_bytes()));
    }
    let text = String::from_utf8_lossy(bytes).replace('\n', " ");
    for expected in [
        &format!("/MediaBox [0 0 {width} {height}]"),
        "/Type /Catalog",
        "/Type /Pages",
        "/Kids [3 0 R]",
        "/Count 1",
        "/Contents 4 0 R",
        "/Filter /FlateDecode",
        "/Root 1 0 R",
    ] {
        assert!(text.contains(expected), "{expected}");
    }
    let start = find(bytes, "stream\n").unwrap() + "stream\n".len();
    let length = number_after(bytes, "/Length ");
    let end = &bytes[start + length..];
    assert!(end.starts_with(b"\nendstream"));
    String::from_utf8(decompress_to_vec_zlib(&bytes[start..start + length]).unwrap()).unwrap()
}

/// The painted content, as SVG, and the numbers of fills and strokes. Pages are turned upside down.
fn as_svg(operators: &str, [width, height]: [u32; 2]) -> (String, [usize; 2]) {
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\">\
         <g transform=\"matrix(1 0 0 -1 0 {height})\">"
    );
    let (mut groups, mut counts) = (1, [0; 2]);
    let (mut numbers, mut data): (Vec<&str>, String) = (vec![], String::new());
    let (mut fill, mut pen, mut dashes) = (String::new(), String::new(), String::new());
    for token in operators.split_whitespace() {
        let all = numbers.join(" ").replace(['[', ']'], "");
        match token {
            "rg" => {
                let channels = numbers.iter().map(|c| 255.0 * c.parse::<f64>().unwrap());
                let channels: Vec<String> =
                    channels.map(|c| format!("{:02x}", c.round() as u8)).collect();
                fill = format!("#{}", channels.concat());
            }
            "G" => assert_eq!(all, "0"),
            "re" => data += &format!("M0 0H{width}V{height}H0z"),
            "cm" => {
                svg += &format!("<g transform=\"matrix({all})\">");
                groups += 1;
            }
            "m" | "l" => data += &format!("{}{all}", if token == "m" { "M" } else { "L" }),
            "h" => data += "z",
            "w" => pen = format!("stroke-width=\"{all}\""),
            "d" => {
                let all: Vec<&str> = all.split_whitespace().collect();
                let (_, lengths) = all.split_last().unwrap();
                dashes = match lengths {
                    [] => String::new(),
                    _ => format!("stroke-dasharray=\"{}\"", lengths.join(" ")),
                };
            }
            "j" => assert_eq!(all, "1"),
            "J" => assert_eq!(all, "1"),
            "f" => {
                svg += &format!("<path fill=\"{fill}\" d=\"{data}\"/>");
                data.clear();
                counts[0] += 1;
            }
            "S" => {
                let cap = if dashes.is_empty() { "round" } else { "butt" };
                svg += &format!(
                    "<path fill=\"none\" stroke=\"#000\" stroke-linejoin=\"round\" \
                     stroke-linecap=\"{cap}\" {pen} {dashes} d=\"{data}\"/>"
                );
                data.clear();
                counts[1] += 1;
            }
            _ => {
                numbers.push(token);
                continue;
            }
        }
        numbers.clear();
    }
    (svg + &"</g>".repeat(groups) + "</svg>", counts)
}

#[test]
fn a_page_paints_what_the_svg_does() {
    let folder = Folder::new("pdf_same");
    folder.write("s.obj", CROSSING);
    let mut strokes = 0;
    for (options, size) in [
        ("s.obj --eye=3,2.5,6 --target=0,0,0 --size 300x200", [300, 200]),
        ("teapot:5 --edges creases --hidden dashed", [640, 480]),
        ("random:200 --lines --edges all --hidden dashed --size 200x150", [200, 150]),
        ("city:200 --colours polygon --size 1000x40", [1000, 40]),
        ("newell --size 1x1 --edges all", [1, 1]),
        ("newell --eye=0,0,50 --target=0,0,90", [640, 480]),
    ] {
        for name in ["a.svg", "a.PDF"] {
            folder.run(&format!("draw {options} -o {name}")).good();
        }
        let svg = Svg::read(&folder.path("a.svg"));
        let operators = page(&fs::read(folder.path("a.PDF")).unwrap(), size);
        let (painted, counts) = as_svg(&operators, size);
        // The background is a fill too.
        assert_eq!(counts, [svg.paths.len() + 1, svg.lines.len()], "{options}");
        folder.write("b.svg", &painted);
        let [found, expected] = [Svg::parse(&painted), svg].map(|svg| svg.smooth_picture());
        assert_eq!(found.size, expected.size);
        let differs = |(a, b): (&u8, &u8)| a.abs_diff(*b) > 2;
        let wrong = found.rgb.iter().zip(&expected.rgb).filter(|&pair| differs(pair)).count();
        // Floats of a viewer round coordinates that are turned upside down in other ways.
        assert!(2_000 * wrong <= found.rgb.len(), "{options}: {wrong} of {}", found.rgb.len());
        strokes += counts[1];
    }
    assert!(strokes > 8, "{strokes}");
}

#[test]
fn pdfs_go_to_standard_output_and_are_written_completely_or_not_at_all() {
    let folder = Folder::new("pdf_output");
    folder.write("s.obj", CROSSING);
    folder.run("draw s.obj -o a.pdf --json").good();
    let kept = fs::read(folder.path("a.pdf")).unwrap();
    assert!(folder.pipe("draw - -o - --format pdf", CROSSING).stdout == kept);
    folder.run("draw s.obj -o a.pdf --eye=0,0,1e300").refused();
    folder.run("draw s.obj -o a.pdf --size 20000x10").refused();
    assert!(fs::read(folder.path("a.pdf")).unwrap() == kept);
    assert_eq!(folder.files(), ["a.pdf", "s.obj"]);
}
