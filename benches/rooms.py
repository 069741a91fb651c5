"""What devices in Mitsuba's rooms cost, against its own path tracer: seconds of all processors, per million paths.

    pip install ./python[mitsuba] && python benches/rooms.py

Processor time, so that other work on the machine counts less; each the least of three, after one that compiles.
"""

from __future__ import annotations

import os
import sys
import time
from typing import Any

import mitsuba as mi
import numpy as np

import cloakroom
import cloakroom.mitsuba as rooms

PIXELS = int(sys.argv[1]) if len(sys.argv) > 1 else 128
SAMPLES = 32


def spent(room: dict[str, Any]) -> tuple[float, float]:
    """Seconds of processors and of the clock."""
    scene = mi.load_dict(room)
    best = (np.inf, np.inf)
    for _ in range(4):
        clock, before = time.perf_counter(), os.times()
        np.array(scene.integrator().render(scene, seed=1, spp=SAMPLES))
        after = os.times()
        used = after.user + after.system - before.user - before.system
        best = min(best, (used, time.perf_counter() - clock))
    return best


def box(integrator: str, device: Any = None, **keys: Any) -> dict[str, Any]:
    """The Cornell box, with a device in its middle or none."""
    room: dict[str, Any] = mi.cornell_box()
    room["sensor"]["film"].update(width=PIXELS, height=PIXELS, rfilter={"type": "box"})
    room["integrator"] = {"type": integrator, "max_depth": 8}
    if device is not None:
        room["device"] = rooms.device(device, mi.ScalarTransform4f().translate([0.2, 0.6, 0.3]), unit=32, **keys)
    return room


def scatter() -> None:
    """What `Scatterer.scatter` takes beside tracing, and for a call."""
    cloak = cloakroom.Scatterer(cloakroom.SphereCloak())
    count = 1_000_000
    rng = np.random.default_rng(0)
    origins = np.column_stack([np.full(count, -30.0), rng.uniform(-9, 9, (count, 2))]).astype(np.float32)
    directions = np.tile(np.float32([1, 0, 0]), (count, 1))
    u = rng.random(count, dtype=np.float32)
    for rays, what in ((count, "a million rays"), (1, "one ray")):
        one = origins[:rays], directions[:rays], u[:rays]
        times = []
        for _ in range(5 if rays > 1 else 200):
            clock, before = time.perf_counter(), os.times()
            cloak.scatter(*one)
            after = os.times()
            used = after.user + after.system - before.user - before.system
            # Processor time is counted in hundredths of a second.
            times.append(used if rays > 1 else time.perf_counter() - clock)
        print(f"scatter, {what}: {1e6 * min(times) / rays:.3f} us a ray")


if __name__ == "__main__":
    mi.set_variant("llvm_ad_rgb")
    scatter()
    sphere, square = {"kind": "sphere-cloak"}, {"kind": "square-cloak", "length": 16, "side": 13}
    gaussian = {"kind": "double-gaussian-cloak", "length": 12, "width": 20, "height": 20, "w": 4, "h": 1.7}
    cases = {
        "path": box("path"),
        "without device": box("cloakroom_path"),
        "sphere cloak, blocked": box("cloakroom_path", sphere, see_through="no"),
        "sphere cloak": box("cloakroom_path", sphere),
        "(iii)": box("cloakroom_path", square),
        "(iv)": box("cloakroom_path", gaussian),
    }
    reference = None
    for name, room in cases.items():
        used, clock = spent(room)
        reference = reference or used
        print(f"{name:24} {used:7.2f} s of processors ({clock:.2f} s), {used / reference:5.2f} x path", flush=True)
