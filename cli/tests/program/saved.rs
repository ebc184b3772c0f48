//! Trees in files: written by `build`, and taken by the other commands in place of a scene.

use std::fs;

use serde_json::Value;

use crate::run::{CROSSING, Folder, Run};

/// A scene with colours, a face without area, one that is not convex and one that is not planar.
const ODD: &str = "mtllib m.mtl\nusemtl red\n\
    v 0 0 0\nv 4 4 0\nv 0 2 0\nv -4 4 0\nf 1 2 3 4\nusemtl blue\n\
    v 0 0 1\nv 1 0 1.5\nv 1 1 1\nv 0 1 1.5\nf 5 6 7 8\nf 1 1 2\n\
    v 0.25 1 -1\nv 0.25 3 2\nv 1 1 2\nf 9 10 11\n";

fn odd(test: &str) -> Folder {
    let folder = Folder::new(test);
    folder.write("m.mtl", "newmtl red\nKd 1 0 0\nnewmtl blue\nKd 0 0 1\nd 0.5\n");
    folder.write("s.obj", ODD);
    folder
}

#[test]
fn every_command_says_the_same_of_a_scene_and_of_its_tree_s_file() {
    let folder = odd("saved_same");
    folder.run("build s.obj -o s.bsp").good();
    folder.run("build s.bsp -o again.bsp").good();
    let read = |name: &str| fs::read(folder.path(name)).unwrap();
    assert_eq!(read("s.bsp"), read("again.bsp"));
    for command in [
        "order SCENE --eye=3,2,6 --edges --weights",
        "order SCENE --eye=3,2,6 --eye=-1,2,2 --front-to-back --cull back",
        "order SCENE --direction=0,0,-1",
        "verify SCENE --views 4 --size 40x30",
        "draw SCENE -o - --up z --opaque --ids",
    ] {
        let command = &format!("{command} --notes");
        let scene = folder.run(&command.replace("SCENE", "s.obj"));
        let file = folder.run(&command.replace("SCENE", "s.bsp"));
        // The tolerance of an existing tree was chosen before.
        let notes = |text: &str| -> Vec<String> {
            text.lines().filter(|line| !line.contains("tolerance")).map(str::to_owned).collect()
        };
        // Each has the user's name for it.
        let renamed = |text: &str| text.replace("s.bsp", "s.obj");
        assert_eq!(notes(&renamed(&file.err)), notes(&scene.err), "{command}");
        assert!(!file.err.contains("s.obj"), "{}", file.err);
        assert!(scene.err.contains("(line 14)") || !command.contains("order"), "{}", scene.err);
        assert_eq!(renamed(&file.good()), scene.good(), "{command}");
        let piped = folder.pipe(&command.replace("SCENE", "-"), read("s.bsp"));
        let file = folder.run(&command.replace("SCENE", "s.bsp")).good();
        assert_eq!(Run::new(&piped).good(), file.replace("s.bsp", "standard input"));
    }
    for name in ["s.obj", "s.bsp"] {
        folder.run(&format!("render {name} -o {name}.png --size 60x40 --samples 2")).good();
    }
    assert_eq!(read("s.obj.png"), read("s.bsp.png"));
}

#[test]
fn stats_tell_of_a_tree_from_a_file() {
    let folder = odd("saved_stats");
    folder.run("build s.obj -o s.bsp --heuristic fewest-splits --tolerance 0").good();
    let figures = |command: &str| -> Value {
        let out = folder.run(command).good();
        serde_json::from_str(&out).unwrap_or_else(|_| panic!("one line: {out}"))
    };
    let mut built = figures("stats s.obj --json --heuristic fewest-splits --tolerance 0");
    let mut read = figures("stats s.bsp --json");
    assert_eq!(read["heuristic"], Value::Null);
    assert!(read["build_seconds"].as_f64().unwrap() > 0.0);
    for figures in [&mut built, &mut read] {
        for key in ["heuristic", "build_seconds", "order_ns_per_fragment"] {
            figures.as_object_mut().unwrap().remove(key);
        }
    }
    assert_eq!(built, read);
    let table = folder.run("stats s.bsp").good();
    assert!(
        table.contains("from a file") && table.lines().all(|line| line.chars().count() <= 80),
        "{table}"
    );
}

#[test]
fn a_tree_that_is_built_is_not_built_in_another_way() {
    let folder = odd("saved_options");
    folder.run("build s.obj -o s.bsp").good();
    for command in [
        "order s.bsp --eye=1,2,3 --heuristic first",
        "verify s.bsp --tolerance 0",
        "stats s.bsp --heuristic all",
        "render s.bsp -o a.png --max-fragments 5",
        "draw s.bsp -o a.svg --heuristic first",
        "build s.bsp -o b.bsp --tolerance 1",
        // The defaults, too.
        "stats s.bsp --heuristic auto",
        "order s.bsp --eye=1,2,3 --heuristic auto",
        "verify s.bsp --max-fragments 33554432",
    ] {
        let message = folder.run(command).refused();
        assert!(message.contains("s.bsp: it contains a finished tree"), "{command}: {message}");
    }
    assert_eq!(folder.files(), ["m.mtl", "s.bsp", "s.obj"]);
}

#[test]
fn messages_name_the_file_that_was_given_and_a_file_tells_no_folders() {
    let folder = odd("saved_names");
    let whole = folder.path("s.obj");
    let built = folder.command("build").arg(&whole).args(["-o", "first.bsp"]).output().unwrap();
    Run::new(&built).good();
    fs::rename(folder.path("first.bsp"), folder.path("renamed.bsp")).unwrap();
    let file = fs::read(folder.path("renamed.bsp")).unwrap();
    let has = |text: &str| file.windows(text.len()).any(|bytes| bytes == text.as_bytes());
    let name = folder.path("").file_name().unwrap().to_str().unwrap().to_owned();
    assert!(has("s.obj") && !has(&name), "{name}");

    let refused = folder.run("stats --heuristic all renamed.bsp").refused();
    let order = folder.run("order renamed.bsp --eye=3,2,6").err;
    let stats = folder.run("stats renamed.bsp").good();
    for text in [refused, order, stats] {
        assert!(text.contains("renamed.bsp: ") && !text.contains("s.obj"), "{text}");
    }
    let piped = Run::new(&folder.pipe("stats -", &file)).good();
    assert!(piped.contains("standard input: "), "{piped}");
    // Passed on, it keeps the scene's name.
    folder.run("build ./renamed.bsp -o again.bsp").good();
    assert_eq!(fs::read(folder.path("again.bsp")).unwrap(), file);
}

#[test]
fn a_file_of_a_tree_is_written_completely_or_not_at_all() {
    let folder = Folder::new("saved_whole");
    folder.write("s.obj", CROSSING);
    folder.write("bad.obj", "v 0 0 nan\nf 1 1 1\n");
    folder.write("flat.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n");
    folder.run("build s.obj -o s.bsp").good();
    let kept = fs::read(folder.path("s.bsp")).unwrap();
    for scene in ["bad.obj", "missing.obj", "flat.obj", "random --max-fragments 10"] {
        folder.run(&format!("build {scene} -o s.bsp")).refused();
        assert_eq!(fs::read(folder.path("s.bsp")).unwrap(), kept);
    }
    assert_eq!(folder.files(), ["bad.obj", "flat.obj", "s.bsp", "s.obj"]);
    assert_eq!(folder.pipe("build s.obj -o -", "").stdout, kept);
    assert_eq!(folder.pipe("build - -o -", &kept).stdout, kept);
    // Under another name as well, by how it begins.
    fs::copy(folder.path("s.bsp"), folder.path("tree")).unwrap();
    assert!(folder.run("order ./tree --eye=3,2,6").good().lines().count() > 3);
}

#[test]
fn files_that_are_not_right_are_refused_by_name() {
    let folder = Folder::new("saved_bad");
    folder.write("s.obj", CROSSING);
    folder.run("build s.obj -o s.bsp").good();
    folder.run("build newell -o newell.bsp").good();
    let read = |name: &str| fs::read(folder.path(name)).unwrap();
    let (file, other) = (read("s.bsp"), read("newell.bsp"));
    let scene_at = |file: &[u8]| {
        file.windows(12).position(|bytes| bytes == b"binspacescen").expect("the scene")
    };
    let (at, other_at) = (scene_at(&file), scene_at(&other));
    let with = |at: usize, bit: u8| {
        let mut file = file.clone();
        file[at] ^= bit;
        file
    };
    for (content, problem) in [
        (file[..at - 9].to_vec(), "truncated"),
        (file[..at].to_vec(), "in the scene after the tree"),
        (file[..file.len() - 1].to_vec(), "truncated"),
        (with(at / 2, 1), "damaged"),
        (with(file.len() - 30, 4), "damaged"),
        (with(12, 1), "version 3"),
        ([&file[..], b"more"].concat(), "data after the end of the scene"),
        ([&file[..at], &other[other_at..]].concat(), "belongs to another scene"),
        (CROSSING.as_bytes().to_vec(), "not a binspace file"),
        (Vec::new(), "truncated"),
    ] {
        folder.write("bad.bsp", &content);
        let message = folder.run("order bad.bsp --eye=1,2,3").refused();
        assert!(message.contains("bad.bsp") && message.contains(problem), "{problem}: {message}");
    }
    assert!(folder.run("stats missing.bsp").refused().contains("missing.bsp: cannot be read"));
}
