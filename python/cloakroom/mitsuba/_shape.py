"""The shape that bounds a device, with the device on it."""

from __future__ import annotations

import json
from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..scatterers import Scatterer, rigid
from ..scenes import Scene
from ..tables import Device

__all__ = ["MARGIN", "bounding", "device"]

#: How far a bounding shape goes beyond its device, as a share of its size: rays are single numbers outside.
MARGIN = 1e-4


def device(
    given: Device | Mapping[str, Any],
    to_world: Any = None,
    *,
    unit: float = 1.0,
    wavelength_nm: float = 550.0,
    see_through: str = "auto",
    min_power: float = 1e-4,
) -> dict[str, Any]:
    """A device as a shape for ``mitsuba.load_dict``: the least box or ball around it, with the BSDF ``cloakroom`` on it.

    Parameters
    ----------
    given : device or mapping
        A device, ``SquareCloak(length=40)``, or its kind and keys.
    to_world : transform or array_like, (4, 4), optional
        Where it stands: a rotation and a shift. The device's own frame is x forward, y up, z right.
    unit : float, default 1
        How many cm the scene's unit of length is: 100 for a scene in metres.
    wavelength_nm : float, default 550
        The wavelength in vacuum at which the device is traced, for all colors.
    see_through : {"auto", "yes", "no"}, default "auto"
        Whether shadow rays go through the device, on as far as its leaves go on along their line. ``"auto"`` lets them
        where nearly all leaves do.
    min_power : float, default 1e-4
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
    scatterer = scatterer_of(listed, matrix, unit, wavelength_nm, min_power)
    kind = listed.pop("kind")
    bsdf = {
        "type": "cloakroom",
        "kind": kind,
        "keys": json.dumps(listed),
        "to_world": mi.ScalarTransform4f(matrix),
        "unit": float(unit),
        "wavelength_nm": float(wavelength_nm),
        "see_through": see_through,
        "min_power": float(min_power),
    }
    shape, placed = bounding(scatterer)
    return {"type": shape, "to_world": mi.ScalarTransform4f(placed), "bsdf": bsdf}


def scatterer_of(
    keys: Mapping[str, Any], to_world: NDArray[np.float64], unit: float, wavelength_nm: float, min_power: float
) -> Scatterer:
    """The one device of a kind and keys, at its place."""
    if "surface" in keys:
        raise ValueError("surface: an opaque body in a room is a shape of Mitsuba's own, with a BSDF of its own")
    scene = Scene(devices=keys, light={"wavelength_nm": wavelength_nm})
    return Scatterer(scene, to_world=to_world, unit=unit, min_power=min_power)


def bounding(scatterer: Scatterer) -> tuple[str, NDArray[np.float64]]:
    """The kind of Mitsuba's shape around the one device of a scatterer, and the matrix that places it."""
    bounds = scatterer.bounds
    if len(bounds) != 1:
        raise ValueError(f"a bounding shape is around one device; there are {len(bounds)}: take one shape for each")
    (only,) = bounds
    if only.ball:
        centre, half = (only.low + only.high) / 2, (only.high - only.low).max() / 2 * (1 + MARGIN)
        halves = np.full(3, half)
    else:
        centre, halves = (only.low + only.high) / 2, (only.high - only.low) / 2
        halves = halves + MARGIN * halves.max()
    placed = only.to_world @ np.block([[np.diag(halves), centre[:, None]], [np.zeros((1, 3)), np.ones((1, 1))]])
    return "sphere" if only.ball else "cube", placed


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
