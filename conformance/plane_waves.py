"""Plane waves in homogeneous media and at plane borders between them, from Maxwell's equations, in 40 digits.

Fields vary as exp(i(k0 p.r - omega t)), with p = k/k0 and the magnetic field times the impedance of vacuum:
p x E = mu H, p x H = -eps E. Of the tangential fields (Ex, Ey, Hx, Hy), z being the normal of a border, Maxwell's
equations leave the eigenproblem of a 4 x 4 matrix, whose eigenvalue is the normal part of p (D. W. Berreman, J. Opt.
Soc. Am. 62, 502 (1972)). Two of its four waves run or decay towards +z, two towards -z.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import lru_cache

from mpmath import mp, mpc, mpf

mp.dps = 40

#: What is one eigenvalue, and what flows nowhere: far above rounding, far below what tells waves apart.
SAME = mpf(10) ** -20
NOTHING = mpf(10) ** -20
SHIFT = mpc("0.37", "0.21")

Vector = list  # three numbers of mpmath
Tensor = tuple  # three rows of three, hashable


def number(value: float | list[float]) -> mpc:
    """A number or a pair [re, im]."""
    return mpc(*value) if isinstance(value, (list, tuple)) else mpc(value)


def tensor(value: float | list) -> Tensor:
    """A tensor from a number, [re, im], or 3 x 3 of either."""
    if isinstance(value, (list, tuple)) and len(value) == 3:
        return tuple(tuple(number(entry) for entry in row) for row in value)
    return tuple(tuple(number(value) if i == j else mpc(0) for j in range(3)) for i in range(3))


@dataclass(frozen=True)
class Medium:
    """A homogeneous medium, by its relative tensors."""

    permittivity: Tensor
    permeability: Tensor

    @staticmethod
    def of(permittivity: float | list, permeability: float | list = 1.0) -> Medium:
        return Medium(tensor(permittivity), tensor(permeability))

    @property
    def is_isotropic(self) -> bool:
        def scalar(t: Tensor) -> bool:
            return all(t[i][j] == (t[0][0] if i == j else 0) for i in range(3) for j in range(3))

        return scalar(self.permittivity) and scalar(self.permeability)

    @property
    def absorbs(self) -> bool:
        tensors = (self.permittivity, self.permeability)
        return any(entry.imag != 0 for t in tensors for row in t for entry in row)


AIR = Medium.of(1.0)


def dot(a: Vector, b: Vector) -> mpc:
    """The sum of products, without conjugation."""
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def cross(a: Vector, b: Vector) -> Vector:
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def scaled(a: Vector, factor: mpc) -> Vector:
    return [factor * c for c in a]


def added(a: Vector, b: Vector) -> Vector:
    return [x + y for x, y in zip(a, b)]


def unit(a: Vector) -> Vector:
    """A real vector of length 1."""
    return scaled(a, 1 / mp.sqrt(dot(a, a)))


def real(values: list[float]) -> Vector:
    return [mpf(value) for value in values]


def flux(electric: Vector, magnetic: Vector) -> Vector:
    """Re(E x H*)."""
    return [c.real for c in cross(electric, [mp.conj(c) for c in magnetic])]


@dataclass
class Mode:
    """A plane wave: vectors of mpmath numbers, of a normal flux of 1 either way where it carries any."""

    wave_vector: Vector
    electric: Vector
    magnetic: Vector
    propagates: bool

    @property
    def poynting(self) -> Vector:
        return flux(self.electric, self.magnetic)

    def times(self, factor: mpc) -> Mode:
        return Mode(self.wave_vector, scaled(self.electric, factor), scaled(self.magnetic, factor), self.propagates)


@dataclass
class Pair:
    """The two waves to one side of a border, and whether they share one wave vector."""

    modes: list[Mode]
    degenerate: bool
    #: (Ex, Ey, Hx, Hy) of each in the frame of the border.
    tangential: list[list[mpc]] = field(default_factory=list)


def frame(normal: Vector, tangential: Vector) -> list[Vector]:
    """Unit vectors x along the tangential wave vector (any where there is none), y = z x x, and the normal z."""
    z = unit(normal)
    along = added(tangential, scaled(z, -dot(tangential, z)))
    if dot(along, along) < NOTHING**2:
        other = real([1, 0, 0]) if abs(z[0]) < 0.9 else real([0, 1, 0])
        along = added(other, scaled(z, -dot(other, z)))
    x = unit(along)
    return [x, cross(z, x), z]


def turned(t: Tensor, axes: list[Vector]) -> list[list[mpc]]:
    """A tensor in a frame."""
    on = [[dot(t[i], axis) for i in range(3)] for axis in axes]
    return [[dot(axis, column) for column in on] for axis in axes]


def delta_matrix(eps: list, mu: list, k: mpf) -> list[list[mpc]]:
    """Berreman's matrix of (Ex, Ey, Hx, Hy), for p = (k, 0, p_z)."""
    columns = []
    for basis in range(4):
        ex, ey, hx, hy = (mpc(int(basis == i)) for i in range(4))
        ez = (-k * hy - eps[2][0] * ex - eps[2][1] * ey) / eps[2][2]
        hz = (k * ey - mu[2][0] * hx - mu[2][1] * hy) / mu[2][2]
        d = [dot(eps[i], [ex, ey, ez]) for i in range(2)]
        b = [dot(mu[i], [hx, hy, hz]) for i in range(2)]
        # p x E = B and p x H = -D, solved for p_z times each tangential field.
        columns.append([b[1] + k * ez, -b[0], k * hz - d[1], d[0]])
    return [[columns[j][i] for j in range(4)] for i in range(4)]


def product(a: list[list[mpc]], b: list[list[mpc]]) -> list[list[mpc]]:
    return [[sum(a[i][l] * b[l][j] for l in range(4)) for j in range(4)] for i in range(4)]


def normal_flux(a: list[mpc], b: list[mpc]) -> mpc:
    """The flux along z that the tangential fields of two waves carry together; linear in the first."""
    cross_flux = a[0] * mp.conj(b[3]) - a[1] * mp.conj(b[2])
    return (cross_flux + mp.conj(b[0]) * a[3] - mp.conj(b[1]) * a[2]) / 2


def eigenspaces(m: list[list[mpc]]) -> list[tuple[mpc, list, list[list[mpc]]]]:
    """The distinct eigenvalues of a diagonalizable 4 x 4 matrix, each with its projector and a basis of its eigenspace."""
    # Eigenvalues of opposite signs stall the QR steps, so all are shifted.
    shifted = mp.matrix(m) + SHIFT * mp.eye(4)
    values = [value - SHIFT for value in mp.eig(shifted, left=False, right=False)]
    groups: list[list[mpc]] = []
    for value in values:
        near = [group for group in groups if abs(group[0] - value) < SAME * (1 + abs(value))]
        near[0].append(value) if near else groups.append([value])
    means = [sum(group) / len(group) for group in groups]
    spaces = []
    for group, value in zip(groups, means):
        # The projector onto the eigenspace is a product over the other eigenvalues.
        projector = [[mpc(int(i == j)) for j in range(4)] for i in range(4)]
        for other in means:
            if other is not value:
                shifted = [[(m[i][j] - other * (i == j)) / (value - other) for j in range(4)] for i in range(4)]
                projector = product(projector, shifted)
        columns = [[projector[i][j] for i in range(4)] for j in range(4)]
        basis: list[list[mpc]] = []
        for _ in group:
            # The longest column, then what is longest across it.
            longest = max(columns, key=lambda c: sum(abs(entry) ** 2 for entry in c))
            size = mp.sqrt(sum(abs(entry) ** 2 for entry in longest))
            basis.append([entry / size for entry in longest])
            along = [sum(mp.conj(b) * c for b, c in zip(basis[-1], column)) for column in columns]
            columns = [[c - a * b for b, c in zip(basis[-1], column)] for a, column in zip(along, columns)]
        spaces.append((value, projector, basis))
    return spaces


@lru_cache(maxsize=100_000)
def _waves(medium: Medium, normal: tuple, tangential: tuple) -> tuple[Pair, Pair]:
    axes = frame(list(normal), list(tangential))
    k = dot(list(tangential), axes[0])
    eps, mu = turned(medium.permittivity, axes), turned(medium.permeability, axes)
    sides: dict[int, list] = {1: [], -1: []}
    for value, _, basis in eigenspaces(delta_matrix(eps, mu, k)):
        if len(basis) == 2 and medium.is_isotropic:
            # s, whose field is across the plane of incidence, then p.
            a, b = basis
            s = [b[0] * x - a[0] * y for x, y in zip(a, b)]
            p = [b[1] * x - a[1] * y for x, y in zip(a, b)]
            basis = [s, p]
        elif len(basis) == 2:
            a, b = basis
            along = normal_flux(b, a) / normal_flux(a, a)
            basis = [a, [y - along * x for x, y in zip(a, b)]]
        for psi in basis:
            size = sum(abs(entry) ** 2 for entry in psi)
            carried = normal_flux(psi, psi).real / size
            decays = abs(value.imag) > NOTHING * (1 + abs(value))
            propagates = abs(carried) > NOTHING and (medium.absorbs or not decays)
            side = (1 if value.imag > 0 else -1) if decays else (1 if carried > 0 else -1)
            assert decays or propagates, "grazing: no direction"
            psi = [entry / mp.sqrt(size * abs(carried) if propagates else size) for entry in psi]
            sides[side].append((value, psi, propagates))
    both = []
    for side in (1, -1):
        modes, tangentials = [], []
        assert len(sides[side]) == 2, "no two waves to each side"
        for value, psi, propagates in sides[side]:
            ex, ey, hx, hy = psi
            ez = (-k * hy - eps[2][0] * ex - eps[2][1] * ey) / eps[2][2]
            hz = (k * ey - mu[2][0] * hx - mu[2][1] * hy) / mu[2][2]

            def world(local: Vector) -> Vector:
                return [sum(axes[j][i] * local[j] for j in range(3)) for i in range(3)]

            modes.append(Mode(world([k, 0, value]), world([ex, ey, ez]), world([hx, hy, hz]), propagates))
            tangentials.append(psi)
        degenerate = abs(sides[side][0][0] - sides[side][1][0]) < SAME
        both.append(Pair(modes, degenerate, tangentials))
    return both[0], both[1]


def waves(medium: Medium, normal: Vector, tangential: Vector) -> tuple[Pair, Pair]:
    """The waves of a tangential wave vector that run or decay along a normal, and those against it."""
    return _waves(medium, tuple(normal), tuple(tangential))


@dataclass
class Scattering:
    """What the waves that come to a border become: amplitudes by rows (outgoing) and columns (incident)."""

    incident: Pair
    reflected: Pair
    transmitted: Pair | None
    amplitudes: list[list[mpc]]


def scatter(here: Medium, beyond: Medium | None, normal: Vector, tangential: Vector) -> Scattering:
    """Continuity of the tangential fields; at metal (no medium beyond) the tangential electric field vanishes."""
    onward, backward = waves(here, normal, tangential)
    if beyond is None:
        system = mp.matrix([[psi[i] for psi in backward.tangential] for i in range(2)])
        through = None
        rows = range(2)
    else:
        through, _ = waves(beyond, normal, tangential)
        rows = range(4)
        system = mp.matrix(
            [[psi[i] for psi in backward.tangential] + [-psi[i] for psi in through.tangential] for i in rows]
        )
    columns = [mp.lu_solve(system, mp.matrix([-psi[i] for i in rows])) for psi in onward.tangential]
    amplitudes = [[column[i] for column in columns] for i in rows]
    return Scattering(onward, backward, through, amplitudes)
