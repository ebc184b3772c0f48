//! Lines of drawings, as a viewer shows them, against the exact picture of polygons.

use serde_json::Value;

use crate::draw::{View, WHITE, figures, views};
use crate::png_picture::Picture;
use crate::run::{CROSSING, Folder};
use crate::svg_picture::Svg;

/// Whether the exact picture has different polygons, or an uncertain edge, within some pixels of a pixel.
fn is_near_edge(truth: &[Option<Option<usize>>], size: [u32; 2], at: usize, reach: i64) -> bool {
    let [width, height] = size.map(i64::from);
    let (x, y) = (at as i64 % width, at as i64 / width);
    let mut around =
        (-reach..=reach).flat_map(|dy| (-reach..=reach).map(move |dx| (x + dx, y + dy)));
    around.any(|(x, y)| {
        // There may be edges beyond the picture's border.
        let is_inside = (0..width).contains(&x) && (0..height).contains(&y);
        let found = if is_inside { truth[(y * width + x) as usize] } else { None };
        found.is_none() || found != truth[at]
    })
}

fn pixel(picture: &Picture, at: usize) -> [u8; 3] {
    [0, 1, 2].map(|i| picture.rgb[3 * at + i])
}

fn drawn(folder: &Folder, view: &View, options: &str) -> (Value, Svg) {
    let command = format!("draw {} -o a.svg --json {options}", view.arguments());
    let figures = figures(&folder.run(&command).good());
    (figures, Svg::read(&folder.path("a.svg")))
}

/// Where there is ink there is an edge; where polygons meet there is ink.
#[test]
fn lines_lie_where_polygons_meet_in_the_exact_picture() {
    let folder = Folder::new("lines_exact");
    let (mut inked, mut stray, mut meeting, mut missing) = (0, 0, 0, 0);
    for view in views().into_iter().take(3) {
        let (_, svg) = drawn(&folder, &view, "--lines --edges all");
        assert!(svg.paths.is_empty());
        let picture = svg.smooth_picture();
        let truth = view.truth();
        for at in 0..truth.len() {
            let ink = 255 - pixel(&picture, at)[0];
            // A line a pixel wide puts this amount of ink only into pixels less than a pixel away.
            if ink > 60 {
                inked += 1;
                stray += usize::from(!is_near_edge(&truth, view.pixels, at, 1));
            }
            let [width, height] = view.pixels.map(|side| side as usize);
            let (x, y) = (at % width, at / width);
            let is_inside = x > 0 && y > 0 && x + 1 < width && y + 1 < height;
            if is_inside && is_near_edge(&truth, view.pixels, at, 1) {
                meeting += 1;
                let around = (0..9).map(|k| (y + k / 3 - 1) * width + x + k % 3 - 1);
                missing += usize::from(around.map(|at| pixel(&picture, at)[0]).min() > Some(150));
            }
        }
    }
    let counts = format!("{inked} {stray} {meeting} {missing}");
    assert!(inked > 2_500 && meeting > 2_500, "{counts}");
    // The exact picture may have no centre of polygons narrower than a pixel.
    assert!(500 * stray < inked && missing == 0, "{counts}");
}

#[test]
fn lines_over_fills_change_nothing_away_from_edges() {
    let folder = Folder::new("lines_fills");
    let (mut compared, mut wrong, mut changed) = (0, 0, 0);
    for view in views() {
        let truth = view.truth();
        let (plain_figures, plain) = drawn(&folder, &view, "");
        let (with_figures, with) = drawn(&folder, &view, "--edges all");
        assert_eq!(plain.paths, with.paths);
        assert!(plain.lines.is_empty() && plain_figures["runs"] == 0, "{plain_figures}");
        assert!(with_figures["runs"].as_u64() >= with_figures["lines"].as_u64());
        let [plain, with] = [plain, with].map(|svg| svg.smooth_picture());
        for at in (0..truth.len()).filter(|&at| !is_near_edge(&truth, view.pixels, at, 2)) {
            wrong += usize::from(pixel(&plain, at) != pixel(&with, at));
            compared += 1;
        }
        changed += usize::from(plain != with);
    }
    assert!(compared > 50_000 && changed == 6, "{compared} {changed}");
    // On polygons that are seen almost edge-on, which the exact picture's samples miss, there are lines.
    assert!(2_000 * wrong < compared, "{wrong} of {compared}");
}

/// The numbers of a path's data that is one step: its start and its offset.
fn step(data: &str, units: f64) -> [f64; 4] {
    let text = data.trim_matches(['m', 'z']).replace('-', " -");
    let numbers: Vec<f64> = text.split_whitespace().map(|n| n.parse().unwrap()).collect();
    let numbers: [f64; 4] = numbers.try_into().unwrap_or_else(|_| panic!("{data}"));
    numbers.map(|c| c / units)
}

#[test]
fn hidden_parts_are_dashed_below_what_is_visible_and_lie_behind_something() {
    let folder = Folder::new("lines_hidden");
    let (mut hidden, mut total, mut crossings) = (0, 0, [0; 2]);
    for view in views().into_iter().take(5) {
        let (figures, svg) = drawn(&folder, &view, "--lines --edges all --hidden dashed --ids");
        assert_eq!(figures["runs"], svg.lines.len(), "{figures}");
        let is_hidden: Vec<bool> =
            svg.lines.iter().map(|line| line.classes[0] == "hidden").collect();
        assert!(is_hidden.is_sorted_by(|a, b| a >= b), "hidden lines come first");
        assert!(svg.text.contains("stroke-dasharray") && svg.text.contains("class=\"visible\""));
        let (truth, corners) = (view.truth(), view.corners());
        let [width, height] = view.pixels.map(f64::from);
        for (line, &is_hidden) in svg.lines.iter().zip(&is_hidden) {
            match line.crossing {
                Some([polygon, other]) => {
                    assert!(polygon < other && line.edge.is_none(), "{line:?}");
                    assert_eq!(line.classes[1], "crossing");
                    crossings[usize::from(is_hidden)] += 1;
                }
                None => {
                    let kind = &*line.classes[1];
                    match line.edge {
                        Some([polygon, edge]) => assert!(edge < corners[polygon]),
                        // Where a polygon that is not planar turns away.
                        None => assert_eq!(kind, "silhouette"),
                    }
                    assert!(["border", "crease", "silhouette"].contains(&kind));
                }
            }
            // Pictures of less than 480 pixels have five hundred units a pixel.
            let [x, y, dx, dy] = step(&line.data, 500.0);
            let middle = [x + 0.5 * dx, y + 0.5 * dy].map(f64::floor);
            if !is_hidden || middle[0] >= width || middle[1] >= height {
                continue;
            }
            let at = (middle[1] * width + middle[0]) as usize;
            let is_hiding = truth[at] != Some(None) || is_near_edge(&truth, view.pixels, at, 1);
            assert!(is_hiding, "{}: {line:?}: nothing hides it", view.arguments());
            hidden += 1;
        }
        total += svg.lines.len();
        // Without names: the same lines, joined.
        let (joined, joined_svg) = drawn(&folder, &view, "--lines --edges all --hidden dashed");
        assert_eq!(joined["runs"], figures["runs"]);
        let begun =
            joined_svg.lines.iter().map(|path| path.data.matches('m').count()).sum::<usize>();
        assert_eq!(joined["lines"], begun);
        // Among random triangles, seven in ten lines join no other.
        assert!(joined_svg.lines.len() <= 8 && 4 * begun < 3 * svg.lines.len().max(30));
        assert!(joined["bytes"].as_u64() < figures["bytes"].as_u64());
        // A drawing of visible lines alone has no dashes.
        let (_, visible) = drawn(&folder, &view, "--lines --edges all --hidden none");
        assert!(!visible.text.contains("dash") && !visible.text.contains("hidden"));
    }
    let counts = format!("{hidden} {total} {crossings:?}");
    assert!(hidden > 1_000 && total > 3_000, "{counts}");
    assert!(crossings[0] > 50 && crossings[1] > 50, "{counts}");
}

#[test]
fn edges_are_chosen_by_kind_and_angle() {
    let folder = Folder::new("lines_kinds");
    let camera = "--eye=9,7,8 --target=0,0,0 --up z";
    // A cube, and a wall behind it.
    let mut text = String::new();
    for k in 0..8 {
        text += &format!("v {} {} {}\n", k & 1, k >> 1 & 1, k >> 2);
    }
    text += "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n";
    text += "v -3 -3 -1\nv 3 -3 -1\nv 3 3 -1\nv -3 3 -1\nf 9 10 11 12\n";
    folder.write("s.obj", text);
    let classes = |options: &str| {
        let command = format!("draw s.obj {camera} -o a.svg --ids --lines {options}");
        folder.run(&command).good();
        let svg = Svg::read(&folder.path("a.svg"));
        let count = |class: &str| svg.lines.iter().filter(|line| line.classes[1] == class).count();
        ["border", "silhouette", "crease"].map(count)
    };
    // The cube cuts two edges of the border, and hides their corner.
    assert_eq!(classes(""), [4, 6, 3]);
    assert_eq!(classes("--edges all"), [4, 6, 3]);
    assert_eq!(classes("--edges creases=90"), [4, 6, 3]);
    assert_eq!(classes("--edges creases=90.001"), [4, 6, 0]);
    assert_eq!(classes("--edges silhouettes"), [4, 6, 0]);
    assert_eq!(classes("--hidden dashed")[2], 6);
    // Lines as long as the picture are the least that is drawn.
    assert_eq!(classes("--min-size 5000"), [0; 3]);
}

#[test]
fn line_drawings_go_to_standard_output_and_show_nothing_of_nothing() {
    let folder = Folder::new("lines_output");
    folder.write("s.obj", CROSSING);
    folder.run("draw s.obj --lines --hidden dashed -o a.svg").good();
    let piped = folder.run("draw s.obj --lines --hidden dashed -o -").good();
    assert_eq!(std::fs::read_to_string(folder.path("a.svg")).unwrap(), piped);
    folder.run("draw s.obj --lines --eye=0,0,50 --target=0,0,90 -o a.svg").good();
    let nothing = Svg::read(&folder.path("a.svg"));
    assert!(nothing.lines.is_empty() && nothing.picture().count(WHITE) == 640 * 480);
}
