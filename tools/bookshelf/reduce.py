#!/usr/bin/env python3
"""Makes the images of the page that computes in the browser, crates/cloakroom/assets/reduced, from the whole ones beside them.

Half as wide and high, each pixel the mean of four. Needs Pillow. With --check nothing is written: exit status 1 says that the committed ones
are others.
"""

import io
import pathlib
import sys

from PIL import Image

ASSETS = pathlib.Path(__file__).resolve().parents[2] / "crates/cloakroom/assets"


def reduced(path: pathlib.Path) -> bytes:
    with Image.open(path) as whole:
        size = (whole.width // 2, whole.height // 2)
        half = whole.resize(size, Image.Resampling.BOX)
    file = io.BytesIO()
    half.save(file, "JPEG", quality=90, optimize=True, subsampling=0)
    return file.getvalue()


def main() -> int:
    if sys.argv[1:] not in ([], ["--check"]):
        print(f"usage: {sys.argv[0]} [--check]", file=sys.stderr)
        return 2
    others = 0
    for path in sorted(ASSETS.glob("*.jpg")):
        to = ASSETS / "reduced" / path.name
        image = reduced(path)
        if not sys.argv[1:]:
            to.write_bytes(image)
        elif not to.exists() or to.read_bytes() != image:
            print(f"{to} is not what {path} gives", file=sys.stderr)
            others += 1
    return 1 if others else 0


if __name__ == "__main__":
    sys.exit(main())
