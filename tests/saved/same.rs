//! Reading returns the written tree, bit for bit.

use proptest::prelude::*;
use std::io;
use testkit::prelude::*;
use testkit::rays::Rays;
use testkit::saved::{bytes, use_all};
use testkit::snapshot::{Snapshot, order};
use testkit::views;

fn again(tree: &BspTree) -> BspTree {
    let file = bytes(tree);
    let again = BspTree::read(&file[..]).expect("a file that was written");
    assert_eq!(bytes(&again), file, "another file");
    again
}

/// Asserts that two trees have the same fragments, statistics, weights and orders.
fn assert_same(tree: &BspTree, eyes: &[Viewpoint]) {
    let again = again(tree);
    assert_eq!(Snapshot::of(&again), Snapshot::of(tree));
    assert_eq!(again.stats(), tree.stats());
    assert_eq!(again.preparation(), tree.preparation());
    assert!(again.dropped().eq(tree.dropped()));
    for (a, b) in again.fragments().zip(tree.fragments()) {
        assert!(a.weights().eq(b.weights()) && a.edges().eq(b.edges()));
        assert!(a.vertices().eq(b.vertices()));
    }
    for &eye in eyes {
        assert_eq!(order(&again, eye), order(tree, eye));
    }
    assert_eq!(again.validate(), Ok(()));
}

const EYES: [Viewpoint; 3] = [
    Viewpoint::Eye(DVec3::new(3.0, 1.0, 2.0)),
    Viewpoint::Eye(DVec3::new(0.1, -0.2, 0.05)),
    Viewpoint::Direction(DVec3::new(0.3, -1.0, 0.2)),
];

proptest! {
    #![proptest_config(cases(250, file!()))]

    #[test]
    fn trees_of_hard_scenes_come_back(
        scene in hard::scene(), by in hard::heuristic(), seed: u64,
    ) {
        let tree = scene.build(by).unwrap();
        let mut eyes = EYES.to_vec();
        if !tree.is_empty() {
            // Eyes are also on corners and planes.
            let (mut dice, rays) = (Dice(seed), Rays::new(&tree));
            eyes.extend((0..4).map(|_| views::some_view(tree.faces(), &rays, &mut dice).viewpoint));
        }
        assert_same(&tree, &eyes);
        assert_eq!(use_all(&tree), Ok(()));
        let mut builder = FrameBuilder::new(scene.options(by));
        assert_same(builder.build(&scene.polygons).unwrap(), &eyes);
    }
}

#[test]
fn trees_of_large_scenes_come_back() {
    let scenes = [
        scene::terrain(3000, 1),
        scene::sphere(2000),
        scene::city(3000, 2),
        scene::chain(9000),
        scene::random_triangles(120, 3),
        scene::newell_bars(),
        scene::cornell_box(),
        scene::teapot(6),
    ];
    let mut fragments = 0;
    for scene in scenes {
        let tree = BspTree::build(scene.polygons()).unwrap();
        assert_same(&tree, &EYES);
        assert_same(
            FrameBuilder::new(BuildOptions::DEFAULT).build(scene.polygons()).unwrap(),
            &EYES,
        );
        fragments += tree.len();
    }
    enough!(fragments > 15_000; "{fragments}");
}

#[test]
fn empty_trees_are_read_again() {
    for polygons in [vec![], vec![[[0.0; 3]; 3]; 4]] {
        let tree = BspTree::build(&polygons).unwrap();
        assert_same(&tree, &EYES);
        assert_eq!(again(&tree).preparation().dropped, polygons.len());
    }
    assert_same(FrameBuilder::new(BuildOptions::DEFAULT).tree(), &EYES);
}

/// A file may hold a tree and other data.
#[test]
fn a_reader_stops_at_the_end_of_the_tree() {
    let trees = [scene::crossing(3), scene::chain(7)]
        .map(|scene| BspTree::build(scene.polygons()).unwrap());
    let mut file: Vec<u8> = trees.iter().flat_map(bytes).collect();
    file.extend(b"rest");
    let mut rest = &file[..];
    for tree in &trees {
        let read = BspTree::read(&mut rest).unwrap();
        assert_eq!(Snapshot::of(&read), Snapshot::of(tree));
    }
    assert_eq!(rest, b"rest");
}

/// A reader that returns a byte at a time, and is interrupted.
struct Slow<'a>(&'a [u8], bool);

impl io::Read for Slow<'_> {
    fn read(&mut self, to: &mut [u8]) -> io::Result<usize> {
        self.1 = !self.1;
        if self.1 {
            return Err(io::ErrorKind::Interrupted.into());
        }
        let len = to.len().min(1);
        io::Read::read(&mut self.0, &mut to[..len])
    }
}

#[test]
fn a_slow_reader_is_waited_for() {
    let tree = BspTree::build(scene::crossing(3).polygons()).unwrap();
    let read = BspTree::read(Slow(&bytes(&tree), false)).unwrap();
    assert_eq!(Snapshot::of(&read), Snapshot::of(&tree));
}

#[test]
fn errors_of_readers_and_writers_are_passed_on() {
    use std::error::Error;

    struct Broken;
    impl io::Read for Broken {
        fn read(&mut self, _: &mut [u8]) -> io::Result<usize> {
            Err(io::Error::other("the disk is gone"))
        }
    }
    impl io::Write for Broken {
        fn write(&mut self, _: &[u8]) -> io::Result<usize> {
            Err(io::Error::other("the disk is full"))
        }
        fn flush(&mut self) -> io::Result<()> {
            Ok(())
        }
    }
    let error = BspTree::read(Broken).unwrap_err();
    assert!(error.kind() == binspace::ErrorKind::Io && error.source().is_some(), "{error}");
    assert_eq!(error.to_string(), "cannot be read: the disk is gone");
    let tree = BspTree::build(scene::chain(2).polygons()).unwrap();
    assert_eq!(tree.write(Broken).unwrap_err().to_string(), "the disk is full");
}

/// A writer that fails at one call, counted from 0, and accepts everything at other calls.
struct FailsOnce {
    calls: usize,
    at: usize,
}

impl io::Write for FailsOnce {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.calls += 1;
        if self.calls == self.at + 1 {
            return Err(io::Error::other("the network is gone"));
        }
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

/// The writer fails at any position, in each list of a file.
#[test]
fn a_writer_that_fails_once_is_reported() {
    // Each list is longer than one write, 64 kB: a wall cuts all of many squares.
    const COUNT: usize = 9000;
    let square = |k: usize| {
        let z = (k * 2753 % COUNT) as f64;
        [[0.0, 0.0, z], [2.0, 0.0, z], [2.0, 2.0, z], [0.0, 2.0, z]]
    };
    let wall =
        [[1.0, -1.0, -1.0], [1.0, 3.0, -1.0], [1.0, 3.0, COUNT as f64], [1.0, -1.0, COUNT as f64]];
    let polygons = [wall].into_iter().chain((0..COUNT).map(square));
    let tree = BuildOptions::DEFAULT.with_heuristic(Heuristic::First).build(polygons).unwrap();
    assert!(8 * tree.nodes().len() > 1 << 16 && tree.len() == 2 * COUNT + 1, "{tree:?}");
    let written = bytes(&tree).len();
    let mut calls = 0;
    loop {
        let mut output = FailsOnce { calls: 0, at: calls };
        match tree.write(&mut output) {
            Err(error) => assert_eq!(error.to_string(), "the network is gone"),
            Ok(()) => break,
        }
        calls += 1;
    }
    assert!(calls >= written >> 16, "{calls}");
}
