//! OBJ files read polygon by polygon.

use std::io::BufReader;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};

use glam::DVec3;

use super::error::{Kind, ObjError};
use super::file;
use super::lines::Scan;
use super::text::LinesOf;
use super::{ObjReport, add_materials, material};
use crate::scene::Scene;

/// How many bytes are read at once.
const CHUNK: usize = 1 << 18;

/// A Wavefront OBJ file that is read polygon by polygon, with nothing but its vertices in memory: for
/// scenes too large for one tree.
///
/// Polygons, materials, precision and errors are those of [`Scene::read_obj`]. Texture coordinates,
/// normals and colours of corners are passed over. (A line that is not UTF-8 is taken for Latin-1 by
/// itself; there, the whole file is.) As it is read twice, it must be a regular file.
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
/// # Ok::<(), binspace::scene::ObjError>(())
/// ```
#[derive(Debug)]
pub struct ObjStream {
    path: PathBuf,
    vertices: Vec<DVec3>,
    /// A bit for each vertex, set if a polygon has it.
    used: Vec<u64>,
    scene: Scene,
    polygons: usize,
    report: ObjReport,
}

impl ObjStream {
    /// Reads a file once, for its vertices, materials and precision, and to find what is wrong with it.
    ///
    /// # Errors
    ///
    /// As for [`Scene::read_obj`].
    pub fn open(path: impl AsRef<Path>) -> Result<Self, ObjError> {
        let path = path.as_ref();
        let name = path.display().to_string();
        let (mut vertices, mut used) = (Vec::new(), Vec::new());
        // Vertices that were named before they came: whether they come at all is known only at the end.
        let mut ahead = Vec::new();
        let scan = scan(path, |statement, _| {
            match statement {
                Statement::Vertex(vertex) => {
                    if vertices.len() % 64 == 0 {
                        used.push(0_u64);
                    }
                    vertices.push(vertex);
                }
                Statement::Face(indices) => indices.for_each(|index| {
                    if index < vertices.len() {
                        used[index / 64] |= 1 << (index % 64);
                    } else {
                        ahead.push(index);
                    }
                }),
            }
            ControlFlow::Continue(())
        });
        // All vertices that are named are there now.
        let mut scan = scan.and_then(Scan::finish).map_err(|error| error.in_file(&name))?;
        ahead.into_iter().for_each(|index| used[index / 64] |= 1 << (index % 64));
        vertices.shrink_to_fit();
        let folder = path.parent().unwrap_or(Path::new(""));
        let library = |library: &Path| {
            let library = folder.join(library);
            library.is_file().then(|| std::fs::read(library).ok())?
        };
        let looks = material::load(&scan.libraries, library, &mut scan.report);
        let mut scene = Scene::new(name, DVec3::Y);
        scene.precision = 4.0 * scan.decimals.unit();
        add_materials(&mut scene, &scan.materials, &looks, &mut scan.report);
        let (polygons, report) = (scan.report.faces, scan.report);
        Ok(Self { path: path.to_owned(), vertices, used, scene, polygons, report })
    }

    /// The scene without its polygons: its name, materials and precision.
    pub fn scene(&self) -> &Scene {
        &self.scene
    }

    /// How many polygons there are.
    pub fn polygons(&self) -> usize {
        self.polygons
    }

    /// What was left out. Degenerate faces are not counted.
    pub fn report(&self) -> &ObjReport {
        &self.report
    }

    /// The vertices that polygons have, each once.
    pub fn corners(&self) -> impl Iterator<Item = DVec3> + Clone {
        let is_used =
            |index: usize| self.used.get(index / 64).is_some_and(|w| w >> (index % 64) & 1 == 1);
        (0..self.vertices.len()).filter(move |&index| is_used(index)).map(|i| self.vertices[i])
    }

    /// Reads the file again, and calls `visit` with the corners and the number of the material of each
    /// polygon, in order, until that breaks.
    ///
    /// # Errors
    ///
    /// If the file cannot be read any more, or is another one by now.
    pub fn read<B>(
        &self,
        mut visit: impl FnMut(&[DVec3], u32) -> ControlFlow<B>,
    ) -> Result<ControlFlow<B>, ObjError> {
        let (mut corners, mut broken) = (Vec::new(), ControlFlow::Continue(()));
        let name = self.path.display().to_string();
        let mut missing = None;
        let scan = scan(&self.path, |statement, material| {
            let Statement::Face(indices) = statement else { return ControlFlow::Continue(()) };
            corners.clear();
            for index in indices {
                match self.vertices.get(index) {
                    Some(&vertex) => corners.push(vertex),
                    None => missing = Some(index + 1),
                }
            }
            if missing.is_some() {
                return ControlFlow::Break(());
            }
            broken = visit(&corners, material);
            if broken.is_break() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        });
        let scan = scan.map_err(|error| error.in_file(&name))?;
        if let Some(index) = missing {
            let vertices = self.vertices.len();
            let kind = Kind::OutOfRange { index: index.to_string(), vertices };
            return Err(kind.at(None, None).in_file(&name));
        }
        if broken.is_continue() && scan.report.faces != self.polygons {
            let problem = "it has changed while it was read".to_owned();
            return Err(Kind::Reader(problem).at(None, None).in_file(&name));
        }
        Ok(broken)
    }
}

/// What a line says that matters here.
enum Statement<I> {
    Vertex(DVec3),
    /// The numbers from 0 of its vertices.
    Face(I),
}

/// Reads all lines of a file, and calls `visit` with each vertex, and each face and its material.
fn scan(
    path: &Path,
    mut visit: impl FnMut(Statement<Indices<'_>>, u32) -> ControlFlow<()>,
) -> Result<Scan, ObjError> {
    let file = file::open_regular(path).map_err(|error| Kind::Read(error).at(None, None))?;
    let mut lines = LinesOf::new(BufReader::with_capacity(CHUNK, file));
    let mut scan = Scan::bare();
    while let Some((number, line)) = lines.next()? {
        scan.line(number, &line)?;
        if scan.cleaned.is_empty() {
            continue;
        }
        let mut words = scan.cleaned.split_ascii_whitespace();
        let flow = if words.next() == Some("v") {
            let mut next = || words.next().and_then(|word| word.parse().ok()).unwrap_or(0.0);
            visit(Statement::Vertex(DVec3::new(next(), next(), next())), 0)
        } else {
            let material = scan.material_of.last().copied().unwrap_or(0);
            visit(Statement::Face(Indices(words)), material)
        };
        scan.cleaned.clear();
        scan.material_of.clear();
        scan.face_lines.clear();
        if flow.is_break() {
            break;
        }
    }
    Ok(scan)
}

/// The numbers from 0 of a face's vertices, from a line that was checked.
struct Indices<'a>(std::str::SplitAsciiWhitespace<'a>);

impl Iterator for Indices<'_> {
    type Item = usize;

    fn next(&mut self) -> Option<usize> {
        Some(self.0.next()?.parse::<usize>().ok()?.saturating_sub(1))
    }
}
