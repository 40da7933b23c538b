"""The jobs by whose files two programs are compared, and those by which they are timed.

A job is a list of commands, run one after the other in an empty folder of its own in which
`models` is the folder of models. Outputs go to `out`, or to folders whose names begin with it.
"""

import os
import shlex

# Small pictures, so that the bytes are of dips and inks rather than of rendering.
PICTURES = "--set preview.width_px=240 --set preview.texture_px=256"
SMALL = "--film 110x110 --set film.elements=4000 --set dip.step_mm=0.5 " + PICTURES
SIMULATE = "simulate %s -o out --quiet " + SMALL + " %s"
PRINT = "print %s -o out --quiet " + SMALL + " --dpi 90 %s"
SPOT = "models/spot/spot.obj --texture models/spot/spot_texture.png --size 60"
PEBBLE = "models/formats/pebble.obj"
CALIBRATION = "--film 110x110 --set film.elements=1000 --set dip.step_mm=1"

# Profiles of Debian's package libgs-common; other systems have none there.
CMYK_PROFILE = "/usr/share/color/icc/ghostscript/default_cmyk.icc"
RGB_PROFILE = "/usr/share/color/icc/ghostscript/a98.icc"

# Files that differ because of a fault that is named: (job, file): which fault. "*" is any job.
EXPLAINED = {
    ("calibrate", "out/simulations.jsonl"): "fingerprints know the program now",
}


def compared_jobs(with_spot):
    """Name of each job, and its commands."""
    jobs = {}

    def add(name, *commands, threads=1):
        jobs[name] = [shlex.split(c) + ["--threads", str(threads)] for c in commands]

    def sample(name):
        return "models/samples/%s.obj" % name

    # Samples.
    for name in ("sphere", "pyramid", "ellipsoid", "mask", "box"):
        add("sample-" + name, "sample %s -o out" % name)
        add("print-" + name, PRINT % (sample(name), "--size 80"), threads=2)
        add("simulate-" + name, SIMULATE % (sample(name), "--size 60 --rotate 12,-20,30"))

    # Poses.
    if with_spot:
        add("spot", PRINT % (SPOT, ""), threads=2)
        for side in ("+x", "-x", "+y", "-y", "+z"):
            add("spot-down" + side, SIMULATE % (SPOT, "--down " + side))
        add("spot-rotate", PRINT % (SPOT, "--rotate 20,-35,70"))
        add("spot-down-rotate", PRINT % (SPOT, "--down -y --rotate 5,10,-15 --depth 18"))
        add("spot-units-depth", SIMULATE %
            ("models/spot/spot.obj --texture models/spot/spot_texture.png --units in", "--depth 11"))
        add("spot-paper", PRINT % (SPOT, "--set dip.scheme=paper"))
        add("spot-a4-draft", "print %s -o out --quiet --quality draft --dpi 72" % SPOT)

    # Formats.
    for file in ("pebble.obj", "ascii.ply", "binary.ply", "colors.stl", "colors.off", "colors.3mf",
                 "inside.glb", "inside.gltf", "beside.gltf"):
        add("format-" + file, PRINT % ("models/formats/" + file, "--rotate 8,0,0"))
    add("texture-instead", PRINT % ("models/formats/pebble.obj",
                                    "--texture models/samples/mask.png"))

    # Methods and schemes.
    for name, model in (("pebble", PEBBLE), ("mask", sample("mask"))):
        for method in ("single-step", "projection"):
            add("%s-%s" % (method, name), PRINT % (model, "--size 60 --method " + method))
        add("paper-" + name, PRINT % (model, "--size 60 --set dip.scheme=paper"))
    add("paper-tears", SIMULATE % (sample("box"),
                                   "--set dip.scheme=paper --set material.tear_stretch=1.2"))

    # Film and process.
    settings = {
        "z-stretch": "material.z_stretch=0.9",
        "poisson": "material.poisson=0.3",
        "tears-never": "material.tear_stretch=0",
        "tears-early": "material.tear_stretch=1.2",
        "disc": "film.shape=disc",
        "even-grid": "film.grading=1",
        "ink-soft": "material.ink_stiffness_ratio=1",
        "ink-one-round": "ink.rounds_max=1",
        "ink-filter": "ink.filter_mm=4",
        "ink-uncompensated": "ink.compensation=off",
        "ink-limit": "ink.limit=1.5",
        "gamut-scale": "gamut.policy=scale",
        "gamut-soft": "gamut.policy=soft",
        "base-color": "object.base_color=#804020",
        "cmyk": "print.color=cmyk",
        "ink-down": "print.ink_side=down",
        "bleed": "print.bleed_mm=5",
    }
    for name, setting in settings.items():
        add(name, PRINT % (PEBBLE, "--size 60 --set " + setting))
    add("ink-off", PRINT % (sample("mask"), "--size 70 --set ink.rounds_max=1 "
                            "--set material.ink_stiffness_ratio=1"))
    add("fine", "print %s -o out --quiet --quality fine --set film.elements=9000 --depth 8 "
        "--film 90x90 --dpi 72 %s" % (PEBBLE, PICTURES), threads=2)
    add("draft", "print %s -o out --quiet --quality draft --dpi 72" % sample("mask"))
    add("without-pictures", PRINT % (sample("mask"), "--size 70 --set preview.pictures=off"))
    add("configured", PRINT % (PEBBLE, "--config models/job.toml "
                               "--profile models/film.toml --size 60"))
    for name, profile in (("cmyk", CMYK_PROFILE), ("rgb", RGB_PROFILE)):
        if os.path.exists(profile):
            add("profile-" + name, PRINT % (PEBBLE, "--size 60 --printer-profile " + profile))

    # A printed image on the film.
    for file in ("print.png", "print.tif"):
        add("film-image-" + file[-3:],
            ("print %s --size 60 -o out-print --quiet --dpi 90 " + SMALL) % PEBBLE,
            SIMULATE % (PEBBLE, "--size 60 --film-image out-print/" + file))

    # The bench and calibration.
    add("run-sheet", PRINT % (PEBBLE, "--size 60"), "rig sheet out --quiet")
    add("kit", "calibrate kit -o out --film letter --quiet")
    add("synth", "calibrate synth sphere pyramid -o out --quiet --set film.elements=600 "
        "--set dip.step_mm=1 --film 110x110 --set material.poisson=0.1 --noise 0.03 --missing 0.1")
    add("calibrate", "calibrate models/scans/sphere-scan.obj -o out --quiet --z-stretch 0.55,0.75 "
        "--ratio 10,90 --poisson 0.1 " + CALIBRATION, threads=2)
    add("measure", "measure sphere=models/scans/sphere-scan.csv -o out --quiet --json " + CALIBRATION)

    # Without a dip.
    inspected = {"mask": sample("mask"), "format": "models/formats/inside.glb --down +x"}
    if with_spot:
        inspected["spot"] = SPOT + " --rotate 30,0,0"
    for name, model in inspected.items():
        add("inspect-" + name, "inspect %s -o out --json --film a4 --quiet" % model)
    add("params", "params --json")
    for commands in (c for name, c in jobs.items() if name == "params" or name.startswith("sample-")):
        for command in commands:
            del command[-2:]  # these know no threads
    for command in jobs["run-sheet"][1:]:
        del command[-2:]
    return jobs


def write_settings(folder):
    (folder / "film.toml").write_text('[material]\nz_stretch = 0.7\npoisson = 0.1\n'
                                      '[film]\nmargin_mm = 12\n')
    (folder / "job.toml").write_text('[object]\nrotate_deg = [10, 0, 20]\nbase_color = "#dddddd"\n'
                                     '[print]\ndpi = 72\nbleed_mm = 2\n')


def timed_jobs(with_spot):
    """What users wait for."""
    jobs = {
        "print mask, a4, 600 dpi": "print models/samples/mask.obj --film a4 --dpi 600",
        "simulate mask, draft": "simulate models/samples/mask.obj --quality draft",
        "simulate sphere": "simulate models/samples/sphere.obj --film a4",
    }
    if with_spot:
        spot = "models/spot/spot.obj --texture models/spot/spot_texture.png --size 80"
        jobs["print spot, a4, 600 dpi"] = "print %s --film a4 --dpi 600" % spot
        jobs["simulate spot, draft"] = "simulate %s --quality draft" % spot
    return {name: shlex.split(command) + ["-o", "out", "--quiet"] for name, command in jobs.items()}
