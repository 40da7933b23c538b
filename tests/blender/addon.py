"""The add-on in Blender without a window: pose, plan, print and bring back.

Usage: blender -b --factory-startup -noaudio --python-exit-code 1 -P addon.py [-- CHECK...]
HYDRODIP names the program.
"""

import os
import sys
import tempfile
import time

sys.path.insert(0, os.path.dirname(__file__))

import bpy  # noqa: E402
import numpy as np  # noqa: E402
from mathutils import Vector  # noqa: E402

import scenes  # noqa: E402
from hydrodip_addon import exchange, operators, process  # noqa: E402


def run(command, **more):
    result = bpy.ops.hydrodip.run(command=command, **more)
    assert result == {"FINISHED"}, (result, bpy.context.scene.hydrodip.message)


def check_places(mm_per_unit, folder):
    """Film lies on the object, wherever that stands and however long a unit is; the sheet below it."""
    scene, settings = scenes.start(mm_per_unit / 1000)
    settings.output = folder
    target = scenes.keel(mm_per_unit)
    run("simulate")
    film = scenes.brought("film")
    laid = scenes.attribute(film, "state") == 1
    assert laid.sum() > 100
    places = scenes.places(film)
    apart = [scenes.nearest(target, Vector(p))[0] * mm_per_unit for p in places[laid][::3]]
    print(f"unit {mm_per_unit} mm: film {max(apart):.4f} mm off the object")
    assert max(apart) < 0.01, max(apart)
    # The sheet floats at the object's lowest point, its middle under the middle of the object.
    own = scenes.places(target)
    rim = places[scenes.attribute(film, "state") == 2]
    assert abs(np.ptp(rim[:, 0]) * mm_per_unit - 90) < 0.01 and abs(np.ptp(rim[:, 1]) * mm_per_unit - 70) < 0.01
    middle = 0.5 * (own.min(axis=0) + own.max(axis=0))
    assert np.abs(0.5 * (rim.min(axis=0) + rim.max(axis=0)) - middle)[:2].max() * mm_per_unit < 0.01
    return places, laid


def check_print(folder):
    """What is predicted at a point of the object is what its texture has there."""
    scene, settings = scenes.start(0.001)
    settings.output = folder
    settings.options += " --set print.dpi=100 --set preview.pictures=on --set preview.width_px=200"
    target = scenes.keel(1.0)
    run("print")
    image = bpy.data.images["print.png"]
    assert tuple(image.size) == (round(110 / 25.4 * 100), round(90 / 25.4 * 100)), tuple(image.size)
    assert "preview.png" in bpy.data.images and "maps.png" in bpy.data.images
    prediction, sheet = scenes.brought("prediction"), scenes.brought("sheet")
    own = scenes.places(target)
    flat = scenes.places(sheet)
    assert np.ptp(flat[:, 2]) < 1e-4 and abs(flat[0, 2] - own[:, 2].min()) < 1e-3
    assert abs(np.ptp(flat[:, 0]) - 110) < 1e-3 and abs(np.ptp(flat[:, 1]) - 90) < 1e-3
    (texture,) = [n.image for n in prediction.data.materials[0].node_tree.nodes if n.type == "TEX_IMAGE"]
    pixels = np.array(texture.pixels).reshape(texture.size[1], texture.size[0], 4)
    uv = np.empty(2 * len(prediction.data.loops), np.float32)
    prediction.data.uv_layers[0].data.foreach_get("uv", uv)
    uv = uv.reshape(-1, 3, 2).mean(axis=1)
    middles = np.array([prediction.matrix_world @ p.center for p in prediction.data.polygons])
    right = count = 0
    for middle, at in list(zip(middles, uv))[::5]:
        distance, place = scenes.nearest(target, Vector(middle))
        assert distance < 1, distance
        if min(abs(place.x), abs(place.y)) < 2:  # at a border of colours
            continue
        wanted = scenes.COLORS[(place.x > 0) + 2 * (place.y > 0)]
        seen = pixels[int(at[1] * pixels.shape[0]), int(at[0] * pixels.shape[1]), :3]
        right += np.abs(seen - wanted).max() < 0.2
        count += 1
    print(f"{right} of {count} predicted colours are those of the texture")
    # Film that is partly torn is drawn whole: a few triangles at the edge are bare.
    assert count > 50 and right > 0.9 * count
    # Once more: what the first run brought is replaced.
    run("simulate")
    assert len([o for o in bpy.data.objects if "hydrodip" in o]) == 2


def check_orient_and_pose(folder):
    scene, settings = scenes.start(0.001)
    settings.output = folder
    target = scenes.keel(1.0, turn_deg=(90, 0, 0))
    run("orient")
    assert len(settings.poses) >= 1 and settings.poses[0].text
    rotate, depth = list(settings.poses[0].rotate_deg), settings.poses[0].depth_mm
    x, y, z = np.radians(rotate)
    about = [np.array([[1, 0, 0], [0, np.cos(x), -np.sin(x)], [0, np.sin(x), np.cos(x)]]),
             np.array([[np.cos(y), 0, np.sin(y)], [0, 1, 0], [-np.sin(y), 0, np.cos(y)]]),
             np.array([[np.cos(z), -np.sin(z), 0], [np.sin(z), np.cos(z), 0], [0, 0, 1]])]
    before = np.array(target.matrix_world)
    assert bpy.ops.hydrodip.take_pose(number=0) == {"FINISHED"}
    bpy.context.view_layer.update()
    after = np.array(target.matrix_world)
    expected = about[2] @ about[1] @ about[0] @ before[:3, :3]
    assert np.abs(after[:3, :3] - expected).max() < 1e-5
    assert np.abs(after[:3, 3] - before[:3, 3]).max() < 1e-4
    assert abs(settings.depth_mm - depth) < 1e-6 and len(settings.poses) == 0
    run("simulate")


def check_plan(folder):
    scene, settings = scenes.start(0.001)
    settings.output = folder
    scenes.keel(1.0)
    settings.dips = 2
    settings.options += " --set film.elements=600"
    run("plan")
    assert len(settings.poses) == 2
    assert os.path.exists(os.path.join(folder, "keel-plan", "plan.toml"))


def check_job(folder):
    """A job's object comes as it is posed, in its colours."""
    scene, settings = scenes.start(1.0)
    target = scenes.keel(1000.0)
    model = os.path.join(folder, "keel.obj")
    exchange.export(target, model, 1000.0)
    job = os.path.join(folder, "job.toml")
    with open(job, "w") as out:
        out.write('[object]\nfile = "keel.obj"\nsize_mm = 50\nrotate_deg = [0, 0, 90]\n'
                  "[film]\nwidth_mm = 110\nheight_mm = 90\nelements = 1500\n"
                  "[dip]\ndepth_mm = 8\nstep_mm = 1\nair_cells = 0\n")
    settings.output = folder
    settings.options = "--set preview.pictures=off --set plan.suggest=off"
    assert bpy.ops.hydrodip.open_job(filepath=job) == {"FINISHED"}, settings.message
    made, film = scenes.brought("object"), scenes.brought("film")
    places = 1000 * scenes.places(made)
    assert abs(places[:, 2].min()) < 1e-2 and np.abs((places.min(axis=0) + places.max(axis=0))[:2]).max() < 1e-2
    original = 1000 * scenes.places(target)
    # A quarter turn about z: x and y have changed places.
    size = np.ptp(original, axis=0)
    assert np.abs(np.ptp(places, axis=0) - size[[1, 0, 2]] * 50 / size.max()).max() < 0.02
    assert any(n.type == "TEX_IMAGE" for m in made.data.materials for n in m.node_tree.nodes)
    assert scenes.attribute(film, "state").max() == 2
    # And it is run as it is from then on.
    assert settings.arguments("print", job, "out")[:4] == ["print", job, "-o", "out"]
    assert "--film" not in settings.arguments("print", job, "out")


def check_refusals(folder):
    scene, settings = scenes.start(1.0)
    settings.output = folder
    for action in (lambda: bpy.ops.hydrodip.run(command="simulate"),  # nothing is selected
                   lambda: (scenes.keel(1.0), bpy.ops.hydrodip.run(command="simulate"))):  # 44 m large
        try:
            action()
            raise AssertionError("was not refused")
        except RuntimeError as error:
            print(str(error).strip())
    assert "44" in settings.message or "mm large" in settings.message, settings.message
    settings.unit = "MM"  # what its author meant
    run("simulate")
    try:
        settings.film_mm = (30, 20)
        bpy.ops.hydrodip.run(command="simulate")
        raise AssertionError("was not refused")
    except RuntimeError:
        assert "film" in settings.message, settings.message
    assert not operators.is_running(scene)


def check_cancel(folder):
    """Progress is told, and a cancelled run leaves nothing."""
    scene, settings = scenes.start(0.001)
    target = scenes.keel(1.0)
    model = os.path.join(folder, "long.obj")
    exchange.export(target, model, 1.0)
    output = os.path.join(folder, "long")
    job = process.Job([os.environ["HYDRODIP"], "simulate", model, "-o", output, "--set", "film.elements=400000",
                       "--set", "dip.step_mm=0.01"], folder)
    while job.activity != "dipping" and job.poll() is None:
        time.sleep(0.05)
    assert job.poll() is None, job.error
    begun = time.perf_counter()
    job.cancel()
    while job.poll() is None:
        time.sleep(0.01)
    print(f"cancelled while {job.activity} at {100 * job.fraction:.0f} %, ended {1000 * (time.perf_counter() - begun):.0f} ms later")
    assert job.poll() == 130 and not os.path.exists(output)


def check_units(folder):
    """A model in metres and one in millimetres: the same film, to Blender's single precision."""
    (metres, laid_there), (millimetres, laid_here) = check_places(1000.0, folder), check_places(1.0, folder)
    # In long steps, rounding decides where the last vertices land that touch just as a step ends.
    both = laid_there & laid_here
    assert (laid_there != laid_here).sum() <= 5, (laid_there != laid_here).sum()
    apart = np.linalg.norm(1000 * metres - millimetres, axis=1)[both]
    assert np.median(apart) < 1e-3 and (apart > 0.02).sum() <= 5, np.sort(apart)[-8:]


chosen = sys.argv[sys.argv.index("--") + 1 :] if "--" in sys.argv else []
with tempfile.TemporaryDirectory() as work:
    for check in (check_units, check_print, check_orient_and_pose, check_plan, check_job, check_refusals, check_cancel):
        if chosen and check.__name__ not in chosen:
            continue
        folder = os.path.join(work, check.__name__)
        os.makedirs(folder)
        check(folder)
        print(check.__name__, "passed")
    scenes.hydrodip_addon.unregister()
print("all passed")
