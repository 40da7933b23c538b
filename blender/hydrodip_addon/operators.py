"""What the panel's buttons do."""

import json
import os
import shutil
import tempfile
import time

import bpy
from bpy.props import EnumProperty, IntProperty, StringProperty

from . import exchange, process

_running = {}  # the job of each scene, by its name


def program(context):
    """The hydrodip program: as the preferences say, or the one in PATH."""
    addon = context.preferences.addons.get(__package__)
    said = addon.preferences.program if addon else ""
    found = said or os.environ.get("HYDRODIP") or shutil.which("hydrodip")
    if not found or not shutil.which(found):
        raise ValueError(
            "the hydrodip program is not found; install it, or name it in the add-on's preferences")
    return found


def is_running(scene):
    return scene.name in _running


def stop_all():
    for job in _running.values():
        job.cancel()


def _output_folder(settings, name, command):
    base = bpy.path.abspath(settings.output) if settings.output else (
        bpy.path.abspath("//") if bpy.data.filepath else tempfile.mkdtemp(prefix="hydrodip-"))
    return os.path.join(base, f"{bpy.path.clean_name(name)}-{command}")


class Run:
    """One run of a command for a scene, from the export to what is brought back."""

    def __init__(self, context, command, model=None, bring_object=False):
        self.scene, self.command = context.scene, command
        settings = self.settings = context.scene.hydrodip
        self.bring_object = bring_object
        self.unit = settings.mm_per_unit(context.scene)
        model = model or bpy.path.abspath(settings.job_file)
        if model:
            name = os.path.splitext(os.path.basename(model))[0]
            self.output = _output_folder(settings, name, command)
            self.frame = exchange.Frame(self.unit)
        else:
            target = context.active_object
            if target is None or target.type != "MESH" or exchange.TAG in target:
                raise ValueError("select the mesh to dip")
            self.output = _output_folder(settings, target.name, command)
            self.made = self.output + "-model"
            os.makedirs(self.made, exist_ok=True)
            model = os.path.join(self.made, "model.obj")
            self.frame = exchange.export(target, model, self.unit)
        arguments = [program(context)] + settings.arguments(command, model, self.output)
        settings.message, settings.activity, settings.fraction = "", "starting", 0
        self.job = _running[self.scene.name] = process.Job(arguments, os.path.dirname(model) or None)

    def step(self):
        """None while it runs; then whether it went well. Brings the results back."""
        code = self.job.poll()
        self.settings.activity, self.settings.fraction = self.job.activity, self.job.fraction
        if code is None:
            return None
        _running.pop(self.scene.name, None)
        self.settings.activity = ""
        if self.job.cancelled or code == 130:
            self.settings.message = "cancelled"
            return False
        if code not in (0, 4):
            self.settings.message = self.job.error
            return False
        self._bring()
        return True

    def _bring(self):
        if self.command in ("orient", "plan"):
            said = json.loads(self.job.said)
            self.settings.poses.clear()
            for found in said.get("poses") or said["dips"]:
                pose = self.settings.poses.add()
                pose.rotate_deg, pose.depth_mm, pose.text = found["rotate_deg"], found["depth_mm"], found["text"]
            self.settings.message = f"{len(self.settings.poses)} found; in {self.output}"
            return
        with open(os.path.join(self.output, "report.json"), encoding="utf-8") as file:
            report = json.load(file)
        exchange.clear(self.scene, ("film", "prediction", "sheet") + (("object",) if self.bring_object else ()))
        for name in ("preview.png", "print.png", "maps.png"):
            file = os.path.join(self.output, name)
            if os.path.exists(file):
                exchange.load_image(file)
        if os.path.exists(os.path.join(self.output, "film.ply")):
            sheet = sheet_of(report, self.output)
            exchange.bring_sheet(self.scene, self.frame, sheet)
            exchange.bring_film(self.scene, self.frame, self.output, sheet).hide_set(True)
            exchange.bring_prediction(self.scene, self.frame, self.output, self.bring_object)
        else:  # several dips: a sheet for each
            for entry in sorted(os.listdir(self.output)):
                file = os.path.join(self.output, entry, "print.png")
                if os.path.exists(file):
                    exchange.load_image(file)
        self.settings.message = f"{report['verdict']} Files: {self.output}"


def sheet_of(report, folder):
    size = [report["parameters"][f"film.{side}_mm"]["value"] for side in ("width", "height")]
    picture = os.path.join(folder, "print.png")
    return {"size_mm": size, "picture": picture if os.path.exists(picture) else ""}


class HYDRODIP_OT_run(bpy.types.Operator):
    """Runs the hydrodip program in the background; Escape cancels"""

    bl_idname = "hydrodip.run"
    bl_label = "Run hydrodip"

    command: EnumProperty(items=[(c, c.capitalize(), "") for c in ("simulate", "print", "orient", "plan")])
    model: StringProperty(options={"SKIP_SAVE"}, description="A model's or a job's file, instead of the selected object")
    bring_object: bpy.props.BoolProperty(options={"SKIP_SAVE"})

    @classmethod
    def poll(cls, context):
        return not is_running(context.scene)

    def execute(self, context):
        try:
            self._run = Run(context, self.command, self.model, self.bring_object)
        except (ValueError, OSError) as error:
            context.scene.hydrodip.message = str(error)
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        if bpy.app.background:
            while True:
                ended = self._step()
                if ended is not None:
                    return ended
                time.sleep(0.05)
        self._timer = context.window_manager.event_timer_add(0.1, window=context.window)
        context.window_manager.modal_handler_add(self)
        return {"RUNNING_MODAL"}

    def _step(self):
        try:
            done = self._run.step()
        except (ValueError, OSError, KeyError) as error:
            self._run.settings.message = f"the result cannot be read: {error}"
            done = False
        if done is None:
            return None
        if not done and self._run.settings.message != "cancelled":
            self.report({"ERROR"}, self._run.settings.message)
        return {"FINISHED"} if done else {"CANCELLED"}

    def modal(self, context, event):
        if event.type == "ESC" and event.value == "PRESS":
            self._run.job.cancel()
        if event.type != "TIMER":
            return {"PASS_THROUGH"}
        ended = self._step()
        for area in context.screen.areas if context.screen else ():
            if area.type == "VIEW_3D":
                area.tag_redraw()
        if ended is None:
            return {"PASS_THROUGH"}
        context.window_manager.event_timer_remove(self._timer)
        return ended


class HYDRODIP_OT_cancel(bpy.types.Operator):
    """Stops the program; nothing is written"""

    bl_idname = "hydrodip.cancel"
    bl_label = "Cancel"

    @classmethod
    def poll(cls, context):
        return is_running(context.scene)

    def execute(self, context):
        _running[context.scene.name].cancel()
        return {"FINISHED"}


class HYDRODIP_OT_take_pose(bpy.types.Operator):
    """Turns the selected object to this pose and takes over its depth"""

    bl_idname = "hydrodip.take_pose"
    bl_label = "Hold it like that"
    bl_options = {"UNDO"}

    number: IntProperty()

    @classmethod
    def poll(cls, context):
        return context.active_object is not None

    def execute(self, context):
        settings = context.scene.hydrodip
        pose = settings.poses[self.number]
        exchange.turn(context.active_object, pose.rotate_deg, settings.mm_per_unit(context.scene))
        settings.depth_mm = pose.depth_mm
        settings.poses.clear()  # they begin with the pose that it had
        return {"FINISHED"}


class HYDRODIP_OT_open_job(bpy.types.Operator):
    """Reads a job: its object, posed as it says, comes with a draft of its dip"""

    bl_idname = "hydrodip.open_job"
    bl_label = "Open job"

    filepath: StringProperty(subtype="FILE_PATH")
    filter_glob: StringProperty(default="*.toml", options={"HIDDEN"})

    def invoke(self, context, event):
        context.window_manager.fileselect_add(self)
        return {"RUNNING_MODAL"}

    def execute(self, context):
        settings = context.scene.hydrodip
        settings.job_file = self.filepath
        quality, settings.quality = settings.quality, "draft"
        try:
            return bpy.ops.hydrodip.run(command="simulate", model=self.filepath, bring_object=True)
        finally:
            settings.quality = quality


_CLASSES = (HYDRODIP_OT_run, HYDRODIP_OT_cancel, HYDRODIP_OT_take_pose, HYDRODIP_OT_open_job)


def register():
    for each in _CLASSES:
        bpy.utils.register_class(each)


def unregister():
    for each in reversed(_CLASSES):
        bpy.utils.unregister_class(each)
