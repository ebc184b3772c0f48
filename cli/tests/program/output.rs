use std::fs;

use crate::run::{CROSSING, Folder};

#[test]
fn a_file_is_written_completely_or_not_at_all() {
    let folder = Folder::new("order_output");
    folder.write("s.obj", CROSSING);
    let printed = folder.run("order s.obj --eye=3,2,6").good();
    assert_eq!(folder.run("order s.obj --eye=3,2,6 -o a.jsonl").good(), "");
    assert_eq!(fs::read_to_string(folder.path("a.jsonl")).unwrap(), printed);
    assert_eq!(folder.run("order s.obj --eye=3,2,6 -o -").good(), printed);
    // Again, over it; and then errors, which leave it as it is.
    folder.run("order newell --eye=3,2,6 -o a.jsonl").good();
    let kept = fs::read_to_string(folder.path("a.jsonl")).unwrap();
    assert_ne!(kept, printed);
    folder.write("bad.obj", "v 0 0 nan\nf 1 1 1\n");
    for command in ["bad.obj", "missing.obj", "random --max-fragments 10"] {
        folder.run(&format!("order {command} --eye=3,2,6 -o a.jsonl")).refused();
        assert_eq!(fs::read_to_string(folder.path("a.jsonl")).unwrap(), kept);
    }
    assert_eq!(folder.files(), ["a.jsonl", "bad.obj", "s.obj"]);
}

#[cfg(unix)]
#[test]
fn links_and_devices_are_written_through() {
    let folder = Folder::new("order_links");
    folder.write("real.jsonl", "old");
    std::os::unix::fs::symlink("real.jsonl", folder.path("link.jsonl")).unwrap();
    folder.run("order newell --eye=3,2,6 -o link.jsonl").good();
    assert!(folder.path("link.jsonl").is_symlink());
    assert!(fs::read_to_string(folder.path("real.jsonl")).unwrap().starts_with("{\"polygon\""));
    folder.run("order newell --eye=3,2,6 -o /dev/null").good();
    assert!(!fs::metadata("/dev/null").unwrap().is_file());
}

#[cfg(unix)]
#[test]
fn a_link_to_a_file_that_is_not_there_is_kept_and_the_file_made() {
    use std::os::unix::fs::symlink;
    let folder = Folder::new("output_dangling");
    fs::create_dir(folder.path("below")).unwrap();
    symlink("below/first", folder.path("link.jsonl")).unwrap();
    symlink("../real.jsonl", folder.path("below/first")).unwrap();
    folder.run("order newell --eye=3,2,6 -o link.jsonl").good();
    assert!(folder.path("link.jsonl").is_symlink() && folder.path("below/first").is_symlink());
    assert!(fs::read_to_string(folder.path("real.jsonl")).unwrap().starts_with("{\"polygon\""));
    symlink("missing/file", folder.path("nowhere.jsonl")).unwrap();
    symlink("round.jsonl", folder.path("round.jsonl")).unwrap();
    for name in ["nowhere.jsonl", "round.jsonl"] {
        let message = folder.run(&format!("order newell --eye=3,2,6 -o {name}")).refused();
        assert!(message.contains(&format!("{name}: cannot be written")), "{message}");
        assert!(folder.path(name).is_symlink());
    }
}

#[test]
fn a_name_as_long_as_names_can_be_is_written() {
    let folder = Folder::new("output_long");
    let name = "n".repeat(250);
    folder.run(&format!("order newell --eye=3,2,6 -o {name}")).good();
    assert_eq!(folder.files(), [name.as_str()]);
    let message = folder.run(&format!("order newell --eye=3,2,6 -o {name}{name}")).refused();
    assert!(message.contains("cannot be written"), "{message}");
    assert_eq!(folder.files(), [name]);
}

#[cfg(unix)]
#[test]
fn a_program_that_is_interrupted_leaves_no_file_behind() {
    use std::os::unix::process::ExitStatusExt;
    use std::process::{Command, Stdio};
    use std::time::{Duration, Instant};

    let folder = Folder::new("output_signal");
    for (signal, number) in [("-INT", 2), ("-TERM", 15)] {
        folder.write("a.jsonl", "old");
        let mut command = folder.command("order random:20000 --eye=3,2,6 -o a.jsonl");
        let mut child = command.stderr(Stdio::null()).spawn().unwrap();
        let start = Instant::now();
        while !folder.files().iter().any(|name| name.ends_with(".part")) {
            assert!(start.elapsed() < Duration::from_secs(60), "it writes no file");
            std::thread::sleep(Duration::from_millis(5));
        }
        let id = child.id().to_string();
        assert!(Command::new("kill").args([signal, &id]).status().unwrap().success());
        assert_eq!(child.wait().unwrap().signal(), Some(number));
        assert_eq!(folder.files(), ["a.jsonl"]);
        assert_eq!(fs::read_to_string(folder.path("a.jsonl")).unwrap(), "old");
    }
}
