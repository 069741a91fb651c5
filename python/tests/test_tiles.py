"""Tiles, in this process and on a cluster."""

from __future__ import annotations

import os
import signal
from pathlib import Path

import numpy as np
import pytest

import cloakroom
from cloakroom import Camera, Picture, Scene

distributed = pytest.importorskip("distributed")
from cloakroom.distributed import render_frames, render_tiles, sweep  # noqa: E402


@pytest.fixture
def scene() -> Scene:
    camera = Camera(resolution=[75, 53], samples=2)
    photograph = np.linspace(0, 1, 60 * 80 * 3).reshape(60, 80, 3)
    device = cloakroom.SquareCloak(material="negative-uniaxial", rotation=10)
    return Scene(camera=camera, photograph=photograph, devices=device, picture={"channels": ["stokes"]})


@pytest.fixture(scope="module")
def cluster():
    with distributed.LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as cluster:
        with distributed.Client(cluster):
            yield cluster


def saved(picture: Picture, path: Path) -> bytes:
    picture.save(path)
    return path.read_bytes()


def test_tiles_make_the_whole_picture(scene: Scene, tmp_path: Path) -> None:
    places = [(0, 0, 31, 20), (31, 0, 44, 20), (0, 20, 75, 33)]
    for image_only in (False, True):
        tiles = [scene.render(tile=place, image_only=image_only) for place in places]
        assert tiles[0].shape == (20, 31) and tiles[0].metadata["tile"] == "0,0,31,20"
        merged = Picture.merge(tiles)
        whole = scene.render(image_only=image_only)
        assert merged.metadata == whole.metadata
        for ending in (".npz", ".exr", ".png"):
            assert saved(merged, tmp_path / f"a{ending}") == saved(whole, tmp_path / f"b{ending}")
    for number, tile in enumerate(tiles):
        tile.save(tmp_path / f"{number}.npz")
    files = [tmp_path / f"{number}.npz" for number in range(3)]
    assert saved(Picture.merge(files), tmp_path / "a.png") == saved(whole, tmp_path / "b.png")
    with pytest.raises(ValueError, match="some tiles are missing"):
        Picture.merge(tiles[:2])
    with pytest.raises(ValueError, match="overlap"):
        Picture.merge([*tiles, tiles[0]])
    with pytest.raises(ValueError, match="tile 0 is not a tile of a picture"):
        Picture.merge([whole])
    with pytest.raises(FileNotFoundError, match="none.npz"):
        Picture.merge([tmp_path / "none.npz"])


def test_tiles_are_those_of_the_command(command, scene: Scene, tmp_path: Path) -> None:
    scene = scene.replace({"photograph.image": "builtin:bookshelf"})
    (tmp_path / "scene.toml").write_text(scene.toml)
    whole = scene.render(image_only=True)
    for ending in ("npz", "png"):
        files = [tmp_path / f"{top}.{ending}" for top in (0, 30)]
        for file, place in zip(files, ("0,0,75,30", "0,30,75,23")):
            command("render", tmp_path / "scene.toml", "--tile", place, "-o", file)
        command("merge", *files, "-o", tmp_path / f"merged.{ending}")
    assert (tmp_path / "merged.npz").read_bytes() == saved(scene.render(), tmp_path / "whole.npz")
    assert (tmp_path / "merged.png").read_bytes() == saved(whole, tmp_path / "whole.png")
    for words, message in [
        (["--tile", "0,0,76,1", "-o", "a.npz"], "reaches beyond the picture of 75 x 53 pixels"),
        (["--tile", "0,0,5,5", "-o", "a.exr"], "a tile is a .npz or a .png"),
        (["--tile", "0,0,5,5", "-o", "a.png", "--set", "picture.map=pruned"], "write tiles of it as .npz"),
        (["--tile", "0,0,5", "-o", "a.npz"], "write LEFT,TOP,WIDTH,HEIGHT"),
    ]:
        run = command("render", tmp_path / "scene.toml", *words, check=False)
        assert run.returncode in (1, 2) and message in run.stderr
    run = command("merge", tmp_path / "0.npz", tmp_path / "30.png", "-o", tmp_path / "a.png", check=False)
    assert run.returncode == 1 and "all .npz, or all .png" in run.stderr


@pytest.mark.parametrize("tile", [(1, 2), (1, 2, 3, -4), (0, 0, 76, 1), (0, 0, 0, 1), "all", (0.0, 0, 2, 2)])
def test_bad_tiles_are_told(scene: Scene, tile) -> None:
    with pytest.raises(ValueError, match="tile"):
        scene.render(tile=tile)


def test_a_worker_lost_loses_nothing(cluster, scene: Scene, tmp_path: Path) -> None:
    killed: list[int] = []

    def kill(done: int, total: int) -> None:
        if done == 2 and not killed:
            killed.append(cluster.workers[0].process.process.pid)
            os.kill(killed[0], signal.SIGKILL)

    scene = scene.replace({"camera.samples": 16})
    picture = render_tiles(scene, tmp_path / "tiles", tile=(20, 16), progress=kill)
    assert killed
    for ending in (".npz", ".png"):
        assert saved(picture, tmp_path / f"a{ending}") == saved(scene.render(), tmp_path / f"b{ending}")


def test_what_is_finished_is_not_done_again(cluster, scene: Scene, tmp_path: Path) -> None:
    class Enough(Exception):
        pass

    def stop(done: int, total: int) -> None:
        if done == 3:
            raise Enough

    with pytest.raises(Enough):
        render_tiles(scene, tmp_path, tile=(20, 16), progress=stop)
    with (tmp_path / "finished.jsonl").open("a") as record:
        record.write('{"file": "tile-0')
    times = {file.name: file.stat().st_mtime_ns for file in tmp_path.glob("*.npz")}
    assert len(times) == 3
    told: list[int] = []
    picture = render_tiles(scene, tmp_path, tile=(20, 16), progress=lambda done, total: told.append(done))
    assert told[0] == 3 and told[-1] == 16
    for name, time in times.items():
        assert (tmp_path / name).stat().st_mtime_ns == time
    assert saved(picture, tmp_path / "a.npz") == saved(scene.render(), tmp_path / "b.npz")
    other = render_tiles(scene.replace({"device.0.rotation": 11}), tmp_path, tile=(20, 16))
    assert not np.array_equal(other.linear, picture.linear)


def test_what_other_files_made_is_done_again(cluster, tmp_path: Path) -> None:
    photographs = [tmp_path / f"photograph-{number}.png" for number in range(2)]
    for photograph, color in zip(photographs, (0.2, 0.7)):
        Scene(camera=Camera(resolution=[16, 12]), photograph=np.full((3, 4, 3), color)).render(samples=1).save(photograph)
    indices = [tmp_path / f"index-{number}.npy" for number in range(2)]
    for index, value in zip(indices, (1.2, 1.7)):
        np.save(index, np.full((4, 4), value))
    photograph, index = tmp_path / "photograph.png", tmp_path / "index.npy"
    shown = []
    for photograph_number, index_number in [(0, 0), (0, 0), (1, 0), (1, 1)]:
        # Other contents, of the same time.
        for file, content in [(photograph, photographs[photograph_number]), (index, indices[index_number])]:
            file.write_bytes(content.read_bytes())
            os.utime(file, ns=(0, 0))
        scene = Scene(
            camera=Camera(resolution=[40, 30], samples=1),
            photograph=str(photograph),
            devices=cloakroom.Graded(index=index, width=4, height=4),
        )
        tiles = render_tiles(scene, tmp_path / "tiles", tile=(20, 30))
        assert np.array_equal(tiles.linear, scene.render().linear)
        (frame,) = render_frames(scene, {"device.0.rotation": [0]}, tmp_path / "frames", ending=".npz")
        assert np.array_equal(Picture.load(frame).linear, tiles.linear)
        shown.append(tiles.linear)
    assert np.array_equal(shown[0], shown[1])
    assert not np.array_equal(shown[1], shown[2]) and not np.array_equal(shown[2], shown[3])


def test_what_was_damaged_is_done_again(cluster, scene: Scene, tmp_path: Path) -> None:
    def rendered() -> tuple[int, Picture]:
        told: list[int] = []
        picture = render_tiles(scene, tmp_path, tile=(40, 30), progress=lambda done, total: told.append(done))
        return told[0], picture

    rendered()
    whole = {file.name: file.read_bytes() for file in tmp_path.glob("*.npz")}
    assert len(whole) == 4
    names = sorted(whole)
    # Cut short, replaced by another tile, and gone.
    (tmp_path / names[0]).write_bytes(whole[names[0]][:-10])
    (tmp_path / names[1]).write_bytes(whole[names[2]])
    (tmp_path / names[3]).unlink()
    kept, picture = rendered()
    assert kept == 1
    assert {file.name: file.read_bytes() for file in tmp_path.glob("*.npz")} == whole
    assert np.array_equal(picture.linear, scene.render().linear)
    assert rendered()[0] == 4


def test_frames_are_pictures(cluster, scene: Scene, tmp_path: Path) -> None:
    keys = {"device.0.rotation": np.array([0.0, 5.0, 10.0])}
    files = render_frames(scene, keys, tmp_path)
    assert [file.name for file in files] == ["frame-00000.png", "frame-00001.png", "frame-00002.png"]
    for rotation, file in zip(keys["device.0.rotation"], files):
        frame = scene.replace({"device.0.rotation": rotation}).render(image_only=True)
        assert file.read_bytes() == saved(frame, tmp_path / "expected.png")


def test_sweeps_are_rows(cluster, scene: Scene, tmp_path: Path) -> None:
    keys = {"device.0.rotation": [0, 10], "camera.polarizer": ["horizontal", "vertical"]}
    rows = sweep(scene, keys, tmp_path)
    expected = cloakroom.sweep(scene, keys)
    assert [row["camera.polarizer"] for row in rows] == ["horizontal", "vertical"] * 2
    for name, grid in expected.items():
        if name not in keys:
            np.testing.assert_array_equal([row[name] for row in rows], grid.ravel(), err_msg=name)


def test_bad_jobs_are_told(cluster, scene: Scene, tmp_path: Path) -> None:
    for job, error, message in [
        (lambda: render_tiles(scene, tmp_path, tile=(21, 16)), ValueError, "expected an even width"),
        (lambda: render_tiles("scene", tmp_path), TypeError, "scene is a str"),
        (lambda: render_tiles(scene, tmp_path, client="mine"), TypeError, "client is a str"),
        (lambda: render_frames(scene, {}, tmp_path), ValueError, "one key at least"),
        (lambda: render_frames(scene, {"camera.seed": [1], "camera.samples": [1, 2]}, tmp_path), ValueError, "as many"),
        (lambda: render_frames(scene, {"camera.seed": [1]}, tmp_path, ending=".gif"), ValueError, "ending is '.gif'"),
        (lambda: render_frames(scene, {"camera.samples": [0]}, tmp_path), ValueError, "samples is 0"),
        (lambda: sweep(scene, {"camera.seed": []}, tmp_path), ValueError, "is empty"),
        (
            lambda: render_tiles(scene.replace({"camera.position": [0, 5, 0]}), tmp_path),
            ValueError,
            "the camera stands inside device 0",
        ),
    ]:
        with pytest.raises(error) as raised:
            job()
        assert message in str(raised.value)
