//! Files written here, read again; and the same files damaged.

use std::path::Path;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use binspace::glam::DVec3;
use binspace::internals::SplitMix64;
use binspace::scene::Scene;

use super::{Kind, MeshKind};
use crate::failure::Failure;

/// Vertices of a tetrahedron, its faces, and a colour of each.
const VERTICES: [[f32; 3]; 4] =
    [[0.1, 0.2, 0.3], [4.5, 0.25, -1.0], [1.5, 3.75, 0.125], [1.0, 1.0, 5.5]];
const FACES: [[usize; 3]; 4] = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];
const COLOURS: [[u8; 4]; 4] =
    [[255, 0, 0, 255], [0, 255, 0, 255], [0, 51, 255, 255], [255, 255, 0, 102]];

fn joined(words: impl IntoIterator<Item = impl ToString>) -> String {
    words.into_iter().map(|word| word.to_string()).collect::<Vec<_>>().join(" ")
}

fn little(numbers: impl IntoIterator<Item = f32>) -> Vec<u8> {
    numbers.into_iter().flat_map(f32::to_le_bytes).collect()
}

/// An STL text of two solids, the first of which has one face.
fn stl_text() -> Vec<u8> {
    let mut text = "solid\n".to_owned();
    for (number, face) in FACES.iter().enumerate() {
        text += "  facet normal 0 0 0\n    outer loop\n";
        for &corner in face {
            text += &format!("      vertex {}\n", joined(VERTICES[corner]));
        }
        text += "    endloop\n  endfacet\n";
        if number == 0 {
            text += "endsolid\nsolid second # with a name\n";
        }
    }
    (text + "endsolid second\n").into()
}

/// A binary STL file with a header that begins as text does.
fn stl_binary() -> Vec<u8> {
    let mut bytes = b"solid".to_vec();
    bytes.resize(80, b' ');
    bytes.extend(4u32.to_le_bytes());
    for face in FACES {
        bytes.extend(little([0.0; 3]));
        face.iter().for_each(|&corner| bytes.extend(little(VERTICES[corner])));
        bytes.extend([0, 0]);
    }
    bytes
}

/// A PLY file with an unknown element, faces before vertices, and colours of faces.
fn ply(format: &str) -> Vec<u8> {
    let header = format!(
        "ply\nformat {format} 1.0\ncomment by hand\nelement extra 2\nproperty list uchar short numbers\n\
         element face 4\nproperty list uchar int vertex_indices\nproperty uchar red\n\
         property uchar green\nproperty uchar blue\nproperty uchar alpha\n\
         element vertex 4\nproperty float x\nproperty float y\nproperty float z\nproperty float nx\n\
         end_header\n"
    );
    let mut bytes = header.into_bytes();
    let (is_text, is_big) = (format == "ascii", format == "binary_big_endian");
    if is_text {
        let mut text = "2 7 -8\n0\n".to_owned();
        for (face, colour) in FACES.iter().zip(COLOURS) {
            text += &format!("3 {} {}\n", joined(face), joined(colour));
        }
        VERTICES.iter().for_each(|&vertex| text += &format!("{} .5\n", joined(vertex)));
        bytes.extend(text.bytes());
        return bytes;
    }
    let mut push = |mut number: Vec<u8>| {
        // Numbers are given in little-endian order.
        if is_big {
            number.reverse();
        }
        bytes.extend(number);
    };
    push(vec![2]);
    push(7i16.to_le_bytes().into());
    push((-8i16).to_le_bytes().into());
    push(vec![0]);
    for (face, colour) in FACES.iter().zip(COLOURS) {
        push(vec![3]);
        face.iter().for_each(|&corner| push((corner as i32).to_le_bytes().into()));
        colour.iter().for_each(|&channel| push(vec![channel]));
    }
    for vertex in VERTICES {
        vertex.iter().chain(&[0.5]).for_each(|number| push(number.to_le_bytes().into()));
    }
    bytes
}

fn off() -> Vec<u8> {
    let mut text = "OFF # a comment\n\n4 4 6\n".to_owned();
    VERTICES.iter().for_each(|&vertex| text += &format!("{}\n", joined(vertex)));
    for (face, [r, g, b, opacity]) in FACES.iter().zip(COLOURS) {
        // Whole numbers, or shares.
        let colour = if opacity == 255 {
            joined([r, g, b])
        } else {
            joined([r, g, b, opacity].map(|channel| format!("{:?}", f32::from(channel) / 255.0)))
        };
        text += &format!("3 {} {colour}\n", joined(face));
    }
    text.into()
}

/// A binary OFF file: a first line of text, and big-endian numbers.
fn off_binary() -> Vec<u8> {
    let mut bytes = b"OFF BINARY\n".to_vec();
    let mut push = |number: [u8; 4]| bytes.extend(number);
    [4u32, 4, 6].into_iter().for_each(|count| push(count.to_be_bytes()));
    VERTICES.iter().flatten().for_each(|number| push(number.to_be_bytes()));
    for (face, colour) in FACES.iter().zip(COLOURS) {
        push(3u32.to_be_bytes());
        face.iter().for_each(|&corner| push((corner as u32).to_be_bytes()));
        let channels = if colour[3] == 255 { &colour[..3] } else { &colour[..] };
        push((channels.len() as u32).to_be_bytes());
        channels.iter().for_each(|&channel| push((f32::from(channel) / 255.0).to_be_bytes()));
    }
    bytes
}

/// Light of an sRGB byte, as the colours above need it.
fn light(byte: u8) -> f64 {
    let value = f64::from(byte) / 255.0;
    if value <= 0.04045 { value / 12.92 } else { ((value + 0.055) / 1.055).powf(2.4) }
}

/// The JSON and the buffer: a mesh of a primitive for each face, twice: once in place, once mirrored,
/// turned and moved.
fn gltf_parts(uri: &str) -> (String, Vec<u8>) {
    let mut buffer = little(VERTICES.into_iter().flatten());
    FACES.iter().flatten().for_each(|&corner| buffer.extend((corner as u16).to_le_bytes()));
    let (mut materials, mut primitives, mut accessors) = (vec![], vec![], vec![]);
    accessors.push(
        r#"{"bufferView":0,"componentType":5126,"count":4,"type":"VEC3","min":[0,0,-1],"max":[5,4,6]}"#
            .to_owned(),
    );
    for (number, [r, g, b, opacity]) in COLOURS.into_iter().enumerate() {
        let mode = if opacity < 255 { ",\"alphaMode\":\"BLEND\"" } else { "" };
        materials.push(format!(
            r#"{{"pbrMetallicRoughness":{{"baseColorFactor":[{},{},{},{}]}}{mode}}}"#,
            light(r),
            light(g),
            light(b),
            f64::from(opacity) / 255.0
        ));
        accessors.push(format!(
            r#"{{"bufferView":1,"byteOffset":{},"componentType":5123,"count":3,"type":"SCALAR"}}"#,
            6 * number
        ));
        primitives.push(format!(
            r#"{{"attributes":{{"POSITION":0}},"indices":{},"material":{number}}}"#,
            number + 1
        ));
    }
    let json = format!(
        r#"{{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[0,1]}}],
        "nodes":[{{"mesh":0}},{{"translation":[10,0,0],"children":[2]}},
        {{"mesh":0,"rotation":[0,0.70710678,0,0.70710678],"scale":[-2,2,2]}}],
        "meshes":[{{"primitives":[{}]}}],"materials":[{}],"accessors":[{}],
        "bufferViews":[{{"buffer":0,"byteLength":48}},{{"buffer":0,"byteOffset":48,"byteLength":24}}],
        "buffers":[{{{uri}"byteLength":{}}}]}}"#,
        primitives.join(","),
        materials.join(","),
        accessors.join(","),
        buffer.len()
    );
    (json, buffer)
}

fn gltf() -> Vec<u8> {
    let (_, buffer) = gltf_parts("");
    let uri =
        format!(r#""uri":"data:application/octet-stream;base64,{}","#, STANDARD.encode(buffer));
    gltf_parts(&uri).0.into()
}

fn glb() -> Vec<u8> {
    let (json, buffer) = gltf_parts("");
    let mut json = json.into_bytes();
    json.resize(json.len().next_multiple_of(4), b' ');
    let length = 12 + 8 + json.len() + 8 + buffer.len();
    let mut bytes = b"glTF".to_vec();
    bytes.extend([2, length as u32, json.len() as u32].iter().flat_map(|n| n.to_le_bytes()));
    bytes.extend(b"JSON");
    bytes.extend(json);
    bytes.extend((buffer.len() as u32).to_le_bytes());
    bytes.extend(b"BIN\0");
    bytes.extend(buffer);
    bytes
}

/// All files, each with its kind and whether its coordinates are text.
fn files() -> Vec<(&'static str, Vec<u8>, MeshKind, bool)> {
    vec![
        ("STL as text", stl_text(), MeshKind::Stl, true),
        ("binary STL", stl_binary(), MeshKind::BinaryStl, false),
        ("PLY as text", ply("ascii"), MeshKind::Ply, true),
        ("PLY, big-endian", ply("binary_big_endian"), MeshKind::Ply, false),
        ("PLY, little-endian", ply("binary_little_endian"), MeshKind::Ply, false),
        ("OFF", off(), MeshKind::Off, true),
        ("binary OFF", off_binary(), MeshKind::Off, false),
        ("glTF", gltf(), MeshKind::Gltf, false),
        ("GLB", glb(), MeshKind::Gltf, false),
    ]
}

fn read(kind: MeshKind, bytes: &[u8]) -> Result<Scene, String> {
    kind.read("the file", bytes, None).map_err(|failure| match failure {
        Failure::Message(message) => message,
        other => panic!("{other:?}"),
    })
}

#[test]
fn what_was_written_is_read() {
    for (what, bytes, kind, is_text) in files() {
        let found = Kind::of(&bytes, bytes.len() as u64, Path::new("x.obj"));
        assert_eq!(found, Kind::Mesh(kind), "{what}");
        let scene = read(kind, &bytes).unwrap();
        let is_gltf = kind == MeshKind::Gltf;
        assert_eq!(scene.len(), if is_gltf { 8 } else { 4 }, "{what}");
        assert_eq!(scene.up(), if is_gltf { DVec3::Y } else { DVec3::Z }, "{what}");
        for (number, face) in FACES.iter().enumerate() {
            // As in text, or as rounded to 32 bits.
            let number_of =
                |c: f32| if is_text { c.to_string().parse().unwrap() } else { f64::from(c) };
            let corners = face.map(|corner| DVec3::from(VERTICES[corner].map(number_of)));
            assert_eq!(scene.polygon(number), corners, "{what}");
            let material = scene.material(number);
            let colour = match kind {
                MeshKind::Stl | MeshKind::BinaryStl => [204, 204, 204, 255],
                _ => COLOURS[number],
            };
            let [r, g, b] = material.color;
            assert_eq!(
                [r, g, b, material.opacity].map(|c| (c * 255.0).round() as u8),
                colour,
                "{what}"
            );
            if is_gltf {
                // A quarter turn about y takes x to -z and z to x; mirrored, the corners change places.
                let moved = [0, 2, 1].map(|k| {
                    let [x, y, z] = VERTICES[face[k]].map(f64::from);
                    DVec3::new(10.0 + 2.0 * z, 2.0 * y, 2.0 * x)
                });
                let there = scene.polygon(4 + number);
                assert!(
                    there.iter().zip(moved).all(|(a, b)| a.distance(b) < 1e-6),
                    "{there:?} {moved:?}"
                );
            }
        }
        // Numbers of three decimals, or a step of 32 bits.
        let unit =
            if is_text { 1e-3 } else { f64::from(f32::EPSILON) * if is_gltf { 21.0 } else { 5.5 } };
        assert!(
            (scene.precision() / (4.0 * unit) - 1.0).abs() < 1e-6,
            "{what}: {}",
            scene.precision()
        );
    }
}

#[test]
fn what_is_wrong_is_named() {
    let text = |bytes: Vec<u8>| String::from_utf8(bytes).unwrap();
    let stl = |from: &str, to: &str| text(stl_text()).replacen(from, to, 1).into_bytes();
    let ply_of = |from: &str, to: &str| text(ply("ascii")).replacen(from, to, 1).into_bytes();
    let off_of = |from: &str, to: &str| text(off()).replacen(from, to, 1).into_bytes();
    let gltf_of = |from: &str, to: &str| text(gltf()).replacen(from, to, 1).into_bytes();
    let cut = |bytes: Vec<u8>, less: usize| bytes[..bytes.len() - less].to_vec();
    let lying = |count: u32| {
        let mut bytes = stl_binary();
        bytes[80..84].copy_from_slice(&count.to_le_bytes());
        bytes
    };
    let with_nan = || {
        let mut bytes = stl_binary();
        bytes[84 + 50 + 12..][..4].copy_from_slice(&f32::NAN.to_le_bytes());
        bytes
    };
    let cases = [
        (
            MeshKind::Stl,
            stl("vertex 0.1", "vertex nan"),
            "line 4, facet 0 (from 0): expected `vertex`",
        ),
        (
            MeshKind::Stl,
            stl("vertex 0.1", "outer # "),
            "facet 0 (from 0): fewer than three corners",
        ),
        (MeshKind::Stl, cut(stl_text(), 40), "facet 3 (from 0): truncated"),
        (MeshKind::Stl, stl("outer loop", "inner loop"), "inner is out of place in an STL file"),
        (MeshKind::BinaryStl, lying(5), "truncated: 5 triangles declared, 4 found"),
        (MeshKind::BinaryStl, lying(u32::MAX), "truncated: 4294967295 triangles declared, 4 found"),
        (
            MeshKind::BinaryStl,
            with_nan(),
            "triangle 1 (from 0): a coordinate is not a finite number",
        ),
        (MeshKind::BinaryStl, vec![0; 20], "truncated header"),
        (
            MeshKind::Ply,
            ply_of("vertex 4", "vertex 99999999999"),
            "truncated: 99999999999 of `vertex` declared, at most ",
        ),
        (MeshKind::Ply, ply_of("vertex 4", "vertex 5"), "vertex 4 (from 0): truncated"),
        (
            MeshKind::Ply,
            ply_of("0.1 0.2", "inf 0.2"),
            "line 24, vertex 0 (from 0): `x`: inf is not a finite number",
        ),
        (
            MeshKind::Ply,
            ply_of("3 0 2 1", "3 0 2 9"),
            "face 0 (from 0): index 9 is out of range: 4 vertices",
        ),
        (
            MeshKind::Ply,
            ply_of("3 0 2 1", "3 0 2 -1"),
            "face 0 (from 0): index -1 is out of range: 4 vertices",
        ),
        (MeshKind::Ply, ply_of("3 0 2 1", "99999999999 0 2 1"), "face 0 (from 0): the property"),
        (
            MeshKind::Ply,
            ply_of("property float z\n", ""),
            "vertex 0 (from 0): x, y or z is missing",
        ),
        (MeshKind::Ply, ply_of("end_header", "end_headache"), "in the header: Line"),
        (
            MeshKind::Ply,
            cut(ply("binary_little_endian"), 3),
            "truncated: 4 of `vertex` declared, at most 3 found",
        ),
        (MeshKind::Off, off_of("4 4 6", "99999999999 4 6"), "more than the file can hold"),
        (MeshKind::Off, off_of("4 4 6", "4 5 6"), "face 4 (from 0): truncated"),
        (
            MeshKind::Off,
            off_of("0.1 0.2", "0.1 nan"),
            "line 4, vertex 0 (from 0): expected three finite",
        ),
        (
            MeshKind::Off,
            off_of("3 0 2 1", "3 0 2 4"),
            "face 0 (from 0): index 4 is out of range: 4 vertices",
        ),
        (MeshKind::Off, off_of("3 0 2 1", "9 0 2 1 #"), "truncated: 9 corners declared, "),
        (MeshKind::Gltf, cut(glb(), 1), "truncated: "),
        (
            MeshKind::Gltf,
            b"glTF\x01\0\0\0\xff\0\0\0".to_vec(),
            "this is glTF 1.0; binspace reads glTF 2.0",
        ),
        (MeshKind::Gltf, br#"{"asset": {}, "accessors": {"a": {}}}"#.to_vec(), "this is glTF 1.0"),
        (MeshKind::Gltf, glb()[..10].to_vec(), "truncated header"),
        (
            MeshKind::Gltf,
            gltf_of("\"mesh\":0", "\"mesh\":7"),
            "`nodes[0].mesh`: index out of bounds",
        ),
        (
            MeshKind::Gltf,
            gltf_of("\"count\":4", "\"count\":99999999999"),
            "mesh 0, primitive 0 (from 0): accessor 0 (from 0): its 99999999999 values do not fit",
        ),
        (
            MeshKind::Gltf,
            gltf_of("\"children\":[2]", "\"children\":[1]"),
            "node 1 (from 0): it occurs twice in the scene",
        ),
        (
            MeshKind::Gltf,
            gltf_of("\"byteLength\":72", "\"byteLength\":73"),
            "buffer 0 (from 0): truncated: 73 bytes declared, 72 found",
        ),
        (MeshKind::Gltf, gltf_of("[10,0,0]", "[1e39,0,0]"), "invalid JSON: "),
        (
            MeshKind::Gltf,
            gltf_of(
                "\"asset\"",
                "\"extensionsRequired\":[\"KHR_draco_mesh_compression\"],\"asset\"",
            ),
            "requires the extension KHR_draco_mesh_compression",
        ),
        (
            MeshKind::Gltf,
            gltf_of("\"asset\"", "\"extensionsRequired\":[\"ACME_new\\nthing\"],\"asset\""),
            "requires the extension ACME_new\\nthing,",
        ),
        (
            MeshKind::Gltf,
            gltf_parts("\"uri\":\"../b.bin\",").0.into(),
            "../b.bin: not read, because it is outside",
        ),
        (
            MeshKind::Gltf,
            gltf_parts("\"uri\":\"b.bin\",").0.into(),
            "b.bin: standard input has no folder",
        ),
    ];
    for (kind, bytes, problem) in cases {
        let message = read(kind, &bytes).unwrap_err();
        assert!(
            message.starts_with("the file: ") && message.contains(problem),
            "{problem}: {message}"
        );
        assert!(message.len() < 300 && !message.contains('\n'), "{message}");
    }
}

/// Every other triangle of a strip is turned over; -1 ends the strip, and repeated corners
/// continue it.
#[test]
fn ply_files_have_strips_of_triangles() {
    let text = String::from_utf8(ply("ascii")).unwrap();
    let start = text.find("3 0 2 1").unwrap();
    let end = text.find("0.1 0.2").unwrap();
    let strips = "17 0 2 1 3 3 -1 0 1 3 -1 2 0 3 -1 0 1 0 1 2 3 4\n";
    let header = text[..start].replace("face 4", "tristrips 1");
    let file = header + strips + &text[end..];
    let scene = read(MeshKind::Ply, file.as_bytes()).unwrap();
    let whole = read(MeshKind::Ply, text.as_bytes()).unwrap();
    assert_eq!(scene.len(), 4);
    for (number, face) in [0, 2, 1, 3].into_iter().enumerate() {
        assert_eq!(scene.polygon(number), whole.polygon(face));
        assert_eq!(scene.material(number).color, [1.0, 2.0, 3.0].map(|c| c / 255.0));
    }
    for index in ["9", "1.5", "-2", "-0.5"] {
        let file = file.replace("2 1 3 3", &format!("2 1 {index} 3"));
        let message = read(MeshKind::Ply, file.as_bytes()).unwrap_err();
        let problem = format!("index {index} is out of range: 4 vertices");
        assert!(message.contains(&problem), "{message}");
    }
}

/// In a strip every other triangle is turned over, and a fan turns around its first corner: all triangles of a flat shape
/// have their fronts up. The orders of corners are those of glTF 2.0, section 3.7.2.1.
#[test]
fn gltf_strips_and_fans_keep_their_fronts() {
    let places = |corners: [[f32; 2]; 5]| corners.map(|[x, y]| [x, y, 0.0]);
    let zigzag = places([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0], [0.0, 2.0]]);
    let round = places([[0.0, 0.0], [2.0, 0.0], [3.0, 1.0], [2.0, 2.0], [0.0, 2.0]]);
    let strip = [[0, 1, 2], [1, 3, 2], [2, 3, 4]];
    let fan = [[1, 2, 0], [2, 3, 0], [3, 4, 0]];
    for (mode, corners, triangles) in [(5, zigzag, strip), (6, round, fan)] {
        let buffer = little(corners.into_iter().flatten());
        let file = format!(
            r#"{{"asset":{{"version":"2.0"}},"nodes":[{{"mesh":0}}],
            "meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}},"mode":{mode}}}]}}],
            "accessors":[{{"bufferView":0,"componentType":5126,"count":5,"type":"VEC3","min":[0,0,0],"max":[3,2,0]}}],
            "bufferViews":[{{"buffer":0,"byteLength":60}}],
            "buffers":[{{"uri":"data:;base64,{}","byteLength":60}}]}}"#,
            STANDARD.encode(buffer)
        );
        let scene = read(MeshKind::Gltf, file.as_bytes()).unwrap();
        let expected = triangles.map(|t| t.map(|k| DVec3::from(corners[k].map(f64::from))));
        assert_eq!(scene.len(), 3, "mode {mode}");
        for (number, triangle) in expected.iter().enumerate() {
            assert_eq!(scene.polygon(number), triangle, "mode {mode}");
        }
        for [a, b, c] in expected {
            assert!((b - a).cross(c - a).z > 0.0, "the case is wrong: {a} {b} {c}");
        }
    }
}

/// Indices of signed or float type were rounded: -1 became 0, and 2.9 became 2.
#[test]
fn gltf_accessors_of_wrong_types_are_refused() {
    let mut buffer = little([1.0, 2.0, 3.0, 4.0, 5.0, 6.5, 7.0, 8.5, 9.0]);
    buffer.extend(little([0.0; 12]));
    let file = |index: &str| {
        format!(
            r#"{{"asset":{{"version":"2.0"}},"nodes":[{{"mesh":0}}],
            "meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}},"indices":1}}]}}],
            "accessors":[{{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"}},
            {{"bufferView":1,"count":3,{index}}},{{"bufferView":1,"componentType":5126,"count":3,"type":"VEC4"}}],
            "bufferViews":[{{"buffer":0,"byteLength":36}},{{"buffer":0,"byteOffset":36,"byteLength":48}}],
            "buffers":[{{"uri":"data:;base64,{}","byteLength":84}}]}}"#,
            STANDARD.encode(&buffer)
        )
    };
    let index = |kind: u32| format!("\"componentType\":{kind},\"type\":\"SCALAR\"");
    let valid = [5121, 5123, 5125].map(|kind| file(&index(kind)));
    let problem =
        "mesh 0, primitive 0 (from 0): accessor 1 (from 0): its indices are not single unsigned";
    let wrong = [5120, 5122, 5126].map(index).into_iter().chain([
        "\"componentType\":5121,\"type\":\"VEC2\"".to_owned(),
        index(5121) + ",\"normalized\":true",
    ]);
    let wrong = wrong.map(|index| (file(&index), problem));
    let coloured = |kind: &str| {
        let file = file(&index(5121)).replace("\"POSITION\"", "\"COLOR_0\":2,\"POSITION\"");
        file.replace(
            "\"componentType\":5126,\"count\":3,\"type\":\"VEC4\"",
            &format!("\"count\":3,{kind}"),
        )
    };
    let valid = valid.into_iter().chain([
        coloured("\"componentType\":5126,\"type\":\"VEC4\""),
        coloured("\"componentType\":5121,\"type\":\"VEC4\",\"normalized\":true"),
        coloured("\"componentType\":5123,\"type\":\"VEC3\",\"normalized\":true"),
    ]);
    let problem = "accessor 2 (from 0): its colours are not three or four";
    let colours = [
        "\"componentType\":5120,\"type\":\"VEC4\",\"normalized\":true",
        "\"componentType\":5121,\"type\":\"VEC4\"",
        "\"componentType\":5126,\"type\":\"VEC2\"",
    ];
    let wrong = wrong.chain(colours.map(|kind| (coloured(kind), problem)));
    for file in valid {
        assert_eq!(read(MeshKind::Gltf, file.as_bytes()).map(|scene| scene.len()), Ok(1), "{file}");
    }
    for (file, problem) in wrong {
        let message = read(MeshKind::Gltf, file.as_bytes()).unwrap_err();
        assert!(message.contains(problem), "{message}");
    }
}

/// Vertices with normals, colours and texture coordinates.
#[test]
fn binary_off_files_have_colours_of_vertices() {
    let mut bytes = b"STCNOFF BINARY\n".to_vec();
    let mut push = |number: [u8; 4]| bytes.extend(number);
    [3u32, 1, 0].into_iter().for_each(|count| push(count.to_be_bytes()));
    for (x, y) in [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0)] {
        let vertex: [f32; 12] = [x, y, 5.0, 9.0, 9.0, 9.0, x, y, 0.6, 0.5, 9.0, 9.0];
        vertex.iter().for_each(|number| push(number.to_be_bytes()));
    }
    [3u32, 0, 1, 2, 0].into_iter().for_each(|number| push(number.to_be_bytes()));
    let scene = read(MeshKind::Off, &bytes).unwrap();
    let corners = [[0.0, 0.0, 5.0], [1.0, 0.0, 5.0], [0.0, 1.0, 5.0]].map(DVec3::from);
    assert_eq!(scene.polygon(0), corners);
    let material = scene.material(0);
    let colour = [material.color[0], material.color[1], material.color[2], material.opacity];
    assert_eq!(colour.map(|channel| (channel * 255.0).round()), [85.0, 85.0, 153.0, 128.0]);
    for (at, number, problem) in [
        (bytes.len() - 8, 3, "face 0 (from 0): index 3 is out of range: 3 vertices"),
        (bytes.len() - 20, u32::MAX, "face 0 (from 0): "),
        (bytes.len() - 4, 7, "face 0 (from 0): truncated"),
        (15, 4, "vertex 3 (from 0): truncated"),
        (27, 0x7fc0_0000, "vertex 0 (from 0): a coordinate is not a finite number"),
    ] {
        let mut wrong = bytes.clone();
        wrong[at..at + 4].copy_from_slice(&number.to_be_bytes());
        let message = read(MeshKind::Off, &wrong).unwrap_err();
        assert!(message.contains(problem), "{problem}: {message}");
    }
}

/// A sparse accessor replaces some of its values.
#[test]
fn sparse_values_replace_others() {
    let corners = [[1.0, 2.0, 3.0], [4.0, 5.0, 6.5], [7.0, 8.5, 9.0]];
    let mut buffer = little([corners[0], [0.0; 3], corners[2]].concat());
    // Its number in 16 bits, and itself.
    buffer.extend([1, 0, 0, 0]);
    buffer.extend(little([corners[1], [0.0; 3]].concat()));
    // The lengths of the numbers and of the values, in bytes, and where the values begin.
    let file = |count: usize, base: &str, [numbers, values, offset]: [usize; 3]| {
        format!(
            r#"{{"asset":{{"version":"2.0"}},"nodes":[{{"mesh":0}}],
            "meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}}}}]}}],
            "accessors":[{{{base}"componentType":5126,"count":3,"type":"VEC3","sparse":{{"count":{count},
            "indices":{{"bufferView":1,"componentType":5123}},"values":{{"bufferView":2,"byteOffset":{offset}}}}}}}],
            "bufferViews":[{{"buffer":0,"byteLength":36}},{{"buffer":0,"byteOffset":36,"byteLength":{numbers}}},
            {{"buffer":0,"byteOffset":40,"byteLength":{values}}}],
            "buffers":[{{"uri":"data:;base64,{}","byteLength":64}}]}}"#,
            STANDARD.encode(&buffer)
        )
    };
    let base = "\"bufferView\":0,";
    let scene = read(MeshKind::Gltf, file(1, base, [2, 12, 0]).as_bytes()).unwrap();
    assert_eq!(scene.polygon(0), corners.map(|corner| DVec3::from(corner.map(f64::from))));
    let scene = read(MeshKind::Gltf, file(1, base, [2, 24, 12]).as_bytes()).unwrap();
    assert_eq!(scene.polygon(0)[1], DVec3::ZERO);
    for (file, problem) in [
        (file(2, base, [4, 24, 0]), "accessor 0 (from 0): its sparse indices do not increase"),
        (file(2, base, [2, 24, 0]), "accessor 0 (from 0): its sparse values do not fit"),
        (file(2, base, [4, 12, 0]), "accessor 0 (from 0): its sparse values do not fit"),
        (file(1, "", [2, 12, 0]), "accessor 0 (from 0): it has no buffer view"),
    ] {
        let message = read(MeshKind::Gltf, file.as_bytes()).unwrap_err();
        assert!(message.contains(problem), "{message}");
    }
}

/// Two conventions have the order of the colours and the highest bit the other way round.
#[test]
fn binary_stl_files_have_colours() {
    let coloured = |header: &[u8], words: [u16; 4]| -> Vec<[u8; 4]> {
        let mut bytes = stl_binary();
        bytes[..header.len()].copy_from_slice(header);
        for (number, word) in words.into_iter().enumerate() {
            bytes[84 + 50 * number + 48..][..2].copy_from_slice(&word.to_le_bytes());
        }
        let scene = read(MeshKind::BinaryStl, &bytes).unwrap();
        let colour = |number| {
            let material = scene.material(number);
            let [r, g, b] = material.color;
            [r, g, b, material.opacity].map(|channel| (channel * 255.0).round() as u8)
        };
        (0..4).map(colour).collect()
    };
    let words = [
        0b1_11111_00000_00000,
        0b1_00000_11111_00000,
        0b1_00000_00000_11111,
        0b0_00000_00000_11111,
    ];
    let grey = [204, 204, 204, 255];
    let [red, green, blue] = [[255, 0, 0, 255], [0, 255, 0, 255], [0, 0, 255, 255]];
    assert_eq!(coloured(b"", words), [red, green, blue, grey]);
    let whole = [1, 2, 3, 255];
    let header = [&b"made by hand COLOR="[..], &whole].concat();
    assert_eq!(coloured(&header, words), [whole, whole, whole, red]);
    assert_eq!(coloured(&header, words.map(|word| word & 0x7fff)), [blue, green, red, red]);
}

/// `KHR_mesh_quantization`: positions are integers, shares of the largest one or not.
#[test]
fn integers_are_positions() {
    let corners: [[i16; 3]; 3] = [[-32_768, 0, 32_767], [0, 32_767, -100], [16_384, 7, 8]];
    // Three numbers of 16 bits fill eight bytes.
    let bytes: Vec<u8> = corners
        .iter()
        .flat_map(|corner| corner.iter().copied().chain([0]).flat_map(i16::to_le_bytes))
        .collect();
    for (normalized, full) in [(false, 1.0), (true, 32_767.0)] {
        let json = format!(
            r#"{{"asset":{{"version":"2.0"}},"nodes":[{{"mesh":0}}],
            "extensionsUsed":["KHR_mesh_quantization","KHR_materials_unlit"],
            "extensionsRequired":["KHR_mesh_quantization","KHR_materials_unlit"],
            "meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}}}}]}}],
            "accessors":[{{"bufferView":0,"componentType":5122,"count":3,"type":"VEC3",
            "normalized":{normalized}}}],
            "bufferViews":[{{"buffer":0,"byteLength":24,"byteStride":8}}],
            "buffers":[{{"uri":"data:;base64,{}","byteLength":24}}]}}"#,
            STANDARD.encode(&bytes)
        );
        let scene = read(MeshKind::Gltf, json.as_bytes()).unwrap();
        let share = |c: i16| (f64::from(c) / full).max(if normalized { -1.0 } else { -1e9 });
        let expected = corners.map(|corner| DVec3::from(corner.map(share)));
        assert_eq!(scene.polygon(0), expected);
    }
}

/// A scene or a message of one line, and never more corners than bytes.
#[test]
fn damaged_files_are_read_or_refused() {
    for (what, good, _, _) in files() {
        let mut random = SplitMix64::new(good.len() as u64);
        let mut refused = 0;
        for _ in 0..300 {
            let mut bytes = good.clone();
            for _ in 0..1 + random.next() % 3 {
                let at = |random: &mut SplitMix64, length: usize| {
                    (random.next() % length.max(1) as u64) as usize
                };
                let (place, other) = (at(&mut random, bytes.len()), at(&mut random, bytes.len()));
                match random.next() % 7 {
                    0 => bytes.truncate(place.max(1)),
                    1 => bytes[place] ^= 1 << (random.next() % 8),
                    2 => bytes[place] = [0, 255, b'9', b'-', b'\n', b' '][other % 6],
                    3 => drop(bytes.splice(place..place, *b"99999999999")),
                    4 => drop(bytes.splice(place..place, *b" nan ")),
                    5 => drop(bytes.drain(place.min(other)..place.max(other))),
                    _ => {
                        let end = (place + 4).min(bytes.len());
                        bytes[place..end].fill(0xff);
                    }
                }
            }
            let Kind::Mesh(kind) = Kind::of(&bytes, bytes.len() as u64, Path::new("x.stl")) else {
                continue;
            };
            match read(kind, &bytes) {
                Ok(scene) => {
                    let corners: usize =
                        scene.polygons().map(|polygon| polygon.points().len()).sum();
                    assert!(corners <= bytes.len(), "{what}");
                    assert!(scene.polygons().flatten().all(|corner| corner.is_finite()), "{what}");
                }
                Err(message) => {
                    refused += 1;
                    assert!(message.len() < 400 && !message.contains('\n'), "{what}: {message}");
                }
            }
        }
        assert!(refused > 100, "{what}: {refused}");
    }
}

/// A file may place its content as often as it has nodes.
#[test]
fn many_places_of_many_empty_primitives_take_no_time() {
    let primitives = vec![r#"{"attributes":{"POSITION":0}}"#; 20_000].join(",");
    let nodes = vec![r#"{"mesh":0}"#; 20_000].join(",");
    let json = format!(
        r#"{{"asset":{{"version":"2.0"}},"nodes":[{nodes}],"meshes":[{{"primitives":[{primitives}]}}],
        "accessors":[{{"bufferView":0,"componentType":5126,"count":2,"type":"VEC3"}}],
        "bufferViews":[{{"buffer":0,"byteLength":24}}],
        "buffers":[{{"uri":"data:;base64,{}","byteLength":24}}]}}"#,
        STANDARD.encode([0; 24])
    );
    let message = read(MeshKind::Gltf, json.as_bytes()).unwrap_err();
    assert!(message.contains("no triangles in its scene"), "{message}");
}

#[test]
fn files_of_other_programs_are_named() {
    let kind = |bytes: &[u8]| Kind::of(bytes, bytes.len() as u64, Path::new("x.obj"));
    for (beginning, name) in [
        (&b"ISO-10303-21;\nHEADER;"[..], "STEP"),
        (b"\n<?xml version=\"1.0\"?>\n<COLLADA xmlns=", "COLLADA"),
        (b"<!DOCTYPE html><html>", "HTML"),
        (b"PK\x03\x04\x14", "ZIP"),
        (b"  0\r\nSECTION\r\n  2\r\n", "DXF"),
        (b"999\nwritten by hand\n999\n\n  0\nSECTION\n", "DXF"),
        (b"AutoCAD Binary DXF\r\n\x1a\0", "DXF"),
        (b"FORM\0\0\x01\0LWO2", "LightWave"),
        (b"MM\x08\0\0\0\x02\0", "3DS"),
        (b"{\"a\": 1}", "JSON"),
        (b"4OFF\n4 4 6\n", "four coordinates"),
        (b"\xff\xfe<\0?\0x\0m\0l\0>\0<\0X\x003\0D\0>\0", "X3D"),
    ] {
        assert!(matches!(kind(beginning), Kind::Other(found) if found.contains(name)), "{name}");
    }
    assert_eq!(kind(b""), Kind::Other("an empty file"));
    for text in ["# a comment\nv 1 2 3\n", "solids\n", "plywood\n", "OFFICE 3\n", "v 0 0 0"] {
        assert_eq!(kind(text.as_bytes()), Kind::Obj, "{text}");
    }
}
