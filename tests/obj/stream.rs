//! Files read polygon by polygon give the same polygons, materials, precision and errors.

use std::fs;
use std::path::PathBuf;
use testkit::prelude::*;

use binspace::scene::ObjStream;

/// A file with a material library.
fn file(test: &str, text: impl AsRef<[u8]>) -> PathBuf {
    let path = super::file(test, text);
    let library = "newmtl a\nKd 1 0 0\nd 0.5\nnewmtl b c\nKd 0 1 0\n";
    fs::write(path.with_file_name("m.mtl"), library).unwrap();
    path
}

fn same(test: &str, text: impl AsRef<[u8]>) {
    let path = file(test, text);
    let (scene, mut report) = Scene::read_obj(&path).unwrap();
    let stream = ObjStream::open(&path).unwrap();
    report.degenerate_faces = 0;
    report.skipped_attributes = 0;
    assert_eq!(*stream.report(), report);
    assert_eq!(stream.polygons(), scene.len());
    assert_eq!(stream.scene().precision(), scene.precision());
    assert_eq!(stream.scene().materials(), scene.materials());
    assert_eq!(stream.scene().name(), scene.name());
    let mut number = 0;
    let read = stream.read(|corners, material| {
        assert_eq!(corners, scene.polygon(number));
        assert_eq!(stream.scene().materials()[material as usize], *scene.material(number));
        number += 1;
        ControlFlow::<()>::Continue(())
    });
    assert!(read.unwrap().is_continue() && number == scene.len());
    let bounds = |mut corners: Box<dyn Iterator<Item = DVec3> + '_>| {
        let first = corners.next().unwrap();
        corners.fold((first, first), |(low, high), p| (low.min(p), high.max(p)))
    };
    assert_eq!(Some(bounds(Box::new(stream.corners()))), scene.bounds());
}

#[test]
fn streams_read_the_same_polygons() {
    let text = "mtllib m.mtl\r\nv 0.25 0 0\nv 1e1 -0.125 0.5 1 0 0\nv 0 7 0\nv 99 99 99\nvt 0 1\n\
        vn 0 0 1\nusemtl a\nf 1/1/1 2 \\\n 3\n# \\\nusemtl b c\rf -4 -2 -3\nl 1 2\np 1\nusemtl\nf 5 6 1 1\n\
        curv 1\nusemtl none\nv 3 3 3\nv 1 2 3 0.5\nf 1 2 3 5 6\nf\n";
    same("stream_same", text);
    same("stream_marked", format!("\u{feff}{text}"));
    same("stream_latin", [text.as_bytes(), b"usemtl \xe9\nf 1 2 3\n"].concat());
}

#[test]
fn streams_refuse_the_same_files() {
    for text in [
        "",
        "v 1 2\nf 1 1 1\n",
        "v 1 2 nan\n",
        "v 1 2 x\n",
        "v 1 2 3\nf 1 2 3\n",
        "v 1 2 3\nf 0\n",
        "v 1 2 3\nf a\n",
        "v 1 2 3\nf -2\n",
        "v 1 2 3\nf 1 2\nv 1 1 1\nf 1 9\n",
        "v 1 2 3\n",
    ] {
        let path = file("stream_refused", text);
        let [whole, streamed] = [
            Scene::read_obj(&path).map(|_| ()).unwrap_err(),
            ObjStream::open(&path).map(|_| ()).unwrap_err(),
        ];
        assert_eq!(whole.to_string(), streamed.to_string(), "{text:?}");
        assert_eq!(whole, streamed, "{text:?}");
    }
    let missing = ObjStream::open("no such file.obj").unwrap_err().to_string();
    assert!(missing.contains("no such file.obj") && missing.contains("cannot be read"));
}

#[test]
fn a_file_that_changes_meanwhile_is_an_error() {
    let path = file("stream_changed", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 3 2 1\n");
    let stream = ObjStream::open(&path).unwrap();
    let broken = stream.read(|_, _| ControlFlow::Break(7)).unwrap();
    assert_eq!(broken, ControlFlow::Break(7));
    for text in [
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n",
        "v 0 0 0\nf 1 1 5\nf 1 2 2\n",
        "v x\n",
        // As many faces as before, and one more vertex.
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nf 1 2 3\nf 3 2 4\n",
    ] {
        fs::write(&path, text).unwrap();
        assert!(stream.read(|_, _| ControlFlow::<()>::Continue(())).is_err(), "{text}");
    }
}
