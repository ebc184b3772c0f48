//! Reading OBJ files: what is kept, what is refused, and that nothing panics.
#![cfg(feature = "obj")]
// A skipped test says so.
#![allow(clippy::print_stderr)]

use binspace::glam::{DVec3, dvec3};
use binspace::scene::{self, Material, ObjError, ObjReport, Scene};
use proptest::prelude::*;
use std::path::{Path, PathBuf};

fn read(text: impl AsRef<[u8]>) -> Result<(Scene, ObjReport), ObjError> {
    Scene::from_obj("test.obj", text.as_ref(), |_| None)
}

fn read_with(text: &str, libraries: &[(&str, &str)]) -> (Scene, ObjReport) {
    let find = |path: &Path| {
        let found = libraries.iter().find(|(name, _)| Path::new(name) == path);
        found.map(|(_, content)| content.as_bytes().to_vec())
    };
    Scene::from_obj("test.obj", text.as_bytes(), find).expect(text)
}

fn sides(scene: &Scene) -> Vec<usize> {
    scene.polygons().map(<[DVec3]>::len).collect()
}

/// Line, face and message of the error.
fn refused(text: impl AsRef<[u8]>) -> (Option<usize>, Option<u32>, String) {
    match read(text) {
        Ok((scene, _)) => panic!("accepted with {} polygons", scene.len()),
        Err(error) => (error.line(), error.face(), error.to_string()),
    }
}

/// Five corners; the last stands apart.
const CORNERS: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 5\n";

fn with_corners(rest: &str) -> String {
    format!("{CORNERS}{rest}\n")
}

#[test]
fn polygons_keep_their_sides_order_and_place() {
    let text = with_corners(
        "o one\nf 1 2 3 4\ng two\nusemtl red\nf 1 2 5\nf 1\nusemtl blue\nf\nf 2 3 5\n\
         usemtl red\nf 1 2 3 4 5\ng\nf 1 1 1\nf 3 4 5\n",
    );
    let (scene, report) = read(text).unwrap();
    assert_eq!(sides(&scene), [4, 3, 1, 0, 3, 5, 3, 3]);
    assert_eq!((report.faces, report.degenerate_faces), (8, 3));
    assert_eq!(scene.polygon(4), [dvec3(1., 0., 0.), dvec3(1., 1., 0.), dvec3(0., 0., 5.)]);
    let names: Vec<&str> = (0..8).map(|i| scene.material(i).name.as_str()).collect();
    assert_eq!(names, ["", "red", "red", "blue", "blue", "red", "red", "red"]);
    assert_eq!(report.missing_materials, ["red", "blue"]);
}

#[test]
fn only_triangles_stay_triangles() {
    let (scene, report) = read(with_corners("f 1 2 3\nf 1 3 4")).unwrap();
    assert_eq!(sides(&scene), [3, 3]);
    assert!(report.is_clean());
}

#[test]
fn a_face_of_two_different_corners_is_degenerate() {
    let (scene, report) = read(with_corners("f 1 2 1 2 2\nf 1 2 3 1")).unwrap();
    assert_eq!(sides(&scene), [5, 4]);
    assert_eq!(report.degenerate_faces, 1);
}

#[test]
fn points_lines_and_curves_are_no_faces() {
    let (scene, report) = read(with_corners("p 1\nl 1 2 3\nl 1 2\ncurv 0 1 1 2\nf 1 2 3")).unwrap();
    assert_eq!(sides(&scene), [3]);
    assert_eq!((report.skipped_points, report.skipped_lines), (1, 2));
    assert_eq!(report.skipped_statements, 1);
    assert!(!report.to_string().is_empty());
}

#[test]
fn byte_order_mark_loses_no_line() {
    let marked = format!("\u{feff}{}", with_corners("f 1 2 3 4"));
    assert_eq!(read(marked).unwrap().0.polygon(0)[1], DVec3::X);
}

#[test]
fn line_ends_continuations_and_comments_do_not_matter() {
    let plain = read(with_corners("f 1 2 3 4")).unwrap();
    for text in [
        with_corners("f 1 2 3 4").replace('\n', "\r\n"),
        with_corners("f 1 2 3 4").replace('\n', "\r"),
        with_corners("f 1 2 \\\n 3 4"),
        with_corners("f 1 2 3 4 # the floor"),
        with_corners("# a path: C:\\\nf 1 2 3 4"),
        with_corners("\tf\t1\t2  3 4  "),
        with_corners("f 1 2 3 4").trim_end().to_owned(),
        with_corners("f -5 -4 -3 -2"),
        format!("f 1 2 3 4\n{CORNERS}"),
    ] {
        assert_eq!(read(&text).expect(&text), plain, "{text:?}");
    }
}

#[test]
fn normals_texture_weights_and_colours_are_left_out() {
    let plain = read(with_corners("f 1 2 3\nf 3 4 5")).unwrap();
    let faces = [
        "f 1/1/1 2/1/1 3/1/1\nf 3//1 4//1 5//1",
        "f 1/9/9 2/-9/-9 3/x/0\nf 3/ 4// 5/7",
        "vt 1\nvn nan\nvn 0 0\nf 1/1 2/1 3/1\nf 3 4 5/1",
    ];
    for face in faces {
        assert_eq!(read(with_corners(face)).expect(face), plain, "{face}");
    }
    let weighted = CORNERS.replace("v 1 0 0", "v 1 0 0 2").replace("v 0 1 0", "v 0 1 0 1 0.5 0");
    let weighted = format!("{weighted}f 1 2 3\nf 3 4 5");
    assert_eq!(read(weighted).unwrap(), plain);
}

#[test]
fn bytes_that_are_no_utf8_may_stand_in_names() {
    let mut text = b"# caf\xe9\ng \xff\xc0\nusemtl gr\xfcn\n".to_vec();
    text.extend(with_corners("f 1 2 3").bytes());
    assert_eq!(read(text).unwrap().0.len(), 1);
}

#[test]
fn materials_whose_names_differ_in_one_byte_that_is_no_utf8_have_their_own_colours() {
    let mut text = with_corners("").into_bytes();
    let mut library = Vec::new();
    // 0xA0 and 0x85 are spaces in Latin-1, and halves of letters elsewhere.
    let names = [&b"\xe8"[..], b"\xe9", b"a", b"a\xa0", b"a\x85", b"\xc3\xa9"];
    for (number, name) in names.iter().enumerate() {
        text.extend([b"usemtl ", *name, b"\nf 1 2 3\n"].concat());
        library.extend([b"newmtl ", *name, format!("\nKd 0.{number} 0 0\n").as_bytes()].concat());
    }
    let (scene, report) =
        Scene::from_obj("s", &[b"mtllib m\n", &text[..]].concat(), |_| Some(library.clone()))
            .expect("a scene");
    assert!(report.is_clean(), "{report}");
    for number in 0..names.len() {
        assert_eq!(scene.material(number).color[0], number as f32 / 10.0);
    }
    assert_eq!(scene.material(1).name, "é");
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
        ("v 0 0", "must give x, y and z"),
        ("v", "must give x, y and z"),
        ("v 0 0 # 0", "must give x, y and z"),
    ] {
        let (line, face, message) = refused(format!("{CORNERS}\n{vertex}\nf 1 2 3\n"));
        assert_eq!((line, face), (Some(7), None), "{vertex}");
        assert!(message.starts_with("test.obj, line 7: "), "{message}");
        assert!(message.contains(reason), "{message}");
    }
}

/// tobj's own number type would turn it into infinity where that is `f32`.
#[test]
fn a_coordinate_beyond_32_bits_is_read_or_refused_but_never_infinite() {
    match read(with_corners("v 1e39 0 0\nf 1 2 6")) {
        Ok((scene, _)) => assert_eq!(scene.polygon(0)[2].x, 1e39),
        Err(error) => {
            assert_eq!(error.line(), Some(6));
            assert!(error.to_string().contains("too large for 32 bits"));
        }
    }
}

#[test]
fn bad_corners_are_refused_with_line_and_face() {
    for (corner, reason) in [
        ("6", "vertex 6 does not exist; there are 5"),
        ("-6", "vertex -6 does not exist"),
        ("0", "the first is 1"),
        ("4294967297", "does not exist"),
        ("99999999999999999999", "does not exist"),
        ("-99999999999999999999", "does not exist"),
        ("9223372036854775807", "does not exist"),
        ("-9223372036854775808", "does not exist"),
        ("1.5", "names no vertex"),
        ("x", "names no vertex"),
        ("/1", "names no vertex"),
        ("1\u{fffd}", "names no vertex"),
    ] {
        let (line, face, message) =
            refused(with_corners(&format!("f 1 2 3\n\nf 1 2 {corner}\nf 3 4 5")));
        assert_eq!((line, face), (Some(8), Some(1)), "{corner}");
        assert!(message.starts_with("test.obj, line 8, face 1 (from 0): "), "{message}");
        assert!(message.contains(reason), "{message}");
    }
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
fn materials_come_from_the_library() {
    let library = "newmtl red\nKd 0.9 0.1 0\nd 0.5\nnewmtl grey one\n\tKd\t0.25 # grey\nTr 0.75\n\
                   newmtl both\nd 0.5\nTr 0.9\nnewmtl plain\nKd 1 2 -3\n";
    let faces =
        ["red", "grey one", "both", "plain"].map(|name| format!("usemtl {name}\nf 1 2 3\n"));
    let text = with_corners(&format!("mtllib a file.mtl\nmtllib a file.mtl\n{}", faces.concat()));
    let (scene, report) = read_with(&text, &[("a file.mtl", library)]);
    assert!(report.is_clean(), "{report}");
    let looks: Vec<_> = scene.materials().iter().map(|m| (m.color, m.opacity)).collect();
    let expected = [
        ([0.9, 0.1, 0.0], 0.5),
        ([0.25; 3], 0.25),
        (Material::DEFAULT.color, 0.5),
        ([1.0, 1.0, 0.0], 1.0),
    ];
    assert_eq!(looks, expected);
}

#[test]
fn missing_libraries_and_materials_are_reported() {
    let text = with_corners("mtllib gone.mtl\nusemtl red\nf 1 2 3\nusemtl\nf 1 2 3");
    let (scene, report) = read_with(&text, &[]);
    assert_eq!(report.missing_libraries, ["gone.mtl"]);
    assert_eq!(report.missing_materials, ["red"]);
    assert_eq!(scene.material(0).color, Material::DEFAULT.color);
    assert_eq!(scene.material(1), &Material::DEFAULT);
    assert!(report.to_string().contains("gone.mtl"));
}

#[test]
fn several_libraries_may_stand_in_one_line() {
    let text = with_corners("mtllib a.mtl sub\\b.mtl\nmtllib sub\\b.mtl\nusemtl red\nf 1 2 3");
    let (scene, report) = read_with(&text, &[("a.mtl", ""), ("sub/b.mtl", "newmtl red\nKd 1 0 0")]);
    assert_eq!(scene.material(0).color, [1.0, 0.0, 0.0]);
    assert_eq!(report.missing_libraries, ["a.mtl sub\\b.mtl"]);
}

/// `tobj` panics on a `Kd` of one number and drops the library for any bad line.
#[test]
fn bad_lines_in_a_library_spoil_nothing_else() {
    let library = "Kd 1 1 1\nnewmtl\nKd 0 0 0\nnewmtl red\nKd 1 x\nKd 1 2\nKd nan 0 0\nKd\nd\nNs\n\
                   map_Kd\nillum\nKs 1\nKd spectral file.rfl 1\nd -halo 0.5\nKd 1 0 0\nillum x\n";
    let (scene, report) =
        read_with(&with_corners("mtllib a.mtl\nusemtl red\nf 1 2 3"), &[("a.mtl", library)]);
    assert_eq!(scene.material(0).color, [1.0, 0.0, 0.0]);
    assert_eq!(report.skipped_material_lines, 8);
    assert!(report.missing_materials.is_empty());
}

#[test]
fn long_continuations_and_large_faces_are_read_in_linear_time() {
    let mut text = CORNERS.to_owned();
    text.push('f');
    for _ in 0..200_000 {
        text.push_str(" \\\n1 2 3");
    }
    let (scene, _) = read(text).unwrap();
    assert_eq!(sides(&scene), [600_000]);
}

/// What a scene read from anything must satisfy.
fn check(result: Result<(Scene, ObjReport), ObjError>) {
    match result {
        Ok((scene, report)) => {
            assert_eq!(scene.len(), report.faces as usize);
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
        let mut text = with_corners("mtllib a\nusemtl b\nf 1/1 2/2 3/3 4/4\nf -1 -2 -3\nl 1 2").into_bytes();
        for (place, byte) in damage {
            let place = place.index(text.len());
            text[place] = byte;
        }
        check(read(text));
    }
}

/// The folder of real scenes, or `None` after saying why the test is skipped.
fn real_scenes() -> Option<PathBuf> {
    let folder = std::env::var_os("BINSPACE_SCENES").map(PathBuf::from);
    if folder.is_none() {
        eprintln!("skipped: BINSPACE_SCENES does not name the folder of real scenes");
    }
    folder
}

/// The manifest's rows: name, faces, triangles, quads, larger, low, high.
fn manifest(folder: &Path) -> Vec<(String, [usize; 4], DVec3, DVec3)> {
    let text = std::fs::read_to_string(folder.join("MANIFEST.md")).expect("a manifest");
    let numbers = |cell: &str| -> Vec<f64> {
        let words = cell.split(|c: char| !(c.is_ascii_digit() || ".-".contains(c)));
        words.filter_map(|word| word.parse().ok()).collect()
    };
    let rows = text.lines().filter(|line| line.contains(".obj |"));
    rows.map(|row| {
        let cells: Vec<&str> = row.split('|').map(str::trim).collect();
        let (faces, kinds, bounds) = (numbers(cells[2]), numbers(cells[3]), numbers(cells[4]));
        let counts = [faces[0], kinds[0], kinds[1], kinds[2]].map(|count| count as usize);
        let [low, high] = [&bounds[..3], &bounds[3..6]].map(DVec3::from_slice);
        (cells[1].to_owned(), counts, low, high)
    })
    .collect()
}

#[test]
fn real_scenes_match_their_manifest() {
    let Some(folder) = real_scenes() else { return };
    let rows = manifest(&folder);
    assert!(rows.len() >= 10, "{} rows", rows.len());
    for (name, counts, low, high) in rows {
        if !folder.join(&name).exists() {
            eprintln!("skipped: {name} is not there");
            continue;
        }
        let (scene, report) = Scene::read_obj(folder.join(&name)).expect(&name);
        let sides = sides(&scene);
        let count = |wanted: fn(usize) -> bool| sides.iter().filter(|&&n| wanted(n)).count();
        let found = [scene.len(), count(|n| n == 3), count(|n| n == 4), count(|n| n > 4)];
        assert_eq!(found, counts, "{name}");
        let (least, most) = scene.bounds().unwrap_or_default();
        let error = (least - low).abs().max((most - high).abs()).max_element();
        assert!(error < 1e-4 * (high - low).max_element(), "{name}: {least} {most}");
        assert!(report.is_clean(), "{name}: {report}");
    }
}

#[test]
fn torture_files_are_read_or_refused_with_a_reason() {
    let Some(folder) = real_scenes() else { return };
    let read = |name: &str| Scene::read_obj(folder.join("torture").join(name));
    for (name, reason) in [
        ("box_UTF16BE.obj", "UTF-16"),
        ("testline.obj", "no faces"),
        ("testpoints.obj", "no faces"),
        ("number_formats.obj", "line 11"),
    ] {
        let error = read(name).expect_err(name).to_string();
        assert!(error.contains(reason), "{error}");
    }
    for (name, faces, degenerate) in [
        ("box_mat_with_spaces.obj", 6, 0),
        ("concave_polygon.obj", 1, 0),
        ("cube_usemtl.obj", 12, 0),
        ("cube_with_vertexcolors_uni.obj", 12, 0),
        ("malformed2.obj", 6, 1),
        ("regr_3429812.obj", 3, 0),
    ] {
        let (scene, report) = read(name).expect(name);
        assert_eq!((scene.len(), report.degenerate_faces), (faces, degenerate), "{name}");
    }
    assert!(read("empty_mat.obj").is_ok());
}

/// Two independent evaluations of the published patches: every corner of one is
/// a corner of the other. The file has 5 decimals.
#[test]
fn generated_teapot_agrees_with_the_real_one() {
    let Some(folder) = real_scenes() else { return };
    let (file, _) = Scene::read_obj(folder.join("teapot_quads_2k.obj")).expect("the teapot");
    let ours = scene::teapot(8);
    assert_eq!(file.len(), ours.len());
    for (from, to) in [(&file, &ours), (&ours, &file)] {
        for corner in from.polygons().flatten() {
            let nearest = to.polygons().flatten().map(|p| p.distance_squared(*corner));
            let distance = nearest.fold(f64::MAX, f64::min).sqrt();
            assert!(distance < 2e-5, "{corner}: {distance}");
        }
    }
}

#[test]
fn generated_cornell_box_agrees_with_the_real_one() {
    let Some(folder) = real_scenes() else { return };
    let (file, _) = Scene::read_obj(folder.join("cornell_box.obj")).expect("the Cornell box");
    let ours = scene::cornell_box();
    let near = |a: &DVec3, b: &DVec3| a.distance(*b) < 1e-4;
    for (a, b) in file.polygons().zip(ours.polygons()) {
        let same = a.iter().all(|p| b.iter().any(|q| near(p, q)));
        assert!(same, "{a:?} {b:?}");
    }
}

#[test]
fn every_polygon_knows_its_line() {
    let text = "v 0 0 0\nv 1 0 0\n\nv 0 1 0\nf 1 2 3\n# f\nf 1 \\\n 2 3\nf 3 2 1\n";
    let (scene, _) = Scene::from_obj("lines", text.as_bytes(), |_| None).expect("a scene");
    assert_eq!([0, 1, 2, 3].map(|i| scene.line(i)), [Some(5), Some(7), Some(9), None]);
    assert_eq!(binspace::scene::newell_bars().line(0), None);
}
