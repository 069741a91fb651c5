"""The shape that bounds a device, with the device on it."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..scatterers import Scatterer, rigid
from ..scenes import Scene
from ..tables import Device

__all__ = ["MARGIN", "MIN_POWER", "Box", "box_of", "device", "keys_of", "scatterer_of"]

#: How far a bounding shape goes beyond its device, as a share of its size: rays are single numbers outside.
MARGIN = 1e-4

#: Weaker branches of a ray's tree are pruned, and what they carry is given to the others.
MIN_POWER = 1e-3


def device(
    given: Device | Mapping[str, Any],
    to_world: Any = None,
    *,
    unit: float = 1.0,
    wavelength_nm: float | None = None,
    wavelengths: int = 1,
    see_through: str = "auto",
    min_power: float = MIN_POWER,
) -> dict[str, Any]:
    """A device as a shape for ``mitsuba.load_dict``: the least box or ball around it, with the BSDF ``cloakroom`` on it.

    Parameters
    ----------
    given : device or mapping
        A device, ``SquareCloak(length=40)``, its kind and keys, or ``{"scene": name}`` of a scene file.
    to_world : transform or array_like, (4, 4), optional
        Where it stands: a rotation and a shift. The device's own frame is x forward, y up, z right.
    unit : float, default 1
        How many cm the scene's unit of length is: 100 for a scene in metres.
    wavelength_nm : float, optional
        The wavelength in vacuum at which the device is traced, for all colors: by default 550, or that of the scene file.
    wavelengths : int, default 1
        In spectral variants, at how many wavelengths it is traced instead: at the middles of so many equal bins from 400
        to 700 nm, so that its materials show their colors. A path that meets it goes on with one of its wavelengths.
    see_through : {"auto", "yes", "no"}, default "auto"
        Whether shadow rays go through the device, on as far as its leaves go on along their line. ``"auto"`` lets them
        where nearly all leaves do, or where a lamp is a point or the sun, whose light no other ray finds.
    min_power : float, default 1e-3
        Branches within the device below this share of a ray's power are pruned.

    Returns
    -------
    dict
        The shape. In XML it reads the same: see the book.

    Raises
    ------
    ValueError
        If the device does not fit, or is endless: a cloak along an axis needs a ``length``.
    """
    import mitsuba as mi

    matrix = rigid("to_world", np.eye(4) if to_world is None else _matrix(to_world))
    listed = {"kind": given.kind, **given.given()} if isinstance(given, Device) else dict(given)
    of_light = wavelength_nm is not None
    nm = 550.0 if wavelength_nm is None else float(wavelength_nm)
    scatterer = scatterer_of(listed, matrix, unit, nm, min_power, of_light=of_light)
    words = {"scene": str(listed.pop("scene"))} if "scene" in listed else {"kind": listed.pop("kind"), "keys": _json(listed)}
    bsdf = {
        "type": "cloakroom",
        **words,
        "to_world": mi.ScalarTransform4f(matrix),
        "unit": float(unit),
        "see_through": see_through,
        "min_power": float(min_power),
    }
    if of_light:
        bsdf["wavelength_nm"] = nm
    if wavelengths != 1:
        bsdf["wavelengths"] = int(wavelengths)
    box = box_of(scatterer)
    shape = "sphere" if box.ball else "cube"
    return {"type": shape, "to_world": mi.ScalarTransform4f(box.shape()), "bsdf": bsdf}


def scatterer_of(
    keys: Mapping[str, Any],
    to_world: NDArray[np.float64],
    unit: float,
    wavelength_nm: float,
    min_power: float,
    *,
    of_light: bool = False,
) -> Scatterer:
    """The one device of a kind and keys, or the devices of the scene file ``scene``, at their place: that has a wavelength
    of its own, unless ``of_light`` says otherwise."""
    if "scene" in keys:
        if set(keys) != {"scene"}:
            raise ValueError(f"a device of a scene file has no keys of its own, but {', '.join(sorted(set(keys) - {'scene'}))}")
        scene = Scene.load(keys["scene"])
        if of_light:
            scene = scene.replace({"light.wavelength_nm": wavelength_nm})
    elif "kind" not in keys:
        raise ValueError("a device has a kind, such as sphere-cloak, or a scene, the name of a scene file")
    else:
        scene = Scene(devices=keys, light={"wavelength_nm": wavelength_nm})
    if any(getattr(device, "surface", None) is not None for device in scene.devices):
        raise ValueError("surface: an opaque body in a room is a shape of Mitsuba's own, with a BSDF of its own")
    return Scatterer(scene, to_world=to_world, unit=unit, min_power=min_power)


@dataclass(frozen=True)
class Box:
    """The least box around the devices of a scatterer, or the ball in it."""

    #: From the box's frame to the world; (4, 4), a rotation and a shift.
    to_world: NDArray[np.float64]
    #: The halves of its sides; (3,).
    halves: NDArray[np.float64]
    #: Whether it is a ball.
    ball: bool

    @property
    def extent(self) -> NDArray[np.float64]:
        """How far it reaches along the world's axes from its middle; (3,)."""
        turn = self.to_world[:3, :3]
        return np.full(3, self.halves[0]) if self.ball else np.abs(turn) @ self.halves

    def shape(self, grown: float = MARGIN) -> NDArray[np.float64]:
        """The matrix that makes Mitsuba's cube or sphere of it, grown by a share of its size."""
        matrix = self.to_world.copy()
        # What is thin has no more to lose than it has.
        matrix[:3, :3] *= np.maximum(self.halves + grown * self.halves.max(), 0)
        return matrix

    def holds(self, point: NDArray[np.float64]) -> bool:
        """Whether a point of the world, (3,), is in it."""
        local = np.abs(self.to_world[:3, :3].T @ (point - self.to_world[:3, 3]))
        return bool(np.linalg.norm(local) < self.halves[0] if self.ball else (local < self.halves).all())


def box_of(scatterer: Scatterer) -> Box:
    """The box around devices: of one in its own frame, of several in that which they share."""
    bounds = scatterer.bounds
    to_world, ball = scatterer.to_world, False
    low, high = np.full(3, np.inf), np.full(3, -np.inf)
    if len(bounds) == 1:
        to_world, low, high, ball = bounds[0].to_world, bounds[0].low, bounds[0].high, bounds[0].ball
        if not ball:
            to_world, low, high = _turned(scatterer, to_world, low, high)
    else:
        for each in bounds:
            local = np.linalg.inv(to_world) @ each.to_world
            middle = local[:3, :3] @ (each.low + each.high) / 2 + local[:3, 3]
            half = (each.high - each.low) / 2
            reach = half if each.ball else np.abs(local[:3, :3]) @ half
            low, high = np.minimum(low, middle - reach), np.maximum(high, middle + reach)
    placed = to_world.copy()
    placed[:3, 3] += to_world[:3, :3] @ (low + high) / 2
    return Box(placed, (high - low) / 2, ball)


def _turned(
    scatterer: Scatterer, to_world: NDArray[np.float64], low: NDArray[np.float64], high: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
    """The same box turned about its own z axis, if that makes it smaller: the square cloak stands on an edge."""
    corners = np.concatenate([outline.triangles.reshape(-1, 3) for outline in scatterer.outlines()])
    local = (corners - to_world[:3, 3]) @ to_world[:3, :3]
    best = (to_world, low, high)
    area = 0.99 * np.prod((high - low)[:2])
    for angle in np.radians([15, 30, 45, 60, 75]):
        turn = np.eye(4)
        turn[:2, :2] = [[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]]
        turned = local @ turn[:3, :3]
        middle, half = (turned.min(axis=0) + turned.max(axis=0)) / 2, np.ptp(turned, axis=0) / 2
        # What is round reaches beyond the pieces of its outline, 96 all around, by this.
        half[:2] /= np.cos(np.pi / 96)
        if np.prod(2 * half[:2]) < area:
            area, best = np.prod(2 * half[:2]), (to_world @ turn, middle - half, middle + half)
    return best


def _json(keys: Mapping[str, Any]) -> str:
    """Keys as JSON; numbers and arrays may be those of numpy."""

    def plain(value: Any) -> Any:
        if isinstance(value, (np.ndarray, np.generic)) and not np.iscomplexobj(value):
            return value.tolist()
        raise ValueError(f"{value!r} cannot stand among the keys of a device")

    return json.dumps(keys, default=plain)


def _matrix(given: Any) -> ArrayLike:
    """A transform of Mitsuba, or an array."""
    matrix = getattr(given, "matrix", given)
    return np.array(matrix, dtype=np.float64).reshape(4, 4)


def keys_of(properties: Mapping[str, Any]) -> dict[str, Any]:
    """The keys of a device among the plain properties of a plugin: each by its name, lists in the JSON of ``keys``."""
    keys = dict(properties)
    text = keys.pop("keys", None)
    if text is not None:
        try:
            more = json.loads(text)
        except (TypeError, json.JSONDecodeError) as error:
            raise ValueError(f'keys is no JSON object such as {{"rotation": 10}}: {error}') from None
        if not isinstance(more, dict):
            raise ValueError(f"keys is no JSON object, but {text}")
        keys.update(more)
    return keys
