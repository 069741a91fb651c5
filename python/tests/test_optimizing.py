"""The optimizer finds designs whose values are known."""

from __future__ import annotations

import numpy as np
import pytest

import cloakroom
from cloakroom import Prisms, Scene, optimize, trace

pytest.importorskip("scipy")

#: Calcite at 590 nm, and the carpet that its optic axis at 30 degrees makes: docs/real-cloaks.md.
ORDINARY, EXTRAORDINARY = 1.65830, 1.48611


def inside(scene: Scene) -> np.ndarray:
    """How high rays are in the cloak. Outside, nothing tells its kappa."""
    origins = [[-20, height, 0] for height in (0.5, 1.5, 2.5, 3.5, 4.5)]
    paths = trace(scene, origins, [1, 0, 0], paths=True).paths
    ways = [paths.to_leaf(leaf) for leaf in range(5)]
    return np.ravel([np.interp([-4, -1, 2], way[:, 0], way[:, 1]) for way in ways])


def test_kappa_of_design_iii_is_found_again() -> None:
    scene = Scene(devices=cloakroom.SquareCloak())
    measured = inside(scene)
    start = {"device.0.kappa": 0.5}
    keys = {"device.0.kappa": (0.3, 0.8)}
    found = optimize(scene, keys, lambda scene: inside(scene) - measured, start=start)
    assert abs(found.values["device.0.kappa"] - 3**-0.5) < 1e-6 and found.converged
    assert found.scene.devices[0].kappa == found.values["device.0.kappa"]
    assert found.history["value"].min() == found.value
    # By a number instead of residuals, too.
    whole = optimize(scene, keys, lambda scene: float(np.sum((inside(scene) - measured) ** 2)), start=start)
    assert abs(whole.values["device.0.kappa"] - 3**-0.5) < 1e-6
    # And from nowhere.
    anywhere = optimize(scene, keys, lambda scene: inside(scene) - measured, seed=5)
    assert abs(anywhere.values["device.0.kappa"] - 3**-0.5) < 1e-6


def carpet(values: dict[str, float]) -> Scene:
    """Two prisms of calcite over a bump of half width 2 cm, and the glass prism that they should look like."""
    bump, top = 2 * values["bump"], 2 * values["height"]
    floor = {"corners": [[-14, -0.3], [14, -0.3], [14, 0], [-14, 0]], "metal": True}
    glass = {"corners": [[-2, 0], [2, 0], [0, top]], "index": values["index"]}
    crystals = Prisms(
        design_wavelength_nm=590,
        prism=[
            {"corners": [[-2, 0], [2, 0], [0, bump]], "metal": True},
            {"corners": [[-2, 0], [0, bump], [0, top]], "material": "calcite", "optic_axis": 120},
            {"corners": [[2, 0], [0, top], [0, bump]], "material": "calcite", "optic_axis": 60},
        ],
        imitated=[glass],
    )
    mirror = Prisms(prism=[floor], imitated=[floor])
    return Scene(light={"spectrum": 590}, devices=[mirror, crystals])


def seen(scene: Scene) -> np.ndarray:
    """Where the strongest leaves of light from above go, and how long they take."""
    angles = np.radians([65, 75, 82, 98, 105, 115])
    steep = np.column_stack([np.cos(angles), -np.sin(angles), np.zeros_like(angles)])
    aims = np.linspace(-0.9, 0.9, 5)
    directions = np.repeat(steep, len(aims), axis=0)
    origins = np.column_stack([np.tile(aims, len(angles)), np.zeros((len(directions), 2))]) - 20 * directions
    traced = trace(scene, origins, directions, "vertical", min_power=0.3)
    found = np.full((len(directions), 5), 9.0)
    has_one = traced.strongest >= 0
    leaf = traced.strongest[has_one]
    across = np.cross(traced.position[leaf], traced.direction[leaf])[:, 2]
    phase = traced.optical_path[leaf] - (traced.position[leaf] * traced.direction[leaf]).sum(axis=1)
    found[has_one] = np.column_stack([5 * traced.direction[leaf], across, phase])
    return found


def unlike(scene: Scene) -> np.ndarray:
    """By how much what is seen of the crystals differs from the glass, for each ray at most so much."""
    return np.tanh(seen(scene) - seen(scene.replace({"device.1.show": "mirror"}))).ravel()


def test_the_calcite_carpet_is_found_from_nothing() -> None:
    bounds = {"bump": (0.02, 0.3), "height": (0.8, 2.4), "index": (1.3, 1.8)}
    found = optimize(carpet, bounds, unlike, seed=1)
    xx = ORDINARY**2 - (ORDINARY**2 - EXTRAORDINARY**2) / 4
    index = ORDINARY * EXTRAORDINARY / np.sqrt(xx)
    k, slope = index / np.sqrt(xx), (ORDINARY**2 - EXTRAORDINARY**2) * np.sqrt(3) / (4 * xx)
    design = {"bump": slope, "height": slope / (1 - k), "index": index}
    for key, value in design.items():
        assert abs(found.values[key] / value - 1) < 1e-4, (key, found.values[key], value)


def test_objectives_get_the_same_random_numbers_each_time() -> None:
    scene = Scene(devices=cloakroom.SquareCloak())
    drawn = []

    def objective(scene: Scene, random: np.random.Generator) -> float:
        drawn.append(random.uniform())
        return (scene.devices[0].rotation - 3) ** 2

    found = optimize(scene, {"device.0.rotation": (0, 10)}, objective, start={"device.0.rotation": 8}, tolerance=1e-6)
    assert len(set(drawn)) == 1 and abs(found.values["device.0.rotation"] - 3) < 1e-4
    assert len(found.history["value"]) == len(drawn)


def test_values_without_a_scene_are_passed_over() -> None:
    scene = Scene(devices=cloakroom.CylinderCloak(inner=4, outer=10))
    found = optimize(scene, {"device.0.inner": (2, 14)}, lambda scene: (scene.devices[0].inner - 9) ** 2, seed=2)
    assert abs(found.values["device.0.inner"] - 9) < 1e-6
    assert np.isinf(found.history["value"]).any()


def test_a_key_of_whole_numbers_is_no_place_to_go_down() -> None:
    keys = {"camera.samples": (1, 9)}
    with pytest.raises(ValueError, match="only the start makes a scene: .*it must be a whole number"):
        optimize(Scene(), keys, lambda scene: float(scene.camera.samples), start={"camera.samples": 3})


def test_parameters_with_a_default_keep_it() -> None:
    def objective(scene: Scene, wanted: float = 3.0) -> float:
        return (scene.devices[0].rotation - wanted) ** 2

    scene = Scene(devices=cloakroom.SquareCloak())
    found = optimize(scene, {"device.0.rotation": (0, 10)}, objective, start={"device.0.rotation": 8}, tolerance=1e-6)
    assert abs(found.values["device.0.rotation"] - 3) < 1e-4


@pytest.mark.parametrize(
    ("keys", "more", "message"),
    [
        ({}, {}, "keys is empty"),
        ({"device.0.kappa": (0.8, 0.3)}, {}, "expected its least and its greatest value"),
        ({"device.0.kappa": (0.3, 0.8)}, {"start": {"device.0.kappa": 1}}, "within its bounds, 0.3 to 0.8"),
        ({"device.0.kappa": (0.3, 0.8)}, {"start": {}}, "expected a value for each of device.0.kappa"),
        ({"device.0.kapa": (0.3, 0.8)}, {"start": {"device.0.kapa": 0.5}}, "did you mean `kappa`?"),
        ({"device.0.kapa": (0.3, 0.8)}, {"most_evaluations": 20}, "did you mean `kappa`?"),
    ],
)
def test_bad_bounds_are_told(keys: dict, more: dict, message: str) -> None:
    with pytest.raises(ValueError) as raised:
        optimize(Scene(devices=cloakroom.SquareCloak()), keys, lambda scene: 0.0, **more)
    assert message in str(raised.value)


def test_bad_objectives_are_told() -> None:
    scene, keys = Scene(devices=cloakroom.SquareCloak()), {"device.0.kappa": (0.3, 0.8)}
    start = {"device.0.kappa": 0.5}
    with pytest.raises(ValueError, match="expected a finite number"):
        optimize(scene, keys, lambda scene: np.nan, start=start)
    with pytest.raises(ValueError, match=r"an array of the shape \(2, 2\)"):
        optimize(scene, keys, lambda scene: np.zeros((2, 2)), start=start)
    with pytest.raises(TypeError, match="expected a Scene or a function"):
        optimize("a scene", keys, lambda scene: 0.0)


@pytest.mark.parametrize(
    ("objective", "error", "message"),
    [
        (lambda: 3, TypeError, "objective takes nothing"),
        (5, TypeError, "objective is a int"),
        (lambda scene: [], ValueError, r"the shape \(0,\)"),
        (lambda scene: None, ValueError, "objective gives None"),
        (lambda scene: "x", ValueError, "objective gives 'x'"),
        (lambda scene: float("nan"), ValueError, "objective gives nan"),
        (lambda scene: scene.nothing, AttributeError, "nothing"),
    ],
)
def test_objectives_that_are_none_are_refused(objective, error, message) -> None:
    with pytest.raises(error, match=message):
        optimize(Scene(devices=cloakroom.SquareCloak()), {"device.0.kappa": (0.3, 0.8)}, objective)
