//! Tests the combinations in the table of the crate page.

use binspace::overlay::{Overlay, Shapes};
use binspace::partition::Extent;
use binspace::{Culling, ErrorKind, Facing, Ray};
use testkit::prelude::*;
use testkit::shapes::rectangle;

const ABOVE: Viewpoint = Viewpoint::Eye(DVec3::new(1.5, 0.7, 9.0));

fn camera() -> Camera {
    let eye = DVec3::new(1.5, 0.7, 9.0);
    Camera::perspective(eye, DVec3::new(1.0, 1.0, 0.0), DVec3::Y, 0.8, [40, 30]).expect("a camera")
}

fn squares() -> Vec<Vec<DVec3>> {
    (0..6).map(|k| rectangle([0.0, 0.25 * f64::from(k)], [2.0, 3.0], f64::from(k % 3))).collect()
}

/// Uses a tree in every way. Returns the kind of the error of a drawing.
fn use_all(tree: &BspTree) -> Option<ErrorKind> {
    let culling = Culling::NONE.with_facing(Facing::Front);
    let mut order = Vec::new();
    tree.order(ABOVE).culled(&culling).write_into(&mut order);
    assert_eq!(order.len(), tree.len());
    let down = Ray::new([1.0, 1.6, 8.0], [0.0, 0.0, -1.0]);
    // The ray goes through all squares; a cell has some of them.
    let hits = tree.hits(down).count();
    assert!(hits == 6 || tree.is_of_cell() && hits < 6, "{hits}");
    assert_eq!(tree.is_occluded(down), hits > 0);
    assert!(tree.welded_mesh().expect("small").vertices().count() > 3);
    assert_eq!(tree.arrays().expect("small").polygons.len(), tree.len());
    let mut bytes = Vec::new();
    tree.write(&mut bytes).expect("memory");
    assert_eq!(BspTree::read(&bytes[..]).expect("a tree").len(), tree.len());
    let drawing = tree.visibility(&camera(), &ViewOptions::DEFAULT).and_then(|map| map.drawing());
    drawing.err().map(|error| error.kind())
}

#[test]
fn trees_frames_and_cells() {
    assert_eq!(use_all(&BspTree::build(squares()).expect("a tree")), None);
    let mut builder = FrameBuilder::new(BuildOptions::DEFAULT);
    assert_eq!(use_all(builder.build(squares()).expect("a tree")), None);
    let all = squares();
    let (options, mut extent) = (BuildOptions::DEFAULT, Extent::default());
    all.iter().for_each(|square| extent.include(square));
    let corners = all.iter().flatten().copied();
    let partition = options.partition(&extent, corners, 2).expect("corners");
    let cells = (0..partition.cells()).map(|cell| options.build_cell(&partition, cell, &all));
    let cells: Vec<BspTree> = cells.map(|tree| tree.expect("a tree")).collect();
    let cells = cells.iter().filter(|tree| !tree.is_empty());
    assert!(cells.clone().count() > 0);
    cells.for_each(|tree| assert_eq!(use_all(tree), Some(ErrorKind::Unsupported)));
}

/// Drawings refuse polygons of an overlay, and regions ignore them.
#[test]
fn trees_and_overlays() {
    let tree = BspTree::build(squares()).expect("a tree");
    let mut overlay = Overlay::new(&tree);
    let shapes = Shapes::NONE
        .with_polygons([rectangle([0.5, 0.5], [1.5, 2.5], 1.5)])
        .with_lines([[DVec3::new(0.0, 1.0, 1.7), DVec3::new(2.0, 1.0, 1.7)]]);
    overlay.replace_with(&tree, shapes).expect("in the grid");
    let culling = Culling::NONE.with_facing(Facing::Front);
    let order = overlay.order(&tree, ABOVE).expect("its tree").culled(&culling);
    assert!(order.into_iter().count() > tree.len());
    let down = Ray::new([1.0, 1.6, 8.0], [0.0, 0.0, -1.0]);
    assert_eq!(overlay.hits(&tree, down).expect("its tree").count(), 6 + 1);
    let around_it = Ray::between([1.0, 1.6, 1.7], [1.0, 1.6, 1.3]);
    assert!(overlay.is_occluded(&tree, around_it).expect("its tree"));
    assert!(!tree.is_occluded(around_it));
    let mesh = overlay.welded_mesh().expect("small");
    assert!(mesh.vertices().all(|vertex| vertex.polygon == 6) && !mesh.is_empty());
    let map = tree.visibility(&camera(), &ViewOptions::DEFAULT).expect("memory");
    assert_eq!(map.lines(&overlay, Hidden::Keep).unwrap_err().kind(), ErrorKind::Unsupported);
    overlay
        .replace_with(&tree, Shapes::NONE.with_lines([[DVec3::ZERO, DVec3::ONE]]))
        .expect("in the grid");
    assert!(!map.lines(&overlay, Hidden::Keep).expect("lines alone").is_empty());
}
