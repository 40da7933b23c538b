"""Types of arguments; imported by type checkers only."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING, Any, Callable, Mapping, Optional, Protocol, Sequence, Union

if TYPE_CHECKING:
    import numpy as np
    import numpy.typing as npt

    from ._mesh import Mesh

    Array = npt.NDArray[np.float64]

    class HasFaces(Protocol):
        """A mesh of another library, as trimesh's."""

        @property
        def vertices(self) -> Any: ...
        @property
        def faces(self) -> Any: ...

    class HasCells(Protocol):
        """meshio's."""

        @property
        def points(self) -> Any: ...
        @property
        def cells(self) -> Any: ...

    PathLike = Union[str, "os.PathLike[str]"]
    ModelLike = Union[PathLike, Mesh, HasFaces, HasCells]
    PictureLike = Union[PathLike, npt.NDArray[np.uint8]]
    ScansLike = Union[Mapping[str, PathLike], Sequence[str]]
    Progress = Optional[Callable[[str, float], object]]
    Vector = Union[Sequence[float], npt.NDArray[Any], str]
    Way = Union[PathLike, Sequence[Sequence[float]], npt.NDArray[Any]]
    Color = str
