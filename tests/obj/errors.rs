//! Refused files, and their errors.

use crate::obj::{CORNERS, read, with_corners};
use binspace::internals::MAX_CORNERS;
use testkit::prelude::*;

/// Line, face and message of the error.
fn refused(text: impl AsRef<[u8]>) -> (Option<usize>, Option<usize>, String) {
    match read(text) {
        Ok((scene, _)) => panic!("accepted with {} polygons", scene.len()),
        Err(error) => (error.line_of_file(), error.polygon(), error.to_string()),
    }
}

#[test]
fn utf_32_is_not_called_utf_16() {
    for mark in [b"\xff\xfe\0\0", b"\0\0\xfe\xff"] {
        assert!(refused(mark).2.contains("this is UTF-32; save it as UTF-8"));
    }
    let unmarked: Vec<u8> = "v 1".chars().flat_map(|c| u32::from(c).to_le_bytes()).collect();
    assert!(refused(unmarked).2.contains("UTF-32"));
}

#[test]
fn wrong_encodings_are_named() {
    let utf16: Vec<u8> =
        with_corners("f 1 2 3").encode_utf16().flat_map(u16::to_le_bytes).collect();
    let big: Vec<u8> = utf16.chunks(2).flat_map(|pair| [pair[1], pair[0]]).collect();
    for marked in [[b"\xff\xfe", &utf16[..]].concat(), [b"\xfe\xff", &big[..]].concat()] {
        assert!(refused(marked).2.contains("UTF-16; save it as UTF-8"));
    }
    for unmarked in [utf16, big] {
        let (line, _, message) = refused(unmarked);
        assert_eq!(line, Some(1));
        assert!(message.contains("save it as UTF-8"), "{message}");
    }
}

#[test]
fn bad_coordinates_are_refused_with_their_line() {
    for (vertex, reason) in [
        ("v nan 0 0", "not finite"),
        ("v 0 inf 0", "not finite"),
        ("v 0 0 -Infinity", "not finite"),
        ("v 1e999 0 0", "not finite"),
        ("v 0 3.1+e2 0", "not a number"),
        ("v 0 0,5 0", "not a number"),
        ("v 0 0", "needs x, y and z"),
        ("v", "needs x, y and z"),
        ("v 0 0 # 0", "needs x, y and z"),
    ] {
        let (line, face, message) = refused(format!("{CORNERS}\n{vertex}\nf 1 2 3\n"));
        assert_eq!((line, face), (Some(7), None), "{vertex}");
        assert!(message.starts_with("test.obj, line 7: "), "{message}");
        assert!(message.contains(reason), "{message}");
    }
}

/// In 32 bits, each of these would be another number or not a number.
#[test]
fn coordinates_are_read_in_64_bits() {
    for text in ["1e39", "0.1", "16777217", "1.7976931348623157e308", "5e-324"] {
        let (scene, _) = read(with_corners(&format!("v {text} 0 -{text}\nf 1 2 6"))).expect(text);
        let number: f64 = text.parse().unwrap();
        assert_eq!(scene.polygon(0)[2].to_array(), [number, 0.0, -number]);
    }
}

#[test]
fn bad_corners_are_refused_with_line_and_face() {
    for (corner, reason) in [
        ("6", "vertex 6 does not exist; there are 5"),
        ("-6", "vertex -6 does not exist"),
        ("0", "the first vertex is 1"),
        ("4294967296", "does not exist"),
        ("4294967297", "does not exist"),
        ("99999999999999999999", "does not exist"),
        ("-99999999999999999999", "does not exist"),
        ("9223372036854775807", "does not exist"),
        ("-9223372036854775808", "does not exist"),
        ("1.5", "does not name a vertex"),
        ("x", "does not name a vertex"),
        ("/1", "does not name a vertex"),
        ("1\u{fffd}", "does not name a vertex"),
    ] {
        let (line, face, message) =
            refused(with_corners(&format!("f 1 2 3\n\nf 1 2 {corner}\nf 3 4 5")));
        assert_eq!((line, face), (Some(8), Some(1)), "{corner}");
        assert!(message.starts_with("test.obj, line 8, face 1 (from 0): "), "{message}");
        assert!(message.contains(reason), "{message}");
    }
}

#[test]
fn a_face_of_more_corners_than_a_tree_takes_is_refused_where_it_is_read() {
    let face = |corners: usize| {
        format!("v 0 0 0\nv 1 0 0\nv 0 1 0\nf{}\n", " 1 2 3 1".repeat(corners / 4))
    };
    let (line, face, message) = refused(face(MAX_CORNERS + 4));
    assert_eq!((line, face), (Some(4), Some(0)), "{message}");
    assert!(message.contains("corners"), "{message}");
}

#[test]
fn a_file_without_faces_is_refused() {
    for text in ["", "\n\n", "# nothing", CORNERS, &with_corners("l 1 2 3\np 1")] {
        assert!(refused(text).2.contains("no faces"), "{text:?}");
    }
}

#[test]
fn unreadable_files_are_errors() {
    for path in ["no/such/file.obj", "src"] {
        let error = Scene::read_obj(path).expect_err("not a file");
        assert!(error.to_string().starts_with(path), "{error}");
        assert!(std::error::Error::source(&error).is_some());
    }
}

#[test]
fn the_first_face_with_the_highest_vertex_is_named_and_no_line_if_there_is_no_face() {
    let corners = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
    let (line, face, _) = refused(format!("{corners}f 1 2 9\nf 1 2 9\n"));
    assert_eq!((line, face), (Some(4), Some(0)));
    let (line, face, message) = refused(corners);
    assert_eq!((line, face), (None, None));
    assert!(message.starts_with("test.obj: no faces"), "{message}");
}
