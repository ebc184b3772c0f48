//! The lines of an OBJ file, checked, and the text that is left for `tobj`.

use super::attributes::Found;
use super::decimals::Decimals;
use super::error::{Kind, ObjError};
use super::report::ObjReport;
use super::text::lines;
use crate::input::MAX_CORNERS;
use std::collections::{HashMap, HashSet};
use std::fmt::Write;
use std::str::SplitWhitespace;

/// The statements of an OBJ file, read and checked line by line before `tobj` sees them.
///
/// `tobj` accepts NaN and infinity, reads `l` lines as faces, divides coordinates by a fourth one,
/// reorders faces by material, fails on indices of normals that are not read, and names no line in
/// its errors. So it gets only `v` lines of three finite numbers and `f` lines of vertex numbers
/// from 1.
#[derive(Debug, Default)]
pub(super) struct Scan {
    pub(super) cleaned: String,
    /// The corners of all faces together.
    pub(super) corners: usize,
    /// Each face's place in `materials`.
    pub(super) material_of: Vec<u32>,
    /// Each face's line in the file.
    pub(super) face_lines: Vec<usize>,
    /// The materials that faces use; `None` where no name was given.
    pub(super) materials: Vec<Option<String>>,
    /// Material libraries in the order of their first mention.
    pub(super) libraries: Vec<String>,
    pub(super) attributes: Found,
    pub(super) decimals: Decimals,
    pub(super) report: ObjReport,
    vertices: usize,
    /// The highest vertex number that was not yet defined when it was used.
    ahead: Option<Ahead>,
    /// The name of the material in use, and the numbers of those that were.
    in_use: Option<String>,
    numbers: HashMap<Option<String>, u32>,
    /// The libraries, to find those that are mentioned again.
    known_libraries: HashSet<String>,
    /// Whether what is said of corners besides their positions is passed over.
    is_bare: bool,
}

/// A vertex number with the line and the face that use it.
#[derive(Debug)]
struct Ahead {
    index: usize,
    line: usize,
    face: usize,
}

impl Scan {
    pub(super) fn new(text: &str) -> Result<Self, ObjError> {
        let mut scan = Self::default();
        scan.cleaned.reserve(text.len());
        lines(text).try_for_each(|(number, line)| scan.line(number, &line))?;
        scan.finish()
    }

    /// One that passes over what is said of corners besides their positions.
    pub(super) fn bare() -> Self {
        Self { is_bare: true, ..Self::default() }
    }

    /// Reads the next line, by its number from 1.
    pub(super) fn line(&mut self, number: usize, line: &str) -> Result<(), ObjError> {
        let line = line.trim_start();
        let mut words = line.split_whitespace();
        let keyword = words.next().unwrap_or("#");
        // The last byte of a name may be a space in another encoding.
        let rest = || line.get(keyword.len()..).unwrap_or_default().trim_ascii();
        match keyword {
            "v" => self.vertex(words, number)?,
            "vt" | "vn" if self.is_bare => {}
            "vt" => self.attributes.uv(words),
            "vn" => self.attributes.normal(words),
            "f" => {
                self.face(words, number)?;
                let material = self.number_of_material();
                self.material_of.push(material);
                self.face_lines.push(number);
            }
            "usemtl" => self.in_use = Some(rest().to_owned()).filter(|name| !name.is_empty()),
            "mtllib" if !rest().is_empty() && self.known_libraries.insert(rest().to_owned()) => {
                self.libraries.push(rest().to_owned());
            }
            "p" => self.report.skipped_points += 1,
            "l" => self.report.skipped_lines += 1,
            _ if keyword.starts_with('#') || HARMLESS.contains(&keyword) => {}
            _ => self.report.skipped_statements += 1,
        }
        Ok(())
    }

    /// An error if a face names a vertex that does not exist, or there is none.
    pub(super) fn finish(self) -> Result<Self, ObjError> {
        if self.report.faces == 0 {
            return Err(Kind::NoFace.at(None, None));
        }
        match &self.ahead {
            Some(ahead) if ahead.index > self.vertices => {
                Err(Kind::OutOfRange { index: ahead.index.to_string(), vertices: self.vertices }
                    .at(Some(ahead.line), Some(ahead.face)))
            }
            _ => Ok(self),
        }
    }

    /// The number of the material in use.
    fn number_of_material(&mut self) -> u32 {
        if let Some(&number) = self.numbers.get(&self.in_use) {
            return number;
        }
        // No more names than faces, of which there are at most u32::MAX.
        let number = self.materials.len() as u32;
        self.materials.push(self.in_use.clone());
        self.numbers.insert(self.in_use.clone(), number);
        number
    }

    fn vertex(&mut self, mut words: SplitWhitespace<'_>, line: usize) -> Result<(), ObjError> {
        self.cleaned.push('v');
        let mut found = 0;
        for token in words.by_ref().take(3).take_while(|word| !word.starts_with('#')) {
            check_coordinate(token).map_err(|kind| kind.at(Some(line), None))?;
            self.decimals.see(token);
            self.cleaned.push(' ');
            self.cleaned.push_str(token);
            found += 1;
        }
        self.cleaned.push('\n');
        if !self.is_bare {
            self.attributes.vertex(self.vertices, words);
        }
        self.vertices += 1;
        match found {
            3 => Ok(()),
            _ => Err(Kind::FewCoordinates(found).at(Some(line), None)),
        }
    }

    fn face(&mut self, words: SplitWhitespace<'_>, line: usize) -> Result<(), ObjError> {
        let face = self.report.faces;
        if face == u32::MAX as usize {
            return Err(Kind::TooManyFaces.at(Some(line), None));
        }
        self.cleaned.push('f');
        for (corner, token) in words.take_while(|word| !word.starts_with('#')).enumerate() {
            if corner == MAX_CORNERS {
                return Err(Kind::TooManyCorners.at(Some(line), Some(face)));
            }
            let index =
                self.vertex_number(token).map_err(|kind| kind.at(Some(line), Some(face)))?;
            let highest = self.ahead.as_ref().map_or(self.vertices, |ahead| ahead.index);
            if index > highest.max(self.vertices) {
                self.ahead = Some(Ahead { index, line, face });
            }
            // Writing to a string does not fail.
            let _ = write!(self.cleaned, " {index}");
            if !self.is_bare {
                self.attributes.corner(index, token.split_once('/').map(|(_, rest)| rest));
            }
            self.corners += 1;
        }
        self.cleaned.push('\n');
        self.report.faces += 1;
        Ok(())
    }

    /// The number from 1 of the vertex in `vertex/texture/normal`, where a negative one counts back
    /// from the last vertex so far. It may still lie beyond the last vertex of the file.
    fn vertex_number(&self, token: &str) -> Result<usize, Kind> {
        let digits = token.split('/').next().unwrap_or_default();
        let out_of_range =
            || Kind::OutOfRange { index: digits.to_owned(), vertices: self.vertices };
        match digits.parse::<i64>() {
            Ok(0) => Err(Kind::ZeroIndex),
            Ok(index) if index > 0 => usize::try_from(index).map_err(|_| out_of_range()),
            Ok(index) => usize::try_from(index.unsigned_abs())
                .ok()
                .and_then(|back| (self.vertices + 1).checked_sub(back))
                .filter(|&number| number > 0)
                .ok_or_else(out_of_range),
            Err(error) => match error.kind() {
                std::num::IntErrorKind::PosOverflow | std::num::IntErrorKind::NegOverflow => {
                    Err(out_of_range())
                }
                _ => Err(Kind::Index(token.to_owned())),
            },
        }
    }
}

/// Statements that name, group or decorate faces and change no polygon.
const HARMLESS: [&str; 5] = ["o", "g", "s", "mtllib", "mg"];

fn check_coordinate(token: &str) -> Result<(), Kind> {
    match token.parse::<f64>() {
        Ok(number) if number.is_finite() => Ok(()),
        Ok(_) => Err(Kind::NotFinite(token.to_owned())),
        Err(_) => Err(Kind::Coordinate(token.to_owned())),
    }
}
