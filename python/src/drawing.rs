//! Cameras, visible polygons, and vector pictures.

use std::ops::ControlFlow;
use std::sync::Arc;

use binspace::drawing::{
    self, DisplayItem, EdgeKind, EdgeRun, Hidden, Paint, Stroke, VectorPicture, ViewOptions,
    VisibilityMap, polylines,
};
use binspace::glam::{DMat4, DVec3};
use binspace::{BspTree, Error, Progress, Viewpoint, view};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyBytes;
use self_cell::self_cell;

use crate::arrays::{Array1, Array2, Array3, array1, array2, array3};
use crate::input::Points;
use crate::overlay::{LineRuns, Markers, Overlay};
use crate::task::{Turns, Watch, exception, run};
use crate::tree::Tree;

/// A camera, made from a matrix that maps the world to clip coordinates.
#[pyclass(frozen, subclass, module = "binspace._binspace")]
pub(crate) struct Camera {
    camera: view::Camera,
}

#[pymethods]
impl Camera {
    #[new]
    fn new(matrix: [[f64; 4]; 4], size: [u32; 2]) -> PyResult<Self> {
        let matrix = DMat4::from_cols_array_2d(&matrix).transpose();
        let camera = view::Camera::from_matrix(matrix, size).map_err(exception)?;
        Ok(Self { camera })
    }

    /// The width and the height of the picture in pixels.
    #[getter]
    fn size(&self) -> [u32; 2] {
        self.camera.size()
    }

    /// The eye; None for a parallel projection.
    #[getter]
    fn eye(&self) -> Option<[f64; 3]> {
        self.camera.eye().map(|eye| eye.to_array())
    }

    /// The direction in which a parallel projection looks; None for a perspective projection.
    #[getter]
    fn direction(&self) -> Option<[f64; 3]> {
        match self.camera.viewpoint() {
            Viewpoint::Direction(direction) => Some(direction.to_array()),
            Viewpoint::Eye(_) => None,
        }
    }

    fn _project(&self, py: Python<'_>, points: Points<'_>) -> PyResult<Array2<f64>> {
        let points = points.view()?;
        let project = |i: usize| self.camera.project(DVec3::from_array(points.get(i)));
        let places = (0..points.len()).map(|i| project(i).unwrap_or([f64::NAN; 2]));
        array2(py, places.collect())
    }
}

/// The owners of a map's references: the tree, and the callback for progress.
struct Owner {
    tree: Arc<BspTree>,
    report: Box<dyn Fn(Progress) -> ControlFlow<()> + Send + Sync>,
}

self_cell!(
    struct OwnedMap {
        owner: Owner,
        #[not_covariant]
        dependent: VisibilityMap,
    }
);

/// The visible parts of a tree for a camera.
#[pyclass(frozen, module = "binspace._binspace")]
pub(crate) struct Visibility {
    map: OwnedMap,
    opacity: Vec<f64>,
    turns: Arc<Turns>,
}

impl Visibility {
    fn run<T: Send>(
        &self,
        py: Python<'_>,
        progress: Option<Py<PyAny>>,
        work: impl FnOnce(&VisibilityMap<'_>) -> Result<T, Error> + Send,
    ) -> PyResult<T> {
        let work = || self.map.with_dependent(|_, map| work(map));
        run(py, progress, &Arc::default(), Some(&self.turns), work)
    }
}

fn options<'a>(front_faces_only: bool, opacity: &[f64], least_area: f64) -> ViewOptions<'a> {
    let options = ViewOptions::DEFAULT.with_opacities(opacity.to_vec()).with_least_area(least_area);
    if front_faces_only { options.with_front_faces_only() } else { options }
}

fn hidden(name: &str) -> PyResult<Hidden> {
    match name {
        "skip" => Ok(Hidden::Skip),
        "keep" => Ok(Hidden::Keep),
        "count" => Ok(Hidden::Count),
        _ => Err(PyValueError::new_err(format!(
            "hidden is {name:?}, but must be \"skip\", \"keep\" or \"count\""
        ))),
    }
}

#[pymethods]
impl Visibility {
    #[new]
    fn new(
        py: Python<'_>,
        tree: &Tree,
        camera: &Camera,
        front_faces_only: bool,
        least_area: f64,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<Self> {
        let turns = Arc::new(Turns::default());
        let of_map = turns.clone();
        let report = Box::new(move |progress: Progress| of_map.report(progress));
        let owner = Owner { tree: tree.tree.clone(), report };
        let opacity = &tree.opacity;
        let map = run(py, progress, &Arc::default(), Some(&turns), || {
            OwnedMap::try_new(owner, |Owner { tree, report }| {
                let options = options(front_faces_only, opacity, least_area);
                tree.visibility(&camera.camera, &options.with_progress(&**report))
            })
        })?;
        Ok(Self { map, opacity: tree.opacity.clone(), turns })
    }

    #[getter]
    fn size(&self) -> [u32; 2] {
        self.map.with_dependent(|_, map| map.size())
    }

    fn polygons(&self, py: Python<'_>) -> PyResult<VisiblePolygons> {
        let found: Vec<_> =
            py.detach(|| self.map.with_dependent(|_, map| map.polygons().collect()));
        Ok(VisiblePolygons {
            polygon: array1(py, found.iter().map(|visible| visible.polygon as u32).collect()),
            area: array1(py, found.iter().map(|visible| visible.area).collect()),
            point: array2(py, found.iter().map(|visible| visible.point).collect())?,
        })
    }

    #[pyo3(signature = (*, progress=None))]
    fn drawing(&self, py: Python<'_>, progress: Option<Py<PyAny>>) -> PyResult<Drawing> {
        let drawing = self.run(py, progress, |map| map.drawing())?;
        Ok(Drawing { drawing, overlay: None })
    }

    #[pyo3(signature = (hidden="skip", *, progress=None))]
    fn edges(
        &self,
        py: Python<'_>,
        hidden: &str,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<EdgeRuns> {
        let hidden = self::hidden(hidden)?;
        EdgeRuns::new(py, &self.run(py, progress, |map| map.edges(hidden))?)
    }

    #[pyo3(signature = (hidden="skip", *, progress=None))]
    fn crossings(
        &self,
        py: Python<'_>,
        hidden: &str,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<EdgeRuns> {
        let hidden = self::hidden(hidden)?;
        EdgeRuns::new(py, &self.run(py, progress, |map| map.crossings(hidden))?)
    }

    #[pyo3(signature = (overlay, hidden="skip", *, progress=None))]
    fn lines(
        &self,
        py: Python<'_>,
        overlay: &Overlay,
        hidden: &str,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<LineRuns> {
        let hidden = self::hidden(hidden)?;
        let runs = self.run(py, progress, |map| map.lines(&overlay.overlay, hidden))?;
        overlay.line_runs(py, &runs)
    }

    #[pyo3(signature = (overlay, *, progress=None))]
    fn markers(
        &self,
        py: Python<'_>,
        overlay: &Overlay,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<Markers> {
        let views = self.run(py, progress, |map| map.markers(&overlay.overlay))?;
        overlay.markers(py, &views)
    }

    /// Returns the view as an SVG or a PDF file. `colors` has a row for each polygon, or one row for all
    /// polygons. A stroke is a width and a colour.
    #[expect(clippy::too_many_arguments, reason = "keywords in Python")]
    fn _picture<'py>(
        &self,
        py: Python<'py>,
        format: &str,
        colors: Vec<[u8; 3]>,
        outlines: Option<(f64, [u8; 3])>,
        edges: Option<(f64, [u8; 3])>,
        lines: Option<Py<Overlay>>,
        line: (f64, [u8; 3]),
        background: Option<[u8; 3]>,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<Bound<'py, PyBytes>> {
        let stroke = |(width, colour): (f64, [u8; 3])| Stroke::new(width, colour);
        let write = match format {
            "svg" => |picture: &VectorPicture| picture.to_svg().into_bytes(),
            "pdf" => |picture: &VectorPicture| picture.to_pdf(),
            _ => return Err(PyValueError::new_err("the format must be \"svg\" or \"pdf\"")),
        };
        let polygons = self.map.borrow_owner().tree.preparation().polygons;
        if colors.len() != 1 && colors.len() != polygons {
            let given = colors.len();
            return Err(PyValueError::new_err(format!(
                "{given} colours are given for {polygons} polygons"
            )));
        }
        let file = self.run(py, progress, |map| {
            let mut picture = VectorPicture::new(map.size());
            if let Some(colour) = background {
                picture = picture.with_background(colour);
            }
            picture.add_drawing(&map.drawing()?, |polygon| {
                let colour = colors.get(polygon).or(colors.first()).copied().unwrap_or_default();
                let opacity = self.opacity.get(polygon).copied().unwrap_or(1.0);
                let paint = Paint::from(colour).with_opacity(opacity);
                outlines.map_or(paint, |outline| paint.with_stroke(stroke(outline)))
            });
            if let Some(edge) = edges {
                let runs = map.edges(Hidden::Skip)?;
                let crossings = map.crossings(Hidden::Skip)?;
                let ends = runs.iter().chain(&crossings).map(|run| run.ends);
                picture.add_lines(polylines(ends)?, stroke(edge));
            }
            if let Some(overlay) = &lines {
                let runs = map.lines(&overlay.get().overlay, Hidden::Skip)?;
                picture.add_lines(polylines(runs.iter().map(|run| run.ends))?, stroke(line));
            }
            Ok(write(&picture))
        })?;
        Ok(PyBytes::new(py, &file))
    }
}

/// A drawing: filled paths in painting order, with lines and points between the paths. `Visibility.drawing`
/// and `Tree.translucent` return a drawing.
///
/// Path `i` shows the polygon with the number `polygon[i]`, or only a part of this polygon if `is_clipped[i]`
/// is true. The path consists of the outlines from `path_offsets[i]` to `path_offsets[i + 1]`. These outlines
/// are filled together by the nonzero rule. The corners of outline `o` are the rows of `corners` from
/// `outline_offsets[o]` to `outline_offsets[o + 1]`, in pixels from the top left corner of the picture.
///
/// `edges[c]` belongs to the side that leads from corner `c` to the next corner of its outline. `edges[c]` is
/// the number of the polygon's edge that contains this side, or -1 if no edge contains it. A polygon's edge
/// `k` begins at its corner `k`.
///
/// `items` lists all paths, lines and points in painting order, in the shape (n, 2). The first number of a
/// row is the kind of the item, and the second number is the item's index:
///
/// - 0: a path;
/// - 1: a part of a line, by its index in the arrays of `lines`;
/// - 2: a point, by its index in the arrays of `markers`.
///
/// Without an overlay, `lines` and `markers` are None. `size` is the width and the height of the picture in
/// pixels.
#[pyclass(frozen, module = "binspace._binspace")]
pub(crate) struct Drawing {
    drawing: drawing::Drawing,
    /// The overlay of the lines and points.
    overlay: Option<Py<Overlay>>,
}

const PATH: u32 = 0;
const LINE: u32 = 1;
const MARKER: u32 = 2;

#[pymethods]
impl Drawing {
    /// Makes paths of all polygons of a tree, with no hidden parts removed.
    #[new]
    fn new(
        py: Python<'_>,
        tree: &Tree,
        camera: &Camera,
        overlay: Option<Py<Overlay>>,
        front_faces_only: bool,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<Self> {
        let watch = Arc::new(Watch::default());
        let drawing = run(py, progress, &watch, None, || {
            let report = |progress: Progress| watch.report(progress);
            let options = options(front_faces_only, &tree.opacity, 0.0).with_progress(&report);
            let overlay = overlay.as_ref().map(|overlay| &overlay.get().overlay);
            drawing::Drawing::translucent(&tree.tree, &camera.camera, &options, overlay)
        })?;
        Ok(Self { drawing, overlay })
    }

    #[getter]
    fn size(&self) -> [u32; 2] {
        self.drawing.size()
    }

    fn __len__(&self) -> usize {
        self.drawing.paths().len()
    }

    /// Returns this drawing with the outlines of opaque polygons extended under later opaque neighbours.
    fn _trapped(&self, py: Python<'_>, is_opaque: Vec<bool>) -> Self {
        let is_opaque = |polygon: usize| is_opaque.get(polygon).copied().unwrap_or(true);
        let drawing = py.detach(|| self.drawing.trapped(is_opaque));
        Self { drawing, overlay: self.overlay.as_ref().map(|overlay| overlay.clone_ref(py)) }
    }

    #[getter]
    fn polygon(&self, py: Python<'_>) -> Array1<u32> {
        array1(py, self.drawing.paths().map(|path| path.polygon() as u32).collect())
    }

    #[getter]
    fn is_clipped(&self, py: Python<'_>) -> Array1<bool> {
        array1(py, self.drawing.paths().map(|path| path.is_clipped()).collect())
    }

    #[getter]
    fn path_offsets(&self, py: Python<'_>) -> Array1<u32> {
        let counts = self.drawing.paths().map(|path| path.outlines().count());
        array1(py, offsets(counts))
    }

    #[getter]
    fn outline_offsets(&self, py: Python<'_>) -> Array1<u32> {
        let outlines = self.drawing.paths().flat_map(|path| path.outlines());
        array1(py, offsets(outlines.map(<[_]>::len)))
    }

    #[getter]
    fn corners(&self, py: Python<'_>) -> PyResult<Array2<f64>> {
        let outlines = self.drawing.paths().flat_map(|path| path.outlines());
        array2(py, outlines.flatten().copied().collect())
    }

    #[getter]
    fn edges(&self, py: Python<'_>) -> Array1<i32> {
        let edges = self.drawing.paths().flat_map(|path| path.edges()).flatten();
        array1(py, edges.map(|edge| edge.map_or(-1, |edge| edge as i32)).collect())
    }

    #[getter]
    fn items(&self, py: Python<'_>) -> PyResult<Array2<u32>> {
        let mut next = [0; 3];
        let items = self.drawing.display_list().filter_map(|item| {
            let kind = match item {
                DisplayItem::Path(_) => PATH,
                DisplayItem::Line(_) => LINE,
                DisplayItem::Marker(_) => MARKER,
                _ => return None,
            };
            next[kind as usize] += 1;
            Some([kind, next[kind as usize] - 1])
        });
        array2(py, items.collect())
    }

    #[getter]
    fn lines(&self, py: Python<'_>) -> PyResult<Option<LineRuns>> {
        let runs: Vec<_> = self
            .drawing
            .display_list()
            .filter_map(|item| match item {
                DisplayItem::Line(run) => Some(run),
                _ => None,
            })
            .collect();
        self.overlay.as_ref().map(|overlay| overlay.get().line_runs(py, &runs)).transpose()
    }

    #[getter]
    fn markers(&self, py: Python<'_>) -> PyResult<Option<Markers>> {
        let views: Vec<_> = self
            .drawing
            .display_list()
            .filter_map(|item| match item {
                DisplayItem::Marker(view) => Some(view),
                _ => None,
            })
            .collect();
        self.overlay.as_ref().map(|overlay| overlay.get().markers(py, &views)).transpose()
    }
}

/// The start of each list, and the end of the last list, if lists of these lengths are stored one after the
/// other.
fn offsets(counts: impl Iterator<Item = usize>) -> Vec<u32> {
    let ends = counts.scan(0, |end, count| {
        *end += count as u32;
        Some(*end)
    });
    std::iter::once(0).chain(ends).collect()
}

/// The visible polygons, as returned by `Visibility.polygons`.
///
/// Each array has an entry for each visible polygon. `polygon` is the polygon's number. `area` is its visible
/// area in square pixels. `point` is a point in the picture where the polygon is visible, in pixels from the
/// top left corner, in the shape (n, 2).
#[pyclass(frozen, get_all, module = "binspace._binspace")]
pub(crate) struct VisiblePolygons {
    polygon: Array1<u32>,
    area: Array1<f64>,
    point: Array2<f64>,
}

/// Parts of edges, as returned by `Visibility.edges`, or of lines where polygons cross each other, as
/// returned by `Visibility.crossings`.
///
/// Each array has an entry for each part:
///
/// - `polygon`: the number of a polygon.
/// - `edge`: the number of the polygon's edge that contains the part, or -1 if no edge contains it. Edge `k`
///   begins at corner `k`.
/// - `kind`: 0 for a border (an edge that exactly one polygon has, or more than two polygons have), 1 for a
///   silhouette, 2 for a crease, 3 for a crossing.
/// - `angle`: the angle of a crease in radians; NaN for other kinds.
/// - `other`: the number of the second polygon of a crossing; -1 for other kinds.
/// - `ends`: the two ends of the part in pixels from the top left corner of the picture. The shape is
///   (n, 2, 2).
/// - `is_visible`: false if the part is hidden.
/// - `layers`: the number of polygons in front of the part, or -1 if these polygons were not counted.
#[pyclass(frozen, get_all, module = "binspace._binspace")]
pub(crate) struct EdgeRuns {
    polygon: Array1<u32>,
    edge: Array1<i32>,
    kind: Array1<u8>,
    angle: Array1<f64>,
    other: Array1<i64>,
    ends: Array3<f64>,
    is_visible: Array1<bool>,
    layers: Array1<i64>,
}

impl EdgeRuns {
    fn new(py: Python<'_>, runs: &[EdgeRun]) -> PyResult<Self> {
        let kind = |run: &EdgeRun| match run.kind {
            EdgeKind::Border => 0,
            EdgeKind::Silhouette => 1,
            EdgeKind::Crease(_) => 2,
            EdgeKind::Crossing(_) => 3,
            _ => u8::MAX,
        };
        let angle = |run: &EdgeRun| match run.kind {
            EdgeKind::Crease(angle) => angle,
            _ => f64::NAN,
        };
        let other = |run: &EdgeRun| match run.kind {
            EdgeKind::Crossing(other) => other as i64,
            _ => -1,
        };
        let edge = |run: &EdgeRun| run.edge.map_or(-1, |edge| edge as i32);
        Ok(Self {
            polygon: array1(py, runs.iter().map(|run| run.polygon as u32).collect()),
            edge: array1(py, runs.iter().map(edge).collect()),
            kind: array1(py, runs.iter().map(kind).collect()),
            angle: array1(py, runs.iter().map(angle).collect()),
            other: array1(py, runs.iter().map(other).collect()),
            ends: array3(py, runs.iter().map(|run| run.ends).collect())?,
            is_visible: array1(py, runs.iter().map(|run| run.is_visible).collect()),
            layers: array1(py, runs.iter().map(|run| run.layers.map_or(-1, i64::from)).collect()),
        })
    }
}
