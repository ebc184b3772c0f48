//! What an overlay was given without area: whole, before any plane cut it.

use super::Overlay;
use crate::error::{Error, InputFault};
use crate::tree::BspTree;

/// A segment of a line.
#[derive(Clone, Copy, Debug)]
pub(crate) struct GivenSegment {
    pub(crate) line: usize,
    /// Its number in its line.
    pub(crate) number: usize,
    /// Its ends on the grid.
    pub(crate) ends: [[f64; 3]; 2],
}

impl Overlay {
    /// An error if the overlay is not one for the tree, or has polygons.
    pub(crate) fn expect_no_polygons(&self, tree: &BspTree) -> Result<(), Error> {
        self.expect(tree)?;
        if self.base.faces < self.first_thin() {
            let number = self.faces.polygon(self.base.faces as u32) - self.base.polygons;
            return Err(InputFault::InOverlay.of_polygon(number));
        }
        Ok(())
    }

    /// All segments of its lines, in input order.
    pub(crate) fn given_segments(&self) -> impl ExactSizeIterator<Item = GivenSegment> {
        let first = self.first_thin();
        (0..self.faces.thin.segments).map(move |i| {
            let face = (first + i) as u32;
            let corners = self.faces.corners(face);
            let (line, number) = (self.faces.polygon(face), self.segments[i] as usize);
            GivenSegment { line, number, ends: [corners[0], corners[1]] }
        })
    }

    /// All its points on the grid, in input order.
    pub(crate) fn given_points(&self) -> impl ExactSizeIterator<Item = [f64; 3]> {
        let first = self.faces.len() - self.faces.thin.points;
        (0..self.faces.thin.points).map(move |i| self.faces.corners((first + i) as u32)[0])
    }

    /// The first face that has no area.
    fn first_thin(&self) -> usize {
        self.faces.len() - self.faces.thin.segments - self.faces.thin.points
    }
}
