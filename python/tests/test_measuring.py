"""Likeness, sweeps, flux, the paper's statements, material."""

from __future__ import annotations

import json

import numpy as np
import pytest

import cloakroom
from cloakroom import Camera, Scene, SquareCloak, export, flux, quality, sweep, verify


def test_likeness_is_that_of_the_command(command, cloak: Scene, tmp_path) -> None:
    a, b = cloak.render(), cloak.replace({"device.0.rotation": 20}).render()
    a.save(tmp_path / "a.npz")
    b.save(tmp_path / "b.npz")
    expected = json.loads(
        command("compare", tmp_path / "a.npz", tmp_path / "b.npz", "--region", "5,6,20,10", "--json").stdout
    )
    mask = np.zeros(a.shape, dtype=bool)
    mask[6:16, 5:25] = True
    for first, second, region in (
        (a, b, [5, 6, 20, 10]),
        (tmp_path / "a.npz", str(tmp_path / "b.npz"), mask),
        (a, b, np.asfortranarray(mask)),
    ):
        ours = quality(first, second, region)
        for part in ("picture", "region"):
            assert ours[part]["pixels"] == expected[part]["pixels"]
            for figure in ("correlation", "rms_difference", "structural_similarity", "flip", "delivered"):
                np.testing.assert_allclose(ours[part][figure], expected[part][figure], rtol=1e-9)
    images = quality(a.image, b.image)["picture"]
    np.testing.assert_allclose(images["correlation"], expected["picture"]["correlation"], atol=0.01)
    assert quality(a, a)["picture"]["flip"] == 0


@pytest.mark.parametrize(
    ("arguments", "error", "message"),
    [
        ((3, np.ones((4, 4))), TypeError, "first is a int; expected a Picture, an array or a path"),
        ((np.ones((4, 4)), np.ones((4, 4), dtype=int)), TypeError, "second is of the type int64"),
        ((np.ones((4, 4)), np.ones((4, 5))), ValueError, "the sizes differ: 4 x 4 pixels and 5 x 4"),
        ((np.ones((4, 4)), np.full((4, 4), np.nan)), ValueError, "not a finite number"),
        ((np.ones((4, 4)), np.ones((4, 4)), np.zeros((4, 4), dtype=bool)), ValueError, "no pixels in the region"),
        ((np.ones((4, 4)), np.ones((4, 4)), np.ones((4, 5), dtype=bool)), ValueError, "sizes differ"),
        ((np.ones((4, 4)), np.ones((4, 4)), np.zeros((0, 0), dtype=bool)), ValueError, "region"),
        ((np.ones((4, 4)), np.ones((4, 4)), [0, 0, 5, 1]), ValueError, "reaches beyond the picture"),
        ((np.ones((4, 4)), np.ones((4, 4)), [-1, 0, 5, 1]), ValueError, "none of its numbers may be negative"),
        ((np.ones((4, 4)), np.ones((4, 4)), [1, 2]), ValueError, "region has the shape (2,)"),
        ((np.ones((4, 4)), np.ones((4, 4)), "all"), TypeError, "region is of the type"),
        (("nowhere.npz", np.ones((4, 4))), FileNotFoundError, "nowhere.npz"),
    ],
)
def test_bad_comparisons_are_told(arguments: tuple, error: type[Exception], message: str) -> None:
    with pytest.raises(error) as raised:
        quality(*arguments)
    assert message in str(raised.value)


def test_sweeps_are_grids(command, tmp_path) -> None:
    camera = Camera(resolution=[40, 30], samples=1)
    scene = Scene(camera=camera, devices=SquareCloak())
    keys = {"device.0.rotation": np.array([0.0, 10.0, 20.0]), "camera.polarizer": ["horizontal", "vertical"]}
    told: list[tuple[int, int]] = []
    table = sweep(scene, keys, tmp_path / "table.csv", progress=lambda *steps: told.append(steps))
    assert told[-1][0] == told[-1][1] > 0 and (tmp_path / "table.csv").exists()
    sweep(scene, {"device.0.rotation": [0, 10]}, tmp_path / "plot.svg")
    sweep(scene, {"device.0.rotation": [0, 10]}, tmp_path / "plot.pdf")
    assert "Rotation (°)" in (tmp_path / "plot.svg").read_text()
    assert "RMS displacement" in (tmp_path / "plot.svg").read_text()
    assert (tmp_path / "plot.pdf").read_bytes().startswith(b"%PDF")
    assert table["device.0.rotation"].tolist() == [[0, 0], [10, 10], [20, 20]]
    assert table["camera.polarizer"][1].tolist() == ["horizontal", "vertical"]
    (tmp_path / "scene.toml").write_text(scene.toml)
    sweeps = ["--sweep=device.0.rotation=0,10,20", "--sweep=camera.polarizer=horizontal,vertical"]
    rows = json.loads(command("quality", tmp_path / "scene.toml", *sweeps, "--json").stdout)["rows"]
    for name in ("silhouette_share", "ideal_silhouette_flip", "delivered"):
        expected = [np.nan if row["figures"][name] is None else row["figures"][name] for row in rows]
        np.testing.assert_allclose(table[name].ravel(), expected, rtol=1e-6, atol=1e-9)


def test_lists_are_places_along_an_axis(cloak: Scene) -> None:
    positions = [[-80, 0, 0], [-90, 0, 0], [-95, 1, 0]]
    table = sweep(cloak, {"camera.position": positions, "device.0.rotation": [0, 5]})
    assert table["camera.position"].shape == (3, 2) and table["camera.position"][2, 1] == positions[2]
    alone = sweep(cloak.replace({"camera.position": positions[2]}), {"device.0.rotation": [5]})
    assert table["in_place_share"][2, 1] == alone["in_place_share"][0]
    dataset = pytest.importorskip("xarray") and table.to_xarray()
    assert dataset["in_place_share"].sel({"camera.position": "[-95, 1, 0]"}).shape == (2,)
    again = sweep(cloak, {"camera.position": positions, "device.0.rotation": [0, 5]})
    assert table == again and not table != again
    again["in_place_share"][0, 0] += 1
    assert table != again and not table == again
    assert table != alone and table != {} and table != 3


def test_bad_sweeps_are_told(cloak: Scene, tmp_path) -> None:
    for keys, error, message in [
        ([], TypeError, "keys is a list"),
        ({"device.0.rotation": 5}, TypeError, "keys['device.0.rotation'] is a int; expected a list of values"),
        ({"device.0.rotation": "0..5"}, TypeError, "is a str"),
        ({"device.0.rotation": []}, ValueError, "is empty"),
        ({"photograph.image": [np.zeros((9, 8, 3))]}, TypeError, "keys['photograph.image'] holds arrays; expected names"),
        ({"device.0.rotaton": [1]}, ValueError, "unknown key `rotaton`"),
        ({"camera.samples": range(200_000)}, ValueError, "more than 100000 combinations"),
    ]:
        with pytest.raises(error) as raised:
            sweep(cloak, keys)  # type: ignore[arg-type]
        assert message in str(raised.value)
    with pytest.raises(ValueError, match="cannot tell the format"):
        sweep(cloak, {"device.0.rotation": [1]}, tmp_path / "a.txt")
    with pytest.raises(OSError, match="cannot write"):
        sweep(cloak, {"device.0.rotation": [1]}, tmp_path / "none" / "a.csv")
    with pytest.raises(TypeError, match="scene is a str"):
        sweep("a", {})  # type: ignore[arg-type]


def test_flux_is_that_of_the_command(command, tmp_path) -> None:
    from conftest import REPOSITORY

    file = REPOSITORY / "scenes" / "flux" / "solar-cell.toml"
    few = {"rays": 64, "samples": 2, "cells": 8}
    arguments = [f"--{name}={count}" for name, count in few.items()]
    command("flux", file, "--angles=-10..10:10", *arguments, "-o", tmp_path / "theirs.npz")
    ours = flux(Scene.load(file), [-10, 0, 10], **few, path=tmp_path / "ours.npz")
    with np.load(tmp_path / "theirs.npz") as theirs, np.load(tmp_path / "ours.npz") as written:
        assert set(ours) | {"metadata"} == set(theirs.files) == set(written.files)
        for name, array in ours.items():
            np.testing.assert_allclose(array, theirs[name], rtol=1e-9, atol=1e-12)
            np.testing.assert_array_equal(array, written[name])
    day = flux(Scene.load(file), sun=(48, 0), rays=16, samples=2, cells=4)
    assert (np.diff(day["label"]) == 0.5).all() and len(day["label"]) > 10


def test_bad_flux_is_told(cloak: Scene) -> None:
    for arguments, error, message in [
        ({"angles": [[1, 2]]}, ValueError, "angles has the shape (1, 2)"),
        ({"angles": []}, ValueError, "angles has the shape (0,)"),
        ({"angles": [np.nan]}, ValueError, "expected finite angles"),
        ({"angles": ["a"]}, TypeError, "angles is of the type"),
        ({"angles": [0], "sun": (1, 2)}, ValueError, "angles and sun are both given"),
        ({"sun": (91, 0)}, ValueError, "from -90 to 90"),
        ({"sun": 3}, ValueError, "sun is 3"),
        ({"rays": 2.5}, TypeError, "rays is a float"),
        ({"rays": -1}, ValueError, "rays is -1"),
        ({"samples": 1}, ValueError, "samples"),
        ({"tilt": float("inf")}, ValueError, "tilt is inf"),
        ({"angles": [95]}, ValueError, "does not come from the front"),
        ({"path": "a.csv"}, ValueError, "path is 'a.csv'; expected the name of an .npz"),
        ({"path": "nowhere/a.npz"}, OSError, "cannot write nowhere/a.npz"),
    ]:
        with pytest.raises(error) as raised:
            flux(cloak, **arguments)
        assert message in str(raised.value), arguments
    with pytest.raises(ValueError, match="no device"):
        flux(Scene())


def test_material_is_that_of_the_command(command, cloak: Scene, tmp_path) -> None:
    (tmp_path / "scene.toml").write_text(cloak.toml)
    for name, words, arguments in [
        ("grid.npz", ["--grid", "8x6x1", "--frame", "world"], {"grid": (8, 6, 1), "frame": "world"}),
        ("cubes.csv", ["--grid", "2.5"], {"grid": 2.5}),
        ("table.json", ["--table"], {"table": True, "device": np.int64(0)}),
    ]:
        command("export", tmp_path / "scene.toml", "-o", tmp_path / f"theirs-{name}", *words)
        export(cloak, tmp_path / f"ours-{name}", **arguments)
        assert (tmp_path / f"ours-{name}").read_bytes() == (tmp_path / f"theirs-{name}").read_bytes(), name


def test_bad_exports_are_told(cloak: Scene, tmp_path) -> None:
    for arguments, error, message in [
        ({"grid": 0}, ValueError, "a grid needs a positive spacing"),
        ({"grid": (1, 2)}, ValueError, "grid is (1, 2)"),
        ({"grid": (1, 2, 3.5)}, ValueError, "expected the side of a cell"),
        ({"grid": "fine"}, TypeError, "grid is 'fine'"),
        ({"grid": 1e-5}, MemoryError, "needs"),
        ({"grid": 1e-9}, MemoryError, "too large for any memory"),
        ({"device": 3}, ValueError, "there is no device 3"),
        ({"device": -1}, ValueError, "device is -1"),
        ({"device": "first"}, TypeError, "device is a str"),
        ({"frame": "mine"}, ValueError, "frame is 'mine'"),
        ({"table": True, "grid": 1}, ValueError, "table goes with neither"),
    ]:
        with pytest.raises(error) as raised:
            export(cloak, tmp_path / "a.npz", **arguments)
        assert message in str(raised.value), arguments
    with pytest.raises(ValueError, match="cannot tell the format"):
        export(cloak, tmp_path / "a.txt")
    with pytest.raises(OSError, match="cannot write"):
        export(cloak, tmp_path / "none" / "a.npz")
    assert list(tmp_path.iterdir()) == []


def test_the_paper_is_gone_through(command) -> None:
    findings = verify()
    expected = json.loads(command("verify", "--json").stdout)["findings"]
    assert [finding.statement for finding in findings] == [finding["statement"] for finding in expected]
    assert [finding.verdict for finding in findings] == [finding["verdict"] for finding in expected]
    assert isinstance(findings[0], cloakroom.Finding)
