//! Bytes, words and damaged files: anything is read or refused, and nothing panics.

use crate::obj::{read, with_corners};
use binspace::scene::ObjReport;
use proptest::prelude::*;
use testkit::prelude::*;

/// Requirements for a scene read from any bytes.
fn check(result: Result<(Scene, ObjReport), binspace::Error>) {
    match result {
        Ok((scene, report)) => {
            assert_eq!(scene.len(), report.faces);
            assert!(scene.polygons().flatten().all(|p| p.is_finite()));
            assert!((0..scene.len()).all(|i| scene.material(i).opacity <= 1.0));
            let _ = report.to_string();
        }
        Err(error) => assert!(error.to_string().starts_with("test.obj")),
    }
}

/// Words and separators from which plausible and broken files are made.
const WORDS: [&str; 44] = [
    "v",
    "v 0 0 0",
    "v 1 0 0\nv 0 1 0\nv 0 0 1\n",
    "vt 0 0",
    "vn 0 0 1",
    "f",
    "f 1 2 3",
    "f 1 2 3 4",
    "f -1 -2 -3",
    "f 1/1/1 2//1 3/",
    "l 1 2 3",
    "p 1",
    "o",
    "g a b",
    "s off",
    "usemtl a",
    "usemtl",
    "mtllib a.mtl",
    "mtllib",
    "newmtl a",
    "newmtl",
    "Kd 1 0 0",
    "Kd 1",
    "d 0.5",
    "Tr 2",
    "1",
    "-1",
    "0",
    "3",
    "1e39",
    "1e999",
    "nan",
    "-inf",
    "99999999999999999999",
    "/",
    "//",
    "\\\n",
    "\r",
    "\n",
    "\r\n",
    "#",
    "\u{feff}",
    "\u{a0}",
    "\0",
];

fn soup() -> impl Strategy<Value = String> {
    let word = prop::sample::select(&WORDS[..]);
    let gap = prop::sample::select(&["\n", "\n", "\n", " ", "\t", ""][..]);
    prop::collection::vec((word, gap), 0..60)
        .prop_map(|words| words.into_iter().flat_map(|(word, gap)| [word, gap]).collect())
}

proptest! {
    #![proptest_config(cases(256, file!()))]

    #[test]
    fn any_bytes_are_read_or_refused(text: Vec<u8>, library: Vec<u8>) {
        check(Scene::from_obj("test.obj", &text, |_| Some(library.clone())));
    }

    #[test]
    fn any_words_are_read_or_refused(text in soup(), library in soup()) {
        check(Scene::from_obj("test.obj", text.as_bytes(), |_| Some(library.clone().into_bytes())));
    }

    #[test]
    fn any_damage_to_a_file_is_read_or_refused(
        damage in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..8),
    ) {
        let faces = "mtllib a\nusemtl b\nf 1/1 2/2 3/3 4/4\nf -1 -2 -3\nl 1 2";
        let mut text = with_corners(faces).into_bytes();
        for (place, byte) in damage {
            let place = place.index(text.len());
            text[place] = byte;
        }
        check(read(text));
    }
}
