//! Trees, their orders and fragments, and rays.

use std::sync::Arc;

use binspace::glam::DVec3;
use binspace::{BspTree, BuildOptions, Error, Facing, Polygon, Progress, Ray};
use numpy::PyReadonlyArray1;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use crate::arrays::{Array1, Array2, array1, array2};
use crate::input::{Build, Lists, Points, PointsView, viewpoint};
use crate::task::{Watch, exception, for_each, run};

/// A tree of polygons. `binspace.Tree` prepares its arguments.
#[pyclass(frozen, subclass, module = "binspace._binspace")]
pub(crate) struct Tree {
    pub(crate) tree: Arc<BspTree>,
    /// The opacity of each polygon; empty if all polygons are opaque.
    pub(crate) opacity: Vec<f64>,
}

/// Builds a tree of polygons.
struct Builder<'w> {
    options: BuildOptions,
    watch: &'w Watch,
}

impl Build<Result<BspTree, Error>> for Builder<'_> {
    fn with<P: Polygon>(self, polygons: impl Iterator<Item = P>) -> Result<BspTree, Error> {
        let report = |progress: Progress| self.watch.report(progress);
        self.options.build_with_progress(polygons, report)
    }
}

#[pymethods]
impl Tree {
    #[new]
    #[pyo3(signature = (points, indices, offsets, opacity, tolerance, bounds, max_fragments, progress))]
    #[expect(clippy::too_many_arguments, reason = "the arguments of a constructor")]
    fn new(
        py: Python<'_>,
        points: Points<'_>,
        indices: Option<PyReadonlyArray1<'_, i64>>,
        offsets: PyReadonlyArray1<'_, i64>,
        opacity: Option<Vec<f64>>,
        tolerance: Option<f64>,
        bounds: Option<[[f64; 3]; 2]>,
        max_fragments: Option<usize>,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<Self> {
        let lists = Lists::new(points, indices, offsets);
        let lists = lists.view()?;
        let opacity = opacity.unwrap_or_default();
        if !opacity.is_empty() && opacity.len() != lists.len() {
            let (given, expected) = (opacity.len(), lists.len());
            return Err(PyValueError::new_err(format!(
                "{given} opacities are given for {expected} polygons"
            )));
        }
        if let Some(at) = opacity.iter().position(|opacity| !(0.0..=1.0).contains(opacity)) {
            let text = format!("polygon {at} has the opacity {}, not 0 to 1", opacity[at]);
            return Err(PyValueError::new_err(text));
        }
        let mut options = BuildOptions::DEFAULT;
        if let Some(length) = tolerance {
            options = options.with_tolerance(length);
        }
        if let Some(bounds) = bounds {
            let [low, high] = bounds.map(DVec3::from_array);
            options = options.with_bounds(low, high);
        }
        if let Some(most) = max_fragments {
            options = options.with_max_fragments(most);
        }
        let watch = Arc::new(Watch::default());
        let builder = Builder { options, watch: &watch };
        let tree = run(py, progress, &watch, None, move || lists.polygons(builder))?;
        Ok(Self { tree: Arc::new(tree), opacity })
    }

    fn __len__(&self) -> usize {
        self.tree.len()
    }

    fn __repr__(&self) -> String {
        let polygons = self.tree.preparation().polygons;
        format!("<binspace.Tree of {polygons} polygons in {} fragments>", self.tree.len())
    }

    /// The number of polygons that were given.
    #[getter]
    fn polygons(&self) -> usize {
        self.tree.preparation().polygons
    }

    /// The size of the tree in bytes.
    #[getter]
    fn memory_usage(&self) -> usize {
        self.tree.memory_usage()
    }

    /// The numbers of the polygons without area, in ascending order. These polygons have no fragments.
    #[getter]
    fn dropped(&self, py: Python<'_>) -> Array1<u32> {
        array1(py, self.tree.dropped().map(|polygon| polygon as u32).collect())
    }

    /// The least and the largest coordinates of all fragments, in the shape (2, 3). None for a tree
    /// without fragments.
    #[getter]
    fn bounds(&self, py: Python<'_>) -> PyResult<Option<Array2<f64>>> {
        let bounds = py.detach(|| self.tree.bounds());
        bounds.map(|ends| array2(py, ends.map(|end| end.to_array()).to_vec())).transpose()
    }

    /// Returns the numbers of all fragments in back-to-front order, the painting order. O(n).
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
            let mut numbers = Vec::new();
            let order = self.tree.order(viewpoint);
            let order = if front_to_back { order.front_to_back() } else { order };
            order.write_into(&mut numbers);
            numbers
        });
        Ok(array1(py, numbers))
    }

    fn _fragments(&self, py: Python<'_>) -> PyResult<Fragments> {
        let arrays = py.detach(|| self.tree.arrays()).map_err(exception)?;
        Ok(Fragments {
            points: array2(py, arrays.vertices)?,
            offsets: array1(py, arrays.offsets),
            polygon: array1(py, arrays.polygons),
            edges: array1(py, arrays.edges),
            weight_offsets: array1(py, arrays.weight_offsets),
            weight_corners: array1(py, arrays.weight_corners),
            weights: array1(py, arrays.weights),
        })
    }

    /// Returns the hits of rays that start at the points `from`. If `are_ends` is true, `others` are the ends
    /// of the rays; otherwise, `others` are the directions of the rays.
    fn _hits(
        &self,
        py: Python<'_>,
        from: Points<'_>,
        others: Points<'_>,
        are_ends: bool,
        limit: Option<usize>,
    ) -> PyResult<Hits> {
        let (from, others) = (from.view()?, others.view()?);
        let limit = limit.unwrap_or(usize::MAX);
        let mut found = FoundHits { offsets: vec![0], ..FoundHits::default() };
        for_each(py, rays(from, others, are_ends), |ray| {
            for hit in self.tree.hits(ray).take(limit) {
                found.polygon.push(hit.polygon() as u32);
                found.parameter.push(hit.parameter());
                found.points.push(hit.point().to_array());
                found.facing.push(match hit.facing() {
                    Facing::Front => 1,
                    Facing::Back => -1,
                    Facing::EdgeOn => 0,
                });
            }
            found.offsets.push(found.polygon.len() as u64);
        })?;
        Ok(Hits {
            offsets: array1(py, found.offsets),
            polygon: array1(py, found.polygon),
            parameter: array1(py, found.parameter),
            points: array2(py, found.points)?,
            facing: array1(py, found.facing),
        })
    }

    fn _is_occluded(
        &self,
        py: Python<'_>,
        from: Points<'_>,
        to: Points<'_>,
    ) -> PyResult<Array1<bool>> {
        let (from, to) = (from.view()?, to.view()?);
        let mut occluded = Vec::new();
        for_each(py, rays(from, to, true), |ray| occluded.push(self.tree.is_occluded(ray)))?;
        Ok(array1(py, occluded))
    }
}

fn rays<'a>(
    from: PointsView<'a>,
    others: PointsView<'a>,
    are_ends: bool,
) -> impl Iterator<Item = Ray> + 'a {
    (0..from.len().min(others.len())).map(move |i| match are_ends {
        true => Ray::between(from.get(i), others.get(i)),
        false => Ray::new(from.get(i), others.get(i)),
    })
}

#[derive(Default)]
struct FoundHits {
    offsets: Vec<u64>,
    polygon: Vec<u32>,
    parameter: Vec<f64>,
    points: Vec<[f64; 3]>,
    facing: Vec<i8>,
}

/// All fragments of a tree, as returned by `Tree.fragments`.
///
/// A fragment is a convex part of a polygon. Fragment `i` is a part of polygon number `polygon[i]`. The
/// vertices of fragment `i` are the rows of `points` from `offsets[i]` to `offsets[i + 1]`. `edges[v]`
/// belongs to the side that leads from vertex `v` to the next vertex of its fragment. `edges[v]` is the
/// number of the polygon's edge that contains this side, or -1 if the side is a cut. A polygon's edge `k`
/// begins at its corner `k`.
///
/// Vertex `v` is a weighted sum of corners of its polygon. The entries from `weight_offsets[v]` to
/// `weight_offsets[v + 1]` of `weight_corners` are the numbers of these corners, and the same entries of
/// `weights` are the weights of the corners.
#[pyclass(frozen, get_all, module = "binspace._binspace")]
pub(crate) struct Fragments {
    points: Array2<f64>,
    offsets: Array1<u32>,
    polygon: Array1<u32>,
    edges: Array1<i32>,
    weight_offsets: Array1<u32>,
    weight_corners: Array1<u32>,
    weights: Array1<f64>,
}

/// The hits of rays, as returned by `Tree.hits`.
///
/// The hits of ray `i` are the entries from `offsets[i]` to `offsets[i + 1]` of the other arrays, nearest
/// first. `polygon` is the number of the polygon that is hit. `parameter` is the place of the hit along the
/// ray: 0 at the start of the ray, and 1 at the end of a segment or at start + direction. `points` are the
/// hit points, in the shape (n, 3). `facing` is 1 if the ray hits the front, -1 if it hits the back, and 0 if
/// it lies in the polygon's plane.
#[pyclass(frozen, get_all, module = "binspace._binspace")]
pub(crate) struct Hits {
    offsets: Array1<u64>,
    polygon: Array1<u32>,
    parameter: Array1<f64>,
    points: Array2<f64>,
    facing: Array1<i8>,
}
