//! Real files in the folder that `BINSPACE_SCENES` names.

use crate::obj::sides;
use std::path::Path;
use testkit::prelude::*;
use testkit::real_scenes;
use testkit::targets::obj::polygons_of_tobj;

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
#[ignore = "needs the real scenes: BINSPACE_SCENES"]
fn real_scenes_match_their_manifest() {
    let folder = real_scenes::folder();
    let rows = manifest(&folder);
    enough!(rows.len() >= 10; "{} rows", rows.len());
    for (name, counts, low, high) in rows {
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
#[ignore = "needs the real scenes: BINSPACE_SCENES"]
fn torture_files_are_read_or_refused_with_a_reason() {
    let folder = real_scenes::folder();
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

/// Compares two independent evaluations of the published patches: every corner of one is a corner of the
/// other. The file has 5 decimals.
#[test]
#[ignore = "needs the real scenes: BINSPACE_SCENES"]
fn generated_teapot_agrees_with_the_real_one() {
    let folder = real_scenes::folder();
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
#[ignore = "needs the real scenes: BINSPACE_SCENES"]
fn generated_cornell_box_agrees_with_the_real_one() {
    let folder = real_scenes::folder();
    let (file, _) = Scene::read_obj(folder.join("cornell_box.obj")).expect("the Cornell box");
    let ours = scene::cornell_box();
    let near = |a: &DVec3, b: &DVec3| a.distance(*b) < 1e-4;
    for (a, b) in file.polygons().zip(ours.polygons()) {
        let same = a.points().iter().all(|p| b.points().iter().any(|q| near(p, q)));
        assert!(same, "{a:?} {b:?}");
    }
}

#[test]
#[ignore = "needs the real scenes: BINSPACE_SCENES"]
fn real_scenes_are_read_as_by_tobj() {
    let mut compared = 0;
    for entry in std::fs::read_dir(real_scenes::folder()).expect("a folder") {
        let path = entry.expect("an entry").path();
        if path.extension().is_none_or(|extension| extension != "obj") {
            continue;
        }
        let (scene, _) = Scene::read_obj(&path).expect("a valid file");
        let polygons = polygons_of_tobj(&std::fs::read(&path).expect("a file"));
        let polygons = polygons.expect("a file of plain text");
        assert!(scene.polygons().map(|p| p.points().to_vec()).eq(polygons), "{}", path.display());
        compared += scene.len();
    }
    enough!(compared > 100_000; "{compared} polygons");
}
