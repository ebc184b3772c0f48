//! The cells and polygons that may be seen through portals.

use std::collections::VecDeque;

use binspace::Frustum;
use binspace::glam::DVec3;

use super::cells::{Cells, NOISE, Portal};
use super::outline::{Outline, Plane, apart, clip, holds, hull};

/// Geometry no further than this beyond a plane that bounds the lines of sight counts as visible. It is a
/// share of the scene's extent.
///
/// Points of a source and of an opening are within 4 `NOISE` of their exact places: one each for the
/// outlines, for cutting, for the test that the plane is between them, and for parts that are not visited
/// again. A line from the source through the opening magnifies the sum of both errors up to the end of the
/// box, which is at most √3 · 1.02 / `NEAREST` times as far as the opening: 2 · 4 · 10⁻¹² · 8840 = 7.1·10⁻⁸.
pub(super) const SLACK: f64 = 1e-7;
/// Openings that are nearer to the source than this do not narrow the view, because lines through them would
/// magnify roundings too much. Too large: more is kept without need. Too small: `SLACK` has to be larger.
pub(super) const NEAREST: f64 = 2e-4;
/// The number of times that a portal's visible part may grow before all of the portal counts as visible. Too
/// small: invisible polygons are kept. Too large: crowded scenes take longer.
const GROWTHS: u32 = 24;

/// The cells and polygons that may be seen from an eye or from a cell.
#[derive(Clone, Debug)]
pub struct Seen {
    /// Whether each cell has a point that may be seen.
    pub cells: Vec<bool>,
    /// Whether each polygon has such a point.
    pub polygons: Vec<bool>,
}

impl Seen {
    fn nothing(cells: &Cells) -> Self {
        Self { cells: vec![false; cells.len()], polygons: vec![false; cells.polygons] }
    }

    /// Returns the number of polygons that may be seen.
    pub fn polygon_count(&self) -> usize {
        self.polygons.iter().filter(|&&seen| seen).count()
    }

    /// Returns the number of cells that may be seen.
    pub fn cell_count(&self) -> usize {
        self.cells.iter().filter(|&&seen| seen).count()
    }
}

impl Cells {
    /// Returns the set that an eye may see within a frustum, through portals that are within the portals
    /// before them (C. Jones 1971; D. Luebke and C. Georges 1995).
    pub fn seen_from(&self, eye: DVec3, frustum: &Frustum) -> Seen {
        self.seen_with(SLACK, NEAREST, eye, frustum)
    }

    /// Runs the search of `seen_from` with other bounds of roundings, so that tests can show the purpose of
    /// the bounds.
    pub(super) fn seen_with(
        &self,
        slack: f64,
        nearest: f64,
        eye: DVec3,
        frustum: &Frustum,
    ) -> Seen {
        let ease = slack * self.extent;
        let plane = |&(normal, offset): &(DVec3, f64)| {
            let length = normal.length();
            Plane { normal: normal / length, offset: offset / length }.eased(ease)
        };
        let bounds: Vec<Plane> = frustum.planes().iter().map(plane).collect();
        let mut seen = Seen::nothing(self);
        Sight::new(self, [slack, nearest], &[eye], &bounds).look(&self.at(eye), &mut seen);
        seen
    }

    /// Returns the set that may be seen from some point of a cell: its potentially visible set (J. Airey
    /// 1990; S. Teller and C. Séquin 1991). A line of sight leaves the cell through a portal, so it is the
    /// union of the sets that may be seen from each portal.
    pub fn seen_from_cell(&self, cell: usize) -> Seen {
        let mut seen = Seen::nothing(self);
        self.look_around(cell, &[], &mut seen);
        for &(number, side) in &self.cells[cell].portals {
            let portal = &self.portals[number];
            Sight::new(self, [SLACK, NEAREST], &portal.outline, &[])
                .look(&[portal.cells[1 - side]], &mut seen);
        }
        seen
    }

    /// Marks a cell and the polygons on its walls within some planes.
    fn look_around(&self, cell: usize, bounds: &[Plane], seen: &mut Seen) {
        seen.cells[cell] = true;
        for surface in &self.cells[cell].surfaces {
            if !seen.polygons[surface.polygon] {
                seen.polygons[surface.polygon] = !within(&surface.outline, bounds).is_empty();
            }
        }
    }
}

/// The search for the set visible from one source: an eye, or a portal.
struct Sight<'a> {
    cells: &'a Cells,
    slack: f64,
    nearest: f64,
    source: &'a [DVec3],
    bounds: &'a [Plane],
    /// The visible part of each portal, first to the back, then to the front; and the number of times that it
    /// grew.
    parts: Vec<[(Outline, u32); 2]>,
    /// Portals whose part has grown, each with the side from which they are seen.
    pending: VecDeque<(usize, usize)>,
}

impl<'a> Sight<'a> {
    fn new(
        cells: &'a Cells,
        [slack, nearest]: [f64; 2],
        source: &'a [DVec3],
        bounds: &'a [Plane],
    ) -> Self {
        let parts = vec![<[(Outline, u32); 2]>::default(); cells.portals.len()];
        Self { cells, slack, nearest, source, bounds, parts, pending: VecDeque::new() }
    }

    /// Marks everything seen, where the source is in some cells or on their walls.
    fn look(mut self, start: &[usize], seen: &mut Seen) {
        for &cell in start {
            self.pass(cell, self.bounds);
        }
        while let Some((portal, side)) = self.pending.pop_front() {
            let planes = self.planes(portal, side);
            self.pass(self.cells.portals[portal].cells[1 - side], &planes);
        }
        for &cell in start {
            self.cells.look_around(cell, self.bounds, seen);
        }
        for portal in 0..self.parts.len() {
            for side in [0, 1].into_iter().filter(|&side| !self.parts[portal][side].0.is_empty()) {
                let planes = self.planes(portal, side);
                self.cells.look_around(self.cells.portals[portal].cells[1 - side], &planes, seen);
            }
        }
    }

    /// Continues through the parts of a cell's portals that are within some planes.
    fn pass(&mut self, cell: usize, planes: &[Plane]) {
        let noise = NOISE * self.cells.extent;
        for &(number, side) in &self.cells.cells[cell].portals {
            let Portal { plane, outline, .. } = &self.cells.portals[number];
            let [low, high] = plane.range(self.source);
            // Lines of sight cross the portal from the source's side.
            if (if side == 0 { high } else { -low }) <= noise {
                continue;
            }
            let part = within(outline, planes);
            let (known, growths) = &mut self.parts[number][side];
            // The whole portal contains every part of the portal, although rounding may deny this for a thin
            // part.
            let is_whole = *growths > GROWTHS;
            if part.is_empty() || is_whole || holds(known, plane, &part, noise) {
                continue;
            }
            let has_part = !known.is_empty();
            known.extend(part);
            *known = hull(std::mem::take(known), plane);
            *growths += 1;
            if *growths > GROWTHS || known.len() < 3 {
                *known = outline.clone();
            }
            let is_pending = has_part && self.pending.contains(&(number, side));
            if !is_pending {
                self.pending.push_back((number, side));
            }
        }
    }

    /// The planes that bound the view through the visible part of a portal.
    fn planes(&self, portal: usize, side: usize) -> Vec<Plane> {
        let part = &self.parts[portal][side].0;
        let Portal { plane, .. } = &self.cells.portals[portal];
        if apart(self.source, part, plane) < self.nearest * self.cells.extent {
            return self.bounds.to_vec();
        }
        let mut planes = between(self.source, part, NOISE * self.cells.extent);
        let ease = self.slack * self.cells.extent;
        planes.iter_mut().for_each(|plane| *plane = plane.eased(ease));
        planes.extend(self.bounds);
        planes
    }
}

/// The part of an outline within all of some planes.
fn within(outline: &[DVec3], planes: &[Plane]) -> Outline {
    let mut part = outline.to_vec();
    for plane in planes {
        if plane.range(&part)[0] < 0.0 {
            part = clip(&part, plane);
        }
        if part.is_empty() {
            break;
        }
    }
    part
}

/// Planes with a convex source behind and a convex opening in front. Each goes through an edge of one and a
/// corner of the other. Behind the opening, lines from the source through it stay in front of these planes.
fn between(source: &[DVec3], opening: &[DVec3], noise: f64) -> Vec<Plane> {
    let mut planes: Vec<Plane> = Vec::new();
    let mut add = |edge: [DVec3; 2], corner: DVec3| {
        let normal = (edge[1] - edge[0]).cross(corner - edge[0]);
        let size = (edge[1] - edge[0]).length() * (corner - edge[0]).length();
        // Three points that are almost collinear give no plane.
        if normal.length() < 1e-6 * size || size == 0.0 {
            return;
        }
        let plane = Plane::new(normal.normalize(), corner);
        for plane in [plane, plane.flipped()] {
            let [[_, source_high], [low, high]] = [source, opening].map(|of| plane.range(of));
            if source_high <= noise && low >= -noise && high > noise {
                planes.push(plane);
            }
        }
    };
    let edges = |of: &[DVec3]| {
        let pairs = of.iter().copied().zip(of.iter().copied().cycle().skip(1));
        pairs.map(|(a, b)| [a, b]).collect::<Vec<_>>()
    };
    for edge in edges(opening) {
        source.iter().for_each(|&corner| add(edge, corner));
    }
    for edge in edges(source).into_iter().filter(|_| source.len() > 1) {
        opening.iter().for_each(|&corner| add(edge, corner));
    }
    planes
}
