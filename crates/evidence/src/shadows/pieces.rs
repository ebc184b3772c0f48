//! The lit and shadowed parts of faces as convex pieces, exactly.

use std::rc::Rc;

use num_bigint::{BigInt, Sign};

use super::Zone;
use super::shade::{Shade, side};
use crate::place::{Place, Plane};
use binspace::glam::DVec3;
use binspace::internals::Faces;

/// A convex part of a face, all of whose inner points see the same of a lamp.
///
/// It is bounded by edges of the face, and by planes through a point of the lamp and an edge of a
/// face that hides it. Corners are exact: each is where two such planes meet the face's own.
#[derive(Clone, Debug)]
pub struct Piece {
    /// The face that it is a part of.
    pub face: u32,
    /// Whether it sees each point of the lamp that was asked for.
    pub sees: Vec<bool>,
    /// Whether one face lies between it and all points of the lamp: that face hides all that is
    /// between these points as well.
    pub is_umbra: bool,
    corners: Vec<Corner>,
}

/// A corner, and a plane through the edge from there to the next; it is not the face's own.
#[derive(Clone, Debug)]
struct Corner {
    place: Place,
    edge: Rc<Plane>,
}

impl Piece {
    /// Which zone it is in, by the points of the lamp that were asked for.
    pub fn zone(&self) -> Zone {
        match self.sees.iter().filter(|&&sees| sees).count() {
            0 => Zone::Umbra,
            n if n == self.sees.len() => Zone::Lit,
            _ => Zone::Penumbra,
        }
    }

    /// The corners, exact: coordinates in lattice units, times a weight above 0, and that weight.
    pub fn exact_corners(&self) -> impl Iterator<Item = [BigInt; 4]> + '_ {
        self.corners.iter().map(|corner| corner.place.homogeneous())
    }

    /// The corners, each coordinate within a few roundings.
    pub fn corners<'a>(&'a self, faces: &'a Faces) -> impl Iterator<Item = DVec3> + 'a {
        self.corners.iter().map(|corner| faces.lattice().to_world(corner.place.rounded()))
    }

    /// The parts behind a plane and in front of it, where they have an area.
    fn split(self, face: &Plane, by: &Rc<Plane>) -> [Option<Self>; 2] {
        let sides: Vec<Sign> = self.corners.iter().map(|c| side(by, &c.place)).collect();
        if !sides.contains(&Sign::Plus) {
            return [Some(self), None];
        }
        if !sides.contains(&Sign::Minus) {
            return [None, Some(self)];
        }
        let part = |kept: Sign| Self { corners: self.part(face, by, &sides, kept), ..self.clone() };
        [Some(part(Sign::Minus)), Some(part(Sign::Plus))]
    }

    /// The corners of the part on one side of a plane that goes through the piece.
    fn part(&self, face: &Plane, by: &Rc<Plane>, sides: &[Sign], kept: Sign) -> Vec<Corner> {
        let mut corners = Vec::with_capacity(self.corners.len() + 1);
        for (k, corner) in self.corners.iter().enumerate() {
            let (here, next) = (sides[k], sides[(k + 1) % sides.len()]);
            let leaves = next == -kept;
            if here == kept {
                corners.push(corner.clone());
            } else if here == Sign::NoSign {
                let edge = if leaves { by } else { &corner.edge };
                corners.push(Corner { place: corner.place.clone(), edge: Rc::clone(edge) });
            }
            // The edge has ends on both sides, so it meets the plane in one point.
            if here != Sign::NoSign
                && next == -here
                && let Some(place) = Place::meeting([face, &corner.edge, by])
            {
                let edge = if leaves { by } else { &corner.edge };
                corners.push(Corner { place, edge: Rc::clone(edge) });
            }
        }
        corners
    }
}

/// Cuts all faces along the rims of the shadows that points of a lamp throw. What a face's own plane
/// goes through the lamp is in its light edge-on, and sees nothing of it.
///
/// Every face is cut by the shadow of every other: time grows with the square of their number, and
/// with the number of pieces. The lamp is rounded to the faces' lattice.
pub fn pieces(faces: &Faces, lamp: &[DVec3]) -> Vec<Piece> {
    let shades: Vec<Vec<Option<Shade>>> = lamp.iter().map(|&at| Shade::all(faces, at)).collect();
    (0..faces.len() as u32).flat_map(|face| pieces_of(faces, face, &shades)).collect()
}

/// The pieces of one face. `shades` has, for each point of the lamp, the shade of each face.
fn pieces_of(faces: &Faces, face: u32, shades: &[Vec<Option<Shade>>]) -> Vec<Piece> {
    let plane = Plane::of_face(faces, face);
    let mut pieces = vec![whole(faces, face, &plane, shades.len())];
    for (number, shades) in shades.iter().enumerate() {
        if shades[face as usize].is_none() {
            pieces.iter_mut().for_each(|piece| piece.sees[number] = false);
            continue;
        }
        for shade in shades.iter().flatten() {
            let dim = |piece: &mut Piece| piece.sees[number] = false;
            pieces = cut(pieces, &plane, &shade.planes, |piece| piece.sees[number], dim);
        }
    }
    for hiding in 0..faces.len() {
        let all: Option<Vec<&Shade>> = shades.iter().map(|of| of[hiding].as_ref()).collect();
        let planes = all.into_iter().flatten().flat_map(|shade| shade.planes.iter().cloned());
        let planes: Vec<Rc<Plane>> = planes.collect();
        if !planes.is_empty() {
            let is_asked = |piece: &Piece| piece.zone() == Zone::Umbra && !piece.is_umbra;
            pieces = cut(pieces, &plane, &planes, is_asked, |piece| piece.is_umbra = true);
        }
    }
    pieces
}

/// Cuts what is in front of all of some planes out of pieces, and marks it.
fn cut(
    pieces: Vec<Piece>,
    face: &Plane,
    planes: &[Rc<Plane>],
    is_asked: impl Fn(&Piece) -> bool,
    mark: impl Fn(&mut Piece),
) -> Vec<Piece> {
    let mut result = Vec::with_capacity(pieces.len());
    for piece in pieces {
        if !is_asked(&piece) {
            result.push(piece);
            continue;
        }
        let (mut outside, mut rest) = (Vec::new(), Some(piece.clone()));
        for plane in planes {
            let Some(part) = rest else { break };
            let [behind, front] = part.split(face, plane);
            outside.extend(behind);
            rest = front;
        }
        match rest {
            Some(mut inside) => {
                mark(&mut inside);
                result.extend(outside);
                result.push(inside);
            }
            // Nothing is in front of all: it need not be cut.
            None => result.push(piece),
        }
    }
    result
}

/// A whole face, lit by all.
fn whole(faces: &Faces, face: u32, plane: &Plane, lamps: usize) -> Piece {
    let places: Vec<Place> =
        (0..faces.corners(face).len()).map(|k| Place::corner(faces, face, plane, k)).collect();
    let next = places.iter().cycle().skip(1);
    let upright = plane.direction();
    let corners = places.iter().zip(next).map(|(place, next)| Corner {
        place: place.clone(),
        edge: Rc::new(Plane::joining([&upright, &place.homogeneous(), &next.homogeneous()])),
    });
    Piece { face, sees: vec![true; lamps], is_umbra: false, corners: corners.collect() }
}
