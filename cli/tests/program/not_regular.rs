//! Pipes, folders and devices in place of files that the program reads.

use std::fs;
use std::process::{Command, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

use crate::run::{CROSSING, Folder, Run};

fn make_pipe(folder: &Folder, name: &str) {
    let _ = fs::remove_file(folder.path(name));
    assert!(Command::new("mkfifo").arg(folder.path(name)).status().expect("mkfifo").success());
}

/// The message of a run that is refused, and does not wait until somebody writes to a pipe.
#[track_caller]
fn refused_soon(folder: &Folder, arguments: &str) -> String {
    let mut command = folder.command(arguments);
    command.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped());
    let (mut child, begin) = (command.spawn().unwrap(), Instant::now());
    while child.try_wait().unwrap().is_none() {
        if begin.elapsed() > Duration::from_secs(600) {
            child.kill().unwrap();
            panic!("{arguments}: it waits");
        }
        sleep(Duration::from_millis(2));
    }
    Run::new(&child.wait_with_output().unwrap()).refused()
}

#[test]
fn a_pipe_in_place_of_a_cell_or_a_partition_is_refused() {
    let folder = Folder::new("not_regular_cells");
    folder.write("s.obj", CROSSING);
    folder.run("build s.obj --cells 3 -o d").good();
    for name in ["cell-0000.bsp", "partition.bsp"] {
        let file = format!("d/{name}");
        let kept = fs::read(folder.path(&file)).unwrap();
        make_pipe(&folder, &file);
        for command in ["order d --eye=1,2,3", "stats d", "render d -o p.png"] {
            let message = refused_soon(&folder, command);
            assert!(message.contains(name) && message.contains("regular file"), "{message}");
        }
        fs::remove_file(folder.path(&file)).unwrap();
        fs::create_dir(folder.path(&file)).unwrap();
        assert!(refused_soon(&folder, "stats d").contains(name));
        fs::remove_dir(folder.path(&file)).unwrap();
        std::os::unix::fs::symlink("/dev/zero", folder.path(&file)).unwrap();
        assert!(refused_soon(&folder, "stats d").contains("regular file"));
        fs::remove_file(folder.path(&file)).unwrap();
        fs::write(folder.path(&file), kept).unwrap();
    }
    folder.run("stats d").good();
    assert!(!folder.path("p.png").exists());
}

#[test]
fn a_pipe_in_place_of_a_scene_is_refused() {
    let folder = Folder::new("not_regular_scenes");
    for name in ["s.obj", "s.bsp", "s"] {
        make_pipe(&folder, name);
        let mut commands = ["order SCENE --eye=1,2,3", "stats SCENE", "verify SCENE"].to_vec();
        commands.extend(["render SCENE -o p.png", "draw SCENE -o p.svg", "page SCENE -o p.html"]);
        commands.extend(["build SCENE -o t.bsp", "build SCENE --cells 2 -o d"]);
        for command in commands {
            let message = refused_soon(&folder, &command.replace("SCENE", name));
            assert!(message.contains(name), "{command}: {message}");
            let says = ["pipe", "regular file", "it contains a finished tree"];
            assert!(says.iter().any(|says| message.contains(says)), "{command}: {message}");
        }
    }
    // Where the message leads.
    let message = refused_soon(&folder, "stats s.obj");
    assert!(message.contains("standard input"), "{message}");
}

#[test]
fn a_pipe_in_place_of_a_material_library_is_not_read() {
    let folder = Folder::new("not_regular_library");
    folder.write("s.obj", format!("mtllib m.mtl\nusemtl red\n{CROSSING}"));
    make_pipe(&folder, "m.mtl");
    let run = folder.run("stats s.obj");
    assert!(run.err.contains("m.mtl"), "{run:?}");
    run.good();
}

#[test]
fn an_endless_device_is_refused() {
    let folder = Folder::new("not_regular_devices");
    for command in ["stats /dev/zero", "build /dev/zero --cells 2 -o d", "stats /dev/null"] {
        let message = refused_soon(&folder, command);
        assert!(message.contains("/dev/"), "{command}: {message}");
    }
}

/// The paths that a shell passes for `<(…)`, for `/dev/stdin` and for `-`: somebody writes to these.
#[cfg(target_os = "linux")]
#[test]
fn pipes_without_names_are_read() {
    let folder = Folder::new("not_regular_unnamed");
    folder.write("s.obj", CROSSING);
    folder.run("build s.obj -o s.bsp").good();
    let polygons = |text: &str| text.lines().filter(|line| line.contains("\"polygon\"")).count();
    let expected = polygons(&folder.run("order s.obj --eye=3,2,6").good());
    for name in ["/dev/stdin", "-", "/dev/fd/0", "/proc/self/fd/0"] {
        let piped = folder.pipe(&format!("order {name} --eye=3,2,6"), CROSSING);
        assert_eq!(polygons(&Run::new(&piped).good()), expected, "{name}");
        for file in ["s.obj", "s.bsp"] {
            let mut command = folder.command(&format!("order {name} --eye=3,2,6"));
            command.stdin(fs::File::open(folder.path(file)).unwrap());
            let run = Run::new(&command.output().unwrap());
            assert_eq!(polygons(&run.good()), expected, "{name} < {file}");
        }
    }
    // A pipe with a name, by standard input.
    make_pipe(&folder, "pipe");
    let program = env!("CARGO_BIN_EXE_binspace");
    let line = format!("cat s.obj > pipe & exec {program} order - --eye=3,2,6 < pipe");
    let mut shell = Command::new("sh");
    let output = shell.args(["-c", &line]).current_dir(folder.path("")).output().unwrap();
    assert_eq!(polygons(&Run::new(&output).good()), expected);
}
