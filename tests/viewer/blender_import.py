"""Blender imports preview.glb with its texture. Usage, with the Debian package blender:
blender -b --factory-startup -noaudio --python-exit-code 1 -P blender_import.py -- preview.glb"""
import sys

import numpy

numpy.bool = bool  # Debian 12's importer asks for it, Debian 12's numpy no longer has it
import bpy  # noqa: E402

bpy.ops.wm.read_factory_settings(use_empty=True)
bpy.ops.import_scene.gltf(filepath=sys.argv[-1])

film = bpy.data.objects["film"]
(material,) = film.data.materials
(texture,) = [node.image for node in material.node_tree.nodes if node.type == "TEX_IMAGE"]
print(f"film: {len(film.data.polygons)} triangles, texture {tuple(texture.size)}")
assert len(film.data.polygons) > 100 and len(film.data.uv_layers) == 1
assert min(texture.size) > 10
colors = {tuple(round(c, 1) for c in texture.pixels[i : i + 3]) for i in range(0, len(texture.pixels), 400)}
assert len(colors) > 3, "the texture is plain"
# Metres: the film lies on the object, and hardly stands out of it.
for a, b in zip(film.dimensions, bpy.data.objects["object"].dimensions):
    assert 0 < a < b + 0.001, (a, b)
