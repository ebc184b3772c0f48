use std::fs;
use std::path::PathBuf;

use crate::run::Folder;

/// The OBJ files of a folder of scenes, and of its folder `torture`; none without the folder.
fn files(subfolder: &str) -> Vec<PathBuf> {
    let Some(folder) = std::env::var_os("BINSPACE_SCENES") else {
        let mut err = std::io::stderr().lock();
        let reason = "skipped: BINSPACE_SCENES does not name the folder with the scenes";
        let _ = std::io::Write::write_fmt(&mut err, format_args!("{reason}\n"));
        return Vec::new();
    };
    let entries = fs::read_dir(PathBuf::from(folder).join(subfolder)).unwrap();
    let paths = entries.map(|entry| entry.unwrap().path());
    paths.filter(|path| path.extension().is_some_and(|ext| ext == "obj")).collect()
}

#[test]
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
fn files_that_test_parsers_are_read_or_refused() {
    let folder = Folder::new("torture");
    for path in files("torture") {
        let path = path.display();
        for command in [
            format!("order {path} --eye=3,2,1"),
            format!("verify {path} --size 64x48 --views 2"),
            format!("stats {path}"),
            format!("render {path} -o p.svg"),
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
