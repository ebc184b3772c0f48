use std::fs;

use crate::run::{CROSSING, Folder};

#[test]
fn every_command_refuses_a_bad_file_with_its_name_line_and_face() {
    let folder = Folder::new("bad_files");
    let good = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
    let utf16: Vec<u8> = "v 0 0 0\nf 1 1 1\n".encode_utf16().flat_map(u16::to_be_bytes).collect();
    let files: [(&str, Vec<u8>, &str); 9] = [
        ("nan.obj", format!("{good}v 0 nan 0\nf 1 2 4\n").into(), "line 4: the coordinate \"nan\""),
        ("inf.obj", format!("v 0 -inf 0\n{good}f 1 2 3\n").into(), "line 1: the coordinate"),
        ("huge.obj", format!("v 0 1e999 0\n{good}f 1 2 3\n").into(), "line 1: the coordinate"),
        (
            "index.obj",
            format!("{good}f 1 2 3\nf 1 2 7\n").into(),
            "line 5, face 1 (from 0): vertex 7",
        ),
        ("none.obj", good.into(), "no faces"),
        ("empty.obj", Vec::new(), "an empty file"),
        ("word.obj", format!("{good}f 1 2 x\n").into(), "line 4, face 0 (from 0): \"x\""),
        ("utf16.obj", utf16, "wrong encoding"),
        ("binary.obj", vec![0, 159, 146, 150, 0, 7], "unknown kind of binary file"),
    ];
    fs::create_dir(folder.path("folder.obj")).unwrap();
    for (name, content, _) in &files {
        folder.write(name, content);
    }
    let others = [("missing.obj", "cannot be read"), ("folder.obj", "")];
    let all = files.iter().map(|(name, _, problem)| (*name, *problem)).chain(others);
    for (name, problem) in all {
        for command in [
            format!("order {name} --eye=0,0,1"),
            format!("verify {name}"),
            format!("stats {name} --heuristic all --json"),
            format!("render {name} -o out.png"),
            format!("draw {name} -o out.svg"),
        ] {
            let message = folder.run(&command).refused();
            assert!(message.contains(name) && message.contains(problem), "{command}: {message}");
        }
    }
    // Some commands take folders of cells.
    assert!(folder.run("verify folder.obj").refused().contains("this is a folder"));
    assert!(folder.run("stats folder.obj").refused().contains("cannot be read"));
    assert!(!folder.path("out.png").exists() && !folder.path("out.svg").exists());
}

#[test]
fn usage_errors_say_what_is_wrong() {
    let folder = Folder::new("bad_usage");
    folder.write("s.obj", CROSSING);
    for (command, problem) in [
        ("order s.obj", "--eye"),
        ("order s.obj --eye=1,2", "three numbers"),
        ("order s.obj --eye=1,2,3,4", "three numbers"),
        ("order s.obj --eye=1,2,nan", "not a finite number"),
        ("order s.obj --eye 1,2,-inf", "not a finite number"),
        ("order s.obj --eye=1,2,x", "not a number"),
        ("order s.obj --eye=", "three numbers"),
        ("order s.obj --direction=0,0,0", "must not be zero"),
        ("order s.obj --eye=1,2,3 --direction=1,2,3", "cannot be used with"),
        ("order s.obj --eye=1,2,3 --heuristic best", "fewest-splits"),
        (
            "order s.obj --eye=1,2,3 --heuristic sampled(0)",
            "invalid parameter in `sampled(0)`: expected a whole",
        ),
        ("order s.obj --eye=1,2,3 --tolerance -1", "0 or more"),
        ("order s.obj --eye=1,2,3 --tolerance=inf", "not a finite number"),
        ("order s.obj --eye=1,2,3 --max-fragments=-1", "invalid value"),
        ("order s.obj --eye=1,2,3 -o missing/x", "missing/x: cannot be written"),
        ("order --eye=1,2,3", "SCENE"),
        ("verify s.obj --views 0", "--views"),
        ("verify s.obj --size 0x5", "such as 640x480"),
        ("verify s.obj --size 99999x99999", "at most"),
        ("verify s.obj --up 0,0,0", "must not be zero"),
        ("verify s.obj --up w", "an axis"),
        ("stats s.obj --heuristic everything", "or use `all`"),
        ("render s.obj -o p.png --fov 180", "degrees"),
        ("stats teapto", "there is no file"),
        ("stats teapot:1", "from 2 to 790"),
        ("stats newell:5", "one size"),
        ("paint s.obj", "unrecognized subcommand"),
        ("--views 3", "unexpected argument"),
    ] {
        let message = folder.run(command).refused();
        assert!(message.contains(problem), "{command}: {message}");
    }
}

#[test]
fn over_budget_is_an_error_with_the_figure() {
    let folder = Folder::new("bad_budget");
    for command in ["order random --eye=1,2,3", "verify random", "stats random"] {
        let message = folder.run(&format!("{command} --max-fragments 600")).refused();
        assert!(message.contains("(`--max-fragments`)"), "{message}");
        assert!(message.contains("random:500: ") && message.contains("600 fragments"), "{message}");
    }
    folder.run("stats random:5 --max-fragments 0").refused();
}

#[test]
fn numbers_at_the_end_of_the_range_are_no_panic() {
    let folder = Folder::new("bad_extremes");
    let max = "1.7976931348623157e308";
    folder.write("max.obj", format!("v -{max} -{max} 0\nv {max} 0 0\nv 0 {max} {max}\nf 1 2 3\n"));
    folder.write("min.obj", "v 0 0 0\nv 5e-324 0 0\nv 0 5e-324 0\nf 1 2 3\n");
    folder.write("point.obj", "v 1 2 3\nv 1 2 3\nv 1 2 3\nf 1 2 3\n");
    folder.write("far.obj", "v 1e15 0 0\nv 1000000000000001 0 0\nv 1e15 1 0\nf 1 2 3\n");
    for scene in ["max.obj", "min.obj", "point.obj", "far.obj"] {
        for command in [
            format!("order {scene} --eye=1e308,-1e308,1e-308"),
            format!("order {scene} --direction=1e308,-1e308,1e-308"),
            format!("verify {scene} --size 40x30 --views 3"),
            format!("stats {scene} --json"),
            format!("render {scene} -o p.png --size 40x30"),
            format!("render {scene} -o p.png --size 1x1"),
            format!("draw {scene} -o p.svg --direction=1,2,3"),
            format!("render {scene} -o p.png --eye=1e300,0,0 --size 4x3"),
        ] {
            let run = folder.run(&command);
            assert!(matches!(run.status, Some(0 | 2)), "{command}: {run:?}");
            assert!(!run.err.contains("panicked"), "{command}: {run:?}");
        }
    }
}

#[test]
fn a_scene_too_large_for_a_camera_is_said_to_be_that() {
    let folder = Folder::new("bad_large");
    folder.write("s.obj", "v -1e308 -1e308 0\nv 1e308 0 0\nv 0 1e308 1e308\nf 1 2 3\n");
    for command in ["verify s.obj", "render s.obj -o p.png", "draw s.obj -o p.svg"] {
        let message = folder.run(command).refused();
        assert!(message.contains("too large for a camera") && message.contains("1.0e308"));
    }
}

/// Runs the program with at most this much memory, in kB.
#[cfg(target_os = "linux")]
fn run_within(kilobytes: u32, folder: &Folder, arguments: &str) -> (Option<i32>, String) {
    let program = env!("CARGO_BIN_EXE_binspace");
    let line = format!("ulimit -v {kilobytes}; exec {program} {arguments}");
    let mut command = std::process::Command::new("sh");
    // Threads need memory, as many threads as there are processors.
    command.env("RAYON_NUM_THREADS", "2").args(["-c", &line]);
    let output = command.current_dir(folder.path("")).output().unwrap();
    (output.status.code(), String::from_utf8_lossy(&output.stderr).into_owned())
}

#[cfg(target_os = "linux")]
#[test]
fn a_scene_that_memory_does_not_hold_is_refused_not_aborted() {
    let folder = Folder::new("bad_memory");
    for scene in ["random:20000000", "teapot:790", "chain:5000000"] {
        let (status, message) = run_within(2_000_000, &folder, &format!("stats {scene}"));
        assert_eq!(status, Some(2), "{message}");
        assert!(message.contains(&format!("error: {scene}: too little memory for ")), "{message}");
    }
    let huge = folder.run("stats random:99999999999").refused();
    assert!(huge.contains("from 1 to 20000000"), "{huge}");
}

#[cfg(target_os = "linux")]
#[test]
fn a_file_that_memory_does_not_hold_is_refused_not_aborted() {
    let folder = Folder::new("bad_memory_file");
    let vertices: String = (0..200_000).map(|i| format!("v {i}.25 -0.123456 {i}e-3\n")).collect();
    folder.write("vertices.obj", format!("{vertices}f 1 2 3\n"));
    // Many corners in few bytes.
    folder.write(
        "corners.obj",
        format!("v 0 0 0\nv 1 0 0\nv 0 1 0\n{}", "f 1 2 3\n".repeat(400_000)),
    );
    for name in ["vertices.obj", "corners.obj"] {
        for kilobytes in [20_000, 30_000, 40_000] {
            let command = format!("order {name} --eye=1,2,3 -o a.jsonl");
            let (status, message) = run_within(kilobytes, &folder, &command);
            assert_eq!(status, Some(2), "{name} {kilobytes}: {message}");
            assert!(message.contains("memory"), "{name} {kilobytes}: {message}");
        }
    }
    assert_eq!(folder.files(), ["corners.obj", "vertices.obj"]);
}

#[cfg(target_os = "linux")]
#[test]
fn a_tree_that_memory_does_not_hold_ends_the_program_as_an_error_does() {
    let folder = Folder::new("bad_memory_tree");
    for command in [
        "order random:6000 --eye=1,2,3 -o a.jsonl",
        "render random:6000 -o a.png",
        "draw random:6000 -o a.svg",
        "stats random:6000",
        "verify random:6000",
    ] {
        let (status, message) = run_within(30_000, &folder, command);
        assert_eq!(status, Some(2), "{command}: {message}");
        assert!(message.contains("memory"), "{command}: {message}");
    }
    assert!(folder.files().is_empty(), "{:?}", folder.files());
}

/// Where no thread can be started, because its stack would not fit, the program does without, and is
/// neither stopped nor left waiting.
#[cfg(target_os = "linux")]
#[test]
fn where_threads_do_not_fit_into_memory_the_program_does_without_them() {
    let folder = Folder::new("bad_memory_threads");
    let (mut good, mut has_begun) = (0, false);
    for kilobytes in (10_000..30_000).step_by(500) {
        let command = "stats city:3000";
        let (status, message) = run_within(kilobytes, &folder, command);
        // With too little, the system cannot load the program or its libraries, or ends it before `main`.
        let is_before = status == Some(127)
            || status.is_none() && (message.is_empty() || message.starts_with("memory"));
        let is_error = status == Some(2) && message.contains("memory");
        assert!(
            status == Some(0) || is_error || is_before && !has_begun,
            "{kilobytes}: {status:?} {message}"
        );
        has_begun |= !is_before;
        good += usize::from(status == Some(0));
    }
    assert!(good > 10, "{good}");
}

#[test]
fn libraries_outside_the_folder_are_not_read() {
    let folder = Folder::new("bad_library");
    folder.write("red.mtl", "newmtl red\nKd 1 0 0\n");
    fs::create_dir_all(folder.path("scene/below")).unwrap();
    folder.write("scene/below/red.mtl", "newmtl red\nKd 1 0 0\n");
    let absolute = folder.path("red.mtl").display().to_string();
    for (library, is_read) in [
        ("../red.mtl", false),
        ("below/../../red.mtl", false),
        ("..\\red.mtl", false),
        (&absolute[..], false),
        ("gone.mtl ../red.mtl", false),
        ("below/red.mtl", true),
        ("./below/red.mtl", true),
        ("below\\red.mtl", true),
    ] {
        let text = format!("mtllib {library}\nusemtl red\n{CROSSING}");
        folder.write("scene/s.obj", text);
        let run = folder.run("stats scene/s.obj --notes");
        let note = format!("material libraries outside the file's folder, not read: {library}");
        assert_eq!(run.err.contains(&note), !is_read, "{library}: {run:?}");
        assert_eq!(run.err.contains("materials not defined: red"), !is_read, "{library}: {run:?}");
        assert!(!run.err.contains("not found"), "{library}: {run:?}");
        run.good();
    }
}

/// A mistyped number of threads is refused before any thread is made.
#[test]
fn too_many_threads_are_refused() {
    let folder = Folder::new("too_many_threads");
    for number in ["0", "1025", "99999999"] {
        let message = folder.run(&format!("stats crossing --threads {number}")).refused();
        assert!(message.contains("1..=1024"), "{message}");
    }
    folder.run("stats crossing --threads 3").good();
}
