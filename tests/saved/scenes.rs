//! Scenes that are written and read back.

use binspace::scene::Material;
use testkit::prelude::*;
use testkit::saved::seal;

fn bytes(scene: &Scene) -> Vec<u8> {
    let mut bytes = Vec::new();
    scene.write(&mut bytes).unwrap();
    bytes
}

/// A scene with every attribute that a file can have.
fn full() -> Scene {
    let text =
        b"mtllib m\nv 0 0 0 1 0 0\nv 1 0 0 0 1 0\nv 0 1 0 0 0 1\nv 5 5 5\nvt 0.5 0.25\nvn 0 0 1\n\
        usemtl a\nf 1/1/1 2 3//1\nusemtl \xc3\xa4\nf 2 3 4/1\nf 1 1 1\n";
    let library = b"newmtl a\nKd 1 0.5 0.25\nnewmtl \xc3\xa4\nd 0.5\n";
    Scene::from_obj("full", text, |_| Some(library.to_vec())).unwrap().0
}

#[test]
fn scenes_come_back() {
    let mut odd = Scene::new("", DVec3::new(-0.0, f64::INFINITY, 3.0));
    odd.push([DVec3::new(1e300, -0.0, f64::MIN_POSITIVE)], 77);
    odd.push([], 0);
    odd.add_material(Material::new("größe", [0.1, 0.2, 0.3]).with_opacity(0.25));
    let view = scene::random_triangles(3, 1).with_view(DVec3::X, DVec3::Y);
    for scene in
        [full(), odd, view, scene::cornell_box(), scene::teapot(3), Scene::new("n", DVec3::Z)]
    {
        let file = bytes(&scene);
        let read = Scene::read(&file[..]).unwrap();
        assert_eq!(read, scene);
        assert_eq!(bytes(&read), file);
        assert!((0..scene.len()).all(|polygon| read.line(polygon) == scene.line(polygon)));
    }
    let full = full();
    let again = Scene::read(&bytes(&full)[..]).unwrap();
    assert_eq!((again.uv(0, 0), again.normal(0, 2)), (full.uv(0, 0), full.normal(0, 2)));
    assert!(again.uv(0, 0).is_some() && again.color(1, 0).is_some() && again.line(2) == Some(12));
}

#[test]
fn damaged_scenes_are_refused_and_forged_ones_usable() {
    let file = bytes(&full());
    for len in 0..file.len() {
        let error = Scene::read(&file[..len]).unwrap_err();
        assert!(error.to_string().contains("truncated"), "{len}: {error}");
    }
    let (mut usable, mut refused) = (0, 0);
    for at in 0..file.len() {
        for change in [1, 0x10, 0x80, 0xff] {
            let mut damaged = file.clone();
            damaged[at] ^= change;
            assert!(Scene::read(&damaged[..]).is_err(), "byte {at}");
            seal(&mut damaged);
            match Scene::read(&damaged[..]) {
                Ok(scene) => {
                    usable += 1;
                    for polygon in 0..scene.len() {
                        for corner in 0..scene.polygon(polygon).len() {
                            let _ = (scene.uv(polygon, corner), scene.normal(polygon, corner));
                            let _ = scene.color(polygon, corner);
                        }
                        let _ = (scene.material(polygon), scene.line(polygon));
                    }
                    let _ = (scene.bounds(), BspTree::build(scene.polygons()));
                }
                Err(error) => {
                    refused += 1;
                    assert!(!error.to_string().is_empty());
                }
            }
        }
    }
    enough!(usable > 300, refused > 100; "{usable} {refused}");
}

/// Lists that have one item too few or too many.
#[test]
fn lists_of_another_length_than_the_scene_are_refused() {
    let file = bytes(&full());
    // The file ends with the list of lines, the attributes of nine corners, and the checksum.
    let (lines, attributes) = (3, [20, 28, 16]);
    let list = |item: usize| 8 + 9 * item;
    let mut at = file.len() - 4 - attributes.map(list).iter().sum::<usize>() - (8 + lines * 8);
    let lists = [("lines", lines, 8), ("texture", 9, 20), ("texture", 9, 28), ("texture", 9, 16)];
    for (what, count, item) in lists {
        assert_eq!(file[at..at + 8], (count as u64).to_le_bytes(), "{what}");
        for other in [count - 1, count + 1] {
            let mut forged = file.clone();
            forged[at..at + 8].copy_from_slice(&(other as u64).to_le_bytes());
            let first = at + 8;
            match other < count {
                true => drop(forged.drain(first..first + item)),
                false => drop(forged.splice(first..first, file[first..first + item].to_vec())),
            }
            seal(&mut forged);
            let error = Scene::read(&forged[..]).unwrap_err().to_string();
            assert!(error.contains(what) && error.contains("do not match"), "{error}");
        }
        at += 8 + count * item;
    }
}

#[test]
fn a_tree_is_no_scene() {
    let mut file = Vec::new();
    BspTree::build(scene::chain(3).polygons()).unwrap().write(&mut file).unwrap();
    let error = Scene::read(&file[..]).unwrap_err();
    assert!(error.to_string().contains("contains a \"tree\", but a \"scen\""), "{error}");
}
