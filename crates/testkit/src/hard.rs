//! Scenes that are hard to decide: proptest strategies biased towards coincidence and near coincidence.
//!
//! Use [`scene`] in general, and a single family only in a test about this family.

use super::shapes::{self, Corners};
use binspace::glam::{DMat3, DVec3};
use binspace::internals::Faces;
use binspace::{BspTree, BuildOptions, Heuristic};
use proptest::prelude::*;
use proptest::sample::Index;

/// The coplanar tolerance of a build.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Tolerance {
    /// The library's.
    Default,
    /// This share of the longest side of the scene's bounding box.
    Share(f64),
}

/// Polygons, and their tolerance.
#[derive(Clone, Debug)]
pub struct HardScene {
    pub polygons: Vec<Corners>,
    tolerance: Tolerance,
}

impl HardScene {
    /// Returns the tolerance as a library option.
    pub fn tolerance(&self) -> Option<f64> {
        match self.tolerance {
            Tolerance::Default => None,
            Tolerance::Share(share) => Some(share * extent(&self.polygons)),
        }
    }

    /// Returns the same scene with another tolerance.
    pub fn with_tolerance(self, tolerance: Tolerance) -> Self {
        Self { tolerance, ..self }
    }

    /// Returns options with the scene's tolerance and a heuristic.
    pub fn options(&self, by: Heuristic) -> BuildOptions {
        let mut options = BuildOptions::DEFAULT.with_heuristic(by);
        options.tolerance = self.tolerance().into();
        options
    }

    pub fn build(&self, by: Heuristic) -> Result<BspTree, String> {
        self.options(by).build(&self.polygons).map_err(|error| error.to_string())
    }

    pub fn faces(&self) -> Faces {
        Faces::new(&self.polygons, self.tolerance()).expect("finite").0
    }

    /// Returns the scene's bounding box, if the scene has a corner.
    pub fn bounds(&self) -> Option<[DVec3; 2]> {
        bounds(&self.polygons)
    }
}

/// Returns the bounding box, if there is a corner.
pub fn bounds(polygons: &[Corners]) -> Option<[DVec3; 2]> {
    let corners = || polygons.iter().flatten().copied();
    Some([corners().reduce(DVec3::min)?, corners().reduce(DVec3::max)?])
}

/// Returns the longest side of the bounding box.
pub fn extent(polygons: &[Corners]) -> f64 {
    bounds(polygons).map_or(0.0, |[low, high]| (high - low).max_element())
}

/// Returns one of all heuristics.
pub fn heuristic() -> impl Strategy<Value = Heuristic> {
    prop::sample::select(Heuristic::ALL)
}

/// Returns a scene of a few polygons: one or two families, perhaps with duplicates, with coordinates nudged
/// by ulps, moved far out, or scaled.
pub fn scene() -> impl Strategy<Value = HardScene> {
    let mixed = prop_oneof![
        3 => family(),
        1 => (family(), family()).prop_map(|(mut a, b)| { a.extend(b); a }),
    ];
    (mixed, duplicates(), nudges(), placement(), tolerance()).prop_map(
        |(mut polygons, duplicates, nudges, (offset, scale), tolerance)| {
            for (index, reversed) in duplicates {
                let mut copy = index.get(&polygons).clone();
                if reversed {
                    copy.reverse();
                }
                polygons.push(copy);
            }
            for corner in polygons.iter_mut().flatten() {
                *corner = (*corner + offset) * scale;
            }
            for (polygon, corner, axis, steps) in nudges {
                let polygon = polygon.index(polygons.len());
                let corner = corner.get_mut(&mut polygons[polygon]);
                corner[axis] = shapes::ulps_from(corner[axis], steps);
            }
            HardScene { polygons, tolerance }
        },
    )
}

/// Returns one of all families.
pub fn family() -> BoxedStrategy<Vec<Corners>> {
    prop_oneof![
        2 => small_lattice().boxed(),
        2 => on_each_others_planes().boxed(),
        1 => near_coplanar().boxed(),
        1 => layers().boxed(),
        1 => slivers().boxed(),
        1 => boxes().boxed(),
        1 => t_junctions().boxed(),
        2 => lattice_ngons().boxed(),
        2 => rounded_ngons().boxed(),
        1 => chaos().boxed(),
    ]
    .boxed()
}

/// Triangles with corners on a lattice of 5 × 5 × 5 points: everything coincides.
pub fn small_lattice() -> impl Strategy<Value = Vec<Corners>> {
    let corner = prop::array::uniform3(-2..=2i32);
    prop::collection::vec(prop::array::uniform3(corner), 2..8)
        .prop_map(|list| list.into_iter().map(|t| t.map(whole).to_vec()).collect())
}

/// Returns a lattice triangle and others that touch its plane, inside, outside, and on its edges.
pub fn on_each_others_planes() -> impl Strategy<Value = Vec<Corners>> {
    let resting = (prop::array::uniform2(prop::array::uniform2(-2..=10i32)), lattice_point());
    (prop::array::uniform3(lattice_point()), prop::collection::vec(resting, 1..5)).prop_map(
        |(base, list)| {
            let others = list.into_iter().map(|(at, apex)| shapes::resting_on(base, at, apex));
            std::iter::once(base.to_vec()).chain(others).collect()
        },
    )
}

/// Pairs of triangles with a common edge, and an angle of 1e-3 to 1e-12 rad between their planes.
pub fn near_coplanar() -> impl Strategy<Value = Vec<Corners>> {
    let pair = (turn(), -12..=-3i32, point(), prop::bool::ANY);
    prop::collection::vec(pair, 1..4).prop_map(|list| {
        let pair = |(turn, exponent, shift, apart): (DMat3, i32, DVec3, bool)| {
            let angle = 10f64.powi(exponent);
            let shift = if apart { shift * angle } else { DVec3::ZERO };
            shapes::near_coplanar_pair(turn, angle, shift)
        };
        list.into_iter().flat_map(pair).collect()
    })
}

/// Squares 1e-3 to 1e-7 apart, rotated in any way or not at all.
pub fn layers() -> impl Strategy<Value = Vec<Corners>> {
    (prop_oneof![Just(DMat3::IDENTITY), turn()], -7..=-3i32, 2..7usize)
        .prop_map(|(turn, gap, count)| shapes::layers(turn, 10f64.powi(gap), count))
}

/// Triangles 1e-3 to 1e-12 wide that pass through each other.
pub fn slivers() -> impl Strategy<Value = Vec<Corners>> {
    let one = (turn(), -12..=-3i32, -1.0..1.0f64, point());
    prop::collection::vec(one, 2..6).prop_map(|list| {
        let sliver = |(turn, width, along, centre): (DMat3, i32, f64, DVec3)| {
            shapes::sliver(turn, 10f64.powi(width), along, centre * 0.25)
        };
        list.into_iter().map(sliver).collect()
    })
}

/// Boxes rotated in any way: their sides are planar except for rounding.
pub fn boxes() -> impl Strategy<Value = Vec<Corners>> {
    let one = (turn(), point(), prop::array::uniform3(0.125..1.0f64));
    prop::collection::vec(one, 1..3).prop_map(|list| {
        let cuboid = |(turn, centre, size)| shapes::cuboid(turn, centre, DVec3::from_array(size));
        list.into_iter().flat_map(cuboid).collect()
    })
}

/// Edges that end in the middle of another edge, on a lattice or not.
pub fn t_junctions() -> impl Strategy<Value = Vec<Corners>> {
    let at = prop_oneof![lattice_point().boxed(), point().boxed()];
    let one = (prop::array::uniform3(at.clone()), at);
    prop::collection::vec(one, 1..4).prop_map(|list| {
        list.into_iter().flat_map(|(base, apex)| shapes::t_junction(base, apex)).collect()
    })
}

/// Convex polygons that are planar to the last bit, some with collinear corners.
pub fn lattice_ngons() -> impl Strategy<Value = Vec<Corners>> {
    prop::collection::vec(lattice_ngon(), 1..5)
}

/// Returns one convex polygon with integer corners.
pub fn lattice_ngon() -> impl Strategy<Value = Corners> {
    let edges = prop::collection::vec(prop::array::uniform2(-4..=4i32), 2..12);
    let vector = || prop::array::uniform3(-2..=2i32);
    (edges, vector(), vector(), vector()).prop_map(|(edges, u, v, origin)| {
        shapes::onto_plane(&shapes::convex_on_grid(&edges), u, v, origin)
    })
}

/// Convex polygons that are planar except for rounding, or for a noise of 1e-15 to 1e-10.
pub fn rounded_ngons() -> impl Strategy<Value = Vec<Corners>> {
    let noise = prop_oneof![Just(0.0), (-15..=-10i32).prop_map(|e| 10f64.powi(e))];
    let one = (3..=12usize, turn(), point(), noise, prop::collection::vec(-1.0..1.0f64, 12));
    prop::collection::vec(one, 1..5).prop_map(|list| {
        let ngon = |(n, turn, centre, noise, rough): (usize, DMat3, DVec3, f64, Vec<f64>)| {
            let mut corners = shapes::regular(n, turn, centre);
            let lift = |(corner, r): (&mut DVec3, f64)| *corner += turn.z_axis * (r * noise);
            corners.iter_mut().zip(rough).for_each(lift);
            corners
        };
        list.into_iter().map(ngon).collect()
    })
}

/// Unrelated triangles.
pub fn chaos() -> impl Strategy<Value = Vec<Corners>> {
    prop::collection::vec(prop::collection::vec(point(), 3), 2..7)
}

/// Offsets up to 1e8 and scales from 1e-30 to 1e30, often none.
fn placement() -> impl Strategy<Value = (DVec3, f64)> {
    let far = (prop::array::uniform3(-1.0..1.0f64), 2..=8i32);
    let offset = prop_oneof![
        3 => Just(DVec3::ZERO),
        1 => far.prop_map(|(d, e)| DVec3::from_array(d) * 10f64.powi(e)),
        1 => (1..=8i32).prop_map(|e| DVec3::splat(10f64.powi(e))),
    ];
    let scale = prop_oneof![3 => Just(1.0), 1 => (-30..=30i32).prop_map(|e| 10f64.powi(e))];
    (offset, scale)
}

fn tolerance() -> impl Strategy<Value = Tolerance> {
    prop_oneof![
        2 => Just(Tolerance::Default),
        2 => Just(Tolerance::Share(0.0)),
        2 => (-16.0..-1.0f64).prop_map(|e| Tolerance::Share(10f64.powf(e))),
        1 => Just(Tolerance::Share(1.0)),
    ]
}

fn duplicates() -> impl Strategy<Value = Vec<(Index, bool)>> {
    let one = (any::<Index>(), any::<bool>());
    prop_oneof![2 => Just(Vec::new()), 1 => prop::collection::vec(one, 1..3)]
}

fn nudges() -> impl Strategy<Value = Vec<(Index, Index, usize, i32)>> {
    let one = (any::<Index>(), any::<Index>(), 0..3usize, -4..=4i32);
    prop_oneof![2 => Just(Vec::new()), 1 => prop::collection::vec(one, 1..6)]
}

/// Returns a rotation: about one axis by an eighth turn or a small angle, or any.
pub fn turn() -> impl Strategy<Value = DMat3> {
    let any_turn = prop::array::uniform3(-3.0..3.0f64).prop_map(shapes::rotation);
    let eighth = (0..3usize, 0..8i32).prop_map(|(axis, k)| {
        let mut angles = [0.0; 3];
        angles[axis] = f64::from(k) * std::f64::consts::FRAC_PI_4;
        shapes::rotation(angles)
    });
    prop_oneof![2 => any_turn, 1 => eighth]
}

fn point() -> impl Strategy<Value = DVec3> {
    prop::array::uniform3(-1.0..1.0f64).prop_map(DVec3::from_array)
}

fn lattice_point() -> impl Strategy<Value = DVec3> {
    prop::array::uniform3(-4..=4i32).prop_map(whole)
}

fn whole(p: [i32; 3]) -> DVec3 {
    DVec3::from_array(p.map(f64::from))
}
