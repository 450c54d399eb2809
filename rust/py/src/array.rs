//! `NumPy` arrays, made in ways that can fail: those of the `numpy` crate take it that there is memory.

use std::any::Any;
use std::ffi::c_int;
use std::ptr;

use ndarray::{Array, Dimension};
use numpy::npyffi::{self, NpyTypes, PY_ARRAY_API, npy_intp};
use numpy::{Element, PyArray, PyArrayDescrMethods, PyArrayMethods};
use pyo3::prelude::*;

/// Most dimensions of an array of `NumPy` 1.
const MOST_DIMENSIONS: usize = 32;

/// What an array's numbers belong to.
#[pyclass(frozen, module = "crankpin._core")]
struct Owner {
    _values: Box<dyn Any + Send + Sync>,
}

/// An array that owns the values and cannot be written to.
pub fn frozen<T: Element + 'static, D: Dimension + 'static>(
    py: Python<'_>,
    values: Array<T, D>,
) -> PyResult<Bound<'_, PyArray<T, D>>> {
    owning(py, values, 0)
}

/// An array that owns the values.
pub fn writeable<T: Element + 'static, D: Dimension + 'static>(
    py: Python<'_>,
    values: Array<T, D>,
) -> PyResult<Bound<'_, PyArray<T, D>>> {
    owning(py, values, npyffi::NPY_ARRAY_WRITEABLE)
}

fn owning<T: Element + 'static, D: Dimension + 'static>(
    py: Python<'_>,
    mut values: Array<T, D>,
    flags: c_int,
) -> PyResult<Bound<'_, PyArray<T, D>>> {
    let (mut lengths, mut strides) = ([0; MOST_DIMENSIONS], [0; MOST_DIMENSIONS]);
    for (axis, (&length, &stride)) in values.shape().iter().zip(values.strides()).enumerate() {
        lengths[axis] = length as npy_intp;
        strides[axis] = stride as npy_intp * size_of::<T>() as npy_intp;
    }
    let (dimensions, data) = (values.ndim() as c_int, values.as_mut_ptr());
    let owner = Bound::new(py, Owner { _values: Box::new(values) })?;
    // SAFETY: the data are those of `values`, of these lengths and strides, and stay in place until the
    // owner, which becomes the array's base, is dropped. An array that is null is an error.
    let array = unsafe {
        let array = PY_ARRAY_API.PyArray_NewFromDescr(
            py,
            npyffi::get_type_object(py, NpyTypes::PyArray_Type),
            T::get_dtype(py).into_dtype_ptr(),
            dimensions,
            lengths.as_mut_ptr(),
            strides.as_mut_ptr(),
            data.cast(),
            flags,
            ptr::null_mut(),
        );
        let array = Bound::from_owned_ptr_or_err(py, array)?;
        if PY_ARRAY_API.PyArray_SetBaseObject(py, array.as_ptr().cast(), owner.into_ptr()) != 0 {
            return Err(PyErr::fetch(py));
        }
        array
    };
    Ok(array.cast_into::<PyArray<T, D>>()?)
}

/// An array of numbers that are still to be written, in `NumPy`'s own memory: it asks for large pages,
/// which are several times faster to allocate and to free.
pub fn empty<'py, T: Element, D: Dimension>(
    py: Python<'py>,
    shape: impl IntoPyObject<'py>,
) -> PyResult<Bound<'py, PyArray<T, D>>> {
    // Not zeros, which would write the small ones twice.
    let array = py.import("numpy")?.call_method1("empty", (shape, numpy::dtype::<T>(py)))?;
    Ok(array.cast_into::<PyArray<T, D>>()?)
}

/// Load what the first array would load.
pub fn load(py: Python<'_>) -> PyResult<()> {
    let array = writeable(py, Array::from(vec![0.0]))?;
    array.try_readwrite()?.make_nonwriteable();
    Ok(())
}
