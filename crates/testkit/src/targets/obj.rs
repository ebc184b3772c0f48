//! OBJ files: files with a known meaning, and files of any bytes.

use arbitrary::{Result, Unstructured};
use binspace::glam::DVec3;
use binspace::scene::Scene;
use std::fmt::Write;
use std::path::Path;

/// The polygons of a valid file as the crate `tobj` reads them. `None` for text that this function does not
/// prepare: other encodings, and backslashes except at the end of lines without comments.
///
/// `tobj` accepts NaN, reads `l` lines as faces, divides coordinates by a fourth number, reorders faces by
/// material and checks the numbers of normals. So it receives only `v` lines of three numbers and `f` lines
/// of vertex numbers.
pub fn polygons_of_tobj(bytes: &[u8]) -> Option<Vec<Vec<DVec3>>> {
    let text = std::str::from_utf8(bytes).ok()?;
    let has_comments = text.contains('#');
    let text = text.trim_start_matches('\u{feff}').replace("\r\n", "\n").replace('\r', "\n");
    let text = if has_comments { text } else { text.replace("\\\n", " ") };
    if text.contains('\\') {
        return None;
    }
    let mut prepared = String::new();
    for line in text.lines() {
        let mut words = line.split_whitespace().take_while(|word| !word.starts_with('#'));
        let (keyword, count) = match words.next() {
            Some("v") => ("v", 3),
            Some("f") => ("f", usize::MAX),
            _ => continue,
        };
        prepared.push_str(keyword);
        let numbers = words.take(count).filter_map(|word| word.split('/').next());
        numbers.for_each(|number| prepared.extend([" ", number]));
        prepared.push('\n');
    }
    let no_library = |_: &Path| Err(tobj::LoadError::OpenFileFailed);
    let options = tobj::LoadOptions::default();
    let (models, _) = tobj::load_obj_buf(&mut prepared.as_bytes(), &options, no_library)
        .unwrap_or_else(|error| panic!("{error}: {text}"));
    let mut polygons = Vec::new();
    for tobj::Model { mesh, .. } in models {
        let (points, _) = mesh.positions.as_chunks::<3>();
        let mut corners = mesh.indices.iter().map(|&number| DVec3::from(points[number as usize]));
        // If all faces are triangles, `tobj` returns no numbers of corners.
        let sides = match &mesh.face_arities[..] {
            [] => vec![3; mesh.indices.len() / 3],
            sides => sides.to_vec(),
        };
        polygons.extend(sides.iter().map(|&n| corners.by_ref().take(n as usize).collect()));
        assert!(corners.next().is_none());
    }
    Some(polygons)
}

/// The expected result of reading a file that was written here.
struct Known {
    text: String,
    corners: Vec<DVec3>,
    faces: Vec<Vec<usize>>,
    /// The first line that must be refused.
    refused: Option<usize>,
    lines: usize,
}

/// Reads a file with a known meaning in half of the cases, and the bytes themselves in the other half.
pub fn run(data: &[u8]) {
    match data.split_first() {
        Some((kind, rest)) if kind % 2 == 1 => {
            // Too few bytes make no file.
            let _ = read_known(&mut Unstructured::new(rest));
        }
        Some((_, rest)) => read_any(rest),
        None => {}
    }
}

/// Reads any bytes. A scene that is read must be finite, and must be read back as the same scene after
/// writing.
fn read_any(bytes: &[u8]) {
    // The material library is the file itself, so its lines are read as material lines too.
    let Ok((scene, report)) = Scene::from_obj("any", bytes, |_| Some(bytes.to_vec())) else {
        return;
    };
    assert!(scene.len() == report.faces && !scene.is_empty());
    assert!(scene.polygons().flatten().all(|corner| corner.is_finite()));
    let colours = scene.materials().iter();
    assert!(colours.flat_map(|m| m.color.into_iter().chain([m.opacity])).all(|c| c.is_finite()));
    let corners = |scene: &Scene| scene.polygons().map(|p| p.points().to_vec()).collect::<Vec<_>>();
    if let Some(polygons) = polygons_of_tobj(bytes) {
        assert_eq!(corners(&scene), polygons);
    }
    let mut text = String::new();
    let mut next = 0;
    for polygon in scene.polygons() {
        for corner in polygon {
            let _ = writeln!(text, "v {:e} {:e} {:e}", corner.x, corner.y, corner.z);
        }
        let numbers: Vec<String> =
            (1..=polygon.points().len()).map(|k| (next + k).to_string()).collect();
        let _ = writeln!(text, "f {}", numbers.join(" "));
        next += polygon.points().len();
    }
    let again = Scene::from_obj("again", text.as_bytes(), |_| None);
    let (again, _) = again.unwrap_or_else(|error| panic!("{error}: {text}"));
    // Only corners are compared, because vertices that no face names also determine the precision.
    assert_eq!(corners(&scene), corners(&again), "{text}");
}

fn read_known(bytes: &mut Unstructured<'_>) -> Result<()> {
    let mut known =
        Known { text: String::new(), corners: vec![], faces: vec![], refused: None, lines: 0 };
    if bytes.ratio(1, 8u8)? {
        known.text.push('\u{feff}');
    }
    for _ in 0..bytes.int_in_range(0..=40u8)? {
        known.lines += 1;
        let line = known.lines;
        let written = match bytes.int_in_range(0..=9u8)? {
            0..=3 => known.vertex(bytes)?,
            4..=6 => known.face(bytes)?,
            _ => known.aside(bytes)?,
        };
        if !written && known.refused.is_none() {
            known.refused = Some(line);
        }
        known.end_line(bytes)?;
    }
    known.check();
    Ok(())
}

/// A small number, or any finite one.
fn coordinate(bytes: &mut Unstructured<'_>) -> Result<f64> {
    if bytes.ratio(1, 4u8)? {
        return Ok(f64::from(bytes.arbitrary::<i8>()?) / 4.0);
    }
    Ok(Some(bytes.arbitrary::<f64>()?).filter(|number| number.is_finite()).unwrap_or(0.1))
}

impl Known {
    /// A `v` line; returns whether it is valid.
    fn vertex(&mut self, bytes: &mut Unstructured<'_>) -> Result<bool> {
        let corner = DVec3::new(coordinate(bytes)?, coordinate(bytes)?, coordinate(bytes)?);
        let bad = bytes.ratio(1, 40u8)?;
        self.text.push('v');
        for (axis, coordinate) in corner.to_array().into_iter().enumerate() {
            if bad && axis == 1 {
                let word = ["nan", "inf", "-Infinity", "1e999", "x", "1,5", ""];
                let _ = write!(self.text, " {}", bytes.choose(&word)?);
            } else {
                // The shortest text that reads back as the same number, in different notations.
                let _ = match bytes.arbitrary()? {
                    true => write!(self.text, " {coordinate:e}"),
                    false => write!(self.text, " {coordinate}"),
                };
            }
        }
        if !bad {
            self.text.push_str(bytes.choose(&["", " 1.0", " 0.5 0.5 0.5", "\t", " # a corner"])?);
        }
        self.corners.push(corner);
        Ok(!bad)
    }

    /// An `f` line; returns whether it is valid.
    fn face(&mut self, bytes: &mut Unstructured<'_>) -> Result<bool> {
        let mut good = true;
        let mut face = Vec::new();
        self.text.push('f');
        for _ in 0..bytes.int_in_range(0..=6u8)? {
            let count = self.corners.len();
            let number = bytes.int_in_range(0..=count + 1)?;
            // 0 is not a valid number. A number one above the last vertex is valid if another vertex follows.
            let index = if number > 0 && number <= count && bytes.arbitrary()? {
                number as i64 - count as i64 - 1
            } else {
                number as i64
            };
            good &= number > 0;
            let _ = write!(self.text, " {index}");
            self.text.push_str(bytes.choose(&["", "/", "//7", "/1/2", "/-1", " \\\n"])?);
            if self.text.ends_with('\n') {
                self.lines += 1;
            }
            face.push(number.wrapping_sub(1));
        }
        self.faces.push(face);
        Ok(good)
    }

    /// A line that is not a polygon.
    fn aside(&mut self, bytes: &mut Unstructured<'_>) -> Result<bool> {
        // No line is empty, because an LF after a lone CR would be half of a line end.
        let asides =
            [" ", "# f 1 2 3", "l 1 2 3", "p 1", "g f 1", "o v", "s 1", "vn 0 0 1", "usemtl x"];
        self.text.push_str(bytes.choose(&asides)?);
        Ok(true)
    }

    fn end_line(&mut self, bytes: &mut Unstructured<'_>) -> Result<()> {
        self.text.push_str(bytes.choose(&["\n", "\n", "\r\n", " \n", "\r"])?);
        Ok(())
    }

    fn check(&self) {
        let ahead = self.faces.iter().flatten().any(|&k| k >= self.corners.len());
        match Scene::from_obj("known", self.text.as_bytes(), |_| None) {
            Ok((scene, _)) => {
                let good = self.refused.is_none() && !ahead && !self.faces.is_empty();
                assert!(good, "read, though it is bad: {:?}", self.text);
                let corner = |&k: &usize| self.corners[k];
                let faces = self.faces.iter().map(|f| f.iter().map(corner).collect::<Vec<_>>());
                assert!(
                    scene.polygons().map(|polygon| polygon.points().to_vec()).eq(faces),
                    "{:?}",
                    self.text
                );
            }
            Err(error) => {
                let bad = self.refused.is_some() || ahead || self.faces.is_empty();
                assert!(bad, "{error}: {:?}", self.text);
                if self.refused.is_some() {
                    assert_eq!(error.line_of_file(), self.refused, "{error}: {:?}", self.text);
                }
            }
        }
    }
}
