//! Faces behind those of a finished scene, and room on its lattice for them.

use glam::DVec3;

use super::lattice_and_tolerance::Ground;
use super::{Preparation, Preparer};
use crate::error::{Error, InputFault, Kind};
use crate::exact::Faces;
use crate::input::Polygon;
use crate::progress::Watch;

impl Preparer {
    /// Makes the lattices of the scenes to come hold a box, by its lower and upper corner.
    ///
    /// # Errors
    ///
    /// If a coordinate is not finite.
    pub(crate) fn hold(&mut self, room: Option<[DVec3; 2]>) -> Result<(), Error> {
        if room.iter().flatten().any(|corner| !corner.is_finite()) {
            return Err(Kind::Bounds.error());
        }
        self.room = room;
        Ok(())
    }

    /// Appends the faces of more polygons to those of a finished scene, on its lattice and with its
    /// tolerance. More than `limit` are an error. The polygons are numbered from `first` on.
    /// After an error, some of their faces may have been appended.
    pub(crate) fn append<P: Polygon>(
        &mut self,
        faces: &mut Faces,
        polygons: impl IntoIterator<Item = P>,
        first: usize,
        limit: usize,
        watch: &Watch<'_>,
    ) -> Result<Preparation, Error> {
        self.input.read(polygons, limit, watch)?;
        if let Some(polygon) = self.input.first_off(faces.lattice()) {
            return Err(InputFault::OffGrid.of_polygon(polygon));
        }
        let (before, ground) = (faces.len(), Ground::of(faces));
        let lent = Lent::new(self, faces);
        let report = lent.preparer.prepare_all(&ground, watch);
        drop(lent);
        faces.faces[before..].iter_mut().for_each(|face| face.polygon += first as u32);
        Ok(report?.in_world(&ground.lattice))
    }
}

/// Faces that a preparer has while it appends to them. They are given back when this is dropped, also
/// where a callback of the caller's panics.
struct Lent<'a> {
    preparer: &'a mut Preparer,
    faces: &'a mut Faces,
}

impl<'a> Lent<'a> {
    fn new(preparer: &'a mut Preparer, faces: &'a mut Faces) -> Self {
        preparer.builder.faces = std::mem::take(faces);
        Self { preparer, faces }
    }
}

impl Drop for Lent<'_> {
    fn drop(&mut self) {
        *self.faces = std::mem::take(&mut self.preparer.builder.faces);
    }
}
