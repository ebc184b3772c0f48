//! Splits the faces of a file by the planes of its nodes, like the builder.
//!
//! A file contains no vertices. So a forged file cannot make wrong pieces: whatever planes the file has, each
//! piece is on the correct side of all planes above the piece, and the pieces of each face cover the face.
//! The file's numbers of fragments only limit the number of pieces.

use std::mem::{replace, take};
use std::ops::Range;

use crate::error::Error;
use crate::exact::{Clipper, Faces, PreparedPlane, Side, Vertex, split};
use crate::parallel_map;
use crate::save::invalid;
use crate::tree::node::{NodeRecord, Ranges};
use crate::tree::parts::{Parts, Record};

/// Trees with more fragments are split by several threads. Too small: waking a thread takes longer than the
/// time that it saves. Too large: one thread works while others are idle.
const WORTH_A_THREAD: usize = 4096;
/// Subtrees of less than 1/`JOBS` of the fragments are handed over to other threads. Too small: threads wait
/// for the last subtree. Too large: more of the tree is split before threads share the work.
const JOBS: usize = 32;
/// Subtrees of less than 1/`MOST_JOBS` of the fragments are not handed over, because handing over takes
/// longer than it saves.
const MOST_JOBS: usize = 512;

/// The number of pieces in a list that share a bounding box. (A *list* is a sequence of nodes with one child
/// node each.) Too small: more boxes are tested. Too large: more pieces are tested near the plane.
const BLOCK: usize = 16;
/// The fewest fragments of a list whose pieces get boxes. Too small: boxes take longer to make than they
/// save. Too large: all pieces are tested against each plane.
const LARGE: usize = 8 * BLOCK;
/// The number that replaces the face of a piece that is no longer in a list.
const GONE: u32 = u32::MAX;

type Bounds = [[f64; 3]; 2];

const NOWHERE: Bounds = [[f64::INFINITY; 3], [f64::NEG_INFINITY; 3]];

fn union([low, high]: Bounds, other: Bounds) -> Bounds {
    // Not `min` and `max`, which take more instructions because of NaN.
    let least = |axis: usize| if other[0][axis] < low[axis] { other[0][axis] } else { low[axis] };
    let most = |axis: usize| if other[1][axis] > high[axis] { other[1][axis] } else { high[axis] };
    [std::array::from_fn(least), std::array::from_fn(most)]
}

/// A piece of a face that has not yet reached the node or leaf where it stays.
struct Piece {
    face: u32,
    /// The vertices of the piece; empty for a whole face.
    vertices: Vec<Vertex>,
    /// The bounding box of the rounded vertices.
    bounds: Bounds,
}

impl Piece {
    fn new(faces: &Faces, face: u32, vertices: &[Vertex]) -> Self {
        let include = |bounds, position| union(bounds, [position; 2]);
        let bounds = if vertices.is_empty() {
            faces.corners(face).iter().copied().fold(NOWHERE, include)
        } else {
            vertices.iter().map(Vertex::position).fold(NOWHERE, include)
        };
        Self { face, vertices: vertices.to_vec(), bounds }
    }

    #[inline]
    fn side(&self, faces: &Faces, plane: &PreparedPlane) -> Side {
        let cut = (!self.vertices.is_empty()).then_some(&self.vertices[..]);
        let of_box = plane.side_of_box(self.bounds);
        of_box.unwrap_or_else(|| plane.classify(faces, self.face, cut))
    }

    /// Splits a piece that spans a plane into the parts in front and behind.
    fn split(
        &mut self,
        faces: &Faces,
        plane: &PreparedPlane,
        parts: &mut [Vec<Vertex>; 2],
    ) -> [Self; 2] {
        let [front, back] = parts;
        front.clear();
        back.clear();
        if self.vertices.is_empty() {
            self.vertices.extend(Vertex::corners(faces, self.face));
        }
        split(faces, plane, self.face, &self.vertices, front, back);
        [&*front, &*back].map(|part| Self::new(faces, self.face, part))
    }
}

/// A subtree whose pieces are known.
struct Job {
    node: usize,
    /// The numbers of the subtree's fragments.
    fragments: Range<u32>,
    pieces: Vec<Piece>,
}

/// Splits the faces of a tree by the tree's planes into fragments. With `keeps_positions`, also computes the
/// positions of the fragments' vertices.
///
/// Returns an error unless each node has the stated numbers of fragments on its plane and in its leaves, and
/// the fragments belong to the `listed` faces.
pub(super) fn replay(
    faces: &Faces,
    nodes: &[NodeRecord],
    listed: &[u32],
    keeps_positions: bool,
) -> Result<Parts, Error> {
    let replay = Replay { faces, nodes, keeps_positions };
    let jobs = match listed.len() {
        len if len > WORTH_A_THREAD => len / MOST_JOBS..len / JOBS,
        _ => 0..0,
    };
    if nodes.is_empty() {
        return Ok(Parts::default());
    }
    let (handed_over, last) = replay.run(replay.root(listed.len() as u32)?, jobs)?;
    let finished = parallel_map::map(handed_over, |(before, job)| {
        let (_, subtree) = replay.run(job, 0..0)?;
        Ok([before, subtree])
    })?;
    let whole = join(finished.into_iter().flatten().chain([last]).collect())?;
    let faces = whole.records.iter().map(|record| &record.face);
    match faces.zip(listed).position(|(face, listed)| face != listed) {
        Some(fragment) => {
            Err(invalid("fragment", fragment, "is listed with another face than its planes make"))
        }
        None => Ok(whole),
    }
}

/// Joins the parts of a tree.
fn join(mut parts: Vec<Parts>) -> Result<Parts, Error> {
    if parts.len() == 1 {
        return Ok(parts.remove(0));
    }
    let mut whole = Parts::default();
    let sum = |len: fn(&Parts) -> usize| parts.iter().map(len).sum();
    reserve(&mut whole.records, sum(|parts| parts.records.len()))?;
    reserve(&mut whole.vertices, sum(|parts| parts.vertices.len()))?;
    reserve(&mut whole.positions, sum(|parts| parts.positions.len()))?;
    for mut parts in parts {
        let shift = whole.vertices.len() as u32;
        parts.records.iter_mut().for_each(|record| record.vertices += shift);
        whole.records.append(&mut parts.records);
        whole.vertices.append(&mut parts.vertices);
        whole.positions.append(&mut parts.positions);
        whole.cuts += parts.cuts;
    }
    Ok(whole)
}

fn reserve<T>(list: &mut Vec<T>, more: usize) -> Result<(), Error> {
    list.try_reserve(more).map_err(|_| Error::out_of_memory())
}

struct Replay<'a> {
    faces: &'a Faces,
    nodes: &'a [NodeRecord],
    keeps_positions: bool,
}

impl Replay<'_> {
    /// The job of the root: all faces, or the parts of all faces inside the cell.
    fn root(&self, fragments: u32) -> Result<Job, Error> {
        let mut clipper = Clipper::new(self.faces);
        let mut pieces = Vec::new();
        reserve(&mut pieces, self.faces.len())?;
        for face in 0..self.faces.len() as u32 {
            let outline = clipper.clip(face);
            let outline =
                outline.ok_or_else(|| invalid("face", face as usize, "is outside the cell"))?;
            pieces.push(Piece::new(self.faces, face, outline));
        }
        Ok(Job { node: 0, fragments: 0..fragments, pieces })
    }

    /// Splits the pieces of a subtree. Subtrees whose number of fragments is in `jobs` are not split, but
    /// returned as jobs, each with the fragments before the subtree. The fragments after the last job are
    /// returned separately.
    fn run(&self, job: Job, jobs: Range<usize>) -> Result<(Vec<(Parts, Job)>, Parts), Error> {
        let (mut handed_over, mut parts) = (Vec::new(), Parts::default());
        let (mut own, mut others, mut scratch) = (Vec::new(), Vec::new(), Default::default());
        // In a list, such as peeled layers, most pieces go on to the node below. Such pieces stay in their
        // places, in blocks with boxes. The other pieces leave gaps.
        let (mut boxes, mut gaps): (Vec<Bounds>, _) = (Vec::new(), 0);
        // The sets of pieces still to be split, the next one on top, and the start of each.
        let mut pieces = job.pieces;
        let mut pending = vec![(job.node, job.fragments, 0)];
        while let Some((index, fragments, start)) = pending.pop() {
            let node = &self.nodes[index];
            let (front_node, back_node) = (node.front_node(index), node.back_node(index));
            let is_job = jobs.contains(&fragments.len());
            let is_list = front_node.is_some() != back_node.is_some() && fragments.len() >= LARGE;
            if !is_list || is_job {
                if gaps > 0 {
                    let set = pieces.split_off(start);
                    pieces.extend(set.into_iter().filter(|piece| piece.face != GONE));
                }
                boxes.clear();
                gaps = 0;
            } else if boxes.is_empty() {
                let unite = |pieces: &[Piece]| {
                    pieces.iter().fold(NOWHERE, |bounds, piece| union(bounds, piece.bounds))
                };
                boxes.extend(pieces[start..].chunks(BLOCK).map(unite));
            }
            if is_job {
                let pieces = pieces.split_off(start);
                handed_over.push((take(&mut parts), Job { node: index, fragments, pieces }));
                continue;
            }
            // Pieces on one side stay in their places.
            let stays = if back_node.is_some() { Side::Back } else { Side::Front };
            let plane = PreparedPlane::new(self.faces, node.plane);
            for (block, begin) in (start..pieces.len()).step_by(BLOCK).enumerate().rev() {
                let of_block = boxes.get(block).and_then(|&bounds| plane.side_of_box(bounds));
                if of_block == Some(stays) {
                    continue;
                }
                // Backwards, because a piece that replaces another must have been classified.
                for i in (begin..pieces.len().min(begin + BLOCK)).rev() {
                    if pieces[i].face == GONE {
                        continue;
                    }
                    let side = pieces[i].side(self.faces, &plane);
                    let piece = match side {
                        Side::Spanning => {
                            let [front, back] = pieces[i].split(self.faces, &plane, &mut scratch);
                            let (part, other) =
                                if stays == Side::Front { (front, back) } else { (back, front) };
                            pieces[i] = part;
                            parts.cuts += 1;
                            other
                        }
                        side if side == stays => continue,
                        _ if boxes.is_empty() => pieces.swap_remove(i),
                        _ => {
                            gaps += 1;
                            let gap = Piece { face: GONE, vertices: vec![], bounds: NOWHERE };
                            replace(&mut pieces[i], gap)
                        }
                    };
                    let list = if side == Side::Coplanar { &mut own } else { &mut others };
                    reserve(list, 1)?;
                    list.push(piece);
                }
            }
            // Each piece in front of a node or behind it becomes one or more fragments. So there are at most
            // twice as many pieces as the file lists fragments.
            let Ranges { own: on_plane, front: in_front, back: behind } = node.ranges(fragments);
            let stay = pieces.len() - start - gaps;
            let counts = match stays {
                Side::Front => [stay, others.len()],
                _ => [others.len(), stay],
            };
            let fits = |is_leaf, pieces: usize, range: &Range<u32>| {
                if is_leaf { pieces == range.len() } else { pieces <= range.len() }
            };
            if !fits(true, own.len(), &on_plane)
                || !fits(front_node.is_none(), counts[0], &in_front)
                || !fits(back_node.is_none(), counts[1], &behind)
            {
                return Err(invalid(
                    "node",
                    index,
                    "does not have the fragments that its plane makes",
                ));
            }
            // Coplanar polygons are painted in input order.
            own.sort_unstable_by_key(|piece| piece.face);
            self.store(&mut parts, own.drain(..))?;
            match (front_node, back_node) {
                (Some(front), Some(back)) => {
                    pending.push((back, behind, start));
                    pending.push((front, in_front, pieces.len()));
                    reserve(&mut pieces, others.len())?;
                    pieces.append(&mut others);
                }
                (Some(front), None) => {
                    self.store(&mut parts, others.drain(..))?;
                    pending.push((front, in_front, start));
                }
                (None, Some(back)) => {
                    self.store(&mut parts, others.drain(..))?;
                    pending.push((back, behind, start));
                }
                (None, None) => {
                    self.store(&mut parts, pieces.drain(start..))?;
                    self.store(&mut parts, others.drain(..))?;
                }
            }
        }
        Ok((handed_over, parts))
    }

    /// Appends pieces to the output.
    fn store(&self, parts: &mut Parts, pieces: impl Iterator<Item = Piece>) -> Result<(), Error> {
        for Piece { face, vertices, .. } in pieces {
            reserve(&mut parts.records, 1)?;
            parts.records.push(Record { face, vertices: parts.vertices.len() as u32 });
            reserve(&mut parts.vertices, vertices.len())?;
            parts.vertices.extend(vertices.iter().map(Vertex::stored));
            if self.keeps_positions {
                reserve(&mut parts.positions, vertices.len())?;
                parts.positions.extend(vertices.iter().map(Vertex::position));
            }
        }
        Ok(())
    }
}
