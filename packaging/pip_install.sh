#!/bin/sh
# pip_install.sh BUILD: `pip install .` of the tree, without a network, into a fresh virtual environment,
# with what the configured build BUILD has compiled; then what it installed, and away with it.
set -eu
build=$1
say() { printf '== %s\n' "$*"; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
/usr/bin/python3 -m venv --system-site-packages "$work/venv"
pip="$work/venv/bin/pip --disable-pip-version-check"

say 'pip install .'
HYDRODIP_BUILD_DIR=$build $pip install --quiet --no-index --no-build-isolation --no-deps .
(
  cd "$work"
  venv/bin/python - <<'PY'
import pathlib
import hydrodip

folder = pathlib.Path(hydrodip.__file__).parent
assert "venv" in folder.parts, folder
for name in ("_core.pyi", "py.typed", "_functions.py"):
    assert (folder / name).is_file(), name
box = hydrodip.Mesh([[0, 0, 0], [9, -9, 9], [9, 9, 9], [-9, 0, 9]], [[0, 2, 1], [0, 3, 2], [0, 1, 3], [1, 2, 3]])
dip = hydrodip.simulate(box, film=(60, 60), film_elements=400, dip_step_mm=1)
print("hydrodip", hydrodip.__version__, "covers", round(dip.coverage.covered_mm2), "mm2")
PY
)
$pip uninstall --quiet --yes hydrodip
[ -z "$(find "$work/venv" -name '*hydrodip*')" ] || { echo 'pip_install.sh: something is left behind' >&2; exit 1; }
say 'and removed'
