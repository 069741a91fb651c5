"""What people hand over as arrays, checked and as the compiled half wants it."""

from __future__ import annotations

import os
import warnings
from typing import Any

import numpy as np
from numpy.typing import NDArray

from . import _cloakroom

__all__ = ["check_listed", "common_length", "image_of", "is_image_array", "numbers", "tensors", "vectors"]


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


def check_listed(key: str, given: Any, expected: str) -> None:
    """Refuses what is given for a key where a list of its values is expected."""
    if isinstance(given, (str, bytes)) or not hasattr(given, "__len__"):
        raise TypeError(f"keys[{key!r}] is a {type(given).__name__}; expected {expected}")


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


_IMAGE = (
    "an image of the shape (height, width), (height, width, 3) or (height, width, 4), of uint8 (sRGB) or floats (linear "
    "light, or sRGB with encoding='srgb')"
)


def image_of(name: str, value: Any, encoding: Any = None) -> _cloakroom.Image:
    """``value`` as an image: (height, width), (height, width, 3) or, over black, (height, width, 4).

    ``encoding`` says what floats stand for; ``None`` is linear light, with a warning where it looks like sRGB.
    """
    if encoding not in (None, "srgb", "linear"):
        raise ValueError(f'encoding is {encoding!r}; expected "srgb" or "linear"')
    try:
        array = np.asarray(value)
    except (TypeError, ValueError) as error:
        raise ValueError(f"{name} is no array: {error}; expected {_IMAGE}") from None
    if array.dtype != np.uint8 and array.dtype.kind != "f":
        raise TypeError(f"{name} is of the type {array.dtype}; expected {_IMAGE}")
    if array.ndim == 2:
        array = np.broadcast_to(array[:, :, None], (*array.shape, 3))
    if array.ndim == 3 and array.shape[2] == 1 and array.size:
        array = np.broadcast_to(array, (*array.shape[:2], 3))
    if array.ndim != 3 or array.shape[2] not in (3, 4) or array.size == 0:
        channels_first = array.ndim == 3 and array.shape[0] in (3, 4)
        mend = f"; {name}.transpose(1, 2, 0) has the colors last" if channels_first else ""
        raise ValueError(f"{name} has the shape {array.shape}; expected {_IMAGE}{mend}")
    if array.dtype.kind == "f" and array.shape[2] == 4 and not ((array[..., 3] >= 0) & (array[..., 3] <= 1)).all():
        alpha = array[..., 3]
        raise ValueError(
            f"{name} has alpha, its last channel, from {alpha.min():g} to {alpha.max():g}; expected 0 (clear) to 1 (opaque)"
        )
    if array.dtype == np.uint8:
        if encoding != "linear":
            return _cloakroom.Image(_required(name, array, np.uint8), True)
        array = np.asarray(array, np.float32) / np.float32(255)
    elif encoding is None and (doubt := _doubt(array)):
        warnings.warn(f'{name} {doubt}, or encoding="linear" if it is linear light', stacklevel=4)
    elif encoding == "srgb" and ((array < 0) | (array > 1)).any():
        raise ValueError(
            f"{name} has numbers from {array.min():g} to {array.max():g}; floats in sRGB are from 0 to 1: divide by 255, "
            "or give uint8"
        )
    with np.errstate(over="ignore"):
        return _cloakroom.Image(_required(name, array, np.float32), encoding == "srgb")


#: An image has more codes than this, a test pattern fewer.
_FEWEST_CODES = 24

#: Half of an image in linear light is hardly brighter than so many times white.
_BRIGHT = 2.0


def _doubt(array: NDArray[Any]) -> str | None:
    """Why floats are hardly linear light in which 1 is white, and what to do, if they are not."""
    step = max(1, array.size // 65536)
    sample = np.asarray(array.reshape(-1)[::step], np.float64)
    if not np.isfinite(sample).all():
        # What is no number is refused in any case.
        return None
    if (lowest := sample.min()) < 0:
        return f"has negative numbers, {lowest:g} among them, and there is no negative light; scale them to 0..1"
    eight_bit, largest = "give uint8, or divide by 255 and say encoding=\"srgb\"", sample.max()
    codes = sample * 255 if largest <= 1 else sample
    whole = np.round(codes)
    if largest <= 255 and (np.abs(codes - whole) < 1e-3).all() and len(np.unique(whole)) > _FEWEST_CODES:
        if largest <= 1:
            return (
                "has floats on the steps of 8-bit codes, as sRGB images divided by 255 have, but floats are taken as "
                'linear light; say encoding="srgb"'
            )
        return f"has floats that are whole numbers up to 255, as 8-bit images have, but 1 is white; {eight_bit}"
    if largest <= 255 and (middle := np.median(sample)) > _BRIGHT:
        return f"has floats half of which are above {middle:g}, and 1 is white; if they are 8-bit codes, {eight_bit}"
    return None
