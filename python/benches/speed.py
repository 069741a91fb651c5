"""The speed of the package beside that of the command line, on this machine.

Build both in release mode (`maturin develop --release`, `cargo build --release`), leave the machine alone, and run
`python benches/speed.py`; CLOAKROOM_COMMAND may name the program. Times are medians, each run of the one beside a run of the
other.
"""

from __future__ import annotations

import os
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np

import cloakroom
from cloakroom import DoubleGaussianCloak, Scene, SquareCloak, trace

REPOSITORY = Path(__file__).resolve().parents[2]
COMMAND = os.environ.get("CLOAKROOM_COMMAND", str(REPOSITORY / "target" / "release" / "cloakroom"))
RUNS = int(sys.argv[1]) if len(sys.argv) > 1 else 15
RAYS = 1_000_000


def seconds(work: Callable[[], object]) -> float:
    begin = time.perf_counter()
    work()
    return time.perf_counter() - begin


def rendering(panel: str, ending: str) -> None:
    """A panel of the paper into a file: the command, and in an interpreter that runs already."""
    scene = REPOSITORY / "scenes" / "paper" / f"fig{panel}.toml"
    with tempfile.TemporaryDirectory() as folder:
        files = [str(Path(folder) / f"{name}.{ending}") for name in ("command", "python")]

        def command() -> None:
            subprocess.run([COMMAND, "render", str(scene), "-o", files[0]], check=True, capture_output=True)

        def python() -> None:
            Scene.load(scene).render(image_only=ending == "png").save(files[1])

        pairs = [(seconds(command), seconds(python)) for _ in range(RUNS)]
    ratio = statistics.median(python / command for command, python in pairs)
    commands, pythons = (statistics.median(times) for times in zip(*pairs))
    print(f"fig{panel} into .{ending}: command {commands:.2f} s, Python {pythons:.2f} s, median ratio {ratio:.3f}")


def rays() -> tuple[np.ndarray, np.ndarray]:
    """Rays towards the device from 100 cm before it, over a field of 40 degrees."""
    random = np.random.default_rng(1)
    across = random.uniform(-0.14, 0.14, (RAYS, 2))
    directions = np.column_stack([np.ones(RAYS), across])
    return np.tile([-100.0, 0, 0], (RAYS, 1)), directions


def tracing(name: str, scene: Scene, origins: np.ndarray, directions: np.ndarray) -> None:
    traced = trace(scene, origins, directions)
    whole = [seconds(lambda: trace(scene, origins, directions)) for _ in range(5)]
    columns = np.asfortranarray(directions)
    strided = [seconds(lambda: trace(scene, origins, columns)) for _ in range(5)]
    print(
        f"{RAYS} rays through {name}: {statistics.median(whole):.2f} s, {len(traced.ray)} leaves; "
        f"columns apart in memory {statistics.median(strided):.2f} s"
    )


def overhead() -> None:
    """What a call costs beside the tracing, and the arrays of many rays that meet nothing."""
    scene = Scene(devices=SquareCloak())
    trace(scene, [-100, 3, 0], [1, 0, 0])
    calls = 200
    one = seconds(lambda: [trace(scene, [-100, 3, 0], [1, 0, 0]) for _ in range(calls)]) / calls
    origins = np.tile([-100.0, 500, 0], (RAYS, 1))
    missed = statistics.median(seconds(lambda: trace(scene, origins, [1, 0, 0])) for _ in range(5))
    print(f"a call with one ray: {1e6 * one:.0f} us; {RAYS} rays that meet nothing: {missed:.2f} s")


if __name__ == "__main__":
    print(f"cloakroom {cloakroom.__version__}, {cloakroom.threads()} threads, {RUNS} runs")
    origins, directions = rays()
    tracing("(iii)", Scene(devices=SquareCloak(rotation=10)), origins, directions)
    tracing("(iv)", Scene(devices=DoubleGaussianCloak(rotation=10)), origins, directions)
    overhead()
    for panel in ("6c", "8c"):
        for ending in ("png", "npz"):
            rendering(panel, ending)
