//! Outlines of polygons in the plane, with integer corners. Some are simple by construction.

use super::super::super::dice::Dice;
use super::maze;
use arbitrary::{Result, Unstructured};

pub(super) type Corner = [i32; 2];

/// A closed outline.
#[derive(Clone, Debug)]
pub(super) struct Outline {
    pub(super) corners: Vec<Corner>,
    /// Whether the outline is known not to touch or cross itself, except for consecutive equal corners.
    pub(super) is_simple: bool,
}

/// The approximate number of corners. Large ones are rare.
const SIZES: [usize; 12] = [3, 4, 5, 6, 8, 12, 20, 40, 100, 300, 1_000, 3_000];
/// The largest number of corners of an outline that crosses itself: the number of crossings is quadratic.
const MOST_CROSSING: usize = 150;
/// Larger outlines get no more corners.
const MOST: usize = 6_000;

/// The shape of an outline.
#[derive(Clone, Copy, Debug)]
enum Shape {
    Spiral,
    Coil,
    Comb,
    Star,
    Maze,
    Walk,
    Steps,
    Pentagram,
    Weave,
    Again,
}

impl Shape {
    const ALL: [Self; 10] = [
        Self::Spiral,
        Self::Coil,
        Self::Comb,
        Self::Star,
        Self::Maze,
        Self::Walk,
        Self::Steps,
        Self::Pentagram,
        Self::Weave,
        Self::Again,
    ];

    fn outline(self, size: usize, dice: &mut Dice) -> Outline {
        let simple = |corners| Outline { corners, is_simple: true };
        let few = size.min(MOST_CROSSING);
        let corners = match self {
            Self::Spiral => return simple(spiral(size)),
            Self::Coil => return simple(coil(size)),
            Self::Comb => return simple(comb(size, dice)),
            Self::Star => return simple(star(size, dice)),
            Self::Maze => return simple(maze::outline(size, dice)),
            Self::Walk => walk(few, dice),
            Self::Steps => steps(few, dice),
            Self::Pentagram => pentagram(few, dice),
            Self::Weave => weave(few),
            Self::Again => (0..size).map(|k| [[0, 0], [2, 0], [2, 2], [0, 2]][k % 4]).collect(),
        };
        Outline { corners, is_simple: false }
    }
}

/// Decodes an outline: a shape with changes.
pub(super) fn some(bytes: &mut Unstructured<'_>) -> Result<Outline> {
    let (shape, size) = (*bytes.choose(&Shape::ALL)?, *bytes.choose(&SIZES)?);
    let size = size + bytes.int_in_range(0..=size / 2)?;
    let mut dice = Dice(u64::from(bytes.arbitrary::<u16>()?));
    let mut outline = shape.outline(size, &mut dice);
    for _ in 0..bytes.int_in_range(0..=2u8)? {
        change(&mut outline, bytes.int_in_range(0..=5u8)?, &mut dice);
    }
    Ok(outline)
}

fn change(outline: &mut Outline, how: u8, dice: &mut Dice) {
    let corners = &mut outline.corners;
    let at = dice.below(corners.len());
    match how {
        0 => corners.reverse(),
        1 => corners.rotate_left(at),
        2 if corners.len() < MOST => {
            let times = 2 + dice.below(3);
            *corners = corners.iter().flat_map(|&corner| vec![corner; times]).collect();
        }
        3 if corners.len() < MOST => subdivide(corners),
        4 => {
            // Out and back.
            let aim = corners[dice.below(corners.len())];
            let from = corners[at];
            corners.splice(at..at, [from, aim]);
            outline.is_simple = false;
        }
        _ => {
            corners[at][dice.below(2)] += dice.around_zero(3) as i32;
            outline.is_simple = false;
        }
    }
}

/// Puts a corner in the middle of each edge.
fn subdivide(corners: &mut Vec<Corner>) {
    let n = corners.len();
    let twice = |k: usize| {
        let ([x, y], [u, v]) = (corners[k], corners[(k + 1) % n]);
        [[2 * x, 2 * y], [x + u, y + v]]
    };
    *corners = (0..n).flat_map(twice).collect();
}

/// A spiral corridor with right angles.
fn spiral(size: usize) -> Vec<Corner> {
    let arms = (size / 2).max(2) as i32;
    let inner = |k: i32| {
        let out = 2 * (k / 4 + 1);
        match k % 4 {
            0 => [out, if k == 0 { 0 } else { 2 - out }],
            1 => [out, out],
            2 => [-out, out],
            _ => [-out, -out],
        }
    };
    let outer = |k: i32| {
        let [x, y] = inner(k);
        match k % 4 {
            0 => [x + 1, y - 1],
            1 => [x + 1, y + 1],
            2 => [x - 1, y + 1],
            _ => [x - 1, y - 1],
        }
    };
    let start = [[0, -1], [0, 0]];
    start.into_iter().chain((0..arms).map(inner)).chain((0..arms).rev().map(outer)).collect()
}

/// A spiral corridor with sixteen corners per turn.
fn coil(size: usize) -> Vec<Corner> {
    let arms = (size / 2).max(3);
    let at = |k: usize, more: f64| {
        let angle = std::f64::consts::TAU * (k % 16) as f64 / 16.0;
        let radius = 64.0 * (k + 16) as f64 + more;
        [(angle.cos() * radius).round() as i32, (angle.sin() * radius).round() as i32]
    };
    (0..arms).map(|k| at(k, 0.0)).chain((0..arms).rev().map(|k| at(k, 500.0))).collect()
}

/// Teeth of any length on both sides of a line.
fn comb(size: usize, dice: &mut Dice) -> Vec<Corner> {
    let teeth = (size / 2).max(2) as i32;
    let long = 1 + dice.below(1000);
    let mut tooth = |k: i32, side: i32| [k, side * (1 + (k % 2) * dice.below(long) as i32)];
    let above: Vec<Corner> = (0..teeth).map(|k| tooth(k, 1)).collect();
    let below: Vec<Corner> = (0..teeth).map(|k| tooth(k, -1)).collect();
    below.into_iter().chain(above.into_iter().rev()).collect()
}

/// Corners around a centre that sees all corners.
fn star(size: usize, dice: &mut Dice) -> Vec<Corner> {
    let n = size.max(5);
    let ray = |k: usize| {
        let angle = std::f64::consts::TAU * k as f64 / n as f64;
        let radius = (10_000 + dice.below(90_000)) as f64;
        [(angle.cos() * radius).round() as i32, (angle.sin() * radius).round() as i32]
    };
    (0..n).map(ray).collect()
}

/// Any corners, on a large grid, or on a grid so small that they coincide.
fn walk(size: usize, dice: &mut Dice) -> Vec<Corner> {
    let across = [2, 4, 8, 1000][dice.below(4)];
    (0..size).map(|_| [dice.below(across) as i32, dice.below(across) as i32]).collect()
}

/// Steps of one along the axes.
fn steps(size: usize, dice: &mut Dice) -> Vec<Corner> {
    let mut at = [0, 0];
    let step = |_| {
        at[dice.below(2)] += 2 * dice.below(2) as i32 - 1;
        at
    };
    (0..size).map(step).collect()
}

/// An outline that winds several times around a centre.
fn pentagram(size: usize, dice: &mut Dice) -> Vec<Corner> {
    let n = size.max(5);
    let times = 2 + dice.below(n - 2);
    let ray = |k: usize| {
        let angle = std::f64::consts::TAU * (k * times % n) as f64 / n as f64;
        [(angle.cos() * 1e6).round() as i32, (angle.sin() * 1e6).round() as i32]
    };
    (0..n).map(ray).collect()
}

/// A zigzag line out, and another back that crosses the first.
fn weave(size: usize) -> Vec<Corner> {
    let there = (size / 2).max(2) as i32;
    let back = (0..there).rev().map(|k| [k, 1 - k % 2]);
    (0..there).map(|k| [k, k % 2]).chain(back).collect()
}
