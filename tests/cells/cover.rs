//! Checks that each point of each polygon is in one cell, by the areas and edges of all cells together, in
//! rationals.

use crate::cells::polygons::{stars, tiles, triangles};
use testkit::cell_cover::check;
use testkit::divided::Divided;
use testkit::judge::{Verdict, ensure};
use testkit::prelude::*;
use testkit::shapes::sheet;

fn checked(polygons: Vec<Corners>, options: BuildOptions, cells: usize) -> usize {
    let scene = Divided::new(polygons, options.clone(), cells).unwrap();
    check(&scene, options).unwrap_or_else(|what| panic!("{cells} cells: {what}"))
}

#[test]
fn every_polygon_is_in_all_cells_together_once() {
    let mut cut = 0;
    for cells in 1..10 {
        let mut dice = Dice(100 + cells as u64);
        for polygons in [triangles(&mut dice, 30, 20), tiles(&mut dice, 60), stars(&mut dice, 8)] {
            for options in [BuildOptions::DEFAULT, BuildOptions::DEFAULT.with_tolerance(0.0)] {
                cut += checked(polygons.clone(), options, cells);
            }
        }
    }
    enough!(cut > 500; "{cut}");
}

#[test]
fn every_hard_polygon_is_in_all_cells_together_once() {
    let cases = (hard::scene(), 1..10_usize);
    let cut = tally(file!(), 150, cases, |cut: &mut usize, (scene, cells)| {
        let options = scene.options(Heuristic::default());
        let divided = Divided::new(scene.polygons, options.clone(), cells).expect("a tree of each");
        *cut += check(&divided, options).map_err(fail)?;
        Ok(())
    });
    enough!(cut > 100; "{cut}");
}

/// Polygons in the plane between two cells, or within the tolerance of this plane, belong to the cell on the
/// side of larger coordinates.
#[test]
fn polygons_in_a_plane_between_cells_are_in_the_front_cell() {
    let square = |x: f64| -> Corners { sheet(0, x, 1.0).map(DVec3::from).to_vec() };
    let xs = [0.0, 2.0 - 1e-7, 2.0, 2.0 + 1e-7, 2.0 - 1e-5, 4.0];
    let polygons: Vec<Corners> = xs.map(square).into();
    // The middle of three samples.
    let samples = vec![DVec3::ZERO, DVec3::new(2.0, 0.5, 0.5), DVec3::new(4.0, 0.0, 0.0)];
    let options = BuildOptions::DEFAULT.with_tolerance(1e-6);
    let scene = Divided::with_samples(polygons, options, samples, 2).unwrap();
    assert_eq!(scene.partition.bounds(1)[0].x, 2.0);
    let of = |cell: usize| {
        let cell = &scene.cells[cell];
        let mut numbers: Vec<usize> =
            (0..cell.tree.len() as u32).map(|f| cell.polygon(f)).collect();
        numbers.sort_unstable();
        numbers
    };
    assert_eq!([of(0), of(1)], [vec![0, 4], vec![1, 2, 3, 5]]);
}

/// All polygons in one cell of many, and an empty scene.
#[test]
fn cells_may_be_empty() -> Verdict {
    let mut dice = Dice(4);
    let polygons = triangles(&mut dice, 20, 10);
    let far =
        |p: f64| vec![DVec3::splat(p), DVec3::splat(p) + DVec3::X, DVec3::splat(p) + DVec3::Y];
    // Most of the scene is in one place, and the samples are in another place.
    let away = |p: Corners| p.into_iter().map(|corner| corner - 3e5).collect();
    let all: Vec<Corners> = polygons.into_iter().map(away).chain([far(1e6), far(-1e6)]).collect();
    let samples = vec![DVec3::splat(1e6); 50];
    let scene = Divided::with_samples(all, BuildOptions::DEFAULT, samples, 7).unwrap();
    let full = scene.cells.iter().filter(|cell| !cell.tree.is_empty()).count();
    ensure(full < 7, || format!("{full} full cells"))?;
    check(&scene, BuildOptions::DEFAULT)?;
    let nothing = Divided::new(vec![], BuildOptions::DEFAULT, 3).unwrap();
    ensure(nothing.fragments() == 0, || "something of nothing".into())
}
