"""The extraordinary ray of the cylinder cloaks of uniaxial dielectric, by Hamilton's equations about the axis.

eps_phi = K, eps_r = K s^2, eps_z = K (radial axis) or K s^2 (azimuthal axis), mu = 1; s = (r - a)/r, K = (b/(b - a))^2.
A wave whose E lies in the plane of p and the axis has p_across^2/eps_along + p_along^2/eps_across = 1: twice the
Hamiltonian, whose parameter is then the optical path. L = r p_phi and p_z are kept.
"""

from __future__ import annotations

import numpy as np
from mpmath import mp, mpf

from exact_maps import Oracle, at, onto_round
from graded import to_border
from plane_waves import AIR, Medium, Mode, Vector, added, cross, dot, flux, normal_flux, frame, scaled, scatter, unit
from ray_tree import Leaf, norm


def cloak(inner: float, outer: float, radial: bool, least: float) -> Oracle:
    """What the border reflects, and what the extraordinary wave brings out, at once or after reflections inside."""
    a, b = mpf(inner), mpf(outer)
    k = (b / (b - a)) ** 2

    def local(r: Vector) -> tuple[Medium, Vector, Vector]:
        """The medium at the border, the normal out of it, and the optic axis."""
        out = unit([r[0], r[1], mpf(0)])
        around = [-out[1], out[0], mpf(0)]
        up = [mpf(0), mpf(0), mpf(1)]
        values = [(out, mpf(1)), (around, k), (up, k if radial else mpf(1))]
        eps = tuple(tuple(sum(v * n[i] * n[j] for n, v in values) + mp.mpc(0) for j in range(3)) for i in range(3))
        return Medium(eps, Medium.of(1.0).permeability), out, out if radial else around

    def travel(r: Vector, p: Vector) -> tuple[Vector, Vector, mpf]:
        """From the border to the border: place, wave vector and optical path."""
        size = mp.sqrt(r[0] ** 2 + r[1] ** 2)
        p_r, turn, p_z = (r[0] * p[0] + r[1] * p[1]) / size, float(r[0] * p[1] - r[1] * p[0]), float(p[2])
        kk, aa = float(k), float(a)

        def slope(_: float, y: np.ndarray) -> np.ndarray:
            rho, momentum = y[0], y[1]
            off = rho - aa
            g, dg = (rho**2 / (kk * off**2), -2 * aa * rho / (kk * off**3)) if radial else (1 / kk, 0.0)
            force = turn**2 / (kk * off**3) - p_z**2 * dg / 2
            return np.array([momentum / kk, force, turn / (kk * off**2), p_z * g])

        start = np.array([float(size), float(p_r), float(mp.atan2(r[1], r[0])), float(r[2])])
        end, _, path = to_border(slope, [lambda y: float(b) - y[0]], start, 0)
        out, around = [mpf(np.cos(end[2])), mpf(np.sin(end[2]))], [-mpf(np.sin(end[2])), mpf(np.cos(end[2]))]
        momentum = [mpf(end[1]) * o + mpf(turn) / b * n for o, n in zip(out, around)]
        return [b * out[0], b * out[1], mpf(end[3])], [*momentum, mpf(p_z)], mpf(path)

    def extraordinary(modes: list[Mode], axis: Vector) -> int:
        """Its H is across the axis."""
        return min((0, 1), key=lambda i: abs(dot(modes[i].magnetic, axis)) / norm(modes[i].magnetic))

    def trace(origin: Vector, direction: Vector, electric: Vector) -> list[Leaf]:
        path, _ = onto_round(origin, direction, b, endless=True)
        r = at(origin, direction, path)
        medium, out, axis = local(r)
        normal = scaled(out, -1)
        tangential = added(direction, scaled(normal, -dot(direction, normal)))
        found = scatter(AIR, medium, normal, tangential)
        axes = frame(normal, tangential)
        psi = [dot(x, f) for f in (electric, cross(direction, electric)) for x in axes[:2]]
        come = [normal_flux(psi, own) / normal_flux(own, own) for own in found.incident.tangential]
        carried = -dot(direction, out)
        amplitudes = [row[0] * come[0] + row[1] * come[1] for row in found.amplitudes]

        def leaf(waves: list[Mode], power: mpf) -> Leaf:
            e = added(waves[0].electric, waves[1].electric)
            p = [c.real for c in waves[0].wave_vector]
            return Leaf(r, p, power, path, scaled(e, mp.sqrt(power) / norm(e)))

        def share(waves: list[Mode], over: mpf) -> mpf:
            fields = added(waves[0].electric, waves[1].electric), added(waves[0].magnetic, waves[1].magnetic)
            return abs(dot(flux(*fields), out)) / over

        back = [mode.times(c) for mode, c in zip(found.reflected.modes, amplitudes[:2])]
        leaves = [leaf(back, share(back, carried))]
        which = extraordinary(found.transmitted.modes, axis)
        wave = found.transmitted.modes[which].times(amplitudes[2 + which])
        power = abs(dot(wave.poynting, out)) / carried
        while power > least:
            p = [c.real for c in wave.wave_vector]
            # H stays along p x axis, with its sign.
            across = cross(p, axis)
            along = dot(across, wave.magnetic) / norm(across)
            r, p, on = travel(r, p)
            path += on
            medium, out, axis = local(r)
            found = scatter(medium, AIR, out, added(p, scaled(out, -dot(p, out))))
            which = extraordinary(found.incident.modes, axis)
            mode = found.incident.modes[which]
            across = cross(p, axis)
            c = along / (dot(across, mode.magnetic) / norm(across))
            carried = abs(dot(mode.poynting, out)) * abs(c) ** 2
            amplitudes = [row[which] * c for row in found.amplitudes]
            through = [mode.times(c) for mode, c in zip(found.transmitted.modes, amplitudes[2:])]
            leaves.append(leaf(through, power * share(through, carried)))
            which = extraordinary(found.reflected.modes, axis)
            wave = found.reflected.modes[which].times(amplitudes[which])
            power = power * abs(dot(wave.poynting, out)) / carried
        return sorted((leaf for leaf in leaves if leaf.power > least), key=lambda leaf: -leaf.power)

    return trace
