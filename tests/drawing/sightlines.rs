//! The polygons that hide a point, in rationals: their faces, including edges, are between the point and the
//! eye.

use binspace::internals::Lattice;
use num_traits::One;
use testkit::model::Face;
use testkit::prelude::*;
use testkit::rational::Point;

/// The origin of rays, on the lattice of a scene.
pub(crate) enum Origin {
    Eye(Point),
    /// Rays along this direction, without a start.
    Along(Point),
}

/// The cover in front of a point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Cover {
    None,
    Hidden,
    /// The line of sight meets the border of a face, or the point is on a face of another polygon.
    Unsure,
}

/// The faces of a scene, and a camera.
pub(crate) struct Sightlines {
    pub(crate) faces: Vec<(usize, Face)>,
    /// The rounded corners of each face.
    rounded: Vec<Vec<DVec3>>,
    pub(crate) origin: Origin,
    /// The eye or the direction, rounded.
    from: DVec3,
    camera: Camera,
    lattice: Lattice,
}

impl Sightlines {
    /// The rays of a camera; `None` if the eye is not a point of the lattice.
    pub(crate) fn of(tree: &BspTree, camera: &Camera) -> Option<Self> {
        let faces = tree.faces();
        let origin = match camera.viewpoint() {
            Viewpoint::Eye(eye) => {
                let place = faces.lattice().to_lattice(eye);
                let is_exact = place.iter().all(|c| c.fract() == 0.0);
                is_exact.then(|| Origin::Eye(rational::point(place)))?
            }
            Viewpoint::Direction(direction) => Origin::Along(rational::point(direction)),
        };
        let all = (0..faces.len() as u32).map(|face| (faces.polygon(face), Face::new(faces, face)));
        let all: Vec<(usize, Face)> = all.collect();
        let rounded = all.iter().map(|(_, face)| face.corners.iter().map(to_f64).collect());
        let (Origin::Eye(from) | Origin::Along(from)) = &origin;
        let (from, camera, lattice) = (to_f64(from), *camera, *faces.lattice());
        Some(Self { rounded: rounded.collect(), faces: all, origin, from, camera, lattice })
    }

    /// The position of a point in the picture, if it is ahead of the eye and in the picture.
    pub(crate) fn place_of(&self, point: &Point) -> Option<[f64; 2]> {
        if let Origin::Eye(eye) = &self.origin {
            let arm = rational::difference(point, eye);
            if !rational::scalar(&arm, &rational::point(self.camera.forward())).is_positive() {
                return None;
            }
        }
        let at = self.project(point)?;
        let last = self.camera.size().map(|side| f64::from(side) - 1.0);
        (0..2).all(|i| 0.0 < at[i] && at[i] < last[i]).then_some(at)
    }

    /// The point where the line of sight of a point meets the picture's plane.
    pub(crate) fn project(&self, point: &Point) -> Option<[f64; 2]> {
        // Pixels of cameras begin at the picture's corner.
        let rounded = self.lattice.to_world(to_f64(point).to_array());
        self.camera.project(rounded)
    }

    /// The faces of a polygon.
    pub(crate) fn faces_of(&self, polygon: usize) -> Vec<&Face> {
        let own = self.faces.iter().filter(|(other, _)| *other == polygon);
        own.map(|(_, face)| face).collect()
    }

    /// The polygons that hide a point of the scene, each once.
    pub(crate) fn polygons_before(&self, point: &Point) -> Vec<usize> {
        let (all, rounded) = (self.faces.iter().zip(&self.rounded), to_f64(point));
        let mut polygons: Vec<usize> = all
            .filter(|(_, corners)| self.may_be_before(corners, rounded))
            .filter(|((_, face), _)| self.is_before(face, point))
            .map(|((polygon, _), _)| *polygon)
            .collect();
        // Faces of one polygon are consecutive.
        polygons.dedup();
        polygons
    }

    /// Whether the line of sight of a point may go through a face. Floats decide, to save time.
    fn may_be_before(&self, corners: &[DVec3], point: DVec3) -> bool {
        let (from, way) = match &self.origin {
            Origin::Eye(_) => (self.from, point - self.from),
            Origin::Along(_) => (point, self.from),
        };
        let arms = || corners.iter().map(|corner| *corner - from);
        let turns: Vec<f64> = arms()
            .zip(arms().cycle().skip(1))
            .map(|(a, b)| a.cross(b).dot(way) / (1.0 + a.length() * b.length() * way.length()))
            .collect();
        turns.iter().all(|&turn| turn > -1e-9) || turns.iter().all(|&turn| turn < 1e-9)
    }

    /// The faces between a point and the eye, without the faces that it is on.
    pub(crate) fn cover(&self, point: &Point, own: [usize; 2]) -> Cover {
        let (mut cover, rounded) = (Cover::None, to_f64(point));
        for ((polygon, face), corners) in self.faces.iter().zip(&self.rounded) {
            let is_on = face.plane.at(point).is_zero();
            if is_on && own.contains(polygon) || !self.may_be_before(corners, rounded) {
                continue;
            }
            match if is_on { Some(face.place(point)) } else { self.before(face, point) } {
                Some(Ordering::Greater) if !is_on => return Cover::Hidden,
                Some(Ordering::Less) | None => {}
                Some(_) => cover = Cover::Unsure,
            }
        }
        cover
    }

    fn is_before(&self, face: &Face, point: &Point) -> bool {
        self.before(face, point).is_some_and(Ordering::is_ge)
    }

    /// Whether the line of sight of a point goes through a face before the point: through its inside or its
    /// border.
    fn before(&self, face: &Face, point: &Point) -> Option<Ordering> {
        let at = face.plane.at(point);
        let (from, share) = match &self.origin {
            Origin::Eye(eye) => {
                let at_eye = face.plane.at(eye);
                if at_eye == at {
                    return None;
                }
                // From 0 at the point to 1 at the eye.
                (rational::difference(eye, point), &at / (&at - &at_eye))
            }
            Origin::Along(direction) => {
                let slope = rational::scalar(&face.plane.normal, direction);
                if slope.is_zero() {
                    return None;
                }
                let zero = [(); 3].map(|()| Rational::zero());
                (rational::difference(&zero, direction), &at / slope)
            }
        };
        let ends_at_eye = matches!(self.origin, Origin::Eye(_));
        if !share.is_positive() || ends_at_eye && share >= Rational::one() {
            return None;
        }
        let hit: Point = std::array::from_fn(|i| &point[i] + &from[i] * &share);
        Some(face.place(&hit))
    }
}

fn to_f64(point: &Point) -> DVec3 {
    DVec3::from_array(point.each_ref().map(|c| c.to_f64().value()))
}

/// The segment that two faces have in common, if they are not in one plane.
pub(crate) fn common(a: &Face, b: &Face) -> Option<[Point; 2]> {
    let along = rational::product(&a.plane.normal, &b.plane.normal);
    let mut found: Vec<Point> = vec![];
    for (one, other) in [(a, b), (b, a)] {
        for k in 0..one.corners.len() {
            let ends = [&one.corners[k], &one.corners[(k + 1) % one.corners.len()]];
            let values = ends.map(|end| other.plane.at(end));
            if values[0].is_zero() {
                found.push(ends[0].clone());
            } else if (&values[0] * &values[1]).is_negative() {
                found.push(rational::crossing(ends, [&values[0], &values[1]]));
            }
        }
    }
    found.retain(|point| a.place(point).is_ge() && b.place(point).is_ge());
    let place = |point: &Point| rational::scalar(&along, point);
    let low = found.iter().min_by_key(|point| place(point))?.clone();
    let high = found.iter().max_by_key(|point| place(point))?.clone();
    (low != high && along.iter().any(|c| !c.is_zero())).then_some([low, high])
}
