# %% [markdown]
# A scan against the simulation: where the corners of a printed checkerboard came out, and where the
# program says they do. The scan here is computed with noise, as we have no real one: put your own
# file in its place.
import os

import matplotlib.pyplot as plt
import numpy as np

import hydrodip

QUICK = "HYDRODIP_EXAMPLE_QUICK" in os.environ  # for the project's tests
options = dict(
    film=(130, 130),
    film_elements=4000 if QUICK else 20000,
    dip_step_mm=1.0 if QUICK else 0.2,
)

# %% A scan: a table with the row and column of every corner, and where it lies on the object.
hydrodip.synth(["sphere"], output="scans", noise_mm=0.03, seed=3, aligned=True, **options)
table = np.genfromtxt("scans/sphere-scan.csv", delimiter=",", skip_header=2)
place, position = table[:, :2], table[:, 2:5]

# %% Eq. 4 of the paper, by all three methods.
measured = hydrodip.measure({"sphere": "scans/sphere-scan.csv"}, aligned=True, **options).scans[0]
for name, error in measured.methods.items():
    print(f"{name:12} {error.rms_mm:.3f} mm over {error.lengths} lengths")

# %% Corner by corner: back to the film, against where it was printed.
dip = hydrodip.simulate(
    hydrodip.Mesh.sample("sphere"), depth=12, material_tear_stretch=0, dip_air_cells=0, **options
)
back = dip.to_film(position)
printed = 5.0 * place
# Places are counted from some corner, and the film's centre is the middle of a square.
printed += 2.5 * np.round(np.nanmedian(back - printed, axis=0) / 2.5)
off = np.linalg.norm(back - printed, axis=1)
known = ~np.isnan(off)

# %% Drawn.
figure, (left, right) = plt.subplots(1, 2, figsize=(11, 5), layout="constrained")
hydrodip.plot_on_object(dip, ax=left, title="simulated")
shown = right.scatter(*printed[known].T, c=off[known], cmap="magma_r", s=30)
right.quiver(*printed[known].T, *(back - printed)[known].T, angles="xy", width=0.003)
right.set(aspect="equal", xlabel="film x, mm", ylabel="film y, mm",
          title=f"corners carried back: {off[known].mean():.2f} mm off on average")
figure.colorbar(shown, ax=right, label="mm")
figure.savefig("compare_with_scan.png", dpi=120)


# %% For the tests: gluing matters, as the paper says.
def check():
    full, projected = measured.methods["full"], measured.methods["projection"]
    assert full.rms_mm < 0.5 * projected.rms_mm
    assert known.sum() > 50 and np.median(off[known]) < 0.5, off[known]
