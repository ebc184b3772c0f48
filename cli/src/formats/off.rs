//! OFF files (Geomview): vertices and polygons as text or binary, with colours in some. Up is z.

use binspace::glam::DVec3;
use binspace::scene::Scene;

use super::mesh::{Colour, Mesh, Precision, mean};
use super::text::{Line, Lines};

/// The content of each vertex, from the first word of a file: letters for the content, and then `OFF`.
struct Kind {
    has_colours: bool,
    has_normals: bool,
    has_textures: bool,
}

impl Kind {
    /// The content that a first word names; `None` for any other word. Vertices of four or more coordinates
    /// do not occur in scenes.
    fn of(word: &[u8]) -> Option<Self> {
        let word = word.strip_suffix(b"OFF")?;
        let rest = word.strip_prefix(b"ST").unwrap_or(word);
        let (has_colours, has_normals) = match rest {
            b"" => (false, false),
            b"C" => (true, false),
            b"N" => (false, true),
            b"CN" => (true, true),
            _ => return None,
        };
        Some(Self { has_colours, has_normals, has_textures: rest.len() < word.len() })
    }
}

/// Whether a file begins as an OFF file.
pub(crate) fn is_off(beginning: &[u8]) -> bool {
    let text = beginning.trim_ascii_start();
    text.split(u8::is_ascii_whitespace).next().is_some_and(|word| Kind::of(word).is_some())
}

/// Reads a file.
pub(crate) fn read(name: &str, bytes: &[u8]) -> Result<Scene, String> {
    let mut lines = Lines::new(bytes);
    let first = lines.next().ok_or("it is empty")?;
    let mut words = first.words();
    let kind = Kind::of(words.next().unwrap_or_default().as_bytes()).ok_or("not an OFF file")?;
    let mut counts: Vec<&str> = words.collect();
    if counts.first() == Some(&"BINARY") {
        return binary(name, &kind, lines.rest());
    }
    if counts.is_empty() {
        counts = lines.next().ok_or("truncated before the counts")?.words().collect();
    }
    let count = |i: usize| counts.get(i).and_then(|word| word.parse::<usize>().ok());
    let (Some(vertices), Some(faces)) = (count(0), count(1)) else {
        return Err("expected the numbers of vertices and faces after `OFF`".into());
    };
    // Each line of a vertex or a face has two bytes at least. So the memory requested later is at most
    // proportional to the file's size.
    if vertices.saturating_add(faces) > bytes.len() / 2 {
        return Err(format!(
            "truncated: {vertices} vertices and {faces} faces declared, more than the file can hold"
        ));
    }
    let mut precision = Precision::default();
    let mut content = Content::new(name);
    for number in 0..vertices {
        let line = lines.next().ok_or_else(|| format!("vertex {number} (from 0): truncated"))?;
        let mut words = line.words();
        let mut next = || precision.text(words.next()?);
        let (Some(x), Some(y), Some(z)) = (next(), next(), next()) else {
            let what = format!("vertex {number} (from 0)");
            return Err(line.about(&what, "expected three finite numbers"));
        };
        content.positions.push(DVec3::new(x, y, z));
        if kind.has_colours {
            let words: Vec<&str> = words.skip(if kind.has_normals { 3 } else { 0 }).collect();
            // Texture coordinates follow colours of four numbers.
            content.colours.push(colour(words.get(..4).unwrap_or(&words)));
        }
    }
    for number in 0..faces {
        let line = lines.next().ok_or_else(|| format!("face {number} (from 0): truncated"))?;
        let about = |problem: &str| line.about(&format!("face {number} (from 0)"), problem);
        let (corners, own) =
            face(line, content.positions.len()).map_err(|problem| about(&problem))?;
        content.add_face(&corners, own);
    }
    Ok(content.mesh.finish(precision.unit()))
}

/// Reads the part of a binary file after the first line: numbers of 32 bits, big-endian.
fn binary(name: &str, kind: &Kind, mut rest: &[u8]) -> Result<Scene, String> {
    let mut take = |count: usize| {
        let (bytes, behind) = rest.split_at_checked(count.saturating_mul(4)).ok_or("truncated")?;
        rest = behind;
        Ok::<_, &str>(bytes.as_chunks().0)
    };
    let whole = |&bytes: &[u8; 4]| u32::from_be_bytes(bytes) as usize;
    let single = |&bytes: &[u8; 4]| f32::from_be_bytes(bytes);
    let counts = take(3)?;
    let [vertices, faces] = [whole(&counts[0]), whole(&counts[1])];
    let (mut precision, mut content) = (Precision::default(), Content::new(name));
    let first_colour = 3 + if kind.has_normals { 3 } else { 0 };
    let behind_colours = first_colour + if kind.has_colours { 4 } else { 0 };
    let count = behind_colours + if kind.has_textures { 2 } else { 0 };
    for number in 0..vertices {
        let about = |problem: &str| format!("vertex {number} (from 0): {problem}");
        let numbers: Vec<f32> = take(count).map_err(about)?.iter().map(single).collect();
        let mut coordinate = |axis: usize| precision.single(numbers[axis]);
        let (Some(x), Some(y), Some(z)) = (coordinate(0), coordinate(1), coordinate(2)) else {
            return Err(about("a coordinate is not a finite number"));
        };
        content.positions.push(DVec3::new(x, y, z));
        if let &[r, g, b, opacity] = &numbers[first_colour..behind_colours] {
            content.colours.push(Some([r, g, b, opacity]));
        }
    }
    for number in 0..faces {
        let about = |problem: &str| format!("face {number} (from 0): {problem}");
        let mut list = || {
            let count = whole(&take(1)?[0]);
            take(count)
        };
        let corners: Vec<usize> = list().map_err(about)?.iter().map(whole).collect();
        if let Some(corner) = corners.iter().find(|&&corner| corner >= vertices) {
            return Err(about(&format!("index {corner} is out of range: {vertices} vertices")));
        }
        // A single number is an index of a colour map.
        let numbers: Vec<f32> = list().map_err(about)?.iter().map(single).collect();
        let own = match numbers[..] {
            [r, g, b] => Some([r, g, b, 1.0]),
            [r, g, b, opacity] => Some([r, g, b, opacity]),
            _ => None,
        };
        content.add_face(&corners, own);
    }
    Ok(content.mesh.finish(precision.unit()))
}

/// The content of a file: vertices, their colours if the file has any, and faces.
struct Content {
    mesh: Mesh,
    positions: Vec<DVec3>,
    colours: Vec<Option<Colour>>,
}

impl Content {
    fn new(name: &str) -> Self {
        Self { mesh: Mesh::new(name, DVec3::Z), positions: Vec::new(), colours: Vec::new() }
    }

    /// Adds a face with its own colour, or the mean of its vertices' colours.
    fn add_face(&mut self, corners: &[usize], own: Option<Colour>) {
        let of_vertices = || mean(corners.iter().map(|&corner| *self.colours.get(corner)?));
        let colour = own.or_else(of_vertices);
        self.mesh.face(corners.iter().map(|&corner| self.positions[corner]), colour);
    }
}

/// The corners and the colour in a line.
fn face(line: Line<'_>, vertices: usize) -> Result<(Vec<usize>, Option<Colour>), String> {
    let mut words = line.words();
    let count: Option<usize> = words.next().and_then(|word| word.parse().ok());
    let count = count.ok_or("expected the number of corners")?;
    let mut corners = Vec::new();
    for number in 0..count {
        let word = words
            .next()
            .ok_or_else(|| format!("truncated: {count} corners declared, {number} found"))?;
        match word.parse() {
            Ok(corner) if corner < vertices => corners.push(corner),
            _ => return Err(format!("index {word:.20} is out of range: {vertices} vertices")),
        }
    }
    Ok((corners, colour(&words.collect::<Vec<_>>())))
}

/// A colour of three or four numbers: whole numbers up to 255, other numbers up to 1.
fn colour(words: &[&str]) -> Option<Colour> {
    let numbers: Vec<f32> = words.iter().map_while(|word| word.parse().ok()).collect();
    let &[r, g, b, ref rest @ ..] = &numbers[..] else { return None };
    let is_whole = words.iter().all(|word| word.bytes().all(|byte| byte.is_ascii_digit()));
    let full = if is_whole { 255.0 } else { 1.0 };
    let opacity = rest.first().map_or(1.0, |opacity| opacity / full);
    Some([r / full, g / full, b / full, opacity])
}
