from collections.abc import Callable, Sequence
from typing import Any, Literal, final

import numpy as np
from numpy.typing import NDArray

__all__ = [
    "__version__",
    "Drawing",
    "Image",
    "Material",
    "Page",
    "Scene",
    "animate",
    "check_memory",
    "device_bounds",
    "diagram",
    "estimate",
    "export_grid",
    "export_paths",
    "export_table",
    "fail_on_purpose",
    "figures",
    "fit",
    "flight",
    "flux",
    "interface",
    "key_names",
    "merge",
    "outline_meshes",
    "png_bytes",
    "pulses",
    "quality",
    "read",
    "render",
    "save",
    "scatter",
    "schema",
    "set_threads",
    "setting",
    "srgb",
    "sweep",
    "threads",
    "trace",
    "verify",
]

__version__: str

_Tell = Callable[[int, int], object] | None
_Images = tuple[Image | None, Image | None]
_Map = dict[str, Any]
_Tensors = tuple[NDArray[np.complex128], NDArray[np.complex128]]

@final
class Drawing:
    @property
    def svg(self) -> str: ...
    def save(self, path: str) -> None: ...

@final
class Image:
    def __new__(cls, array: NDArray[Any], is_srgb: bool) -> Image: ...
    def array(self) -> NDArray[Any]: ...
    def __eq__(self, value: object, /) -> bool: ...
    @property
    def name(self) -> str: ...

@final
class Material:
    def __new__(cls, what: Any) -> Material: ...
    @property
    def value(self) -> Any: ...
    @property
    def title(self) -> str: ...
    @property
    def source(self) -> str: ...
    @property
    def is_uniaxial(self) -> bool: ...
    @property
    def range_nm(self) -> tuple[float, float]: ...
    def indices(
        self, wavelengths_nm: NDArray[np.float64], extraordinary: bool
    ) -> list[NDArray[np.complex128]]: ...

@final
class Page:
    def __new__(cls, scene: Scene, name: str, port: int) -> Page: ...
    @property
    def address(self) -> str: ...
    @property
    def way_in(self) -> str | None: ...
    def close(self) -> None: ...

@final
class Scene:
    def __new__(
        cls,
        text: str,
        name: str,
        folder: str,
        is_file: bool,
        overrides: Sequence[tuple[str, object]],
        images: _Images,
    ) -> Scene: ...
    @staticmethod
    def of_tables(
        tables: dict[str, Any],
        folder: str,
        images: _Images,
    ) -> Scene: ...
    @staticmethod
    def load(path: str) -> Scene: ...
    def replaced(
        self,
        overrides: Sequence[tuple[str, object]],
        images: _Images,
    ) -> Scene: ...
    @property
    def written(self) -> tuple[str, str, str, bool]: ...
    @property
    def files(self) -> list[tuple[str, str]]: ...
    @property
    def toml(self) -> str: ...
    def orbited(self, degrees: float) -> list[float]: ...
    @property
    def resolution(self) -> tuple[int, int]: ...
    @property
    def kinds(self) -> list[str]: ...
    @property
    def tables(self) -> dict[str, Any]: ...
    @property
    def map(self) -> _Map: ...
    def build(self) -> None: ...
    def check(self) -> None: ...

def schema() -> str: ...
def key_names(table: str) -> list[str]: ...
def fit(table: str, entries: dict[str, Any]) -> dict[str, Any]: ...
def render(
    scene: Scene, image_only: bool, tile: Sequence[int] | None, progress: _Tell
) -> tuple[dict[str, NDArray[Any]], list[tuple[str, str]], tuple[int, int]]: ...
def estimate(scene: Scene) -> tuple[float, float, int, int, int]: ...
def pulses(scene: Scene, pixel: Sequence[int]) -> str: ...
def flight(
    scene: Scene, gate: str | None, pulse: float, delay: str, flash: str, progress: _Tell
) -> tuple[dict[str, NDArray[Any]], tuple[int, int]]: ...
def setting(scene: Scene) -> Drawing: ...
def diagram(
    scene: Scene,
    parallel: float | None,
    point: Sequence[float] | None,
    counts: Sequence[int],
    z: float | None,
    width: float | None,
    window: Sequence[float] | None,
    polarization: tuple[float, float],
    wavefronts: float | None,
    min_power: float,
    space: Sequence[float] | None,
    size: Sequence[int],
    pulse: float | None,
    delay: str,
) -> Drawing: ...
def animate(
    scenes: Sequence[Scene],
    path: str,
    rate: int,
    map_range: Sequence[float] | None,
    keep_frames: bool,
    progress: _Tell,
) -> tuple[int, int, int]: ...
def figures(
    only: Sequence[str],
    folder: str,
    photo: str | None,
    size: Sequence[int],
    samples: int,
    progress: _Tell,
) -> list[str]: ...
def read(path: str) -> tuple[dict[str, NDArray[Any]], list[tuple[str, str]]]: ...
def merge(
    tiles: Sequence[tuple[str, dict[str, NDArray[Any]], Sequence[tuple[str, str]]]],
) -> tuple[dict[str, NDArray[Any]], list[tuple[str, str]]]: ...
def save(
    path: str, channels: dict[str, NDArray[Any]], metadata: Sequence[tuple[str, str]], map: _Map
) -> None: ...
def srgb(channels: dict[str, NDArray[Any]], map: _Map) -> NDArray[np.uint8]: ...
def png_bytes(
    channels: dict[str, NDArray[Any]], metadata: Sequence[tuple[str, str]], map: _Map
) -> bytes: ...
def trace(
    scene: Scene,
    origins: NDArray[np.float64],
    directions: NDArray[np.float64],
    polarization: str,
    fields: NDArray[np.complex128] | None,
    min_power: float | None,
    coherent: bool,
    group_delay: bool,
    pick: int | None,
    paths: float | None,
    progress: _Tell,
) -> dict[str, Any]: ...
def scatter(
    scene: Scene,
    origins: NDArray[Any],
    directions: NDArray[Any],
    draws: NDArray[Any] | None,
    fields: NDArray[np.complex128] | None,
    want_fields: bool,
    rotation: NDArray[np.float64],
    place: NDArray[np.float64],
    unit: float,
    min_power: float,
) -> dict[str, Any]: ...
def device_bounds(
    scene: Scene, unit: float
) -> list[tuple[NDArray[np.float64], list[float], list[float], bool]]: ...
def outline_meshes(
    scene: Scene, unit: float
) -> list[tuple[str, Literal["medium", "metal", "polarizer", "opaque"], NDArray[np.float64]]]: ...
def interface(
    incident: _Tensors,
    transmitted: _Tensors | None,
    normals: NDArray[np.float64],
    tangentials: NDArray[np.float64],
    progress: _Tell,
) -> dict[str, Any]: ...
def quality(
    first: object,
    second: object,
    mask: NDArray[np.bool_] | None,
    rectangle: Sequence[int] | None,
) -> str: ...
def sweep(
    scene: Scene,
    sweeps: Sequence[tuple[str, Sequence[object]]],
    reference: Scene | None,
    path: str | None,
    progress: _Tell,
) -> str: ...
def verify(progress: _Tell) -> str: ...
def flux(
    scene: Scene,
    angles: Sequence[float],
    tilt: float,
    sun: tuple[float, float] | None,
    sampling: Sequence[int],
    path: str | None,
    progress: _Tell,
) -> dict[str, NDArray[np.float64]]: ...
def export_grid(
    scene: Scene,
    path: str | None,
    device: int | None,
    cells: Sequence[int] | None,
    spacing: float | None,
    world: bool,
    progress: _Tell,
) -> dict[str, NDArray[Any]] | None: ...
def export_paths(
    path: str,
    ray: NDArray[np.uint32],
    power: NDArray[np.float64],
    leaf: NDArray[np.int64],
    parent: NDArray[np.int64],
    start: NDArray[np.int64],
    vertex: NDArray[np.float64],
    optical_path: NDArray[np.float64],
) -> None: ...
def export_table(scene: Scene, path: str | None, device: int | None) -> str | None: ...
def set_threads(count: int) -> None: ...
def threads() -> int: ...
def check_memory(name: str, bytes: int) -> None: ...
def fail_on_purpose() -> None: ...
