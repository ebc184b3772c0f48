//! What a picture is made of: pieces of faces, front to back, by the lines that bound them.

use std::ops::Range;

use super::frame::{Frame, Sheet};
use super::half::Half;
use super::lines::Lines;
use super::region::{Region, common, is_within};
use super::tile::{Across, Tile};
use crate::Error;
use crate::build::progress::Watch;
use crate::exact::PlaneId;
use crate::memory::{place, push, reserve};
use crate::raster::Rays;
use crate::tree::{BspTree, Fragment};

/// A piece of a face that may show.
#[derive(Clone, Copy, Debug)]
pub(super) struct Item {
    /// Its face, by its place in [`Stock::seen`].
    pub(super) seen: u32,
    /// Where the halves that bound it begin and end in [`Stock::halves`].
    halves: [u32; 2],
    /// A box around it in the picture.
    pub(super) region: Region,
}

/// A face that the camera sees a side of.
#[derive(Clone, Debug)]
pub(super) struct Seen {
    pub(super) face: u32,
    /// Its edges in [`Stock::halves`], one after another, and what else bounds it.
    halves: Range<u32>,
    /// The last of its items.
    pub(super) last: u32,
    /// A box around it in the picture.
    pub(super) region: Region,
    /// Whether it hides what is behind it.
    pub(super) is_opaque: bool,
}

/// All pieces that may show, front to back.
#[derive(Debug)]
pub(super) struct Stock<'t> {
    pub(super) lines: Lines<'t>,
    pub(super) items: Vec<Item>,
    pub(super) seen: Vec<Seen>,
    halves: Vec<Half>,
    /// Of each polygon; none if all are opaque.
    opacities: Vec<f64>,
}

/// To make the lines of a fragment takes as long as a build takes to examine so many pieces.
const LINES: usize = 64;
/// Faces that show nothing.
const UNSEEN: u32 = u32::MAX;
/// Faces that were not met so far.
const UNKNOWN: u32 = u32::MAX - 1;

impl<'t> Stock<'t> {
    /// The pieces of a tree that rays may meet: of polygons whose opacity is not 0. With no opacities, all
    /// are opaque.
    pub(super) fn new(
        tree: &'t BspTree,
        rays: Rays,
        opacities: Vec<f64>,
        watch: &Watch<'_>,
    ) -> Result<Self, Error> {
        let (faces, viewpoint) = (tree.faces(), rays.viewpoint());
        let lines = Lines::new(Frame { rays, faces });
        let mut stock = Self { lines, items: vec![], seen: vec![], halves: vec![], opacities };
        let mut numbers: Vec<u32> = Vec::new();
        reserve(&mut numbers, faces.len())?;
        numbers.resize(faces.len(), UNKNOWN);
        let mut sheets: Vec<Sheet> = Vec::new();
        for fragment in tree.front_to_back(viewpoint) {
            watch.work(LINES)?;
            let face = fragment.face();
            let number = &mut numbers[face as usize];
            if *number == UNKNOWN {
                *number = stock.see(face, &mut sheets)?;
            }
            if *number == UNSEEN {
                continue;
            }
            let seen = *number;
            if let Some(item) = stock.item(&fragment, seen, &sheets[seen as usize])? {
                stock.seen[seen as usize].last = stock.items.len() as u32;
                push(&mut stock.items, item)?;
            }
        }
        Ok(stock)
    }

    /// A fragment of a face, unless the picture shows nothing of it.
    fn item(
        &mut self,
        fragment: &Fragment<'_>,
        seen: u32,
        sheet: &Sheet,
    ) -> Result<Option<Item>, Error> {
        let Seen { region, ref halves, .. } = self.seen[seen as usize];
        if fragment.lines().all(|line| line.as_cut().is_none()) {
            return Ok(Some(Item { seen, halves: [halves.start, halves.end], region }));
        }
        let (rim, start) = (halves.start as usize..halves.end as usize, self.halves.len());
        reserve(&mut self.halves, rim.len())?;
        self.halves.extend_from_within(rim.clone());
        for line in fragment.lines() {
            let Some(plane) = line.as_cut() else { continue };
            let half = self.lines.cut(fragment.face(), plane, line.is_behind(), sheet)?;
            push(&mut self.halves, half)?;
        }
        let picture = Tile::picture(self.lines.frame.rays.size()).sides();
        let Some(region) = self.lines.around(&common(&region, &picture), &self.halves[start..])
        else {
            self.halves.truncate(start);
            return Ok(None);
        };
        // Edges of the face that do not touch the fragment's box bound nothing of it.
        let mut end = start;
        for place in start..self.halves.len() {
            let half = self.halves[place];
            if place >= start + rim.len() || self.lines.across(half, &region) != Across::Inside {
                self.halves[end] = half;
                end += 1;
            }
        }
        self.halves.truncate(end);
        Ok(Some(Item { seen, halves: [place(start)?, place(end)?], region }))
    }

    /// The number of a face, which is added if the picture shows it.
    fn see(&mut self, face: u32, sheets: &mut Vec<Sheet>) -> Result<u32, Error> {
        let Frame { rays, faces } = &self.lines.frame;
        let faces = *faces;
        let opacity = self.opacity(face);
        if opacity == 0.0 {
            return Ok(UNSEEN);
        }
        let Some(region) = rays.region(faces.corners(face)) else { return Ok(UNSEEN) };
        let sheet = self.lines.frame.sheet(PlaneId::face(face));
        let side = sheet.side();
        let front = side.is_gt() == rays.is_perspective();
        if side.is_eq() || rays.is_front_only() && !front {
            return Ok(UNSEEN);
        }
        let may_be_behind = rays.is_perspective() && faces.upright_axis(face).is_some();
        let start = place(self.halves.len())?;
        for k in 0..faces.corners(face).len() as u32 {
            let half = self.lines.edge(face, k, &sheet, front)?;
            push(&mut self.halves, half)?;
        }
        // Edges in a plane bound a cone, all of it ahead of the eye; others may bound its image
        // behind the eye as well.
        if may_be_behind {
            let half = self.lines.ahead(face, &sheet)?;
            push(&mut self.halves, half)?;
        }
        let halves = start..place(self.halves.len())?;
        push(sheets, sheet)?;
        push(&mut self.seen, Seen { face, halves, last: 0, region, is_opaque: opacity == 1.0 })?;
        Ok(self.seen.len() as u32 - 1)
    }

    /// The halves that bound a whole face.
    pub(super) fn outline(&self, seen: u32) -> &[Half] {
        let Range { start, end } = self.seen[seen as usize].halves;
        &self.halves[start as usize..end as usize]
    }

    /// Whether a face certainly covers a box.
    pub(super) fn covers(&self, seen: u32, sides: &Region) -> bool {
        is_within(sides, &self.seen[seen as usize].region)
            && self
                .outline(seen)
                .iter()
                .all(|&half| self.lines.across(half, sides) == Across::Inside)
    }

    /// The halves that bound an item.
    pub(super) fn halves(&self, item: u32) -> &[Half] {
        let [start, end] = self.items[item as usize].halves;
        &self.halves[start as usize..end as usize]
    }

    /// The place of an item's face in [`Stock::seen`].
    pub(super) fn seen_of(&self, item: u32) -> u32 {
        self.items[item as usize].seen
    }

    /// The opacity of a face.
    pub(super) fn opacity(&self, face: u32) -> f64 {
        let polygon = self.lines.frame.faces.polygon(face);
        self.opacities.get(polygon).copied().unwrap_or(1.0)
    }

    /// Whether an item hides what is behind it.
    pub(super) fn is_opaque(&self, item: u32) -> bool {
        self.seen[self.seen_of(item) as usize].is_opaque
    }

    /// Whether something shows through an item.
    pub(super) fn has_translucent(&self) -> bool {
        self.seen.iter().any(|seen| !seen.is_opaque)
    }

    /// The polygon of an item.
    pub(super) fn polygon(&self, item: u32) -> usize {
        let seen = self.items[item as usize].seen;
        self.lines.frame.faces.polygon(self.seen[seen as usize].face)
    }
}
