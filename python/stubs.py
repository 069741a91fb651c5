"""Writes cloakroom/tables.pyi, the types of the classes that cloakroom/tables.py makes from the catalogue.

Run it where cloakroom is installed, after a change of the catalogue: python stubs.py
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from cloakroom import tables

HEADER = '''\
# Made by stubs.py from the catalogue of devices; do not edit.
import os
from collections.abc import Callable, Mapping, Sequence
from typing import Any, Literal, TypeVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _cloakroom
from .materials import Material

_Self = TypeVar("_Self", bound="Table")
_Image = str | os.PathLike[str] | ArrayLike
_Index = str | os.PathLike[str] | ArrayLike | Callable[[NDArray[np.float64], NDArray[np.float64]], ArrayLike]

class Table:
    _table: str
    _properties: dict[str, dict[str, Any]]
    _image: _cloakroom.Image | None
    def __init__(self, **keys: Any) -> None: ...
    @classmethod
    def _of(cls, keys: Mapping[str, Any], image: _cloakroom.Image | None = None) -> Any: ...
    def given(self) -> dict[str, Any]: ...
    def replace(self: _Self, **keys: Any) -> _Self: ...
    def __eq__(self, other: object) -> bool: ...

class Device(Table):
    kind: str
PLACEMENT
def class_name(kind: str) -> str: ...

DEVICES: dict[str, type[Device]]
TABLES: dict[str, type[Table]]
'''


def annotation(name: str, description: Mapping[str, Any], *, given: bool) -> str:
    """The type of a key: as it is given, or as it comes back."""
    if "enum" in description:
        return f"Literal[{', '.join(json.dumps(word) for word in description['enum'])}]"
    kind = description.get("type")
    if "anyOf" in description:
        each = (annotation(name, option, given=given) for option in description["anyOf"])
        options = dict.fromkeys(part for option in each for part in option.split(" | "))
        if given and name == "material":
            options["Material"] = None
        if name == "index" and "str" in options:
            return "_Index" if given else "str | list[list[float]]"
        numeric = all(option in ("float", "ArrayLike", "list[Any]") for option in options)
        return ("ArrayLike" if given else "Any") if numeric else " | ".join(options)
    if kind == "array":
        items = description["items"]
        if items.get("type") == "object":
            return "Sequence[Mapping[str, Any]]" if given else "list[dict[str, Any]]"
        if "enum" in items:
            inner = annotation(name, items, given=given)
            return f"Sequence[{inner}]" if given else f"list[{inner}]"
        return "ArrayLike" if given else "list[Any]"
    if kind == "object":
        return "Mapping[str, Any]" if given else "dict[str, Any]"
    if kind == "string":
        return "_Image" if given and name == "image" else "str"
    return {"number": "float", "integer": "int", "boolean": "bool"}[str(kind)]


def reading(name: str, description: Mapping[str, Any]) -> list[str]:
    """The property that gives a key."""
    optional = "" if "default" in description else " | None"
    returned = annotation(name, description, given=False)
    return ["    @property", f"    def {name}(self) -> {returned}{optional}: ..."]


def placement() -> list[str]:
    """The properties that all devices have."""
    first, *others = tables.DEVICES.values()
    same = (name for name in first._properties if all(name in other._properties for other in others))
    lines = [reading(name, first._properties[name]) for name in same]
    return [line for two in lines for line in two]


def stub() -> str:
    """The text of the stub."""
    parts = [HEADER.replace("PLACEMENT", "\n".join(placement()) + "\n")]
    for base, classes in (("Device", tables.DEVICES), ("Table", tables.TABLES)):
        for cls in classes.values():
            lines = [f"\nclass {cls.__name__}({base}):", "    def __init__(", "        self,", "        *,"]
            for name, description in cls._properties.items():
                lines.append(f"        {name}: {annotation(name, description, given=True)} | None = ...,")
            lines.append("    ) -> None: ...")
            for name, description in cls._properties.items():
                if hasattr(cls, name):
                    lines += reading(name, description)
            parts.append("\n".join(lines) + "\n")
    names = ", ".join(f'"{name}"' for name in tables.__all__)
    return "".join(parts) + f"\n__all__ = [{names}]\n"


if __name__ == "__main__":
    Path(__file__).with_name("cloakroom").joinpath("tables.pyi").write_text(stub(), encoding="utf-8")
