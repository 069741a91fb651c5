"""Runs the notebooks of the documentation and keeps what they show in them, pictures made small.

Run it where cloakroom is installed with its extra `notebooks`, after a change of one: python notebooks.py [NAME ...]
"""

from __future__ import annotations

import base64
import io
import sys
from pathlib import Path
from typing import Any

FOLDER = Path(__file__).resolve().parents[1] / "docs" / "notebooks"

#: Pictures have so many colors, and are so wide at most (pixels): what they show is to be seen, not measured.
COLORS, WIDEST = 64, 760


def small(png: str) -> str:
    """A picture in base64 with few colors."""
    from PIL import Image

    image = Image.open(io.BytesIO(base64.b64decode(png))).convert("RGB")
    image.thumbnail((WIDEST, 10 * WIDEST))
    out = io.BytesIO()
    image.quantize(COLORS).save(out, "PNG", optimize=True)
    return base64.b64encode(out.getvalue()).decode() + "\n"


def run(path: Path) -> Any:
    """The notebook with what its cells show."""
    import nbclient
    import nbformat

    notebook = nbformat.read(path, as_version=4)
    resources = {"metadata": {"path": str(path.parent)}}
    nbclient.NotebookClient(
        notebook, timeout=600, kernel_name="python3", resources=resources, record_timing=False
    ).execute()
    return notebook


if __name__ == "__main__":
    import nbformat

    for path in sorted(FOLDER.glob("*.ipynb")):
        if sys.argv[1:] and path.stem not in sys.argv[1:]:
            continue
        notebook = run(path)
        notebook.metadata.pop("widgets", None)
        # That of the machine that has run it is of no use elsewhere.
        notebook.metadata.language_info = {"name": "python"}
        for cell in notebook.cells:
            for output in cell.get("outputs", []):
                if "image/png" in output.get("data", {}):
                    output.data["image/png"] = small(output.data["image/png"])
        nbformat.write(notebook, path)
        print(f"{path.name}: {path.stat().st_size // 1024} KiB")
