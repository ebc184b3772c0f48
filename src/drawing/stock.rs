//! What a picture is made of: pieces of faces, front to back, and the lines that bound them.

use smallvec::SmallVec;

use super::cell::{NOWHERE, Rect, common, is_empty, is_within};
use super::exact_lines::Frame;
use super::lines::{HalfPlane, LineTable, Table};
use super::map::each;
use super::tile::{Across, Tile};
use crate::error::{Error, Kind};
use crate::exact::{Faces, PlaneId, PlaneKind, VertexId, VertexKind};
use crate::memory::place;
use crate::parallel_map;
use crate::progress::Watch;
use crate::raster::{RayOrigin, Rays, Sheet, VERTEX_ERROR, normal_of};
use crate::tree::{BspTree, Fragment};

/// A piece of a face that may show.
#[derive(Clone, Copy, Debug)]
pub(super) struct Item {
    pub(super) face: u32,
    /// The tree's number of it.
    pub(super) fragment: u32,
    /// A box around what of it is in the picture.
    pub(super) around: Rect,
}

/// How the camera sees a face.
#[derive(Clone, Copy, Debug)]
pub(super) struct View {
    /// A box around what of it is in the picture; an empty one if the picture shows nothing of it.
    pub(super) around: Rect,
    /// Whether the κ of its plane is positive.
    pub(super) is_positive: bool,
    /// Whether it hides what is behind it.
    pub(super) is_opaque: bool,
    /// Whether its edges in the picture go through its corners as given.
    pub(super) is_as_given: bool,
    /// The last of its items, if it has some.
    pub(super) last: u32,
}

/// All pieces that may show, front to back.
#[derive(Debug)]
pub(super) struct Primitives<'t> {
    tree: &'t BspTree,
    pub(super) frame: Frame<'t>,
    pub(super) items: Vec<Item>,
    /// Of all faces, by their numbers.
    pub(super) views: Vec<View>,
    /// Of each polygon; none if all are opaque.
    opacities: Vec<f64>,
}

/// So many faces, or pieces, are looked at by one thread.
const SHARE: usize = 1024;
/// Faces and cells of more corners count as that much work.
pub(super) const FEW_CORNERS: usize = 32;
/// Edges of faces of more corners, of which some were moved, do not go through the corners as given: to find out whether
/// they may, takes time that grows with the square of their number.
const FEW_CORNERS_AS_GIVEN: usize = 8;
/// To look at a piece takes as long as a build takes to examine so many.
const LOOKED: usize = 16;

impl<'t> Primitives<'t> {
    /// The pieces of a tree that rays may meet: of polygons whose opacity is not 0. With no opacities, all
    /// are opaque.
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
        if !rays.are_for(faces) {
            return Err(Kind::OtherRays.error());
        }
        let frame = Frame { rays, faces };
        let mut order = Vec::with_capacity(tree.len());
        for fragment in each(watch, 1, tree.order(frame.rays.viewpoint()).front_to_back()) {
            order.push(fragment?.index());
        }
        let mut stock = Self { tree, frame, items: vec![], views: vec![], opacities };
        let all: Vec<u32> = (0..faces.len() as u32).collect();
        let view = |face: u32| Some(stock.view(face));
        stock.views = shared(&all, view, watch)?;
        let item = |index: u32| stock.item(&tree.fragment(index));
        stock.items = shared(&order, item, watch)?;
        for numbered in each(watch, 1, (0..).zip(&stock.items)) {
            let (number, item) = numbered?;
            stock.views[item.face as usize].last = number;
        }
        Ok(stock)
    }

    /// A fragment, unless the picture shows nothing of it.
    fn item(&self, fragment: &Fragment<'_>) -> Option<Item> {
        let face = fragment.face();
        let View { around, .. } = self.views[face as usize];
        if is_empty(&around) {
            return None;
        }
        let item = |around| Item { face, fragment: fragment.index(), around };
        // Where corners were moved, what the edges in the picture bound may reach beyond the fragment.
        if fragment.is_whole() || self.frame.faces.moved_axis(face).is_some() {
            return Some(item(around));
        }
        self.around(&self.frame.near_vertices(fragment), NEAR_VERTEX).map(item)
    }

    /// A box around the part of a convex hull that is in the picture, of points that may be off by so much; `None` if
    /// there is none.
    fn around(&self, points: &[[f64; 3]], off: f64) -> Option<Rect> {
        let picture = Tile::picture(self.frame.rays.size()).sides();
        let around = common(&self.frame.rays.region(points, off)?, &picture);
        (!is_empty(&around)).then_some(around)
    }

    fn view(&self, face: u32) -> View {
        let Frame { rays, faces } = &self.frame;
        let unseen = View {
            around: NOWHERE,
            is_positive: false,
            is_opaque: false,
            is_as_given: false,
            last: 0,
        };
        let opacity = self.opacity(face);
        if opacity == 0.0 {
            return unseen;
        }
        let moved = match faces.moved_axis(face) {
            Some(_) => faces.given_corners(face),
            None => SmallVec::new(),
        };
        let corners: SmallVec<[[f64; 3]; 8]> =
            faces.corners(face).iter().chain(&moved).copied().collect();
        let Some(around) = self.around(&corners, VERTEX_ERROR) else {
            return unseen;
        };
        let plane = PlaneId::face(face);
        let certain = Sheet::new(rays, faces, plane).certain_side();
        let side = certain.unwrap_or_else(|| self.frame.sheet(plane).side());
        let is_positive = side.is_gt();
        if side.is_eq() || rays.is_front_only() && is_positive != rays.is_perspective() {
            return unseen;
        }
        let is_as_given = self.frame.is_convex_as_given(face, &moved, is_positive);
        View { around, is_positive, is_opaque: opacity == 1.0, is_as_given, last: 0 }
    }

    /// Whether the picture may show some of a face.
    pub(super) fn sees(&self, face: u32) -> bool {
        !is_empty(&self.views[face as usize].around)
    }

    /// A number above those of all polygons that the picture may show.
    pub(super) fn polygons_end(&self, watch: &Watch<'_>) -> Result<usize, Error> {
        let mut end = 0;
        for face in each(watch, 1, 0..self.views.len() as u32) {
            let face = face?;
            if self.sees(face) {
                end = end.max(self.frame.faces.polygon(face) + 1);
            }
        }
        Ok(end)
    }

    /// To look at all edges of a face takes as long as a build takes to examine so many pieces; 0 for faces of few
    /// corners, whose edges are part of what is counted for a face.
    pub(super) fn edges_work(&self, face: u32) -> usize {
        let corners = self.frame.faces.corners(face).len();
        if corners > FEW_CORNERS { corners } else { 0 }
    }

    /// The tree's fragment that an item is.
    pub(super) fn fragment(&self, item: u32) -> Fragment<'t> {
        self.tree.fragment(self.items[item as usize].fragment)
    }

    /// The face of an item.
    pub(super) fn face(&self, item: u32) -> u32 {
        self.items[item as usize].face
    }

    /// The opacity of a face.
    pub(super) fn opacity(&self, face: u32) -> f64 {
        self.opacities.get(self.frame.faces.polygon(face)).copied().unwrap_or(1.0)
    }

    /// Whether an item hides what is behind it.
    pub(super) fn is_opaque(&self, item: u32) -> bool {
        self.views[self.face(item) as usize].is_opaque
    }

    /// Whether something shows through a face.
    pub(super) fn has_translucent(&self) -> bool {
        let mut faces = 0..self.views.len() as u32;
        !self.opacities.is_empty()
            && faces.any(|face| self.sees(face) && !self.views[face as usize].is_opaque)
    }

    /// The polygon of an item.
    pub(super) fn polygon(&self, item: u32) -> usize {
        self.frame.faces.polygon(self.face(item))
    }
}

/// What a function gives for numbers, in their order, by all threads.
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
    let mut all = Vec::new();
    for mut part in parallel_map::map(numbers.chunks(SHARE).collect(), part)? {
        all.reserve(part.len());
        all.append(&mut part);
    }
    Ok(all)
}

/// Vertices are at most so far off along each axis, in lattice units: 2⁻³³ of the lattice. Smaller: more are
/// computed by integers; larger: boxes are larger than they need be.
pub(super) const NEAR_VERTEX: f64 = (1u64 << 20) as f64;
/// What is rounded at the end, and the error of vertices from integers.
const ROUNDING: f64 = 8.0;

impl Frame<'_> {
    /// Whether the corners of a face as given, if some were moved, are certainly those of a convex polygon in the
    /// picture, of which the same side is seen as of the face's plane, and are where rays meet that ahead. Not if
    /// they were moved by more than [`NEAR_VERTEX`]: the picture would differ from that of the faces as moved, which decide
    /// what is in front.
    fn is_convex_as_given(&self, face: u32, given: &[[f64; 3]], is_positive: bool) -> bool {
        let Frame { rays, faces } = self;
        let n = given.len();
        let is_far = |(given, at): (&[f64; 3], &[f64; 3])| {
            difference(*given, *at).iter().any(|off| off.abs() > NEAR_VERTEX)
        };
        if n > FEW_CORNERS_AS_GIVEN || given.iter().zip(faces.corners(face)).any(is_far) {
            return false;
        }
        let is_front = is_positive == rays.is_perspective();
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
        (0..n).all(|k| {
            let (a, ray) = (at(k), from_eye(at(k)));
            (k + 2..k + n).all(|i| is_certain(normal_of([a, at(k + 1), at(i)]), ray, is_front))
        }) && (!rays.is_perspective() || {
            let normal = normal_of(faces.triangle(face));
            given.iter().all(|&corner| is_certain(normal, from_eye(corner), is_positive))
        })
    }

    /// The vertices of a fragment, each to within [`NEAR_VERTEX`]: by floats where they can tell, else by integers.
    pub(super) fn near_vertices(&self, fragment: &Fragment<'_>) -> SmallVec<[[f64; 3]; 8]> {
        let (faces, face) = (self.faces, fragment.face());
        let near: Option<_> =
            fragment.vertex_ids().map(|vertex_id| near_vertex(faces, face, vertex_id)).collect();
        near.unwrap_or_else(|| fragment.lattice_vertices().collect())
    }
}

/// A vertex of a face to within [`NEAR_VERTEX`]; `None` if floats cannot tell.
fn near_vertex(faces: &Faces, face: u32, vertex: VertexId) -> Option<[f64; 3]> {
    match vertex.kind() {
        VertexKind::Corner(k) => Some(faces.corners(face)[k as usize]),
        // Edges of faces of which corners were moved are not straight through these.
        VertexKind::OnEdge(..) if faces.moved_axis(face).is_some() => None,
        VertexKind::OnEdge(k, plane) => on_edge(faces, faces.ends(face, k), plane),
        VertexKind::Inside(g, h) => meeting(faces, faces.triangle(face), [g, h]),
    }
}

/// Where a plane meets the edge between two points.
fn on_edge(faces: &Faces, [a, b]: [[f64; 3]; 2], plane: PlaneId) -> Option<[f64; 3]> {
    let ([at_a, at_b], off) = values(faces, plane, [a, b]);
    let fall = at_a - at_b;
    // The fall is off by both values, and by a rounding of its own.
    let least = fall.abs() * (1.0 - f64::EPSILON) - 2.0 * off;
    if least.is_nan() || least <= 0.0 {
        return None;
    }
    let share = at_a / fall;
    let arm = difference(b, a);
    // Where s is the exact share, this one is wrong by off · (|s| + |1 − s|) / least at most, and by the roundings:
    // between the ends, where vertices are, by off / least. A forged tree may have others.
    let spread = (off + 2.0 * off * share.abs()) / least + 4.0 * f64::EPSILON * share.abs();
    near(a, arm.map(|c| share * c), arm.map(|c| spread * c.abs()))
}

/// Where two planes meet that of a triangle. The weights of its corners there are the vector product of the
/// values of the one plane at the three corners and those of the other.
fn meeting(faces: &Faces, triangle: [[f64; 3]; 3], planes: [PlaneId; 2]) -> Option<[f64; 3]> {
    let [(g, g_off), (h, h_off)] = planes.map(|plane| values(faces, plane, triangle));
    let [g_most, h_most] = [g, h].map(|v| v.iter().fold(0.0f64, |most, c| most.max(c.abs())));
    let weights: [f64; 3] = std::array::from_fn(|i| {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        g[j] * h[k] - g[k] * h[j]
    });
    let total = weights[0] + weights[1] + weights[2];
    // A weight g h − g′ h′ is off by 2 (|g| δh + |h| δg + δg δh), and by the roundings of the two products, of their
    // difference and, in part, of the sum.
    let off = 2.0 * (g_most * h_off + h_most * g_off + g_off * h_off)
        + 16.0 * f64::EPSILON * g_most * h_most;
    let least = total.abs() - 3.0 * off;
    if least.is_nan() || least <= 0.0 {
        return None;
    }
    let arms = [difference(triangle[1], triangle[0]), difference(triangle[2], triangle[0])];
    let from = std::array::from_fn(|i| (weights[1] * arms[0][i] + weights[2] * arms[1][i]) / total);
    let spread = std::array::from_fn(|i| {
        let sizes = arms.map(|arm: [f64; 3]| arm[i].abs());
        let terms = weights[1].abs() * sizes[0] + weights[2].abs() * sizes[1];
        let from: [f64; 3] = from;
        (off * (sizes[0] + sizes[1] + 3.0 * from[i].abs()) + 2.0 * f64::EPSILON * terms) / least
    });
    near(triangle[0], from, spread)
}

/// `point` + `from`, where `from` is off by up to `spread`, if that is near enough.
fn near(point: [f64; 3], from: [f64; 3], spread: [f64; 3]) -> Option<[f64; 3]> {
    let is_near = spread.iter().all(|off| *off <= NEAR_VERTEX - ROUNDING);
    is_near.then(|| std::array::from_fn(|i| point[i] + from[i]))
}

/// The values of a plane at points, and a bound on what each is off by.
///
/// Differences of lattice points are exact. The normal is off by 2.01 roundings of its size, each product by one,
/// and the sum by two.
fn values<const K: usize>(faces: &Faces, plane: PlaneId, points: [[f64; 3]; K]) -> ([f64; K], f64) {
    match plane.kind() {
        PlaneKind::Axis(axis, corner) => {
            let at = faces.corner(corner)[axis];
            (points.map(|point| point[axis] - at), 0.0)
        }
        PlaneKind::Face(face) => {
            let triangle = faces.triangle(face);
            let (normal, size) = normal_of(triangle);
            let arms = points.map(|point| difference(point, triangle[0]));
            let sizes = arms.map(|arm| sum(size, arm.map(f64::abs)));
            let most = sizes.iter().fold(0.0f64, |most, size| most.max(*size));
            (arms.map(|arm| sum(normal, arm)), 8.0 * f64::EPSILON * most)
        }
    }
}

fn difference(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|i| a[i] - b[i])
}

fn sum(factors: [f64; 3], numbers: [f64; 3]) -> f64 {
    factors[0] * numbers[0] + factors[1] * numbers[1] + factors[2] * numbers[2]
}

/// The halves that bound faces and items, of those that someone asked for.
///
/// Most of what is hidden is never asked for. Parts of a picture that several threads look at have rims
/// each, with numbers of their own for lines.
#[derive(Debug)]
pub(super) struct OutlineCache<'t> {
    pub(super) lines: LineTable<'t>,
    halves: Vec<HalfPlane>,
    of_faces: Table<u32, [u32; 2]>,
    of_items: Table<u32, [u32; 2]>,
}

impl<'t> OutlineCache<'t> {
    /// None so far.
    pub(super) fn new(stock: &Primitives<'t>) -> Self {
        let lines = LineTable::new(stock.frame.clone());
        Self { lines, halves: vec![], of_faces: Table::default(), of_items: Table::default() }
    }

    /// The halves that bound a whole face: its edges, one after another.
    ///
    /// No ray from an eye is in all of them that meets the face's plane behind the eye: the point where it
    /// does would be outside of every edge of a bounded convex polygon. Nor is one along the plane.
    pub(super) fn outline(
        &mut self,
        stock: &Primitives<'_>,
        face: u32,
    ) -> Result<&[HalfPlane], Error> {
        let ends = self.outline_place(stock, face)?;
        Ok(self.at(ends))
    }

    /// The same, if it was asked for before; else none.
    pub(super) fn known_outline(&self, face: u32) -> &[HalfPlane] {
        self.of_faces.get(&face).map_or(&[], |&ends| self.at(ends))
    }

    /// The halves that bound an item.
    pub(super) fn item(
        &mut self,
        stock: &Primitives<'_>,
        item: u32,
    ) -> Result<&[HalfPlane], Error> {
        let ends = self.item_place(stock, item)?;
        Ok(self.at(ends))
    }

    /// The same of an item that was asked for before, or is a whole face whose outline was.
    pub(super) fn known_item(&self, stock: &Primitives<'_>, item: u32) -> &[HalfPlane] {
        match self.of_items.get(&item) {
            Some(&ends) => self.at(ends),
            None => {
                debug_assert!(stock.fragment(item).is_whole(), "item {item} was not asked for");
                self.known_outline(stock.face(item))
            }
        }
    }

    /// Where a box lies against an item: inside, the item covers it.
    pub(super) fn across_item(
        &mut self,
        stock: &Primitives<'_>,
        item: u32,
        sides: &Rect,
    ) -> Result<Across, Error> {
        let ends = self.item_place(stock, item)?;
        Ok(self.across(ends, sides))
    }

    /// The halves of an item whose lines may cross a box; `None` if the item certainly lies beside it.
    pub(super) fn crossing(
        &mut self,
        stock: &Primitives<'_>,
        item: u32,
        sides: &Rect,
    ) -> Result<Option<SmallVec<[HalfPlane; 8]>>, Error> {
        let ends = self.item_place(stock, item)?;
        if is_within(&stock.items[item as usize].around, sides) {
            return Ok(Some(SmallVec::from_slice(self.at(ends))));
        }
        let mut crossing = SmallVec::new();
        for &half in self.at(ends) {
            match self.lines.across(half, sides) {
                Across::Inside => {}
                Across::Outside => return Ok(None),
                Across::Maybe => crossing.push(half),
            }
        }
        Ok(Some(crossing))
    }

    /// Whether a face certainly covers a box.
    pub(super) fn covers(
        &mut self,
        stock: &Primitives<'_>,
        face: u32,
        sides: &Rect,
    ) -> Result<bool, Error> {
        if !is_within(sides, &stock.views[face as usize].around) {
            return Ok(false);
        }
        let ends = self.outline_place(stock, face)?;
        Ok(self.across(ends, sides) == Across::Inside)
    }

    fn across(&self, ends: [u32; 2], sides: &Rect) -> Across {
        let mut all = Across::Inside;
        for &half in self.at(ends) {
            match self.lines.across(half, sides) {
                Across::Inside => {}
                Across::Outside => return Across::Outside,
                Across::Maybe => all = Across::Maybe,
            }
        }
        all
    }

    fn at(&self, [start, end]: [u32; 2]) -> &[HalfPlane] {
        &self.halves[start as usize..end as usize]
    }

    fn outline_place(&mut self, stock: &Primitives<'_>, face: u32) -> Result<[u32; 2], Error> {
        if let Some(&ends) = self.of_faces.get(&face) {
            return Ok(ends);
        }
        let Self { lines, halves, .. } = self;
        let View { is_positive, is_as_given, .. } = stock.views[face as usize];
        let start = place(halves.len())?;
        for k in 0..stock.frame.faces.corners(face).len() as u32 {
            halves.push(lines.edge(face, k, is_positive, is_as_given)?);
        }
        let ends = [start, place(halves.len())?];
        self.of_faces.insert(face, ends);
        Ok(ends)
    }

    fn item_place(&mut self, stock: &Primitives<'_>, item: u32) -> Result<[u32; 2], Error> {
        if let Some(&ends) = self.of_items.get(&item) {
            return Ok(ends);
        }
        let Item { face, .. } = stock.items[item as usize];
        let rim = self.outline_place(stock, face)?;
        let fragment = stock.fragment(item);
        if fragment.is_whole() {
            return Ok(rim);
        }
        let start = self.halves.len();
        // All edges of the face: one that passes by the piece's box may still be what keeps a piece out that
        // is beside the picture, whose box is not empty.
        self.halves.reserve((rim[1] - rim[0]) as usize);
        self.halves.extend_from_within(rim[0] as usize..rim[1] as usize);
        let View { is_positive, .. } = stock.views[face as usize];
        for line in fragment.lines() {
            let Some(plane) = line.as_cut() else { continue };
            self.halves.push(self.lines.cut(face, plane, line.is_behind(), is_positive)?);
        }
        let ends = [place(start)?, place(self.halves.len())?];
        self.of_items.insert(item, ends);
        Ok(ends)
    }
}

#[cfg(test)]
mod tests;
