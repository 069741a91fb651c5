"""What people hand over as arrays, checked and as the compiled half wants it."""

from __future__ import annotations

import os
from typing import Any

import numpy as np
from numpy.typing import NDArray

from . import _cloakroom

__all__ = ["common_length", "image_array", "is_image_array", "numbers", "tensors", "vectors"]


def numbers(name: str, value: Any, expected: str, *, allow_complex: bool = False) -> NDArray[Any]:
    """``value`` as an array of ``float64`` or, if allowed, ``complex128``; copied only where it must be."""
    try:
        array = np.asarray(value)
    except (TypeError, ValueError) as error:
        raise ValueError(f"{name} is no array: {error}; expected {expected}") from None
    if array.dtype.kind not in ("iufc" if allow_complex else "iuf"):
        raise TypeError(f"{name} is of the type {array.dtype}; expected {expected}")
    return _required(name, array, np.complex128 if allow_complex else np.float64)


def _required(name: str, array: NDArray[Any], dtype: Any) -> NDArray[Any]:
    """The array as one of a type; a copy is not begun that does not fit into memory."""
    if array.dtype != dtype or not array.flags.aligned:
        _cloakroom.check_memory(name, array.size * np.dtype(dtype).itemsize)
    return np.require(array, dtype, ["ALIGNED"])


def vectors(name: str, value: Any, *, allow_complex: bool = False) -> NDArray[Any]:
    """``value`` as an array of shape (N, 3)."""
    kind = "numbers, real or complex," if allow_complex else "real numbers"
    expected = f"{kind} of the shape (N, 3) or (3,)"
    array = numbers(name, value, expected, allow_complex=allow_complex)
    if array.shape == (3,):
        return array.reshape(1, 3)
    if array.ndim != 2 or array.shape[1] != 3:
        raise ValueError(f"{name} has the shape {array.shape}; expected {expected}")
    return array


def tensors(name: str, value: Any) -> NDArray[np.complex128]:
    """``value`` as an array of shape (N, 3, 3): a number, a tensor, or N of either."""
    expected = "numbers, real or complex, of the shape (), (N,), (3, 3) or (N, 3, 3)"
    array = numbers(name, value, expected, allow_complex=True)
    if array.ndim <= 1:
        _cloakroom.check_memory(name, 9 * 16 * array.size)
        spread: NDArray[np.complex128] = np.atleast_1d(array)[:, None, None] * np.eye(3, dtype=np.complex128)
        return spread
    if array.shape == (3, 3):
        return array[None]
    if array.ndim != 3 or array.shape[1:] != (3, 3):
        raise ValueError(f"{name} has the shape {array.shape}; expected {expected}")
    return array


def common_length(lengths: dict[str, int]) -> int:
    """The one length of arrays of which those with a single row stand for as many as there are."""
    longest = max(lengths.values(), key=lambda length: (length != 1, length))
    if any(length not in (1, longest) for length in lengths.values()):
        listed = ", ".join(f"{name} {length}" for name, length in lengths.items())
        raise ValueError(f"the arrays differ in their rows: {listed}; expected as many in each, or one")
    return longest


def is_image_array(value: Any) -> bool:
    """Whether ``value`` is pixels rather than the name of a file."""
    if isinstance(value, (str, bytes, os.PathLike)):
        return False
    return isinstance(value, (list, tuple)) or hasattr(value, "__array__")


def image_array(name: str, value: Any) -> NDArray[Any]:
    """``value`` as pixels (height, width, 3), ``uint8`` or ``float32``; gray ones have three equal channels."""
    expected = (
        "an image of the shape (height, width, 3) or (height, width), of uint8 (sRGB) or floats (linear light)"
    )
    try:
        array = np.asarray(value)
    except (TypeError, ValueError) as error:
        raise ValueError(f"{name} is no array: {error}; expected {expected}") from None
    if array.dtype != np.uint8 and array.dtype.kind != "f":
        raise TypeError(f"{name} is of the type {array.dtype}; expected {expected}")
    if array.ndim == 2:
        array = np.broadcast_to(array[:, :, None], (*array.shape, 3))
    if array.ndim != 3 or array.shape[2] != 3 or array.size == 0:
        raise ValueError(f"{name} has the shape {array.shape}; expected {expected}")
    with np.errstate(over="ignore"):
        return _required(name, array, np.uint8 if array.dtype == np.uint8 else np.float32)
