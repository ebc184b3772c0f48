//! Writes and reads lattices and faces, and checks them after reading.
//! [`BspTree::write`](crate::BspTree::write) documents the layout.

use std::io::{self, Read, Write};
use std::ops::Range;

use super::faces::{Face, Frame, INNER};
use super::lattice::{FAR_ORIGIN, LIMIT, MAX_CORNER, MAX_TOLERANCE, PowerOfTwo};
use super::names::MAX_NAMES;
use super::{Faces, Lattice, Plane, RoundedNormal, have_area, is_convex};
use crate::error::Error;
use crate::parallel_map;
use crate::save::{Reader, Writer, damaged, invalid, too_many, u32_at, u64_at};

/// The range of the exponents of all lattices, from the smallest to the largest numbers.
const EXPONENTS: std::ops::RangeInclusive<i32> = -1000..=1150;

impl Lattice {
    /// Writes the part *grid* of a file.
    pub(crate) fn write(&self, file: &mut Writer<impl Write>) -> io::Result<()> {
        file.u32(self.exponent() as u32)?;
        file.items(self.origin.into_iter().chain(self.far), |file, number| file.f64(number))
    }

    /// Reads a lattice, which must be [checked](Self::check) after the file's checksum.
    pub(crate) fn read(file: &mut Reader<impl Read>) -> Result<Self, Error> {
        let exponent = file.u32("grid")? as i32;
        // Clamped, so that the step is a finite number. `check` rejects exponents outside the range.
        let steps = PowerOfTwo::new(exponent.clamp(EXPONENTS.start() - 1, EXPONENTS.end() + 1));
        let (mut origin, mut far) = ([0.0; 3], [0.0; 3]);
        for number in origin.iter_mut().chain(&mut far) {
            *number = file.f64("grid")?;
        }
        Ok(Self { steps, origin, far })
    }

    /// Returns an error unless some scene could have the lattice.
    pub(crate) fn check(&self) -> Result<(), Error> {
        let exponent = self.exponent();
        let is_possible = |axis: usize| {
            let (origin, far) = (self.origin[axis], self.far[axis]);
            let is_whole = origin.abs() <= FAR_ORIGIN && origin.fract() == 0.0;
            is_whole && far.is_finite() && (origin == 0.0 || far == 0.0)
        };
        if EXPONENTS.contains(&exponent) && (0..3).all(is_possible) {
            Ok(())
        } else {
            Err(damaged("grid", "is impossible"))
        }
    }
}

/// The number of faces that one thread checks at a time.
const FACES_A_THREAD: usize = 4096;

impl Faces {
    pub(crate) fn write(&self, file: &mut Writer<impl Write>) -> io::Result<()> {
        let point = |file: &mut Writer<_>, point: [f64; 3]| {
            file.items(point.into_iter(), |file, c| file.u64(c as i64 as u64))
        };
        self.lattice.write(file)?;
        file.f64(self.tolerance)?;
        let ranges = (0..self.faces.len() as u32).map(|face| self.corner_range(face).len());
        file.list(self.faces.iter().zip(ranges), |file, (face, corners)| {
            file.u32(face.polygon)?;
            file.u32(corners as u32)?;
            file.u32(face.frame.0)
        })?;
        file.items(self.corners.iter(), |file, &corner| point(file, corner))?;
        file.list(self.numbered.iter(), |file, &(face, _)| file.u32(face))?;
        file.items(self.numbers.iter(), |file, &number| file.u32(number))?;
        file.list(self.moved.iter(), |file, &(corner, given)| {
            file.u32(corner)?;
            point(file, given)
        })
    }

    /// Reads faces, which must be [checked](Self::check) after the file's checksum. `of_cell` is the number
    /// of the cell's corners, which precede the corners of all faces.
    pub(crate) fn read(file: &mut Reader<impl Read>, of_cell: u32) -> Result<Self, Error> {
        let point = |bytes: &[u8], at: usize| {
            let bytes: &[u8; 24] = bytes[at..].first_chunk().unwrap_or(&[0; 24]);
            [0, 8, 16].map(|at| u64_at(bytes, at) as i64 as f64)
        };
        let lattice = Lattice::read(file)?;
        let tolerance = file.f64("tolerance")?;
        let mut corners = u64::from(of_cell);
        let faces = file.list("faces", MAX_NAMES, |bytes: &[u8; 12]| {
            // An overflow is limited to the largest number: too many corners are rejected below.
            let start = u32::try_from(corners).unwrap_or(u32::MAX);
            corners += u64::from(u32_at(bytes, 4));
            Face { start, polygon: u32_at(bytes, 0), frame: Frame(u32_at(bytes, 8)) }
        })?;
        if corners >= MAX_NAMES as u64 {
            return Err(too_many("corners", corners, MAX_NAMES as u64 - 1));
        }
        let corners =
            file.items("corners", corners as usize, |bytes: &[u8; 24]| point(bytes, 0))?;
        let mut read = Self { lattice, tolerance, corners, faces, ..Self::default() };
        let mut numbers = 0_u64;
        read.numbered = file.list("numbered faces", read.faces.len(), |bytes: &[u8; 4]| {
            let (face, at) = (u32_at(bytes, 0), numbers as u32);
            if (face as usize) < read.faces.len() {
                numbers += read.corner_range(face).len() as u64;
            }
            (face, at)
        })?;
        if numbers > read.corners.len() as u64 {
            let limit = read.corners.len() as u64;
            return Err(too_many("corner numbers", numbers, limit));
        }
        let numbers = numbers as usize;
        read.numbers = file.items("corner numbers", numbers, |bytes: &[u8; 4]| u32_at(bytes, 0))?;
        let moved = |bytes: &[u8; 28]| (u32_at(bytes, 0), point(bytes, 4));
        read.moved = file.list("moved corners", read.corners.len(), moved)?;
        Ok(read)
    }

    /// Returns an error unless all faces fulfil the requirements of the exact predicates: convex, with area,
    /// on their planes, within the lattice. O(corners).
    pub(crate) fn check(&self) -> Result<(), Error> {
        self.lattice.check()?;
        if !(0.0..=MAX_TOLERANCE).contains(&self.tolerance) {
            return Err(damaged("tolerance", "is negative, too large or NaN"));
        }
        if !Self::is_cell(self.cell()) {
            return Err(damaged("cell", "is outside the grid"));
        }
        if let [low, high] = self.cell()
            && (0..3).any(|axis| low[axis] > high[axis])
        {
            return Err(damaged("cell", "has its lower corner above its upper corner"));
        }
        let ranges = (0..self.faces.len()).step_by(FACES_A_THREAD);
        let ranges =
            ranges.map(|start| start..self.faces.len().min(start + FACES_A_THREAD)).collect();
        let check = |mut range: Range<usize>| range.try_for_each(|face| self.check_face(face));
        parallel_map::map(ranges, check)?;
        self.check_numbers()?;
        self.check_moved()
    }

    fn check_face(&self, face: usize) -> Result<(), Error> {
        let range = self.corner_range(face as u32);
        let corners = &self.corners[range.clone()];
        // First, because larger coordinates do not fit the integers of the later checks.
        let is_outside = |corner: &[f64; 3]| corner.iter().any(|c| c.abs() > MAX_CORNER);
        if let Some(k) = corners.iter().position(is_outside) {
            return Err(invalid("corner", range.start + k, "is outside the grid"));
        }
        if face > 0 && self.faces[face].polygon < self.faces[face - 1].polygon {
            return Err(invalid("face", face, "precedes a face of an earlier polygon"));
        }
        let frame = self.faces[face].frame;
        check_outline(corners, frame).map_err(|fault| invalid("face", face, fault))
    }

    fn check_numbers(&self) -> Result<(), Error> {
        let mut next = 0;
        for &(face, _) in &self.numbered {
            if face < next || face as usize >= self.faces.len() {
                return Err(invalid("numbered face", face as usize, "is unknown or out of order"));
            }
            next = face + 1;
        }
        let is_large = |&number: &u32| (number & !INNER) as usize >= MAX_NAMES;
        match self.numbers.iter().position(is_large) {
            Some(at) => Err(invalid("corner number", at, "is too large")),
            None => Ok(()),
        }
    }

    fn check_moved(&self) -> Result<(), Error> {
        let (mut next, mut face) = (self.corners_of_cell() as u32, 0);
        for &(corner, given) in &self.moved {
            let fault = |fault| Err(invalid("moved corner", corner as usize, fault));
            if corner < next || corner as usize >= self.corners.len() {
                return fault("is unknown or out of order");
            }
            next = corner + 1;
            while !self.corner_range(face).contains(&(corner as usize)) {
                face += 1;
            }
            let stays = |axis: usize| given[axis] == self.corner(corner)[axis];
            let axis = self.moved_axis(face);
            if axis.is_none() || !(0..3).all(|k| Some(k) == axis || stays(k)) {
                return fault("was not moved along its face's axis");
            }
            if given.iter().any(|c| c.abs() > LIMIT) {
                return fault("was outside the grid");
            }
        }
        Ok(())
    }
}

/// Returns an error, which describes the fault, unless a face with this frame can have these corners.
fn check_outline(corners: &[[f64; 3]], frame: Frame) -> Result<(), &'static str> {
    let [_, second, third] = frame.triangle().map(|k| k as usize);
    if !(3..=Frame::MAX_CORNERS).contains(&corners.len()) {
        return Err("has too few corners or too many");
    }
    if second == 0 || third <= second || third >= corners.len() {
        return Err("names corners that it does not have");
    }
    let triangle = [0, second, third].map(|k| corners[k]);
    if corners.len() == 3 {
        return match frame {
            _ if !have_area(triangle) => Err("has no area"),
            Frame::TRIANGLE => Ok(()),
            _ => Err("is a triangle, but is stored as moved"),
        };
    }
    let plane = Plane::through(triangle);
    if plane.normal() == [0; 3] {
        return Err("has no area");
    }
    let axis = plane.dominant_axis();
    if !is_convex(corners.len(), |k| corners[k], axis) {
        return Err("is not convex");
    }
    // The nearest lattice points are off the plane by at most half a step along the axis.
    let most = match frame.moved_axis() {
        Some(moved) if moved != axis => {
            return Err("is moved along the wrong axis");
        }
        Some(axis) => plane.normal()[axis].unsigned_abs() / 2,
        None => 0,
    };
    // The three corners that span the plane are on it.
    let others = [1..second, second + 1..third, third + 1..corners.len()];
    let mut others = others.into_iter().flat_map(|range| &corners[range]);
    let rounded = RoundedNormal::through(triangle);
    let is_off = |corner| !plane.is_within(most, &rounded.normal, corner);
    if others.any(is_off) { Err("is not planar") } else { Ok(()) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::save::Kind;
    use glam::DVec3;

    const KIND: Kind = Kind { name: *b"grid", version: 7 };

    fn again(lattice: &Lattice) -> Lattice {
        let mut bytes = Vec::new();
        let mut file = Writer::new(&mut bytes, KIND).unwrap();
        lattice.write(&mut file).unwrap();
        file.finish().unwrap();
        let mut file = Reader::new(&bytes[..], KIND).unwrap();
        let read = Lattice::read(&mut file).unwrap();
        file.finish().unwrap();
        read
    }

    #[test]
    fn lattices_of_every_size_come_back() {
        for size in [5e-324, 1e-300, 1e-30, 1.0, 3.7, 1e30, 1e300, f64::MAX] {
            for centre in [0.0, size, -size * 0.75, 1.0, -1e308] {
                let middle = DVec3::new(centre, 0.0, -centre * 0.5);
                let clamp = |p: DVec3| p.clamp(DVec3::MIN, DVec3::MAX);
                let lattice = Lattice::new(clamp(middle - size), clamp(middle + size));
                assert!(lattice.check().is_ok(), "{size} {centre}");
                assert_eq!(again(&lattice), lattice, "{size} {centre}");
            }
        }
    }

    #[test]
    fn impossible_lattices_are_errors() {
        let right = Lattice::default();
        let is_wrong = |lattice: Lattice| again(&lattice).check().is_err();
        assert!(!is_wrong(right));
        for number in [f64::NAN, f64::INFINITY, 0.5, 2.0 * FAR_ORIGIN] {
            assert!(is_wrong(Lattice { origin: [0.0, number, 0.0], ..right }), "{number}");
        }
        assert!(is_wrong(Lattice { far: [f64::NAN, 0.0, 0.0], ..right }));
        assert!(is_wrong(Lattice { far: [1e300, 0.0, 0.0], origin: [1.0, 0.0, 0.0], ..right }));
        for exponent in [-1001, 1151] {
            assert!(is_wrong(Lattice { steps: PowerOfTwo::new(exponent), ..right }));
        }
    }
}
