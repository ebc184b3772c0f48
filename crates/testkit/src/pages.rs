//! Pages as in a compositor of CSS 3D layers, from a seed: for tests, benches and examples.
//!
//! Units are pixels, x runs right, y down and z towards the viewer. Every layer is a rectangle around its own
//! origin. The layer's matrix places it on a screen of [`SCREEN`] pixels, and includes the page's
//! perspective. No layer reaches behind the eye.

use super::dice::Dice;
use binspace::glam::{DMat4, DVec3, dvec3};
use std::f64::consts::{PI, TAU};

/// The size of the screen.
pub const SCREEN: [f64; 2] = [1920.0, 1080.0];
/// The distance of the eye from the plane z = 0.
const PERSPECTIVE: f64 = 1200.0;

/// The content of a page.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Page {
    /// A ring of cards, each of which crosses its two neighbours.
    Carousel,
    /// Parallel cards, three in each plane, in no order of depth.
    Stack,
    /// Cubes of six faces each, rotated in every way, that do not meet.
    Cubes,
    /// Cards that cross each other in every way.
    Crossing,
}

impl Page {
    /// All kinds of pages.
    pub const ALL: [Self; 4] = [Self::Carousel, Self::Stack, Self::Cubes, Self::Crossing];

    /// Returns the name in tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::Carousel => "carousel",
            Self::Stack => "stack",
            Self::Cubes => "cubes",
            Self::Crossing => "crossing",
        }
    }

    /// Returns `count` layers, the same for the same seed.
    pub fn layers(self, count: usize, seed: u64) -> Vec<PageLayer> {
        let mut dice = Dice(seed);
        let camera = camera();
        let places = match self {
            Self::Carousel => carousel(count, &mut dice),
            Self::Stack => stack(count, &mut dice),
            Self::Cubes => cubes(count, &mut dice),
            Self::Crossing => crossing(count, &mut dice),
        };
        let layer = |(half, place)| PageLayer { half, matrix: camera * place };
        places.into_iter().map(layer).collect()
    }
}

/// A layer of a page: the rectangle from −`half` to `half` and its matrix.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PageLayer {
    /// Half the width and half the height of the layer.
    pub half: [f64; 2],
    /// From the layer's own x and y (z is 0) to homogeneous screen coordinates.
    pub matrix: DMat4,
}

impl PageLayer {
    /// Returns the layer's corners on the screen with their depths, after the division by w.
    pub fn outline(&self) -> [[f64; 3]; 4] {
        let [x, y] = self.half;
        [[-x, -y], [x, -y], [x, y], [-x, y]].map(|[x, y]| {
            let corner = self.matrix * dvec3(x, y, 0.0).extend(1.0);
            (corner.truncate() / corner.w).to_array()
        })
    }
}

/// Returns the perspective of the page, from the middle of the screen.
pub fn camera() -> DMat4 {
    let mut perspective = DMat4::IDENTITY;
    perspective.z_axis.w = -1.0 / PERSPECTIVE;
    let middle = dvec3(SCREEN[0] / 2.0, SCREEN[1] / 2.0, 0.0);
    DMat4::from_translation(middle) * perspective
}

/// Half the size of a layer, and its place in space.
type Placed = ([f64; 2], DMat4);

fn carousel(count: usize, dice: &mut Dice) -> Vec<Placed> {
    let radius = 500.0;
    let step = TAU / count as f64;
    // Half as wide again as cards that only touch their neighbours in the ring.
    let half = 1.5 * radius * (step / 2.0).tan().min(0.6);
    let start = dice.range(0.0, step);
    let ring = DMat4::from_translation(dvec3(0.0, 0.0, -300.0))
        * DMat4::from_rotation_x(dice.range(-0.4, 0.4));
    let place = |k: usize| {
        let around = DMat4::from_rotation_y(start + step * k as f64);
        ([half, 140.0], ring * around * DMat4::from_translation(dvec3(0.0, 0.0, radius)))
    };
    (0..count).map(place).collect()
}

fn stack(count: usize, dice: &mut Dice) -> Vec<Placed> {
    let tilt = DMat4::from_rotation_x(dice.range(-0.7, 0.7))
        * DMat4::from_rotation_y(dice.range(-0.7, 0.7));
    let planes = count.div_ceil(3);
    let place = |k: usize| {
        // Planes are in a scattered order, with a step that is coprime to their number.
        let plane = (k % planes) * scatter(planes) % planes;
        let z = 400.0 * (plane as f64 / planes as f64 - 0.7);
        let at = dvec3(dice.range(-250.0, 250.0), dice.range(-150.0, 150.0), z);
        let half = [dice.range(60.0, 220.0), dice.range(40.0, 140.0)];
        (half, tilt * DMat4::from_translation(at))
    };
    (0..count).map(place).collect()
}

/// A number coprime to `count`, near the golden section of `count`.
fn scatter(count: usize) -> usize {
    let shares_none = |&step: &usize| {
        let (mut a, mut b) = (step, count);
        while b > 0 {
            (a, b) = (b, a % b);
        }
        a == 1
    };
    (count * 61 / 100 + 1..).find(shares_none).expect("the next prime at the latest")
}

fn cubes(count: usize, dice: &mut Dice) -> Vec<Placed> {
    let number = count.div_ceil(6);
    let columns = ((number as f64 * 16.0 / 9.0).sqrt().ceil() as usize).max(1);
    let cell = 1200.0 / columns as f64;
    // A rotated cube fits a ball of this radius times √3.
    let half = 0.5 * cell / 3.0f64.sqrt();
    let rows = number.div_ceil(columns);
    let mut places = Vec::with_capacity(count);
    for cube in 0..number {
        let (column, row) = ((cube % columns) as f64, (cube / columns) as f64);
        let at = dvec3(
            (column - (columns as f64 - 1.0) / 2.0) * cell,
            (row - (rows as f64 - 1.0) / 2.0) * cell,
            dice.range(-300.0, 0.0),
        );
        let turn = DMat4::from_translation(at) * any_turn(dice);
        for face in 0..6.min(count - places.len()) {
            let side = match face {
                0..4 => DMat4::from_rotation_y(face as f64 * PI / 2.0),
                4 => DMat4::from_rotation_x(PI / 2.0),
                _ => DMat4::from_rotation_x(-PI / 2.0),
            };
            let out = DMat4::from_translation(dvec3(0.0, 0.0, half));
            places.push(([half; 2], turn * side * out));
        }
    }
    places
}

fn crossing(count: usize, dice: &mut Dice) -> Vec<Placed> {
    let place = |_| {
        let at = dice.point(-200.0, 200.0) - DVec3::Z * 300.0;
        let half = [dice.range(120.0, 350.0), dice.range(80.0, 240.0)];
        (half, DMat4::from_translation(at) * any_turn(dice))
    };
    (0..count).map(place).collect()
}

fn any_turn(dice: &mut Dice) -> DMat4 {
    DMat4::from_rotation_z(dice.range(0.0, TAU))
        * DMat4::from_rotation_y(dice.range(0.0, TAU))
        * DMat4::from_rotation_x(dice.range(0.0, TAU))
}
