//! Rectangles over a grid, seen from above: their visible parts are known in integers.

use testkit::prelude::*;

pub(crate) type Corners = Vec<[f64; 3]>;

pub(crate) fn tree_of(polygons: &[Corners]) -> BspTree {
    let polygons = polygons.iter().map(|corners| corners.iter().copied().map(DVec3::from));
    BuildOptions::DEFAULT.with_tolerance(0.0).build(polygons.map(Vec::from_iter)).unwrap()
}

pub(crate) fn from_above(height: f64, size: [u32; 2]) -> Camera {
    let centre = DVec3::new(4.0, 4.0, 0.0);
    Camera::parallel(DVec3::NEG_Z, DVec3::Y, centre, height, size).unwrap()
}

/// A rectangle over squares of a grid of 8 by 8, level or with a slope of 1 along x.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Sheet {
    pub(crate) low: [i64; 2],
    pub(crate) high: [i64; 2],
    pub(crate) slope: i64,
    pub(crate) height: i64,
    pub(crate) is_opaque: bool,
}

impl Sheet {
    pub(crate) fn new(dice: &mut Dice) -> Self {
        let [x, y] = [(); 2].map(|()| {
            let size = 1 + dice.below(5);
            let low = dice.below(9 - size);
            [low, low + size].map(|end| end as i64)
        });
        let (low, high) = ([x[0], y[0]], [x[1], y[1]]);
        let slope = [0, 0, 1, -1][dice.below(4)];
        let height = dice.below(5) as i64 - 4 * slope;
        Self { low, high, slope, height, is_opaque: dice.below(2) == 0 }
    }

    pub(crate) fn corners(&self) -> Corners {
        let Self { low: [x0, y0], high: [x1, y1], .. } = *self;
        let corner = |[x, y]: [i64; 2]| [x as f64, y as f64, (self.slope * x + self.height) as f64];
        [[x0, y0], [x1, y0], [x1, y1], [x0, y1]].map(corner).to_vec()
    }

    /// Four times the sheet's height over the middle of half a square, if the sheet covers it.
    fn over(&self, [x, y]: [i64; 2]) -> Option<i64> {
        let is_in = |axis: usize, at: i64| 2 * self.low[axis] <= at && at < 2 * self.high[axis];
        (is_in(0, x) && is_in(1, y)).then(|| self.slope * (2 * x + 1) + 4 * self.height)
    }
}

/// The sheets over a half of a square, front to back. (Of several sheets in one plane, the last one comes
/// first.)
pub(crate) fn stack(sheets: &[Sheet], at: [i64; 2]) -> Vec<usize> {
    let over = |(i, sheet): (usize, &Sheet)| sheet.over(at).map(|height| (height, i));
    let mut stack: Vec<_> = sheets.iter().enumerate().filter_map(over).collect();
    stack.sort_by(|a, b| b.cmp(a));
    stack.into_iter().map(|(_, i)| i).collect()
}
