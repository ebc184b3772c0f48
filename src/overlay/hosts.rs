//! The polygons of a tree on which an overlay's shapes lie.

use glam::DVec3;
use smallvec::SmallVec;

use super::following::Beside;
use super::region::Ground;
use crate::build::piece::Piece;
use crate::error::Error;
use crate::exact::{EdgeLine, Faces, Outline, PlaneId, Side, Vertex};
use crate::memory::push;
use crate::tree::bounds::outwards;
use crate::tree::node::Ranges;
use crate::tree::{Flat, Fragment};

/// A polygon on which a piece lies, and its side of a plane.
#[derive(Clone, Debug)]
pub(super) struct Host {
    pub(super) origin: Origin,
    pub(super) side: Side,
    /// Whether the plane bounds the polygon.
    pub(super) is_cut: bool,
}

/// A polygon of a tree, or of the overlay.
#[derive(Clone, Debug)]
pub(super) enum Origin {
    Fragment(u32),
    Piece(Piece),
}

impl Host {
    /// The face and the vertices.
    pub(super) fn outline(
        &self,
        ground: Ground<'_>,
        faces: &Faces,
        arena: &[Vertex],
    ) -> (u32, Outline) {
        match self.origin {
            Origin::Fragment(fragment) => {
                let fragment = ground.fragment(faces, fragment);
                (fragment.face(), vertices(fragment))
            }
            Origin::Piece(piece) => (piece.face, piece.outline(faces, arena)),
        }
    }

    /// The lines that bound the polygon.
    pub(super) fn lines(
        &self,
        ground: Ground<'_>,
        faces: &Faces,
        arena: &[Vertex],
    ) -> SmallVec<[EdgeLine; 4]> {
        match self.origin {
            Origin::Fragment(fragment) => ground.fragment(faces, fragment).lines().collect(),
            Origin::Piece(piece) => match piece.cut_vertices(arena) {
                Some(cut) => cut.iter().map(Vertex::line).collect(),
                None => Vertex::corners(faces, piece.face).map(|corner| corner.line()).collect(),
            },
        }
    }
}

/// The most fragments on a plane that are compared with a piece before its hosts are sought. Too small: hosts are sought
/// without need. Too large: time.
const FEW: usize = 8;

/// A piece whose hosts are sought.
pub(super) struct Sought<'a> {
    pub(super) piece: &'a Piece,
    pub(super) outline: &'a Outline,
    /// The piece's own side of the plane.
    pub(super) side: Side,
    /// Whether the piece stays within twice the tolerance of the plane.
    pub(super) is_within: bool,
}

impl Beside<'_> {
    /// Appends the *hosts* of a piece: the fragments at a node that are coplanar with the piece and overlap it, those of
    /// the largest polygon first. Of a piece that leaves the plane, only hosts that come near it count. If all hosts are
    /// on the side where the piece may go as a whole, appends one of them and returns true.
    pub(super) fn hosts(
        &self,
        faces: &Faces,
        sought: &Sought<'_>,
        found: &mut Vec<Host>,
    ) -> Result<bool, Error> {
        let &Sought { outline, side, is_within, .. } = sought;
        if side == Side::Coplanar
            && let Some(fragment) = self.around(faces, outline)
        {
            push(found, Host { origin: Origin::Fragment(fragment), side, is_cut: false })?;
            return Ok(true);
        }
        let near = self.boxes_near(faces, outline)?;
        let start = found.len();
        // The first host on each side: most often there is no other side, and one host is enough.
        let mut is_open = false;
        let Ranges { own, front, back } = self.node;
        let parts = [(own, Side::Coplanar), (front, Side::Front), (back, Side::Back)];
        for (part, side) in parts {
            let first = near.partition_point(|&fragment| fragment < part.start);
            for &fragment in near[first..].iter().take_while(|fragment| part.contains(fragment)) {
                if let Some(host) = self.host(faces, sought, fragment, side)? {
                    is_open |= found.len() > start || !is_within && side != sought.side;
                    push(found, host)?;
                    break;
                }
            }
        }
        if !is_open {
            return Ok(found.len() > start);
        }
        found.truncate(start);
        for &fragment in &near {
            let part = parts.iter().find(|(part, _)| part.contains(&fragment));
            let Some(&(_, side)) = part else { continue };
            if let Some(host) = self.host(faces, sought, fragment, side)? {
                push(found, host)?;
            }
        }
        let face = |host: &Host| match host.origin {
            Origin::Fragment(fragment) => (self.ground.face(fragment), fragment),
            Origin::Piece(piece) => (piece.face, 0),
        };
        found[start..].sort_by(|a, b| {
            let [a, b] = [a, b].map(face);
            faces.largest_first(a.0, b.0).then(a.1.cmp(&b.1))
        });
        Ok(false)
    }

    /// A fragment with the node's plane within which a piece lies. It is a host, and most often the only one: if a
    /// larger polygon that is coplanar with it and overlaps it left the plane, the tree would usually have that
    /// polygon's plane instead.
    fn around(&self, faces: &Faces, outline: &Outline) -> Option<u32> {
        self.node.own.clone().take(FEW).find(|&number| {
            let fragment = self.ground.fragment(faces, number);
            PlaneId::face(fragment.face()) == self.plane.id()
                && faces.is_inside(fragment.face(), [outline, &vertices(fragment)])
        })
    }

    /// The fragments at the node whose boxes come within twice the tolerance of a piece's box, in ascending order.
    fn boxes_near(&self, faces: &Faces, outline: &Outline) -> Result<SmallVec<[u32; 16]>, Error> {
        let nothing = [DVec3::INFINITY, DVec3::NEG_INFINITY];
        let union = |[low, high]: [DVec3; 2], &corner: &[f64; 3]| {
            [low.min(corner.into()), high.max(corner.into())]
        };
        let [low, high] = outline.iter().fold(nothing, union);
        let reach = DVec3::splat(2.0 * faces.tolerance());
        let around = outwards((low - reach).to_array(), (high + reach).to_array());
        let is_apart = |bounds: &Flat| {
            (0..3).any(|axis| bounds[axis] > around[axis + 3] || around[axis] > bounds[axis + 3])
        };
        let boxes = self.ground.boxes(faces);
        let next = |part: &mut _| boxes.next_block(part, |block| is_apart(block).then_some(false));
        let (mut part, mut near) = (self.node.all(), SmallVec::new());
        while let Some((block, _)) = next(&mut part) {
            // A block that is not inside is a single fragment.
            near.push(block.start);
        }
        self.watch.work(near.len())?;
        Ok(near)
    }

    /// A fragment as a host of a piece, if it is one.
    fn host(
        &self,
        faces: &Faces,
        sought: &Sought<'_>,
        fragment: u32,
        side: Side,
    ) -> Result<Option<Host>, Error> {
        self.watch.work(1)?;
        let host = self.ground.fragment(faces, fragment);
        if !faces.are_coplanar(host.face(), sought.piece.face) {
            return Ok(None);
        }
        let is_cut = host.lines().any(|line| line.as_cut() == Some(self.plane.id()));
        let vertices = vertices(host);
        // The plane cuts a piece that leaves the plane as it has cut the host.
        let counts = sought.is_within
            || !is_cut && (side == Side::Coplanar || self.plane.comes_near(&vertices));
        let is_host = counts && faces.overlap(host.face(), [sought.outline, &vertices]);
        Ok(is_host.then_some(Host { origin: Origin::Fragment(fragment), side, is_cut }))
    }
}

fn vertices(fragment: Fragment<'_>) -> Outline {
    fragment.lattice_vertices().collect()
}
