"""What cloakroom says of its devices: material, metal and rays, as the command `cloakroom` writes them.

Nothing here knows a formula of a cloak. Lengths in cm, angles in degrees; the device's frame unless said otherwise.
"""

import json
import subprocess
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[2]
WORK = ROOT / "target" / "full_wave"
CLOAKROOM = ROOT / "target" / "release" / "cloakroom"
SCENES = {"(iii)": "scenes/paper/fig6c.toml", "(iv)": "scenes/paper/fig8c.toml"}
KINDS = {"(iii)": "square-cloak", "(iv)": "double-gaussian-cloak"}


def cloakroom(*words, stdin=None):
    """Runs the command and returns what it prints."""
    done = subprocess.run(
        [str(word) for word in (CLOAKROOM, *words)],
        cwd=ROOT, input=stdin, capture_output=True, text=True, check=False,
    )  # fmt: skip
    if done.returncode != 0:
        raise SystemExit(f"cloakroom {' '.join(map(str, words))}: {done.stderr}")
    return done.stdout


def scene(design, rotation=0.0, show="cloak", material=None):
    """The scene of a design and the words that set it."""
    words = [SCENES[design], "--set", f"device.0.rotation={rotation}", "--set", f'device.0.show="{show}"']
    return words + (["--set", f'device.0.material="{material}"'] if material else [])


@dataclass
class Device:
    """A device across its axis."""

    design: str
    metal: np.ndarray  # corners of the metal's outline, (n, 2), counterclockwise
    outline: np.ndarray  # corners of the cloak's border, (n, 2), counterclockwise
    mirror: float  # half the width of the flat mirror that it imitates
    segments: list = field(default_factory=list)  # (corners (n, 2), permittivity, permeability (3, 3))
    grid: tuple | None = None  # x, y, permittivity (x, y) of the isotropic medium; metal is filled smoothly


def load(design, material=None):
    """Fetches a design from cloakroom; `material` chooses (i) or (ii) among the square cloaks."""
    facts = json.loads(cloakroom("devices", "--json"))["devices"]
    mirror = next(f["mirror_width_cm"] for f in facts if f["kind"] == KINDS[design]) / 2
    WORK.mkdir(parents=True, exist_ok=True)
    if design == "(iii)":
        return load_segments(mirror, material)
    return load_grid(design, mirror)


def tensor(entry):
    """The tensor with these principal values along these axes (rows)."""
    axes = np.array(entry["axes"])
    return axes.T @ np.diag(entry["values"]) @ axes


def load_segments(mirror, material):
    path = WORK / "segments.json"
    cloakroom("export", *scene("(iii)", material=material), "--table", "-o", path)
    table = json.loads(path.read_text())
    segments = [
        (np.array(s["corners_cm"]), tensor(s["permittivity"]), tensor(s["permeability"]))
        for s in table
        if s["filling"] == "medium"
    ]
    metal = around(np.array(next(s["corners_cm"] for s in table if s["filling"] == "metal")))
    corners = np.unique(np.vstack([corners for corners, _, _ in segments]), axis=0)
    outer = corners[np.isclose(np.abs(corners).sum(axis=1), np.abs(corners).sum(axis=1).max())]
    return Device("(iii)", metal, around(outer), mirror, segments)


def around(corners):
    """Corners of a convex polygon about the origin, counterclockwise from the positive x axis."""
    angle = np.arctan2(corners[:, 1], corners[:, 0])
    return corners[np.argsort(np.round(angle, 9))]


def load_grid(design, mirror, cells="1000x1143x1"):
    path = WORK / "material.npz"
    if not path.exists():
        cloakroom("export", *scene(design), "--grid", cells, "-o", path)
    data = np.load(path)
    permittivity = data["permittivity"][:, :, 0, 0, 0].copy()
    if not np.allclose(data["permeability"][data["region"] == 1], np.eye(3)):
        raise SystemExit("the medium of design (iv) is magnetic: this check takes a dielectric")
    metal = data["region"][:, :, 0] == 2
    # Smooth beyond the outline, towards the middle: the outline falls between middles of cells.
    middle = permittivity.shape[1] // 2
    for rows in (range(permittivity.shape[1] - 3, middle - 1, -1), range(2, middle)):
        step = 1 if rows.step < 0 else -1
        for j in rows:
            column = metal[:, j]
            linear = 2 * permittivity[:, j + step] - permittivity[:, j + 2 * step]
            permittivity[column, j] = np.clip(linear[column], 0.5, 6)
    (left, right), (bottom, top) = (
        (axis[0] - (axis[1] - axis[0]) / 2, axis[-1] + (axis[1] - axis[0]) / 2) for axis in (data["x"], data["y"])
    )
    corners = np.array([[right, bottom], [right, top], [left, top], [left, bottom]])
    return Device(design, lens(design, right, top), corners, mirror, grid=(data["x"], data["y"], permittivity))


def lens(design, right, top, points=161):
    """The outline of the metal, where rays from above and below meet it."""
    # Denser towards the ends, just inside which rays still meet the metal.
    x = right * np.sin(np.linspace(-0.5, 0.5, points) * np.pi)
    x[[0, -1]] *= 1 - 1e-9
    halves = []
    for side in (1, -1):
        rays = [{"origin": [v, side * 2 * top, 0], "direction": [0, -side, 0]} for v in x]
        traced = json.loads(
            cloakroom("trace", *scene(design, show="bare"), "--rays", "-", stdin=json.dumps(rays))
        )
        halves.append(np.array([t["leaves"][0]["position"][:2] for t in traced]))
    upper, lower = halves
    return np.vstack([lower, upper[::-1]])


def rays(design, heights, start=-60.0, rotation=0.0, show="cloak", polarization="vertical", slope=0.0, least=1e-4):
    """Leaves of rays along x (or at `slope` degrees to it) from x = `start`, in the world's frame.

    Returns for each ray a list of (position (2), direction (2), power, optical path, amplitude), where the
    amplitude is that of the field across the ray: of H along z for vertical polarization, of E along z for
    horizontal polarization.
    """
    towards = [np.cos(np.radians(slope)), np.sin(np.radians(slope)), 0.0]
    asked = [
        {"origin": [start, float(y), 0.0], "direction": towards, "polarization": polarization} for y in heights
    ]
    words = ["trace", *scene(design, rotation, show), "--rays", "-", "--min-power", least]
    found = []
    for tree in json.loads(cloakroom(*words, stdin=json.dumps(asked))):
        leaves = []
        for leaf in tree["leaves"]:
            position = np.array(leaf["position"] if leaf["position"] else [start, asked[len(found)]["origin"][1], 0.0])
            direction = np.array(leaf["direction"])
            e = np.array([complex(*c) for c in leaf["electric_field"]])
            across = e[2] if polarization == "horizontal" else direction[0] * e[1] - direction[1] * e[0]
            leaves.append((position[:2], direction[:2], leaf["power"], leaf["optical_path"], across))
        found.append(leaves)
    return found
