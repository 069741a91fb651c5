"""Devices whose rays are known in closed form: cloaks that are transformations, balls of graded index, a ball of glass.

All functions take a ray in the device's frame, in numbers of mpmath, and give its leaves; outside of maps fields are
those of empty space.
"""

from __future__ import annotations

from collections.abc import Callable

from mpmath import mp, mpf

from plane_waves import Vector, added, cross, dot, scaled, unit
from ray_tree import Leaf, norm

#: From the origin, direction and electric field of a ray to its leaves.
Oracle = Callable[[Vector, Vector, Vector], list[Leaf]]


def onto_round(origin: Vector, direction: Vector, radius: mpf, endless: bool = False) -> tuple[mpf, mpf] | None:
    """Where a ray enters and leaves a ball, or a cylinder along z."""
    o, d = (origin[:2], direction[:2]) if endless else (origin, direction)
    a, b = sum(c * c for c in d), sum(x * y for x, y in zip(o, d))
    square = b * b - a * (sum(c * c for c in o) - radius**2)
    return None if square <= 0 else ((-b - mp.sqrt(square)) / a, (-b + mp.sqrt(square)) / a)


def at(origin: Vector, direction: Vector, t: mpf) -> Vector:
    return added(origin, scaled(direction, t))


def round_cloak(outer: float, endless: bool) -> Oracle:
    """The cylinder and the sphere that open the axis or the centre: outside nothing has changed."""

    def trace(origin: Vector, direction: Vector, electric: Vector) -> list[Leaf]:
        _, t = onto_round(origin, direction, mpf(outer), endless)
        return [Leaf(at(origin, direction, t), direction, mpf(1), t, electric)]

    return trace


def square_cloak(side: float) -> Oracle:
    """Design (iii): a flat mirror strip along a diagonal of the square, from which rays are reflected once."""
    d = mpf(side) / mp.sqrt(2)

    def out(origin: Vector, direction: Vector) -> mpf:
        """The way out of |x| + |y| < d."""
        last = None
        for sx in (1, -1):
            for sy in (1, -1):
                speed = sx * direction[0] + sy * direction[1]
                if speed > 0:
                    t = (d - sx * origin[0] - sy * origin[1]) / speed
                    last = t if last is None else min(last, t)
        return last

    def trace(origin: Vector, direction: Vector, electric: Vector) -> list[Leaf]:
        path = mpf(0)
        if direction[1] != 0:
            t = -origin[1] / direction[1]
            hit = at(origin, direction, t)
            if t > 0 and abs(hit[0]) < d:
                origin, path = hit, t
                direction = [direction[0], -direction[1], direction[2]]
                electric = [-electric[0], electric[1], -electric[2]]
        t = out(origin, direction)
        return [Leaf(at(origin, direction, t), direction, mpf(1), path + t, electric)]

    return trace


def _turned_along(electric: Vector, before: Vector, after: Vector, axis: Vector) -> Vector:
    """The field of a ray that has stayed in the plane across `axis`."""
    s, p = dot(axis, electric), dot(cross(axis, before), electric)
    return added(scaled(axis, s), scaled(cross(axis, after), p))


def _central(radius: float, leave: Callable[[Vector, Vector, Vector], tuple[Vector, Vector, mpf]]) -> Oracle:
    def trace(origin: Vector, direction: Vector, electric: Vector) -> list[Leaf]:
        t, _ = onto_round(origin, direction, mpf(radius))
        x = scaled(at(origin, direction, t), 1 / mpf(radius))
        axis = unit(cross(x, direction))
        position, after, path = leave(x, direction, axis)
        electric = _turned_along(electric, direction, after, axis)
        return [Leaf(scaled(position, mpf(radius)), after, mpf(1), t + mpf(radius) * path, electric)]

    return trace


def eaton(radius: float, turn: mpf) -> Oracle:
    """The balls that turn every ray by one angle towards the centre; the path is longer than the chord by as much."""

    def leave(x: Vector, d: Vector, axis: Vector) -> tuple[Vector, Vector, mpf]:
        chord = -2 * dot(x, d)

        def turned(v: Vector) -> Vector:
            return added(scaled(v, mp.cos(turn)), scaled(cross(axis, v), mp.sin(turn)))

        return turned(at(x, d, chord)), turned(d), chord + turn

    return _central(radius, leave)


def luneburg(radius: float) -> Oracle:
    return _central(radius, lambda x, d, axis: (d, scaled(x, -1), mp.pi / 2 - dot(x, d)))


def fisheye(radius: float) -> Oracle:
    def leave(x: Vector, d: Vector, axis: Vector) -> tuple[Vector, Vector, mpf]:
        return scaled(x, -1), added(scaled(x, 2 * dot(d, x)), scaled(d, -1)), mp.pi

    return _central(radius, leave)


def glass_ball(radius: float, index: float, least: float) -> Oracle:
    """Descartes's rays, with Fresnel's amplitudes, s and p apart."""
    r, n = mpf(radius), mpf(index)

    def trace(origin: Vector, direction: Vector, electric: Vector) -> list[Leaf]:
        t, _ = onto_round(origin, direction, r)
        x = scaled(at(origin, direction, t), 1 / r)
        cos = -dot(x, direction)
        y = unit(added(direction, scaled(x, cos)))
        axis = cross(x, y)
        sin = mp.sqrt(1 - cos**2)
        inside = mp.sqrt(1 - (sin / n) ** 2)
        # Reflection outside and inside, into the ball and out of it.
        rs, rp = (cos - n * inside) / (cos + n * inside), (n * cos - inside) / (n * cos + inside)
        ts = 2 * cos / (cos + n * inside) * 2 * n * inside / (cos + n * inside)
        tp = 2 * cos / (n * cos + inside) * 2 * n * inside / (n * cos + inside)
        s, p = dot(axis, electric), dot(cross(axis, direction), electric)
        leaves = []
        turn = mp.pi - 2 * mp.asin(sin / n)
        for chords in range(100):
            a, b = (s * rs, p * rp) if chords == 0 else (s * ts * (-rs) ** (chords - 1), p * tp * (-rp) ** (chords - 1))
            power = abs(a) ** 2 + abs(b) ** 2
            if power < least:
                break
            angle = chords * turn
            up = added(scaled(x, mp.cos(angle)), scaled(y, mp.sin(angle)))
            on = added(scaled(x, -mp.sin(angle)), scaled(y, mp.cos(angle)))
            after = added(scaled(up, cos), scaled(on, sin))
            field = added(scaled(axis, a), scaled(cross(axis, after), b))
            path = t + chords * 2 * n * r * inside
            leaves.append(Leaf(scaled(up, r), after, power, path, scaled(field, mp.sqrt(power) / norm(field))))
        return sorted(leaves, key=lambda leaf: -leaf.power)

    return trace


def absorbing_slab(thickness: float, permittivity: list[float], wavelength_nm: float, least: float) -> Oracle:
    """The partial waves of Airy's sum, for a slab across x and light along x."""
    n, d = mp.sqrt(mp.mpc(*permittivity)), mpf(thickness)
    r, through = (1 - n) / (1 + n), 4 * n / (1 + n) ** 2
    decay = mp.exp(-2 * mp.pi / (wavelength_nm * mpf(10) ** -7) * n.imag * d)

    def trace(origin: Vector, direction: Vector, electric: Vector) -> list[Leaf]:
        assert direction == [1, 0, 0]
        path = -d / 2 - origin[0]
        leaves = []
        for passes in range(100):
            amplitude = r if passes == 0 else through * (-r) ** (passes - 1) * decay**passes
            power = abs(amplitude) ** 2
            if power < least:
                break
            on = 1 if passes % 2 == 1 else -1
            place = [on * d / 2, origin[1], origin[2]]
            leaves.append(Leaf(place, [on, 0, 0], power, path + passes * n.real * d, scaled(electric, amplitude)))
        return sorted(leaves, key=lambda leaf: -leaf.power)

    return trace


def polarizer(angle: float) -> Oracle:
    """A sheet across x that passes the field along its axis, at an angle from z towards y, projected across the ray."""
    sin, cos = mp.sin(mp.radians(angle)), mp.cos(mp.radians(angle))

    def trace(origin: Vector, direction: Vector, electric: Vector) -> list[Leaf]:
        t = -origin[0] / direction[0]
        axis = [mpf(0), sin, cos]
        axis = unit(added(axis, scaled(direction, -dot(axis, direction))))
        passed = dot(axis, electric)
        return [Leaf(at(origin, direction, t), direction, abs(passed) ** 2, t, scaled(axis, passed))]

    return trace
