"""Random rooms of Mitsuba: bodies of glass and metal against its own, cloaks against nothing, and any device in even light.

What is drawn comes from fixed seeds; CLOAKROOM_LONG=1 draws ten times as many.
"""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from conftest import REPOSITORY

mi = pytest.importorskip("mitsuba", reason="mitsuba is not installed: pip install './python[mitsuba]'")
try:
    import cloakroom
    import cloakroom.mitsuba as rooms
except ImportError as error:
    pytest.skip(str(error), allow_module_level=True)

TIMES = 10 if os.environ.get("CLOAKROOM_LONG") else 1

Random = np.random.Generator
Image = NDArray[np.float64]


@pytest.fixture(autouse=True)
def variant() -> None:
    mi.set_variant("llvm_ad_rgb")
    mi.set_log_level(mi.LogLevel.Error)


def direction(random: Random) -> NDArray[np.float64]:
    along = random.normal(size=3)
    return along / np.linalg.norm(along)


def turned(random: Random) -> Any:
    return mi.ScalarTransform4f().rotate(direction(random).tolist(), float(random.uniform(0, 360)))


class World:
    """A frame in which everything stands: lengths in cm there are in another unit, shifted and turned, here."""

    def __init__(self, random: Random, far: float) -> None:
        self.unit = float(10 ** random.uniform(-1, 2))
        shift = far * 60 * direction(random) / self.unit
        self.frame = mi.ScalarTransform4f().translate(shift.tolist()) @ turned(random)
        self.scaled = self.frame @ mi.ScalarTransform4f().scale(1 / self.unit)

    def point(self, at: Any) -> Any:
        return self.scaled @ mi.ScalarPoint3f(np.asarray(at, float).tolist())

    def rigid(self, at: Any, turn: Any) -> Any:
        """A device's place, for `rooms.device`."""
        return self.frame @ mi.ScalarTransform4f().translate((np.asarray(at, float) / self.unit).tolist()) @ turn

    def room(self, random: Random, lamp: str) -> dict[str, Any]:
        """A floor and a wall that shines, both in two colors, a lamp, a dim sky and a camera that looks at the origin."""
        up = mi.ScalarTransform4f()
        squares = {
            "type": "checkerboard",
            "color0": {"type": "rgb", "value": random.uniform(0.05, 0.3, 3).tolist()},
            "color1": {"type": "rgb", "value": random.uniform(0.3, 0.6, 3).tolist()},
            "to_uv": up.scale(12),
        }
        matt = {"type": "twosided", "bsdf": {"type": "diffuse", "reflectance": squares}}
        aside = np.array([random.uniform(-25, 25), 60, random.uniform(-25, 25)])
        above = self.point(aside)
        lamps: dict[str, Any] = {
            "area": {
                "type": "rectangle",
                "to_world": self.scaled @ up.translate(aside.tolist()).rotate([1, 0, 0], 90).scale(float(random.uniform(10, 30))),
                "emitter": {"type": "area", "radiance": {"type": "rgb", "value": 3.0}},
            },
            "point": {"type": "point", "position": above, "intensity": {"type": "rgb", "value": 4000 / self.unit**2}},
            "directional": {
                "type": "directional",
                "direction": self.point([0, 0, 0]) - above,
                "irradiance": {"type": "rgb", "value": 1.0},
            },
        }
        below = self.scaled @ up.translate([0, -12, 0]).rotate([1, 0, 0], -90).scale(60)
        behind = self.scaled @ up.translate([40, 0, 0]).rotate([0, 1, 0], -90).scale(60)
        azimuth, height = random.uniform(-1, 1), random.uniform(0, 0.6)
        eye = 80 * np.array([-np.cos(azimuth), height, np.sin(azimuth)])
        return {
            "type": "scene",
            "integrator": {"type": "path", "max_depth": 64, "rr_depth": 64},
            "floor": {"type": "rectangle", "to_world": below, "bsdf": matt},
            "wall": {"type": "rectangle", "to_world": behind, "bsdf": matt, "emitter": {"type": "area", "radiance": squares}},
            "lamp": lamps[lamp],
            "sky": {"type": "constant", "radiance": {"type": "rgb", "value": 0.2}},
            "sensor": {
                "type": "perspective",
                "fov": 32,
                "near_clip": 1.0 / self.unit,
                "far_clip": 1e4 / self.unit,
                "to_world": self.scaled @ up.look_at(eye.tolist(), [0, 0, 0], [0, 1, 0]) @ up.scale(self.unit),
                "sampler": {"type": "independent"},
                "film": {"type": "hdrfilm", "width": 32, "height": 32, "rfilter": {"type": "box"}, "pixel_format": "rgb"},
            },
        }


def picture(room: dict[str, Any], samples: int, seed: int = 0, integrator: str = "cloakroom_path") -> Image:
    # Mitsuba loses the bounds of meshes that it makes one of, and with them light of the sky.
    scene = mi.load_dict({**room, "integrator": {**room["integrator"], "type": integrator}}, optimize=False)
    image = np.array(scene.integrator().render(scene, seed=seed, spp=samples), np.float64)
    assert np.isfinite(image).all()
    return image


def bodies(random: Random) -> list[tuple[dict[str, Any], Any, Any]]:
    """One to three bodies that do not touch: keys, place and turn in the world's frame."""
    found: list[tuple[dict[str, Any], Any, Any]] = []
    for x in random.permutation([-14.0, 0.0, 14.0])[: random.integers(1, 4)]:
        at = np.array([random.uniform(-4, 4), random.uniform(-2, 6), x])
        shape = str(random.choice(["sphere", "box", "cylinder"]))
        size: dict[str, Any] = {
            "sphere": {"radius": random.uniform(4, 6.5)},
            "box": {"size": random.uniform(5, 8, 3)},
            "cylinder": {"radius": random.uniform(2.5, 4), "length": random.uniform(6, 10)},
        }[shape]
        matter: dict[str, Any] = [
            {"index": random.uniform(1.1, 2.2)},
            {"index": random.uniform(0.6, 0.95)},
            {"metal": True},
            {"metal": {"index": [random.uniform(0.2, 3), random.uniform(1, 4)]}},
        ][random.choice(4, p=[0.6, 0.1, 0.1, 0.2])]
        found.append(({"kind": "body", "shape": shape, **size, **matter}, at, turned(random)))
    return found


def as_keys(turn: NDArray[np.float64]) -> dict[str, Any]:
    """The keys of a device that is turned so: about z, and then by the shortest turn from z to its axis."""
    axis = turn[:, 2]
    across = np.cross([0, 0, 1], axis)
    cross = np.array([[0, -across[2], across[1]], [across[2], 0, -across[0]], [-across[1], across[0], 0]])
    shortest = np.eye(3) + cross + cross @ cross / (1 + axis[2])
    about_z = shortest.T @ turn
    return {"rotation": np.degrees(np.arctan2(about_z[1, 0], about_z[0, 0])), "axis": axis}


def of_mitsuba(world: World, keys: dict[str, Any], at: Any, turn: Any) -> list[dict[str, Any]]:
    """The same body by Mitsuba's own shapes."""
    if "index" in keys:
        matter: dict[str, Any] = {"type": "dielectric", "int_ior": float(keys["index"]), "ext_ior": 1.0}
    else:
        matter = {"type": "conductor", "material": "none"}
        if keys["metal"] is not True:
            n, k = keys["metal"]["index"]
            matter = {"type": "conductor", "eta": {"type": "rgb", "value": [n] * 3}, "k": {"type": "rgb", "value": [k] * 3}}
    placed = world.scaled @ mi.ScalarTransform4f().translate(at.tolist()) @ turn
    up = mi.ScalarTransform4f()
    if keys["shape"] == "sphere":
        return [{"type": "sphere", "to_world": placed @ up.scale(keys["radius"]), "bsdf": matter}]
    if keys["shape"] == "box":
        return [{"type": "cube", "to_world": placed @ up.scale((keys["size"] / 2).tolist()), "bsdf": matter}]
    radius, half = keys["radius"], keys["length"] / 2
    side = {"type": "cylinder", "p0": [0, 0, -half], "p1": [0, 0, half], "radius": radius, "to_world": placed, "bsdf": matter}
    # Their normals go out.
    turns = [placed @ up.rotate([1, 0, 0], angle) for angle in (0, 180)]
    ends = [turn @ up.translate([0, 0, half]).scale([radius, radius, 1]) for turn in turns]
    return [side, *({"type": "disk", "to_world": end, "bsdf": matter} for end in ends)]


@pytest.mark.parametrize("seed", range(6 * TIMES))
def test_bodies_are_those_of_mitsuba(seed: int, tmp_path: Path) -> None:
    """Light in parts of the picture, by how much it differs from picture to picture."""
    random = np.random.default_rng([24, seed])
    world = World(random, far=float(random.choice([0, 1, 5])))
    # A point's light through glass is found by neither.
    lamp = str(random.choice(["area", "directional", "point"], p=[0.6, 0.2, 0.2]))
    room = world.room(random, lamp)
    placed = bodies(random)
    # In shapes of their own, or all in one, which they do not fill.
    if random.random() < 0.5:
        see_through = str(random.choice(["auto", "yes", "no"])) if lamp == "area" else "auto"
        ours = {
            f"body{number}": rooms.device(keys, world.rigid(at, turn), unit=world.unit, see_through=see_through, min_power=1e-4)
            for number, (keys, at, turn) in enumerate(placed)
        }
    else:
        devices = [{**keys, "position": at, **as_keys(np.array(turn.matrix, float)[:3, :3])} for keys, at, turn in placed]
        (tmp_path / "bodies.toml").write_text(cloakroom.Scene(devices=devices).toml)
        scene = {"scene": str(tmp_path / "bodies.toml")}
        up = mi.ScalarTransform4f()
        ours = {"bodies": rooms.device(scene, world.rigid([0, 0, 0], up), unit=world.unit, min_power=1e-4)}
    theirs = {
        f"part{number}-{place}": part
        for number, (keys, at, turn) in enumerate(placed)
        for place, part in enumerate(of_mitsuba(world, keys, at, turn))
    }
    seeds = range(8)
    # The same numbers are drawn, so that most of what is random is the same in both.
    own = np.array([picture({**room, **ours}, 64, each).mean(axis=-1) for each in seeds])
    wanted = np.array([picture({**room, **theirs}, 64, each, "path").mean(axis=-1) for each in seeds])
    off = own - wanted
    light = wanted.mean()
    told = f"unit {world.unit:.3g}, {lamp}, {placed}"
    # Parts of 2 x 2 pixels, in standard errors of their means; where nothing is random, by what rounding does to a ray in a thousand.
    parts = off.reshape(8, 16, 2, 16, 2).mean(axis=(2, 4))
    error = np.maximum(parts.std(axis=0, ddof=1) / np.sqrt(8), 1e-4 * light)
    assert np.square(parts.mean(axis=0) / error).mean() < 3, told
    whole = off.mean(axis=(1, 2))
    error = whole.std(ddof=1) / np.sqrt(8) + 1e-4 * light
    assert abs(whole.mean()) < 4 * error, told
    # So that there is something to miss.
    assert error < 3e-3 * light, told


@pytest.mark.parametrize("seed", range(4 * TIMES))
def test_what_nobody_sees_is_nothing(seed: int) -> None:
    random = np.random.default_rng([25, seed])
    world = World(random, far=float(random.uniform(0, 2)))
    room = world.room(random, str(random.choice(["area", "directional", "point"])))
    at, turn = random.uniform(-3, 3, 3), turned(random)
    cloak: dict[str, Any] = [
        {"kind": "sphere-cloak", "inner": 3, "outer": random.uniform(4, 8)},
        {"kind": "invisible-sphere", "radius": random.uniform(4, 8)},
    ][random.integers(2)]
    radius = cloak.get("outer") or cloak["radius"]
    nothing = {"kind": "body", "shape": "sphere", "radius": radius}
    one, other = (
        picture({**room, "device": rooms.device(keys, world.rigid(at, turn), unit=world.unit)}, 32) for keys in (cloak, nothing)
    )
    assert (np.abs(one - other).max(axis=-1) < 1e-3 * other.mean()).mean() >= 0.99, cloak
    assert abs(one.mean() / other.mean() - 1) < 2e-4, cloak


#: Scenes whose devices end, and absorb nothing.
LOSSLESS = [
    "bending-sphere",
    "carpet-in-glass",
    "eaton-lens",
    "fisheye-hemisphere",
    "fisheye-lens",
    "graded",
    "graded-3d",
    "graded-box",
    "invisible-sphere",
    "invisible-sphere-regularized",
    "luneburg-lens",
    "sphere-cloak",
    "standing-cylinder-cloak",
    "tilted-box",
]

#: Devices that absorb nothing, and are endless without a length.
LONG: list[dict[str, Any]] = [
    *({"kind": "square-cloak", "material": each} for each in ("impedance-matched", "positive-uniaxial", "negative-uniaxial")),
    {"kind": "double-gaussian-cloak"},
    *({"kind": "cylinder-cloak", "material": each} for each in ("radial-uniaxial", "azimuthal-uniaxial")),
    {"kind": "gaussian-carpet"},
    {"kind": "grating-carpet"},
    {"kind": "quasi-conformal-carpet"},
    {"kind": "mirror-detour"},
]


@pytest.mark.parametrize("seed", range(8 * TIMES))
def test_any_device_that_absorbs_nothing_is_not_seen_in_even_light(seed: int) -> None:
    random = np.random.default_rng([26, seed])
    world = World(random, far=0)
    room = {
        "type": "scene",
        "integrator": {"type": "path"},
        "sky": {"type": "constant", "radiance": {"type": "rgb", "value": 1.0}},
        "sensor": world.room(random, "area")["sensor"],
    }
    name = str(random.choice(LOSSLESS))
    scene = {"scene": str(REPOSITORY / "scenes" / "gallery" / f"{name}.toml")}
    long = {**LONG[random.integers(len(LONG))], "length": random.uniform(10, 40)}
    for keys, z in ((scene, -100), (long, 100)):
        place = world.rigid([160, 0, z], turned(random))
        room[f"at {z}"] = rooms.device(keys, place, unit=world.unit, see_through="no")
    image = picture(room, 4)
    assert np.abs(image - 1).max() < 1e-5, (name, long)
