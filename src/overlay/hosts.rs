//! The polygons of a tree on which an overlay's shapes lie.
//!
//! A shape can lie on a partition plane of the tree and also on a larger polygon that leaves this plane: the plane of a
//! small polygon is less certain, and extended across a large polygon in the same plane it can deviate from that
//! polygon by more than the tolerance. The tree then has the large polygon on one side of the plane, and the shape
//! has to go there too.

use std::ops::Range;

use glam::DVec3;

use crate::build::piece::Piece;
use crate::error::Error;
use crate::exact::{Faces, Outline, PlaneId, Side, Vertex};
use crate::memory::{place, push};
use crate::progress::Watch;
use crate::tree::bounds::outwards;
use crate::tree::node::Ranges;
use crate::tree::{BspTree, Flat, Fragment};

/// The *hosts* of each shape: the fragments of a tree that are coplanar with the shape and overlap it. They are found
/// when a shape is first asked for.
#[derive(Default)]
pub(super) struct Hosts {
    /// The fragments of one shape after the other, and of each shape those of the largest polygon first: one number for
    /// each pair of a shape and a fragment on which it lies.
    fragments: Vec<u32>,
    /// For each shape the part of the tree that was searched last, and the range of the shape's fragments there.
    of_shapes: Vec<Option<[Range<u32>; 2]>>,
}

impl Hosts {
    /// Forgets all shapes, and prepares for a number of others.
    pub(super) fn reset(&mut self, shapes: usize) {
        self.fragments.clear();
        self.of_shapes.clear();
        self.of_shapes.resize(shapes, None);
    }

    /// The side of a node's plane on which the largest host of a piece is, among the node's fragments; `None` without a
    /// host. `side` is the piece's own side of the plane.
    pub(super) fn side(
        &mut self,
        (tree, faces): (&BspTree, &Faces),
        (piece, arena): (&Piece, &[Vertex]),
        (plane, side): (PlaneId, Side),
        node: &Ranges,
        watch: &Watch<'_>,
    ) -> Result<Option<Side>, Error> {
        let Ranges { own, front, back } = node;
        let all = own.start..front.end.max(back.end);
        let Self { fragments, of_shapes } = self;
        let known = &mut of_shapes[piece.face as usize - tree.faces.len()];
        let is_part = |part: &Range<u32>| part.start <= all.start && all.end <= part.end;
        let range = match known {
            Some([part, range]) if is_part(part) => range.clone(),
            _ => {
                if side == Side::Coplanar {
                    let mut outline = Outline::new();
                    piece.for_each_vertex(faces, arena, |p| outline.push(p));
                    if is_inside(tree, faces, &outline, plane, own) {
                        return Ok(Some(side));
                    }
                }
                let start = fragments.len();
                find((tree, all.clone()), faces, piece.face, fragments, watch)?;
                let range = place(start)?..place(fragments.len())?;
                *known = Some([all, range.clone()]);
                range
            }
        };
        let hosts = &fragments[range.start as usize..range.end as usize];
        let parts = [(own, Side::Coplanar), (front, Side::Front), (back, Side::Back)];
        let side_of = |host| parts.iter().find(|(part, _)| part.contains(host)).map(|part| part.1);
        Ok(hosts.iter().find_map(side_of))
    }
}

/// The most fragments on a plane that are compared with a shape before its hosts are sought. Too small: hosts are sought
/// without need. Too large: time.
const FEW: usize = 8;

/// Whether a piece lies within a polygon that has a given plane, among the fragments on that plane. Then the polygon is a
/// host, and most often the only one: if a larger polygon that is coplanar with it and overlaps it left the plane, the
/// tree would have that polygon's plane instead.
fn is_inside(
    tree: &BspTree,
    faces: &Faces,
    outline: &Outline,
    plane: PlaneId,
    on_plane: &Range<u32>,
) -> bool {
    on_plane.clone().take(FEW).any(|number| {
        let fragment = tree.fragment(number);
        PlaneId::face(fragment.face()) == plane
            && faces.is_inside(fragment.face(), [outline, &vertices(fragment)])
    })
}

/// Appends the fragments of a part of a tree that are coplanar with a shape and overlap it, those of the largest polygon
/// first.
fn find(
    (tree, mut part): (&BspTree, Range<u32>),
    faces: &Faces,
    shape: u32,
    found: &mut Vec<u32>,
    watch: &Watch<'_>,
) -> Result<(), Error> {
    let outline = outline(faces, shape);
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
    let boxes = tree.boxes();
    let next = |part: &mut _| boxes.next_block(part, |block| is_apart(block).then_some(false));
    let start = found.len();
    while let Some((block, _)) = next(&mut part) {
        watch.work(block.len())?;
        for number in block {
            let fragment = tree.fragment(number);
            if faces.are_coplanar(fragment.face(), shape)
                && faces.overlap(fragment.face(), [&outline, &vertices(fragment)])
            {
                push(found, number)?;
            }
        }
    }
    found[start..].sort_unstable_by(|&a, &b| {
        let [one, other] = [a, b].map(|number| tree.records[number as usize].face);
        faces.largest_first(one, other).then(a.cmp(&b))
    });
    Ok(())
}

fn outline(faces: &Faces, shape: u32) -> Outline {
    faces.corners(shape)[..faces.reach(shape)].into()
}

fn vertices(fragment: Fragment<'_>) -> Outline {
    fragment.lattice_vertices().collect()
}
