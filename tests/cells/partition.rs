//! Partitions: their cells, and the polygons that reach them.

use crate::cells::polygons::{stars, tiles, triangles};
use binspace::partition::{Extent, Partition};
use binspace::{ErrorKind, Preparation};
use std::panic::{AssertUnwindSafe, catch_unwind};
use testkit::divided::{Divided, extent};
use testkit::prelude::*;
use testkit::scenes::polygons;
use testkit::shapes::{Claim, sheet};
use testkit::snapshot::Snapshot;

/// The visible data of a tree: the places of its fragments, and their polygons.
fn fragments(tree: &BspTree, number: impl Fn(usize) -> usize) -> Vec<(usize, Vec<DVec3>)> {
    tree.fragments().map(|f| (number(f.polygon()), f.vertices().collect())).collect()
}

/// Polygons that are not listed for a cell have no part in the cell. Few polygons are listed unnecessarily,
/// although the polygons are large compared with the cells.
#[test]
fn a_cell_needs_the_polygons_that_reach_it_and_no_others() {
    let (mut listed, mut had) = (0, 0);
    for cells in 1..10 {
        let mut dice = Dice(cells as u64 * 31);
        for polygons in [triangles(&mut dice, 60, 30), tiles(&mut dice, 60)] {
            let options = BuildOptions::DEFAULT;
            let scene = Divided::new(polygons, options.clone(), cells).unwrap();
            for (number, cell) in scene.cells.iter().enumerate() {
                let of_all = options.build_cell(&scene.partition, number, &scene.polygons).unwrap();
                let own = fragments(&cell.tree, |polygon| cell.given[polygon]);
                assert_eq!(own, fragments(&of_all, |polygon| polygon));
                listed += cell.given.len();
                had += cell.given.len() - cell.tree.preparation().dropped;
            }
        }
    }
    assert!(had > 2000 && listed * 10 < had * 14, "{listed} {had}");
}

#[test]
fn one_cell_is_the_tree_of_all() {
    let polygons = triangles(&mut Dice(2), 80, 50);
    let options = BuildOptions::DEFAULT;
    let scene = Divided::new(polygons, options.clone(), 1).unwrap();
    let all = options.build(&scene.polygons).unwrap();
    assert_eq!(fragments(&scene.cells[0].tree, |p| p), fragments(&all, |p| p));
    let stats = scene.cells[0].tree.stats();
    assert_eq!((stats.nodes, stats.tolerance), (all.stats().nodes, all.stats().tolerance));
    assert_eq!(scene.partition.tolerance(), stats.tolerance);
}

#[test]
fn the_order_of_samples_and_the_number_of_threads_do_not_count() {
    let polygons = triangles(&mut Dice(6), 1500, 1000);
    let all = extent(&polygons);
    let mut samples: Vec<DVec3> = polygons.iter().flatten().copied().collect();
    let options = BuildOptions::DEFAULT;
    let partition = options.partition(&all, samples.clone(), 13).unwrap();
    samples.reverse();
    samples.rotate_left(1234);
    assert_eq!(partition, options.partition(&all, samples, 13).unwrap());
    let build = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| options.build_cell(&partition, 5, &polygons).unwrap())
    };
    assert_eq!(Snapshot::of(&build(1)), Snapshot::of(&build(4)));
}

/// Checks the number of samples in each cell, for a scene without clusters.
#[test]
fn cells_have_about_as_many_samples() {
    let mut dice = Dice(1);
    let samples: Vec<DVec3> =
        (0..10_000).map(|_| DVec3::new(dice.share(), dice.share() * 3.0, dice.share())).collect();
    let mut all = Extent::default();
    all.include(&samples[..]);
    for cells in [1, 2, 3, 5, 8, 13, 100] {
        let partition = BuildOptions::DEFAULT.partition(&all, samples.clone(), cells).unwrap();
        for cell in 0..cells {
            let [low, high] = partition.bounds(cell);
            let is_in = |p: &&DVec3| p.cmpge(low).all() && p.cmplt(high).all();
            let share = samples.iter().filter(is_in).count() * cells;
            assert!((9_000..11_000).contains(&share), "{share} in {cell} of {cells}");
        }
    }
}

/// Degenerate samples: no sample, one sample, all in one place, or some NaN.
#[test]
fn odd_samples_give_as_many_cells() {
    let polygons = tiles(&mut Dice(3), 30);
    let at = DVec3::new(1.0, 1.0, 1.0);
    let odd = [vec![], vec![at], vec![at; 9], vec![DVec3::NAN, at, DVec3::INFINITY, at * 1e300]];
    for samples in odd {
        for cells in [0, 1, 2, 6, 9] {
            let all = extent(&polygons);
            let partition = BuildOptions::DEFAULT.partition(&all, samples.clone(), cells).unwrap();
            assert_eq!(partition.cells(), cells.max(1));
            let is_number = |cell| partition.bounds(cell).iter().all(|corner| !corner.is_nan());
            assert!((0..partition.cells()).all(is_number));
            let mut order = partition.back_to_front(Viewpoint::eye([9.0, 8.0, 7.0]));
            order.sort_unstable();
            assert!(order.into_iter().eq(0..cells.max(1)));
        }
    }
}

/// Samples in four places. Planes go through these places, and have samples on both sides.
#[test]
fn planes_go_through_places_that_many_samples_share() {
    let options = BuildOptions::DEFAULT;
    for (counts, planes) in [
        ([300, 1, 1, 1], &[1.0][..]),
        ([1, 1, 1, 300], &[3.0]),
        ([100, 100, 100, 100], &[2.0]),
        ([100, 100, 100, 100], &[1.0, 2.0]),
        ([100, 100, 100, 100], &[1.0, 2.0, 3.0]),
        ([100, 100, 100, 100], &[]),
    ] {
        let places = (0..4).map(|x| DVec3::X * f64::from(x));
        let samples: Vec<DVec3> =
            places.zip(counts).flat_map(|(place, count)| vec![place; count]).collect();
        let mut extent = Extent::default();
        extent.include(&[DVec3::splat(-1.0), DVec3::splat(4.0)]);
        let partition = options.partition(&extent, samples, planes.len() + 1).unwrap();
        let bounds: Vec<[DVec3; 2]> =
            (0..partition.cells()).map(|cell| partition.bounds(cell)).collect();
        let ends = |k: usize| bounds.iter().map(move |cell| cell[k].x);
        assert!(ends(0).eq([f64::NEG_INFINITY].into_iter().chain(planes.iter().copied())));
        assert!(ends(1).eq(planes.iter().copied().chain([f64::INFINITY])));
        assert!(
            bounds.iter().all(|[low, high]| low.y == f64::NEG_INFINITY && high.z == f64::INFINITY)
        );
    }
}

/// The trees of all cells report the same as one tree, if each polygon counts once.
#[test]
fn preparations_count_each_polygon_once() {
    let mut dice = Dice(17);
    let mut polygons = triangles(&mut dice, 20, 20);
    polygons.extend(stars(&mut dice, 6));
    polygons.push(vec![DVec3::ZERO, DVec3::X, DVec3::X * 2.0]);
    let again: Vec<Corners> = polygons[15..].iter().rev().cloned().collect();
    polygons.extend(again);
    let whole = BspTree::build(&polygons).unwrap();
    for cells in [1, 3, 8] {
        let scene = Divided::new(polygons.clone(), BuildOptions::DEFAULT, cells).unwrap();
        let found = scene.partition.preparation(&polygons).unwrap();
        let counts = |found: &Preparation| {
            let Preparation { polygons, dropped, triangulated, crossing, .. } = *found;
            [polygons, dropped, triangulated, crossing]
        };
        assert_eq!(counts(&found), counts(whole.preparation()), "{cells} cells");
        enough!(found.triangulated > 5, found.dropped > 0; "{found:?}");
        let cell = &scene.cells[cells - 1].tree;
        assert_eq!(cell.dropped().count(), cell.preparation().dropped);
    }
}

/// Extents of shares merge to the extent of the whole, in any order.
#[test]
fn merged_extents_of_shares_are_the_extent_of_the_whole() {
    let polygons = triangles(&mut Dice(31), 30, 9);
    let coarse = [[0.5_f32, 1.0, 2.0], [7.0, 3.0, 1.0], [3.0, 9.0, 0.0]];
    let mut whole = extent(&polygons);
    whole.include(&coarse);
    let mut shares: Vec<Extent> = polygons.chunks(7).map(extent).collect();
    shares.push(Extent::default());
    shares.push(Extent::default());
    shares[5].include(&coarse);
    for turn in 0..shares.len() {
        shares.rotate_left(turn);
        let mut merged = Extent::default();
        shares.iter().for_each(|share| merged.merge(share));
        assert_eq!(merged, whole);
    }
    assert!(whole.precision > 0.0);
}

#[test]
fn an_extent_that_cannot_be_divided_is_an_error() {
    let options = BuildOptions::DEFAULT;
    let polygon = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    let mut all = Extent::default();
    all.include(&polygon);
    let none: [DVec3; 0] = [];
    assert!(options.clone().with_tolerance(-1.0).partition(&all, none, 2).is_err());
    let mut wrong = all;
    wrong.include(&[[0.0, f64::NAN, 0.0]]);
    assert!(wrong.low.y.is_nan() && wrong.high.y.is_nan());
    assert!(options.partition(&wrong, none, 2).is_err());
    // The polygons in any order, and their extents merged or not.
    let mut wrong_too = Extent::default();
    wrong_too.merge(&wrong);
    wrong_too.merge(&all);
    assert!(options.partition(&wrong_too, none, 2).is_err());
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let bad = DVec3::new(0.0, bad, 0.0);
        for [corner, opposite] in [[bad, DVec3::ONE], [DVec3::ONE, bad], [bad; 2]] {
            let room = options.clone().with_bounds(corner, opposite);
            assert!(room.partition(&all, none, 2).is_err(), "{corner} {opposite}");
        }
    }
    let partition = options.partition(&all, none, 4).unwrap();
    let mut reached = Vec::new();
    for bad in [f64::NAN, f64::INFINITY, 1e9] {
        let off = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, bad, 0.0]];
        partition.reached_by(&off, &mut reached);
        assert_eq!(reached, [0, 1, 2, 3]);
        let error = options.build_cell(&partition, 2, [polygon, off]).unwrap_err();
        assert_eq!(error.polygon(), Some(1), "{error}");
    }
    partition.reached_by(&[[0.0; 3]; 0], &mut reached);
    assert!(reached.is_empty());
}

/// A polygon whose corners do not end.
struct Endless;

impl Polygon for Endless {
    type Point = [f64; 3];

    fn corners(&self) -> impl Iterator<Item = [f64; 3]> {
        std::iter::repeat([0.5, 0.5, 0.0])
    }
}

#[test]
fn a_polygon_that_does_not_end_is_an_error_when_a_cell_is_built() {
    let options = BuildOptions::DEFAULT;
    let polygon = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    let mut all = Extent::default();
    all.include(&polygon);
    let without = all;
    all.include(&Endless);
    assert_eq!(all, without);
    let partition = options.partition(&all, polygon, 3).unwrap();
    let mut reached = Vec::new();
    partition.reached_by(&Endless, &mut reached);
    assert_eq!(reached, [0, 1, 2]);
    let error = options.build_cell(&partition, 1, [Endless]).unwrap_err();
    assert_eq!(error.polygon(), Some(0), "{error}");
}

#[test]
fn too_many_cells_are_an_error_and_neither_a_panic_nor_an_abort() {
    let mut extent = Extent::default();
    extent.include(&[DVec3::ZERO, DVec3::ONE]);
    for cells in [Partition::MAX_CELLS + 1, 1 << 40, usize::MAX] {
        let error = BuildOptions::DEFAULT.partition(&extent, [DVec3::ZERO], cells).unwrap_err();
        assert_eq!(error.kind(), ErrorKind::InvalidInput, "{error}");
        assert!(error.to_string().contains("at most 16777216"), "{error}");
    }
}

/// The tree of a cell remains the tree of this cell when polygons are added.
#[test]
fn added_polygons_are_cut_to_the_cell() {
    let options = BuildOptions::DEFAULT;
    let polygons = triangles(&mut Dice(12), 60, 30);
    let scene = Divided::new(polygons.clone(), options.clone(), 5).unwrap();
    let own = |tree: &BspTree| {
        let mut own = fragments(tree, |polygon| polygon);
        own.iter_mut()
            .for_each(|(_, vertices)| vertices.sort_by_key(|v| v.to_array().map(f64::to_bits)));
        own.sort_by_key(|(polygon, vertices)| (*polygon, vertices[0].to_array().map(f64::to_bits)));
        own
    };
    for cell in 0..5 {
        let mut tree = options.build_cell(&scene.partition, cell, &polygons[..40]).unwrap();
        tree.extend(&polygons[40..]).unwrap();
        tree.validate().unwrap();
        let all = options.build_cell(&scene.partition, cell, &polygons).unwrap();
        assert_eq!(own(&tree), own(&all));
        assert_eq!(tree.preparation().dropped, all.preparation().dropped);
    }
}

/// Corners that were moved onto their plane keep their given positions, also if faces before them went to
/// other cells.
#[test]
fn duplicates_in_an_extension_are_found_by_their_given_corners() {
    let bent = |x: u32| -> Corners {
        let x = f64::from(x);
        vec![[x, 0.0, 0.0], [x + 1.0, 0.0, 0.0], [x + 1.0, 1.0, 1e-7], [x, 1.0, 0.0]]
            .into_iter()
            .map(DVec3::from)
            .collect()
    };
    let polygons: Vec<Corners> = (0..20).map(bent).collect();
    let options = BuildOptions::DEFAULT.with_tolerance(1e-6);
    let scene = Divided::new(polygons.clone(), options.clone(), 4).unwrap();
    for cell in 0..4 {
        let mut tree = options.build_cell(&scene.partition, cell, &polygons).unwrap();
        let own = tree.preparation().polygons - tree.preparation().dropped;
        assert!(own >= 4 && tree.preparation().flattened == 20, "{:?}", tree.preparation());
        tree.extend(&polygons).unwrap();
        assert_eq!(tree.duplicates(), own, "cell {cell}");
    }
}

/// Far from the origin, numbers are less precise than a small scene's tolerance, which does not follow
/// bounds.
#[test]
fn the_tolerance_of_bounds_far_out_is_that_of_one_tree() {
    let at = DVec3::splat(5e6);
    // In numbers whose digits are all exact.
    let square = |x: f64| {
        let corners = sheet(0, x, 1.0).map(|corner| at + DVec3::from(corner)).to_vec();
        Claim { corners, precision: 0.0 }
    };
    let squares = [square(0.0), square(0.5)];
    let mut extent = Extent::default();
    squares.iter().for_each(|square| extent.include(square));
    let samples = [at, at + 0.5];
    for options in
        [BuildOptions::DEFAULT, BuildOptions::DEFAULT.with_bounds(at + DVec3::splat(2.0), at)]
    {
        let whole = options.build(&squares).unwrap();
        let partition = options.partition(&extent, samples, 2).unwrap();
        let cell = options.build_cell(&partition, 0, &squares).unwrap();
        let (found, expected) = (cell.faces(), whole.faces());
        assert_eq!((cell.grid(), found.tolerance()), (whole.grid(), expected.tolerance()));
        let length = expected.lattice().length_to_world(expected.tolerance());
        assert_eq!(partition.tolerance(), length);
    }
}

#[test]
fn a_tree_belongs_to_one_cell_of_one_partition() {
    let square = |x: f64| -> Corners { sheet(0, x, 1.0).map(DVec3::from).to_vec() };
    let squares: Vec<Corners> = (0..9).map(|x| square(f64::from(x))).collect();
    let whole = BspTree::build(&squares).unwrap();
    for cells in [1, 2, 5] {
        let scene = Divided::new(squares.clone(), BuildOptions::DEFAULT, cells).unwrap();
        let other = BuildOptions::DEFAULT.with_tolerance(1e-3);
        let other = Divided::new(squares.clone(), other, cells).unwrap();
        for (cell, own) in scene.cells.iter().enumerate() {
            for place in 0..cells {
                assert_eq!(scene.partition.is_tree_of(place, &own.tree), place == cell);
            }
            assert!(!scene.partition.is_tree_of(cell, &whole));
            assert!(!other.partition.is_tree_of(cell, &own.tree));
        }
    }
}

/// The number of a missing cell must not be treated as the last cell.
#[test]
fn a_cell_behind_the_last_is_refused() {
    let square = [[0.0, 0.0], [8.0, 0.0], [8.0, 8.0], [0.0, 8.0]];
    let square: Corners = square.map(|[x, y]| DVec3::new(x, y, 0.0)).to_vec();
    for cells in [1, 2, 5] {
        let scene = Divided::new(vec![square.clone()], BuildOptions::DEFAULT, cells).unwrap();
        let (partition, tree) = (&scene.partition, &scene.cells[cells - 1].tree);
        assert_eq!(partition.cells(), cells);
        for cell in [cells, cells + 1, usize::MAX] {
            let calls: [&dyn Fn(); 3] = [
                &|| {
                    partition.bounds(cell);
                },
                &|| {
                    partition.is_tree_of(cell, tree);
                },
                &|| drop(BuildOptions::DEFAULT.build_cell(partition, cell, [&square])),
            ];
            for call in calls {
                assert!(catch_unwind(AssertUnwindSafe(call)).is_err(), "{cell} of {cells}");
            }
        }
    }
}

/// Two squares in a corner of much larger bounds.
#[test]
fn bounds_of_the_options_are_held_too() {
    let square = |z: f64| -> Corners { sheet(2, z, 1.0).map(DVec3::from).to_vec() };
    let options = BuildOptions::DEFAULT.with_bounds(DVec3::ZERO, DVec3::splat(100.0));
    let scene = Divided::new(vec![square(0.0), square(1.0)], options.clone(), 2).unwrap();
    let whole = options.build(&scene.polygons).unwrap();
    assert_eq!(scene.cells[0].tree.grid(), whole.grid());
    assert!(options.build_cell(&scene.partition, 1, [square(99.0)]).is_ok());
}

/// Meshes, boxes and hits of a cell contain only the parts of polygons in the cell.
#[test]
fn a_cell_is_a_tree_as_any_other() {
    let terrain = scene::terrain(400, 3);
    let polygons = polygons(&terrain);
    let scene = Divided::new(polygons, BuildOptions::DEFAULT, 4).unwrap();
    let whole = BspTree::build(terrain.polygons()).unwrap();
    let (mut area, mut hits) = (0.0, [0; 2]);
    for cell in &scene.cells {
        let mesh = cell.tree.welded_mesh().unwrap();
        let at: Vec<DVec3> = mesh.vertices().map(|vertex| vertex.position).collect();
        for triangle in mesh.triangles().indices().chunks_exact(3) {
            let [a, b, c] = [0, 1, 2].map(|k| at[triangle[k] as usize]);
            area += (b - a).cross(c - a).length();
        }
    }
    let expected: f64 = whole
        .fragments()
        .map(|fragment| {
            let at: Vec<DVec3> = fragment.vertices().collect();
            at.windows(2).map(|w| (w[0] - at[0]).cross(w[1] - at[0])).sum::<DVec3>().length()
        })
        .sum();
    assert!((area - expected).abs() < 1e-9 * expected, "{area} {expected}");
    let mut dice = Dice(8);
    for _ in 0..times(200) {
        let from = DVec3::new(dice.share() * 60.0, dice.share() * 60.0, 90.0);
        let ray = binspace::Ray::new(from, DVec3::new(0.1, 0.05, -1.0));
        let found = whole.hits(ray).count();
        let in_cells: usize = scene.cells.iter().map(|cell| cell.tree.hits(ray).count()).sum();
        assert_eq!(found, in_cells);
        hits[usize::from(found > 0)] += 1;
    }
    enough!(hits[1] > 20; "{hits:?}");
}

/// More polygons or fragments than allowed, also endless polygons, and a cancelled build.
#[test]
fn budgets_and_cancels_count_in_cells() {
    use std::ops::ControlFlow;

    let options = BuildOptions::DEFAULT;
    let polygons = triangles(&mut Dice(21), 200, 30);
    let scene = Divided::new(polygons, options.clone(), 3).unwrap();
    let few = options.clone().with_max_fragments(50);
    let error = few.build_cell(&scene.partition, 1, &scene.polygons).unwrap_err();
    assert!(error.kind() == ErrorKind::OverBudget, "{error}");
    let endless = std::iter::repeat(&scene.polygons[0]);
    let error = few.build_cell(&scene.partition, 1, endless).unwrap_err();
    assert!(error.kind() == ErrorKind::OverBudget, "{error}");
    let mut last = None;
    let built =
        options.build_cell_with_progress(&scene.partition, 1, &scene.polygons, |progress| {
            last = Some(progress);
            ControlFlow::Continue(())
        });
    let last = last.expect("it is called in the end");
    assert!(last.done == last.total && last.total == built.unwrap().face_count());
    let cancelled = options
        .build_cell_with_progress(&scene.partition, 1, &scene.polygons, |_| ControlFlow::Break(()));
    assert!(cancelled.is_err_and(|error| error.kind() == ErrorKind::Cancelled));
}

/// A drawing needs whole polygons.
#[test]
fn a_drawing_of_a_cell_is_an_error() {
    use binspace::drawing::ViewOptions;
    use binspace::view::Camera;

    let scene = Divided::new(triangles(&mut Dice(5), 30, 30), BuildOptions::DEFAULT, 2).unwrap();
    let camera =
        Camera::perspective(DVec3::splat(90.0), DVec3::ZERO, DVec3::Z, 0.7, [20, 20]).unwrap();
    let tree = &scene.cells[0].tree;
    assert!(tree.is_of_cell() && !BspTree::build(&scene.polygons).unwrap().is_of_cell());
    let error = tree.visibility(&camera, &ViewOptions::DEFAULT).unwrap_err();
    assert!(error.to_string().contains("belongs to one cell"), "{error}");
}

/// Whether a point is inside a body is refused in the tree of a cell, also if the whole body lies in the cell.
#[test]
fn winding_numbers_are_refused_in_cells() {
    let corner = |k: usize| DVec3::from([0, 1, 2].map(|axis| f64::from(k as u32 >> axis & 1)));
    let sides =
        [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let cube: Vec<Corners> = sides.iter().map(|side| side.map(corner).to_vec()).collect();
    let inside = [0.5, 0.4, 0.3];
    assert_eq!(BspTree::build(&cube).unwrap().winding_number(inside).unwrap(), Some(1));
    let scene = Divided::new(cube, BuildOptions::DEFAULT, 1).unwrap();
    let error = scene.cells[0].tree.winding_number(inside).unwrap_err();
    assert_eq!(error.kind(), ErrorKind::Unsupported);
}
