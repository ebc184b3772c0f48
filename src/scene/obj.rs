//! Wavefront OBJ files as scenes.

mod decimals;
mod material;
mod statements;

use std::fmt;
use std::fs::{self, File};
use std::io::{self, Read};
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};

use glam::{DVec2, DVec3};
use smallvec::SmallVec;

use super::{Attributes, Scene};
use crate::error::{Error, FileFault, Kind, Problem};
use crate::memory::{collect, push, reserve};
pub use decimals::Decimals;
use statements::{Statement, index, read};

impl Scene {
    /// Reads a Wavefront OBJ file and the material libraries that it names.
    ///
    /// Polygon `i` of the scene is the `i`-th `f` line of the file, counted from 0. Objects and groups do not
    /// matter. Every `f` line becomes a polygon with all its corners: also if it is degenerate, repeated, not
    /// convex or not planar. Corners keep their [texture coordinates](Self::uv), their
    /// [normals](Self::normal), and the [colours](Self::color) of their `v` lines. Points, lines, curves, and
    /// weights of `v` lines are left out. A line that ends in a backslash continues in the next line.
    ///
    /// Up is y, because OBJ files do not define an up direction. Coordinates are read as `f64`. The scene's
    /// [`precision`](Self::precision) is four units in the last decimal that the coordinates need:
    ///
    /// - In a file with a fixed number of decimals, the smallest decimal of any coordinate counts. In a file
    ///   with a fixed number of significant digits, the last decimal of the largest coordinates counts.
    /// - Zeros at the end of all coordinates do not count: `1.230000` and `4.500000` need two decimals.
    /// - A coordinate with more than 15 significant digits is first rounded to 15 digits:
    ///   `0.30000000000000004` needs one decimal.
    /// - A coordinate below about 10⁻¹¹ times the largest coordinate counts as 0.
    /// - Outliers are coordinates with nine or more significant digits *and* more decimals than all
    ///   coordinates with fewer digits. If at most 1 % of the coordinates are outliers, only the first three
    ///   digits of outliers count.
    /// - If 99 % of the coordinates with nine or more digits equal an `f32` after rounding to the written
    ///   digits, the file counts as written from `f32`. Then the unit is the distance from the largest
    ///   coordinate to the next larger `f32`.
    ///
    /// A face's colour is the `Kd` of its material, read as sRGB. The opacity is the material's `d` or `Tr`.
    /// A missing or unreadable library is not an error: the report lists the library, and its materials
    /// appear as [`Material::DEFAULT`](super::Material::DEFAULT).
    ///
    /// Libraries are read from the file's folder and its subfolders. A library name that is absolute or
    /// contains `..` is not followed, and the report lists the name. (Symbolic links are followed: the owner
    /// of the folder made them, not the author of the file.) Only regular files are read as libraries.
    ///
    /// The file itself may be a device, or an unnamed pipe such as `/dev/stdin`. A named pipe is an error:
    /// without a writer, reading the pipe would wait forever. A line that is not UTF-8 is read as Latin-1.
    ///
    /// # Errors
    ///
    /// If the file cannot be read or has no face; if its encoding is neither UTF-8 nor an 8-bit superset of
    /// ASCII; if a coordinate is malformed or not finite; or if a face names a missing corner or has more
    /// than 2²² corners. The error names the line and the face.
    pub fn read_obj(path: impl AsRef<Path>) -> Result<(Self, ObjReport), Error> {
        let path = path.as_ref();
        load(&path.display().to_string(), open(path), beside(path))
    }

    /// Reads the text of an OBJ file like [`read_obj`](Self::read_obj).
    ///
    /// `name` is the scene's name, which errors include. `library` is a function that returns the content of
    /// a material library, given the library's name in the text; `None` if there is no such library.
    /// `library` is never called with a name that is absolute or contains `..`.
    ///
    /// # Errors
    ///
    /// As for [`read_obj`](Self::read_obj), except errors of reading the file.
    pub fn from_obj(
        name: &str,
        bytes: &[u8],
        library: impl FnMut(&Path) -> Option<Vec<u8>>,
    ) -> Result<(Self, ObjReport), Error> {
        load(name, Ok(bytes), library)
    }
}

/// Reads a whole file.
fn load(
    name: &str,
    input: io::Result<impl Read>,
    library: impl FnMut(&Path) -> Option<Vec<u8>>,
) -> Result<(Scene, ObjReport), Error> {
    let mut parts = Parts::default();
    let (mut contents, flow) = read(name, input, |statement, words| {
        parts.add(&statement, words).map_or_else(ControlFlow::Break, ControlFlow::Continue)
    })?;
    if let ControlFlow::Break(error) = flow {
        return Err(error);
    }
    let mut scene = contents.scene(name, library);
    contents.report.skipped_attributes = parts.finish(&mut scene)?;
    let polygons = scene.polygons().filter(|polygon| is_degenerate(polygon.points()));
    contents.report.degenerate_faces = polygons.count();
    Ok((scene, contents.report))
}

/// Whether a polygon has fewer than three different corners.
fn is_degenerate(polygon: &[DVec3]) -> bool {
    let Some((first, rest)) = polygon.split_first() else { return true };
    let mut others = rest.iter().filter(|&corner| corner != first);
    others.next().is_none_or(|second| others.all(|corner| corner == second))
}

/// Stands for a missing `vt` or `vn` line in lists of their numbers.
const NONE: u32 = u32::MAX;

/// The vertices, faces and attributes of a file.
///
/// A corner can name lines that follow, so numbers of lines are stored. Positions and attributes of corners
/// need many times the memory of these numbers. They are allocated at the end, when their number is known.
#[derive(Default)]
struct Parts {
    vertices: Vec<DVec3>,
    /// The colours of the vertices up to the last vertex with a colour.
    colors: Vec<Option<[f32; 3]>>,
    /// The value of each `vt` line and each `vn` line; `None` if the line is malformed.
    uvs: Vec<Option<DVec2>>,
    normals: Vec<Option<DVec3>>,
    /// The vertex of each corner.
    corners: Vec<u32>,
    /// The `vt` lines and the `vn` lines of the corners, up to the last corner with such a line.
    uv_of: Vec<u32>,
    normal_of: Vec<u32>,
    /// Malformed references.
    faults: usize,
    /// For each face the end of its corners, its material and its line.
    ends: Vec<usize>,
    material_of: Vec<u32>,
    lines: Vec<usize>,
}

impl Parts {
    /// Adds a statement, given the words after its keyword.
    fn add(
        &mut self,
        statement: &Statement<'_>,
        words: &mut dyn Iterator<Item = &str>,
    ) -> Result<(), Error> {
        match *statement {
            Statement::Vertex(vertex) => {
                // One number after the coordinates is a weight.
                if let [Some(r), Some(g), Some(b)] = numbers(words.skip(3))[..] {
                    fill(&mut self.colors, self.vertices.len(), None)?;
                    push(&mut self.colors, Some([r, g, b].map(|c| c as f32)))?;
                }
                if self.vertices.len() == u32::MAX as usize {
                    return Err(Error::out_of_memory());
                }
                push(&mut self.vertices, vertex)
            }
            // The second coordinate may be missing, and a third coordinate is not used.
            Statement::TextureCoordinates => {
                let uv = match numbers(words)[..] {
                    [Some(u)] => Some(DVec2::new(u, 0.0)),
                    [Some(u), Some(v), ..] => Some(DVec2::new(u, v)),
                    _ => None,
                };
                push(&mut self.uvs, uv)
            }
            Statement::Normal => {
                let normal = match numbers(words)[..] {
                    [Some(x), Some(y), Some(z), ..] => Some(DVec3::new(x, y, z)),
                    _ => None,
                };
                push(&mut self.normals, normal)
            }
            Statement::Face { corners, material, line } => {
                for (&corner, word) in corners.iter().zip(words) {
                    if let Some((_, others)) = word.split_once('/') {
                        self.refer(others)?;
                    }
                    // A number that does not fit names no vertex, which is an error at the end.
                    push(&mut self.corners, u32::try_from(corner).unwrap_or(u32::MAX))?;
                }
                push(&mut self.ends, self.corners.len())?;
                push(&mut self.material_of, material)?;
                push(&mut self.lines, line)
            }
        }
    }

    /// Adds the numbers of the next corner's `vt` line and `vn` line, such as `7/8`.
    fn refer(&mut self, numbers: &str) -> Result<(), Error> {
        let counts = [self.uvs.len(), self.normals.len()];
        let lists = [&mut self.uv_of, &mut self.normal_of];
        for ((word, count), list) in numbers.split('/').zip(counts).zip(lists) {
            if word.is_empty() {
                continue;
            }
            match index(word, count).and_then(|index| u32::try_from(index).ok()) {
                None | Some(NONE) => self.faults += 1,
                Some(number) => {
                    fill(list, self.corners.len(), NONE)?;
                    push(list, number)?;
                }
            }
        }
        Ok(())
    }

    /// Adds all polygons and their attributes to a scene without polygons. Returns the number of lines and
    /// references that are malformed or name a missing line.
    fn finish(self, scene: &mut Scene) -> Result<usize, Error> {
        let mut faults = self.faults
            + self.uvs.iter().filter(|uv| uv.is_none()).count()
            + self.normals.iter().filter(|normal| normal.is_none()).count();
        let len = self.corners.len();
        scene.corners = collect(self.corners.iter().map(|&number| self.vertices[number as usize]))?;
        scene.attributes = Attributes {
            uvs: of_corners(self.uv_of, len, &self.uvs, &mut faults)?,
            normals: of_corners(self.normal_of, len, &self.normals, &mut faults)?,
            // Vertices behind the last colour are no faults.
            colors: of_corners(self.corners, len, &self.colors, &mut 0)?,
        };
        (scene.ends, scene.material_of, scene.lines) = (self.ends, self.material_of, self.lines);
        Ok(faults)
    }
}

/// The values of all `len` corners, given the corners' numbers of values; empty if no corner has a value.
/// Adds the count of numbers beyond the last value to `faults`.
fn of_corners<T: Copy>(
    mut numbers: Vec<u32>,
    len: usize,
    values: &[Option<T>],
    faults: &mut usize,
) -> Result<Vec<Option<T>>, Error> {
    let value = |&number: &u32| values.get(number as usize).copied().flatten();
    *faults += numbers.iter().filter(|&&n| n != NONE && n as usize >= values.len()).count();
    if numbers.iter().all(|number| value(number).is_none()) {
        return Ok(Vec::new());
    }
    fill(&mut numbers, len, NONE)?;
    collect(numbers.iter().map(value))
}

/// Lengthens a list to `len` items.
fn fill<T: Clone>(list: &mut Vec<T>, len: usize, item: T) -> Result<(), Error> {
    reserve(list, len.saturating_sub(list.len()))?;
    list.resize(len.max(list.len()), item);
    Ok(())
}

/// Up to four words as finite numbers.
fn numbers<'a>(words: impl Iterator<Item = &'a str>) -> SmallVec<[Option<f64>; 4]> {
    let number = |word: &str| word.parse().ok().filter(|number: &f64| number.is_finite());
    words.take(4).map(number).collect()
}

/// A Wavefront OBJ file that is read polygon by polygon, with only the vertices in memory. Use it for scenes
/// that are too large for one tree.
///
/// Polygons, materials, precision and errors are the same as for [`Scene::read_obj`]. Texture coordinates,
/// normals and colours of corners are ignored. The file is read twice, so it must be a regular file.
///
/// ```no_run
/// use std::ops::ControlFlow;
/// use binspace::scene::ObjStream;
///
/// let file = ObjStream::open("city.obj")?;
/// let (mut corners, mut number) = (0, 0);
/// let _ = file.read(|polygon, _material| {
///     corners += polygon.len();
///     number += 1;
///     ControlFlow::<()>::Continue(())
/// })?;
/// assert_eq!(number, file.polygons());
/// # Ok::<(), binspace::Error>(())
/// ```
#[derive(Debug)]
pub struct ObjStream {
    path: PathBuf,
    vertices: Vec<DVec3>,
    /// For each vertex, whether a polygon uses it.
    is_used: Vec<bool>,
    scene: Scene,
    report: ObjReport,
}

impl ObjStream {
    /// Opens a file and reads it once, to store its vertices, materials and precision, and to find errors.
    ///
    /// # Errors
    ///
    /// As for [`Scene::read_obj`].
    pub fn open(path: impl AsRef<Path>) -> Result<Self, Error> {
        let path = path.as_ref();
        let name = path.display().to_string();
        let (mut vertices, mut is_used) = (Vec::new(), Vec::new());
        // Vertices that faces name before the vertices are defined. Whether such vertices exist is known only
        // at the end.
        let mut ahead = Vec::new();
        let (mut contents, _) = read(&name, open_regular(path), |statement, _| {
            match statement {
                Statement::Vertex(vertex) => {
                    vertices.push(vertex);
                    is_used.push(false);
                }
                Statement::Face { corners, .. } => {
                    for &index in corners {
                        match is_used.get_mut(index) {
                            Some(is_used) => *is_used = true,
                            None => ahead.push(index),
                        }
                    }
                }
                _ => {}
            }
            ControlFlow::<()>::Continue(())
        })?;
        // All named vertices exist now.
        ahead.into_iter().for_each(|index| is_used[index] = true);
        vertices.shrink_to_fit();
        let scene = contents.scene(&name, beside(path));
        Ok(Self { path: path.to_owned(), vertices, is_used, scene, report: contents.report })
    }

    /// Returns the scene without its polygons: its name, materials and precision.
    pub fn scene(&self) -> &Scene {
        &self.scene
    }

    /// Returns the number of polygons.
    pub fn polygons(&self) -> usize {
        self.report.faces
    }

    /// Returns a report on the parts left out. Degenerate faces are not counted.
    pub fn report(&self) -> &ObjReport {
        &self.report
    }

    /// Returns the vertices that polygons use, each once.
    pub fn corners(&self) -> impl Iterator<Item = DVec3> + Clone {
        let used = self.vertices.iter().zip(&self.is_used).filter(|&(_, &is_used)| is_used);
        used.map(|(&vertex, _)| vertex)
    }

    /// Reads the file again. Calls `visit` for each polygon in order, with the polygon's corners and the
    /// number of its material, until `visit` returns [`ControlFlow::Break`](std::ops::ControlFlow::Break).
    ///
    /// # Errors
    ///
    /// If the file can no longer be read, or if its faces have changed.
    pub fn read<B>(
        &self,
        mut visit: impl FnMut(&[DVec3], u32) -> ControlFlow<B>,
    ) -> Result<ControlFlow<B>, Error> {
        let name = self.path.display().to_string();
        let mut polygon = Vec::new();
        let (contents, flow) = read(&name, open_regular(&self.path), |statement, _| {
            let Statement::Face { corners, material, .. } = statement else {
                return ControlFlow::Continue(());
            };
            polygon.clear();
            polygon.extend(corners.iter().filter_map(|&index| self.vertices.get(index)));
            if polygon.len() < corners.len() {
                return ControlFlow::Break(None);
            }
            visit(&polygon, material).map_break(Some)
        })?;
        match flow {
            ControlFlow::Break(Some(value)) => Ok(ControlFlow::Break(value)),
            ControlFlow::Continue(()) if contents.report.faces == self.polygons() => {
                Ok(ControlFlow::Continue(()))
            }
            _ => Err(of_file(&name, "it has changed since it was opened")),
        }
    }
}

/// Opens a file to read it completely.
fn open(path: &Path) -> io::Result<File> {
    // Unnamed pipes, such as `/dev/stdin`, have a writer. If `/dev/fd` contains links, links to such pipes
    // have no target. On other systems, `/dev/fd` contains files.
    #[cfg(unix)]
    if let Ok(target) = path.canonicalize()
        && !target.starts_with("/dev")
        && std::os::unix::fs::FileTypeExt::is_fifo(&target.metadata()?.file_type())
    {
        let problem = "it is a named pipe: redirect it to standard input";
        return Err(io::Error::new(io::ErrorKind::InvalidInput, problem));
    }
    File::open(path)
}

/// Opens a regular file; anything else is an error.
///
/// # Errors
///
/// If the file cannot be opened, or is not a regular file.
pub fn open_regular(path: &Path) -> io::Result<File> {
    // Checked before opening, because opening a pipe may wait for a writer.
    let found = fs::metadata(path)?;
    // Opening or reading a folder fails with an error that says so.
    if !found.is_file() && !found.is_dir() {
        return Err(io::Error::new(io::ErrorKind::InvalidInput, "it is not a regular file"));
    }
    File::open(path)
}

/// Reads material libraries from the folder of a file.
fn beside(path: &Path) -> impl FnMut(&Path) -> Option<Vec<u8>> {
    let folder = path.parent().unwrap_or(Path::new(""));
    move |library| {
        let library = folder.join(library);
        library.is_file().then(|| fs::read(library).ok())?
    }
}

/// The error of a whole file.
fn of_file(name: &str, problem: impl Into<Problem>) -> Error {
    Kind::File(FileFault { name: name.to_owned(), line: None, problem: problem.into() }).error()
}

/// A report on an OBJ file: the faces read, and the parts left out.
///
/// `Display` writes a short list of everything that was left out. If nothing was left out, `Display` writes
/// nothing.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct ObjReport {
    /// The number of `f` lines, including degenerate faces. This number equals the scene's number of
    /// polygons.
    pub faces: usize,
    /// The number of faces with fewer than three different corner positions. Such faces stay in the scene, so
    /// that polygons are numbered as in the file.
    pub degenerate_faces: usize,
    /// The number of `p` lines (points), which are left out.
    pub skipped_points: usize,
    /// The number of `l` lines (polylines), which are left out.
    pub skipped_lines: usize,
    /// The number of malformed `vt` and `vn` lines, plus the number of invalid references from corners to
    /// such lines. A corner with an invalid reference has no texture coordinates, or no normal.
    pub skipped_attributes: usize,
    /// The number of lines that begin with an unknown word, such as the statements for free-form curves and
    /// surfaces.
    pub skipped_statements: usize,
    /// Material libraries that could not be read, by the name in the file.
    pub missing_libraries: Vec<String>,
    /// Material libraries that were not read because they may be outside the file's folder: their names are
    /// absolute or contain `..`.
    pub outside_libraries: Vec<String>,
    /// Materials that are used but not defined.
    pub missing_materials: Vec<String>,
    /// The number of `newmtl`, `Kd`, `d` and `Tr` lines of material libraries that were skipped, because the
    /// line is malformed or of an unsupported kind, such as a spectral curve.
    pub skipped_material_lines: usize,
    /// The number of `map_Kd` and `map_d` lines in material libraries: textures, which are not read.
    pub skipped_textures: usize,
    /// `Kd`, `d` and `Tr` lines of material libraries whose numbers are outside the range from 0 to 1 and
    /// were clamped. Each line is given by its library and its number, as in `parts.mtl:7`.
    pub clamped_material_lines: Vec<String>,
}

impl ObjReport {
    /// Returns whether nothing was left out or changed.
    pub fn is_clean(&self) -> bool {
        *self == Self { faces: self.faces, ..Self::default() }
    }
}

impl fmt::Display for ObjReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let count = |count: usize| (count > 0).then(|| count.to_string());
        // The first three names, and the number of the others.
        let list = |names: &[String]| {
            let shown = names.iter().take(3).cloned().collect::<Vec<_>>().join(", ");
            match names.len() {
                0 => None,
                1..=3 => Some(shown),
                len => Some(format!("{shown} and {} more", len - 3)),
            }
        };
        let parts = [
            ("faces with fewer than three different corners", count(self.degenerate_faces)),
            ("`p` lines skipped", count(self.skipped_points)),
            ("`l` lines skipped", count(self.skipped_lines)),
            ("texture coordinates and normals skipped", count(self.skipped_attributes)),
            ("unknown statements skipped", count(self.skipped_statements)),
            ("material properties skipped", count(self.skipped_material_lines)),
            ("textures skipped", count(self.skipped_textures)),
            ("material libraries not found", list(&self.missing_libraries)),
            (
                "material libraries outside the file's folder, not read",
                list(&self.outside_libraries),
            ),
            ("materials not defined", list(&self.missing_materials)),
            ("colours and opacities clamped to 0 or 1", list(&self.clamped_material_lines)),
        ];
        let said = parts.into_iter().filter_map(|(what, said)| Some(format!("{what}: {}", said?)));
        f.write_str(&said.collect::<Vec<_>>().join("; "))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_parts_left_out_are_reported() {
        let mut report = ObjReport { faces: 7, ..ObjReport::default() };
        assert!(report.is_clean());
        assert_eq!(report.to_string(), "");
        report.skipped_points = 2;
        report.missing_materials = ["a", "b", "c", "d"].map(str::to_owned).to_vec();
        assert!(!report.is_clean());
        let expected = "`p` lines skipped: 2; materials not defined: a, b, c and 1 more";
        assert_eq!(report.to_string(), expected);
    }
}
