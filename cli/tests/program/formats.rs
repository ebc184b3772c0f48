//! Files other than OBJ.

use std::fs;

use crate::run::{Folder, Run};

/// A wall with a floor in front of it, as OBJ and in other formats.
const OBJ: &str = "v 0 0 0\nv 4 0 0\nv 4 4 0\nv 0 4 0\nv 0 -1 1\nv 4 -1 1\nv 4 2 -1\nv 0 2 -1\nf 1 2 3\nf 1 3 4\nf 5 6 7\nf 5 7 8\n";
const TRIANGLES: [[usize; 3]; 4] = [[0, 1, 2], [0, 2, 3], [4, 5, 6], [4, 6, 7]];

fn vertices() -> Vec<[f32; 3]> {
    let lines = OBJ.lines().filter_map(|line| line.strip_prefix("v "));
    let numbers = |line: &str| {
        let numbers: Vec<f32> = line.split(' ').map(|word| word.parse().unwrap()).collect();
        <[f32; 3]>::try_from(numbers).unwrap()
    };
    lines.map(numbers).collect()
}

fn bytes(numbers: impl IntoIterator<Item = f32>) -> Vec<u8> {
    numbers.into_iter().flat_map(f32::to_le_bytes).collect()
}

fn stl(count: u32) -> Vec<u8> {
    let mut file = vec![0; 80];
    file.extend(count.to_le_bytes());
    for triangle in TRIANGLES {
        file.extend(bytes([0.0; 3]));
        triangle.iter().for_each(|&corner| file.extend(bytes(vertices()[corner])));
        file.extend([0; 2]);
    }
    file
}

fn text(head: &str) -> String {
    let mut file = head.to_owned();
    for [x, y, z] in vertices() {
        file += &format!("{x} {y} {z}\n");
    }
    for [a, b, c] in TRIANGLES {
        file += &format!("3 {a} {b} {c}\n");
    }
    file
}

fn ply() -> String {
    text(
        "ply\nformat ascii 1.0\nelement vertex 8\nproperty float x\nproperty float y\n\
         property float z\nelement face 4\nproperty list uchar int vertex_indices\nend_header\n",
    )
}

/// Its buffer is a file.
fn gltf(uri: &str) -> (String, Vec<u8>) {
    let corners = TRIANGLES.iter().flatten().map(|&corner| vertices()[corner]);
    let json = format!(
        r#"{{"asset":{{"version":"2.0"}},"nodes":[{{"mesh":0}}],
        "meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}}}}]}}],
        "accessors":[{{"bufferView":0,"componentType":5126,"count":12,"type":"VEC3"}}],
        "bufferViews":[{{"buffer":0,"byteLength":144}}],
        "buffers":[{{"uri":"{uri}","byteLength":144}}]}}"#
    );
    (json, bytes(corners.flatten()))
}

/// The kind does not depend on the file's name.
#[test]
fn all_formats_have_the_same_order() {
    let folder = Folder::new("formats_order");
    folder.write("s.obj", OBJ);
    folder.write("s.stl", stl(4));
    folder.write("stl.obj", stl(4));
    folder.write("s.ply", ply());
    folder.write("noname", ply());
    folder.write("s.off", text("OFF 8 4 0\n"));
    let (json, buffer) = gltf("a%20buffer.bin");
    folder.write("s.gltf", json);
    folder.write("a buffer.bin", buffer);
    let order = |scene: &str| folder.run(&format!("order {scene} --eye=1,2,9"));
    let expected = order("s.obj").good();
    // The floor penetrates the wall.
    assert!(expected.lines().count() > 4);
    for scene in ["s.stl", "stl.obj", "s.ply", "noname", "s.off", "s.gltf"] {
        assert_eq!(order(scene).good(), expected, "{scene}");
    }
    for file in [stl(4), ply().into_bytes(), text("OFF\n8 4 0\n").into_bytes()] {
        let run = Run::new(&folder.pipe("order - --eye=1,2,9", file));
        assert_eq!(run.good(), expected);
    }
    // Trees built from them hold the same polygons.
    folder.run("build s.gltf -o s.bsp").good();
    assert_eq!(order("s.bsp").good(), expected);
    folder.run("build s.stl --cells 2 -o cells").good();
    assert!(order("cells").good().lines().count() > 4);
    for scene in ["s.stl", "s.ply", "s.off", "s.gltf"] {
        let run = folder.run(&format!("verify {scene} --views 2 --size 40x30"));
        assert!(!run.err.contains("z points up"), "{run:?}");
        run.good();
    }
}

/// The up direction of a picture: the wall is at the top if y is up.
#[test]
fn up_is_that_of_the_format() {
    let folder = Folder::new("formats_up");
    folder.write("s.obj", OBJ);
    folder.write("s.stl", stl(4));
    let (json, buffer) = gltf("b.bin");
    folder.write("s.gltf", json);
    folder.write("b.bin", buffer);
    let picture = |options: &str| {
        folder.run(&format!("render {options} -o p.png --size 40x30")).good();
        fs::read(folder.path("p.png")).unwrap()
    };
    let [y_up, z_up] = ["s.obj --up y", "s.obj --up z"].map(picture);
    assert_ne!(y_up, z_up);
    assert_eq!(picture("s.gltf"), y_up);
    assert_eq!(picture("s.stl"), z_up);
}

#[test]
fn files_that_are_not_read_are_named() {
    let folder = Folder::new("formats_other");
    let reads = "binspace reads OBJ, STL, PLY, OFF and glTF 2.0 files";
    for (name, content, kind) in [
        ("part.step", &b"ISO-10303-21;\nHEADER;\n"[..], "this is a STEP or IFC file"),
        ("part.obj", b"ISO-10303-21;\nHEADER;\n", "this is a STEP or IFC file"),
        ("page.stl", b"<!DOCTYPE html>\n<html></html>", "this is an HTML page"),
        ("scene.fbx", b"Kaydara FBX Binary  \0", "this is an FBX file"),
        ("notes", b"Dear all,\nthe scene is attached.\n", "unknown kind of text file"),
        ("data", b"\x01\x02\0\x03 nothing known", "unknown kind of binary file"),
    ] {
        folder.write(name, content);
        for command in ["stats", "order --eye=1,2,3", "build -o out --cells 2", "verify"] {
            let message = folder.run(&format!("{command} {name}")).refused();
            assert!(message.contains(kind) && message.contains(reads), "{command}: {message}");
            assert!(message.contains(name), "{message}");
        }
        let message = Run::new(&folder.pipe("stats -", content)).refused();
        assert!(message.contains("standard input: ") && message.contains(kind), "{message}");
    }
    // An OBJ file with an error is one.
    folder.write("s.obj", "v 0 0 0\nf 1 2 3\n");
    assert!(folder.run("stats s.obj").refused().contains("s.obj, line 2"));
}

#[test]
fn copies_of_meshes_in_a_gltf_are_left_out_and_that_is_said() {
    let folder = Folder::new("formats_copies");
    let (json, buffer) = gltf("b.bin");
    folder.write("b.bin", &buffer);
    for (extension, is_said) in [("EXT_mesh_gpu_instancing", true), ("EXT_other", false)] {
        let used = format!("{{\"extensionsUsed\":[\"{extension}\"],");
        folder.write("s.gltf", json.replacen('{', &used, 1));
        let run = folder.run("stats s.gltf");
        let said = "copies of meshes by EXT_mesh_gpu_instancing skipped";
        assert_eq!(run.err.contains(said), is_said, "{run:?}");
        run.good();
    }
}

#[test]
fn buffers_beside_a_file_are_found_or_named() {
    let folder = Folder::new("formats_buffers");
    let (json, buffer) = gltf("in/b.bin");
    folder.write("s.gltf", &json);
    assert!(folder.run("stats s.gltf").refused().contains("in/b.bin: cannot be read"));
    fs::create_dir(folder.path("in")).unwrap();
    folder.write("in/b.bin", &buffer[..140]);
    let message = folder.run("stats s.gltf").refused();
    assert!(
        message.contains("buffer 0 (from 0): truncated: 144 bytes declared, 140 found"),
        "{message}"
    );
    folder.write("in/b.bin", &buffer);
    folder.run("stats s.gltf").good();
    let message = Run::new(&folder.pipe("stats -", &json)).refused();
    assert!(message.contains("name the file"), "{message}");
    for outside in ["../b.bin", "/etc/passwd", "http://example.org/b.bin"] {
        folder.write("s.gltf", gltf(outside).0);
        let message = folder.run("stats s.gltf").refused();
        assert!(message.contains(outside) && message.contains("buffer 0"), "{message}");
    }
}

/// Files that declare far more data than they hold, read with little memory.
#[cfg(target_os = "linux")]
#[test]
fn counts_that_lie_ask_for_no_memory() {
    let folder = Folder::new("formats_lies");
    let huge = "4000000000";
    folder.write("s.stl", stl(4_000_000_000));
    folder.write("v.ply", ply().replace("vertex 8", &format!("vertex {huge}")));
    folder.write("f.ply", ply().replace("face 4", &format!("face {huge}")));
    folder.write("l.ply", ply().replace("3 0 1 2", &format!("{huge} 0 1 2")));
    folder.write("v.off", text(&format!("OFF {huge} 4 0\n")));
    folder.write("f.off", text("OFF 8 4 0\n").replace("3 0 1 2", &format!("{huge} 0 1 2")));
    let (json, buffer) = gltf("b.bin");
    folder.write("b.bin", buffer);
    folder.write("a.gltf", json.replace("\"count\":12", &format!("\"count\":{huge}")));
    folder.write("b.gltf", json.replace("\"byteLength\":144", &format!("\"byteLength\":{huge}")));
    for file in folder.files() {
        if file == "b.bin" {
            continue;
        }
        let program = crate::PROGRAM;
        // In kB.
        let line = format!("ulimit -v 400000; exec {program} stats {file}");
        let mut shell = std::process::Command::new("sh");
        let output = shell.args(["-c", &line]).current_dir(folder.path("")).output().unwrap();
        let message = Run::new(&output).refused();
        assert!(message.contains(&file) && !message.contains("memory"), "{message}");
    }
}
