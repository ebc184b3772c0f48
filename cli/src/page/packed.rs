//! Arrays of numbers in a page: little-endian, in the minimal number of bytes for the largest number,
//! compressed, in base64.

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use miniz_oxide::deflate::compress_to_vec;
use serde::Serialize;

/// The level of compression, up to 10. Too large: much more time for slightly shorter files. Too small:
/// longer files.
const LEVEL: u8 = 7;

/// An array, as the page's script reads it.
#[derive(Debug, Serialize)]
pub(super) struct Packed {
    kind: &'static str,
    /// The number of bytes.
    bytes: usize,
    /// The bytes of the numbers, compressed with deflate (RFC 1951): the first byte of each number, then the
    /// second byte of each number, and so on. Then similar bytes are adjacent, and compress better.
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
        Self::of(kind, width, bytes)
    }

    pub(super) fn single(numbers: &[f32]) -> Self {
        Self::of("f32", 4, numbers.iter().flat_map(|number| number.to_le_bytes()))
    }

    pub(super) fn double(numbers: &[f64]) -> Self {
        Self::of("f64", 8, numbers.iter().flat_map(|number| number.to_le_bytes()))
    }

    fn of(kind: &'static str, width: usize, bytes: impl Iterator<Item = u8>) -> Self {
        let bytes: Vec<u8> = bytes.collect();
        let planes = (0..width).flat_map(|place| bytes.iter().skip(place).step_by(width));
        let planes: Vec<u8> = planes.copied().collect();
        let base64 = STANDARD.encode(compress_to_vec(&planes, LEVEL));
        Self { kind, bytes: bytes.len(), base64 }
    }
}

#[cfg(test)]
mod tests {
    use miniz_oxide::inflate::decompress_to_vec;

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
            assert_eq!((packed.kind, packed.bytes), (kind, bytes));
        }
        let packed = STANDARD.decode(Packed::whole(&[0x1234, 0x56]).base64).unwrap();
        assert_eq!(decompress_to_vec(&packed).unwrap(), [0x34, 0x56, 0x12, 0]);
    }
}
