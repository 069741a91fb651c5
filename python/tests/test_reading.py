"""Scenes are read as they are made: tables as attributes, equality, drawings, estimates."""

from __future__ import annotations

import json
import pickle
import urllib.request
import warnings
from pathlib import Path

import numpy as np
import pytest

import cloakroom
from cloakroom import Camera, Photograph, Scene, SquareCloak, export, figures, flux, sweep
from conftest import REPOSITORY

EXAMPLES = sorted((REPOSITORY / "scenes").rglob("*.toml"))


def parts(scene: Scene) -> dict:
    names = ("camera", "photograph", "surroundings", "light", "trace", "picture", "receiver", "devices")
    return {name: getattr(scene, name) for name in names}


@pytest.mark.parametrize("path", EXAMPLES, ids=lambda path: path.stem)
def test_scenes_are_made_again_of_their_tables(path: Path, tmp_path, monkeypatch) -> None:
    scene = Scene.load(path)
    # Files are found from any folder.
    monkeypatch.chdir(tmp_path)
    again = Scene(**parts(scene))
    assert again == scene and hash(again) == hash(scene)
    assert parts(again) == parts(scene)
    assert pickle.loads(pickle.dumps(scene)) == scene


def test_tables_are_read_as_what_they_are() -> None:
    image = np.full((2, 3, 3), 7, dtype=np.uint8)
    cloak = SquareCloak(rotation=10)
    scene = Scene(camera=Camera(samples=2), photograph=Photograph(image=image, x=60), devices=[cloak])
    assert scene.devices == (cloak,) and scene.devices[0].rotation == 10
    assert scene.camera == Camera(samples=2) and scene.camera.field_of_view == 40
    assert scene.photograph.x == 60 and scene.photograph == Photograph(image=image, x=60)
    assert scene.light == cloakroom.Light() and scene.surroundings.color == [0, 0, 0]
    turned = scene.replace({"device.0.rotation": 5, "camera.samples": 4})
    assert turned.devices[0].rotation == 5 and turned.camera.samples == 4
    assert Scene(**parts(turned)) == turned
    other = scene.replace({"photograph.image": image + 1})
    assert other != scene and other.photograph != scene.photograph
    assert scene != "a text" and scene == scene.replace({"device.0.rotation": 10.0})
    assert len({scene, scene.replace({}), turned}) == 2


def test_graded_devices_are_read_with_their_samples() -> None:
    scene = Scene(devices=cloakroom.Graded(index=lambda x, y: 1 + 0.01 * x**2 / 100, spacing=5, width=40, height=40))
    again = Scene(devices=scene.devices)
    assert again == scene and np.shape(again.devices[0].index) == (9, 9)


def test_settings_and_diagrams_are_those_of_the_command(command, cloak: Scene, tmp_path) -> None:
    (tmp_path / "scene.toml").write_text(cloak.toml)
    command("diagram", tmp_path / "scene.toml", "-o", tmp_path / "plain.svg")
    assert cloak.diagram().svg == (tmp_path / "plain.svg").read_text()
    words = ["--rays", 7, "--parallel", 10, "--polarization", "vertical", "--wavefronts", 4, "--width", 20, "--z", 1]
    command("diagram", tmp_path / "scene.toml", *words, "--min-power", 0.1, "--size", "800x400", "-o", tmp_path / "a.svg")
    drawn = cloak.diagram(
        7, parallel=10, polarization="vertical", wavefronts=4, width=20, z=1, min_power=0.1, size=(800, 400)
    )
    assert drawn.svg == drawn._repr_svg_() == (tmp_path / "a.svg").read_text()
    command("diagram", tmp_path / "scene.toml", "--point=-30,2,0", "--space", "30,20", "--layers", 2, "-o", tmp_path / "b.svg")
    assert cloak.diagram(point=[-30, 2, 0], space=(30, 20), layers=2).svg == (tmp_path / "b.svg").read_text()
    command("diagram", tmp_path / "scene.toml", "--pulse", 0.4, "--delay", "phase", "-o", tmp_path / "pulse.svg")
    assert cloak.diagram(pulse=0.4, delay="phase").svg == (tmp_path / "pulse.svg").read_text()
    command("diagram", tmp_path / "scene.toml", "--setting", "--size", "40x30", "-o", tmp_path / "setting.svg")
    assert cloak.setting().svg == cloak._repr_svg_() == (tmp_path / "setting.svg").read_text()
    cloak.diagram(camera=True).save(tmp_path / "c.pdf")
    assert (tmp_path / "c.pdf").read_bytes().startswith(b"%PDF")
    with pytest.raises(ValueError, match="use .svg, .pdf or .png"):
        drawn.save(tmp_path / "c.jpg")


@pytest.mark.parametrize(
    ("keys", "error", "message"),
    [
        ({"rays": 0}, ValueError, "the number of rays is 0; it must be from 1 to 2000"),
        ({"rays": 2.5}, TypeError, "rays is a float"),
        ({"parallel": 3, "camera": True}, ValueError, "parallel and camera are given"),
        ({"point": [1, 2]}, ValueError, "point is [1, 2]; expected 3 numbers (cm)"),
        ({"polarization": "round"}, ValueError, "polarization is 'round'"),
        ({"size": (0, 10)}, ValueError, "size must be one pixel at least"),
    ],
)
def test_bad_diagrams_are_told(cloak: Scene, keys: dict, error: type[Exception], message: str) -> None:
    with pytest.raises(error) as raised:
        cloak.diagram(**keys)
    assert message in str(raised.value)
    with pytest.raises(ValueError, match="no device that could be drawn"):
        Scene().diagram()


def test_a_scene_that_cannot_be_is_shown_as_a_text() -> None:
    scene = Scene(devices=[SquareCloak(), SquareCloak()])
    assert scene._repr_svg_() is None and "square-cloak" in repr(scene)


def test_pulses_are_those_of_the_command(command, cloak: Scene, tmp_path) -> None:
    (tmp_path / "scene.toml").write_text(cloak.toml)
    printed = json.loads(command("pulses", tmp_path / "scene.toml", "--pixel", "20,15", "--json").stdout)
    assert cloak.pulses(20, 15) == printed
    with pytest.raises(ValueError, match="there is no pixel 40,0"):
        cloak.pulses(40, 0)


def test_estimates_are_of_time_memory_and_rays(cloak: Scene) -> None:
    estimate = cloak.estimate()
    assert estimate.samples == 1200 and estimate.threads == cloakroom.threads()
    assert 0 < estimate.rays_per_sample <= 1 and 0 < estimate.seconds < 100
    assert cloak.replace({"camera.resolution": [80, 60]}).estimate().memory == 4 * estimate.memory > 0


def test_films_are_those_of_the_command(command, cloak: Scene, tmp_path) -> None:
    (tmp_path / "scene.toml").write_text(cloak.toml)
    command("animate", tmp_path / "scene.toml", "--sweep", "device.0.rotation=0,5,10", "-o", tmp_path / "a.gif")
    told = []
    keys = {"device.0.rotation": np.array([0, 5, 10])}
    cloak.animate(keys, tmp_path / "b.gif", progress=lambda done, total: told.append((done, total)))
    assert (tmp_path / "b.gif").read_bytes() == (tmp_path / "a.gif").read_bytes()
    assert told[-1] == (93, 93) and not (tmp_path / "b.gif.frames").exists()
    cloak.animate(keys, tmp_path / "frames")
    assert len(list((tmp_path / "frames").iterdir())) == 3
    for wrong, message in [
        ({"device.0.rotation": [1, 2], "camera.samples": [1]}, "differ in their values"),
        ({"camera.resolution": [[10, 10], [20, 20]]}, "a film has one size"),
        ({"picture.map": ["delivered"]}, "give map_range"),
        ({"device.0.turn": [1]}, "unknown key `turn`"),
    ]:
        with pytest.raises(ValueError, match=message):
            cloak.animate(wrong, tmp_path / "c.gif")
    with pytest.raises(ValueError, match="cannot tell the format"):
        cloak.animate(keys, tmp_path / "c.txt")
    command("animate", tmp_path / "scene.toml", "--orbit", "0..10", "--frames", 3, "-o", tmp_path / "d.gif")
    cloak.animate({}, tmp_path / "e.gif", orbit=[0, 5, 10])
    assert (tmp_path / "d.gif").read_bytes() == (tmp_path / "e.gif").read_bytes()
    with pytest.raises(ValueError, match="device.0.rotation 3, orbit 2"):
        cloak.animate(keys, tmp_path / "c.gif", orbit=[0, 5])


def test_figures_are_those_of_the_command(command, tmp_path) -> None:
    arguments = ["--only", "6", "--size", "40x30", "--samples", 1, "--out", tmp_path / "command"]
    command("figures", *arguments)
    files = figures("6", tmp_path / "here", size=(40, 30), samples=1)
    assert {file.name for file in files} == {file.name for file in (tmp_path / "command").iterdir()}
    for file in files:
        assert file.read_bytes() == (tmp_path / "command" / file.name).read_bytes(), file.name
    with pytest.raises(ValueError, match="there is no figure or panel `10`"):
        figures("10", tmp_path)


def test_the_page_is_served_until_it_is_closed(cloak: Scene) -> None:
    with cloak.view(open=False) as page:
        with urllib.request.urlopen(page.address) as answer:
            assert answer.status == 200 and b"<html" in answer.read()
        assert page.address in page._repr_html_() and page.address in repr(page)
    with pytest.raises(OSError):
        urllib.request.urlopen(page.address, timeout=1)
    with pytest.raises(ValueError, match="the page shows files"):
        Scene(photograph=np.zeros((2, 2), dtype=np.uint8)).view(open=False)


def test_exports_are_arrays_without_a_path(tmp_path) -> None:
    scene = Scene(devices=SquareCloak(material="negative-uniaxial"))
    arrays = export(scene, grid=(9, 8, 2))
    assert export(scene, tmp_path / "a.npz", grid=(9, 8, 2)) is None
    written = np.load(tmp_path / "a.npz")
    assert set(arrays) == set(written) - {"metadata"}
    for name, array in arrays.items():
        np.testing.assert_array_equal(array, written[name])
    segments = export(scene, table=True)
    export(scene, tmp_path / "a.json", table=True)
    assert segments[0]["filling"] == "medium" and len(segments) > 4
    dataset = pytest.importorskip("xarray") and arrays.to_xarray()
    assert dataset["index"].dims == ("x", "y", "z") and dataset["permittivity"].dims[3:] == ("row", "column")
    np.testing.assert_array_equal(dataset["x"], arrays["x"])


def test_datasets_of_xarray(cloak: Scene) -> None:
    pytest.importorskip("xarray")
    dataset = cloak.render().to_xarray()
    assert dataset["time_of_flight"].dims == ("row", "column") and dataset.sizes["column"] == 40
    assert "square-cloak" in dataset.attrs["scene"]
    stokes = cloak.replace({"picture.channels": ["stokes"]}).render().to_xarray()
    assert any(variable.dims == ("row", "column", "color") for variable in stokes.values())
    table = sweep(cloak, {"camera.polarizer": ["none", "vertical"], "device.0.rotation": [0, 10, 20]}).to_xarray()
    assert table["delivered"].dims == ("camera.polarizer", "device.0.rotation")
    assert table["delivered"].sel({"camera.polarizer": "vertical", "device.0.rotation": 10}).shape == ()
    light = flux(cloak.replace({"receiver.position": [20, 0, 0]}), [0, 20], rays=64, samples=2, cells=4)
    bright = light.to_xarray()
    assert bright["total"].sel(device="cloaked", polarization="vertical").dims == ("incidence",)
    np.testing.assert_array_equal(bright["map"], light["map"])


def test_floats_are_light_or_srgb() -> None:
    random = np.random.default_rng(0)
    codes = random.integers(0, 256, (8, 9, 3), dtype=np.uint8)
    floats = codes / 255
    camera = {"resolution": [20, 15], "samples": 1}

    def light(image: object, **keys: object) -> np.ndarray:
        return Scene(camera=camera, photograph=Photograph(image=image, **keys)).render(image_only=True).linear

    expected = light(codes)
    np.testing.assert_allclose(light(floats, encoding="srgb"), expected, atol=1e-6)
    with pytest.warns(UserWarning, match='say encoding="srgb"'):
        dark = light(floats)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        np.testing.assert_array_equal(light(floats, encoding="linear"), dark)
        light(floats**2)
        light(np.eye(8))
        photograph = Photograph(image=floats, encoding="linear")
        assert photograph.replace(x=60).x == 60 and pickle.loads(pickle.dumps(photograph)) == photograph
        np.testing.assert_array_equal(light(codes, encoding="linear"), dark)
    with pytest.warns(UserWarning, match="photograph has floats that are whole numbers up to 255.*divide by 255"):
        Scene(photograph=codes.astype(float))
    with pytest.warns(UserWarning, match="half of which are above .*divide by 255"):
        Scene(photograph=0.5 * codes + 0.3)
    with pytest.warns(UserWarning, match="negative numbers, -1 among them"):
        Scene(photograph=2 * floats.clip(0, 1) - 1)
    with pytest.raises(ValueError, match="numbers from 0 to 25.*; floats in sRGB are from 0 to 1: divide by 255"):
        Photograph(image=codes.astype(float), encoding="srgb")
    with pytest.raises(ValueError, match="encoding is 'gamma'"):
        Photograph(image=floats, encoding="gamma")
    with pytest.raises(ValueError, match="encoding is that of arrays"):
        Photograph(image="a.png", encoding="srgb")


def test_alpha_lies_over_black() -> None:
    codes = np.full((4, 5, 4), 200, dtype=np.uint8)
    camera = {"resolution": [20, 15], "samples": 1}

    def light(image: object) -> np.ndarray:
        return Scene(camera=camera, photograph=image).render(image_only=True).linear

    opaque, half = codes.copy(), codes.copy()
    opaque[..., 3], half[..., 3] = 255, 51
    np.testing.assert_array_equal(light(opaque), light(codes[..., :3]))
    np.testing.assert_allclose(light(half), 0.2 * light(codes[..., :3]), rtol=1e-5)
    floats = np.full((4, 5, 4), 0.5)
    np.testing.assert_allclose(light(floats), 0.5 * light(floats[..., :3]), rtol=1e-5)
    with pytest.raises(ValueError, match=r"image.transpose\(1, 2, 0\) has the colors last"):
        Photograph(image=np.zeros((3, 40, 50)))


def test_keys_come_in_the_order_in_which_they_matter() -> None:
    import inspect

    assert list(inspect.signature(SquareCloak).parameters)[:3] == ["material", "side", "kappa"]
    assert list(inspect.signature(Photograph).parameters)[:2] == ["image", "encoding"]
    assert list(inspect.signature(Camera).parameters)[:2] == ["position", "target"]
