//! Checks that the orders of cells, one after the other, are an order of the scene. Rays decide, in big
//! integers.

use binspace::Viewpoint;
use binspace::glam::DVec3;

use super::dice::Dice;
use super::divided::{Cell, Divided};
use super::judge::{Verdict, ensure, judge_cell};
use super::rays::{Hit, Ray, Rays};
use super::views::some_view;

/// The counts of comparisons.
#[derive(Debug, Default)]
pub struct Score {
    pub scenes: usize,
    pub empty_cells: usize,
    pub pairs: usize,
    /// The number of these pairs that are in different cells.
    pub apart: usize,
    pub coplanar: usize,
    pub excused: usize,
}

/// A hit in a cell, and its place in the order of all cells.
struct Found<'c> {
    cell: &'c Cell,
    number: usize,
    hit: Hit,
    place: usize,
}

/// Judges a divided scene from some views.
pub fn judge(scene: &Divided, seed: u64, views: usize, score: &mut Score) -> Verdict {
    score.scenes += 1;
    for cell in &scene.cells {
        let polygons = cell.given.iter().map(|&number| scene.polygons[number].clone());
        judge_cell(&cell.tree, &polygons.collect::<Vec<_>>())?;
        score.empty_cells += usize::from(cell.tree.is_empty());
    }
    let mut dice = Dice(seed);
    let mut rays: Vec<Rays<'_>> = scene.cells.iter().map(|cell| Rays::new(&cell.tree)).collect();
    let full: Vec<usize> =
        (0..rays.len()).filter(|&cell| !scene.cells[cell].tree.is_empty()).collect();
    if full.is_empty() {
        return Ok(());
    }
    for _ in 0..views {
        let some = full[dice.below(full.len())];
        let view = some_view(scene.cells[some].tree.faces(), &rays[some], &mut dice);
        let places = places(scene, view.viewpoint)?;
        for _ in 0..12 {
            let target = rays[full[dice.below(full.len())]].some_point(&mut dice);
            let Some(ray) = Ray::through(target, &view) else { continue };
            shoot(scene, &mut rays, &ray, &places, score)
                .map_err(|what| format!("{what}, {view:?}"))?;
        }
    }
    Ok(())
}

/// Returns the place of each fragment of each cell in the order of all cells.
pub fn places(scene: &Divided, viewpoint: Viewpoint) -> Result<Vec<Vec<usize>>, String> {
    let mut places: Vec<Vec<usize>> =
        scene.cells.iter().map(|cell| vec![usize::MAX; cell.tree.len()]).collect();
    let cells = scene.partition.back_to_front(viewpoint);
    let mut reverse = scene.partition.front_to_back(viewpoint);
    reverse.reverse();
    ensure(cells == reverse, || "front to back is no reverse".into())?;
    let mut next = 0;
    for cell in cells {
        for fragment in scene.cells[cell].tree.back_to_front(viewpoint) {
            places[cell][fragment.index() as usize] = next;
            next += 1;
        }
    }
    ensure(next == scene.fragments(), || "a cell is missing".into())?;
    Ok(places)
}

pub fn shoot(
    scene: &Divided,
    rays: &mut [Rays<'_>],
    ray: &Ray,
    places: &[Vec<usize>],
    score: &mut Score,
) -> Verdict {
    let mut all: Vec<Found<'_>> = Vec::new();
    for (number, cell) in scene.cells.iter().enumerate() {
        let place = |hit: &Hit| places[number][hit.fragment as usize];
        all.extend(rays[number].hits(ray).into_iter().map(|hit| {
            let place = place(&hit);
            Found { cell, number, hit, place }
        }));
    }
    all.sort_by_key(|found| found.place);
    for (i, a) in all.iter().enumerate() {
        for b in &all[i + 1..] {
            score.pairs += 1;
            score.apart += usize::from(a.number != b.number);
            let depth = a.hit.depth_order(&b.hit);
            if depth.is_gt() {
                continue;
            }
            if a.number == b.number {
                score.coplanar += usize::from(depth.is_eq());
                rays[a.number].compare(ray, &a.hit, &b.hit, &places[a.number])?;
            } else {
                let wrong = || {
                    let [p, q] = [a, b].map(|found| found.cell.polygon(found.hit.fragment));
                    format!("polygon {p} in cell {} hides {q} in {}", a.number, b.number)
                };
                ensure(is_excused(ray, [a, b]), wrong)?;
                score.excused += 1;
            }
        }
    }
    Ok(())
}

/// Whether both hits, or the nearer hit and the eye, are within the tolerance of a plane between their cells.
fn is_excused(ray: &Ray, hits: [&Found<'_>; 2]) -> bool {
    let tolerance = hits[0].cell.tree.faces().tolerance();
    if tolerance == 0.0 {
        return false;
    }
    // Places are rounded.
    let reach = tolerance * 1.001 + 8.0;
    let side = |found: &Found<'_>, end: u32| DVec3::from(found.cell.tree.faces().corner(end));
    let [(a, eye), (b, _)] = [0, 1].map(|k| ray.places(&hits[k].hit));
    (0..3).any(|axis| {
        let walls = [[0, 1], [1, 0]]
            .map(|[low, high]| [side(hits[low], 1)[axis], side(hits[high], 0)[axis]]);
        walls.into_iter().filter(|[low, high]| low <= high).flatten().any(|wall| {
            let near = |point: DVec3| (point[axis] - wall).abs() <= reach;
            // The second hit comes later in the order, and is further away.
            near(a) && (near(b) || eye.is_some_and(near))
        })
    })
}
