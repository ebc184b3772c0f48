//! Names as files hold them.
//!
//! A plane is 32 bits: 1 in bits 28 to 30 for the plane of a face, 2, 3, 4 for one perpendicular to
//! x, y, z through a corner; the number of the face or corner below.

use super::{AXIS, FACE, PAYLOAD, PlaneId, TAG_SHIFT};

/// How many things a plane may name.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Known {
    pub(crate) faces: usize,
    /// Corners of all faces.
    pub(crate) corners: usize,
}

impl PlaneId {
    pub(crate) const fn to_bits(self) -> u32 {
        self.0
    }

    /// Any bits: check [`is_known`](Self::is_known) before the plane is used.
    pub(crate) const fn from_bits(bits: u32) -> Self {
        Self(bits)
    }

    /// Whether the bits name a plane.
    pub(crate) fn is_known(self, known: Known) -> bool {
        let payload = (self.0 & PAYLOAD) as usize;
        match self.0 >> TAG_SHIFT {
            FACE => payload < known.faces,
            tag => (AXIS..AXIS + 3).contains(&tag) && payload < known.corners,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::BEHIND;
    use super::*;

    const KNOWN: Known = Known { faces: 3, corners: 12 };

    #[test]
    fn names_are_known_up_to_the_last() {
        let planes = [PlaneId::face(2), PlaneId::axis(0, 11), PlaneId::axis(2, 11)];
        for plane in planes {
            assert!(plane.is_known(KNOWN));
            assert_eq!(PlaneId::from_bits(plane.to_bits()), plane);
        }
        for plane in [PlaneId::face(3), PlaneId::axis(1, 12)] {
            assert!(!plane.is_known(KNOWN));
        }
        for bits in
            [0, 5 << TAG_SHIFT, 6 << TAG_SHIFT, 7 << TAG_SHIFT, BEHIND, BEHIND | 1 << TAG_SHIFT]
        {
            assert!(!PlaneId::from_bits(bits).is_known(KNOWN), "{bits:x}");
        }
    }
}
