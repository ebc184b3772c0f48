//! A small scene repeated: rotated copies on a grid, or on top of one another.

use super::super::super::decode;
use arbitrary::{Result, Unstructured};
use binspace::glam::DVec3;

/// The approximate number of polygons of all copies: below and above every size at which the builder changes
/// its method. Large sizes are rare, because they take long.
const SIZES: [usize; 16] =
    [1, 40, 63, 64, 65, 120, 190, 255, 256, 257, 400, 700, 1_100, 2_047, 2_100, 5_000];

/// Exact quarter turns and reflections: the image of each axis, and which axes are reversed.
#[derive(Clone, Copy, Debug)]
struct Turn {
    axes: [usize; 3],
    signs: DVec3,
}

impl Turn {
    const AXES: [[usize; 3]; 6] =
        [[0, 1, 2], [1, 2, 0], [2, 0, 1], [0, 2, 1], [2, 1, 0], [1, 0, 2]];

    /// One of the 48 symmetries of the cube.
    fn some(bytes: &mut Unstructured<'_>) -> Result<Self> {
        let axes = *bytes.choose(&Self::AXES)?;
        let reversed = bytes.int_in_range(0..=7u8)?;
        let sign = |axis: u8| if reversed >> axis & 1 == 0 { 1.0 } else { -1.0 };
        Ok(Self { axes, signs: DVec3::new(sign(0), sign(1), sign(2)) })
    }

    fn apply(self, point: DVec3) -> DVec3 {
        DVec3::from_array(self.axes.map(|axis| point[axis])) * self.signs
    }
}

/// The places of the copies: the number in a row, and the number of rows in a layer.
#[derive(Debug)]
struct Grid {
    row: usize,
    rows: usize,
    steps: [DVec3; 3],
}

impl Grid {
    fn some(bytes: &mut Unstructured<'_>) -> Result<Self> {
        let (row, rows) = (bytes.int_in_range(1..=40)?, bytes.int_in_range(1..=40)?);
        let mut steps = [DVec3::ZERO; 3];
        for step in &mut steps {
            *step = match bytes.int_in_range(0..=3u8)? {
                0 => DVec3::ZERO,
                1 => DVec3::AXES[bytes.int_in_range(0..=2usize)?] * 8.0,
                _ => halves(bytes)?,
            };
        }
        Ok(Self { row, rows, steps })
    }

    fn place(&self, copy: usize) -> DVec3 {
        let (column, row) = (copy % self.row, copy / self.row);
        [column, row % self.rows, row / self.rows]
            .into_iter()
            .zip(self.steps)
            .map(|(count, step)| step * count as f64)
            .sum()
    }
}

/// Small numbers, halves among them: copies that cross, touch, or share planes.
fn halves(bytes: &mut Unstructured<'_>) -> Result<DVec3> {
    let mut axis = || Ok(f64::from(bytes.int_in_range(-14..=14i8)?) / 2.0);
    Ok(DVec3::new(axis()?, axis()?, axis()?))
}

/// Copies of up to twelve polygons.
pub(super) fn scene(bytes: &mut Unstructured<'_>) -> Result<Vec<Vec<DVec3>>> {
    let size = *bytes.choose(&SIZES)?;
    let mut turns = Vec::new();
    for _ in 0..bytes.int_in_range(1..=4u8)? {
        turns.push(Turn::some(bytes)?);
    }
    let grid = Grid::some(bytes)?;
    let small = decode::polygons(bytes, 12)?;
    let copy = |copy: usize| {
        let (turn, place) = (turns[copy % turns.len()], grid.place(copy));
        let polygon =
            move |polygon: &Vec<DVec3>| polygon.iter().map(|&c| turn.apply(c) + place).collect();
        small.iter().map(polygon)
    };
    Ok((0..size.div_ceil(small.len().max(1))).flat_map(copy).collect())
}
