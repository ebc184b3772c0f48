use crate::run::{Folder, Run};

#[test]
fn help_has_examples_and_fits() {
    let folder = Folder::new("help");
    for command in
        ["", "demo", "order", "verify", "stats", "render", "draw", "page", "export", "build"]
    {
        let help = |option: &str| {
            let mut run = folder.command(&format!("{command} {option}"));
            Run::new(&run.env("COLUMNS", "100").output().unwrap()).good()
        };
        let (short, long) = (help("-h"), help("--help"));
        assert!(short.lines().count() <= 40, "{} lines: {short}", short.lines().count());
        for help in [&short, &long] {
            assert!(help.contains("Examples:\n  binspace"), "{help}");
            assert!(help.lines().all(|line| line.chars().count() <= 100), "{help}");
        }
        for option in ["--threads", "--quiet", "--notes"] {
            assert!(long.contains(option), "{command}: {long}");
        }
    }
    let version = folder.run("--version").good();
    assert_eq!(version, format!("binspace {}\n", env!("CARGO_PKG_VERSION")));
}

/// The first output for somebody who has just installed the program.
#[test]
fn without_arguments_help_is_printed() {
    let folder = Folder::new("help_alone");
    let run = folder.run("");
    assert_eq!(run.err, "");
    let help = run.good();
    assert_eq!(help.trim_end(), folder.run("-h").good().trim_end());
    let commands = help.split("Commands:\n").nth(1).unwrap();
    assert!(commands.trim_start().starts_with("demo "), "{help}");
    assert!(folder.files().is_empty());
}

#[test]
fn scenes_lists_what_can_be_asked_for() {
    let folder = Folder::new("scenes");
    let list = folder.run("scenes").good();
    for name in ["newell", "cornell", "teapot:SIZE", "sphere:SIZE", "random:SIZE"] {
        assert!(list.contains(name), "{list}");
    }
    assert!(list.lines().all(|line| line.chars().count() <= 80), "{list}");
}

#[test]
fn files_and_built_in_scenes_are_told_apart() {
    let folder = Folder::new("names");
    folder.write("newell", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    folder.write("mesh", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    let lines =
        |scene: &str| folder.run(&format!("order {scene} --eye=9,9,9")).good().lines().count();
    assert_eq!([lines("./newell"), lines("mesh")], [1, 1]);
    assert!(lines("newell") >= 18);
}
