"""Scenes, and the pictures they make."""

from __future__ import annotations

import os
import pickle
import signal
import subprocess
import sys
import threading
import time
from pathlib import Path

import numpy as np
import pytest

import cloakroom
from cloakroom import Camera, Photograph, Picture, Scene, SquareCloak, _cloakroom


def test_pictures_are_those_of_the_command(command, paper, tmp_path: Path) -> None:
    for ending in ("npz", "exr", "png"):
        theirs, ours = tmp_path / f"theirs.{ending}", tmp_path / f"ours.{ending}"
        keys = {"camera.resolution": [64, 48], "camera.samples": 2}
        command("render", paper("6c"), "-o", theirs, *(f"--set={k}={v}" for k, v in keys.items()))
        scene = Scene.load(paper("6c")).replace(keys)
        scene.render(image_only=ending == "png").save(ours)
        assert ours.read_bytes() == theirs.read_bytes(), ending


def test_channels_are_arrays_with_names(cloak: Scene) -> None:
    picture = cloak.replace({"picture.channels": ["stokes"]}).render()
    assert picture.shape == (30, 40) and len(picture) == 20
    assert picture["time_of_flight"] is picture.time_of_flight
    assert picture.time_of_flight.dtype == np.float64 and picture.delivered.dtype == np.float32
    assert picture["stokes.S0"].shape == (30, 40, 3)
    assert picture.image.shape == (30, 40, 3) and picture.image.dtype == np.uint8
    np.testing.assert_array_equal(picture.linear[..., 1], picture["G"])
    shares = picture.delivered + picture.escaped + picture.absorbed + picture.pruned
    np.testing.assert_allclose(shares, 1, atol=1e-6)
    assert picture.metadata["seed"] == "0" and "square-cloak" in picture.metadata["scene"]
    assert picture.rarities == {"endless": 0, "lost": 0}
    assert picture._repr_png_().startswith(b"\x89PNG") and "40 x 30" in repr(picture)
    with pytest.raises(KeyError, match="no channel `depth`; it has R, G"):
        picture["depth"]
    with pytest.raises(AttributeError, match="no channel `depth`"):
        picture.depth


def test_the_image_alone_is_the_same_image(cloak: Scene) -> None:
    alone = cloak.render(image_only=True)
    assert list(alone) == ["R", "G", "B"]
    np.testing.assert_allclose(alone.linear, cloak.render().linear, atol=1e-6)
    with pytest.raises(AttributeError, match="no channel `time_of_flight`"):
        alone.time_of_flight
    with pytest.raises(ValueError, match="image_only leaves no channel `delivered`"):
        cloak.replace({"picture.map": "delivered"}).render(image_only=True)


def test_interpolated_pictures_are_those_of_rays_traced_one_by_one(paper) -> None:
    scene = Scene.load(paper("8c")).replace({"camera.resolution": [160, 120], "camera.samples": 4})
    shared, exact = (scene.replace({"trace.exact": exact}).render(image_only=True) for exact in (False, True))
    assert not np.array_equal(shared.linear, exact.linear), "some are interpolated"
    np.testing.assert_allclose(shared.linear, exact.linear, atol=1e-6)
    steps = np.abs(shared.image.astype(int) - exact.image)
    assert steps.max() <= 1 and np.any(steps, axis=-1).mean() < 1e-3


def test_maps_are_images(cloak: Scene) -> None:
    picture = cloak.replace({"picture.map": "time_of_flight", "picture.color_bar": False}).render()
    assert picture.image.shape == (30, 40, 3)
    assert not np.array_equal(picture.image, Picture(picture, picture.metadata).image)


def test_maps_are_drawn_for_print(cloak: Scene, tmp_path: Path) -> None:
    picture = cloak.replace({"picture.map": "delivered"}).render()
    picture.save(tmp_path / "map.svg")
    picture.save(tmp_path / "map.pdf")
    assert "power delivered (%)" in (tmp_path / "map.svg").read_text()
    assert (tmp_path / "map.pdf").read_bytes().startswith(b"%PDF")
    with pytest.raises(ValueError, match="none.pdf would be a map"):
        cloak.render().save(tmp_path / "none.pdf")


def test_photographs_may_be_arrays(random: np.random.Generator, tmp_path: Path) -> None:
    """An array, in whatever order it lies in memory, is what the same file is."""
    image = pytest.importorskip("PIL.Image", reason="writes the file to compare with")
    codes = random.integers(0, 256, (24, 32, 3), dtype=np.uint8)
    image.fromarray(codes).save(tmp_path / "photograph.png")
    camera = Camera(resolution=[40, 30], samples=1)
    expected = Scene(camera=camera, photograph=tmp_path / "photograph.png").render().linear
    read_only = np.asfortranarray(codes)
    read_only.flags.writeable = False
    for given in (codes, read_only, codes[::-1][::-1], Photograph(image=codes), {"image": codes}):
        np.testing.assert_array_equal(Scene(camera=camera, photograph=given).render().linear, expected)
    replaced = Scene(camera=camera).replace({"photograph.image": codes})
    np.testing.assert_array_equal(replaced.render().linear, expected)
    back = replaced.replace({"photograph.image": tmp_path / "photograph.png"})
    np.testing.assert_array_equal(back.render().linear, expected)


def test_floats_are_linear_light() -> None:
    camera = Camera(resolution=[8, 6], samples=1)
    for dtype in (np.float32, np.float64, ">f8"):
        gray = Scene(camera=camera, photograph=np.full((6, 8), 0.25, dtype=dtype)).render()
        np.testing.assert_allclose(gray.linear, 0.25, rtol=1e-6)
    assert (gray.image == 137).all()
    color = Scene(camera=camera, surroundings=[0.1, 0.2, 0.3], photograph=Photograph(x=-500)).render()
    np.testing.assert_allclose(color.linear[0, 0], [0.1, 0.2, 0.3], rtol=1e-6)
    sky = Scene(camera=camera, surroundings=np.full((2, 4, 3), 0.5), photograph={"x": -500}).render()
    np.testing.assert_allclose(sky.linear, 0.5, rtol=1e-6)


def test_beyond_the_photograph_and_without_the_device() -> None:
    camera = Camera(resolution=[16, 12], samples=1)
    small = Photograph(image=np.full((6, 8), 0.25), width=20)
    dark = Scene(camera=camera, photograph=small).render()
    assert dark.linear.min() == 0
    gray = Scene(camera=camera, photograph=small.replace(border="mirror")).render()
    np.testing.assert_allclose(gray.linear, 0.25, rtol=1e-6)
    empty = Scene(camera=camera, devices=SquareCloak(rotation=20, show="empty")).render()
    np.testing.assert_array_equal(empty.linear, Scene(camera=camera).render().linear)


def test_devices_and_photographs_in_any_pose() -> None:
    camera = Camera(resolution=[24, 18], samples=1)
    upright = Scene(camera=camera, devices=SquareCloak(), photograph=Photograph(x=40)).render()
    photograph = Photograph(position=[40, 0, 0], normal=(-2, 0, 0), up=np.array([0, 5, 0]))
    cloak = SquareCloak(axis=np.array([0, 0, 3]))
    assert cloak.axis == [0, 0, 3] and SquareCloak().axis == [0, 0, 1]
    same = Scene(camera=camera, devices=cloak, photograph=photograph).render()
    np.testing.assert_array_equal(same.linear, upright.linear)
    tilted = Scene(camera=camera, devices=SquareCloak(axis=[1, 1, 1], length=10), photograph=photograph).render()
    assert not np.array_equal(tilted.linear, upright.linear)
    with pytest.raises(ValueError, match="axis is .0, 0, 0.; it must be a direction"):
        Scene(devices=SquareCloak(axis=[0, 0, 0])).render()


def test_scenes_can_be_sent_to_other_processes(cloak: Scene, tmp_path: Path, monkeypatch) -> None:
    scene = cloak.replace({"device.0.rotation": 3, "photograph.image": np.full((3, 4), 0.5)})
    copy = pickle.loads(pickle.dumps(scene))
    monkeypatch.chdir(tmp_path)
    assert copy.toml == scene.toml
    np.testing.assert_array_equal(copy.render().linear, scene.render().linear)
    picture = pickle.loads(pickle.dumps(scene.render()))
    np.testing.assert_array_equal(picture.linear, scene.render().linear)
    assert picture.metadata == scene.render().metadata


def test_pictures_can_be_read_back(cloak: Scene, tmp_path: Path) -> None:
    picture = cloak.render()
    picture.save(tmp_path / "a.npz")
    read = Picture.load(tmp_path / "a.npz")
    assert list(read) == list(picture) and read.metadata == picture.metadata
    read.save(tmp_path / "b.npz")
    assert (tmp_path / "a.npz").read_bytes() == (tmp_path / "b.npz").read_bytes()


@pytest.mark.parametrize(
    ("arguments", "error", "message"),
    [
        ({"camera": 3}, TypeError, "camera is a int; expected a Camera or a mapping of its keys"),
        ({"camera": SquareCloak()}, TypeError, "camera is a SquareCloak"),
        ({"camera": {"positon": 1}}, TypeError, "unknown key `positon` in [camera]; did you mean `position`?"),
        ({"camera": {1: 1}}, TypeError, "camera has the key 1"),
        ({"camera": {"projection": "orthographic"}}, ValueError, "an orthographic camera needs width"),
        ({"photograph": 3}, TypeError, "photograph is a int; expected an array, a path"),
        ({"photograph": np.zeros(3)}, ValueError, "photograph has the shape (3,)"),
        ({"photograph": [[1.0], [1.0, 2.0]]}, ValueError, "photograph is no array"),
        ({"devices": "square-cloak"}, TypeError, "devices is a str; expected a list of devices"),
        ({"devices": 3}, TypeError, "devices is a int"),
        ({"devices": SquareCloak}, TypeError, "devices is a type"),
        ({"devices": [SquareCloak]}, TypeError, "device 0 is SquareCloak itself; expected a device such as SquareCloak()"),
        ({"devices": [{"side": 3}]}, ValueError, "device 0 has no kind"),
        ({"devices": [{"kind": "square-clok"}]}, ValueError, "no kind of device `square-clok`; did you mean"),
        ({"colour": 3}, TypeError, "colour"),
    ],
)
def test_bad_scenes_are_told(arguments: dict, error: type[Exception], message: str) -> None:
    with pytest.raises(error) as raised:
        Scene(**arguments)
    assert message in str(raised.value)


@pytest.mark.parametrize(
    ("scene", "message"),
    [
        (Scene(devices=[SquareCloak(), SquareCloak()]), "device.1: device 1 overlaps device 0"),
        (Scene(photograph="nowhere.png"), "photograph.image: there is no image file"),
        (Scene(camera={"position": [0, 0.5, 0]}, devices=SquareCloak()), "camera.position: the camera stands inside"),
        (Scene(devices=cloakroom.CylinderCloak(inner=20)), "device.0.inner: "),
    ],
)
def test_impossible_scenes_are_told_and_stay_usable(scene: Scene, message: str) -> None:
    for attempt in (scene.render, scene.check, scene.render):
        with pytest.raises(ValueError) as raised:
            attempt()
        assert message in str(raised.value)
    empty = scene.replace({"device": [], "camera.position": [-100, 0, 0], "photograph.image": "builtin:bookshelf"})
    assert empty.render(resolution=(4, 3), samples=1).shape == (3, 4)


def test_errors_in_files_point_at_the_place(command, tmp_path: Path) -> None:
    file = tmp_path / "bad.toml"
    file.write_text("[camera]\npositon = [1, 2, 3]\n")
    with pytest.raises(ValueError) as raised:
        Scene.load(file)
    assert str(raised.value) == command("check", file, check=False).stderr.removeprefix("error: ").rstrip("\n")
    with pytest.raises(FileNotFoundError, match="there is no such file"):
        Scene.load(tmp_path / "none.toml")
    with pytest.raises(ValueError, match="this is a folder"):
        Scene.load(tmp_path)
    with pytest.raises(TypeError):
        Scene.load(3)  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("keys", "error", "message"),
    [
        ({"camera.samples": 0}, ValueError, "camera.samples=0: samples is 0; it must be from 1 to 65536"),
        ({"camera.sample": 1}, ValueError, "camera.sample=1: unknown key `sample`"),
        ({"device.3.rotation": 1}, ValueError, "there is no device.3"),
        ({3: 1}, TypeError, "keys has the key 3"),
        ([], TypeError, "keys is a list"),
        ({"camera.samples": None}, TypeError, "camera.samples is a NoneType"),
    ],
)
def test_bad_replacements_are_told(cloak: Scene, keys: dict, error: type[Exception], message: str) -> None:
    with pytest.raises(error) as raised:
        cloak.replace(keys)
    assert message in str(raised.value)


def test_files_appear_whole_or_not_at_all(cloak: Scene, tmp_path: Path) -> None:
    picture = cloak.render()
    with pytest.raises(ValueError, match="cannot tell the format"):
        picture.save(tmp_path / "a.bmp")
    with pytest.raises(OSError, match="cannot write"):
        picture.save(tmp_path / "none" / "a.png")
    with pytest.raises(ValueError, match="has no channel `R`"):
        Picture({"delivered": picture.delivered}).save(tmp_path / "a.png")
    for wrong in (np.zeros((3, 3), dtype=int), np.zeros(3), np.zeros((3, 3, 4), dtype=np.float32), "text"):
        with pytest.raises(TypeError, match="channel `R` must be an array"):
            Picture({"R": wrong}).save(tmp_path / "a.npz")
    with pytest.raises(ValueError, match="not of the size of the others"):
        Picture({"R": np.zeros((2, 3)), "G": np.zeros((3, 2))}).save(tmp_path / "a.npz")
    with pytest.raises(ValueError, match="one pixel at least"):
        Picture({"R": np.zeros((0, 3))}).save(tmp_path / "a.npz")
    assert list(tmp_path.iterdir()) == []
    (tmp_path / "b.npz").write_bytes(b"PK no archive")
    with pytest.raises(ValueError, match="cannot read .*b.npz"):
        Picture.load(tmp_path / "b.npz")
    np.savez(tmp_path / "c.npz", R=np.zeros((2, 2)))
    assert Picture.load(tmp_path / "c.npz").metadata == {}


def test_changed_and_strided_channels_are_saved_as_they_are(cloak: Scene, tmp_path: Path) -> None:
    picture = cloak.render()
    picture.delivered[3, 4] = 0.5
    flipped = Picture({name: channel[:, ::-1] for name, channel in picture.items()}, picture.metadata)
    flipped.save(tmp_path / "a.npz")
    assert Picture.load(tmp_path / "a.npz").delivered[3, 40 - 1 - 4] == 0.5


def test_progress_is_told(cloak: Scene, capsys: pytest.CaptureFixture[str]) -> None:
    told: list[tuple[int, int]] = []
    cloak.render(samples=40, progress=lambda done, total: told.append((done, total)))
    assert told[-1] == (30, 30) and told == sorted(told)
    cloak.render(progress=True)
    assert "100 %" in capsys.readouterr().err
    with pytest.raises(ZeroDivisionError):
        cloak.render(progress=lambda done, total: 1 / 0)


def test_a_panic_is_an_exception(cloak: Scene) -> None:
    with pytest.raises(RuntimeError, match="a mistake in cloakroom, not in your input: on purpose"):
        _cloakroom.fail_on_purpose()
    assert cloak.render().shape == (30, 40)


def test_too_large_pictures_are_refused(cloak: Scene) -> None:
    with pytest.raises(MemoryError, match="65536 x 65536 pixels needs"):
        cloak.render(resolution=(65536, 65536))


def test_other_threads_go_on_while_a_picture_is_rendered(cloak: Scene) -> None:
    counted = [0]
    done = threading.Event()

    def count() -> None:
        while not done.is_set():
            counted[0] += 1
            time.sleep(0.001)

    thread = threading.Thread(target=count)
    thread.start()
    start = time.perf_counter()
    cloak.render(samples=300)
    seconds = time.perf_counter() - start
    done.set()
    thread.join()
    assert counted[0] > 20 * seconds, (counted[0], seconds)


INTERRUPTED = """
import sys, cloakroom
scene = cloakroom.Scene(devices=cloakroom.DoubleGaussianCloak(), camera={"resolution": [2000, 2000], "samples": 5000})
try:
    scene.render(progress=lambda done, total: print("on", flush=True))
except KeyboardInterrupt:
    print("stopped", scene.render(samples=1, resolution=(4, 3)).shape, flush=True)
"""


# Programs below start in a folder of their own: `python -c` looks into the working folder first, where the sources of the
# package lie without its compiled part.
def test_ctrl_c_stops_a_render(tmp_path: Path) -> None:
    process = subprocess.Popen([sys.executable, "-c", INTERRUPTED], stdout=subprocess.PIPE, text=True, cwd=tmp_path)
    assert process.stdout is not None and process.stdout.readline() == "on\n"
    process.send_signal(signal.SIGINT)
    out, _ = process.communicate(timeout=60)
    assert out.splitlines()[-1] == "stopped (3, 4)" and process.returncode == 0


INTERRUPTED_BESIDE_ANOTHER = """
import threading, time, cloakroom
scene = cloakroom.Scene(devices=cloakroom.DoubleGaussianCloak(), camera={"resolution": [2000, 2000], "samples": 50})
begun = threading.Barrier(2)
left = []
def other():
    told = iter([begun.wait])
    left.append(scene.render(progress=lambda done, total: next(told, lambda: None)()))
thread = threading.Thread(target=other, daemon=True)
thread.start()
begun.wait()
try:
    scene.render(progress=lambda done, total: print("on", flush=True))
except KeyboardInterrupt:
    print("stopped", len(left), thread.is_alive(), flush=True)
    import os; os._exit(0)
"""


def test_ctrl_c_stops_the_render_that_waits_and_no_other(tmp_path: Path) -> None:
    # The other one has every processor busy; the one that is interrupted ends all the same, and alone.
    command = [sys.executable, "-c", INTERRUPTED_BESIDE_ANOTHER]
    process = subprocess.Popen(command, stdout=subprocess.PIPE, text=True, cwd=tmp_path)
    assert process.stdout is not None and process.stdout.readline() == "on\n"
    process.send_signal(signal.SIGINT)
    out, _ = process.communicate(timeout=60)
    assert out.splitlines()[-1] == "stopped 0 True" and process.returncode == 0


@pytest.mark.skipif(not hasattr(os, "fork"), reason="needs fork")
def test_a_forked_process_has_threads_of_its_own(tmp_path: Path) -> None:
    code = (
        "import os, cloakroom\n"
        "scene = cloakroom.Scene(devices=cloakroom.SquareCloak())\n"
        "scene.render(samples=1, resolution=(8, 6))\n"
        "child = os.fork()\n"
        "shape = scene.render(samples=1, resolution=(8, 6)).shape\n"
        "if child:\n"
        "    print(shape, os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]))\n"
    )
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=60, cwd=tmp_path)
    assert run.stdout == "(6, 8) 0\n", run.stderr


def test_threads_can_be_counted_and_chosen(cloak: Scene) -> None:
    before = cloak.render().linear
    try:
        cloakroom.set_threads(1)
        assert cloakroom.threads() == 1
        np.testing.assert_array_equal(cloak.render().linear, before)
        for wrong, error in ((-1, ValueError), (10**6, ValueError), ("two", TypeError)):
            with pytest.raises(error):
                cloakroom.set_threads(wrong)
    finally:
        cloakroom.set_threads(0)
    assert cloakroom.threads() >= 1


def test_arrays_of_a_scene_from_elsewhere_may_lie_anywhere_in_memory() -> None:
    photograph = np.linspace(0, 1, 6 * 8 * 3, dtype=np.float32).reshape(6, 8, 3)
    scene = Scene(camera=cloakroom.Camera(resolution=[8, 6], samples=1), photograph=photograph)
    function, arguments = scene.__reduce__()[:2]
    shifted = np.zeros(photograph.nbytes + 1, np.uint8)[1:].view(np.float32).reshape(photograph.shape)
    shifted[...] = photograph
    assert not shifted.flags.aligned
    moved = [shifted if isinstance(a, np.ndarray) else a for a in arguments]
    assert np.array_equal(function(*moved).render().linear, scene.render().linear)


def test_examples_are_loaded_by_their_names(tmp_path, monkeypatch) -> None:
    monkeypatch.chdir(tmp_path)
    prisms = Scene.load("gallery/prisms")
    assert prisms.kinds == ["prisms"] and prisms.replace({"camera.samples": 1}).kinds == ["prisms"]
    with pytest.raises(FileNotFoundError, match="did you mean `gallery/prisms`"):
        Scene.load("gallery/prims")


def test_the_room_lights_bodies() -> None:
    """A lit ball shows its share of the light around: of an even one that light, of the room as much as is there."""
    camera = Camera(projection="orthographic", width=6.0, position=[-100, 0, 0], resolution=(9, 9), samples=1)
    ball = cloakroom.Body(shape="sphere", radius=5.0, surface={"color": [0.8, 0.4, 0.2], "lit": True})
    even = Scene(camera=camera, devices=ball, surroundings=[0.5, 0.5, 0.5]).render().linear
    np.testing.assert_allclose(even, np.broadcast_to([0.4, 0.2, 0.1], even.shape), atol=1e-6)
    room = Scene(camera=camera, devices=ball, surroundings="builtin:room").render().linear
    white = room / np.array([0.8, 0.4, 0.2])
    assert 0.05 < white.min() and white.max() < 1.0
    # The ceiling is brighter than the desk.
    assert white[0].mean() > white[-1].mean()
