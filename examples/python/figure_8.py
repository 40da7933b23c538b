# %% [markdown]
# Figure 8 of the paper: a checkerboard of 5 mm, dipped onto the three shapes of the calibration
# kit. Left a dip computed on finer film, which stands for the paper's scans; in the middle the
# simulation; right what the film must have carried to look like the left one, recovered through the
# simulation point by point.
import os

import matplotlib.pyplot as plt
import numpy as np

import hydrodip

QUICK = "HYDRODIP_EXAMPLE_QUICK" in os.environ  # for the project's tests
elements, step_mm = (2500, 0.5) if QUICK else (40000, 0.1)
SQUARE_MM = 5

# %% The checkerboard, as a picture of the whole sheet.
film_mm = (215.9, 279.4)
dpi = 100


def is_black(x, y):
    """Of film coordinates in mm."""
    return (np.floor(x / SQUARE_MM) + np.floor(y / SQUARE_MM)) % 2 == 0


columns, rows = (round(side / 25.4 * dpi) for side in film_mm)
x = (np.arange(columns) + 0.5 - columns / 2) / dpi * 25.4
y = -(np.arange(rows) + 0.5 - rows / 2) / dpi * 25.4
x, y = np.meshgrid(x, y)
inside = (np.abs(x) < film_mm[0] / 2 - 10) & (np.abs(y) < film_mm[1] / 2 - 10)
board = np.full((rows, columns, 3), 255, np.uint8)
board[is_black(x, y) & inside] = 0


# %% One dip: its ink stiffens the film.
def dip(name, depth_mm, elements, step_mm):
    return hydrodip.simulate(
        hydrodip.Mesh.sample(name),
        film=film_mm,
        film_image=board,
        depth=depth_mm,
        material_tear_stretch=0,
        film_elements=elements,
        dip_step_mm=step_mm,
        dip_air_cells=0,
    )


# Every film point gets the colour that lies on the true object where the simulation takes it.
def recovered(truth, simulated, side_mm=80, pixels=320):
    at = (np.arange(pixels) + 0.5) / pixels * side_mm - side_mm / 2
    u, v = np.meshgrid(at, -at)
    where = simulated.to_object(np.stack([u.ravel(), v.ravel()], axis=1))
    found = truth.to_film(where)
    known = ~np.isnan(found[:, 0])
    black = is_black(found[:, 0], found[:, 1])
    picture = np.full((pixels * pixels, 3), 0.75)
    picture[known & black] = 0.1
    picture[known & ~black] = 1
    right = (black == is_black(u.ravel(), v.ravel()))[known].mean()
    return picture.reshape(pixels, pixels, 3), right


# %% The figure.
shares = {}
figure, panels = plt.subplots(3, 3, figsize=(9, 9.6), layout="constrained")
for row, (name, depth_mm) in zip(panels, [("sphere", 12), ("pyramid", 22), ("ellipsoid", 11)]):
    truth = dip(name, depth_mm, 4 * elements, step_mm / 2)
    simulated = dip(name, depth_mm, elements, step_mm)
    for ax, each, title in ((row[0], truth, "computed 'scan'"), (row[1], simulated, "simulated")):
        hydrodip.plot_on_object(
            each, lambda u: np.where(is_black(*u.T), 0.1, 1.0), ax=ax, cmap="gray", vmin=0, vmax=1, elevation_deg=-65, colorbar=False,
            title=f"{name}, {title}",
        )
    picture, shares[name] = recovered(truth, simulated)
    row[2].imshow(picture)
    row[2].set_title(f"recovered film: {100 * shares[name]:.2f} % right")
    for ax in row:
        ax.axis("off")
figure.savefig("figure_8.png", dpi=120)
print({name: f"{100 * share:.2f} %" for name, share in shares.items()})


# %% For the tests.
def check():
    assert min(shares.values()) > 0.95, shares
