"""The field that rays carry: each tube of light between neighbouring rays keeps its power and has the optical path."""

import numpy as np

import device


def on_line(leaves, x):
    """Height on the line at x, optical path to it, direction, amplitude: of the strongest leaf of each ray.

    Rays that go back have NaN.
    """
    rows = []
    for tree in leaves:
        position, direction, power, path, across = max(tree, key=lambda leaf: leaf[2])
        if direction[0] <= 0.05:
            rows.append([np.nan] * 6)
            continue
        way = (x - position[0]) / direction[0]
        rows.append([position[1] + way * direction[1], path + way, *direction, power, across.real / abs(across)])
    return np.array(rows)


def field(design, x, heights, wavelength, rotation=0.0, show="cloak", polarization="vertical", start=-60.0):
    """The field on the line at x, relative to that of the empty view: of coherent tubes, without diffraction.

    `heights` are those of the rays, evenly spaced; the result is on them, too.
    """
    k = 2 * np.pi / wavelength
    rows = on_line(device.rays(design, heights, start, rotation, show, polarization), x)
    step = heights[1] - heights[0]
    u = np.zeros(len(heights), complex)
    path = np.full(len(heights), np.nan)
    for one, two in zip(rows[:-1], rows[1:]):
        if not np.isfinite(one[0] + two[0]) or abs(two[0] - one[0]) > 5 * step:
            continue
        low, high = (one, two) if one[0] < two[0] else (two, one)
        inside = (heights >= low[0]) & (heights < high[0])
        if not inside.any():
            continue
        share = (heights[inside] - low[0]) / (high[0] - low[0])
        mixed = low + share[:, None] * (high - low)
        amplitude = np.sqrt(mixed[:, 4] * step / (high[0] - low[0]) / mixed[:, 2])
        delay = mixed[:, 1] - (x - start)
        u[inside] += mixed[:, 5] * amplitude * np.exp(1j * k * delay)
        path[inside] = delay
    return u, path


def beam(design, waist, height, x, rotation=0.0, show="cloak", forward=True, polarization="vertical"):
    """Height on the line at x and direction (degrees) of a beam of parallel rays, means weighted by power."""
    heights = height + waist * np.linspace(-2, 2, 161)
    weight = np.exp(-2 * ((heights - height) / waist) ** 2)
    rows = on_line(device.rays(design, heights, -60.0, rotation, show, polarization), x)
    weight = weight * np.nan_to_num(rows[:, 4])
    mean = np.nansum(rows * weight[:, None], axis=0) / weight.sum()
    return mean[0], np.degrees(np.arctan2(mean[3], mean[2]))
