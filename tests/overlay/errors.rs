//! The errors of an overlay, and its contents after them.

use binspace::ErrorKind;
use binspace::overlay::{Overlay, Shapes};
use testkit::prelude::*;

fn triangle(at: DVec3) -> [DVec3; 3] {
    [at, at + DVec3::X, at + DVec3::Y]
}

#[test]
fn polygons_beyond_the_grid_are_named() {
    let scene = scene::city(100, 1);
    let tree = BspTree::build(scene.polygons()).expect("within budget");
    let (low, high) = scene.bounds().expect("corners");
    let inside = triangle((low + high) * 0.5);
    let mut overlay = Overlay::new(&tree);
    let extent = (high - low).max_element();
    for far in [3.0 * extent, -5.0 * extent, 1e300, -1e308] {
        overlay.replace(&tree, [inside]).expect("on the grid");
        let outside = triangle(DVec3::new(0.0, far, 1.0));
        let error = overlay.replace(&tree, [inside, outside]).expect_err("beyond the grid");
        assert_eq!(error.polygon(), Some(1), "{error}");
        assert!(error.to_string().contains("with_bounds"), "{error}");
        check_empty(&overlay, &tree);
    }
    // The remedy in the message.
    let far = low - (high - low) * 5.0;
    let roomy =
        BuildOptions::DEFAULT.with_bounds(far, high).build(scene.polygons()).expect("built");
    assert!(roomy.len() >= tree.len());
    assert_eq!(roomy.preparation().polygons, tree.preparation().polygons);
    let mut overlay = Overlay::new(&roomy);
    overlay.replace(&roomy, [inside, triangle(far)]).expect("on the larger grid");
    assert!(overlay.len() >= 2);
}

fn check_empty(overlay: &Overlay, tree: &BspTree) {
    assert!(overlay.is_empty() && overlay.piece(tree.len() as u32).is_none());
    let (mut order, mut still) = (Vec::new(), Vec::new());
    let eye = Viewpoint::eye([1.0, 2.0, 3.0]);
    overlay.order(tree, eye).expect("its own tree").write_into(&mut order);
    tree.back_to_front_into(eye, &mut still);
    assert_eq!(order, still);
    assert_eq!(overlay.faces().len(), tree.faces().len());
}

#[test]
fn polygons_that_a_tree_refuses_are_refused() {
    let tree = BspTree::build(scene::city(100, 1).polygons()).expect("within budget");
    let mut overlay = Overlay::new(&tree);
    let inside = triangle(DVec3::ONE);
    for bad in [f64::NAN, f64::INFINITY] {
        overlay.replace(&tree, [inside]).expect("on the grid");
        let error = overlay.replace(&tree, [inside, inside, [DVec3::splat(bad); 3]]);
        assert_eq!(error.expect_err("not finite").polygon(), Some(2));
        check_empty(&overlay, &tree);
    }
    overlay.replace(&tree, [inside, [DVec3::ONE; 3], inside]).expect("one has no area");
    assert_eq!(overlay.preparation().dropped, 1);
    let tree_polygons = tree.preparation().polygons;
    let piece = overlay.piece(tree.len() as u32).expect("a piece");
    assert!(piece.polygon() == tree_polygons || piece.polygon() == tree_polygons + 2);
}

#[test]
fn bounds_must_be_finite() {
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let options = BuildOptions::DEFAULT.with_bounds(DVec3::ZERO, DVec3::new(1.0, bad, 1.0));
        let error = options.build([triangle(DVec3::ZERO)]).expect_err("no box");
        assert!(error.to_string().contains("with_bounds"), "{error}");
    }
}

/// Trees of other sizes, and trees with equal counts that differ only in the grid or only in the tolerance.
#[test]
fn another_tree_is_refused() {
    let scene = scene::city(100, 1);
    let scaled = |by: f64| {
        let polygons =
            scene.polygons().map(|p| p.points().iter().map(|&c| c * by).collect::<Vec<_>>());
        BspTree::build(polygons).expect("within budget")
    };
    // In a tree twice as large, the grid is as fine for its size, and the tolerance has the same number of
    // steps.
    let (tree, twice, thrice) = (scaled(1.0), scaled(2.0), scaled(3.0));
    assert_eq!(tree.faces().tolerance(), twice.faces().tolerance());
    let tolerance = scene.bounds().map(|(low, high)| (high - low).max_element() * 2e-9);
    let options = BuildOptions::DEFAULT.with_tolerance(tolerance.expect("corners"));
    let coarse = options.build(scene.polygons()).expect("within budget");
    assert_eq!(tree.faces().lattice(), coarse.faces().lattice());
    let counts = |tree: &BspTree| (tree.len(), tree.nodes().len(), tree.faces().corner_count());
    for same in [&twice, &coarse] {
        assert_eq!(counts(&tree), counts(same), "they would be refused anyway");
    }
    let larger = BspTree::build(scene::city(150, 1).polygons()).expect("within budget");
    let mut overlay = Overlay::new(&tree);
    let eye = Viewpoint::eye([1.0, 2.0, 3.0]);
    for other in [&larger, &twice, &thrice, &coarse] {
        overlay.replace(&tree, [triangle(DVec3::ONE)]).expect("on the grid");
        assert!(overlay.order(other, eye).is_err());
        let error = overlay.replace(other, [triangle(DVec3::ONE)]).expect_err("another tree");
        assert!(error.to_string().contains("overlay"), "{error}");
        check_empty(&overlay, &tree);
    }
    overlay.replace(&tree.clone(), [triangle(DVec3::ONE)]).expect("a copy is the same");
}

#[test]
fn faulty_lines_and_points_are_named() {
    let tree = BspTree::build(scene::city(100, 1).polygons()).expect("within budget");
    let mut overlay = Overlay::new(&tree);
    let inside = triangle(DVec3::ONE);
    for (bad, says) in [(f64::NAN, "NaN"), (f64::INFINITY, "infinite"), (1e9, "with_bounds")] {
        let bad = DVec3::new(1.0, bad, 1.0);
        let shapes = Shapes::NONE.with_polygons([inside]).with_lines([inside]);
        overlay.replace_with(&tree, shapes.with_points(inside)).expect("on the grid");
        let lines = [vec![DVec3::ONE], vec![DVec3::ONE, bad]];
        let error = overlay.replace_with(&tree, shapes.with_lines(lines)).expect_err("a bad line");
        assert_eq!((error.polygon(), error.line(), error.point()), (None, Some(1), None));
        assert!(error.to_string().starts_with("line 1") && error.to_string().contains(says));
        check_empty(&overlay, &tree);
        let points = [DVec3::ONE, DVec3::ONE, bad];
        let error = overlay.replace_with(&tree, shapes.with_points(points)).expect_err("a point");
        assert_eq!((error.polygon(), error.line(), error.point()), (None, None, Some(2)));
        assert!(error.to_string().starts_with("point 2") && error.to_string().contains(says));
        check_empty(&overlay, &tree);
    }
}

#[test]
fn a_replacement_reports_progress_and_can_be_cancelled() {
    let scene = scene::random_triangles(800, 1);
    let tree = BspTree::build(scene.polygons()).expect("within budget");
    let mut overlay = Overlay::new(&tree);
    let lines = scene.polygons().map(|p| p.corners().collect::<Vec<_>>());
    let points = scene.polygons().flat_map(|p| p.corners().collect::<Vec<_>>());
    let shapes = Shapes::NONE.with_polygons(scene.polygons());
    let shapes = shapes.with_lines(lines).with_points(points);
    let mut heard = Vec::new();
    let replaced = overlay.replace_with_progress(&tree, shapes.clone(), |progress| {
        heard.push(progress);
        ControlFlow::Continue(())
    });
    replaced.expect("on the grid");
    let (whole, last) = (overlay.len(), heard[heard.len() - 1]);
    assert_eq!((last.done, last.total), (800 + 1600 + 2400, last.done));
    let placed = heard.iter().filter(|p| p.total == last.total && p.done > 0 && p.done < p.total);
    enough!(placed.count() > 0; "{heard:?}");
    for stop in [0, heard.len() / 2, heard.len() - 2] {
        let mut calls = 0;
        let cancelled = overlay.replace_with_progress(&tree, shapes.clone(), |_| {
            calls += 1;
            if calls > stop { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        });
        assert!(cancelled.is_err_and(|error| error.kind() == ErrorKind::Cancelled), "{stop}");
        assert_eq!(calls, stop + 1);
        check_empty(&overlay, &tree);
    }
    overlay.replace_with(&tree, shapes).expect("on the grid");
    assert_eq!(overlay.len(), whole);
}

/// The caller's callback or iterator panics at any step of the overlay.
#[test]
fn after_a_panic_in_a_callback_an_overlay_is_empty_and_goes_on() {
    let scene = scene::random_triangles(60, 3);
    let room = BuildOptions::DEFAULT.with_bounds(DVec3::splat(-1e3), DVec3::splat(1e3));
    let tree = room.build(scene.polygons()).expect("within budget");
    let moving: Vec<Vec<DVec3>> = scene::random_triangles(1400, 4)
        .polygons()
        .map(|polygon| polygon.points().to_vec())
        .collect();
    let lines: Vec<Vec<DVec3>> = moving[..40].to_vec();
    let points: Vec<DVec3> = lines.iter().map(|line| line[0]).collect();
    let shapes = || {
        Shapes::NONE.with_polygons(&moving).with_lines(&lines).with_points(points.iter().copied())
    };
    let eye = Viewpoint::eye([9.0, 2.0, 30.0]);
    let (mut whole, mut expected) = (Overlay::new(&tree), Vec::new());
    let mut calls = 0;
    whole
        .replace_with_progress(&tree, shapes(), |_| {
            calls += 1;
            ControlFlow::Continue(())
        })
        .expect("on the grid");
    whole.order(&tree, eye).expect("its own tree").write_into(&mut expected);
    enough!(calls > 4; "{calls}");
    let mut overlay = Overlay::new(&tree);
    let mut panics = 0;
    for at in (0..calls).filter(|at| *at < 6 || at % (calls / 6 + 1) == 0) {
        let mut left = at;
        let replace = || {
            overlay.replace_with_progress(&tree, shapes(), |_| {
                assert!(left > 0, "the caller's fault");
                left -= 1;
                ControlFlow::Continue(())
            })
        };
        let caught = std::panic::catch_unwind(std::panic::AssertUnwindSafe(replace));
        panics += usize::from(caught.is_err());
        check_empty(&overlay, &tree);
        overlay.replace_with(&tree, shapes()).expect("as if nothing had happened");
        let mut order = Vec::new();
        overlay.order(&tree, eye).expect("its own tree").write_into(&mut order);
        assert_eq!(order, expected, "call {at}");
    }
    enough!(panics > 4; "{panics}");
    let bad = (0..9).map(|k| {
        assert!(k < 7, "the caller's fault");
        triangle(DVec3::splat(f64::from(k)))
    });
    let replace = || overlay.replace(&tree, bad);
    assert!(std::panic::catch_unwind(std::panic::AssertUnwindSafe(replace)).is_err());
    check_empty(&overlay, &tree);
}
