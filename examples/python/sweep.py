# %% [markdown]
# A sweep: how far the film stretches on a sphere, by how deep it is dipped and by z_stretch, the
# film's answer to slopes. Jobs run side by side in threads: simulations hold no interpreter lock.
import os
from concurrent.futures import ThreadPoolExecutor

import matplotlib.pyplot as plt
import numpy as np

import hydrodip

QUICK = "HYDRODIP_EXAMPLE_QUICK" in os.environ  # for the project's tests
sphere = hydrodip.Mesh.sample("sphere")
depths_mm = np.linspace(4, 20, 5 if QUICK else 9)
z_stretches = (0.5, 0.65, 0.8)


# %% One point of it.
def largest_stretch(z_stretch, depth_mm):
    dip = hydrodip.simulate(
        sphere,
        size=60,
        depth=depth_mm,
        film=(130, 130),
        film_elements=2500 if QUICK else 20000,
        dip_step_mm=0.5 if QUICK else 0.2,
        dip_air_cells=0,
        material_z_stretch=z_stretch,
        material_tear_stretch=0,
        threads=1,
    )
    return dip.coverage.stretch_max


# %% All of them, a thread each.
jobs = [(z, depth) for z in z_stretches for depth in depths_mm]
with ThreadPoolExecutor(os.cpu_count()) as pool:
    found = np.array(list(pool.map(lambda job: largest_stretch(*job), jobs)))
found = found.reshape(len(z_stretches), len(depths_mm))

# %% And drawn.
figure, ax = plt.subplots(figsize=(6, 4), layout="constrained")
for z_stretch, row in zip(z_stretches, found):
    ax.plot(depths_mm, row, "o-", label=f"z_stretch {z_stretch}")
ax.axhline(1.4, color="#b3262e", linewidth=1, label="film tears")
ax.set(xlabel="depth of the dip, mm", ylabel="largest stretch of film on the object",
       title="A sphere of 60 mm")
ax.legend()
figure.savefig("sweep.png", dpi=120)


# %% For the tests: deeper means steeper, and film that follows slopes less is stretched otherwise.
def check():
    assert (np.diff(found, axis=1) > -0.01).all(), found
    assert found[:, -1].min() > found[:, 0].max()
