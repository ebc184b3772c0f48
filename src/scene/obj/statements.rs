//! The statements of an OBJ file, read line by line and checked.

use std::borrow::Cow;
use std::collections::HashMap;
use std::io::{self, BufReader, Bytes, Read};
use std::ops::ControlFlow;
use std::path::Path;

use glam::DVec3;

use super::decimals::Decimals;
use super::{ObjReport, material};
use crate::error::{Error, FileFault, Kind, Problem};
use crate::input::MAX_CORNERS;
use crate::scene::{Material, Scene};

/// The number of bytes read at once.
const CHUNK: usize = 1 << 18;

/// A line about polygons or their corners.
pub(super) enum Statement<'a> {
    /// A vertex, at a finite position.
    Vertex(DVec3),
    TextureCoordinates,
    Normal,
    /// A face: the numbers of the vertices, counted from 0, the material's number, and the line.
    Face {
        corners: &'a [usize],
        material: u32,
        line: usize,
    },
}

/// The line and the face of a problem, as far as known.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Place {
    pub(super) line: Option<usize>,
    pub(super) face: Option<usize>,
}

/// Names as bytes, numbered in the order of their first mention.
type Names = HashMap<Vec<u8>, u32>;

/// The contents of a file besides vertices and faces.
#[derive(Default)]
pub(super) struct Contents {
    pub(super) report: ObjReport,
    vertices: usize,
    decimals: Decimals,
    libraries: Names,
    /// The materials that faces use; the name is empty if the file sets no material.
    materials: Names,
    /// The name of the material in use, and the material's number, assigned at the first use by a face.
    material: (Vec<u8>, Option<u32>),
    /// The largest number, counted from 1, of a vertex that a face names, and the place of that face.
    highest: (usize, Place),
}

/// Reads a file called `name`. Calls `visit` with each statement, and the words after its keyword, until
/// `visit` breaks.
pub(super) fn read<B>(
    name: &str,
    input: io::Result<impl Read>,
    mut visit: impl FnMut(Statement<'_>, &mut dyn Iterator<Item = &str>) -> ControlFlow<B>,
) -> Result<(Contents, ControlFlow<B>), Error> {
    let (mut contents, mut place) = (Contents::default(), Place::default());
    let read = || -> Result<ControlFlow<B>, Problem> {
        let mut lines = Lines::new(input?);
        let mut corners = Vec::new();
        while let Some(line) = lines.next()? {
            place.line = Some(line);
            let text = decode(&lines.line)?;
            let mut words = words(&text);
            let statement = match words.next() {
                Some("v") => Some(Statement::Vertex(contents.vertex(words.clone())?)),
                Some("vt") => Some(Statement::TextureCoordinates),
                Some("vn") => Some(Statement::Normal),
                Some("f") => {
                    place.face = Some(contents.report.faces);
                    let material = contents.face(words.clone(), place, &mut corners)?;
                    Some(Statement::Face { corners: &corners, material, line })
                }
                keyword => {
                    contents.aside(keyword, &lines.line);
                    None
                }
            };
            if let Some(statement) = statement
                && let ControlFlow::Break(value) = visit(statement, &mut words)
            {
                return Ok(ControlFlow::Break(value));
            }
            place = Place::default();
        }
        if contents.report.faces == 0 {
            return Err("no faces: there must be at least one `f` line".into());
        }
        let (highest, vertices) = (contents.highest.0, contents.vertices);
        if highest > vertices {
            place = contents.highest.1;
            return Err(no_vertex(&highest.to_string(), vertices));
        }
        Ok(ControlFlow::Continue(()))
    };
    match read() {
        Ok(flow) => Ok((contents, flow)),
        Err(problem) => {
            let kind = Kind::File(FileFault { name: name.to_owned(), line: place.line, problem });
            Err(match place.face {
                Some(face) => kind.of_polygon(face),
                None => kind.error(),
            })
        }
    }
}

impl Contents {
    /// Reads a line that changes no polygon and no corner.
    fn aside(&mut self, keyword: Option<&str>, line: &[u8]) {
        match keyword {
            Some("usemtl") => self.material = (behind_keyword(line).to_owned(), None),
            Some("mtllib") => _ = number(&mut self.libraries, behind_keyword(line)),
            Some("p") => self.report.skipped_points += 1,
            Some("l") => self.report.skipped_lines += 1,
            // These statements name or group faces, or define their shading.
            None | Some("o" | "g" | "s" | "mg") => {}
            Some(_) => self.report.skipped_statements += 1,
        }
    }

    fn vertex<'a>(&mut self, words: impl Iterator<Item = &'a str>) -> Result<DVec3, Problem> {
        let (mut vertex, mut found) = ([0.0_f64; 3], 0);
        for (coordinate, word) in vertex.iter_mut().zip(words) {
            *coordinate =
                word.parse().map_err(|_| format!("the coordinate {word:?} is not a number"))?;
            if !coordinate.is_finite() {
                let problem = "is not finite; remove the vertex or correct it";
                return Err(format!("the coordinate {word:?} {problem}").into());
            }
            self.decimals.see(word, *coordinate);
            found += 1;
        }
        if found < 3 {
            return Err(format!("{found} coordinates; a `v` line needs x, y and z").into());
        }
        self.vertices += 1;
        Ok(vertex.into())
    }

    /// Reads the corners of a face; returns the number of the face's material.
    fn face<'a>(
        &mut self,
        words: impl Iterator<Item = &'a str>,
        place: Place,
        corners: &mut Vec<usize>,
    ) -> Result<u32, Problem> {
        if self.report.faces == u32::MAX as usize {
            return Err(format!("more than {} faces; divide the file", u32::MAX).into());
        }
        corners.clear();
        for word in words {
            if corners.len() == MAX_CORNERS {
                return Err(format!("more than {MAX_CORNERS} corners; divide the polygon").into());
            }
            let vertex = word.split('/').next().unwrap_or_default();
            let Some(index) = index(vertex, self.vertices) else {
                return Err(no_vertex(word, self.vertices));
            };
            if index >= self.highest.0 {
                self.highest = (index + 1, place);
            }
            corners.push(index);
        }
        self.report.faces += 1;
        let (name, known) = &mut self.material;
        Ok(*known.get_or_insert_with(|| number(&mut self.materials, name)))
    }

    /// The scene without its polygons. `library` returns the content of a material library.
    pub(super) fn scene(
        &mut self,
        name: &str,
        library: impl FnMut(&Path) -> Option<Vec<u8>>,
    ) -> Scene {
        let known = material::load(&in_order(&self.libraries), library, &mut self.report);
        let mut scene = Scene::new(name, DVec3::Y);
        scene.precision = 4.0 * self.decimals.unit();
        for bytes in in_order(&self.materials) {
            scene.add_material(known.get(bytes).cloned().unwrap_or_else(|| {
                let name = text(bytes).into_owned();
                if !name.is_empty() {
                    self.report.missing_materials.push(name.clone());
                }
                Material { name, ..Material::DEFAULT }
            }));
        }
        scene
    }
}

/// The number of a name, assigned at the name's first mention.
fn number(names: &mut Names, name: &[u8]) -> u32 {
    // There are no more names than lines, and no more materials than faces.
    let next = names.len() as u32;
    *names.entry(name.to_owned()).or_insert(next)
}

fn in_order(names: &Names) -> Vec<&[u8]> {
    let mut names: Vec<_> = names.iter().collect();
    names.sort_unstable_by_key(|&(_, number)| number);
    names.into_iter().map(|(name, _)| &name[..]).collect()
}

/// The number, counted from 0, of a vertex, texture coordinate or normal. A positive word counts from 1; a
/// negative word counts backwards from the last of the `count` items so far. The number may be beyond the
/// last item of the file.
pub(super) fn index(word: &str, count: usize) -> Option<usize> {
    let number: i64 = word.parse().ok()?;
    let from_0 = if number < 0 { number.checked_add_unsigned(count as u64)? } else { number - 1 };
    // The next number must also be valid.
    usize::try_from(from_0).ok().filter(|&index| index < usize::MAX)
}

/// The problem of a word that names no vertex.
#[cold]
fn no_vertex(word: &str, vertices: usize) -> Problem {
    let vertex = word.split('/').next().unwrap_or_default();
    match vertex.parse::<i128>() {
        Ok(0) => "vertex 0 does not exist; the first vertex is 1".into(),
        Ok(_) => format!("vertex {vertex} does not exist; there are {vertices} `v` lines").into(),
        Err(_) => {
            format!("{word:?} does not name a vertex; write whole numbers such as 3, 3/1 or -1")
                .into()
        }
    }
}

/// The words of a line up to a comment.
pub(super) fn words(line: &str) -> impl Iterator<Item = &str> + Clone {
    line.split_whitespace().take_while(|word| !word.starts_with('#'))
}

/// A line without its first word: a name, with all its spaces.
pub(super) fn behind_keyword(line: &[u8]) -> &[u8] {
    let mut parts = line.trim_ascii().splitn(2, u8::is_ascii_whitespace);
    parts.nth(1).unwrap_or_default().trim_ascii_start()
}

/// The text of a line.
pub(super) fn decode(line: &[u8]) -> Result<Cow<'_, str>, Problem> {
    if line.contains(&0) {
        let problem = "a zero byte, so this is UTF-16, UTF-32 or not text; save it as UTF-8";
        return Err(format!("wrong encoding: {problem}").into());
    }
    Ok(text(line))
}

/// Bytes as text. If they are not UTF-8, each byte becomes the character of that number (Latin-1): old files
/// have names and comments in other encodings.
pub(super) fn text(bytes: &[u8]) -> Cow<'_, str> {
    match str::from_utf8(bytes) {
        Ok(text) => Cow::Borrowed(text),
        Err(_) => bytes.iter().map(|&byte| char::from(byte)).collect(),
    }
}

/// Byte-order marks of unsupported encodings; the mark of UTF-32 begins with the mark of UTF-16.
const MARKS: [(&[u8], &str); 4] = [
    (b"\xff\xfe\0\0", "UTF-32"),
    (b"\0\0\xfe\xff", "UTF-32"),
    (b"\xff\xfe", "UTF-16"),
    (b"\xfe\xff", "UTF-16"),
];

/// The lines of a text. Lines end in LF, CR LF or CR. A line that is not a comment and ends in a backslash is
/// joined with the next line by a space.
pub(super) struct Lines<R> {
    input: Bytes<BufReader<R>>,
    pub(super) line: Vec<u8>,
    /// The number of line ends read.
    ends: usize,
    /// Whether the last byte was CR: a LF that follows is part of the same line end.
    is_after_cr: bool,
}

impl<R: Read> Lines<R> {
    pub(super) fn new(input: R) -> Self {
        let input = BufReader::with_capacity(CHUNK, input).bytes();
        Self { input, line: Vec::new(), ends: 0, is_after_cr: false }
    }

    /// Reads the next line; returns the line's number, counted from 1. Joined lines have the number of the
    /// first line. `None` at the end.
    pub(super) fn next(&mut self) -> Result<Option<usize>, Problem> {
        self.line.clear();
        let is_there = self.append()?;
        let number = self.ends;
        if number == 1 {
            if let Some((_, name)) = MARKS.iter().find(|(mark, _)| self.line.starts_with(mark)) {
                return Err(format!("wrong encoding: this is {name}; save it as UTF-8").into());
            }
            if self.line.starts_with("\u{feff}".as_bytes()) {
                self.line.drain(..3);
            }
        }
        // A comment can end in a Windows path.
        let is_comment = self.line.trim_ascii_start().starts_with(b"#");
        while !is_comment && self.line.ends_with(b"\\") {
            self.line.pop();
            self.line.push(b' ');
            self.append()?;
        }
        Ok(is_there.then_some(number))
    }

    /// Appends the next line of the file; `false` at the end.
    fn append(&mut self) -> io::Result<bool> {
        let mut is_there = false;
        for byte in self.input.by_ref() {
            let byte = byte?;
            let is_second =
                std::mem::replace(&mut self.is_after_cr, byte == b'\r') && byte == b'\n';
            if is_second {
                continue;
            }
            is_there = true;
            if byte == b'\n' || byte == b'\r' {
                break;
            }
            self.line.push(byte);
            // No text has a zero byte, and some devices return nothing else. The longest mark has 4 bytes.
            if byte == 0 && self.line.len() > 4 {
                break;
            }
        }
        self.ends += usize::from(is_there);
        Ok(is_there)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// All lines with their numbers, or the problem.
    fn all(bytes: impl AsRef<[u8]>) -> Result<Vec<(usize, String)>, String> {
        let (mut lines, mut all) = (Lines::new(bytes.as_ref()), Vec::new());
        while let Some(number) = lines.next().map_err(|problem| problem.to_string())? {
            let text = decode(&lines.line).map_err(|problem| problem.to_string())?;
            all.push((number, text.into_owned()));
        }
        Ok(all)
    }

    #[test]
    fn every_line_end_counts_once() {
        let expected = [(1, "a"), (2, "b"), (3, ""), (4, "c")].map(|(n, s)| (n, s.to_owned()));
        for text in ["a\nb\n\nc\n", "a\r\nb\r\n\r\nc", "a\rb\r\rc\r", "\u{feff}a\nb\r\n\rc"] {
            assert_eq!(all(text).unwrap(), expected, "{text:?}");
        }
        assert_eq!([all(""), all("\n"), all("\r")].map(|lines| lines.unwrap().len()), [0, 1, 1]);
    }

    #[test]
    fn backslash_joins_lines_but_not_after_a_comment() {
        let expected = [(1, "f 1  2  3"), (4, "# C:\\"), (5, "v")].map(|(n, s)| (n, s.to_owned()));
        assert_eq!(all("f 1 \\\n2 \\\n3\n# C:\\\nv").unwrap(), expected);
        assert_eq!(all("v \\").unwrap(), [(1, "v  ".to_owned())]);
    }

    #[test]
    fn a_line_that_is_not_utf_8_is_latin_1() {
        let expected = [(1, "# é"), (2, "o é")].map(|(n, s)| (n, s.to_owned()));
        assert_eq!(all(b"# \xe9\no \xc3\xa9").unwrap(), expected);
    }

    #[test]
    fn other_encodings_are_named() {
        assert!(all(b"\xff\xfev\0").unwrap_err().contains("UTF-16"));
        assert!(all(b"v 1\nv\0").unwrap_err().contains("zero byte"));
    }
}
