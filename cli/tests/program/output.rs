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

/// The paths that a shell passes for `>(…)` and for `/dev/stdout`.
#[cfg(target_os = "linux")]
#[test]
fn pipes_without_names_are_written() {
    let folder = Folder::new("output_unnamed");
    let expected = folder.run("order newell --eye=3,2,6 -o -").good();
    for name in ["/dev/stdout", "/dev/fd/1", "/proc/self/fd/1"] {
        let piped = folder.pipe(&format!("order newell --eye=3,2,6 -o {name}"), "");
        assert_eq!(String::from_utf8_lossy(&piped.stdout), expected, "{name}: {piped:?}");
    }
    assert!(folder.files().is_empty());
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

/// Starts a long run that writes `a.jsonl`, and waits until it has opened a file for that.
#[cfg(target_os = "linux")]
fn start_writing(folder: &Folder, prefix: &str) -> std::process::Child {
    use std::process::{Command, Stdio};
    use std::time::{Duration, Instant};

    folder.write("a.jsonl", "old");
    let program = env!("CARGO_BIN_EXE_binspace");
    let line = format!("{prefix} exec {program} order random:20000 --eye=3,2,6 -o a.jsonl");
    let mut command = Command::new("sh");
    command.args(["-c", &line]).current_dir(folder.path("")).stderr(Stdio::null());
    let child = command.spawn().unwrap();
    let opened = format!("/proc/{}/fd", child.id());
    let is_of_folder = |file: fs::DirEntry| {
        fs::read_link(file.path()).is_ok_and(|path| path.starts_with(folder.path("")))
    };
    let start = Instant::now();
    while !fs::read_dir(&opened).unwrap().any(|file| file.is_ok_and(is_of_folder)) {
        assert!(start.elapsed() < Duration::from_secs(600), "it opens no file");
        std::thread::sleep(Duration::from_millis(5));
    }
    child
}

#[cfg(target_os = "linux")]
fn is_ignored(signal: i32) -> bool {
    let status = fs::read_to_string("/proc/self/status").unwrap();
    let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:")).unwrap();
    u64::from_str_radix(mask.trim(), 16).unwrap() >> (signal - 1) & 1 == 1
}

#[cfg(target_os = "linux")]
fn send(signal: &str, child: &std::process::Child) {
    let id = child.id().to_string();
    assert!(std::process::Command::new("kill").args([signal, &id]).status().unwrap().success());
}

#[cfg(target_os = "linux")]
#[test]
fn a_program_that_is_ended_by_a_signal_leaves_no_file_behind() {
    use std::os::unix::process::ExitStatusExt;

    let folder = Folder::new("output_signal");
    // Signals that were ignored when the tests started, as by `nohup`, stay ignored.
    let signals = [("-HUP", 1), ("-INT", 2), ("-TERM", 15), ("-KILL", 9)];
    for (signal, number) in signals.into_iter().filter(|&(_, number)| !is_ignored(number)) {
        let mut child = start_writing(&folder, "");
        send(signal, &child);
        assert_eq!(child.wait().unwrap().signal(), Some(number));
        assert_eq!(folder.files(), ["a.jsonl"], "{signal}");
        assert_eq!(fs::read_to_string(folder.path("a.jsonl")).unwrap(), "old");
    }
}

/// As `nohup` does with SIGHUP, and shells with SIGINT for background processes.
#[cfg(target_os = "linux")]
#[test]
fn signals_that_are_ignored_stay_ignored() {
    use std::os::unix::process::ExitStatusExt;

    let folder = Folder::new("output_ignored");
    let mut child = start_writing(&folder, "trap '' HUP INT;");
    send("-HUP", &child);
    send("-INT", &child);
    std::thread::sleep(std::time::Duration::from_millis(200));
    assert!(child.try_wait().unwrap().is_none(), "it has ended");
    send("-TERM", &child);
    assert_eq!(child.wait().unwrap().signal(), Some(15));
}

#[cfg(unix)]
#[test]
fn a_file_has_the_permissions_of_the_one_it_replaces_or_the_usual_ones() {
    use std::os::unix::fs::PermissionsExt;

    let folder = Folder::new("output_permissions");
    let mode = |name: &str| {
        let data = fs::metadata(folder.path(name)).unwrap();
        format!("{:o}", data.permissions().mode() & 0o777)
    };
    folder.write("usual", "");
    folder.run("order newell --eye=3,2,6 -o new.jsonl").good();
    assert_eq!(mode("new.jsonl"), mode("usual"));
    for bits in [0o600, 0o640, 0o666] {
        let kept = fs::Permissions::from_mode(bits);
        fs::set_permissions(folder.path("new.jsonl"), kept).unwrap();
        folder.run("order newell --eye=3,2,6 -o new.jsonl").good();
        assert_eq!(mode("new.jsonl"), format!("{bits:o}"));
    }
}

#[test]
fn the_file_of_a_scene_is_not_replaced() {
    let folder = Folder::new("output_same");
    folder.write("s.obj", CROSSING);
    for command in [
        "build s.obj -o s.obj",
        "order s.obj --eye=3,2,6 -o ./s.obj",
        "draw s.obj --format svg -o s.obj",
        "page s.obj -o s.obj",
        "export s.obj -o s.obj",
    ] {
        let message = folder.run(command).refused();
        assert!(message.contains("this is the scene's own file"), "{command}: {message}");
        assert_eq!(fs::read_to_string(folder.path("s.obj")).unwrap(), CROSSING, "{command}");
    }
    #[cfg(unix)]
    {
        std::os::unix::fs::symlink("s.obj", folder.path("link.obj")).unwrap();
        let message = folder.run("order link.obj --eye=3,2,6 -o s.obj").refused();
        assert!(message.contains("this is the scene's own file"), "{message}");
    }
    // The name of a built-in scene is no file.
    for _ in 0..2 {
        folder.run("order newell --eye=3,2,6 -o newell").good();
    }
}

#[cfg(target_os = "linux")]
#[test]
fn output_that_cannot_be_written_is_an_error_in_every_command() {
    let folder = Folder::new("output_full");
    folder.write("s.obj", CROSSING);
    std::os::unix::fs::symlink("/dev/full", folder.path("full.png")).unwrap();
    std::os::unix::fs::symlink("/dev/full", folder.path("full.svg")).unwrap();
    std::os::unix::fs::symlink("/dev/full", folder.path("full.pdf")).unwrap();
    let full = || fs::OpenOptions::new().write(true).open("/dev/full").unwrap();
    for command in [
        "--help",
        "-h",
        "--version",
        "",
        "help",
        "help order",
        "order --help",
        "scenes",
        "order s.obj --eye=3,2,6",
        "stats s.obj",
        "stats s.obj --json",
        "verify s.obj --size 8x6 --views 1",
        "demo --size 8x6 --views 1",
    ] {
        let output = folder.command(command).stdout(full()).output().unwrap();
        let message = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{command}: {message}");
        assert!(message.contains("error: standard output: No space left"), "{command}: {message}");
    }
    for command in [
        "order s.obj --eye=3,2,6 -o /dev/full",
        "render s.obj --size 8x6 -o full.png",
        "draw s.obj --size 8x6 -o full.svg",
        "draw s.obj --size 8x6 -o full.pdf",
        "draw s.obj --size 8x6 -o full.png",
        "page s.obj -o /dev/full",
    ] {
        let message = folder.run(command).refused();
        assert!(message.contains("cannot be written: No space left"), "{command}: {message}");
    }
}
