"""The scene of strip.pov in Mitsuba 3: strip_mitsuba.py VARIANT HALF_WIDTH SAMPLES PHOTOGRAPH PICTURE"""

import sys

import mitsuba as mi

variant, half_width, samples, photograph, picture = sys.argv[1:]
mi.set_variant(variant)
from mitsuba import ScalarTransform4f as T  # noqa: E402  (it exists once there is a variant)

# A rectangle in the xy-plane, twice as long along its y axis as the view is wide, onto the strip.
turned = T().rotate([0, 0, 1], 10)
strip = turned @ T().rotate([1, 0, 0], 90) @ T().scale([float(half_width), 1000, 1])
# The photograph, its front towards the camera and its left side to -z.
photo = T().translate([50, 0, 0]) @ T().rotate([0, 1, 0], -90) @ T().scale([55, 68.75, 1])

scene = mi.load_dict(
    {
        "type": "scene",
        # Camera, mirror, photograph; once more for rays that meet the strip on its edge.
        "integrator": {"type": "path", "max_depth": 3},
        "sensor": {
            "type": "perspective",
            "fov": 40,
            "fov_axis": "x",
            "to_world": T().look_at(origin=[-100, 0, 0], target=[50, 0, 0], up=[0, 1, 0]),
            "film": {
                "type": "hdrfilm",
                "width": 1024,
                "height": 1024,
                "rfilter": {"type": "box"},
            },
            "sampler": {"type": "independent", "sample_count": int(samples)},
        },
        "photograph": {
            "type": "rectangle",
            "to_world": photo,
            "emitter": {
                "type": "area",
                "radiance": {
                    "type": "bitmap",
                    "filename": photograph,
                    "wrap_mode": "clamp",
                    "to_uv": T().translate([0, 1, 0]) @ T().scale([1, -1, 1]),
                },
            },
        },
        "strip": {
            "type": "rectangle",
            "to_world": strip,
            "bsdf": {"type": "twosided", "bsdf": {"type": "conductor", "material": "none"}},
        },
    }
)
mi.util.write_bitmap(picture, mi.render(scene), write_async=False)
