"""What the README, the book and the package's own page show in Python runs, each page from its top."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from cloakroom import DoubleGaussianCloak, Scene, export
from conftest import REPOSITORY

#: What is written smaller before a page is run.
SMALLER = {
    "resolution=[640, 480]": "resolution=[40, 30]",
    "resolution=[320, 240]": "resolution=[40, 30]",
    "[16384, 12288]": "[64, 48]",
    "1_000_000": "1_000",
    "range(0, 91, 5)": "range(0, 91, 45)",
    "range(0, 91)": "range(0, 91, 45)",
    "np.linspace(0, 90, 181)": "np.linspace(0, 90, 3)",
    'Client("scheduler:8786")': "Client(n_workers=1, threads_per_worker=1, dashboard_address=None)",
    # It takes a minute; test_measuring.py calls it.
    "verify()": "verify",
}


def program(page: Path) -> str:
    """The Python of a page, every line where it stands in the page."""
    lines, inside = [], False
    for line in page.read_text(encoding="utf-8").splitlines():
        fence = line.startswith("```")
        inside = line == "```python" if fence else inside
        lines.append(line if inside and not fence else "")
    return "\n".join(lines)


PAGES = [REPOSITORY / "README.md", REPOSITORY / "python" / "README.md", *sorted((REPOSITORY / "docs").rglob("*.md"))]
PROGRAMS = {str(page.relative_to(REPOSITORY)): program(page) for page in PAGES if program(page).strip()}


def test_what_is_written_smaller_is_there() -> None:
    assert len(PROGRAMS) >= 4
    for large in SMALLER:
        assert any(large in code for code in PROGRAMS.values()), large


@pytest.mark.parametrize("page", PROGRAMS)
def test_pages_run(page: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, request: pytest.FixtureRequest) -> None:
    image = pytest.importorskip("PIL.Image", reason="writes a photograph")
    code = PROGRAMS[page]
    if "dask" in code:
        pytest.importorskip("distributed")
    if "mitsuba" in code:
        pytest.importorskip("cloakroom.mitsuba", reason="renders a room", exc_type=ImportError)
    for large, small in SMALLER.items():
        code = code.replace(large, small)
    if '["cloakroom"' in code:
        executable: Path = request.getfixturevalue("executable")
        monkeypatch.setenv("PATH", str(executable.parent), prepend=os.pathsep)
    # The files that pages take for granted.
    monkeypatch.chdir(tmp_path)
    (tmp_path / "conformance").symlink_to(REPOSITORY / "conformance")
    scene = Scene(devices=DoubleGaussianCloak())
    picture = scene.render(samples=1, resolution=(40, 30), image_only=True)
    picture.save("other.png")
    image.fromarray(picture.image).save("holiday.jpg")
    export(scene, "material.npz", grid=(8, 8, 1))
    names: dict = {}
    try:
        exec(compile(code, page, "exec"), names)
    finally:
        if "client" in names:
            names["client"].close()
