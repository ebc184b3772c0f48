//! Names as files hold them.
//!
//! A plane is 32 bits: 1 in bits 28 to 30 for the plane of a face, 2, 3, 4 for one perpendicular to
//! x, y, z through a corner; the number of the face or corner below. A line is 0 in those bits and the
//! number of an edge, or a plane, with bit 31 set if the piece lies behind it. A vertex is the two
//! lines that cross there, edges before planes, the lesser number first, bit 31 clear; a corner is its
//! number twice.

use super::{AXIS, BEHIND, EDGE, FACE, Line, PAYLOAD, PlaneId, Symbol, TAG_SHIFT};

/// How many things a plane may name, and a face's corners.
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

impl Line {
    pub(crate) const fn to_bits(self) -> u32 {
        self.0
    }

    /// Any bits: check [`is_known`](Self::is_known) before the line is used.
    pub(crate) const fn from_bits(bits: u32) -> Self {
        Self(bits)
    }

    /// Whether the bits name a line on a face of so many corners.
    pub(crate) fn is_known(self, known: Known, edges: u32) -> bool {
        if self.0 >> TAG_SHIFT == EDGE {
            self.0 < edges
        } else {
            PlaneId(self.0 & !BEHIND).is_known(known)
        }
    }
}

impl Symbol {
    pub(crate) const fn to_bits(self) -> [u32; 2] {
        [self.a.0, self.b.0]
    }

    /// Any bits: check [`is_known`](Self::is_known) before the vertex is used.
    pub(crate) const fn from_bits([a, b]: [u32; 2]) -> Self {
        Self { a: Line(a), b: Line(b) }
    }

    /// Whether the bits name a vertex on a face of so many corners, in the one way in which it is
    /// named.
    pub(crate) fn is_known(self, known: Known, edges: u32) -> bool {
        let Self { a, b } = self;
        let are_lines = a.is_known(known, edges) && b.is_known(known, edges);
        let is_corner = a == b && a.as_edge().is_some();
        let is_crossing = a.0 < b.0 && b.as_edge().is_none();
        are_lines && !a.is_behind() && !b.is_behind() && (is_corner || is_crossing)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const KNOWN: Known = Known { faces: 3, corners: 12 };

    #[test]
    fn names_are_known_up_to_the_last() {
        let planes = [PlaneId::face(2), PlaneId::axis(0, 11), PlaneId::axis(2, 11)];
        assert!(planes.iter().all(|plane| plane.is_known(KNOWN)));
        let lines = planes.map(|plane| Line::cut(plane, true));
        assert!(lines.iter().all(|line| line.is_known(KNOWN, 4)));
        assert!(Line::edge(3).is_known(KNOWN, 4) && !Line::edge(4).is_known(KNOWN, 4));
        for plane in [PlaneId::face(3), PlaneId::axis(1, 12)] {
            assert!(!plane.is_known(KNOWN) && !Line::cut(plane, false).is_known(KNOWN, 4));
        }
        for bits in [5 << TAG_SHIFT, 6 << TAG_SHIFT, 7 << TAG_SHIFT, BEHIND, BEHIND | FACE] {
            assert!(!PlaneId::from_bits(bits).is_known(KNOWN), "{bits:x}");
        }
        assert!(!Line::from_bits(BEHIND | 1).is_known(KNOWN, 4), "no edge has a side");
    }

    #[test]
    fn a_vertex_has_one_name() {
        let (g, h) = (PlaneId::face(1), PlaneId::axis(0, 2));
        let right = [
            Symbol::corner(3),
            Symbol::crossing(Line::edge(0), g),
            Symbol::crossing(Line::cut(h, true), g),
        ];
        for symbol in right {
            assert!(symbol.is_known(KNOWN, 4), "{symbol:?}");
            assert_eq!(Symbol::from_bits(symbol.to_bits()), symbol);
        }
        let [g, h] = [g, h].map(PlaneId::to_bits);
        for wrong in [[4, 4], [0, 1], [h, g], [g, 0], [g, g], [g, h | BEHIND], [0, g | BEHIND]] {
            assert!(!Symbol::from_bits(wrong).is_known(KNOWN, 4), "{wrong:x?}");
        }
    }
}
