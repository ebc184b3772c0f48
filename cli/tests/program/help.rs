use crate::run::Folder;

#[test]
fn help_has_examples_and_fits() {
    let folder = Folder::new("help");
    for command in ["", "build", "order", "verify", "stats", "render", "draw", "page", "report"] {
        let help = folder.run(&format!("{command} --help")).good();
        assert!(help.contains("Examples:\n  binspace"), "{help}");
        assert!(help.lines().all(|line| line.chars().count() <= 100), "{help}");
    }
    let version = folder.run("--version").good();
    assert_eq!(version, format!("binspace {}\n", env!("CARGO_PKG_VERSION")));
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
