//! Tensors of media as scenes write them: a number, [re, im], or 3 x 3 of either.

use super::Value;
use super::value::items_of;
use glam::{DMat3, DVec3};
use num_complex::Complex64;
use optics::medium::Tensor;

/// The tensor that a value is, if it is one.
pub(super) fn from_value(value: &Value) -> Option<Tensor> {
    if let Some(scalar) = entry(value) {
        return Some(Tensor { re: diagonal(scalar.re), im: diagonal(scalar.im) });
    }
    let rows = three(value)?;
    let mut tensor = Tensor { re: DMat3::ZERO, im: DMat3::ZERO };
    for (i, row) in rows.iter().enumerate() {
        for (j, value) in three(row)?.iter().enumerate() {
            let entry = entry(value)?;
            tensor.re.col_mut(j)[i] = entry.re;
            tensor.im.col_mut(j)[i] = entry.im;
        }
    }
    Some(tensor)
}

/// The shortest way to write a tensor.
pub(super) fn to_value(tensor: &Tensor) -> Value {
    let written = |re: f64, im: f64| {
        if im == 0.0 { Value::from(re) } else { Value::from([re, im]) }
    };
    let (re, im) = (&tensor.re, &tensor.im);
    let scalar = [re, im].into_iter().all(|m| *m == diagonal(m.x_axis.x));
    if scalar {
        return written(re.x_axis.x, im.x_axis.x);
    }
    let row = |i: usize| Value::List((0..3).map(|j| written(re.col(j)[i], im.col(j)[i])).collect());
    Value::List((0..3).map(row).collect())
}

/// Every number in a tensor.
pub(super) fn parts(tensor: &Tensor) -> impl Iterator<Item = f64> {
    tensor.re.to_cols_array().into_iter().chain(tensor.im.to_cols_array())
}

/// The complex number that a number or a pair of its real and imaginary part is.
pub(super) fn entry(value: &Value) -> Option<Complex64> {
    match items_of(value, Value::as_number) {
        Some([re, im]) => Some(Complex64::new(re, im)),
        None => value.as_number().map(Complex64::from),
    }
}

fn three(value: &Value) -> Option<&[Value; 3]> {
    value.as_list()?.try_into().ok()
}

fn diagonal(value: f64) -> DMat3 {
    DMat3::from_diagonal(DVec3::splat(value))
}
