"""Real materials by the wavelength; and what devices are made of, for fabrication and for full-wave solvers."""

from __future__ import annotations

import operator
import os
from collections.abc import Mapping
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _cloakroom
from ._arrays import numbers
from ._progress import Progress, told
from .scenes import Scene

__all__ = ["Material", "export"]

_Wave = Literal["ordinary", "extraordinary"]


class Material:
    """A real material: how its index of refraction depends on the wavelength.

    It goes where a device takes a ``material``.

    Parameters
    ----------
    what : str, path or mapping
        The name of one that comes with the program (``cloakroom materials`` lists them), a file of the
        refractiveindex.info database (``.yml``), or a law of one's own as scenes write it, such as
        ``{"cauchy": [1.5, 0.004, 0]}``.

    Raises
    ------
    ValueError
        If there is no such material, or its file or law cannot be used.

    Examples
    --------
    >>> from cloakroom import Body, Material
    >>> calcite = Material("calcite")
    >>> calcite.index([488, 590]).real.round(5).tolist()
    [1.66742, 1.6583]
    >>> float(calcite.index(590, "extraordinary").real.round(5))
    1.48611
    >>> float(calcite.group_index(590).round(4))
    1.6979
    >>> rhomb = Body(shape="box", size=[4, 4, 4], material=calcite, optic_axis=30)
    """

    def __init__(self, what: str | os.PathLike[str] | Mapping[str, Any]) -> None:
        if isinstance(what, Mapping):
            what = dict(what)
        elif not isinstance(what, str):
            what = os.fspath(what)
        # The working folder may be another one where it is used.
        if isinstance(what, str) and what.lower().endswith((".yml", ".yaml")):
            what = os.path.abspath(what)
        self._native = _cloakroom.Material(what)

    @property
    def title(self) -> str:
        """What it is."""
        return self._native.title

    @property
    def source(self) -> str:
        """Where its numbers are from."""
        return self._native.source

    @property
    def is_uniaxial(self) -> bool:
        """Whether it is a crystal with an extraordinary wave."""
        return self._native.is_uniaxial

    @property
    def range_nm(self) -> tuple[float, float]:
        """The least and the largest wavelength in vacuum at which its laws hold."""
        return self._native.range_nm

    @property
    def value(self) -> Any:
        """What the key ``material`` of a scene says."""
        return self._native.value

    def index(self, wavelength_nm: ArrayLike, wave: _Wave = "ordinary") -> NDArray[np.complex128]:
        """The index of refraction n + ik.

        Parameters
        ----------
        wavelength_nm : array of any shape
            Wavelengths in vacuum.
        wave : {"ordinary", "extraordinary"}
            Which wave of a crystal; other materials have the ordinary one alone.

        Returns
        -------
        array of complex128
            Of the same shape.

        Raises
        ------
        ValueError
            If the law does not hold at a wavelength, or there is no such wave.
        """
        return self._at(wavelength_nm, wave)[0]

    def group_index(self, wavelength_nm: ArrayLike, wave: _Wave = "ordinary") -> NDArray[np.float64]:
        """The group index n - wavelength dn/dwavelength; parameters and errors are those of `index`."""
        return self._at(wavelength_nm, wave)[1].real

    def permittivity(self, wavelength_nm: ArrayLike, wave: _Wave = "ordinary") -> NDArray[np.complex128]:
        """The relative permittivity, the square of `index`."""
        return self.index(wavelength_nm, wave) ** 2

    def _at(self, wavelength_nm: ArrayLike, wave: str) -> list[NDArray[np.complex128]]:
        if wave not in ("ordinary", "extraordinary"):
            raise ValueError(f'wave is {wave!r}; expected "ordinary" or "extraordinary"')
        if wave == "extraordinary" and not self.is_uniaxial:
            raise ValueError(f"{self.title} is isotropic; it has no extraordinary wave")
        wavelengths = numbers("wavelength_nm", wavelength_nm, "wavelengths in nm")
        found = self._native.indices(wavelengths.reshape(-1), wave == "extraordinary")
        return [array.reshape(wavelengths.shape) for array in found]

    def __eq__(self, other: object) -> bool:
        return self.value == other.value if isinstance(other, Material) else NotImplemented

    def __hash__(self) -> int:
        return hash(repr(self.value))

    def __repr__(self) -> str:
        return f"Material({self.value!r})"

    def __reduce__(self) -> tuple[Any, ...]:
        return Material, (self.value,)


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
