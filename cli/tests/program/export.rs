//! `binspace export`: reads the written files back.

use std::collections::HashMap;
use std::fs;

use binspace::glam::DVec3;
use binspace::scene::{Builtin, Scene};
use serde_json::Value;

use crate::png_picture::Picture;
use crate::run::Folder;

/// The vertices and faces of an OBJ file, and the polygon of each face.
fn obj(folder: &Folder, name: &str) -> (Vec<DVec3>, Vec<[usize; 3]>, Vec<usize>) {
    let text = fs::read_to_string(folder.path(name)).unwrap();
    let (mut vertices, mut faces, mut polygons) = (vec![], vec![], vec![]);
    let mut polygon = 0;
    for line in text.lines() {
        let (word, rest) = line.split_once(' ').unwrap();
        let words: Vec<&str> = rest.split(' ').collect();
        match word {
            "v" => vertices.push(DVec3::from([0, 1, 2].map(|k| words[k].parse::<f64>().unwrap()))),
            "f" => {
                faces.push([0, 1, 2].map(|k| words[k].parse::<usize>().unwrap() - 1));
                polygons.push(polygon);
            }
            "g" => polygon = words[0].strip_prefix("polygon_").unwrap().parse().unwrap(),
            "usemtl" | "mtllib" => {}
            _ => panic!("{line}"),
        }
    }
    (vertices, faces, polygons)
}

fn area(corners: &[DVec3]) -> f64 {
    let fan = corners.windows(2).map(|ends| (ends[0] - corners[0]).cross(ends[1] - corners[0]));
    0.5 * fan.sum::<DVec3>().length()
}

/// The number of face edges that do not run once in each direction.
fn open_edges(faces: &[[usize; 3]]) -> usize {
    let mut edges: HashMap<[usize; 2], i32> = HashMap::new();
    for &[a, b, c] in faces {
        for [from, to] in [[a, b], [b, c], [c, a]] {
            *edges.entry([from.min(to), from.max(to)]).or_default() +=
                if from < to { 1 } else { -1 };
        }
    }
    edges.values().filter(|&&count| count != 0).count()
}

#[test]
fn triangles_are_those_of_the_polygons_and_closed_bodies_stay_closed() {
    let folder = Folder::new("export_obj");
    let scene: Scene = Builtin::Newell.build(None, 1);
    folder.run("export newell -o s.obj").good();
    let (vertices, faces, polygons) = obj(&folder, "s.obj");
    assert_eq!(open_edges(&faces), 0);
    let mut areas = vec![0.0; scene.len()];
    for (face, &polygon) in faces.iter().zip(&polygons) {
        areas[polygon] += area(&face.map(|vertex| vertices[vertex]));
    }
    for (polygon, area_there) in areas.iter().enumerate() {
        assert!((area_there / area(scene.polygon(polygon)) - 1.0).abs() < 1e-9, "{polygon}");
    }
    let materials = fs::read_to_string(folder.path("s.mtl")).unwrap();
    assert!(materials.contains("newmtl colour_") && materials.contains("\nd 1.0"), "{materials}");
}

/// The plane of the second triangle cuts the third alone, on the edge that it shares with the first.
#[test]
fn a_cut_that_ends_on_an_edge_is_welded() {
    let folder = Folder::new("export_welded");
    folder.write(
        "s.obj",
        "v 0 0 0\nv 2 0 0\nv 1 -1 0\nv 1 0 2\nv 1 1 1\nv 1 2 1\nv 1 1 3\n\
         f 1 3 2\nf 5 6 7\nf 1 2 4\n",
    );
    let open = |options: &str| {
        folder.run(&format!("export s.obj -o t.obj --heuristic first {options}")).good();
        open_edges(&obj(&folder, "t.obj").1)
    };
    // The outlines; without welding, the whole edge and its two halves too.
    assert_eq!([open(""), open("--unwelded")], [7, 10]);
}

#[test]
fn all_formats_show_the_same_picture() {
    let folder = Folder::new("export_pictures");
    folder.write(
        "glass.obj",
        "mtllib glass.mtl\nv -1 -1 0.1\nv 1 -1 0.1\nv 1 1 0.1\nv -1 1 0.1\nv 0.3 -1 -1\n\
         v 0.3 1 -1\nv 0.3 1 1\nv 0.3 -1 1\nv -2 -2 -3\nv 2 -2 -3\nv 2 2 -3\nv -2 2 -3\n\
         usemtl red\nf 1 2 3 4\nusemtl blue\nf 5 6 7 8\nusemtl green\nf 9 10 11 12\n",
    );
    folder.write(
        "glass.mtl",
        "newmtl red\nKd 1 0 0\nd 0.4\nnewmtl blue\nKd 0 0.2 1\nnewmtl green\nKd 0.2 1 0\n",
    );
    let picture = |scene: &str| {
        let options = "--eye=3,2,6 --up y --size 80x60 -o p.png";
        folder.run(&format!("render {scene} {options}")).good();
        Picture::read(&folder.path("p.png"))
    };
    let expected = picture("glass.obj");
    assert!(expected.colours() > 4);
    for format in ["obj", "ply", "glb"] {
        let file = format!("s.{format}");
        folder.run(&format!("export glass.obj -o {file}")).good();
        let found = picture(&file);
        let differs = |(a, b): (&u8, &u8)| a.abs_diff(*b) > 2;
        let wrong = expected.rgb.iter().zip(&found.rgb).filter(|&pair| differs(pair)).count();
        assert!(wrong < 12, "{format}: {wrong} of {}", expected.rgb.len());
        folder.run(&format!("verify {file} --views 2 --size 40x30")).good();
        // To standard output, with the format named.
        let out =
            folder.command(&format!("export glass.obj -o - --format {format}")).output().unwrap();
        let file = fs::read(folder.path(&file)).unwrap();
        if format != "obj" {
            assert_eq!(out.stdout, file, "{format}");
        }
    }
    // Up is z in the scene, y in the file.
    folder.run("export teapot:3 -o t.glb").good();
    let stats = |scene: &str| {
        let line: Value =
            serde_json::from_str(&folder.run(&format!("stats {scene} --json")).good()).unwrap();
        line["polygons"].as_u64().unwrap()
    };
    folder.run("export teapot:3 -o t.ply").good();
    assert_eq!(stats("t.glb"), stats("t.ply"));
    let whole = |view: &str| {
        folder.run(&format!("render {view} --target=0,0,0 --size 80x60 -o p.png")).good();
        Picture::read(&folder.path("p.png")).rgb.chunks(3).filter(|rgb| *rgb != [255; 3]).count()
    };
    assert!(whole("t.glb --eye=9,3,4").abs_diff(whole("teapot:3 --eye=9,-4,3")) < 30);
}

#[test]
fn triangles_are_sorted_for_an_eye() {
    let folder = Folder::new("export_order");
    let listed = |mut polygons: Vec<usize>| {
        polygons.dedup();
        polygons
    };
    let order = folder.run("order random:60 --eye=9,-4,3").good();
    let number = |line: &str| {
        serde_json::from_str::<Value>(line).unwrap()["polygon"].as_u64().unwrap() as usize
    };
    let expected = listed(order.lines().map(number).collect());
    folder.run("export random:60 -o s.obj --order=9,-4,3").good();
    assert_eq!(listed(obj(&folder, "s.obj").2), expected);
    folder.run("export random:60 -o t.obj").good();
    assert_ne!(listed(obj(&folder, "t.obj").2), expected);
}

#[test]
fn files_of_no_format_are_refused() {
    let folder = Folder::new("export_refused");
    for output in ["s.stl", "s"] {
        let message = folder.run(&format!("export newell -o {output}")).refused();
        assert!(message.contains(".obj, .ply, .glb"), "{message}");
    }
    assert!(folder.run("export newell -o -").good().starts_with("v "));
    assert!(folder.run("export newell -o no/s.ply").refused().contains("cannot be written"));
    assert!(folder.files().is_empty());
}

/// Materials replace only a file that `export` wrote, and never the triangles.
#[test]
fn materials_replace_no_file_of_others() {
    let folder = Folder::new("export_materials");
    folder.write("mine.mtl", "newmtl mine\n");
    let message = folder.run("export cornell -o mine.obj").refused();
    assert!(message.contains("mine.mtl: `binspace export` did not write this file"), "{message}");
    assert_eq!(fs::read_to_string(folder.path("mine.mtl")).unwrap(), "newmtl mine\n");
    assert!(!folder.path("mine.obj").exists());
    let message = folder.run("export cornell -o same.mtl --format obj").refused();
    assert!(message.contains("name the output .obj"), "{message}");
    // Its own are replaced; a link's are beside the file that it names.
    folder.run("export cornell -o a.obj").good();
    folder.run("export crossing -o a.obj").good();
    assert!(!fs::read_to_string(folder.path("a.mtl")).unwrap().contains("newmtl mine"));
    #[cfg(unix)]
    {
        fs::create_dir(folder.path("real")).unwrap();
        folder.write("real/t.obj", "");
        std::os::unix::fs::symlink("real/t.obj", folder.path("link.obj")).unwrap();
        folder.run("export cornell -o link.obj").good();
        folder.run("stats real/t.obj").good();
        assert!(folder.path("real/t.mtl").exists() && !folder.path("link.mtl").exists());
        folder.run("export crossing -o /dev/null --format obj").good();
        assert!(!std::path::Path::new("/dev/null.mtl").exists());
    }
}

/// The name of the materials stood raw in the file, so a line break in it made a line of another meaning.
#[cfg(unix)]
#[test]
fn names_that_a_line_cannot_hold_are_refused() {
    use std::ffi::OsStr;
    use std::os::unix::ffi::OsStrExt;

    use crate::run::Run;

    let folder = Folder::new("export_names");
    let run = |name: &[u8]| {
        let mut command = folder.command("export cornell");
        Run::new(&command.arg("-o").arg(OsStr::from_bytes(name)).output().unwrap())
    };
    for name in [&b"a\nv 1 2 3.obj"[..], b"a\rb.obj", b"a\tb.obj", b" a.obj", b"a\xff.obj"] {
        let message = run(name).refused();
        assert!(message.contains("cannot name its file of materials"), "{message}");
        assert!(folder.files().is_empty());
    }
    // Files of other formats contain no name.
    run(b"a\nb.ply").good();
    run(b"a\nb.glb").good();
    run("b b#é.obj".as_bytes()).good();
    let text = fs::read_to_string(folder.path("b b#é.obj")).unwrap();
    assert!(text.starts_with("mtllib b b#é.mtl\nv "), "{text}");
    let message = folder.command("stats").arg("b b#é.obj").output().unwrap();
    assert!(!Run::new(&message).err.contains("not found"));
}
