//! OFF files (Geomview): vertices and polygons as text, with colours in some. Up is z.

use binspace::glam::DVec3;
use binspace::scene::Scene;

use super::mesh::{Colour, Mesh, Precision, mean};
use super::text::{Line, Lines};

/// The content of each vertex line, as the first word of a file gives it: `OFF` behind these letters.
struct Kind {
    has_colours: bool,
    has_normals: bool,
}

impl Kind {
    /// `None` if it is another word. Vertices of four or more coordinates do not occur in scenes.
    fn of(word: &[u8]) -> Option<Self> {
        let rest = word.strip_suffix(b"OFF")?;
        let rest = rest.strip_prefix(b"ST").unwrap_or(rest);
        let (has_colours, has_normals) = match rest {
            b"" => (false, false),
            b"C" => (true, false),
            b"N" => (false, true),
            b"CN" => (true, true),
            _ => return None,
        };
        Some(Self { has_colours, has_normals })
    }
}

/// Whether a file begins as one of these.
pub(crate) fn is_off(beginning: &[u8]) -> bool {
    let text = beginning.trim_ascii_start();
    text.split(u8::is_ascii_whitespace).next().is_some_and(|word| Kind::of(word).is_some())
}

/// Reads a file.
pub(crate) fn read(name: &str, bytes: &[u8]) -> Result<Scene, String> {
    let mut lines = Lines::new(bytes);
    let first = lines.next().ok_or("it is empty")?;
    let mut words = first.words();
    let kind = Kind::of(words.next().unwrap_or_default().as_bytes()).ok_or("it is no OFF file")?;
    let mut counts: Vec<&str> = words.collect();
    if counts.first() == Some(&"BINARY") {
        return Err("binary OFF files are not supported: write it as text".into());
    }
    if counts.is_empty() {
        counts = lines.next().ok_or("cut short before its counts")?.words().collect();
    }
    let count = |i: usize| counts.get(i).and_then(|word| word.parse::<usize>().ok());
    let (Some(vertices), Some(faces)) = (count(0), count(1)) else {
        return Err("expected the numbers of vertices and faces behind `OFF`".into());
    };
    // Each line of a vertex or a face has two bytes at least. So the memory requested later is at most
    // proportional to the file's size.
    if vertices.saturating_add(faces) > bytes.len() / 2 {
        return Err(format!(
            "truncated: {vertices} vertices and {faces} faces declared, more than fit into it"
        ));
    }
    let (mut mesh, mut precision) = (Mesh::new(name, DVec3::Z), Precision::default());
    let (mut positions, mut colours) = (Vec::new(), Vec::new());
    for number in 0..vertices {
        let line = lines.next().ok_or_else(|| format!("vertex {number} (from 0): cut short"))?;
        let mut words = line.words();
        let mut next = || precision.text(words.next()?);
        let (Some(x), Some(y), Some(z)) = (next(), next(), next()) else {
            let what = format!("vertex {number} (from 0)");
            return Err(line.about(&what, "expected three finite numbers"));
        };
        positions.push(DVec3::new(x, y, z));
        if kind.has_colours {
            let words: Vec<&str> = words.skip(if kind.has_normals { 3 } else { 0 }).collect();
            // Texture coordinates follow colours of four numbers.
            colours.push(colour(words.get(..4).unwrap_or(&words)));
        }
    }
    for number in 0..faces {
        let line = lines.next().ok_or_else(|| format!("face {number} (from 0): cut short"))?;
        let about = |problem: &str| line.about(&format!("face {number} (from 0)"), problem);
        let (corners, own) = face(line, positions.len()).map_err(|problem| about(&problem))?;
        let of_vertices = || mean(corners.iter().map(|&corner| *colours.get(corner)?));
        mesh.face(corners.iter().map(|&corner| positions[corner]), own.or_else(of_vertices));
    }
    Ok(mesh.finish(precision.unit()))
}

/// The corners and the colour in a line.
fn face(line: Line<'_>, vertices: usize) -> Result<(Vec<usize>, Option<Colour>), String> {
    let mut words = line.words();
    let count: Option<usize> = words.next().and_then(|word| word.parse().ok());
    let count = count.ok_or("expected the number of its corners")?;
    let mut corners = Vec::new();
    for number in 0..count {
        let word = words
            .next()
            .ok_or_else(|| format!("truncated: {count} corners declared, {number} found"))?;
        match word.parse() {
            Ok(corner) if corner < vertices => corners.push(corner),
            _ => return Err(format!("{word:.20} is not one of {vertices} vertices")),
        }
    }
    Ok((corners, colour(&words.collect::<Vec<_>>())))
}

/// A colour of three or four numbers: whole ones up to 255, others up to 1.
fn colour(words: &[&str]) -> Option<Colour> {
    let numbers: Vec<f32> = words.iter().map_while(|word| word.parse().ok()).collect();
    let &[r, g, b, ref rest @ ..] = &numbers[..] else { return None };
    let is_whole = words.iter().all(|word| word.bytes().all(|byte| byte.is_ascii_digit()));
    let full = if is_whole { 255.0 } else { 1.0 };
    let opacity = rest.first().map_or(1.0, |opacity| opacity / full);
    Some([r / full, g / full, b / full, opacity])
}
