//! Points of the scene as the picture shows them.

use std::cmp::Ordering;

use super::cell::Cell;
use super::frame::{Image, side_at};
use super::lines::Lines;
use super::rect::Rect;
use super::sight::MARGIN;
use super::tile::Tile;
use crate::exact::{Int, PlaneId, PreparedPlane};

/// A point of the scene as the picture shows it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Spot {
    point: [f64; 3],
    pub(super) at: [f64; 2],
}

impl Spot {
    /// `None` if it is not in the picture.
    pub(super) fn new(lines: &Lines<'_>, point: [f64; 3]) -> Option<Self> {
        let image = lines.frame.image(point);
        if !image[0].sign().is_gt() {
            return None;
        }
        let [weight, x, y] = image.map(Int::to_f64);
        let spot = Self { point, at: [x / weight, y / weight] };
        let Tile { low, high } = Tile::picture(lines.frame.rays.size());
        spot.is_in(lines, &Cell::rectangle(lines, low, high)).then_some(spot)
    }

    /// A box around it.
    pub(super) fn around(&self) -> Rect {
        [self.at.map(|c| c - MARGIN), self.at.map(|c| c + MARGIN)]
    }

    /// Whether it is in a cell, or on one of its sides: exact.
    pub(super) fn is_in(&self, lines: &Lines<'_>, cell: &Cell) -> bool {
        cell.sides.iter().all(|side| {
            let line = lines.rounded(side.half);
            let value = line.at(self.at);
            let is_outside = |side_of: Ordering| side_of.is_lt() != side.half.is_negative();
            // Its coordinates are rounded three times.
            let off = 4.0 * f64::EPSILON * (self.at[0].abs() + self.at[1].abs());
            if value.abs() > line.error + line.slope * off {
                return !is_outside(value.total_cmp(&0.0));
            }
            let image: Image = lines.frame.image(self.point);
            let side = side_at(&lines.exact(side.half), &image);
            side.is_eq() || !is_outside(side)
        })
    }

    /// Whether it is further away than a face's plane.
    pub(super) fn is_behind(&self, lines: &Lines<'_>, face: u32, seen: Ordering) -> bool {
        let faces = lines.frame.faces;
        let prepared = PreparedPlane::new(faces, PlaneId::face(face));
        prepared.side_beyond(faces, &self.point) == seen.reverse()
    }
}
