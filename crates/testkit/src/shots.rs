//! Rays that are hard to decide.

use super::dice::Dice;
use binspace::Ray;
use binspace::glam::DVec3;
use binspace::internals::Faces;

/// Makes rays for the faces of a tree. The tree must have faces.
pub struct Shots<'t> {
    faces: &'t Faces,
    low: DVec3,
    high: DVec3,
}

impl<'t> Shots<'t> {
    pub fn new(faces: &'t Faces) -> Self {
        let corners = || (0..faces.corner_count() as u32).map(|k| world(faces, k));
        let low = corners().reduce(DVec3::min).expect("corners");
        let high = corners().reduce(DVec3::max).expect("corners");
        Self { faces, low, high }
    }

    /// Returns a corner of any face.
    pub fn corner(&self, dice: &mut Dice) -> DVec3 {
        world(self.faces, dice.below(self.faces.corner_count()) as u32)
    }

    /// Returns a point of the plane of a face, inside the face or not: exactly on it if eighths of the face's
    /// edges fit an `f64`.
    pub fn on_plane(&self, face: u32, dice: &mut Dice) -> DVec3 {
        let [a, b, c] = self.faces.reference_triangle(face).map(|k| world(self.faces, k));
        let mut share = || (dice.below(17) as f64 - 4.0) / 8.0;
        a + (b - a) * share() + (c - a) * share()
    }

    /// Returns a point of the bounding box, enlarged.
    pub fn around(&self, by: f64, dice: &mut Dice) -> DVec3 {
        let share = DVec3::from_array([0; 3].map(|_| (dice.share() - 0.5) * by + 0.5));
        self.low + (self.high - self.low) * share
    }

    fn face(&self, dice: &mut Dice) -> u32 {
        dice.below(self.faces.len()) as u32
    }

    /// Two corners of a face.
    fn chord(&self, dice: &mut Dice) -> [DVec3; 2] {
        let range = self.faces.corner_range(self.face(dice));
        [0, 1].map(|_| world(self.faces, (range.start + dice.below(range.len())) as u32))
    }

    /// Returns a ray of any kind, with finite numbers.
    pub fn ray(&self, dice: &mut Dice) -> Ray {
        let ray = self.any_ray(dice);
        let (Ray::Segment { from: a, to: b } | Ray::Endless { from: a, direction: b }) = ray;
        // In a scene as large as the largest numbers, some rays would begin beyond it.
        if a.is_finite() && b.is_finite() { ray } else { Ray::new(self.corner(dice), DVec3::X) }
    }

    fn any_ray(&self, dice: &mut Dice) -> Ray {
        let (from, to) = self.ends(dice);
        match dice.below(4) {
            0 | 1 => Ray::between(from, to),
            2 => Ray::new(from, to - from),
            // The same line, from far behind or from between the ends.
            _ => {
                let start = from + (from - to) * (dice.below(9) as f64 / 4.0 - 0.5);
                Ray::new(start, (to - from) * 2f64.powi(dice.around_zero(80) as i32))
            }
        }
    }

    fn ends(&self, dice: &mut Dice) -> (DVec3, DVec3) {
        match dice.below(14) {
            0 => (self.around(1.5, dice), self.around(1.0, dice)),
            1 => (self.corner(dice), self.corner(dice)),
            2 => {
                let [a, b] = self.chord(dice);
                (a, b)
            }
            3 => {
                // From beyond one end of an edge or a diagonal to beyond the other end.
                let ([a, b], k) = (self.chord(dice), dice.below(5) as f64);
                (a + (a - b) * k, b + (b - a) * k)
            }
            4 => {
                // A corner is exactly in the middle.
                let (corner, arm) = (self.corner(dice), self.arm(dice));
                (corner - arm, corner + arm)
            }
            5 => {
                let face = self.face(dice);
                (self.on_plane(face, dice), self.on_plane(face, dice))
            }
            6 => {
                let [face, other] = [self.face(dice), self.face(dice)];
                (self.on_plane(face, dice), self.on_plane(other, dice))
            }
            7 => {
                // Along an axis, beside a corner or through it.
                let (mut from, axis) = (self.corner(dice), dice.below(3));
                let mut to = from;
                from[axis] = self.around(2.0, dice)[axis];
                to[axis] = self.around(2.0, dice)[axis];
                (from, to)
            }
            8 => {
                // Both ends are the same point.
                let face = self.face(dice);
                let point = match dice.below(3) {
                    0 => self.corner(dice),
                    1 => self.on_plane(face, dice),
                    _ => self.around(1.0, dice),
                };
                (point, point)
            }
            9 => {
                // From as far away as a ray may begin.
                let target = self.corner(dice);
                (target + self.arm(dice) * 10f64.powi(dice.below(21) as i32), target)
            }
            10 => {
                // A few ulps long.
                let from = self.corner(dice);
                let mut to = from;
                for _ in 0..dice.below(4) {
                    let axis = dice.below(3);
                    let step = if dice.below(2) == 0 { f64::next_up } else { f64::next_down };
                    // Digits of numbers far below the scene's extent are lost in a ray.
                    if to[axis] != 0.0 {
                        to[axis] = step(to[axis]);
                    }
                }
                (from, to)
            }
            11 => (self.corner(dice), self.around(1.2, dice)),
            12 => {
                let face = self.face(dice);
                (self.around(2.0, dice), self.on_plane(face, dice))
            }
            _ => {
                // In the plane of one face, through a corner of another.
                let face = self.face(dice);
                (self.on_plane(face, dice), self.corner(dice))
            }
        }
    }

    /// A vector of about the scene's size, with few digits.
    fn arm(&self, dice: &mut Dice) -> DVec3 {
        let size = (self.high - self.low).max_element();
        let unit = if size > 0.0 { 2f64.powi(size.log2().floor() as i32 - 3) } else { 1.0 };
        dice.whole_point(6) * unit
    }
}

fn world(faces: &Faces, corner: u32) -> DVec3 {
    faces.lattice().to_world(faces.corner(corner))
}
