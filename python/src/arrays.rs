//! Lists of the library as numpy arrays, without copies.

use numpy::{Element, IntoPyArray, PyArray1, PyArray2, PyArray3, PyArrayMethods};
use pyo3::prelude::*;

pub(crate) type Array1<T> = Py<PyArray1<T>>;
pub(crate) type Array2<T> = Py<PyArray2<T>>;
pub(crate) type Array3<T> = Py<PyArray3<T>>;

/// An array of the list's numbers.
pub(crate) fn array1<T: Element>(py: Python<'_>, list: Vec<T>) -> Array1<T> {
    list.into_pyarray(py).unbind()
}

/// An array with a row for each of the list's items.
pub(crate) fn array2<T: Element, const N: usize>(
    py: Python<'_>,
    list: Vec<[T; N]>,
) -> PyResult<Array2<T>> {
    let shape = [list.len(), N];
    Ok(list.into_flattened().into_pyarray(py).reshape(shape)?.unbind())
}

/// An array with a matrix for each of the list's items.
pub(crate) fn array3<T: Element, const M: usize, const N: usize>(
    py: Python<'_>,
    list: Vec<[[T; N]; M]>,
) -> PyResult<Array3<T>> {
    let shape = [list.len(), M, N];
    let flat = list.into_flattened().into_flattened();
    Ok(flat.into_pyarray(py).reshape(shape)?.unbind())
}
