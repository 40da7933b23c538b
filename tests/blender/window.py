"""The add-on in a real window: prints, shows the panel and what came back, and writes pictures.

Usage: xvfb-run -a -s '-screen 0 1400x900x24' blender --factory-startup -noaudio -P window.py -- FOLDER
HYDRODIP names the program. Fails (exit code 1) if nothing came back in ten minutes.
"""

import os
import sys
import time

sys.path.insert(0, os.path.dirname(__file__))

import bpy  # noqa: E402

import scenes  # noqa: E402

folder = sys.argv[-1]
steps = []
bpy.context.preferences.view.show_splash = False
begun = time.time()


def view(context):
    (area,) = [a for a in context.screen.areas if a.type == "VIEW_3D"]
    (region,) = [r for r in area.regions if r.type == "WINDOW"]
    return area, region


def set_up():
    for each in list(bpy.data.objects):
        bpy.data.objects.remove(each)
    # The first tab is the one that is shown; no program can choose another.
    panel = scenes.hydrodip_addon.panel.HYDRODIP_PT_panel
    panel.bl_category, panel.bl_order = "Item", -1
    scenes.hydrodip_addon.register()
    scene = bpy.context.scene
    scene.unit_settings.scale_length = 0.001
    settings = scene.hydrodip
    settings.film, settings.film_mm, settings.output = "own", (110, 90), folder
    settings.depth_mm = 9
    settings.options = "--set film.elements=4000 --set dip.step_mm=0.5"
    target = scenes.keel(1.0, location_mm=(0, 0, 0), turn_deg=(0, 0, 0))
    target.select_set(True)
    area, _ = view(bpy.context)
    space = area.spaces.active
    space.show_region_ui = True
    space.shading.type, space.shading.color_type = "SOLID", "TEXTURE"  # quick without a graphics card
    space.clip_end = 10000
    space.region_3d.view_distance = 110
    # From below, where the film comes from.
    from mathutils import Euler

    space.region_3d.view_rotation = Euler((2.2, 0, 0.5)).to_quaternion()
    with bpy.context.temp_override(area=area, region=view(bpy.context)[1]):
        bpy.ops.hydrodip.run("INVOKE_DEFAULT", command="print")


def running():
    bpy.ops.screen.screenshot(filepath=os.path.join(folder, "running.png"))


def look():
    settings = bpy.context.scene.hydrodip
    if scenes.hydrodip_addon.operators.is_running(bpy.context.scene):
        return 0.5
    print(settings.message)
    scenes.brought("prediction")
    for each in bpy.data.objects:
        each.select_set(False)
    scenes.brought("sheet").hide_set(True)
    return None


def finish():
    bpy.ops.screen.screenshot(filepath=os.path.join(folder, "done.png"))
    print("all passed")
    sys.stdout.flush()
    os._exit(0)


def tick():
    if time.time() - begun > 600:
        print("nothing came back")
        os._exit(1)
    try:
        step = steps[0]
        again = step()
        if again:
            return again
        steps.pop(0)
        return 2.0
    except Exception as error:  # noqa: BLE001
        import traceback

        traceback.print_exc()
        sys.stdout.flush()
        os._exit(1)


steps = [set_up, running, look, finish]
bpy.app.timers.register(tick, first_interval=2.0)
