"""`rays.json`: rays through devices, and their leaves."""

from __future__ import annotations

import json
import math
from collections.abc import Callable, Iterator

import numpy as np
from mpmath import mp, mpc, mpf

import exact_maps
import graded
import uniaxial_cylinders
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
            Leaf(
                pose.point_out(leaf.position),
                pose.vector_out(leaf.direction),
                leaf.power,
                leaf.optical_path,
                None if leaf.electric is None else pose.vector_out(leaf.electric),
            )
            for leaf in leaves
        ]

    return traced


def through(cells: list[Cell], least: float = LEAST) -> Oracle:
    """The ray tree of homogeneous media."""

    def traced(origin: Vector, direction: Vector, electric: Vector) -> list[Leaf]:
        return merged(trace(cells, origin, direction, electric, least), 30 * least)

    return traced


def by_hamilton(
    medium: graded.Medium, borders: list[graded.Border], mirrored: bool = False, floor: bool = False
) -> Oracle:
    """The ray tree of a graded medium above y = 0; `mirrored`: below stands its mirror image; `floor`: there is a mirror."""

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
            if floor and leaf.wave_vector[1] < 0:
                on = -leaf.position[1] / leaf.wave_vector[1]
                leaf.position, leaf.path = leaf.position + on * leaf.wave_vector, leaf.path + on
                leaf.wave_vector, leaf.electric = leaf.wave_vector * [1, -1, 1], leaf.electric * [-1, 1, -1]
            values = (leaf.position * turn, leaf.wave_vector * turn, np.sqrt(leaf.power) * leaf.electric * turn)
            position, after, field = (
                [mpc(c) if isinstance(c, complex) else mpf(float(c)) for c in v.tolist()] for v in values
            )
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
            for x, y in zip(
                [*a.position, *a.direction, a.power, a.optical_path, *a.electric],
                [*b.position, *b.direction, b.power, b.optical_path, *b.electric],
            ):
                assert abs(x - y) < tolerance, (a, b)
        return leaves

    return traced


def _square_cloak(positive: bool) -> list[Cell]:
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
        cells.append(
            Cell(
                Medium(eps, mu),
                [
                    side(-1, tip, top, middle),
                    side(None, tip, low, middle),
                    side(neighbour, top, low, middle),
                ],
            )
        )
    return cells


#: What is known to all digits, and what is integrated.
EXACT = {"position": 1e-11, "direction": 1e-12, "power": 1e-12, "optical_path": 1e-11, "electric_field": 1e-12}
INTEGRATED = {"position": 1e-10, "direction": 1e-11, "power": 1e-12, "optical_path": 1e-10, "electric_field": 1e-10}

TREE = "a ray tree of plane waves"
HAMILTON = "Hamilton's equations by DOP853"

PLAINLY, TURNED = Pose(), Pose([1.0, -2.0, 3.0], 20.0)
ANYHOW = Pose([-3.0, 2.5, 1.5], 35.0, [1.0, 2.0, 2.0])

Point = Callable[[], list[float]]


class Book:
    """Cases of one kind, and the rays drawn for them."""

    def __init__(self, seed: int) -> None:
        self.draw = Draws(seed)
        self.cases: list[dict] = []

    def case(
        self,
        name: str,
        oracle: str,
        device: str,
        pose: Pose,
        trace: Oracle,
        rays: list[dict],
        tolerance: dict = EXACT,
        keys: str = "",
        least: float = LEAST,
        every: bool = True,
    ) -> None:
        """A device, as its part of a scene file, and rays; `every`: the oracle has all leaves."""
        name += "" if pose is PLAINLY else ", turned" if pose is TURNED else ", tilted"
        traced = _posed(trace, pose)
        # The pose stands before the tables of prisms.
        head, *prisms = device.split("[[device.prism]]")
        scene = "[[device.prism]]".join(
            [f"[trace]\nmin_power = {least}\n{keys}\n[[device]]\n{head}{pose.keys}", *prisms]
        )
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
        self.cases.append(
            {
                "name": name,
                "oracle": oracle,
                "scene": scene,
                "rays": requests,
                "all_leaves_above": 30 * least if every else None,
                "expected": expected,
                "tolerance": tolerance,
            }
        )

    def rays(
        self, count: int, pose: Pose, target: Point, towards: Point | None = None, distance: float = 30.0
    ) -> list[dict]:
        """Rays from around a device towards points in it, both in its frame; in turn of each polarization."""
        drawn = []
        for i in range(count):
            at, d = target(), (towards or self.draw.axis)()
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

    # Points and directions of chance, in the frame of a device.

    def within(self, *half: float) -> Point:
        return lambda: [self.draw.between(-h, h) for h in half]

    def ball(self, radius: float, least: float = 0.0) -> Point:
        def point() -> list[float]:
            size = radius * (least + (1 - least) * self.draw.random.random() ** (1 / 3))
            return [size * c for c in self.draw.axis()]

        return point

    def aside(self) -> list[float]:
        """A direction not too near to z."""
        while True:
            d = self.draw.axis()
            if abs(d[2]) < 0.7:
                return d

    def along_x(self, y: float, z: float) -> Point:
        """A direction not too far from x."""
        return lambda: [float(c) for c in unit([1.0, self.draw.between(-y, y), self.draw.between(-z, z)])]

    def body(
        self,
        name: str,
        shape: str,
        faces: list,
        permittivity: float | list,
        permeability: float | list,
        pose: Pose,
        drawn: list[dict],
        least: float = LEAST,
    ) -> None:
        media = f"permittivity = {json.dumps(permittivity)}\npermeability = {json.dumps(permeability)}\n"
        cells = [Cell(Medium.of(permittivity, permeability), faces)]
        device = f'kind = "body"\n{shape}{media}'
        if "corners" in shape:
            device = f'kind = "prisms"\n\n[[device.prism]]\n{shape}{media}'
        self.case(name, TREE, device, pose, through(cells, least), drawn, least=least)


BALL, SLAB = 'shape = "sphere"\nradius = 5.0\n', 'shape = "slab"\nthickness = 3.0\n'
BOX, ROD = 'shape = "box"\nsize = [4.0, 6.0, 8.0]\n', 'shape = "cylinder"\nradius = 3.0\nlength = 10.0\n'
CORNERS = [[-4.0, -2.0], [4.0, -2.0], [1.0, 4.0]]
PRISM = f"corners = {CORNERS}\n"

SLAB_FACES = [plane(-1, [1, 0, 0], 1.5), plane(-1, [-1, 0, 0], 1.5)]
BOX_FACES = [plane(-1, [s * (i == a) for i in range(3)], h / 2) for a, h in enumerate((4.0, 6.0, 8.0)) for s in (1, -1)]
ROD_FACES = [cylinder(3.0), plane(-1, [0, 0, 1], 5.0), plane(-1, [0, 0, -1], 5.0)]
PRISM_FACES = [side(-1, CORNERS[i], CORNERS[(i + 1) % 3], [1 / 3, 0.0]) for i in range(3)]


def isotropic_bodies() -> list[dict]:
    book = Book(11)
    rays, ball, within, body = book.rays, book.ball, book.within, book.body
    glass = [Cell(Medium.of(2.25), [sphere(5.0)])]
    both = _checked(exact_maps.glass_ball(5.0, 1.5, 30 * LEAST), through(glass), 1e-20)
    for pose in (PLAINLY, TURNED):
        book.case(
            "a ball of glass",
            "Descartes's rays with Fresnel's amplitudes, and a ray tree",
            f'kind = "body"\n{BALL}permittivity = 2.25\n',
            pose,
            both,
            rays(4, pose, ball(5.0)),
        )
    centre = [{"origin": [-30.0, 0.0, 0.0], "direction": [1.0, 0.0, 0.0], "polarization": "horizontal"}]
    body("a ball of glass, through its centre", BALL, [sphere(5.0)], 2.25, 1.0, PLAINLY, centre)
    body("a ball of n = -1.3", BALL, [sphere(5.0)], -1.69, -1.0, TURNED, rays(3, TURNED, ball(5.0)))
    body(
        "a ball of n = -1 that reflects nothing", BALL, [sphere(5.0)], -1.0, -1.0, PLAINLY, rays(2, PLAINLY, ball(5.0))
    )
    body(
        "a slab of glass",
        SLAB,
        SLAB_FACES,
        2.25,
        1.0,
        ANYHOW,
        rays(3, ANYHOW, within(1.4, 5, 5), book.along_x(1, 1)),
    )
    body(
        "a box of glass, with total reflection",
        BOX,
        BOX_FACES,
        2.25,
        1.0,
        ANYHOW,
        rays(3, ANYHOW, within(1.8, 2.8, 3.8)),
    )
    body("a rod of glass with ends", ROD, ROD_FACES, 2.25, 1.0, ANYHOW, rays(3, ANYHOW, within(2, 2, 4.5)))
    body("a magneto-dielectric rod", ROD, ROD_FACES, 1.8, 1.4, TURNED, rays(3, TURNED, within(2, 2, 4.5)))
    body("a prism of glass", PRISM, PRISM_FACES, 2.25, 1.0, TURNED, rays(3, TURNED, within(1, 1, 1), book.aside))
    return book.cases


def simple_devices() -> list[dict]:
    book = Book(16)
    loss = [2.25, 1e-6]
    ray = {"origin": [-20.0, 1.0, 2.0], "direction": [1.0, 0.0, 0.0], "polarization": "vertical"}
    book.case(
        "a slab of glass that absorbs",
        "Airy's partial waves",
        f'kind = "body"\n{SLAB}permittivity = {loss}\n',
        PLAINLY,
        exact_maps.absorbing_slab(3.0, loss, 550, 30 * LEAST),
        [ray],
        keys="\n[light]\nwavelength_nm = 550\n",
    )
    for pose in (PLAINLY, ANYHOW):
        book.case(
            "an ideal polarizer",
            "Malus's law",
            'kind = "polarizer"\nwidth = 20.0\nlength = 20.0\nangle = 30.0\n',
            pose,
            exact_maps.polarizer(30.0),
            book.rays(3, pose, book.within(0, 5, 5), book.along_x(1, 1)),
        )
    return book.cases


def transformations() -> list[dict]:
    book = Book(12)
    mapped = "empty space, transformed"
    for pose in (PLAINLY, TURNED, ANYHOW):
        book.case(
            "the square cloak (iii)",
            mapped,
            'kind = "square-cloak"\n',
            pose,
            exact_maps.square_cloak(14.1),
            book.rays(3, pose, book.within(0.5, 5, 3), book.aside),
        )
        book.case(
            "the cylinder cloak",
            mapped,
            'kind = "cylinder-cloak"\n',
            pose,
            exact_maps.round_cloak(10.0, True),
            book.rays(2, pose, book.within(7, 7, 5), book.aside),
        )
        book.case(
            "the sphere cloak",
            mapped,
            'kind = "sphere-cloak"\n',
            pose,
            exact_maps.round_cloak(10.0, False),
            book.rays(2, pose, book.ball(9.5)),
        )
    return book.cases


def _radial(n2: Callable[[float], tuple[float, float]]) -> graded.Medium:
    """A ball of 10 cm, by n^2 and its slope as functions of r in units of the radius."""

    def of(r: np.ndarray) -> tuple[float, np.ndarray]:
        size = float(np.linalg.norm(r))
        value, slope = n2(size / 10)
        return value, slope / 10 * r / size

    return graded.Formula(of)


def _turning(m: float) -> Callable[[float], tuple[float, float]]:
    """n^2 of the balls that turn rays by pi/m: r = 2 v^(1 - 1/m)/(1 + v^2), v = n^m, by Newton's method for ln v."""

    def n2(r: float) -> tuple[float, float]:
        u, power = 1.0, 1 - 1 / m
        for _ in range(200):
            v = math.exp(u)
            value = math.log(2) + power * u - math.log1p(v * v) - math.log(r)
            step = value / (power - 2 * v * v / (1 + v * v))
            u -= max(-0.5, min(0.5, step))
            if abs(step) < 1e-16:
                break
        v, n = math.exp(u), math.exp(u / m)
        return n * n, 2 * n * n / m / r / (power - 2 * v * v / (1 + v * v))

    return n2


def _fisheye(r: float) -> tuple[float, float]:
    return (2 / (1 + r * r)) ** 2, -16 * r / (1 + r * r) ** 3


def graded_balls() -> list[dict]:
    book = Book(13)
    balls = [
        ("invisible-sphere", exact_maps.eaton(10.0, 2 * mp.pi), _turning(0.5)),
        ("bending-sphere", exact_maps.eaton(10.0, mp.pi / 2), _turning(2.0)),
        ("eaton-lens", exact_maps.eaton(10.0, mp.pi), lambda r: (2 / r - 1, -2 / r**2)),
        ("luneburg-lens", exact_maps.luneburg(10.0), lambda r: (2 - r * r, -2 * r)),
        ("fisheye-lens", exact_maps.fisheye(10.0), _fisheye),
    ]
    for kind, oracle, n2 in balls:
        both = _checked(oracle, by_hamilton(_radial(n2), [shell(10.0)]), 1e-9)
        for pose in (PLAINLY, ANYHOW):
            book.case(
                f"the {kind}",
                "closed form, and Hamilton's equations",
                f'kind = "{kind}"\n',
                pose,
                both,
                book.rays(2, pose, book.ball(9.0, 0.3)),
            )
    return book.cases


def graded_media() -> list[dict]:
    book = Book(14)
    between, rays = book.draw.between, book.rays
    gradient = [0.02, 0.05, -0.03]
    box = graded.Formula(lambda r: (1.5**2 + float(np.dot(gradient, r)), np.array(gradient)))
    walls = [
        wall([float(s * (i == a)) for i in range(3)], h / 2) for a, h in enumerate((8.0, 6.0, 10.0)) for s in (1, -1)
    ]
    for pose in (PLAINLY, ANYHOW):
        book.case(
            "a box of graded index",
            HAMILTON,
            f'kind = "graded-box"\nsides = [8.0, 6.0, 10.0]\nindex = 1.5\ngradient = {gradient}\n',
            pose,
            by_hamilton(box, walls),
            rays(2, pose, book.within(3, 2, 4)),
            INTEGRATED,
        )
    for pose in (PLAINLY, ANYHOW):
        book.case(
            "half of Maxwell's fish-eye",
            HAMILTON,
            'kind = "fisheye-hemisphere"\n',
            pose,
            by_hamilton(_radial(_fisheye), [shell(10.0), wall([-1.0, 0.0, 0.0], 0.0)]),
            rays(2, pose, lambda: [between(1, 5), between(-5, 5), between(-5, 5)], book.along_x(1, 1)),
            INTEGRATED,
        )
    gaussian = graded.Gaussian(10.02, 4.25)

    def into_metal(r: np.ndarray, zeta: complex) -> np.ndarray:
        down = -1j * gaussian.derivatives(zeta)[0]
        down /= abs(down)
        return np.array([down.real, down.imag, 0.0])

    metal = graded.Border(lambda r, zeta: zeta.imag, into_metal, True)
    sides = [wall([1.0, 0.0, 0.0], 25.0), wall([-1.0, 0.0, 0.0], 25.0)]
    cloak, carpet = ([*sides, wall([0.0, 1.0, 0.0], height), metal] for height in (57.14 / 2, 28.57))
    finely = "tolerance = 1e-10\n"
    for pose in (PLAINLY, TURNED, ANYHOW):

        def beside() -> list[float]:
            return [0.0, between(0.5, 18) * (1 if book.draw.random.random() < 0.5 else -1), between(-5, 5)]

        book.case(
            "the double-Gaussian cloak (iv)",
            HAMILTON,
            'kind = "double-gaussian-cloak"\n',
            pose,
            by_hamilton(gaussian, cloak, mirrored=True),
            rays(3, pose, beside, book.along_x(0.3, 0.3), 50.0),
            INTEGRATED,
            finely,
        )

    def down() -> list[float]:
        return [float(c) for c in unit([between(-0.6, 0.6), -1.0, between(-0.4, 0.4)])]

    for pose in (PLAINLY, ANYHOW):
        book.case(
            "the Gaussian carpet",
            HAMILTON,
            'kind = "gaussian-carpet"\n',
            pose,
            by_hamilton(gaussian, carpet, floor=True),
            rays(2, pose, lambda: [between(-10, 10), 6.0, between(-5, 5)], down, 50.0),
            INTEGRATED,
            finely,
        )
    for material, radial in [("azimuthal-uniaxial", False), ("radial-uniaxial", True)]:
        for pose in (PLAINLY, ANYHOW):
            book.case(
                f"the cylinder cloak of uniaxial dielectric, {material}: its extraordinary rays",
                HAMILTON,
                f'kind = "cylinder-cloak"\nmaterial = "{material}"\n',
                pose,
                uniaxial_cylinders.cloak(4.0, 10.0, radial, 1e-6),
                rays(2, pose, book.within(6, 6, 2), book.aside),
                INTEGRATED,
                every=False,
            )
    return book.cases


def crystals() -> list[dict]:
    book = Book(15)
    draw, rays, body, few = book.draw, book.rays, book.body, LEAST_IN_CRYSTALS
    for design, positive in [("(i)", True), ("(ii)", False)]:
        material = "positive-uniaxial" if positive else "negative-uniaxial"
        for pose in (PLAINLY, TURNED):
            book.case(
                f"the square cloak {design}",
                TREE,
                f'kind = "square-cloak"\nmaterial = "{material}"\n',
                pose,
                through(_square_cloak(positive), few),
                rays(2, pose, book.within(0.1, 5, 2), book.along_x(0.25, 0.3)),
                least=few,
            )
    eps, _ = draw.uniaxial(2.0, 3.0)
    body(
        "a slab of a uniaxial crystal",
        SLAB,
        SLAB_FACES,
        eps,
        1.0,
        TURNED,
        rays(3, TURNED, book.within(1.4, 5, 5), book.along_x(1, 1)),
        few,
    )
    body(
        "a ball of a biaxial crystal",
        BALL,
        [sphere(5.0)],
        draw.biaxial(1.8, 3.5),
        1.0,
        ANYHOW,
        rays(3, ANYHOW, book.ball(2.5)),
        few,
    )
    body(
        "a prism of a crystal, electric and magnetic",
        PRISM,
        PRISM_FACES,
        draw.biaxial(1.8, 3.0),
        draw.biaxial(0.8, 1.5),
        ANYHOW,
        rays(3, ANYHOW, book.within(1, 1, 1), book.aside),
        few,
    )
    return book.cases


def cases() -> Iterator[dict]:
    """The cases, of crystals last, for they take longest."""
    for part in (isotropic_bodies, simple_devices, transformations, graded_balls, graded_media, crystals):
        yield from part()
