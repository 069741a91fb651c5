"""Outlines of devices in Blender itself, where its module `bpy` is installed."""

from __future__ import annotations

import importlib.util
import json
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from cloakroom import Scatterer, Scene

#: Imports a file as Blender's menu does, and tells the corners of its meshes in the world.
IMPORT = """
import bpy, json, sys
bpy.ops.wm.read_factory_settings(use_empty=True)
bpy.ops.import_scene.gltf(filepath=sys.argv[1])
meshes = [each for each in bpy.data.objects if each.type == "MESH"]
corners = {each.name: [list(each.matrix_world @ corner.co) for corner in each.data.vertices] for each in meshes}
with open(sys.argv[2], "w") as out:
    json.dump(corners, out)
"""


@pytest.mark.skipif(importlib.util.find_spec("bpy") is None, reason="bpy is not installed: pip install bpy")
def test_outlines_stand_in_blender_where_devices_do(
    command: Callable[..., subprocess.CompletedProcess[str]], tmp_path: Path
) -> None:
    """In metres, and with Blender's z for what is up."""
    scene = tmp_path / "scene.toml"
    scene.write_text(
        '[[device]]\nkind = "square-cloak"\nlength = 40\nrotation = 20\naxis = [0.2, 0.3, 1]\nposition = [10, 20, 30]\n'
    )
    model, found = tmp_path / "cloak.glb", tmp_path / "corners.json"
    command("export", scene, "-o", model)
    # In a process of its own: Blender keeps what it has set up.
    subprocess.run([sys.executable, "-c", IMPORT, str(model), str(found)], check=True, capture_output=True, timeout=120)
    meshes = json.loads(found.read_text())
    outlines = Scatterer(Scene.load(scene), unit=100).outlines()
    assert len(meshes) == len(outlines) and all("square-cloak" in name for name in meshes)

    seen = np.concatenate([np.array(corners) for corners in meshes.values()])
    there = np.concatenate([outline.triangles.reshape(-1, 3) for outline in outlines])
    # Blender's x is ours, its y goes against our z, and its z is our y.
    expected = np.column_stack([there[:, 0], -there[:, 2], there[:, 1]])
    for one, other in ((seen, expected), (expected, seen)):
        apart = np.linalg.norm(one[:, None] - other[None], axis=-1).min(axis=1)
        assert apart.max() < 1e-6
    assert np.ptp(seen, axis=0).max() > 0.3
