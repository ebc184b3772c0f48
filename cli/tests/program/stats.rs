use serde_json::Value;

use crate::run::{CROSSING, Folder};

#[test]
fn json_has_a_line_for_each_heuristic() {
    let folder = Folder::new("stats_json");
    folder.write("s.obj", CROSSING);
    let out = folder.run("stats s.obj --heuristic all --json").good();
    let lines: Vec<Value> = out.lines().map(|line| serde_json::from_str(line).unwrap()).collect();
    assert_eq!(lines.len(), 8);
    for line in &lines {
        let number = |key: &str| line[key].as_f64().unwrap_or_else(|| panic!("{key}: {line}"));
        assert!(line["heuristic"].is_string());
        assert_eq!(number("polygons"), 3.0);
        assert_eq!(number("faces"), 3.0);
        assert_eq!(number("fragments"), number("faces") + number("splits"));
        assert!(number("depth_mean") <= number("depth_max"));
        assert!(number("nodes") >= 1.0 && number("bytes") > 0.0);
        assert!(number("build_seconds") > 0.0 && number("order_ns_per_fragment") > 0.0);
        assert_eq!((number("dropped"), number("triangulated")), (0.0, 0.0));
    }
    let one = folder.run("stats s.obj --json").good();
    assert_eq!(serde_json::from_str::<Value>(&one).unwrap()["heuristic"], "auto");
}

#[test]
fn the_table_is_aligned_and_narrow() {
    let folder = Folder::new("stats_table");
    let out = folder.run("stats random:100 --heuristic all").good();
    let widths: Vec<usize> = out.lines().skip(1).map(|line| line.chars().count()).collect();
    assert_eq!(widths.len(), 9, "{out}");
    assert!(widths.iter().all(|&width| width == widths[0] && width <= 80), "{out}");
    assert!(out.starts_with("random:100: 100 polygons, 100 faces; 0 dropped"), "{out}");
    assert!(!out.contains('\u{1b}'), "colours are for terminals");
    // Only names that do not fit are cut.
    assert!(out.contains("fewest-splits") && !out.contains('…'), "{out}");
    let out = folder.run("stats random:10 --heuristic weighted(12.5,1.25,0.125)").good();
    assert!(out.lines().all(|line| line.chars().count() <= 80), "{out}");
    assert!(out.contains("weighted(12.…"), "{out}");
}

#[test]
fn what_is_dropped_and_triangulated_is_counted() {
    let folder = Folder::new("stats_counts");
    // A triangle without area, a bent quad, an arrowhead.
    folder.write(
        "s.obj",
        "v 0 0 0\nv 1 0 0\nv 2 0 0\nv 1 1 1\nv 0 1 0\nv 0.2 0.2 0\n\
         f 1 2 3\nf 1 2 4 5\nf 1 3 6 5\n",
    );
    let out = folder.run("stats s.obj --json").good();
    let line: Value = serde_json::from_str(&out).unwrap();
    let found = ["polygons", "dropped", "triangulated", "faces"].map(|key| line[key].as_u64());
    assert_eq!(found, [3, 1, 2, 4].map(Some), "{line}");
}

#[test]
fn a_heuristic_over_budget_does_not_stop_the_others() {
    let folder = Folder::new("stats_budget");
    let figures = |options: &str| folder.run(&format!("stats random:100 {options} --json"));
    let fragments =
        |line: &str| serde_json::from_str::<Value>(line).unwrap()["fragments"].as_u64().unwrap();
    let all = figures("--heuristic all").good();
    let least = all.lines().map(fragments).min().unwrap();
    let run = figures(&format!("--heuristic all --max-fragments {least}"));
    assert_eq!(run.status, Some(2));
    assert!(run.out.lines().count() >= 1 && run.out.lines().count() < 8, "{run:?}");
    let over = 8 - run.out.lines().count();
    let notes = run.err.matches(&format!("more than {least} fragments")).count();
    assert_eq!(notes, over, "{run:?}");
    assert!(run.err.contains(&format!("error: random:100: {over} tree")), "{run:?}");
}

/// Ten quads in one tilted plane, to some decimals.
fn rounded_quads(places: usize) -> String {
    let mut text = String::new();
    for i in 0..10 {
        let turn = f64::from(i);
        for angle in [0.0, 1.3, 2.9, 4.4] {
            let (sin, cos) = (turn + angle).sin_cos();
            let (x, y) = (cos + 0.1 * turn, sin);
            let z = (x + 2.0 * y) / 3.0;
            text += &format!("v {x:.places$} {y:.places$} {z:.places$}\n");
        }
        let first = 4 * i + 1;
        text += &format!("f {first} {} {} {}\n", first + 1, first + 2, first + 3);
    }
    text
}

#[test]
fn the_decimals_of_a_file_decide_the_tolerance_unless_one_is_given() {
    let folder = Folder::new("stats_tolerance");
    folder.write("s.obj", rounded_quads(6));
    let run = |options: &str| {
        let run = folder.run(&format!("stats s.obj --json --notes {options}"));
        let notes = run.err.clone();
        (serde_json::from_str::<Value>(&run.good()).unwrap(), notes)
    };
    let (line, notes) = run("");
    let said = "s.obj: coordinates are precise to 1e-6, so the tolerance is 4e-6; `--tolerance`";
    assert!(notes.contains(said), "{notes}");
    let tolerance = line["tolerance"].as_f64().unwrap();
    assert!((tolerance - 4e-6).abs() < 1e-15, "{line}");
    assert!(line["flattened"].as_u64() >= Some(6), "{line}");

    let (line, notes) = run("--tolerance 0");
    assert!(!notes.contains("precise to"), "{notes}");
    assert!(notes.contains("with four or more corners are non-planar by at most"), "{notes}");
    assert_eq!((line["tolerance"].as_f64(), line["flattened"].as_u64()), (Some(0.0), Some(0)));
    let bent_by = line["bent_by"].as_f64().unwrap();
    assert!(line["bent"].as_u64() >= Some(6) && bent_by > 0.0 && bent_by < 2e-6, "{line}");
}

/// Where a unit in the last decimal is far more than 1e-5 of the extent, so that the default
/// tolerance is too small for most quads.
#[test]
fn quads_that_a_coarse_rounding_bends_are_noted_with_a_tolerance_that_helps() {
    let folder = Folder::new("stats_coarse");
    for places in [2, 3] {
        folder.write("s.obj", rounded_quads(places));
        let run = folder.run("stats s.obj --json --notes");
        let notes = run.err.clone();
        let line: Value = serde_json::from_str(&run.good()).unwrap();
        let (bent, bent_by) = (line["bent"].as_u64().unwrap(), line["bent_by"].as_f64().unwrap());
        let unit = 10f64.powi(-(places as i32));
        assert!(bent >= 6 && bent_by < 2.0 * unit, "{places}: {line}");
        let said =
            format!("{bent} of 10 faces with four or more corners are non-planar by at most");
        assert!(notes.contains(&said), "{places}: {notes}");
        let tolerance = notes.split('`').find(|part| part.starts_with("--tolerance")).unwrap();
        let run = folder.run(&format!("stats s.obj --json {tolerance}"));
        assert!(!run.err.contains("are non-planar"), "{places}: {}", run.err);
        let line: Value = serde_json::from_str(&run.good()).unwrap();
        assert_eq!((line["bent"].as_u64(), line["triangulated"].as_u64()), (Some(0), Some(0)));
    }
}

/// Quads that are non-planar on purpose are no rounding's.
#[test]
fn quads_that_are_bent_by_more_than_a_rounding_are_not_noted() {
    let folder = Folder::new("stats_saddle");
    folder.write("s.obj", "v 0 0 0.00\nv 1 0 0.25\nv 1 1 0\nv 0 1 0.25\nf 1 2 3 4\n");
    let run = folder.run("stats s.obj --json");
    assert!(!run.err.contains("are non-planar"), "{}", run.err);
    let line: Value = serde_json::from_str(&run.good()).unwrap();
    assert_eq!((line["bent"].as_u64(), line["triangulated"].as_u64()), (Some(0), Some(1)));
}
