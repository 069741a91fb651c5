"""What the tests share."""

from __future__ import annotations

import os
import subprocess
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

import cloakroom

REPOSITORY = Path(__file__).resolve().parents[2]

Run = Callable[..., subprocess.CompletedProcess[str]]


@pytest.fixture(scope="session")
def executable() -> Path:
    """The command line program, which the tests hold the package against."""
    named = os.environ.get("CLOAKROOM_COMMAND")
    built = [REPOSITORY / "target" / profile / "cloakroom" for profile in ("debug", "release")]
    found = [Path(named).resolve()] if named else [path for path in built if path.exists()]
    if not found:
        pytest.skip("the command cloakroom is not built; CLOAKROOM_COMMAND may name it")
    return max(found, key=lambda path: path.stat().st_mtime)


@pytest.fixture(scope="session")
def command(executable: Path) -> Run:
    """Runs the command line program."""

    def run(*arguments: object, check: bool = True) -> subprocess.CompletedProcess[str]:
        words = [str(executable), *map(str, arguments)]
        return subprocess.run(words, capture_output=True, text=True, check=check, cwd=REPOSITORY)

    return run


@pytest.fixture(scope="session")
def paper() -> Callable[[str], Path]:
    """The scene file of a panel of the paper."""
    return lambda panel: REPOSITORY / "scenes" / "paper" / f"fig{panel}.toml"


@pytest.fixture
def cloak() -> cloakroom.Scene:
    """A small picture of a turned cloak."""
    camera = cloakroom.Camera(resolution=[40, 30], samples=1)
    return cloakroom.Scene(camera=camera, devices=cloakroom.SquareCloak(rotation=10))


@pytest.fixture
def random() -> np.random.Generator:
    return np.random.default_rng(7)
