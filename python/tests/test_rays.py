"""Rays and interfaces as arrays."""

from __future__ import annotations

import json

import numpy as np
import pytest

import cloakroom
from cloakroom import Medium, Scene, interface, trace


@pytest.fixture
def scene() -> Scene:
    return Scene(devices=cloakroom.SquareCloak(material="negative-uniaxial", rotation=10))


def close(ours: object, theirs: object) -> None:
    """Equal but for the rounding of another build."""
    np.testing.assert_allclose(ours, theirs, rtol=1e-10, atol=1e-12)


def rays(random: np.random.Generator, count: int) -> tuple[np.ndarray, np.ndarray]:
    origins = np.column_stack([np.full(count, -100.0), *random.uniform(-12, 12, (2, count))])
    directions = np.column_stack([np.ones(count), *random.uniform(-0.1, 0.1, (2, count))])
    return origins, directions


def test_leaves_are_those_of_the_command(command, scene: Scene, random, tmp_path) -> None:
    origins, directions = rays(random, 13)
    (tmp_path / "scene.toml").write_text(scene.toml)
    fields = np.cross(directions, [0, 0, 1]) + 1j * np.cross(directions, np.cross(directions, [0, 0, 1]))
    requests = [
        {"origin": list(o), "direction": list(d), "polarization": {"electric_field": [[c.real, c.imag] for c in f]}}
        for o, d, f in zip(origins, directions, fields)
    ]
    (tmp_path / "rays.json").write_text(json.dumps(requests))
    reports = json.loads(command("trace", tmp_path / "scene.toml", "--rays", tmp_path / "rays.json").stdout)
    traced = trace(scene, origins, directions, fields)
    assert len(traced) == 13 and len(traced.ray) == sum(len(report["leaves"]) for report in reports)
    assert len(traced.ray) > 13
    leaf = 0
    for number, report in enumerate(reports):
        close(traced.absorbed[number], report["absorbed"])
        close(traced.pruned[number], report["pruned"])
        for expected in report["leaves"]:
            assert traced.ray[leaf] == number
            close(traced.power[leaf], expected["power"])
            close(traced.position[leaf], [np.nan] * 3 if expected["position"] is None else expected["position"])
            close(traced.direction[leaf], expected["direction"])
            close(traced.optical_path[leaf], expected["optical_path"])
            close(traced.electric_field[leaf], [complex(*part) for part in expected["electric_field"]])
            leaf += 1


def test_power_is_accounted_for(scene: Scene, random) -> None:
    traced = trace(scene, *rays(random, 2001), "vertical")
    np.testing.assert_allclose(traced.delivered + traced.absorbed + traced.pruned, 1, atol=1e-12)
    norms = (np.abs(traced.electric_field) ** 2).sum(axis=1)
    np.testing.assert_allclose(norms, traced.power, atol=1e-12)
    strongest = traced.strongest
    np.testing.assert_array_equal(traced.ray[strongest], np.arange(2001))
    best = np.zeros(2001)
    np.maximum.at(best, traced.ray, traced.power)
    np.testing.assert_array_equal(traced.power[strongest], best)


def test_arrays_may_lie_in_memory_as_they_like(scene: Scene, random) -> None:
    origins, directions = rays(random, 9)
    expected = trace(scene, origins, directions)
    read_only = np.asfortranarray(origins)
    read_only.flags.writeable = False
    wide = np.zeros((9, 6))
    wide[:, ::2] = directions
    packed = np.zeros(9, dtype=np.dtype([("flag", "u1"), ("origin", "f8", 3)]))
    packed["origin"] = origins
    for given in (read_only, origins.tolist(), origins.astype(">f8"), origins[::-1][::-1], packed["origin"]):
        traced = trace(scene, given, wide[:, ::2])
        np.testing.assert_array_equal(traced.power, expected.power)
        np.testing.assert_array_equal(traced.position, expected.position)
    before = origins.copy()
    trace(scene, origins, directions)
    np.testing.assert_array_equal(origins, before)


def test_one_row_stands_for_all(scene: Scene, random) -> None:
    origins, _ = rays(random, 5)
    spread = trace(scene, origins, [1, 0, 0], [0, 1j, 0])
    np.testing.assert_array_equal(
        spread.power, trace(scene, origins, np.tile([1, 0, 0], (5, 1)), np.tile([0, 1j, 0], (5, 1))).power
    )
    assert len(trace(scene, [-100, 3, 0], [1, 0, 0])) == 1
    assert len(trace(scene, np.empty((0, 3)), [1, 0, 0])) == 0
    assert trace(scene, np.empty((0, 3)), [1, 0, 0]).electric_field.shape == (0, 3)


ORIGIN, FORWARD = [-100, 3, 0], [1, 0, 0]


@pytest.mark.parametrize(
    ("arguments", "error", "message"),
    [
        (([1, 2], FORWARD), ValueError, "origins has the shape (2,); expected real numbers of the shape (N, 3) or (3,)"),
        ((np.zeros((3, 2)), FORWARD), ValueError, "origins has the shape (3, 2)"),
        ((np.zeros((1, 1, 3)), FORWARD), ValueError, "origins has the shape (1, 1, 3)"),
        (([], FORWARD), ValueError, "origins has the shape (0,)"),
        ((5, FORWARD), ValueError, "origins has the shape ()"),
        (([[1, 2, 3], [1, 2]], FORWARD), ValueError, "origins is no array"),
        ((["a", "b", "c"], FORWARD), TypeError, "origins is of the type <U1"),
        ((np.zeros(3, dtype=bool), FORWARD), TypeError, "origins is of the type bool"),
        ((np.zeros(3, dtype=complex), FORWARD), TypeError, "origins is of the type complex128"),
        ((np.zeros(3, dtype="datetime64[s]"), FORWARD), TypeError, "origins is of the type datetime64[s]"),
        (([None, 1, 2], FORWARD), TypeError, "origins is of the type object"),
        ((np.zeros((2, 3)) - 100, np.ones((3, 3))), ValueError, "differ in their rows: origins 2, directions 3"),
        (([ORIGIN, [np.nan, 0, 0]], FORWARD), ValueError, "ray 1 (counted from 0): origin and direction must be finite"),
        ((ORIGIN, [0, 0, 0]), ValueError, "ray 0 (counted from 0): the direction is zero"),
        ((ORIGIN, [np.inf, 0, 0]), ValueError, "must be finite"),
        (([[0, 20, 0], [4, 0, 0]], FORWARD), ValueError, "ray 1 (counted from 0): it starts inside device 0"),
        ((ORIGIN, FORWARD, "circular"), ValueError, 'polarization is "circular"; expected "horizontal"'),
        ((ORIGIN, FORWARD, [1, 0, 0]), ValueError, "the electric field is not transverse"),
        ((ORIGIN, FORWARD, [0, 0, 0]), ValueError, "the electric field is zero"),
        ((ORIGIN, FORWARD, [0, np.nan, 0]), ValueError, "the electric field must consist of finite numbers"),
        ((ORIGIN, FORWARD, None), TypeError, "polarization is of the type object"),
    ],
)
def test_bad_rays_are_told(scene: Scene, arguments: tuple, error: type[Exception], message: str) -> None:
    with pytest.raises(error) as raised:
        trace(scene, *arguments)
    assert message in str(raised.value)


def test_bad_settings_are_told(scene: Scene) -> None:
    for wrong, error in ((-1, ValueError), (2, ValueError), (float("nan"), ValueError), ("a", TypeError)):
        with pytest.raises(error, match="min_power is"):
            trace(scene, ORIGIN, FORWARD, min_power=wrong)
    with pytest.raises(TypeError, match="scene is a str; expected a Scene"):
        trace("scene.toml", ORIGIN, FORWARD)
    overlapping = Scene(devices=[cloakroom.SquareCloak(), cloakroom.SquareCloak()])
    for _ in range(2):
        with pytest.raises(ValueError, match="device 1 overlaps device 0"):
            trace(overlapping, ORIGIN, FORWARD)


def test_more_rays_than_memory_are_refused(scene: Scene) -> None:
    for count in (10**9, 10**13):
        with pytest.raises(MemoryError, match=f"tracing {count} rays needs"):
            trace(scene, np.broadcast_to(np.array(ORIGIN, dtype=float), (count, 3)), FORWARD)


def test_interfaces_are_those_of_the_command(command, random, tmp_path) -> None:
    def tensor() -> np.ndarray:
        matrix = random.uniform(-0.3, 0.3, (3, 3))
        return np.diag(random.uniform(1, 4, 3)) + matrix + matrix.T

    count = 7
    near = [tensor() for _ in range(count)]
    beyond = [tensor() + 0.1j * np.eye(3) for _ in range(count)]
    normals = random.normal(size=(count, 3))
    tangentials = np.cross(normals, random.normal(size=(count, 3)))
    tangentials *= 0.4 / np.linalg.norm(tangentials, axis=1, keepdims=True)

    def pairs(matrix: np.ndarray) -> list:
        return [[[complex(entry).real, complex(entry).imag] for entry in row] for row in matrix]

    requests = [
        {
            "incident": {"permittivity": pairs(near[i]), "permeability": 1},
            "transmitted": {"permittivity": pairs(beyond[i]), "permeability": 1.5},
            "normal": list(normals[i]),
            "tangential": list(tangentials[i]),
        }
        for i in range(count)
    ]
    (tmp_path / "interfaces.json").write_text(json.dumps(requests))
    reports = json.loads(command("interface", tmp_path / "interfaces.json").stdout)
    solved = interface(Medium(near), Medium(beyond, 1.5), normals, tangentials)
    for i, report in enumerate(reports):
        close(solved.power[i], np.array(report["power"], dtype=float))
        # Rounding decides the phases of modes of an absorbing medium.
        close(abs(solved.amplitudes[i]), abs(np.array(report["amplitudes"]) @ [1, 1j]))
        assert report["jones"] is None and np.isnan(solved.jones_reflected[i]).all()
        close(solved.total_reflected[i], np.array(report["total_reflected"], dtype=float))
        for side in ("incident", "reflected", "transmitted"):
            modes = getattr(solved, side)
            for j, mode in enumerate(report[side]):
                close(modes.wave_vector[i, j], [complex(*part) for part in mode["wave_vector"]])
                assert modes.propagating[i, j] == mode["propagating"]
                assert np.isnan(modes.poynting[i, j]).all() == (mode["poynting"] is None)


def test_fresnel(random) -> None:
    """Glass, against Fresnel's equations (Born & Wolf, section 1.5.2)."""
    angles = np.linspace(0, 1.5, 31)
    tangential = np.column_stack([np.zeros_like(angles), np.sin(angles), np.zeros_like(angles)])
    solved = interface(Medium(), {"permittivity": 2.25}, [1, 0, 0], tangential)
    beyond = np.arcsin(np.sin(angles) / 1.5)
    s = (np.cos(angles) - 1.5 * np.cos(beyond)) / (np.cos(angles) + 1.5 * np.cos(beyond))
    p = (1.5 * np.cos(angles) - np.cos(beyond)) / (1.5 * np.cos(angles) + np.cos(beyond))
    np.testing.assert_allclose(solved.total_reflected, np.column_stack([s**2, p**2]), atol=1e-12)
    onwards = (1 + s, (1 + p) / 1.5)
    for jones, (of_s, of_p) in ((solved.jones_reflected, (s, p)), (solved.jones_transmitted, onwards)):
        expected = np.zeros((31, 2, 2))
        expected[:, 0, 0], expected[:, 1, 1] = of_s, of_p
        np.testing.assert_allclose(jones, expected, atol=1e-12)
    metal = interface(Medium(), "metal", [1, 0, 0], tangential)
    assert metal.transmitted is None and metal.power.shape == metal.amplitudes.shape == (31, 2, 2)
    assert metal.jones_transmitted is None
    np.testing.assert_allclose(metal.jones_reflected, np.broadcast_to(np.diag([-1, 1]), (31, 2, 2)), atol=1e-12)
    np.testing.assert_allclose(metal.total_reflected, 1, atol=1e-12)


@pytest.mark.parametrize(
    ("arguments", "error", "message"),
    [
        ((1, Medium(), FORWARD, [0, 0, 0]), TypeError, "incident is 1; expected a Medium"),
        ((Medium(), "glass", FORWARD, [0, 0, 0]), TypeError, "transmitted is 'glass'; expected a Medium or \"metal\""),
        ((Medium(), {"index": 1.5}, FORWARD, [0, 0, 0]), TypeError, "transmitted has the keys index"),
        ((Medium(np.zeros((2, 2))), "metal", FORWARD, [0, 0, 0]), ValueError, "incident.permittivity has the shape (2, 2)"),
        ((Medium("x"), "metal", FORWARD, [0, 0, 0]), TypeError, "incident.permittivity is of the type"),
        ((Medium(0), "metal", FORWARD, [0, 0, 0]), ValueError, "permittivity"),
        ((Medium([[1, 1, 0], [0, 1, 0], [0, 0, 1]]), "metal", FORWARD, [0, 0, 0]), ValueError, "symmetric"),
        ((Medium(), Medium([1, 2]), FORWARD, np.zeros((3, 3))), ValueError, "differ in their rows"),
        ((Medium(), Medium([2, np.nan]), FORWARD, [0, 0, 0]), ValueError, "interface 1 (counted from 0)"),
        ((Medium(), Medium(), [0, 0, 0], [0, 0, 0]), ValueError, "the normal is zero"),
        ((Medium(), Medium(), FORWARD, [[0, 0, 0], [1, 0, 0]]), ValueError, "interface 1 (counted from 0): tangential"),
        ((Medium(), Medium(), FORWARD, [0, np.nan, 0]), ValueError, "tangential"),
    ],
)
def test_bad_interfaces_are_told(arguments: tuple, error: type[Exception], message: str) -> None:
    with pytest.raises(error) as raised:
        interface(*arguments)
    assert message in str(raised.value)


def test_films_reflect_as_their_thickness_has_it() -> None:
    film = Scene(light={"bandwidth_nm": 0}, devices=cloakroom.Body(shape="slab", thickness=92e-7, permittivity=2.25))
    traced = trace(film, [-1, 0, 0], [1, 0, 0], coherent=True)
    # |r|^2 = 4 r0^2 sin^2(b)/(...) of Airy's formula, b the phase of one way.
    r, phase = -0.2, 2 * np.pi * 1.5 * 92 / 550
    airy = r * (1 - np.exp(2j * phase)) / (1 - r**2 * np.exp(2j * phase))
    reflected = traced.power[traced.direction[:, 0] < 0]
    np.testing.assert_allclose(reflected, [abs(airy) ** 2], atol=1e-12)
    np.testing.assert_allclose(traced.power.sum(), 1, atol=1e-12)
    assert len(trace(film, [-1, 0, 0], [1, 0, 0]).ray) > 4


def test_crossed_polarizers_are_dark() -> None:
    crossed = Scene(devices=[cloakroom.Polarizer(position=(-5, 0, 0)), cloakroom.Polarizer(position=(5, 0, 0), angle=90)])
    traced = trace(crossed, [-50, 1, 2], [1, 0, 0])
    assert len(traced.ray) == 0
    np.testing.assert_allclose(traced.absorbed, 1)


def test_a_pulse_is_no_faster_than_causality_allows() -> None:
    slab = cloakroom.Body(shape="slab", thickness=2, permittivity=0.25)
    traced = trace(Scene(devices=slab), [-1, 0, 0], [1, 0, 0], group_delay=True)
    assert traced.group_path is not None
    # One way through: n is 0.5, the group index 2.
    np.testing.assert_allclose([traced.optical_path[0], traced.group_path[0]], [1, 4], atol=1e-12)
    assert trace(Scene(devices=slab), [-1, 0, 0], [1, 0, 0]).group_path is None
    slab = cloakroom.Body(shape="slab", thickness=2, permittivity=0.25, dispersion="none")
    traced = trace(Scene(devices=slab), [-1, 0, 0], [1, 0, 0], group_delay=True)
    np.testing.assert_allclose(traced.group_path, traced.optical_path)


def test_broadcast_arrays_take_no_memory_they_do_not_get() -> None:
    scene, many = Scene(devices=cloakroom.SquareCloak()), 10**11
    ray = np.array([1.0, 0.0, 0.0])
    start = np.broadcast_to([-100.0, 3.0, 0.0], (many, 3))
    with pytest.raises(MemoryError, match="only .* MB are free"):
        trace(scene, start, ray)
    with pytest.raises(MemoryError, match="origins needs"):
        trace(scene, np.broadcast_to([-100, 3, 0], (many, 3)), ray)
    along = np.broadcast_to([0.0, 0.5, 0.0], (many, 3))
    for permittivity in (1.0, np.broadcast_to(1.0, many), np.broadcast_to(np.eye(3), (many, 3, 3))):
        with pytest.raises(MemoryError):
            interface(Medium(permittivity, 1.0), Medium(2.0, 1.0), ray, along)
    gray = np.broadcast_to(np.uint8(7), (10**6, 10**6, 3))
    for image in (gray, np.broadcast_to(0.5, gray.shape)):
        with pytest.raises((MemoryError, ValueError)):
            Scene(photograph=image)
        with pytest.raises((MemoryError, ValueError)):
            cloakroom.quality(image, image)
    with pytest.raises(ValueError, match="values"):
        cloakroom.sweep(scene, {"device.0.rotation": np.broadcast_to(5.0, many)})
    nested: list[object] = [1.0] * 1000
    for _ in range(5):
        nested = [nested] * 1000
    with pytest.raises((TypeError, ValueError)):
        scene.replace({"camera.position": nested})
    with pytest.raises((MemoryError, ValueError)):
        cloakroom.Graded(index=np.broadcast_to(1.5, (10**6, 10**6)), width=4, height=4)
