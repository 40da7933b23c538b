"""Writes the Python package's functions, with a keyword argument for every parameter of the program.

Usage: generate.py HYDRODIP _functions.py
"""

import json
import subprocess
import sys
import textwrap

# Options of the command line that set a parameter under a shorter name.
SHORT = {
    "units": "object.units",
    "size": "object.size_mm",
    "down": "object.down",
    "rotate": "object.rotate_deg",
    "texture": "object.texture",
    "depth": "dip.depth_mm",
    "method": "dip.method",
    "dips": "plan.dips",
    "dpi": "print.dpi",
    "printer_profile": "ink.profile",
    "threads": "run.threads",
}

OBJECT, DIP, INK, SHEET, PLAN, RUN, OUTPUT = (
    ["object"],
    ["film", "bath", "dip", "path", "material"],
    ["ink", "gamut"],
    ["print", "preview"],
    ["plan"],
    ["run"],
    ["output"],
)

# Arguments that are no parameters: their type and what they are.
OWN = {
    "film_image": ("Optional[PictureLike]", "picture of the whole sheet as printed: a file, or bytes of shape (rows, columns, 3 or 4); its ink stiffens the film"),
    "material": ("Optional[Material]", "a film material of your own, instead of the paper's with material_poisson"),
    "artwork": ("Optional[Sequence[Mapping[str, object]]]", "layers over the model's own colours, the bottom one first: dictionaries with the keys of [[artwork]] tables (docs/artwork.md)"),
    "dip_tables": ("Optional[Sequence[Mapping[str, object]]]", "one dictionary for each of several dips, with the keys of [[dip]] tables: down, rotate_deg, depth_mm, path, locked"),
    "output": ("Optional[PathLike]", "folder for the files that the command writes; None: none are kept"),
    "film": ("Optional[Union[str, Tuple[float, float]]]", "sheet of film: 'a4', 'letter', 'a3', with '-landscape', or (width, height) in mm"),
    "quality": ("Optional[Literal['draft', 'normal', 'fine']]", "as --quality"),
    "profile": ("Optional[Union[PathLike, Sequence[PathLike]]]", "TOML files with film, printer and process, or names of profiles that `hydrodip profile` keeps"),
    "config": ("Optional[Union[PathLike, Sequence[PathLike]]]", "TOML files for this job; they win over profiles"),
    "settings": ("Optional[Mapping[str, object]]", "parameters by the names of `hydrodip params`, as {'film.elements': 4000}; they win over all else"),
    "progress": ("Progress", "is called with what is being done and how much of that is done, 0 to 1; what it raises cancels the work"),
    "board": ("Literal['tints', 'black']", "which board was printed: the kit's tints, or black and blank squares in turn"),
    "square_mm": ("float", "side of the board's squares; 0: as the board is"),
    "scan_units": ("Literal['', 'mm', 'cm', 'm', 'in']", "unit of the scans; empty: what the format says, as glTF's metres, else mm"),
    "aligned": ("bool", "the scans are in the posed object's frame: do not register them"),
    "mirrored": ("bool", "the scans are mirror images: turn them back"),
    "z_stretch": ("str", "values to try: FROM:TO:STEP, FROM:TO:xFACTOR, values with commas, or one that is known"),
    "ratio": ("str", "the same of material.ink_stiffness_ratio"),
    "poisson": ("str", "the same of Poisson's ratio"),
    "torn_rings": ("Sequence[int]", "of each dip of the kit's dome, the innermost ring on which film is torn: fits material.tear_stretch as well"),
    "shard": ("str", "only this part of the grid, as in '2/4'"),
    "merge": ("Sequence[PathLike]", "folders of shards whose simulations to use"),
    "noise_mm": ("float", "standard deviation of every coordinate"),
    "missing_share": ("float", "of the corners, left out at random"),
    "seed": ("int", "of noise, gaps and pose"),
}
DEFAULTS = {
    "board": "'tints'", "square_mm": "0.0", "scan_units": "''", "aligned": "False", "mirrored": "False",
    "z_stretch": "'0.4,0.55,0.7,0.85'", "ratio": "'3:3072:x8'", "poisson": "'0:0.4:0.2'",
    "torn_rings": "()", "shard": "''", "merge": "()", "noise_mm": "0.0", "missing_share": "0.0", "seed": "1",
}
COMMON = ["film", "quality", "profile", "config", "settings", "progress"]
SCANS = ["board", "square_mm", "scan_units", "aligned", "mirrored"]
MODEL = ("model", "ModelLike", "a model's or a job's file, a Mesh, or anything with vertices and faces")
SCAN = ("scans", "ScansLike", "scanned dips: {'sphere': 'scan.obj', 'ellipsoid@11': 'other.csv'}, or the command line's texts; scans with their colours, quad meshes or tables of corners")

# name: (what is given first, own arguments, groups of parameters, result, first line, more)
FUNCTIONS = {
    "simulate": (MODEL, ["film_image", "material", "artwork"] + COMMON, OBJECT + DIP + INK + SHEET + PLAN + RUN, "Simulation",
        "Where the film goes: the dip alone, without a design.",
        "The same numbers as `hydrodip simulate`, whose film.ply `result.film.write(file)` writes byte for byte."),
    "design": (MODEL, ["material", "artwork"] + COMMON, OBJECT + DIP + INK + SHEET + PLAN + RUN, "Design",
        "What to print so that every colour lands where the model has it, and the dip of it.",
        "The same as `hydrodip print` for one dip; `result.write_sheet(folder)` writes its print.png, print.tif and print.pdf."),
    "print_job": (MODEL, ["output", "film_image", "material", "artwork", "dip_tables"] + COMMON, OBJECT + DIP + INK + SHEET + PLAN + RUN + OUTPUT, "JobFiles",
        "`hydrodip print`: everything to print and check, in a folder.",
        "Several dips too. `output` has to be given."),
    "orient": (MODEL, ["output", "material", "artwork"] + COMMON, OBJECT + DIP + INK + SHEET + PLAN + RUN + OUTPUT, "Orientation",
        "The best ways to hold the object, and how deep.", ""),
    "plan": (MODEL, ["output", "material", "artwork", "dip_tables"] + COMMON, OBJECT + DIP + INK + SHEET + PLAN + RUN + OUTPUT, "Plan",
        "Several dips, chosen together (dips=2).",
        "With `output` it writes plan.toml, a job to print."),
    "measure": (SCAN, ["output", "material"] + SCANS + COMMON, DIP + INK + RUN, "Measurement",
        "The error of simulated dips against scans, Eq. 4 of the paper.", ""),
    "calibrate": (SCAN, ["output"] + SCANS + ["z_stretch", "ratio", "poisson", "torn_rings", "shard", "merge"] + COMMON, DIP + INK + RUN, "Calibration",
        "Fits z_stretch, ink stiffness and Poisson's ratio to scanned dips.",
        "Started again with the same `output`, an interrupted calibration goes on where it was."),
    "synth": (("objects", "Sequence[str]", "'sphere', 'pyramid', 'ellipsoid' or model files, with @DEPTH in mm"),
        ["output", "board", "square_mm", "noise_mm", "missing_share", "seed", "aligned"] + COMMON, DIP + INK + RUN, "JobFiles",
        "Scans computed from known parameters, to try calibrations on.", "`output` has to be given."),
}

HEADER = '''"""The package's functions. Made by python/generate.py from the parameter records of the program."""

# mypy: ignore-errors = False
from __future__ import annotations

from typing import TYPE_CHECKING, Mapping, Optional, Sequence, Tuple, Union

from . import _jobs

if TYPE_CHECKING:
    from typing import Literal

    from ._core import Design, Simulation
    from ._material import Material
    from ._results import Calibration, JobFiles, Measurement, Orientation, Plan
    from ._types import Color, ModelLike, PathLike, PictureLike, Progress, ScansLike, Vector, Way

'''


def keyword(name):
    return name.replace(".", "_")


def type_of(record):
    kind = record["type"]
    if kind == "choice":
        choices = record["choices"]
        literal = "Literal[" + ", ".join(repr(c) for c in choices) + "]"
        return f"Union[bool, {literal}]" if choices == ["on", "off"] else literal
    python = {"number": "float", "integer": "int", "text": "str", "path": "PathLike", "color": "Color", "vector": "Vector"}
    result = python.get(kind, "Way")
    return f"Union[{result}, Literal[{record['word']!r}]]" if record.get("word") else result


def range_of(record):
    if "min" not in record:
        return ""
    text = f"{record['min']:g} to {record['max']:g}"
    if record.get("zero_means"):
        text += f", or 0 ({record['zero_means']})"
    return text


def describe(record):
    unit = f", {record['unit']}" if record["unit"] else ""
    default = record["default"]
    shown = ", ".join(f"{v:g}" for v in default) if isinstance(default, list) else default
    text = f"{record['help']}{unit}"
    details = [d for d in (range_of(record), f"default: {shown}" if shown != "" else "") if d]
    return text + (f" ({'; '.join(details)})" if details else "")


def entry(name, kind, text):
    lines = textwrap.wrap(text, 88, initial_indent="        ", subsequent_indent="        ")
    return "\n".join([f"    {name} : {kind}"] + lines)


def function(name, records):
    first, own, groups, result, line, more = FUNCTIONS[name]
    shown = [r for r in records if r["name"].split(".")[0] in groups and r["name"] != "object.file"]
    by_name = {r["name"]: r for r in shown}
    arguments = [f"    {first[0]}: {first[1]},", "    *,"]
    documented = [entry(first[0], first[1], first[2])]

    def add(argument, kind, default, text):
        arguments.append(f"    {argument}: {kind} = {default},")
        documented.append(entry(argument, kind, text))

    for argument in own:
        kind, text = OWN[argument]
        add(argument, kind, DEFAULTS.get(argument, "None"), text)
    for short, record in SHORT.items():
        if record in by_name:
            add(short, f"Optional[{type_of(by_name[record])}]", "None", f"short for {keyword(record)}")
    for r in shown:
        if keyword(r["name"]) in own or keyword(r["name"]) in SHORT:
            continue
        add(keyword(r["name"]), f"Optional[{type_of(r)}]", "None", describe(r))
    text = [f"    {line}"] + ([""] + textwrap.wrap(more, 92, initial_indent="    ", subsequent_indent="    ") if more else [])
    docstring = "\n".join(['    """' + text[0].strip()] + text[1:] + ["", "    Parameters", "    ----------"] + documented + ['    """'])
    return "\n".join([f"def {name}("] + arguments + [f") -> {result}:", docstring, f"    return _jobs.{name}(locals())", ""])


def main():
    program, output = sys.argv[1:]
    records = json.loads(subprocess.run([program, "params", "--json"], check=True, stdout=subprocess.PIPE).stdout)["parameters"]
    version = subprocess.run([program, "--version"], check=True, stdout=subprocess.PIPE).stdout.decode().split()[1]
    names = f"__version__ = {version!r}\n\n" + "__all__ = [" + ", ".join(repr(n) for n in FUNCTIONS) + "]\n"
    short = "_jobs.SHORT.update(\n    " + textwrap.indent(json.dumps(SHORT, indent=4), "    ").strip() + "\n)\n"
    text = HEADER + names + "\n" + short + "\n\n" + "\n\n".join(function(n, records) for n in FUNCTIONS)
    with open(output, "w", encoding="utf-8") as file:
        file.write(text)


main()
