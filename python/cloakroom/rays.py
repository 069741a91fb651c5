"""Rays: where they go, by the million."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _cloakroom
from ._arrays import common_length, numbers, vectors
from ._progress import Progress, told
from .scenes import Scene

__all__ = ["Paths", "Traced", "trace"]


@dataclass(frozen=True)
class Paths:
    """The ways of N rays, in P pieces: from surface to surface, and of each leaf the last one, on which it runs on.

    A piece has two vertices or, in a graded medium, many; there are V of them in all, those of piece ``i`` in the rows
    ``start[i]`` to ``start[i + 1]`` of ``vertex``. Branches that split go on in pieces that have one ``parent``.
    """

    #: The number of the ray that each piece is of, counted from 0; (P,), ``uint32``.
    ray: NDArray[np.uint32]
    #: Its share of the power of its ray where it starts; (P,), or (P, 2) for two polarizations.
    power: NDArray[np.float64]
    #: The place among the leaves of `Traced` of the one that runs on along it, else -1; (P,), ``int64``.
    leaf: NDArray[np.int64]
    #: The place among the pieces of the one from whose end it goes on, -1 for that from the ray's origin; (P,), ``int64``.
    parent: NDArray[np.int64]
    #: Where its vertices begin; (P + 1,), ``int64``, the last one being V.
    start: NDArray[np.int64]
    #: The vertices, cm; (V, 3).
    vertex: NDArray[np.float64]
    #: The optical path from the ray's origin to each vertex, cm; (V,).
    optical_path: NDArray[np.float64]

    def __len__(self) -> int:
        """How many pieces there are."""
        return len(self.ray)

    def segments(self, plane: str = "xy") -> list[NDArray[np.float64]]:
        """The pieces as lines, as matplotlib's ``LineCollection`` takes them.

        Parameters
        ----------
        plane : str, default "xy"
            The coordinates wanted, in their order: ``"xy"``, ``"zy"``, or ``"xyz"`` for a ``Line3DCollection``.

        Returns
        -------
        list of array
            One array for each piece, (vertices, coordinates), cm.

        Examples
        --------
        >>> from cloakroom import Scene, SquareCloak, trace
        >>> paths = trace(Scene(devices=SquareCloak()), [-20, 3, 0], [1, 0, 0], paths=True, reach=10).paths
        >>> [segment.shape for segment in paths.segments("xy")]
        [(2, 2), (2, 2), (2, 2), (2, 2)]
        """
        if not isinstance(plane, str):
            raise TypeError(f"plane is a {type(plane).__name__}; expected letters such as 'xy'")
        if not plane or any(letter not in "xyz" for letter in plane):
            raise ValueError(f"plane is {plane!r}; expected coordinates in their order, such as 'xy', 'zy' or 'xyz'")
        columns = self.vertex[:, ["xyz".index(letter) for letter in plane]]
        return np.split(columns, self.start[1:-1]) if len(self) else []

    def to_leaf(self, leaf: int) -> NDArray[np.float64]:
        """The whole way of a leaf: from the ray's origin along all pieces, to the end of its own.

        Parameters
        ----------
        leaf : int
            The place of the leaf among those of `Traced`.

        Returns
        -------
        array, (vertices, 3)
            The vertices, cm.

        Raises
        ------
        IndexError
            If no piece is that of such a leaf.
        """
        found = np.flatnonzero(self.leaf == leaf)
        if leaf < 0 or len(found) == 0:
            raise IndexError(f"leaf is {leaf}; there are paths of {int((self.leaf >= 0).sum())} leaves")
        pieces = [int(found[0])]
        while self.parent[pieces[-1]] >= 0:
            pieces.append(int(self.parent[pieces[-1]]))
        return np.concatenate([self.vertex[self.start[piece] : self.start[piece + 1]] for piece in reversed(pieces)])

    def __repr__(self) -> str:
        return f"<Paths: {len(self)} pieces with {len(self.vertex)} vertices>"


@dataclass(frozen=True)
class Traced:
    """What became of N rays. A leaf is a branch of a ray that has left every device; there are M of them in all.

    The leaves stand ray by ray, the strongest of each first. For every ray, the powers of its leaves, ``absorbed`` and
    ``pruned`` add up to 1. Of rays with two polarizations, powers and fields have an axis of 2 for them after the
    first: ``electric_field[m].T`` are the columns of a Jones matrix in three dimensions.
    """

    #: The number of the ray that each leaf is of, counted from 0; (M,), ``uint32``.
    ray: NDArray[np.uint32]
    #: The last point at which each leaf left a device, cm; (M, 3), NaN where it met none.
    position: NDArray[np.float64]
    #: Its direction, a unit vector; (M, 3).
    direction: NDArray[np.float64]
    #: Its share of the power of its ray; (M,), or (M, 2).
    power: NDArray[np.float64]
    #: Optical path length from the ray's origin to ``position``, cm; (M,), 0 where it met no device. The phase path:
    #: negative in media of negative index.
    optical_path: NDArray[np.float64]
    #: Its electric field, with the phases of the interfaces but not of the way; (M, 3) or (M, 2, 3), complex, |E|² = ``power``.
    electric_field: NDArray[np.complex128]
    #: The share of power absorbed, by media or on opaque bodies, for each ray; (N,) or (N, 2).
    absorbed: NDArray[np.float64]
    #: The share of power in branches too weak to follow, for each ray; (N,) or (N, 2).
    pruned: NDArray[np.float64]
    #: The speed of light times what a pulse takes from the ray's origin to ``position``, cm; (M,), 0 where it met no
    #: device, NaN behind media that absorb. ``None`` if it was not asked for.
    group_path: NDArray[np.float64] | None = None
    #: The ways of the rays, if they were asked for.
    paths: Paths | None = None

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
        """The share of power in leaves, for each ray; (N,) or (N, 2)."""
        sums = np.zeros_like(self.absorbed)
        np.add.at(sums, self.ray, self.power)
        return sums

    def __repr__(self) -> str:
        return f"<Traced: {len(self)} rays with {len(self.ray)} leaves>"


def trace(
    scene: Scene,
    origins: ArrayLike,
    directions: ArrayLike,
    polarization: Literal["horizontal", "vertical", "both"] | ArrayLike = "horizontal",
    *,
    min_power: float | None = None,
    paths: bool = False,
    reach: float = 100.0,
    pick: int | np.random.Generator | None = None,
    coherent: bool = False,
    group_delay: bool = False,
    progress: Progress = False,
) -> Traced:
    """Traces rays through the devices of a scene, on all cores. The photograph and the camera play no part.

    The devices are built at the first call for a scene and kept.

    Parameters
    ----------
    scene : Scene
        The scene.
    origins : array_like, (N, 3) or (3,)
        Where the rays start, cm, in air or another medium; one place stands for all rays.
    directions : array_like, (N, 3) or (3,)
        Where they go, of any length; one direction stands for all rays.
    polarization : {"horizontal", "vertical", "both"} or complex array_like, (N, 3), (3,) or (N, 2, 3), default "horizontal"
        E in the plane of the ray and z (along x for a ray along z), or perpendicular to both; or the electric fields
        themselves, across the rays and of any norm. ``"both"``, and two fields a ray, trace two polarizations in one
        tree, which gives both columns of Jones matrices.
    min_power : float, optional
        Branches below this share of a ray's power are pruned; by default what the scene's ``trace.min_power`` says,
        else 1e-9, or 1e-24 if `coherent`.
    paths : bool, default False
        Keep the ways of the rays, `Traced.paths`.
    reach : float, default 100
        How far the paths of leaves are followed beyond the devices, cm.
    pick : int or numpy.random.Generator, optional
        Keep one leaf of each ray, drawn with a probability of its power (of two polarizations the mean), or none with
        that of what is absorbed or pruned: a leaf stands for all of a ray's power then, and means over many rays are
        those over all leaves. The same seed draws the same leaves, on any number of threads; a generator gives one
        number for it.
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
    >>> trace(scene, [-100, 3, 0], [1, 0, 0], "both").power.round(6)
    array([[1., 1.]])
    """
    if not isinstance(scene, Scene):
        raise TypeError(f"scene is a {type(scene).__name__}; expected a Scene")
    start, along = vectors("origins", origins), vectors("directions", directions)
    word, fields = "horizontal", None
    if isinstance(polarization, str):
        if polarization not in ("horizontal", "vertical", "both"):
            raise ValueError(
                f'polarization is "{polarization}"; expected "horizontal", "vertical", "both" or electric fields (N, 3)'
            )
        word = polarization
    else:
        fields = _fields(polarization)
    if min_power is not None:
        if not isinstance(min_power, (int, float, np.floating, np.integer)):
            raise TypeError(f"min_power is a {type(min_power).__name__}; expected a number from 0 to 1")
        if not 0 <= min_power <= 1:
            raise ValueError(f"min_power is {min_power}; expected a number from 0 to 1")
        min_power = float(min_power)
    if not isinstance(reach, (int, float, np.floating, np.integer)):
        raise TypeError(f"reach is a {type(reach).__name__}; expected a length in cm")
    if not 0 < reach < float("inf"):
        raise ValueError(f"reach is {reach} cm; it must be above 0 and finite")
    if paths and (coherent or pick is not None):
        other = "coherent" if coherent else "pick"
        raise ValueError(f"paths does not go with {other}: paths are of all branches, each by itself")
    given = {"origins": start, "directions": along}
    if fields is not None:
        given["polarization"] = fields
    count = common_length({name: len(array) for name, array in given.items()})
    spread = {name: np.broadcast_to(array, (count, *array.shape[1:])) for name, array in given.items()}
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
            _seed(pick),
            float(reach) if paths else None,
            tell,
        )
    ways = arrays.pop("paths", None)
    return Traced(**arrays, paths=None if ways is None else Paths(**ways))


def _fields(given: Any) -> NDArray[Any]:
    """Electric fields as an array of shape (N, 1, 3) or (N, 2, 3)."""
    expected = "numbers, real or complex, of the shape (N, 3), (3,) or (N, 2, 3)"
    array = numbers("polarization", given, expected, allow_complex=True)
    if array.shape == (3,):
        array = array.reshape(1, 3)
    if array.ndim == 2 and array.shape[1] == 3:
        array = array[:, None]
    if array.ndim != 3 or array.shape[1] not in (1, 2) or array.shape[2] != 3:
        raise ValueError(f"polarization has the shape {array.shape}; expected {expected}")
    return array


def _seed(pick: Any) -> int | None:
    """The seed by which leaves are drawn."""
    if pick is None:
        return None
    if isinstance(pick, np.random.Generator):
        return int(pick.integers(2**64, dtype=np.uint64))
    if isinstance(pick, bool) or not isinstance(pick, (int, np.integer)):
        raise TypeError(f"pick is a {type(pick).__name__}; expected a numpy.random.Generator or a seed")
    if not 0 <= pick < 2**64:
        raise ValueError(f"pick is {pick}; a seed is a whole number from 0 to 2**64 - 1")
    return int(pick)
