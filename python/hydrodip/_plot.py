"""Pictures with matplotlib."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Callable, Optional, Tuple, Union

from . import _core

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from ._types import Array

# Named quantities per film triangle, and what to write beside their colours.
_LABELS = {
    "stretch": "largest principal stretch",
    "least_stretch": "least principal stretch",
    "area_ratio": "area now / area printed",
}


def _quantity(film: _core.Film, quantity: Union[str, Array]) -> Tuple[Any, str]:
    import numpy as np

    count = len(film.triangles)
    if not isinstance(quantity, str):
        values = np.asarray(quantity, dtype=np.float64)
        if values.shape == (len(film.positions),):
            values = values[film.triangles].mean(axis=1)
        if values.shape != (count,):
            raise _core.InputError("the quantity needs one value per film triangle or per film vertex")
        return values, ""
    if quantity not in _LABELS:
        names = ", ".join(repr(name) for name in _LABELS)
        raise _core.InputError(f"the quantity {quantity!r} is none of {names}, nor an array")
    principal = film.principal_stretches
    if quantity == "area_ratio":
        return principal.prod(axis=1), _LABELS[quantity]
    return principal[:, 0 if quantity == "stretch" else 1], _LABELS[quantity]


# Colours from what there is on the object, without its few most extreme triangles.
def _limits(values: Any, counted: Any, vmin: Optional[float], vmax: Optional[float]) -> Tuple[float, float]:
    import numpy as np

    shown = values[counted] if counted.any() else values
    low, high = np.percentile(shown, [1, 99])
    return (float(low) if vmin is None else vmin, float(high) if vmax is None else vmax)


def _axes(ax: Optional[Axes], title: str) -> Axes:
    import matplotlib.pyplot as plt

    if ax is None:
        ax = plt.subplots(figsize=(6, 6), layout="constrained")[1]
    ax.set_aspect("equal")
    ax.set_title(title)
    return ax


def plot_film(
    dip: _core.Simulation,
    quantity: Union[str, Array] = "stretch",
    *,
    ax: Optional[Axes] = None,
    cmap: str = "viridis",
    vmin: Optional[float] = None,
    vmax: Optional[float] = None,
    title: Optional[str] = None,
    colorbar: bool = True,
) -> Axes:
    """The flat film as it is printed, coloured where it lies on the object; torn film is red.

    quantity : "stretch", "least_stretch", "area_ratio", or an array (triangles,) or (vertices,).
    Returns the matplotlib Axes; film coordinates in mm.
    """
    import numpy as np
    from matplotlib.collections import PolyCollection

    film = dip.film
    values, label = _quantity(film, quantity)
    corners = film.film_coordinates[film.triangles]
    laid, torn = film.on_object & ~film.torn, film.torn
    ax = _axes(ax, title if title is not None else "film as printed")
    plain = PolyCollection(corners[~laid & ~torn], facecolors="#eceff2", edgecolors="face", linewidths=0.2)
    lost = PolyCollection(corners[torn], facecolors="#b3262e", edgecolors="face", linewidths=0.2)
    low, high = _limits(values, laid, vmin, vmax)
    shown = PolyCollection(corners[laid], array=values[laid], cmap=cmap, edgecolors="face", linewidths=0.2)
    shown.set_clim(low, high)
    for part in (plain, lost, shown):
        part.set_rasterized(True)
        ax.add_collection(part)
    low_u, high_u = film.film_coordinates.min(axis=0), film.film_coordinates.max(axis=0)
    ax.set_xlim(low_u[0], high_u[0])
    ax.set_ylim(low_u[1], high_u[1])
    ax.set_xlabel("film x, mm")
    ax.set_ylabel("film y, mm")
    if colorbar and np.any(laid):
        ax.figure.colorbar(shown, ax=ax, label=label, shrink=0.8)
    return ax


# Right, up and towards the viewer, of someone who looks at the object from (azimuth, elevation).
def _view(azimuth_deg: float, elevation_deg: float) -> Any:
    import numpy as np

    azimuth, elevation = np.radians(azimuth_deg), np.radians(elevation_deg)
    toward = np.array(
        [np.cos(elevation) * np.cos(azimuth), np.cos(elevation) * np.sin(azimuth), np.sin(elevation)]
    )
    right = np.array([-np.sin(azimuth), np.cos(azimuth), 0.0])
    return np.stack([right, np.cross(toward, right), toward])


def plot_on_object(
    dip: _core.Simulation,
    quantity: Union[str, Array, Callable[[Array], Any]] = "stretch",
    *,
    ax: Optional[Axes] = None,
    azimuth_deg: float = -60,
    elevation_deg: float = -50,
    cmap: str = "viridis",
    vmin: Optional[float] = None,
    vmax: Optional[float] = None,
    title: Optional[str] = None,
    colorbar: bool = True,
    pixels: int = 500,
) -> Axes:
    """The object with the film that lies on it, seen from below, where the film comes from.

    quantity : "stretch", "least_stretch", "area_ratio"; an array (film triangles,) or (film
        vertices,); a function of film coordinates (k, 2) in mm that returns (k,) values; or
        "predicted" and "wanted" for the object's colours.
    azimuth_deg, elevation_deg : from where one looks, in the posed object's frame; elevation -90
        is from straight below.
    pixels : of the longer side.
    Returns the matplotlib Axes; lengths in mm in the picture's plane.
    """
    import numpy as np
    from matplotlib import colormaps
    from matplotlib.cm import ScalarMappable
    from matplotlib.colors import Normalize

    view = _view(azimuth_deg, elevation_deg)
    seen = dip.vertices @ view.T
    low, high = seen.min(axis=0), seen.max(axis=0)
    edge = 0.03 * (high - low)[:2].max()
    low, high = low - edge, high + edge
    pixel = (high - low)[:2].max() / pixels
    columns, rows = (max(1, int(round(side / pixel))) for side in (high - low)[:2])
    x = low[0] + (np.arange(columns) + 0.5) * pixel
    y = high[1] - (np.arange(rows) + 0.5) * pixel
    plane = np.stack([*np.broadcast_arrays(x, y[:, None]), np.full((rows, columns), high[2])], axis=-1)
    faces, weights, _, triangles, film_points = dip.see(plane.reshape(-1, 3) @ view, -view[2])
    hit, laid = faces >= 0, triangles >= 0

    picture = np.ones((rows * columns, 4))
    picture[~hit, 3] = 0
    mappable, label = None, ""
    if isinstance(quantity, str) and quantity in ("predicted", "wanted"):
        picture[hit, :3] = dip.colors_at(faces[hit], weights[hit], quantity == "predicted") / 255.0
    else:
        picture[hit, :3] = (0.80, 0.80, 0.78)
        if callable(quantity):
            values = np.asarray(quantity(film_points[laid]), dtype=np.float64)
        else:
            of_triangles, label = _quantity(dip.film, quantity)
            values = of_triangles[triangles[laid]]
        limits = _limits(values, np.ones(len(values), bool), vmin, vmax) if len(values) else (0.0, 1.0)
        mappable = ScalarMappable(Normalize(*limits), colormaps[cmap])
        picture[laid, :3] = mappable.to_rgba(values)[:, :3]
    corners = dip.vertices[dip.faces[faces[hit]]]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-300)
    light = 0.5 + 0.5 * np.clip(normals @ (view.T @ np.array([-0.3, 0.5, 0.81])), 0, 1)
    picture[hit, :3] *= light[:, None]

    ax = _axes(ax, title if title is not None else "on the object")
    ax.imshow(picture.reshape(rows, columns, 4), extent=(low[0], high[0], low[1], high[1]))
    ax.set_xlabel("mm")
    ax.set_ylabel("mm")
    if colorbar and mappable is not None:
        ax.figure.colorbar(mappable, ax=ax, label=label, shrink=0.8)
    return ax
