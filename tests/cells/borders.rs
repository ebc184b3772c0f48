//! Neighbouring cells share the vertices made by the planes between them, bit for bit.

use crate::cells::polygons::triangles;
use binspace::internals::{PlaneKind, VertexKind};
use std::collections::BTreeMap;
use testkit::divided::Divided;
use testkit::prelude::*;

/// A plane between cells: its axis, and the bits of its lattice coordinate.
type Wall = (usize, u64);

/// The definition of a vertex. On an edge: the given ends of the edge, in order, and a plane, so that it does
/// not depend on the polygon. Inside a polygon: the polygon and two planes.
#[derive(Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Name {
    OnEdge([[u64; 3]; 2], Wall),
    Inside(usize, [Wall; 2]),
}

/// The places of all vertices made only by planes of cells, with the numbers of the cells.
fn places(scene: &Divided) -> BTreeMap<Name, Vec<([u64; 3], usize)>> {
    let mut places: BTreeMap<Name, Vec<([u64; 3], usize)>> = BTreeMap::new();
    for (number, cell) in scene.cells.iter().enumerate() {
        let faces = cell.tree.faces();
        for fragment in cell.tree.fragments() {
            let wall = |plane: binspace::internals::PlaneId| match plane.kind() {
                // The cell's corners come first.
                PlaneKind::Axis(axis, corner) if corner < 2 => {
                    Some((axis, faces.corner(corner)[axis].to_bits()))
                }
                _ => None,
            };
            for (vertex, vertex_id) in fragment.vertices().zip(fragment.vertex_ids()) {
                let name = match vertex_id.kind() {
                    VertexKind::OnEdge(k, plane) => wall(plane).map(|wall| {
                        let corners = faces.corners(fragment.face());
                        let ends = [k as usize, (k as usize + 1) % corners.len()];
                        let mut ends = ends.map(|k| corners[k].map(f64::to_bits));
                        ends.sort_unstable();
                        Name::OnEdge(ends, wall)
                    }),
                    VertexKind::Inside(g, h) => wall(g).zip(wall(h)).map(|(g, h)| {
                        let mut walls = [g, h];
                        walls.sort_unstable();
                        Name::Inside(cell.polygon(fragment.index()), walls)
                    }),
                    VertexKind::Corner(_) => None,
                };
                if let Some(name) = name {
                    let place = vertex.to_array().map(f64::to_bits);
                    places.entry(name).or_default().push((place, number));
                }
            }
        }
    }
    places
}

/// Checks that every vertex made by planes of cells has the same place in all its cells. Returns the number
/// of these vertices on edges, and inside polygons.
fn check(polygons: Vec<Corners>, cells: usize) -> [usize; 2] {
    let options = BuildOptions::DEFAULT.with_tolerance(0.0);
    let scene = Divided::new(polygons, options, cells).unwrap();
    let mut common = [0; 2];
    for (name, found) in places(&scene) {
        assert!(found.iter().all(|(place, _)| *place == found[0].0), "{name:?}: {found:?}");
        // A polygon that meets a plane is on both sides of the plane.
        let in_several = found.iter().any(|(_, cell)| *cell != found[0].1);
        assert!(in_several, "{name:?} is in one cell alone");
        common[usize::from(matches!(name, Name::Inside(..)))] += 1;
    }
    common
}

#[test]
fn neighbours_have_the_same_vertices_bit_for_bit() {
    let mut total = [0; 2];
    for cells in 2..10 {
        let mut dice = Dice(cells as u64);
        // Corners have many digits, so that nothing is exact by chance.
        let odd = |corner: DVec3| corner * 0.1 + DVec3::new(0.003, 0.007, 0.011) * corner.x;
        let polygons = triangles(&mut dice, 60, 30);
        let polygons = polygons.into_iter().map(|p| p.into_iter().map(odd).collect()).collect();
        let found = check(polygons, cells);
        total = [0, 1].map(|k| total[k] + found[k]);
    }
    enough!(total[0] > 1000, total[1] > 100; "{total:?}");
}

/// In a mesh, the faces on both sides of an edge have the same vertex where a plane cuts the edge.
#[test]
fn faces_that_share_an_edge_have_the_same_vertices() {
    let mesh = scene::sphere(900);
    let odd = |p: &DVec3| DVec3::new(p.x + 0.1 * p.y, p.y * 0.7 - p.z, p.z + p.x / 3.0);
    // Only triangles, because corners that are moved onto a plane have separate vertices.
    let polygons: Vec<Corners> = mesh
        .polygons()
        .flat_map(|quad| {
            quad.points()[1..]
                .windows(2)
                .map(|pair| [quad.points()[0], pair[0], pair[1]])
                .collect::<Vec<_>>()
        })
        .map(|triangle| triangle.iter().map(odd).collect())
        .collect();
    let options = BuildOptions::DEFAULT;
    // Planes that go through no corner.
    let samples = (0..64).map(|k| DVec3::new(f64::from(k) * 0.0137, 0.01, 0.003) - 0.41).collect();
    let scene = Divided::with_samples(polygons, options, samples, 6).unwrap();
    let shared = places(&scene);
    let mut common = 0;
    for (name, found) in shared {
        assert!(found.iter().all(|(place, _)| *place == found[0].0), "{name:?}: {found:?}");
        common += usize::from(found.len() >= 4);
    }
    enough!(common > 50; "{common}");
}
