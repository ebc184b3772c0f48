//! The borders of the polygons on which shapes lie.
//!
//! A shape can lie on several polygons of a flat surface whose planes differ by rounding. A plane of the tree near them
//! may then have some in front and others behind. So the shape is cut by planes through the polygons' edges, across the
//! surface.

use std::collections::HashMap;

use glam::DVec3;
use smallvec::SmallVec;

use super::hosts::Host;
use super::region::Ground;
use crate::error::Error;
use crate::exact::{Faces, PlaneId, PreparedPlane, Side, Vertex};

/// The planes through edges so far.
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
        ground: Ground<'_>,
        arena: &[Vertex],
        host: &Host,
    ) -> Result<SmallVec<[(PreparedPlane, Side); 4]>, Error> {
        let (face, outline) = host.outline(ground, faces, arena);
        let middle: DVec3 = outline.iter().map(|p| DVec3::from(*p)).sum();
        let middle = (middle / outline.len() as f64).to_array();
        let mut borders = SmallVec::new();
        for line in host.lines(ground, faces, arena) {
            let plane = match line.as_edge() {
                Some(k) => self.through(faces, face, k)?,
                None => line.as_cut(),
            };
            let Some(plane) = plane else { continue };
            let plane = PreparedPlane::new(faces, plane);
            let is_in_front = plane.distance(middle) > 0.0;
            borders.push((plane, if is_in_front { Side::Front } else { Side::Back }));
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
