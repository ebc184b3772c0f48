//! Nodes in files.

use crate::exact::PlaneId;
use crate::exact::label::bits::Known;
use crate::save::{LoadError, invalid};
use crate::tree::node::{NodeRecord, finish, make_room};
use crate::tree::parts::{RawChild, RawNode, Record};

const EMPTY: u32 = 0;
const FRAGMENT: u32 = 1;
const NODE: u32 = 2;

/// What a node has on its plane and its sides. (There are as many fragments on a plane as faces at
/// most, and fewer than 2²⁷ faces.)
pub(super) fn shape(node: &RawNode) -> u32 {
    let side = |child| match child {
        RawChild::Leaf(0) => EMPTY,
        RawChild::Leaf(_) => FRAGMENT,
        RawChild::Node => NODE,
    };
    node.own << 4 | side(node.front) << 2 | side(node.back)
}

/// A node from the bits of a file; a side of an unknown kind is taken for empty.
fn raw(&[plane, shape]: &[u32; 2]) -> RawNode {
    let side = |bits| match bits {
        FRAGMENT => RawChild::Leaf(1),
        NODE => RawChild::Node,
        _ => RawChild::Leaf(0),
    };
    let plane = PlaneId::from_bits(plane);
    RawNode { plane, own: shape >> 4, front: side(shape >> 2 & 3), back: side(shape & 3) }
}

/// The nodes of a tree, if they are one tree, which has exactly these fragments, each plane parts
/// something, and fragments on a plane are in input order.
pub(super) fn read(
    bits: &[[u32; 2]],
    records: &[Record],
    known: Known,
) -> Result<Vec<NodeRecord>, LoadError> {
    check(bits, records, known)?;
    let (mut sizes, mut nodes) = (Vec::new(), Vec::new());
    make_room(bits.len(), &mut sizes, &mut nodes).map_err(|_| LoadError::out_of_memory())?;
    finish(bits.iter().map(raw), &mut sizes, &mut nodes);
    Ok(nodes)
}

fn check(bits: &[[u32; 2]], records: &[Record], known: Known) -> Result<(), LoadError> {
    // How many nodes are to come, and the first fragment of those.
    let (mut to_come, mut next) = (usize::from(!bits.is_empty()), 0_usize);
    for (index, bits) in bits.iter().enumerate() {
        let fault = |fault| invalid("node", index, fault);
        let RawNode { plane, own, front, back } = raw(bits);
        if !plane.is_known(known) {
            return Err(fault("names a face or corner that does not exist"));
        }
        if bits[1] >> 2 & 3 > NODE || bits[1] & 3 > NODE {
            return Err(fault("has a side of an unknown kind"));
        }
        if own == 0 && [front, back].contains(&RawChild::Leaf(0)) {
            return Err(fault("has a plane that separates no fragments"));
        }
        let sides = [front, back].map(|side| usize::from(side == RawChild::Node));
        // Its own place first: a node without a parent must not count as its own child.
        let others = to_come.checked_sub(1).ok_or_else(|| fault("has no parent"))?;
        to_come = others + sides[0] + sides[1];
        let on_plane = records.get(next..next + own as usize);
        let on_plane = on_plane.ok_or_else(|| fault("has more fragments than there are"))?;
        if on_plane.windows(2).any(|pair| pair[0].face >= pair[1].face) {
            return Err(fault("has fragments on its plane that are not in input order"));
        }
        let leaves = [front, back].into_iter().filter(|&side| side == RawChild::Leaf(1)).count();
        next += own as usize + leaves;
    }
    if to_come > 0 || next != records.len() {
        return Err(LoadError::of("nodes", "are not those of its fragments"));
    }
    Ok(())
}
