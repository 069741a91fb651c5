"""An index of one's own, given as an array or as a function, on the grid that a scene has it on."""

from __future__ import annotations

import os
from collections.abc import Callable, Container
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ._arrays import numbers

__all__ = ["SPACING", "check_shapes", "grid_array", "index_array"]

#: What a function's grid is asked for beside the keys of the catalogue.
SPACING: dict[str, Any] = {
    "type": "number",
    "exclusiveMinimum": 0,
    "description": "Distance between the samples of an index that is a function, made a little smaller to fit; 1/160 "
    "of the longer side where it is absent. Unit: cm.",
    "x-unit": "cm",
}

#: Within a core, a function is asked for no more than these steps of the grid.
_INTO_CORE = 12

#: A cubic spline has as many samples as this along a side.
_LEAST = 4


def index_array(index: Any, size: tuple[float, float], inner: float, spacing: Any) -> Any:
    """The index as a scene file has it: rows of numbers, or the name of a file."""
    if isinstance(index, (str, os.PathLike)):
        return os.path.abspath(index)
    if callable(index):
        return _sampled(index, size, inner, _step(spacing, size))
    if spacing is not None:
        raise ValueError("spacing is that of the samples of a function; an array is from border to border")
    expected = "real numbers of the shape (samples along x, samples along y), a function or a path"
    return _checked("index", index, expected, (2, 3))


def grid_array(name: str, values: Any, most: int) -> Any:
    """A ratio or optic axes as a scene file has them: one number, lists of numbers, or the name of a file."""
    if isinstance(values, (str, os.PathLike)):
        return os.path.abspath(values)
    array = _checked(name, values, "one number, or real numbers of the shape of index, or a path", range(most + 1))
    return float(array) if array.ndim == 0 else array


def check_shapes(index: Any, ratio: Any, optic_axis: Any) -> None:
    """Refuses arrays of ratios and optic axes that are not on the grid of the index."""
    if not isinstance(index, np.ndarray):
        return
    shape = index.shape
    if min(shape) < _LEAST:
        raise ValueError(f"index has the shape {shape}; expected {_LEAST} samples at least each way")
    known = {"ratio": (ratio, [shape]), "optic_axis": (optic_axis, [(3,), shape, (*shape, 3)])}
    for name, (values, shapes) in known.items():
        if isinstance(values, np.ndarray) and values.shape not in shapes:
            listed = " or ".join(map(str, shapes))
            raise ValueError(f"{name} has the shape {values.shape}; expected {listed}, as index has the shape {shape}")


def _checked(name: str, values: Any, expected: str, dimensions: Container[int] = (2,)) -> NDArray[np.float64]:
    array = numbers(name, values, expected)
    if array.ndim not in dimensions:
        raise ValueError(f"{name} has the shape {array.shape}; expected {expected}")
    return array


def _step(spacing: Any, size: tuple[float, float]) -> float:
    if spacing is None:
        return max(size) / 160
    if isinstance(spacing, bool) or not isinstance(spacing, (int, float, np.integer, np.floating)):
        raise TypeError(f"spacing is a {type(spacing).__name__}; expected a number (cm)")
    if not 0 < spacing < float("inf"):
        raise ValueError(f"spacing is {spacing} cm; it must be above 0 and finite")
    return float(spacing)


def _sampled(
    index: Callable[[NDArray[np.float64], NDArray[np.float64]], Any],
    size: tuple[float, float],
    inner: float,
    spacing: float,
) -> NDArray[np.float64]:
    counts = [max(_LEAST, int(np.ceil(min(side / spacing, 1e6) - 1e-9)) + 1) for side in size]
    if counts[0] * counts[1] > 1_000_000:
        raise ValueError(f"spacing is {spacing} cm: a grid of {counts[0]} x {counts[1]} samples is too large")
    x, y = np.meshgrid(*(np.linspace(-side / 2, side / 2, count) for side, count in zip(size, counts)), indexing="ij")
    # What an index is deep within a core does not matter; formulas often have a pole there.
    if inner > 0:
        radius = np.hypot(x, y)
        least = inner - _INTO_CORE * spacing
        middle = least if least > 0 else inner / 2
        x = np.where(radius > 0, x, middle)
        radius = np.where(radius > 0, radius, middle)
        out = np.maximum(1.0, least / radius)
        x, y = x * out, y * out
    values = np.asarray(index(x, y))
    expected = f"a real number for each of the {x.shape[0]} x {x.shape[1]} places x, y that it is given"
    if values.dtype.kind not in "iuf" or values.shape not in ((), x.shape):
        raise ValueError(f"index gives an array of {values.dtype} of the shape {values.shape}; expected {expected}")
    return _checked("index", np.broadcast_to(values, x.shape), expected)
