//! The number of frames of a camera's path that need no new order, because no partition plane lies between
//! the eye and the eye of the last ordered frame.

use binspace::glam::DVec3;
use binspace::{BspTree, Viewpoint};
use std::time::{Duration, Instant};
use support::{Table, check, scene, time};

const SCENES: [&str; 5] =
    ["terrain:10000", "sphere:10000", "city:10000", "random:300", "layers:12"];

/// The number of frames of a path, at 60 frames per second.
const FRAMES: usize = 1200;

/// Paths through the middle third of a scene at eye height, with the speed in extents per frame; and a path
/// once around the scene.
const PATHS: [(&str, Path); 3] =
    [("slow walk", Path::Walk(2e-5)), ("fast walk", Path::Walk(5e-4)), ("orbit", Path::Orbit)];

#[derive(Clone, Copy)]
enum Path {
    Walk(f64),
    Orbit,
}

impl Path {
    /// The eye of a frame in shares of the scene's extent, from the middle of its bounds.
    fn eye(self, frame: usize) -> DVec3 {
        let frame = frame as f64;
        match self {
            // The walker sometimes steps to the side, and the head moves up and down.
            Self::Walk(step) => {
                let gone = frame * step;
                DVec3::new(
                    gone - 0.17,
                    0.02 * (gone * 40.0).sin() + 0.013,
                    0.11 + 0.1 * step * (frame * 0.2).sin(),
                )
            }
            Self::Orbit => {
                let angle = frame / FRAMES as f64 * std::f64::consts::TAU;
                DVec3::new(1.5 * angle.cos(), 1.5 * angle.sin(), 0.6)
            }
        }
    }
}

pub(crate) fn run() {
    let table = Table::new(
        "Frames that keep their order",
        &["scene", "path", "frames", "share", "same_order", "order"],
    );
    for name in SCENES {
        let scene = scene(name);
        let tree = BspTree::build(scene.polygons()).expect("within budget");
        check(&tree, &scene);
        let (low, high) = scene.bounds().expect("a scene with polygons");
        let extent = (high - low).max_element();
        for (path_name, path) in PATHS {
            let eye = |frame| Viewpoint::Eye((low + high) * 0.5 + path.eye(frame) * extent);
            let (kept, asking, ordering) = walk(&tree, eye);
            table.row(&[
                name.to_owned(),
                path_name.to_owned(),
                kept.to_string(),
                format!("{:.1} %", 100.0 * kept as f64 / (FRAMES - 1) as f64),
                time(asking / (FRAMES - 1) as u32),
                time(ordering / (FRAMES - kept) as u32),
            ]);
        }
    }
}

/// The number of frames that keep the order of an earlier frame, the time of the test, and the time of an
/// order.
fn walk(tree: &BspTree, eye: impl Fn(usize) -> Viewpoint) -> (usize, Duration, Duration) {
    let (mut order, mut other) = (Vec::new(), Vec::new());
    let (mut asking, mut ordering) = (Duration::ZERO, Duration::ZERO);
    let (mut kept, mut ordered) = (0, None);
    for frame in 0..FRAMES {
        let begin = Instant::now();
        let same = ordered.is_some_and(|last| tree.same_order(last, eye(frame)));
        asking += begin.elapsed();
        if same {
            kept += 1;
        } else {
            let begin = Instant::now();
            tree.back_to_front_into(eye(frame), &mut order);
            ordering += begin.elapsed();
            ordered = Some(eye(frame));
        }
        // The kept order equals the order of this frame.
        tree.back_to_front_into(eye(frame), &mut other);
        assert!(order == other, "frame {frame}");
    }
    (kept, asking, ordering)
}
