//! Arrays of numbers in a page: in base64, little-endian, in the minimal number of bytes for their largest
//! number.

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use serde::Serialize;

/// An array, as the page's script reads it.
#[derive(Debug, Serialize)]
pub(super) struct Packed {
    kind: &'static str,
    base64: String,
}

impl Packed {
    /// Whole numbers.
    pub(super) fn whole(numbers: &[u32]) -> Self {
        let (kind, width) = match numbers.iter().max() {
            Some(0x1_0000..) => ("u32", 4),
            Some(0x100..) => ("u16", 2),
            _ => ("u8", 1),
        };
        let bytes = numbers.iter().flat_map(|number| number.to_le_bytes().into_iter().take(width));
        Self::of(kind, bytes)
    }

    pub(super) fn single(numbers: &[f32]) -> Self {
        Self::of("f32", numbers.iter().flat_map(|number| number.to_le_bytes()))
    }

    pub(super) fn double(numbers: &[f64]) -> Self {
        Self::of("f64", numbers.iter().flat_map(|number| number.to_le_bytes()))
    }

    fn of(kind: &'static str, bytes: impl Iterator<Item = u8>) -> Self {
        Self { kind, base64: STANDARD.encode(bytes.collect::<Vec<u8>>()) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_take_no_more_bytes_than_the_largest_needs() {
        for (numbers, kind, bytes) in [
            (&[][..], "u8", 0),
            (&[255, 0, 3], "u8", 3),
            (&[256, 0, 3], "u16", 6),
            (&[65_535], "u16", 2),
            (&[65_536, 1, 1], "u32", 12),
        ] {
            let packed = Packed::whole(numbers);
            assert_eq!((packed.kind, packed.base64.len()), (kind, usize::div_ceil(bytes, 3) * 4));
        }
        assert_eq!(Packed::whole(&[0x1234, 0x56]).base64, STANDARD.encode([0x34, 0x12, 0x56, 0]));
    }
}
