"""Meshes in memory."""

from __future__ import annotations

import hashlib
import os
from typing import TYPE_CHECKING, Any, Dict, List, Optional, Tuple

from . import _core

if TYPE_CHECKING:
    import numpy as np
    import numpy.typing as npt

    from ._types import ModelLike, PathLike, PictureLike, Progress

# Of an array's content, or of several arrays'.
_Digest = Tuple[str, ...]


class Mesh:
    """A triangle mesh with its colours, in millimetres.

    Its arrays may be changed in place, and set anew: what is done with the mesh next is done with
    them as they are then. Of a mesh from a file or sample all else stays as it was there.

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
    colors : (n, 3 or 4) or (m, 3, 3 or 4) uint8, optional
        sRGB colour per vertex, or per corner of every face.
    name : str
        In messages.

    Attributes
    ----------
    textures : list of (rows, columns, 3 or 4) uint8
        All pictures of a mesh from a file; `texture` is the first of them.
    face_materials : (m,) int, optional
        For each face which of the `materials` it has; None if all have the first.
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
        self.name = name
        self.vertices = vertices
        self.faces = faces
        self.uv = uv
        self.textures: List[Any] = [] if texture is None else [_picture(texture)]
        self.colors = colors
        self.face_materials = None
        # What the arrays are changes of, and what they were there; the last model made of them.
        self._base: Optional[_core.Model] = None
        self._as_in_base: Dict[str, _Digest] = {}
        self._made: Optional[Tuple[Dict[str, _Digest], _core.Model]] = None

    @property
    def vertices(self) -> npt.NDArray[np.float64]:
        return self._vertices

    @vertices.setter
    def vertices(self, vertices: npt.NDArray[np.float64]) -> None:
        self._vertices = _doubles(vertices)

    @property
    def faces(self) -> npt.NDArray[Any]:
        return self._faces

    @faces.setter
    def faces(self, faces: npt.NDArray[Any]) -> None:
        self._faces = _whole_numbers(faces, "the faces have to be whole numbers")

    @property
    def uv(self) -> Optional[npt.NDArray[np.float64]]:
        return self._uv

    @uv.setter
    def uv(self, uv: Optional[npt.NDArray[np.float64]]) -> None:
        self._uv = None if uv is None else _doubles(uv)

    @property
    def colors(self) -> Optional[npt.NDArray[np.uint8]]:
        return self._colors

    @colors.setter
    def colors(self, colors: Optional[npt.NDArray[np.uint8]]) -> None:
        self._colors = None if colors is None else _bytes(colors, "the colors have")

    @property
    def face_materials(self) -> Optional[npt.NDArray[Any]]:
        return self._face_materials

    @face_materials.setter
    def face_materials(self, numbers: Optional[npt.NDArray[Any]]) -> None:
        self._face_materials = (
            None
            if numbers is None
            else _whole_numbers(numbers, "the face_materials have to be whole numbers")
        )

    @property
    def texture(self) -> Optional[npt.NDArray[np.uint8]]:
        """The picture that the uv refer to; the first, if there are several."""
        return self.textures[0] if self.textures else None

    @texture.setter
    def texture(self, texture: Optional[npt.NDArray[np.uint8]]) -> None:
        if len(self.textures) > 1:
            raise _core.InputError(
                f"the mesh has {len(self.textures)} textures: set mesh.textures[0] and so on, or make "
                "a Mesh of its vertices, faces and uv with one texture"
            )
        self.textures = [] if texture is None else [_picture(texture)]

    @property
    def materials(self) -> List[str]:
        """Names of the materials that face_materials counts; of a file's mesh."""
        return [] if self._base is None else self._base.materials

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
        import numpy as np

        # Copies, which a user may write to.
        mesh = cls(np.array(made.vertices), np.array(made.faces), name=name)
        mesh.uv = None if made.uv is None else np.array(made.uv, dtype=np.float64)
        mesh.colors = None if made.colors is None else np.array(made.colors)
        mesh.face_materials = np.array(made.face_materials) if len(made.materials) > 1 else None
        mesh.textures = [np.array(texture) for texture in made.textures]
        mesh._base = made
        mesh._as_in_base = mesh._digests()
        return mesh

    def _arrays(self) -> Dict[str, Any]:
        self.textures[:] = [_picture(texture) for texture in self.textures]
        return {
            "vertices": self.vertices,
            "faces": self.faces,
            "face_materials": self.face_materials,
            "uv": self.uv,
            "colors": self.colors,
            "textures": self.textures,
        }

    def _digests(self) -> Dict[str, _Digest]:
        return {name: _digest(array) for name, array in self._arrays().items()}

    # As the program takes it. What is in the arrays counts, as they may be changed in place.
    def _model(self) -> _core.Model:
        digests = self._digests()
        if self._base is not None and digests == self._as_in_base:
            return self._base
        if self._made is None or self._made[0] != digests:
            changed = {
                name: array
                for name, array in self._arrays().items()
                if self._base is None or digests[name] != self._as_in_base[name]
            }
            self._made = (digests, _core.make_model(self._base, changed))
        return self._made[1]


def _digest(array: Any) -> _Digest:
    if array is None:
        return ()
    if isinstance(array, list):
        return tuple(part for each in array for part in _digest(each))
    digest = hashlib.sha256(f"{array.dtype.str} {array.shape}".encode())
    digest.update(array.data)
    return (digest.hexdigest(),)


def _doubles(values: Any) -> npt.NDArray[np.float64]:
    import numpy as np

    return np.ascontiguousarray(values, dtype=np.float64)


def _whole_numbers(values: Any, otherwise: str) -> npt.NDArray[Any]:
    import numpy as np

    given = np.asarray(values)
    if given.dtype not in (np.dtype(np.int32), np.dtype(np.int64)):
        whole = given.astype(np.int64)
        if not np.array_equal(whole, given):
            raise _core.InputError(otherwise)
        given = whole
    return np.ascontiguousarray(given)


def _bytes(values: Any, what: str) -> npt.NDArray[np.uint8]:
    import numpy as np

    given = np.asarray(values)
    with np.errstate(invalid="ignore"):  # of what is no number the comparison tells
        whole = given.astype(np.uint8)
    if not np.array_equal(whole, given):
        raise _core.InputError(f"{what} to be bytes, whole numbers from 0 to 255")
    return np.ascontiguousarray(whole if given.dtype != np.uint8 else given)


def _picture(picture: Any) -> Any:
    if isinstance(picture, (str, os.PathLike)):
        return _core.read_image(os.fspath(picture))
    if hasattr(picture, "convert"):  # Pillow's
        picture = picture.convert("RGBA")
    return _bytes(picture, "a picture's pixels have")


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
