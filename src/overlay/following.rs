//! Moves shapes near a plane of the tree to the sides of the polygons on which they lie.
//!
//! A shape can lie on a partition plane and also on a polygon that leaves this plane: the plane of a small polygon is
//! less certain, and extended across a large polygon in the same plane it can deviate from that polygon by more than the
//! tolerance. The large polygon is then on one side of the plane, or the plane cuts it, and the shape has to go with it.
//!
//! A shape follows the largest polygon of the overlay on which it lies. Beyond that polygon, or without one, it follows
//! its [hosts](Beside::hosts). If these are on several sides of the plane, the shape is cut at their [borders](Borders).

use smallvec::SmallVec;

use super::borders::Borders;
use super::hosts::{Host, Origin, Sought};
use super::region::Ground;
use crate::build::choose::{SortedPieces, is_along};
use crate::build::piece::{Piece, Splitter};
use crate::error::Error;
use crate::exact::{Faces, Outline, PreparedPlane, Side, Vertex};
use crate::memory::{place as as_u32, push};
use crate::progress::Watch;
use crate::tree::node::Ranges;

/// The pieces of a set near a plane, with lists that are reused.
#[derive(Default)]
pub(super) struct Following {
    borders: Borders,
    near: Vec<NearPiece>,
    /// The hosts of one near piece after the other.
    found: Vec<Host>,
    /// Whether the hosts of some piece do not decide its side.
    is_open: bool,
    placed: Vec<Placed>,
}

/// A piece of a set that comes within twice the tolerance of a plane and lies along it.
#[derive(Clone, Copy, Debug)]
struct NearPiece {
    /// Its number in the set.
    place: u32,
    /// The start and the end of its hosts in the list of all.
    hosts: [u32; 2],
    /// Whether the first of them decides the side of all parts.
    is_one_side: bool,
    /// The start and the end of its parts.
    parts: [u32; 2],
}

/// A part of a near piece, and its side of the plane.
#[derive(Clone, Copy)]
struct Placed {
    piece: Piece,
    side: Side,
}

/// A set of pieces beside a plane of one of the trees that shapes descend.
pub(super) struct Beside<'a> {
    pub(super) ground: Ground<'a>,
    pub(super) plane: &'a PreparedPlane,
    pub(super) node: &'a Ranges,
    pub(super) watch: &'a Watch<'a>,
}

impl Following {
    /// Forgets all shapes.
    pub(super) fn reset(&mut self) {
        self.borders.clear();
    }

    /// Begins another set.
    pub(super) fn begin(&mut self) {
        self.near.clear();
        self.found.clear();
        self.is_open = false;
    }

    /// Adds a piece of the set that comes near the plane. `side` is its own side; returns that of its hosts, if any.
    pub(super) fn add(
        &mut self,
        faces: &Faces,
        beside: &Beside<'_>,
        (place, piece, arena): (u32, &Piece, &[Vertex]),
        side: Side,
    ) -> Result<Option<Side>, Error> {
        let plane = beside.plane;
        let is_within = plane.stays_near(faces, piece.face, piece.cut_vertices(arena));
        if !is_within && !is_along(faces, piece.face, plane.normal()) {
            return Ok(None);
        }
        let start = self.found.len();
        let outline = &piece.outline(faces, arena);
        let sought = Sought { piece, outline, side, is_within };
        let is_one_side = beside.hosts(faces, &sought, &mut self.found)?;
        let hosts = [as_u32(start)?, as_u32(self.found.len())?];
        push(&mut self.near, NearPiece { place, hosts, is_one_side, parts: [0; 2] })?;
        let of_hosts = decided(faces, plane, piece, arena, &self.found[start..]);
        self.is_open |= of_hosts.is_none();
        Ok(of_hosts.flatten())
    }

    /// Places the near pieces, if they are not all on one side. Puts further parts of a piece after it in the set, which
    /// begins at `start`.
    pub(super) fn settle(
        &mut self,
        faces: &mut Faces,
        beside: &Beside<'_>,
        (pieces, start, sides): (&mut Vec<Piece>, usize, &mut Vec<Side>),
        (arena, splitter): (&mut Vec<Vertex>, &mut Splitter),
    ) -> Result<(), Error> {
        let Self { near, found, borders, placed, is_open, .. } = self;
        let side = |near: &NearPiece| sides[near.place as usize];
        if !*is_open && near.windows(2).all(|two| side(&two[0]) == side(&two[1])) {
            return Ok(());
        }
        let (set, tolerance) = (&pieces[start..], faces.tolerance());
        let face = |near: &NearPiece| set[near.place as usize].face;
        near.sort_unstable_by(|a, b| {
            faces.largest_first(face(a), face(b)).then(a.place.cmp(&b.place))
        });
        let numbers: Vec<u32> = (0..near.len() as u32).collect();
        let all: Vec<Piece> = near.iter().map(|near| set[near.place as usize]).collect();
        let polygons = all.partition_point(|piece| faces.has_area(piece.face));
        let leaders = SortedPieces::of(&all, &numbers[..polygons]);
        placed.clear();
        for (number, piece) in all.iter().enumerate() {
            let outline = piece.outline(faces, arena);
            let mut above: SmallVec<[Host; 4]> = SmallVec::new();
            let mut largest: Option<u32> = None;
            let mut compared = 0;
            let mut touching: SmallVec<[u32; 16]> = leaders
                .touching(&all, piece, tolerance)
                .copied()
                .inspect(|_| compared += 1)
                .filter(|&other| {
                    (other as usize) < number && all[other as usize].touches(piece, tolerance)
                })
                .collect();
            beside.watch.work(compared)?;
            touching.sort_unstable();
            for other in touching {
                let face = all[other as usize].face;
                if largest.is_some_and(|largest| largest != face) {
                    break;
                }
                if face == piece.face || !faces.are_coplanar(face, piece.face) {
                    continue;
                }
                let [first, end] = near[other as usize].parts.map(|part| part as usize);
                for part in &placed[first..end] {
                    let Placed { piece: on, side, .. } = *part;
                    if faces.overlap(face, [&on.outline(faces, arena), &outline]) {
                        let lines = on.cut_vertices(arena).unwrap_or_default().iter();
                        let is_cut =
                            lines.map(Vertex::line).any(|l| l.as_cut() == Some(beside.plane.id()));
                        above.push(Host { origin: Origin::Piece(on), side, is_cut });
                        largest = Some(face);
                    }
                }
            }
            let NearPiece { hosts: [first, end], is_one_side, .. } = near[number];
            let hosts = &found[first as usize..end as usize];
            let begin = as_u32(placed.len())?;
            let mut parting = Parting { faces, beside, borders, arena, splitter, placed };
            parting.part(*piece, &above, hosts, is_one_side)?;
            near[number].parts = [begin, as_u32(placed.len())?];
        }
        if placed.len() > near.len() {
            near.sort_unstable_by_key(|near| near.place);
        }
        let further = merge(near, placed, start, pieces, sides);
        debug_assert_eq!(further, placed.len() - near.len(), "each part once");
        Ok(())
    }
}

/// The side of a piece that its hosts decide; `None` inside if it has no host. `None` if its hosts are on different
/// sides, or if the piece leaves the plane on another side.
fn decided(
    faces: &Faces,
    plane: &PreparedPlane,
    piece: &Piece,
    arena: &[Vertex],
    hosts: &[Host],
) -> Option<Option<Side>> {
    let Some(first) = hosts.first() else { return Some(None) };
    let is_one = hosts.iter().all(|host| host.side == first.side);
    let may_go = || plane.allows(faces, piece.face, piece.cut_vertices(arena), first.side);
    (is_one && may_go()).then_some(Some(first.side))
}

/// The cutting of one piece of a set.
struct Parting<'a, 'b> {
    faces: &'a mut Faces,
    beside: &'a Beside<'b>,
    borders: &'a mut Borders,
    arena: &'a mut Vec<Vertex>,
    splitter: &'a mut Splitter,
    placed: &'a mut Vec<Placed>,
}

impl Parting<'_, '_> {
    /// Cuts a piece into parts that each lie on polygons on one side only: on those of the overlay, otherwise on those of
    /// the tree, otherwise on none.
    fn part(
        &mut self,
        piece: Piece,
        above: &[Host],
        hosts: &[Host],
        is_one_side: bool,
    ) -> Result<(), Error> {
        let &Beside { ground, plane, watch, .. } = self.beside;
        let mut stack: SmallVec<[(Piece, Vec<Host>, bool); 4]> = SmallVec::new();
        let (list, is_above) = if above.is_empty() { (hosts, false) } else { (above, true) };
        stack.push((piece, list.to_vec(), is_above));
        while let Some((mut piece, mut under, is_above)) = stack.pop() {
            watch.work(under.len())?;
            if !is_above && is_one_side {
                self.push(piece, hosts.first().map(|host| host.side))?;
                continue;
            }
            let outline = piece.outline(self.faces, self.arena);
            under.retain(|host| self.overlap(host, &outline));
            if under.is_empty() && is_above {
                stack.push((piece, hosts.to_vec(), false));
                continue;
            }
            if let Some(side) = decided(self.faces, plane, &piece, self.arena, &under) {
                self.push(piece, side)?;
                continue;
            }
            // Where the plane has cut a host, it cuts the piece too.
            if under[0].is_cut {
                let on_side = |side: Side| {
                    let same = under.iter().filter(|host| !host.is_cut || host.side == side);
                    same.cloned().collect::<Vec<_>>()
                };
                let side = piece.exact_side(self.faces, plane, self.arena);
                if side == Side::Spanning {
                    let [front, back] = self.splitter.cut(self.faces, plane, &piece, self.arena)?;
                    stack.push((back, on_side(Side::Back), is_above));
                    stack.push((front, on_side(Side::Front), is_above));
                    continue;
                }
                let left = on_side(side);
                if left.len() < under.len() {
                    stack.push((piece, left, is_above));
                    continue;
                }
            }
            let host = under.remove(0);
            let mut is_beyond = false;
            for (border, inside) in self.borders.of(self.faces, ground, self.arena, &host)? {
                let cut = piece.cut_vertices(self.arena);
                if !border.leaves(self.faces, piece.face, cut, inside) {
                    continue;
                }
                let side = piece.exact_side(self.faces, &border, self.arena);
                is_beyond |= side != Side::Spanning && side != inside;
                if side != Side::Spanning {
                    continue;
                }
                let [front, back] = self.splitter.cut(self.faces, &border, &piece, self.arena)?;
                let is_front = inside == Side::Front;
                let (within, beyond) = if is_front { (front, back) } else { (back, front) };
                piece = within;
                stack.push((beyond, under.clone(), is_above));
            }
            // The host is beside what is left of the piece.
            if is_beyond {
                stack.push((piece, under, is_above));
                continue;
            }
            let cut = piece.cut_vertices(self.arena);
            let may_go = plane.allows(self.faces, piece.face, cut, host.side);
            self.push(piece, may_go.then_some(host.side))?;
        }
        Ok(())
    }

    fn overlap(&self, host: &Host, outline: &Outline) -> bool {
        let host = host.outline(self.beside.ground, self.faces, self.arena);
        self.faces.overlap(host.0, [&host.1, outline])
    }

    /// Places a part of the piece. Without a side of its hosts it has its own.
    fn push(&mut self, piece: Piece, side: Option<Side>) -> Result<(), Error> {
        let plane = self.beside.plane;
        let own = || plane.classify(self.faces, piece.face, piece.cut_vertices(self.arena));
        let side = side.unwrap_or_else(own);
        if side != Side::Spanning {
            return push(self.placed, Placed { piece, side });
        }
        // Smaller pieces may lie on either part.
        let [front, back] = self.splitter.cut(self.faces, plane, &piece, self.arena)?;
        push(self.placed, Placed { piece: front, side: Side::Front })?;
        push(self.placed, Placed { piece: back, side: Side::Back })
    }
}

/// Replaces each near piece of a set that begins at `start` by its parts. `near` is in the order of the set if some piece
/// has several parts. Returns the number of further parts.
fn merge(
    near: &[NearPiece],
    placed: &[Placed],
    start: usize,
    pieces: &mut Vec<Piece>,
    sides: &mut Vec<Side>,
) -> usize {
    let parts = |near: &NearPiece| &placed[near.parts[0] as usize..near.parts[1] as usize];
    let further = placed.len() - near.len();
    let (mut old, mut next) = (pieces.len(), pieces.len() + further);
    if further > 0 {
        pieces.resize(next, placed[0].piece);
        sides.resize(next - start, Side::Coplanar);
    }
    // From the end, so that nothing unread is overwritten.
    for near in near.iter().rev() {
        let (end, parts) = (start + near.place as usize + 1, parts(near));
        if further > 0 {
            let moved = old - end;
            pieces.copy_within(end..old, next - moved);
            sides.copy_within(end - start..old - start, next - moved - start);
            (old, next) = (end - 1, next - moved - parts.len());
        } else {
            next = end - 1;
        }
        for (at, part) in (next..).zip(parts) {
            (pieces[at], sides[at - start]) = (part.piece, part.side);
        }
    }
    further
}
