"""Devices for renderers of others."""

from __future__ import annotations

import numpy as np
import pytest

import cloakroom
from cloakroom import Scatterer, Scene, SphereCloak, SquareCloak
from cloakroom.scatterers import ABSORBED, ENDED, LEFT, MISSED, REFUSED

CRYSTAL = SquareCloak(material="negative-uniaxial")


def fan(count: int = 400) -> tuple[np.ndarray, np.ndarray]:
    rng = np.random.default_rng(2)
    origins = np.column_stack([np.full(count, -60.0), rng.uniform(-9, 9, count), rng.uniform(-9, 9, count)])
    directions = np.column_stack([np.ones(count), rng.uniform(-0.4, 0.4, (count, 2))])
    return origins, directions


def test_all_leaves_are_those_of_trace() -> None:
    origins, directions = fan()
    scattered = Scatterer(CRYSTAL, min_power=1e-6).scatter(origins, directions, fields=True)
    traced = cloakroom.trace(Scene(devices=CRYSTAL), origins, directions, "both", min_power=1e-6)
    np.testing.assert_array_equal(scattered.ray, traced.ray)
    np.testing.assert_array_equal(scattered.direction, traced.direction)
    np.testing.assert_array_equal(scattered.electric_field, traced.electric_field)
    missed = np.isnan(traced.position[:, 0])
    assert missed.any() and (scattered.status == np.where(missed, MISSED, LEFT)).all()
    np.testing.assert_array_equal(scattered.position[~missed], traced.position[~missed])
    np.testing.assert_allclose(scattered.weight, traced.power.mean(axis=1), rtol=1e-15)


def test_drawn_leaves_give_the_mean_of_all() -> None:
    """A quantity of leaves, drawn many times, is its sum over all of them."""
    scatterer = Scatterer(CRYSTAL, min_power=1e-5)
    origin, direction = [-60.0, 4.0, 3.0], [60.0, -3.0, 20.0]
    every = scatterer.scatter(origin, direction)
    draws = 4000
    drawn = scatterer.scatter(np.tile(origin, (draws, 1)), direction, u=(np.arange(draws) + 0.5) / draws)
    assert len(every.ray) > 3 and len(set(drawn.path)) > 3
    mean = (drawn.weight[:, None] * drawn.direction).mean(axis=0)
    expected = (every.weight[:, None] * every.direction).sum(axis=0) / every.weight.sum()
    np.testing.assert_allclose(mean, expected, atol=2 * len(every.ray) / draws)
    np.testing.assert_allclose(drawn.weight, 1, rtol=1e-12)


def test_fields_are_jones_columns() -> None:
    origins, directions = fan(50)
    scatterer = Scatterer(CRYSTAL)
    own = scatterer.scatter(origins, directions, fields=True)
    rays = directions / np.linalg.norm(directions, axis=1)[:, None]
    horizontal = np.array([0, 0, 1]) - rays * rays[:, 2:]
    horizontal /= np.linalg.norm(horizontal, axis=1)[:, None]
    vertical = np.cross(rays, horizontal)
    turned = np.stack([horizontal + 1j * vertical, horizontal - 1j * vertical], axis=1) / np.sqrt(2)
    circular = scatterer.scatter(origins, directions, fields=turned)
    sign = np.sign(own.electric_field[own.status == MISSED][:, 1] @ vertical[0].real)[0].real
    assert own.electric_field is not None and circular.electric_field is not None
    expected = (own.electric_field[:, 0] + 1j * sign * own.electric_field[:, 1]) / np.sqrt(2)
    # Weak branches are pruned by the powers of what was launched, so that each has some that the other has not.
    places = {(ray, path): place for place, (ray, path) in enumerate(zip(circular.ray, circular.path))}
    both = [(place, places[way]) for place, way in enumerate(zip(own.ray, own.path)) if way in places]
    assert len(both) > 0.8 * len(own.ray)
    here, there = np.array(both).T
    np.testing.assert_allclose(circular.electric_field[there, 0], expected[here], atol=1e-9)


def test_single_precision_stays_single() -> None:
    origins, directions = fan()
    scatterer = Scatterer(SphereCloak())
    double = scatterer.scatter(origins, directions, u=0.5)
    single = scatterer.scatter(np.float32(origins), np.float32(directions), u=np.full(400, 0.5, np.float32))
    assert single.position.dtype == single.weight.dtype == np.float32
    assert double.position.dtype == np.float64
    np.testing.assert_array_equal(single.status, double.status)
    np.testing.assert_allclose(single.direction, double.direction, atol=1e-6)
    assert scatterer.scatter(np.float32(origins), directions).position.dtype == np.float64


def test_a_place_and_a_unit() -> None:
    """The same rays in a world in metres, whose x is up."""
    to_world = np.array([[0, 1, 0, 2], [0, 0, 1, -1], [1, 0, 0, 0.5], [0, 0, 0, 1]], dtype=float)
    origins, directions = fan()
    here = Scatterer(CRYSTAL).scatter(origins, directions, u=0.4)
    placed = Scatterer(CRYSTAL, to_world=to_world.astype(np.float32), unit=100)
    turn, shift = to_world[:3, :3], to_world[:3, 3]
    there = placed.scatter(origins / 100 @ turn.T + shift, directions @ turn.T, u=0.4)
    np.testing.assert_array_equal(there.path, here.path)
    np.testing.assert_allclose(there.position, here.position / 100 @ turn.T + shift, atol=1e-12)
    np.testing.assert_allclose(there.direction, here.direction @ turn.T, atol=1e-12)


def test_every_ray_has_a_status() -> None:
    glass = {"kind": "body", "shape": "sphere", "radius": 5, "permittivity": 2.25}
    painted = {"kind": "body", "shape": "sphere", "radius": 5, "position": [20, 0, 0], "surface": {"color": [1, 0, 0]}}
    dark = {"kind": "body", "shape": "sphere", "radius": 5, "position": [-20, 0, 0], "permittivity": [2, 0.00001]}
    scatterer = Scatterer([glass, painted, dark], min_power=1e-3)
    origins = [[0, -50, 0], [20, -50, 0], [-50, 40, 0], [np.nan, 0, 0], [0, 0, 0], [20, 0, 0]]
    directions = [[0, 1, 0], [0, 1, 0], [1, 0, 0], [1, 0, 0], [0, 0, 0], [1, 0, 0]]
    scattered = scatterer.scatter(origins, directions, u=0.5)
    assert scattered.status.tolist() == [LEFT, ENDED, MISSED, REFUSED, REFUSED, REFUSED]
    assert scattered.body.tolist() == [-1, 1, -1, -1, -1, -1]
    np.testing.assert_allclose(scattered.position[1], [20, -5, 0], atol=1e-9)
    assert (scattered.weight[3:] == 0).all() and scattered.straight[2]
    absorbed = scatterer.scatter([-20, -50, 0], [0, 1, 0])
    assert 0 < absorbed.weight.sum() < 1 and ABSORBED == 3


def test_what_lets_light_on_along_its_line() -> None:
    origins, directions = fan()
    cloak = Scatterer(SphereCloak()).scatter(origins, directions, u=0.5)
    assert cloak.straight.all()
    np.testing.assert_allclose(cloak.transmitted, 1, atol=1e-12)
    mirror = Scatterer(SquareCloak(rotation=30)).scatter([-60, 0, 0], [1, 0, 0], u=0.5)
    assert not mirror.straight[0] and mirror.transmitted[0] == 0


def test_bounds_and_outlines_hold_the_device() -> None:
    turn = np.array([[0, -1, 0, 3], [1, 0, 0, 4], [0, 0, 1, 5], [0, 0, 0, 1]], dtype=float)
    scatterer = Scatterer(SquareCloak(length=40, rotation=45), to_world=turn, unit=10)
    (bounds,) = scatterer.bounds
    half = 14.1 / np.sqrt(2) / 10
    np.testing.assert_allclose(bounds.high, [half, half, 2])
    np.testing.assert_allclose(bounds.low, [-half, -half, -2])
    # Turned by 90 and by 45 degrees.
    axis = np.array([np.cos(np.radians(135)), np.sin(np.radians(135)), 0])
    np.testing.assert_allclose(bounds.to_world[:3, 0], axis, atol=1e-15)
    np.testing.assert_allclose(bounds.to_world[:3, 3], [3, 4, 5])
    outlines = scatterer.outlines()
    assert {outline.matter for outline in outlines} == {"medium", "metal"}
    corners = np.concatenate([outline.triangles.reshape(-1, 3) for outline in outlines])
    local = (corners - [3, 4, 5]) @ bounds.to_world[:3, :3]
    np.testing.assert_allclose([local.min(axis=0), local.max(axis=0)], [bounds.low, bounds.high], atol=1e-12)
    assert Scatterer(SphereCloak()).bounds[0].ball


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"to_world": np.eye(3)}, "to_world has the shape"),
        ({"to_world": 2 * np.eye(4)}, "last row"),
        ({"to_world": np.diag([2.0, 2, 2, 1])}, "scales"),
        ({"to_world": np.diag([-1.0, 1, 1, 1])}, "mirrors"),
        ({"unit": 0}, "unit is 0"),
        ({"min_power": 2}, "min_power is 2"),
    ],
)
def test_placements_that_are_none_are_refused(arguments: dict[str, object], message: str) -> None:
    with pytest.raises(ValueError, match=message):
        Scatterer(SphereCloak(), **arguments)  # type: ignore[arg-type]


def test_other_mistakes_are_told() -> None:
    with pytest.raises(ValueError, match="devices is empty"):
        Scatterer([])
    with pytest.raises(ValueError, match="endless.*`length`"):
        _ = Scatterer(SquareCloak()).bounds
    with pytest.raises(ValueError, match="differ in their rows"):
        Scatterer(SphereCloak()).scatter(np.zeros((3, 3)), [1, 0, 0], u=[0.1, 0.2])
    with pytest.raises(ValueError, match="fields has the shape"):
        Scatterer(SphereCloak()).scatter([0, 0, 0], [1, 0, 0], fields=np.zeros((1, 3)))
