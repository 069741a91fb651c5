"""What devices are made of, for fabrication and for full-wave solvers; and the paths of rays, for ParaView."""

from __future__ import annotations

import json
import operator
import os
from typing import Any, Literal, overload

import numpy as np

from . import _cloakroom
from ._progress import Progress, told
from .labelled import Arrays
from .rays import Paths, Traced
from .scenes import Scene

__all__ = ["export"]


_Source = Scene | Traced | Paths


@overload
def export(
    source: _Source,
    path: str | os.PathLike[str],
    *,
    grid: float | tuple[int, int, int] | None = None,
    device: int | None = None,
    frame: Literal["device", "world"] = "device",
    table: bool = False,
    progress: Progress = False,
) -> None: ...
@overload
def export(
    source: Scene,
    path: None = None,
    *,
    grid: float | tuple[int, int, int] | None = None,
    device: int | None = None,
    frame: Literal["device", "world"] = "device",
    table: Literal[False] = False,
    progress: Progress = False,
) -> Arrays: ...
@overload
def export(
    source: Scene,
    path: None = None,
    *,
    device: int | None = None,
    table: Literal[True],
    progress: Progress = False,
) -> list[dict[str, Any]]: ...
def export(
    source: _Source,
    path: str | os.PathLike[str] | None = None,
    *,
    grid: float | tuple[int, int, int] | None = None,
    device: int | None = None,
    frame: Literal["device", "world"] = "device",
    table: bool = False,
    progress: Progress = False,
) -> Arrays | list[dict[str, Any]] | None:
    """What a device is made of, index and tensors on a grid or its homogeneous segments, as arrays or a file; or the
    paths of rays as a file.

    Parameters
    ----------
    source : Scene, Traced or Paths
        The scene; or rays traced with ``paths=True``, of which a ``.vtp`` is written.
    path : path, optional
        The file: ``.npz``, ``.vti`` (ParaView) or ``.csv``; of a table ``.csv`` or ``.json``; of paths ``.vtp``
        (ParaView). What is in it is told in docs/export.md. Without one, the arrays are given back.
    grid : float or (int, int, int), optional
        The side of cubic cells in cm, or how many cells along x, y and z; cubes, 64 along the longest side, if not
        given.
    device : int, optional
        Which device, counted from 0; the only one if not given.
    frame : {"device", "world"}, default "device"
        Along whose axes grid and tensors lie.
    table : bool, default False
        The segments instead of a grid.
    progress : bool or callable, default False
        ``True`` for a line on standard error, or a function that is called with the rows done and all rows.

    Returns
    -------
    Arrays, list of dict or None
        Without a path, on a grid of X x Y x Z cells: ``x``, ``y``, ``z``, their middles (cm); ``region``, (X, Y, Z),
        0 air, 1 material, 2 metal, 3 hidden air; ``index``, (X, Y, Z); ``permittivity`` and ``permeability``, (X, Y,
        Z, 3, 3), and their imaginary parts where there are some. Metal is NaN. Of a table, a dict for each segment.

    Raises
    ------
    TypeError, ValueError
        If the device has no material or no segments, the grid is empty, or the ending is another.
    MemoryError
        If the grid would not fit into the memory that is free.
    OSError
        If the file cannot be written; then there is none.

    Examples
    --------
    >>> from cloakroom import Scene, SquareCloak, export
    >>> material = export(Scene(devices=SquareCloak()), grid=(8, 8, 1))
    >>> material["permittivity"].shape, bool((material["region"] == 2).any())
    ((8, 8, 1, 3, 3), True)
    """
    file = None if path is None else os.fspath(path)
    if isinstance(source, (Traced, Paths)):
        _export_paths(source, file)
        return None
    if not isinstance(source, Scene):
        raise TypeError(f"source is a {type(source).__name__}; expected a Scene, or rays traced with paths=True")
    if frame not in ("device", "world"):
        raise ValueError(f'frame is {frame!r}; expected "device" or "world"')
    if device is not None:
        try:
            device = operator.index(device)
        except TypeError:
            raise TypeError(f"device is a {type(device).__name__}; expected the number of a device") from None
        if device < 0:
            raise ValueError(f"device is {device}; expected the number of a device, counted from 0")
    if table:
        if grid is not None or frame != "device":
            raise ValueError("table goes with neither grid nor frame: segments lie in the device's frame")
        text = _cloakroom.export_table(source._native, file, device)
        segments: list[dict[str, Any]] | None = None if text is None else json.loads(text)
        return segments
    cells, spacing = _resolution(grid)
    with told(progress, "sampling") as tell:
        arrays = _cloakroom.export_grid(source._native, file, device, cells, spacing, frame == "world", tell)
    if arrays is None:
        return None
    axes = ("x", "y", "z", "row", "column")
    return Arrays(arrays, {name: (name,) if name in axes else axes[: array.ndim] for name, array in arrays.items()})


def _export_paths(source: Traced | Paths, file: str | None) -> None:
    paths = source.paths if isinstance(source, Traced) else source
    if paths is None:
        raise ValueError("source has no paths; trace with paths=True")
    if file is None:
        raise TypeError("path is missing: paths are arrays already, of which a .vtp is written")
    power = paths.power if paths.power.ndim == 2 else paths.power[:, None]
    rest = (paths.leaf, paths.parent, paths.start, paths.vertex, paths.optical_path)
    _cloakroom.export_paths(file, paths.ray, power, *rest)


def _resolution(grid: object) -> tuple[list[int] | None, float | None]:
    expected = "the side of a cell in cm, or how many cells along x, y and z"
    if grid is None:
        return None, None
    try:
        array = np.asarray(grid)
    except ValueError:
        raise ValueError(f"grid is {grid!r}; expected {expected}") from None
    if array.dtype.kind not in "iuf":
        raise TypeError(f"grid is {grid!r}; expected {expected}")
    if array.shape == ():
        return None, float(array)
    if array.shape != (3,) or array.dtype.kind == "f" or not ((array >= 0) & (array < 2**32)).all():
        raise ValueError(f"grid is {grid!r}; expected {expected}")
    return [int(count) for count in array], None
