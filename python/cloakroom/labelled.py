"""Arrays by their names, whose axes have names, too: what xarray makes datasets of."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    import xarray

__all__ = ["Arrays", "are_equal", "dataset"]


class Arrays(dict[str, NDArray[Any]]):
    """A dict of arrays that knows the names of their axes; equal to a mapping of the same arrays.

    Parameters
    ----------
    arrays : mapping of str to array
        The arrays by their names.
    axes : mapping of str to tuple of str
        For each array the names of its axes.
    coordinates : mapping of str to array, optional
        Where the points along axes are, (length,); arrays that have the name of their one axis are such, too.
    """

    def __init__(
        self,
        arrays: Mapping[str, NDArray[Any]],
        axes: Mapping[str, tuple[str, ...]],
        coordinates: Mapping[str, NDArray[Any]] | None = None,
    ) -> None:
        super().__init__(arrays)
        #: For each array the names of its axes.
        self.axes = dict(axes)
        #: Where the points along axes are.
        self.coordinates = dict(coordinates or {})

    def to_xarray(self) -> xarray.Dataset:
        """The arrays as an `xarray.Dataset`; needs ``pip install './python[xarray]'``.

        Examples
        --------
        >>> from cloakroom import Scene, SquareCloak, export
        >>> dataset = export(Scene(devices=SquareCloak()), grid=(6, 6, 1)).to_xarray()
        >>> dataset["index"].dims, dataset["permittivity"].sel(row=0, column=0).shape
        (('x', 'y', 'z'), (6, 6, 1))
        """
        return dataset(self, self.axes, self.coordinates, {})

    def __eq__(self, other: object) -> bool:
        return are_equal(self, other) if isinstance(other, Mapping) else NotImplemented

    # That of dict would compare by itself.
    def __ne__(self, other: object) -> bool:
        return not self == other

    def __reduce__(self) -> tuple[Any, ...]:
        return Arrays, (dict(self), self.axes, self.coordinates)


def are_equal(one: Mapping[str, Any], other: Mapping[str, Any]) -> bool:
    """Whether arrays of the same names are the same; what is no number is equal to itself."""
    return one.keys() == other.keys() and all(_are_same(np.asarray(one[name]), np.asarray(other[name])) for name in one)


def _are_same(one: NDArray[Any], other: NDArray[Any]) -> bool:
    return np.array_equal(one, other, equal_nan=one.dtype.kind in "fc" and other.dtype.kind in "fc")


def dataset(
    arrays: Mapping[str, NDArray[Any]],
    axes: Mapping[str, tuple[str, ...]],
    coordinates: Mapping[str, NDArray[Any]],
    attributes: Mapping[str, str],
) -> xarray.Dataset:
    """Arrays as an `xarray.Dataset`."""
    try:
        import xarray
    except ImportError:
        raise ImportError("xarray is not installed; pip install './python[xarray]' brings it") from None
    along: dict[str, tuple[tuple[str, ...], NDArray[Any]]] = {name: ((name,), values) for name, values in coordinates.items()}
    along |= {name: (axes[name], array) for name, array in arrays.items() if axes[name] == (name,)}
    # The axes of tensors are counted.
    lengths = {axis: length for name in arrays for axis, length in zip(axes[name], arrays[name].shape)}
    along |= {axis: ((axis,), np.arange(lengths[axis])) for axis in ("row", "column") if axis in lengths}
    # What tells places apart must have an order.
    along = {
        name: (dims, np.array([str(value) for value in array]) if array.dtype == object else array)
        for name, (dims, array) in along.items()
    }
    variables = {name: (axes[name], array) for name, array in arrays.items() if name not in along}
    return xarray.Dataset(variables, along, dict(attributes))
