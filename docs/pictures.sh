#!/usr/bin/env bash
# Makes the pictures of docs/devices: each device as it looks (JPEG), and rays through it (PNG).
# Needs cloakroom on the path and Python with Pillow.
set -euo pipefail
cd "$(dirname "$0")/.."
out=docs/devices
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

cloakroom gallery --size 480x360 --samples 2 --out "$work/gallery"

# rays NAME SCENE [options of cloakroom diagram]
rays() {
  local name=$1 scene=scenes/$2.toml
  shift 2
  cloakroom diagram "$scene" --size 480x360 "$@" -o "$work/$name-rays.png"
}
rays square-cloak paper/fig6c --wavefronts 2 --width 24
rays square-cloak-positive-uniaxial paper/fig3d --polarization horizontal --z 6 --width 20 --rays 6
rays double-gaussian-cloak paper/fig8c --wavefronts 4 --width 56
rays cylinder-cloak gallery/cylinder-cloak --wavefronts 2 --width 24
rays cylinder-cloak-azimuthal gallery/cylinder-cloak-azimuthal --polarization vertical --width 24
rays sphere-cloak gallery/sphere-cloak --space 30,20 --layers 3 --width 18
rays invisible-sphere gallery/invisible-sphere --width 24
rays bending-sphere gallery/bending-sphere --width 24
rays eaton-lens gallery/eaton-lens --width 24
rays luneburg-lens gallery/luneburg-lens --wavefronts 2 --width 24
rays fisheye-lens gallery/fisheye-lens --point=-10,0,0
rays fisheye-hemisphere gallery/fisheye-hemisphere --wavefronts 2 --width 24
rays graded gallery/graded --width 24
rays graded-3d gallery/graded-3d --width 24
rays graded-box gallery/graded-box --width 24
rays mirror-detour gallery/mirror-detour-orthographic --width 40
rays gaussian-carpet gallery/gaussian-carpet --parallel=-40 --wavefronts 4
rays grating-carpet gallery/grating-carpet --parallel=-40
rays quasi-conformal-carpet gallery/quasi-conformal-carpet --parallel=-40 --wavefronts 4

# A photograph is far smaller as JPEG.
python3 - "$work" "$out" <<'PYTHON'
import pathlib, sys
from PIL import Image

work, out = map(pathlib.Path, sys.argv[1:])
for path in sorted((work / "gallery").glob("*.png")):
    if path.stem == "gallery" or path.stem.endswith("-time-of-flight"):
        continue
    image = Image.open(path).convert("RGB")
    image.save(out / f"{path.stem}.jpg", quality=82, optimize=True, progressive=True)
for path in sorted(work.glob("*-rays.png")):
    Image.open(path).convert("RGB").quantize(128).save(out / path.name, optimize=True)
PYTHON
