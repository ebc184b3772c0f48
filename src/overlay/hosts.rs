//! The polygons on which an overlay's shapes lie, and their borders.

use std::collections::HashMap;

use glam::DVec3;
use smallvec::SmallVec;

use super::following::Beside;
use crate::build::piece::Piece;
use crate::error::Error;
use crate::exact::{EdgeLine, Faces, Outline, PlaneId, PreparedPlane, Side, Vertex};
use crate::memory::push;
use crate::tree::bounds::outwards;
use crate::tree::node::Ranges;
use crate::tree::{Flat, Fragment};

/// A polygon on which a piece lies: a fragment of a tree, or a piece of the overlay.
#[derive(Debug)]
pub(super) struct Host {
    pub(super) face: u32,
    pub(super) outline: Outline,
    /// The lines that bound the polygon.
    lines: SmallVec<[EdgeLine; 4]>,
    /// The side of a plane on which the polygon is, and whether the plane bounds it.
    pub(super) side: Side,
    pub(super) is_cut: bool,
}

impl Host {
    fn new(
        face: u32,
        outline: Outline,
        lines: impl Iterator<Item = EdgeLine>,
        (plane, side): (&PreparedPlane, Side),
    ) -> Self {
        let lines: SmallVec<[EdgeLine; 4]> = lines.collect();
        let is_cut = lines.iter().any(|line| line.as_cut() == Some(plane.id()));
        Self { face, outline, lines, side, is_cut }
    }

    /// A piece of the overlay.
    pub(super) fn piece(
        faces: &Faces,
        piece: &Piece,
        arena: &[Vertex],
        beside: (&PreparedPlane, Side),
    ) -> Self {
        let outline = piece.outline(faces, arena);
        match piece.cut_vertices(arena) {
            Some(cut) => Self::new(piece.face, outline, cut.iter().map(Vertex::line), beside),
            None => {
                let lines = (0..outline.len() as u32).map(EdgeLine::edge);
                Self::new(piece.face, outline, lines, beside)
            }
        }
    }

    /// A point inside.
    pub(super) fn middle(&self) -> DVec3 {
        let sum: DVec3 = self.outline.iter().map(|p| DVec3::from(*p)).sum();
        sum / self.outline.len() as f64
    }
}

/// The planes through the edges of hosts, across the surface, so far.
#[derive(Default)]
pub(super) struct Borders {
    /// The plane through the edge that begins at a corner, counted over all faces.
    planes: HashMap<u32, Option<PlaneId>>,
}

impl Borders {
    /// Forgets all planes.
    pub(super) fn clear(&mut self) {
        self.planes.clear();
    }

    /// The planes that bound a host, and on which side of each the host is.
    pub(super) fn of(
        &mut self,
        faces: &mut Faces,
        host: &Host,
    ) -> Result<SmallVec<[(PreparedPlane, Side); 4]>, Error> {
        let middle = host.middle().to_array();
        let mut borders = SmallVec::new();
        for line in &host.lines {
            let plane = match line.as_edge() {
                Some(k) => self.through(faces, host.face, k)?,
                None => line.as_cut(),
            };
            let Some(plane) = plane else { continue };
            let plane = PreparedPlane::new(faces, plane);
            let is_behind = match line.as_cut() {
                Some(_) => line.is_behind(),
                None => plane.distance(middle) < 0.0,
            };
            borders.push((plane, if is_behind { Side::Back } else { Side::Front }));
        }
        Ok(borders)
    }

    /// The plane through an edge of a face, if it is defined.
    fn through(&mut self, faces: &mut Faces, face: u32, k: u32) -> Result<Option<PlaneId>, Error> {
        let corner = faces.corner_range(face).start as u32 + k;
        if let Some(&known) = self.planes.get(&corner) {
            return Ok(known);
        }
        let plane = faces.push_border(face, k)?;
        self.planes.insert(corner, plane);
        Ok(plane)
    }
}

/// The most fragments on a plane that are compared with a piece before its hosts are sought. Too small: hosts are sought
/// without need. Too large: time.
const FEW_OWN: usize = 8;

/// A piece whose hosts are sought.
pub(super) struct Sought<'a> {
    pub(super) piece: &'a Piece,
    pub(super) arena: &'a [Vertex],
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
        let &Sought { piece, arena, outline, side, .. } = sought;
        if side == Side::Coplanar
            && let Some(fragment) = self.around(faces, outline)
        {
            push(found, self.as_host(faces, fragment, side))?;
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
                    let cut = piece.cut_vertices(arena);
                    let may_go = self.plane.allows(faces, piece.face, cut, side);
                    is_open |= found.len() > start || !may_go;
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
        found[start..].sort_by(|a, b| faces.largest_first(a.face, b.face));
        Ok(false)
    }

    /// A fragment with the node's plane within which a piece lies. It is a host, and most often the only one: if a
    /// larger polygon that is coplanar with it and overlaps it left the plane, the tree would usually have that
    /// polygon's plane instead.
    fn around(&self, faces: &Faces, outline: &Outline) -> Option<u32> {
        self.node.own.clone().take(FEW_OWN).find(|&number| {
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
        if !faces.are_coplanar(self.ground.face(fragment), sought.piece.face) {
            return Ok(None);
        }
        let host = self.as_host(faces, fragment, side);
        // The plane cuts a piece that leaves the plane as it has cut the host.
        let counts = sought.is_within
            || !host.is_cut && (side == Side::Coplanar || self.plane.comes_near(&host.outline));
        let is_host = counts && faces.overlap(host.face, [sought.outline, &host.outline]);
        Ok(is_host.then_some(host))
    }

    fn as_host(&self, faces: &Faces, fragment: u32, side: Side) -> Host {
        let fragment = self.ground.fragment(faces, fragment);
        let beside = (self.plane, side);
        Host::new(fragment.face(), vertices(fragment), fragment.lines(), beside)
    }
}

fn vertices(fragment: Fragment<'_>) -> Outline {
    fragment.lattice_vertices().collect()
}
