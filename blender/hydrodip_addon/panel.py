"""The side panel."""

import textwrap

import bpy

from . import operators


def _wrapped(layout, text, width=44):
    for line in textwrap.wrap(text, width):
        layout.label(text=line)


class HYDRODIP_PT_panel(bpy.types.Panel):
    bl_label = "hydrodip"
    bl_idname = "HYDRODIP_PT_panel"
    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = "hydrodip"

    def draw(self, context):
        layout, settings = self.layout, context.scene.hydrodip
        layout.use_property_split = True
        layout.use_property_decorate = False
        target = context.active_object
        box = layout.box()
        if settings.job_file:
            box.label(text="The job is run as it is", icon="FILE_TEXT")
        elif target is not None and target.type == "MESH":
            size = settings.mm_per_unit(context.scene)
            box.label(text=target.name, icon="MESH_DATA")
            box.label(text="{:.4g} x {:.4g} x {:.4g} mm".format(*(size * d for d in target.dimensions)))
            box.label(text="its lowest point meets the film first")
        else:
            box.label(text="Select the mesh to dip", icon="INFO")
        row = box.row(align=True)
        row.prop(settings, "job_file")
        row.operator("hydrodip.open_job", text="", icon="FILE_FOLDER")
        column = layout.column()
        if not settings.job_file:
            column.prop(settings, "unit")
            column.prop(settings, "film")
            if settings.film == "own":
                column.prop(settings, "film_mm")
            column.prop(settings, "depth_mm")
        column.prop(settings, "quality")
        column.prop(settings, "options")
        column.prop(settings, "output")

        if operators.is_running(context.scene):
            box = layout.box()
            box.label(text=settings.activity, icon="SORTTIME")
            box.prop(settings, "fraction", text="")
            box.operator("hydrodip.cancel", icon="CANCEL")
        else:
            row = layout.row(align=True)
            row.operator("hydrodip.run", text="Simulate").command = "simulate"
            row.operator("hydrodip.run", text="Print").command = "print"
            row = layout.row(align=True)
            row.operator("hydrodip.run", text="Best poses").command = "orient"
            row.operator("hydrodip.run", text="Plan dips").command = "plan"
            layout.prop(settings, "dips")
        if settings.message:
            _wrapped(layout.box(), settings.message)
        for number, pose in enumerate(settings.poses):
            box = layout.box()
            _wrapped(box, f"{number + 1}. {pose.text}")
            box.operator("hydrodip.take_pose").number = number


def register():
    bpy.utils.register_class(HYDRODIP_PT_panel)


def unregister():
    bpy.utils.unregister_class(HYDRODIP_PT_panel)
