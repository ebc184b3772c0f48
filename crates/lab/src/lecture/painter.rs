//! The painter's algorithm: views that a sort by depth does not solve, and the true order.

use binspace::BspTree;
use binspace::glam::DVec3;
use binspace::scene::{Builtin, Scene, newell_bars};
use binspace_evidence::method::{Centroid, Newell};
use binspace_evidence::{Family, Hiding, overlaps_in_depth};

use super::chapter::Chapter;
use super::shot::{SIZE, Shot};
use binspace_cli::failure::Failure;

pub(super) fn fill(chapter: &mut Chapter) -> Result<(), Failure> {
    chapter.text(
        "Paint what is far first, and what is near over it: then no pixel has to know what is hidden. The \
         question is what \"far\" means for a whole polygon. Most programs sort by one depth, that of the \
         centroid. That is right as long as polygons do not overlap in depth, and a matter of luck where they \
         do.",
    );
    let city = Builtin::City.build(Some(600), 1);
    let bars = newell_bars();
    let towards = DVec3::new(1.0, 1.1, 0.9);
    let crowd = Family::Penetration.scene(14.0, 1);
    chapter.pictures([
        Shot::around(&city, DVec3::new(0.6, -1.0, 0.4))?.by(&Centroid, "A city by centroids")?,
        Shot::around(&bars, towards)?.by(&Centroid, "Three bars by centroids")?,
        Shot::around(&bars, towards)?.by(&Newell::DEFAULT, "Three bars, cut where needed")?,
        Shot::around(&crowd, towards)?.by(&Centroid, "Triangles through each other")?,
    ]);
    partial_order(chapter)
}

fn partial_order(chapter: &mut Chapter) -> Result<(), Failure> {
    chapter.heading("Who hides whom");
    chapter.text(
        "A polygon has to be painted after all that it hides parts of: that some ray from the eye meets it \
         first and then the other. For each eye this is a relation between pairs, and any order that keeps to \
         it gives the right picture; that of the sort by depth is only one try. Two polygons whose extents in \
         depth overlap are ambiguous for the sort, though few of them hide one another at all. Where the \
         relation runs in a cycle, as in the three bars, or where two polygons go through each other, no order \
         of whole polygons is right, and one of them has to be cut.",
    );
    chapter.text(
        "The table decides every pair in exact arithmetic: the one polygon is clipped to the cone of rays \
         through the other, and what is left is compared with the other's plane. \"At least to cut\" is the \
         smallest number of polygons with which all cycles are broken, by trying all subsets; finding it is \
         expensive, so Newell's algorithm and the tree cut more. The tree's cuts hold for all eyes at once.",
    );
    let few = Family::Penetration.scene(8.0, 1);
    let crowd = Family::Penetration.scene(14.0, 1);
    let city = Builtin::City.build(Some(60), 1);
    let random = Builtin::Random.build(Some(120), 1);
    let cycle = Family::Cycle.scene(5.0, 1);
    let from_front = Family::Cycle.cameras(5.0, 1, SIZE).map(|mut cameras| cameras.remove(0));
    let towards = DVec3::new(1.0, 1.1, 0.9);
    let rows = [
        row("city of 60", &city, &Shot::around(&city, towards)?)?,
        row("random triangles, 120", &random, &Shot::around(&random, towards)?)?,
        row("five bars in a cycle", &cycle, &Shot::new(&cycle, from_front)?)?,
        row(
            "three bars of six faces each",
            &newell_bars(),
            &Shot::around(&newell_bars(), towards)?,
        )?,
        row("triangles through each other, 8", &few, &Shot::around(&few, towards)?)?,
        row("triangles through each other, 14", &crowd, &Shot::around(&crowd, towards)?)?,
    ];
    let head = [
        "scene",
        "pairs",
        "overlap in depth",
        "one hides another",
        "go through each other",
        "on cycles",
        "at least to cut",
        "cuts by Newell",
        "cuts by the tree",
    ];
    chapter.table(head, rows);
    Ok(())
}

fn row(name: &str, scene: &Scene, shot: &Shot<'_>) -> Result<[String; 9], Failure> {
    let (faces, camera) = (&shot.faces, &shot.camera);
    let hiding = Hiding::of(faces, camera.viewpoint());
    let newell = Newell::DEFAULT.decisions(faces, camera);
    let newell = newell.map_err(|error| Failure::about(name, error))?;
    let tree = BspTree::build(scene.polygons()).map_err(|error| Failure::about(name, error))?;
    let on_cycles: usize = hiding.cycles().iter().map(Vec::len).sum();
    let count = |number: usize| number.to_string();
    Ok([
        name.to_owned(),
        count(faces.len() * (faces.len() - 1) / 2),
        count(overlaps_in_depth(faces, camera.forward())),
        count(hiding.pairs()),
        count(hiding.mutual()),
        count(on_cycles),
        hiding.fewest_cut().map_or_else(|| "not searched".to_owned(), count),
        newell.cuts.to_string(),
        count(tree.len() - tree.face_count()),
    ])
}
