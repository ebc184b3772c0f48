//! Boxes that many threads need at once.

use binspace::Ray;
use rayon::prelude::*;
use testkit::prelude::*;

/// The first queries of a tree come from all threads of a pool, and from outside it. The tree is large, so
/// that making the boxes takes some time.
#[test]
fn the_first_queries_may_come_from_all_threads_at_once() {
    for round in 0..times(3) {
        let tree = BspTree::build(scene::terrain(8000, round as u64).polygons()).unwrap();
        let [low, high] = tree.clone().bounds().unwrap();
        let rays: Vec<Ray> = (0..256)
            .map(|k| {
                let share = f64::from(k) / 256.0;
                let at = low + (high - low) * DVec3::new(share, 0.37, 2.0);
                Ray::new(at, [0.001, 0.002, -1.0])
            })
            .collect();
        let found = std::thread::scope(|scope| {
            let outside = scope.spawn(|| rays.iter().filter(|&&ray| tree.is_occluded(ray)).count());
            let inside: usize =
                rays.par_iter().map(|&ray| usize::from(tree.hits(ray).next().is_some())).sum();
            [inside, outside.join().unwrap()]
        });
        assert!(found[0] == found[1] && found[0] > 200, "{found:?}");
    }
}
