//! Images that are arrays.

use crate::errors::{Failure, value_error};
use crate::memory::check_copy;
use cloakroom::photograph::{ImageSource, LinearImage, Texels, decode, decode_table, over_black};
use numpy::{PyArray1, PyArrayMethods, PyReadonlyArray3, PyUntypedArrayMethods};
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;

/// An image that is in memory: red, green and blue of shape (height, width, 3), `uint8` in sRGB or
/// `float32` in linear light, made of such and of those with alpha.
#[pyclass(frozen, eq, module = "cloakroom._cloakroom")]
#[derive(Debug, PartialEq)]
pub struct Image {
    pub source: ImageSource,
}

#[pymethods]
impl Image {
    /// The image of an array; floats stand for light as `is_srgb` says.
    #[new]
    fn new(array: &Bound<'_, PyAny>, is_srgb: bool) -> Result<Self, Failure> {
        check_copy("the image", array)?;
        let light = |value: f32| if is_srgb { decode(value.into()) as f32 } else { value };
        let (shape, texels) = if let Ok(codes) = array.extract::<PyReadonlyArray3<'_, u8>>() {
            let values = codes.as_array().iter().copied().collect();
            (codes.shape().to_vec(), of_codes(values, codes.shape()[2]))
        } else if let Ok(floats) = array.extract::<PyReadonlyArray3<'_, f32>>() {
            let values: Vec<f32> = floats.as_array().iter().copied().collect();
            let texels = match floats.shape()[2] {
                4 => over_black(&values, light, 1.0),
                _ => Texels::Linear(values.into_iter().map(light).collect()),
            };
            (floats.shape().to_vec(), texels)
        } else {
            let message =
                "an image must be of uint8 or float32, (height, width, 3) or (height, width, 4)";
            return Err(PyTypeError::new_err(message).into());
        };
        let [height, width, 3 | 4] = shape[..] else {
            let message = "an image must be of the shape (height, width, 3) or (height, width, 4)";
            return Err(value_error(message));
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

/// The image of sRGB codes, a fourth of each pixel being alpha: over black, as that of a file.
fn of_codes(codes: Vec<u8>, channels: usize) -> Texels {
    let (rgba, _) = codes.as_chunks::<4>();
    if channels != 4 {
        return Texels::Srgb8(codes);
    }
    if rgba.iter().all(|texel| texel[3] == u8::MAX) {
        return Texels::Srgb8(rgba.iter().flat_map(|[r, g, b, _]| [*r, *g, *b]).collect());
    }
    let table = decode_table();
    over_black(&codes, |code| table[usize::from(code)], 1.0 / 255.0)
}
