"""Light in flight."""

import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from cloakroom import Camera, Scene, SquareCloak

LIGHT = 29.9792458


def scene(*devices: object) -> Scene:
    return Scene(camera=Camera(resolution=[24, 18], samples=1), devices=list(devices))


def test_all_light_is_accounted_for_and_arrives_when_it_should():
    flown = scene().flight((5.0, 5.2, 0.01))
    total = flown["light"].sum(axis=0) + sum(flown[name] for name in ("before", "after", "untimed", "steady"))
    assert np.abs(total - flown["picture"]).max() < 1e-12
    inside = flown["after_power"] == 0
    assert 0.5 < inside.mean() < 1.0
    mean = np.tensordot(flown["time"], flown["power"], 1)[inside] / flown["power"].sum(axis=0)[inside]
    assert mean.min() == pytest.approx(150 / LIGHT, abs=2e-3)
    assert np.abs(mean - scene().render()["time_of_flight"][inside]).max() < 1e-12


def test_phases_through_the_perfect_cloak_are_on_time_and_pulses_are_not():
    gate = "4.9..7.9:0.01"
    empty = scene().flight(gate)["light"]
    assert np.abs(scene(SquareCloak()).flight(gate, delay="phase")["light"] - empty).max() < 1e-9
    assert np.abs(scene(SquareCloak()).flight(gate)["light"] - empty).max() > 0.1


def test_axes_have_names():
    xarray = pytest.importorskip("xarray")
    dataset = scene().flight(pulse=0.02).to_xarray()
    assert isinstance(dataset, xarray.Dataset)
    assert dataset["light"].dims == ("time", "height", "width", "color")
    assert dataset["light"].sel(time=150 / LIGHT, method="nearest").shape == (18, 24, 3)


@pytest.mark.parametrize(
    "words", [{"gate": "5..4:1"}, {"gate": (1, 2, 0)}, {"delay": "late"}, {"flash": "lamp"}, {"pulse": -1.0}]
)
def test_what_cannot_be_is_refused(words):
    with pytest.raises(ValueError, match=next(iter(words))):
        scene().flight(**words)


@pytest.mark.parametrize(
    "words", [{"gate": 5}, {"gate": (1, 2)}, {"pulse": "1"}, {"delay": 3}, {"flash": None}],
)
def test_what_is_of_another_type_is_refused_by_its_name(words):
    with pytest.raises((TypeError, ValueError), match=f"^{next(iter(words))} is "):
        scene().flight(**words)


def test_a_pulse_is_drawn_from_the_side():
    front = '<g class="pulse"'
    cloak = scene(SquareCloak())
    assert front in cloak.diagram(pulse=-0.2).svg and front not in cloak.diagram().svg
    assert cloak.diagram(pulse=0.7).svg != cloak.diagram(pulse=0.7, delay="phase").svg
    with pytest.raises(ValueError, match="delay"):
        cloak.diagram(pulse=0.7, delay="late")


@pytest.mark.skipif(not hasattr(os, "wait4"), reason="it takes Unix to know how much memory a program took")
def test_a_large_film_takes_little_memory(executable: Path, paper, tmp_path: Path) -> None:
    """A cube of 640 x 480 pixels at 256 times, which takes 1.3 GB as a file."""
    cube = tmp_path / "cube.npz"
    words = ["--size", "640x480", "--samples", "1", "--delay", "phase", "--gate", "4.9..10:0.02", "-o", str(cube)]
    process = subprocess.Popen([executable, "flight", paper("6c"), *words])
    _, status, used = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    assert process.returncode == 0
    assert cube.stat().st_size > 640 * 480 * 256 * 16
    cube.unlink()
    # Linux counts kB.
    assert used.ru_maxrss * (1024 if sys.platform == "linux" else 1) < 512e6
