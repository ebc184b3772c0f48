//! What a picture is made of: pieces of faces, front to back.

use super::frame::Frame;
use super::near_vertices::NEAR_VERTEX;
use super::rect::{NOWHERE, Rect, common, is_empty};
use super::reporter::each;
use super::tile::Tile;
use crate::build::progress::Watch;
use crate::error::{Error, Kind};
use crate::exact::PlaneId;
use crate::memory::{collect, reserve};
use crate::parallel_map;
use crate::raster::{Rays, Sheet, VERTEX_ERROR};
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
    /// The last of its items, if it has some.
    pub(super) last: u32,
}

/// All pieces that may show, front to back.
#[derive(Debug)]
pub(super) struct Stock<'t> {
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
/// To look at a piece takes as long as a build takes to examine so many.
const LOOKED: usize = 16;

impl<'t> Stock<'t> {
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
        let mut order = Vec::new();
        reserve(&mut order, tree.len())?;
        for fragment in each(watch, 1, tree.front_to_back(frame.rays.viewpoint())) {
            order.push(fragment?.index());
        }
        let mut stock = Self { tree, frame, items: vec![], views: vec![], opacities };
        let all: Vec<u32> = collect(0..faces.len() as u32)?;
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
        if fragment.is_whole() {
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
        let unseen = View { around: NOWHERE, is_positive: false, is_opaque: false, last: 0 };
        let opacity = self.opacity(face);
        if opacity == 0.0 {
            return unseen;
        }
        let Some(around) = self.around(faces.corners(face), VERTEX_ERROR) else {
            return unseen;
        };
        let plane = PlaneId::face(face);
        let certain = Sheet::new(rays, faces, plane).certain_side();
        let side = certain.unwrap_or_else(|| self.frame.sheet(plane).side());
        let is_positive = side.is_gt();
        if side.is_eq() || rays.is_front_only() && is_positive != rays.is_perspective() {
            return unseen;
        }
        View { around, is_positive, is_opaque: opacity == 1.0, last: 0 }
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
        let mut part = Vec::new();
        reserve(&mut part, numbers.len())?;
        part.extend(numbers.iter().filter_map(|&number| function(number)));
        Ok(part)
    };
    let mut all = Vec::new();
    for mut part in parallel_map::map(numbers.chunks(SHARE).collect(), part)? {
        reserve(&mut all, part.len())?;
        all.append(&mut part);
    }
    Ok(all)
}
