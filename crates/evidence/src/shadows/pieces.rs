//! The lit and shadowed parts of faces as convex pieces, exactly.

use std::rc::Rc;

use dashu_int::IBig;
use std::cmp::Ordering;

use super::Zone;
use super::casters::casters;
use super::shade::{Shade, side};
use crate::place::{Place, Plane};
use binspace::BspTree;
use binspace::glam::DVec3;
use binspace::internals::Faces;

/// A convex part of a face. All its inner points see the same points of a lamp.
///
/// It is bounded by edges of the face, and by planes through a point of the lamp and an edge of a face that
/// hides it. Corners are exact: each is the point where two of these planes meet the plane of the face.
#[derive(Clone, Debug)]
pub struct Piece {
    /// The face that the piece is a part of.
    pub face: u32,
    /// For each tested point of the lamp, whether the piece sees it.
    pub sees: Vec<bool>,
    /// Whether one face lies between the piece and all points of the lamp. Then this face also hides the lamp
    /// between these points.
    pub is_umbra: bool,
    corners: Vec<Corner>,
}

/// A corner, and a plane through the edge from this corner to the next, which is not the plane of the face.
#[derive(Clone, Debug)]
struct Corner {
    place: Place,
    edge: Rc<Plane>,
}

impl Piece {
    /// Returns the zone of the piece, by the tested points of the lamp.
    pub fn zone(&self) -> Zone {
        match self.sees.iter().filter(|&&sees| sees).count() {
            0 => Zone::Umbra,
            n if n == self.sees.len() => Zone::Lit,
            _ => Zone::Penumbra,
        }
    }

    /// Returns the corners, exact: coordinates in lattice units, times a weight above 0, and that weight.
    pub fn exact_corners(&self) -> impl Iterator<Item = [IBig; 4]> + '_ {
        self.corners.iter().map(|corner| corner.place.homogeneous())
    }

    /// Returns the corners, each coordinate within a few roundings.
    pub fn corners<'a>(&'a self, faces: &'a Faces) -> impl Iterator<Item = DVec3> + 'a {
        self.corners.iter().map(|corner| faces.lattice().to_world(corner.place.rounded()))
    }

    /// The parts behind a plane and in front of it; `None` for a part without area.
    fn split(self, face: &Plane, by: &Rc<Plane>) -> [Option<Self>; 2] {
        let sides: Vec<Ordering> = self.corners.iter().map(|c| side(by, &c.place)).collect();
        if !sides.contains(&Ordering::Greater) {
            return [Some(self), None];
        }
        if !sides.contains(&Ordering::Less) {
            return [None, Some(self)];
        }
        let part =
            |kept: Ordering| Self { corners: self.part(face, by, &sides, kept), ..self.clone() };
        [Some(part(Ordering::Less)), Some(part(Ordering::Greater))]
    }

    /// The corners of the part on one side of a plane that goes through the piece.
    fn part(
        &self,
        face: &Plane,
        by: &Rc<Plane>,
        sides: &[Ordering],
        kept: Ordering,
    ) -> Vec<Corner> {
        let mut corners = Vec::with_capacity(self.corners.len() + 1);
        for (k, corner) in self.corners.iter().enumerate() {
            let (here, next) = (sides[k], sides[(k + 1) % sides.len()]);
            let leaves = next == kept.reverse();
            if here == kept {
                corners.push(corner.clone());
            } else if here == Ordering::Equal {
                let edge = if leaves { by } else { &corner.edge };
                corners.push(Corner { place: corner.place.clone(), edge: Rc::clone(edge) });
            }
            // The edge has ends on both sides, so it meets the plane in one point.
            if here != Ordering::Equal
                && next == here.reverse()
                && let Some(place) = Place::meeting([face, &corner.edge, by])
            {
                let edge = if leaves { by } else { &corner.edge };
                corners.push(Corner { place, edge: Rc::clone(edge) });
            }
        }
        corners
    }
}

/// The pieces of all faces of a tree, and the work that they took.
#[derive(Clone, Debug)]
pub struct Pieces {
    /// The pieces, face after face.
    pub pieces: Vec<Piece>,
    /// The number of faces tested as casters of a shadow on another: the sum over all faces and all points of
    /// the lamp.
    pub tried: usize,
}

/// Cuts all faces of a tree along the boundaries of the shadows that points of a lamp cast. A face whose
/// plane contains a point of the lamp sees nothing of this point.
///
/// Each face is cut by the shadows of the faces that the tree's boxes find between it and the lamp. Time
/// grows with these and with the number of pieces. The lamp is rounded to the faces' lattice.
pub fn pieces(tree: &BspTree, lamp: &[DVec3]) -> Pieces {
    pieces_by(tree.faces(), lamp, |corners, at| casters(tree, corners, at))
}

/// The pieces. The function `casters` finds the faces that may throw a shadow from a point on a face with the
/// given corners.
pub(super) fn pieces_by(
    faces: &Faces,
    lamp: &[DVec3],
    casters: impl Fn(&[DVec3], DVec3) -> Vec<u32>,
) -> Pieces {
    let shades: Vec<Vec<Option<Shade>>> = lamp.iter().map(|&at| Shade::all(faces, at)).collect();
    let mut found = Pieces { pieces: Vec::new(), tried: 0 };
    for face in 0..faces.len() as u32 {
        let whole = whole(faces, face, lamp.len());
        let corners: Vec<DVec3> = whole.corners(faces).collect();
        // A face sees nothing of a lamp in its plane, even if nothing is between them.
        let is_asked = |number: usize| shades[number][face as usize].is_some();
        let casters = |(number, &at): (usize, &DVec3)| match is_asked(number) {
            true => casters(&corners, at),
            false => Vec::new(),
        };
        let casters: Vec<Vec<u32>> = lamp.iter().enumerate().map(casters).collect();
        found.tried += casters.iter().map(Vec::len).sum::<usize>();
        found.pieces.extend(pieces_of(faces, whole, &shades, &casters));
    }
    found
}

/// The pieces of one face. `shades` contains the shade of each face for each point of the lamp. `casters`
/// contains the faces that may cast a shadow on this face.
fn pieces_of(
    faces: &Faces,
    whole: Piece,
    shades: &[Vec<Option<Shade>>],
    casters: &[Vec<u32>],
) -> Vec<Piece> {
    let face = whole.face;
    let plane = Plane::of_face(faces, face);
    let mut pieces = vec![whole];
    for (number, shades) in shades.iter().enumerate() {
        if shades[face as usize].is_none() {
            pieces.iter_mut().for_each(|piece| piece.sees[number] = false);
            continue;
        }
        for shade in casters[number].iter().filter_map(|&hiding| shades[hiding as usize].as_ref()) {
            let dim = |piece: &mut Piece| piece.sees[number] = false;
            pieces = cut(pieces, &plane, &shade.planes, |piece| piece.sees[number], dim);
        }
    }
    // A face that hides the whole lamp hides each point of the lamp, except the points that see the face
    // edge-on.
    let asked = (0..shades.len()).filter(|&number| shades[number][face as usize].is_some());
    let lists: Vec<&Vec<u32>> = asked.map(|number| &casters[number]).collect();
    let Some((first, others)) = lists.split_first() else { return pieces };
    let of_all = |hiding: &&u32| others.iter().all(|list| list.binary_search(hiding).is_ok());
    for &hiding in first.iter().filter(of_all) {
        let all: Option<Vec<&Shade>> =
            shades.iter().map(|of| of[hiding as usize].as_ref()).collect();
        let planes = all.into_iter().flatten().flat_map(|shade| shade.planes.iter().cloned());
        let planes: Vec<Rc<Plane>> = planes.collect();
        if !planes.is_empty() {
            let is_asked = |piece: &Piece| piece.zone() == Zone::Umbra && !piece.is_umbra;
            pieces = cut(pieces, &plane, &planes, is_asked, |piece| piece.is_umbra = true);
        }
    }
    pieces
}

/// Cuts out of pieces the part that is in front of all given planes, and marks it.
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
            // No part is in front of all planes, so the piece need not be cut.
            None => result.push(piece),
        }
    }
    result
}

/// A whole face, lit by all.
fn whole(faces: &Faces, face: u32, lamps: usize) -> Piece {
    let plane = Plane::of_face(faces, face);
    let places: Vec<Place> =
        (0..faces.corners(face).len()).map(|k| Place::corner(faces, face, &plane, k)).collect();
    let next = places.iter().cycle().skip(1);
    let upright = plane.direction();
    let corners = places.iter().zip(next).map(|(place, next)| Corner {
        place: place.clone(),
        edge: Rc::new(Plane::joining([&upright, &place.homogeneous(), &next.homogeneous()])),
    });
    Piece { face, sees: vec![true; lamps], is_umbra: false, corners: corners.collect() }
}
