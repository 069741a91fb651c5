from collections.abc import Callable, Mapping, Sequence
from typing import Any, final

import numpy as np
from numpy.typing import NDArray

__all__ = [
    "__version__",
    "Image",
    "Scene",
    "fail_on_purpose",
    "fit",
    "interface",
    "png_bytes",
    "render",
    "save",
    "schema",
    "set_threads",
    "srgb",
    "threads",
    "to_toml",
    "toml_literal",
    "trace",
]

__version__: str

_Tell = Callable[[int, int], object] | None
_Map = tuple[str | None, bool]
_Tensors = tuple[NDArray[np.complex128], NDArray[np.complex128]]

@final
class Image:
    def __new__(cls, array: NDArray[Any]) -> Image: ...
    def array(self) -> NDArray[Any]: ...
    @property
    def name(self) -> str: ...

@final
class Scene:
    def __new__(
        cls,
        text: str,
        name: str,
        folder: str,
        is_file: bool,
        overrides: Sequence[str],
        photograph: Image | None = None,
        surroundings: Image | None = None,
    ) -> Scene: ...
    @staticmethod
    def load(path: str) -> Scene: ...
    @property
    def text(self) -> str: ...
    @property
    def name(self) -> str: ...
    @property
    def folder(self) -> str: ...
    @property
    def is_file(self) -> bool: ...
    @property
    def toml(self) -> str: ...
    @property
    def resolution(self) -> tuple[int, int]: ...
    @property
    def kinds(self) -> list[str]: ...
    @property
    def map(self) -> _Map: ...
    def check(self) -> None: ...

def schema() -> str: ...
def fit(table: str, entries: dict[str, Any]) -> dict[str, Any]: ...
def to_toml(tables: dict[str, dict[str, Any]], devices: Sequence[dict[str, Any]]) -> str: ...
def toml_literal(name: str, value: object) -> str: ...
def render(
    scene: Scene, image_only: bool, progress: _Tell = None
) -> tuple[dict[str, NDArray[Any]], list[tuple[str, str]], tuple[int, int]]: ...
def save(
    path: str, channels: Mapping[str, NDArray[Any]], metadata: Sequence[tuple[str, str]], map: _Map
) -> None: ...
def srgb(channels: Mapping[str, NDArray[Any]], map: _Map) -> NDArray[np.uint8]: ...
def png_bytes(
    channels: Mapping[str, NDArray[Any]], metadata: Sequence[tuple[str, str]], map: _Map
) -> bytes: ...
def trace(
    scene: Scene,
    origins: NDArray[np.float64],
    directions: NDArray[np.float64],
    polarization: str,
    fields: NDArray[np.complex128] | None,
    min_power: float | None,
    progress: _Tell = None,
) -> dict[str, NDArray[Any]]: ...
def interface(
    incident: _Tensors,
    transmitted: _Tensors | None,
    normals: NDArray[np.float64],
    tangentials: NDArray[np.float64],
    progress: _Tell = None,
) -> dict[str, Any]: ...
def set_threads(count: int) -> None: ...
def threads() -> int: ...
def fail_on_purpose() -> None: ...
