//! Whether a tree's parts have sizes that agree, and names of things that exist.

use super::fault::{Fault, Invalid};
use crate::exact::{Line, PlaneId, PlaneKind, StoredVertex, SymbolKind};
use crate::tree::BspTree;
use crate::tree::node::{Visit, Walk};

impl BspTree {
    /// The nodes in memory order, if every node and every fragment is visited exactly once and every
    /// node separates something.
    ///
    /// The other checks rely on this: they index by whatever a visit names.
    pub(super) fn check_sizes(&self) -> Result<Vec<Visit>, Invalid> {
        let fault = |node, what| Err(Invalid { node, what });
        let mut visits: Vec<Visit> = Vec::new();
        let mut walk = Walk::new(self);
        let mut fragments = 0;
        while let Some(visit) = walk.next(self) {
            fragments += visit.own.len() + visit.leaves();
            if visit.front.len().max(visit.back.len()) > 1 {
                return fault(visit.node, Fault::CrowdedLeaf);
            }
            // This makes the walk end whatever the sizes say, because each node takes fragments or
            // divides them. It also bounds the number of nodes, for which order buffers have room.
            let has_empty_side = visit.in_front.is_empty() || visit.behind.is_empty();
            if visit.own.is_empty() && has_empty_side {
                return fault(visit.node, Fault::IdlePlane);
            }
            visits.push(visit);
        }
        if visits.len() != self.nodes.len() || fragments != self.records.len() {
            return fault(visits.len().saturating_sub(1), Fault::Counts);
        }
        self.check_node_counts(&visits)?;
        Ok(visits)
    }

    /// Checks how many nodes each subtree has, from the last to the first. If all agree, the nodes
    /// were met in the order in which they stand.
    fn check_node_counts(&self, visits: &[Visit]) -> Result<(), Invalid> {
        // The subtrees whose parent is still to come, the front's above the back's.
        let mut sizes: Vec<u32> = Vec::new();
        for visit in visits.iter().rev() {
            let node = &self.nodes[visit.node];
            let mut child = |is_node: bool| if is_node { sizes.pop() } else { Some(0) };
            match (child(node.front_nodes > 0), child(node.back_is_node())) {
                (Some(front), Some(back)) if front == node.front_nodes => {
                    sizes.push(1 + front + back);
                }
                _ => return Err(Invalid { node: visit.node, what: Fault::Counts }),
            }
        }
        Ok(())
    }

    /// Checks that planes, faces and vertices name things of the input.
    pub(super) fn check_names(&self, visits: &[Visit]) -> Result<(), Invalid> {
        for visit in visits {
            let fault = |what| Err(Invalid { node: visit.node, what });
            let plane = self.nodes[visit.node].plane;
            if !self.names_input(plane) {
                return fault(Fault::Plane(plane));
            }
            for fragment in visit.fragments() {
                if !self.has_outline(fragment) {
                    return fault(Fault::Outline { fragment });
                }
                let stored = self.fragment(fragment).stored();
                let is_cut = stored.iter().any(|vertex| vertex.line().as_cut().is_some());
                if !stored.is_empty() && !is_cut {
                    return fault(Fault::ListedWhole { fragment });
                }
            }
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

    /// Whether a fragment has a face, a place among the vertices, and three known vertices or
    /// more.
    fn has_outline(&self, id: u32) -> bool {
        let record = self.records[id as usize];
        let next = self.records.get(id as usize + 1);
        let end = next.map_or(self.vertices.len(), |next| next.vertices as usize);
        // All vertices are some fragment's.
        let begins = id > 0 || record.vertices == 0;
        if !begins || record.face as usize >= self.faces.len() {
            return false;
        }
        let Some(stored) = self.vertices.get(record.vertices as usize..end) else { return false };
        let corners = self.faces.corners(record.face).len() as u32;
        let knows_line = |line: Line| match (line.as_edge(), line.as_cut()) {
            (Some(edge), _) => edge < corners,
            (None, plane) => plane.is_some_and(|plane| self.names_input(plane)),
        };
        let knows = |vertex: &StoredVertex| {
            let known = match vertex.symbol().kind() {
                SymbolKind::Corner(k) => k < corners,
                SymbolKind::OnEdge(k, plane) => k < corners && self.names_input(plane),
                SymbolKind::Inside(g, h) => self.names_input(g) && self.names_input(h),
            };
            known && knows_line(vertex.line())
        };
        stored.iter().all(knows) && (stored.is_empty() || stored.len() >= 3)
    }
}
