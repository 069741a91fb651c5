"""Devices in rooms of Mitsuba: held against its own path tracer, its own mirror, and against light that is known.

All numbers are drawn from fixed seeds, so that what is asserted comes out the same each time.
"""

from __future__ import annotations

import shutil
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from conftest import REPOSITORY

mi = pytest.importorskip("mitsuba", reason="mitsuba is not installed: pip install './python[mitsuba]'")
try:
    import drjit as dr

    import cloakroom
    import cloakroom.mitsuba as rooms
except ImportError as error:
    pytest.skip(str(error), allow_module_level=True)


Image = NDArray[np.float32]

SPHERE_CLOAK = {"kind": "sphere-cloak"}
#: Where devices stand in the box: in its middle, above the boxes.
THERE = [0.2, 0.6, 0.3]
#: What is where nothing is: air, in a ball of the cloak's size.
NOTHING = {"kind": "body", "shape": "sphere", "radius": 10}


@pytest.fixture(autouse=True)
def variant() -> None:
    mi.set_variant("llvm_ad_rgb")
    mi.set_log_level(mi.LogLevel.Error)


def box(integrator: str = "cloakroom_path", pixels: int = 40, **more: Any) -> dict[str, Any]:
    """The Cornell box."""
    room: dict[str, Any] = mi.cornell_box()
    room["sensor"]["film"].update(width=pixels, height=pixels, rfilter={"type": "box"})
    room["integrator"] = {"type": integrator, "max_depth": 6}
    return {**room, **more}


def with_device(device: Any, **keys: Any) -> dict[str, Any]:
    place = mi.ScalarTransform4f().translate(THERE).rotate([0.36, 0.48, 0.8], 20)
    return box(cloak=rooms.device(device, place, unit=32, **keys))


def picture(room: dict[str, Any], samples: int = 16, seed: int = 1) -> Image:
    scene = mi.load_dict(room)
    image: Image = np.array(scene.integrator().render(scene, seed=seed, spp=samples))
    return image


@pytest.fixture(scope="module")
def empty() -> Image:
    mi.set_variant("llvm_ad_rgb")
    return picture(box(), 64)


@pytest.mark.parametrize("variant_name", ["llvm_ad_rgb", "llvm_ad_spectral", "llvm_ad_spectral_polarized"])
def test_without_devices_it_is_mitsubas_path(variant_name: str) -> None:
    mi.set_variant(variant_name)
    one, other = (picture(box(name)) for name in ("path", "cloakroom_path"))
    # The lamp is 18 bright, where single numbers are 2e-6 apart.
    assert (np.abs(one - other) / np.maximum(1, one)).max() < 2e-6
    assert one.max() > 10


@pytest.mark.parametrize("device", [SPHERE_CLOAK, {"kind": "invisible-sphere"}], ids=["sphere-cloak", "invisible-sphere"])
def test_what_nobody_sees_is_nothing(device: dict[str, Any], empty: Image) -> None:
    image, nothing = (picture(with_device(each), 64) for each in (device, NOTHING))
    assert (np.abs(image - nothing).max(axis=-1) < 1e-4).mean() >= 0.999
    # Against the room without anything: the same numbers are drawn, so that nearly all pixels are the same.
    off = (image - empty).mean(axis=-1).astype(np.float64)
    error = off.std() / np.sqrt(off.size)
    assert error < 3e-5
    assert abs(off.mean()) < 3 * error + 1e-7


def test_shadow_rays_through_a_cloak_make_no_noise(empty: Image) -> None:
    """The variance over seeds, on the floor in the shadow of the ball, is that of the empty room."""

    def variance(room: dict[str, Any]) -> float:
        scene = mi.load_dict(room)
        images = [np.array(scene.integrator().render(scene, seed=seed, spp=16)) for seed in range(8)]
        return float(np.var(images, axis=0, ddof=1).mean())

    clear = variance(with_device(SPHERE_CLOAK)) / variance(box())
    assert clear < 1.05
    blocked = with_device(SPHERE_CLOAK, see_through="no")
    assert variance(blocked) / variance(box()) > 1.2
    # Without shadow rays through it light is the same, as it comes along other paths.
    off = (picture(blocked, 64) - empty).mean()
    assert abs(off) < 0.01 * empty.mean()


@pytest.mark.parametrize(
    "device",
    [
        SPHERE_CLOAK,
        {"kind": "square-cloak", "length": 16, "side": 13, "rotation": 20},
        {"kind": "square-cloak", "length": 16, "side": 13, "material": "positive-uniaxial"},
        {"kind": "square-cloak", "length": 16, "side": 13, "material": "negative-uniaxial"},
        {"kind": "double-gaussian-cloak", "length": 30},
        {"kind": "luneburg-lens"},
        {"kind": "body", "shape": "box", "size": [6, 9, 12], "index": 1.5},
    ],
    ids=["sphere-cloak", "iii", "i", "ii", "iv", "luneburg", "glass"],
)
def test_what_absorbs_nothing_is_not_seen_in_even_light(device: dict[str, Any]) -> None:
    room = {
        "type": "scene",
        "integrator": {"type": "cloakroom_path"},
        "sky": {"type": "constant", "radiance": {"type": "rgb", "value": 1.0}},
        "device": rooms.device(device, mi.ScalarTransform4f().rotate([0.6, 0.8, 0], 40), min_power=1e-3),
        "sensor": {
            "type": "perspective",
            "fov": 40,
            "to_world": mi.ScalarTransform4f().look_at([-60, 12, 9], [0, 0, 0], [0, 1, 0]),
            "film": {"type": "hdrfilm", "width": 32, "height": 32, "rfilter": {"type": "box"}},
        },
    }
    image = picture(room, 4)
    assert np.abs(image - 1).max() < 1e-6


def test_a_turned_cloak_is_a_mirror() -> None:
    """The impedance-matched square cloak, 40 m long, against Mitsuba's mirror where its flat mirror is."""
    half = 14.1 / np.sqrt(2)
    turn = mi.ScalarTransform4f().rotate([0, 0, 1], 15)
    mirror = {
        "type": "rectangle",
        "to_world": turn @ mi.ScalarTransform4f().rotate([1, 0, 0], 90).scale([half, 2000, 1]),
        "bsdf": {"type": "twosided", "bsdf": {"type": "conductor", "material": "none"}},
    }
    cloak = rooms.device({"kind": "square-cloak", "length": 4000, "rotation": 15})
    # Light that changes with the direction, and that nothing is drawn for.
    pixels = np.linspace(0.2, 1, 64 * 32 * 3, dtype=np.float32).reshape(32, 64, 3)
    pixels = pixels * (1.2 + np.sin(np.arange(64) * 2 * np.pi / 64, dtype=np.float32))[None, :, None]
    room = {
        "type": "scene",
        "integrator": {"type": "cloakroom_path"},
        "sky": {"type": "envmap", "bitmap": mi.Bitmap(pixels)},
        "sensor": {
            "type": "perspective",
            "fov": 30,
            "to_world": mi.ScalarTransform4f().look_at([-60, 3, 0], [0, 0, 0], [0, 1, 0]),
            "film": {"type": "hdrfilm", "width": 48, "height": 48, "rfilter": {"type": "box"}},
        },
    }
    one, other = picture({**room, "there": cloak}), picture({**room, "there": mirror})
    bare = picture(room)
    assert (np.abs(other / bare - 1) > 0.02).mean() > 0.1
    assert abs((one / other).mean() - 1) < 3e-4
    # Pixels on the mirror's edge differ, by what rounding decides.
    assert (np.abs(one / other - 1).max(axis=-1) < 1e-3).mean() > 0.98


def test_the_same_seed_gives_the_same_bytes() -> None:
    room = with_device({"kind": "square-cloak", "length": 14, "side": 12, "material": "negative-uniaxial"}, min_power=0.03)
    one, other = picture(room, 8, 5), picture(room, 8, 5)
    assert one.tobytes() == other.tobytes()
    assert one.tobytes() != picture(room, 8, 6).tobytes()


def test_xml_reads_the_same_as_dict() -> None:
    room = """<scene version="3.0.0">
      <integrator type="cloakroom_path"><integer name="max_depth" value="4"/></integrator>
      <emitter type="constant"/>
      <sensor type="perspective">
        <transform name="to_world"><lookat origin="-1, 0.1, 0" target="0, 0, 0" up="0, 1, 0"/></transform>
        <film type="hdrfilm"><integer name="width" value="24"/><integer name="height" value="24"/><rfilter type="box"/></film>
      </sensor>
      <shape type="rectangle"><transform name="to_world"><rotate y="1" angle="-90"/><translate x="0.4"/></transform>
        <bsdf type="diffuse"><texture type="checkerboard" name="reflectance"/></bsdf></shape>
      DEVICE
    </scene>"""
    made = rooms.device({"kind": "square-cloak", "rotation": 30, "length": 20, "rounded": True}, unit=100)
    matrix = " ".join(map(repr, np.array(made["to_world"].matrix, float).ravel().tolist()))
    keys = '<float name="rotation" value="30"/><float name="length" value="20"/><boolean name="rounded" value="true"/>'
    device = f"""<shape type="cube">
        <transform name="to_world"><matrix value="{matrix}"/></transform>
        <bsdf type="cloakroom"><string name="kind" value="square-cloak"/>{keys}<float name="unit" value="100"/></bsdf>
      </shape>"""
    scene = mi.load_string(room.replace("DEVICE", device))
    one = np.array(scene.integrator().render(scene, seed=1, spp=8))
    scene = mi.load_string(room.replace("DEVICE", ""))
    parts = {shape.id() or f"shape{number}": shape for number, shape in enumerate(scene.shapes())}
    sensor, sky = scene.sensors()[0], {"type": "constant"}
    again = mi.load_dict(
        {"type": "scene", "integrator": {"type": "cloakroom_path", "max_depth": 4}, "sensor": sensor, "sky": sky, **parts, "made": made}
    )
    other = np.array(again.integrator().render(again, seed=1, spp=8))
    assert (np.abs(one - other).max(axis=-1) < 1e-5).mean() > 0.99
    assert one.std() > 0.1


def test_two_devices_may_see_each_other() -> None:
    """Two cloaks one behind the other, in any pose, are nothing, too."""
    places = [mi.ScalarTransform4f().translate(at) for at in ([0.4, 0.6, 0.2], [-0.4, 0.6, 0.4])]
    cloaks = {f"cloak{i}": rooms.device(SPHERE_CLOAK, place, unit=32) for i, place in enumerate(places)}
    nothings = {f"cloak{i}": rooms.device(NOTHING, place, unit=32) for i, place in enumerate(places)}
    one, other = picture(box(**cloaks)), picture(box(**nothings))
    assert (np.abs(one - other).max(axis=-1) < 1e-4).mean() >= 0.999


def test_mistakes_are_told() -> None:
    with pytest.raises(ValueError, match="endless.*`length`"):
        rooms.device({"kind": "square-cloak"})
    with pytest.raises(ValueError, match="surface"):
        rooms.device({"kind": "body", "shape": "sphere", "radius": 3, "surface": {"color": [1, 0, 0]}})
    with pytest.raises(ValueError, match="scales or shears"):
        rooms.device(SPHERE_CLOAK, mi.ScalarTransform4f().scale(2))
    with pytest.raises(ValueError, match="something reaches into the bounding shape 'cloak' of a device, at"):
        picture(box(cloak=rooms.device(SPHERE_CLOAK, mi.ScalarTransform4f().translate([-0.3, -0.4, 0.4]), unit=25)))
    small = rooms.device(SPHERE_CLOAK, mi.ScalarTransform4f().translate(THERE), unit=32)
    small["to_world"] = mi.ScalarTransform4f().translate(THERE).scale(0.2)
    with pytest.raises(ValueError, match="'cloak' does not hold its device"):
        picture(box(cloak=small))
    with pytest.raises(RuntimeError, match="known kinds|kind"):
        mi.load_dict({"type": "cloakroom", "kind": "sphere-clock"})
    with pytest.raises(ValueError, match="surface"):
        rooms.device({"kind": "body", "shape": "sphere", "radius": 3, "surface": {}})
    assert rooms.device({"kind": "square-cloak", "length": np.float32(20), "axis": np.array([0, 1, 0])})["bsdf"]["kind"] == "square-cloak"
    mi.set_variant("scalar_rgb")
    for kind in ("cloakroom", "cloakroom_path"):
        with pytest.raises(RuntimeError, match="scalar_rgb traces rays one by one"):
            mi.load_dict({"type": kind})


POLARIZED = ["llvm_ad_mono_polarized", "llvm_ad_spectral_polarized"]


def plain(value: float) -> Any:
    """A number that is one at all wavelengths."""
    return {"type": "uniform", "value": value} if mi.is_spectral else value


def stokes(room: dict[str, Any], samples: int, seed: int = 1) -> Image:
    """S0 to S3 of the light that comes to the camera, by Mitsuba's own integrator for it; (height, width, 4)."""
    nested = {"type": "cloakroom_path", "max_depth": 6}
    room = {**room, "integrator": {"type": "stokes", "nested": nested}}
    image = np.array(mi.render(mi.load_dict(room), seed=seed, spp=samples))
    # The picture and four of its kind, of which the light's first color does.
    return image[..., -12::3]


def camera(origin: list[float], fov: float, width: int, height: int) -> dict[str, Any]:
    return {
        "type": "perspective",
        "fov": fov,
        "to_world": mi.ScalarTransform4f().look_at(origin, [0, 0, 0], [0, 1, 0]),
        "film": {
            "type": "hdrfilm",
            "width": width,
            "height": height,
            "rfilter": {"type": "box"},
            "pixel_format": "rgb" if mi.is_spectral else "luminance",
        },
    }


@pytest.mark.parametrize("variant_name", POLARIZED)
def test_polarized_light_is_reflected_as_by_mitsubas_own_metal(variant_name: str) -> None:
    """Light through a polarizer, made elliptical by metal: the fields' phases tell right-handed from left-handed light."""
    mi.set_variant(variant_name)
    extinction = 2.0
    turn = mi.ScalarTransform4f().rotate([0.36, 0.48, 0.8], 17)
    # Without absorption, so that each draw of the device is the reflected ray.
    metal = {"kind": "body", "shape": "box", "size": [40, 4, 40], "position": [0, -2, 0], "permittivity": [-(extinction**2), 0]}
    conductor = {"type": "conductor", "eta": plain(0.0), "k": plain(extinction)}
    plate = turn @ mi.ScalarTransform4f().rotate([1, 0, 0], -90).scale(20)
    lamp = mi.ScalarTransform4f().look_at([60, 40, 10], [0, 0, 0], [0, 1, 0]).scale(60)
    sheet = mi.ScalarTransform4f().look_at([45, 30, 8], [0, 0, 0], [0, 1, 0]).scale(60)
    room = {
        "type": "scene",
        "lamp": {"type": "rectangle", "to_world": lamp, "emitter": {"type": "area", "radiance": plain(1.0)}},
        "sheet": {"type": "rectangle", "to_world": sheet, "bsdf": {"type": "polarizer", "theta": plain(30.0)}},
        "sensor": camera([-60, 45, 0], 20, 16, 16),
    }
    one = stokes({**room, "metal": rooms.device(metal, turn)}, 16)
    other = stokes({**room, "metal": {"type": "rectangle", "to_world": plate, "bsdf": conductor}}, 16)
    # The same rays, but for those at the edge.
    lit = (one[..., 0] > 0.01) & (other[..., 0] > 0.01)
    assert lit.mean() > 0.5
    share, expected = one[lit][:, 1:] / one[lit][:, :1], other[lit][:, 1:] / other[lit][:, :1]
    off = np.abs(share - expected).max(axis=-1)
    assert (off < 1e-3).mean() > 0.97, np.sort(off)[-20:]
    # There is something of each to get wrong, and no light is left unpolarized.
    assert (np.abs(expected).max(axis=0) > 0.05).all()
    np.testing.assert_allclose(np.linalg.norm(share, axis=-1), 1, atol=2e-2)


@pytest.mark.parametrize("variant_name", POLARIZED)
@pytest.mark.parametrize(
    "device",
    [
        # Total reflection in it makes light circular.
        {"kind": "square-cloak", "material": "positive-uniaxial", "rotation": 12, "length": 60},
        {"kind": "body", "shape": "box", "size": [22, 16, 30], "index": 1.7, "axis": [0.5, 0.4, 1], "rotation": 25},
    ],
    ids=["i", "glass"],
)
def test_stokes_images_are_those_of_our_own_pictures(device: dict[str, Any], variant_name: str, tmp_path: Path) -> None:
    """A photograph behind a device, by Mitsuba with leaves that are drawn, and by cloakroom with all of them."""
    mi.set_variant(variant_name)
    width, height = 24, 18
    y, x = np.mgrid[0 : 4 * height, 0 : 4 * width]
    photograph = (0.6 + 0.3 * np.sin(x / 31 + 0.4) + 0.25 * np.cos(y / 23) * x / 90).astype(np.float32)
    mi.Bitmap(np.repeat(photograph[..., None], 3, axis=2)).write(str(tmp_path / "photograph.exr"))
    scene = cloakroom.Scene(
        camera={"resolution": [width, height], "samples": 16},
        photograph={"image": str(tmp_path / "photograph.exr"), "width": 110},
        picture={"channels": ["stokes"]},
        devices=[device],
    )
    own = scene.render()
    s0, s1, s2, s3 = (own[f"stokes.S{number}"][..., 0].astype(np.float64) for number in range(4))
    # Mitsuba's horizontal is across the camera's up, ours such that vertical is across its right.
    half = np.tan(np.radians(20))
    right = (np.arange(width) + 0.5) / width * 2 - 1
    up = (1 - (np.arange(height) + 0.5) / height * 2) * height / width
    rays = np.stack(np.broadcast_arrays(1.0, half * up[:, None], half * right), axis=-1)
    rays /= np.linalg.norm(rays, axis=-1, keepdims=True)
    vertical, horizontal = np.cross([0.0, 0, 1], rays), np.cross(rays, [0.0, 1, 0])
    vertical, horizontal = (each / np.linalg.norm(each, axis=-1, keepdims=True) for each in (vertical, horizontal))
    angle = 2 * np.arctan2((horizontal * vertical).sum(axis=-1), (horizontal * np.cross(rays, vertical)).sum(axis=-1))
    c, s = np.cos(angle), np.sin(angle)
    expected = np.stack([s0, s1 * c + s2 * s, s2 * c - s1 * s, s3], axis=-1)
    lamp = {"type": "bitmap", "bitmap": mi.Bitmap(photograph[::-1, :, None].copy()), "raw": True, "wrap_mode": "clamp"}
    place = mi.ScalarTransform4f().translate([50, 0, 0]).rotate([0, 1, 0], -90).scale([55, 55 * height / width, 1])
    room = {
        "type": "scene",
        "photograph": {"type": "rectangle", "to_world": place, "emitter": {"type": "area", "radiance": lamp}},
        "device": rooms.device(device, min_power=1e-4),
        "sensor": camera([-100, 0, 0], 40, width, height),
    }
    # In spectral variants the first color of even light is not its brightness.
    white = {"type": "scene", "sky": {"type": "constant", "radiance": plain(1.0)}, "sensor": room["sensor"]}
    scale = stokes(white, 64)[..., 0].mean()
    images = np.array([stokes(room, 64, seed) / scale for seed in range(4)], dtype=np.float64)
    found, spread = images.mean(axis=0), images.std(axis=0, ddof=1) / 2
    error = np.sqrt((spread**2).sum(axis=(0, 1))) / (width * height)
    largest = np.abs(expected).max(axis=(0, 1))
    for number in range(4):
        # Of the sampling of edges there, and of branches that were pruned, something is left.
        off = (found - expected)[..., number].mean()
        assert abs(off) < 4 * error[number] + 5e-4, f"S{number}: {off} +- {error[number]}"
        likeness = np.corrcoef(found[..., number].ravel(), expected[..., number].ravel())[0, 1]
        assert likeness > 0.93 and largest[number] > 0.03, f"S{number}: {likeness}, {largest}"


@pytest.mark.parametrize("variant_name", POLARIZED)
def test_polarized_light_passes_cloaks_as_if_they_were_not_there(variant_name: str) -> None:
    """Of shadow rays, too: Stokes images among polarizing things, and the variant's `path` without devices."""
    mi.set_variant(variant_name)

    def seen(**more: Any) -> Image:
        room = box(pixels=24, **more)
        # Of all integrators, that of the box does not go with these.
        room["sensor"]["film"]["pixel_format"] = "rgb" if mi.is_spectral else "luminance"
        place = mi.ScalarTransform4f().translate([-0.3, -0.1, 0.45]).rotate([0, 1, 0], 25).scale(0.35)
        room["sheet"] = {"type": "rectangle", "to_world": place, "bsdf": {"type": "polarizer", "theta": plain(20.0)}}
        room["small-box"]["bsdf"] = {"type": "conductor", "eta": plain(0.3), "k": plain(3.0)}
        return stokes(room, 16)

    def placed(device: dict[str, Any]) -> dict[str, Any]:
        return rooms.device(device, mi.ScalarTransform4f().translate([0.4, 0.6, 0.1]), unit=32)

    cloak, nothing, empty = seen(cloak=placed(SPHERE_CLOAK)), seen(cloak=placed(NOTHING)), seen()
    assert (np.abs(cloak - nothing).max(axis=-1) < 1e-4).mean() >= 0.995
    assert (np.abs(cloak - empty).max(axis=-1) < 1e-4).mean() >= 0.9
    off = (cloak - empty)[..., 0].astype(np.float64)
    assert abs(off.mean()) < 3 * off.std() / np.sqrt(off.size) + 1e-6
    assert np.abs(empty[..., 1:]).max() > 0.02


def command(*words: object) -> subprocess.CompletedProcess[str]:
    run = [sys.executable, "-m", "cloakroom.mitsuba", *map(str, words)]
    return subprocess.run(run, capture_output=True, text=True, check=False, cwd=REPOSITORY)


@pytest.mark.parametrize("room", ["study", "bar", "shop-window", "tank"])
def test_rooms_are_rendered(room: str, tmp_path: Path) -> None:
    out = tmp_path / "room.exr"
    done = command(f"scenes/rooms/{room}.xml", "-q", "--size", "24x18", "--samples", 2, "-o", out)
    assert done.returncode == 0, done.stderr
    image = np.array(mi.Bitmap(str(out)))
    assert image.shape == (18, 24, 3) and np.isfinite(image).all() and image.std() > 0
    assert np.array(mi.Bitmap(str(out.with_suffix(".png")))).dtype == np.uint8


def test_a_scene_of_blenders_takes_devices_by_the_names_of_shapes(tmp_path: Path) -> None:
    sample = "scenes/rooms/blender/sample.xml"
    assert command(sample, "--shapes").stdout.split() == ["mesh-Floor", "mesh-Cube_001", "mesh-Suzanne_Ball"]
    out = tmp_path / "sample.exr"
    options = ["-q", "--size", "24x18", "--samples", 4]
    done = command(sample, *options, "--replace", "Cube.001=sphere-cloak:inner=20,outer=50", "-o", out)
    assert done.returncode == 0, done.stderr
    image = np.array(mi.Bitmap(str(out)))
    # The red cube is gone, and nothing is in its place.
    before = tmp_path / "before.exr"
    assert command(sample, *options, "-o", before).returncode == 0
    was = np.array(mi.Bitmap(str(before)))
    red = (was[..., 0] > 2 * was[..., 1]).mean(), (image[..., 0] > 2 * image[..., 1]).mean()
    assert red[0] > 0.05 and red[1] == 0
    wrong = command(sample, *options, "--replace", "Cube.002=sphere-cloak", "-o", out)
    assert wrong.returncode == 1 and "no shape called 'Cube.002'; there are: mesh-Floor" in wrong.stderr


def test_a_box_of_blenders_says_how_it_is_turned(tmp_path: Path) -> None:
    """The committed sample, with its cube turned about the vertical as Blender would write it: in its corners."""
    from cloakroom.mitsuba._room import Room

    turn = np.array(mi.ScalarTransform4f().rotate([0, 1, 0], 25).rotate([1, 0, 0], 10).matrix, np.float64).reshape(4, 4)[:3, :3]
    source = REPOSITORY / "scenes/rooms/blender"
    shutil.copytree(source, tmp_path, dirs_exist_ok=True)
    mesh = tmp_path / "meshes" / "Cube_001.ply"
    lines = mesh.read_text().splitlines()
    first = lines.index("end_header") + 1
    corners = np.array([line.split() for line in lines[first : first + 8]], float)
    turned = (corners - corners.mean(axis=0)) @ turn.T + corners.mean(axis=0)
    lines[first : first + 8] = [" ".join(map(repr, map(float, corner))) for corner in turned]
    mesh.write_text("\n".join(lines) + "\n")

    def placed(folder: Path, name: str) -> np.ndarray:
        room = Room(folder / "sample.xml")
        room.replace(name, {"kind": "square-cloak", "length": 40})
        (bsdf,) = room.root.findall("shape/bsdf[@type='cloakroom']")
        return np.array(bsdf.find("transform/matrix").get("value").split(), float).reshape(4, 4)

    np.testing.assert_allclose(placed(tmp_path, "Cube.001")[:3, :3], turn, atol=1e-6)
    np.testing.assert_allclose(placed(tmp_path, "Cube.001")[:3, 3], corners.mean(axis=0), atol=1e-6)
    np.testing.assert_allclose(placed(source, "Cube.001")[:3, :3], np.eye(3), atol=1e-12)
    # A ball says nothing.
    np.testing.assert_allclose(placed(source, "Suzanne.Ball")[:3, :3], np.eye(3), atol=1e-12)


def test_colors_take_their_own_ways_in_spectral_variants() -> None:
    mi.set_variant("llvm_ad_rgb")
    with pytest.raises(Exception, match="llvm_ad_rgb traces red, green and blue together") as told:
        mi.load_dict(with_device({"kind": "sphere-cloak"}, wavelengths=4))
    assert "llvm_ad_spectral" in str(told.value)
    mi.set_variant("llvm_ad_spectral")
    # Where nothing disperses, one wavelength that stands for all gives the same light in the mean.
    for device in ({"kind": "sphere-cloak"}, {"kind": "body", "shape": "sphere", "radius": 8, "permittivity": 2.25}):
        one, many = (picture(with_device(device, wavelengths=bins), 64) for bins in (1, 4))
        spread = np.std((one - many).reshape(-1, 3), axis=0) / np.sqrt(one[..., 0].size)
        assert (np.abs(one.mean(axis=(0, 1)) - many.mean(axis=(0, 1))) < 4 * spread + 1e-4).all()


def test_a_prism_parts_colors_as_the_tracer_does() -> None:
    """Where light of each bin of wavelengths lands behind a prism of flint, against all leaves at the middle of the bin."""
    mi.set_variant("llvm_ad_spectral")
    prism = {"kind": "prisms", "length": 20, "prism": [{"corners": [[-1.5, -3], [1.5, -3], [0, 6]], "material": "sf11"}]}
    bins, count, reach, behind = 8, 20_000, 40.0, 40.0
    origin, direction = np.array([-30.0, 5, 0]), np.array([1, -0.2, 0]) / np.hypot(1, 0.2)
    # A lamp whose radiance grows along y.
    ramp = np.linspace(0, 1, 512, dtype=np.float32)[:, None, None]
    texture = {"type": "bitmap", "bitmap": mi.Bitmap(ramp.repeat(2, axis=1)), "raw": True, "wrap_mode": "clamp"}
    place = mi.ScalarTransform4f().translate([behind, 0, 0]).rotate([0, 1, 0], -90).scale([reach, reach, 1])
    room = mi.load_dict(
        {
            "type": "scene",
            "integrator": {"type": "cloakroom_path", "max_depth": 2},
            "lamp": {"type": "rectangle", "to_world": place, "emitter": {"type": "area", "radiance": texture}},
            "prism": rooms.device(prism, wavelengths=bins, min_power=1e-5),
        }
    )

    def lit(y: NDArray[np.float64]) -> NDArray[np.float64]:
        # Texels are linear from middle to middle.
        up = (1 - y / reach if flipped else 1 + y / reach) / 2
        return np.clip((up * 512 - 0.5) / 511, 0, 1)

    probe = mi.Ray3f(mi.Point3f(-30, 30, 30), mi.Vector3f(1, 0, 0))
    probe.wavelengths = mi.UnpolarizedSpectrum(550)
    sampler = mi.load_dict({"type": "independent"})
    sampler.seed(0, 1)
    flipped = float(np.array(room.integrator().sample(room, sampler, probe)[0])[0, 0]) < 0.5
    landed = []
    for number in (0, 3, 7):
        middle = 400 + 300 * (number + 0.5) / bins
        sampler.seed(number, count)
        ray = mi.Ray3f(dr.zeros(mi.Point3f, count) + mi.Point3f(*origin.tolist()), mi.Vector3f(*direction.tolist()))
        # Anywhere in the bin.
        first = middle + 37.4 * (mi.Float(np.random.default_rng(number).random(count)) - 0.5)
        ray.wavelengths = mi.UnpolarizedSpectrum(first, 420, 560, 680)
        light = np.array(room.integrator().sample(room, sampler, ray)[0], dtype=np.float64).reshape(4, count)
        # The first wavelength has stood for all four.
        assert (light[1:] == 0).all()
        leaves = cloakroom.Scatterer(
            cloakroom.Scene(devices=prism, light={"wavelength_nm": middle}), min_power=1e-5
        ).scatter(origin, direction)
        ways = (behind - leaves.position[:, 0]) / leaves.direction[:, 0]
        at = leaves.position[:, 1] + ways * leaves.direction[:, 1]
        across = np.abs(leaves.position[:, 2] + ways * leaves.direction[:, 2])
        meets = (ways > 0) & (np.abs(at) < reach) & (across < reach)
        expected = 4 * (leaves.weight * np.where(meets, lit(at), 0)).sum() / leaves.weight.sum()
        error = light[0].std() / np.sqrt(count)
        assert abs(light[0].mean() - expected) < 4 * error + 1e-4, f"{middle} nm: {light[0].mean()} {expected} +- {error}"
        landed.append(float(at[np.argmax(leaves.weight * meets)]))
        # The strongest leaf of them all is found where it lands, to what single precision leaves.
        strongest = 4 * lit(np.array(landed[-1]))
        assert (np.abs(light[0] - strongest) < 2e-3).mean() > 0.6
    # Blue is bent most, by more than is said above.
    assert landed[0] < landed[1] - 0.2 < landed[2] - 0.3, landed


def test_noise_is_taken_away_by_open_image_denoise() -> None:
    pytest.importorskip("pyoidn")
    from cloakroom.mitsuba._picture import denoised

    noisy, clean = picture(box(pixels=64), 4), picture(box(pixels=64), 256)
    found = denoised(noisy)
    assert found is not None and found.shape == noisy.shape and found.dtype == np.float32
    # The lamp apart, which is far brighter than all else.
    dim = clean.max(axis=-1) < 2
    assert np.square(found - clean)[dim].mean() < 0.3 * np.square(noisy - clean)[dim].mean()


FLOOR = [
    ("two balls in one box", {"scene": "balls.toml"}, [([-6, 0, -6], 1.0), ([6, 0, 6], 1.0)]),
    ("a ball", {"kind": "body", "shape": "sphere", "radius": 5, "index": 1.5}, [([0, 0, 0], 5.0)]),
]


@pytest.mark.parametrize(("name", "device", "balls"), FLOOR, ids=[name for name, *_ in FLOOR])
@pytest.mark.parametrize("lamp", ["area", "point", "directional"])
@pytest.mark.parametrize("see_through", ["auto", "yes", "no"])
def test_glass_over_a_floor_is_as_bright_as_mitsubas(
    lamp: str, see_through: str, name: str, device: dict[str, Any], balls: list[Any], tmp_path: Path
) -> None:
    """The light of a floor below glass that fills its box or does not; only where no shadow ray goes through is that of points lost."""
    up = mi.ScalarTransform4f()
    lamps: dict[str, Any] = {
        "area": {"type": "rectangle", "to_world": up.translate([0, 60, 0]).rotate([1, 0, 0], 90).scale(30), "emitter": {"type": "area"}},
        "point": {"type": "point", "position": [0, 40, 0], "intensity": 1e3},
        "directional": {"type": "directional", "direction": [0.1, -1, 0]},
    }
    bodies = "".join(
        f'[[device]]\nkind = "body"\nshape = "sphere"\nradius = {radius}\nindex = 1.5\nposition = {at}\n' for at, radius in balls
    )
    (tmp_path / "balls.toml").write_text(bodies)
    if "scene" in device:
        device = {"scene": str(tmp_path / "balls.toml")}

    def light(integrator: str, **glass: Any) -> float:
        room = {
            "type": "scene",
            "integrator": {"type": integrator, "max_depth": 12},
            "floor": {"type": "rectangle", "to_world": up.rotate([1, 0, 0], -90).scale(30)},
            "lamp": lamps[lamp],
            "sensor": camera([-60, 18, 0], 40, 24, 24) | {"sampler": {"type": "independent"}},
            **glass,
        }
        room["sensor"]["film"]["pixel_format"] = "rgb"
        return float(picture(room, 256).mean())

    own = light("cloakroom_path", glass=rooms.device(device, up.translate([0, 12, 0]), see_through=see_through))
    theirs = {
        f"ball{i}": {"type": "sphere", "center": [x, y + 12, z], "radius": radius, "bsdf": {"type": "dielectric", "int_ior": 1.5, "ext_ior": 1.0}}
        for i, ([x, y, z], radius) in enumerate(balls)
    }
    wanted = light("path", **theirs)
    off = own / wanted - 1
    if see_through == "no" and lamp != "area" and len(balls) > 1:
        assert off < -0.01
    else:
        # Three times what pictures of other seeds differ by.
        assert abs(off) < 4e-3, f"{own} instead of {wanted}"


def test_shadow_rays_go_through_devices_far_from_the_origin() -> None:
    """The whole room is moved by ten times its size: single precision leaves that much less."""

    def moved(room: dict[str, Any], by: float) -> dict[str, Any]:
        for part in room.values():
            if isinstance(part, dict) and "to_world" in part:
                part["to_world"] = mi.ScalarTransform4f().translate([by, 0, 0]) @ part["to_world"]
        return room

    place = mi.ScalarTransform4f().translate([10 + THERE[0], *THERE[1:]])
    cloaked = moved(box(pixels=24), 10) | {"cloak": rooms.device(SPHERE_CLOAK, place, unit=32)}
    one, other = picture(cloaked, 64), picture(moved(box(pixels=24), 10), 64)
    assert (np.abs(one - other).max(axis=-1) < 1e-3).mean() > 0.98
    assert abs(one.mean() / other.mean() - 1) < 5e-3


@pytest.mark.parametrize("sampler", ["stratified", "orthogonal", "multijitter", "ldsampler"])
def test_samplers_may_take_more_samples_than_they_are_asked_for(sampler: str) -> None:
    def seen(integrator: str) -> Image:
        room = box(integrator, pixels=20)
        room["sensor"]["sampler"] = {"type": sampler}
        return picture(room, 10)

    assert np.abs(seen("cloakroom_path") - seen("path")).max() < 2e-6


@pytest.mark.parametrize("keys", [{"hide_emitters": True}, {"max_depth": 0}, {"max_depth": 1}], ids=str)
def test_what_is_not_to_be_seen_is_not_seen(keys: dict[str, Any]) -> None:
    def seen(integrator: str) -> Image:
        room = box(integrator)
        # From below, for the lamp to be in the middle.
        room["sensor"]["to_world"] = mi.ScalarTransform4f().look_at([0, -0.6, 0], [0.01, 1, 0], [0, 0, 1])
        room["integrator"].update(keys)
        return picture(room)

    one, other = seen("cloakroom_path"), seen("path")
    assert np.abs(one - other).max() < 2e-6 * max(1.0, float(other.max()))


def test_an_integrator_sees_the_devices_of_each_scene() -> None:
    """Scenes come and go, and another may lie where one has been."""
    integrator = mi.load_dict({"type": "cloakroom_path", "max_depth": 6})
    for kind in ("mirror", "air", "mirror", "none", "air"):
        room = box()
        if kind != "none":
            air = NOTHING if kind == "air" else {"kind": "square-cloak", "length": 16, "side": 13, "rotation": 40}
            room = with_device(air)
        scene = mi.load_dict(room)
        one = np.array(integrator.render(scene, seed=1, spp=2))
        del scene
        assert np.array_equal(one, picture(room, 2)), kind


def test_devices_that_nobody_would_see_are_refused() -> None:
    made = rooms.device(SPHERE_CLOAK, mi.ScalarTransform4f().translate(THERE), unit=32)
    masked = {**made, "bsdf": {"type": "mask", "opacity": 0.5, "nested": made["bsdf"]}}
    group = {"type": "shapegroup", "of": made}
    for parts in ({"cloak": masked}, {"group": group, "one": {"type": "instance", "of": {"type": "ref", "id": "group"}}}):
        with pytest.raises(ValueError, match="put its bounding shape into the scene itself"):
            picture(box(**parts))
    # An integrator that has seen a scene without devices looks again.
    integrator = mi.load_dict({"type": "cloakroom_path"})
    integrator.render(mi.load_dict(box()), spp=1)
    with pytest.raises(ValueError, match="put its bounding shape into the scene itself"):
        integrator.render(mi.load_dict(box(cloak=masked)), spp=1)
    lamp = {"type": "point", "position": THERE, "intensity": {"type": "rgb", "value": 1.0}}
    with pytest.raises(ValueError, match="a lamp stands in the bounding shape 'cloak'"):
        picture(box(cloak=made, lamp=lamp))
    scene = mi.load_dict(box(cloak=made))
    mi.render(scene, spp=1)
    parameters = mi.traverse(scene)
    parameters["cloak.to_world"] = mi.Transform4f().translate([0, 0.3, 0]) @ parameters["cloak.to_world"]
    parameters.update()
    with pytest.raises(ValueError, match="'cloak' does not hold its device"):
        scene.integrator().render(scene, spp=1)


def test_meshes_without_bounds_are_refused_in_light_from_afar() -> None:
    """Mitsuba makes one mesh of those that have the same BSDF, forgets how large it is, and shortens shadow rays to the sky."""
    matt = {"type": "diffuse", "reflectance": {"type": "rgb", "value": 0.5}}
    planes = {f"plane{x}": {"type": "rectangle", "to_world": mi.ScalarTransform4f().translate([0, 0, x]), "bsdf": matt} for x in (-40, 40)}
    room = {
        "type": "scene",
        "integrator": {"type": "cloakroom_path"},
        "sky": {"type": "constant"},
        "sensor": camera([-60, 0, 0], 20, 8, 8),
        "device": rooms.device(SPHERE_CLOAK),
        **planes,
    }
    scene = mi.load_dict(room)
    with pytest.raises(ValueError, match="optimize=False"):
        scene.integrator().render(scene, spp=1)
    scene = mi.load_dict(room, optimize=False)
    scene.integrator().render(scene, spp=1)


def test_thin_devices_have_a_place() -> None:
    """A mirror that has no thickness, and one of Mitsuba's."""
    place = mi.ScalarTransform4f().translate([0.2, 0.6, 0.3]).rotate([0, 1, 0], 60)
    own = picture(box(mirror=rooms.device({"kind": "mirror"}, place, unit=32)), 64)
    half = 10 / 32
    square = place @ mi.ScalarTransform4f().rotate([0, 1, 0], 90) @ mi.ScalarTransform4f().scale([half, half, 1])
    theirs = {"type": "rectangle", "to_world": square, "bsdf": {"type": "twosided", "of": {"type": "conductor", "material": "none"}}}
    # Crossings of devices do not count as steps of a path, which ends some paths later, and draw other numbers.
    other = picture(box(mirror=theirs), 64)
    assert abs(own.mean() / other.mean() - 1) < 1e-2
    assert np.abs(own - other).mean() < 0.03 * other.mean()
    assert np.abs(picture(box(), 64) - other).mean() > 0.06 * other.mean()


def test_which_devices_need_a_length() -> None:
    from cloakroom.mitsuba._room import device_of, is_endless

    for kind in ("square-cloak", "double-gaussian-cloak", "cylinder-cloak", "mirror-detour", "gaussian-carpet"):
        assert is_endless(device_of(kind)), kind
    for text in ("sphere-cloak", "lens", "mirror", "polyhedron", "graded-box", "fisheye-hemisphere", "square-cloak:length=9", "sphere-clock"):
        assert not is_endless(device_of(text)), text


@pytest.mark.parametrize("turned", [0, 10, 30])
@pytest.mark.parametrize("keys", [{}, {"axis": [0, 1, 0]}, {"rotation": 20}], ids=str)
def test_the_outline_of_a_device_says_how_it_is_turned(keys: dict[str, Any], turned: float, tmp_path: Path) -> None:
    """The square cloak's stands on an edge; turned in Blender, it is written in the world's frame."""
    from cloakroom.mitsuba._room import Room

    device = {"kind": "square-cloak", "length": 40, **keys}
    exported = {key: value for key, value in device.items() if key != "rotation"}
    (outline, *_) = cloakroom.Scatterer(cloakroom.Scene(devices=exported), unit=100).outlines()
    turn = np.array(mi.ScalarTransform4f().rotate([0, 0, 1], turned).matrix, np.float64).reshape(4, 4)[:3, :3]
    corners = (outline.triangles.reshape(-1, 3) @ turn.T + [1, 2, 3]).astype(np.float32)
    mesh = mi.Mesh("outline", len(corners), len(corners) // 3)
    parameters = mi.traverse(mesh)
    parameters["vertex_positions"], parameters["faces"] = corners.ravel(), np.arange(len(corners), dtype=np.uint32)
    parameters.update()
    mesh.write_ply(str(tmp_path / "outline.ply"))
    shape = '<shape type="ply" id="outline"><string name="filename" value="outline.ply"/></shape>'
    (tmp_path / "room.xml").write_text(f'<scene version="3.0.0"><sensor type="perspective"/>{shape}</scene>')
    room = Room(tmp_path / "room.xml")
    room.replace("outline", device)
    placed = np.array(room.root.find("shape/bsdf/transform/matrix").get("value").split(), float).reshape(4, 4)
    np.testing.assert_allclose(placed[:3, :3], turn, atol=1e-5)
    np.testing.assert_allclose(placed[:3, 3], [1, 2, 3], atol=1e-5)


def test_rooms_keep_what_they_say(tmp_path: Path) -> None:
    """Parameters, other files, units, and what the device in the room sees through."""
    from cloakroom.mitsuba._room import Room

    (tmp_path / "shapes.xml").write_text(
        '<scene version="3.0.0"><shape type="cube" id="marker"><transform name="to_world"><scale value="$half"/>'
        '<rotate y="1" angle="$turn"/></transform></shape></scene>'
    )
    (tmp_path / "room.xml").write_text(
        '<scene version="3.0.0"><default name="depth" value="3"/><default name="half" value="20"/><default name="turn" value="30"/>'
        '<integrator type="path"><integer name="max_depth" value="$depth"/><integer name="max_crossings" value="7"/></integrator>'
        '<sensor type="perspective"/><emitter type="constant"/><include filename="shapes.xml"/><shape type="sphere" id="place">'
        '<bsdf type="cloakroom"><string name="kind" value="sphere-cloak"/><string name="see_through" value="yes"/></bsdf></shape></scene>'
    )
    room = Room(tmp_path / "room.xml")
    assert room.shapes == ["marker", "place"]
    room.replace("place", SPHERE_CLOAK)
    room.replace("marker", {"kind": "square-cloak", "length": 16, "side": 13}, see_through="no")
    assert [each.get("value") for each in room.root.findall("shape/bsdf/string[@name='see_through']")] == ["no", "yes"]
    assert [each.get("value") for each in room.root.findall("shape/bsdf/float[@name='unit']")] == ["1.0", "1.0"]
    placed = np.array(room.root.find("shape/bsdf/transform/matrix").get("value").split(), float).reshape(4, 4)
    turn = np.array(mi.ScalarTransform4f().rotate([0, 1, 0], 30).matrix, np.float64).reshape(4, 4)
    np.testing.assert_allclose(placed, turn, atol=1e-6)
    room.root.remove(room.root.find("shape[@id='place']"))
    scene = room.load(size=(8, 6), samples=9)
    integrator = scene.integrator()
    assert (integrator.max_depth, integrator.max_crossings, integrator.see_through) == (3, 7, True)
    assert scene.sensors()[0].sampler().sample_count() == 9
    (tmp_path / "blind.xml").write_text('<scene version="3.0.0"/>')
    with pytest.raises(ValueError, match="no <sensor>"):
        Room(tmp_path / "blind.xml")
    with pytest.raises(ValueError, match="in a group that is instanced"):
        (tmp_path / "group.xml").write_text(
            '<scene version="3.0.0"><sensor type="perspective"/><shape type="shapegroup" id="all"><shape type="cube" id="one"/></shape></scene>'
        )
        Room(tmp_path / "group.xml").replace("one", SPHERE_CLOAK)


def test_a_picture_without_colors_is_grey(tmp_path: Path) -> None:
    out = tmp_path / "room.exr"
    words = ["scenes/rooms/bar.xml", "-q", "--size", "24x18", "--samples", 2, "--variant", "llvm_ad_mono", "-o", out]
    done = command(*words, "--device", "sphere-cloak")
    assert done.returncode == 0, done.stderr
    image = np.array(mi.Bitmap(str(out)))
    assert image.shape == (18, 24, 3) and image.std() > 0 and out.with_suffix(".png").exists()
    for wrong, message in (
        (["--empty"], "not allowed with argument"),
        (["--size", "0x3"], "has no pixels"),
        (["--seed", "-1"], "--seed"),
        (["--exposure", "nan"], "no number of stops"),
    ):
        done = command(*words, "--device", "sphere-cloak", *wrong)
        assert done.returncode == 2 and message in done.stderr, done.stderr


@pytest.mark.parametrize("kind", ["sphere-cloak", "double-gaussian-cloak"])
def test_a_second_pass_compiles_nothing(kind: str) -> None:
    device = {"kind": kind} if kind == "sphere-cloak" else {"kind": kind, "length": 10, "width": 12, "height": 14, "w": 2.5, "h": 1}
    room = mi.load_dict(with_device(device))
    room.integrator().render(room, seed=1, spp=16)
    with dr.scoped_set_flag(dr.JitFlag.KernelHistory, True):
        for seed in (1, 2, 3, 4):
            dr.kernel_history_clear()
            room.integrator().render(room, seed=seed, spp=16)
            kernels = [kernel for kernel in dr.kernel_history() if kernel["type"] == dr.KernelType.JIT]
            assert len(kernels) > 20
            assert not [kernel for kernel in kernels if not kernel["cache_hit"] or kernel["cache_disk"]], seed
