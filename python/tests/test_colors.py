"""Colors of light against the package `colour-science`, which has the tables and the observer of the CIE."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import cloakroom
from cloakroom import Body, Camera, Light, Material, Photograph, PictureSettings, Scene

colour = pytest.importorskip("colour")

#: The wavelengths of the standard's tables, nm.
NM = np.arange(380.0, 785.0, 5.0)

OBSERVER = colour.MSDS_CMFS["CIE 1931 2 Degree Standard Observer"].copy().align(colour.SpectralShape(380, 780, 5))

FLUORESCENT = colour.SDS_ILLUMINANTS["FL2"].copy().align(colour.SpectralShape(380, 780, 5))

DAYLIGHT = colour.SDS_ILLUMINANTS["D65"].copy().align(colour.SpectralShape(380, 780, 5))


def seen(spectrum: Any, color: tuple[float, float, float] = (1.0, 1.0, 1.0)) -> np.ndarray:
    """What a camera sees of surroundings of a linear color in a light."""
    scene = Scene(camera=Camera(resolution=[2, 2]), surroundings=color, light=Light(spectrum=spectrum))
    return scene.replace({"camera.target": [-200, 0, 0]}).render(image_only=True).linear[0, 0]


def wanted(power: np.ndarray) -> np.ndarray:
    """Linear sRGB of a light, the largest number of it 1."""
    weights = np.ones(len(NM))
    weights[[0, -1]] = 0.5
    tristimulus = (OBSERVER.values * (power * weights)[:, None]).sum(axis=0)
    linear = colour.XYZ_to_RGB(tristimulus, "sRGB", apply_cctf_encoding=False)
    return linear / linear.max()


@pytest.mark.parametrize(
    ("spectrum", "power"),
    [
        ("D65", DAYLIGHT.values),
        ("E", np.ones(len(NM))),
        ({"black_body_k": 2856}, colour.sd_blackbody(2856).align(colour.SpectralShape(380, 780, 5)).values),
        ({"black_body_k": 12000}, colour.sd_blackbody(12000).align(colour.SpectralShape(380, 780, 5)).values),
    ],
)
def test_white_is_the_color_of_the_lamp(spectrum: Any, power: np.ndarray) -> None:
    np.testing.assert_allclose(seen(spectrum), wanted(power), atol=1e-3)


def test_a_table_is_a_lamp() -> None:
    rows = np.column_stack([NM, FLUORESCENT.values])
    np.testing.assert_allclose(seen({"table": rows}), wanted(FLUORESCENT.values), atol=0.02)


@pytest.mark.parametrize("nm", [450.0, 532.0, 590.0, 632.8])
def test_light_of_one_wavelength_has_its_place_in_the_diagram(nm: float) -> None:
    found = colour.XYZ_to_xy(colour.RGB_to_XYZ(seen(nm), "sRGB", apply_cctf_decoding=False))
    np.testing.assert_allclose(found, colour.XYZ_to_xy(colour.wavelength_to_XYZ(nm)), atol=2e-3)


def test_colors_keep_their_numbers_in_daylight() -> None:
    for color in np.random.default_rng(1).uniform(0, 1, (8, 3)):
        np.testing.assert_allclose(seen("D65", tuple(color)), color, atol=1e-6)


def test_bins_hold_the_power_of_daylight() -> None:
    """White things in daylight: each bin has the lamp's share, and all of them its whole."""
    scene = Scene(
        camera=Camera(resolution=[2, 2], target=[-200, 0, 0]),
        surroundings=(1.0, 1.0, 1.0),
        light=Light(spectrum="D65"),
        picture=PictureSettings(channels=["spectrum"]),
    )
    bins = scene.render()["spectrum"][0, 0]
    edges = np.array([380, 430, 450, 470, 490, 510, 530, 550, 570, 590, 610, 630, 650, 670, 690, 720, 780.0])
    assert bins.shape == (16,)
    power = np.concatenate([[0], np.cumsum((DAYLIGHT.values[1:] + DAYLIGHT.values[:-1]) / 2)])
    shares = np.diff(np.interp(edges, NM, power)) / power[-1]
    np.testing.assert_allclose(bins, shares, atol=2e-6)


def test_sweeps_go_over_wavelengths() -> None:
    """A prism of a law is as visible in light of one wavelength as it is in a scene of that light alone."""
    scene = Scene(
        camera=Camera(resolution=[32, 24], samples=1),
        devices=Body(shape="box", size=[4, 4, 4], material=Material("sf11"), rotation=20),
    )
    swept = cloakroom.sweep(scene, {"light.spectrum": [450.0, 650.0]})
    alone = cloakroom.sweep(scene.replace({"light.spectrum": 650.0}), {"camera.samples": [1]})
    assert swept["light.spectrum"].tolist() == [450.0, 650.0]
    figures = [name for name in alone if name != "camera.samples"]
    for name in figures:
        np.testing.assert_array_equal(swept[name][1], alone[name][0], err_msg=name)
    assert any(swept[name][0] != swept[name][1] for name in figures if np.isfinite(swept[name]).all())


def test_photographs_in_colors_are_whole() -> None:
    """What nothing disperses returns its photograph in daylight."""
    photograph = np.random.default_rng(2).uniform(0, 1, (8, 8, 3))
    camera = Camera(resolution=[8, 8], field_of_view=10)
    scene = Scene(camera=camera, photograph=Photograph(image=photograph))
    lit = scene.replace({"light.spectrum": "D65"})
    np.testing.assert_allclose(lit.render().linear, scene.render().linear, atol=1e-6)
