//! A scene and its cells.

use binspace::glam::DVec3;
use binspace::partition::{Extent, Partition};
use binspace::{BspTree, BuildOptions, Error};

/// A scene divided into cells.
pub struct Divided {
    pub polygons: Vec<Vec<DVec3>>,
    pub partition: Partition,
    pub cells: Vec<Cell>,
}

/// The tree of a cell, and the numbers of its polygons in the scene.
pub struct Cell {
    pub tree: BspTree,
    pub given: Vec<usize>,
}

pub fn extent(polygons: &[Vec<DVec3>]) -> Extent {
    let mut extent = Extent::default();
    polygons.iter().for_each(|polygon| extent.include(polygon));
    extent
}

impl Divided {
    /// Divides a scene into cells. All corners are samples.
    pub fn new(
        polygons: Vec<Vec<DVec3>>,
        options: BuildOptions,
        cells: usize,
    ) -> Result<Self, Error> {
        let samples: Vec<DVec3> = polygons.iter().flatten().copied().collect();
        Self::with_samples(polygons, options, samples, cells)
    }

    pub fn with_samples(
        polygons: Vec<Vec<DVec3>>,
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

    pub fn fragments(&self) -> usize {
        self.cells.iter().map(|cell| cell.tree.len()).sum()
    }
}

impl Cell {
    /// Returns the number in the scene of the polygon of a fragment.
    pub fn polygon(&self, fragment: u32) -> usize {
        self.given[self.tree.fragment(fragment).polygon()]
    }
}
