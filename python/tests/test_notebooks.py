"""The notebooks of the documentation run from beginning to end, and are kept with their pictures."""

from __future__ import annotations

import importlib.util
from pathlib import Path

import pytest

from conftest import REPOSITORY

pytest.importorskip("nbclient")
nbformat = pytest.importorskip("nbformat")
pytest.importorskip("matplotlib")

NOTEBOOKS = sorted((REPOSITORY / "docs" / "notebooks").glob("*.ipynb"))

#: A notebook with its pictures, bytes.
LARGEST = 800_000


def test_there_are_notebooks() -> None:
    assert NOTEBOOKS


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_notebooks_run_and_are_kept_with_their_pictures(path: Path) -> None:
    spec = importlib.util.spec_from_file_location("notebooks", REPOSITORY / "python" / "notebooks.py")
    notebooks = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(notebooks)

    def kinds(notebook) -> list[list[str]]:
        return [
            sorted(kind for output in cell.get("outputs", []) for kind in output.get("data", {}))
            for cell in notebook.cells
        ]

    kept = nbformat.read(path, as_version=4)
    if any("cloakroom.mitsuba" in cell.source for cell in kept.cells):
        pytest.importorskip("mitsuba", reason="mitsuba is not installed: pip install './python[mitsuba]'")
    assert kinds(kept) == kinds(notebooks.run(path)), "run python/notebooks.py"
    assert any("image/png" in shown for shown in kinds(kept)) and path.stat().st_size < LARGEST
