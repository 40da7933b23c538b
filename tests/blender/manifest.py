"""The add-on's manifest has what Blender 4.2 and later ask of an extension, and says what bl_info says,
which older ones read.

Usage: manifest.py ADDON VERSION. The rules are those of the Blender manual's page on extensions.
"""

import ast
import pathlib
import re
import sys
import tomllib

addon, version = pathlib.Path(sys.argv[1]), sys.argv[2]
manifest = tomllib.loads((addon / "blender_manifest.toml").read_text())

TEXTS = ("schema_version", "id", "version", "name", "tagline", "maintainer", "type", "blender_version_min")
OPTIONAL = {"tags", "license", "permissions", "website", "copyright", "platforms", "wheels", "blender_version_max"}
TAGS = {
    "3D View", "Add Curve", "Add Mesh", "Animation", "Bake", "Camera", "Compositing", "Development", "Game Engine",
    "Geometry Nodes", "Grease Pencil", "Import-Export", "Lighting", "Material", "Mesh", "Modeling", "Node", "Object",
    "Paint", "Physics", "Pipeline", "Render", "Rigging", "Scene", "Sculpt", "Sequencer", "System", "Text Editor",
    "Tracking", "User Interface", "UV",
}
PERMISSIONS = {"files", "network", "clipboard", "camera", "microphone"}


def is_short_and_plain(text):
    return 0 < len(text) <= 64 and text == text.strip() and (text[-1].isalnum() or text[-1] in ")]}")


assert all(isinstance(manifest.get(key), str) and manifest[key] for key in TEXTS), manifest
assert set(manifest) <= set(TEXTS) | OPTIONAL, manifest.keys()
assert manifest["schema_version"] == "1.0.0" and manifest["type"] == "add-on"
assert manifest["id"].isidentifier() and "__" not in manifest["id"] and manifest["id"].strip("_") == manifest["id"]
assert re.fullmatch(r"\d+\.\d+\.\d+", manifest["version"]) and manifest["version"] == version, (manifest["version"], version)
minimum = tuple(map(int, manifest["blender_version_min"].split(".")))
assert len(minimum) == 3 and minimum >= (4, 2, 0), minimum
assert is_short_and_plain(manifest["tagline"]), manifest["tagline"]
assert set(manifest["tags"]) <= TAGS, manifest["tags"]
assert manifest["license"] and all(re.fullmatch(r"SPDX:[A-Za-z0-9.-]+", each) for each in manifest["license"])
assert set(manifest["permissions"]) <= PERMISSIONS
assert all(map(is_short_and_plain, manifest["permissions"].values())), manifest["permissions"]

(said,) = [ast.literal_eval(node.value) for node in ast.parse((addon / "__init__.py").read_text()).body
           if isinstance(node, ast.Assign) and node.targets[0].id == "bl_info"]
assert said["name"] == manifest["name"] and said["description"] == manifest["tagline"]
assert ".".join(map(str, said["version"])) == version

# An extension may not count on the name under which it is imported, nor on the others' search path.
for file in addon.glob("*.py"):
    for node in ast.walk(ast.parse(file.read_text())):
        if isinstance(node, ast.ImportFrom):
            assert node.module is None or "hydrodip" not in node.module, (file.name, node.lineno)
        elif isinstance(node, ast.Import):
            assert all("hydrodip" not in each.name for each in node.names), (file.name, node.lineno)
print("all passed")
