"""Ray paths, two polarizations at once, and leaves that are drawn."""

from __future__ import annotations

import base64
import time
import xml.etree.ElementTree as ET

import numpy as np
import pytest

import cloakroom
from cloakroom import Scene, export, trace


@pytest.fixture
def scene() -> Scene:
    return Scene(devices=cloakroom.SquareCloak(material="negative-uniaxial", rotation=10))


def rays(random: np.random.Generator, count: int) -> tuple[np.ndarray, np.ndarray]:
    origins = np.column_stack([np.full(count, -100.0), *random.uniform(-12, 12, (2, count))])
    directions = np.column_stack([np.ones(count), *random.uniform(-0.1, 0.1, (2, count))])
    return origins, directions


def test_paths_lead_from_the_origin_to_the_leaves(scene: Scene, random) -> None:
    origins, directions = rays(random, 100)
    plain = trace(scene, origins, directions, min_power=1e-4)
    traced = trace(scene, origins, directions, min_power=1e-4, paths=True, reach=30)
    np.testing.assert_array_equal(traced.power, plain.power)
    np.testing.assert_array_equal(traced.position, plain.position)
    assert plain.paths is None
    paths = traced.paths
    assert paths is not None and len(paths) == len(paths.power) == len(paths.start) - 1
    # Every leaf has one piece, which begins where it left and goes on for the reach.
    of_leaves = paths.leaf >= 0
    np.testing.assert_array_equal(np.sort(paths.leaf[of_leaves]), np.arange(len(traced.ray)))
    for leaf in range(0, len(traced.ray), 7):
        way = paths.to_leaf(leaf)
        ray = traced.ray[leaf]
        np.testing.assert_allclose(way[0], origins[ray], atol=1e-12)
        if np.isfinite(traced.position[leaf, 0]):
            np.testing.assert_allclose(way[-2], traced.position[leaf], atol=1e-12)
        np.testing.assert_allclose(way[-1] - way[-2], 30 * traced.direction[leaf], atol=1e-9)
    # A piece goes on where the one before it ends, with no more power than that had.
    parents = paths.parent >= 0
    ends = paths.vertex[paths.start[1:] - 1]
    np.testing.assert_allclose(paths.vertex[paths.start[:-1]][parents], ends[paths.parent[parents]], atol=1e-9)
    assert (paths.power[parents] <= paths.power[paths.parent[parents]] + 1e-12).all()
    assert (paths.ray[parents] == paths.ray[paths.parent[parents]]).all()
    paths_end = paths.optical_path[paths.start[1:] - 1][of_leaves]
    expected = (traced.optical_path + 30)[paths.leaf[of_leaves]]
    np.testing.assert_allclose(paths_end, expected, atol=1e-9)


def test_segments_are_those_of_a_plane(scene: Scene) -> None:
    paths = trace(scene, [-20, 3, 1], [1, 0, 0], paths=True, reach=5).paths
    flat, space = paths.segments("zy"), paths.segments("xyz")
    assert len(flat) == len(space) == len(paths)
    np.testing.assert_array_equal(flat[0], space[0][:, [2, 1]])
    assert trace(scene, np.empty((0, 3)), [1, 0, 0], paths=True).paths.segments() == []
    with pytest.raises(ValueError, match="plane is 'ab'"):
        paths.segments("ab")
    with pytest.raises(IndexError, match="leaf is 999"):
        paths.to_leaf(999)


def test_graded_media_have_curved_paths() -> None:
    lens = Scene(devices=cloakroom.LuneburgLens(radius=10))
    traced = trace(lens, [[-20, 5, 0]], [1, 0, 0], paths=True, reach=20)
    way = traced.paths.to_leaf(0)
    assert len(way) > 10
    # All meet on the far side, on the axis.
    np.testing.assert_allclose(traced.position[0], [10, 0, 0], atol=1e-4)


def test_paths_are_written_for_paraview(scene: Scene, random, tmp_path) -> None:
    traced = trace(scene, *rays(random, 20), "both", min_power=1e-3, paths=True)
    export(traced, tmp_path / "rays.vtp")
    root = ET.parse(tmp_path / "rays.vtp").getroot()
    assert root.attrib["type"] == "PolyData"
    piece = root.find("PolyData/Piece")
    lines, points = int(piece.attrib["NumberOfLines"]), int(piece.attrib["NumberOfPoints"])
    assert (lines, points) == (len(traced.paths), len(traced.paths.vertex))
    text = root.find("AppendedData").text.strip()[1:]
    kinds = {"Float64": "<f8", "Int64": "<i8", "UInt32": "<u4"}
    arrays = {}
    for array in piece.iter("DataArray"):
        begin = int(array.attrib["offset"])
        head = np.frombuffer(base64.b64decode(text[begin : begin + 12])[:8], "<u8")[0]
        data = base64.b64decode(text[begin : begin + (8 + int(head) + 2) // 3 * 4])[8:]
        shape = (-1, int(array.attrib["NumberOfComponents"]))
        arrays[array.attrib["Name"]] = np.frombuffer(data, kinds[array.attrib["type"]]).reshape(shape)
    np.testing.assert_array_equal(arrays["vertex"], traced.paths.vertex)
    np.testing.assert_array_equal(arrays["power"], traced.paths.power)
    np.testing.assert_array_equal(arrays["offsets"][:, 0], traced.paths.start[1:])
    np.testing.assert_array_equal(arrays["leaf"][:, 0], traced.paths.leaf)
    export(traced.paths, tmp_path / "same.vtp")
    assert (tmp_path / "same.vtp").read_bytes() == (tmp_path / "rays.vtp").read_bytes()
    with pytest.raises(ValueError, match="use .vtp"):
        export(traced, tmp_path / "rays.obj")
    with pytest.raises(ValueError, match="trace with paths=True"):
        export(trace(scene, [-20, 3, 0], [1, 0, 0]), tmp_path / "rays.vtp")


def test_two_polarizations_are_those_of_each_alone(scene: Scene, random) -> None:
    origins, directions = rays(random, 200)
    both = trace(scene, origins, directions, "both")
    assert both.power.shape == (len(both.ray), 2) and both.electric_field.shape == (len(both.ray), 2, 3)
    np.testing.assert_allclose(both.delivered + both.absorbed + both.pruned, 1, atol=1e-12)
    for number, word in enumerate(("horizontal", "vertical")):
        alone = trace(scene, origins, directions, word)
        # The strong leaves of the one are leaves of both, with the same field.
        strong = both.power[:, number] > 1e-6
        kept = alone.power > 1e-6
        order, alone_order = np.flatnonzero(strong), np.flatnonzero(kept)
        key = np.lexsort((both.optical_path[order].round(6), both.ray[order]))
        alone_key = np.lexsort((alone.optical_path[alone_order].round(6), alone.ray[alone_order]))
        np.testing.assert_allclose(
            both.electric_field[order[key], number], alone.electric_field[alone_order[alone_key]], atol=1e-9
        )
    # A field between the two is their sum: the columns of a Jones matrix.
    fields = np.stack([np.cross([0, 0, 1], directions), np.cross(directions, np.cross([0, 0, 1], directions))], axis=1)
    given = trace(scene, origins, directions, fields)
    assert given.power.shape[1] == 2
    mixed = trace(scene, origins[:1], [1, 0, 0], [0, 0.6, 0.8j], min_power=1e-3)
    pair = trace(scene, origins[:1], [1, 0, 0], [[[0, 1, 0], [0, 0, 1]]], min_power=1e-3)
    strongest = mixed.strongest[0]
    same = np.flatnonzero(np.isclose(pair.optical_path, mixed.optical_path[strongest]))[0]
    np.testing.assert_allclose(
        mixed.electric_field[strongest], [0.6, 0.8j] @ pair.electric_field[same], atol=1e-9
    )


def test_coherent_light_has_two_polarizations_too() -> None:
    film = Scene(devices=cloakroom.Body(shape="slab", thickness=1e-5, permittivity=2.25))
    both = trace(film, [-1, 0, 0], [1, 0.5, 0], "both", coherent=True)
    for number, word in enumerate(("horizontal", "vertical")):
        alone = trace(film, [-1, 0, 0], [1, 0.5, 0], word, coherent=True)
        np.testing.assert_allclose(np.sort(both.power[:, number]), np.sort(alone.power), atol=1e-9)


def test_one_leaf_a_ray_is_drawn_by_its_power(scene: Scene) -> None:
    origin = np.tile([-100.0, 3, 1], (40_000, 1))
    alone = trace(scene, [-100, 3, 1], [1, 0, 0], "vertical", min_power=1e-3)
    drawn = trace(scene, origin, [1, 0, 0], "vertical", min_power=1e-3, pick=7)
    assert len(drawn.ray) == len(np.unique(drawn.ray)) <= 40_000
    for leaf in np.flatnonzero(alone.power > 1e-2):
        share = np.isclose(drawn.optical_path, alone.optical_path[leaf]).sum() / 40_000
        # Five standard deviations.
        assert abs(share - alone.power[leaf]) < 5 * np.sqrt(alone.power[leaf] / 40_000)
    np.testing.assert_array_equal(
        drawn.ray, trace(scene, origin, [1, 0, 0], "vertical", min_power=1e-3, pick=7).ray
    )
    random, same = np.random.default_rng(3), np.random.default_rng(3)
    first = trace(scene, origin, [1, 0, 0], "vertical", pick=random).optical_path
    np.testing.assert_array_equal(first, trace(scene, origin, [1, 0, 0], "vertical", pick=same).optical_path)
    again = trace(scene, origin, [1, 0, 0], "vertical", pick=random).optical_path
    assert len(again) != len(first) or (again != first).any()
    threads = cloakroom.threads()
    try:
        cloakroom.set_threads(1)
        np.testing.assert_array_equal(first, trace(scene, origin, [1, 0, 0], "vertical", pick=np.random.default_rng(3)).optical_path)
    finally:
        cloakroom.set_threads(0 if threads > 1 else threads)


@pytest.mark.parametrize(
    ("keys", "error", "message"),
    [
        ({"pick": "x"}, TypeError, "expected a numpy.random.Generator or a seed"),
        ({"pick": -1}, ValueError, "pick is -1"),
        ({"pick": 1, "paths": True}, ValueError, "paths does not go with pick"),
        ({"coherent": True, "paths": True}, ValueError, "paths does not go with coherent"),
        ({"reach": 0}, ValueError, "reach is 0 cm"),
        ({"polarization": np.ones((1, 4, 3))}, ValueError, "polarization has the shape (1, 4, 3)"),
    ],
)
def test_what_does_not_fit_is_told(scene: Scene, keys: dict, error: type[Exception], message: str) -> None:
    with pytest.raises(error) as raised:
        trace(scene, [-20, 3, 0], [1, 0, 0], **keys)
    assert message in str(raised.value)


def test_devices_are_built_once() -> None:
    # The map of this carpet is solved for when it is built, which takes long.
    scene = Scene(devices=cloakroom.QuasiConformalCarpet())

    def seconds() -> float:
        begin = time.perf_counter()
        trace(scene, [-20, 60, 0], [0.3, -1, 0])
        return time.perf_counter() - begin

    first, later = seconds(), min(seconds() for _ in range(30))
    assert later < 0.2 * first
    assert later < 0.02
