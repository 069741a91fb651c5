#!/usr/bin/env python3
"""Waves against rays: solves Maxwell's equations on what cloakroom exports, and prints tables and draws figures.

    benches/full_wave/install.sh && target/full_wave/venv/bin/python benches/full_wave/run.py [--quick]

Results are kept in target/full_wave and not computed again; --quick leaves out what takes longest. docs/full-wave.md says what is
compared, and holds what this prints and draws.
"""

import argparse
import subprocess
import time
from dataclasses import replace

import numpy as np

import device as cloak
import ray_picture
from finite_elements import ELECTRIC, MAGNETIC, Case, Waves, pattern

# Radius of the disk, of the circle that the scattered field is expanded on, place of the line behind the device,
# its half length, of which so much is compared with rays: cm.
PLACES = {"(iii)": (17.0, 15.0, 12.0, 11.5, 10.0), "(iv)": (40.0, 39.0, 27.0, 28.0, 20.0)}
MEEP = "/usr/bin/python3"


def line(design):
    _, _, at, reach, _ = PLACES[design]
    y = np.linspace(-reach, reach, 1121)
    return y, np.column_stack([np.full(len(y), at), y])


def name(design, case):
    words = [design, case.show, case.polarization, f"{case.wavelength:g}", f"{case.rotation:g}"]
    words += [f"{case.order}", f"{case.size:g}"] + [f"{b:g}" for b in case.beam or ()]
    return " ".join(words)


def solved(design, case, picture=False):
    """The field on the line relative to the incident plane wave; widths and multipoles, or a beam's place and direction."""
    path = cloak.WORK / f"{name(design, case)}{' picture' if picture else ''}.npz"
    if path.exists():
        return np.load(path)
    start = time.perf_counter()
    radius, circle, at, _, _ = PLACES[design]
    waves = Waves(cloak.load(design), case, radius)
    y, points = line(design)
    u = waves.at(waves.total, points)
    result = {"field": u * np.exp(-1j * waves.k * at), "unknowns": waves.unknowns}
    if case.beam is None:
        result["widths"] = waves.widths(circle)
        result["multipoles"], result["orders"] = waves.multipoles(circle)
    else:
        # The flow of power through the line: its mean place and direction.
        flow = (np.conj(u)[:, None] * waves.at(waves.total_gradient, points)).imag
        along, across = flow.sum(axis=0)
        result["beam"] = (y @ flow[:, 0] / along, np.degrees(np.arctan2(across, along)))
    if picture:
        result["picture"] = pictured(waves, 14.0 if design == "(iii)" else 30.0)
    result["seconds"] = time.perf_counter() - start
    np.savez_compressed(path, **result)
    print(f"{path.stem}: {waves.unknowns} unknowns, {result['seconds']:.0f} s", flush=True)
    return np.load(path)


def pictured(waves, reach, pixels=420):
    """The real part of the total field on a square of so many pixels, indices y and x; NaN in metal."""
    from matplotlib.path import Path

    side = (np.arange(pixels) + 0.5) / pixels * 2 * reach - reach
    points = np.stack(np.meshgrid(side, side), axis=-1).reshape(-1, 2)
    metal = Path(waves.metal).contains_points(points)
    values = np.full(len(points), np.nan)
    values[~metal] = waves.at(waves.total, points[~metal]).real
    return values.reshape(pixels, pixels)


def table(title, head, rows):
    print(f"\n**{title}**\n\n| {' | '.join(head)} |\n| {' | '.join(['---'] + ['---:'] * (len(head) - 1))} |")
    for row in rows:
        print(f"| {' | '.join(row)} |")


def rms(values):
    return float(np.sqrt(np.mean(np.abs(values) ** 2)))


def shadow(design, field, half):
    y, _ = line(design)
    return float(np.mean(np.abs(field[np.abs(y) < half]) ** 2))


def square():
    """Design (iii) and its metal along the axis."""
    y, _ = line("(iii)")
    seen = np.abs(y) < PLACES["(iii)"][4]
    metal = np.abs(cloak.load("(iii)").metal[:, 1]).max()
    rows = []
    for polarization in (MAGNETIC, ELECTRIC):
        for show in ("bare", "cloak", "mirror"):
            for wavelength in (2.0, 1.0, 0.5):
                got = solved("(iii)", Case(show, polarization, wavelength))
                u = got["field"]
                rows.append([
                    f"{polarization}, {show}", f"{wavelength:g}", f"{got['widths'][0]:.4f}",
                    f"{abs(got['widths'][1] - got['widths'][0]):.0e}", f"{shadow('(iii)', u, metal):.4f}",
                    f"{rms(u[seen] - 1):.2g}", f"{rms(np.angle(u[seen])) * wavelength / 2 / np.pi:.2g}",
                ])  # fmt: skip
    head = ["square, along x", "wavelength", "scattering width", "extinction less that", "power behind the metal"]
    head += ["RMS of u/u0 - 1", "RMS phase as path"]
    table(f"Design (iii), rays: bare {4 * metal:.2f} cm, power 0; cloak 0 cm, power 1 (lengths in cm)", head, rows)


def turned_square():
    """Design (iii) turned, against the flat mirror."""
    angles = np.linspace(8, 60, 1041)
    rows = []
    for polarization in (MAGNETIC, ELECTRIC):
        # The shortest once: it takes longest.
        for wavelength in (2.0, 1.0, 0.5) if polarization == MAGNETIC else (2.0, 1.0):
            cases = {s: Case(s, polarization, wavelength, 10.0) for s in ("bare", "cloak", "mirror")}
            got = {show: solved("(iii)", case) for show, case in cases.items()}
            flat = got["mirror"]["multipoles"]
            off = {s: rms(g["multipoles"] - flat) / rms(flat) for s, g in got.items()}
            bright = {
                s: angles[np.argmax(pattern(g["multipoles"], g["orders"], wavelength, angles))] for s, g in got.items()
            }
            rows.append([
                f"{polarization}", f"{wavelength:g}", *(f"{got[s]['widths'][0]:.4f}" for s in cases),
                f"{off['cloak']:.1e}", f"{off['bare']:.2f}", *(f"{bright[s]:.2f}" for s in ("cloak", "mirror")),
            ])  # fmt: skip
    head = ["square, turned by 10 degrees", "wavelength", "width: bare", "(iii)", "flat mirror"]
    head += ["(iii) less mirror, relative", "bare less mirror", "brightest beyond 8 degrees: (iii)", "mirror"]
    table("Design (iii) against the flat mirror, far field", head, rows)


def graded(quick):
    """Design (iv) along the axis, against the field that rays carry."""
    y, _ = line("(iv)")
    seen = (np.abs(y) < PLACES["(iv)"][4]) & (np.abs(y) > 0.5)
    heights = np.linspace(-28.5, 28.5, 2280)
    rows = []
    for polarization in (MAGNETIC, ELECTRIC):
        for wavelength in (4.0, 2.0) if quick else (4.0, 2.0, 1.0):
            got = solved("(iv)", Case("cloak", polarization, wavelength))
            rays, _ = ray_picture.field("(iv)", PLACES["(iv)"][2], heights, wavelength)
            rays = np.interp(y, heights, rays)
            path = np.angle(got["field"] * np.conj(rays)) * wavelength / 2 / np.pi
            width = np.sum(np.abs(rays - 1)[np.abs(y) < 27.5] ** 2) * (y[1] - y[0])
            rows.append([
                f"{polarization}", f"{wavelength:g}", f"{got['widths'][0]:.2f}",
                f"{abs(got['widths'][1] - got['widths'][0]):.0e}", f"{width:.1f}", f"{rms(path[seen]):.4f}",
                f"{np.abs(path[seen]).max():.4f}", f"{rms((np.abs(got['field']) - np.abs(rays))[seen]):.3f}",
                f"{np.abs(got['field'][len(y) // 2]) ** 2:.3f}",
            ])  # fmt: skip
    head = ["design (iv), along x", "wavelength", "scattering width", "extinction less that", "of rays"]
    head += ["path, wave less rays: RMS", "largest", "amplitude: RMS", "power on the axis"]
    table("Design (iv) against rays, 0.5 < |y| < 20 cm (lengths in cm)", head, rows)


def beams():
    """Beams through the devices: place on the line and direction."""
    rows = []
    cases = [
        ("(iii)", Case("cloak", MAGNETIC, 1.0, 0.0, beam=(2.5, 4.0))),
        ("(iii)", Case("mirror", MAGNETIC, 1.0, 0.0, beam=(2.5, 4.0))),
        ("(iii)", Case("cloak", MAGNETIC, 1.0, 10.0, beam=(1.2, 0.0))),
        ("(iii)", Case("mirror", MAGNETIC, 1.0, 10.0, beam=(1.2, 0.0))),
        ("(iv)", Case("cloak", MAGNETIC, 2.0, 0.0, beam=(3.0, 8.0))),
        ("(iv)", Case("cloak", MAGNETIC, 2.0, 10.0, beam=(2.5, 0.0))),
    ]
    for design, case in cases:
        got = solved(design, case)["beam"]
        waist, height = case.beam
        show = case.show
        rays = ray_picture.beam(design, waist, height, PLACES[design][2], case.rotation, show)
        rows.append([
            f"{design} {show}, turned by {case.rotation:g}", f"{case.wavelength:g}", f"{waist:g}", f"{height:g}",
            f"{got[0]:.3f}", f"{rays[0]:.3f}", f"{got[1]:.2f}", f"{rays[1]:.2f}",
        ])  # fmt: skip
    head = ["beam", "wavelength", "waist", "height", "place: wave", "rays", "direction: wave", "rays"]
    table("Mean place (cm) and direction (degrees) of the power behind the device, H_z", head, rows)


def convergence():
    """The same with other elements."""
    rows = []
    cases = [("(iii)", Case("bare", MAGNETIC, 1.0)), ("(iii)", Case("cloak", MAGNETIC, 1.0))]
    cases += [("(iii)", Case("cloak", ELECTRIC, 1.0)), ("(iv)", Case("cloak", MAGNETIC, 4.0))]
    for design, case in cases:
        best = solved(design, replace(case, order=10, size=0.6))
        for size, order in ((1.0, 4), (1.0, 6), (0.8, 8), (0.6, 10)):
            got = solved(design, replace(case, order=order, size=size))
            rows.append([
                f"{design}, {case.polarization}, {case.show}, wavelength {case.wavelength:g}", f"{order}", f"{size:g}",
                f"{int(got['unknowns'])}", f"{got['widths'][0]:.5f}", f"{abs(got['widths'][1] - got['widths'][0]):.0e}",
                f"{rms(got['field'] - best['field']):.0e}" if got["unknowns"] != best["unknowns"] else "",
            ])  # fmt: skip
    head = ["finite elements", "order", "size, wavelengths", "unknowns", "scattering width", "extinction less that"]
    table("Convergence of the finite elements", head + ["RMS change on the line"], rows)


def differences():
    """Meep against the finite elements."""
    rows = []
    plans = [
        ("(iii)", "bare", MAGNETIC, (2, 1), (10, 20)),
        ("(iii)", "bare", ELECTRIC, (2, 1), (10, 20)),
        ("(iii)", "cloak", ELECTRIC, (2, 1), (10, 20, 40)),
        ("(iv)", "cloak", MAGNETIC, (4, 2), (5, 10)),
        ("(iv)", "cloak", ELECTRIC, (4, 2), (5, 10)),
    ]
    for design, show, polarization, wavelengths, resolutions in plans:
        off = {w: [] for w in wavelengths}
        for resolution in resolutions:
            path = cloak.WORK / f"meep {design} {show} {polarization} {resolution}.npz"
            if not path.exists():
                words = [design, show, polarization, resolution, PLACES[design][2], path, *wavelengths]
                script = cloak.ROOT / "benches" / "full_wave" / "finite_difference.py"
                subprocess.run([MEEP, script, *map(str, words)], check=True, stdout=subprocess.DEVNULL)
            got = np.load(path)
            for wavelength, field in zip(got["wavelengths"], got["field"]):
                best = solved(design, Case(show, polarization, float(wavelength)))["field"]
                y, _ = line(design)
                seen = (got["y"] > 0) & (got["y"] < PLACES[design][4])
                off[int(wavelength)].append(rms(field[seen] - np.interp(got["y"][seen], y, best)))
        for wavelength, values in off.items():
            found = ", ".join(f"{v:.3f} (1/{n})" for n, v in zip(resolutions, values))
            rows.append([f"{design}, {polarization}, {show}", f"{wavelength}", found])
    head = ["Meep less finite elements", "wavelength", "RMS (cell, cm)"]
    table("Two solvers: RMS difference of u/u0 on the line", head, rows)


def figures():
    import figures as drawn

    drawn.fields(solved)
    drawn.phases(solved, line)
    drawn.far_field(solved)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--quick", action="store_true", help="no wavelength of 1 cm in design (iv)")
    parser.add_argument("--only", help="some of: square,turned,graded,beams,convergence,meep,figures")
    options = parser.parse_args()
    parts = {"square": square, "turned": turned_square, "graded": lambda: graded(options.quick), "beams": beams}
    parts |= {"convergence": convergence, "meep": differences, "figures": figures}
    for part in options.only.split(",") if options.only else parts:
        parts[part]()


if __name__ == "__main__":
    main()
