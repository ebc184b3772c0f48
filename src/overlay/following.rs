//! Moves shapes near a plane of the tree to the sides of the polygons on which they lie.
//!
//! A shape can lie on a partition plane and also on a polygon that leaves this plane: the plane of a small polygon is
//! less certain, and extended across a large polygon in the same plane it can deviate from that polygon by more than the
//! tolerance. The large polygon is then on one side of the plane, or the plane cuts it, and the shape has to go with it.
//!
//! A shape follows the polygons of the overlay on which it lies, the largest first. Beyond these, or without one, it follows
//! its [hosts](Beside::hosts) in the tree. If hosts are on several sides of the plane, the shape is cut at their
//! [borders](Borders). So each part of a shape goes with the polygon on which it lies, though the polygons' planes differ by
//! rounding.

use glam::DVec3;
use smallvec::SmallVec;

use super::hosts::{Borders, Host, Sought};
use super::region::Ground;
use crate::build::choose::{SortedPieces, is_along};
use crate::build::piece::{Piece, Splitter};
use crate::error::Error;
use crate::exact::{Faces, PreparedPlane, Side, Vertex};
use crate::memory::{place as as_u32, push, reserve};
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
        let cut = piece.cut_vertices(arena);
        let is_within = beside.plane.allows(faces, piece.face, cut, Side::Coplanar);
        if !is_within && !is_along(faces, piece.face, beside.plane.normal()) {
            return Ok(None);
        }
        let start = self.found.len();
        let outline = &piece.outline(faces, arena);
        let sought = Sought { piece, arena, outline, side, is_within };
        let is_one_side = beside.hosts(faces, &sought, &mut self.found)?;
        let hosts = [as_u32(start)?, as_u32(self.found.len())?];
        push(&mut self.near, NearPiece { place, hosts, is_one_side, parts: [0; 2] })?;
        self.is_open |= !is_one_side && self.found.len() > start;
        Ok(is_one_side.then(|| self.found[start].side))
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
        let sorted = SortedPieces::of(&all, &numbers[..polygons]);
        placed.clear();
        for (number, piece) in all.iter().enumerate() {
            let mut touching: SmallVec<[u32; 16]> = SmallVec::new();
            let mut compared = 0;
            for &other in sorted.touching(&all, piece, tolerance) {
                compared += 1;
                if (other as usize) < number && all[other as usize].touches(piece, tolerance) {
                    touching.push(other);
                }
            }
            beside.watch.work(compared)?;
            touching.sort_unstable();
            let touching =
                touching.iter().map(|&other| (near[other as usize], &all[other as usize]));
            let leaders = of_overlay(faces, beside, (piece, arena), touching, placed)?;
            let NearPiece { hosts: [first, end], is_one_side, .. } = near[number];
            let hosts = &found[first as usize..end as usize];
            let begin = as_u32(placed.len())?;
            let count = leaders.len();
            let (hosts, rest) = match is_one_side {
                true => (&[][..], Some(hosts[0].side)),
                false => (hosts, None),
            };
            let hosts: Vec<&Host> = leaders.iter().chain(hosts).collect();
            let mut parting = Parting { faces, beside, borders, arena, splitter, placed };
            parting.part(*piece, (&hosts, count), rest)?;
            near[number].parts = [begin, as_u32(placed.len())?];
        }
        near.sort_unstable_by_key(|near| near.place);
        merge(near, placed, start, pieces, sides)
    }
}

/// The parts of polygons of the overlay on which a piece lies, of those in `touching`, the largest first. Once one of these
/// contains the piece, smaller ones do not count.
fn of_overlay<'p>(
    faces: &Faces,
    beside: &Beside<'_>,
    (piece, arena): (&Piece, &[Vertex]),
    touching: impl Iterator<Item = (NearPiece, &'p Piece)>,
    placed: &[Placed],
) -> Result<Vec<Host>, Error> {
    let (outline, mut found) = (piece.outline(faces, arena), Vec::new());
    for (NearPiece { parts: [first, end], .. }, whole) in touching {
        let face = whole.face;
        if face == piece.face || !faces.are_coplanar(face, piece.face) {
            continue;
        }
        let parts = &placed[first as usize..end as usize];
        beside.watch.work(parts.len())?;
        for part in parts {
            if !part.piece.touches(piece, faces.tolerance()) {
                continue;
            }
            let host = Host::piece(faces, &part.piece, arena, (beside.plane, part.side));
            if faces.overlap(face, [&host.outline, &outline]) {
                push(&mut found, host)?;
            }
        }
        if faces.is_inside(face, [&outline, &whole.outline(faces, arena)]) {
            break;
        }
    }
    Ok(found)
}

/// The most hosts that are taken one by one, the largest first. Too small: hosts that overlap one another may decide in
/// another order. Too large: time, because each is compared with what is left of the piece.
const FEW_HOSTS: usize = 8;

/// Parts of a piece that are not placed yet, each with the numbers of hosts that it may overlap.
type Unplaced = SmallVec<[(Piece, Vec<u32>); 4]>;

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
    /// Cuts a piece into parts that each go with one of its hosts: the first `leaders` are of the overlay, the others of the
    /// tree. `rest` is the side of parts beyond these, if it is known.
    fn part(
        &mut self,
        piece: Piece,
        (hosts, leaders): (&[&Host], usize),
        rest: Option<Side>,
    ) -> Result<(), Error> {
        let mut stack = Unplaced::new();
        stack.push((piece, (0..hosts.len() as u32).collect()));
        while let Some((piece, mut under)) = stack.pop() {
            self.beside.watch.work(under.len())?;
            let outline = piece.outline(self.faces, self.arena);
            under.retain(|&host| {
                let Host { face, outline: other, .. } = hosts[host as usize];
                self.faces.overlap(*face, [other, &outline])
            });
            let Some(&number) = under.first() else {
                self.place(piece, rest)?;
                continue;
            };
            let first = hosts[number as usize];
            let is_same = |side: Side| side == first.side;
            let is_one = under.iter().all(|&host| is_same(hosts[host as usize].side));
            let is_one = is_one && rest.is_none_or(is_same);
            let is_on_first = || self.faces.is_inside(first.face, [&outline, &first.outline]);
            if (is_one || is_on_first()) && self.may_go(&piece, first.side) {
                self.place(piece, Some(first.side))?;
                continue;
            }
            if first.is_cut
                && let Some(parts) = self.as_cut(piece, hosts, &under)?
            {
                stack.extend(parts);
                continue;
            }
            // Hosts of the tree count where there is none of the overlay.
            let next = under.partition_point(|&host| (host as usize) < leaders);
            let equal = if next == 0 { &under[..] } else { &under[..next] };
            let mut parts = None;
            if equal.len() > FEW_HOSTS {
                parts = self.halves(&piece, hosts, equal)?;
            }
            if parts.is_none() {
                parts = self.separated(&piece, hosts, &under)?;
            }
            if let Some(parts) = parts {
                stack.extend(parts.map(|part| (part, under.clone())));
                continue;
            }
            under.remove(0);
            let mut beyond = SmallVec::new();
            match self.within(piece, first, is_one, &mut beyond)? {
                // The host is beside the piece.
                None => stack.push((piece, under)),
                Some(within) => {
                    stack.extend(beyond.into_iter().map(|part| (part, under.clone())));
                    let may_go = self.may_go(&within, first.side);
                    self.place(within, may_go.then_some(first.side))?;
                }
            }
        }
        Ok(())
    }

    /// Where the plane has cut hosts of a piece, it cuts the piece too. Returns the parts of the piece with their hosts;
    /// `None` if the piece is on the side of all hosts that were cut.
    fn as_cut(
        &mut self,
        piece: Piece,
        hosts: &[&Host],
        under: &[u32],
    ) -> Result<Option<Unplaced>, Error> {
        let on_side = |side: Side| {
            let is_other =
                |host: &Host| host.is_cut && host.side != side && host.side != Side::Coplanar;
            let same = under.iter().filter(|&&host| !is_other(hosts[host as usize]));
            same.copied().collect::<Vec<_>>()
        };
        let plane = self.beside.plane;
        let side = piece.exact_side(self.faces, plane, self.arena);
        if side == Side::Spanning {
            let [front, back] = self.splitter.cut(self.faces, plane, &piece, self.arena)?;
            let parts = [(back, on_side(Side::Back)), (front, on_side(Side::Front))];
            return Ok(Some(parts.into_iter().collect()));
        }
        let left = on_side(side);
        Ok((left.len() < under.len()).then(|| std::iter::once((piece, left)).collect()))
    }

    /// Cuts a piece at the border of its first host beyond which the most hosts of other sides lie. `None` if there is no
    /// such border.
    fn separated(
        &mut self,
        piece: &Piece,
        hosts: &[&Host],
        under: &[u32],
    ) -> Result<Option<[Piece; 2]>, Error> {
        let first = hosts[under[0] as usize];
        let others = || under.iter().map(|&host| hosts[host as usize]);
        let others = || others().filter(|host| host.side != first.side);
        if others().next().is_none() {
            return Ok(None);
        }
        let (mut best, mut most) = (None, 0);
        for (border, inside) in self.borders.of(self.faces, first)? {
            let beyond = others().filter(|host| border.has_beyond(inside, &host.outline)).count();
            self.beside.watch.work(under.len())?;
            if beyond > most {
                (best, most) = (Some((border, inside)), beyond);
            }
        }
        let Some((border, inside)) = best else { return Ok(None) };
        Ok(match self.cut(piece, &border, inside)? {
            Cut::Parts(parts) => Some(parts),
            Cut::Within | Cut::Beyond => None,
        })
    }

    /// Cuts a piece at the borders of a host. Returns the part within them, and appends the others to `beyond`; `None` if
    /// the piece is beside the host. If all hosts are on one side, cuts no more than is needed for a part to go there.
    fn within(
        &mut self,
        mut piece: Piece,
        host: &Host,
        is_one: bool,
        beyond: &mut SmallVec<[Piece; 4]>,
    ) -> Result<Option<Piece>, Error> {
        for (border, inside) in self.borders.of(self.faces, host)? {
            if is_one && self.may_go(&piece, host.side) {
                break;
            }
            match self.cut(&piece, &border, inside)? {
                Cut::Within => {}
                Cut::Beyond => return Ok(None),
                Cut::Parts([within, rest]) => {
                    piece = within;
                    beyond.push(rest);
                }
            }
        }
        Ok(Some(piece))
    }

    fn may_go(&self, piece: &Piece, side: Side) -> bool {
        let cut = piece.cut_vertices(self.arena);
        self.beside.plane.allows(self.faces, piece.face, cut, side)
    }

    /// Cuts a piece at a border, unless it reaches no further than the tolerance beyond it.
    fn cut(&mut self, piece: &Piece, border: &PreparedPlane, inside: Side) -> Result<Cut, Error> {
        let cut = piece.cut_vertices(self.arena);
        if !border.leaves(self.faces, piece.face, cut, inside) {
            return Ok(Cut::Within);
        }
        let side = piece.exact_side(self.faces, border, self.arena);
        if side != Side::Spanning {
            return Ok(if side == inside { Cut::Within } else { Cut::Beyond });
        }
        let [front, back] = self.splitter.cut(self.faces, border, piece, self.arena)?;
        Ok(Cut::Parts(if inside == Side::Front { [front, back] } else { [back, front] }))
    }

    /// Cuts a piece with many hosts at a border of a host in their middle: at the border with the most even numbers of
    /// hosts on its sides. `None` if no border cuts it.
    fn halves(
        &mut self,
        piece: &Piece,
        hosts: &[&Host],
        under: &[u32],
    ) -> Result<Option<[Piece; 2]>, Error> {
        let middle = |&host: &u32| hosts[host as usize].middle();
        let middles: Vec<DVec3> = under.iter().map(middle).collect();
        let low = middles.iter().fold(DVec3::INFINITY, |low, middle| low.min(*middle));
        let high = middles.iter().fold(DVec3::NEG_INFINITY, |high, middle| high.max(*middle));
        let size = (high - low).to_array();
        let axis = (0..3).max_by(|&a, &b| size[a].total_cmp(&size[b])).unwrap_or(0);
        let mut order: Vec<usize> = (0..under.len()).collect();
        let (_, &mut central, _) = order.select_nth_unstable_by(under.len() / 2, |&a, &b| {
            middles[a][axis].total_cmp(&middles[b][axis]).then(a.cmp(&b))
        });
        let central = hosts[under[central] as usize];
        let mut borders = self.borders.of(self.faces, central)?;
        let balance = |border: &PreparedPlane| {
            let in_front = |middle: &&DVec3| border.distance(middle.to_array()) > 0.0;
            let front = middles.iter().filter(in_front).count();
            front.abs_diff(middles.len() - front)
        };
        borders.sort_by_cached_key(|(border, _)| balance(border));
        for (border, inside) in borders {
            if let Cut::Parts(parts) = self.cut(piece, &border, inside)? {
                return Ok(Some(parts));
            }
        }
        Ok(None)
    }

    /// Places a part of the piece. Without a side of its hosts it has its own.
    fn place(&mut self, piece: Piece, side: Option<Side>) -> Result<(), Error> {
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

/// What a border does to a piece.
enum Cut {
    /// The piece is inside, or beyond the border by no more than the tolerance.
    Within,
    Beyond,
    /// The parts inside and beyond.
    Parts([Piece; 2]),
}

/// Replaces the near pieces of a set that begins at `start`, in the order of the set, each by its parts.
fn merge(
    near: &[NearPiece],
    placed: &[Placed],
    start: usize,
    pieces: &mut Vec<Piece>,
    sides: &mut Vec<Side>,
) -> Result<(), Error> {
    let more = placed.len() - near.len();
    reserve(pieces, more)?;
    reserve(sides, more)?;
    let (mut old, mut next) = (pieces.len(), pieces.len() + more);
    pieces.resize(next, placed[0].piece);
    sides.resize(next - start, Side::Coplanar);
    // From the end, so that nothing unread is overwritten.
    for near in near.iter().rev() {
        let parts = &placed[near.parts[0] as usize..near.parts[1] as usize];
        let end = start + near.place as usize + 1;
        let moved = next - (old - end);
        pieces.copy_within(end..old, moved);
        sides.copy_within(end - start..old - start, moved - start);
        (old, next) = (end - 1, moved - parts.len());
        for (at, part) in (next..).zip(parts) {
            (pieces[at], sides[at - start]) = (part.piece, part.side);
        }
    }
    Ok(())
}
