"""Real materials by the wavelength."""

from __future__ import annotations

import os
from collections.abc import Mapping
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _cloakroom
from ._arrays import numbers

__all__ = ["Material"]

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
