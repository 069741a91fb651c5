"""Numbers for what pictures show: likeness, sweeps of settings, light on a receiver, the paper's statements."""

from __future__ import annotations

import json
import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _cloakroom
from ._arrays import check_listed, image_of, is_image_array, numbers
from ._progress import Progress, told
from .labelled import Arrays
from .pictures import Picture
from .scenes import Scene

__all__ = ["Finding", "flux", "quality", "sweep", "verify"]

#: A picture: rendered, an array as a photograph is given, or a file.
PictureLike = Picture | ArrayLike | str | os.PathLike[str]


def _viewed(name: str, picture: Any) -> Any:
    if isinstance(picture, Picture):
        return dict(picture)
    if isinstance(picture, (str, os.PathLike)):
        return os.fspath(picture)
    if is_image_array(picture):
        return image_of(name, picture)
    raise TypeError(f"{name} is a {type(picture).__name__}; expected a Picture, an array or a path")


def quality(
    first: PictureLike,
    second: PictureLike,
    region: ArrayLike | None = None,
) -> dict[str, Any]:
    """How alike two pictures of one size are.

    Parameters
    ----------
    first, second : Picture, array_like or path
        The pictures: rendered ones, arrays as photographs are given, or files (``.png``, ``.exr``, ``.npz``).
    region : array_like, optional
        The part to be looked at besides the whole: a mask of bools, (height, width), or left, top, width and height
        in pixels.

    Returns
    -------
    dict
        What ``cloakroom compare --json`` prints: ``width_pixels``, ``height_pixels``, and for ``picture`` and
        ``region`` (``None`` if none is given) ``pixels``, ``correlation`` (red, green, blue; ``None`` without
        contrast), ``correlation_maximum`` over shifts, ``rms_difference`` in linear light, ``structural_similarity``
        (SSIM), ``flip`` (FLIP), ``time_of_flight_difference`` and ``delivered`` where the pictures have them.

    Raises
    ------
    TypeError, ValueError
        If a picture is none, cannot be read, or is not of the size of the other; if the region is empty.

    Examples
    --------
    >>> import numpy as np
    >>> from cloakroom import quality
    >>> gray, white = np.full((16, 16), 0.5), np.ones((16, 16))
    >>> quality(gray, white)["picture"]["rms_difference"]
    [0.5, 0.5, 0.5]
    """
    mask: NDArray[np.bool_] | None = None
    rectangle: list[int] | None = None
    if region is not None:
        expected = "a mask of bools, (height, width), or left, top, width, height"
        part = np.asarray(region)
        if part.dtype == np.bool_ and part.ndim == 2:
            mask = part
        elif part.dtype.kind in "iu" and part.shape == (4,):
            if (part < 0).any():
                raise ValueError(f"region is {part.tolist()}; none of its numbers may be negative")
            rectangle = [int(side) for side in part]
        elif part.dtype.kind in "biuf":
            raise ValueError(f"region has the shape {part.shape} of {part.dtype}; expected {expected}")
        else:
            raise TypeError(f"region is of the type {part.dtype}; expected {expected}")
    text = _cloakroom.quality(_viewed("first", first), _viewed("second", second), mask, rectangle)
    compared: dict[str, Any] = json.loads(text)
    return compared


def sweep(
    scene: Scene,
    keys: Mapping[str, Sequence[Any] | NDArray[Any]],
    path: str | os.PathLike[str] | None = None,
    *,
    reference: Scene | None = None,
    progress: Progress = False,
) -> Arrays:
    """Measures how well the devices of a scene work, for every combination of the values of some keys.

    Parameters
    ----------
    scene : Scene
        The scene.
    keys : mapping of str to sequence
        The values that each key takes, as `Scene.replace` takes it: ``{"device.0.rotation": range(0, 91, 5)}``.
    path : path, optional
        A file for the table (``.csv``, ``.npz``) or a plot (``.svg``, ``.pdf``, ``.png``).
    reference : Scene, optional
        A scene whose devices show what should be seen, as a flat floor for a carpet of one's own; else a cloak's flat
        mirror, or nothing.
    progress : bool or callable, default False
        ``True`` for a line on standard error, or a function that is called with the steps done and all steps.

    Returns
    -------
    Arrays, a dict of str to array
        For every key its values, and for every figure its numbers, each of the shape of the grid of combinations:
        (len of the first key's values, ...). Values that are lists stand in an array of objects. The figures are those
        of ``cloakroom quality``, NaN where there is none. Its ``to_xarray()`` has the keys as coordinates, lists as
        texts.

    Raises
    ------
    TypeError, ValueError
        If a key does not exist, a value does not fit, or there are none; if the file's ending is another.
    OSError
        If the file cannot be written; this is told before the work where it can be.
    """
    if not isinstance(scene, Scene):
        raise TypeError(f"scene is a {type(scene).__name__}; expected a Scene")
    if not isinstance(keys, Mapping):
        raise TypeError(f"keys is a {type(keys).__name__}; expected a mapping of keys to lists of values")
    if reference is not None and not isinstance(reference, Scene):
        raise TypeError(f"reference is a {type(reference).__name__}; expected a Scene")
    values = {key: _values(key, given) for key, given in keys.items()}
    file = None if path is None else os.fspath(path)
    with told(progress, "measuring") as tell:
        wanted = None if reference is None else reference._native
        table = json.loads(_cloakroom.sweep(scene._native, list(values.items()), wanted, file, tell))
    shape = tuple(len(given) for given in values.values())
    along = {key: _array(given) for key, given in values.items()}
    grids = np.meshgrid(*along.values(), indexing="ij") if along else []
    columns: dict[str, NDArray[Any]] = dict(zip(along, grids))
    for column in table["columns"]:
        name = column["name"]
        figures = [row["figures"][name] for row in table["rows"]]
        columns[name] = np.array([np.nan if f is None else f for f in figures], dtype=np.float64).reshape(shape)
    axes = {name: tuple(values) for name in columns}
    return Arrays(columns, axes, along)


#: Nobody waits for more.
_MOST_VALUES = 1_000_000


def _values(key: str, given: Any) -> list[Any]:
    check_listed(key, given, "a list of values")
    if len(given) > _MOST_VALUES:
        raise ValueError(f"keys[{key!r}] has {len(given)} values; at most {_MOST_VALUES} are taken")
    values = given.tolist() if isinstance(given, np.ndarray) else list(given)
    if not values:
        raise ValueError(f"keys[{key!r}] is empty; expected one value at least")
    if key.endswith(".image") and any(is_image_array(value) for value in values):
        raise TypeError(f"keys[{key!r}] holds arrays; expected names of files, or measure each scene.replace(...) by itself")
    return values


def _array(values: list[Any]) -> NDArray[Any]:
    """Values along one axis; lists are objects in it."""
    if not any(isinstance(value, (list, tuple, dict, np.ndarray)) for value in values):
        return np.asarray(values)
    array = np.empty(len(values), dtype=object)
    array[:] = values
    return array


def flux(
    scene: Scene,
    angles: ArrayLike | None = None,
    *,
    tilt: float = 0.0,
    sun: tuple[float, float] | None = None,
    rays: int = 4096,
    samples: int = 8,
    cells: int = 60,
    path: str | os.PathLike[str] | None = None,
    progress: Progress = False,
) -> Arrays:
    """Measures how much light comes through to the scene's receiver: for no device, for the bare metal, for the cloak.

    Parameters
    ----------
    scene : Scene
        The scene; its table `Receiver` is the plane.
    angles : array_like, (D,), optional
        Angles of incidence in the plane across z, degrees; -60 to 60 in steps of 10 if not given.
    tilt : float, default 0
        Degrees by which that plane is tilted along the receiver.
    sun : (float, float), optional
        Latitude and declination (23.44 at midsummer in the north), degrees: the sun over a day instead of ``angles``.
    rays, samples, cells : int, default 4096, 8, 60
        Rays of each of the independent samples that errors come from; how many samples; cells of the map across.
    path : path, optional
        An ``.npz`` for the arrays.
    progress : bool or callable, default False
        ``True`` for a line on standard error, or a function that is called with the steps done and all steps.

    Returns
    -------
    Arrays, a dict of str to array
        ``label`` (angle or hour), ``incidence_deg`` and ``direction`` of each of D directions; ``total`` and
        ``total_error``, (D, 3, 3): irradiance for nothing, bare, cloaked, in horizontal, vertical, unpolarized light,
        that across the light being 1; ``given_back_percent`` and its error, (D, 3), NaN without a shadow; ``map``, (D,
        3, along, across), with the middles of its cells in ``along`` and ``across`` (cm); and the convergence:
        ``rays``, ``cloaked_by_rays``, ``given_back_by_rays`` and their errors, (D, steps).

    Raises
    ------
    TypeError, ValueError
        If the scene has no device, the receiver is not behind the devices, or a number is out of its limits; if the
        file's ending is another.
    OSError
        If the file cannot be written; this is told before the work where it can be.
    """
    if not isinstance(scene, Scene):
        raise TypeError(f"scene is a {type(scene).__name__}; expected a Scene")
    if sun is not None:
        if angles is not None:
            raise ValueError("angles and sun are both given; expected one of them")
        place = numbers("sun", sun, "a latitude and a declination in degrees")
        if place.shape != (2,) or not (np.abs(place) <= 90).all():
            raise ValueError(f"sun is {sun}; expected a latitude and a declination from -90 to 90 degrees")
        sun = (float(place[0]), float(place[1]))
    listed = numbers("angles", np.arange(-60, 61, 10) if angles is None else angles, "angles in degrees, (D,)")
    if listed.ndim != 1 or listed.size == 0 or not np.isfinite(listed).all():
        raise ValueError(f"angles has the shape {listed.shape}; expected finite angles in degrees, (D,), one at least")
    counts = {"rays": rays, "samples": samples, "cells": cells}
    for name, count in counts.items():
        if not isinstance(count, (int, np.integer)):
            raise TypeError(f"{name} is a {type(count).__name__}; expected a whole number")
        if not 0 <= count < 2**32:
            raise ValueError(f"{name} is {count}; expected a whole number that fits into 32 bits")
    if not np.isfinite(tilt):
        raise ValueError(f"tilt is {tilt}; expected a finite angle in degrees")
    file = None if path is None else os.fspath(path)
    if file is not None and not file.lower().endswith(".npz"):
        raise ValueError(f"path is {file!r}; expected the name of an .npz")
    with told(progress, "tracing") as tell:
        arrays = _cloakroom.flux(
            scene._native,
            listed.tolist(),
            float(tilt),
            sun,
            [int(count) for count in counts.values()],
            file,
            tell,
        )
    light = (("device", ["none", "bare", "cloaked"]), ("polarization", ["horizontal", "vertical", "unpolarized"]))
    axes: dict[str, tuple[str, ...]] = {name: ("incidence", "step")[: array.ndim] for name, array in arrays.items()}
    axes |= dict.fromkeys(("total", "total_error"), ("incidence", "device", "polarization"))
    axes |= dict.fromkeys(("given_back_percent", "given_back_error"), ("incidence", "polarization"))
    axes |= {"map": ("incidence", "device", "along", "across"), "along": ("along",), "across": ("across",)}
    axes["direction"] = ("incidence", "coordinate")
    return Arrays(arrays, axes, {name: np.array(words) for name, words in light})


@dataclass(frozen=True)
class Finding:
    """A statement of the paper, and what comes out here."""

    #: Where it stands in the paper.
    place: str
    #: Its gist.
    statement: str
    #: What was computed, in words and numbers.
    computed: str
    #: Whether it holds.
    verdict: Literal[
        "agrees",
        "agrees_closely",
        "agrees_in_order_of_magnitude",
        "depends_on_tolerance",
        "differs",
    ]
    #: A word why, where it does not quite; else empty.
    remark: str
    #: By how much a number is off the one that is printed, or beyond the limit that is stated, as a share of that;
    #: 0 where it agrees, None where the statement has no number.
    relative_deviation: float | None


def verify(*, progress: Progress = False) -> list[Finding]:
    """Goes through the statements of Halimeh & Wegener, Opt. Express 21, 9457 (2013), one by one; takes a minute.

    Parameters
    ----------
    progress : bool or callable, default False
        ``True`` for a line on standard error, or a function that is called with the steps done and all steps.

    Returns
    -------
    list of Finding
        In the order of the paper.
    """
    with told(progress, "verifying") as tell:
        return [Finding(**finding) for finding in json.loads(_cloakroom.verify(tell))]
