#!/usr/bin/python3
"""The same waves by finite differences in time (Meep), for comparison: the field on a line behind the device.

Run by the system's Python, for which Debian has Meep (python3-meep):

    finite_difference.py DESIGN SHOW POLARIZATION RESOLUTION LINE OUTPUT WAVELENGTH...

The field is relative to that of the empty view on the same grid. With E along z and an anisotropic permeability
the dual problem is computed, which has the same equations: H along z, the permeability in the place of the
permittivity, and a perfect magnetic conductor for metal.
"""

import sys

import meep as mp
import numpy as np

import device as cloak


def prism(corners, material):
    return mp.Prism([mp.Vector3(*map(float, c)) for c in corners], height=mp.inf, material=material)


def medium(eps, mu):
    """Permittivity in the plane and permeability along z are what matters for H along z."""
    return mp.Medium(
        epsilon_diag=(eps[0, 0], eps[1, 1], eps[2, 2]),
        epsilon_offdiag=(eps[0, 1], 0, 0),
        mu_diag=(1, 1, mu[2, 2]),
    )


def graded(device):
    gx, gy, values = device.grid
    low, high = values.min(), values.max()
    size = [len(axis) * (axis[1] - axis[0]) for axis in (gx, gy)]
    weights = mp.MaterialGrid(
        mp.Vector3(*values.shape), mp.Medium(epsilon=low), mp.Medium(epsilon=high),
        weights=(values - low) / (high - low), do_averaging=False,
    )  # fmt: skip
    return mp.Block(size=mp.Vector3(*size, mp.inf), material=weights)


def solve(device, show, polarization, resolution, line, wavelengths, reach):
    electric = polarization == "E_z"
    dual = electric and bool(device.segments)
    metal = mp.perfect_magnetic_conductor if dual else mp.metal
    geometry = []
    if show == "cloak" and device.segments:
        geometry += [prism(c, medium(mu, eps) if dual else medium(eps, mu)) for c, eps, mu in device.segments]
    elif show == "cloak":
        geometry.append(graded(device))
    if show != "empty":
        geometry.append(prism(device.metal, metal))
    direct = electric and not dual
    source, component, phase = (mp.Ez, mp.Ez, 1) if direct else (mp.Ey, mp.Hz, -1)
    absorber = 1.2 * max(wavelengths)
    cell = mp.Vector3(2 * (reach + absorber) + 2, 2 * (reach + absorber))
    low, high = 1 / max(wavelengths), 1 / min(wavelengths)
    pulse = mp.GaussianSource((low + high) / 2, fwidth=max(1.6 * (high - low), 0.2 * high), is_integrated=True)
    simulation = mp.Simulation(
        resolution=resolution, cell_size=cell, geometry=geometry, Courant=0.4,
        boundary_layers=[mp.PML(absorber)], k_point=mp.Vector3(),
        sources=[
            mp.Source(pulse, source, center=mp.Vector3(-reach - 0.5), size=mp.Vector3(0, cell.y))
        ],
        symmetries=[mp.Mirror(mp.Y, phase=phase)],
    )  # fmt: skip
    middle = mp.Vector3(line, reach / 2)
    monitor = simulation.add_dft_fields(
        [component], [1 / w for w in wavelengths], center=middle, size=mp.Vector3(0, reach)
    )
    simulation.run(until_after_sources=6 * reach)
    (_, y, _, _) = simulation.get_array_metadata(dft_cell=monitor)
    fields = np.array([simulation.get_dft_array(monitor, component, i) for i in range(len(wavelengths))])
    return np.array(y), fields


def main():
    mp.verbosity(0)
    design, show, polarization, resolution, line, output, *wavelengths = sys.argv[1:]
    wavelengths = [float(w) for w in wavelengths]
    device = cloak.load(design)
    reach = float(np.ceil(np.abs(device.outline).max())) + 3
    arguments = (polarization, float(resolution), float(line), wavelengths, reach)
    y, empty = solve(device, "empty", *arguments)
    y, fields = solve(device, show, *arguments)
    np.savez(output, y=y, field=fields / empty, wavelengths=wavelengths)


if __name__ == "__main__":
    main()
