//! Lines and points in one order with a tree.

use std::sync::Arc;

use binspace::drawing::{LineRun, MarkerView};
use binspace::overlay::{self, Shape, Shapes};
use binspace::{BspTree, Progress};
use numpy::PyReadonlyArray1;
use pyo3::prelude::*;

use crate::arrays::{Array1, Array2, Array3, array1, array2, array3};
use crate::input::{Lists, Points, viewpoint};
use crate::task::{Watch, exception, run};
use crate::tree::Tree;

/// An overlay of lines and points. `Tree.overlay` prepares its arguments.
#[pyclass(frozen, module = "binspace._binspace")]
pub(crate) struct Overlay {
    tree: Arc<BspTree>,
    pub(crate) overlay: overlay::Overlay,
    numbers: Numbers,
}

/// The caller's numbers of lines and points. The overlay numbers its lines differently, because a line with
/// NaN becomes several lines.
#[derive(Default)]
pub(crate) struct Numbers {
    /// For each line of the overlay: the caller's line number and the number of the first segment.
    lines: Vec<[u32; 2]>,
    points: Vec<u32>,
}

impl Numbers {
    /// The caller's numbers of a line and a segment.
    fn segment(&self, line: usize, segment: usize) -> [u32; 2] {
        let [given, first] = self.lines.get(line).copied().unwrap_or_default();
        [given, first + segment as u32]
    }

    fn point(&self, point: usize) -> u32 {
        self.points.get(point).copied().unwrap_or_default()
    }
}

#[pymethods]
impl Overlay {
    #[new]
    fn new(
        py: Python<'_>,
        tree: &Tree,
        corners: Points<'_>,
        offsets: PyReadonlyArray1<'_, i64>,
        points: Points<'_>,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<Self> {
        let lists = Lists::new(corners, None, offsets);
        let lists = lists.view()?;
        let points = points.view()?;
        let tree = tree.tree.clone();
        let watch = Arc::new(Watch::default());
        let work = || {
            let mut numbers = Numbers::default();
            let mut lines: Vec<Vec<[f64; 3]>> = vec![];
            for line in 0..lists.len() {
                let range = lists.range(line);
                let mut run = vec![];
                let mut end = |run: &mut Vec<[f64; 3]>, next: usize| {
                    if run.len() > 1 {
                        numbers.lines.push([line as u32, (next - run.len()) as u32]);
                        lines.push(std::mem::take(run));
                    }
                    run.clear();
                };
                for (i, at) in range.clone().enumerate() {
                    let corner = lists.point(at);
                    if corner.iter().any(|c| c.is_nan()) {
                        end(&mut run, i);
                    } else {
                        run.push(corner);
                    }
                }
                end(&mut run, range.len());
            }
            numbers
                .points
                .extend((0..points.len() as u32).filter(|&i| !points.has_nan(i as usize)));
            let markers = numbers.points.iter().map(|&i| points.get(i as usize));
            let shapes = Shapes::NONE.with_lines(&lines).with_points(markers);
            let mut overlay = overlay::Overlay::new(&tree);
            let report = |progress: Progress| watch.report(progress);
            overlay.replace_with_progress(&tree, shapes, report)?;
            Ok((overlay, numbers))
        };
        let (overlay, numbers) = run(py, progress, &watch, None, work)?;
        Ok(Self { tree, overlay, numbers })
    }

    fn __len__(&self) -> usize {
        self.overlay.len()
    }

    /// Returns the numbers of all fragments and pieces in back-to-front order, the painting order. Pieces are
    /// parts of lines, and points: see `pieces`. If the tree has n fragments, n + k is the number of piece k.
    ///
    /// Give either `eye` or `direction`, as three numbers. `eye` is the point from which the viewer looks.
    /// `direction` is the direction in which the viewer of a parallel projection looks.
    #[pyo3(signature = (*, eye=None, direction=None, front_to_back=false))]
    fn order(
        &self,
        py: Python<'_>,
        eye: Option<[f64; 3]>,
        direction: Option<[f64; 3]>,
        front_to_back: bool,
    ) -> PyResult<Array1<u32>> {
        let viewpoint = viewpoint(eye, direction)?;
        let numbers = py.detach(|| {
            let order = self.overlay.order(&self.tree, viewpoint)?;
            let order = if front_to_back { order.front_to_back() } else { order };
            let mut numbers = Vec::new();
            order.write_into(&mut numbers);
            Ok(numbers)
        });
        Ok(array1(py, numbers.map_err(exception)?))
    }

    /// The pieces of lines and the points, sorted by their numbers in `order`.
    #[getter]
    fn pieces(&self, py: Python<'_>) -> PyResult<Pieces> {
        let first = self.tree.len() as u32;
        let count = self.overlay.len();
        let (mut number, mut segment) = (Vec::with_capacity(count), Vec::with_capacity(count));
        let (mut ends, mut shares) = (Vec::with_capacity(count), Vec::with_capacity(count));
        for index in first..first + count as u32 {
            match self.overlay.shape(index) {
                Some(Shape::Segment(piece)) => {
                    let [line, own] = self.numbers.segment(piece.line(), piece.number());
                    number.push(line);
                    segment.push(i64::from(own));
                    ends.push(piece.ends().map(|end| end.to_array()));
                    shares.push(piece.shares());
                }
                Some(Shape::Marker(marker)) => {
                    number.push(self.numbers.point(marker.point()));
                    segment.push(-1);
                    ends.push([marker.position().to_array(); 2]);
                    shares.push([0.0; 2]);
                }
                // An overlay of this package has no polygons.
                _ => {}
            }
        }
        Ok(Pieces {
            number: array1(py, number),
            segment: array1(py, segment),
            ends: array3(py, ends)?,
            shares: array2(py, shares)?,
        })
    }
}

impl Overlay {
    pub(crate) fn line_runs(&self, py: Python<'_>, runs: &[LineRun]) -> PyResult<LineRuns> {
        let segments: Vec<_> =
            runs.iter().map(|run| self.numbers.segment(run.line, run.segment)).collect();
        let layers = runs.iter().map(|run| run.layers.map_or(-1, i64::from));
        Ok(LineRuns {
            line: array1(py, segments.iter().map(|[line, _]| *line).collect()),
            segment: array1(py, segments.iter().map(|[_, segment]| *segment).collect()),
            ends: array3(py, runs.iter().map(|run| run.ends).collect())?,
            is_visible: array1(py, runs.iter().map(|run| run.is_visible).collect()),
            layers: array1(py, layers.collect()),
        })
    }

    pub(crate) fn markers(&self, py: Python<'_>, views: &[MarkerView]) -> PyResult<Markers> {
        let points = views.iter().map(|view| self.numbers.point(view.point));
        Ok(Markers {
            point: array1(py, points.collect()),
            at: array2(py, views.iter().map(|view| view.position).collect())?,
            is_visible: array1(py, views.iter().map(|view| view.is_visible).collect()),
        })
    }
}

/// The pieces of an overlay, as returned by `Overlay.pieces`. A piece is a part of a line, or a point.
///
/// Each array has an entry for each piece. `number` is the number of a line or a point in the input.
/// `segment` is the number of the segment that contains the piece, counted within its line, or -1 for a
/// point. `ends` are the two ends of the piece in space, in the shape (n, 2, 3). `shares` are the places of
/// these ends on the segment: 0 at its start, 1 at its end.
#[pyclass(frozen, get_all, module = "binspace._binspace")]
pub(crate) struct Pieces {
    number: Array1<u32>,
    segment: Array1<i64>,
    ends: Array3<f64>,
    shares: Array2<f64>,
}

/// Parts of lines in a picture, as returned by `Visibility.lines` and `Drawing.lines`.
///
/// Each array has an entry for each part. A part is entirely visible or entirely hidden. `line` is the number
/// of the part's line, and `segment` is the number of the part's segment within this line. `ends` are the two
/// ends of the part in pixels from the top left corner of the picture, in the shape (n, 2, 2). `is_visible`
/// is false if the part is hidden. `layers` is the number of polygons in front of the part, or -1 if these
/// polygons were not counted.
#[pyclass(frozen, get_all, module = "binspace._binspace")]
pub(crate) struct LineRuns {
    line: Array1<u32>,
    segment: Array1<u32>,
    ends: Array3<f64>,
    is_visible: Array1<bool>,
    layers: Array1<i64>,
}

/// Points in a picture, as returned by `Visibility.markers` and `Drawing.markers`.
///
/// Each array has an entry for each point. `point` is the point's number in the input. `at` is the position
/// of the point in pixels from the top left corner of the picture, in the shape (n, 2). `is_visible` is false
/// if a polygon hides the point.
#[pyclass(frozen, get_all, module = "binspace._binspace")]
pub(crate) struct Markers {
    point: Array1<u32>,
    at: Array2<f64>,
    is_visible: Array1<bool>,
}
