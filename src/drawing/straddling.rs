//! Faces with corners on both sides of one another's planes.

use super::halving::{NARROWED, found_in};
use super::inner_edges::InnerEdges;
use super::pairs::{Found, Pair, add, sorted};
use super::reporter::each;
use super::stock::Stock;
use super::tile::{IN_VAIN, in_vain};
use crate::Error;
use crate::build::progress::Watch;
use crate::exact::{Faces, PlaneId, PreparedPlane};
use crate::memory::{collect, push};

/// Blocks of at most so many faces are not halved. Larger: more pairs are compared; smaller: more blocks.
const FEW: usize = 16;
/// A box in the scene: its least and its largest coordinates.
type Aabb = [[f64; 3]; 2];

/// A part of the scene with the faces that may reach into it.
struct Block {
    bounds: Aabb,
    faces: Vec<u32>,
    in_vain: u32,
}

/// Pairs of faces of different polygons, with corners on both sides of one another's planes and further from
/// these than the tolerance, that may go through one another: a phase.
pub(super) fn straddling(
    stock: &Stock<'_>,
    inner: &InnerEdges,
    watch: &Watch<'_>,
) -> Result<Vec<Pair>, Error> {
    let faces = stock.frame.faces;
    let boxes: Vec<Aabb> = collect((0..faces.len() as u32).map(|face| aabb(faces.corners(face))))?;
    let (mut seen, mut all) = (Vec::new(), NOTHING);
    for face in each(watch, 1, 0..faces.len() as u32) {
        let face = face?;
        if stock.sees(face) {
            push(&mut seen, face)?;
            all = around(all, boxes[face as usize]);
        }
    }
    let all = Block { bounds: all, faces: seen, in_vain: 0 };
    let halves = |block: &Block, _: &mut Found| block.halves(&boxes, watch);
    let leaf = |block: &Block, found: &mut Found| {
        for (i, &a) in block.faces.iter().enumerate() {
            for b in each(watch, NARROWED, &block.faces[i + 1..]) {
                let b = *b?;
                let is_near = !are_apart(&boxes[a as usize], &boxes[b as usize]);
                if !is_near || faces.polygon(a) == faces.polygon(b) {
                    continue;
                }
                let is_crossed = faces.straddles(a, b) && faces.straddles(b, a);
                let bend = || inner.bend(faces, [a, b]).map(|bend| bend.faces);
                if let Some([below, above]) =
                    if is_crossed { Some([a.min(b), a.max(b)]) } else { bend() }
                {
                    add(found, Pair { below, above })?;
                }
            }
        }
        Ok(())
    };
    sorted(found_in(all, Found::default, halves, leaf, watch)?, watch)
}

impl Faces {
    /// Whether a face has corners on both sides of another's plane, further from it than the tolerance.
    pub(super) fn straddles(&self, face: u32, other: u32) -> bool {
        let prepared = PreparedPlane::new(self, PlaneId::face(other));
        let mut sides = self.corners(face).iter().map(|at| prepared.side_beyond(self, at));
        let Some(first) = sides.find(|side| side.is_ne()) else { return false };
        sides.any(|side| side == first.reverse())
    }
}

impl Block {
    /// Both halves, across the longest side; `None` of one that is not halved.
    fn halves(&self, boxes: &[Aabb], watch: &Watch<'_>) -> Result<Option<[Self; 2]>, Error> {
        if self.faces.len() <= FEW || self.in_vain == IN_VAIN {
            return Ok(None);
        }
        let [low, high] = self.bounds;
        let length = |&axis: &usize| high[axis] - low[axis];
        let longest = (0..3).max_by(|a, b| length(a).total_cmp(&length(b)));
        let axis = longest.unwrap_or_default();
        let middle = 0.5 * (low[axis] + high[axis]);
        let part = || Self { bounds: self.bounds, faces: vec![], in_vain: 0 };
        let mut parts = [part(), part()];
        parts[0].bounds[1][axis] = middle;
        parts[1].bounds[0][axis] = middle;
        for face in each(watch, NARROWED, &self.faces) {
            let face = *face?;
            let [from, to] = boxes[face as usize];
            if from[axis] <= middle {
                push(&mut parts[0].faces, face)?;
            }
            if to[axis] >= middle {
                push(&mut parts[1].faces, face)?;
            }
        }
        let counts = parts.each_ref().map(|part| part.faces.len());
        [parts[0].in_vain, parts[1].in_vain] = in_vain(self.in_vain, self.faces.len(), counts);
        Ok(Some(parts))
    }
}

const NOTHING: Aabb = [[f64::INFINITY; 3], [f64::NEG_INFINITY; 3]];

fn aabb(corners: &[[f64; 3]]) -> Aabb {
    corners.iter().fold(NOTHING, |bounds, &corner| around(bounds, [corner; 2]))
}

fn around(a: Aabb, b: Aabb) -> Aabb {
    let axes = [0, 1, 2];
    [axes.map(|i: usize| a[0][i].min(b[0][i])), axes.map(|i: usize| a[1][i].max(b[1][i]))]
}

fn are_apart([low, high]: &Aabb, [from, to]: &Aabb) -> bool {
    (0..3).any(|axis| to[axis] < low[axis] || from[axis] > high[axis])
}
