//! Checking a tree against what it promises.

use std::fmt;

use super::BspTree;
use super::planes::Planes;
use super::schedule::Schedule;
use super::walk::Walk;
use crate::geom::{Kernel, PlaneId, PlaneKind, Side, SymbolKind};

/// What is wrong with a tree, and at which node.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Invalid {
    /// The number of the node, depth first.
    pub node: usize,
    what: Fault,
}

#[derive(Clone, Debug, PartialEq, Eq)]
enum Fault {
    Counts,
    Schedule,
    Plane(PlaneId),
    Fragment { fragment: u32, expected: Side, found: Side },
    Outline { fragment: u32 },
    OwnOrder { fragment: u32 },
}

impl fmt::Display for Invalid {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "node {}: ", self.node)?;
        match self.what {
            Fault::Counts => f.write_str("the sizes of its subtrees contradict each other"),
            Fault::Schedule => f.write_str("orders are not laid out as the nodes below it stand"),
            Fault::Plane(plane) => write!(f, "its plane {plane:?} names nothing of the input"),
            Fault::Fragment { fragment, expected, found } => {
                write!(f, "fragment {fragment} is {found:?}, not {expected:?} as its place says")
            }
            Fault::Outline { fragment } => {
                write!(f, "fragment {fragment} has no outline of three vertices or more")
            }
            Fault::OwnOrder { fragment } => {
                write!(f, "fragment {fragment} on its plane comes before one of an earlier polygon")
            }
        }
    }
}

impl std::error::Error for Invalid {}

impl<K: Kernel> BspTree<K> {
    /// Checks every invariant of the tree, by the decisions of its own kernel: each fragment lies
    /// on its side of every plane above it, fragments on a plane are in input order, the sizes of
    /// subtrees add up, planes and vertices name existing geometry.
    ///
    /// Takes time for every pair of a fragment and a plane above it: O(n · mean depth).
    ///
    /// # Errors
    ///
    /// The first node found to break an invariant.
    pub fn validate(&self) -> Result<(), Invalid> {
        let fault = |node, what| Err(Invalid { node, what });
        let mut path: Vec<(K::Splitter, Side)> = Vec::new();
        let mut walk = Walk::new(self);
        let (mut nodes, mut fragments) = (0, 0);
        while let Some(visit) = walk.next(self) {
            nodes += 1;
            fragments += visit.own.len() + visit.leaves();
            if fragments > self.records.len() || visit.depth > path.len() + 1 {
                return fault(visit.node, Fault::Counts);
            }
            let plane = self.nodes[visit.node].plane;
            if !self.names_input(plane) {
                return fault(visit.node, Fault::Plane(plane));
            }
            path.truncate(visit.depth - 1);
            if let Some(parent) = path.last_mut() {
                parent.1 = if visit.is_front { Side::Front } else { Side::Back };
            }
            path.push((self.kernel.splitter(&self.faces, plane), Side::Coplanar));
            let groups = [
                (visit.own.clone(), Side::Coplanar),
                (visit.front.clone(), Side::Front),
                (visit.back.clone(), Side::Back),
            ];
            for (range, side) in groups {
                if let Some(last) = path.last_mut() {
                    last.1 = side;
                }
                for fragment in range.clone() {
                    self.check_fragment(fragment, &path).or_else(|what| fault(visit.node, what))?;
                }
                let face = |fragment: u32| self.records[fragment as usize].face;
                let late = range.clone().skip(1).find(|&id| face(id) < face(id - 1));
                if let (Some(id), Side::Coplanar) = (late, side) {
                    return fault(visit.node, Fault::OwnOrder { fragment: id - 1 });
                }
            }
        }
        if nodes != self.nodes.len() || fragments != self.records.len() {
            return fault(nodes.saturating_sub(1), Fault::Counts);
        }
        let planes = Planes::new(&self.faces, &self.nodes);
        if self.schedule != Schedule::new(&self.nodes, fragments as u32) || self.planes != planes {
            return fault(0, Fault::Schedule);
        }
        Ok(())
    }

    fn names_input(&self, plane: PlaneId) -> bool {
        match plane.kind() {
            PlaneKind::Face(face) => (face as usize) < self.faces.len(),
            PlaneKind::Axis(axis, corner) => {
                axis < 3 && (corner as usize) < self.faces.corner_count()
            }
        }
    }

    fn check_fragment(&self, id: u32, path: &[(K::Splitter, Side)]) -> Result<(), Fault> {
        let record = self.records[id as usize];
        let outline = Fault::Outline { fragment: id };
        if record.face as usize >= self.faces.len() {
            return Err(outline);
        }
        let fragment = self.fragment(id);
        let corners = self.faces.corners(record.face).len() as u32;
        let vertices = fragment.stored();
        let known = vertices.iter().all(|vertex| match K::symbol(vertex).kind() {
            SymbolKind::Corner(k) => k < corners,
            SymbolKind::OnEdge(k, plane) => k < corners && self.names_input(plane),
            SymbolKind::Inside(g, h) => self.names_input(g) && self.names_input(h),
        });
        if fragment.len() < 3 || !known {
            return Err(outline);
        }
        let vertices: Vec<K::Vertex> = vertices
            .iter()
            .map(|stored| self.kernel.restore(&self.faces, record.face, stored))
            .collect();
        let cut = (!vertices.is_empty()).then_some(&vertices[..]);
        let piece = crate::geom::Piece { face: record.face, cut };
        for (splitter, expected) in path {
            let found = self.kernel.classify(&self.faces, splitter, piece);
            if found != *expected {
                return Err(Fault::Fragment { fragment: id, expected: *expected, found });
            }
        }
        Ok(())
    }
}
