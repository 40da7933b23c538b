"""What the add-on's tests share: the add-on itself, and an object that has no symmetry."""

import os
import sys

import bpy
import numpy as np

sys.path.insert(0, os.path.join(os.path.dirname(__file__), "..", "..", "blender"))
sys.dont_write_bytecode = True

import hydrodip_addon  # noqa: E402

QUICK = ("--set film.elements=1500 --set dip.step_mm=1 --set dip.air_cells=0 --set preview.pictures=off "
         "--set plan.suggest=off")


def start(scale_length):
    """An empty scene whose unit is so many metres, with the add-on."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    if not hasattr(bpy.types.Scene, "hydrodip"):
        hydrodip_addon.register()
    scene = bpy.context.scene
    scene.unit_settings.system = "METRIC"
    scene.unit_settings.scale_length = scale_length
    settings = scene.hydrodip
    settings.film, settings.film_mm = "own", (110, 90)
    settings.options = QUICK
    return scene, settings


COLORS = ((0.8, 0.1, 0.1), (0.1, 0.6, 0.2), (0.1, 0.2, 0.8), (0.9, 0.8, 0.1))


def keel(mm_per_unit, location_mm=(300, -200, 150), turn_deg=(20, -15, 40)):
    """A bowl of 44 x 36 x 16 mm, higher on one side, coloured by the quarter of its own x and y."""
    n, rings = 32, 10
    points, uv = [[0.0, 0.0, 0.0]], [[0.5, 0.5]]
    for ring in range(1, rings + 1):
        r = ring / rings
        for k in range(n):
            a = 2 * np.pi * k / n
            x, y = 22 * r * np.cos(a), 18 * r * np.sin(a)
            points.append([x, y, 12 * r**2 + 0.1 * x + 2 * r * max(np.sin(a), 0)])
            uv.append([0.5 + x / 50, 0.5 + y / 50])
    faces = [[0, 1 + (k + 1) % n, 1 + k] for k in range(n)]
    for ring in range(rings - 1):
        for k in range(n):
            a, b = 1 + ring * n + k, 1 + ring * n + (k + 1) % n
            faces += [[a, b, b + n], [a, b + n, a + n]]
    top = len(points)
    points.append([0, 0, 16.0])
    uv.append([0.5, 0.5])
    first = 1 + (rings - 1) * n
    faces += [[top, first + k, first + (k + 1) % n] for k in range(n)]
    mesh = bpy.data.meshes.new("keel")
    mesh.from_pydata((np.array(points) / mm_per_unit).tolist(), [], faces)
    layer = mesh.uv_layers.new()
    for loop in mesh.loops:
        layer.data[loop.index].uv = uv[loop.vertex_index]
    image = bpy.data.images.new("quarters", 64, 64)
    pixels = np.ones((64, 64, 4), np.float32)
    for q, color in enumerate(COLORS):
        pixels[32 * (q // 2) : 32 * (q // 2) + 32, 32 * (q % 2) : 32 * (q % 2) + 32, :3] = color
    image.pixels.foreach_set(pixels.ravel())
    material = bpy.data.materials.new("quarters")
    material.use_nodes = True
    texture = material.node_tree.nodes.new("ShaderNodeTexImage")
    texture.image = image
    texture.interpolation = "Closest"
    shader = material.node_tree.nodes["Principled BSDF"]
    material.node_tree.links.new(shader.inputs["Base Color"], texture.outputs["Color"])
    mesh.materials.append(material)
    mesh.update()
    made = bpy.data.objects.new("keel", mesh)
    bpy.context.scene.collection.objects.link(made)
    made.location = np.array(location_mm) / mm_per_unit
    made.rotation_euler = np.radians(turn_deg)
    bpy.context.view_layer.objects.active = made
    bpy.context.view_layer.update()
    return made


def brought(role):
    (found,) = [o for o in bpy.data.objects if o.get("hydrodip") == role]
    return found


def places(made):
    """Of its vertices, in the scene."""
    flat = np.empty(3 * len(made.data.vertices), np.float32)
    made.data.vertices.foreach_get("co", flat)
    matrix = np.array(made.matrix_world)
    return flat.reshape(-1, 3) @ matrix[:3, :3].T + matrix[:3, 3]


def attribute(made, name):
    values = np.empty(len(made.data.vertices), np.float32)
    made.data.attributes[name].data.foreach_get("value", values)
    return values


def nearest(target, point):
    """Distance to a point of the scene, and the place there in the object's own coordinates."""
    own = target.matrix_world.inverted() @ point
    found, place, _, _ = target.closest_point_on_mesh(
        own, depsgraph=bpy.context.evaluated_depsgraph_get())
    assert found
    return (target.matrix_world @ place - point).length, place
