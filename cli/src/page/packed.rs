//! Arrays of numbers in a page: in base64, little-endian, in as few bytes as their largest number needs.

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
        Self { kind, base64: base64(&bytes.collect::<Vec<u8>>()) }
    }
}

/// Base64 of RFC 4648: six bits a character, filled up with `=` to a multiple of four.
fn base64(bytes: &[u8]) -> String {
    const DIGITS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut text = String::with_capacity(bytes.len().div_ceil(3) * 4);
    for group in bytes.chunks(3) {
        let bits = (0..3).fold(0, |bits, i| bits << 8 | group.get(i).map_or(0, |&b| u32::from(b)));
        for i in 0..4 {
            let digit = DIGITS[(bits >> (18 - 6 * i)) as usize & 63];
            text.push(if i <= group.len() { char::from(digit) } else { '=' });
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The examples of RFC 4648.
    #[test]
    fn base64_is_that_of_the_standard() {
        let pairs = [
            ("", ""),
            ("f", "Zg=="),
            ("fo", "Zm8="),
            ("foo", "Zm9v"),
            ("foob", "Zm9vYg=="),
            ("fooba", "Zm9vYmE="),
            ("foobar", "Zm9vYmFy"),
        ];
        for (bytes, text) in pairs {
            assert_eq!(base64(bytes.as_bytes()), text);
        }
        assert_eq!(base64(&[0xfb, 0xff, 0xbf]), "+/+/");
    }

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
        assert_eq!(Packed::whole(&[0x1234, 0x56]).base64, base64(&[0x34, 0x12, 0x56, 0]));
    }
}
