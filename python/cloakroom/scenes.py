"""Scenes: camera, light, photograph, surroundings and devices."""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _cloakroom
from ._arrays import image_array, is_image_array
from ._progress import Progress, told
from .pictures import Picture
from .tables import DEVICES, TABLES, Device, Table

__all__ = ["Scene"]

#: A table of a scene: one of the classes, or a mapping of its keys.
TableLike = Table | Mapping[str, Any]


class Scene:
    """All that a picture depends on. A scene does not change; `replace` gives another one.

    Parameters
    ----------
    camera, light, trace, picture, receiver : table or mapping, optional
        The tables of a scene: `Camera`, `Light`, `TraceSettings`, `PictureSettings`, `Receiver`, or their keys in
        a mapping.
    photograph : table, mapping, array or path, optional
        What hangs behind the devices: a `Photograph`, or its image alone. An array is (height, width, 3) or (height,
        width), ``uint8`` in sRGB or floats in linear light, its first row on top.
    surroundings : table, mapping, array or path, optional
        What rays see that hit nothing: a `Surroundings`, an equirectangular image, or three numbers, a color in
        linear light.
    devices : device or iterable of devices, optional
        The devices: `SquareCloak` and so on, or mappings with a key ``kind``.

    Raises
    ------
    TypeError
        For arguments of a wrong type.
    ValueError
        For values that do not fit, or not together.

    Examples
    --------
    >>> from cloakroom import Camera, Scene, SquareCloak
    >>> scene = Scene(camera=Camera(resolution=[64, 48]), devices=[SquareCloak(rotation=10)])
    >>> picture = scene.render(samples=1)
    >>> picture.image.shape, picture.time_of_flight.dtype
    ((48, 64, 3), dtype('float64'))
    """

    def __init__(
        self,
        *,
        camera: TableLike | None = None,
        photograph: TableLike | ArrayLike | str | os.PathLike[str] | None = None,
        surroundings: TableLike | ArrayLike | str | os.PathLike[str] | None = None,
        light: TableLike | None = None,
        trace: TableLike | None = None,
        picture: TableLike | None = None,
        receiver: TableLike | None = None,
        devices: Device | Mapping[str, Any] | Iterable[Device | Mapping[str, Any]] = (),
    ) -> None:
        tables = {
            "camera": _table("camera", camera),
            "light": _table("light", light),
            "photograph": _table("photograph", _pictured("photograph", photograph)),
            "surroundings": _table("surroundings", _pictured("surroundings", surroundings)),
            "trace": _table("trace", trace),
            "picture": _table("picture", picture),
            "receiver": _table("receiver", receiver),
        }
        given: dict[str, Any] = {name: table.given() for name, table in tables.items() if table.given()}
        listed = [_device(i, device) for i, device in enumerate(_listed(devices))]
        if listed:
            given["device"] = listed
        self._images = (tables["photograph"]._image, tables["surroundings"]._image)
        self._overrides: list[tuple[str, Any]] = []
        self._native = _cloakroom.Scene.of_tables(given, os.getcwd(), self._images)

    @staticmethod
    def load(path: str | os.PathLike[str]) -> Scene:
        """Reads a scene file.

        Parameters
        ----------
        path : str or path
            The file; files that it names are relative to it.

        Raises
        ------
        FileNotFoundError
            If there is no such file.
        ValueError
            If it is no scene; the message points at the place.
        """
        scene = object.__new__(Scene)
        scene._images = (None, None)
        scene._overrides = []
        scene._native = _cloakroom.Scene.load(os.fspath(path))
        return scene

    def replace(self, keys: Mapping[str, Any]) -> Scene:
        """The same scene with some keys changed.

        Parameters
        ----------
        keys : mapping
            Keys as ``--set`` of the command line takes them, and their values: ``{"camera.samples": 16,
            "device.0.rotation": 5}``. Files are relative to the working folder.

        Raises
        ------
        ValueError
            If there is no such key, or the value does not fit.

        Examples
        --------
        >>> from cloakroom import Scene, SquareCloak
        >>> scene = Scene(devices=SquareCloak())
        >>> print(scene.replace({"device.0.rotation": 5}).toml)
        [[device]]
        kind = "square-cloak"
        rotation = 5
        <BLANKLINE>
        """
        if not isinstance(keys, Mapping):
            raise TypeError(f"keys is a {type(keys).__name__}; expected a mapping of keys to values")
        images = list(self._images)
        added = []
        for key, value in keys.items():
            if not isinstance(key, str):
                raise TypeError(f"keys has the key {key!r}; expected texts such as 'camera.samples'")
            if key.rpartition(".")[2] == "image" and value is not None:
                value = self._placed_image(key, value, images)
            added.append((key, value))
        scene = object.__new__(Scene)
        scene._images = (images[0], images[1])
        scene._overrides = [*self._overrides, *added]
        scene._native = self._native.replaced(scene._overrides, scene._images)
        return scene

    @staticmethod
    def _placed_image(key: str, value: Any, images: list[_cloakroom.Image | None]) -> Any:
        places = ["photograph.image", "surroundings.image"]
        if key in places and is_image_array(value):
            image = _cloakroom.Image(image_array(key, value))
            images[places.index(key)] = image
            return image.name
        # The working folder may be another one when the scene is sent to another process.
        file = os.fspath(value) if isinstance(value, (str, os.PathLike)) else value
        return os.path.abspath(file) if isinstance(file, str) and file and ":" not in file else file

    @property
    def toml(self) -> str:
        """The scene as a scene file writes it; pictures carry this."""
        return self._native.toml

    @property
    def resolution(self) -> tuple[int, int]:
        """Width and height of its picture in pixels."""
        return self._native.resolution

    @property
    def kinds(self) -> list[str]:
        """The kinds of its devices, in their order."""
        return self._native.kinds

    def check(self) -> None:
        """Builds the devices and reads the images, and does nothing with them.

        Raises
        ------
        ValueError
            If a device is impossible, something stands in something else, or an image cannot be read.
        """
        self._native.check()

    def render(
        self,
        samples: int | None = None,
        *,
        resolution: tuple[int, int] | None = None,
        image_only: bool = False,
        tile: tuple[int, int, int, int] | None = None,
        progress: Progress = False,
    ) -> Picture:
        """Renders the scene on all cores; Ctrl-C stops it.

        Parameters
        ----------
        samples : int, optional
            Camera rays per pixel, instead of ``camera.samples``.
        resolution : (int, int), optional
            Width and height in pixels, instead of ``camera.resolution``.
        image_only : bool, default False
            Only ``R``, ``G`` and ``B``, in less time: no times of flight, no shares of power.
        tile : (int, int, int, int), optional
            Left, top, width and height in pixels: this part of the picture alone, which `Picture.merge` puts together
            with the others. Even edges save work.
        progress : bool or callable, default False
            ``True`` for a line on standard error, or a function that is called with the rows done and all rows.

        Returns
        -------
        Picture
            The channels as arrays.

        Raises
        ------
        ValueError
            If the scene cannot be: a device is impossible, the camera stands in one, an image cannot be read.
        MemoryError
            If the picture would not fit into the memory that is free.
        KeyboardInterrupt
            On Ctrl-C.
        """
        keys = {"camera.samples": samples, "camera.resolution": resolution}
        keys = {key: value for key, value in keys.items() if value is not None}
        scene = self.replace(keys) if keys else self
        shown = scene._native.map
        if image_only and "map" in shown:
            raise ValueError(f"image_only leaves no channel `{shown['map']}` for picture.map to show")
        place = None if tile is None else _tile(tile)
        with told(progress, "rendering") as tell:
            channels, metadata, (endless, lost) = _cloakroom.render(scene._native, image_only, place, tell)
        rarities = {"endless": endless, "lost": lost}
        return Picture(channels, dict(metadata), **shown, rarities=rarities)

    def __repr__(self) -> str:
        width, height = self.resolution
        return f"<Scene of {width} x {height} pixels: {', '.join(self.kinds) or 'no devices'}>"

    def __reduce__(self) -> tuple[Any, ...]:
        text, name, folder, is_file = self._native.written
        arrays = [None if image is None else image.array() for image in self._images]
        # The working folder may be another one there.
        return _rebuild, (text, name, os.path.abspath(folder), is_file, self._overrides, *arrays)


def _rebuild(
    text: str,
    name: str,
    folder: str,
    is_file: bool,
    overrides: list[tuple[str, Any]],
    photograph: NDArray[Any] | None,
    surroundings: NDArray[Any] | None,
) -> Scene:
    scene = object.__new__(Scene)
    # Arrays that have come through a network may lie anywhere in memory.
    images = [
        None if array is None else _cloakroom.Image(np.require(array, requirements=["ALIGNED"]))
        for array in (photograph, surroundings)
    ]
    scene._images = (images[0], images[1])
    scene._overrides = overrides
    scene._native = _cloakroom.Scene(text, name, folder, is_file, overrides, scene._images)
    return scene


def _tile(tile: Any) -> list[int]:
    array = np.asarray(tile)
    if array.shape != (4,) or array.dtype.kind not in "iu" or not ((array >= 0) & (array < 2**32)).all():
        raise ValueError(f"tile is {tile!r}; expected left, top, width and height in pixels")
    return [int(side) for side in array]


def _table(name: str, given: TableLike | None) -> Table:
    """One of the tables of a scene."""
    kind = TABLES[name]
    if given is None:
        return kind()
    if isinstance(given, kind):
        return given
    if isinstance(given, Mapping):
        return kind(**_named(name, given))
    raise TypeError(f"{name} is a {type(given).__name__}; expected a {kind.__name__} or a mapping of its keys")


def _named(name: str, given: Mapping[Any, Any]) -> dict[str, Any]:
    for key in given:
        if not isinstance(key, str):
            raise TypeError(f"{name} has the key {key!r}; expected a text")
    return dict(given)


def _pictured(name: str, given: Any) -> TableLike | None:
    """A table that may be given by its image, or by a color."""
    if given is None or isinstance(given, (Table, Mapping)):
        return given
    if isinstance(given, (str, os.PathLike)):
        return {"image": given}
    if name == "surroundings" and is_image_array(given) and np.shape(given) == (3,):
        return {"color": given}
    if is_image_array(given):
        return TABLES[name](image=image_array(name, given))
    raise TypeError(
        f"{name} is a {type(given).__name__}; expected an array, a path, a {TABLES[name].__name__} or a mapping"
    )


def _listed(devices: Any) -> list[Any]:
    if isinstance(devices, (Device, Mapping)):
        return [devices]
    if isinstance(devices, (str, bytes)) or not isinstance(devices, Iterable):
        raise TypeError(f"devices is a {type(devices).__name__}; expected a list of devices")
    return list(devices)


def _device(number: int, device: Any) -> dict[str, Any]:
    if isinstance(device, Mapping):
        keys = _named(f"device {number}", device)
        kind = keys.pop("kind", None)
        if not isinstance(kind, str):
            raise ValueError(f"device {number} has no kind; known kinds: {', '.join(DEVICES)}")
        return {"kind": kind, **_cloakroom.fit(kind, keys)}
    if not isinstance(device, Device):
        what = device.__name__ + " itself" if isinstance(device, type) else f"a {type(device).__name__}"
        raise TypeError(f"device {number} is {what}; expected a device such as SquareCloak()")
    return {"kind": device.kind, **device.given()}
