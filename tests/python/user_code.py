"""Code as users write it; mypy --strict has to find nothing in it, and every mistake of mistakes.py."""

import pathlib
from typing import Tuple

import numpy as np
import numpy.typing as npt

import hydrodip


def stretch_of(file: pathlib.Path, depth_mm: float) -> Tuple[npt.NDArray[np.float64], float]:
    dip: hydrodip.Simulation = hydrodip.simulate(
        file, size=160, film="a4", depth=depth_mm, down="+z", film_elements=10000, preview_pictures=False
    )
    largest: float = dip.coverage.stretch_max
    return dip.film.principal_stretches[:, 0], largest


def told(activity: str, share: float) -> None:
    print(f"{activity}: {share:.0%}")


def designed(vertices: npt.NDArray[np.float64], faces: npt.NDArray[np.int64]) -> hydrodip.Design:
    mesh = hydrodip.Mesh(vertices, faces, uv=vertices[:, :2], texture="picture.png")
    made = hydrodip.design(mesh, film=(200, 150), rotate="auto", dpi=300, progress=told)
    made.write_sheet("sheet")
    rows: int = made.film_image.shape[0]
    print(rows, made.warnings)
    return made


def recoloured(file: str) -> hydrodip.Mesh:
    mesh = hydrodip.Mesh.load(file)
    mesh.vertices *= 2
    mesh.vertices = mesh.vertices @ np.diag([1.0, 1.0, 0.5])
    if mesh.uv is not None:
        mesh.uv += 0.25
    if mesh.colors is not None and mesh.face_materials is not None:
        mesh.colors[mesh.face_materials == mesh.materials.index("lid")] = 255
    mesh.textures[0][:, :, 0] = 0
    mesh.texture = np.zeros((8, 8, 3), dtype=np.uint8)
    return mesh


def best(file: str) -> hydrodip.Pose:
    found = hydrodip.orient(file, object_rotate_deg=(0, 0, 30))
    x, y, z = found.poses[0].rotate_deg
    print(x + y + z, [p.keyword for p in hydrodip.parameters()])
    return found.poses[0]


def own() -> hydrodip.Material:
    def energy(s: npt.NDArray[np.float64], t: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
        return (s - 1) ** 2 + (t - 1) ** 2

    return hydrodip.Material(energy)


def fit() -> float:
    calibration = hydrodip.calibrate({"sphere": "scan.obj"}, z_stretch="0.5:0.8:0.1", output="fit")
    assert calibration.parameters is not None
    return calibration.parameters.z_stretch


try:
    designed(np.zeros((3, 3)), np.zeros((1, 3), dtype=np.int64))
except hydrodip.InputError as error:
    print(error)
except hydrodip.DipError:
    raise
