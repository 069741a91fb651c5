"""Where devices stand: the frame of a device and that of the world."""

from __future__ import annotations

from dataclasses import dataclass, field

from mpmath import mp

from plane_waves import Vector, added, cross, dot, real, scaled, unit


@dataclass
class Pose:
    """Turned by `rotation` degrees about z, then by the shortest turn of z to `axis`, then moved to `position`, cm."""

    position: list[float] = field(default_factory=lambda: [0.0, 0.0, 0.0])
    rotation: float = 0.0
    axis: list[float] = field(default_factory=lambda: [0.0, 0.0, 1.0])

    @property
    def keys(self) -> str:
        """The keys of a scene file."""
        return f"position = {self.position}\nrotation = {self.rotation}\naxis = {self.axis}\n"

    @property
    def columns(self) -> list[Vector]:
        """Where the device's own x, y and z point."""
        angle = mp.radians(self.rotation)
        sin, cos = mp.sin(angle), mp.cos(angle)
        to = unit(real(self.axis))
        turn = cross(real([0, 0, 1]), to)
        assert to[2] > -1

        def turned(v: Vector) -> Vector:
            # Rodrigues's formula; 1 + to_z is (1 - cos)/sin^2, turned over.
            about = scaled(turn, dot(turn, v) / (1 + to[2]))
            return added(added(scaled(v, to[2]), cross(turn, v)), about)

        return [turned([cos, sin, 0]), turned([-sin, cos, 0]), to]

    def vector_out(self, v: Vector) -> Vector:
        x, y, z = self.columns
        return added(added(scaled(x, v[0]), scaled(y, v[1])), scaled(z, v[2]))

    def vector_in(self, v: Vector) -> Vector:
        return [dot(column, v) for column in self.columns]

    def point_out(self, v: Vector) -> Vector:
        return added(self.vector_out(v), real(self.position))

    def point_in(self, v: Vector) -> Vector:
        return self.vector_in(added(v, scaled(real(self.position), -1)))
