//! Shared code of the tests of choosing, and tests of whole choices.

use glam::{DQuat, DVec3, EulerRot};

use super::set::Set;
use super::tuning::Tuning;
use super::{Choice, ChooseContext, Chooser};
use crate::build::piece::{Division, Piece, Splitter};
use crate::build::{BuildOptions, FrameBuilder, Heuristic};
use crate::exact::{Faces, PlaneId, PlaneKind, PreparedPlane, Side, Vertex};
use crate::progress::Watch;
use crate::random::SplitMix64;
use crate::tree::BspTree;

/// A set of pieces with all referenced data.
pub(super) struct Fixture {
    pub(super) faces: Faces,
    pub(super) pieces: Vec<Piece>,
    pub(super) arena: Vec<Vertex>,
}

impl Fixture {
    pub(super) fn new<const N: usize>(polygons: &[[DVec3; N]], tolerance: f64) -> Self {
        let (faces, _) = Faces::new(polygons, Some(tolerance)).unwrap();
        let pieces = (0..faces.len() as u32).map(|face| Piece::whole(&faces, face)).collect();
        Self { faces, pieces, arena: vec![] }
    }

    pub(super) fn set(&self) -> Set<'_> {
        Set::new(&self.faces, &self.pieces, &self.arena)
    }

    /// Keeps the pieces on one side of a plane.
    pub(super) fn keep(&mut self, plane: PlaneId, kept: Side) {
        let prepared = PreparedPlane::new(&self.faces, plane);
        let mut splitter = Splitter::default();
        for piece in std::mem::take(&mut self.pieces) {
            let side = piece.side(&self.faces, &prepared, &self.arena);
            if side == kept {
                self.pieces.push(piece);
            } else if side == Side::Spanning {
                let parts = splitter.cut(&self.faces, &prepared, &piece, &mut self.arena).unwrap();
                self.pieces.push(parts[usize::from(kept == Side::Back)]);
            }
        }
    }
}

pub(super) fn triangles(random: &mut SplitMix64, count: usize, size: f64) -> Vec<[DVec3; 3]> {
    let mut triangle = || {
        let at = random.point(-1.0, 1.0);
        [(); 3].map(|()| at + random.point(-size, size))
    };
    (0..count).map(|_| triangle()).collect()
}

/// Squares of a rotated grid; `height` returns the distance of each corner from the plane.
pub(super) fn grid(side: u32, mut height: impl FnMut(DVec3) -> f64) -> Vec<[DVec3; 3]> {
    let turn = DQuat::from_euler(EulerRot::XYZ, 0.3, 0.5, 0.7);
    let mut triangles = vec![];
    for i in 0..side {
        for j in 0..side {
            let mut corner = |x: u32, y: u32| {
                let at = DVec3::new(f64::from(i + x), f64::from(j + y), 0.0) / f64::from(side);
                turn * (at + DVec3::Z * height(at))
            };
            let [a, b, c, d] = [corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)];
            triangles.extend([[a, b, c], [a, c, d]]);
        }
    }
    triangles
}

#[test]
fn fragments_grow_with_the_scene_without_a_jump() {
    let all = triangles(&mut SplitMix64::new(7), 600, 0.3);
    let per_face = |n: usize| BspTree::build(&all[..n]).unwrap().len() as f64 / n as f64;
    let sizes = || (150..=600).step_by(25);
    for (n, pair) in sizes().zip(sizes().map(per_face).collect::<Vec<_>>().windows(2)) {
        let growth = pair[1] / pair[0];
        assert!((0.9..1.25).contains(&growth), "{n}: {pair:?}");
    }
}

#[test]
fn what_lies_in_one_plane_is_one_node() {
    for side in [5, 12, 40] {
        let polygons = grid(side, |_| 0.0);
        let tree = BspTree::build(&polygons).unwrap();
        assert_eq!((tree.len(), tree.stats().nodes), (polygons.len(), 1), "{side}");
    }
}

#[test]
fn a_sample_is_spread_over_the_set() {
    let fixture = Fixture::new(&triangles(&mut SplitMix64::new(1), 10, 0.1), 0.0);
    let sample = |count| fixture.set().sample(count).collect::<Vec<_>>();
    assert_eq!(sample(4), [0, 2, 5, 7]);
    assert!((10..12).all(|count| sample(count).into_iter().eq(0..10)));
}

fn chosen<const N: usize>(heuristic: Heuristic, polygons: &[[DVec3; N]]) -> PlaneId {
    let (fixture, watch) = (Fixture::new(polygons, 0.0), Watch::default());
    let options = BuildOptions::DEFAULT.with_heuristic(heuristic);
    let rules = ChooseContext::new(&options, &Tuning::DEFAULT, &watch);
    match Chooser::default().choose(&rules, &fixture.set(), &mut Division::default()).unwrap() {
        Choice::Split(plane) => plane,
        choice => panic!("{choice:?}"),
    }
}

/// The polygons that one plane cuts come late in the set, after more pieces than are tested at once.
#[test]
fn own_planes_are_held_against_all_of_a_large_set() {
    const HALF: u32 = 5000;
    let top = f64::from(2 * HALF);
    let layer = |i: u32| {
        let z = f64::from(i);
        let at = if i >= HALF {
            DVec3::new(0.0, 5.0, z)
        } else if i == 1 {
            DVec3::new(5.0, 0.0, z)
        } else {
            DVec3::new(5.0, 5.0, z)
        };
        [DVec3::new(-1.0, -1.0, 0.0), DVec3::X, DVec3::Y].map(|corner| at + corner)
    };
    let wall =
        |x: f64, y: f64| [DVec3::new(x, y, -1.0), DVec3::new(y, x, -1.0), DVec3::new(y, x, top)];
    let mut polygons: Vec<_> = (0..2 * HALF).map(layer).collect();
    // A wall in the plane x = 0, and one in the plane y = 0: both planes are candidates.
    polygons[0] = wall(0.0, 7.0).map(|corner| corner.with_x(0.0));
    polygons[104] = wall(0.0, 7.0).map(|corner| corner.with_y(0.0));
    polygons[0][1].y = 9.0;
    polygons[104][1].x = 9.0;
    assert_eq!(chosen(Heuristic::FewestSplits, &polygons), PlaneId::face(104));
}

#[test]
fn of_equal_scores_the_earliest_wins() {
    let layers = [0.0, 1.0].map(|z| [DVec3::ZERO, DVec3::X, DVec3::Y].map(|p| p.with_z(z)));
    for heuristic in [Heuristic::FewestSplits, Heuristic::Balanced] {
        assert_eq!(chosen(heuristic, &layers), PlaneId::face(0), "{heuristic}");
    }
}

/// The free plane is used even if other planes divide the set more evenly.
#[test]
fn a_free_plane_that_cuts_nothing_is_taken_at_once() {
    let mut random = SplitMix64::new(7);
    for n in [300, 800] {
        let mut polygons = triangles(&mut random, n, 0.03);
        let apart = polygons[0].map(|corner| corner.with_x(5.0 + corner.x));
        polygons.push(apart);
        let fixture = Fixture::new(&polygons, 0.0);
        let plane = chosen(Heuristic::Auto, &polygons);
        let PlaneKind::Axis(axis, corner) = plane.kind() else { panic!("{n}: {plane:?}") };
        let at = fixture.faces.corner(corner)[axis];
        let is_uncut = |piece: &Piece| piece.max[axis] <= at || piece.min[axis] >= at;
        assert!(fixture.pieces.iter().all(is_uncut), "{n}: {plane:?}");
    }
}

/// In a list, the deepest layer would be at level 31.
#[test]
fn a_frame_divides_a_small_stack_evenly() {
    let layers = [DVec3::ZERO, DVec3::X, DVec3::Y];
    let layers: Vec<_> = (0..32).map(|z| layers.map(|p| p.with_z(f64::from(z)))).collect();
    let mut builder = FrameBuilder::new(BuildOptions::DEFAULT);
    let stats = builder.build(&layers).unwrap().stats();
    assert_eq!(stats.fragments, 32);
    assert!(stats.depth_max <= 16, "{}", stats.depth_max);
}

/// A ring of cards, each of which crosses its two neighbours.
fn ring(cards: usize) -> Vec<[DVec3; 4]> {
    let turn = DQuat::from_euler(EulerRot::XYZ, 0.3, 0.5, 0.7);
    let half = 1.5 * (std::f64::consts::PI / cards as f64).tan();
    let card = |k: usize| {
        let around = DQuat::from_rotation_z(k as f64 * std::f64::consts::TAU / cards as f64);
        let corner = |u: f64, v: f64| turn * around * DVec3::new(1.0, u * half, v);
        [corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)]
    };
    (0..cards).map(card).collect()
}

/// In sets of every range of sizes, each pair of neighbours is cut once.
#[test]
fn a_ring_of_cards_is_cut_no_more_than_it_crosses() {
    for cards in [8, 12, 31, 33, 60, 100, 200] {
        let mut builder = FrameBuilder::new(BuildOptions::DEFAULT);
        assert_eq!(builder.build(ring(cards)).unwrap().len(), 2 * cards, "{cards}");
    }
}
