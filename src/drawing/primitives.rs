//! The primitives of a picture: pieces of faces, front to back, and the lines that bound the pieces.

use std::cmp::Ordering;

use smallvec::SmallVec;

use super::cell::{Cell, NOWHERE, Rect, common, is_empty, is_within};
use super::lines::{HalfPlane, LineTable, ViewFrame};
use super::map::finish_item;
use super::quadtree::{Across, LINES, Tile};
use crate::error::{Error, Kind};
use crate::exact::PlaneId;
use crate::memory::place;
use crate::parallel_map;
use crate::progress::Watch;
use crate::raster::{Projected, RayOrigin, Rays, Sheet, normal_of};
use crate::tree::{BspTree, Fragment};

/// A piece of a face that may be visible.
#[derive(Clone, Copy, Debug)]
pub(super) struct Item {
    pub(super) face: u32,
    /// The number of the fragment in the tree.
    pub(super) fragment: u32,
    /// The bounding box of the item's part in the picture.
    pub(super) around: Rect,
    /// The range of the half-planes that bound the item.
    halves: [u32; 2],
    /// The previous item of the same face; [`NONE`] for the face's first item.
    before: u32,
}

/// The number that stands for no item, or for no face.
const NONE: u32 = u32::MAX;

/// The view of a face from the camera.
#[derive(Clone, Copy, Debug)]
pub(super) struct View {
    /// The bounding box of the face's part in the picture; empty if no part is in the picture.
    pub(super) around: Rect,
    /// The side of the face's plane that the rays come from: `Greater` is the front, `Equal` if the rays are
    /// parallel to the plane.
    pub(super) side: Ordering,
    /// Whether the face hides items behind it.
    pub(super) is_opaque: bool,
    /// Whether the face's edges in the picture go through the given corners.
    pub(super) is_as_given: bool,
    /// The last item of the face; [`NONE`] for a face without items.
    last: u32,
    /// The range of the half-planes that bound the face.
    halves: [u32; 2],
}

/// All pieces that may be visible, front to back, and the lines that bound the pieces.
#[derive(Debug)]
pub(super) struct Primitives<'t> {
    tree: &'t BspTree,
    pub(super) lines: LineTable<'t>,
    /// The half-planes that bound faces and items, one list after another.
    halves: Vec<HalfPlane>,
    pub(super) items: Vec<Item>,
    /// The views of all faces, by their numbers.
    pub(super) views: Vec<View>,
    /// The face on the other side of each shared edge, by the corner where the edge begins; [`NONE`] for other
    /// edges.
    neighbours: Vec<u32>,
    /// The opacity of each polygon; empty if all polygons are opaque.
    opacities: Vec<f64>,
}

/// The number of faces or pieces in one job of a thread.
const SHARE: usize = 1024;
/// Faces and cells with more corners than this count one unit of work per corner.
pub(super) const FEW_CORNERS: usize = 32;
/// A face whose corners were moved is drawn with the moved corners if it has more corners than this, because
/// the test for given corners takes quadratic time. Too small: cracks beside faces of many corners. Too
/// large: more time.
const FEW_CORNERS_AS_GIVEN: usize = 8;
/// The cost of one piece, in pieces that a build examines.
const LOOKED: usize = 16;

impl<'t> Primitives<'t> {
    /// The pieces of a tree that rays may meet, except pieces of polygons with opacity 0. Without opacities,
    /// all polygons are opaque. Counts as one phase of the progress.
    pub(super) fn new(
        tree: &'t BspTree,
        rays: Rays,
        opacities: Vec<f64>,
        watch: &Watch<'_>,
    ) -> Result<Self, Error> {
        if tree.is_of_cell() {
            return Err(Kind::OfCell.error());
        }
        let faces = tree.faces();
        let frame = ViewFrame { rays, faces };
        let mut order = Vec::new();
        tree.order(frame.rays.viewpoint()).front_to_back().write_into(&mut order);
        let lines = LineTable::new(frame, watch)?;
        let mut primitives = Self {
            tree,
            lines,
            halves: vec![],
            items: vec![],
            views: vec![],
            neighbours: vec![],
            opacities,
        };
        let LineTable { frame: ViewFrame { rays, .. }, adjacency, .. } = &primitives.lines;
        let points = adjacency.points();
        let all: Vec<u32> = (0..points.len().max(faces.len()) as u32).collect();
        let project = |point: u32| Some(rays.projected(points[point as usize]));
        let projected = shared(&all[..points.len()], project, watch)?;
        let all = &all[..faces.len()];
        let view = |face: u32| Some(primitives.view(face, &projected));
        primitives.views = shared(all, view, watch)?;
        let item = |index: u32| primitives.item(&tree.fragment(index));
        primitives.items = shared(&order, item, watch)?;
        for (number, item) in (0..).zip(&mut primitives.items) {
            let last = &mut primitives.views[item.face as usize].last;
            item.before = std::mem::replace(last, number);
        }
        primitives.add_halves(watch)?;
        primitives.neighbours = primitives.neighbours(watch)?;
        Ok(primitives)
    }

    /// The face on the other side of each shared edge. Exactly two faces have such an edge. Both are opaque, may
    /// be visible, lie on opposite sides of the edge in the picture, and end where the edge ends.
    fn neighbours(&self, watch: &Watch<'_>) -> Result<Vec<u32>, Error> {
        let LineTable { ref frame, ref adjacency, .. } = self.lines;
        let faces = frame.faces;
        watch.work(faces.corner_count())?;
        // For each edge, the first two faces that have it, each with the corner where the edge begins.
        let mut owners = vec![[[NONE; 2]; 2]; adjacency.edge_count()];
        let mut neighbours = vec![NONE; faces.corner_count()];
        for face in 0..faces.len() as u32 {
            for corner in faces.corner_range(face) {
                let corner = corner as u32;
                let [first, second] = &mut owners[adjacency.edge(corner) as usize];
                if first[0] == NONE {
                    *first = [face, corner];
                } else if second[0] == NONE {
                    *second = [face, corner];
                    if self.are_beside([*first, *second]) {
                        neighbours[first[1] as usize] = face;
                        neighbours[corner as usize] = first[0];
                    }
                } else {
                    neighbours[first[1] as usize] = NONE;
                    neighbours[second[1] as usize] = NONE;
                }
            }
        }
        Ok(neighbours)
    }

    /// Whether two faces lie beside each other in the picture, on opposite sides of an edge. Each face comes with
    /// the corner where the edge begins.
    fn are_beside(&self, sides: [[u32; 2]; 2]) -> bool {
        let [one, other] = sides.map(|[face, corner]| {
            let is_bounded = self.views[face as usize].is_opaque && self.is_bounded_in_order(face);
            let start = self.lines.frame.faces.corner_range(face).start;
            let half = self.outline(face).get(corner as usize - start);
            half.filter(|_| is_bounded).copied()
        });
        one.is_some() && sides[0][0] != sides[1][0] && one == other.map(|half| half.flipped(true))
    }

    /// The face on the other side of a face's edge `k`, if the edge is shared.
    pub(super) fn neighbour(&self, face: u32, k: u32) -> Option<u32> {
        let start = self.lines.frame.faces.corner_range(face).start;
        let neighbour = self.neighbours[start + k as usize];
        (neighbour != NONE).then_some(neighbour)
    }

    /// A box around the part of a face's edge `k` that is in the picture; `None` if no part is in the picture.
    pub(super) fn around_edge(&self, face: u32, k: u32) -> Option<Rect> {
        let faces = self.lines.frame.faces;
        let [given, moved] = [faces.given_ends(face, k), faces.ends(face, k)];
        self.around(&[given, moved].concat())
    }

    /// The items of a face, the last one first.
    pub(super) fn items_of(&self, face: u32) -> impl Iterator<Item = u32> {
        let item = |item: u32| (item != NONE).then_some(item);
        std::iter::successors(item(self.views[face as usize].last), move |&last| {
            item(self.items[last as usize].before)
        })
    }

    /// Whether an item is a face that was not cut.
    pub(super) fn is_whole(&self, item: u32) -> bool {
        let Item { face, halves, .. } = self.items[item as usize];
        halves == self.views[face as usize].halves
    }

    /// Whether a face's part in the picture, if it is inside the picture, is the polygon of its corners. (If the
    /// face is drawn with moved corners, edges between them may meet elsewhere.)
    pub(super) fn is_bounded_in_order(&self, face: u32) -> bool {
        let View { is_as_given, .. } = self.views[face as usize];
        is_as_given || self.lines.frame.faces.moved_axis(face).is_none()
    }

    /// Makes the lines of all faces and items that may be visible in the picture. Counts as one phase of the
    /// progress.
    fn add_halves(&mut self, watch: &Watch<'_>) -> Result<(), Error> {
        let faces = self.lines.frame.faces;
        for face in 0..faces.len() {
            let is_as_given = self.views[face].is_as_given;
            let is_positive = self.is_positive(face as u32);
            let start = place(self.halves.len())?;
            if self.sees(face as u32) {
                let corners = faces.corners(face as u32).len() as u32;
                watch.work(LINES + self.edges_work(face as u32) * LINES / 4)?;
                for k in 0..corners {
                    self.halves.push(self.lines.edge(face as u32, k, is_positive, is_as_given)?);
                }
            }
            self.views[face].halves = [start, place(self.halves.len())?];
            finish_item(watch, face, faces.len());
        }
        for item in 0..self.items.len() {
            let Item { face, fragment, .. } = self.items[item];
            let (halves, is_positive) = (self.views[face as usize].halves, self.is_positive(face));
            let fragment = self.tree.fragment(fragment);
            self.items[item].halves = halves;
            if fragment.is_whole() {
                continue;
            }
            watch.work(LINES)?;
            // All edges of the face are needed. A piece beside the picture may be excluded by a single edge,
            // even if that edge does not meet the piece's box. A face of n corners in m pieces takes 8·n·m
            // bytes here, and twice as much in lists of candidates. With a floor of 10 000 corners in 1 396
            // pieces, a process peaks at 346 MB.
            let start = place(self.halves.len())?;
            self.halves.extend_from_within(halves[0] as usize..halves[1] as usize);
            for line in fragment.lines() {
                let Some(plane) = line.as_cut() else { continue };
                let half = self.lines.cut(face, plane, line.is_behind(), is_positive)?;
                self.halves.push(half);
            }
            self.items[item].halves = [start, place(self.halves.len())?];
        }
        self.lines.merge_equal(&mut self.halves, watch)
    }

    /// The half-planes that bound a whole face, one for each edge, in order; empty for a face outside the
    /// picture.
    ///
    /// A ray that meets the face's plane behind the eye, or is parallel to the plane, is never in all these
    /// half-planes: the intersection of the ray's line and the plane would be outside every edge of a bounded
    /// convex polygon.
    pub(super) fn outline(&self, face: u32) -> &[HalfPlane] {
        self.at(self.views[face as usize].halves)
    }

    /// The half-planes that bound an item.
    pub(super) fn halves(&self, item: u32) -> &[HalfPlane] {
        self.at(self.items[item as usize].halves)
    }

    fn at(&self, [start, end]: [u32; 2]) -> &[HalfPlane] {
        &self.halves[start as usize..end as usize]
    }

    /// Whether a face certainly covers a box.
    pub(super) fn covers(&self, face: u32, sides: &Rect) -> bool {
        is_within(sides, &self.views[face as usize].around)
            && self
                .outline(face)
                .iter()
                .all(|&half| self.lines.across(half, sides) == Across::Inside)
    }

    /// The whole face as one cell, if the face is certainly inside a part of the picture, and bounded by its edges
    /// in order.
    pub(super) fn whole_in(&self, face: u32, [low, high]: &Rect) -> Option<Cell> {
        let View { around: [from, to], side, .. } = self.views[face as usize];
        // The box of a face that reaches beyond the picture ends at the picture's border.
        let is_inside = (0..2).all(|axis| low[axis] < from[axis] && to[axis] < high[axis]);
        (is_inside && self.is_bounded_in_order(face))
            .then(|| Cell::of_outline(&self.lines, self.outline(face), side.is_gt()))
    }

    /// The item of a fragment, unless the fragment is outside the picture.
    fn item(&self, fragment: &Fragment<'_>) -> Option<Item> {
        let face = fragment.face();
        let View { around, .. } = self.views[face as usize];
        if is_empty(&around) {
            return None;
        }
        let item = |around| Item {
            face,
            fragment: fragment.index(),
            around,
            halves: [0; 2],
            before: NONE,
        };
        // If corners were moved, the area bounded by the edges in the picture may reach beyond the fragment.
        if fragment.is_whole() || self.lines.frame.faces.moved_axis(face).is_some() {
            return Some(item(around));
        }
        let vertices: SmallVec<[[f64; 3]; 8]> = fragment.lattice_vertices().collect();
        self.around(&vertices).map(item)
    }

    /// A box around the part of the vertices' convex hull that is in the picture; `None` if no part is in the
    /// picture.
    fn around(&self, vertices: &[[f64; 3]]) -> Option<Rect> {
        let rays = &self.lines.frame.rays;
        let vertices = vertices.iter().map(|&vertex| rays.projected(vertex));
        self.in_picture(&Projected::region(vertices)?)
    }

    /// The part of a box in the picture; `None` if no part is in the picture.
    fn in_picture(&self, around: &Rect) -> Option<Rect> {
        let picture = Tile::picture(self.lines.frame.rays.size());
        let around = common(around, &picture.sides());
        (!is_empty(&around)).then_some(around)
    }

    /// The view of a face, given the places of all points in the picture.
    fn view(&self, face: u32, projected: &[Projected]) -> View {
        let LineTable { frame: ViewFrame { rays, faces }, adjacency, .. } = &self.lines;
        let plane = PlaneId::face(face);
        let certain = Sheet::new(rays, faces, plane).certain_side();
        let side = certain.unwrap_or_else(|| self.lines.frame.sheet(plane).side());
        let side = if rays.is_perspective() { side } else { side.reverse() };
        let unseen = View {
            around: NOWHERE,
            side,
            is_opaque: false,
            is_as_given: false,
            last: NONE,
            halves: [0; 2],
        };
        let opacity = self.opacity(face);
        if opacity == 0.0 || side.is_eq() || side.is_lt() && rays.is_front_only() {
            return unseen;
        }
        let points = faces.corner_range(face).map(|corner| adjacency.point(corner as u32));
        let of_point = |point: u32| projected[point as usize];
        // The given corners of a face whose corners were moved.
        let mut given: SmallVec<[[f64; 3]; 8]> = SmallVec::new();
        if faces.moved_axis(face).is_some() {
            given.extend(points.clone().map(|point| adjacency.points()[point as usize]));
        }
        let both = given.iter().zip(faces.corners(face));
        let moved = both.filter(|(given, at)| given != at).map(|(_, at)| rays.projected(*at));
        let hull = Projected::region(points.map(of_point).chain(moved));
        let Some(around) = hull.and_then(|hull| self.in_picture(&hull)) else { return unseen };
        let is_as_given = self.lines.frame.is_convex_as_given(face, &given, side);
        View { around, is_opaque: opacity == 1.0, is_as_given, ..unseen }
    }

    /// Whether the κ of a face's plane is positive. Only for faces that may be visible in the picture.
    fn is_positive(&self, face: u32) -> bool {
        self.views[face as usize].side.is_gt() == self.lines.frame.rays.is_perspective()
    }

    /// Whether a part of a face may be visible in the picture.
    pub(super) fn sees(&self, face: u32) -> bool {
        !is_empty(&self.views[face as usize].around)
    }

    /// The number of polygons that the tree was built of.
    pub(super) fn polygon_count(&self) -> usize {
        self.tree.preparation().polygons
    }

    /// The cost of all edges of a face, in pieces that a build examines. The cost is 0 for faces of few
    /// corners, because the cost of such a face includes the edges.
    pub(super) fn edges_work(&self, face: u32) -> usize {
        let corners = self.lines.frame.faces.corners(face).len();
        if corners > FEW_CORNERS { corners } else { 0 }
    }

    /// The face of an item.
    pub(super) fn face(&self, item: u32) -> u32 {
        self.items[item as usize].face
    }

    /// The opacity of a face.
    pub(super) fn opacity(&self, face: u32) -> f64 {
        self.opacities.get(self.lines.frame.faces.polygon(face)).copied().unwrap_or(1.0)
    }

    /// Whether an item hides items behind it.
    pub(super) fn is_opaque(&self, item: u32) -> bool {
        self.views[self.face(item) as usize].is_opaque
    }

    /// Whether any face that may be visible is translucent.
    pub(super) fn has_translucent(&self) -> bool {
        let mut faces = 0..self.views.len() as u32;
        !self.opacities.is_empty()
            && faces.any(|face| self.sees(face) && !self.views[face as usize].is_opaque)
    }

    /// The polygon of an item.
    pub(super) fn polygon(&self, item: u32) -> usize {
        self.lines.frame.faces.polygon(self.face(item))
    }
}

/// Applies a function to numbers on all threads, and returns the results in order.
fn shared<T: Send>(
    numbers: &[u32],
    function: impl Fn(u32) -> Option<T> + Sync,
    watch: &Watch<'_>,
) -> Result<Vec<T>, Error> {
    let part = |numbers: &[u32]| {
        watch.work(numbers.len() * LOOKED)?;
        let mut part = Vec::with_capacity(numbers.len());
        part.extend(numbers.iter().filter_map(|&number| function(number)));
        Ok(part)
    };
    let parts = parallel_map::map(numbers.chunks(SHARE).collect(), part)?;
    Ok(parts.into_iter().flatten().collect())
}

/// A face is drawn with its given corners unless a corner was moved further than this along an axis. In
/// lattice units: 2⁻³² of the extent, or up to twice as much. Too small: cracks between faces that share an
/// edge. Too large: the outlines differ from the outlines of the moved faces, which decide the depth order.
const FURTHEST_MOVE: f64 = (1u64 << 20) as f64;

impl ViewFrame<'_> {
    /// Whether a face whose corners were moved can be drawn with its given corners. The given corners must
    /// certainly form a convex polygon in the picture. This polygon must show the same side as the face's
    /// plane. Rays through the given corners must meet the face's plane ahead. No corner may have been moved
    /// by more than [`FURTHEST_MOVE`].
    fn is_convex_as_given(&self, face: u32, given: &[[f64; 3]], side: Ordering) -> bool {
        let ViewFrame { rays, faces } = self;
        let n = given.len();
        let is_far = |(given, at): (&[f64; 3], &[f64; 3])| {
            (0..3).any(|axis| (given[axis] - at[axis]).abs() > FURTHEST_MOVE)
        };
        if n > FEW_CORNERS_AS_GIVEN || given.iter().zip(faces.corners(face)).any(is_far) {
            return false;
        }
        let from_eye = |point: [f64; 3]| match rays.pencil {
            RayOrigin::From { .. } => rays.origin_from(point).map(|c| -c),
            RayOrigin::Along { direction } => direction.map(|c| c as f64),
        };
        let is_certain =
            |(normal, size): ([f64; 3], [f64; 3]), ray: [f64; 3], is_negative: bool| {
                let value = if is_negative { -sum(normal, ray) } else { sum(normal, ray) };
                value > 8.0 * f64::EPSILON * sum(size, ray.map(f64::abs))
            };
        let at = |k: usize| given[if k < n { k } else { k - n }];
        // In a quad, an edge and the corner before it are also the previous edge and the corner after that edge.
        let others = if n == 4 { 1 } else { n.saturating_sub(2) };
        (0..n).all(|k| {
            let (a, ray) = (at(k), from_eye(at(k)));
            (k + 2..k + 2 + others)
                .all(|i| is_certain(normal_of([a, at(k + 1), at(i)]), ray, side.is_gt()))
        }) && (!rays.is_perspective() || {
            let normal = normal_of(faces.triangle(face));
            given.iter().all(|&corner| is_certain(normal, from_eye(corner), side.is_gt()))
        })
    }
}

fn sum(factors: [f64; 3], numbers: [f64; 3]) -> f64 {
    factors[0] * numbers[0] + factors[1] * numbers[1] + factors[2] * numbers[2]
}
