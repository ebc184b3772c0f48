//! Pipes, devices and folders in place of an OBJ file or of a material library.

use std::fs::{self, File, OpenOptions};
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::mpsc;
use std::thread;
use std::time::Duration;
use testkit::prelude::*;

use binspace::scene::ObjStream;

use super::folder;

const SCENE: &str = "mtllib m.mtl\nusemtl red\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

fn make_pipe(path: &Path) {
    assert!(Command::new("mkfifo").arg(path).status().expect("mkfifo").success());
}

/// The result of a call, which must not wait for anything.
fn soon<T: Send + 'static>(call: impl FnOnce() -> T + Send + 'static) -> T {
    let (send, receive) = mpsc::channel();
    thread::spawn(move || send.send(call()));
    receive.recv_timeout(Duration::from_secs(20)).expect("it waits for somebody to write")
}

/// The messages with which both ways to read a file refuse it.
fn refused(path: &Path) -> [String; 2] {
    let (whole, streamed) = (path.to_owned(), path.to_owned());
    [
        soon(move || Scene::read_obj(whole).map(|_| ()).unwrap_err().to_string()),
        soon(move || ObjStream::open(streamed).map(|_| ()).unwrap_err().to_string()),
    ]
}

#[test]
fn a_named_pipe_that_nobody_writes_to_is_refused() {
    let folder = folder("named_pipe");
    let (pipe, link) = (folder.join("s.obj"), folder.join("link.obj"));
    make_pipe(&pipe);
    std::os::unix::fs::symlink("s.obj", &link).unwrap();
    for path in [&pipe, &link] {
        for message in refused(path) {
            assert!(message.contains("pipe") && message.contains(".obj"), "{message}");
        }
    }
}

#[test]
fn folders_and_devices_are_refused() {
    let folder = folder("devices");
    for message in refused(&folder) {
        assert!(message.contains("cannot be read"), "{message}");
    }
    // An endless device, and an empty one.
    for (device, says) in [("/dev/zero", "zero byte"), ("/dev/null", "no faces")] {
        let [whole, streamed] = refused(Path::new(device));
        assert!(whole.contains(says), "{device}: {whole}");
        // A pipe would have to be read twice.
        assert!(streamed.contains("regular"), "{device}: {streamed}");
    }
}

/// An unnamed pipe, which a shell passes to a program, has a writer, so the pipe is read.
#[cfg(target_os = "linux")]
#[test]
fn a_pipe_without_a_name_is_read() {
    use std::os::fd::AsRawFd;

    let (reader, mut writer) = std::io::pipe().expect("a pipe");
    let path = PathBuf::from(format!("/dev/fd/{}", reader.as_raw_fd()));
    let read = thread::spawn({
        let path = path.clone();
        move || Scene::read_obj(path)
    });
    for line in SCENE.lines() {
        thread::sleep(Duration::from_millis(5));
        writeln!(writer, "{line}").unwrap();
    }
    drop(writer);
    let (scene, _) = read.join().expect("no panic").expect("a scene");
    assert_eq!(scene.len(), 1);
    drop(reader);
    assert!(Scene::read_obj(path).is_err());
}

#[test]
fn a_material_library_that_is_no_file_is_missing() {
    let folder = folder("library_pipe");
    fs::write(folder.join("s.obj"), SCENE).unwrap();
    make_pipe(&folder.join("m.mtl"));
    let path = folder.join("s.obj");
    let missing = soon(move || {
        let (_, whole) = Scene::read_obj(&path).unwrap();
        [whole, ObjStream::open(&path).unwrap().report().clone()].map(|r| r.missing_libraries)
    });
    assert_eq!(missing, [["m.mtl"], ["m.mtl"]]);
    fs::remove_file(folder.join("m.mtl")).unwrap();
    fs::create_dir(folder.join("m.mtl")).unwrap();
    let (_, report) = Scene::read_obj(folder.join("s.obj")).unwrap();
    assert_eq!(report.missing_libraries, ["m.mtl"]);
}

/// The file becomes a pipe between the two readings.
#[test]
fn a_file_that_becomes_a_pipe_is_refused() {
    let folder = folder("becomes_pipe");
    let path = folder.join("s.obj");
    fs::write(&path, SCENE).unwrap();
    let stream = ObjStream::open(&path).unwrap();
    fs::remove_file(&path).unwrap();
    make_pipe(&path);
    let message = soon(move || {
        let read = stream.read(|_, _| std::ops::ControlFlow::<()>::Continue(()));
        read.map(|_| ()).unwrap_err().to_string()
    });
    assert!(message.contains("regular"), "{message}");
}

/// As with the shell's `<`, the file is open, and its path is the number of the descriptor.
#[cfg(target_os = "linux")]
#[test]
fn a_regular_file_behind_a_device_is_read() {
    use std::os::fd::AsRawFd;

    let folder = folder("behind_device");
    fs::write(folder.join("s.obj"), SCENE).unwrap();
    fs::write(folder.join("m.mtl"), "newmtl red\nKd 1 0 0\n").unwrap();
    let file = File::open(folder.join("s.obj")).unwrap();
    let path = format!("/proc/self/fd/{}", file.as_raw_fd());
    assert_eq!(Scene::read_obj(&path).unwrap().0.len(), 1);
    assert_eq!(ObjStream::open(&path).unwrap().polygons(), 1);
    drop(OpenOptions::new().append(true).open(folder.join("s.obj")).unwrap());
}
