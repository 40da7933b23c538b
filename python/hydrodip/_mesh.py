"""Meshes in memory."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING, Any, List, Optional, Tuple

from . import _core

if TYPE_CHECKING:
    import numpy as np
    import numpy.typing as npt

    from ._types import ModelLike, PathLike, PictureLike, Progress


class Mesh:
    """A triangle mesh with its colours, in millimetres.

    Parameters
    ----------
    vertices : (n, 3) float64
        Kept as it is, without a copy, if it is a C-contiguous array of that type.
    faces : (m, 3) int32 or int64
        Likewise. Counter-clockwise seen from outside, where the mesh says so.
    uv : (n, 2) or (m, 3, 2) float, optional
        Texture coordinates per vertex, or per corner of every face; v = 0 is the picture's
        bottom row.
    texture : file or (rows, columns, 3 or 4) uint8, optional
        sRGB picture that the uv refer to.
    colors : (n, 3 or 4) uint8, optional
        sRGB colour per vertex.
    name : str
        In messages.
    """

    def __init__(
        self,
        vertices: Any,
        faces: Any,
        *,
        uv: Optional[Any] = None,
        texture: Optional[PictureLike] = None,
        colors: Optional[Any] = None,
        name: str = "mesh",
    ) -> None:
        import numpy as np

        self.name = name
        self.vertices: npt.NDArray[np.float64] = np.ascontiguousarray(vertices, dtype=np.float64)
        triangles = np.asarray(faces)
        if triangles.dtype not in (np.dtype(np.int32), np.dtype(np.int64)):
            whole = triangles.astype(np.int64)
            if not np.array_equal(whole, triangles):
                raise _core.InputError("the faces have to be whole numbers")
            triangles = whole
        self.faces: npt.NDArray[Any] = np.ascontiguousarray(triangles)
        self.uv: Optional[npt.NDArray[np.float64]] = (
            None if uv is None else np.ascontiguousarray(uv, dtype=np.float64)
        )
        self.texture: Optional[npt.NDArray[np.uint8]] = None if texture is None else _picture(texture)
        self.colors: Optional[npt.NDArray[np.uint8]] = (
            None if colors is None else np.ascontiguousarray(colors, dtype=np.uint8)
        )
        self._made: Optional[Tuple[int, _core.Model]] = None
        self._given: Optional[Tuple[Tuple[Any, ...], _core.Model]] = None

    def __repr__(self) -> str:
        return f"<hydrodip.Mesh {self.name!r}: {len(self.vertices)} vertices, {len(self.faces)} faces>"

    @staticmethod
    def load(file: PathLike, *, units: str = "", texture: PathLike = "", progress: Progress = None) -> Mesh:
        """Reads OBJ, PLY, STL, OFF, 3MF, glTF or GLB as the program does: checked, mended, in mm."""
        made = _core.load_model(os.fspath(file), units, os.fspath(texture), progress)
        return Mesh._of(made, os.path.basename(os.fspath(file)))

    @staticmethod
    def sample(name: str) -> Mesh:
        """A built-in sample ('sphere', 'pyramid', 'ellipsoid', 'mask', ...): `hydrodip sample`."""
        return Mesh._of(_core.sample_model(name), name)

    @staticmethod
    def of(other: Any, name: str = "mesh") -> Mesh:
        """Of another library's mesh: with vertices and faces (trimesh), or points and cells (meshio).

        A trimesh's texture and colours come along.
        """
        if hasattr(other, "vertices") and hasattr(other, "faces"):
            return Mesh(other.vertices, other.faces, name=name, **_look(other))
        if hasattr(other, "points") and hasattr(other, "cells"):
            return Mesh(other.points, _faces_of_cells(other.cells), name=name)
        raise TypeError(
            "a model is a file, a hydrodip.Mesh, or something with vertices and faces or with points "
            f"and cells, not {type(other).__name__}"
        )

    def save(self, file: PathLike) -> None:
        """Writes vertices and faces: PLY by itself, everything else by meshio."""
        import numpy as np

        if os.fspath(file).lower().endswith(".ply"):
            with open(file, "wb") as out:
                out.write(
                    f"ply\nformat binary_little_endian 1.0\nelement vertex {len(self.vertices)}\n"
                    "property double x\nproperty double y\nproperty double z\n"
                    f"element face {len(self.faces)}\nproperty list uchar int vertex_indices\n"
                    "end_header\n".encode()
                )
                out.write(self.vertices.astype("<f8").tobytes())
                rows = np.empty(len(self.faces), dtype=[("n", "u1"), ("v", "<i4", 3)])
                rows["n"] = 3
                rows["v"] = self.faces
                out.write(rows.tobytes())
            return
        import meshio

        meshio.Mesh(self.vertices, [("triangle", self.faces)]).write(file)

    @property
    def findings(self) -> List[str]:
        """What was wrong with the mesh, one sentence each."""
        return self._model().findings

    @property
    def closed(self) -> bool:
        """Whether it encloses a volume."""
        return self._model().closed

    @classmethod
    def _of(cls, made: _core.Model, name: str) -> Mesh:
        textures = made.textures
        mesh = cls(
            made.vertices, made.faces, uv=made.uv, texture=textures[0] if textures else None, name=name
        )
        mesh._given = (mesh._arrays(), made)
        return mesh

    def _arrays(self) -> Tuple[Any, ...]:
        return self.vertices, self.faces, self.uv, self.texture, self.colors

    # As the program takes it. Arrays that were changed since are read again.
    def _model(self) -> _core.Model:
        arrays = self._arrays()
        if self._given is not None and all(a is b for a, b in zip(arrays, self._given[0])):
            return self._given[1]
        import zlib

        key = 0
        for array in arrays:
            key = zlib.crc32(array.data if array is not None else b"", key)
        if self._made is None or self._made[0] != key:
            self._made = (key, _core.make_model(*arrays))
        return self._made[1]


def _picture(picture: Any) -> Any:
    import numpy as np

    if isinstance(picture, (str, os.PathLike)):
        return _core.read_image(os.fspath(picture))
    if hasattr(picture, "convert"):  # Pillow's
        picture = picture.convert("RGBA")
    return np.ascontiguousarray(picture, dtype=np.uint8)


def _look(other: Any) -> Any:
    import numpy as np

    visual: Any = getattr(other, "visual", None)
    uv = getattr(visual, "uv", None)
    material = getattr(visual, "material", None)
    image = getattr(material, "image", None)
    if image is None:
        image = getattr(material, "baseColorTexture", None)
    if uv is not None and image is not None:
        return {"uv": np.asarray(uv)[:, :2], "texture": image}
    if getattr(visual, "kind", None) in ("vertex", "face"):
        return {"colors": np.asarray(visual.vertex_colors)}
    return {}


def _faces_of_cells(cells: Any) -> Any:
    import numpy as np

    found = []
    for block in cells:
        data = np.asarray(block.data)
        if block.type == "triangle":
            found.append(data)
        elif block.type == "quad":
            found += [data[:, [0, 1, 2]], data[:, [0, 2, 3]]]
    if not found:
        raise _core.InputError("the mesh has neither triangles nor quads")
    return np.concatenate(found).astype(np.int64)


def resolved(model: ModelLike) -> Tuple[str, Optional[_core.Model]]:
    """A model's file, or its name and what it is in memory."""
    if isinstance(model, (str, os.PathLike)):
        return os.fspath(model), None
    mesh = model if isinstance(model, Mesh) else Mesh.of(model)
    return mesh.name, mesh._model()
