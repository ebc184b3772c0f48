use std::fs;
use std::path::PathBuf;

use crate::run::Folder;
use testkit::real_scenes;

/// The OBJ files of the folder of real scenes, or of a folder in it.
fn files(subfolder: &str) -> Vec<PathBuf> {
    let entries = fs::read_dir(real_scenes::folder().join(subfolder)).unwrap();
    let paths = entries.map(|entry| entry.unwrap().path());
    let files: Vec<PathBuf> =
        paths.filter(|path| path.extension().is_some_and(|ext| ext == "obj")).collect();
    assert!(files.len() > 5, "{files:?}");
    files
}

#[test]
#[ignore = "needs the real scenes: BINSPACE_SCENES"]
fn small_real_scenes_are_painted_right() {
    let folder = Folder::new("real_scenes");
    for path in files("") {
        if fs::metadata(&path).unwrap().len() < 200_000 {
            let command = format!("verify {} --size 320x240 --views 4", path.display());
            let out = folder.run(&command).good();
            assert!(out.trim_end().ends_with("right"), "{}: {out}", path.display());
        }
    }
}

#[test]
#[ignore = "needs the real scenes: BINSPACE_SCENES"]
fn files_that_test_parsers_are_read_or_refused() {
    let folder = Folder::new("torture");
    for path in files("torture") {
        let path = path.display();
        for command in [
            format!("order {path} --eye=3,2,1"),
            format!("verify {path} --size 64x48 --views 2"),
            format!("stats {path}"),
            format!("draw {path} -o p.svg"),
        ] {
            let run = folder.run(&command);
            assert!(matches!(run.status, Some(0 | 2)), "{command}: {run:?}");
            if run.status == Some(2) {
                let name = run.err.lines().any(|line| line.starts_with("error: /"));
                assert!(name && run.out.is_empty(), "{command}: {run:?}");
            }
        }
    }
}
