# Made by stubs.py from the catalogue of devices; do not edit.
import os
from collections.abc import Callable, Mapping, Sequence
from typing import Any, Literal, TypeVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _cloakroom

_Self = TypeVar("_Self", bound="Table")
_Image = str | os.PathLike[str] | ArrayLike
_Index = str | os.PathLike[str] | ArrayLike | Callable[[NDArray[np.float64], NDArray[np.float64]], ArrayLike]

class Table:
    _table: str
    _properties: dict[str, dict[str, Any]]
    _image: _cloakroom.Image | None
    def __init__(self, **keys: Any) -> None: ...
    def given(self) -> dict[str, Any]: ...
    def replace(self: _Self, **keys: Any) -> _Self: ...
    def __eq__(self, other: object) -> bool: ...

class Device(Table):
    kind: str

def class_name(kind: str) -> str: ...

DEVICES: dict[str, type[Device]]
TABLES: dict[str, type[Table]]

class SquareCloak(Device):
    def __init__(
        self,
        *,
        axis: ArrayLike | None = ...,
        core: Literal["metal", "open"] | None = ...,
        dispersion: Literal["causal", "none"] | None = ...,
        imperfection: Mapping[str, Any] | None = ...,
        kappa: float | None = ...,
        length: float | None = ...,
        material: Literal["impedance-matched", "positive-uniaxial", "negative-uniaxial"] | None = ...,
        position: ArrayLike | None = ...,
        rotation: float | None = ...,
        rounded: bool | None = ...,
        show: Literal["cloak", "bare", "mirror"] | None = ...,
        side: float | None = ...,
    ) -> None: ...
    @property
    def axis(self) -> list[Any]: ...
    @property
    def core(self) -> Literal["metal", "open"]: ...
    @property
    def dispersion(self) -> Literal["causal", "none"]: ...
    @property
    def imperfection(self) -> dict[str, Any] | None: ...
    @property
    def kappa(self) -> float: ...
    @property
    def length(self) -> float | None: ...
    @property
    def material(self) -> Literal["impedance-matched", "positive-uniaxial", "negative-uniaxial"]: ...
    @property
    def position(self) -> list[Any]: ...
    @property
    def rotation(self) -> float: ...
    @property
    def rounded(self) -> bool: ...
    @property
    def show(self) -> Literal["cloak", "bare", "mirror"]: ...
    @property
    def side(self) -> float: ...

class DoubleGaussianCloak(Device):
    def __init__(
        self,
        *,
        axis: ArrayLike | None = ...,
        core: Literal["metal", "open"] | None = ...,
        dispersion: Literal["causal", "none"] | None = ...,
        fresnel: bool | None = ...,
        h: float | None = ...,
        height: float | None = ...,
        imperfection: Mapping[str, Any] | None = ...,
        length: float | None = ...,
        position: ArrayLike | None = ...,
        referenced: bool | None = ...,
        rotation: float | None = ...,
        show: Literal["cloak", "bare", "mirror"] | None = ...,
        w: float | None = ...,
        width: float | None = ...,
    ) -> None: ...
    @property
    def axis(self) -> list[Any]: ...
    @property
    def core(self) -> Literal["metal", "open"]: ...
    @property
    def dispersion(self) -> Literal["causal", "none"]: ...
    @property
    def fresnel(self) -> bool: ...
    @property
    def h(self) -> float: ...
    @property
    def height(self) -> float: ...
    @property
    def imperfection(self) -> dict[str, Any] | None: ...
    @property
    def length(self) -> float | None: ...
    @property
    def position(self) -> list[Any]: ...
    @property
    def referenced(self) -> bool: ...
    @property
    def rotation(self) -> float: ...
    @property
    def show(self) -> Literal["cloak", "bare", "mirror"]: ...
    @property
    def w(self) -> float: ...
    @property
    def width(self) -> float: ...

class CylinderCloak(Device):
    def __init__(
        self,
        *,
        axis: ArrayLike | None = ...,
        core: Literal["metal", "open"] | None = ...,
        dispersion: Literal["causal", "none"] | None = ...,
        imperfection: Mapping[str, Any] | None = ...,
        inner: float | None = ...,
        length: float | None = ...,
        material: Literal["impedance-matched", "radial-uniaxial", "azimuthal-uniaxial"] | None = ...,
        outer: float | None = ...,
        position: ArrayLike | None = ...,
        rotation: float | None = ...,
        show: Literal["cloak", "bare", "mirror"] | None = ...,
    ) -> None: ...
    @property
    def axis(self) -> list[Any]: ...
    @property
    def core(self) -> Literal["metal", "open"]: ...
    @property
    def dispersion(self) -> Literal["causal", "none"]: ...
    @property
    def imperfection(self) -> dict[str, Any] | None: ...
    @property
    def inner(self) -> float: ...
    @property
    def length(self) -> float | None: ...
    @property
    def material(self) -> Literal["impedance-matched", "radial-uniaxial", "azimuthal-uniaxial"]: ...
    @property
    def outer(self) -> float: ...
    @property
    def position(self) -> list[Any]: ...
    @property
    def rotation(self) -> float: ...
    @property
    def show(self) -> Literal["cloak", "bare", "mirror"]: ...

class SphereCloak(Device):
    def __init__(
        self,
        *,
        axis: ArrayLike | None = ...,
        core: Literal["metal", "open"] | None = ...,
        dispersion: Literal["causal", "none"] | None = ...,
        imperfection: Mapping[str, Any] | None = ...,
        inner: float | None = ...,
        length: float | None = ...,
        outer: float | None = ...,
        position: ArrayLike | None = ...,
        rotation: float | None = ...,
        show: Literal["cloak", "bare", "mirror"] | None = ...,
    ) -> None: ...
    @property
    def axis(self) -> list[Any]: ...
    @property
    def core(self) -> Literal["metal", "open"]: ...
    @property
    def dispersion(self) -> Literal["causal", "none"]: ...
    @property
    def imperfection(self) -> dict[str, Any] | None: ...
    @property
    def inner(self) -> float: ...
    @property
    def length(self) -> float | None: ...
    @property
    def outer(self) -> float: ...
    @property
    def position(self) -> list[Any]: ...
    @property
    def rotation(self) -> float: ...
    @property
    def show(self) -> Literal["cloak", "bare", "mirror"]: ...

class InvisibleSphere(Device):
    def __init__(
        self,
        *,
        axis: ArrayLike | None = ...,
        core: Literal["metal", "open"] | None = ...,
        dispersion: Literal["causal", "none"] | None = ...,
        imperfection: Mapping[str, Any] | None = ...,
        length: float | None = ...,
        material: Literal["graded", "regularized"] | None = ...,
        position: ArrayLike | None = ...,
        radius: float | None = ...,
        rotation: float | None = ...,
        show: Literal["cloak", "bare", "mirror"] | None = ...,
    ) -> None: ...
    @property
    def axis(self) -> list[Any]: ...
    @property
    def core(self) -> Literal["metal", "open"]: ...
    @property
    def dispersion(self) -> Literal["causal", "none"]: ...
    @property
    def imperfection(self) -> dict[str, Any] | None: ...
    @property
    def length(self) -> float | None: ...
    @property
    def material(self) -> Literal["graded", "regularized"]: ...
    @property
    def position(self) -> list[Any]: ...
    @property
    def radius(self) -> float: ...
    @property
    def rotation(self) -> float: ...
    @property
    def show(self) -> Literal["cloak", "bare", "mirror"]: ...

class BendingSphere(Device):
    def __init__(
        self,
        *,
        angle: float | None = ...,
        axis: ArrayLike | None = ...,
        core: Literal["metal", "open"] | None = ...,
        dispersion: Literal["causal", "none"] | None = ...,
        imperfection: Mapping[str, Any] | None = ...,
        length: float | None = ...,
        position: ArrayLike | None = ...,
        radius: float | None = ...,
        rotation: float | None = ...,
        show: Literal["cloak", "bare", "mirror"] | None = ...,
    ) -> None: ...
    @property
    def angle(self) -> float: ...
    @property
    def axis(self) -> list[Any]: ...
    @property
    def core(self) -> Literal["metal", "open"]: ...
    @property
    def dispersion(self) -> Literal["causal", "none"]: ...
    @property
    def imperfection(self) -> dict[str, Any] | None: ...
    @property
    def length(self) -> float | None: ...
    @property
    def position(self) -> list[Any]: ...
    @property
    def radius(self) -> float: ...
    @property
    def rotation(self) -> float: ...
    @property
    def show(self) -> Literal["cloak", "bare", "mirror"]: ...

class EatonLens(Device):
    def __init__(
        self,
        *,
        axis: ArrayLike | None = ...,
        core: Literal["metal", "open"] | None = ...,
        dispersion: Literal["causal", "none"] | None = ...,
        imperfection: Mapping[str, Any] | None = ...,
        length: float | None = ...,
        position: ArrayLike | None = ...,
        radius: float | None = ...,
        rotation: float | None = ...,
        show: Literal["cloak", "bare", "mirror"] | None = ...,
    ) -> None: ...
    @property
    def axis(self) -> list[Any]: ...
    @property
    def core(self) -> Literal["metal", "open"]: ...
    @property
    def dispersion(self) -> Literal["causal", "none"]: ...
    @property
    def imperfection(self) -> dict[str, Any] | None: ...
    @property
    def length(self) -> float | None: ...
    @property
    def position(self) -> list[Any]: ...
    @property
    def radius(self) -> float: ...
    @property
    def rotation(self) -> float: ...
    @property
    def show(self) -> Literal["cloak", "bare", "mirror"]: ...

class LuneburgLens(Device):
    def __init__(
        self,
        *,
        axis: ArrayLike | None = ...,
        core: Literal["metal", "open"] | None = ...,
        dispersion: Literal["causal", "none"] | None = ...,
        imperfection: Mapping[str, Any] | None = ...,
        length: float | None = ...,
        position: ArrayLike | None = ...,
        radius: float | None = ...,
        rotation: float | None = ...,
        show: Literal["cloak", "bare", "mirror"] | None = ...,
    ) -> None: ...
    @property
    def axis(self) -> list[Any]: ...
    @property
    def core(self) -> Literal["metal", "open"]: ...
    @property
    def dispersion(self) -> Literal["causal", "none"]: ...
    @property
    def imperfection(self) -> dict[str, Any] | None: ...
    @property
    def length(self) -> float | None: ...
    @property
    def position(self) -> list[Any]: ...
    @property
    def radius(self) -> float: ...
    @property
    def rotation(self) -> float: ...
    @property
    def show(self) -> Literal["cloak", "bare", "mirror"]: ...

class FisheyeLens(Device):
    def __init__(
        self,
        *,
        axis: ArrayLike | None = ...,
        core: Literal["metal", "open"] | None = ...,
        dispersion: Literal["causal", "none"] | None = ...,
        imperfection: Mapping[str, Any] | None = ...,
        length: float | None = ...,
        position: ArrayLike | None = ...,
        radius: float | None = ...,
        rotation: float | None = ...,
        show: Literal["cloak", "bare", "mirror"] | None = ...,
    ) -> None: ...
    @property
    def axis(self) -> list[Any]: ...
    @property
    def core(self) -> Literal["metal", "open"]: ...
    @property
    def dispersion(self) -> Literal["causal", "none"]: ...
    @property
    def imperfection(self) -> dict[str, Any] | None: ...
    @property
    def length(self) -> float | None: ...
    @property
    def position(self) -> list[Any]: ...
    @property
    def radius(self) -> float: ...
    @property
    def rotation(self) -> float: ...
    @property
    def show(self) -> Literal["cloak", "bare", "mirror"]: ...

class FisheyeHemisphere(Device):
    def __init__(
        self,
        *,
        axis: ArrayLike | None = ...,
        core: Literal["metal", "open"] | None = ...,
        cut_distance: float | None = ...,
        cut_normal: ArrayLike | None = ...,
        dispersion: Literal["causal", "none"] | None = ...,
        imperfection: Mapping[str, Any] | None = ...,
        index: float | None = ...,
        length: float | None = ...,
        position: ArrayLike | None = ...,
        radius: float | None = ...,
        rotation: float | None = ...,
        show: Literal["cloak", "bare", "mirror"] | None = ...,
    ) -> None: ...
    @property
    def axis(self) -> list[Any]: ...
    @property
    def core(self) -> Literal["metal", "open"]: ...
    @property
    def cut_distance(self) -> float: ...
    @property
    def cut_normal(self) -> list[Any]: ...
    @property
    def dispersion(self) -> Literal["causal", "none"]: ...
    @property
    def imperfection(self) -> dict[str, Any] | None: ...
    @property
    def index(self) -> float: ...
    @property
    def length(self) -> float | None: ...
    @property
    def position(self) -> list[Any]: ...
    @property
    def radius(self) -> float: ...
    @property
    def rotation(self) -> float: ...
    @property
    def show(self) -> Literal["cloak", "bare", "mirror"]: ...

class MirrorDetour(Device):
    def __init__(
        self,
        *,
        axis: ArrayLike | None = ...,
        core: Literal["metal", "open"] | None = ...,
        dispersion: Literal["causal", "none"] | None = ...,
        half_length: float | None = ...,
        imperfection: Mapping[str, Any] | None = ...,
        length: float | None = ...,
        offset: float | None = ...,
        position: ArrayLike | None = ...,
        rotation: float | None = ...,
        show: Literal["cloak", "bare", "mirror"] | None = ...,
    ) -> None: ...
    @property
    def axis(self) -> list[Any]: ...
    @property
    def core(self) -> Literal["metal", "open"]: ...
    @property
    def dispersion(self) -> Literal["causal", "none"]: ...
    @property
    def half_length(self) -> float: ...
    @property
    def imperfection(self) -> dict[str, Any] | None: ...
    @property
    def length(self) -> float | None: ...
    @property
    def offset(self) -> float: ...
    @property
    def position(self) -> list[Any]: ...
    @property
    def rotation(self) -> float: ...
    @property
    def show(self) -> Literal["cloak", "bare", "mirror"]: ...

class Prisms(Device):
    def __init__(
        self,
        *,
        axis: ArrayLike | None = ...,
        core: Literal["metal", "open"] | None = ...,
        dispersion: Literal["causal", "none"] | None = ...,
        imperfection: Mapping[str, Any] | None = ...,
        length: float | None = ...,
        position: ArrayLike | None = ...,
        prism: Sequence[Mapping[str, Any]] | None = ...,
        rotation: float | None = ...,
        show: Literal["cloak", "bare", "mirror"] | None = ...,
    ) -> None: ...
    @property
    def axis(self) -> list[Any]: ...
    @property
    def core(self) -> Literal["metal", "open"]: ...
    @property
    def dispersion(self) -> Literal["causal", "none"]: ...
    @property
    def imperfection(self) -> dict[str, Any] | None: ...
    @property
    def length(self) -> float | None: ...
    @property
    def position(self) -> list[Any]: ...
    @property
    def prism(self) -> list[dict[str, Any]]: ...
    @property
    def rotation(self) -> float: ...
    @property
    def show(self) -> Literal["cloak", "bare", "mirror"]: ...

class Graded(Device):
    def __init__(
        self,
        *,
        axis: ArrayLike | None = ...,
        core: Literal["metal", "open"] | None = ...,
        dispersion: Literal["causal", "none"] | None = ...,
        height: float | None = ...,
        imperfection: Mapping[str, Any] | None = ...,
        index: _Index | None = ...,
        inner: float | None = ...,
        length: float | None = ...,
        position: ArrayLike | None = ...,
        rotation: float | None = ...,
        shape: Literal["rectangle", "circle"] | None = ...,
        show: Literal["cloak", "bare", "mirror"] | None = ...,
        width: float | None = ...,
        spacing: float | None = ...,
    ) -> None: ...
    @property
    def axis(self) -> list[Any]: ...
    @property
    def core(self) -> Literal["metal", "open"]: ...
    @property
    def dispersion(self) -> Literal["causal", "none"]: ...
    @property
    def height(self) -> float: ...
    @property
    def imperfection(self) -> dict[str, Any] | None: ...
    @property
    def index(self) -> str | list[list[float]] | None: ...
    @property
    def inner(self) -> float: ...
    @property
    def length(self) -> float | None: ...
    @property
    def position(self) -> list[Any]: ...
    @property
    def rotation(self) -> float: ...
    @property
    def shape(self) -> Literal["rectangle", "circle"]: ...
    @property
    def show(self) -> Literal["cloak", "bare", "mirror"]: ...
    @property
    def width(self) -> float: ...

class GradedBox(Device):
    def __init__(
        self,
        *,
        axis: ArrayLike | None = ...,
        core: Literal["metal", "open"] | None = ...,
        dispersion: Literal["causal", "none"] | None = ...,
        gradient: ArrayLike | None = ...,
        imperfection: Mapping[str, Any] | None = ...,
        index: float | None = ...,
        length: float | None = ...,
        position: ArrayLike | None = ...,
        rotation: float | None = ...,
        show: Literal["cloak", "bare", "mirror"] | None = ...,
        sides: ArrayLike | None = ...,
    ) -> None: ...
    @property
    def axis(self) -> list[Any]: ...
    @property
    def core(self) -> Literal["metal", "open"]: ...
    @property
    def dispersion(self) -> Literal["causal", "none"]: ...
    @property
    def gradient(self) -> list[Any]: ...
    @property
    def imperfection(self) -> dict[str, Any] | None: ...
    @property
    def index(self) -> float: ...
    @property
    def length(self) -> float | None: ...
    @property
    def position(self) -> list[Any]: ...
    @property
    def rotation(self) -> float: ...
    @property
    def show(self) -> Literal["cloak", "bare", "mirror"]: ...
    @property
    def sides(self) -> list[Any]: ...

class Body(Device):
    def __init__(
        self,
        *,
        axis: ArrayLike | None = ...,
        core: Literal["metal", "open"] | None = ...,
        dispersion: Literal["causal", "none"] | None = ...,
        group_index: float | None = ...,
        imperfection: Mapping[str, Any] | None = ...,
        length: float | None = ...,
        permeability: ArrayLike | None = ...,
        permittivity: ArrayLike | None = ...,
        position: ArrayLike | None = ...,
        priority: int | None = ...,
        radius: float | None = ...,
        rotation: float | None = ...,
        shape: Literal["slab", "box", "sphere", "cylinder"] | None = ...,
        show: Literal["cloak", "bare", "mirror"] | None = ...,
        size: ArrayLike | None = ...,
        surface: Mapping[str, Any] | None = ...,
        thickness: float | None = ...,
    ) -> None: ...
    @property
    def axis(self) -> list[Any]: ...
    @property
    def core(self) -> Literal["metal", "open"]: ...
    @property
    def dispersion(self) -> Literal["causal", "none"]: ...
    @property
    def group_index(self) -> float | None: ...
    @property
    def imperfection(self) -> dict[str, Any] | None: ...
    @property
    def length(self) -> float | None: ...
    @property
    def permeability(self) -> Any: ...
    @property
    def permittivity(self) -> Any: ...
    @property
    def position(self) -> list[Any]: ...
    @property
    def priority(self) -> int: ...
    @property
    def radius(self) -> float: ...
    @property
    def rotation(self) -> float: ...
    @property
    def shape(self) -> Literal["slab", "box", "sphere", "cylinder"]: ...
    @property
    def show(self) -> Literal["cloak", "bare", "mirror"]: ...
    @property
    def size(self) -> list[Any]: ...
    @property
    def surface(self) -> dict[str, Any] | None: ...
    @property
    def thickness(self) -> float: ...

class Polarizer(Device):
    def __init__(
        self,
        *,
        angle: float | None = ...,
        axis: ArrayLike | None = ...,
        core: Literal["metal", "open"] | None = ...,
        dispersion: Literal["causal", "none"] | None = ...,
        imperfection: Mapping[str, Any] | None = ...,
        length: float | None = ...,
        position: ArrayLike | None = ...,
        rotation: float | None = ...,
        show: Literal["cloak", "bare", "mirror"] | None = ...,
        width: float | None = ...,
    ) -> None: ...
    @property
    def angle(self) -> float: ...
    @property
    def axis(self) -> list[Any]: ...
    @property
    def core(self) -> Literal["metal", "open"]: ...
    @property
    def dispersion(self) -> Literal["causal", "none"]: ...
    @property
    def imperfection(self) -> dict[str, Any] | None: ...
    @property
    def length(self) -> float | None: ...
    @property
    def position(self) -> list[Any]: ...
    @property
    def rotation(self) -> float: ...
    @property
    def show(self) -> Literal["cloak", "bare", "mirror"]: ...
    @property
    def width(self) -> float: ...

class GaussianCarpet(Device):
    def __init__(
        self,
        *,
        axis: ArrayLike | None = ...,
        core: Literal["metal", "open"] | None = ...,
        dispersion: Literal["causal", "none"] | None = ...,
        floor: float | None = ...,
        h: float | None = ...,
        height: float | None = ...,
        imperfection: Mapping[str, Any] | None = ...,
        length: float | None = ...,
        position: ArrayLike | None = ...,
        rotation: float | None = ...,
        show: Literal["cloak", "bare", "mirror"] | None = ...,
        w: float | None = ...,
        width: float | None = ...,
    ) -> None: ...
    @property
    def axis(self) -> list[Any]: ...
    @property
    def core(self) -> Literal["metal", "open"]: ...
    @property
    def dispersion(self) -> Literal["causal", "none"]: ...
    @property
    def floor(self) -> float: ...
    @property
    def h(self) -> float: ...
    @property
    def height(self) -> float: ...
    @property
    def imperfection(self) -> dict[str, Any] | None: ...
    @property
    def length(self) -> float | None: ...
    @property
    def position(self) -> list[Any]: ...
    @property
    def rotation(self) -> float: ...
    @property
    def show(self) -> Literal["cloak", "bare", "mirror"]: ...
    @property
    def w(self) -> float: ...
    @property
    def width(self) -> float: ...

class GratingCarpet(Device):
    def __init__(
        self,
        *,
        axis: ArrayLike | None = ...,
        core: Literal["metal", "open"] | None = ...,
        dispersion: Literal["causal", "none"] | None = ...,
        floor: float | None = ...,
        h: float | None = ...,
        height: float | None = ...,
        imperfection: Mapping[str, Any] | None = ...,
        length: float | None = ...,
        period: float | None = ...,
        position: ArrayLike | None = ...,
        rotation: float | None = ...,
        show: Literal["cloak", "bare", "mirror"] | None = ...,
        width: float | None = ...,
    ) -> None: ...
    @property
    def axis(self) -> list[Any]: ...
    @property
    def core(self) -> Literal["metal", "open"]: ...
    @property
    def dispersion(self) -> Literal["causal", "none"]: ...
    @property
    def floor(self) -> float: ...
    @property
    def h(self) -> float: ...
    @property
    def height(self) -> float: ...
    @property
    def imperfection(self) -> dict[str, Any] | None: ...
    @property
    def length(self) -> float | None: ...
    @property
    def period(self) -> float: ...
    @property
    def position(self) -> list[Any]: ...
    @property
    def rotation(self) -> float: ...
    @property
    def show(self) -> Literal["cloak", "bare", "mirror"]: ...
    @property
    def width(self) -> float: ...

class QuasiConformalCarpet(Device):
    def __init__(
        self,
        *,
        axis: ArrayLike | None = ...,
        core: Literal["metal", "open"] | None = ...,
        dispersion: Literal["causal", "none"] | None = ...,
        floor: float | None = ...,
        h: float | None = ...,
        height: float | None = ...,
        imperfection: Mapping[str, Any] | None = ...,
        length: float | None = ...,
        position: ArrayLike | None = ...,
        rotation: float | None = ...,
        show: Literal["cloak", "bare", "mirror"] | None = ...,
        w: float | None = ...,
        width: float | None = ...,
    ) -> None: ...
    @property
    def axis(self) -> list[Any]: ...
    @property
    def core(self) -> Literal["metal", "open"]: ...
    @property
    def dispersion(self) -> Literal["causal", "none"]: ...
    @property
    def floor(self) -> float: ...
    @property
    def h(self) -> float: ...
    @property
    def height(self) -> float: ...
    @property
    def imperfection(self) -> dict[str, Any] | None: ...
    @property
    def length(self) -> float | None: ...
    @property
    def position(self) -> list[Any]: ...
    @property
    def rotation(self) -> float: ...
    @property
    def show(self) -> Literal["cloak", "bare", "mirror"]: ...
    @property
    def w(self) -> float: ...
    @property
    def width(self) -> float: ...

class Camera(Table):
    def __init__(
        self,
        *,
        adaptive: float | None = ...,
        field_of_view: float | None = ...,
        polarizer: Literal["none", "horizontal", "vertical"] | float | None = ...,
        position: ArrayLike | None = ...,
        projection: Literal["perspective", "orthographic"] | None = ...,
        resolution: ArrayLike | None = ...,
        samples: int | None = ...,
        seed: int | None = ...,
        target: ArrayLike | None = ...,
        up: ArrayLike | None = ...,
        width: float | None = ...,
    ) -> None: ...
    @property
    def adaptive(self) -> float: ...
    @property
    def field_of_view(self) -> float: ...
    @property
    def polarizer(self) -> Literal["none", "horizontal", "vertical"] | float: ...
    @property
    def position(self) -> list[Any]: ...
    @property
    def projection(self) -> Literal["perspective", "orthographic"]: ...
    @property
    def resolution(self) -> list[Any]: ...
    @property
    def samples(self) -> int: ...
    @property
    def seed(self) -> int: ...
    @property
    def target(self) -> list[Any]: ...
    @property
    def up(self) -> list[Any]: ...
    @property
    def width(self) -> float | None: ...

class Light(Table):
    def __init__(
        self,
        *,
        bandwidth_nm: float | None = ...,
        wavelength_nm: float | None = ...,
    ) -> None: ...
    @property
    def bandwidth_nm(self) -> float: ...
    @property
    def wavelength_nm(self) -> float: ...

class Photograph(Table):
    def __init__(
        self,
        *,
        image: _Image | None = ...,
        normal: ArrayLike | None = ...,
        position: ArrayLike | None = ...,
        up: ArrayLike | None = ...,
        width: float | None = ...,
        x: float | None = ...,
    ) -> None: ...
    @property
    def image(self) -> str: ...
    @property
    def normal(self) -> list[Any]: ...
    @property
    def position(self) -> list[Any]: ...
    @property
    def up(self) -> list[Any]: ...
    @property
    def width(self) -> float | None: ...
    @property
    def x(self) -> float: ...

class PictureSettings(Table):
    def __init__(
        self,
        *,
        channels: Sequence[Literal["stokes", "extraordinary_share", "first_face_reflectance", "group_delay"]] | None = ...,
        color_bar: bool | None = ...,
        map: Literal["none", "time_of_flight", "time_of_flight_spread", "time_of_flight_difference", "group_delay", "group_delay_spread", "group_delay_difference", "delivered", "escaped", "absorbed", "pruned", "extraordinary_share", "first_face_reflectance"] | None = ...,
    ) -> None: ...
    @property
    def channels(self) -> list[Literal["stokes", "extraordinary_share", "first_face_reflectance", "group_delay"]]: ...
    @property
    def color_bar(self) -> bool: ...
    @property
    def map(self) -> Literal["none", "time_of_flight", "time_of_flight_spread", "time_of_flight_difference", "group_delay", "group_delay_spread", "group_delay_difference", "delivered", "escaped", "absorbed", "pruned", "extraordinary_share", "first_face_reflectance"]: ...

class Receiver(Table):
    def __init__(
        self,
        *,
        length: float | None = ...,
        normal: ArrayLike | None = ...,
        position: ArrayLike | None = ...,
        width: float | None = ...,
    ) -> None: ...
    @property
    def length(self) -> float: ...
    @property
    def normal(self) -> list[Any]: ...
    @property
    def position(self) -> list[Any]: ...
    @property
    def width(self) -> float: ...

class Surroundings(Table):
    def __init__(
        self,
        *,
        color: ArrayLike | None = ...,
        image: _Image | None = ...,
    ) -> None: ...
    @property
    def color(self) -> list[Any]: ...
    @property
    def image(self) -> str | None: ...

class TraceSettings(Table):
    def __init__(
        self,
        *,
        min_power: float | None = ...,
        tolerance: float | None = ...,
    ) -> None: ...
    @property
    def min_power(self) -> float: ...
    @property
    def tolerance(self) -> float: ...

__all__ = ["DEVICES", "TABLES", "Device", "Table", "class_name", "SquareCloak", "DoubleGaussianCloak", "CylinderCloak", "SphereCloak", "InvisibleSphere", "BendingSphere", "EatonLens", "LuneburgLens", "FisheyeLens", "FisheyeHemisphere", "MirrorDetour", "Prisms", "Graded", "GradedBox", "Body", "Polarizer", "GaussianCarpet", "GratingCarpet", "QuasiConformalCarpet", "Camera", "Light", "Photograph", "PictureSettings", "Receiver", "Surroundings", "TraceSettings"]
