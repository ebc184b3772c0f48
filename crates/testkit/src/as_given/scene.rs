//! Scenes with integer coordinates, for the judge and the library.

use crate::prelude::*;
use binspace::Error;

pub type Point = [i64; 3];

/// Convex, planar polygons with integer corners, so that rounding to the lattice moves no corner.
#[derive(Clone, Debug)]
pub struct Scene {
    pub name: String,
    pub polygons: Vec<Vec<Point>>,
    /// The coplanar tolerance to build with, in the polygons' unit.
    pub tolerance: f64,
}

impl Scene {
    pub fn new(name: &str, polygons: Vec<Vec<Point>>) -> Self {
        Self { name: name.to_owned(), polygons, tolerance: 0.0 }
    }

    pub fn with_tolerance(self, tolerance: f64) -> Self {
        Self { tolerance, ..self }
    }

    /// Returns the largest magnitude of a coordinate.
    pub fn size(&self) -> i64 {
        self.polygons.iter().flatten().flatten().map(|c| c.abs()).max().unwrap_or(1)
    }

    pub fn build(&self, heuristic: Heuristic, max_fragments: usize) -> Result<BspTree, Error> {
        self.options(heuristic, max_fragments).build(self.corners())
    }

    /// Returns the tree of a frame, whose planes are chosen in another way.
    pub fn frame(&self, max_fragments: usize) -> Result<BspTree, Error> {
        let options = self.options(Heuristic::Auto, max_fragments);
        FrameBuilder::new(options).build(self.corners()).cloned()
    }

    fn options(&self, heuristic: Heuristic, max_fragments: usize) -> BuildOptions {
        BuildOptions::DEFAULT
            .with_heuristic(heuristic)
            .with_tolerance(self.tolerance)
            .with_max_fragments(max_fragments)
    }

    fn corners(&self) -> impl Iterator<Item = Vec<DVec3>> {
        self.polygons.iter().map(|polygon| polygon.iter().map(|&p| world(p)).collect())
    }

    /// Shuffles polygons into any order and orientation: some start at another corner, some run the other
    /// way, and their numbers are random.
    pub fn shuffled(mut self, dice: &mut Dice) -> Self {
        for polygon in &mut self.polygons {
            let by = dice.below(polygon.len());
            polygon.rotate_left(by);
            if dice.below(2) == 0 {
                polygon.reverse();
            }
        }
        dice.shuffle(&mut self.polygons);
        self
    }
}

/// Converts a point exactly to an input of the library.
pub fn world(p: Point) -> DVec3 {
    DVec3::from_array(p.map(|c| c as f64))
}

pub fn add(a: Point, b: Point) -> Point {
    std::array::from_fn(|i| a[i] + b[i])
}

pub fn minus(a: Point, b: Point) -> Point {
    std::array::from_fn(|i| a[i] - b[i])
}

pub fn times(k: i64, p: Point) -> Point {
    p.map(|c| k * c)
}

/// Returns a rotated point, scaled by seven so that it has integer coordinates. The rotation moves all axes.
pub fn tilt([x, y, z]: Point) -> Point {
    add(add(times(x, [2, 3, 6]), times(y, [3, -6, 2])), times(z, [6, 2, -3]))
}

/// Returns one of the 48 rotations and reflections that map the axes to the axes.
pub fn turned(p: Point, which: usize) -> Point {
    const ORDERS: [[usize; 3]; 6] =
        [[0, 1, 2], [1, 2, 0], [2, 0, 1], [0, 2, 1], [2, 1, 0], [1, 0, 2]];
    let order = ORDERS[which / 8 % 6];
    std::array::from_fn(|i| if which >> i & 1 == 1 { -p[order[i]] } else { p[order[i]] })
}

pub fn each(polygons: Vec<Vec<Point>>, go: impl Fn(Point) -> Point) -> Vec<Vec<Point>> {
    polygons.into_iter().map(|polygon| polygon.into_iter().map(&go).collect()).collect()
}

/// Returns a whole number from `low` to `high`.
pub fn between(dice: &mut Dice, low: i64, high: i64) -> i64 {
    low + dice.below((high - low + 1) as usize) as i64
}

/// Returns a point with coordinates from 0 to `n`.
pub fn point_within(dice: &mut Dice, n: i64) -> Point {
    [0; 3].map(|_| between(dice, 0, n))
}
