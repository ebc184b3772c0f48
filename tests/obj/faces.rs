//! The data of faces that are kept, and the syntax of faces.

use crate::obj::{CORNERS, read, sides, with_corners};
use binspace::scene::ObjReport;
use testkit::prelude::*;
use testkit::targets::obj::polygons_of_tobj;

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
        with_corners("  # a path: C:\\\nf 1 2 3 4"),
        with_corners("\tf\t1\t2  3 4  "),
        with_corners("f 1 2 3 4").trim_end().to_owned(),
        with_corners("f -5 -4 -3 -2"),
        format!("f 1 2 3 4\n{CORNERS}"),
    ] {
        assert_eq!(read(&text).expect(&text), plain, "{text:?}");
    }
}

#[test]
fn normals_texture_weights_and_colours_change_no_polygon() {
    let polygons = |(scene, _): (Scene, ObjReport)| {
        scene.polygons().map(|polygon| polygon.points().to_vec()).collect::<Vec<_>>()
    };
    let plain = polygons(read(with_corners("f 1 2 3\nf 3 4 5")).unwrap());
    let faces = [
        "f 1/1/1 2/1/1 3/1/1\nf 3//1 4//1 5//1",
        "f 1/9/9 2/-9/-9 3/x/0\nf 3/ 4// 5/7",
        "vt 1\nvn nan\nvn 0 0\nf 1/1 2/1 3/1\nf 3 4 5/1",
    ];
    for face in faces {
        assert_eq!(polygons(read(with_corners(face)).expect(face)), plain, "{face}");
    }
    let weighted = CORNERS.replace("v 1 0 0", "v 1 0 0 2").replace("v 0 1 0", "v 0 1 0 1 0.5 0");
    let weighted = format!("{weighted}f 1 2 3\nf 3 4 5");
    assert_eq!(polygons(read(weighted).unwrap()), plain);
}

#[test]
fn bytes_that_are_no_utf8_may_stand_in_names() {
    let mut text = b"# caf\xe9\ng \xff\xc0\nusemtl gr\xfcn\n".to_vec();
    text.extend(with_corners("f 1 2 3").bytes());
    assert_eq!(read(text).unwrap().0.len(), 1);
}

#[test]
fn every_polygon_knows_its_line() {
    let text = "v 0 0 0\nv 1 0 0\n\nv 0 1 0\nf 1 2 3\n# f\nf 1 \\\n 2 3\nf 3 2 1\n";
    let (scene, _) = Scene::from_obj("lines", text.as_bytes(), |_| None).expect("a scene");
    assert_eq!([0, 1, 2, 3].map(|i| scene.line(i)), [Some(5), Some(7), Some(9), None]);
    assert_eq!(scene::newell_bars().line(0), None);
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

/// Faces of zero to nine corners name vertices before and after them, in all notations of numbers.
#[test]
fn faces_are_read_as_by_tobj() {
    let mut random = Dice(44);
    let (mut compared, mut ahead) = (0, 0);
    for _ in 0..400 {
        let (mut text, mut vertices) = (String::new(), 0);
        let (first, behind) = (1 + random.below(20), random.below(20));
        let in_all = 2 * first + behind;
        let vertex = |text: &mut String, random: &mut Dice| {
            let numbers = [0; 3].map(|_| random.below(2001) as f64 / 64.0 - 15.0);
            let colour = ["", " 0.5", " 1 0.5 0", " # last"][random.below(4)];
            *text += &format!("v {:e} {} {}{colour}\n", numbers[0], numbers[1], numbers[2]);
        };
        for round in 0..2 {
            (0..first).for_each(|_| vertex(&mut text, &mut random));
            vertices += first;
            for _ in 0..1 + random.below(9) {
                text += "f";
                for _ in 0..random.below(10) {
                    let number = 1 + random.below(in_all);
                    ahead += usize::from(number > vertices);
                    let is_negative = number <= vertices && random.below(2) == 0;
                    let number = number as i64 - if is_negative { vertices as i64 + 1 } else { 0 };
                    let others = ["", "/", "/1", "//1", "/1/-1", "/7/x"][random.below(6)];
                    text += &format!(" {number}{others}");
                }
                text += ["\n", " # face\n", "\nl 1 2\n", "\r\n", "\nusemtl a\n"][random.below(5)];
            }
            text += ["vt 0 1\nvn 0 0 1\n", ""][round];
        }
        (0..behind).for_each(|_| vertex(&mut text, &mut random));
        let (scene, _) = read(&text).expect(&text);
        let polygons = polygons_of_tobj(text.as_bytes()).expect("plain text");
        compared += polygons.len();
        assert!(scene.polygons().map(|p| p.points().to_vec()).eq(polygons), "{text}");
    }
    enough!(compared > 3000, ahead > 3000; "{compared} faces, {ahead} corners ahead");
}
