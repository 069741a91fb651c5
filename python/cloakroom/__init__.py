"""Physically exact pictures of invisibility cloaks and other transformation-optics devices.

A scene has a camera, a photograph and devices; rays are traced through the physical media of the devices, with
polarization, Fresnel reflections and times of flight. Lengths are in cm, angles in degrees, times in ns; x is forward
along the line of sight, y up, z right.

>>> import cloakroom
>>> scene = cloakroom.Scene(devices=cloakroom.SquareCloak(material="negative-uniaxial", rotation=10))
>>> picture = scene.render(samples=1, resolution=(64, 48))
>>> picture.image.shape
(48, 64, 3)

The devices are those of Halimeh & Wegener, "Photorealistic rendering of unidirectional free-space invisibility
cloaks", Opt. Express 21, 9457 (2013), and more; `cloakroom.tables.DEVICES` has them all.
"""

from . import tables
from ._cloakroom import __version__, set_threads, threads
from .drawings import Drawing
from .exporting import export
from .interfaces import Interface, Medium, Modes, interface
from .labelled import Arrays
from .materials import Material
from .measuring import Finding, flux, quality, sweep, verify
from .optimizing import Optimum, optimize
from .pages import Page
from .papers import figures
from .pictures import Picture
from .rays import Paths, Traced, trace
from .scatterers import Bounds, Outline, Scattered, Scatterer
from .scenes import Estimate, Scene
from .tables import *  # noqa: F403

__all__ = [
    "Arrays",
    "Bounds",
    "Drawing",
    "Estimate",
    "Finding",
    "Interface",
    "Material",
    "Medium",
    "Modes",
    "Optimum",
    "Outline",
    "Page",
    "Paths",
    "Picture",
    "Scattered",
    "Scatterer",
    "Scene",
    "Traced",
    "__version__",
    "export",
    "figures",
    "flux",
    "interface",
    "optimize",
    "quality",
    "set_threads",
    "sweep",
    "tables",
    "threads",
    "trace",
    "verify",
]
__all__ += [name for name in tables.__all__ if name not in ("DEVICES", "TABLES", "class_name")]
