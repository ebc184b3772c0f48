//! Whether fragments lie where their places in the tree say.

use super::fault::{Fault, Invalid};
use crate::exact::{PreparedPlane, Side, Vertex};
use crate::tree::BspTree;
use crate::tree::node::Visit;

impl BspTree {
    /// Holds each fragment against every plane above it, and those on a plane against the order of
    /// the input.
    pub(super) fn check_sides(&self, visits: &[Visit]) -> Result<(), Invalid> {
        let mut path: Vec<(PreparedPlane, Side)> = Vec::new();
        for visit in visits {
            let fault = |what| Invalid { node: visit.node, what };
            let plane = self.nodes[visit.node].plane;
            path.truncate(visit.depth - 1);
            if let Some(parent) = path.last_mut() {
                parent.1 = if visit.is_front { Side::Front } else { Side::Back };
            }
            let prepared = PreparedPlane::new(&self.faces, plane);
            // Otherwise the classification below, which is the builder's, proves nothing.
            if !prepared.has_length_of(&self.faces) {
                return Err(fault(Fault::Tolerance));
            }
            path.push((prepared, Side::Coplanar));
            for (range, side) in visit.groups() {
                if let Some(last) = path.last_mut() {
                    last.1 = side;
                }
                for fragment in range {
                    self.check_sides_of(fragment, &path).map_err(fault)?;
                }
            }
            let face = |fragment: u32| self.records[fragment as usize].face;
            if let Some(late) = visit.own.clone().skip(1).find(|&id| face(id) < face(id - 1)) {
                return Err(fault(Fault::OwnOrder { fragment: late - 1 }));
            }
        }
        Ok(())
    }

    fn check_sides_of(&self, id: u32, path: &[(PreparedPlane, Side)]) -> Result<(), Fault> {
        let vertices = self.restored(id);
        let cut = (!vertices.is_empty()).then_some(&vertices[..]);
        let face = self.records[id as usize].face;
        for &(ref prepared, expected) in path {
            let found = prepared.classify(&self.faces, face, cut);
            if found != expected {
                return Err(Fault::Side { fragment: id, expected, found });
            }
        }
        Ok(())
    }

    /// The vertices of a fragment as the builder had them; none of a whole face.
    pub(super) fn restored(&self, id: u32) -> Vec<Vertex> {
        let fragment = self.fragment(id);
        let stored = fragment.stored().iter();
        stored.map(|stored| stored.restored(&self.faces, fragment.face())).collect()
    }
}
