"""Scenes: camera, light, photograph, surroundings and devices."""

from __future__ import annotations

import json
import os
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _cloakroom
from ._arrays import check_listed, image_of, is_image_array, numbers
from ._progress import Progress, told
from .drawings import Drawing
from .labelled import Arrays
from .pages import Page
from .pictures import Picture
from .tables import (
    DEVICES,
    TABLES,
    Camera,
    Device,
    Light,
    Photograph,
    PictureSettings,
    Receiver,
    Surroundings,
    Table,
    TraceSettings,
)

__all__ = ["Estimate", "Scene"]

#: A table of a scene: one of the classes, or a mapping of its keys.
TableLike = Table | Mapping[str, Any]


@dataclass(frozen=True)
class Estimate:
    """What rendering the image of a scene takes on this machine."""

    #: Seconds, on that many threads.
    seconds: float
    #: How many rays are followed to their ends; the others go past every device, or are interpolated.
    rays: float
    #: How many rays the camera sends out.
    samples: int
    #: Memory for the picture and the file that it is written to, bytes.
    memory: int
    #: How many threads do the work.
    threads: int

    @property
    def rays_per_sample(self) -> float:
        """The share of the camera's rays that are followed."""
        return self.rays / self.samples


class Scene:
    """All that a picture depends on. A scene does not change; `replace` gives another one.

    Its tables can be read as attributes, ``scene.camera.samples`` and ``scene.devices[0].rotation``, and given to
    another scene. Scenes are equal whose tables say the same and whose images are equal: a key that is written with its
    default is another scene than one without the key. In a notebook a scene shows its setting.

    Parameters
    ----------
    camera, light, trace, picture, receiver : table or mapping, optional
        The tables of a scene: `Camera`, `Light`, `TraceSettings`, `PictureSettings`, `Receiver`, or their keys in
        a mapping.
    photograph : table, mapping, array or path, optional
        What hangs behind the devices: a `Photograph`, or its image alone. An array is (height, width), (height, width,
        3), or (height, width, 4) with alpha, over black; ``uint8`` in sRGB or floats in linear light, its first row on
        top. ``Photograph(image=array, encoding="srgb")`` says that floats are sRGB.
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

    def __setattr__(self, name: str, value: object) -> None:
        if not name.startswith("_"):
            raise AttributeError(
                "scenes do not change; .replace({\"camera.samples\": 16}) gives another one, and Scene(...) takes its tables"
            )
        super().__setattr__(name, value)

    @staticmethod
    def load(path: str | os.PathLike[str]) -> Scene:
        """Reads a scene file, or one of the examples.

        Parameters
        ----------
        path : str or path
            The file; files that it names are relative to it. Where there is no such file, an example of that name, as
            `cloakroom scenes` lists them: ``"gallery/prisms"``.

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
            image = image_of(key, value)
            images[places.index(key)] = image
            return image.name
        # The working folder may be another one when the scene is sent to another process.
        file = os.fspath(value) if isinstance(value, (str, os.PathLike)) else value
        return os.path.abspath(file) if isinstance(file, str) and file and ":" not in file else file

    @property
    def camera(self) -> Camera:
        """The camera."""
        return self._table("camera")  # type: ignore[return-value]

    @property
    def photograph(self) -> Photograph:
        """What hangs behind the devices."""
        return self._table("photograph")  # type: ignore[return-value]

    @property
    def surroundings(self) -> Surroundings:
        """What rays see that hit nothing."""
        return self._table("surroundings")  # type: ignore[return-value]

    @property
    def light(self) -> Light:
        """The light."""
        return self._table("light")  # type: ignore[return-value]

    @property
    def trace(self) -> TraceSettings:
        """How far rays are followed."""
        return self._table("trace")  # type: ignore[return-value]

    @property
    def picture(self) -> PictureSettings:
        """What pictures show."""
        return self._table("picture")  # type: ignore[return-value]

    @property
    def receiver(self) -> Receiver:
        """The plane on which light is measured."""
        return self._table("receiver")  # type: ignore[return-value]

    @property
    def devices(self) -> tuple[Device, ...]:
        """The devices, in their order."""
        devices = self._tables().get("device", [])
        return tuple(DEVICES[keys["kind"]]._of({k: v for k, v in keys.items() if k != "kind"}) for keys in devices)

    def _table(self, name: str) -> Table:
        keys = self._tables().get(name, {})
        table: Table = TABLES[name]._of(keys, self._shown(name, keys))
        return table

    def _tables(self) -> dict[str, Any]:
        """What a scene file says, files by names that hold in any folder."""
        tables: dict[str, Any] = self._native.tables
        for key, path in self._native.files:
            *places, last = key.split(".")
            table: Any = tables
            for place in places:
                table = table[int(place) if place.isdigit() else place]
            table[last] = os.path.abspath(path)
        return {name: keys for name, keys in tables.items() if keys}

    def _shown(self, name: str, keys: Mapping[str, Any]) -> _cloakroom.Image | None:
        """The array that a table shows as its image."""
        image = dict(zip(("photograph", "surroundings"), self._images)).get(name)
        return image if image is not None and keys.get("image") == image.name else None

    def _compared(self) -> tuple[Any, ...]:
        tables = self._tables()
        return tables, [self._shown(name, tables.get(name, {})) for name in ("photograph", "surroundings")]

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Scene):
            return NotImplemented
        return self._native is other._native or self._compared() == other._compared()

    def __hash__(self) -> int:
        return hash((self.resolution, *self.kinds))

    @property
    def toml(self) -> str:
        """The scene as a scene file writes it; pictures carry this.

        An image that is an array is called ``array:WIDTHxHEIGHT`` in it, which cannot be loaded: save the image, and give
        its path.
        """
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

    def estimate(self) -> Estimate:
        """Estimates what rendering the image takes, as ``cloakroom check`` does; parts of it are rendered for up to two
        seconds.

        Raises
        ------
        ValueError
            As `check`.

        Examples
        --------
        >>> from cloakroom import Camera, Scene, SquareCloak
        >>> estimate = Scene(camera=Camera(resolution=[64, 48], samples=2), devices=SquareCloak()).estimate()
        >>> estimate.samples, 0 < estimate.rays_per_sample < 1
        (6144, True)
        """
        return Estimate(*_cloakroom.estimate(self._native))

    def setting(self) -> Drawing:
        """Draws camera, photograph and devices to scale, as ``cloakroom diagram --setting`` does.

        Raises
        ------
        ValueError
            As `check`.
        """
        return Drawing._of(_cloakroom.setting(self._native))

    def diagram(
        self,
        rays: int = 20,
        *,
        parallel: float | None = None,
        point: ArrayLike | None = None,
        camera: bool = False,
        width: float | None = None,
        window: tuple[float, float, float, float] | None = None,
        z: float | None = None,
        polarization: Literal["none", "horizontal", "vertical"] = "none",
        wavefronts: float | None = None,
        min_power: float = 0.01,
        space: tuple[float, float] | None = None,
        layers: int = 1,
        size: tuple[int, int] = (1024, 768),
        pulse: float | None = None,
        delay: str = "group",
    ) -> Drawing:
        """Draws rays through the devices, as ``cloakroom diagram`` does.

        Parameters
        ----------
        rays : int, default 20
            How many rays.
        parallel : float, optional
            Parallel rays in that direction, degrees from x in the xy-plane; along x if nothing else is asked for.
        point : array_like, (3,), optional
            A fan of rays from that point instead, cm.
        camera : bool, default False
            A fan of rays from the scene's camera instead.
        width : float, optional
            The width of a bundle of parallel rays, cm; that of the devices if not given.
        window : (float, float, float, float), optional
            The part of the cross-section that is shown: least x and y, greatest x and y (cm); the devices and what is
            around them if not given.
        z : float, optional
            The plane z = const that the rays start in, cm; that of the first device if not given.
        polarization : {"none", "horizontal", "vertical"}, default "none"
            The polarization.
        wavefronts : float, optional
            Marks the points of equal optical path, as often as that (cm).
        min_power : float, default 0.01
            Branches below this share of a ray's power are left out.
        space : (float, float), optional
            Shows space in parallel projection, seen from that azimuth and elevation (degrees), instead of the
            cross-section.
        layers : int, default 1
            With `space`, layers of rays one behind the other along z.
        size : (int, int), default (1024, 768)
            Width and height in pixels of a ``.png``; their ratio is that of the sheet.
        pulse : float, optional
            Draws where a pulse is at that time, ns: after it has left the point or the camera, and of parallel rays after
            it would be in the middle of the devices, were there nothing in its way.
        delay : str, default "group"
            With `pulse`, ``"group"`` for what a pulse takes, ``"phase"`` for what the phase takes, as in the paper.

        Raises
        ------
        TypeError, ValueError
            If the scene cannot be or has no devices, or a number makes no sense.

        Examples
        --------
        >>> from cloakroom import Scene, SquareCloak
        >>> Scene(devices=SquareCloak()).diagram(10, wavefronts=4).svg.count('class="wavefront"') > 5
        True
        >>> Scene(devices=SquareCloak()).diagram(10, pulse=0.4).svg.count('<g class="pulse"') > 0
        True
        """
        sources = {"parallel": parallel is not None, "point": point is not None, "camera": camera}
        if sum(sources.values()) > 1:
            given = " and ".join(name for name, is_given in sources.items() if is_given)
            raise ValueError(f"{given} are given; rays come from one of them")
        shares = {"none": (0.5, 0.5), "horizontal": (1.0, 0.0), "vertical": (0.0, 1.0)}
        if polarization not in shares:
            raise ValueError(f'polarization is {polarization!r}; expected "none", "horizontal" or "vertical"')
        return Drawing._of(
            _cloakroom.diagram(
                self._native,
                None if point is not None or camera else _number("parallel", parallel or 0.0),
                None if point is None else _numbers("point", point, 3, "cm"),
                [_count("rays", rays), _count("layers", layers)],
                None if z is None else _number("z", z),
                None if width is None else _number("width", width),
                None if window is None else _numbers("window", window, 4, "cm"),
                shares[polarization],
                None if wavefronts is None else _number("wavefronts", wavefronts),
                _number("min_power", min_power),
                None if space is None else _numbers("space", space, 2, "degrees"),
                _pixels("size", size, 2, "width and height"),
                None if pulse is None else _number("pulse", pulse),
                _text("delay", delay),
            )
        )

    def pulses(self, column: int, row: int) -> dict[str, Any]:
        """Lists the pulses of a pixel, as ``cloakroom pulses --json`` does: what a short flash of the photograph looks
        like there.

        Parameters
        ----------
        column, row : int
            The pixel, counted from 0 at the top left.

        Returns
        -------
        dict
            ``pulses``, a list of dicts with ``time_of_flight_ns``, ``delay_ns``, ``group_delay_ns``, ``power`` and
            ``landings``; and ``mean_time_of_flight_ns``, ``delivered``, ``escaped`` and more of the pixel.

        Raises
        ------
        TypeError, ValueError
            If there is no such pixel, or the scene cannot be.

        Examples
        --------
        >>> from cloakroom import Camera, Scene, SquareCloak
        >>> pulses = Scene(camera=Camera(resolution=[64, 48]), devices=SquareCloak()).pulses(32, 24)
        >>> len(pulses["pulses"]), round(pulses["pulses"][0]["power"], 6)
        (1, 1.0)
        """
        pulses: dict[str, Any] = json.loads(
            _cloakroom.pulses(self._native, [_count("column", column), _count("row", row)])
        )
        return pulses

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
        place = None if tile is None else _pixels("tile", tile, 4, "left, top, width and height")
        with told(progress, "rendering") as tell:
            channels, metadata, (endless, lost) = _cloakroom.render(scene._native, image_only, place, tell)
        rarities = {"endless": endless, "lost": lost}
        return Picture(channels, dict(metadata), **shown, rarities=rarities)

    def flight(
        self,
        gate: str | tuple[float, float, float] | None = None,
        *,
        pulse: float = 0.0,
        delay: str = "group",
        flash: str = "photograph",
        samples: int | None = None,
        resolution: tuple[int, int] | None = None,
        progress: Progress = False,
    ) -> Arrays:
        """Looks at light in flight: what a camera with a time gate sees when the photograph flashes.

        Leaves are added by power; the photograph alone is timed. The bins together with ``before``, ``after``,
        ``untimed`` and ``steady`` are the ``picture``; the mean of ``time``, weighted by ``power``, is the time of
        flight.

        Parameters
        ----------
        gate : str or (float, float, float), optional
            The middles of the first and the last bin and the length of each, ns, as in ``"5.0..5.4:0.005"`` or
            ``(5.0, 5.4, 0.005)``; about 120 bins that hold what arrives if absent.
        pulse : float, default 0
            How long the flash is at half its height, ns, of the shape cos².
        delay : str, default "group"
            ``"group"`` for what a pulse takes, ``"phase"`` for what the phase takes, as in the paper.
        flash : str, default "photograph"
            What flashes: ``"photograph"``, ``"plane:DX,DY,DZ"``, ``"point:X,Y,Z"`` or ``"spot:X,Y,Z,RADIUS"``.
        samples : int, optional
            Camera rays per pixel, instead of ``camera.samples``.
        resolution : (int, int), optional
            Width and height in pixels, instead of ``camera.resolution``.
        progress : bool or callable, default False
            ``True`` for a line on standard error, or a function that is called with the steps done and all steps.

        Returns
        -------
        Arrays
            ``light`` (time, height, width, color) and ``power`` (time, height, width); ``time``, the middles of the
            bins, ns; ``before``, ``after`` and ``untimed`` with their powers, ``steady`` and ``picture``
            (height, width, color).

        Raises
        ------
        ValueError
            If the gate or the flash cannot be read, or the scene cannot be.
        MemoryError
            If it would not fit into the memory that is free.

        Examples
        --------
        >>> from cloakroom import Camera, Scene, SquareCloak
        >>> scene = Scene(camera=Camera(resolution=[16, 12]), devices=SquareCloak())
        >>> flown = scene.flight((4.9, 7.9, 0.01))
        >>> flown["light"].shape
        (301, 12, 16, 3)
        >>> bool(abs(flown["power"].sum(axis=0) + flown["after_power"] - 1).max() < 1e-6)
        True
        """
        keys = {"camera.samples": samples, "camera.resolution": resolution}
        keys = {key: value for key, value in keys.items() if value is not None}
        scene = self.replace(keys) if keys else self
        if gate is not None and not isinstance(gate, str):
            start, end, step = _numbers("gate", gate, 3, "ns: the first and the last bin, and their length")
            gate = f"{start!r}..{end!r}:{step!r}"
        with told(progress, "rendering") as tell:
            arrays, _ = _cloakroom.flight(
                scene._native, gate, _number("pulse", pulse), _text("delay", delay), _text("flash", flash), tell
            )
        image = ("height", "width")
        axes: dict[str, tuple[str, ...]] = {}
        axes |= {name: (*image, "color") for name in ("before", "after", "untimed", "steady", "picture")}
        axes |= {name: image for name in ("before_power", "after_power", "untimed_power")}
        axes |= {"time": ("time",), "light": ("time", *image, "color"), "power": ("time", *image)}
        return Arrays(arrays, axes)

    def animate(
        self,
        keys: Mapping[str, Sequence[Any] | NDArray[Any]],
        path: str | os.PathLike[str],
        *,
        orbit: ArrayLike | None = None,
        fps: int = 25,
        map_range: tuple[float, float] | None = None,
        keep_frames: bool = False,
        progress: Progress = False,
    ) -> None:
        """Makes a film in which keys change from frame to frame, as ``cloakroom animate`` does.

        Stopped work goes on where it was when the same call is made once more: finished frames are kept in a folder
        beside the film.

        Parameters
        ----------
        keys : mapping of str to sequence
            The values that each key takes, one a frame, as `replace` takes it: ``{"device.0.rotation":
            np.linspace(0, 90, 91)}``. Ways between a few frames are what `numpy.interp` gives.
        path : path
            The film: ``.gif``, ``.apng``, ``.png``, ``.webp``, ``.mp4`` or ``.webm`` (by ffmpeg); a name without ending is
            a folder of frames.
        orbit : array_like (N,), optional
            How far the camera has gone round its target, a value a frame, degrees about ``camera.up``, counterclockwise
            from above; `keys` may then be empty.
        fps : int, default 25
            Frames a second, 1 to 100.
        map_range : (float, float), optional
            With ``picture.map`` in the scene, the one scale of all frames: in ns for times, as shares for powers.
        keep_frames : bool, default False
            Keep the folder of the frames.
        progress : bool or callable, default False
            ``True`` for a line on standard error, or a function that is called with the steps done and all steps.

        Raises
        ------
        TypeError, ValueError
            If a key does not exist or a value does not fit, the keys differ in the number of values, the frames would be
            of different sizes, or the ending is another.
        OSError
            If a file cannot be written.
        """
        if not isinstance(keys, Mapping) or not (keys or orbit is not None):
            raise TypeError(f"keys is {keys!r}; expected a mapping of keys to their values, one a frame")
        for key, values in keys.items():
            check_listed(key, values, "a list of values, one a frame")
        counts = {key: len(values) for key, values in keys.items()}
        turns = None if orbit is None else numbers("orbit", orbit, "angles (N,) in degrees")
        if turns is not None:
            if turns.ndim != 1 or not len(turns) or not np.isfinite(turns).all():
                raise ValueError(f"orbit has the shape {turns.shape}; expected finite angles (N,) in degrees, one a frame")
            counts["orbit"] = len(turns)
        if len(set(counts.values())) != 1:
            listed = ", ".join(f"{key} {count}" for key, count in counts.items())
            raise ValueError(f"the keys differ in their values: {listed}; expected one a frame in each")
        if not 1 <= _count("fps", fps) <= 100:
            raise ValueError(f"fps is {fps}; expected 1 to 100 frames a second")
        plain = ([value.item() if isinstance(value, np.generic) else value for value in row] for row in zip(*keys.values()))
        rows = plain if keys else ([] for _ in range(counts["orbit"]))
        scenes = [self.replace(dict(zip(keys, row))) for row in rows]
        if turns is not None:
            places = (scene._native.orbited(float(turn)) for scene, turn in zip(scenes, turns))
            scenes = [scene.replace({"camera.position": place}) for scene, place in zip(scenes, places)]
        if len({scene.resolution for scene in scenes}) > 1:
            raise ValueError("camera.resolution changes from frame to frame; a film has one size")
        shown = [scene._native.map for scene in scenes]
        if map_range is None and any("map" in keys and "map_range" not in keys for keys in shown):
            raise ValueError("a film of a map needs one scale for all frames; give map_range=(low, high)")
        scale = None if map_range is None else _numbers("map_range", map_range, 2, "ns, or shares")
        natives = [scene._native for scene in scenes]
        with told(progress, "animating") as tell:
            _cloakroom.animate(natives, os.fspath(path), int(fps), scale, bool(keep_frames), tell)

    def view(self, *, port: int = 0, open: bool = True) -> Page:
        """Serves an interactive page with the scene on this machine, as ``cloakroom view`` does; it stays until it is
        closed, or Python ends.

        Parameters
        ----------
        port : int, default 0
            The port; 0 stands for any that is free.
        open : bool, default True
            Open it in the browser.

        Returns
        -------
        Page
            The page: ``page.address``, ``page.close()``; in a script, ``page.wait()``.

        Raises
        ------
        TypeError, ValueError
            If the port is none, or an image of the scene is an array.
        OSError
            If no port is free.
        """
        if not 0 <= _count("port", port) < 2**16:
            raise ValueError(f"port is {port}; expected a number below 65536")
        page = Page._of(_cloakroom.Page(self._native, "a scene in Python", int(port)))
        if open:
            page.open()
        return page

    def _repr_svg_(self) -> str | None:
        try:
            return self.setting().svg
        except ValueError:
            # One that cannot be built shows as a text.
            return None

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
        None if array is None else _cloakroom.Image(np.require(array, requirements=["ALIGNED"]), False)
        for array in (photograph, surroundings)
    ]
    scene._images = (images[0], images[1])
    scene._overrides = overrides
    scene._native = _cloakroom.Scene(text, name, folder, is_file, overrides, scene._images)
    return scene


def _pixels(name: str, given: Any, count: int, expected: str) -> list[int]:
    array = np.asarray(given)
    if array.shape != (count,) or array.dtype.kind not in "iu" or not ((array >= 0) & (array < 2**32)).all():
        raise ValueError(f"{name} is {given!r}; expected {expected} in pixels")
    return [int(side) for side in array]


def _number(name: str, value: Any) -> float:
    if isinstance(value, bool) or not isinstance(value, (int, float, np.integer, np.floating)):
        raise TypeError(f"{name} is a {type(value).__name__}; expected a number")
    return float(value)


def _numbers(name: str, values: Any, count: int, unit: str) -> list[float]:
    expected = f"{count} numbers ({unit})"
    array = numbers(name, values, expected)
    if array.shape != (count,) or not np.isfinite(array).all():
        raise ValueError(f"{name} is {values!r}; expected {expected}")
    return [float(value) for value in array]


def _count(name: str, value: Any) -> int:
    if isinstance(value, bool) or not isinstance(value, (int, np.integer)):
        raise TypeError(f"{name} is a {type(value).__name__}; expected a whole number")
    if not 0 <= value < 2**32:
        raise ValueError(f"{name} is {value}; expected a whole number from 0 on that fits into 32 bits")
    return int(value)


def _text(name: str, value: Any) -> str:
    if not isinstance(value, str):
        raise TypeError(f"{name} is a {type(value).__name__}; expected a text")
    return value


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
        return TABLES[name](image=image_of(name, given))
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
