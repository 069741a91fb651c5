//! Images that are arrays.

use crate::errors::value_error;
use cloakroom::photograph::{ImageSource, LinearImage, Texels};
use ndarray::ArrayView3;
use numpy::{PyArray3, PyReadonlyArray3, PyUntypedArrayMethods};
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;

/// An image that is in memory: red, green and blue of shape (height, width, 3), `uint8` in sRGB or `float32` in
/// linear light.
#[pyclass(frozen, module = "cloakroom._cloakroom")]
#[derive(Debug)]
pub struct Image {
    pub source: ImageSource,
}

#[pymethods]
impl Image {
    #[new]
    fn new(array: &Bound<'_, PyAny>) -> PyResult<Self> {
        let (shape, texels) = if let Ok(codes) = array.extract::<PyReadonlyArray3<'_, u8>>() {
            (codes.shape().to_vec(), Texels::Srgb8(in_order(&codes.as_array())))
        } else if let Ok(light) = array.extract::<PyReadonlyArray3<'_, f32>>() {
            (light.shape().to_vec(), Texels::Linear(in_order(&light.as_array())))
        } else {
            return Err(PyTypeError::new_err(
                "an image must be of uint8 or float32, (height, width, 3)",
            ));
        };
        let [height, width, 3] = shape[..] else {
            return Err(value_error("an image must be of the shape (height, width, 3)"));
        };
        let image = LinearImage { width, height, texels };
        Ok(Self { source: ImageSource::memory(image).map_err(value_error)? })
    }

    /// The array, a copy.
    fn array<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let ImageSource::Memory(image) = &self.source else {
            return Err(value_error("the image is no array"));
        };
        let shape = (image.height, image.width, 3);
        Ok(match &image.texels {
            Texels::Srgb8(codes) => of_shape(py, shape, codes)?.into_any(),
            Texels::Linear(light) => of_shape(py, shape, light)?.into_any(),
        })
    }

    /// How scenes name it.
    #[getter]
    fn name(&self) -> String {
        self.source.to_string()
    }
}

fn of_shape<'py, T: numpy::Element + Copy>(
    py: Python<'py>,
    shape: (usize, usize, usize),
    values: &[T],
) -> PyResult<Bound<'py, PyArray3<T>>> {
    let view = ArrayView3::from_shape(shape, values).map_err(value_error)?;
    Ok(PyArray3::from_array(py, &view))
}

/// The elements in the order of rows.
fn in_order<T: Copy>(array: &ArrayView3<'_, T>) -> Vec<T> {
    match array.as_slice() {
        Some(slice) => slice.to_vec(),
        None => array.iter().copied().collect(),
    }
}
