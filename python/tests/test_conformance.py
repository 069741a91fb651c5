"""The files of `conformance/` are what its program writes."""

from __future__ import annotations

import importlib
import itertools
import json
import math
import sys

import pytest

from conftest import REPOSITORY

FOLDER = REPOSITORY / "conformance"

#: How far numbers of another machine may be off: its sines, and steps of integrators.
EXACT, INTEGRATED = 1e-11, 3e-11

#: How many rays cases are written again: the last ones, of crystals, take long.
RAYS = 45


def differ(one: object, other: object, tolerance: float, place: str = "") -> str | None:
    """Where two values of JSON differ."""
    if isinstance(one, dict) and isinstance(other, dict) and one.keys() == other.keys():
        parts = ((one[key], other[key], f"{place}.{key}") for key in one)
    elif isinstance(one, list) and isinstance(other, list) and len(one) == len(other):
        parts = ((a, b, f"{place}[{i}]") for i, (a, b) in enumerate(zip(one, other)))
    elif isinstance(one, float) and isinstance(other, (float, int)):
        near = math.isclose(one, other, rel_tol=tolerance, abs_tol=tolerance)
        return None if near else f"{place}: {one} is not {other}"
    else:
        return None if one == other else f"{place}: {one} is not {other}"
    return next((found for part in parts if (found := differ(*part[:2], tolerance, part[2]))), None)


@pytest.mark.parametrize("name", ["interfaces", "plates", "rays"])
def test_the_files_are_written_so(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    for package in ("mpmath", "numpy", "scipy"):
        pytest.importorskip(package)
    monkeypatch.setattr(sys, "path", [str(FOLDER), *sys.path])
    module = importlib.import_module(name)
    committed = json.loads((FOLDER / f"{name}.json").read_text(encoding="utf-8"))
    written = list(itertools.islice(module.cases(), RAYS if name == "rays" else None))
    assert len(written) == (RAYS if name == "rays" else len(committed["cases"]))
    for case, there in zip(written, committed["cases"]):
        exact = "DOP853" not in case.get("oracle", "")
        # Scenes hold numbers in their text, which are those of layers and devices.
        case, there = ({k: v for k, v in c.items() if k != "scene"} for c in (json.loads(json.dumps(case)), there))
        assert differ(case, there, EXACT if exact else INTEGRATED) is None, case["name"]
