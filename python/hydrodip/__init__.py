"""hydrodip: from a textured model to a film image to print on PVA film and dip.

    import hydrodip

    dip = hydrodip.simulate("mask.obj", size=160, film="a4", depth=25)
    dip.film.positions          # (n, 3) where every film vertex ends up, mm
    dip.film.film_coordinates   # (n, 2) where it is printed, mm from the sheet's centre
    hydrodip.plot_on_object(dip)

Lengths are millimetres, angles degrees. Keyword arguments are the program's parameters
(`hydrodip params`), with "_" for ".": film.elements is film_elements.
"""

from ._core import (
    Air,
    AirPocket,
    Coverage,
    Design,
    DipError,
    Film,
    InputError,
    Simulation,
    Statistics,
)
from ._functions import __version__, calibrate, design, measure, orient, plan, print_job, simulate, synth
from ._jobs import parameters, render
from ._material import Material
from ._mesh import Mesh
from ._plot import plot_film, plot_on_object
from ._results import (
    Calibration,
    FilmParameters,
    JobFiles,
    Measurement,
    MethodError,
    Orientation,
    Parameter,
    Plan,
    PlannedDip,
    Pose,
    ScanMeasurement,
)

# Film.state of a vertex.
UNATTACHED, ATTACHED, CLAMPED = 0, 1, 2

__all__ = [
    "ATTACHED",
    "Air",
    "AirPocket",
    "CLAMPED",
    "Calibration",
    "Coverage",
    "Design",
    "DipError",
    "Film",
    "FilmParameters",
    "InputError",
    "JobFiles",
    "Material",
    "Measurement",
    "Mesh",
    "MethodError",
    "Orientation",
    "Parameter",
    "Plan",
    "PlannedDip",
    "Pose",
    "ScanMeasurement",
    "Simulation",
    "Statistics",
    "UNATTACHED",
    "__version__",
    "calibrate",
    "design",
    "measure",
    "orient",
    "parameters",
    "plan",
    "plot_film",
    "plot_on_object",
    "print_job",
    "render",
    "simulate",
    "synth",
]
