"""Interfaces between media: modes, fields and powers."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _cloakroom
from ._arrays import common_length, tensors, vectors
from ._progress import Progress, told

__all__ = ["Interface", "Medium", "Modes", "interface"]


@dataclass(frozen=True)
class Medium:
    """A medium, or one for each of N interfaces.

    Parameters
    ----------
    permittivity, permeability : array_like, (), (N,), (3, 3) or (N, 3, 3), default 1
        Relative, real or complex (a positive imaginary part absorbs); tensors are symmetric.
    """

    permittivity: ArrayLike = 1
    permeability: ArrayLike = 1


@dataclass(frozen=True)
class Modes:
    """Two modes on one side of each of N interfaces, of normal flux 1 and orthogonal in flux.

    Degenerate pairs: s, then p; uniaxial media: ordinary, then extraordinary; others: the smaller \\|p\\| first.
    """

    #: Wave vector k/k0; (N, 2, 3), complex.
    wave_vector: NDArray[np.complex128]
    #: Poynting vector Re(E x H*); (N, 2, 3), NaN for evanescent modes.
    poynting: NDArray[np.float64]
    #: Electric field; (N, 2, 3), complex.
    electric_field: NDArray[np.complex128]
    #: Magnetic field times the vacuum impedance; (N, 2, 3), complex.
    magnetic_field: NDArray[np.complex128]
    #: Whether the mode carries power across the interface; (N, 2).
    propagating: NDArray[np.bool_]


@dataclass(frozen=True)
class Interface:
    """What N interfaces make of the light that comes to them."""

    #: The modes that run towards the interface.
    incident: Modes
    #: The modes that run back.
    reflected: Modes
    #: The modes beyond; ``None`` for metal.
    transmitted: Modes | None
    #: Shares of the incident normal flux: (N, 4, 2), or (N, 2, 2) for metal. Rows are the outgoing modes (reflected 1,
    #: 2, transmitted 1, 2), columns the incident ones; NaN for evanescent incident modes.
    power: NDArray[np.float64]
    #: Amplitudes of the outgoing modes for an incident mode of amplitude 1, with the modes' own fields, those at the
    #: interface; complex, of the shape of ``power``. Evanescent modes have theirs.
    amplitudes: NDArray[np.complex128]
    #: Jones matrices of reflection for fields of unit size; (N, 2, 2), complex, NaN where a medium is not isotropic. Rows
    #: are s and p of the wave that leaves, columns s and p of the wave that comes. The field of p lies along s x k/\|k\|, k
    #: being each wave's own wave vector: r_p = (n2 cos a1 - n1 cos a2)/(n2 cos a1 + n1 cos a2).
    jones_reflected: NDArray[np.complex128]
    #: Jones matrices of transmission; ``None`` for metal.
    jones_transmitted: NDArray[np.complex128] | None
    #: The share of the normal flux that is reflected, for each incident mode; (N, 2), NaN for evanescent ones. In a medium
    #: that absorbs it is the sum of the rows and what the two modes carry together beyond what each carries alone.
    total_reflected: NDArray[np.float64]
    #: The same of what is transmitted.
    total_transmitted: NDArray[np.float64]


def interface(
    incident: Medium | Mapping[str, ArrayLike],
    transmitted: Medium | Mapping[str, ArrayLike] | Literal["metal"],
    normal: ArrayLike,
    tangential: ArrayLike,
    *,
    progress: Progress = False,
) -> Interface:
    """Solves interfaces between any two media, anisotropic, magnetic, negative or absorbing, or of one with metal.

    Parameters
    ----------
    incident : Medium or mapping
        The medium that light comes from.
    transmitted : Medium, mapping or "metal"
        The medium beyond.
    normal : array_like, (N, 3) or (3,)
        From the incident into the transmitted medium, of any length.
    tangential : array_like, (N, 3) or (3,)
        The tangential part of the wave vector k/k0.
    progress : bool or callable, default False
        ``True`` for a line on standard error, or a function that is called with the interfaces done and all of them.

    Returns
    -------
    Interface
        Modes and powers; one row stands for all interfaces where an argument has only one.

    Raises
    ------
    TypeError, ValueError
        If an array is of a wrong type or shape, a tensor is unphysical, a normal is zero, or a tangential vector is
        not tangential; the message names the argument or the interface.

    Examples
    --------
    Fresnel's equations at normal incidence on glass of index 1.5 reflect 4 %:

    >>> from cloakroom import Medium, interface
    >>> solved = interface(Medium(), Medium(permittivity=2.25), normal=[1, 0, 0], tangential=[0, 0, 0])
    >>> solved.total_reflected.round(12)
    array([[0.04, 0.04]])
    """
    near = _medium("incident", incident)
    beyond = None if isinstance(transmitted, str) and transmitted == "metal" else _medium("transmitted", transmitted)
    normals, tangentials = vectors("normal", normal), vectors("tangential", tangential)
    lengths = {"normal": len(normals), "tangential": len(tangentials)}
    for name, medium in (("incident", near), ("transmitted", beyond)):
        if medium is not None:
            lengths[f"{name}.permittivity"], lengths[f"{name}.permeability"] = map(len, medium)
    count = common_length(lengths)
    with told(progress, "solving") as tell:
        arrays = _cloakroom.interface(
            near,
            beyond,
            np.broadcast_to(normals, (count, 3)),
            np.broadcast_to(tangentials, (count, 3)),
            tell,
        )
    modes = {side: Modes(**arrays.pop(side)) for side in ("incident", "reflected", "transmitted") if side in arrays}
    return Interface(modes["incident"], modes["reflected"], modes.get("transmitted"), **arrays)


def _medium(name: str, medium: Any) -> tuple[NDArray[np.complex128], NDArray[np.complex128]]:
    """Permittivity and permeability, (N, 3, 3) each."""
    if isinstance(medium, Mapping):
        try:
            medium = Medium(**medium)
        except TypeError:
            raise TypeError(
                f"{name} has the keys {', '.join(map(str, medium))}; expected permittivity and permeability"
            ) from None
    if not isinstance(medium, Medium):
        raise TypeError(f"{name} is {medium!r}; expected a Medium" + (' or "metal"' if name == "transmitted" else ""))
    permittivity = tensors(f"{name}.permittivity", medium.permittivity)
    return permittivity, tensors(f"{name}.permeability", medium.permeability)
