//! Polygons as messages between ranks.

use binspace::Polygon;
use binspace::glam::DVec3;

/// A polygon with its colour and opacity.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Given {
    /// The polygon's number in the whole scene.
    pub(crate) number: u64,
    pub(crate) colour: [u8; 3],
    /// The opacity, from 0 to 1.
    pub(crate) opacity: f32,
    /// See [`Polygon::precision`].
    pub(crate) precision: f64,
    /// The corners; at least one.
    pub(crate) corners: Vec<DVec3>,
}

impl Polygon for Given {
    type Point = DVec3;

    fn corners(&self) -> impl Iterator<Item = DVec3> {
        self.corners.iter().copied()
    }

    fn precision(&self) -> f64 {
        self.precision
    }
}

/// The bytes of a polygon before its corners.
const HEAD: usize = 28;
/// The bytes of a corner.
const CORNER: usize = 24;

impl Given {
    /// Appends the polygon to some bytes.
    pub(crate) fn write(&self, bytes: &mut Vec<u8>) {
        let [r, g, b] = self.colour;
        bytes.extend(self.number.to_le_bytes());
        bytes.extend([r, g, b, 0]);
        bytes.extend(self.opacity.to_le_bytes());
        bytes.extend(self.precision.to_le_bytes());
        bytes.extend((self.corners.len() as u32).to_le_bytes());
        bytes.extend(
            self.corners.iter().flat_map(|corner| corner.to_array()).flat_map(f64::to_le_bytes),
        );
    }

    /// All polygons that were written one after the other.
    pub(crate) fn read_all(mut bytes: &[u8]) -> impl Iterator<Item = Self> {
        std::iter::from_fn(move || {
            let (head, rest) = bytes.split_first_chunk::<HEAD>()?;
            let word = |at: usize| -> [u8; 4] { std::array::from_fn(|i| head[at + i]) };
            let long = |at: usize| -> [u8; 8] { std::array::from_fn(|i| head[at + i]) };
            let len = u32::from_le_bytes(word(24)) as usize;
            let (corners, rest) = rest.split_at_checked(len * CORNER)?;
            bytes = rest;
            let numbers: Vec<f64> =
                corners.as_chunks::<8>().0.iter().map(|&bytes| f64::from_le_bytes(bytes)).collect();
            Some(Self {
                number: u64::from_le_bytes(long(0)),
                colour: [head[8], head[9], head[10]],
                opacity: f32::from_le_bytes(word(12)),
                precision: f64::from_le_bytes(long(16)),
                corners: numbers.as_chunks::<3>().0.iter().map(|&p| DVec3::from_array(p)).collect(),
            })
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn written_data_are_read_again() {
        let given = |number: u64, corners: usize| Given {
            number,
            colour: [1, 200, number as u8],
            opacity: 0.25,
            precision: 1e-7,
            corners: (0..corners).map(|k| DVec3::splat(k as f64 * 0.1)).collect(),
        };
        let all = [given(7, 3), given(1 << 40, 5), given(9, 1)];
        let mut bytes = Vec::new();
        all.iter().for_each(|given| given.write(&mut bytes));
        assert!(Given::read_all(&bytes).eq(all));
        assert_eq!(Given::read_all(&bytes[..bytes.len() - 1]).count(), 2);
    }
}
