//! Bounds decide the side that polygons show only where the exact predicate agrees. Eyes are far away in the
//! plane of a small polygon, where a rounded normal alone would decide, or next to this plane.

use binspace::Facing;
use testkit::prelude::*;

#[test]
fn bounds_of_normals_hold_the_exact_normals() {
    let (mut undecided, mut decided) = (0, 0);
    for seed in seeds(2000) {
        let mut dice = Dice(seed);
        let mut vector =
            |n: u32| DVec3::new(dice.around_zero(n), dice.around_zero(n), dice.around_zero(n));
        // Whole numbers, so that everything below is exact.
        let (at, u, v) = (vector(1000), vector(20), vector(20));
        let normal = u.cross(v);
        if normal == DVec3::ZERO {
            continue;
        }
        let options =
            BuildOptions::DEFAULT.with_bounds(DVec3::splat(-2000.0), DVec3::splat(2000.0));
        let tree: BspTree = options.build([[at, at + u, at + v]]).unwrap();
        let root = tree.root().unwrap();
        let fragment = tree.fragment(0);
        let steps = [0.0, 1.0, 3.0, 1e3, 1e6, 3e8];
        for (i, j) in (0..36).map(|k| (steps[k / 6], -steps[k % 6])) {
            let on = at + u * i + v * j;
            for (off, side) in
                [(0.0, Ordering::Equal), (1.0, Ordering::Greater), (-1.0, Ordering::Less)]
            {
                let viewpoint = Viewpoint::eye(on + normal * off);
                let exact = fragment.facing(viewpoint);
                assert_eq!(exact, side.into(), "{seed}: the case is another");
                match root.facing_all(viewpoint) {
                    Some(told) => assert_eq!(told, exact, "{seed}: {i} {j} {off}"),
                    None => undecided += 1,
                }
            }
            let along = Viewpoint::direction(u * (i + 1.0) + v * j);
            assert_eq!(root.facing_all(along), None, "{seed}: {i} {j}, along the plane");
        }
        // The bounds decide if the eye is clearly off the plane.
        let eye = Viewpoint::eye(at + normal * 1e4);
        decided += usize::from(root.facing_all(eye) == Some(Facing::Front));
    }
    enough!(undecided > 50_000, decided > 1500; "{undecided} undecided, {decided} decided");
}
