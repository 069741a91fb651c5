"""Rays through graded media: Hamilton's equations by DOP853, and Fresnel's at the borders.

With the parameter sigma, ds = n dsigma: r' = p, p' = grad(n^2)/2, the optical path grows by n^2, and the electric field
turns by e' = -(e.grad ln n) p. Media of conformal maps, z = f(zeta) and n = 1/|f'|, carry zeta along:
zeta' = (p_x + i p_y)/f'.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.integrate import solve_ivp
from scipy.special import wofz

TOLERANCE = 3e-14

Array = np.ndarray


class Medium:
    """n^2 and its gradient, at a place and what is carried along there."""

    def start(self, r: Array) -> complex:
        """What is carried along, where a ray begins."""
        return 0j

    def squared(self, r: Array, carried: complex) -> tuple[float, Array]:
        raise NotImplementedError

    def carry(self, p: Array, carried: complex) -> complex:
        return 0j


@dataclass
class Formula(Medium):
    """An index known as a function of the place."""

    of: Callable[[Array], tuple[float, Array]]

    def squared(self, r: Array, carried: complex) -> tuple[float, Array]:
        return self.of(r)


@dataclass
class Gaussian(Medium):
    """f = zeta + i h w_F(zeta/w), w_F the Faddeeva function, above the metal Im zeta = 0."""

    w: float
    h: float

    def derivatives(self, zeta: complex) -> tuple[complex, complex]:
        t = zeta / self.w
        w = wofz(t)
        first = -2 * t * w + 2j / np.sqrt(np.pi)
        second = -2 * w - 2 * t * first
        return 1 + 1j * self.h / self.w * first, 1j * self.h / self.w**2 * second

    def start(self, r: Array) -> complex:
        z = complex(r[0], r[1])
        zeta = z + self.w * self.h / (np.sqrt(np.pi) * z)
        for _ in range(100):
            step = (zeta + 1j * self.h * wofz(zeta / self.w) - z) / self.derivatives(zeta)[0]
            zeta -= step
            if abs(step) < 1e-15 * abs(zeta):
                break
        assert abs(zeta + 1j * self.h * wofz(zeta / self.w) - z) < 1e-13 * abs(z)
        return zeta

    def squared(self, r: Array, carried: complex) -> tuple[float, Array]:
        first, second = self.derivatives(carried)
        n2 = 1 / abs(first) ** 2
        # grad ln n = -conj(f''/f'^2), as x + i y.
        gradient = -2 * n2 * np.conj(second / first**2)
        return n2, np.array([gradient.real, gradient.imag, 0.0])

    def carry(self, p: Array, carried: complex) -> complex:
        return complex(p[0], p[1]) / self.derivatives(carried)[0]


@dataclass
class Border:
    """Where a function vanishes, positive within; a mirror, or a border to air."""

    value: Callable[[Array, complex], float]
    #: The unit normal out of the medium.
    normal: Callable[[Array, complex], Array]
    mirror: bool = False


@dataclass
class Branch:
    position: Array
    wave_vector: Array
    electric: Array
    power: float
    path: float


def fresnel(n1: float, n2: float, normal: Array, p: Array, e: Array) -> list[tuple[bool, Array, Array, float]]:
    """What a wave becomes at a border: (whether it goes on, wave vector, field of unit size, share of the power)."""
    across = p - normal * (p @ normal)
    s = np.cross(normal, across)
    s = s / np.linalg.norm(s) if np.linalg.norm(s) > 1e-12 else np.linalg.svd(normal[None])[2][1]
    c1 = (p @ normal) / n1
    square = 1 - (n1 / n2) ** 2 * (1 - c1**2)
    c2 = np.sqrt(complex(square))
    rs, rp = (n1 * c1 - n2 * c2) / (n1 * c1 + n2 * c2), (n2 * c1 - n1 * c2) / (n2 * c1 + n1 * c2)
    ts, tp = 2 * n1 * c1 / (n1 * c1 + n2 * c2), 2 * n1 * c1 / (n2 * c1 + n1 * c2)
    a, b = s @ e, np.cross(s, p / n1) @ e
    waves = []
    for on, (fs, fp), n, c in [(False, (rs, rp), n1, -c1), (True, (ts, tp), n2, c2.real)]:
        if on and square <= 0:
            continue
        q = across + n * c * normal
        field = fs * a * s + fp * b * np.cross(s, q / n)
        size = np.linalg.norm(field)
        share = size**2 * (n * abs(c)) / (n1 * c1)
        if size > 0:
            waves.append((on, q, field / size, share))
    return waves


Slope = Callable[[float, Array], Array]


def to_border(
    slope: Slope, values: list[Callable[[Array], float]], y: Array, left: int | None = None
) -> tuple[Array, int, float]:
    """From a state to the first at which one of the values, positive before, vanishes; `left` vanishes at the start.

    Gives that state, which value it is, and the parameter.
    """
    settings = {"method": "DOP853", "rtol": TOLERANCE, "atol": TOLERANCE}

    def event(i: int) -> Callable[[float, Array], float]:
        def value(t: float, y: Array) -> float:
            return 1.0 if i == left and t < 1e-6 else values[i](y)

        value.terminal, value.direction = True, -1
        return value

    found = solve_ivp(slope, (0, 1e4), y, events=[event(i) for i in range(len(values))], max_step=2.0, **settings)
    met = next(i for i, times in enumerate(found.t_events) if len(times))
    t = found.t_events[met][0]
    # The event stands on the interpolant; the state there, and what is left to the border, on steps of the method.
    y = solve_ivp(slope, (0, t), y, **settings).y[:, -1]
    for _ in range(4):
        here, h = values[met](y), 1e-6
        step = -here * h / (values[met](y + h * slope(0, y)) - here)
        if abs(step) < 1e-15:
            break
        y = solve_ivp(slope, (0, step), y, **settings).y[:, -1]
        t += step
    return y, met, t


def _unpack(y: Array) -> tuple[Array, Array, Array, complex, float]:
    """Place, wave vector, field, what is carried along, and the optical path."""
    return y[:3], y[3:6], y[6:9] + 1j * y[9:12], complex(y[12], y[13]), y[14]


def _advance(
    medium: Medium, borders: list[Border], branch: Branch, left: Border
) -> tuple[Branch, Border, float, complex]:
    """To the next border; and the index there."""

    def slope(_: float, y: Array) -> Array:
        r, p, e, carried, _ = _unpack(y)
        n2, gradient = medium.squared(r, carried)
        turn = -(e @ gradient) / (2 * n2) * p
        on = medium.carry(p, carried)
        return np.concatenate([p, gradient / 2, turn.real, turn.imag, [on.real, on.imag, n2]])

    def value(border: Border) -> Callable[[Array], float]:
        return lambda y: border.value(y[:3], complex(y[12], y[13]))

    carried = medium.start(branch.position)
    e = branch.electric
    y = np.concatenate([branch.position, branch.wave_vector, e.real, e.imag, [carried.real, carried.imag, branch.path]])
    # By identity: borders hold functions.
    leaving = next(i for i, border in enumerate(borders) if border is left)
    y, met, _ = to_border(slope, [value(border) for border in borders], y, leaving)
    r, p, e, carried, path = _unpack(y)
    n = np.sqrt(medium.squared(r, carried)[0])
    e = e - p * (p @ e) / (p @ p)
    end = Branch(r, p * n / np.linalg.norm(p), e / np.linalg.norm(e), branch.power, path)
    return end, borders[met], n, carried


def trace(medium: Medium, borders: list[Border], entry: Border, branch: Branch, least: float) -> list[Branch]:
    """All leaves of a ray that stands at a border in air, of at least a power."""
    carried = medium.start(branch.position)
    normal = entry.normal(branch.position, carried)
    n = np.sqrt(medium.squared(branch.position, carried)[0])
    leaves: list[Branch] = []
    waiting: list[tuple[Branch, Border]] = []

    def part(branch: Branch, n1: float, n2: float, normal: Array, border: Border, outside: bool) -> None:
        for on, q, e, share in fresnel(n1, n2, normal, branch.wave_vector, branch.electric):
            after = Branch(branch.position, q, e, branch.power * share, branch.path)
            if after.power < least:
                continue
            if on == outside:
                waiting.append((after, border))
            else:
                leaves.append(after)

    part(branch, 1.0, n, -normal, entry, True)
    while waiting:
        branch, left = waiting.pop()
        branch, border, n, carried = _advance(medium, borders, branch, left)
        normal = border.normal(branch.position, carried)
        if border.mirror:
            p, e = branch.wave_vector, branch.electric
            turned = p - 2 * normal * (p @ normal), 2 * normal * (normal @ e) - e
            waiting.append((Branch(branch.position, *turned, branch.power, branch.path), border))
        else:
            part(branch, n, 1.0, normal, border, False)
    return leaves
