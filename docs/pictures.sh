#!/usr/bin/env bash
# Makes the pictures of docs/devices and docs/real, each device as it looks (JPEG) and rays through it (PNG), the table of all devices,
# frames of the shop window, films and a picture of light in flight, and rooms.
# Needs cloakroom on the path, and Python with Pillow and the package with Mitsuba.
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
rays lens gallery/lens --width 12 --z 0 --set device.0.show=empty --set device.1.show=empty
rays graded-box gallery/graded-box --width 24
rays mirror-detour gallery/mirror-detour-orthographic --width 40
rays gaussian-carpet gallery/gaussian-carpet --parallel=-40 --wavefronts 4
rays grating-carpet gallery/grating-carpet --parallel=-40
rays quasi-conformal-carpet gallery/quasi-conformal-carpet --parallel=-40 --wavefronts 4

# real NAME SCENE [options of cloakroom render]
mkdir "$work/real"
real() {
  local name=$1 scene=scenes/real/$2.toml
  shift 2
  cloakroom render "$scene" --set camera.resolution=[480,360] --set camera.samples=3 --set trace.min_power=0.005 "$@" \
    -o "$work/real/$name.png"
}
real calcite-carpet calcite-carpet
real calcite-carpet-in-liquid calcite-carpet-in-liquid
real calcite-carpet-bare calcite-carpet-in-liquid --set device.2.show=bare
real prism-cloak prism-cloak
real water-cloak water-cloak
real four-mirrors four-mirrors
real mirror-box mirror-box
real mirror-box-open mirror-box --set device.5.position=[0,1000,0]
# real_rays SCENE [options of cloakroom diagram]
real_rays() {
  local name=$1
  shift
  cloakroom diagram "scenes/real/$name.toml" --size 480x360 "$@" -o "$work/real/$name-rays.png"
}
real_rays calcite-carpet --set light.spectrum=590 --parallel=-35 --width 4 --rays 14 --polarization vertical --min-power 0.1
real_rays prism-cloak --width 6
real_rays water-cloak --width 10
real_rays four-mirrors --camera --rays 40

# Frames of the shop window.
for angle in 0 8 16 30 45 60 75 90; do
  cloakroom render scenes/shop-window.toml --size 320x240 --samples 4 --set "device.0.rotation=$angle" -o "$work/window-$(printf %02d "$angle").png"
done

# Light in flight: films of the cloaks (ii) and (iii), and a pulse in (i) from the side.
for pair in ii:4c iii:6c; do
  cloakroom flight "scenes/paper/fig${pair#*:}.toml" --size 160x120 --pulse 0.1 --gate 4.85..6.85:0.05 --fps 10 -o "docs/flight-${pair%:*}.gif"
done
cloakroom diagram scenes/paper/fig2c.toml --size 640x480 --pulse 0.9 --z 6 --rays 40 --min-power 0.03 -o "$work/flight-side.png"

# Rooms, by the package cloakroom.mitsuba.
mkdir "$work/rooms"
# room NAME ROOM [options]
room() {
  local name=$1 scene=scenes/rooms/$2.xml
  shift 2
  python3 -m cloakroom.mitsuba "$scene" --size 400x300 --samples 256 --denoise --quiet "$@" -o "$work/rooms/$name.exr"
}
room 1 bar
room 2 bar --device cylinder-cloak:inner=3,outer=7,show=bare --length 60
room 3 study --device square-cloak --rotation 10
room 4 shop-window

# A photograph is far smaller as JPEG.
python3 - "$work" "$out" docs/real <<'PYTHON'
import pathlib, sys
from PIL import Image

work, out, real = map(pathlib.Path, sys.argv[1:])
for path in sorted((work / "gallery").glob("*.png")):
    if path.stem == "gallery" or path.stem.endswith("-time-of-flight"):
        continue
    image = Image.open(path).convert("RGB")
    image.save(out / f"{path.stem}.jpg", quality=82, optimize=True, progressive=True)
table = Image.open(work / "gallery" / "gallery.png").convert("RGB")
table.thumbnail((1500, table.height), Image.LANCZOS)
table.save("docs/gallery.jpg", quality=82, optimize=True, progressive=True)
for path in sorted(work.glob("*-rays.png")):
    Image.open(path).convert("RGB").quantize(128).save(out / path.name, optimize=True)
for path in sorted((work / "real").glob("*.png")):
    image = Image.open(path).convert("RGB")
    if path.stem.endswith("-rays"):
        image.quantize(128).save(real / path.name, optimize=True)
    else:
        image.save(real / f"{path.stem}.jpg", quality=84, optimize=True, progressive=True)
frames = [Image.open(path).convert("RGB") for path in sorted(work.glob("window-*.png"))]
window = Image.new("RGB", (4 * 326 - 6, 2 * 246 - 6), "white")
for number, frame in enumerate(frames):
    window.paste(frame, (326 * (number % 4), 246 * (number // 4)))
window.quantize(256).save("docs/shop-window.png", optimize=True)
rooms = Image.new("RGB", (800, 600))
for number in range(4):
    rooms.paste(Image.open(work / "rooms" / f"{number + 1}.png"), (400 * (number % 2), 300 * (number // 2)))
rooms.save("docs/rooms.jpg", quality=84, optimize=True, progressive=True)
Image.open(work / "flight-side.png").convert("RGB").quantize(128).save("docs/flight-side.png", optimize=True)
PYTHON
