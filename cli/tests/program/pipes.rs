//! Standard input as a scene, standard output as a file.

use std::fs;

use crate::png_picture::Picture;
use crate::run::{CROSSING, Folder, Run};

#[test]
fn a_scene_on_standard_input_is_that_of_the_file() {
    let folder = Folder::new("pipes_input");
    folder.write("s.obj", CROSSING);
    for command in [
        "order SCENE --eye=3,2,6",
        "order SCENE --eye=3,2,6 --edges --weights",
        "verify SCENE --views 2 --size 20x10",
        "draw SCENE -o -",
        "draw SCENE -o - --ids",
    ] {
        let piped = Run::new(&folder.pipe(&command.replace("SCENE", "-"), CROSSING));
        let file = folder.run(&command.replace("SCENE", "s.obj"));
        assert_eq!(piped.err.replace("standard input", "s.obj"), file.err, "{command}");
        let (piped, file) = (piped.good().replace("standard input", "s.obj"), file.good());
        assert_eq!(piped, file, "{command}");
    }
    let stats = Run::new(&folder.pipe("stats -", CROSSING)).good();
    assert!(stats.starts_with("standard input: 3 polygons"), "{stats}");
    // A path with a folder refers to a file of that name.
    fs::write(folder.path("-"), CROSSING).unwrap();
    assert!(folder.run("order ./- --eye=3,2,6").good().lines().count() > 3);
}

#[test]
fn a_large_scene_comes_through_a_pipe() {
    let folder = Folder::new("pipes_large");
    let mut text = String::new();
    for i in 0..40_000 {
        text += &format!("v {i} 0 0\nv {i}.5 0 0\nv {i} 1 0.125\n");
        text += "f -3 -2 -1\n";
    }
    assert!(text.len() > 1 << 20);
    let run = Run::new(&folder.pipe("order - --direction=0,0,-1", &text));
    assert_eq!(run.good().lines().count(), 40_000);
}

#[test]
fn material_libraries_beside_standard_input_are_not_read_and_that_is_said() {
    let folder = Folder::new("pipes_materials");
    folder.write("m.mtl", "newmtl red\nKd 1 0 0\n");
    let text = format!("mtllib m.mtl\nmtllib ../n.mtl\nusemtl red\n{CROSSING}");
    let output = folder.pipe("render - -o - --size 40x30 --notes", &text);
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(said.contains("name the file to use m.mtl, ../n.mtl"), "{said}");
    assert_eq!(said.matches("m.mtl").count(), 1, "{said}");
    let rgb = Picture::parse(&output.stdout).rgb;
    assert!(rgb.chunks_exact(3).all(|p| p[0] == p[1] && p[1] == p[2]));
}

#[test]
fn bad_scenes_on_standard_input_are_refused() {
    let folder = Folder::new("pipes_bad");
    for (command, text, problem) in [
        ("order - --eye=0,0,1", "", "standard input: this is an empty file"),
        ("order - --eye=0,0,1", "v 0 0 nan\nf 1 1 1\n", "standard input, line 1"),
        ("render - -o p.png", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n", "standard input: nothing"),
        ("stats -", "f 1 2 3\n", "standard input, line 1, face 0"),
        ("demo -o -", "", "standard output: several files cannot go there"),
    ] {
        let message = Run::new(&folder.pipe(command, text)).refused();
        assert!(message.contains(problem), "{command}: {message}");
    }
    assert!(folder.files().is_empty(), "{:?}", folder.files());
}

#[test]
fn a_picture_on_standard_output_is_that_of_the_file() {
    let folder = Folder::new("pipes_output");
    folder.write("s.obj", CROSSING);
    for (options, file) in [
        ("render", "a.png"),
        ("render --samples 2", "a.png"),
        ("render --depth", "a.png"),
        ("draw --format png", "a.png"),
        ("draw", "a.svg"),
    ] {
        let command = format!("{options} s.obj --size 40x30 -o");
        let piped = folder.pipe(&format!("{command} -"), "");
        assert_eq!(piped.status.code(), Some(0));
        folder.run(&format!("{command} {file}")).good();
        assert_eq!(piped.stdout, fs::read(folder.path(file)).unwrap(), "{options}");
    }
    // A name without a known extension, with a format.
    folder.run("draw s.obj --size 40x30 --format svg -o drawing").good();
    assert!(fs::read_to_string(folder.path("drawing")).unwrap().starts_with("<svg"));
    assert_eq!(folder.files(), ["a.png", "a.svg", "drawing", "s.obj"]);
}

#[test]
fn failures_write_nothing_to_standard_output() {
    let folder = Folder::new("pipes_failures");
    for options in ["--eye=0,0,0 --target=0,0,0", "--eye=0,0,1e300 --target=0,0,0", "--samples 99"]
    {
        folder.run(&format!("render newell -o - {options}")).refused();
    }
}

#[cfg(target_os = "linux")]
#[test]
fn a_png_is_not_written_to_a_terminal() {
    use rustix::fs::{Mode, OFlags, open};
    use rustix::pty::{OpenptFlags, grantpt, openpt, ptsname, unlockpt};

    let folder = Folder::new("pipes_terminal");
    let master = openpt(OpenptFlags::RDWR | OpenptFlags::NOCTTY).unwrap();
    grantpt(&master).unwrap();
    unlockpt(&master).unwrap();
    let name = ptsname(&master, Vec::new()).unwrap();
    let terminal = || open(name.as_c_str(), OFlags::RDWR | OFlags::NOCTTY, Mode::empty()).unwrap();
    let device = name.to_str().unwrap();
    let run = |options: &str| {
        let mut command = folder.command(&format!("{options} newell --size 8x6"));
        let output = command.stdout(terminal()).output().unwrap();
        (output.status.code(), String::from_utf8(output.stderr).unwrap())
    };
    for options in ["render -o -".to_owned(), format!("render -o {device}")] {
        let (status, message) = run(&options);
        assert_eq!(status, Some(2), "{message}");
        assert!(message.contains("a PNG is not for a terminal"), "{message}");
    }
    assert_eq!(run("draw -o -").0, Some(0));
    assert_eq!(run("render -o p.png").0, Some(0));
}
