//! Materials and the libraries they come from.

use crate::obj::{read_with, with_corners};
use binspace::scene::Material;
use std::path::Path;
use testkit::prelude::*;

#[test]
fn materials_come_from_the_library() {
    let library = "newmtl red\nKd 0.9 0.1 0\nd 0.5\nnewmtl grey one\n\tKd\t0.25 # grey\nTr 0.75\n\
                   newmtl both\nd 0.5\nTr 0.9\nnewmtl plain\nKd 1 2 -3\n";
    let faces =
        ["red", "grey one", "both", "plain"].map(|name| format!("usemtl {name}\nf 1 2 3\n"));
    let text = with_corners(&format!("mtllib a file.mtl\nmtllib a file.mtl\n{}", faces.concat()));
    let (scene, report) = read_with(&text, &[("a file.mtl", library)]);
    assert_eq!(report.clamped_material_lines, ["a file.mtl:11"]);
    assert_eq!(report.to_string(), "colours and opacities clamped to 0 or 1: a file.mtl:11");
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

#[test]
fn libraries_outside_the_folder_are_never_read() {
    for (name, asked) in [
        ("../a.mtl", vec![]),
        ("sub/../../a.mtl", vec![]),
        ("/etc/passwd", vec![]),
        ("..", vec![]),
        // On systems where a backslash is not a separator, a name may contain it.
        ("..\\a.mtl", if cfg!(windows) { vec![] } else { vec!["..\\a.mtl"] }),
        ("a.mtl ../b.mtl", vec!["a.mtl ../b.mtl", "a.mtl"]),
    ] {
        let mut names = Vec::new();
        let text = with_corners(&format!("mtllib {name}\nusemtl red\nf 1 2 3"));
        let library = |path: &Path| {
            names.push(path.to_str().unwrap().to_owned());
            None
        };
        let (_, report) = Scene::from_obj("s", text.as_bytes(), library).expect("a scene");
        assert_eq!(names, asked, "{name}");
        assert_eq!(report.outside_libraries, [name]);
        assert!(report.missing_libraries.is_empty());
        assert!(report.to_string().contains("outside the file's folder, not read: "), "{report}");
    }
}

/// `tobj` panics on a `Kd` of one number and drops the library for any bad line.
#[test]
fn textures_are_counted() {
    let library =
        "map_Kd none.png\nnewmtl a\nKd 1 0 0\nmap_Kd a.png\nmap_d -s 2 2 2 b.png\nmap_Bump c.png\n";
    let (_, report) =
        read_with(&with_corners("mtllib m.mtl\nusemtl a\nf 1 2 3"), &[("m.mtl", library)]);
    assert_eq!(report.skipped_textures, 2);
    assert_eq!(report.to_string(), "textures skipped: 2");
}

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
fn materials_whose_names_differ_in_one_byte_that_is_no_utf8_have_their_own_colours() {
    let mut text = with_corners("").into_bytes();
    let mut library = Vec::new();
    // 0xA0 and 0x85 are spaces in Latin-1, and parts of letters in UTF-8.
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
