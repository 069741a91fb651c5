"""Waves on a device by finite elements of high order (NGSolve): the field across the axis, in two dimensions.

The scalar u is H_z or E_z; fields vary as exp(-i omega t), as in cloakroom. With H along z

    div(A grad u) + k^2 m u = 0,   A = eps / det(eps) in the plane,   m = mu_zz,

and dA u/dn = 0 on metal; with E along z the same with eps and mu exchanged, and u = 0 on metal. The unknown is the
scattered field, which a perfectly matched layer absorbs around a disk; the incident one is given in closed form.
"""

from dataclasses import dataclass

import numpy as np
from netgen.occ import Circle, Glue, OCCGeometry, Rectangle, WorkPlane
from ngsolve import (
    H1, BilinearForm, CoefficientFunction, GridFunction, IfPos, InnerProduct, LinearForm, Mesh, VoxelCoefficient,
    cos, ds, dx, exp, grad, pml, sin, specialcf, x, y,
)  # fmt: skip
from scipy.special import hankel1

MAGNETIC, ELECTRIC = "H_z", "E_z"


@dataclass(frozen=True)
class Case:
    """What is computed. `show` is "cloak", "bare" or "mirror"; lengths in cm, angles in degrees."""

    show: str
    polarization: str
    wavelength: float
    rotation: float = 0.0
    order: int = 8  # of the elements
    size: float = 0.8  # of the elements in air, in wavelengths
    beam: tuple | None = None  # waist radius, height; its waist is at x = 0 and it goes along x

    @property
    def symmetric(self):
        """Whether the plane y = 0 is a mirror plane of the field, so that half of it is enough."""
        return self.rotation == 0 and self.beam is None


def polygon(corners):
    path = WorkPlane().MoveTo(*map(float, corners[0]))
    for corner in corners[1:]:
        path = path.LineTo(*map(float, corner))
    return path.Close().Face()


def turned(points, angle):
    c, s = np.cos(np.radians(angle)), np.sin(np.radians(angle))
    return np.asarray(points) @ np.array([[c, s], [-s, c]])


class Waves:
    """The mesh around a device, and the fields on it."""

    def __init__(self, device, case, radius):
        self.device, self.case, self.radius = device, case, radius
        self.k = 2 * np.pi / case.wavelength
        thin = device.mirror * np.array([[-1, 0], [0, -2e-5], [1, 0], [0, 2e-5]])
        self.metal = turned(thin if case.show == "mirror" else device.metal, case.rotation)
        self.mesh = self.meshed()
        self.solve()

    def regions(self):
        """The cells of the cloak: their corners, name and size of elements."""
        if self.case.show != "cloak":
            return []
        wavelength = self.case.size * self.case.wavelength
        if self.device.segments:
            return [
                (turned(corners, self.case.rotation), f"segment{i}", wavelength / 2)
                for i, (corners, _, _) in enumerate(self.device.segments)
            ]
        return [(turned(self.device.outline, self.case.rotation), "graded", wavelength / 1.4)]

    def meshed(self):
        thick = max(1.5 * self.case.wavelength, 1.0)
        outer, inner = Circle((0, 0), self.radius + thick).Face(), Circle((0, 0), self.radius).Face()
        metal = polygon(self.metal)
        ring, air = outer - inner, inner - metal
        ring.faces.name, air.faces.name = "pml", "air"
        ring.faces.maxh = air.faces.maxh = self.case.size * self.case.wavelength
        parts = [ring]
        for corners, name, size in self.regions():
            cell = polygon(corners) - metal
            air = air - cell
            cell.faces.name, cell.faces.maxh = name, size
            parts.append(cell)
        air.faces.name, air.faces.maxh = "air", self.case.size * self.case.wavelength
        parts.append(air)
        if self.case.symmetric:
            reach = 2 * self.radius + 2 * thick
            half = WorkPlane().MoveTo(-reach, 0).Rectangle(2 * reach, reach).Face()
            names = [(p.faces[0].name, p.faces[0].maxh) for p in parts]
            parts = [p * half for p in parts]
            for part, (name, size) in zip(parts, names):
                part.faces.name, part.faces.maxh = name, size
            parts = [p for p in parts if len(p.faces)]
        whole = Glue(parts)
        for edge in whole.edges:
            edge.name = "metal" if self.on_metal(np.array([edge.center.x, edge.center.y])) else "other"
        # Fields are singular at the ends of metal.
        for vertex in whole.vertices:
            if self.on_metal(np.array([vertex.p.x, vertex.p.y])):
                vertex.maxh = self.case.wavelength / 50
        mesh = Mesh(OCCGeometry(whole, dim=2).GenerateMesh(grading=0.5))
        mesh.Curve(self.case.order)
        mesh.SetPML(pml.Radial(rad=self.radius, alpha=1j, origin=(0, 0)), "pml")
        return mesh

    def on_metal(self, point):
        start, end = self.metal, np.roll(self.metal, -1, axis=0)
        along = end - start
        share = np.clip(((point - start) * along).sum(1) / (along**2).sum(1), 0, 1)
        return np.hypot(*(start + share[:, None] * along - point).T).min() < 1e-7

    def medium(self):
        """A and m of the wave equation, on the whole mesh."""
        swap = self.case.polarization == ELECTRIC
        if self.case.show == "cloak" and self.device.grid:
            c, s = np.cos(np.radians(self.case.rotation)), np.sin(np.radians(self.case.rotation))
            gx, gy, values = self.device.grid
            # Places in the frame of the device; the form is complex and asks for complex values.
            graded = VoxelCoefficient(
                (gx[0], gy[0]), (gx[-1], gy[-1]), np.ascontiguousarray(values.T.astype(complex)), linear=True,
                trafocf=CoefficientFunction((c * x + s * y, -s * x + c * y)),
            )  # fmt: skip
            one = CoefficientFunction(1.0)
            return {"graded": ((one, graded) if swap else (1 / graded, one))}
        media = {}
        for i, (_, eps, mu) in enumerate(self.device.segments if self.case.show == "cloak" else []):
            plane, along = (mu, eps) if swap else (eps, mu)
            c, s = np.cos(np.radians(self.case.rotation)), np.sin(np.radians(self.case.rotation))
            r = np.array([[c, -s], [s, c]])
            a = r @ plane[:2, :2] @ r.T / np.linalg.det(plane[:2, :2])
            media[f"segment{i}"] = (CoefficientFunction(tuple(a.ravel()), dims=(2, 2)), CoefficientFunction(along[2, 2]))
        return media

    def into_metal(self):
        """The normal on metal that points into it: all surfaces of the metals face away from y = 0."""
        c, s = np.cos(np.radians(self.case.rotation)), np.sin(np.radians(self.case.rotation))
        along, across = c * x + s * y, -s * x + c * y
        outward = CoefficientFunction((1e-3 * c * along - s * across, 1e-3 * s * along + c * across))
        n = specialcf.normal(2)
        return IfPos(n * outward, -n, n)

    def incident(self):
        """The incident field: a plane wave of amplitude 1 along x, or a beam made of plane waves."""
        if self.case.beam is None:
            return exp(1j * self.k * x)
        waist, height = self.case.beam
        spread = min(2 / (self.k * waist) * 3.2, 1.4)
        # As many waves as keep the copies of the beam, which a sum instead of an integral has, away.
        count = int(np.ceil(2 * spread * self.k * (2 * self.radius) / (2 * np.pi))) | 1
        angles = np.linspace(-spread, spread, count)
        weights = np.exp(-((self.k * waist * np.sin(angles) / 2) ** 2)) * np.cos(angles)
        weights /= weights.sum()
        return sum(
            w * exp(1j * self.k * (np.cos(a) * x + np.sin(a) * (y - height))) for a, w in zip(angles, weights)
        )

    def solve(self):
        mesh, k, case = self.mesh, self.k, self.case
        electric = case.polarization == ELECTRIC
        space = H1(mesh, order=case.order, complex=True, dirichlet="metal" if electric else "")
        u, v = space.TnT()
        media = self.medium()
        u_in = self.incident()
        grad_in = CoefficientFunction((u_in.Diff(x), u_in.Diff(y)))
        more = 4 if self.device.grid else 0
        a = BilinearForm(space, symmetric=True, condense=True)
        load = LinearForm(space)
        plain = "|".join(sorted(set(mesh.GetMaterials()) - set(media)))
        a += (grad(u) * grad(v) - k**2 * u * v) * dx(definedon=mesh.Materials(plain))
        for name, (tensor, scalar) in media.items():
            region = dx(definedon=mesh.Materials(name), bonus_intorder=more)
            a += (InnerProduct(tensor * grad(u), grad(v)) - k**2 * scalar * u * v) * region
            load += (-(tensor * grad_in - grad_in) * grad(v) + k**2 * (scalar - 1) * u_in * v) * region
        if not electric:
            load += -(grad_in * self.into_metal()) * v * ds("metal", bonus_intorder=4)
        a.Assemble()
        load.Assemble()
        self.scattered = field = GridFunction(space)
        if electric:
            field.Set(-u_in, definedon=mesh.Boundaries("metal"))
        load.vec.data -= a.mat * field.vec
        load.vec.data += a.harmonic_extension_trans * load.vec
        inverse = a.mat.Inverse(space.FreeDofs(True), inverse="sparsecholesky")
        correction = field.vec.CreateVector()
        correction.data = inverse * load.vec
        field.vec.data += correction
        field.vec.data += a.harmonic_extension * field.vec
        field.vec.data += a.inner_solve * load.vec
        self.unknowns = space.ndof
        self.total, self.total_gradient = field + u_in, grad(field) + grad_in

    def at(self, function, points):
        """Values at points (n, 2); half a field is continued across y = 0."""
        points = np.array(points, dtype=float)
        sign = 1.0
        if self.case.symmetric:
            sign = np.where(points[:, 1] < 0, -1.0, 1.0)
            points[:, 1] = np.maximum(np.abs(points[:, 1]), 1e-9)
        values = np.array(function(self.mesh(points[:, 0], points[:, 1])))
        if values.shape[1] == 2:
            values[:, 1] *= sign
            return values
        return values[:, 0]

    def multipoles(self, radius, count=None):
        """Amplitudes c_n of H_n(k r) exp(i n phi) in the scattered field, and n."""
        count = count or 2 * int(self.k * radius * 1.3 + 20)
        phi = 2 * np.pi * np.arange(count) / count
        u = self.at(self.scattered, radius * np.column_stack([np.cos(phi), np.sin(phi)]))
        n = np.fft.fftfreq(count, 1 / count).astype(int)
        keep = np.abs(n) < self.k * radius + 10
        return (np.fft.fft(u) / count)[keep] / hankel1(n[keep], self.k * radius), n[keep]

    def widths(self, radius):
        """Scattering and extinction width, cm: equal where no light is lost."""
        c, n = self.multipoles(radius)
        return 4 / self.k * (np.abs(c) ** 2).sum(), -4 / self.k * (c * np.conj(1j**n)).real.sum()


def pattern(multipoles, orders, wavelength, angles):
    """Differential scattering width, cm per radian, at angles in degrees."""
    f = (multipoles * (-1j) ** orders) @ np.exp(1j * np.outer(orders, np.radians(angles)))
    return wavelength / np.pi**2 * np.abs(f) ** 2
