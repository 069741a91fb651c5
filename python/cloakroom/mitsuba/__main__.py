"""``python -m cloakroom.mitsuba ROOM -o room.exr``: a room in Mitsuba's XML, with devices in it."""

from __future__ import annotations

import argparse
import math
import re
import sys
from pathlib import Path

PROGRAM = "python -m cloakroom.mitsuba"


def arguments() -> argparse.ArgumentParser:
    """What the command takes."""
    parser = argparse.ArgumentParser(
        prog=PROGRAM,
        description="Renders a room of Mitsuba's XML with cloaks and other devices in it: EXR, and a PNG beside it.",
        epilog="A device is a kind and its keys, such as square-cloak:length=40,rotation=10, or a scene file.",
    )
    parser.add_argument("room", type=Path, help="the scene, such as scenes/rooms/study.xml")
    parser.add_argument("-o", "--output", type=Path, help="the picture, .exr; the PNG has the same name")
    place = parser.add_mutually_exclusive_group()
    place.add_argument("--device", metavar="DEVICE", help="what stands at the room's place for a device")
    parser.add_argument("--rotation", type=float, metavar="DEGREES", help="how it is turned about its own axis")
    parser.add_argument("--length", type=float, metavar="CM", help="its length along its axis (40 where it needs one)")
    place.add_argument("--empty", action="store_true", help="the room without that device")
    parser.add_argument(
        "--replace", action="append", default=[], metavar="SHAPE=DEVICE", help="a device in the place of a shape; again for more"
    )
    parser.add_argument(
        "--unit", type=float, metavar="CM", help="how many cm the room's unit of length is (as of its devices, else 100, a metre)"
    )
    shadows = parser.add_mutually_exclusive_group()
    shadows.add_argument(
        "--see-through", choices=["auto", "yes", "no"], help="whether shadow rays go through these devices (as the room has it, else auto)"
    )
    shadows.add_argument(
        "--block-shadows",
        action="store_true",
        help="no shadow rays through any device: quicker, noisier, and behind devices dark in the light of points and the sun",
    )
    parser.add_argument("--size", metavar="WxH", help="the size of the picture in pixels")
    parser.add_argument("--samples", type=int, metavar="N", help="samples per pixel")
    parser.add_argument("--seed", type=int, default=0, metavar="N", help="the seed (0); the same one gives the same bytes")
    parser.add_argument("--exposure", type=float, metavar="STOPS", help="of the PNG; by default as bright as suits the eye")
    parser.add_argument("--denoise", action="store_true", help="takes the noise away, by OptiX or Open Image Denoise (pip install pyoidn)")
    parser.add_argument("--variant", default="llvm_ad_rgb", help="of Mitsuba, one that computes wavefronts (llvm_ad_rgb)")
    parser.add_argument("--shapes", action="store_true", help="lists the names of the room's shapes, and ends")
    parser.add_argument("-q", "--quiet", action="store_true", help="no progress")
    return parser


def main(words: list[str] | None = None) -> int:
    """Runs the command; the exit status."""
    parser = arguments()
    given = parser.parse_args(words)
    size = None
    if given.size is not None:
        found = re.fullmatch(r"(\d+)x(\d+)", given.size)
        if not found:
            parser.error(f"--size: {given.size} is no size such as 640x480")
        size = (int(found[1]), int(found[2]))
    if size is not None and not all(size):
        parser.error(f"--size: {given.size} has no pixels")
    if given.samples is not None and given.samples < 1:
        parser.error("--samples: there must be one at least")
    if not 0 <= given.seed < 2**32:
        parser.error("--seed: expected a whole number from 0, below 2^32")
    if given.exposure is not None and not math.isfinite(given.exposure):
        parser.error(f"--exposure: {given.exposure} is no number of stops")
    try:
        return _render(given, size)
    except KeyboardInterrupt:
        return 130
    except (ImportError, OSError, RuntimeError, ValueError, TypeError) as error:
        # Mitsuba tells what went wrong in a plugin as the cause of an error of its own.
        cause: BaseException = error
        while cause.__cause__ is not None:
            cause = cause.__cause__
        print(f"{PROGRAM}: {cause}", file=sys.stderr)
        return 1


def _render(given: argparse.Namespace, size: tuple[int, int] | None) -> int:
    import mitsuba as mi
    import numpy as np

    import cloakroom.mitsuba  # noqa: F401

    from .._progress import told
    from ._picture import denoised, write
    from ._room import PLACE, Room, device_of, is_endless

    if not given.variant.startswith(("llvm_", "cuda_")) or given.variant not in mi.variants():
        known = ", ".join(name for name in mi.variants() if name.startswith(("llvm_", "cuda_")))
        raise ValueError(f"--variant: {given.variant} computes no wavefronts, or is not there; there are: {known}")
    mi.set_variant(given.variant)
    mi.set_log_level(mi.LogLevel.Error)
    room = Room(given.room)
    if given.shapes:
        print("\n".join(room.shapes))
        return 0
    if given.output is None:
        raise ValueError("--output is missing: where the picture goes, such as -o room.exr")
    if given.output.suffix != ".exr":
        raise ValueError(f"--output: {given.output} does not end in .exr")
    if not given.output.resolve().parent.is_dir():
        raise ValueError(f"--output: there is no folder {given.output.parent}")
    if given.empty:
        room.without(PLACE)
    elif given.device is not None:
        device = device_of(given.device)
        for key in ("rotation", "length"):
            if getattr(given, key) is not None:
                device[key] = getattr(given, key)
        if "length" not in device and is_endless(device):
            device["length"] = 40.0
        room.replace(PLACE, device, unit=given.unit, stands=True, see_through=given.see_through)
    elif given.rotation is not None or given.length is not None:
        raise ValueError("--rotation and --length are of a --device")
    for text in given.replace:
        name, equals, device_text = text.partition("=")
        if not equals:
            raise ValueError(f"--replace: {text} is no shape and device such as Cube.001=sphere-cloak")
        room.replace(name, device_of(device_text), unit=given.unit, see_through=given.see_through)
    scene = room.load(size=size, samples=given.samples)
    integrator = scene.integrator()
    if given.block_shadows:
        integrator.see_through = False
    with told(not given.quiet, "rendering") as tell:
        integrator.progress = tell
        image = np.array(integrator.render(scene, seed=given.seed))[:, :, :3]
    if image.shape[2] == 1:
        # Light without colors.
        image = np.repeat(image, 3, axis=2)
    if given.denoise:
        clean = denoised(image)
        if clean is None:
            print(f"{PROGRAM}: --denoise: Open Image Denoise is not there (pip install pyoidn), nor a variant for OptiX; not denoised", file=sys.stderr)
        else:
            image = clean
    write(image, given.output, given.exposure)
    return 0


if __name__ == "__main__":
    sys.exit(main())
