"""hydrodip in Blender: pose an object over the bath, and let the hydrodip program simulate, orient,
plan and print it in the background. docs/blender.md says how."""

bl_info = {
    "name": "hydrodip",
    "author": "The hydrodip developers",
    "version": (0, 1, 0),
    "blender": (3, 4, 0),
    "location": "3D View > Sidebar > hydrodip",
    "description": "Film for hydro-dipping, with colours where the model has them",
    "category": "3D View",
}

from . import operators, panel, settings

_PARTS = (settings, operators, panel)


def register():
    for part in _PARTS:
        part.register()


def unregister():
    operators.stop_all()
    for part in reversed(_PARTS):
        part.unregister()
