"""The tables of a scene as classes, devices among them.

Every class here is made from the one description of scene files that the program has: the keys, their defaults,
units and limits are those that ``cloakroom devices`` and ``cloakroom schema`` print. Lengths are in cm, angles in
degrees.
"""

from __future__ import annotations

import inspect
import json
import os
import textwrap
from collections.abc import Mapping
from typing import Any

import numpy as np

from . import _cloakroom
from ._arrays import image_of, is_image_array, numbers
from ._index import SPACING, check_shapes, grid_array, index_array

_SCHEMA: dict[str, Any] = json.loads(_cloakroom.schema())

#: Classes of tables whose table's name is that of something else in Python.
_NAMES = {"trace": "TraceSettings", "picture": "PictureSettings"}


def _refuse(self: Any, *values: Any, **keys: Any) -> Any:
    raise TypeError("tables do not change, nor do lists and tables in them; .replace(KEY=...) gives another one")


class _FixedList(list[Any]):
    """A list in a table."""

    __setitem__ = __delitem__ = __iadd__ = __imul__ = _refuse
    append = extend = insert = remove = pop = clear = sort = reverse = _refuse

    def __reduce_ex__(self, protocol: Any) -> Any:
        # A copy is a list like any other.
        return list, (_plain(self),)


class _FixedDict(dict[str, Any]):
    """A table in a table."""

    __setitem__ = __delitem__ = __ior__ = _refuse
    pop = popitem = clear = update = setdefault = _refuse

    def __reduce_ex__(self, protocol: Any) -> Any:
        return dict, (_plain(self),)


def _fixed(value: Any) -> Any:
    """A value in which lists and tables do not change."""
    if isinstance(value, dict):
        return _FixedDict((name, _fixed(inner)) for name, inner in value.items())
    if isinstance(value, list):
        inner = value and isinstance(value[0], (list, dict))
        return _FixedList(map(_fixed, value) if inner else value)
    return value


def _plain(value: Any) -> Any:
    """A copy that is the caller's own."""
    if isinstance(value, dict):
        return {name: _plain(inner) for name, inner in value.items()}
    if isinstance(value, list):
        inner = value and isinstance(value[0], (list, dict))
        return list(map(_plain, value)) if inner else list(value)
    return value


class Table:
    """A table of a scene: keys and their values.

    Keys that are not given, or given as ``None``, are at their defaults. Every value is held against its key at once.

    Raises
    ------
    TypeError
        For a key that does not exist, or a value of a type that no key takes.
    ValueError
        For a value that does not fit its key.
    """

    _table: str = ""
    _properties: dict[str, dict[str, Any]] = {}
    _image: _cloakroom.Image | None = None

    def __init__(self, *values: Any, **keys: Any) -> None:
        if values:
            name, first = type(self).__name__, next(iter(self._properties), "key")
            raise TypeError(f"{name}({values[0]!r}): keys are given by name, as in {name}({first}=...)")
        if not self._table:
            raise TypeError(f"{type(self).__name__} is what tables have in common; take one of its subclasses")
        given = {name: value for name, value in keys.items() if value is not None}
        if "image" in self._properties:
            image, encoding = given.get("image"), given.pop("encoding", None)
            if is_image_array(image):
                image = image_of("image", image, encoding)
            elif encoding is not None:
                raise ValueError("encoding is that of arrays; a file says by its format what its numbers are")
            if isinstance(image, _cloakroom.Image):
                self._image, given["image"] = image, image.name
        self._given = _fixed(_cloakroom.fit(self._table, given))

    @classmethod
    def _of(cls, keys: Mapping[str, Any], image: _cloakroom.Image | None = None) -> Any:
        """One of what a scene file says, and the array that is its image."""
        table = object.__new__(cls)
        table._given = _fixed(_cloakroom.fit(cls._table, dict(keys)))
        table._image = image
        return table

    def given(self) -> dict[str, Any]:
        """The keys that were given, with their values as a scene file writes them."""
        return dict(_plain(self._given))

    def replace(self, **keys: Any) -> Any:
        """The same table with some keys changed; ``None`` takes a key back to its default."""
        image = {} if self._image is None else {"image": self._image}
        return type(self)(**{**self._given, **image, **keys})

    def __setattr__(self, name: str, value: object) -> None:
        # What is set would be kept and never read.
        if not name.startswith("_"):
            if name not in self._properties:
                try:
                    _cloakroom.fit(self._table, {name: value})
                except TypeError as error:
                    raise AttributeError(str(error)) from None
            raise AttributeError(f"tables do not change; .replace({name}=...) gives another one")
        super().__setattr__(name, value)

    def __repr__(self) -> str:
        keys = ", ".join(f"{name}={value!r}" for name, value in self._given.items())
        return f"{type(self).__name__}({keys})"

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Table):
            return NotImplemented
        same = type(self) is type(other) and self._given == other._given
        return same and self._image == other._image

    __hash__ = None  # type: ignore[assignment]

    def __reduce__(self) -> tuple[Any, ...]:
        return _rebuild, (type(self).__name__, self._given, None if self._image is None else self._image.array())


class Device(Table):
    """A device of a scene: the class of every device of the catalogue is made from this one."""

    #: The kind as scene files write it.
    kind: str = ""


class _Graded(Device):
    """A device whose index may be an array or a function."""

    def __init__(self, **keys: Any) -> None:
        spacing, index = keys.pop("spacing", None), keys.get("index")
        if index is not None:
            # Sizes that do not fit are told as those of any device.
            kept = {name: keys[name] for name in ("width", "height", "inner") if keys.get(name) is not None}
            kept = _cloakroom.fit(self._table, kept)
            width, height, inner = (
                kept.get(name, self._properties[name]["default"]) for name in ("width", "height", "inner")
            )
            keys["index"] = index_array(index, (width, height), inner, spacing)
        for name, most in (("ratio", 3), ("optic_axis", 4)):
            if keys.get(name) is not None:
                keys[name] = grid_array(name, keys[name], most)
        super().__init__(**keys)
        check_shapes(*(keys.get(name) for name in ("index", "ratio", "optic_axis")))

    def __repr__(self) -> str:
        words = {name: repr(value) for name, value in self._given.items()}
        for name in ("index", "ratio", "optic_axis"):
            values = self._given.get(name)
            if isinstance(values, list) and isinstance(values[0], list):
                words[name] = f"<{' x '.join(map(str, np.shape(values)))} samples>"
        keys = ", ".join(f"{name}={word}" for name, word in words.items())
        return f"{type(self).__name__}({keys})"


class _Polyhedron(Device):
    """A device whose corners or planes may be arrays."""

    def __init__(self, **keys: Any) -> None:
        for name, columns in (("vertices", 3), ("planes", 4)):
            rows = keys.get(name)
            if rows is None or isinstance(rows, (str, os.PathLike)):
                continue
            expected = f"real numbers of the shape (N, {columns}), four rows at least, or a path"
            array = numbers(name, rows, expected)
            if array.ndim != 2 or array.shape[1] != columns or len(array) < 4:
                raise ValueError(f"{name} has the shape {array.shape}; expected {expected}")
        super().__init__(**keys)


#: The devices that take more than the keys of the catalogue.
_BASES: dict[str, type[Device]] = {"graded": _Graded, "polyhedron": _Polyhedron}


def _rebuild(name: str, keys: Mapping[str, Any], array: Any) -> Table:
    image = None if array is None else image_of("image", array, "linear" if array.dtype.kind == "f" else "srgb")
    table: Table = globals()[name]._of(keys, image)
    return table


def class_name(kind: str) -> str:
    """The name of the class of a table or a kind of device: ``"square-cloak"`` is ``"SquareCloak"``."""
    return _NAMES.get(kind) or "".join(word.capitalize() for word in kind.replace("_", "-").split("-"))


def _type_words(description: Mapping[str, Any]) -> str:
    """What a key takes, for its docstring."""
    if "enum" in description:
        return "{" + ", ".join(json.dumps(word) for word in description["enum"]) + "}"
    if "anyOf" in description:
        return " or ".join(_type_words(option) for option in description["anyOf"])
    kind = description.get("type")
    if kind == "array":
        items, length = description["items"], description.get("maxItems")
        if items.get("type") == "object":
            return "list of tables"
        return f"{length} x {_type_words(items)}" if length else f"list of {_type_words(items)}"
    return {"number": "float", "integer": "int", "boolean": "bool", "string": "str", "object": "table"}[str(kind)]


def _key_doc(name: str, description: Mapping[str, Any]) -> str:
    default = f", default {description['default']!r}" if "default" in description else ", optional"
    lines = [f"{name} : {_type_words(description)}{default}"]
    lines += textwrap.wrap(description["description"], 110, initial_indent="    ", subsequent_indent="    ")
    forms = [description, description.get("items", {}), *description.get("anyOf", [])]
    inner = next((form["properties"] for form in forms if "properties" in form), None)
    if inner:
        keys = [f"``{key}`` ({_type_words(of)}): {of['description']}" for key, of in inner.items()]
        for key in ["Its keys:", *keys]:
            lines += textwrap.wrap(key, 110, initial_indent="    ", subsequent_indent="      ")
    return "\n".join(lines)


def _key(name: str, description: Mapping[str, Any]) -> property:
    default = _fixed(description.get("default"))
    return property(lambda table: table._given.get(name, default), doc=description["description"])


#: What arrays are asked for beside the keys of the catalogue.
_ENCODING = {
    "enum": ["srgb", "linear"],
    "description": "What the numbers of an array stand for: \"srgb\", as in image files, or \"linear\" light. If it is "
    "not given, uint8 is sRGB and floats are linear light.",
}

#: What images may be.
_IMAGE = (
    " Or an array, its first row on top: (height, width), (height, width, 3), or (height, width, 4), whose last channel "
    "is alpha over black."
)

#: What `Graded` takes as its index, which is more than a scene file does.
_INDEX = (
    "The refractive index: an array (samples along x, samples along y), or (along x, along y, along z) with a length, on "
    "a regular grid from border to border, of four or more each way, copied; a function of arrays x and y (cm) that is asked for it at such a grid, at once; or a .npy "
    "file. Between the samples the square of the index is a bicubic spline. Within a core the function is asked for "
    "no more than 12 steps of the grid from its border."
)


def _make(name: str, base: type[Table], summary: str, properties: dict[str, Any], table: str) -> type[Table]:
    properties = {key: properties[key] for key in _cloakroom.key_names(table)}
    if base is _Graded:
        properties["index"] = {**properties["index"], "description": _INDEX}
        properties["spacing"] = SPACING
    if "image" in properties:
        image = properties.pop("image")
        first = {"image": {**image, "description": image["description"] + _IMAGE}, "encoding": _ENCODING}
        properties = {**first, **properties}
    parts = [_key_doc(key, description) for key, description in properties.items()]
    doc = f"{summary}\n\nParameters\n----------\n" + "\n".join(parts) + "\n"
    parameters = [
        inspect.Parameter(key, inspect.Parameter.KEYWORD_ONLY, default=description.get("default"))
        for key, description in properties.items()
    ]
    names: dict[str, Any] = {key: _key(key, description) for key, description in properties.items()}
    names |= {
        "__doc__": doc,
        "__module__": __name__,
        "__signature__": inspect.Signature(parameters),
        "_table": table,
        "_properties": properties,
    }
    names.pop("encoding", None)
    if issubclass(base, Device):
        names["kind"] = table
        names.pop("spacing", None)
    return type(name, (base,), names)


def _wrapped(*paragraphs: str) -> str:
    return "\n\n".join("\n".join(textwrap.wrap(paragraph, 110)) for paragraph in paragraphs)


#: The class of each kind of device, in the order of the catalogue.
DEVICES: dict[str, type[Device]] = {}
#: The class of each other table of a scene.
TABLES: dict[str, type[Table]] = {}

for _reference in _SCHEMA["properties"]["device"]["items"]["oneOf"]:
    _kind = _reference["$ref"].rsplit("/", 1)[-1]
    _description = _SCHEMA["$defs"][_kind]
    _summary = _wrapped(_description["title"].rstrip(".") + ".", _description["description"])
    _base = _BASES.get(_kind, Device)
    _class = _make(class_name(_kind), _base, _summary, _description["properties"], _kind)
    DEVICES[_kind] = globals()[_class.__name__] = _class
for _kind, _description in _SCHEMA["properties"].items():
    if _kind != "device":
        _summary = f"The table ``[{_kind}]`` of a scene."
        _class = _make(class_name(_kind), Table, _summary, _description["properties"], _kind)
        TABLES[_kind] = globals()[_class.__name__] = _class

__all__ = ["DEVICES", "TABLES", "Device", "Table", "class_name"]
__all__ += [_class.__name__ for _class in [*DEVICES.values(), *TABLES.values()]]
