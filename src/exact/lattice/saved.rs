//! Lattices in files: the exponent of the steps in a unit of length as `u32` in two's complement, the
//! origin and the far coordinates as three `f64` each.

use std::io::{self, Read, Write};

use super::{FAR_ORIGIN, Lattice, PowerOfTwo};
use crate::save::{LoadError, Reader, Writer};

/// What messages call it.
const WHAT: &str = "grid";
/// Exponents of all lattices are between these: those of the smallest and of the largest numbers.
const EXPONENTS: std::ops::RangeInclusive<i32> = -1000..=1150;

impl Lattice {
    pub(crate) fn write(&self, file: &mut Writer<impl Write>) -> io::Result<()> {
        file.u32(self.exponent() as u32)?;
        file.items(self.origin.into_iter().chain(self.far), |file, number| file.f64(number))
    }

    /// Reads a lattice, which has to be checked.
    pub(crate) fn read(file: &mut Reader<impl Read>) -> Result<Self, LoadError> {
        let exponent = file.u32(WHAT)? as i32;
        // So that every step is a number; `check` refuses what lies beyond.
        let steps = PowerOfTwo::new(exponent.clamp(EXPONENTS.start() - 1, EXPONENTS.end() + 1));
        let (mut origin, mut far) = ([0.0; 3], [0.0; 3]);
        for number in origin.iter_mut().chain(&mut far) {
            *number = file.f64(WHAT)?;
        }
        Ok(Self { steps, origin, far })
    }

    /// An error unless the lattice is one that some scene could have.
    pub(crate) fn check(&self) -> Result<(), LoadError> {
        let exponent = self.exponent();
        let is_possible = |axis: usize| {
            let (origin, far) = (self.origin[axis], self.far[axis]);
            let is_whole = origin.abs() <= FAR_ORIGIN && origin.fract() == 0.0;
            is_whole && far.is_finite() && (origin == 0.0 || far == 0.0)
        };
        if EXPONENTS.contains(&exponent) && (0..3).all(is_possible) {
            Ok(())
        } else {
            Err(LoadError::of(WHAT, "is impossible"))
        }
    }
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
