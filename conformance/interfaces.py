"""`interfaces.json`: light at plane borders between two media."""

from __future__ import annotations

import math
import random

from mpmath import mp, mpc

from plane_waves import Medium, Mode, Pair, added, cross, dot, flux, frame, real, scaled, scatter
from write import plain

ABOUT = {
    "title": "Light at a plane border between two media",
    "conventions": "exp(i(k0 p.r - omega t)); p = k/k0; magnetic fields times the vacuum impedance; complex: [re, im]",
    "tolerance": {"wave_vector": 1e-12, "poynting": 1e-11, "power": 1e-12, "response": 1e-11},
}


def _mode(mode: Mode) -> dict:
    poynting = mode.poynting if mode.propagates else None
    return {"wave_vector": mode.wave_vector, "poynting": poynting, "propagating": mode.propagates}


def _order(pair: Pair, medium: Medium, axis: list[float] | None) -> list[int]:
    """Which of two modes comes first: s, the ordinary one, or that of the smaller |p|."""
    if pair.degenerate:
        return [0, 1]
    if axis is not None:
        # The ordinary wave of an electric crystal has no E along the axis, of a magnetic one no H.
        magnetic = any(medium.permeability[i][j] != 0 for i in range(3) for j in range(3) if i != j)
        magnetic |= len({medium.permeability[i][i] for i in range(3)}) > 1
        fields = [mode.magnetic if magnetic else mode.electric for mode in pair.modes]
        along = [abs(dot(f, real(axis))) / mp.sqrt(sum(abs(c) ** 2 for c in f)) for f in fields]
        return sorted(range(2), key=lambda i: along[i])
    return sorted(range(2), key=lambda i: sum(abs(c) ** 2 for c in pair.modes[i].wave_vector))


def _ordered(pair: Pair, order: list[int]) -> Pair:
    return Pair([pair.modes[i] for i in order], pair.degenerate, [pair.tangential[i] for i in order])


def solve(request: dict, axes: list) -> dict:
    """What must come of an interface; `axes` are the optic axes of the two media, where they are uniaxial."""
    metal = request["transmitted"] == "metal"
    here = Medium.of(**request["incident"])
    beyond = None if metal else Medium.of(**request["transmitted"])
    normal, tangential = real(request["normal"]), real(request["tangential"])
    found = scatter(here, beyond, normal, tangential)
    orders = [
        _order(pair, medium, axis)
        for pair, medium, axis in [(found.incident, here, axes[0]), (found.reflected, here, axes[0])]
    ]
    incident, reflected = _ordered(found.incident, orders[0]), _ordered(found.reflected, orders[1])
    rows = [found.amplitudes[i] for i in orders[1]]
    outgoing = [reflected]
    if beyond is not None:
        order = _order(found.transmitted, beyond, axes[1])
        transmitted = _ordered(found.transmitted, order)
        rows += [found.amplitudes[2 + i] for i in order]
        outgoing.append(transmitted)
    amplitudes = [[row[i] for i in orders[0]] for row in rows]
    x, y, z = frame(normal, tangential)

    def total(pair: Pair, first: int, column: int) -> list[mpc]:
        """The fields of the waves to one side, added."""
        parts = [pair.modes[i].times(amplitudes[first + i][column]) for i in range(2)]
        return [added(parts[0].electric, parts[1].electric), added(parts[0].magnetic, parts[1].magnetic)]

    shares, totals = [], [[], []]
    for column in range(2):
        carried = incident.modes[column].propagates
        for side, pair in enumerate(outgoing):
            fields = total(pair, 2 * side, column)
            totals[side].append(abs(dot(flux(*fields), z)) if carried else None)
    if metal:
        totals[1] = [0.0 if carried is not None else None for carried in totals[0]]
    for row in range(len(amplitudes)):
        mode = outgoing[row // 2].modes[row % 2]
        shares.append(
            [
                (
                    (abs(amplitudes[row][column]) ** 2 if mode.propagates else 0.0)
                    if incident.modes[column].propagates
                    else None
                )
                for column in range(2)
            ]
        )
    # Of two waves that share a wave vector, or of s and p where there is no plane of incidence, each says nothing.
    at_normal = dot(tangential, tangential) == 0

    def told(pair: Pair, medium: Medium) -> bool:
        return not pair.degenerate or (medium.is_isotropic and not at_normal)

    sides = [(incident, here), (reflected, here)] + ([] if metal else [(transmitted, beyond)])
    known = [told(pair, medium) for pair, medium in sides]
    # The field beyond as a linear function of the tangential part of the field that comes.
    e = [mode.electric for mode in incident.modes]
    tangents = mp.matrix([[dot(x, e[0]), dot(x, e[1])], [dot(y, e[0]), dot(y, e[1])]])
    inverse = mp.inverse(tangents)

    def response(pair: Pair, first: int) -> list[list[mpc]]:
        columns = [total(pair, first, column)[0] for column in range(2)]
        local = [[columns[0][i] * inverse[0, j] + columns[1][i] * inverse[1, j] for j in range(2)] for i in range(3)]
        return [[local[i][0] * x[j] + local[i][1] * y[j] for j in range(3)] for i in range(3)]

    expected = {
        "incident": [_mode(mode) for mode in incident.modes],
        "reflected": [_mode(mode) for mode in reflected.modes],
        "transmitted": [] if metal else [_mode(mode) for mode in transmitted.modes],
        "power": shares if all(known) else None,
        "total_reflected": totals[0] if known[0] else None,
        "total_transmitted": totals[1] if known[0] else None,
        "reflection": response(reflected, 0),
        "transmission": None if metal else response(transmitted, 2),
    }
    return plain(expected)


# Media: what stands in a request, and the optic axis of what is uniaxial.


def isotropic(permittivity: float | list, permeability: float | list = 1.0) -> tuple[dict, None]:
    return {"permittivity": permittivity, "permeability": permeability}, None


def _about(axis: list[float], across: float, along: float) -> list:
    return [[across * (i == j) + (along - across) * axis[i] * axis[j] for j in range(3)] for i in range(3)]


class Draws:
    """What is drawn by chance, the same at each run."""

    def __init__(self, seed: int) -> None:
        self.random = random.Random(seed)

    def between(self, low: float, high: float) -> float:
        return round(low + (high - low) * self.random.random(), 4)

    def axis(self) -> list[float]:
        z, angle = 2 * self.random.random() - 1, math.tau * self.random.random()
        across = math.sqrt(1 - z * z)
        return [across * math.cos(angle), across * math.sin(angle), z]

    def uniaxial(self, low: float, high: float) -> tuple[list, list[float]]:
        axis = self.axis()
        across = self.between(low, high)
        along = across * self.between(1.05, 1.6) ** (1 if self.random.random() < 0.5 else -1)
        return _about(axis, across, round(along, 4)), axis

    def principal(self, values: list[float]) -> list:
        """A tensor of principal values along axes of chance, rounded, so symmetric to the last digit."""
        z = self.axis()
        other = self.axis()
        x = [a - dot(other, z) * b for a, b in zip(other, z)]
        x = [float(a) for a in scaled(x, 1 / math.sqrt(sum(a * a for a in x)))]
        y = [float(a) for a in cross(z, x)]
        axes = [x, y, z]
        return [[round(sum(v * a[i] * a[j] for v, a in zip(values, axes)), 6) for j in range(3)] for i in range(3)]

    def biaxial(self, low: float, high: float) -> list:
        step = (high - low) / 3
        return self.principal([self.between(low + i * step, low + (i + 0.7) * step) for i in range(3)])

    def lossy(self, tensor: list, low: float, high: float) -> list:
        loss = self.biaxial(low, high)
        return [[[tensor[i][j], loss[i][j]] for j in range(3)] for i in range(3)]

    def border(self, largest: float, smallest: float = 0.05) -> tuple[list[float], list[float]]:
        """A unit normal, and a vector across it."""
        normal = self.axis()
        other = self.axis()
        across = [float(a) for a in cross(normal, other)]
        size = math.sqrt(sum(a * a for a in across))
        length = smallest + (largest - smallest) * self.random.random()
        return normal, [length * a / size for a in across]

    def border_of(self, length: float) -> tuple[list[float], list[float]]:
        return self.border(length, length)


def cases() -> list[dict]:
    draw = Draws(18)
    between, border = draw.between, draw.border
    found: list[dict] = []

    def case(name: str, here: tuple, beyond: tuple | None, at: tuple) -> None:
        request = {
            "incident": here[0],
            "transmitted": "metal" if beyond is None else beyond[0],
            "normal": at[0],
            "tangential": at[1],
        }
        expected = solve(request, [here[1], beyond[1] if beyond else None])
        found.append({"name": name, "input": request, "expected": expected})

    def uniaxial() -> tuple:
        eps, axis = draw.uniaxial(1.5, 4.0)
        return {"permittivity": eps, "permeability": 1.0}, axis

    def magnetic() -> tuple:
        mu, axis = draw.uniaxial(1.2, 3.0)
        return {"permittivity": between(1.5, 4.0), "permeability": mu}, axis

    def biaxial() -> tuple:
        return isotropic(draw.biaxial(1.5, 5.0))

    def general() -> tuple:
        return isotropic(draw.biaxial(1.5, 5.0), draw.biaxial(0.8, 2.0))

    def lossy() -> tuple:
        return isotropic(draw.lossy(draw.biaxial(1.5, 5.0), 0.05, 0.6), 1.0)

    air = isotropic(1.0)
    glass = isotropic(2.25)
    up = ([0.0, 0.0, 1.0], [0.0, 0.0, 0.0])
    case("air to glass at normal incidence", air, glass, up)
    # Brewster's angle: tan = 1.5.
    case("air to glass at Brewster's angle", air, glass, ([0.0, 0.0, 1.0], [1.5 / math.sqrt(3.25), 0.0, 0.0]))
    for _ in range(3):
        case("two dielectrics", isotropic(between(1, 6)), isotropic(between(1, 6)), border(0.95))
    for _ in range(3):
        case("total reflection", isotropic(between(2.2, 6)), air, border(1.45, 1.02))
    for off in (1e-2, 1e-4):
        case(f"grazing: 1 - |p_t| = {off:g}", air, glass, draw.border_of(1 - off))
        case(f"grazing beyond: 1 - |p_t| = {off:g}", glass, air, draw.border_of(1 - off))
        case(f"total reflection, nearly grazing beyond: |p_t| - 1 = {off:g}", glass, air, draw.border_of(1 + off))
    for _ in range(4):
        case(
            "magneto-dielectrics",
            isotropic(between(1, 5), between(0.5, 3)),
            isotropic(between(1, 5), between(0.5, 3)),
            border(0.7),
        )
    case("the same impedance", air, isotropic(2.0, 2.0), up)
    case("to a negative index", air, isotropic(-1.69, -1.0), border(0.9))
    case("from a negative index", isotropic(-1.69, -1.0), glass, border(0.9))
    case("from a negative index, total reflection", isotropic(-2.5, -1.2), air, border(1.6, 1.1))
    case("eps = mu = -1, which reflects nothing", air, isotropic(-1.0, -1.0), border(0.9))
    case("a metal without loss", air, isotropic(-5.0), border(0.9))
    case("negative permeability alone", glass, isotropic(2.0, -1.5), border(0.9))
    case("gold at 550 nm", air, isotropic([-5.9, 2.1]), border(0.9))
    case("gold at 550 nm, from glass", glass, isotropic([-5.9, 2.1]), border(1.4, 1.1))
    case("silver-like", glass, isotropic([-12.9, 0.43]), up)
    case("glass that absorbs", air, isotropic([2.25, 0.3]), border(0.95))
    case("a magnetic medium that absorbs", air, isotropic([3.0, 0.2], [1.4, 0.5]), border(0.95))
    case("out of glass that absorbs", isotropic([2.25, 0.3]), air, border(0.8))
    for medium, largest in [(air, 0.95), (glass, 1.4), (isotropic([2.25, 0.1]), 1.2)]:
        case("metal", medium, None, border(largest))
    case("metal in an electric crystal", uniaxial(), None, border(1.0))
    case("metal in a magnetic crystal", magnetic(), None, border(1.0))
    case("metal in a biaxial crystal", biaxial(), None, border(1.0))
    for _ in range(3):
        case("to an electric crystal", air, uniaxial(), border(0.95))
        case("out of an electric crystal", uniaxial(), air, border(1.15))
        case("to a magnetic crystal", air, magnetic(), border(0.95))
        case("out of a magnetic crystal", magnetic(), air, border(1.15))
    for _ in range(2):
        case("between electric crystals", uniaxial(), uniaxial(), border(1.1))
        case("between electric and magnetic crystals", uniaxial(), magnetic(), border(1.1))
    calcite = [[2.2085, 0.0, 0.0], [0.0, 2.75, 0.0], [0.0, 0.0, 2.75]]
    case(
        "calcite, its axis across the border",
        air,
        (isotropic(calcite)[0], [1.0, 0.0, 0.0]),
        ([1.0, 0.0, 0.0], [0.0, 0.3, 0.4]),
    )
    case(
        "calcite, its axis in the border",
        air,
        (isotropic(calcite)[0], [1.0, 0.0, 0.0]),
        ([0.0, 0.0, 1.0], [0.3, 0.4, 0.0]),
    )
    case("calcite along its axis", (isotropic(calcite)[0], [1.0, 0.0, 0.0]), air, ([1.0, 0.0, 0.0], [0.0, 0.0, 0.0]))
    case(
        "out of calcite, one wave totally reflected",
        (isotropic(calcite)[0], [1.0, 0.0, 0.0]),
        glass,
        ([0.0, 0.0, 1.0], [0.0, 1.49, 0.0]),
    )
    case(
        "calcite, where one wave is evanescent",
        (isotropic(calcite)[0], [1.0, 0.0, 0.0]),
        isotropic(4.0),
        ([0.0, 0.0, 1.0], [0.0, 1.55, 0.0]),
    )
    # The square cloak's tensor (kappa = 1/sqrt 3), and its reduced designs.
    kappa = 1 / math.sqrt(3)
    m = 1 / (1 - kappa)
    matched = [[m, -m * kappa, 0.0], [-m * kappa, m * (kappa**2 + (1 - kappa) ** 2), 0.0], [0.0, 0.0, m]]
    side = [math.sqrt(0.5), math.sqrt(0.5), 0.0]
    across = [-math.sqrt(0.5), math.sqrt(0.5), 0.0]
    onto = ([-v for v in side], [0.5 * across[0], 0.5 * across[1], 0.2])
    for name, here, beyond in [
        ("into", air, isotropic(matched, matched)),
        ("out of", isotropic(matched, matched), air),
    ]:
        case(f"{name} the impedance-matched square cloak, which reflects nothing", here, beyond, onto)
    case(
        "metal in the impedance-matched square cloak",
        isotropic(matched, matched),
        None,
        ([math.sin(0.5), math.cos(0.5), 0.0], [0.4 * math.cos(0.5), -0.4 * math.sin(0.5), 0.3]),
    )
    trace, det = matched[0][0] + matched[1][1], 1.0
    large = trace / 2 + math.sqrt(trace**2 / 4 - det)
    angle = math.atan2(large - matched[0][0], matched[0][1])
    u, v = [math.cos(angle), math.sin(angle), 0.0], [-math.sin(angle), math.cos(angle), 0.0]
    for design, axis, values in [("(i)", u, (1 / large, large)), ("(ii)", v, (large, 1 / large))]:
        medium = ({"permittivity": m, "permeability": _about(axis, *values)}, axis)
        case(f"into the square cloak {design}", air, medium, onto)
        case(f"out of the square cloak {design}", medium, air, onto)
    for _ in range(3):
        case("to a biaxial crystal", air, biaxial(), border(0.95))
        case("out of a biaxial crystal", biaxial(), air, border(1.2))
        case("between crystals, electric and magnetic in all directions", general(), general(), border(1.0))
    case("a biaxial crystal at normal incidence", air, biaxial(), up)
    case("between crystals, grazing in the first", air, general(), draw.border_of(0.9999))
    for _ in range(2):
        case("to a crystal that absorbs", air, lossy(), border(0.95))
        case("out of a crystal that absorbs", lossy(), glass, border(1.0))
    for _ in range(2):
        case("to a hyperbolic medium", air, isotropic(draw.principal([2.0, 2.5, -3.0])), border(0.95))
        case("out of a hyperbolic medium", isotropic(draw.principal([-2.0, 2.5, 3.0])), glass, border(0.9))
    case(
        "to a dichroic sheet: absorbs along one axis",
        air,
        isotropic([[[2.3, 0.0], 0.0, 0.0], [0.0, [2.4, 0.8], 0.0], [0.0, 0.0, 2.3]]),
        ([1.0, 0.0, 0.0], [0.0, 0.3, 0.4]),
    )
    return found
