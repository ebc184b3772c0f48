//! Checks the guarantees of a tree, for tests and fuzzers.

mod cover;
#[cfg(test)]
mod tests;

use std::fmt::Display;
use std::ops::Range;

use super::node::{Visit, Walk};
use super::order::eye::Planes;
use super::order::layout::OrderLayout;
use super::{BspTree, Fragment};
use crate::exact::{EdgeLine, PlaneId, PreparedPlane, Side, StoredVertex, Vertex, VertexKind};

const COUNTS: &str = "the sizes of its subtrees contradict each other";

/// The message of a fault at a node. Nodes are counted depth first.
fn fault(node: usize, what: impl Display) -> String {
    format!("node {node}: {what}")
}

impl BspTree {
    /// Checks every invariant of the tree:
    ///
    /// - the sizes of subtrees add up, a leaf has at most one fragment, every plane separates
    ///   fragments, and planes and vertices refer to existing geometry;
    /// - each fragment lies on the correct side of the planes of all nodes above the fragment, up to the
    ///   tolerance (a length); and fragments on a plane are in input order;
    /// - the fragments of each face cover the face exactly once: glued together along the cuts, from the
    ///   leaves up, the fragments form the face with all its corners, and the number of cuts is
    ///   [`Stats::splits`](crate::Stats::splits);
    /// - the auxiliary data for orders matches the nodes, and stored positions match the vertices.
    ///
    /// All checks are exact. A tree that the library built or read is always valid; this method is for tests
    /// and fuzzers.
    ///
    /// Takes O(n · mean depth + n log² n) time for fragments of few vertices, and O(n) memory.
    ///
    /// # Errors
    ///
    /// The first fault found. The invariants are checked in the order of the list.
    #[doc(hidden)]
    pub fn validate(&self) -> Result<(), String> {
        let visits = self.check_sizes()?;
        self.check_names(&visits)?;
        self.check_sides(&visits)?;
        self.check_cover(&visits)?;
        self.check_layout()
    }

    /// Returns the nodes in memory order. Returns an error unless each node and each fragment is visited
    /// exactly once, and each node separates fragments.
    ///
    /// The other checks rely on this check, because they use every number of a visit as an index.
    fn check_sizes(&self) -> Result<Vec<Visit>, String> {
        let mut visits: Vec<Visit> = Vec::new();
        let mut walk = Walk::new(self);
        let mut fragments = 0;
        while let Some(visit) = walk.next(self) {
            fragments += visit.own.len() + visit.leaves();
            if visit.front.len().max(visit.back.len()) > 1 {
                return Err(fault(visit.node, "a leaf has more than one fragment"));
            }
            // With this check the walk ends for any sizes, because each node has fragments on its plane or on
            // both sides. The check also bounds the number of nodes, for which order buffers have room.
            let has_empty_side = visit.in_front.is_empty() || visit.behind.is_empty();
            if visit.own.is_empty() && has_empty_side {
                return Err(fault(visit.node, "its plane separates no fragments"));
            }
            visits.push(visit);
        }
        if visits.len() != self.nodes.len() || fragments != self.records.len() {
            return Err(fault(visits.len().saturating_sub(1), COUNTS));
        }
        self.check_node_counts(&visits)?;
        Ok(visits)
    }

    /// Checks the number of nodes of each subtree, from the last to the first. If all agree, the walk has
    /// visited the nodes in memory order.
    fn check_node_counts(&self, visits: &[Visit]) -> Result<(), String> {
        // A stack of the subtrees whose parents have not been visited yet, front subtrees above back
        // subtrees.
        let mut sizes: Vec<u32> = Vec::new();
        for visit in visits.iter().rev() {
            let node = &self.nodes[visit.node];
            let mut child = |is_node: bool| if is_node { sizes.pop() } else { Some(0) };
            match (child(node.front_nodes > 0), child(node.back_is_node())) {
                (Some(front), Some(back)) if front == node.front_nodes => {
                    sizes.push(1 + front + back);
                }
                _ => return Err(fault(visit.node, COUNTS)),
            }
        }
        Ok(())
    }

    /// Checks that planes, faces and vertices name parts of the input.
    fn check_names(&self, visits: &[Visit]) -> Result<(), String> {
        for visit in visits {
            let plane = self.nodes[visit.node].plane;
            if !self.names_input(plane) {
                let what =
                    format!("its plane {plane:?} names a face or corner that does not exist");
                return Err(fault(visit.node, what));
            }
            for fragment in visit.own.start..visit.back.end {
                let fault =
                    |what| Err(fault(visit.node, format_args!("fragment {fragment} {what}")));
                if !self.has_outline(fragment) {
                    return fault("does not have three or more known vertices");
                }
                let stored = self.fragment(fragment).stored();
                let is_cut = stored.iter().any(|vertex| vertex.line().as_cut().is_some());
                if !stored.is_empty() && !is_cut {
                    return fault("was never cut, but is stored as a cut piece");
                }
            }
        }
        Ok(())
    }

    fn names_input(&self, plane: PlaneId) -> bool {
        self.faces.has_plane(plane)
    }

    /// Whether a fragment has a face, a place among the vertices, and three known vertices or
    /// more.
    fn has_outline(&self, id: u32) -> bool {
        let record = self.records[id as usize];
        let next = self.records.get(id as usize + 1);
        let end = next.map_or(self.vertices.len(), |next| next.vertices as usize);
        // Every vertex belongs to a fragment.
        let begins = id > 0 || record.vertices == 0;
        if !begins || record.face as usize >= self.faces.len() {
            return false;
        }
        let Some(stored) = self.vertices.get(record.vertices as usize..end) else { return false };
        let corners = self.faces.corners(record.face).len() as u32;
        let knows_line = |line: EdgeLine| match (line.as_edge(), line.as_cut()) {
            (Some(edge), _) => edge < corners,
            (None, plane) => plane.is_some_and(|plane| self.names_input(plane)),
        };
        let knows = |vertex: &StoredVertex| {
            let known = match vertex.vertex_id().kind() {
                VertexKind::Corner(k) => k < corners,
                VertexKind::OnEdge(k, plane) => k < corners && self.names_input(plane),
                VertexKind::Inside(g, h) => self.names_input(g) && self.names_input(h),
            };
            known && knows_line(vertex.line())
        };
        stored.iter().all(knows) && (stored.is_empty() || stored.len() >= 3)
    }

    /// Tests each fragment against the planes of all nodes above the fragment, and the fragments on a plane
    /// for input order.
    fn check_sides(&self, visits: &[Visit]) -> Result<(), String> {
        let mut path: Vec<(PreparedPlane, Side)> = Vec::new();
        // The fragments in front of each node of the path.
        let mut in_front: Vec<&Range<u32>> = Vec::new();
        for visit in visits {
            let fault = |what: String| fault(visit.node, what);
            let plane = self.nodes[visit.node].plane;
            path.truncate(visit.depth - 1);
            in_front.truncate(visit.depth - 1);
            if let (Some(parent), Some(in_front)) = (path.last_mut(), in_front.last()) {
                let is_front = in_front.contains(&visit.own.start);
                parent.1 = if is_front { Side::Front } else { Side::Back };
            }
            in_front.push(&visit.in_front);
            let prepared = PreparedPlane::new(&self.faces, plane);
            // Without this check, the classification below would prove nothing, because it uses the builder's
            // code.
            if !prepared.has_length_of(&self.faces) {
                let what = "the tolerance at its plane has the wrong length";
                return Err(fault(what.to_owned()));
            }
            path.push((prepared, Side::Coplanar));
            for (range, side) in [
                (&visit.own, Side::Coplanar),
                (&visit.front, Side::Front),
                (&visit.back, Side::Back),
            ] {
                if let Some(last) = path.last_mut() {
                    last.1 = side;
                }
                for fragment in range.clone() {
                    self.check_sides_of(fragment, &path).map_err(fault)?;
                }
            }
            let face = |fragment: u32| self.records[fragment as usize].face;
            if let Some(late) = visit.own.clone().skip(1).find(|&id| face(id) < face(id - 1)) {
                let what = "on its plane precedes a fragment of an earlier polygon";
                return Err(fault(format!("fragment {} {what}", late - 1)));
            }
        }
        Ok(())
    }

    fn check_sides_of(&self, id: u32, path: &[(PreparedPlane, Side)]) -> Result<(), String> {
        let vertices = self.restored(id);
        let cut = (!vertices.is_empty()).then_some(&vertices[..]);
        let face = self.records[id as usize].face;
        for &(ref prepared, expected) in path {
            let found = prepared.classify(&self.faces, face, cut);
            if found != expected {
                return Err(format!(
                    "fragment {id} is {found:?}, but its place requires {expected:?}"
                ));
            }
        }
        Ok(())
    }

    /// The vertices of a fragment as the builder had them; empty for a whole face.
    fn restored(&self, id: u32) -> Vec<Vertex> {
        let fragment = self.fragment(id);
        let stored = fragment.stored().iter();
        stored.map(|stored| stored.restored(&self.faces, fragment.face())).collect()
    }

    fn check_layout(&self) -> Result<(), String> {
        let mut planes = Planes::default();
        let out_of_memory = |error| fault(0, error);
        planes.fill(&self.faces, &self.nodes).map_err(out_of_memory)?;
        if self.planes != planes {
            return Err(fault(0, "the rounded planes do not match the nodes"));
        }
        if let Some(layout) = &self.layout {
            let expected = OrderLayout::new(&self.nodes, self.records.len() as u32);
            if *layout != expected.map_err(out_of_memory)? {
                return Err(fault(0, "the layout for orders does not match the nodes"));
            }
        }
        self.check_positions()
    }

    /// Checks that stored positions equal the positions computed for the vertices.
    fn check_positions(&self) -> Result<(), String> {
        let fault = Err(fault(0, "the positions do not match the vertices"));
        if !self.positions.is_empty() && self.positions.len() != self.vertices.len() {
            return fault;
        }
        let mut kept = self.positions.iter();
        let is_wrong = |fragment: Fragment<'_>| {
            let stored = fragment.stored().iter().zip(&mut kept);
            stored.into_iter().any(|(stored, &position)| {
                self.faces.position(fragment.face(), stored.vertex_id()) != position
            })
        };
        if self.fragments().any(is_wrong) { fault } else { Ok(()) }
    }
}
