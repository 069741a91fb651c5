"""Devices for renderers of others: rays in, what leaves the devices out."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _cloakroom
from ._arrays import common_length, numbers
from .scenes import Scene
from .tables import Device

__all__ = ["Bounds", "Outline", "Scattered", "Scatterer"]

#: What became of a ray, `Scattered.status`.
MISSED, LEFT, ENDED, ABSORBED, REFUSED = range(5)

#: How far a matrix may be from a rotation; single precision is nearer.
RIGID = 1e-5



@dataclass(frozen=True)
class Scattered:
    """What became of N rays, in the frame and the unit of the `Scatterer`: of each one row or, if all leaves were asked
    for, one for each leaf, M in all.

    Numbers are of the type that the rays were given in.
    """

    #: The number of the ray that each row is of, counted from 0; (M,), ``uint32``.
    ray: NDArray[np.uint32]
    #: What became of it; (M,), ``uint8``: `MISSED` (0), it has met no device and goes on as it came; `LEFT` (1), the
    #: leaf has left the devices; `ENDED` (2), the leaf ends on an opaque body; `ABSORBED` (3), nothing leaves; `REFUSED`
    #: (4), it is no ray, for a number is not finite, the direction is zero, `u` is not from 0 to 1, or it starts in metal
    #: or an opaque body.
    status: NDArray[np.uint8]
    #: Whether it goes on along the ray's own line; (M,).
    straight: NDArray[np.bool_]
    #: Where the leaf has left the devices, else where the ray has started; (M, 3).
    position: NDArray[Any]
    #: Its direction, a unit vector; (M, 3).
    direction: NDArray[Any]
    #: What the leaf is to be weighed with in unpolarized light; (M,). A drawn one stands for all of them and for what
    #: was pruned: what has not been absorbed on its way, so 1 in devices that absorb nothing; else its share of the
    #: power. 0 where nothing goes on.
    weight: NDArray[Any]
    #: With which probability the leaf was drawn, what is pruned being among what may be: times ``weight`` it is its
    #: share of the power; (M,).
    probability: NDArray[Any]
    #: How much of the ray's power, unpolarized, goes on along the ray's own line in all leaves together; (M,). Of a
    #: drawn leaf what it says, its weight or 0: the mean of many draws is that.
    transmitted: NDArray[Any]
    #: The share of power in branches too weak to follow; (M,). Where a leaf is drawn, what the first way says that was
    #: drawn, all or nothing of what it carries: the mean of many draws is that.
    pruned: NDArray[Any]
    #: Optical path length from the ray's origin to ``position``; (M,).
    optical_path: NDArray[Any]
    #: A fingerprint of the surfaces that the leaf has met and the branches it took; (M,), ``uint64``.
    path: NDArray[np.uint64]
    #: The number of the opaque body on which the leaf ends, else -1; (M,), ``int32``.
    body: NDArray[np.int32]
    #: The electric fields of the leaf for both fields of the ray, the columns of a Jones matrix in three dimensions; (M,
    #: 2, 3), complex. ``None`` if they were not asked for.
    electric_field: NDArray[np.complex128] | None = None

    def __repr__(self) -> str:
        return f"<Scattered: {len(self.status)} rows>"


@dataclass(frozen=True)
class Bounds:
    """The space that a device takes up: a box, or the ball in it, in a frame of its own."""

    #: From its frame to that of the `Scatterer`; (4, 4), without the unit.
    to_world: NDArray[np.float64]
    #: The least coordinates in its frame; (3,).
    low: NDArray[np.float64]
    #: The greatest; (3,).
    high: NDArray[np.float64]
    #: Whether it is a ball.
    ball: bool


@dataclass(frozen=True)
class Outline:
    """What a part of a device looks like from outside."""

    #: Which device it is, and its kind.
    name: str
    #: What it is of.
    matter: Literal["medium", "metal", "polarizer", "opaque"]
    #: The corners of its triangles, counterclockwise as seen from outside; (T, 3, 3).
    triangles: NDArray[np.float64]


class Scatterer:
    """Devices at a place in the world of a renderer, as a black box: rays go in, and what leaves comes out.

    The devices are built once. A scatterer may be used by several threads.

    Parameters
    ----------
    devices : Scene, device, mapping or iterable of them
        The devices; of a scene those of it, with its light and its tolerance.
    to_world : array_like, (4, 4), optional
        Where they stand: a rotation and a shift, which takes the frame of the devices, in the world's unit, to the
        world. What rounding has left of it is made a rotation in double precision.
    unit : float, default 1
        How many cm the world's unit of length is: 100 for a world in metres.
    min_power : float, default 1e-4
        Branches below this share of a ray's power are pruned.

    Raises
    ------
    TypeError, ValueError
        If the devices are none, overlap, or a number does not fit.

    Examples
    --------
    >>> from cloakroom import Scatterer, SphereCloak
    >>> cloak = Scatterer(SphereCloak(), unit=100)
    >>> scattered = cloak.scatter([[-1, 0.05, 0], [-1, 0.5, 0]], [1, 0, 0], u=[0.3, 0.7])
    >>> scattered.status, scattered.straight, scattered.weight
    (array([1, 0], dtype=uint8), array([ True,  True]), array([1., 1.]))
    """

    def __init__(
        self,
        devices: Scene | Device | Mapping[str, Any] | Iterable[Device | Mapping[str, Any]],
        *,
        to_world: ArrayLike | None = None,
        unit: float = 1.0,
        min_power: float = 1e-4,
    ) -> None:
        self.scene = devices if isinstance(devices, Scene) else Scene(devices=devices)
        if not self.scene.devices:
            raise ValueError("devices is empty; a scatterer is made of one device at least")
        self.unit = _number("unit", unit)
        if not 0 < self.unit < np.inf:
            raise ValueError(f"unit is {unit} cm; it must be above 0 and finite")
        self.min_power = _number("min_power", min_power)
        if not 0 <= self.min_power <= 1:
            raise ValueError(f"min_power is {min_power}; expected a number from 0 to 1")
        self.to_world = rigid("to_world", np.eye(4) if to_world is None else to_world)
        self._rotation = np.ascontiguousarray(self.to_world[:3, :3])
        self._place = np.ascontiguousarray(self.to_world[:3, 3])
        self.scene._native.check()

    def scatter(
        self,
        origins: ArrayLike,
        directions: ArrayLike,
        u: ArrayLike | None = None,
        *,
        fields: ArrayLike | bool = False,
    ) -> Scattered:
        """What becomes of rays. No ray is an error: each has a status.

        Rays in ``float32`` give numbers in ``float32``, all others ``float64``; in between all is ``float64``.

        Parameters
        ----------
        origins : array_like, (N, 3) or (3,)
            Where the rays start; one place stands for all rays.
        directions : array_like, (N, 3) or (3,)
            Where they go, of any length; one direction stands for all rays.
        u : array_like, (N,) or number, optional
            Numbers from 0 to 1, by which one leaf of each ray is drawn with a probability of its power; only the way to
            it is traced. Without them all leaves are given, the strongest of each ray first.
        fields : bool or complex array_like, (N, 2, 3), default False
            Whether the electric fields of the leaves are wanted; or two fields across each ray, of unit norm, instead of
            those in the plane of the ray and z, and perpendicular to it.

        Returns
        -------
        Scattered
            What became of them.
        """
        start, along = _triples("origins", origins), _triples("directions", directions)
        draws = None if u is None else np.atleast_1d(_reals("u", u, "numbers from 0 to 1, of the shape (N,)"))
        if draws is not None and draws.ndim != 1:
            raise ValueError(f"u has the shape {draws.shape}; expected numbers from 0 to 1, of the shape (N,)")
        given = {"origins": start, "directions": along}
        if draws is not None:
            given["u"] = draws
        # Single precision only if all are: a double among them is not thrown away.
        single = all(array.dtype == np.float32 for array in given.values())
        given = {name: array.astype(np.float32 if single else np.float64, copy=False) for name, array in given.items()}
        if not isinstance(fields, (bool, np.bool_)):
            expected = "numbers, real or complex, of the shape (N, 2, 3)"
            given["fields"] = numbers("fields", fields, expected, allow_complex=True)
            if given["fields"].ndim != 3 or given["fields"].shape[1:] != (2, 3):
                raise ValueError(f"fields has the shape {given['fields'].shape}; expected {expected}")
        count = common_length({name: len(array) for name, array in given.items()})
        spread = {
            name: array if len(array) == count else np.broadcast_to(array, (count, *array.shape[1:]))
            for name, array in given.items()
        }
        arrays = _cloakroom.scatter(
            self.scene._native,
            spread["origins"],
            spread["directions"],
            spread.get("u"),
            spread.get("fields"),
            bool(fields) if isinstance(fields, (bool, np.bool_)) else True,
            self._rotation,
            self._place,
            self.unit,
            self.min_power,
        )
        if draws is not None:
            arrays["ray"] = np.arange(count, dtype=np.uint32)
        return Scattered(**arrays)

    @property
    def bounds(self) -> tuple[Bounds, ...]:
        """The space that each device takes up.

        Raises
        ------
        ValueError
            If a device is endless: it needs a ``length``.
        """
        found = []
        for frame, low, high, ball in _cloakroom.device_bounds(self.scene._native, self.unit):
            to_world = self.to_world @ np.vstack([frame, [0, 0, 0, 1]])
            found.append(Bounds(to_world, np.array(low), np.array(high), ball))
        return tuple(found)

    def outlines(self) -> tuple[Outline, ...]:
        """What the devices look like from outside, in the frame of the world; curved surfaces are cut into flat pieces.

        Raises
        ------
        ValueError
            If a device is endless: it needs a ``length``.
        """
        found = []
        for name, matter, rows in _cloakroom.outline_meshes(self.scene._native, self.unit):
            corners = rows.reshape(-1, 3, 3) @ self._rotation.T + self._place
            found.append(Outline(name, matter, corners))
        return tuple(found)

    def __repr__(self) -> str:
        kinds = ", ".join(device.kind for device in self.scene.devices)
        return f"<Scatterer: {kinds}>"


def rigid(name: str, given: ArrayLike) -> NDArray[np.float64]:
    """A rotation and a shift, (4, 4), made exact in double precision from what is nearly so."""
    expected = "a rotation and a shift of the shape (4, 4)"
    matrix: NDArray[np.float64] = numbers(name, given, expected)
    if matrix.shape != (4, 4):
        raise ValueError(f"{name} has the shape {matrix.shape}; expected {expected}")
    if not np.isfinite(matrix).all() or np.abs(matrix[3] - [0, 0, 0, 1]).max() > RIGID:
        raise ValueError(f"{name} is no rotation and shift: its last row must be 0, 0, 0, 1, and its numbers finite")
    turn = matrix[:3, :3]
    if np.abs(turn.T @ turn - np.eye(3)).max() > RIGID:
        raise ValueError(f"{name} scales or shears; a device is given its size by its keys, and the world's by `unit`")
    if np.linalg.det(turn) < 0:
        raise ValueError(f"{name} mirrors; a device can be turned and shifted only")
    u, _, v = np.linalg.svd(turn)
    exact = np.eye(4)
    exact[:3, :3] = turn if np.array_equal(turn.T @ turn, np.eye(3)) else u @ v
    exact[:3, 3] = matrix[:3, 3]
    return exact


def _number(name: str, given: Any) -> float:
    if isinstance(given, bool) or not isinstance(given, (int, float, np.floating, np.integer)):
        raise TypeError(f"{name} is a {type(given).__name__}; expected a number")
    return float(given)


def _reals(name: str, given: ArrayLike, expected: str) -> NDArray[Any]:
    if isinstance(given, np.ndarray) and given.dtype in (np.float32, np.float64):
        return given
    return numbers(name, given, expected)


def _triples(name: str, given: ArrayLike) -> NDArray[Any]:
    expected = "real numbers of the shape (N, 3) or (3,)"
    array = _reals(name, given, expected)
    if array.shape == (3,):
        return array.reshape(1, 3)
    if array.ndim != 2 or array.shape[1] != 3:
        raise ValueError(f"{name} has the shape {array.shape}; expected {expected}")
    return array
