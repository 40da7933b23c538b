"""Files between Blender and the program, in plain numpy: nothing here knows Blender. Millimetres."""

import json
import os
import struct

import numpy as np

_PLY_TYPES = {"float": "<f4", "double": "<f8", "uchar": "u1", "int": "<i4"}


def read_film(file):
    """film.ply: a dictionary of arrays per vertex, and the triangles (m, 3)."""
    with open(file, "rb") as stream:
        if stream.readline() != b"ply\n":
            raise ValueError(f"{file} is no PLY file")
        fields, counts, element = [], {}, ""
        for line in iter(stream.readline, b"end_header\n"):
            words = line.decode().split()
            if words[0] == "element":
                element = words[1]
                counts[element] = int(words[2])
            elif words[0] == "property" and element == "vertex":
                fields.append((words[2], _PLY_TYPES[words[1]]))
        vertices = np.frombuffer(stream.read(np.dtype(fields).itemsize * counts["vertex"]), np.dtype(fields))
        faces = np.frombuffer(stream.read(13 * counts["face"]), np.dtype([("n", "u1"), ("v", "<i4", 3)]))
    return {name: vertices[name].astype(float) for name, _ in fields}, faces["v"].copy()


class GlbPart:
    """One mesh of a preview.glb in the posed object's frame, and its pictures as bytes."""

    def __init__(self, vertices, triangles, uv, colors, material_of, materials):
        self.vertices, self.triangles, self.uv, self.colors = vertices, triangles, uv, colors
        self.material_of, self.materials = material_of, materials


def read_preview(file):
    """preview.glb by the names of its meshes: "object", "film", sometimes "wanted". Materials are
    those of the variant "wanted" for the object, of "predicted" for the film."""
    with open(file, "rb") as stream:
        data = stream.read()
    length = struct.unpack_from("<I", data, 12)[0]
    scene = json.loads(data[20 : 20 + length])
    binary = data[20 + length + 8 :]

    def view(number):
        v = scene["bufferViews"][number]
        begin = v.get("byteOffset", 0)
        return binary[begin : begin + v["byteLength"]]

    def accessor(number):
        a = scene["accessors"][number]
        kind = {5126: "<f4", 5125: "<u4", 5123: "<u2", 5121: "u1"}[a["componentType"]]
        width = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4}[a["type"]]
        begin = a.get("byteOffset", 0)
        values = np.frombuffer(view(a["bufferView"])[begin:], kind, a["count"] * width)
        return values.reshape(-1, width) if width > 1 else values

    def material(number):
        m = scene["materials"][number]
        pbr = m.get("pbrMetallicRoughness", {})
        picture = None
        if "baseColorTexture" in pbr:
            image = scene["images"][scene["textures"][pbr["baseColorTexture"]["index"]]["source"]]
            picture = (view(image["bufferView"]), image["mimeType"])
        return {"name": m["name"], "color": pbr.get("baseColorFactor", [1, 1, 1, 1]), "picture": picture}

    parts = {}
    for mesh in scene["meshes"]:
        triangles, material_of, materials = [], [], []
        attributes = mesh["primitives"][0]["attributes"]
        for primitive in mesh["primitives"]:
            used = primitive["material"]
            variants = primitive.get("extensions", {}).get("KHR_materials_variants", {}).get("mappings", [])
            for mapping in variants:
                if mesh["name"] != "film" and 1 in mapping["variants"]:
                    used = mapping["material"]
            corner = accessor(primitive["indices"]).reshape(-1, 3)
            triangles.append(corner)
            material_of.append(np.full(len(corner), len(materials)))
            materials.append(material(used))
        x, y, z = accessor(attributes["POSITION"]).astype(float).T * 1000
        uv = accessor(attributes["TEXCOORD_0"]).astype(float) if "TEXCOORD_0" in attributes else None
        if uv is not None:
            uv = uv * [1, -1] + [0, 1]
        colors = accessor(attributes["COLOR_0"]).astype(float) if "COLOR_0" in attributes else None
        parts[mesh["name"]] = GlbPart(
            np.stack([-x, y, -z], axis=1), np.concatenate(triangles), uv, colors,
            np.concatenate(material_of), materials)
    return parts


def write_obj(file, vertices, triangles, uv=None, colors=None, material_of=None, materials=()):
    """An OBJ in mm with its MTL. uv: (m, 3, 2) per corner; colors: (n, 3) sRGB from 0 to 1;
    materials: dictionaries with name, color (sRGB, 0 to 1) and picture, a file beside this one."""
    name = os.path.splitext(os.path.basename(file))[0]
    with open(file, "w", encoding="utf-8", newline="\n") as out:
        if materials:
            out.write(f"mtllib {name}.mtl\n")
        rows = np.asarray(vertices)
        if colors is None:
            out.writelines("v %.7g %.7g %.7g\n" % tuple(v) for v in rows)
        else:
            out.writelines("v %.7g %.7g %.7g %.5f %.5f %.5f\n" % tuple(v) for v in np.hstack([rows, colors]))
        if uv is not None:
            out.writelines("vt %.7g %.7g\n" % tuple(t) for t in np.asarray(uv).reshape(-1, 2))
        last = None
        for n, (a, b, c) in enumerate(np.asarray(triangles) + 1):
            if materials and material_of[n] != last:
                last = material_of[n]
                out.write(f"usemtl m{last}\n")
            if uv is None:
                out.write(f"f {a} {b} {c}\n")
            else:
                out.write(f"f {a}/{3 * n + 1} {b}/{3 * n + 2} {c}/{3 * n + 3}\n")
    if not materials:
        return
    with open(os.path.join(os.path.dirname(file), name + ".mtl"), "w", encoding="utf-8", newline="\n") as out:
        for n, m in enumerate(materials):
            out.write(f"newmtl m{n}\nKd %.5f %.5f %.5f\n" % tuple(m["color"]))
            if m["picture"]:
                out.write(f"map_Kd {m['picture']}\n")
