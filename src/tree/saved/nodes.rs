//! Nodes in files.

use crate::exact::PlaneId;
use crate::exact::label::bits::Known;
use crate::save::{LoadError, invalid};
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

fn child(bits: u32) -> Option<RawChild> {
    match bits {
        EMPTY => Some(RawChild::Leaf(0)),
        FRAGMENT => Some(RawChild::Leaf(1)),
        NODE => Some(RawChild::Node),
        _ => None,
    }
}

/// The nodes of a tree, if they are one tree, which has exactly these fragments, each plane parts
/// something, and fragments on a plane are in input order.
pub(super) fn check(
    bits: &[[u32; 2]],
    records: &[Record],
    known: Known,
) -> Result<Vec<RawNode>, LoadError> {
    let mut nodes = Vec::new();
    nodes.try_reserve_exact(bits.len()).map_err(|_| LoadError::out_of_memory())?;
    // How many nodes are to come, and the first fragment of those.
    let (mut to_come, mut next) = (usize::from(!bits.is_empty()), 0_usize);
    for (index, &[plane, shape]) in bits.iter().enumerate() {
        let fault = |fault| invalid("node", index, fault);
        let plane = PlaneId::from_bits(plane);
        if !plane.is_known(known) {
            return Err(fault("names a face or corner that does not exist"));
        }
        let (front, back) = (child(shape >> 2 & 3), child(shape & 3));
        let (Some(front), Some(back)) = (front, back) else {
            return Err(fault("has a side of an unknown kind"));
        };
        let own = shape >> 4;
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
        nodes.push(RawNode { plane, own, front, back });
    }
    // A tree of one fragment has no node.
    let fragments = if bits.is_empty() { records.len().min(1) } else { next };
    if to_come > 0 || fragments != records.len() {
        return Err(LoadError::of("nodes", "are not those of its fragments"));
    }
    Ok(nodes)
}
