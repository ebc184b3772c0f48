//! Progress of maps and drawings, and their cancellation.

use std::ops::ControlFlow;

use binspace::drawing::{Drawing, VisibilityMap};
use binspace::raster::Rays;
use binspace::scene::Builtin;
use binspace::view::Camera;
use binspace::{BspTree, Error, Progress};

/// The tree of many crossing triangles, and the rays of a view.
fn tree_and_rays() -> (BspTree, Rays) {
    let scene = Builtin::Random.build(Some(500), 3);
    let tree = BspTree::build(scene.polygons()).unwrap();
    let (low, high) = scene.bounds().unwrap();
    let camera = Camera::looking_at_all([low, high], scene.up(), [400, 300]).unwrap();
    let rays = Rays::new(&camera, tree.faces()).unwrap();
    (tree, rays)
}

type Job<'j> = (
    &'j str,
    &'j dyn Fn(&mut (dyn FnMut(Progress) -> ControlFlow<()> + Send)) -> Result<(), Error>,
);

#[test]
fn jobs_tell_how_far_they_are_and_can_be_cancelled() {
    let (tree, rays) = tree_and_rays();
    let map = VisibilityMap::of(&tree, rays.clone()).unwrap();
    let mixed = |polygon: usize| if polygon.is_multiple_of(2) { 0.5 } else { 1.0 };
    let half = VisibilityMap::with_opacities(&tree, rays.clone(), mixed).unwrap();
    let jobs: [Job<'_>; 5] = [
        ("map", &|progress| {
            VisibilityMap::of_with_progress(&tree, rays.clone(), progress).map(drop)
        }),
        ("drawing", &|progress| map.drawing_with_progress(progress).map(drop)),
        ("map with opacities", &|progress| {
            VisibilityMap::with_opacities_and_progress(&tree, rays.clone(), mixed, progress)
                .map(drop)
        }),
        ("mixed drawing", &|progress| half.drawing_with_progress(progress).map(drop)),
        ("translucent", &|progress| {
            Drawing::translucent_with_progress(&tree, rays.clone(), progress).map(drop)
        }),
    ];
    for (name, job) in jobs {
        let mut heard: Vec<Progress> = vec![];
        job(&mut |progress| {
            heard.push(progress);
            ControlFlow::Continue(())
        })
        .unwrap();
        assert!(heard.len() > 10, "{name}: {heard:?}");
        assert!(heard.windows(2).all(|pair| pair[0].done <= pair[1].done), "{name}: {heard:?}");
        let some =
            heard.iter().filter(|progress| 0 < progress.done && progress.done < progress.total);
        assert!(some.count() > 1, "{name}: {heard:?}");
        assert!(heard.iter().any(|progress| progress.total > 0 && progress.done == progress.total));
        for calls in [1, heard.len() / 2] {
            let mut left = calls;
            let error = job(&mut |_| {
                left -= 1;
                if left == 0 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
            })
            .unwrap_err();
            assert!(error.is_cancelled() && left == 0, "{name}: {error}");
        }
    }
}

/// Who listens gets what others get.
#[test]
fn results_are_the_same_with_progress() {
    let (tree, rays) = tree_and_rays();
    let go_on = |_| ControlFlow::Continue(());
    let map = VisibilityMap::of(&tree, rays.clone()).unwrap();
    let other = VisibilityMap::of_with_progress(&tree, rays.clone(), go_on).unwrap();
    assert!(map.polygons().eq(other.polygons()) && map.polygons().count() > 100);
    let outlines = |drawing: &Drawing| -> Vec<_> {
        drawing
            .paths()
            .map(|path| (path.polygon(), path.outlines().map(<[_]>::to_vec).collect::<Vec<_>>()))
            .collect()
    };
    let (one, two) = (map.drawing().unwrap(), other.drawing_with_progress(go_on).unwrap());
    assert_eq!(outlines(&one), outlines(&two));
    let one = Drawing::translucent(&tree, rays.clone()).unwrap();
    let two = Drawing::translucent_with_progress(&tree, rays, go_on).unwrap();
    assert_eq!(outlines(&one), outlines(&two));
}
