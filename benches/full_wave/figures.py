"""The figures of docs/full-wave.md."""

import matplotlib
import numpy as np

matplotlib.use("Agg")

import matplotlib.pyplot as plt

import device as cloak
import ray_picture
from finite_elements import ELECTRIC, MAGNETIC, Case, pattern, turned

DOCS = cloak.ROOT / "docs"
# Okabe and Ito's colors, which color-blind people tell apart.
BLUE, ORANGE, GREEN, SKY = "#0072B2", "#D55E00", "#009E73", "#56B4E9"
plt.rcParams.update({"font.size": 8, "axes.linewidth": 0.6, "lines.linewidth": 1.0, "legend.frameon": False})


def saved(figure, name):
    """Written with a palette, which is a third of the size and looks the same."""
    from PIL import Image

    path = DOCS / name
    figure.savefig(path, dpi=200)
    plt.close(figure)
    Image.open(path).convert("RGB").quantize(256, method=Image.Quantize.MEDIANCUT, dither=Image.Dither.FLOYDSTEINBERG).save(path, optimize=True)
    print(f"{path.relative_to(cloak.ROOT)}: {path.stat().st_size // 1024} kB")


def fields(solved):
    """Real parts of the fields."""
    square, four = cloak.load("(iii)"), cloak.load("(iv)")
    panels = [
        ("a  empty", None, None),
        ("b  metal, $H_z$", square, Case("bare", MAGNETIC, 2.0)),
        ("c  (iii), $H_z$", square, Case("cloak", MAGNETIC, 2.0)),
        ("d  (iii) turned by 10°, $H_z$", square, Case("cloak", MAGNETIC, 2.0, 10.0)),
        ("e  (i), (ii), (iii), $E_z$", square, Case("cloak", ELECTRIC, 2.0)),
        ("f  (iv), $H_z$", four, Case("cloak", MAGNETIC, 4.0)),
    ]
    figure, axes = plt.subplots(2, 3, figsize=(6.8, 4.35), layout="constrained")
    for axis, (title, device, case) in zip(axes.flat, panels):
        reach = 30.0 if device is four else 14.0
        if case is None:
            side = (np.arange(420) + 0.5) / 420 * 2 * reach - reach
            values = np.tile(np.cos(np.pi * side), (420, 1))
        else:
            values = solved(device.design, case, picture=True)["picture"]
            for outline, color in ((device.outline, "black"), (device.metal, "0.35")):
                points = turned(outline, case.rotation)
                if color == "0.35":
                    axis.fill(*points.T, facecolor="0.75", edgecolor="none")
                if color == "0.35" or case.show == "cloak":
                    axis.plot(*np.vstack([points, points[:1]]).T, color=color, linewidth=0.6)
        image = axis.imshow(
            values, origin="lower", extent=(-reach, reach) * 2, cmap="RdBu_r", vmin=-1.6, vmax=1.6, zorder=0
        )
        axis.set(title=title, xlim=(-reach, reach), ylim=(-reach, reach))
        axis.set_xticks([-20, 0, 20] if reach > 20 else [-10, 0, 10])
        axis.set_yticks([-20, 0, 20] if reach > 20 else [-10, 0, 10])
        axis.tick_params(length=2, width=0.6)
    for axis in axes[1]:
        axis.set_xlabel("x (cm)")
    for axis in axes[:, 0]:
        axis.set_ylabel("y (cm)")
    figure.colorbar(image, ax=axes, shrink=0.7, aspect=30, label="real part of the field, incident wave 1")
    saved(figure, "full-wave-fields.png")


def phases(solved, line):
    """Optical path and power behind the devices against height, of waves and of rays."""
    figure, (one, two, three) = plt.subplots(3, 1, figsize=(3.4, 6.2), layout="constrained")
    y, _ = line("(iv)")
    heights = np.linspace(-28.5, 28.5, 2280)
    for wavelength, color in ((4.0, SKY), (2.0, ORANGE), (1.0, BLUE)):
        rays, path = ray_picture.field("(iv)", 27.0, heights, wavelength)
        rays, path = np.interp(y, heights, rays), np.interp(y, heights, path)
        u = solved("(iv)", Case("cloak", MAGNETIC, wavelength))["field"]
        found = path + np.angle(u * np.conj(rays)) * wavelength / 2 / np.pi
        found[rays == 0] = np.nan
        one.plot(y, found, color=color, label=f"wave, {wavelength:g} cm")
    one.plot(y, path, color="black", linestyle=(0, (4, 3)), label="rays")
    flat, _ = line("(iii)")
    u = solved("(iii)", Case("cloak", MAGNETIC, 2.0))["field"]
    one.plot(flat, np.angle(u) / np.pi, color=GREEN, label="(iii), wave, 2 cm")
    one.set(ylabel="path less empty view (cm)", ylim=(-0.2, 2.3), title="a  (iv) and (iii), $H_z$")
    one.legend(fontsize=6.5, ncols=2, loc="lower center", bbox_to_anchor=(0.5, 0.08))
    metal = np.abs(cloak.load("(iii)").metal[:, 1]).max()
    two.fill_between([-metal, metal], 0, 2.6, color="0.88", linewidth=0, label="shadow of rays")
    cases = [
        ("metal, $H_z$", Case("bare", MAGNETIC, 0.5), ORANGE),
        ("(iii), $H_z$", Case("cloak", MAGNETIC, 0.5), GREEN),
        ("(iii), $E_z$", Case("cloak", ELECTRIC, 0.5), BLUE),
    ]
    for label, case, color in cases:
        two.plot(flat, np.abs(solved("(iii)", case)["field"]) ** 2, color=color, label=label)
    two.set(ylabel="power, incident 1", ylim=(0, 2.6), title="b  square, wavelength 0.5 cm")
    two.legend(fontsize=6.5, ncols=2, loc="upper center")
    for label, polarization, color in (("$H_z$", MAGNETIC, GREEN), ("$E_z$", ELECTRIC, BLUE)):
        u = solved("(iv)", Case("cloak", polarization, 1.0))["field"]
        three.plot(y, np.abs(u) ** 2, color=color, label=label)
    # Tubes cross in the middle, where the field of rays is none.
    rays = np.where((rays == 0) | (np.abs(y) < 0.3), np.nan, rays)
    three.plot(y, np.abs(rays) ** 2, color="black", linestyle=(0, (4, 3)), label="rays")
    three.set(ylabel="power, incident 1", ylim=(0, 3.1), xlabel="y (cm)", title="c  (iv), wavelength 1 cm")
    three.legend(fontsize=6.5, ncols=3, loc="upper center")
    saved(figure, "full-wave-phase.png")


def far_field(solved):
    """Where turned devices send light."""
    figure, axis = plt.subplots(figsize=(3.4, 2.4), layout="constrained")
    angles = np.linspace(-30, 75, 2101)
    wavelength = 0.5
    dashed = (0, (4, 3))
    shows = [("metal", "bare", ORANGE, "-"), ("flat mirror", "mirror", "black", "-"), ("(iii)", "cloak", SKY, dashed)]
    for label, show, color, style in shows:
        got = solved("(iii)", Case(show, MAGNETIC, wavelength, 10.0))
        width = pattern(got["multipoles"], got["orders"], wavelength, angles)
        axis.semilogy(angles, width, color=color, linestyle=style, label=label)
    axis.axvline(20, color="0.6", linewidth=0.6)
    axis.text(20.7, 2.2e-3, "rays", fontsize=6.5, color="0.35")
    axis.set(xlabel="direction (degrees)", ylabel="scattering width (cm/rad)", ylim=(1e-3, 1e3), xlim=(-30, 75))
    axis.legend(fontsize=6.5, loc="upper right")
    saved(figure, "full-wave-mirror.png")
