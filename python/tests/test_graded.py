"""A graded index of one's own."""

from __future__ import annotations

import math
import pickle
from pathlib import Path

import numpy as np
import pytest

import cloakroom
from cloakroom import Graded, Scene, trace

RADIUS = 10.0


def luneburg(x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """A rod that focuses parallel light on its far side; beyond it, the parabola may not fall to 0."""
    return np.sqrt(np.maximum(2 - (x * x + y * y) / RADIUS**2, 0.2))


def focused(device: Graded) -> np.ndarray:
    """Where parallel light in the plane across leaves the rod."""
    heights = np.linspace(-6, 6, 25)
    origins = np.column_stack([np.full_like(heights, -30), heights, np.zeros_like(heights)])
    traced = trace(Scene(devices=device, trace={"tolerance": 1e-9}), origins, [1, 0, 0])
    return traced.position[traced.strongest]


def test_a_function_is_sampled_and_its_light_focused() -> None:
    rod = Graded(index=luneburg, shape="circle", width=2 * RADIUS, height=2 * RADIUS)
    assert np.shape(rod.index) == (161, 161)
    assert np.abs(focused(rod) - [RADIUS, 0, 0]).max() < 1e-8
    coarse = Graded(index=luneburg, spacing=0.3, shape="circle", width=2 * RADIUS, height=2 * RADIUS)
    assert np.shape(coarse.index) == (68, 68)
    assert Graded(index=lambda x, y: 1.5, width=10, height=10, spacing=5).index == [[1.5] * 4] * 4


def test_arrays_of_any_order_are_what_the_function_gives() -> None:
    line = np.linspace(-RADIUS, RADIUS, 161)
    x, y = np.meshgrid(line, line, indexing="ij")
    sampled = luneburg(x, y) * (1 + 0.01 * x)
    rod = Graded(index=lambda x, y: luneburg(x, y) * (1 + 0.01 * x), shape="circle", width=20, height=20)
    for array in (sampled, np.asfortranarray(sampled), np.repeat(sampled, 2, axis=1)[:, ::2], sampled.tolist()):
        assert Graded(index=array, shape="circle", width=20, height=20) == rod
    read_only = sampled.copy()
    read_only.flags.writeable = False
    assert Graded(index=read_only, shape="circle", width=20, height=20) == rod
    assert Graded(index=np.full((5, 5), 2)).index == [[2.0] * 5] * 5


def test_a_file_and_a_scene_hold_it_as_well(tmp_path: Path) -> None:
    rod = Graded(index=luneburg, spacing=0.5, shape="circle", width=20, height=20)
    np.save(tmp_path / "rod.npy", rod.index)
    filed = Graded(index=tmp_path / "rod.npy", shape="circle", width=20, height=20)
    assert (focused(filed) == focused(rod)).all()
    scene = Scene(devices=rod.replace(rotation=10))
    (tmp_path / "a.toml").write_text(scene.toml)
    for copy in (Scene.load(tmp_path / "a.toml"), pickle.loads(pickle.dumps(scene))):
        assert copy.toml == scene.toml
    assert repr(rod) == "Graded(index=<41 x 41 samples>, shape='circle', width=20.0, height=20.0)"
    assert pickle.loads(pickle.dumps(rod)) == rod


def test_a_core_hides_the_pole_of_a_formula() -> None:
    # ζ = z + a²/z makes a strip of a cylinder; |ζ'| has a pole at the middle.
    def index(x: np.ndarray, y: np.ndarray) -> np.ndarray:
        return np.maximum(np.abs(1 - (4 / (x + 1j * y)) ** 2), 0.05)

    # Also where the grid is coarse beside the core.
    assert np.isfinite(Graded(index=index, inner=4.4, spacing=0.5).index).all()
    cloak = Graded(index=index, inner=4.4, spacing=0.2)
    assert np.isfinite(cloak.index).all() and np.max(cloak.index) < 10
    scene = Scene(devices=cloak)
    traced = trace(scene, [[-60, 12, 0], [-60, 0, 0]], [1, 0, 0], min_power=1e-2)
    # Straight in ζ, and refracted where the index steps to that of air.
    def slope(z: complex) -> complex:
        return 1 - (4 / z) ** 2

    start = complex(-20, 12)
    along = slope(start) / abs(slope(start))
    heights = np.linspace(8, 14, 100_001)
    ends = 20 + 1j * heights
    off = ((ends + 16 / ends - (start + 16 / start)) * np.conj(along)).imag
    height = np.interp(0, off, heights)
    end = complex(20, height)
    leaf = traced.strongest[0]
    assert abs(traced.position[leaf, 1] - height) < 1e-5
    sine = abs(slope(end)) * (along / slope(end)).imag / abs(along / slope(end))
    assert abs(traced.direction[leaf, 1] - sine) < 1e-6
    assert np.abs(traced.delivered + traced.absorbed + traced.pruned - 1).max() < 1e-12
    bare = trace(scene.replace({"device.0.show": "bare"}), [-60, 0, 0], [1, 0, 0])
    assert np.abs(bare.position - [-4.4, 0, 0]).max() < 1e-12 and bare.direction[0, 0] == -1


def test_a_crystal_in_space_is_a_body_of_it() -> None:
    size, ratio = [12, 10, 8], 1.1
    axis = np.broadcast_to([0.0, 0.6, 0.8], (4, 5, 6, 3))
    grid = Graded(
        index=np.full((4, 5, 6), 1.5), ratio=ratio, optic_axis=axis, width=size[0], height=size[1], length=size[2]
    )
    assert repr(grid).startswith("Graded(index=<4 x 5 x 6 samples>, ratio=1.1, optic_axis=<4 x 5 x 6 x 3 samples>")
    words = {"ordinary": 1.5, "extraordinary": 1.5 * ratio, "optic_axis": [0, 0.6, 0.8]}
    body = cloakroom.Body(shape="box", size=size, uniaxial=words)
    found, expected = (
        trace(Scene(devices=device, trace={"tolerance": 1e-10}), [-30, 1, 0.5], [1, 0.1, 0.05], min_power=1e-2)
        for device in (grid, body)
    )
    assert found.position.shape == expected.position.shape
    assert np.abs(np.sort(found.optical_path) - np.sort(expected.optical_path)).max() < 1e-8


@pytest.mark.parametrize(
    ("keys", "error", "message"),
    [
        ({"index": np.ones(5)}, ValueError, "index has the shape (5,); expected real numbers of the shape"),
        ({"index": np.ones((4, 4, 4, 4))}, ValueError, "index has the shape (4, 4, 4, 4)"),
        ({"ratio": np.ones((4, 4, 4, 4))}, ValueError, "ratio has the shape (4, 4, 4, 4)"),
        ({"ratio": -1}, ValueError, "ratio is -1"),
        ({"index": np.ones((4, 4)) + 0j}, TypeError, "index is of the type complex128"),
        ({"index": [["a"]]}, TypeError, "index is of the type"),
        ({"index": [[1, 2], [3]]}, ValueError, "index is no array"),
        ({"index": np.zeros((4, 4))}, ValueError, "index[0][0] is 0; it must be above 0 and below 1000"),
        ({"index": np.full((4, 4), -1.5)}, ValueError, "index[0][0] is -1.5"),
        ({"index": np.array([[1, 1], [1, math.nan]])}, ValueError, "index[1][1] is not a number (nan)"),
        ({"index": np.full((2, 2), math.inf)}, ValueError, "index[0][0] is infinite"),
        ({"index": np.ones((0, 4))}, ValueError, "there are no numbers in it"),
        ({"index": np.ones((2000, 2000))}, ValueError, "4000000 entries"),
        ({"index": np.ones((5, 5)), "spacing": 1}, ValueError, "spacing is that of the samples of a function"),
        ({"index": lambda x, y: x[0]}, ValueError, "index gives an array of float64 of the shape (161,)"),
        ({"index": lambda x, y: x + 1j}, ValueError, "index gives an array of complex128"),
        ({"index": lambda x, y: None}, ValueError, "index gives an array of object"),
        ({"index": lambda x, y: x}, ValueError, "index[0][0] is -20"),
        ({"index": lambda x, y: 1 / 0}, ZeroDivisionError, "division"),
        ({"index": lambda x, y: 1.0, "spacing": 0}, ValueError, "spacing is 0 cm"),
        ({"index": lambda x, y: 1.0, "spacing": "wide"}, TypeError, "spacing is a str"),
        ({"index": lambda x, y: 1.0, "spacing": 1e-5}, ValueError, "samples is too large"),
        ({"index": lambda x, y: 1.0, "width": -1}, ValueError, "width is -1 cm; it must be from 1e-6 to 1000000"),
        ({"index": 1.5}, ValueError, "index has the shape ()"),
    ],
)
def test_what_is_no_index_is_told(keys: dict, error: type[Exception], message: str) -> None:
    with pytest.raises(error) as raised:
        cloakroom.Graded(**keys)
    assert message in str(raised.value)


def test_what_is_no_device_is_told_by_the_scene(tmp_path: Path) -> None:
    for device, message in (
        (Graded(), "there is no `index`"),
        (Graded(index=tmp_path / "no.npy"), "cannot read"),
        (Graded(index=np.ones((4, 4)), inner=20), "inner is 20 cm; it must be at most"),
    ):
        with pytest.raises(ValueError, match="device.0") as raised:
            Scene(devices=device).check()
        assert message in str(raised.value)
