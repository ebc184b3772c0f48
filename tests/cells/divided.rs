//! A scene and its cells.

use binspace::glam::DVec3;
use binspace::{BspTree, BuildOptions, Error, Extent, Partition};

use crate::support::dice::Dice;
use crate::support::shapes::Corners;

/// A scene, divided.
pub(crate) struct Divided {
    pub(crate) polygons: Vec<Corners>,
    pub(crate) partition: Partition,
    pub(crate) cells: Vec<Cell>,
}

/// A tree, and the numbers in the scene of the polygons that it was given.
pub(crate) struct Cell {
    pub(crate) tree: BspTree,
    pub(crate) given: Vec<usize>,
}

pub(crate) fn extent(polygons: &[Corners]) -> Extent {
    let mut extent = Extent::default();
    polygons.iter().for_each(|polygon| extent.include(polygon));
    extent
}

impl Divided {
    /// Samples are all corners.
    pub(crate) fn new(
        polygons: Vec<Corners>,
        options: BuildOptions,
        cells: usize,
    ) -> Result<Self, Error> {
        let samples: Vec<DVec3> = polygons.iter().flatten().copied().collect();
        Self::with_samples(polygons, options, samples, cells)
    }

    pub(crate) fn with_samples(
        polygons: Vec<Corners>,
        options: BuildOptions,
        samples: Vec<DVec3>,
        cells: usize,
    ) -> Result<Self, Error> {
        let partition = options.partition(&extent(&polygons), samples, cells)?;
        assert_eq!(partition.cells(), cells);
        let mut given = vec![Vec::new(); cells];
        let mut reached = vec![usize::MAX];
        for (number, polygon) in polygons.iter().enumerate() {
            partition.reached_by(polygon, &mut reached);
            assert!(reached.is_sorted_by(|a, b| a < b));
            reached.iter().for_each(|&cell| given[cell].push(number));
        }
        let cell = |(cell, given): (usize, Vec<usize>)| {
            let own = given.iter().map(|&number| &polygons[number]);
            Ok(Cell { tree: options.build_cell(&partition, cell, own)?, given })
        };
        let cells = given.into_iter().enumerate().map(cell).collect::<Result<_, Error>>()?;
        Ok(Self { polygons, partition, cells })
    }

    pub(crate) fn fragments(&self) -> usize {
        self.cells.iter().map(|cell| cell.tree.len()).sum()
    }
}

impl Cell {
    /// The number in the scene of the polygon of a fragment.
    pub(crate) fn polygon(&self, fragment: u32) -> usize {
        self.given[self.tree.fragment(fragment).polygon()]
    }
}

/// Triangles at random with whole corners from −n to n.
pub(crate) fn triangles(dice: &mut Dice, count: usize, n: u32) -> Vec<Corners> {
    let mut corner = || DVec3::from_array([0; 3].map(|_| dice.around_zero(n)));
    (0..count).map(|_| vec![corner(), corner(), corner()]).collect()
}

/// Squares in planes x, y or z = whole numbers, side by side and one over the other: all of them lie in
/// planes of cells sooner or later.
pub(crate) fn tiles(dice: &mut Dice, count: usize) -> Vec<Corners> {
    let tile = |_| {
        let axis = dice.below(3);
        let at = [0; 3].map(|_| dice.around_zero(3));
        let side = 1.0 + dice.below(2) as f64;
        let corner = |[u, v]: [f64; 2]| {
            let mut corner = DVec3::from_array(at);
            corner[(axis + 1) % 3] += u * side;
            corner[(axis + 2) % 3] += v * side;
            corner
        };
        [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]].map(corner).to_vec()
    };
    (0..count).map(tile).collect()
}

/// Stars that are not convex, so that they are triangulated, turned any way.
pub(crate) fn stars(dice: &mut Dice, count: usize) -> Vec<Corners> {
    let star = |_| {
        let mut some = || DVec3::from_array([0; 3].map(|_| dice.around_zero(8)));
        let (middle, u, v) = (some() * 2.0, some(), some());
        let around = [[4, 0], [1, 1], [0, 4], [-1, 1], [-4, 0], [-1, -1], [0, -4], [1, -1]];
        around.map(|[a, b]| middle + u * f64::from(a) + v * f64::from(b)).to_vec()
    };
    (0..count).map(star).collect()
}
