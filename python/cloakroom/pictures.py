"""Pictures: channels as numpy arrays."""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator, Mapping
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from . import _cloakroom
from .labelled import are_equal, dataset

if TYPE_CHECKING:
    import xarray

__all__ = ["Picture"]


class Picture(Mapping[str, NDArray[Any]]):
    """A picture: named channels, each a numpy array.

    ``picture["time_of_flight"]`` and ``picture.time_of_flight`` are the same array; ``picture["horizontal.R"]`` has a
    dot in its name. Shapes are (height, width), and (height, width, 3) for Stokes images; colors and shares of power
    are ``float32``, times ``float64``. The channels are the renderer's own memory, not copies: what you change in them
    is changed in what is saved. `image`, `linear`, `horizontal` and `vertical` are put together from them, and copies.

    Pictures are equal whose channels are. In a notebook a picture shows itself.

    Parameters
    ----------
    channels : mapping of str to array
        The channels by their names, in the order of files.
    metadata : mapping of str to str, optional
        What every file carries: scene, version, seed.
    map : str, optional
        The channel that ``image`` shows in false colors instead of what the camera sees.
    color_bar : bool, default True
        Whether the scale of a map is drawn beside it.
    map_range : (float, float), optional
        The numbers of a map with its first and its last color, ns for times and shares for powers.
    map_percentile : float, optional
        Instead of these, the percentage of the numbers, about the middle one, that lies in the range.
    colormap : str, optional
        ``"auto"``, ``"viridis"``, ``"cividis"``, ``"magma"``, or ``"blue-red"``, which is centred on 0.
    rarities : mapping of str to int, optional
        How many branches of ray trees were cut because there was no end to them (``"endless"``), or could not be
        followed (``"lost"``); their power is in ``pruned``.
    """

    def __init__(
        self,
        channels: Mapping[str, NDArray[Any]],
        metadata: Mapping[str, str] | None = None,
        *,
        map: str | None = None,
        color_bar: bool = True,
        map_range: tuple[float, float] | None = None,
        map_percentile: float | None = None,
        colormap: str = "auto",
        rarities: Mapping[str, int] | None = None,
    ) -> None:
        self._channels = dict(channels)
        #: What every file carries: scene, version, seed.
        self.metadata: dict[str, str] = dict(metadata or {})
        #: Branches of ray trees that were cut (``"endless"``) or lost (``"lost"``).
        self.rarities: dict[str, int] = dict(rarities or {})
        settings = {
            "map": map,
            "color_bar": color_bar,
            "map_range": map_range,
            "map_percentile": map_percentile,
            "colormap": colormap,
        }
        self._map = _cloakroom.fit("picture", {key: value for key, value in settings.items() if value is not None})

    @staticmethod
    def load(path: str | os.PathLike[str]) -> Picture:
        """Reads a picture from an ``.npz`` that ``save`` or ``cloakroom render`` has written.

        Raises
        ------
        FileNotFoundError
            If there is no such file.
        ValueError
            If it is no such file.
        """
        channels, metadata = _cloakroom.read(os.fspath(path))
        return Picture(channels, dict(metadata))

    @staticmethod
    def merge(
        tiles: Iterable[str | os.PathLike[str] | Picture], **shown: Any
    ) -> Picture:
        """Puts tiles together that ``Scene.render(tile=...)`` or ``cloakroom render --tile`` has made.

        Parameters
        ----------
        tiles : iterable of Picture or path
            The tiles, or their ``.npz`` files; they must cover the picture and not overlap.
        **shown
            ``map``, ``color_bar`` and the others that say what is shown, as for a `Picture`.

        Returns
        -------
        Picture
            The picture as if it had been rendered whole.

        Raises
        ------
        FileNotFoundError, ValueError
            If a tile is missing, or they are not tiles of one picture.
        """
        pieces = []
        for number, tile in enumerate(tiles):
            if isinstance(tile, Picture):
                pieces.append((f"tile {number}", tile._channels, list(tile.metadata.items())))
            else:
                channels, metadata = _cloakroom.read(os.fspath(tile))
                pieces.append((os.fspath(tile), channels, metadata))
        channels, metadata = _cloakroom.merge(pieces)
        return Picture(channels, dict(metadata), **shown)

    def __getitem__(self, name: str) -> NDArray[Any]:
        try:
            return self._channels[name]
        except KeyError:
            known = ", ".join(self._channels)
            raise KeyError(f"the picture has no channel `{name}`; it has {known}") from None

    def __iter__(self) -> Iterator[str]:
        return iter(self._channels)

    def __len__(self) -> int:
        return len(self._channels)

    def __getattr__(self, name: str) -> NDArray[Any]:
        if not name.startswith("_") and name in self._channels:
            return self._channels[name]
        raise AttributeError(f"the picture has no channel `{name}`")

    def __dir__(self) -> Iterator[str]:
        yield from super().__dir__()
        yield from (name for name in self._channels if "." not in name)

    def __eq__(self, other: object) -> bool:
        return are_equal(self, other) if isinstance(other, Mapping) else NotImplemented

    @property
    def shape(self) -> tuple[int, int]:
        """Height and width in pixels."""
        height, width = next(iter(self._channels.values())).shape[:2]
        return height, width

    @property
    def image(self) -> NDArray[np.uint8]:
        """What a PNG shows: 8-bit sRGB, (height, width, 3); with ``picture.map`` in the scene, the map."""
        return _cloakroom.srgb(self._channels, self._map)

    @property
    def linear(self) -> NDArray[np.float32]:
        """Linear light through the camera's polarizer, (height, width, 3)."""
        return self._colors("")

    @property
    def horizontal(self) -> NDArray[np.float32]:
        """Linear light through a horizontal polarizer, (height, width, 3)."""
        return self._colors("horizontal.")

    @property
    def vertical(self) -> NDArray[np.float32]:
        """Linear light through a vertical polarizer, (height, width, 3)."""
        return self._colors("vertical.")

    def _colors(self, prefix: str) -> NDArray[np.float32]:
        try:
            return np.stack([self[prefix + color] for color in "RGB"], axis=-1)
        except KeyError as error:
            raise AttributeError(error.args[0]) from None

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes the picture as the ending asks for: ``.png`` (8-bit sRGB), ``.exr`` or ``.npz`` (all channels).

        With ``picture.map`` in the scene, a ``.png`` is the map, and ``.svg`` or ``.pdf`` are the map drawn for print.

        Raises
        ------
        ValueError
            If the ending is another or needs a map, or a channel is missing or of a wrong shape.
        TypeError
            If a channel is not an array of floats.
        OSError
            If the file cannot be written; then there is none.
        """
        _cloakroom.save(os.fspath(path), self._channels, list(self.metadata.items()), self._map)

    def to_xarray(self) -> xarray.Dataset:
        """The channels as an `xarray.Dataset`; needs ``pip install './python[xarray]'``.

        Axes are ``row`` and ``column``, counted from the top left, and ``color`` (red, green, blue) or ``bin`` of
        channels that have more numbers a pixel; the metadata are its attributes.
        """
        more: dict[int, tuple[str, ...]] = {3: ("color",), 16: ("bin",)}
        axes = {
            name: ("row", "column", *(more.get(array.shape[2], (name,)) if array.ndim == 3 else ()))
            for name, array in self._channels.items()
        }
        has_color = any("color" in of for of in axes.values())
        return dataset(self._channels, axes, {"color": np.array(list("RGB"))} if has_color else {}, self.metadata)

    def _repr_png_(self) -> bytes | None:
        if "map" not in self._map and "R" not in self._channels:
            return None
        return _cloakroom.png_bytes(self._channels, list(self.metadata.items()), self._map)

    def __repr__(self) -> str:
        height, width = self.shape
        return f"<Picture of {width} x {height} pixels: {', '.join(self._channels)}>"

    def __reduce__(self) -> tuple[Any, ...]:
        return _rebuild, (self._channels, self.metadata, self._map, self.rarities)


def _rebuild(
    channels: Mapping[str, NDArray[Any]],
    metadata: Mapping[str, str],
    shown: Mapping[str, Any],
    rarities: Mapping[str, int],
) -> Picture:
    return Picture(channels, metadata, **shown, rarities=rarities)
