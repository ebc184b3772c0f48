//! The planes of a tree, rounded and laid out to be held against an eye.

use glam::{DVec3, Vec4};

use crate::Error;
use crate::exact::{Faces, LATTICE_LIMIT, PlaneId, PlaneKind};
use crate::memory::{collect, reserve};
use crate::parallel_map;
use crate::tree::node_record::NodeRecord;

/// How many planes stand together, and how many signs are in a word.
pub(super) const GROUP: usize = 4;
pub(super) const WORD: usize = 32;

/// How many groups one thread makes at a time.
const GROUPS_A_THREAD: usize = 1024;

/// The rounded planes of a tree's nodes, or of its fragments, in their order and by fours: the three
/// coordinates of their unit normals, and their distances from the lattice's origin in 2⁵¹ lattice
/// units. The last group is filled up with zeros.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Planes(pub(super) Vec<[Vec4; 4]>);

/// Up to [`GROUP`] planes, by the component.
fn group(planes: impl Iterator<Item = Vec4>) -> [Vec4; 4] {
    let mut group = [Vec4::ZERO; 4];
    for (i, plane) in planes.enumerate() {
        for (part, value) in group.iter_mut().zip(plane.to_array()) {
            part[i] = value;
        }
    }
    group
}

impl Planes {
    /// The rounded plane of a node, as [`rounded`] has it.
    pub(crate) fn get(&self, node: usize) -> Vec4 {
        let group = &self.0[node / GROUP];
        Vec4::from_array(group.map(|part| part[node % GROUP]))
    }

    pub(in crate::tree) fn clear(&mut self) {
        self.0.clear();
    }

    /// Replaces the planes by those of a tree's nodes.
    pub(in crate::tree) fn fill(
        &mut self,
        faces: &Faces,
        nodes: &[NodeRecord],
    ) -> Result<(), Error> {
        let group =
            |nodes: &[NodeRecord]| group(nodes.iter().map(|node| rounded(faces, node.plane)));
        self.0.clear();
        reserve(&mut self.0, nodes.len().div_ceil(GROUP))?;
        if nodes.len() <= GROUPS_A_THREAD * GROUP {
            self.0.extend(nodes.chunks(GROUP).map(group));
            return Ok(());
        }
        let parts = parallel_map::map(nodes.chunks(GROUPS_A_THREAD * GROUP).collect(), |nodes| {
            collect(nodes.chunks(GROUP).map(group))
        })?;
        parts.into_iter().for_each(|part| self.0.extend(part));
        Ok(())
    }

    /// Planes that are given rounded, in their order.
    pub(in crate::tree) fn of(
        mut planes: impl ExactSizeIterator<Item = Vec4>,
    ) -> Result<Self, Error> {
        let groups = 0..planes.len().div_ceil(GROUP);
        Ok(Self(collect(groups.map(|_| group(planes.by_ref().take(GROUP))))?))
    }

    /// How many words the signs of all planes take, and one more to read past the end.
    pub(in crate::tree) fn words(&self) -> usize {
        self.0.len().div_ceil(WORD / GROUP) + 1
    }

    /// The resident size in bytes, apart from its own.
    pub(in crate::tree) fn bytes(&self) -> usize {
        size_of_val(&*self.0)
    }
}

/// A plane, rounded: its unit normal, and its distance from the lattice's origin in 2⁵¹ lattice units.
pub(crate) fn rounded(faces: &Faces, id: PlaneId) -> Vec4 {
    let plane = match id.kind() {
        // The same numbers as below, without integers and a square root.
        PlaneKind::Axis(axis, corner) => {
            DVec3::AXES[axis].extend(faces.corner(corner)[axis] / LATTICE_LIMIT)
        }
        PlaneKind::Face(face) => {
            let [point, ..] = faces.reference_triangle(face);
            let normal = faces.normal(face);
            let offset = normal.dot(DVec3::from(faces.corner(point)) / LATTICE_LIMIT);
            normal.extend(offset) / normal.length()
        }
    };
    plane.as_vec4()
}
