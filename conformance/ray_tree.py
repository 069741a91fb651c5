"""Rays through homogeneous media with plane and round faces: every border splits a wave by `plane_waves.scatter`.

A branch runs along Re(E x H*); its optical path grows by p.dr, its power is shared by the normal fluxes.
"""

from __future__ import annotations

from dataclasses import dataclass

from mpmath import mp, mpc, mpf

from plane_waves import AIR, Medium, Vector, added, cross, dot, flux, normal_flux, frame, real, scaled, scatter, unit

#: Nothing in a file is nearer to an edge, cm.
EDGE = mpf(10) ** -6


#: How many borders the branches of a ray may come to.
MOST_EVENTS = 200


class Trapped(Exception):
    """Light is held by total reflection for too long."""


@dataclass
class Face:
    """Where (r - c).Q(r - c) + n.r = d, Q being 1 on the axes that curve; outside it is positive."""

    beyond: int | None
    """The cell beyond, -1 for air, None for metal."""
    normal: Vector
    distance: mpf
    curved: tuple[int, int, int] = (0, 0, 0)

    def value(self, r: Vector) -> mpf:
        return sum(q * c * c for q, c in zip(self.curved, r)) + dot(self.normal, r) - self.distance

    def outward(self, r: Vector) -> Vector:
        return unit([2 * q * c + n for q, c, n in zip(self.curved, r, self.normal)])

    def crossings(self, r: Vector, d: Vector) -> list[mpf]:
        a = sum(q * c * c for q, c in zip(self.curved, d))
        b = 2 * sum(q * c * e for q, c, e in zip(self.curved, r, d)) + dot(self.normal, d)
        c = self.value(r)
        if a == 0:
            return [] if b == 0 else [-c / b]
        square = b * b - 4 * a * c
        return [] if square < 0 else [(-b - mp.sqrt(square)) / (2 * a), (-b + mp.sqrt(square)) / (2 * a)]


def plane(beyond: int | None, normal: list, distance: float | mpf) -> Face:
    size = mp.sqrt(sum(mpf(n) ** 2 for n in normal))
    return Face(beyond, [mpf(n) / size for n in normal], mpf(distance) / size)


def sphere(radius: float) -> Face:
    return Face(-1, real([0, 0, 0]), mpf(radius) ** 2, (1, 1, 1))


def cylinder(radius: float) -> Face:
    return Face(-1, real([0, 0, 0]), mpf(radius) ** 2, (1, 1, 0))


def side(beyond: int | None, start: list, end: list, inner: list) -> Face:
    """The plane through two points of the cross-section, along z; `inner` is a point on its inside."""
    normal = [end[1] - start[1], start[0] - end[0], 0]
    distance = normal[0] * start[0] + normal[1] * start[1]
    if normal[0] * inner[0] + normal[1] * inner[1] > distance:
        normal, distance = [-n for n in normal], -distance
    return plane(beyond, normal, distance)


@dataclass
class Cell:
    """A convex part of a device, filled with one medium."""

    medium: Medium
    faces: list[Face]


@dataclass
class Leaf:
    position: Vector
    direction: Vector
    power: mpf
    optical_path: mpf
    electric: Vector

    def written(self) -> dict:
        return {
            "position": self.position,
            "direction": self.direction,
            "power": self.power,
            "optical_path": self.optical_path,
            "electric_field": self.electric and [mpc(c) for c in self.electric],
        }


@dataclass
class Branch:
    cell: int
    position: Vector
    wave_vector: Vector
    electric: Vector
    magnetic: Vector
    power: mpf
    optical_path: mpf


def norm(v: Vector) -> mpf:
    return mp.sqrt(sum(abs(c) ** 2 for c in v))


def _waves_out(amplitudes: list[mpc], pair) -> list[tuple[Vector, Vector, Vector]]:
    """The waves to one side: two, or one with the fields of both."""
    waves = [mode.times(a) for mode, a in zip(pair.modes, amplitudes)]
    travelling = [w for w in waves if w.propagates]
    if pair.degenerate and len(travelling) == 2:
        a, b = travelling
        return [(a.wave_vector, added(a.electric, b.electric), added(a.magnetic, b.magnetic))]
    return [(w.wave_vector, w.electric, w.magnetic) for w in travelling]


def trace(cells: list[Cell], origin: Vector, direction: Vector, electric: Vector, least: float) -> list[Leaf]:
    """All leaves of a ray in the device's frame, from branches of at least a power."""

    def along(branch: Branch, faces: list[Face], inside: bool) -> tuple[mpf, Face, Vector] | None:
        """The way to the border of a cell, from within or from outside."""
        d = unit(flux(branch.electric, branch.magnetic))
        best = None
        for face in faces:
            for t in face.crossings(branch.position, d):
                if t < EDGE:
                    continue
                r = added(branch.position, scaled(d, t))
                falls = dot(face.outward(r), d)
                others = [other.value(r) for other in faces if other is not face]
                if (falls > 0) == inside and all(v < EDGE for v in others) and (best is None or t < best[0]):
                    assert all(v < -EDGE for v in others), "at an edge"
                    best = (t, face, r)
        return best

    start = Branch(-1, origin, direction, electric, cross(direction, electric), mpf(1), mpf(0))
    first = []
    for index, cell in enumerate(cells):
        met = along(start, cell.faces, False)
        if met is not None and met[1].beyond == -1:
            first.append((met[0], index, met))
    if not first:
        return []
    leaves: list[Leaf] = []
    open_branches: list[Branch] = []

    def split(branch: Branch, t: mpf, face: Face, r: Vector, beyond: int | None, normal: Vector) -> None:
        p = [c.real for c in branch.wave_vector]
        path = branch.optical_path + dot(p, added(r, scaled(branch.position, -1)))
        tangential = added(p, scaled(normal, -dot(p, normal)))
        medium = AIR if branch.cell == -1 else cells[branch.cell].medium
        there = None if beyond is None else (AIR if beyond == -1 else cells[beyond].medium)
        found = scatter(medium, there, normal, tangential)
        x, y, z = frame(normal, tangential)
        psi = [dot(axis, f) for f in (branch.electric, branch.magnetic) for axis in (x, y)]
        pair = found.incident
        come = [
            normal_flux(psi, own) / normal_flux(own, own) if mode.propagates else mpc(0)
            for mode, own in zip(pair.modes, pair.tangential)
        ]
        carried = dot(flux(branch.electric, branch.magnetic), normal)
        out = [row[0] * come[0] + row[1] * come[1] for row in found.amplitudes]
        sides = [(branch.cell, found.reflected, out[:2])]
        if found.transmitted is not None:
            sides.append((beyond, found.transmitted, out[2:]))
        for cell, pair, amplitudes in sides:
            for wave_vector, e, h in _waves_out(amplitudes, pair):
                power = branch.power * abs(dot(flux(e, h), normal)) / carried
                if power < least:
                    continue
                if cell == -1:
                    leaves.append(
                        Leaf(r, [c.real for c in wave_vector], power, path, scaled(e, mp.sqrt(power) / norm(e)))
                    )
                else:
                    open_branches.append(Branch(cell, r, wave_vector, e, h, power, path))

    _, index, (t, face, r) = min(first, key=lambda item: item[0])
    split(start, t, face, r, index, scaled(face.outward(r), -1))
    events = 0
    while open_branches:
        events += 1
        if events > MOST_EVENTS:
            raise Trapped
        branch = open_branches.pop()
        t, face, r = along(branch, cells[branch.cell].faces, True)
        split(branch, t, face, r, face.beyond, face.outward(r))
    return leaves


def merged(leaves: list[Leaf], above: float) -> list[Leaf]:
    """Leaves strongest first, those that coincide with their powers added; and only those above a power."""
    groups: list[list[Leaf]] = []
    for leaf in sorted(leaves, key=lambda leaf: -leaf.power):
        for group in groups:
            other = group[0]
            apart = [
                norm(added(leaf.position, scaled(other.position, -1))),
                norm(added(leaf.direction, scaled(other.direction, -1))),
                abs(leaf.optical_path - other.optical_path),
            ]
            if max(apart) < 1e-9:
                group.append(leaf)
                break
        else:
            groups.append([leaf])
    found = []
    for group in groups:
        power = sum(leaf.power for leaf in group)
        if power > above:
            first = group[0]
            electric = first.electric if len(group) == 1 else None
            found.append(Leaf(first.position, first.direction, power, first.optical_path, electric))
    return sorted(found, key=lambda leaf: -leaf.power)
