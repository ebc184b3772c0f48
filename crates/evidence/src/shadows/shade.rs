//! The region that a face hides from a point of a lamp.

use std::rc::Rc;

use dashu_int::IBig;
use std::cmp::Ordering;

use crate::place::{self, Place, Plane};
use binspace::Viewpoint;
use binspace::glam::DVec3;
use binspace::internals::{Eye, Faces};

/// The region behind a face, as seen from a point: the part in front of all of these planes.
pub(super) struct Shade {
    pub(super) planes: Vec<Rc<Plane>>,
}

impl Shade {
    /// The regions of all faces; `None` for faces whose planes contain the point, because they hide nothing.
    pub(super) fn all(faces: &Faces, from: DVec3) -> Vec<Option<Self>> {
        let eye = place::eye(&Eye::new(Viewpoint::Eye(from), faces.lattice()));
        (0..faces.len() as u32).map(|face| Self::of(faces, face, &eye)).collect()
    }

    fn of(faces: &Faces, face: u32, eye: &[IBig; 4]) -> Option<Self> {
        let plane = Plane::of_face(faces, face);
        let beyond = match plane.at_eye(eye).cmp(&IBig::ZERO) {
            Ordering::Greater => plane.flipped(),
            Ordering::Less => plane.clone(),
            Ordering::Equal => return None,
        };
        let count = faces.corners(face).len();
        let places: Vec<Place> =
            (0..count).map(|k| Place::corner(faces, face, &plane, k)).collect();
        let mut planes = vec![Rc::new(beyond)];
        for k in 0..count {
            let ends = [k, (k + 1) % count].map(|k| places[k].homogeneous());
            let border = Plane::joining([eye, &ends[0], &ends[1]]);
            // The face is convex: all of its other corners are on the same side, or in line.
            let sides = places.iter().map(|place| side(&border, place));
            match sides.into_iter().find(|&side| side != Ordering::Equal) {
                Some(Ordering::Less) => planes.push(Rc::new(border.flipped())),
                Some(_) => planes.push(Rc::new(border)),
                None => {}
            }
        }
        Some(Self { planes })
    }
}

/// The side of a plane that a place is on.
pub(super) fn side(plane: &Plane, place: &Place) -> Ordering {
    plane.at(place).cmp(&IBig::ZERO)
}
