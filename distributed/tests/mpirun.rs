//! Runs the program by `mpirun`: pictures are the same, bit for bit, on any number of ranks, and an error
//! on one rank ends all.
//!
//! The tests are ignored because they need Open MPI; `cargo test --test mpirun -- --ignored` runs them.

use std::fs::{self, File};
use std::io::BufReader;
use std::path::{Path, PathBuf};
use std::process::Command;

/// The result of a run.
#[derive(Debug)]
struct Run {
    status: Option<i32>,
    out: String,
    err: String,
}

/// Runs the program on some ranks, in a folder. Each run has its own folder for temporary files. Otherwise
/// all runs of Open MPI would share one folder, which a run that ends removes while another run begins.
fn run(folder: &Path, ranks: usize, arguments: &str) -> Run {
    let temporary = tempfile::tempdir().unwrap();
    let mut command = Command::new("timeout");
    command.args(["100", "mpirun", "--allow-run-as-root", "--oversubscribe", "-np"]);
    command.arg(ranks.to_string()).arg(env!("CARGO_BIN_EXE_binspace-mpi"));
    command.args(arguments.split_whitespace()).current_dir(folder).env("TMPDIR", temporary.path());
    let output = command.output().unwrap();
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    Run { status: output.status.code(), out: text(&output.stdout), err: text(&output.stderr) }
}

/// The picture that a run writes, in RGB.
fn picture(folder: &Path, ranks: usize, arguments: &str) -> Vec<u8> {
    let run = run(folder, ranks, &format!("{arguments} -o p.png"));
    assert_eq!(run.status, Some(0), "{ranks} ranks: {run:?}");
    let file = BufReader::new(File::open(folder.join("p.png")).unwrap());
    let mut reader = png::Decoder::new(file).read_info().unwrap();
    let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
    reader.next_frame(&mut pixels).unwrap();
    fs::remove_file(folder.join("p.png")).unwrap();
    pixels
}

/// The figures of each rank.
fn figures(run: &Run) -> Vec<Vec<f64>> {
    let rows = run.out.lines().skip(1);
    rows.map(|line| line.split(',').map(|number| number.parse().unwrap()).collect()).collect()
}

/// The number of pixels that are not white.
fn covered(picture: &[u8]) -> usize {
    picture.chunks(3).filter(|pixel| *pixel != [255; 3]).count()
}

/// For each number of ranks, the picture equals the picture of a single tree without cells.
fn same_on_all(folder: &Path, scene: &str, views: &[&str], least: usize) {
    for view in views {
        let arguments = format!("{scene} --size 128x96 {view}");
        let expected = picture(folder, 1, &format!("{arguments} --alone"));
        assert!(covered(&expected) >= least, "{arguments}");
        for ranks in [1, 2, 3, 4, 8] {
            let found = picture(folder, ranks, &arguments);
            assert!(found == expected, "{arguments}: {ranks} ranks paint another picture");
        }
    }
}

/// The shortest test of ranks that exchange pieces.
#[test]
#[ignore = "needs mpirun of Open MPI"]
fn two_ranks_paint_the_picture_of_one() {
    let folder = tempfile::tempdir().unwrap();
    let expected = picture(folder.path(), 1, "cloud:400 --size 128x96 --alone");
    assert!(covered(&expected) >= 1000);
    assert!(picture(folder.path(), 2, "cloud:400 --size 128x96") == expected);
}

const FAR_AND_INSIDE: [&str; 2] = ["", "--eye=5,3,1 --target=40,30,20"];

#[test]
#[ignore = "needs mpirun of Open MPI"]
fn pictures_are_those_of_one_process() {
    let folder = tempfile::tempdir().unwrap();
    same_on_all(folder.path(), "cloud:4000", &FAR_AND_INSIDE, 2000);
}

#[test]
#[ignore = "needs mpirun of Open MPI"]
fn pictures_of_a_scene_in_one_corner_are_the_same() {
    let folder = tempfile::tempdir().unwrap();
    same_on_all(folder.path(), "lump:3000", &["", "--eye=38,39,47 --target=40,40,40"], 30);
}

/// More ranks than polygons, one polygon, and no polygon.
#[test]
#[ignore = "needs mpirun of Open MPI"]
fn ranks_without_polygons_do_their_part() {
    let folder = tempfile::tempdir().unwrap();
    for (scene, least) in [("cloud:5", 10), ("cloud:1", 10), ("cloud:0", 0)] {
        same_on_all(folder.path(), scene, &[""], least);
    }
}

/// All polygons are in the cell of one rank: their first corners are equal, so all samples are in one place.
/// One far sample, of a face without area, makes the extent large.
#[test]
#[ignore = "needs mpirun of Open MPI"]
fn a_scene_in_one_cell_of_many_is_the_same() {
    let folder = tempfile::tempdir().unwrap();
    let mut text = "mtllib m.mtl\nv 1 1 1\nv 100 90 80\nf 2 2 2\n".to_owned();
    for k in 0..40 {
        let angle = f64::from(k) * 0.37;
        let (u, v, w) = (angle.sin(), angle.cos(), (angle * 2.3).sin());
        text += &format!("usemtl {}\n", if k % 3 == 0 { "a" } else { "b" });
        text += &format!(
            "v {} {} {}\nv {} {} {}\n",
            1.0 + u,
            1.0 + v,
            1.0 + w,
            1.0 - w,
            1.0 + u,
            1.0 - v
        );
        text += "f 1 -2 -1\n";
    }
    write_parts(folder.path());
    for file in 0..5 {
        fs::remove_file(folder.path().join(format!("part{file}.obj"))).unwrap();
    }
    fs::write(folder.path().join("s.obj"), text).unwrap();
    let view = "--eye=4,3,5 --target=1,1,1";
    same_on_all(folder.path(), "s.obj", &[view], 1000);
    for ranks in [2, 3, 4, 8] {
        let run = run(folder.path(), ranks, &format!("s.obj -o p.png --figures {view}"));
        let rows = figures(&run);
        let full: Vec<f64> = rows.iter().map(|row| row[3]).filter(|&count| count > 0.0).collect();
        assert_eq!((rows.len(), full), (ranks, vec![40.0]), "{run:?}");
    }
}

/// Walls in the planes x = 0, 1, …, panes that penetrate them, and decals on both.
fn write_parts(folder: &Path) {
    let mut corners = String::new();
    let mut square = |at: [f64; 3], u: [f64; 3], v: [f64; 3]| {
        for [a, b] in [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]] {
            let p: Vec<String> =
                (0..3).map(|i| format!("{}", at[i] + a * u[i] + b * v[i])).collect();
            corners += &format!("v {}\n", p.join(" "));
        }
        corners += "f -4 -3 -2 -1\n";
        std::mem::take(&mut corners)
    };
    fs::write(folder.join("m.mtl"), "newmtl a\nKd 0.9 0.3 0.1\nnewmtl b\nKd 0.1 0.3 0.9\nd 0.4\n")
        .unwrap();
    for file in 0..5 {
        let x = f64::from(file);
        let mut text = "mtllib m.mtl\nusemtl b\n".to_owned();
        text += &square([x, 0.0, 0.0], [0.0, 4.0, 0.0], [0.0, 0.0, 4.0]);
        text += "usemtl a\n";
        text += &square([x, 1.0, 1.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]);
        text += &square([-1.0, x * 0.75, 0.5], [7.0, 0.0, 0.0], [0.0, 0.5, 2.0]);
        text += "usemtl b\n";
        text += &square([-1.0, 0.25, x * 0.75 + 0.1], [7.0, 0.0, 0.3], [0.0, 3.0, 0.0]);
        fs::write(folder.join(format!("part{file}.obj")), text).unwrap();
    }
}

#[test]
#[ignore = "needs mpirun of Open MPI"]
fn files_that_ranks_share_are_one_scene() {
    let folder = tempfile::tempdir().unwrap();
    write_parts(folder.path());
    let views = ["", "--eye=9,3,7", "--eye=2,2,2.2 --target=0,1,0"];
    same_on_all(folder.path(), ".", &views, 2000);
}

/// Squares in one plane, each in a file of its own, come in the order of the files, whichever rank reads them. Also
/// squares that differ in height by less than the decimals of one of the files.
#[test]
#[ignore = "needs mpirun of Open MPI"]
fn squares_in_one_plane_come_in_the_order_of_the_files() {
    for step in [0.0, -0.000_002] {
        let folder = tempfile::tempdir().unwrap();
        let mut materials = String::new();
        for file in 0..5 {
            materials += &format!("newmtl m{file}\nKd 0.{} 0.{} 0.5\n", file + 2, 9 - file);
            let (x, z) = (0.5 * f64::from(file), step * f64::from(file));
            let corners = [(x, 0.0), (x + 1.0, 0.0), (x + 1.0, 3.0), (x, 3.0)];
            // The first file has fewer decimals than the others.
            let line = |(x, y)| match file {
                0 => format!("v {x:.3} {y:.3} {z:.3}\n"),
                _ => format!("v {x:.9} {y:.9} {z:.9}\n"),
            };
            let text = corners.map(line).concat();
            let text = format!("mtllib m.mtl\nusemtl m{file}\n{text}f 1 2 3 4\n");
            fs::write(folder.path().join(format!("part{file}.obj")), text).unwrap();
        }
        fs::write(folder.path().join("m.mtl"), materials).unwrap();
        same_on_all(folder.path(), ".", &["--eye=1.5,1,6 --target=1.5,1.5,0"], 1000);
    }
}

/// A bad file on one rank, a budget that one rank exceeds, an output that rank 0 cannot write, and a
/// command line that is wrong on all: one message, exit status 2, and no picture.
#[test]
#[ignore = "needs mpirun of Open MPI"]
fn an_error_on_one_rank_ends_all() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    write_parts(path);
    fs::write(path.join("part2.obj"), "v 0 0 0\nv 1 0 0\nf 1 2 9\n").unwrap();
    let before = fs::read_dir(path).unwrap().count();
    for (ranks, arguments, problem) in [
        (4, ". -o p.png", "rank 2: ./part2.obj"),
        (2, ". -o p.png", "vertex 9 does not exist"),
        (3, "lump:3000 --max-fragments 900 -o p.png", "raise the budget"),
        (3, "cloud:30 -o none/p.png", "rank 0: none/p.png: cannot be written"),
        (3, "cloud:30 --tolerance -1 -o p.png", "rank 0: the coplanar tolerance"),
        (2, "cloud:30 --eye 1,2,3 --target 1,2,3 -o p.png", "rank 0"),
        (2, "cloud:30 -o /", "rank 0: /: cannot be written"),
        (2, "cloud:18446744073709551615 -o p.png", "no memory for so many polygons"),
        // These errors are reported before the scene is read.
        (2, "no_such_file.obj -o none/p.png", "rank 0: none/p.png: cannot be written"),
        (2, "cloud:30", "Usage"),
        (2, "no_such_file.obj -o p.png", "no_such_file.obj"),
        (2, "cloud:30 --alone -o p.png", "--alone is for one rank"),
    ] {
        let run = run(path, ranks, arguments);
        assert_eq!(run.status, Some(2), "{arguments}: {run:?}");
        assert!(run.err.contains(problem), "{arguments}: {run:?}");
        assert_eq!(run.err.matches("error: rank").count(), 1, "{arguments}: {run:?}");
        assert!(run.out.is_empty() && !path.join("p.png").exists(), "{arguments}: {run:?}");
        let files = fs::read_dir(path).unwrap().count();
        assert_eq!(files, before, "{arguments}");
    }
}

#[test]
#[ignore = "needs mpirun of Open MPI"]
fn figures_have_a_line_for_each_rank() {
    let folder: PathBuf = tempfile::tempdir().unwrap().keep();
    let run = run(&folder, 3, "cloud:2000 -o p.png --figures");
    fs::remove_dir_all(&folder).unwrap();
    let rows = figures(&run);
    assert_eq!(rows.len(), 3, "{run:?}");
    let sum = |column: usize| rows.iter().map(|row| row[column]).sum::<f64>();
    // Each polygon is given once, and reaches into one cell or more.
    assert_eq!(sum(1), 2000.0);
    assert!(sum(2) >= sum(3) && sum(3) > 2000.0 && sum(4) >= sum(3), "{run:?}");
}
