"""What comes out of a room: EXR, and a PNG that is made for the eye."""

from __future__ import annotations

import os
import shutil
import subprocess
import tempfile
from pathlib import Path
from typing import Any

import mitsuba as mi
import numpy as np
from numpy.typing import NDArray

__all__ = ["denoised", "tone_mapped", "write"]

#: Luminance of linear sRGB.
LUMINANCE = np.array([0.2126, 0.7152, 0.0722])

#: What the mean of the logarithms of a picture is brought to.
MIDDLE_GREY = 0.16


def tone_mapped(image: NDArray[Any], exposure: float | None = None) -> NDArray[np.float64]:
    """Light as numbers from 0 to 1 for sRGB: Reinhard et al., "Photographic tone reproduction", SIGGRAPH 2002, eq. 4.

    Parameters
    ----------
    image : array, (height, width, 3)
        Linear light.
    exposure : float, optional
        Stops by which it is made brighter; by default the logarithmic mean comes to middle grey.
    """
    light = np.maximum(np.asarray(image, np.float64), 0)
    luminance = light @ LUMINANCE
    if exposure is None:
        scale = MIDDLE_GREY / np.exp(np.log(luminance + 1e-4 * (luminance.mean() + 1e-12)).mean())
    else:
        scale = 2.0**exposure
    luminance = luminance * scale
    white = max(1.0, float(np.quantile(luminance, 0.995)))
    mapped = (1 + luminance / white**2) / (1 + luminance)
    shown: NDArray[np.float64] = np.clip(light * (scale * mapped)[..., None], 0, 1)
    return shown


def denoised(image: NDArray[np.float32]) -> NDArray[np.float32] | None:
    """The picture without its noise, by OptiX in variants for its GPUs or by Open Image Denoise, as the package ``pyoidn`` or
    its command; ``None`` where there is none of them."""
    height, width = image.shape[:2]
    if mi.variant().startswith("cuda_"):
        return np.array(mi.OptixDenoiser(mi.ScalarVector2u(width, height))(mi.TensorXf(image)))
    try:
        import pyoidn
    except ImportError:
        pass
    else:
        return np.asarray(pyoidn.denoise(np.ascontiguousarray(image, np.float32), hdr=True))
    program = shutil.which("oidnDenoise")
    if program is None:
        return None
    with tempfile.TemporaryDirectory() as folder:
        noisy, clean = Path(folder, "noisy.pfm"), Path(folder, "clean.pfm")
        mi.Bitmap(image).convert(mi.Bitmap.PixelFormat.RGB, mi.Struct.Type.Float32, False).write(str(noisy))
        subprocess.run([program, "--hdr", noisy, "-o", clean], check=True, stdout=subprocess.DEVNULL)
        return np.array(mi.Bitmap(str(clean)))


def write(image: NDArray[Any], path: Path, exposure: float | None = None) -> None:
    """Writes linear light as EXR, and a tone mapped PNG beside it; each file whole or not at all."""
    bitmap = mi.Bitmap(np.asarray(image, np.float32))
    _whole(bitmap, path.with_suffix(".exr"))
    eye = mi.Bitmap(tone_mapped(image, exposure).astype(np.float32))
    _whole(eye.convert(mi.Bitmap.PixelFormat.RGB, mi.Struct.Type.UInt8, True), path.with_suffix(".png"))


def _whole(bitmap: Any, path: Path) -> None:
    # The ending says the format.
    beside = path.with_name(f".{path.stem}.{os.getpid()}{path.suffix}")
    try:
        bitmap.write(str(beside))
        os.replace(beside, path)
    finally:
        beside.unlink(missing_ok=True)
