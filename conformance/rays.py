"""`rays.json`: rays through devices, and their leaves."""

from __future__ import annotations

import json
import math
from collections.abc import Callable

import numpy as np
from mpmath import mp, mpc, mpf

import exact_maps
import graded
from exact_maps import Oracle
from interfaces import Draws
from plane_waves import Medium, Vector, added, cross, dot, real, scaled, unit
from poses import Pose
from ray_tree import Cell, Leaf, Trapped, cylinder, merged, norm, plane, side, sphere, trace
from write import plain

ABOUT = {
    "title": "Rays through devices in air",
    "conventions": "cm; exp(i(k0 p.r - omega t)); position: where the leaf leaves the device; |electric_field|^2 = power, "
    "with the phases of borders and mirrors, without those of the way; powers add, also of leaves that coincide",
}

#: Below this no branch of a ray tree is followed, in crystals, which trap light and share it among two waves, below the
#: second; leaves of 30 times as much are in the file.
LEAST, LEAST_IN_CRYSTALS = 1e-9, 1e-5

KAPPA = 1 / mp.sqrt(3)


def _polarized(direction: Vector, polarization: str | dict) -> Vector:
    if isinstance(polarization, dict):
        e = [mpc(*c) for c in polarization["electric_field"]]
        e = added(e, scaled(direction, -dot(e, direction)))
        return scaled(e, 1 / norm(e))
    z = real([0, 0, 1])
    vertical = unit(cross(z, direction)) if direction[0] or direction[1] else real([0, 1, 0])
    return vertical if polarization == "vertical" else cross(direction, vertical)


def _posed(oracle: Oracle, pose: Pose) -> Oracle:
    """An oracle of the device's frame, in that of the world."""

    def traced(origin: Vector, direction: Vector, electric: Vector) -> list[Leaf]:
        leaves = oracle(pose.point_in(origin), pose.vector_in(direction), pose.vector_in(electric))
        return [
            Leaf(pose.point_out(leaf.position), pose.vector_out(leaf.direction), leaf.power, leaf.optical_path,
                 None if leaf.electric is None else pose.vector_out(leaf.electric))
            for leaf in leaves
        ]

    return traced


def through(cells: list[Cell], least: float = LEAST) -> Oracle:
    """The ray tree of homogeneous media."""

    def traced(origin: Vector, direction: Vector, electric: Vector) -> list[Leaf]:
        return merged(trace(cells, origin, direction, electric, least), 30 * least)

    return traced


def by_hamilton(medium: graded.Medium, borders: list[graded.Border], mirrored: bool = False) -> Oracle:
    """The ray tree of a graded medium; `mirrored`: it is above y = 0, and below it stands its mirror image."""

    def traced(origin: Vector, direction: Vector, electric: Vector) -> list[Leaf]:
        o, d = (np.array([float(c) for c in v]) for v in (origin, direction))
        e = np.array([complex(c) for c in electric])
        best = None
        for flip in (1, -1) if mirrored else (1,):
            turn = np.array([1, flip, 1])
            for border in borders:
                if border.mirror:
                    continue
                # Outside the border is a function of the place alone.
                t = _crossing(border, o * turn, d * turn)
                if t is None:
                    continue
                at = (o + t * d) * turn
                inside = all(b is border or b.mirror or b.value(at, 0j) > 0 for b in borders)
                inside &= not mirrored or at[1] > 0
                if inside and (best is None or t < best[0]):
                    best = (t, border, at, turn)
        t, border, at, turn = best
        start = graded.Branch(at, d * turn, e * turn, 1.0, t)
        leaves = []
        for leaf in graded.trace(medium, borders, border, start, LEAST):
            values = (leaf.position * turn, leaf.wave_vector * turn, np.sqrt(leaf.power) * leaf.electric * turn)
            position, after, field = ([mpc(c) if isinstance(c, complex) else mpf(float(c)) for c in v.tolist()] for v in values)
            leaves.append(Leaf(position, unit(after), mpf(leaf.power), mpf(leaf.path), field))
        return merged(leaves, 30 * LEAST)

    return traced


def _crossing(border: graded.Border, o: np.ndarray, d: np.ndarray) -> float | None:
    """Where a line from outside first comes in through a border, a polynomial of second degree along it."""
    a, b, c = (border.value(o + t * d, 0j) for t in (-1.0, 0.0, 1.0))
    square, linear = (a + c) / 2 - b, (c - a) / 2
    if abs(square) < 1e-9:
        roots = [-b / linear] if linear else []
    else:
        root = linear**2 - 4 * square * b
        # The root that does not cancel, and the other by Vieta.
        q = -(linear + math.copysign(math.sqrt(root), linear)) / 2 if root > 0 else None
        roots = [] if q is None else [q / square, b / q]
    enters = [t for t in roots if t > 0 and linear + 2 * square * t > 0]
    return min(enters, default=None)


def wall(normal: list[float], distance: float) -> graded.Border:
    n = np.array(normal)
    return graded.Border(lambda r, _: distance - n @ r, lambda r, _: n)


def shell(radius: float) -> graded.Border:
    return graded.Border(lambda r, _: (radius**2 - r @ r) / (2 * radius), lambda r, _: r / np.linalg.norm(r))


def _checked(oracle: Oracle, other: Oracle, tolerance: float) -> Oracle:
    """An oracle that a second one agrees with."""

    def traced(origin: Vector, direction: Vector, electric: Vector) -> list[Leaf]:
        leaves, others = oracle(origin, direction, electric), other(origin, direction, electric)
        others = [leaf for leaf in others if leaf.power > 1e-12]
        assert len(leaves) == len(others), (len(leaves), len(others))
        for a, b in zip(leaves, others):
            for x, y in zip([*a.position, *a.direction, a.power, a.optical_path, *a.electric],
                            [*b.position, *b.direction, b.power, b.optical_path, *b.electric]):
                assert abs(x - y) < tolerance, (a, b)
        return leaves

    return traced


def _square_cloak(matched: bool, positive: bool) -> list[Cell]:
    """The four triangles of designs (i) and (ii): eps and the principal values of mu of the exact design."""
    d = mpf("14.1") / mp.sqrt(2)
    b = KAPPA * d
    m = 1 / (1 - KAPPA)
    cells = []
    quadrants = [(1, 1), (-1, 1), (-1, -1), (1, -1)]
    for index, (sx, sy) in enumerate(quadrants):
        off = -m * KAPPA * sx * sy
        inplane = mp.matrix([[m, off], [off, m * (KAPPA**2 + (1 - KAPPA) ** 2)]])
        values, vectors = mp.eigsy(inplane)
        # (i): mu_e along the axis of the larger value, mu_o across it; (ii): the other way round.
        large = 1 if values[1] > values[0] else 0
        axis = large if positive else 1 - large
        along, across = values[axis], values[1 - axis]
        a = [vectors[0, axis], vectors[1, axis], mpf(0)]
        mu = tuple(tuple(mpc(across * (i == j) + (along - across) * a[i] * a[j]) for j in range(3)) for i in range(3))
        eps = tuple(tuple(mpc(m * (i == j)) for j in range(3)) for i in range(3))
        tip, top, low = [sx * d, 0], [0, sy * d], [0, sy * b]
        middle = [sum(c[i] for c in (tip, top, low)) / 3 for i in range(2)]
        neighbour = quadrants.index((-sx, sy))
        cells.append(Cell(Medium(eps, mu), [
            side(-1, tip, top, middle), side(None, tip, low, middle), side(neighbour, top, low, middle),
        ]))
    return cells


def cases() -> list[dict]:
    draw = Draws(11)
    found: list[dict] = []
    exact = {"position": 1e-11, "direction": 1e-12, "power": 1e-12, "optical_path": 1e-11, "electric_field": 1e-12}

    def case(name: str, oracle: str, device: str, pose: Pose, trace: Oracle, rays: list[dict], tolerance: dict,
             keys: str = "", least: float = LEAST) -> None:
        traced = _posed(trace, pose)
        # The pose stands before the tables of prisms.
        head, *prisms = device.split("[[device.prism]]")
        scene = "[[device.prism]]".join([f"[trace]\nmin_power = {least}\n{keys}\n[[device]]\n{head}{pose.keys}", *prisms])
        requests, expected = [], []
        for ray in rays:
            direction = unit(real(ray["direction"]))
            try:
                leaves = traced(real(ray["origin"]), direction, _polarized(direction, ray["polarization"]))
            except Trapped:
                continue
            assert leaves, name
            requests.append(ray)
            expected.append(plain({"leaves": [leaf.written() for leaf in leaves]}))
        assert requests, name
        found.append({
            "name": name, "oracle": oracle, "scene": scene, "rays": requests, "all_leaves_above": 30 * least,
            "expected": expected, "tolerance": tolerance,
        })

    def rays(count: int, pose: Pose, target: Callable[[], list[float]], distance: float = 30.0,
             towards: Callable[[], list[float]] = draw.axis) -> list[dict]:
        """Rays from around a device towards points in it, both in its frame; in turn of each polarization."""
        drawn = []
        for i in range(count):
            at, d = target(), towards()
            origin = [a - distance * c for a, c in zip(at, d)]
            where = [round(float(c), 6) for c in pose.point_out(real(origin))]
            way = [round(float(c), 6) for c in pose.vector_out(real(d))]
            polarization: str | dict = "horizontal" if i % 3 == 0 else "vertical"
            if i % 3 == 2:
                u = unit(real(way))
                h, v = _polarized(u, "horizontal"), _polarized(u, "vertical")
                polarization = {"electric_field": [[float(a * 0.6), float(b * 0.8)] for a, b in zip(h, v)]}
            drawn.append({"origin": where, "direction": way, "polarization": polarization})
        return drawn

    def within(*half: float) -> Callable[[], list[float]]:
        return lambda: [draw.between(-h, h) for h in half]

    def ball(radius: float, least: float = 0.0) -> Callable[[], list[float]]:
        def point() -> list[float]:
            size = radius * (least + (1 - least) * draw.random.random() ** (1 / 3))
            return [size * c for c in draw.axis()]

        return point

    def ring(inner: float, outer: float, height: float) -> Callable[[], list[float]]:
        def point() -> list[float]:
            angle, r = math.tau * draw.random.random(), draw.between(inner, outer)
            return [r * math.cos(angle), r * math.sin(angle), draw.between(-height, height)]

        return point

    def aside() -> list[float]:
        """A direction not too near to z."""
        while True:
            d = draw.axis()
            if abs(d[2]) < 0.7:
                return d

    plainly, turned = Pose(), Pose([1.0, -2.0, 3.0], 20.0)
    anyhow = Pose([-3.0, 2.5, 1.5], 35.0, [1.0, 2.0, 2.0])

    # Bodies of isotropic media.
    glass = Cell(Medium.of(2.25), [sphere(5.0)])
    both = _checked(exact_maps.glass_ball(5.0, 1.5, 30 * LEAST), through([glass]), 1e-20)
    body = 'kind = "body"\nshape = "sphere"\nradius = 5.0\n'
    for pose, name in [(plainly, "a ball of glass"), (turned, "a ball of glass aside")]:
        case(name, "Descartes's rays with Fresnel's amplitudes, and the ray tree", body + "permittivity = 2.25\n", pose, both,
             rays(4, pose, ball(5.0)), exact)
    centre = [{"origin": [-30.0, 0.0, 0.0], "direction": [1.0, 0.0, 0.0], "polarization": "horizontal"}]
    tree = "the ray tree of plane waves at every border"
    case("a ball of glass, through its centre", tree, body + "permittivity = 2.25\n", plainly, through([glass]), centre, exact)

    def bodies(name: str, shape: str, faces: list, permittivity: float | list, permeability: float | list, pose: Pose,
               drawn: list[dict], least: float = LEAST) -> None:
        keys = f"{shape}permittivity = {json.dumps(permittivity)}\npermeability = {json.dumps(permeability)}\n"
        cells = [Cell(Medium.of(permittivity, permeability), faces)]
        case(name, tree, 'kind = "body"\n' + keys, pose, through(cells, least), drawn, exact, least=least)

    round_body = 'shape = "sphere"\nradius = 5.0\n'
    bodies("a ball of n = -1.3", round_body, [sphere(5.0)], -1.69, -1.0, turned, rays(3, turned, ball(5.0)))
    bodies("a ball of n = -1 that reflects nothing", round_body, [sphere(5.0)], -1.0, -1.0, plainly, rays(2, plainly, ball(5.0)))
    slab = [plane(-1, [1, 0, 0], 1.5), plane(-1, [-1, 0, 0], 1.5)]
    bodies("a slab of glass, in any pose", 'shape = "slab"\nthickness = 3.0\n', slab, 2.25, 1.0, anyhow,
           rays(3, anyhow, within(1.4, 5, 5), towards=lambda: unit([1.0, draw.between(-1, 1), draw.between(-1, 1)])))
    box = [plane(-1, [s * (i == a) for i in range(3)], h / 2) for a, h in enumerate((4.0, 6.0, 8.0)) for s in (1, -1)]
    boxed = 'shape = "box"\nsize = [4.0, 6.0, 8.0]\n'
    bodies("a box of glass, with total reflection", boxed, box, 2.25, 1.0, anyhow, rays(3, anyhow, within(1.8, 2.8, 3.8)))
    tube = 'shape = "cylinder"\nradius = 3.0\nlength = 10.0\n'
    ends = [cylinder(3.0), plane(-1, [0, 0, 1], 5.0), plane(-1, [0, 0, -1], 5.0)]
    bodies("a rod of glass with ends", tube, ends, 2.25, 1.0, anyhow, rays(3, anyhow, within(2, 2, 4.5)))
    bodies("a magneto-dielectric rod", tube, ends, 1.8, 1.4, turned, rays(3, turned, within(2, 2, 4.5)))
    corners = [[-4.0, -2.0], [4.0, -2.0], [1.0, 4.0]]
    inner = [1 / 3, 0.0]
    sides = [side(-1, corners[i], corners[(i + 1) % 3], inner) for i in range(3)]

    def prism(name: str, permittivity: float | list, permeability: float | list, pose: Pose, drawn: list[dict],
              least: float = LEAST) -> None:
        keys = f"corners = {corners}\npermittivity = {json.dumps(permittivity)}\npermeability = {json.dumps(permeability)}\n"
        cells = [Cell(Medium.of(permittivity, permeability), sides)]
        case(name, tree, f'kind = "prisms"\n\n[[device.prism]]\n{keys}', pose, through(cells, least), drawn, exact, least=least)

    prism("a prism of glass", 2.25, 1.0, turned, rays(3, turned, within(1, 1, 1), towards=aside))

    # Bodies of crystals.
    few = LEAST_IN_CRYSTALS
    eps, _ = draw.uniaxial(2.0, 3.0)
    bodies("a slab of a uniaxial crystal", 'shape = "slab"\nthickness = 3.0\n', slab, eps, 1.0, turned,
           rays(3, turned, within(1.4, 5, 5), towards=lambda: unit([1.0, draw.between(-1, 1), draw.between(-1, 1)])), few)
    bodies("a ball of a biaxial crystal", round_body, [sphere(5.0)], draw.biaxial(1.8, 3.5), 1.0, anyhow,
           rays(3, anyhow, ball(2.5)), few)
    prism("a prism of a crystal, electric and magnetic", draw.biaxial(1.8, 3.0), draw.biaxial(0.8, 1.5), anyhow,
          rays(2, anyhow, within(1, 1, 1), towards=aside), few)

    # Designs (i) and (ii): what is beyond 30 times the threshold.
    def onward() -> list[float]:
        return unit([1.0, draw.between(-0.25, 0.25), draw.between(-0.3, 0.3)])

    for design, material, positive in [("(i)", "positive-uniaxial", True), ("(ii)", "negative-uniaxial", False)]:
        cells = _square_cloak(False, positive)
        for pose in (plainly, turned):
            case(f"the square cloak {design}", tree, f'kind = "square-cloak"\nmaterial = "{material}"\n', pose, through(cells, few),
                 rays(2, pose, within(0.1, 5, 2), towards=onward), exact, least=few)

    # Transformations.
    mapped = "empty space, transformed"
    for pose in (plainly, turned, anyhow):
        case("the square cloak (iii)", mapped, 'kind = "square-cloak"\n', pose, exact_maps.square_cloak(14.1),
             rays(3, pose, within(0.5, 5, 3), towards=aside), exact)
        case("the cylinder cloak", mapped, 'kind = "cylinder-cloak"\n', pose, exact_maps.round_cloak(10.0, True),
             rays(2, pose, within(7, 7, 5), towards=aside), exact)
        case("the sphere cloak", mapped, 'kind = "sphere-cloak"\n', pose, exact_maps.round_cloak(10.0, False),
             rays(2, pose, ball(9.5)), exact)

    # Balls of graded index, 10 cm; Hamilton's equations agree with the closed forms.
    def radial(n2: Callable[[float], tuple[float, float]]) -> graded.Medium:
        def of(r: np.ndarray) -> tuple[float, np.ndarray]:
            size = float(np.linalg.norm(r))
            value, slope = n2(size / 10)
            return value, slope / 10 * r / size

        return graded.Formula(of)

    def family(m: float) -> Callable[[float], tuple[float, float]]:
        def n2(r: float) -> tuple[float, float]:
            # r = 2 v^(1 - 1/m)/(1 + v^2), v = n^m; Newton's method for ln v.
            u, power = 0.0 if r >= 1 else math.acosh(1 / r) if m != 0.5 else 1.0, 1 - 1 / m
            for _ in range(200):
                v = math.exp(u)
                value = math.log(2) + power * u - math.log1p(v * v) - math.log(r)
                slope = power - 2 * v * v / (1 + v * v)
                step = value / slope
                u -= max(-0.5, min(0.5, step))
                if abs(step) < 1e-16:
                    break
            v = math.exp(u)
            n = math.exp(2 * u / m)
            return n, 2 * n / m / r / (power - 2 * v * v / (1 + v * v))

        return n2

    closed = "closed form, and Hamilton's equations"
    balls = [
        ("invisible-sphere", exact_maps.eaton(10.0, 2 * mp.pi), family(0.5)),
        ("bending-sphere", exact_maps.eaton(10.0, mp.pi / 2), family(2.0)),
        ("eaton-lens", exact_maps.eaton(10.0, mp.pi), lambda r: (2 / r - 1, -2 / r**2)),
        ("luneburg-lens", exact_maps.luneburg(10.0), lambda r: (2 - r * r, -2 * r)),
        ("fisheye-lens", exact_maps.fisheye(10.0), lambda r: ((2 / (1 + r * r)) ** 2, -16 * r / (1 + r * r) ** 3)),
    ]
    for kind, oracle, n2 in balls:
        both = _checked(oracle, by_hamilton(radial(n2), [shell(10.0)]), 1e-9)
        for pose in (plainly, anyhow):
            case(f"the {kind}", closed, f'kind = "{kind}"\n', pose, both, rays(2, pose, ball(9.0, 0.3)), exact)

    # Graded media with borders: DOP853.
    numeric = "Hamilton's equations by DOP853"
    precise = {"position": 1e-10, "direction": 1e-11, "power": 1e-12, "optical_path": 1e-10, "electric_field": 1e-10}
    finely = "tolerance = 1e-10\n"
    gradient = [0.02, 0.05, -0.03]
    box_medium = graded.Formula(lambda r: (1.5**2 + float(np.dot(gradient, r)), np.array(gradient)))
    walls = [wall([float(s * (i == a)) for i in range(3)], h / 2) for a, h in enumerate((8.0, 6.0, 10.0)) for s in (1, -1)]
    for pose in (plainly, anyhow):
        case("a box of graded index", numeric, f'kind = "graded-box"\nsides = [8.0, 6.0, 10.0]\nindex = 1.5\ngradient = {gradient}\n',
             pose, by_hamilton(box_medium, walls), rays(2, pose, within(3, 2, 4)), precise)
    half = [shell(10.0), wall([-1.0, 0.0, 0.0], 0.0)]
    _, fish = balls[4][1], balls[4][2]
    for pose in (plainly, anyhow):
        case("half of Maxwell's fish-eye", numeric, 'kind = "fisheye-hemisphere"\n', pose, by_hamilton(radial(fish), half),
             rays(2, pose, lambda: [draw.between(1, 5), draw.between(-5, 5), draw.between(-5, 5)],
                  towards=lambda: unit([1.0, draw.between(-1, 1), draw.between(-1, 1)])), precise)
    cloak = graded.Gaussian(10.02, 4.25)

    def metal_normal(r: np.ndarray, zeta: complex) -> np.ndarray:
        down = -1j * cloak.derivatives(zeta)[0]
        down /= abs(down)
        return np.array([down.real, down.imag, 0.0])

    metal = graded.Border(lambda r, zeta: zeta.imag, metal_normal, True)
    edges = [wall([1.0, 0.0, 0.0], 25.0), wall([-1.0, 0.0, 0.0], 25.0), wall([0.0, 1.0, 0.0], 57.14 / 2), metal]
    for pose in (plainly, turned, anyhow):
        case("the double-Gaussian cloak (iv)", numeric, 'kind = "double-gaussian-cloak"\n', pose,
             by_hamilton(cloak, edges, mirrored=True),
             rays(3, pose, lambda: [0.0, draw.between(0.5, 18) * (1 if draw.random.random() < 0.5 else -1), draw.between(-5, 5)],
                  50.0, lambda: unit([1.0, draw.between(-0.3, 0.3), draw.between(-0.3, 0.3)])), precise, finely)
    return found
