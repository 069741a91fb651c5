"""Numbers of mpmath, and the files: one line for each part of a case, 17 digits."""

from __future__ import annotations

import json
from pathlib import Path

from mpmath import mpc, mpf


def plain(value: object, least: float = 1e-30) -> object:
    """A value as JSON has it: complex numbers as [re, im], what is below `least` as 0."""
    if isinstance(value, mpc):
        return [plain(value.real, least), plain(value.imag, least)]
    if isinstance(value, complex):
        return [plain(value.real, least), plain(value.imag, least)]
    if isinstance(value, (mpf, float)):
        return float(value) if abs(value) > least else 0.0
    if isinstance(value, dict):
        return {key: plain(entry, least) for key, entry in value.items()}
    if isinstance(value, (list, tuple)):
        return [plain(entry, least) for entry in value]
    return value


def text(about: dict, cases: list[dict]) -> str:
    """A file of cases."""
    lines = ["{"]
    lines += [f"{json.dumps(key)}: {json.dumps(value)}," for key, value in about.items()]
    lines.append('"cases": [')
    bodies = []
    for case in cases:
        parts = [f" {json.dumps(key)}: {json.dumps(value)}" for key, value in case.items()]
        bodies.append("{\n" + ",\n".join(parts) + "\n}")
    return "\n".join(lines) + "\n" + ",\n".join(bodies) + "\n]\n}\n"


def write(folder: Path, name: str, about: dict, cases: list[dict]) -> None:
    (folder / name).write_text(text(about, cases), encoding="utf-8")
