//! The polygons of a tree on which an overlay's shapes lie.

use std::ops::Range;

use glam::DVec3;
use smallvec::SmallVec;

use super::region::Ground;
use crate::build::piece::Piece;
use crate::error::Error;
use crate::exact::{EdgeLine, Faces, Outline, PlaneId, PreparedPlane, Side, Vertex};
use crate::memory::{place, push};
use crate::progress::Watch;
use crate::tree::bounds::outwards;
use crate::tree::node::Ranges;
use crate::tree::{Flat, Fragment};

/// The *hosts* of each shape: the fragments of a tree that are coplanar with the shape and overlap it. They are found
/// when a shape is first asked for.
#[derive(Default)]
pub(super) struct Hosts {
    /// The fragments of one shape after the other, and of each shape those of the largest polygon first: one number for
    /// each pair of a shape and a fragment on which it lies.
    fragments: Vec<u32>,
    of_shapes: Vec<Option<Known>>,
}

/// The hosts of a shape in the part of a tree that was searched last.
#[derive(Clone)]
struct Known {
    /// The number of the [`Ground`].
    ground: u32,
    part: Range<u32>,
    /// The place of the hosts in the list of all.
    hosts: Range<u32>,
}

/// A node of a tree that shapes descend: the fragments on its plane and on its sides.
pub(super) struct At<'a> {
    pub(super) ground: Ground<'a>,
    /// The faces of the overlay.
    pub(super) faces: &'a Faces,
    /// The first of these that is the overlay's own.
    pub(super) first: u32,
    pub(super) plane: &'a PreparedPlane,
    pub(super) node: &'a Ranges,
    pub(super) watch: &'a Watch<'a>,
}

impl Hosts {
    /// Forgets all shapes, and prepares for a number of others.
    pub(super) fn reset(&mut self, shapes: usize) {
        self.fragments.clear();
        self.of_shapes.clear();
        self.of_shapes.resize(shapes, None);
    }

    /// Appends the hosts of a piece at a node of the tree, those of the largest polygon first. `side` is the piece's own
    /// side of the node's plane. Of a piece that leaves the plane, only hosts that come near it count.
    pub(super) fn at(
        &mut self,
        at: &At<'_>,
        (piece, arena): (&Piece, &[Vertex]),
        (side, is_within): (Side, bool),
        found: &mut Vec<Host>,
    ) -> Result<(), Error> {
        let &At { ground, faces, plane, watch, .. } = at;
        let Ranges { own, front, back } = at.node;
        let all = own.start..front.end.max(back.end);
        let Self { fragments, of_shapes } = self;
        let known = &mut of_shapes[(piece.face - at.first) as usize];
        let is_part = |known: &Known| {
            known.ground == ground.number()
                && known.part.start <= all.start
                && all.end <= known.part.end
        };
        let mut outline = Outline::new();
        let hosts = match known {
            Some(known) if is_part(known) => known.hosts.clone(),
            _ => {
                outline = piece.outline(faces, arena);
                if side == Side::Coplanar
                    && let Some(fragment) = at.around(&outline)
                {
                    let origin = Origin::Fragment(fragment);
                    return push(found, Host { origin, side, is_cut: false });
                }
                let start = fragments.len();
                at.find(all.clone(), piece.face, &outline, fragments)?;
                let hosts = place(start)?..place(fragments.len())?;
                *known = Some(Known { ground: ground.number(), part: all, hosts: hosts.clone() });
                hosts
            }
        };
        let hosts = &fragments[hosts.start as usize..hosts.end as usize];
        if outline.is_empty() && !hosts.is_empty() {
            outline = piece.outline(faces, arena);
        }
        let parts = [(own, Side::Coplanar), (front, Side::Front), (back, Side::Back)];
        for &fragment in hosts {
            let part = parts.iter().find(|(part, _)| part.contains(&fragment));
            let (Some(&(_, side)), origin) = (part, Origin::Fragment(fragment)) else { continue };
            watch.work(1)?;
            let host = ground.fragment(faces, fragment);
            let is_cut = host.lines().any(|line| line.as_cut() == Some(plane.id()));
            let vertices = vertices(host);
            // The plane cuts a piece that leaves the plane as it has cut the host.
            let counts =
                is_within || !is_cut && (side == Side::Coplanar || plane.comes_near(&vertices));
            // The shape may have been cut since its hosts were found.
            if counts && faces.overlap(host.face(), [&outline, &vertices]) {
                push(found, Host { origin, side, is_cut })?;
            }
        }
        Ok(())
    }
}

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

/// The most fragments on a plane that are compared with a shape before its hosts are sought. Too small: hosts are sought
/// without need. Too large: time.
const FEW: usize = 8;

impl At<'_> {
    /// A fragment with the node's plane within which a piece lies. It is a host, and most often the only one: if a
    /// larger polygon that is coplanar with it and overlaps it left the plane, the tree would usually have that
    /// polygon's plane instead.
    fn around(&self, outline: &Outline) -> Option<u32> {
        self.node.own.clone().take(FEW).find(|&number| {
            let fragment = self.ground.fragment(self.faces, number);
            PlaneId::face(fragment.face()) == self.plane.id()
                && self.faces.is_inside(fragment.face(), [outline, &vertices(fragment)])
        })
    }

    /// Appends the fragments of a part of the tree that are coplanar with a shape and overlap a piece of it, those of
    /// the largest polygon first.
    fn find(
        &self,
        mut part: Range<u32>,
        shape: u32,
        outline: &Outline,
        found: &mut Vec<u32>,
    ) -> Result<(), Error> {
        let &Self { ground, faces, watch, .. } = self;
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
        let boxes = ground.boxes(faces);
        let next = |part: &mut _| boxes.next_block(part, |block| is_apart(block).then_some(false));
        let start = found.len();
        while let Some((block, _)) = next(&mut part) {
            watch.work(1)?;
            // A block that is not inside is a single fragment.
            let fragment = ground.fragment(faces, block.start);
            if faces.are_coplanar(fragment.face(), shape)
                && faces.overlap(fragment.face(), [outline, &vertices(fragment)])
            {
                push(found, block.start)?;
            }
        }
        found[start..].sort_unstable_by(|&a, &b| {
            faces.largest_first(ground.face(a), ground.face(b)).then(a.cmp(&b))
        });
        Ok(())
    }
}

fn vertices(fragment: Fragment<'_>) -> Outline {
    fragment.lattice_vertices().collect()
}
