# %% [markdown]
# A film material of one's own in the program's solver: a rubber that stiffens as it is stretched,
# beside the paper's linear film. It is given as an energy density of the two principal stretches;
# the program makes a smooth table of it, and checks its derivatives.
import os

import matplotlib.pyplot as plt
import numpy as np

import hydrodip

QUICK = "HYDRODIP_EXAMPLE_QUICK" in os.environ  # for the project's tests


# %% Per mm^2 of flat film; s and t are lengths now over lengths printed.
def rubber(s, t):
    """Neo-Hookean in the plane, and stiffer beyond a stretch of 1.2."""
    j = np.log(s * t)
    beyond = np.maximum(s - 1.2, 0) ** 4 + np.maximum(t - 1.2, 0) ** 4
    return 0.25 * (s**2 + t**2 - 2 - 2 * j) + 0.2 * j**2 + 10 * beyond


material = hydrodip.Material(rubber)

# %% The same dip with both.
options = dict(
    size=60,
    depth=18,
    film=(130, 130),
    film_elements=4000 if QUICK else 40000,
    dip_step_mm=0.5 if QUICK else 0.1,
    dip_air_cells=0,
    material_tear_stretch=0,
)
sphere = hydrodip.Mesh.sample("sphere")
paper = hydrodip.simulate(sphere, **options)
own = hydrodip.simulate(sphere, material=material, **options)

# %% Side by side, and how far apart the same points of the film lie.
apart = np.linalg.norm(own.film.positions - paper.film.positions, axis=1)
limits = dict(vmin=1.0, vmax=max(paper.coverage.stretch_max, own.coverage.stretch_max))
figure, panels = plt.subplots(2, 2, figsize=(9.5, 8), layout="constrained")
hydrodip.plot_on_object(paper, ax=panels[0, 0], title="the paper's film", **limits)
hydrodip.plot_on_object(own, ax=panels[0, 1], title="a stiffening rubber", **limits)
hydrodip.plot_film(own, ax=panels[1, 0], title="the rubber's stretch, as printed", **limits)
hydrodip.plot_on_object(own, apart, ax=panels[1, 1], cmap="magma", title="apart by so many mm")
figure.savefig("own_material.png", dpi=120)
laid = apart[own.film.state == hydrodip.ATTACHED]
print(f"film on the sphere lies {laid.mean():.3f} mm elsewhere on average, {laid.max():.3f} mm at most")


# %% For the tests: it is another film, found as well as the paper's.
def check():
    assert own.statistics.failed_steps == 0 and 0.02 < laid.max() < 2
