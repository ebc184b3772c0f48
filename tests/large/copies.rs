//! The hard scenes of a few polygons, repeated many times.

use super::heaps::copies;
use proptest::prelude::*;
use proptest::strategy::ValueTree;
use proptest::test_runner::{Config, RngAlgorithm, TestRng, TestRunner};
use testkit::as_given::exact::{Plane, sign};
use testkit::as_given::scene::{Point, Scene};
use testkit::prelude::*;

/// A family of hard scenes, and the number of grid steps in one unit.
struct Family {
    name: &'static str,
    scenes: BoxedStrategy<Vec<Corners>>,
    steps: f64,
}

fn families() -> [Family; 8] {
    // Sizes of 1 and gaps of 1e-12 need 2⁴⁰ steps.
    let fine = (1u64 << 40) as f64;
    let family = |name, scenes, steps| Family { name, scenes, steps };
    [
        family("small lattices", hard::small_lattice().boxed(), 1.0),
        family("resting", hard::on_each_others_planes().boxed(), 64.0),
        family("nearly coplanar", hard::near_coplanar().boxed(), fine),
        family("thin layers", hard::layers().boxed(), fine),
        family("slivers", hard::slivers().boxed(), fine),
        family("boxes", hard::boxes().boxed(), fine),
        family("T-junctions again", hard::t_junctions().boxed(), 2.0),
        family("n-gons", hard::lattice_ngons().boxed(), 1.0),
    ]
}

/// The number of families.
pub(crate) const FAMILIES: usize = 8;

/// Rotated copies of scenes of one family.
pub(crate) fn of_family(family: usize, dice: &mut Dice, n: usize) -> Scene {
    let Some(Family { name, scenes, steps }) = families().into_iter().nth(family) else {
        unreachable!("there are {FAMILIES} families");
    };
    let mut seed = [0; 32];
    seed[..8].copy_from_slice(&dice.roll().to_le_bytes());
    let random = TestRng::from_seed(RngAlgorithm::ChaCha, &seed);
    let mut runner = TestRunner::new_with_rng(Config::default(), random);
    copies(name, dice, n, |_| {
        let scene = scenes.new_tree(&mut runner).expect("a strategy without filters").current();
        scene.iter().flat_map(|polygon| rounded(polygon, steps)).collect()
    })
}

/// A polygon rounded to the grid, as triangles if rounding makes it bent.
fn rounded(polygon: &Corners, steps: f64) -> Vec<Vec<Point>> {
    let mut corners: Vec<Point> =
        polygon.iter().map(|p| (*p * steps).round().to_array().map(|c| c as i64)).collect();
    corners.dedup();
    if corners.len() < 3 {
        return vec![];
    }
    let plane = Plane::of(&corners);
    if corners.iter().all(|&p| sign(&plane.at(p)).is_eq()) {
        return vec![corners];
    }
    (1..corners.len() - 1).map(|k| vec![corners[0], corners[k], corners[k + 1]]).collect()
}
