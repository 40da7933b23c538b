"""What jobs say in numbers."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Dict, Optional, Tuple

Triple = Tuple[float, float, float]


@dataclass(frozen=True)
class Parameter:
    """A parameter of the program."""

    name: str  # "film.width_mm"
    keyword: str  # "film_width_mm"
    unit: str
    default: Any
    range: str
    choices: Tuple[str, ...]
    help: str


@dataclass(frozen=True)
class JobFiles:
    """What a command wrote."""

    folder: str
    files: Tuple[str, ...]
    text: str  # the result in words
    report: Dict[str, Any]  # the same for machines, as --json prints it
    do_not_dip: bool


@dataclass(frozen=True)
class Pose:
    """A way to hold the object. Shares of the whole surface."""

    rotate_deg: Triple
    down: str
    depth_mm: float
    covered_share: float
    torn_share: float
    doubtful_share: float
    air_mm2: float
    score: float
    text: str
    command: str


@dataclass(frozen=True)
class Orientation:
    """The best ways to hold an object, best first."""

    poses: Tuple[Pose, ...]
    trial_dips: int
    folder: Optional[str]


@dataclass(frozen=True)
class PlannedDip:
    """One of several dips. Shares of the whole surface."""

    down: str
    rotate_deg: Triple
    depth_mm: float
    path: Optional[Tuple[Tuple[float, ...], ...]]  # rows of keyframes; None: straight down
    gained_share: float
    covered_share: float  # after this dip
    torn_share: float
    text: str


@dataclass(frozen=True)
class Plan:
    """Several dips, in their order."""

    dips: Tuple[PlannedDip, ...]
    trial_dips: int
    folder: Optional[str]


@dataclass(frozen=True)
class MethodError:
    """Eq. 4 for one scan by one method, mm."""

    rms_mm: float
    mean_mm: float
    worst_mm: float
    edge_rms_mm: float
    diagonal_rms_mm: float
    lengths: int
    corners_without_film: int


@dataclass(frozen=True)
class ScanMeasurement:
    """One scan, by the methods "full", "single-step" and "projection"."""

    name: str
    corners: int
    off_surface_rms_mm: float
    methods: Dict[str, MethodError]


@dataclass(frozen=True)
class Measurement:
    """Scans against simulated dips."""

    scans: Tuple[ScanMeasurement, ...]
    warnings: Tuple[str, ...]
    folder: Optional[str]


@dataclass(frozen=True)
class FilmParameters:
    """What a calibration finds out about a film."""

    z_stretch: float
    ink_stiffness_ratio: float
    poisson: float


@dataclass(frozen=True)
class Calibration:
    """A fit to scans; of a shard, only how far it is."""

    parameters: Optional[FilmParameters]
    low_95: Optional[FilmParameters]
    high_95: Optional[FilmParameters]
    rms_mm: Optional[float]
    noise_mm: Optional[float]
    report: Dict[str, Any]  # calibration.json
    folder: str


def _triple(values: Any) -> Triple:
    return (float(values[0]), float(values[1]), float(values[2]))


def _picked(kind: Any, entry: Dict[str, Any], **changed: Any) -> Any:
    names = kind.__dataclass_fields__
    return kind(**{k: changed.get(k, entry.get(k)) for k in names})


def orientation(report: Dict[str, Any], folder: Optional[str]) -> Orientation:
    poses = tuple(_picked(Pose, p, rotate_deg=_triple(p["rotate_deg"])) for p in report["poses"])
    return Orientation(poses, report["trial_dips"], folder)


def plan(report: Dict[str, Any], folder: Optional[str]) -> Plan:
    dips = tuple(
        _picked(
            PlannedDip,
            d,
            rotate_deg=_triple(d["rotate_deg"]),
            path=None if d["path"] is None else tuple(tuple(row) for row in d["path"]),
        )
        for d in report["dips"]
    )
    return Plan(dips, report["trial_dips"], folder)


def measurement(report: Dict[str, Any], folder: Optional[str]) -> Measurement:
    scans = []
    for s in report["scans"]:
        methods = {
            name: _picked(MethodError, m, lengths=m["edges"] + m["diagonals"])
            for name, m in s["methods"].items()
        }
        scans.append(_picked(ScanMeasurement, s, methods=methods))
    return Measurement(tuple(scans), tuple(report["warnings"]), folder)


def calibration(report: Dict[str, Any], folder: str) -> Calibration:
    result = report.get("result")
    if result is None:
        return Calibration(None, None, None, None, None, report, folder)
    three = [FilmParameters(**result[k]) for k in ("parameters", "low_95", "high_95")]
    return Calibration(three[0], three[1], three[2], result["rms_mm"], result["noise_mm"], report, folder)
