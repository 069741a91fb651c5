"""`plates.json`: plane-parallel stacks in air, whose waves add as fields or as powers."""

from __future__ import annotations

import json
import math

from mpmath import mp, mpc, mpf

from interfaces import Draws
from plane_waves import (
    AIR,
    Medium,
    Pair,
    added,
    cross,
    delta_matrix,
    dot,
    eigenspaces,
    frame,
    normal_flux,
    real,
    scaled,
    turned,
    unit,
    waves,
)
from write import plain

WAVELENGTH_NM = 550

ABOUT = {
    "title": "Plane-parallel stacks in air",
    "conventions": "cm; exp(i(k0 p.r - omega t)); the light that comes has the field E exp(i k0 d.r), d its direction; "
    "complex: [re, im]",
    "wavelength_nm": WAVELENGTH_NM,
}

NORMAL = real([1, 0, 0])

#: Of two waves each with each.
PAIRS = [(i, j) for i in range(2) for j in range(2)]


def _scene(layers: list[dict], coherent: bool) -> str:
    lines = ["[light]", f"wavelength_nm = {WAVELENGTH_NM}"]
    lines += (["bandwidth_nm = 0"] if coherent else []) + [
        "",
        "[trace]",
        f"min_power = {1e-26 if coherent else 1e-14}",
        "",
    ]
    x = 0.0
    for layer in layers:
        lines += ["[[device]]", 'kind = "body"', 'shape = "slab"', f"thickness = {layer['thickness']!r}"]
        lines += [f"position = [{x + 0.5 * layer['thickness']!r}, 0, 0]"]
        lines += [f"{key} = {json.dumps(layer[key])}" for key in ("permittivity", "permeability")]
        x += layer["thickness"]
    return "\n".join(lines) + "\n"


def _through(layer: dict, axes: list, k: mpf, wave_number: mpf) -> mp.matrix:
    """The tangential fields behind a layer from those before it: exp(i k0 d M)."""
    medium = Medium.of(layer["permittivity"], layer["permeability"])
    m = delta_matrix(turned(medium.permittivity, axes), turned(medium.permeability, axes), k)
    found = mp.zeros(4)
    for value, projector, _ in eigenspaces(m):
        found += mp.matrix(projector) * mp.expj(wave_number * layer["thickness"] * value)
    return found


def _split(fields: list[mpc], pair: Pair) -> list[mpc]:
    """The amplitudes of flux-orthogonal waves of normal flux +-1 in tangential fields."""
    return [normal_flux(fields, psi) / normal_flux(psi, psi) for psi in pair.tangential]


def _fields(pair: Pair, amplitudes: list[mpc]) -> list[mpc]:
    parts = [scaled(mode.electric, a) for mode, a in zip(pair.modes, amplitudes)]
    return added(*parts)


def _norm(vector: list[mpc]) -> mpf:
    return sum(abs(c) ** 2 for c in vector)


def _as_fields(layers: list[dict], direction: list, electric: list) -> dict:
    tangential = [mpf(0), direction[1], direction[2]]
    axes = frame(NORMAL, tangential)
    k, wave_number = dot(tangential, axes[0]), 2 * mp.pi / (WAVELENGTH_NM * mpf(10) ** -7)
    through = mp.eye(4)
    for layer in layers:
        through = _through(layer, axes, k, wave_number) * through
    on, back = waves(AIR, NORMAL, tangential)
    magnetic = cross(direction, electric)
    psi = mp.matrix([dot(axes[i], f) for f in (electric, magnetic) for i in range(2)])
    # transmitted - through reflected = through incident.
    backward = [through * mp.matrix(b) for b in back.tangential]
    system = mp.matrix([[t[i] for t in on.tangential] + [-b[i] for b in backward] for i in range(4)])
    found = list(mp.lu_solve(system, through * psi))
    thickness = sum(mpf(layer["thickness"]) for layer in layers)
    places = {"transmitted": [thickness, mpf(0), mpf(0)], "reflected": [mpf(0)] * 3}
    answer = {}
    for name, pair, amplitudes in [("reflected", back, found[2:]), ("transmitted", on, found[:2])]:
        field = _fields(pair, amplitudes)
        way = [-direction[0] if name == "reflected" else direction[0], direction[1], direction[2]]
        answer[name] = {
            "direction": way,
            "power": _norm(field) / _norm(electric),
            "point": places[name],
            "electric_field": field,
        }
    if direction[1] == 0 and direction[2] == 0:
        _, v, h = answer["transmitted"]["electric_field"]
        s0 = abs(h) ** 2 + abs(v) ** 2
        across = h * mp.conj(v)
        stokes = [abs(h) ** 2 - abs(v) ** 2, 2 * across.real, 2 * across.imag]
        answer["transmitted"]["stokes"] = [s / s0 for s in stokes]
    return answer


def _as_powers(layers: list[dict], direction: list, electric: list) -> dict:
    """Every branch for itself: coherency matrices, without what is between the two waves of a birefringent layer."""
    tangential = [mpf(0), direction[1], direction[2]]
    media = [AIR, *(Medium.of(layer["permittivity"], layer["permeability"]) for layer in layers), AIR]
    sides = [waves(medium, NORMAL, tangential) for medium in media]
    assert not any(medium.absorbs for medium in media)
    assert all(mode.propagates for pairs in sides for pair in pairs for mode in pair.modes)
    axes = frame(NORMAL, tangential)
    psi = [dot(axes[i], f) for f in (electric, cross(direction, electric)) for i in range(2)]
    come = _split(psi, sides[0][0])
    first = [[a * mp.conj(b) for b in come] for a in come]
    last = len(layers) + 1

    def place(layer: int, onward: bool, i: int, j: int) -> int:
        """Where the coherency of two waves that leave a border into a layer stands among the unknowns."""
        return 8 * layer + 4 * (not onward) + 2 * i + j

    system, constant = mp.eye(8 * (last + 1)), mp.zeros(8 * (last + 1), 1)
    for border in range(last):
        (left_on, left_back), (right_on, right_back) = sides[border], sides[border + 1]
        columns = left_back.tangential, right_on.tangential
        out = mp.matrix([[l[i] for l in columns[0]] + [-r[i] for r in columns[1]] for i in range(4)])
        s = []
        for psi, sign in [(p, -1) for p in left_on.tangential] + [(p, 1) for p in right_back.tangential]:
            s.append(mp.lu_solve(out, mp.matrix([sign * entry for entry in psi])))
        for side, (layer, onward) in enumerate([(border, False), (border + 1, True)]):
            for i, j in PAIRS:
                row = place(layer, onward, i, j)
                for source, (origin, origin_onward) in enumerate([(border, True), (border + 1, False)]):
                    together = sides[origin][0 if origin_onward else 1].degenerate
                    for a, b in PAIRS:
                        weight = s[2 * source + a][2 * side + i] * mp.conj(s[2 * source + b][2 * side + j])
                        if a != b and not together:
                            continue
                        if origin == 0:
                            constant[row] += weight * first[a][b]
                        elif origin != last:
                            system[row, place(origin, origin_onward, a, b)] -= weight
    found = mp.lu_solve(system, constant)
    carried = (first[0][0] + first[1][1]).real
    answer = {}
    for name, layer, onward, sign in [("reflected", 0, False, -1), ("transmitted", last, True, 1)]:
        power = (found[place(layer, onward, 0, 0)] + found[place(layer, onward, 1, 1)]).real / carried
        answer[name] = {"direction": [sign * direction[0], direction[1], direction[2]], "power": power}
    return answer


def cases() -> list[dict]:
    draw = Draws(8)
    found: list[dict] = []

    def case(name: str, layers: list[dict], coherent: bool, rays: list[tuple[list[float], list]]) -> list[dict]:
        requests, expected = [], []
        for towards, electric in rays:
            direction = unit(real(towards))
            origin = [float(-c / 2) for c in direction]
            # What stands in the file is what is solved: rounded, then made transverse again.
            e = [mpc(*c) for c in electric]
            e = added(e, scaled(direction, -dot(e, direction)))
            e = scaled(e, 1 / mp.sqrt(_norm(e)))
            written = plain([[c.real, c.imag] for c in e])
            direction_written = [float(c) for c in direction]
            solve = _as_fields if coherent else _as_powers
            expected.append(plain(solve(layers, direction, e)))
            requests.append(
                {"origin": origin, "direction": direction_written, "polarization": {"electric_field": written}}
            )
        tolerance = {"power": 1e-10, "electric_field": 1e-10} if coherent else {"power": 1e-10}
        found.append(
            {
                "name": name,
                "coherent": coherent,
                "scene": _scene(layers, coherent),
                "layers": layers,
                "rays": requests,
                "expected": expected,
                "tolerance": tolerance,
            }
        )
        return expected

    def layer(permittivity: float | list, thickness: float, permeability: float | list = 1.0) -> dict:
        return {"permittivity": permittivity, "permeability": permeability, "thickness": thickness}

    def fields(theta: float, turn: float) -> list[tuple[list[float], list]]:
        """Light at an angle from x, turned about it, in s, p and circular."""
        d = [math.cos(theta), math.sin(theta) * math.cos(turn), math.sin(theta) * math.sin(turn)]
        s = [0.0, -math.sin(turn), math.cos(turn)]
        p = [-math.sin(theta), math.cos(theta) * math.cos(turn), math.cos(theta) * math.sin(turn)]
        circular = [[a * math.sqrt(0.5), b * math.sqrt(0.5)] for a, b in zip(s, p)]
        return [(d, [[c, 0.0] for c in s]), (d, [[c, 0.0] for c in p]), (d, circular)]

    horizontal = [([1.0, 0.0, 0.0], [[0.0, 0.0], [0.0, 0.0], [1.0, 0.0]])]

    # Films of glass, 92 and 183 nm at normal incidence: 14.8 % and nothing; others at any angle.
    quarter = case("a film of glass of 92 nm", [layer(2.25, 92e-7)], True, horizontal)
    assert abs(quarter[0]["reflected"]["power"] - 0.148) < 2e-4
    half = case("a film of glass of half a wavelength", [layer(2.25, 550e-7 / 3)], True, horizontal)
    assert half[0]["reflected"]["power"] < 1e-12
    for theta in (0.5, 1.3):
        case(f"a film of glass, {theta} rad", [layer(2.25, 4.1e-5)], True, fields(theta, 0.4))
    mirror = [layer(5.29 if i % 2 == 0 else 2.1025, 550e-7 / 4 / (2.3 if i % 2 == 0 else 1.45)) for i in range(7)]
    case("a dielectric mirror: seven quarter-wave films", mirror, True, horizontal + fields(0.6, 2.0))
    film = [layer(1.9044, 550e-7 / 4 / 1.38), layer(3.6, 0.1)]
    case("an antireflection film on a plate of 1 mm", film, True, horizontal + fields(0.3, 1.0))

    # Quartz between quarter-wave films: what it makes of horizontal light at 45 degrees (physics of retarders).
    no, ne = 1.546, 1.555
    mean, difference = (no**2 + ne**2) / 2, (ne**2 - no**2) / 2
    crystal = [[no**2, 0.0, 0.0], [0.0, mean, difference], [0.0, difference, mean]]
    n = math.sqrt((no + ne) / 2)
    for name, waves_of, stokes in [("quarter", 0.25, (0, 0, -1)), ("half", 0.5, (-1, 0, 0)), ("full", 1.0, (1, 0, 0))]:
        plate = layer(crystal, waves_of * 550e-7 / (ne - no))
        coat = layer(n * n, 550e-7 / 4 / n)
        coated = case(
            f"a {name}-wave plate of quartz at 45 degrees between antireflection films",
            [coat, plate, coat],
            True,
            horizontal,
        )
        bare = case(f"a {name}-wave plate of quartz at 45 degrees", [plate], True, horizontal + fields(0.35, 0.9))
        for beam, off in [(coated, 6e-3), (bare, 0.15)]:
            assert all(abs(a - b) < off for a, b in zip(beam[0]["transmitted"]["stokes"], stokes)), beam[0][
                "transmitted"
            ]

    # 1 mm of glass with a trace of birefringence, at Brewster's angle: p passes whole.
    brewster = [fields(math.atan(1.5), 0.3)[1]]
    for exponent in (-11, -9, -7, -6):
        weak = draw.biaxial(-1.0, 1.0)
        eps = [[2.25 * (i == j) + 3 * weak[i][j] * 10.0**exponent for j in range(3)] for i in range(3)]
        passed = case(
            f"1 mm of glass at Brewster's angle, birefringence about 1e{exponent}", [layer(eps, 0.1)], True, brewster
        )
        assert passed[0]["transmitted"]["power"] > 0.9999

    def medium(kind: int) -> tuple[float | list, float | list]:
        if kind == 0:
            return draw.between(1.2, 6), 1.0
        if kind == 1:
            return draw.between(1.2, 4), draw.between(0.8, 2)
        if kind == 2:
            return draw.biaxial(1.5, 4), 1.0
        return draw.biaxial(1.5, 4), draw.biaxial(0.8, 1.6)

    for count in (1, 1, 2, 2, 3, 4, 5):
        layers = []
        for _ in range(count):
            eps, mu = medium(int(4 * draw.random.random()))
            layers.append(layer(eps, draw.between(0.02, 3) * 1e-4, mu))
        theta, turn = draw.between(0, 0.9), draw.between(0, 6.28)
        case(f"a stack of {count} layers, crystals and magnetic media too", layers, True, fields(theta, turn))
    case(
        "a film of n = -1.3 on one of glass", [layer(-1.69, 1.1e-5, -1.0), layer(2.25, 2.3e-5)], True, fields(0.4, 5.0)
    )
    case("glass that absorbs", [layer([2.25, 0.02], 2e-4)], True, horizontal + fields(0.7, 1.2))
    eps = draw.lossy(draw.biaxial(1.5, 4), 0.01, 0.2)
    case("a crystal that absorbs", [layer(eps, 1.3e-4)], True, fields(0.5, 2.2))
    eps = draw.lossy(draw.biaxial(1.5, 4), 0.01, 0.2)
    case("glass on a crystal that absorbs", [layer(2.25, 0.9e-4), layer(eps, 0.7e-4)], True, fields(0.6, 4.2))

    # As powers: thick plates. 2R/(1 + R) at normal incidence.
    glass = case("a window of 1 mm", [layer(2.25, 0.1)], False, horizontal + fields(0.9, 0.4))
    assert abs(glass[0]["reflected"]["power"] - 0.08 / 1.04) < 1e-15
    case("a window of 1 mm at Brewster's angle", [layer(2.25, 0.1)], False, fields(math.atan(1.5), 0.3))
    case("two windows that touch", [layer(2.25, 0.1), layer(3.24, 0.2)], False, fields(0.6, 0.4))
    case(
        "three plates, magnetic and of negative index",
        [layer(2.25, 0.1), layer(2.0, 0.15, 1.5), layer(-1.69, 0.1, -1.0)],
        False,
        fields(0.5, 3.4),
    )
    calcite = [[2.2085, 0.0, 0.0], [0.0, 2.75, 0.0], [0.0, 0.0, 2.75]]
    case("calcite of 1 cm, its axis across the faces", [layer(calcite, 1.0)], False, fields(0.8, 0.7))
    for _ in range(2):
        case("a biaxial crystal of 3 mm", [layer(draw.biaxial(1.5, 4), 0.3)], False, fields(draw.between(0.1, 1), 2.7))
    case(
        "a magnetic crystal of 3 mm",
        [layer(draw.biaxial(1.5, 4), 0.3, draw.biaxial(0.8, 1.6))],
        False,
        fields(0.7, 1.7),
    )
    case("a crystal on glass", [layer(draw.biaxial(1.5, 3), 0.3), layer(2.25, 0.2)], False, fields(0.4, 1.1))
    return found
