//! Arrays as polygons, lines and viewpoints.

use binspace::glam::DVec3;
use binspace::{Point, Polygon, Viewpoint};
use numpy::ndarray::{ArrayView1, ArrayView2};
use numpy::{PyReadonlyArray1, PyReadonlyArray2};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

/// Points as rows of three numbers.
#[derive(FromPyObject)]
pub(crate) enum Points<'py> {
    Double(PyReadonlyArray2<'py, f64>),
    Single(PyReadonlyArray2<'py, f32>),
}

impl Points<'_> {
    pub(crate) fn view(&self) -> PyResult<PointsView<'_>> {
        let (view, columns) = match self {
            Self::Double(array) => {
                let array = array.as_array();
                (PointsView::Double(array), array.ncols())
            }
            Self::Single(array) => {
                let array = array.as_array();
                (PointsView::Single(array), array.ncols())
            }
        };
        match columns {
            3 => Ok(view),
            _ => Err(PyValueError::new_err(format!(
                "points have {columns} coordinates instead of 3"
            ))),
        }
    }
}

#[derive(Clone, Copy)]
pub(crate) enum PointsView<'a> {
    Double(ArrayView2<'a, f64>),
    Single(ArrayView2<'a, f32>),
}

impl PointsView<'_> {
    pub(crate) fn len(&self) -> usize {
        match self {
            Self::Double(array) => array.nrows(),
            Self::Single(array) => array.nrows(),
        }
    }

    pub(crate) fn get(&self, i: usize) -> [f64; 3] {
        match self {
            Self::Double(array) => row(array, i),
            Self::Single(array) => row(array, i).map(f64::from),
        }
    }

    pub(crate) fn has_nan(&self, i: usize) -> bool {
        self.get(i).iter().any(|c| c.is_nan())
    }
}

fn row<T: Copy>(array: &ArrayView2<'_, T>, i: usize) -> [T; 3] {
    [0, 1, 2].map(|axis| array[[i, axis]])
}

/// Lists of points. List `i` consists of the entries from `offsets[i]` to `offsets[i + 1]` of `indices`, or
/// of `points` if there are no indices.
pub(crate) struct Lists<'py> {
    points: Points<'py>,
    indices: Option<PyReadonlyArray1<'py, i64>>,
    offsets: PyReadonlyArray1<'py, i64>,
}

impl<'py> Lists<'py> {
    pub(crate) fn new(
        points: Points<'py>,
        indices: Option<PyReadonlyArray1<'py, i64>>,
        offsets: PyReadonlyArray1<'py, i64>,
    ) -> Self {
        Self { points, indices, offsets }
    }

    /// Checks that all offsets and indices are inside the arrays, and returns the lists.
    pub(crate) fn view(&self) -> PyResult<ListsView<'_>> {
        let points = self.points.view()?;
        let indices = self.indices.as_ref().map(|indices| indices.as_array());
        let offsets = self.offsets.as_array();
        let count = indices.map_or(points.len(), |indices| indices.len());
        let fault = |text: String| Err(PyValueError::new_err(text));
        if let Some(indices) = indices {
            let is_outside =
                |&index: &i64| usize::try_from(index).map_or(true, |i| i >= points.len());
            if let Some(at) = indices.iter().position(is_outside) {
                let (index, points) = (indices[at], points.len());
                return fault(format!(
                    "face index {index} (at {at}) is none of the {points} vertices"
                ));
            }
        }
        if offsets.first() != Some(&0) {
            return fault("offsets must begin with 0".into());
        }
        for (i, (&from, &to)) in offsets.iter().zip(offsets.iter().skip(1)).enumerate() {
            if to < from {
                return fault(format!("offsets decrease from {from} to {to} (at {i})"));
            }
        }
        match offsets.last() {
            Some(&last) if usize::try_from(last) == Ok(count) => {}
            last => {
                let last = last.copied().unwrap_or_default();
                return fault(format!("offsets end with {last} instead of {count}"));
            }
        }
        Ok(ListsView { points, indices, offsets })
    }
}

#[derive(Clone, Copy)]
pub(crate) struct ListsView<'a> {
    points: PointsView<'a>,
    indices: Option<ArrayView1<'a, i64>>,
    offsets: ArrayView1<'a, i64>,
}

impl<'a> ListsView<'a> {
    pub(crate) fn len(&self) -> usize {
        self.offsets.len() - 1
    }

    /// The range of a list's entries. The range is clamped, because another thread may have changed the
    /// arrays after the check.
    pub(crate) fn range(&self, list: usize) -> std::ops::Range<usize> {
        let at = |i: usize| usize::try_from(self.offsets[i]).unwrap_or(0).min(self.count());
        at(list)..at(list + 1)
    }

    fn count(&self) -> usize {
        self.indices.map_or(self.points.len(), |indices| indices.len())
    }

    pub(crate) fn point(&self, i: usize) -> [f64; 3] {
        let at = match self.indices {
            Some(indices) => usize::try_from(indices[i]).unwrap_or(0),
            None => i,
        };
        self.points.get(at.min(self.points.len() - 1))
    }

    /// Calls `build` with the lists as polygons. A list with a NaN becomes a polygon without corners.
    pub(crate) fn polygons<R>(&self, build: impl Build<R>) -> R {
        let lists = *self;
        match self.points {
            PointsView::Double(_) => {
                build.with((0..lists.len()).map(move |i| Rows { lists, i, point: |point| point }))
            }
            PointsView::Single(_) => build.with((0..lists.len()).map(move |i| Rows {
                lists,
                i,
                point: |point: [f64; 3]| point.map(|c| c as f32),
            })),
        }
    }
}

/// A function that accepts polygons of any type.
pub(crate) trait Build<R> {
    fn with<P: Polygon>(self, polygons: impl Iterator<Item = P>) -> R;
}

/// A list of points, in the precision of the array.
struct Rows<'a, P> {
    lists: ListsView<'a>,
    i: usize,
    point: fn([f64; 3]) -> P,
}

impl<P: Point> Polygon for Rows<'_, P> {
    type Point = P;

    fn corners(&self) -> impl Iterator<Item = P> {
        let Self { lists, i, point } = *self;
        let range = lists.range(i);
        let has_nan = range.clone().any(|at| lists.point(at).iter().any(|c| c.is_nan()));
        let range = if has_nan { 0..0 } else { range };
        range.map(move |at| point(lists.point(at)))
    }
}

/// Makes a viewpoint from an eye or a direction. Exactly one of the two must be given.
pub(crate) fn viewpoint(eye: Option<[f64; 3]>, direction: Option<[f64; 3]>) -> PyResult<Viewpoint> {
    let numbers = eye.iter().chain(&direction).flatten();
    if numbers.clone().any(|c| c.is_nan()) {
        return Err(PyValueError::new_err("the viewpoint has a coordinate that is NaN"));
    }
    match (eye, direction) {
        (Some(eye), None) => Ok(Viewpoint::Eye(DVec3::from_array(eye))),
        (None, Some([0.0, 0.0, 0.0])) => Err(PyValueError::new_err("the direction is zero")),
        (None, Some(direction)) => Ok(Viewpoint::Direction(DVec3::from_array(direction))),
        _ => Err(PyValueError::new_err("give either an eye or a direction")),
    }
}
