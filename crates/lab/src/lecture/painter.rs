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
        "Paint far polygons first, and near polygons over them. Then a pixel needs to store nothing \
         but its colour. But how far is a whole polygon? Most programs use one depth, the depth of the \
         centroid. This order is right if no polygons overlap in depth. If some polygons overlap, this \
         order is right only by chance.",
    );
    let city = Builtin::City.build(Some(600), 1);
    let bars = newell_bars();
    let towards = DVec3::new(1.0, 1.1, 0.9);
    let crowd = Family::Penetration.scene(14.0, 1);
    chapter.pictures([
        Shot::around(&city, DVec3::new(0.6, -1.0, 0.4))?.by(&Centroid, "A city by centroids")?,
        Shot::around(&bars, towards)?.by(&Centroid, "Three bars by centroids")?,
        Shot::around(&bars, towards)?.by(&Newell::DEFAULT, "Three bars by Newell's algorithm")?,
        Shot::around(&crowd, towards)?.by(&Centroid, "Penetrating triangles by centroids")?,
    ]);
    partial_order(chapter)
}

fn partial_order(chapter: &mut Chapter) -> Result<(), Failure> {
    chapter.heading("Who hides whom");
    chapter.text(
        "A polygon P hides a polygon Q if some ray from the eye meets P first and Q later. Then P must \
         be painted after Q. For each eye this is a relation between pairs of polygons. Every order that \
         respects the relation gives the right picture; a sort by depth is one attempt to find such an \
         order. The sort cannot decide a pair whose extents in depth overlap, although few of these \
         pairs hide each other at all. If the relation contains a cycle, as it does for the three bars, \
         no order of whole polygons is right. The same is true if two polygons penetrate each other. \
         Then one of the polygons must be split.",
    );
    chapter.text(
        "The table decides every pair in exact arithmetic. For each pair, one polygon is clipped to \
         the cone of rays from the eye through the other polygon. The clipped part is then compared \
         with the plane of the other polygon. \"Fewest to split\" is the smallest number of polygons \
         whose removal breaks all cycles. This number is found by trying all subsets, which is \
         expensive. Newell's algorithm and the tree therefore split more polygons. The splits of the \
         tree serve all eyes.",
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
        row("penetrating triangles, 8", &few, &Shot::around(&few, towards)?)?,
        row("penetrating triangles, 14", &crowd, &Shot::around(&crowd, towards)?)?,
    ];
    let head = [
        "scene",
        "pairs",
        "overlap in depth",
        "one hides another",
        "penetrate each other",
        "on cycles",
        "fewest to split",
        "splits by Newell",
        "splits by the tree",
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
