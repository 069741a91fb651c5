//! Images that are arrays.

use crate::errors::{Failure, value_error};
use crate::memory::check_copy;
use cloakroom::photograph::{ImageSource, LinearImage, Texels};
use numpy::{PyArray1, PyArrayMethods, PyReadonlyArray3, PyUntypedArrayMethods};
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;

/// An image that is in memory: red, green and blue of shape (height, width, 3), `uint8` in sRGB or
/// `float32` in linear light.
#[pyclass(frozen, module = "cloakroom._cloakroom")]
#[derive(Debug)]
pub struct Image {
    pub source: ImageSource,
}

#[pymethods]
impl Image {
    #[new]
    fn new(array: &Bound<'_, PyAny>) -> Result<Self, Failure> {
        check_copy("the image", array)?;
        let (shape, texels) = if let Ok(codes) = array.extract::<PyReadonlyArray3<'_, u8>>() {
            (codes.shape().to_vec(), Texels::Srgb8(codes.as_array().iter().copied().collect()))
        } else if let Ok(light) = array.extract::<PyReadonlyArray3<'_, f32>>() {
            (light.shape().to_vec(), Texels::Linear(light.as_array().iter().copied().collect()))
        } else {
            let message = "an image must be of uint8 or float32, (height, width, 3)";
            return Err(PyTypeError::new_err(message).into());
        };
        let [height, width, 3] = shape[..] else {
            return Err(value_error("an image must be of the shape (height, width, 3)"));
        };
        let image = LinearImage { width, height, texels };
        Ok(Self { source: ImageSource::memory(image)? })
    }

    /// The array, a copy.
    fn array<'py>(&self, py: Python<'py>) -> Result<Bound<'py, PyAny>, Failure> {
        let ImageSource::Memory(image) = &self.source else {
            return Err(value_error("the image is no array"));
        };
        let shape = [image.height, image.width, 3];
        Ok(match &image.texels {
            Texels::Srgb8(codes) => PyArray1::from_slice(py, codes).reshape(shape)?.into_any(),
            Texels::Linear(light) => PyArray1::from_slice(py, light).reshape(shape)?.into_any(),
        })
    }

    /// How scenes name it.
    #[getter]
    fn name(&self) -> String {
        self.source.to_string()
    }
}
