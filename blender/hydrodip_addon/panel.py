"""The side panel."""

import textwrap

import bpy

from . import operators


def _wrapped(layout, text, width=28):
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
        self._draw_object(layout.box(), context, settings)
        if operators.is_running(context.scene):
            box = layout.box()
            box.label(text=settings.activity, icon="SORTTIME")
            box.prop(settings, "fraction", text="")
            box.operator("hydrodip.cancel", icon="CANCEL")
        else:
            grid = layout.grid_flow(columns=2, even_columns=True, align=True)
            for command, text in (
                ("simulate", "Simulate"), ("print", "Print"), ("orient", "Best poses"), ("plan", "Plan dips")):
                grid.operator("hydrodip.run", text=text).command = command
        if settings.message:
            _wrapped(layout.box(), settings.message)
        for number, pose in enumerate(settings.poses):
            box = layout.box()
            _wrapped(box, f"{number + 1}. {pose.text}")
            box.operator("hydrodip.take_pose").number = number
        column = layout.column()
        if not settings.job_file:
            for name in ("film", "film_mm", "depth_mm", "unit"):
                if name != "film_mm" or settings.film == "own":
                    column.prop(settings, name)
        for name in ("quality", "dips", "options", "output"):
            column.prop(settings, name)

    def _draw_object(self, box, context, settings):
        target = context.active_object
        if settings.job_file:
            box.label(text="The job as it is", icon="FILE_TEXT")
        elif target is not None and target.type == "MESH":
            size = settings.mm_per_unit(context.scene)
            box.label(text=target.name, icon="MESH_DATA")
            box.label(text="{:.4g} x {:.4g} x {:.4g} mm".format(*(size * d for d in target.dimensions)))
            _wrapped(box, "Its lowest point meets the film first.")
        else:
            box.label(text="Select the mesh to dip", icon="INFO")
        row = box.row(align=True)
        row.prop(settings, "job_file")
        row.operator("hydrodip.open_job", text="", icon="IMPORT")


def register():
    bpy.utils.register_class(HYDRODIP_PT_panel)


def unregister():
    bpy.utils.unregister_class(HYDRODIP_PT_panel)
