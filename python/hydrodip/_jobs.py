"""From keyword arguments to jobs."""

from __future__ import annotations

import contextlib
import os
from typing import TYPE_CHECKING, Any, Callable, Dict, Iterable, List, Mapping, Optional, Sequence, Tuple

from . import _core, _material, _mesh, _results

if TYPE_CHECKING:
    import numpy as np
    import numpy.typing as npt

    from ._types import Progress

# Short names of parameters, as the command line has them; filled by _functions.py.
SHORT: Dict[str, str] = {}

# Arguments that are no parameters.
_OWN = set(
    "model scans objects film_image material artwork dip_tables output film quality profile config "
    "settings progress board square_mm scan_units aligned mirrored z_stretch ratio poisson torn_rings "
    "shard merge noise_mm missing_share seed".split()
)
_SCANS = "board square_mm scan_units aligned mirrored z_stretch ratio poisson shard noise_mm missing_share seed".split()

_known: Dict[str, Dict[str, Any]] = {}


def _records() -> Dict[str, Dict[str, Any]]:
    if not _known:
        _known.update((p["name"], p) for p in _core.parameters())
    return _known


def parameters() -> Tuple[_results.Parameter, ...]:
    """Every parameter of the program, in the order of `hydrodip params`."""
    return tuple(
        _results.Parameter(
            p["name"],
            p["name"].replace(".", "_"),
            p["unit"],
            tuple(p["default"]) if isinstance(p["default"], list) else p["default"],
            p["range"],
            tuple(p["choices"]),
            p["help"],
        )
        for p in _records().values()
    )


def _is_number(value: Any) -> bool:
    return hasattr(value, "__float__") and getattr(value, "ndim", 0) == 0


def _is_path(value: Any) -> bool:
    return isinstance(value, (str, os.PathLike))


def _is_switch(value: Any) -> bool:
    return type(value).__name__ in ("bool", "bool_")  # numpy's


def _numbers(value: Any) -> List[float]:
    if isinstance(value, (str, bytes)):
        raise TypeError("not a number")
    if _is_number(value):
        return [float(value)]
    return [x for item in value for x in _numbers(item)]


# As the settings take it: text, a number, or numbers in a row.
def _value(value: Any, yes_no: Tuple[str, str]) -> Any:
    if _is_switch(value):
        return yes_no[0] if value else yes_no[1]
    if _is_path(value):
        return os.fspath(value)
    try:
        numbers = _numbers(value)
    except (TypeError, ValueError):
        return repr(value)  # refused with the parameter's name and range
    return numbers[0] if getattr(value, "ndim", 0) == 0 and not isinstance(value, Sequence) else numbers


def _setting(name: str, value: Any, origin: str) -> Tuple[str, Any, str, str]:
    switch = _records().get(name, {}).get("choices") == ["on", "off"]
    shown = os.fspath(value) if _is_path(value) else repr(value)
    return name, _value(value, ("on", "off") if switch else ("true", "false")), shown, origin


def _options(given: Dict[str, Any]) -> List[Tuple[str, Any, str, str]]:
    by_keyword = {name.replace(".", "_"): name for name in _records()}
    options: List[Tuple[str, Any, str, str]] = []
    seen: Dict[str, str] = {}
    for keyword, value in given.items():
        if keyword in _OWN or value is None:
            continue
        name = SHORT.get(keyword) or by_keyword[keyword]
        if name in seen:
            raise TypeError(f"{seen[name]} and {keyword} are the same parameter; give one of them")
        seen[name] = keyword
        options.append(_setting(name, value, keyword))
    for table, key in (("artwork", "artwork"), ("dip", "dip_tables")):
        for number, entry in enumerate(_tables(given.get(key), key), 1):
            for name, value in entry.items():
                origin = f"{key}[{number - 1}]"
                options.append(_setting(f"{table}[{number}].{name}", value, origin))
    return options


_EXAMPLES = {"artwork": "[{'image': 'logo.png', 'size_mm': [40, 40]}]", "dip_tables": "[{'rotate_deg': [0, 90, 0]}]"}


def _tables(given: Any, key: str) -> List[Mapping[str, Any]]:
    if given is None:
        return []
    tables = list(given) if isinstance(given, Iterable) and not isinstance(given, (str, bytes, Mapping)) else [None]
    if all(isinstance(table, Mapping) for table in tables):
        return tables
    raise TypeError(f"{key} is a list of dictionaries, as in {key}={_EXAMPLES[key]}, not {given!r}")


def _files(given: Any, key: str) -> List[str]:
    if given is None:
        return []
    single = isinstance(given, (str, os.PathLike, Mapping)) or not isinstance(given, Iterable)
    files = [given] if single else list(given)
    if all(_is_path(file) for file in files):
        return [os.fspath(file) for file in files]
    raise TypeError(f"{key} is a file or a list of files, not {given!r}")


def _is_text(value: Any) -> bool:
    return isinstance(value, str)


def _is_count(value: Any, end: int = 2**31) -> bool:
    return hasattr(value, "__index__") and 0 <= value < end


_VALUES = "a text of values to try, as in '0.5:0.8:0.1' or '0.5,0.65'"
# What arguments that are no parameters have to be; None, where it may be, is left out.
_KINDS: Dict[str, Tuple[Callable[[Any], bool], str]] = {
    "quality": (_is_text, "a name: 'draft', 'normal' or 'fine'"),
    "material": (lambda value: isinstance(value, _material.Material), "a hydrodip.Material"),
    "progress": (callable, "a function of an activity and a share"),
    "output": (_is_path, "a folder's name"),
    "board": (_is_text, "a name: 'tints' or 'black'"),
    "square_mm": (_is_number, "a number"),
    "scan_units": (_is_text, "a name: 'mm', 'cm', 'm' or 'in'"),
    "aligned": (_is_switch, "a choice of True and False"),
    "mirrored": (_is_switch, "a choice of True and False"),
    "z_stretch": (_is_text, _VALUES),
    "ratio": (_is_text, _VALUES),
    "poisson": (_is_text, _VALUES),
    "shard": (_is_text, "a text, as in '2/4'"),
    "torn_rings": (lambda value: isinstance(value, Iterable) and all(map(_is_count, value)), "a list of whole numbers"),
    "noise_mm": (_is_number, "a number"),
    "missing_share": (_is_number, "a number"),
    "seed": (lambda value: _is_count(value, 2**64), "a whole number, 0 or more"),
}


def _require_kinds(given: Dict[str, Any]) -> None:
    for key, (is_one, kind) in _KINDS.items():
        if given.get(key) is not None and not is_one(given[key]):
            raise TypeError(f"{key} is {kind}, not {given[key]!r}")


# Services and cron jobs have no HOME, or none that is one.
def _home() -> str:
    home = os.environ.get("HOME", "")
    if not os.path.isabs(home):
        import pwd

        with contextlib.suppress(KeyError):
            home = pwd.getpwuid(os.getuid()).pw_dir
    return home


# Where `hydrodip profile` keeps profiles by their names.
def _profile_folder() -> str:
    configured = os.environ.get("XDG_CONFIG_HOME", "")
    if not os.path.isabs(configured):
        configured = os.path.join(_home(), ".config")
    return os.path.join(configured, "hydrodip", "profiles")


def _film(film: Any) -> str:
    if film is None:
        return ""
    if isinstance(film, str):
        return film
    try:
        width_mm, height_mm = _numbers(film)
    except (TypeError, ValueError):
        raise TypeError(
            f"film is a name or (width, height) in mm, as in film='a4' or film=(200, 150), not {film!r}"
        ) from None
    return f"{width_mm:.17g}x{height_mm:.17g}"


def _config(given: Dict[str, Any], model: Any = None, output: Any = None, quiet: bool = False) -> Any:
    _require_kinds(given)
    name, made = ("", None) if model is None else _mesh.resolved(model)
    settings = given.get("settings") or {}
    if not isinstance(settings, Mapping):
        raise TypeError(f"settings is a dictionary, as in settings={{'film.elements': 4000}}, not {settings!r}")
    sets = [_setting(n, v, "settings") for n, v in settings.items()]
    if quiet:
        sets.append(("preview.pictures", "off", "off", "hydrodip"))
    material = given.get("material")
    return _core.configure(
        name,
        made,
        _options(given),
        sets,
        _film(given.get("film")),
        given.get("quality") or "",
        _files(given.get("profile"), "profile"),
        _profile_folder(),
        _files(given.get("config"), "config"),
        "" if output is None else os.fspath(output),
        None if material is None else material._law,
    )


class _Picture:
    """A picture's file; of an array, one that is removed again."""

    def __init__(self, picture: Any) -> None:
        self._made: Optional[str] = None
        self._given = picture

    def __enter__(self) -> str:
        if self._given is None:
            return ""
        if isinstance(self._given, (str, os.PathLike)):
            return os.fspath(self._given)
        if not (hasattr(self._given, "__array__") or isinstance(self._given, Sequence)):
            raise TypeError(f"film_image is a file or an array of a picture's bytes, not {self._given!r}")
        import tempfile

        handle, self._made = tempfile.mkstemp(suffix=".png")
        os.close(handle)
        _core.write_png(self._made, _mesh._picture(self._given))
        return self._made

    def __exit__(self, *_: Any) -> None:
        if self._made:
            os.remove(self._made)


def simulate(given: Dict[str, Any]) -> _core.Simulation:
    config = _config(given, given["model"])
    with _Picture(given["film_image"]) as picture:
        return _core.simulate(config, picture, given["progress"])


def design(given: Dict[str, Any]) -> _core.Design:
    return _core.design(_config(given, given["model"]), given["progress"])


def render(
    dip: _core.Simulation, width_px: int = 1600, *, progress: Progress = None
) -> npt.NDArray[np.uint8]:
    """Wanted beside predicted, from the two most telling directions: (rows, columns, 4) bytes."""
    return _core.render(dip, width_px, progress)


# Runs a command in `output`, or in a folder that is removed again. Returns its folder, what it
# says, and the rest.
def _run(
    command: str, given: Dict[str, Any], request: Any = None, picture: str = ""
) -> Tuple[Optional[str], Any, Any]:
    import json
    import tempfile

    request = request or _core.CalibrationRequest()
    model = given.get("model")
    keep = given.get("output")
    if keep is not None:
        config = _config(given, model, keep)
        made = _core.run_command(command, config, picture, request, given["progress"])
        return os.fspath(keep), json.loads(made[3]), made
    with tempfile.TemporaryDirectory() as folder:
        at = os.path.join(folder, "out")
        config = _config(given, model, at, quiet=True)
        made = _core.run_command(command, config, "", request, given["progress"])
        return None, json.loads(made[3]), made


def _require_output(given: Dict[str, Any]) -> None:
    if given.get("output") is None:
        raise _core.InputError("say where to write: output='FOLDER'")


def _job_files(
    command: str, given: Dict[str, Any], request: Any = None, picture: str = ""
) -> _results.JobFiles:
    _require_output(given)
    folder, report, made = _run(command, given, request, picture)
    return _results.JobFiles(str(folder), tuple(made[1]), made[2], report, made[4])


def print_job(given: Dict[str, Any]) -> _results.JobFiles:
    with _Picture(given["film_image"]) as picture:
        return _job_files("print", given, picture=picture)


def orient(given: Dict[str, Any]) -> _results.Orientation:
    folder, report, _ = _run("orient", given)
    return _results.orientation(report, folder)


def plan(given: Dict[str, Any]) -> _results.Plan:
    if given.get("output") is not None and not _is_path(given["model"]):
        raise _core.InputError(
            "a plan with output= is a job to print, which needs the model's file: save the mesh first"
        )
    folder, report, _ = _run("plan", given)
    return _results.plan(report, folder)


def _request(given: Dict[str, Any], scans: List[str]) -> Any:
    _require_kinds(given)
    request = _core.CalibrationRequest()
    request.scans = scans
    for name in _SCANS:
        if name in given:
            setattr(request, name, given[name])
    request.torn_rings = list(given.get("torn_rings") or ())
    request.merge = _files(given.get("merge"), "merge")
    return request


def _scans(scans: Any) -> List[str]:
    if hasattr(scans, "items"):
        named = list(scans.items())
        files = _files([file for _, file in named], "scans")
        return [f"{name}={file}" for (name, _), file in zip(named, files)]
    return _files(scans, "scans")


def measure(given: Dict[str, Any]) -> _results.Measurement:
    request = _request(given, _scans(given["scans"]))
    if given["output"] is None:
        # Without a folder it writes nothing.
        import json

        made = _core.run_command("measure", _config(given), "", request, given["progress"])
        return _results.measurement(json.loads(made[3]), None)
    folder, report, _ = _run("measure", given, request)
    return _results.measurement(report, folder)


def calibrate(given: Dict[str, Any]) -> _results.Calibration:
    folder, report, _ = _run("calibrate", given, _request(given, _scans(given["scans"])))
    return _results.calibration(report, folder or "")


def synth(given: Dict[str, Any]) -> _results.JobFiles:
    objects = given["objects"]
    return _job_files("synth", given, _request(given, _files(objects, "objects")))
