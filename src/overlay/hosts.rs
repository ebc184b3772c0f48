//! The polygons of a tree on which an overlay's shapes lie.
//!
//! A shape can lie on a partition plane of the tree and also on a larger polygon that leaves this plane: the plane of a
//! small polygon is less certain, and extended across a large polygon in the same plane it can deviate from that
//! polygon by more than the tolerance. The tree then has the large polygon on one side of the plane, and the shape
//! has to go there too.

use std::ops::Range;

use glam::DVec3;

use super::region::Ground;
use crate::build::piece::Piece;
use crate::error::Error;
use crate::exact::{Faces, Outline, PlaneId, PreparedPlane, Side, Vertex};
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

    /// The side of a node's plane on which the largest host of a piece is; `None` without a host. `side` is the piece's
    /// own side. If the plane has cut the host and the piece overlaps both parts, the piece's side is exact.
    pub(super) fn side(
        &mut self,
        at: &At<'_>,
        (piece, arena): (&Piece, &[Vertex]),
        side: Side,
    ) -> Result<Option<Side>, Error> {
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
                if side == Side::Coplanar && at.is_inside(&outline) {
                    return Ok(Some(side));
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
        let mut largest: Option<(u32, Side)> = None;
        for &host in hosts {
            let Some((_, side)) = parts.iter().find(|(part, _)| part.contains(&host)) else {
                continue;
            };
            let face = ground.face(host);
            match largest {
                Some((of, _)) if of != face => break,
                Some((_, first)) if first == *side => continue,
                _ => {}
            }
            watch.work(1)?;
            // The shape may have been cut since its hosts were found.
            if !faces.overlap(face, [&outline, &vertices(ground.fragment(faces, host))]) {
                continue;
            }
            if largest.is_some() {
                return Ok(Some(piece.exact_side(faces, plane, arena)));
            }
            largest = Some((face, *side));
        }
        Ok(largest.map(|(_, side)| side))
    }
}

/// The most fragments on a plane that are compared with a shape before its hosts are sought. Too small: hosts are sought
/// without need. Too large: time.
const FEW: usize = 8;

impl At<'_> {
    /// Whether a piece lies within a polygon that has the node's plane. Then the polygon is a host, and most often the
    /// only one: if a larger polygon that is coplanar with it and overlaps it left the plane, the tree would usually
    /// have that polygon's plane instead.
    fn is_inside(&self, outline: &Outline) -> bool {
        self.node.own.clone().take(FEW).any(|number| {
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
