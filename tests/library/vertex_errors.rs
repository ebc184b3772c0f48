//! The errors of the vertices that a tree returns, in the scene's own coordinates, compared with exact
//! rationals: in scenes far from the origin, tiny, and huge.

use binspace::internals::{EdgeLine, PlaneKind, VertexKind};
use proptest::prelude::*;
use proptest::test_runner::TestCaseError;
use std::collections::HashMap;
use testkit::hard::HardScene;
use testkit::judge::meeting;
use testkit::model::Face;
use testkit::prelude::*;

/// World coordinates as (lattice + origin) · step, computed from the corners of the scene if these decide.
struct World {
    step: Rational,
    origin: [Rational; 3],
}

impl World {
    fn of(faces: &Faces, scene: &HardScene) -> Self {
        let step = rational::step(faces.lattice());
        let (half, zero) = (rational::exact(0.5), rational::exact(0.0));
        let origin = std::array::from_fn(|axis| {
            let corners = || scene.polygons.iter().flatten();
            let place = |corner: &DVec3| rational::exact(corner[axis]) / &step;
            // A corner halfway between two grid points may be rounded to either point.
            let is_halfway = |corner: &&DVec3| (place(corner).fract().abs() - &half) == zero;
            match corners().find(|corner| !is_halfway(corner)) {
                Some(corner) => {
                    place(corner).round() - rational::exact(faces.lattice().snap(*corner)[axis])
                }
                // Without other points, no corner decides.
                None => rational::exact(faces.lattice().to_world([0.0; 3])[axis]) / &step,
            }
        });
        Self { step, origin }
    }
}

/// The step from a number to the next.
fn ulp(value: f64) -> f64 {
    value.abs().next_up() - value.abs()
}

#[derive(Default)]
struct Errors {
    vertices: usize,
    far: usize,
    /// The largest error in lattice steps, where the steps of coordinates are smaller; and the largest error
    /// in steps of the coordinate, where these are larger.
    steps: f64,
    ulps: f64,
    /// The largest error in steps of the coordinate, everywhere.
    relative: f64,
}

impl Errors {
    fn add(&mut self, tree: &BspTree, scene: &HardScene) -> Result<(), TestCaseError> {
        let faces = tree.faces();
        let world = World::of(faces, scene);
        let step = faces.lattice().length_to_world(1.0);
        let mut places: HashMap<String, [u64; 3]> = HashMap::new();
        for fragment in tree.fragments() {
            let exact = Face::new(faces, fragment.face());
            let lines: Vec<EdgeLine> = fragment.lines().collect();
            let corners = faces.corners(fragment.face()).len() as u32;
            for (i, (vertex, name)) in fragment.vertices().zip(fragment.vertex_ids()).enumerate() {
                let vertex_id =
                    meeting(lines[(i + lines.len() - 1) % lines.len()], lines[i], corners);
                let point = exact.resolve(faces, vertex_id);
                // The vertex is the same, bit for bit, in all pieces that the same cuts made.
                let bits = vertex.to_array().map(f64::to_bits);
                let name = format!("{} {name:?}", fragment.face());
                prop_assert_eq!(*places.entry(name).or_insert(bits), bits, "{:?}", vertex_id);
                for axis in 0..3 {
                    let place = (&point[axis] + &world.origin[axis]) * &world.step;
                    let off = (rational::exact(vertex[axis]) - &place).abs();
                    let off = off.to_f64().value();
                    let own = ulp(vertex[axis]);
                    // As `docs/guide/exact.md` says.
                    prop_assert!(off <= 0.77 * step + own, "{off:e}: {own:e} and {step:e}");
                    let worst = if own < step { &mut self.steps } else { &mut self.ulps };
                    *worst = worst.max(off / own.max(step));
                    self.relative = self.relative.max(off / own);
                    self.far += usize::from(own > step);
                    self.vertices += 1;
                }
            }
        }
        Ok(())
    }
}

#[test]
fn vertices_in_the_world_are_as_near_their_exact_places_as_stated() {
    let cases = (hard::scene(), hard::heuristic());
    let errors = tally(file!(), 200, cases, |errors: &mut Errors, (scene, by)| {
        let options = BuildOptions::DEFAULT.with_heuristic(by).with_tolerance(0.0);
        errors.add(&options.build(&scene.polygons).expect("finite"), &scene)
    });
    let Errors { vertices, far, steps, ulps, relative } = errors;
    enough!(vertices > 10_000, far > 500; "{vertices} coordinates, {far} far out");
    // The actual errors are not far below the documented bounds.
    assert!(steps > 0.2 && ulps > 0.4, "{steps} steps, {ulps} of the coordinates' own");
    // Near zero a coordinate's own steps are smaller than any error.
    assert!(relative > 100.0, "{relative}");
}

/// Vertices on planes perpendicular to an axis have their coordinate exactly, whatever the rounding of the
/// others. Counts these vertices by the role of the plane: it alone cuts an edge, it is the first of two
/// planes, or it is the second.
fn check_axis_planes(tree: &BspTree, compared: &mut [usize; 3]) {
    for fragment in tree.fragments() {
        for (vertex_id, position) in fragment.vertex_ids().zip(fragment.lattice_vertices()) {
            let planes = match vertex_id.kind() {
                VertexKind::Corner(_) => [None; 3],
                VertexKind::OnEdge(_, plane) => [Some(plane), None, None],
                VertexKind::Inside(g, h) => [None, Some(g), Some(h)],
            };
            for (plane, compared) in planes.into_iter().zip(&mut *compared) {
                if let Some(PlaneKind::Axis(axis, corner)) = plane.map(PlaneId::kind) {
                    let at = tree.faces().corner(corner)[axis];
                    assert_eq!(position[axis], at, "{vertex_id:?}");
                    *compared += 1;
                }
            }
        }
    }
}

#[test]
fn vertices_on_an_axis_aligned_plane_have_its_coordinate_exactly() {
    let options = BuildOptions::DEFAULT.with_heuristic(Heuristic::FreePlanes);
    let mut compared = [0; 3];
    for seed in 1..5 {
        let scene = scene::random_triangles(300, seed);
        check_axis_planes(&options.build(scene.polygons()).unwrap(), &mut compared);
    }
    assert!(compared.iter().all(|&compared| compared > 1000), "{compared:?}");
    let hard = tally(file!(), 300, hard::scene(), |compared: &mut [usize; 3], scene| {
        check_axis_planes(&scene.build(Heuristic::FreePlanes).map_err(fail)?, compared);
        Ok(())
    });
    enough!(hard[0] > 1000; "{hard:?}");
}
