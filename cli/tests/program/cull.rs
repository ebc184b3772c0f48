//! Rooms seen from outside.

use std::fs;

use serde_json::Value;

use crate::png_picture::Picture;
use crate::run::Folder;

/// A room from 0 to 1, its six walls facing inwards: floor 0 and ceiling 1 across y, x = 0 and x = 1, z = 0
/// and z = 1. Nothing in it stands on the ground.
const ROOM: &str = "\
v 0 0 0\nv 1 0 0\nv 1 0 1\nv 0 0 1\nv 0 1 0\nv 1 1 0\nv 1 1 1\nv 0 1 1\n\
f 1 4 3 2\nf 5 6 7 8\nf 1 5 8 4\nf 2 3 7 6\nf 1 2 6 5\nf 4 8 7 3\n";

fn polygons(output: &str) -> Vec<u64> {
    let number =
        |line: &str| serde_json::from_str::<Value>(line).unwrap()["polygon"].as_u64().unwrap();
    let mut numbers: Vec<u64> = output.lines().map(number).collect();
    numbers.sort_unstable();
    numbers
}

#[test]
fn an_order_without_backs_has_the_walls_that_face_the_eye() {
    let folder = Folder::new("cull_order");
    folder.write("room.obj", ROOM);
    let order = |options: &str| polygons(&folder.run(&format!("order room.obj {options}")).good());
    // Above, to the right and in front: the floor, x = 0 and z = 0 face it.
    assert_eq!(order("--eye=5,6,7 --cull back"), [0, 2, 4]);
    assert_eq!(order("--eye=5,6,7 --cull none"), [0, 1, 2, 3, 4, 5]);
    assert_eq!(order("--eye=5,6,7"), [0, 1, 2, 3, 4, 5]);
    // Inside all do; in the plane of a wall, that one is seen edge-on, as along a direction.
    assert_eq!(order("--eye=0.5,0.5,0.5 --cull back"), [0, 1, 2, 3, 4, 5]);
    assert_eq!(order("--eye=1,6,7 --cull back"), [0, 2, 4]);
    assert_eq!(order("--direction=0,-1,0 --cull back --front-to-back"), [0]);
}

#[test]
fn a_picture_without_backs_shows_the_inside() {
    let folder = Folder::new("cull_render");
    folder.write("m.mtl", "newmtl red\nKd 1 0 0\nnewmtl blue\nKd 0 0 1\n");
    // The floor is red, everything else blue.
    let room = ROOM.replace("f 1 4 3 2\n", "usemtl red\nf 1 4 3 2\nusemtl blue\n");
    folder.write("room.obj", format!("mtllib m.mtl\n{room}"));
    let picture = |options: &str| {
        let command = format!("render room.obj --direction=0,-1,0 --up z --size 60x40 {options}");
        folder.run(&command).good();
        Picture::read(&folder.path("p.png"))
    };
    let (red, blue) = ([255, 0, 0], [0, 0, 255]);
    for kind in ["", "--z-buffer", "--samples 3"] {
        assert!(picture(&format!("-o p.png {kind}")).count(blue) > 1000, "{kind}");
        let inside = picture(&format!("-o p.png --cull back {kind}"));
        assert!(inside.count(red) > 1000 && inside.count(blue) == 0, "{kind}");
    }
    picture("-o p.png --cull back --difference");
    folder.run("draw room.obj --direction=0,-1,0 --up z -o p.svg --cull back").good();
    let svg = fs::read_to_string(folder.path("p.svg")).unwrap();
    assert_eq!(svg.matches("<path").count(), 1, "{svg}");
    assert!(svg.contains("#ff0000") && !svg.contains("#0000ff"), "{svg}");
    folder.run("verify room.obj --views 6 --size 60x40 --cull back").good();
    folder.run("verify random:100 --views 4 --size 60x40 --cull back").good();
}

#[test]
fn a_picture_of_backs_says_so() {
    let folder = Folder::new("cull_note");
    folder.write("room.obj", ROOM);
    let said = |options: &str| {
        let run = folder.run(&format!("{options} --size 60x40"));
        let said = run.err.contains("--cull back");
        run.good();
        said
    };
    for view in ["", "--direction=1,-1,1", "--eye=5,6,7"] {
        assert!(said(&format!("render room.obj -o p.png {view}")), "{view}");
        assert!(said(&format!("draw room.obj -o p.svg {view}")), "{view}");
        assert!(!said(&format!("render room.obj -o p.png {view} --cull back")), "{view}");
    }
    // From inside, and for pictures of fronts or of both sides.
    assert!(!said("render room.obj -o p.png --eye=0.5,0.5,0.2"));
    for scene in ["teapot:3", "city:300", "random:100", "crossing:4", "newell", "terrain:200"] {
        assert!(!said(&format!("render {scene} -o p.png")), "{scene}");
    }
}
