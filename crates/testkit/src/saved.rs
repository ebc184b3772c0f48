//! Trees as bytes, and functions that use a tree in every way.

use super::judge::{Verdict, ensure};
use super::{orders, snapshot::Snapshot};
use binspace::drawing::{Hidden, ViewOptions};
use binspace::glam::{DVec3, dvec3};
use binspace::mesh::Mesh;
use binspace::overlay::{Overlay, Shape, Shapes};
use binspace::verify::{verify, verify_fronts};
use binspace::{
    BspTree, BuildOptions, Culling, Facing, Flow, Frustum, Node, Part, Ray, Viewpoint, view,
};

/// Returns a tree's file.
pub fn bytes(tree: &BspTree) -> Vec<u8> {
    let mut bytes = Vec::new();
    tree.write(&mut bytes).expect("a list takes all");
    bytes
}

/// Returns the CRC-32 of gzip and PNG, bit by bit.
pub fn checksum(bytes: &[u8]) -> u32 {
    let step = |rest: u32| if rest & 1 == 1 { rest >> 1 ^ 0xedb8_8320 } else { rest >> 1 };
    let next = |rest: u32, &byte: &u8| (0..8).fold(rest ^ u32::from(byte), |rest, _| step(rest));
    !bytes.iter().fold(!0, next)
}

/// Replaces the last four bytes by the checksum of all bytes before them.
pub fn seal(bytes: &mut [u8]) {
    if let Some(body) = bytes.len().checked_sub(4) {
        let sum = checksum(&bytes[..body]);
        bytes[body..].copy_from_slice(&sum.to_le_bytes());
    }
}

const EYES: [Viewpoint; 4] = [
    Viewpoint::Eye(dvec3(3.0, -1.0, 2.0)),
    Viewpoint::Eye(dvec3(0.1, 0.2, -0.05)),
    Viewpoint::Direction(dvec3(0.3, -1.0, 0.2)),
    Viewpoint::Direction(DVec3::Z),
];

/// Calls every method of a tree, which may come from a forged file: its faces and planes may be arbitrary,
/// but the tree is valid.
pub fn use_all(tree: &BspTree) -> Verdict {
    tree.validate()?;
    // These results are not compared, but must not panic.
    let _ = (tree.stats(), tree.memory_usage(), format!("{tree:?}"));
    ensure(tree.dropped().count() == tree.preparation().dropped, || "dropped".into())?;
    for viewpoint in EYES {
        orders::check(tree, viewpoint)?;
        tree.same_order(viewpoint, EYES[0]);
    }
    use_fragments(tree)?;
    // Rounded normals are left out, because a forged plane may have none.
    let places = |node: Node<'_>| (node.index(), node.depth(), node.on(), node.fragments());
    let nodes: Vec<_> = tree.nodes().map(places).collect();
    let mut backwards: Vec<_> = tree.nodes().rev().map(places).collect();
    backwards.reverse();
    ensure(nodes == backwards, || "nodes".into())?;
    for node in tree.nodes() {
        let _ = (node.normal(), node.offset(), node.polygon(), node.front(), node.back());
    }
    use_walks(tree)?;
    use_queries(tree)?;
    use_overlay(tree);
    use_extend(tree);
    for mesh in [tree.mesh(), tree.welded_mesh()] {
        use_mesh(tree, &mesh.map_err(|error| error.to_string())?)?;
    }
    use_pictures(tree);
    let (again, written) = (tree.clone(), bytes(tree));
    ensure(bytes(&again) == written, || "a copy is another tree".into())?;
    let again = BspTree::read(&written[..]).map_err(|error| error.to_string())?;
    ensure(Snapshot::of(&again) == Snapshot::of(tree), || "it is not the same again".into())
}

fn use_walks(tree: &BspTree) -> Verdict {
    let _ = tree.bounds();
    let slab = Frustum::new([(DVec3::X, -0.5), (DVec3::NEG_X, -0.5)]);
    for viewpoint in EYES {
        let mut walked = Vec::new();
        let _ = tree.order(viewpoint).walk(|part| {
            match part {
                Part::Subtree(node) => drop((node.bounds(), node.facing_all(viewpoint))),
                Part::Fragment(fragment) => walked.push(fragment.index()),
            }
            Flow::<()>::Descend
        });
        let mut order = Vec::new();
        tree.back_to_front_into(viewpoint, &mut order);
        ensure(walked == order, || "a walk has another order".into())?;
        for facing in [Facing::Front, Facing::Back, Facing::EdgeOn] {
            let culling = Culling::NONE.with_frustum(slab.clone()).with_facing(facing);
            tree.order(viewpoint).culled(&culling).write_into(&mut order);
            ensure(order.len() <= tree.len(), || "more than all is left".into())?;
        }
    }
    Ok(())
}

/// Some places of a tree: vertices, and points between them.
fn places(tree: &BspTree) -> Vec<DVec3> {
    let vertices = tree.fragments().flat_map(|fragment| fragment.vertices());
    let some: Vec<DVec3> = vertices.take(200).step_by(1 + tree.len() / 4).take(7).collect();
    let between = some.windows(2).map(|pair| pair[0] * 0.25 + pair[1] * 0.75);
    between.chain(some.iter().copied()).collect()
}

/// The number of hits of a ray that are read.
const HITS: usize = 100;

/// Runs every query of points, rays and regions.
pub fn use_queries(tree: &BspTree) -> Verdict {
    let places = places(tree);
    let _ = tree.grid();
    for (k, &place) in places.iter().enumerate() {
        if let Some(location) = tree.locate(place) {
            let _ = (location.node(), location.fragments(), location.planes().len());
        }
        let other = places[(k + 3) % places.len()];
        for ray in [
            Ray::between(place, other),
            Ray::new(place, other - place),
            Ray::between(place, place),
            Ray::new(place + (place - other) * 3.0, DVec3::new(0.1, 0.0, -1.0)),
        ] {
            let hits: Vec<_> = tree.hits(ray).take(HITS).collect();
            ensure(!tree.is_occluded(ray) || !hits.is_empty(), || format!("{ray:?}"))?;
            for pair in hits.windows(2) {
                ensure(pair[0].compare(&pair[1]).is_le(), || format!("order: {ray:?}"))?;
            }
            for hit in &hits {
                let _ = (hit.point(), hit.parameter(), hit.facing(), hit.grid_points());
                let _ = (format!("{hit:?}"), hit.fragment().grid_points());
            }
        }
        let region = Frustum::from_box([place.min(other), place.max(other)]);
        let inside: Vec<u32> = tree.fragments_in(&region).collect();
        ensure(inside.is_sorted_by(|a, b| a < b), || "fragments in a region".into())?;
        let _ = tree.fragments_in(&Frustum::new([(other - place, 0.0)])).count();
    }
    for node in tree.nodes() {
        let _ = node.grid_points();
    }
    Ok(())
}

fn use_extend(tree: &BspTree) {
    let mut more = tree.clone();
    let places = places(tree);
    let polygons = [places.iter().copied().take(3).collect::<Vec<_>>(), places];
    // The extension may fail; a budget keeps it short.
    let options = BuildOptions::DEFAULT.with_max_fragments(4 * tree.len() + 100);
    if options.extend(&mut more, &polygons).is_ok() {
        assert_eq!(more.preparation().polygons, tree.preparation().polygons + 2);
    } else {
        assert_eq!(more.len(), tree.len());
    }
}

fn use_overlay(tree: &BspTree) {
    let mut overlay = Overlay::new(tree);
    let corners = tree.fragments().flat_map(|fragment| fragment.vertices()).take(9);
    let corners: Vec<DVec3> = corners.collect();
    // Polygons between places of the tree; they may be degenerate.
    let polygons: Vec<[DVec3; 3]> = corners.as_chunks::<3>().0.to_vec();
    let mut order = Vec::new();
    if overlay.replace(tree, &polygons).is_ok() {
        for viewpoint in EYES {
            overlay.order(tree, viewpoint).expect("its own tree").write_into(&mut order);
            assert!(order.len() == tree.len() + overlay.len());
        }
    }
    let shapes = Shapes::NONE.with_polygons(&polygons).with_lines([&corners[..]]);
    if overlay.replace_with(tree, shapes.with_points(corners.iter().copied())).is_ok() {
        for viewpoint in EYES {
            let shapes = overlay.order(tree, viewpoint).expect("its own tree");
            let mut seen = 0;
            for shape in shapes {
                let at = match shape {
                    Shape::Fragment(fragment) => fragment.vertices().next(),
                    Shape::Segment(segment) => Some(segment.ends()[0]),
                    Shape::Marker(marker) => Some(marker.position()),
                    _ => None,
                };
                assert!(at.is_some_and(|at| at.is_finite()));
                seen += 1;
            }
            assert_eq!(seen, tree.len() + overlay.len());
        }
    }
}

fn use_fragments(tree: &BspTree) -> Verdict {
    for fragment in tree.fragments() {
        let count = fragment.vertex_count();
        let is_finite = fragment.vertices().all(DVec3::is_finite)
            && fragment.weights().flatten().all(|(_, weight)| weight.is_finite());
        ensure(is_finite && count >= 3, || format!("{fragment:?}"))?;
        ensure(fragment.edges().len() == count, || "edges".into())?;
        ensure(fragment.polygon() < tree.preparation().polygons, || "its polygon".into())?;
        for viewpoint in EYES {
            let _ = fragment.facing(viewpoint);
        }
        let other = fragment.index() / 2;
        let _ = tree.plane_between(fragment.index(), other);
    }
    Ok(())
}

fn use_mesh(tree: &BspTree, mesh: &Mesh) -> Verdict {
    let triangles = mesh.triangles();
    let is_known = |&index: &u32| (index as usize) < mesh.len();
    ensure(triangles.indices().iter().all(is_known), || "an index of no vertex".into())?;
    let is_finite = |vertex: binspace::mesh::MeshVertex<'_>| {
        vertex.position.is_finite() && vertex.interpolate(|corner| corner as f64).is_finite()
    };
    ensure(mesh.vertices().all(is_finite), || "a vertex nowhere".into())?;
    let (mut order, mut indices) = (Vec::new(), vec![0; triangles.indices().len()]);
    let written = triangles.write_back_to_front(tree, EYES[1], &mut order, &mut indices);
    ensure(written == Ok(indices.len()), || format!("{written:?}"))?;
    let some = mesh.triangles_of(|polygon| polygon % 2 == 0).map_err(|error| error.to_string())?;
    ensure(some.indices().len() <= indices.len(), || "some are more than all".into())
}

fn use_pictures(tree: &BspTree) {
    let points = || tree.fragments().flat_map(|fragment| fragment.vertices());
    let Some(low) = points().reduce(DVec3::min) else { return };
    let high = points().fold(low, DVec3::max);
    // There is no camera around a tree as large as the largest numbers.
    let cameras = view::views([low, high], DVec3::Z, 2, [24, 18], 3).unwrap_or_default();
    for camera in cameras {
        let _ = (verify(tree, &camera), verify_fronts(tree, &camera));
        use_drawing(tree, &camera);
    }
}

/// Makes the visibility map and its drawings. This may fail for a forged tree.
fn use_drawing(tree: &BspTree, camera: &view::Camera) {
    let Ok(map) = tree.visibility(camera, &ViewOptions::DEFAULT) else { return };
    let corners: usize = map.cells().map(|cell| cell.corners().len()).sum();
    let paths = map.drawing().map_or(0, |drawing| drawing.paths().len());
    let _ =
        (corners, paths, map.polygons().count(), map.edges(Hidden::Keep).map(|runs| runs.len()));
}
