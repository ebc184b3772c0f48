use std::collections::HashMap;
use std::fs;

use crate::run::{CROSSING, Folder, Run};

/// The rows of a CSV file as maps from column to cell.
fn rows(folder: &Folder, name: &str) -> Vec<HashMap<String, String>> {
    let mut reader = csv::Reader::from_path(folder.path(name)).unwrap();
    reader.deserialize().map(Result::unwrap).collect()
}

#[test]
fn the_exact_rows_are_zero_and_others_are_not() {
    let folder = Folder::new("report");
    folder.write("scene.obj", CROSSING);
    let run = folder.run(
        "report --quick --size 64x48 --family angle --family boxes --family cycle -o out/new \
         scene.obj",
    );
    let out = run.good();
    assert!(out.contains("angle") && out.contains("exact: nothing wrong"), "{out}");
    assert!(out.contains("0 of 15 trials") || out.contains("0 of 13 trials"), "{out}");
    let rows = rows(&folder, "out/new/errors.csv");
    let exact: Vec<_> = rows.iter().filter(|row| row["method"] == "bsp exact").collect();
    assert_eq!(exact.len(), 6 + 3 + 3 + 1);
    for row in &exact {
        assert_ne!(row["covered"], "0", "{row:?}");
        for column in
            ["wrong", "wrong_order", "holes", "spills", "misplaced_vertices", "torn_faces"]
        {
            assert_eq!(row[column], "0", "{column} of {row:?}");
        }
        assert!(row["drift_max_ulps"].parse::<f64>().unwrap() < 1.0, "{row:?}");
    }
    let wrong = |method: &str| {
        let cells = rows.iter().filter(|row| row["method"] == method).map(|row| &row["wrong"]);
        cells.map(|cell| cell.parse::<usize>().unwrap()).sum::<usize>()
    };
    for method in ["bsp f64 1e-6", "bsp f32 1e-4", "newell", "centroid", "z 16", "z 24"] {
        assert!(wrong(method) > 0, "{method} is never wrong");
    }
    for row in &rows {
        let removed: f64 = row["removed_share"].parse().unwrap();
        let has_step = row["method"].starts_with("fronts");
        // About a half of the faces of closed boxes are removed. Other scenes may show only fronts.
        let is_known = row["subject"] != "boxes" || (0.3..0.7).contains(&removed);
        assert!(if has_step { is_known && removed < 1.0 } else { removed == 0.0 }, "{row:?}");
    }
    let text = fs::read_to_string(folder.path("out/new/report.md")).unwrap();
    assert!(!text.contains("Not complete"), "{text}");
    // Cells without padding.
    let text = text.split(' ').filter(|word| !word.is_empty()).collect::<Vec<_>>().join(" ");
    for part in [
        "| bsp exact | 0 | 0 | 0 | 0 |",
        "### boxes",
        "## scene.obj",
        "speed.svg",
        "removed by back faces",
    ] {
        assert!(text.contains(part), "{part}");
    }
    for plot in ["speed", "error-angle", "error-boxes", "error-cycle"] {
        let svg = fs::read_to_string(folder.path(&format!("out/new/{plot}.svg"))).unwrap();
        assert!(svg.starts_with("<svg") && svg.contains("bsp exact"), "{plot}");
    }
}

#[test]
fn a_seed_gives_the_same_errors_again() {
    let folder = Folder::new("report_seed");
    let errors = |seed: u32, name: &str| {
        let run = format!("report --quick --size 16x12 --family offset --seed {seed} -o {name}");
        folder.run(&run).good();
        fs::read_to_string(folder.path(&format!("{name}/errors.csv"))).unwrap()
    };
    let first = errors(3, "a");
    assert_eq!(first, errors(3, "b"));
    assert_ne!(first, errors(4, "c"));
}

#[test]
fn reports_that_cannot_be_written_are_refused_before_any_measurement() {
    let folder = Folder::new("report_refused");
    folder.write("file", "");
    assert!(folder.run("report --family angel").refused().contains("angle, gap"));
    assert!(folder.run("report nothing.obj -o out").refused().contains("nothing.obj"));
    assert!(folder.run("report --family gap -o file/x").refused().contains("cannot be created"));
    assert_eq!(folder.files(), ["file"]);
    // A folder of earlier files, one of which cannot be replaced.
    fs::create_dir_all(folder.path("out/speed.svg")).unwrap();
    folder.write("out/report.md", "earlier");
    let message = folder.run("report --quick --family gap -o out").refused();
    assert!(message.contains("out/speed.svg: cannot be written"), "{message}");
    assert_eq!(fs::read_to_string(folder.path("out/report.md")).unwrap(), "earlier");
    assert_eq!(fs::read_dir(folder.path("out")).unwrap().count(), 2);
}

#[cfg(target_os = "linux")]
#[test]
fn a_folder_in_which_nothing_can_be_made_is_refused_before_anything_is_measured() {
    let folder = Folder::new("report_proc");
    let message = folder.run("report -o /proc").refused();
    assert!(message.contains("/proc/report.md: cannot be written"), "{message}");
}

/// A report without a named family has all sections.
#[test]
#[ignore = "takes a quarter of a minute"]
fn culling_and_growth_follow_the_families() {
    let folder = Folder::new("report_all");
    folder.write("scene.obj", CROSSING);
    folder.run("report --quick --size 64x48 -o out scene.obj").good();
    let text = fs::read_to_string(folder.path("out/report.md")).unwrap();
    let (_, culling) = text.split_once("## Culling").unwrap();
    let step = culling.lines().find(|line| line.starts_with("| and hidden")).unwrap();
    assert!(step.ends_with(" 0 |"), "{step}");
    let (_, growth) = culling.split_once("## Growth").unwrap();
    assert!(growth.contains("noisy sphere"));
    assert!(rows(&folder, "out/growth.csv").len() > 30);
}

#[test]
fn scenes_come_from_standard_input_and_from_trees_too() {
    let folder = Folder::new("report_input");
    let run = |command: &str| Run::new(&folder.pipe(command, CROSSING));
    run("report - --quick --family cycle --size 8x6 -o r").good();
    let report = fs::read_to_string(folder.path("r/report.md")).unwrap();
    assert!(report.contains("standard input"), "{report}");
    for (command, problem) in [
        ("report - - -o s", "standard input: it can be read only once"),
        ("report -o -", "standard output: several files cannot go there"),
    ] {
        assert!(run(command).refused().contains(problem), "{command}");
    }
    assert_eq!(folder.files(), ["r"]);
}

#[test]
fn a_scene_without_area_is_refused() {
    let folder = Folder::new("report_empty");
    folder.write("s.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n");
    let message = folder.run("report --family gap s.obj -o out").refused();
    assert!(message.contains("s.obj: nothing to draw"), "{message}");
    assert!(message.contains("1 face without area dropped: face 0 (line 4)"), "{message}");
    assert_eq!(folder.files(), ["s.obj"]);
}

/// With standard output full, the exit status and the message report it.
#[cfg(target_os = "linux")]
#[test]
fn output_that_cannot_be_written_is_an_error() {
    let folder = Folder::new("report_full");
    let full = fs::OpenOptions::new().write(true).open("/dev/full").unwrap();
    let output =
        folder.command("report --quick --family gap --size 8x6").stdout(full).output().unwrap();
    let message = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(2), "{message}");
    assert!(message.contains("error: standard output: No space left"), "{message}");
}

#[test]
fn help_has_examples_and_fits() {
    let folder = Folder::new("help");
    for command in ["report", "lecture"] {
        let help = folder.run(&format!("{command} --help")).good();
        assert!(help.contains("Examples:\n  binspace-lab"), "{help}");
        assert!(help.lines().all(|line| line.chars().count() <= 100), "{help}");
    }
}
