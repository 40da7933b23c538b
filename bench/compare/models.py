"""Small models in every format that hydrodip reads, written without it."""

import base64
import json
import math
import struct
import zipfile
import zlib

# A pebble, 40 x 30 x 16 mm, lowest point at z = 0.
COLUMNS, ROWS = 24, 12


def pebble():
    """Points of a closed grid (rows from pole to pole), texture coordinates, triangles."""
    points, uvs, triangles = [], [], []
    for row in range(ROWS + 1):
        for column in range(COLUMNS + 1):
            around, down = 2 * math.pi * (column % COLUMNS) / COLUMNS, math.pi * row / ROWS
            point = (20 * math.sin(down) * math.cos(around), 15 * math.sin(down) * math.sin(around),
                     8 - 8 * math.cos(down))
            points.append(tuple(round(x, 6) + 0.0 for x in point))  # the seam's two sides agree
            uvs.append((column / COLUMNS, row / ROWS))
    for row in range(ROWS):
        for column in range(COLUMNS):
            a = row * (COLUMNS + 1) + column
            b, c, d = a + 1, a + COLUMNS + 2, a + COLUMNS + 1
            if row > 0:
                triangles.append((a, b, c))
            if row < ROWS - 1:
                triangles.append((a, c, d))
    return points, uvs, triangles


def color_of(point):
    """Soft stripes and a gradient, so that a shift or a swapped channel shows."""
    x, y, z = point
    return (round(127 + 120 * math.sin(x / 4)), round(127 + 8 * y), round(255 - 14 * z))


def png(width, height):
    rows = b""
    for y in range(height):
        rows += b"\0" + bytes(
            channel
            for x in range(width)
            for channel in (255 * x // width, 255 * y // height, 60 + 150 * ((x // 8 + y // 8) % 2)))

    def chunk(kind, data):
        return (struct.pack(">I", len(data)) + kind + data +
                struct.pack(">I", zlib.crc32(kind + data)))

    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)) +
            chunk(b"IDAT", zlib.compress(rows, 9)) + chunk(b"IEND", b""))


def obj(folder):
    points, uvs, triangles = pebble()
    lines = ["mtllib pebble.mtl"]
    lines += ["v %.6f %.6f %.6f" % p for p in points]
    lines += ["vt %.6f %.6f" % uv for uv in uvs]
    half = len(triangles) // 2
    for name, part in (("pictured", triangles[:half]), ("plain", triangles[half:])):
        lines.append("usemtl " + name)
        lines += ["f " + " ".join("%d/%d" % (i + 1, i + 1) for i in t) for t in part]
    (folder / "pebble.obj").write_text("\n".join(lines) + "\n")
    (folder / "pebble.mtl").write_text("newmtl pictured\nKd 1 1 1\nmap_Kd pebble.png\n"
                                       "newmtl plain\nKd 0.9 0.3 0.1\n")
    (folder / "pebble.png").write_bytes(png(64, 64))


def ply(folder):
    points, _, triangles = pebble()
    header = ("ply\nformat %s 1.0\nelement vertex %d\nproperty float x\nproperty float y\n"
              "property float z\nproperty uchar red\nproperty uchar green\nproperty uchar blue\n"
              "element face %d\nproperty list uchar int vertex_indices\nend_header\n")
    text = header % ("ascii", len(points), len(triangles))
    text += "".join("%.6f %.6f %.6f %d %d %d\n" % (*p, *color_of(p)) for p in points)
    text += "".join("3 %d %d %d\n" % t for t in triangles)
    (folder / "ascii.ply").write_text(text)
    data = (header % ("binary_big_endian", len(points), len(triangles))).encode()
    data += b"".join(struct.pack(">fffBBB", *p, *color_of(p)) for p in points)
    data += b"".join(struct.pack(">Biii", 3, *t) for t in triangles)
    (folder / "binary.ply").write_bytes(data)


def stl(folder):
    """Binary, with colours as VisCAM writes them: 15 bits, blue lowest, and one that says so."""
    points, _, triangles = pebble()
    data = b"pebble".ljust(80) + struct.pack("<I", len(triangles))
    for triangle in triangles:
        corners = [points[i] for i in triangle]
        red, green, blue = (c >> 3 for c in color_of(corners[0]))
        data += struct.pack("<12fH", 0, 0, 0, *(x for p in corners for x in p),
                            1 << 15 | red << 10 | green << 5 | blue)
    (folder / "colors.stl").write_bytes(data)


def off(folder):
    points, _, triangles = pebble()
    text = "COFF\n%d %d 0\n" % (len(points), len(triangles))
    text += "".join("%.6f %.6f %.6f %d %d %d 255\n" % (*p, *color_of(p)) for p in points)
    text += "".join("3 %d %d %d\n" % t for t in triangles)
    (folder / "colors.off").write_text(text)


def threemf(folder):
    points, _, triangles = pebble()
    colors = "".join('<m:color color="#%02X%02X%02X"/>' % color_of(p) for p in points)
    vertices = "".join('<vertex x="%.6f" y="%.6f" z="%.6f"/>' % tuple(x / 10 for x in p)
                       for p in points)
    faces = "".join('<triangle v1="%d" v2="%d" v3="%d" pid="1" p1="%d" p2="%d" p3="%d"/>' % (t + t)
                    for t in triangles)
    model = ('<?xml version="1.0" encoding="UTF-8"?>\n<model unit="centimeter" '
             'xmlns="http://schemas.microsoft.com/3dmanufacturing/core/2015/02" '
             'xmlns:m="http://schemas.microsoft.com/3dmanufacturing/material/2015/02"><resources>'
             '<m:colorgroup id="1">' + colors + '</m:colorgroup>'
             '<object id="2" type="model"><mesh><vertices>' + vertices + '</vertices><triangles>' +
             faces + '</triangles></mesh></object></resources><build><item objectid="2" '
             'transform="0 1 0 -1 0 0 0 0 1 0 0 0"/></build></model>')
    types = ('<?xml version="1.0"?><Types '
             'xmlns="http://schemas.openxmlformats.org/package/2006/content-types">'
             '<Default Extension="rels" '
             'ContentType="application/vnd.openxmlformats-package.relationships+xml"/>'
             '<Default Extension="model" '
             'ContentType="application/vnd.ms-package.3dmanufacturing-3dmodel+xml"/></Types>')
    relations = ('<?xml version="1.0"?><Relationships '
                 'xmlns="http://schemas.openxmlformats.org/package/2006/relationships">'
                 '<Relationship Target="/3D/3dmodel.model" Id="rel0" '
                 'Type="http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"/>'
                 '</Relationships>')
    with zipfile.ZipFile(folder / "colors.3mf", "w", zipfile.ZIP_DEFLATED) as archive:
        for name, text in (("[Content_Types].xml", types), ("_rels/.rels", relations),
                           ("3D/3dmodel.model", model)):
            archive.writestr(zipfile.ZipInfo(name, (1980, 1, 1, 0, 0, 0)), text)


def gltf(folder):
    """Metres, y up: as text with its parts in files, as text with all inside, and as GLB."""
    points, uvs, triangles = pebble()
    flat = [(x / 1000, z / 1000, -y / 1000) for x, y, z in points]
    picture = png(64, 64)
    parts = [
        b"".join(struct.pack("<fff", *p) for p in flat),
        b"".join(struct.pack("<ff", *uv) for uv in uvs),
        b"".join(struct.pack("<BBBB", *color_of(p), 255) for p in points),
        b"".join(struct.pack("<HHH", *t) for t in triangles),
    ]
    views, data = [], b""
    for part in parts + [picture]:
        views.append({"buffer": 0, "byteOffset": len(data), "byteLength": len(part)})
        data += part + b"\0" * (-len(part) % 4)
    limits = {"min": [min(p[k] for p in flat) for k in range(3)],
              "max": [max(p[k] for p in flat) for k in range(3)]}
    scene = {
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
        "nodes": [{"children": [1], "rotation": [0, 0.3826834, 0, 0.9238795]},
                  {"mesh": 0, "scale": [1.25, 1, 1]}],
        "meshes": [{"primitives": [{
            "attributes": {"POSITION": 0, "TEXCOORD_0": 1, "COLOR_0": 2}, "indices": 3,
            "material": 0}]}],
        "materials": [{"pbrMetallicRoughness": {"baseColorFactor": [1, 0.8, 0.9, 1],
                                                "baseColorTexture": {"index": 0}}}],
        "textures": [{"sampler": 0, "source": 0}],
        "samplers": [{"wrapS": 10497, "wrapT": 33071}],
        "images": [{"bufferView": 4, "mimeType": "image/png"}],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": len(points), "type": "VEC3", **limits},
            {"bufferView": 1, "componentType": 5126, "count": len(points), "type": "VEC2"},
            {"bufferView": 2, "componentType": 5121, "count": len(points), "type": "VEC4",
             "normalized": True},
            {"bufferView": 3, "componentType": 5123, "count": 3 * len(triangles),
             "type": "SCALAR"}],
        "bufferViews": views,
        "buffers": [{"byteLength": len(data)}],
    }
    text = json.dumps(scene).encode()
    text += b" " * (-len(text) % 4)
    (folder / "inside.glb").write_bytes(
        struct.pack("<4sII", b"glTF", 2, 28 + len(text) + len(data)) +
        struct.pack("<I4s", len(text), b"JSON") + text +
        struct.pack("<I4s", len(data), b"BIN\0") + data)
    scene["buffers"][0]["uri"] = ("data:application/octet-stream;base64," +
                                  base64.b64encode(data).decode())
    (folder / "inside.gltf").write_text(json.dumps(scene))
    scene["buffers"][0]["uri"] = "beside.bin"
    scene["images"] = [{"uri": "beside.png"}]
    (folder / "beside.gltf").write_text(json.dumps(scene))
    (folder / "beside.bin").write_bytes(data)
    (folder / "beside.png").write_bytes(picture)


def write_models(folder):
    for write in (obj, ply, stl, off, threemf, gltf):
        write(folder)
