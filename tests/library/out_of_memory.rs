//! If the polygons, a tree's file or a tree's mesh do not fit into memory, an error is returned and the
//! program continues. Each case runs in a separate process, with limited memory.
#![allow(clippy::print_stdout, reason = "a process tells another how much memory it took")]

use binspace::ErrorKind;
use std::env;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use testkit::prelude::*;
use testkit::scenes::polygons;

type Polygons = Vec<Vec<DVec3>>;

/// The environment variable that names the case in a process that this test starts.
const CASE: &str = "BINSPACE_OUT_OF_MEMORY";

const CASES: [&str; 8] = ["heap", "sphere", "layers", "sampled", "extend", "frame", "read", "mesh"];

fn heap() -> Polygons {
    polygons(&scene::random_triangles(1500, 1))
}

/// Small blocks of free memory, too small for the lists. Small unchecked allocations succeed, so only the
/// lists meet the limit.
fn keep_small_change() -> Vec<Box<[u8]>> {
    let (change, kept): (Vec<_>, Vec<_>) = (0..200)
        .map(|_| (vec![1_u8; 40_000].into_boxed_slice(), vec![1_u8; 64].into_boxed_slice()))
        .unzip();
    drop(change);
    kept
}

/// A figure of this process, in kB.
fn status(name: &str) -> usize {
    let status = std::fs::read_to_string("/proc/self/status").expect("Linux");
    let line = status.lines().find(|line| line.starts_with(name)).expect("a figure");
    line.split_whitespace().nth(1).and_then(|figure| figure.parse().ok()).expect("a number")
}

/// Runs a case, and returns whether memory ran out.
fn run(case: &str) -> bool {
    let polygons: Polygons = match case {
        "sphere" => polygons(&scene::sphere(20_000)),
        "layers" => (0..30_000).map(|k| square(f64::from(k % 3), f64::from(k / 3))).collect(),
        "heap" | "sampled" | "extend" | "frame" => heap(),
        "read" | "mesh" => vec![],
        other => panic!("{other}"),
    };
    let options = match case {
        "sampled" => BuildOptions::DEFAULT.with_heuristic("sampled(16)".parse().expect("a name")),
        _ => BuildOptions::DEFAULT.with_bounds(DVec3::splat(-9.0), DVec3::splat(9.0)),
    };
    // The input of the case is made before this. The limits that the parent sets are above the memory of the
    // input.
    match case {
        "extend" => {
            let mut tree = options.build(&polygons[..700]).expect("room");
            began();
            tree.extend(&polygons[700..]).is_err_and(|error| error.kind() == ErrorKind::OutOfMemory)
        }
        "frame" => {
            began();
            let mut builder = FrameBuilder::new(options);
            let failed =
                builder.build(&polygons).is_err_and(|error| error.kind() == ErrorKind::OutOfMemory);
            assert!(!failed || builder.tree().is_empty() && builder.tree().root().is_none());
            failed
        }
        "read" => {
            let file = std::fs::read(tree_file()).expect("the parent's file");
            began();
            BspTree::read(&file[..]).is_err_and(|error| error.to_string().contains("memory"))
        }
        "mesh" => {
            let file = std::fs::File::open(tree_file()).expect("the parent's file");
            let tree = BspTree::read(file).expect("room");
            began();
            tree.welded_mesh().is_err_and(|error| error.kind() == ErrorKind::OutOfMemory)
        }
        _ => {
            began();
            options.build(&polygons).is_err_and(|error| error.kind() == ErrorKind::OutOfMemory)
        }
    }
}

fn square(x: f64, y: f64) -> Vec<DVec3> {
    [[0.0, 0.0], [0.9, 0.0], [0.9, 0.9], [0.0, 0.9]]
        .map(|[dx, dy]| DVec3::new(x / 10.0 + dx, y / 4000.0 + dy, 0.0))
        .to_vec()
}

fn began() {
    println!("began at {} kB", status("VmPeak"));
}

/// The file in which the parent stores a tree.
fn tree_file() -> PathBuf {
    Path::new(env!("CARGO_TARGET_TMPDIR")).join("out_of_memory.tree")
}

/// Runs this program again for one case, with limited memory.
fn process(case: &str, kilobytes: Option<usize>) -> Output {
    let program = env::current_exe().expect("this program");
    let limit = kilobytes.map_or("unlimited".to_owned(), |kilobytes| kilobytes.to_string());
    Command::new("sh")
        .args(["-c", &format!("ulimit -v {limit}; exec \"$0\" library::out_of_memory::one_case --exact --ignored --nocapture")])
        .arg(program)
        // One arena that grows on demand, so that the limit meets the lists that grow.
        .envs([("MALLOC_ARENA_MAX", "1"), ("MALLOC_TOP_PAD_", "0"), ("RAYON_NUM_THREADS", "2")])
        .env("RUST_TEST_THREADS", "1")
        .env("MALLOC_MMAP_THRESHOLD_", "65536")
        .env(CASE, case)
        .output()
        .expect("a shell")
}

/// The number after some words in the output of a process.
fn printed(output: &Output, words: &str) -> Option<usize> {
    let text = String::from_utf8_lossy(&output.stdout);
    let (_, rest) = text.split_once(words)?;
    rest.split_whitespace().next()?.parse().ok()
}

#[test]
#[ignore = "a part of the other test, which runs it in processes of its own"]
fn one_case() {
    let case = env::var(CASE).expect("the other test names it");
    // Starts the pool's threads before there is a limit.
    rayon::join(|| (), || ());
    let kept = keep_small_change();
    let failed = run(&case);
    println!("\nfailed: {} and peak {} kB", u8::from(failed), status("VmPeak"));
    drop(kept);
}

#[test]
fn memory_that_runs_out_is_an_error() {
    let file = std::fs::File::create(tree_file()).expect("a place for files of tests");
    BspTree::build(heap()).expect("room").write(file).expect("room");
    for case in CASES {
        let free = process(case, None);
        let (Some(from), Some(peak)) = (printed(&free, "began at "), printed(&free, "and peak "))
        else {
            panic!("{case}: {free:?}");
        };
        assert_eq!(printed(&free, "failed: "), Some(0), "{case}");
        assert!(peak > from + 500, "{case}: it takes no memory, {from} to {peak} kB");
        // A build fails while it reads polygons; its budgets limit the later steps.
        let eighths = if ["read", "mesh"].contains(&case) { 1..8 } else { 1..2 };
        let (cases, mut failed) = (eighths.len(), 0);
        for eighth in eighths {
            let limit = from + (peak - from) * eighth / 8;
            let output = process(case, Some(limit));
            assert!(
                output.status.success(),
                "{case} with {limit} of {from} to {peak} kB: {}\n{}",
                output.status,
                String::from_utf8_lossy(&output.stderr)
            );
            failed += printed(&output, "failed: ").expect("an outcome");
        }
        assert!(2 * failed >= cases, "{case}: memory ran out {failed} times of {cases}");
    }
}
