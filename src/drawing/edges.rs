//! Edges of polygons as they show: visible runs and hidden ones.

use std::cmp::Ordering;

use glam::DVec3;
use smallvec::SmallVec;

use super::map::VisibilityMap;
use super::table::Table;
use super::visible::Visible;
use crate::Error;
use crate::exact::{Faces, PlaneId};
use crate::memory::reserve;

/// What a line is in a drawing of lines.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum EdgeKind {
    /// No other polygon has the same edge, or several do.
    Border,
    /// One polygon at the edge is seen from its front, the other from behind, or one of them edge-on:
    /// a body ends there, as seen from the eye.
    Silhouette,
    /// Two polygons meet at this angle, in radians: 0 where they lie in one plane, π where one is folded
    /// back on the other.
    Crease(f64),
    /// The polygon and another one, of this number, go through one another there.
    Crossing(usize),
}

/// A part of an edge or of a crossing, visible or hidden from one end to the other.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct EdgeRun {
    /// A polygon that has the edge, and shows a side to the camera.
    pub polygon: usize,
    /// The number, within that polygon, of the corner where the edge begins; `None` of a crossing.
    pub edge: Option<u32>,
    /// What the line is.
    pub kind: EdgeKind,
    /// Where the run begins and ends in the picture, in pixels from the centre of the first one.
    pub ends: [[f64; 2]; 2],
    /// Whether it shows.
    pub is_visible: bool,
    /// How many polygons lie in front of it; `None` if they were not counted. Of a visible run that is 0: what it
    /// is seen through does not count.
    pub layers: Option<u32>,
}

/// Runs and gaps shorter than this, in pixels, are what rounding has left.
pub(super) const SHORTEST: f64 = 1e-6;

/// The number of an edge, by a face and which of its edges it is.
type Numbers = Table<(u32, u32), u32>;

/// An edge, by the faces that have it.
#[derive(Debug, Default)]
struct Shared {
    /// Faces, and which of their edges it is.
    faces: SmallVec<[(u32, u32); 2]>,
    /// Where it shows: from one end to the other, in pixels from its beginning in the picture.
    visible: Vec<[f64; 2]>,
}

impl VisibilityMap<'_> {
    /// All edges of polygons that show a side to the camera, as far as they are in the picture, in runs
    /// that are visible or hidden. Runs of one polygon follow one another.
    ///
    /// What is visible is read off the map, so it is as exact: only the ends of runs are rounded. An edge
    /// is hidden by what lies before it, not by the polygons that have it. Polygons have an edge in common
    /// if both of its corners are the same. Edges inside a polygon, which triangulation made, are none;
    /// nor are edges of polygons that are all seen exactly edge-on. Where polygons go through one another,
    /// [`crossings`](Self::crossings) tells.
    ///
    /// O(n log n) for n edges and cells. (What is hidden, and how to tell for lines: A. Appel, "The notion
    /// of quantitative invisibility and the machine rendering of solids", 1967.)
    ///
    /// # Errors
    ///
    /// If there is not enough memory.
    pub fn edges(&self) -> Result<Vec<EdgeRun>, Error> {
        let faces = self.stock.frame.faces;
        let (mut all, numbers) = shared(faces, |face| self.stock.opacity(face) > 0.0)?;
        let starts = self.starts(&all);
        self.collect(&mut all, &numbers, &starts)?;
        let mut views = Views { map: self, sides: Table::default() };
        let mut runs = Vec::new();
        for (edge, start) in all.iter_mut().zip(&starts) {
            let Some(start) = start else { continue };
            views.runs(edge, start, &mut runs)?;
        }
        runs.sort_by_key(|run| (run.polygon, run.edge));
        Ok(runs)
    }

    /// Where each edge begins in the picture, its direction, and its length; `None` if it is not in it.
    fn starts(&self, all: &[Shared]) -> Vec<Option<Span>> {
        let frame = &self.stock.frame;
        let span = |edge: &Shared| {
            let &(face, k) = edge.faces.first()?;
            let ends = ends_of(frame.faces, face, k).map(|corner| frame.rays.project(corner));
            Span::of(ends, self.size())
        };
        all.iter().map(span).collect()
    }

    /// Adds to each edge where it shows.
    fn collect(
        &self,
        all: &mut [Shared],
        numbers: &Numbers,
        starts: &[Option<Span>],
    ) -> Result<(), Error> {
        let stock = &self.stock;
        // Which edges of a face lie on a line.
        let mut edges: Table<(u32, u64), SmallVec<[u32; 1]>> = Table::default();
        let faces = stock.frame.faces;
        for face in 0..faces.len() as u32 {
            // Faces of polygons that do not show have no lines.
            let corners = 0..faces.corners(face).len() as u32;
            for (k, half) in corners.zip(self.rims.known_outline(face)) {
                if numbers.contains_key(&(face, k)) {
                    edges.try_reserve(1).map_err(|_| Error::out_of_memory())?;
                    edges.entry((face, half.line())).or_default().push(k);
                }
            }
        }
        for Visible { item, cell } in self.leaves.iter().flat_map(|leaf| &leaf.cells) {
            let face = stock.face(*item);
            for (i, side) in cell.sides.iter().enumerate() {
                let end = cell.sides[if i + 1 == cell.sides.len() { 0 } else { i + 1 }].start;
                for &k in edges.get(&(face, side.half.line())).into_iter().flatten() {
                    let Some(&number) = numbers.get(&(face, k)) else { continue };
                    let Some(span) = &starts[number as usize] else { continue };
                    let [a, b] = [side.start.at, end.at].map(|point| span.place(point));
                    let visible = &mut all[number as usize].visible;
                    reserve(visible, 1)?;
                    visible.push([a.min(b), a.max(b)]);
                }
            }
        }
        Ok(())
    }
}

/// All edges of faces that are drawn, and the number of each by face and edge of it.
fn shared(faces: &Faces, is_drawn: impl Fn(u32) -> bool) -> Result<(Vec<Shared>, Numbers), Error> {
    let mut points: Table<[u64; 3], u32> = Table::default();
    let mut point = |corner: usize| -> Result<u32, Error> {
        let place = faces.given_corner(corner as u32).map(|c| (c + 0.0).to_bits());
        points.try_reserve(1).map_err(|_| Error::out_of_memory())?;
        let next = points.len() as u32;
        Ok(*points.entry(place).or_insert(next))
    };
    let mut by_points: Table<[u32; 2], u32> = Table::default();
    let mut numbers = Numbers::default();
    let mut all: Vec<Shared> = Vec::new();
    for face in (0..faces.len() as u32).filter(|&face| is_drawn(face)) {
        let range = faces.corner_range(face);
        for k in 0..faces.reach(face).saturating_sub(usize::from(faces.reach(face) < 3)) {
            if faces.outline_edge(face, k as u32).is_none() {
                continue;
            }
            let next = if k + 1 == range.len() { range.start } else { range.start + k + 1 };
            let [a, b] = [point(range.start + k)?, point(next)?];
            for table in [by_points.try_reserve(1), numbers.try_reserve(1)] {
                table.map_err(|_| Error::out_of_memory())?;
            }
            let number = *by_points.entry([a.min(b), a.max(b)]).or_insert(all.len() as u32);
            if number as usize == all.len() {
                reserve(&mut all, 1)?;
                all.push(Shared::default());
            }
            all[number as usize].faces.push((face, k as u32));
            numbers.insert((face, k as u32), number);
        }
    }
    Ok((all, numbers))
}

pub(super) fn ends_of(faces: &Faces, face: u32, k: u32) -> [[f64; 3]; 2] {
    let corners = faces.corners(face);
    let next = if k as usize + 1 == corners.len() { 0 } else { k as usize + 1 };
    [corners[k as usize], corners[next]]
}

/// An edge in the picture.
#[derive(Clone, Copy, Debug)]
struct Span {
    from: [f64; 2],
    /// Of length 1.
    direction: [f64; 2],
    length: f64,
}

impl Span {
    /// The part in the picture of the line between two points in homogeneous coordinates.
    fn of(ends: [[f64; 3]; 2], size: [u32; 2]) -> Option<Self> {
        let [width, height] = size.map(f64::from);
        // What is positive in the picture, and ahead of the eye.
        let inside = |[x, y, z]: [f64; 3]| {
            [z, x + 0.5 * z, (width - 0.5) * z - x, y + 0.5 * z, (height - 0.5) * z - y]
        };
        let (mut first, mut last) = (0.0f64, 1.0f64);
        for (a, b) in inside(ends[0]).into_iter().zip(inside(ends[1])) {
            if a <= 0.0 && b <= 0.0 {
                return None;
            }
            let share = a / (a - b);
            if a < 0.0 {
                first = first.max(share);
            } else if b < 0.0 {
                last = last.min(share);
            }
        }
        let point = |share: f64| {
            let at = |i: usize| ends[0][i] + (ends[1][i] - ends[0][i]) * share;
            [at(0) / at(2), at(1) / at(2)]
        };
        let [from, to] = [point(first), point(last)];
        let way = [to[0] - from[0], to[1] - from[1]];
        let length = way[0].hypot(way[1]);
        if first > last || !length.is_finite() || length < SHORTEST {
            return None;
        }
        Some(Self { from, direction: way.map(|c| c / length), length })
    }

    /// How far along a point is.
    fn place(&self, point: [f64; 2]) -> f64 {
        let along = |i: usize| (point[i] - self.from[i]) * self.direction[i];
        (along(0) + along(1)).clamp(0.0, self.length)
    }

    fn at(&self, place: f64) -> [f64; 2] {
        [0, 1].map(|i: usize| self.from[i] + self.direction[i] * place)
    }
}

/// From which sides faces are seen.
struct Views<'m> {
    map: &'m VisibilityMap<'m>,
    sides: Table<u32, Ordering>,
}

impl Views<'_> {
    fn side(&mut self, face: u32) -> Ordering {
        let frame = &self.map.stock.frame;
        *self.sides.entry(face).or_insert_with(|| frame.seen_side(face))
    }

    /// The runs of an edge, unless no polygon shows a side there.
    fn runs(
        &mut self,
        edge: &mut Shared,
        span: &Span,
        runs: &mut Vec<EdgeRun>,
    ) -> Result<(), Error> {
        let fronts_only = self.map.stock.frame.rays.is_front_only();
        let sides: SmallVec<[Ordering; 2]> =
            edge.faces.iter().map(|&(face, _)| self.side(face)).collect();
        let shows = |side: &Ordering| side.is_gt() || side.is_lt() && !fronts_only;
        let fronts = sides.iter().position(|side| side.is_gt());
        let Some(owner) = fronts.or_else(|| sides.iter().position(shows)) else { return Ok(()) };
        let faces = self.map.stock.frame.faces;
        let (face, k) = edge.faces[owner];
        let kind = kind(faces, edge, &sides);
        let polygon = faces.polygon(face);
        let number = Some(faces.outline_edge(face, k).unwrap_or(k));
        let mut add = |from: f64, to: f64, is_visible: bool| {
            if to - from < SHORTEST {
                return Ok(());
            }
            let ends = [span.at(from), span.at(to)];
            reserve(runs, 1)?;
            runs.push(EdgeRun { polygon, edge: number, kind, ends, is_visible, layers: None });
            Ok::<(), Error>(())
        };
        edge.visible.sort_unstable_by(|a, b| a[0].total_cmp(&b[0]));
        let mut done = 0.0;
        let mut parts = edge.visible.iter().copied().peekable();
        while let Some([from, mut to]) = parts.next() {
            while let Some(next) = parts.next_if(|next| next[0] <= to + SHORTEST) {
                to = to.max(next[1]);
            }
            add(done, from, false)?;
            add(from, to, true)?;
            done = to;
        }
        add(done, span.length, false)
    }
}

/// What an edge is, by its faces and the sides that they show.
fn kind(faces: &Faces, edge: &Shared, sides: &[Ordering]) -> EdgeKind {
    let &[(one, k), (other, l)] = &edge.faces[..] else { return EdgeKind::Border };
    let from = |face: u32, k: u32| faces.given_corner(faces.corner_range(face).start as u32 + k);
    // Where two polygons have their fronts on one side, they run along the edge in opposite ways.
    let is_turned = from(one, k) == from(other, l);
    let second = if is_turned { sides[1].reverse() } else { sides[1] };
    if sides[0] != second || sides[0].is_eq() {
        return EdgeKind::Silhouette;
    }
    let normal = |face: u32| {
        let normal = faces.plane(PlaneId::face(face)).normal_f64();
        (normal / normal.abs().max_element()).normalize_or_zero()
    };
    let (a, b): (DVec3, DVec3) = (normal(one), normal(other));
    let b = if is_turned { -b } else { b };
    EdgeKind::Crease(a.cross(b).length().atan2(a.dot(b)))
}
