"""Rays: where they go, by the million."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _cloakroom
from ._arrays import common_length, vectors
from ._progress import Progress, told
from .scenes import Scene

__all__ = ["Traced", "trace"]


@dataclass(frozen=True)
class Traced:
    """What became of N rays. A leaf is a branch of a ray that has left every device; there are M of them in all.

    The leaves stand ray by ray, the strongest of each first. For every ray, the powers of its leaves, ``absorbed`` and
    ``pruned`` add up to 1.
    """

    #: The number of the ray that each leaf is of, counted from 0; (M,), ``uint32``.
    ray: NDArray[np.uint32]
    #: The last point at which each leaf left a device, cm; (M, 3), NaN where it met none.
    position: NDArray[np.float64]
    #: Its direction, a unit vector; (M, 3).
    direction: NDArray[np.float64]
    #: Its share of the power of its ray; (M,).
    power: NDArray[np.float64]
    #: Optical path length from the ray's origin to ``position``, cm; (M,), 0 where it met no device. The phase path:
    #: negative in media of negative index.
    optical_path: NDArray[np.float64]
    #: Its electric field, with the phases of the interfaces but not of the way; (M, 3), complex, |E|² = ``power``.
    electric_field: NDArray[np.complex128]
    #: The share of power absorbed, by media or on opaque bodies, for each ray; (N,).
    absorbed: NDArray[np.float64]
    #: The share of power in branches too weak to follow, for each ray; (N,).
    pruned: NDArray[np.float64]
    #: The speed of light times what a pulse takes from the ray's origin to ``position``, cm; (M,), 0 where it met no
    #: device, NaN behind media that absorb. ``None`` if it was not asked for.
    group_path: NDArray[np.float64] | None = None

    def __len__(self) -> int:
        """How many rays there were."""
        return len(self.absorbed)

    @property
    def strongest(self) -> NDArray[np.intp]:
        """For each ray the place of its strongest leaf among the leaves, -1 where it has none; (N,)."""
        first = np.full(len(self), -1, dtype=np.intp)
        rays, places = np.unique(self.ray, return_index=True)
        first[rays] = places
        return first

    @property
    def delivered(self) -> NDArray[np.float64]:
        """The share of power in leaves, for each ray; (N,)."""
        sums = np.bincount(self.ray, weights=self.power, minlength=len(self))
        return sums.astype(np.float64, copy=False)

    def __repr__(self) -> str:
        return f"<Traced: {len(self)} rays with {len(self.ray)} leaves>"


def trace(
    scene: Scene,
    origins: ArrayLike,
    directions: ArrayLike,
    polarization: Literal["horizontal", "vertical"] | ArrayLike = "horizontal",
    *,
    min_power: float | None = None,
    coherent: bool = False,
    group_delay: bool = False,
    progress: Progress = False,
) -> Traced:
    """Traces rays through the devices of a scene, on all cores. The photograph and the camera play no part.

    Parameters
    ----------
    scene : Scene
        The scene.
    origins : array_like, (N, 3) or (3,)
        Where the rays start, cm, in air; one place stands for all rays.
    directions : array_like, (N, 3) or (3,)
        Where they go, of any length; one direction stands for all rays.
    polarization : {"horizontal", "vertical"} or complex array_like, (N, 3) or (3,), default "horizontal"
        E in the plane of the ray and z (along x for a ray along z), or perpendicular to both; or the electric fields
        themselves, across the rays and of any norm.
    min_power : float, optional
        Branches below this share of a ray's power are pruned; by default what the scene's ``trace.min_power`` says,
        else 1e-9, or 1e-24 if `coherent`.
    coherent : bool, default False
        Leaves of one direction are added as fields, as light of the scene's wavelength and bandwidth does in the far
        field: one leaf each, at the place of the strongest. Thin films and plates need it.
    group_delay : bool, default False
        Leaves get `group_path`, too: the speed of light times what a pulse takes.
    progress : bool or callable, default False
        ``True`` for a line on standard error, or a function that is called with the rays done and all rays.

    Returns
    -------
    Traced
        The leaves as flat arrays.

    Raises
    ------
    TypeError, ValueError
        If an array is of a wrong type or shape, a number is not finite, a direction is zero, a field is not transverse,
        or a ray starts in metal or an opaque body; the message names the argument or the ray.
    MemoryError
        If the leaves would not fit into the memory that is free.

    Examples
    --------
    >>> from cloakroom import Scene, SquareCloak, trace
    >>> scene = Scene(devices=SquareCloak())
    >>> traced = trace(scene, origins=[[-100, 3, 0], [-100, 30, 0]], directions=[1, 0, 0])
    >>> traced.ray, traced.optical_path.round(6)
    (array([0, 1], dtype=uint32), array([106.970206,   0.      ]))
    """
    if not isinstance(scene, Scene):
        raise TypeError(f"scene is a {type(scene).__name__}; expected a Scene")
    start, along = vectors("origins", origins), vectors("directions", directions)
    word, fields = "horizontal", None
    if isinstance(polarization, str):
        if polarization not in ("horizontal", "vertical"):
            raise ValueError(
                f'polarization is "{polarization}"; expected "horizontal", "vertical" or electric fields (N, 3)'
            )
        word = polarization
    else:
        fields = vectors("polarization", polarization, allow_complex=True)
    if min_power is not None:
        if not isinstance(min_power, (int, float, np.floating, np.integer)):
            raise TypeError(f"min_power is a {type(min_power).__name__}; expected a number from 0 to 1")
        if not 0 <= min_power <= 1:
            raise ValueError(f"min_power is {min_power}; expected a number from 0 to 1")
        min_power = float(min_power)
    given = {"origins": start, "directions": along}
    if fields is not None:
        given["polarization"] = fields
    count = common_length({name: len(array) for name, array in given.items()})
    spread = {name: np.broadcast_to(array, (count, 3)) for name, array in given.items()}
    with told(progress, "tracing") as tell:
        arrays = _cloakroom.trace(
            scene._native,
            spread["origins"],
            spread["directions"],
            word,
            spread.get("polarization"),
            min_power,
            bool(coherent),
            bool(group_delay),
            tell,
        )
    return Traced(**arrays)
