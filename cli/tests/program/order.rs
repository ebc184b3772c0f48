use std::process::Stdio;

use serde_json::Value;

use crate::run::{CROSSING, Folder};

type Point = [f64; 3];

#[derive(Debug, PartialEq)]
struct Line {
    polygon: u64,
    vertices: Vec<Point>,
}

fn parse(output: &str) -> Vec<Line> {
    let number = |value: &Value| value.as_f64().unwrap();
    let point = |value: &Value| -> Point {
        let coordinates: Vec<f64> = value.as_array().unwrap().iter().map(number).collect();
        coordinates.try_into().unwrap()
    };
    let line = |text: &str| {
        let value: Value = serde_json::from_str(text).unwrap();
        assert_eq!(value.as_object().unwrap().len(), 2, "{text}");
        Line {
            polygon: value["polygon"].as_u64().unwrap(),
            vertices: value["vertices"].as_array().unwrap().iter().map(point).collect(),
        }
    };
    output.lines().map(line).collect()
}

fn sub(a: Point, b: Point) -> Point {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

fn cross(a: Point, b: Point) -> Point {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn dot(a: Point, b: Point) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// Where a ray from `eye` meets a convex polygon, in multiples of its direction.
fn hit(vertices: &[Point], eye: Point, direction: Point) -> Option<f64> {
    let normal = cross(sub(vertices[1], vertices[0]), sub(vertices[2], vertices[1]));
    let distance = dot(normal, sub(vertices[0], eye)) / dot(normal, direction);
    let at: Point = std::array::from_fn(|i| eye[i] + distance * direction[i]);
    let inside = (0..vertices.len()).all(|i| {
        let (a, b) = (vertices[i], vertices[(i + 1) % vertices.len()]);
        dot(normal, cross(sub(b, a), sub(at, a))) > 0.0
    });
    (inside && distance > 0.0).then_some(distance)
}

#[test]
fn parallel_squares_come_in_the_order_of_their_depth() {
    let folder = Folder::new("order_parallel");
    let square = |z: &str| format!("v 0.1 0 {z}\nv 1 0 {z}\nv 1 1 {z}\nv 0.1 1 {z}\n");
    let faces = "f 1 2 3 4\nf 5 6 7 8\nf 9 10 11 12\n";
    folder.write("s.obj", square("2") + &square("0") + &square("1") + faces);
    let order = |options: &str| -> Vec<u64> {
        let output = folder.run(&format!("order s.obj {options}")).good();
        parse(&output).iter().map(|line| line.polygon).collect()
    };
    assert_eq!(order("--eye=0.5,0.5,10"), [1, 2, 0]);
    assert_eq!(order("--eye 0.5,0.5,-10"), [0, 2, 1]);
    assert_eq!(order("--eye -0.5,0.5,10"), [1, 2, 0]);
    assert_eq!(order("--direction 0,0,-1"), [1, 2, 0]);
    assert_eq!(order("--direction=0,0,1"), [0, 2, 1]);
    assert_eq!(order("--direction -0,0,1 --front-to-back"), [1, 2, 0]);
    // Whole polygons as in the file.
    let first = &parse(&folder.run("order s.obj --eye=0,0,9").good())[0];
    let corners = vec![[0.1, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.1, 1.0, 0.0]];
    assert_eq!(*first, Line { polygon: 1, vertices: corners });
}

#[test]
fn what_a_ray_meets_last_is_nearest() {
    let folder = Folder::new("order_rays");
    folder.write("s.obj", CROSSING);
    let eye = [3.0, 2.5, 6.0];
    for heuristic in ["auto", "first", "free-planes", "random:3"] {
        let command = format!("order s.obj --eye=3,2.5,6 --heuristic {heuristic}");
        let lines = parse(&folder.run(&command).good());
        assert!(lines.len() > 3, "{heuristic}");
        let mut met = 0;
        for i in 0..40 {
            for j in 0..40 {
                let target = [f64::from(i) * 0.1 - 2.0, f64::from(j) * 0.1 - 1.97, -1.0];
                let direction = sub(target, eye);
                let distances: Vec<f64> =
                    lines.iter().filter_map(|l| hit(&l.vertices, eye, direction)).collect();
                let sorted = distances.windows(2).all(|pair| pair[0] > pair[1]);
                assert!(sorted, "{heuristic} {target:?} {distances:?}");
                met += usize::from(distances.len() > 1);
            }
        }
        assert!(met > 100, "{met}");
        let reverse = parse(&folder.run(&format!("{command} --front-to-back")).good());
        assert!(lines.iter().eq(reverse.iter().rev()), "{heuristic}");
    }
}

#[test]
fn fragments_have_the_area_of_their_polygons() {
    let folder = Folder::new("order_area");
    folder.write("s.obj", CROSSING);
    let mut areas = [0.0; 3];
    for line in parse(&folder.run("order s.obj --eye=3,2,6").good()) {
        let v = &line.vertices;
        for i in 1..v.len() - 1 {
            let normal = cross(sub(v[i], v[0]), sub(v[i + 1], v[0]));
            areas[line.polygon as usize] += 0.5 * dot(normal, normal).sqrt();
        }
    }
    for (area, expected) in areas.into_iter().zip([4.0, 4.0, 16.0]) {
        assert!((area - expected).abs() < 1e-12, "{areas:?}");
    }
}

#[test]
fn polygons_are_numbered_by_their_line_in_the_file() {
    let folder = Folder::new("order_numbers");
    // A point, a line, a face without area and one of two corners lie between them.
    let text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 2 0 0\np 1\nf 1 2 4\nl 1 2 3\nf 1 2\nf 1 2 3\n";
    folder.write("s.obj", text);
    let run = folder.run("order s.obj --eye=0,0,1 --notes");
    for part in [
        "`p` lines skipped: 1",
        "`l` lines skipped: 1",
        "2 faces without area dropped: face 0 (line 6), face 1 (line 8), counted from 0",
        "s.obj: coordinates are precise to 1, so the tolerance is 2e-5, the largest default",
    ] {
        assert!(run.err.contains(part), "{part}: {}", run.err);
    }
    assert_eq!(run.err.lines().count(), 3, "{}", run.err);
    let lines = parse(&run.good());
    assert_eq!(lines.len(), 1);
    assert_eq!(lines[0].polygon, 2);
}

#[test]
fn of_many_dropped_faces_the_first_are_named() {
    let folder = Folder::new("order_dropped");
    folder.write("s.obj", format!("v 0 0 0\nv 1 0 0\nv 0 1 0\n{}f 1 2 3\n", "f 1 2 1\n".repeat(9)));
    let run = folder.run("order s.obj --eye=0,0,1 --notes");
    let names = "face 0 (line 4), face 1 (line 5), face 2 (line 6) and 6 more";
    assert!(run.err.contains(&format!("9 faces without area dropped: {names}")), "{}", run.err);
    assert_eq!(run.good().lines().count(), 1);
}

#[test]
fn duplicate_faces_are_kept_and_said() {
    let folder = Folder::new("order_duplicates");
    let corners = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 0\n";
    folder.write("s.obj", format!("{corners}f 1 2 3 4\nf 3 2 5 4\nf 1 2 3\n"));
    let run = folder.run("order s.obj --eye=0,0,1 --notes");
    assert!(run.err.contains("s.obj: 1 duplicate face"), "{}", run.err);
    assert_eq!(run.good().lines().count(), 3);
    let run = folder.run("stats s.obj --json --notes");
    assert!(run.err.contains("1 duplicate face"), "{}", run.err);
    assert!(run.good().contains("\"duplicates\":1"));
    assert!(folder.run("stats s.obj").good().contains("0 triangulated, 1 duplicate\n"));
}

#[test]
fn faces_that_cross_themselves_are_said() {
    let folder = Folder::new("order_crossing");
    folder.write("s.obj", "v 0 0 0\nv 3 2 0\nv 3 0 0\nv 0 1 0\nf 1 2 3 4\n");
    let run = folder.run("stats s.obj --json --notes");
    assert!(run.err.contains("s.obj: 1 self-intersecting face"), "{}", run.err);
    assert!(run.good().contains("\"crossing\":1"));
}

#[test]
fn extreme_numbers_come_back_bit_for_bit() {
    let folder = Folder::new("order_numbers_extreme");
    folder.write(
        "s.obj",
        "v 1e300 0 -1e-300\nv 1.0000000000000002e300 3e299 0\nv 0 1e22 0.1\nf 1 2 3\n",
    );
    let lines = parse(&folder.run("order s.obj --direction=0,0,1").good());
    let expected =
        vec![[1e300, 0.0, -1e-300], [1.000_000_000_000_000_2e300, 3e299, 0.0], [0.0, 1e22, 0.1]];
    assert_eq!(lines[0].vertices, expected);
}

#[test]
fn there_is_no_negative_zero() {
    let folder = Folder::new("order_zero");
    folder.write("m.mtl", "newmtl glass\nKd -0 -0 -0\nd -0\n");
    let text = "mtllib m.mtl\nusemtl glass\nv -0 -0.0 -0e9\nv 1 -0 0\nv 0 1 -0\nf 1 2 3\n";
    folder.write("s.obj", text);
    let output = folder.run("order s.obj --direction=-0,0,-1").good();
    assert_eq!(parse(&output)[0].vertices.len(), 3);
    assert!(!output.contains('-'), "{output}");
    for command in [
        "order s.obj --eye=-0,-0,1 --eye=-0,-0,-1 --edges --weights",
        "order s.obj --eye=-0,-0,1 --cull back --weights",
        "draw s.obj -o - --direction=-0,-0,-1 --target=-0,-0,-0",
        "stats s.obj --json",
    ] {
        // No number is a negative zero; "-0.5" and "1e-05" are not meant.
        let output = folder.run(command).good();
        let numbers = output.split(|c: char| !(c.is_ascii_alphanumeric() || "-+.".contains(c)));
        let zeros = numbers.filter(|word| word.starts_with('-') && word.parse() == Ok(0.0));
        assert_eq!(zeros.count(), 0, "{command}: {output}");
    }
}

#[test]
fn several_eyes_have_an_order_each() {
    let folder = Folder::new("order_eyes");
    folder.write("s.obj", CROSSING);
    let eyes = ["3,2,6", "-3,2,6", "0,0,-9"];
    for options in ["", "--front-to-back", "--cull back"] {
        let mut expected = String::new();
        for (k, eye) in eyes.iter().enumerate() {
            for line in folder.run(&format!("order s.obj --eye={eye} {options}")).good().lines() {
                expected += &format!("{{\"eye\":{k},{}\n", &line[1..]);
            }
        }
        let all = eyes.map(|eye| format!("--eye={eye}")).join(" ");
        assert_eq!(folder.run(&format!("order s.obj {all} {options}")).good(), expected);
    }
    // The same eye twice is two eyes.
    let output = folder.run("order s.obj --eye 3,2,6 --eye 3,2,6").good();
    assert!(output.contains("\"eye\":0,") && output.contains("\"eye\":1,"), "{output}");
    for problem in ["--eye=1,2,3 --direction=0,0,1", "--direction=0,0,1 --direction=0,1,0"] {
        assert!(folder.run(&format!("order s.obj {problem}")).refused().contains("cannot be used"));
    }
    assert!(folder.run("order s.obj --eye=1,2,3 --eye=1,inf,3").refused().contains("finite"));
}

#[test]
fn edges_and_weights_say_where_vertices_lie_on_the_polygon() {
    let folder = Folder::new("order_attributes");
    folder.write("s.obj", CROSSING);
    let corners: Vec<Point> = CROSSING
        .lines()
        .filter_map(|line| line.strip_prefix("v "))
        .map(|line| {
            let numbers: Vec<f64> = line.split(' ').map(|word| word.parse().unwrap()).collect();
            numbers.try_into().unwrap()
        })
        .collect();
    let plain = parse(&folder.run("order s.obj --eye=3,2,6").good());
    let output = folder.run("order s.obj --eye=3,2,6 --edges --weights").good();
    let (mut of_polygon, mut of_cuts) = (0, 0);
    for (line, plain) in output.lines().zip(&plain) {
        let value: Value = serde_json::from_str(line).unwrap();
        assert_eq!(value.as_object().unwrap().len(), 4, "{line}");
        let corner = |k: usize| corners[4 * plain.polygon as usize + k % 4];
        let (edges, weights) = (&value["edges"], &value["weights"]);
        let n = plain.vertices.len();
        assert_eq!([edges, weights].map(|list| list.as_array().unwrap().len()), [n, n]);
        for (i, &vertex) in plain.vertices.iter().enumerate() {
            let pairs: Vec<(usize, f64)> = serde_json::from_value(weights[i].clone()).unwrap();
            assert!((1..=3).contains(&pairs.len()), "{line}");
            let sum: f64 = pairs.iter().map(|&(_, weight)| weight).sum();
            assert!((sum - 1.0).abs() < 1e-12, "{line}");
            for (axis, coordinate) in vertex.into_iter().enumerate() {
                let place: f64 = pairs.iter().map(|&(k, weight)| weight * corner(k)[axis]).sum();
                assert!((place - coordinate).abs() < 1e-12, "{line}");
            }
            // Both ends of an edge of the polygon lie on it.
            let Some(k) = edges[i].as_u64() else {
                of_cuts += usize::from(edges[i].is_null());
                continue;
            };
            let (a, b) = (corner(k as usize), corner(k as usize + 1));
            for end in [vertex, plain.vertices[(i + 1) % n]] {
                let off = cross(sub(b, a), sub(end, a));
                assert!(dot(off, off) < 1e-24, "{line}");
            }
            of_polygon += 1;
        }
    }
    assert!(of_polygon >= 12 && of_cuts >= 2, "{of_polygon} {of_cuts}: {output}");
    let fields = |options: &str| {
        let output = folder.run(&format!("order s.obj --eye=3,2,6 {options}")).good();
        let value: Value = serde_json::from_str(output.lines().next().unwrap()).unwrap();
        let mut names: Vec<String> = value.as_object().unwrap().keys().cloned().collect();
        names.sort();
        names
    };
    assert_eq!(fields("--edges"), ["edges", "polygon", "vertices"]);
    assert_eq!(fields("--weights"), ["polygon", "vertices", "weights"]);
}

#[test]
fn a_reader_that_leaves_is_no_error() {
    let folder = Folder::new("order_pipe");
    let mut command = folder.command("order random:500 --eye=3,2,6");
    let mut child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    drop(child.stdout.take());
    let output = child.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(0));
    assert_eq!(String::from_utf8_lossy(&output.stderr), "");
}

#[test]
fn a_seed_makes_a_scene_again() {
    let folder = Folder::new("order_seed");
    let order = |seed| folder.run(&format!("order random:20 --eye=3,2,6 --seed {seed}")).good();
    assert_eq!(order(5), order(5));
    assert_ne!(order(5), order(6));
}
