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


@pytest.mark.parametrize("variant_name", ["llvm_ad_rgb", "llvm_ad_spectral"])
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


def test_polarized_variants_are_refused() -> None:
    mi.set_variant("llvm_ad_spectral_polarized")
    with pytest.raises(RuntimeError, match="does not go with polarized variants"):
        mi.load_dict({"type": "cloakroom_path"})


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


def test_noise_is_taken_away_by_open_image_denoise() -> None:
    pytest.importorskip("pyoidn")
    from cloakroom.mitsuba._picture import denoised

    noisy, clean = picture(box(pixels=64), 4), picture(box(pixels=64), 256)
    found = denoised(noisy)
    assert found is not None and found.shape == noisy.shape and found.dtype == np.float32
    # The lamp apart, which is far brighter than all else.
    dim = clean.max(axis=-1) < 2
    assert np.square(found - clean)[dim].mean() < 0.3 * np.square(noisy - clean)[dim].mean()
