//! STL files: triangles as text or binary, with colours in some binary files. Up is z, as in the machines
//! that print them.
//!
//! Crates for STL read text as `f32`, and only the first of several solids.

use binspace::glam::DVec3;
use binspace::scene::Scene;

use super::mesh::{Colour, Mesh, Precision};
use super::text::Lines;

/// The bytes before the triangles of a binary file: a header, and the number of triangles.
const HEADER: usize = 84;
/// The bytes of a triangle: a normal and three corners of three `f32`, and two bytes, which may be a colour.
const TRIANGLE: usize = 50;

/// Whether a file of `length` bytes that begins like this is a binary STL file.
pub(crate) fn is_binary(beginning: &[u8], length: u64) -> bool {
    count(beginning)
        .is_some_and(|count| u64::from(count) * TRIANGLE as u64 + HEADER as u64 == length)
}

/// Whether a file begins as an STL file of text.
pub(crate) fn is_text(beginning: &[u8]) -> bool {
    let text = beginning.trim_ascii_start();
    text.get(..5).is_some_and(|word| word.eq_ignore_ascii_case(b"solid"))
        && text.get(5).is_none_or(u8::is_ascii_whitespace)
        && !beginning.contains(&0)
}

fn count(bytes: &[u8]) -> Option<u32> {
    let count = bytes.get(HEADER - 4..HEADER)?;
    Some(u32::from_le_bytes(count.try_into().ok()?))
}

/// Reads a binary file. Bytes behind the last triangle are passed over.
pub(crate) fn binary(name: &str, bytes: &[u8]) -> Result<Scene, String> {
    let count = count(bytes).ok_or("truncated header")?;
    let triangles = bytes[HEADER..].chunks_exact(TRIANGLE);
    if (count as usize) > triangles.len() {
        let has = triangles.len();
        return Err(format!("truncated: {count} triangles declared, {has} found"));
    }
    let (mut mesh, mut precision) = (Mesh::new(name, DVec3::Z), Precision::default());
    let colours = Colours::of(&bytes[..HEADER - 4]);
    for (number, triangle) in triangles.take(count as usize).enumerate() {
        let mut numbers = triangle[12..48].chunks_exact(4).map(|bytes| {
            let value = f32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]]);
            precision.single(value)
        });
        let mut corner = || Some(DVec3::new(numbers.next()??, numbers.next()??, numbers.next()??));
        let corners = [corner(), corner(), corner()];
        let [Some(a), Some(b), Some(c)] = corners else {
            return Err(format!("triangle {number} (from 0): a coordinate is not a finite number"));
        };
        mesh.face([a, b, c], colours.of_triangle(u16::from_le_bytes([triangle[48], triangle[49]])));
    }
    Ok(mesh.finish(precision.unit()))
}

/// The meaning of the last two bytes of triangles.
enum Colours {
    /// Red, green and blue from the lowest bits on; with the highest bit, the colour of the whole (Magics).
    Magics(Colour),
    /// Blue, green and red from the lowest bits on, if the highest bit is set; otherwise no colour (VisCAM).
    VisCam,
}

impl Colours {
    /// The colours of a file with some header.
    fn of(header: &[u8]) -> Self {
        const KEY: &[u8] = b"COLOR=";
        let at = header.windows(KEY.len()).position(|word| word == KEY);
        match at.and_then(|at| header.get(at + KEY.len()..at + KEY.len() + 4)) {
            Some(&[r, g, b, opacity]) => {
                Self::Magics([r, g, b, opacity].map(|channel| f32::from(channel) / 255.0))
            }
            _ => Self::VisCam,
        }
    }

    fn of_triangle(&self, word: u16) -> Option<Colour> {
        let [low, middle, high] = [0, 5, 10].map(|shift| f32::from(word >> shift & 31) / 31.0);
        match (self, word >> 15) {
            (Self::Magics(whole), 1) => Some(*whole),
            (Self::Magics(_), _) => Some([low, middle, high, 1.0]),
            (Self::VisCam, 1) => Some([high, middle, low, 1.0]),
            (Self::VisCam, _) => None,
        }
    }
}

/// Reads a file of text, with all its solids.
pub(crate) fn text(name: &str, bytes: &[u8]) -> Result<Scene, String> {
    let (mut mesh, mut precision) = (Mesh::new(name, DVec3::Z), Precision::default());
    // Corners of the facet; `None` outside of one.
    let mut facet: Option<Vec<DVec3>> = None;
    let mut number = 0;
    for line in Lines::new(bytes) {
        let about = |problem: &str| line.about(&format!("facet {number} (from 0)"), problem);
        let mut words = line.words();
        let word = words.next().unwrap_or_default().to_ascii_lowercase();
        match (&word[..], &mut facet) {
            ("facet", None) => facet = Some(Vec::with_capacity(3)),
            ("vertex", Some(corners)) => {
                let mut next = || precision.text(words.next()?);
                match (next(), next(), next()) {
                    (Some(x), Some(y), Some(z)) => corners.push(DVec3::new(x, y, z)),
                    _ => return Err(about("expected `vertex` and three finite numbers")),
                }
            }
            ("endfacet", Some(corners)) if corners.len() < 3 => {
                return Err(about("fewer than three corners"));
            }
            ("endfacet", Some(_)) => {
                mesh.face(facet.take().unwrap_or_default(), None);
                number += 1;
            }
            ("outer" | "endloop", Some(_)) | ("solid" | "endsolid", None) => {}
            _ => return Err(about(&format!("{word:.20} is out of place in an STL file"))),
        }
    }
    match facet {
        Some(_) => Err(format!("facet {number} (from 0): truncated")),
        None => Ok(mesh.finish(precision.unit())),
    }
}
