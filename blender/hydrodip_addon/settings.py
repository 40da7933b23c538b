"""What a scene says about its dip."""

import shlex

import bpy
from bpy.props import (
    CollectionProperty,
    EnumProperty,
    FloatProperty,
    FloatVectorProperty,
    IntProperty,
    PointerProperty,
    StringProperty,
)

_UNITS_MM = {"MM": 1.0, "CM": 10.0, "M": 1000.0}


class HYDRODIP_Pose(bpy.types.PropertyGroup):
    rotate_deg: FloatVectorProperty(size=3)
    depth_mm: FloatProperty()
    text: StringProperty()


class HYDRODIP_Settings(bpy.types.PropertyGroup):
    unit: EnumProperty(
        name="Unit",
        description="What one unit of the scene is",
        items=[
            ("SCENE", "As the scene says", "By the scene's unit scale: metres, unless it is changed"),
            ("MM", "Millimetre", "One unit is a millimetre, whatever the scene says"),
            ("CM", "Centimetre", "One unit is a centimetre, whatever the scene says"),
            ("M", "Metre", "One unit is a metre, whatever the scene says"),
        ],
    )
    job_file: StringProperty(
        name="Job", description="A job's TOML that is run as it is, instead of the selected object", subtype="FILE_PATH"
    )
    film: EnumProperty(
        name="Film",
        items=[(f, t, "") for f, t in (
            ("a4", "A4"), ("a4-landscape", "A4, landscape"), ("letter", "Letter"),
            ("letter-landscape", "Letter, landscape"), ("a3", "A3"), ("a3-landscape", "A3, landscape"),
            ("own", "Other"))],
    )
    film_mm: FloatVectorProperty(name="Width and height, mm", size=2, default=(210, 297), min=10, max=3000)
    depth_mm: FloatProperty(name="Depth, mm", description="How deep to dip; 0: the whole object", min=0, max=5000)
    quality: EnumProperty(
        name="Quality",
        items=[("draft", "Draft", "Coarse and quick"), ("normal", "Normal", ""), ("fine", "Fine", "")],
        default="normal",
    )
    dips: IntProperty(name="Dips", description="How many dips to plan", default=2, min=1, max=24)
    options: StringProperty(
        name="More", description="More options, as on the command line: --set film.elements=20000 --dpi 600"
    )
    output: StringProperty(
        name="Folder", description="Where results go; empty: beside the .blend file", subtype="DIR_PATH"
    )
    poses: CollectionProperty(type=HYDRODIP_Pose)
    # While it runs, and what came of it.
    activity: StringProperty()
    fraction: FloatProperty(min=0, max=1, subtype="FACTOR")
    message: StringProperty()

    def mm_per_unit(self, scene):
        return _UNITS_MM.get(self.unit) or 1000.0 * scene.unit_settings.scale_length

    def arguments(self, command, model, output):
        """The command line behind the program's name."""
        words = [command, model, "-o", output]
        if not model.endswith(".toml"):  # which says it itself
            film = self.film if self.film != "own" else "{:g}x{:g}".format(*self.film_mm)
            words += ["--film", film]
            if self.depth_mm > 0:
                words += ["--depth", f"{self.depth_mm:.9g}"]
        if self.quality != "normal":
            words += ["--quality", self.quality]
        if command == "plan":
            words += ["--dips", str(self.dips)]
        if command in ("orient", "plan"):
            words.append("--json")
        elif self.quality == "draft":
            words += ["--set", "preview.pictures=on"]
        return words + shlex.split(self.options)


class HYDRODIP_Preferences(bpy.types.AddonPreferences):
    bl_idname = __package__

    program: StringProperty(
        name="Program", description="The hydrodip program; empty: the one in PATH", subtype="FILE_PATH"
    )

    def draw(self, context):
        self.layout.prop(self, "program")


_CLASSES = (HYDRODIP_Pose, HYDRODIP_Settings, HYDRODIP_Preferences)


def register():
    for each in _CLASSES:
        bpy.utils.register_class(each)
    bpy.types.Scene.hydrodip = PointerProperty(type=HYDRODIP_Settings)


def unregister():
    del bpy.types.Scene.hydrodip
    for each in reversed(_CLASSES):
        bpy.utils.unregister_class(each)
