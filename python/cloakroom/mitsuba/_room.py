"""Rooms as Mitsuba writes them in XML, with devices put in the place of shapes."""

from __future__ import annotations

import itertools
import json
import re
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import mitsuba as mi
import numpy as np
from numpy.typing import NDArray

from ..scatterers import rigid
from ._shape import MIN_POWER, Box, box_of, device, scatterer_of

__all__ = ["Room", "device_of", "is_endless"]

#: The shape of a room of ours that is there for any device.
PLACE = "place"

#: A device stands so far above what it stands on, as a share of its size: rays from there start outside it.
GAP = 1e-3

#: How far the faces of a box may be from square; meshes are written in single precision.
SQUARE = 1e-4

#: By how much, relatively, a box may differ from that of a device and be its outline.
SIMILAR = 1e-3


def device_of(text: str) -> dict[str, Any]:
    """The device of a text such as ``square-cloak:length=40,rotation=10`` or, of a scene file, ``tank.toml``."""
    kind, _, rest = text.partition(":")
    if kind.endswith(".toml"):
        if rest:
            raise ValueError(f"{text}: a device of a scene file has no keys of its own")
        return {"scene": kind}
    keys: dict[str, Any] = {"kind": kind}
    # A comma within brackets is not between keys.
    for part in filter(None, re.split(r",(?![^\[]*\])", rest)):
        name, equals, value = part.partition("=")
        if not equals:
            raise ValueError(f"{text}: expected a kind and keys, such as square-cloak:length=40,rotation=10")
        keys[name.strip()] = value_of(value.strip())
    return keys


def is_endless(given: dict[str, Any]) -> bool:
    """Whether a device has no bounds as it is, and has them with a length."""

    def fails(keys: dict[str, Any]) -> bool:
        try:
            _box(keys, np.eye(4), 1.0)
        except ValueError:
            return True
        return False

    return "scene" not in given and fails(given) and not fails({**given, "length": 1.0})


def value_of(text: str) -> Any:
    """A number, a list, true, false, or else a word."""
    try:
        return json.loads(text)
    except json.JSONDecodeError:
        return text


class Room:
    """A scene of Mitsuba in XML.

    Parameters
    ----------
    path : str or path
        The file; what it names is relative to it.
    """

    def __init__(self, path: str | Path) -> None:
        self.path = Path(path)
        try:
            self.root = ElementTree.parse(self.path).getroot()
        except ElementTree.ParseError as error:
            raise ValueError(f"{self.path}: no XML: {error}") from None
        if self.root.tag != "scene":
            raise ValueError(f"{self.path}: no scene of Mitsuba, but <{self.root.tag}>")
        self._include(self.root)
        if self.root.find("sensor") is None:
            raise ValueError(f"{self.path}: no <sensor>, and so no picture")

    @property
    def shapes(self) -> list[str]:
        """What its shapes are called, as far as they have names."""
        return [name for shape in self.root.iter("shape") for name in _names(shape)[:1]]

    def _include(self, root: Any) -> None:
        """Puts the contents of other files where they are included."""
        for number, child in reversed(list(enumerate(root))):
            if child.tag == "include":
                path = self._file(child.get("filename", ""))
                try:
                    included = ElementTree.parse(path).getroot()
                except ElementTree.ParseError as error:
                    raise ValueError(f"{path}: no XML: {error}") from None
                self._include(included)
                root[number : number + 1] = list(included)

    def replace(
        self,
        name: str,
        given: dict[str, Any],
        *,
        unit: float | None = None,
        stands: bool = False,
        see_through: str | None = None,
    ) -> None:
        """Puts a device in the place of a shape: its middle where that of the shape is, turned as the shape is.

        Parameters
        ----------
        name : str
            The ``id`` of the shape or, as Blender's add-on writes it, the name of the object or its mesh.
        given : mapping
            The kind and the keys of the device, or a ``scene``.
        unit : float, optional
            How many cm the room's unit of length is; by default that of the devices that are in it, else 100.
        stands : bool, default False
            Whether the device stands where the lowest point of the shape is (y is up), instead of sharing its middle.
        see_through : str, optional
            As of `device`; by default that of the device whose place is taken, else ``"auto"``.
        """
        shape = self._shape(name)
        own = shape.find("bsdf[@type='cloakroom']")
        if unit is None:
            devices = self.root.iterfind(".//bsdf[@type='cloakroom']")
            written = [self._plain(each).find("float[@name='unit']") for each in devices]
            units = {1.0 if each is None else float(each.get("value", "1")) for each in written}
            unit = units.pop() if len(units) == 1 else 100.0
        if see_through is None:
            written_word = None if own is None else own.find("string[@name='see_through']")
            see_through = "auto" if written_word is None else written_word.get("value", "auto")
        if "scene" in given:
            given = {**given, "scene": str(self._file(given["scene"]))}
        middle, lowest, turn = self._place(self._plain(shape), own, given, unit)
        to_world = np.eye(4)
        to_world[:3, :3] = turn
        box = _box(given, to_world, unit)
        # The device's own middle may be anywhere in its frame.
        to_world[:3, 3] = middle - box.to_world[:3, 3]
        if stands:
            to_world[1, 3] = lowest - box.to_world[1, 3] + box.extent[1] + GAP * box.halves.max()
        self._write(shape, given, to_world, unit, see_through)

    def without(self, name: str) -> None:
        """Takes a shape out of the room."""
        shape = self._shape(name)
        for parent in self.root.iter():
            if shape in list(parent):
                parent.remove(shape)

    def load(
        self, *, size: tuple[int, int] | None = None, samples: int | None = None, values: dict[str, str] | None = None
    ) -> Any:
        """The scene, with the integrator ``cloakroom_path`` in the place of its own."""
        own = self.root.find("integrator")
        integrator = ElementTree.Element("integrator", type="cloakroom_path")
        for child in () if own is None else own:
            if child.get("name") in ("max_depth", "rr_depth", "hide_emitters", "max_crossings", "see_through"):
                integrator.append(child)
        if own is not None:
            self.root.remove(own)
        self.root.append(integrator)
        for film in self.root.iter("film"):
            if size is not None:
                _set(film, "width", size[0])
                _set(film, "height", size[1])
            # Sums of a box are the same bytes each time.
            for rfilter in film.findall("rfilter"):
                film.remove(rfilter)
            film.append(ElementTree.Element("rfilter", type="box"))
        if samples is not None:
            for sensor in self.root.iter("sensor"):
                sampler = sensor.find("sampler")
                if sampler is None:
                    sampler = ElementTree.SubElement(sensor, "sampler", type="independent")
                _set(sampler, "sample_count", samples)
        resolver = mi.file_resolver()
        resolver.append(str(self.path.resolve().parent))
        # As they are: meshes that Mitsuba makes one of have no bounds, and light from afar is too little then.
        return mi.load_string(ElementTree.tostring(self.root, encoding="unicode"), optimize=False, **(values or {}))

    def _shape(self, name: str) -> Any:
        asked = _clean(name)
        found = [shape for shape in self.root.iter("shape") if asked in map(_clean, _names(shape))]
        if len(found) == 1:
            if found[0] not in list(self.root):
                raise ValueError(f"{self.path}: the shape {name!r} is in a group that is instanced; a device takes a shape of the scene itself")
            return found[0]
        known = ", ".join(self.shapes) or "none has a name"
        raise ValueError(f"{self.path}: {'no shape' if not found else f'{len(found)} shapes'} called {name!r}; there are: {known}")

    def _plain(self, element: Any) -> Any:
        """A copy of a part of the scene with the values of its parameters."""
        defaults = {each.get("name", ""): each.get("value", "") for each in self.root.iter("default")}
        plain = ElementTree.fromstring(ElementTree.tostring(element))
        for each in plain.iter():
            for name, text in each.attrib.items():
                each.set(name, re.sub(r"\$(\w+)", lambda found: defaults.get(found[1], found[0]), text))
        return plain

    def _place(
        self, shape: Any, own: Any, given: dict[str, Any], unit: float
    ) -> tuple[NDArray[np.float64], float, NDArray[np.float64]]:
        """The middle of a shape, its lowest point, and how it is turned as the place of a device; of a copy, which is changed."""
        alone = ElementTree.Element("scene", version="3.0.0")
        for child in list(shape):
            if child.tag in ("bsdf", "ref", "emitter"):
                shape.remove(child)
        for file in shape.findall("string[@name='filename']"):
            file.set("value", str(self._file(file.get("value", ""))))
        alone.append(shape)
        (only,) = mi.load_string(ElementTree.tostring(alone, encoding="unicode")).shapes()
        box = only.bbox()
        low, high = np.array(box.min, np.float64).ravel(), np.array(box.max, np.float64).ravel()
        matrix = _matrix(shape)
        if np.linalg.svd(matrix)[1][-1] <= 0:
            raise ValueError(f"{self.path}: the shape {_names(shape)[:1]} is flat; it has no place for a device")
        # The rotation next to the matrix, without its scales.
        turn = _rotation_next_to(matrix / np.linalg.norm(matrix, axis=0))
        if np.array_equal(matrix, np.eye(3)) and only.is_mesh():
            # An outline is that of the device before it is turned about its own axis.
            unturned = {key: value for key, value in given.items() if key != "rotation"}
            turn = _turn_of_box(only, _box(unturned, np.eye(4), unit))
        if own is not None:
            written = own.find("transform[@name='to_world']")
            turn = np.eye(3) if written is None else _turn_of(written)
        return (low + high) / 2, float(low[1]), turn

    def _file(self, name: str) -> Path:
        path = self.path.resolve().parent / name
        return path if path.exists() else Path(name)

    @staticmethod
    def _write(shape: Any, given: dict[str, Any], to_world: NDArray[np.float64], unit: float, see_through: str) -> None:
        made = device(given, to_world, unit=unit, see_through=see_through)
        shape.set("type", made["type"])
        for child in list(shape):
            shape.remove(child)
        shape.append(_transform(np.array(made["to_world"].matrix, np.float64).reshape(4, 4)))
        bsdf = ElementTree.SubElement(shape, "bsdf", type="cloakroom")
        for name in ("scene", "kind", "keys", "see_through"):
            if name in made["bsdf"]:
                ElementTree.SubElement(bsdf, "string", name=name, value=made["bsdf"][name])
        bsdf.append(_transform(to_world))
        ElementTree.SubElement(bsdf, "float", name="unit", value=repr(float(unit)))


def _box(given: dict[str, Any], to_world: NDArray[np.float64], unit: float) -> Box:
    """The box around a device, which is the same at all wavelengths."""
    return box_of(scatterer_of(given, to_world, unit, 550.0, MIN_POWER))


def _names(shape: Any) -> list[str]:
    """What a shape may be called: its id, the mesh of Blender's add-on without its prefix, its file."""
    names = [shape.get("id"), shape.get("name")]
    names += [name.removeprefix("mesh-") for name in names if name]
    file = shape.find("string[@name='filename']")
    if file is not None:
        names.append(Path(file.get("value", "")).stem)
    return list(dict.fromkeys(name for name in names if name))


def _clean(name: str) -> str:
    """A name as Blender's add-on writes it into ids and files."""
    return re.sub(r"\W", "_", name)


def _set(element: Any, name: str, value: int) -> None:
    for child in element.findall(f"integer[@name='{name}']"):
        element.remove(child)
    ElementTree.SubElement(element, "integer", name=name, value=str(value))


def _transform(matrix: NDArray[np.float64]) -> Any:
    transform = ElementTree.Element("transform", name="to_world")
    ElementTree.SubElement(transform, "matrix", value=" ".join(repr(float(number)) for number in matrix.ravel()))
    return transform


def _matrix(shape: Any) -> NDArray[np.float64]:
    """How a shape is turned and scaled; (3, 3)."""
    written = shape.find("transform[@name='to_world']")
    return np.eye(3) if written is None else _composed(written)[:3, :3]


def _turn_of(transform: Any) -> NDArray[np.float64]:
    return rigid("to_world", _composed(transform))[:3, :3]


def _turn_of_box(mesh: Any, own: Box) -> NDArray[np.float64]:
    """How a box is turned whose corners are written in the frame of the world: of the turns that its faces allow the
    least one, below 45 degrees about each axis. If it is as wide and as high as the device's own box, it is turned from
    where that one is. Of other meshes none."""
    corners = np.array(mesh.vertex_positions_buffer(), np.float64).reshape(-1, 3)
    faces = corners[np.array(mesh.faces_buffer()).reshape(-1, 3)]
    normals = np.cross(faces[:, 1] - faces[:, 0], faces[:, 2] - faces[:, 0])
    sizes = np.linalg.norm(normals, axis=1)
    normals = normals[sizes > 0] / sizes[sizes > 0, None]
    axes: list[NDArray[np.float64]] = []
    for normal in normals:
        if all(abs(normal @ axis) < 1 - SQUARE for axis in axes):
            axes.append(normal)
    if len(axes) != 3 or any(abs(axes[one] @ axes[other]) > SQUARE for one, other in ((0, 1), (0, 2), (1, 2))):
        return np.eye(3)
    found, halves = np.column_stack(axes), np.array([np.ptp(corners @ axis) / 2 for axis in axes])
    orders = [list(order) for order in itertools.permutations(range(3))]
    outlines = [order for order in orders if not own.ball and np.allclose(halves[order][:2], own.halves[:2], rtol=SIMILAR)]
    frame = own.to_world[:3, :3] if outlines else np.eye(3)
    # Of all rotations from one frame to the other that next to none.
    turns = []
    for order in outlines or orders:
        for signs in itertools.product((1, -1), repeat=3):
            turn = found[:, order] * signs @ frame.T
            if np.linalg.det(turn) > 0:
                turns.append(turn)
    return _rotation_next_to(max(turns, key=np.trace))


def _rotation_next_to(matrix: NDArray[np.float64]) -> NDArray[np.float64]:
    turn, _, other = np.linalg.svd(matrix)
    rotation: NDArray[np.float64] = turn @ np.diag([1, 1, np.linalg.det(turn @ other)]) @ other
    return rotation


def _composed(steps: Iterable[Any]) -> NDArray[np.float64]:
    """The product of the steps of a transform, the first one applied first."""
    matrix = np.eye(4)
    for step in steps:
        matrix = _STEPS[step.tag](step) @ matrix
    return matrix


def _numbers(step: Any, default: float) -> NDArray[np.float64]:
    if "value" in step.attrib:
        numbers = [float(number) for number in re.split(r"[,\s]+", step.get("value").strip())]
        return np.array(numbers * 3 if len(numbers) == 1 else numbers)
    return np.array([float(step.get(axis, default)) for axis in "xyz"])


def _translate(step: Any) -> NDArray[np.float64]:
    matrix = np.eye(4)
    matrix[:3, 3] = _numbers(step, 0)
    return matrix


def _rotate(step: Any) -> NDArray[np.float64]:
    numbers = _numbers(step, 0)
    axis = mi.ScalarVector3f(*(numbers / np.linalg.norm(numbers)))
    return np.array(mi.ScalarTransform4f().rotate(axis, float(step.get("angle", "0"))).matrix, np.float64).reshape(4, 4)


def _scale(step: Any) -> NDArray[np.float64]:
    return np.diag([*_numbers(step, 1), 1.0])


def _lookat(step: Any) -> NDArray[np.float64]:
    points = [mi.ScalarPoint3f(*map(float, re.split(r"[,\s]+", step.get(name, default).strip()))) for name, default in (
        ("origin", "0 0 0"), ("target", "0 0 1"), ("up", "0 1 0"))]
    return np.array(mi.ScalarTransform4f().look_at(*points).matrix, np.float64).reshape(4, 4)


def _written_matrix(step: Any) -> NDArray[np.float64]:
    numbers = np.array([float(number) for number in re.split(r"[,\s]+", step.get("value").strip())])
    matrix = np.eye(4)
    size = int(np.sqrt(len(numbers)))
    matrix[:size, :size] = numbers.reshape(size, size)
    return matrix


_STEPS: dict[str, Callable[[Any], NDArray[np.float64]]] = {
    "translate": _translate,
    "rotate": _rotate,
    "scale": _scale,
    "lookat": _lookat,
    "matrix": _written_matrix,
}
