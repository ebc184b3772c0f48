//! Folders of `build --cells`: the same pictures and polygons as of one tree.

use std::collections::BTreeMap;
use std::fmt::Write;
use std::fs;

use serde_json::Value;

use crate::run::{CROSSING, Folder};

/// Panes that go through each other, every third one translucent, one that is not convex, and a face
/// without area.
fn panes(folder: &Folder) {
    folder.write("m.mtl", "newmtl wall\nKd 0.8 0.5 0.2\nnewmtl glass\nKd 0.1 0.4 0.9\nd 0.5\n");
    let mut text = "mtllib m.mtl\n".to_owned();
    for k in 0..60 {
        let (x, y) = (f64::from(k % 8), f64::from(k / 8));
        let lean = f64::from(k % 5) - 2.0;
        writeln!(text, "usemtl {}", if k % 3 == 0 { "glass" } else { "wall" }).unwrap();
        for [u, v] in [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]] {
            writeln!(text, "v {} {} {}", x + u * 1.25, y + v * 1.5, lean * u + 0.25 * v).unwrap();
        }
        writeln!(text, "f -4 -3 -2 -1").unwrap();
    }
    text += "usemtl wall\nv 0 0 3\nv 8 0 3\nv 4 2 3\nv 4 8 3\nf -4 -3 -2 -1\nf 1 1 2\n";
    folder.write("s.obj", text);
}

#[test]
fn pictures_of_cells_are_those_of_one_tree() {
    let folder = Folder::new("cells_pictures");
    panes(&folder);
    folder.run("build s.obj -o s.bsp").good();
    let views = [
        "--eye=12,9,14 --target=4,4,0 --size 120x90",
        "--eye=4,4,0.1 --target=0,0,0 --size 80x60 --cull back",
        "--direction=1,0.5,-2 --target=4,4,0 --size 100x80 --samples 2 --colours polygon",
    ];
    for cells in [1, 2, 3, 7, 16] {
        let made = folder.run(&format!("build s.obj --cells {cells} -o d{cells} --notes"));
        assert!(made.err.contains("1 face without area"), "{}", made.err);
        assert_eq!(made.good(), "");
        assert_eq!(fs::read_dir(folder.path(&format!("d{cells}"))).unwrap().count(), cells + 1);
        for (k, view) in views.iter().enumerate() {
            let picture = |name: &str| {
                folder.run(&format!("render {name} -o p.png {view}")).good();
                fs::read(folder.path("p.png")).unwrap()
            };
            // With a parallel camera the scene's box decides the visible extent.
            let of_one = if k == 2 { picture("d1") } else { picture("s.bsp") };
            assert_eq!(picture(&format!("d{cells}")), of_one, "{cells} cells, {view}");
        }
    }
}

/// Each polygon's area, from the lines of `order`, and the numbers of the cells' trees.
#[test]
fn orders_of_cells_have_all_polygons() {
    let folder = Folder::new("cells_orders");
    panes(&folder);
    folder.run("build s.obj --cells 5 -o d").good();
    let areas = |command: &str| {
        let mut areas: BTreeMap<u64, f64> = BTreeMap::new();
        for line in folder.run(command).good().lines() {
            let line: Value = serde_json::from_str(line).unwrap();
            let at: Vec<Vec<f64>> = serde_json::from_value(line["vertices"].clone()).unwrap();
            let arm = |k: usize| [0, 1, 2].map(|i| at[k][i] - at[0][i]);
            let mut sum = [0.0; 3];
            for k in 1..at.len() - 1 {
                let (a, b) = (arm(k), arm(k + 1));
                for i in 0..3 {
                    sum[i] += a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3];
                }
            }
            let area = sum.iter().map(|c| c * c).sum::<f64>().sqrt();
            *areas.entry(line["polygon"].as_u64().unwrap()).or_default() += area;
        }
        areas
    };
    let whole = areas("order s.obj --eye=12,9,14");
    for command in ["order d --eye=12,9,14", "order d --direction=0,1,0 --front-to-back"] {
        let found = areas(command);
        assert!(found.keys().eq(whole.keys()) && found.len() == 61, "{command}");
        assert!(found.iter().all(|(k, area)| (area - whole[k]).abs() < 1e-9 * area), "{command}");
    }
    let forward = folder.run("order d --eye=12,9,14").good();
    let backward = folder.run("order d --eye=12,9,14 --front-to-back").good();
    assert!(forward.lines().eq(backward.lines().rev()));
    let stats = folder.run("stats d --json").good();
    let fragments = |line: &str| serde_json::from_str::<Value>(line).unwrap()["fragments"].clone();
    let total: u64 = stats.lines().map(|line| fragments(line).as_u64().unwrap()).sum();
    assert_eq!((stats.lines().count(), total), (5, forward.lines().count() as u64));
    let table = folder.run("stats d").good();
    assert!(table.contains("cell 4") && table.lines().all(|line| line.chars().count() <= 80));
}

#[test]
fn a_built_in_scene_is_divided_as_a_file_is() {
    let folder = Folder::new("cells_builtin");
    folder.run("build cornell --cells 4 -o d").good();
    folder.run("build cornell -o s.bsp").good();
    for name in ["d", "s.bsp"] {
        let view = "--eye=1,2,9 --target=0,1,0 --size 80x60";
        folder.run(&format!("render {name} -o {name}.png {view}")).good();
    }
    let read = |name: &str| fs::read(folder.path(name)).unwrap();
    assert_eq!(read("d.png"), read("s.bsp.png"));
}

#[test]
fn a_folder_is_written_completely_or_not_at_all() {
    let folder = Folder::new("cells_whole");
    folder.write("s.obj", CROSSING);
    folder.write("bad.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 1 2 7\n");
    folder.write("flat.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n");
    let files = ["bad.obj", "flat.obj", "s.obj"];
    for (command, problem) in [
        ("build bad.obj --cells 3 -o d", "vertex 7 does not exist"),
        ("build flat.obj --cells 3 -o d", "nothing to draw"),
        ("build missing.obj --cells 3 -o d", "missing.obj"),
        ("build random --cells 3 -o d --max-fragments 10", "--max-fragments"),
        ("build s.obj --cells 0 -o d", "0"),
        ("build s.obj --cells 2 -o -", "name a new one"),
        ("build s.obj --cells 2 -o s.obj", "cannot become a folder"),
        ("build - --cells 2 -o d", "name a file"),
    ] {
        let run = folder.run(command);
        assert!(run.status == Some(2) && run.err.contains(problem), "{command}: {}", run.err);
        assert_eq!(folder.files(), files, "{command}");
    }
    folder.run("build s.obj --cells 2 -o d").good();
    let message = folder.run("build s.obj --cells 3 -o d").refused();
    assert!(message.contains("this folder is not empty"), "{message}");
    // An empty folder becomes one.
    fs::create_dir(folder.path("empty")).unwrap();
    folder.run("build s.obj --cells 2 -o empty").good();
    folder.run("render empty -o p.png --size 20x20").good();
}

/// Every note of `build` on a scene is also written for its cells. Each polygon counts once, however many
/// cells it reaches.
#[test]
fn notes_on_cells_are_those_on_the_whole() {
    let folder = Folder::new("cells_notes");
    // A bow tie and a star right across the scene, quads that are non-planar, some of each given twice, turned
    // and reversed, and faces without area.
    let mut text = String::new();
    let mut face = |corners: &[[f64; 3]]| {
        let lines = corners.iter().map(|[x, y, z]| format!("v {x} {y} {z}\n"));
        let numbers = (1..=corners.len()).rev().map(|k| format!(" -{k}"));
        text += &format!("{}f{}\n", lines.collect::<String>(), numbers.collect::<String>());
    };
    let bow = [[0.0, 0.0, 1.0], [9.0, 9.0, 1.0], [9.0, 0.0, 1.0], [0.0, 9.0, 1.0]];
    let star = [[0.0, 0.0, 0.0], [9.0, 0.0, 0.5], [2.0, 2.0, 0.0], [0.0, 9.0, 0.5]];
    for k in 0..4 {
        let mut turned = [bow, star];
        turned.iter_mut().for_each(|corners| corners.rotate_left(k));
        turned[k % 2].reverse();
        turned.iter().for_each(|corners| face(corners));
    }
    for k in 0..40 {
        let [x, y] = [f64::from(k % 8), f64::from(k / 8)];
        face(&[[x, y, 2.0], [x + 1.0, y, 2.0], [x + 1.0, y + 1.0, 2.25], [x, y + 1.0, 2.0]]);
        if k % 10 == 3 {
            face(&[[x, y, 3.0], [x, y, 3.0], [9.0, y, 3.0]]);
        }
    }
    folder.write("s.obj", text);
    let notes = |command: &str| -> Vec<String> {
        let run = folder.run(command);
        assert_eq!(run.status, Some(0), "{run:?}");
        let notes = run.err.lines().filter(|line| line.contains("s.obj"));
        // A folder has no line numbers.
        let known = |part: &str| part.split_once(')').map_or("", |(_, rest)| rest).to_owned();
        notes
            .map(|note| {
                let mut parts = note.split(" (line ");
                let first = parts.next().unwrap_or_default().to_owned();
                parts.fold(first, |note, part| note + &known(part))
            })
            .collect()
    };
    let mut expected = notes("build s.obj -o s.bsp --notes");
    assert!(expected.len() >= 5, "{expected:?}");
    // Duplicates are counted within a tree, so cells do not report them.
    expected.retain(|note| !note.contains("duplicate face"));
    for cells in [1, 2, 3, 5, 9, 16] {
        let found = notes(&format!("build s.obj --cells {cells} -o d{cells} --notes"));
        assert_eq!(found, expected, "{cells} cells");
    }
}

/// Not after all the work.
#[test]
fn a_place_that_cannot_be_written_is_noticed_before_the_work() {
    let folder = Folder::new("cells_places");
    fs::create_dir(folder.path("empty")).unwrap();
    // Were the scene read first, its absence would be the error.
    let places = ["no/such/d", "/proc/d", "empty/..", "/"];
    for place in places {
        let message = folder.run(&format!("build missing.obj --cells 2 -o {place}")).refused();
        assert!(!message.contains("missing.obj"), "{place}: {message}");
    }
    #[cfg(target_os = "linux")]
    {
        let is_mounted = fs::read_to_string("/proc/mounts")
            .is_ok_and(|all| all.contains(" /dev/shm "))
            && fs::read_dir("/dev/shm").is_ok_and(|mut files| files.next().is_none());
        if is_mounted {
            let message = folder.run("build missing.obj --cells 2 -o /dev/shm").refused();
            // Other programs may write into it now.
            assert!(message.contains("mount point") || message.contains("empty"), "{message}");
        }
    }
    folder.write("s.obj", CROSSING);
    folder.run("build s.obj --cells 2 -o empty/.").good();
    folder.run("build s.obj --cells 2 -o new/").good();
    assert_eq!(folder.files(), ["empty", "new", "s.obj"]);
}

/// Eight cells are built with so little memory that two of them in one, as the cells of four, do not fit in.
#[cfg(target_os = "linux")]
#[test]
fn memory_is_that_of_one_cell() {
    /// In kB.
    const MEMORY: u32 = 11 << 10;
    let folder = Folder::new("cells_memory");
    let mut text = String::new();
    let side = 226;
    for k in 0..side * side {
        let (x, y) = (f64::from(k % side), f64::from(k / side));
        writeln!(text, "v {x} {y} {:.2}", (x * 0.31).sin() * (y * 0.17).cos() * 5.0).unwrap();
    }
    for k in (0..side * (side - 1)).filter(|k| (k + 1) % side != 0) {
        let (a, b) = (k + 1, k + 1 + side);
        writeln!(text, "f {a} {} {}\nf {a} {} {b}", a + 1, b + 1, b + 1).unwrap();
    }
    folder.write("s.obj", text);
    let builds = |cells: u32| {
        let program = env!("CARGO_BIN_EXE_binspace");
        let line =
            format!("ulimit -d {MEMORY}; exec {program} build s.obj --cells {cells} -o d{cells}");
        let mut command = std::process::Command::new("sh");
        command.args(["-c", &line]).current_dir(folder.path(""));
        // One list of free memory and one thread, so that the counted memory is the memory in use.
        let output = command.env("MALLOC_ARENA_MAX", "1").env("RAYON_NUM_THREADS", "1").output();
        let output = output.unwrap();
        let message = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success() || message.contains("memory"), "{message}");
        output.status.success()
    };
    // One cell of eight takes 8 to 9 MB, one of four 13 to 14.
    assert!(builds(8) && !builds(4));
}

#[test]
fn what_a_folder_is_not_for_is_refused() {
    let folder = Folder::new("cells_refused");
    folder.write("s.obj", CROSSING);
    folder.run("build s.obj --cells 3 -o d").good();
    fs::create_dir(folder.path("other")).unwrap();
    for command in [
        "verify d",
        "draw d -o a.svg",
        "page d -o a.html",
        "build d -o a.bsp",
        "build d --cells 2 -o e",
        "render d -o a.png --depth",
        "render d -o a.png --z-buffer",
        "render d -o a.png --tolerance 0",
        "order d --eye=1,2,3 --heuristic first",
        "stats d --heuristic all",
        "order other --eye=1,2,3",
        "order d/cell-0001.bsp --eye=1,2,3",
    ] {
        let message = folder.run(command).refused();
        assert!(!message.contains("os error 21"), "{command}: {message}");
    }
    assert!(folder.run("order d/cell-0001.bsp --eye=1,2,3").refused().contains("name the folder"));
    assert!(folder.run("verify d").refused().contains("render"));
    // Cells of another place, damaged or missing.
    let [first, cell] = ["d/cell-0000.bsp", "d/cell-0001.bsp"].map(|name| folder.path(name));
    let kept = fs::read(&first).unwrap();
    fs::copy(&cell, &first).unwrap();
    let message = folder.run("render d -o a.png").refused();
    assert!(message.contains("cell-0000.bsp: it does not belong to this folder"), "{message}");
    fs::write(&first, kept).unwrap();
    let file = fs::read(&cell).unwrap();
    fs::write(&cell, &file[..file.len() - 3]).unwrap();
    assert!(folder.run("render d -o a.png").refused().contains("cell-0001.bsp"));
    fs::remove_file(&cell).unwrap();
    assert!(folder.run("order d --eye=1,2,3 -o a.json").refused().contains("cell-0001.bsp"));
    assert_eq!(folder.files(), ["d", "other", "s.obj"]);
}
