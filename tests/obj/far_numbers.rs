//! Faces that name vertices far beyond the last vertex of the file are an error, before any memory is
//! allocated.

use std::fs;
use testkit::prelude::*;

use binspace::scene::ObjStream;

use super::file;

#[test]
fn a_vertex_number_beyond_the_file_allocates_no_memory() {
    let corners = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
    // A bit for each vertex would take a gigabyte, a petabyte, or more than any machine has.
    for number in ["8000000000", "9000000000000000", "9000000000000000000", "9223372036854775807"] {
        for text in [
            format!("{corners}f 1 2 {number}\n"),
            format!("f 1 {number} 2\n{corners}"),
            format!("{corners}f 1 2 3\nf 1 2 {number}\nv 3 3 3\n"),
        ] {
            let path = file("far_numbers", &text);
            let before = peak();
            let streamed = ObjStream::open(&path).map(|_| ()).unwrap_err();
            assert!(peak() < before + 100_000, "{number}: {} kB", peak() - before);
            let whole = Scene::read_obj(&path).map(|_| ()).unwrap_err();
            assert_eq!(streamed.to_string(), whole.to_string());
            assert!(streamed.to_string().contains(number), "{streamed}");
        }
    }
}

/// The largest memory that this process has had, in kB; 0 where it is not known.
fn peak() -> usize {
    let status = fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find(|line| line.starts_with("VmHWM"));
    line.and_then(|line| line.split_whitespace().nth(1)?.parse().ok()).unwrap_or(0)
}

/// Vertices may come after the faces that name them. Each vertex is a corner once, however many faces name
/// it.
#[test]
fn vertices_that_come_later_are_corners() {
    let mut text = String::new();
    for k in 0..200 {
        text += &format!("f {} {} {}\n", 3 * k + 1, 3 * k + 2, 3 * k + 3);
    }
    for k in 0..601 {
        text += &format!("v {k} {} 0\n", k % 7);
    }
    text += "f 600 1 2\nf -1 -2 -3\n";
    let stream = ObjStream::open(file("later_vertices", &text)).unwrap();
    assert_eq!(stream.corners().count(), 601);
    let text = text.replace("f -1 -2 -3\n", "");
    let stream = ObjStream::open(file("later_vertices_but_one", &text)).unwrap();
    assert!(stream.corners().map(|corner| corner.x).eq((0..600).map(f64::from)));
}

/// The number is one above the number of vertices, whatever faces come before it.
#[test]
fn a_number_one_past_the_last_vertex_is_an_error() {
    for (name, vertices, faces) in
        [("past_two", 2, "f 1 2 3\n"), ("past_five", 5, "f 1 2 3\nf 3 4 5 6\n")]
    {
        let text = "v 0 1 2\n".repeat(vertices) + faces;
        let line = text.lines().count();
        let whole = crate::obj::read(&text).map(|_| ()).unwrap_err().to_string();
        let streamed = ObjStream::open(file(name, &text)).map(|_| ()).unwrap_err().to_string();
        for error in [whole, streamed] {
            assert!(error.contains(&format!("line {line}")), "{error}");
            assert!(error.contains(&format!("{}", vertices + 1)), "{error}");
        }
    }
}
