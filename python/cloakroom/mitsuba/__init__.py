"""Cloaks and other devices in the rooms of Mitsuba 3: among furniture, in its light and shadow.

Importing it registers two plugins in every variant that computes wavefronts (``llvm_ad_rgb``, ``cuda_ad_spectral`` ...):

- the BSDF ``cloakroom``: a device, on a shape that bounds it; `device` makes both;
- the integrator ``cloakroom_path``: a path tracer that takes rays through devices.

>>> import mitsuba as mi
>>> import cloakroom.mitsuba as rooms
>>> mi.set_variant("llvm_ad_rgb")
>>> room = mi.cornell_box()
>>> room["cloak"] = rooms.device({"kind": "sphere-cloak"}, mi.ScalarTransform4f().translate([0.2, 0.6, 0.3]), unit=32)
>>> room["integrator"] = {"type": "cloakroom_path", "max_depth": 8}
>>> image = mi.render(mi.load_dict(room), spp=4)
>>> image.shape
(256, 256, 3)

What cannot be: variants without wavefronts (``scalar_...``), since devices are traced many rays at a time; geometry
within the bounding shape of a device; light tracing (``ptracer``), photons and derivatives through a device; participating
media. In polarized variants devices act on Stokes vectors; ``{"type": "stokes", "nested": {"type": "cloakroom_path"}}`` gives
their images.
"""

from ._llvm import choose

choose()

import mitsuba as _mitsuba  # noqa: E402

if not (3, 9) <= tuple(int(part) for part in _mitsuba.__version__.split(".")[:2]) < (3, 10):
    raise ImportError(f"mitsuba is {_mitsuba.__version__}; cloakroom.mitsuba goes with 3.9: pip install 'mitsuba>=3.9,<3.10'")

from ._plugins import register  # noqa: E402
from ._shape import device  # noqa: E402

__all__ = ["device", "register"]

register()
_mitsuba.detail.add_variant_callback(lambda _old, _new: register())
