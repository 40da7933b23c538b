"""Objects and images between Blender and the program's files.

The program's frame is Blender's: z up, and the object enters the water with its lowest point first.
Only lengths differ. What is exported is the object as it stands in the scene; the program then moves
the middle of its bounding box over the film's and its lowest point to z = 0, and says where the film
is in that frame. `Frame` goes back.
"""

import os

import bpy
import numpy as np
from mathutils import Matrix

from . import geometry

TAG = "hydrodip"  # custom property of what the add-on made


class Frame:
    """From the posed object's frame, mm, to the scene."""

    def __init__(self, mm_per_unit, offset_mm=(0.0, 0.0, 0.0)):
        self.mm_per_unit, self.offset_mm = mm_per_unit, np.asarray(offset_mm, float)

    def to_scene(self, points_mm):
        return (np.asarray(points_mm, float) + self.offset_mm) / self.mm_per_unit


def _srgb(linear):
    c = np.clip(linear, 0, 1)
    return np.where(c <= 0.0031308, 12.92 * c, 1.055 * c ** (1 / 2.4) - 0.055)


# ---- out ----


def _picture_of(material):
    """The image and colour that a material's Principled shader takes its base colour from."""
    if material is None or not material.use_nodes:
        return None, _srgb(np.array(material.diffuse_color[:3])) if material else np.ones(3)
    shader = _shader_of(material)
    if shader is None:
        return None, np.ones(3)
    base = shader.inputs["Base Color"]
    if base.is_linked:
        source = base.links[0].from_node
        return (source.image if source.type == "TEX_IMAGE" else None), np.ones(3)
    return None, _srgb(np.array(base.default_value[:3]))


def _shader_of(material):
    # By its type: Blender may name new nodes in the user's language.
    return next((node for node in material.node_tree.nodes if node.type == "BSDF_PRINCIPLED"), None)


def _save_picture(image, folder, number):
    # By its pixels: what was painted and never saved is in no file.
    name = f"texture-{number}.png"
    width, height = image.size
    if width * height == 0:
        raise ValueError(f"the image '{image.name}' cannot be read")
    pixels = np.empty(width * height * image.channels, np.float32)
    image.pixels.foreach_get(pixels)
    pixels = pixels.reshape(-1, image.channels)
    if image.is_float:
        pixels[:, :3] = _srgb(pixels[:, :3])
    rgba = np.ones((width * height, 4), np.float32)
    rgba[:, : pixels.shape[1]] = pixels
    if pixels.shape[1] == 1:
        rgba[:, :3] = pixels
    copy = bpy.data.images.new(name, width, height, alpha=True)
    copy.pixels.foreach_set(rgba.ravel())
    copy.filepath_raw = os.path.join(folder, name)
    copy.file_format = "PNG"
    copy.save()
    bpy.data.images.remove(copy)
    return name


def _vertex_colors(mesh):
    layer = mesh.color_attributes.active_color if mesh.color_attributes else None
    if layer is None:
        return None
    values = np.empty(4 * len(layer.data), np.float32)
    layer.data.foreach_get("color", values)
    values = values.reshape(-1, 4)[:, :3]
    if layer.domain == "CORNER":
        corner = np.empty(len(mesh.loops), np.int64)
        mesh.loops.foreach_get("vertex_index", corner)
        colors = np.ones((len(mesh.vertices), 3))
        colors[corner] = values
        values = colors
    return _srgb(values)


def export(target, file, mm_per_unit):
    """Writes the object as it stands, with modifiers, textures and colours. Returns the frame."""
    evaluated = target.evaluated_get(bpy.context.evaluated_depsgraph_get())
    mesh = evaluated.to_mesh()
    try:
        mesh.calc_loop_triangles()
        count = len(mesh.loop_triangles)
        if count == 0:
            raise ValueError(f"'{target.name}' has no faces")
        points = np.empty(3 * len(mesh.vertices), np.float32)
        mesh.vertices.foreach_get("co", points)
        matrix = np.array(evaluated.matrix_world, float)
        points = points.reshape(-1, 3).astype(float) @ matrix[:3, :3].T + matrix[:3, 3]
        points *= mm_per_unit
        corners = np.empty(3 * count, np.int32)
        mesh.loop_triangles.foreach_get("vertices", corners)
        loops = np.empty(3 * count, np.int32)
        mesh.loop_triangles.foreach_get("loops", loops)
        material_of = np.empty(count, np.int32)
        mesh.loop_triangles.foreach_get("material_index", material_of)
        uv = None
        if mesh.uv_layers.active:
            uv = np.empty(2 * len(mesh.loops), np.float32)
            mesh.uv_layers.active.data.foreach_get("uv", uv)
            uv = uv.reshape(-1, 2)[loops].reshape(count, 3, 2)
        colors = _vertex_colors(mesh)
        triangles = corners.reshape(count, 3)
    finally:
        evaluated.to_mesh_clear()
    if np.linalg.det(matrix[:3, :3]) < 0:  # mirrored: the outside stays outside
        triangles = triangles[:, ::-1]
        uv = None if uv is None else uv[:, ::-1]
    used, numbers = np.unique(triangles, return_inverse=True)
    triangles, points = numbers.reshape(-1, 3), points[used]
    low, high = points.min(axis=0), points.max(axis=0)
    largest = (high - low).max()
    if not 5 <= largest <= 1000:
        raise ValueError(
            f"'{target.name}' would be {largest:.3g} mm large: set the scene's unit scale, or say under "
            "Unit what one unit is")
    folder = os.path.dirname(file)
    materials = []
    for slot in target.material_slots:
        image, color = _picture_of(slot.material)
        picture = None
        if image is not None and uv is not None:
            picture = _save_picture(image, folder, len(materials))
        materials.append({"color": color, "picture": picture})
    if any(m["picture"] for m in materials):
        colors = None
    elif colors is not None:
        colors, materials = colors[used], []
    geometry.write_obj(file, points, triangles, uv, colors, np.clip(material_of, 0, max(len(materials) - 1, 0)), materials)
    return Frame(mm_per_unit, [0.5 * (low[0] + high[0]), 0.5 * (low[1] + high[1]), low[2]])


# ---- back ----


def _collection(scene):
    found = bpy.data.collections.get(TAG) or bpy.data.collections.new(TAG)
    if found.name not in scene.collection.children:
        scene.collection.children.link(found)
    return found


def clear(scene, roles):
    """Removes what earlier runs brought in these roles."""
    for each in list(bpy.data.objects):
        if each.get(TAG) in roles:
            mesh = each.data
            bpy.data.objects.remove(each)
            if mesh.users == 0:
                bpy.data.meshes.remove(mesh)


def _material(name, image=None, color=(1, 1, 1, 1), alpha=False):
    material = bpy.data.materials.new(name)
    material.use_nodes = True
    shader = _shader_of(material)
    shader.inputs["Roughness"].default_value = 0.6
    shader.inputs["Base Color"].default_value = color
    if image is not None:
        texture = material.node_tree.nodes.new("ShaderNodeTexImage")
        texture.image = image
        texture.location = (-320, 300)
        material.node_tree.links.new(shader.inputs["Base Color"], texture.outputs["Color"])
        if alpha:
            material.node_tree.links.new(shader.inputs["Alpha"], texture.outputs["Alpha"])
            if hasattr(material, "surface_render_method"):  # Blender 4.2 and later
                material.surface_render_method = "BLENDED"
            else:
                material.blend_method = "BLEND"
    return material


def _object(scene, role, vertices, triangles, uv=None, materials=(), material_of=None):
    mesh = bpy.data.meshes.new(f"hydrodip {role}")
    mesh.from_pydata(np.asarray(vertices).tolist(), [], np.asarray(triangles).tolist())
    if uv is not None:
        layer = mesh.uv_layers.new(name="film")
        layer.data.foreach_set("uv", np.asarray(uv)[np.asarray(triangles).ravel()].astype(np.float32).ravel())
    for material in materials:
        mesh.materials.append(material)
    if material_of is not None:
        mesh.polygons.foreach_set("material_index", np.asarray(material_of, np.int32))
    mesh.validate()
    mesh.update()
    made = bpy.data.objects.new(f"hydrodip {role}", mesh)
    made[TAG] = role
    _collection(scene).objects.link(made)
    return made


def load_image(file):
    image = bpy.data.images.load(file, check_existing=True)
    image.reload()
    return image


def _embedded(picture, folder, name):
    data, kind = picture
    file = os.path.join(folder, name + (".png" if kind == "image/png" else ".jpg"))
    with open(file, "wb") as out:
        out.write(data)
    return load_image(file)


def bring_film(scene, frame, folder, sheet):
    """The whole film where the dip leaves it, with its stretch, and the sheet's picture on it."""
    vertices, triangles = geometry.read_film(os.path.join(folder, "film.ply"))
    flat = np.stack([vertices["u"], vertices["v"]], axis=1)
    size = np.array(sheet["size_mm"])
    image = load_image(sheet["picture"]) if sheet["picture"] else None
    material = _material("hydrodip film", image, (0.75, 0.85, 0.9, 1), alpha=image is not None)
    made = _object(
        scene, "film", frame.to_scene(np.stack([vertices[k] for k in "xyz"], axis=1)), triangles,
        flat / size + 0.5, [material])
    for name in ("stretch", "area_ratio", "state"):
        made.data.attributes.new(name, "FLOAT", "POINT").data.foreach_set(
            "value", np.asarray(vertices[name], np.float32))
    return made


def _lifted(vertices, triangles, by_mm):
    """A surface a little outside of itself: on top of another one, the two would flicker."""
    a, b, c = (vertices[triangles[:, k]] for k in range(3))
    across = np.cross(b - a, c - a)
    normals = np.zeros_like(vertices)
    for k in range(3):
        np.add.at(normals, triangles[:, k], across)
    return vertices + by_mm * normals / np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-12)


def bring_prediction(scene, frame, folder, with_object=False):
    """The film that lies on the object, as it will look; of a job also the object in its colours."""
    parts = geometry.read_preview(os.path.join(folder, "preview.glb"))
    made = []
    for name, role in (("film", "prediction"), ("object", "object")):
        part = parts.get(name)
        if part is None or (name == "object" and not with_object):
            continue
        materials = []
        for n, m in enumerate(part.materials):
            image = _embedded(m["picture"], folder, f"{role}-{n}") if m["picture"] else None
            materials.append(_material(f"hydrodip {role}", image, m["color"]))
        places = np.asarray(part.vertices, float)
        if role == "prediction":
            places = _lifted(places, np.asarray(part.triangles), 0.1)
        made.append(_object(scene, role, frame.to_scene(places), part.triangles, part.uv, materials, part.material_of))
    return made


def bring_sheet(scene, frame, sheet):
    """The sheet as it floats when the object first touches it."""
    if not sheet["picture"]:
        return None
    w, h = np.array(sheet["size_mm"]) / 2
    corners = frame.to_scene([[-w, -h, 0], [w, -h, 0], [w, h, 0], [-w, h, 0]])
    image = load_image(sheet["picture"])
    return _object(
        scene, "sheet", corners, [[0, 1, 2], [0, 2, 3]], [[0, 0], [1, 0], [1, 1], [0, 1]],
        [_material("hydrodip sheet", image, alpha=True)])


def turn(target, rotate_deg, mm_per_unit):
    """Turns an object as the program's --rotate does: about the fixed axes x, y, z, in that order."""
    x, y, z = np.radians(rotate_deg)
    rotation = Matrix.Rotation(z, 4, "Z") @ Matrix.Rotation(y, 4, "Y") @ Matrix.Rotation(x, 4, "X")
    at = Matrix.Translation(target.matrix_world.translation)
    target.matrix_world = at @ rotation @ at.inverted() @ target.matrix_world
