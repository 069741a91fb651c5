"""What devices are made of, for fabrication and for full-wave solvers."""

from __future__ import annotations

import operator
import os
from typing import Literal

import numpy as np

from . import _cloakroom
from ._progress import Progress, told
from .scenes import Scene

__all__ = ["export"]


def export(
    scene: Scene,
    path: str | os.PathLike[str],
    *,
    device: int | None = None,
    grid: float | tuple[int, int, int] | None = None,
    frame: Literal["device", "world"] = "device",
    table: bool = False,
    progress: Progress = False,
) -> None:
    """Writes what a device is made of: index and tensors on a grid, or its homogeneous segments as a table.

    Parameters
    ----------
    scene : Scene
        The scene.
    path : path
        The file: ``.npz``, ``.vti`` (ParaView) or ``.csv``; of a table ``.csv`` or ``.json``. What is in it is told
        in docs/export.md.
    device : int, optional
        Which device, counted from 0; the only one if not given.
    grid : float or (int, int, int), optional
        The side of cubic cells in cm, or how many cells along x, y and z; cubes, 64 along the longest side, if not
        given.
    frame : {"device", "world"}, default "device"
        Along whose axes grid and tensors lie.
    table : bool, default False
        Write the segments instead of a grid.
    progress : bool or callable, default False
        ``True`` for a line on standard error, or a function that is called with the rows done and all rows.

    Raises
    ------
    TypeError, ValueError
        If the device has no material or no segments, the grid is empty, or the ending is another.
    MemoryError
        If the grid would not fit into the memory that is free.
    OSError
        If the file cannot be written; then there is none.
    """
    if not isinstance(scene, Scene):
        raise TypeError(f"scene is a {type(scene).__name__}; expected a Scene")
    if frame not in ("device", "world"):
        raise ValueError(f'frame is {frame!r}; expected "device" or "world"')
    if device is not None:
        try:
            device = operator.index(device)
        except TypeError:
            raise TypeError(f"device is a {type(device).__name__}; expected the number of a device") from None
        if device < 0:
            raise ValueError(f"device is {device}; expected the number of a device, counted from 0")
    file = os.fspath(path)
    if table:
        if grid is not None or frame != "device":
            raise ValueError("table goes with neither grid nor frame: segments lie in the device's frame")
        _cloakroom.export_table(scene._native, file, device)
        return
    cells, spacing = _resolution(grid)
    with told(progress, "sampling") as tell:
        _cloakroom.export_grid(scene._native, file, device, cells, spacing, frame == "world", tell)


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
