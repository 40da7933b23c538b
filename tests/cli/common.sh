# What the command-line tests share. Usage of every test: sh NAME.sh /path/to/hydrodip
# Works in a temporary folder of its own, removed at the end.
set -u

hydrodip=$(cd "$(dirname "$1")" && pwd)/$(basename "$1")
work=$(mktemp -d)
trap 'keep_described_files; rm -rf "$work"' EXIT
trap 'exit 1' HUP INT TERM
cd "$work" || exit 1
failures=0

# Into the folder that HYDRODIP_TEST_FILES names, if it names one: what JSON Schemas describe, for
# tests/schemas/validate.py.
keep_described_files() {
  [ -n "${HYDRODIP_TEST_FILES:-}" ] || return 0
  (cd "$work" && find . -type f \( -name report.json -o -name plan.json -o -name orient.json \
    -o -name nest.json -o -name correction.json -o -name plan.toml -o -name profile.toml -o -name truth.toml \)) |
    while read -r file; do
      mkdir -p "$HYDRODIP_TEST_FILES/$(basename "$work")/$(dirname "$file")"
      cp "$work/$file" "$HYDRODIP_TEST_FILES/$(basename "$work")/$file"
    done
}

fail() {
  echo "FAILED: $*"
  failures=$((failures + 1))
}

# expect CODE PATTERN ARGUMENT...: its exit code, and what it says.
expect() {
  wanted=$1
  pattern=$2
  shift 2
  "$hydrodip" "$@" > said.txt 2>&1 < /dev/null
  code=$?
  [ "$code" -eq "$wanted" ] || fail "$*: exit code $code instead of $wanted: $(cat said.txt)"
  grep -q -- "$pattern" said.txt || fail "$*: does not say '$pattern': $(cat said.txt)"
}

finish() {
  [ "$failures" -eq 0 ] || { echo "$failures checks failed"; exit 1; }
  echo "all passed"
  exit 0
}

# A small closed model without appearance.
write_tetrahedron() {
  cat > "$1" <<'OBJ'
v 0 0 0
v 20 -20 20
v 20 20 20
v -20 0 20
f 1 2 3
f 1 3 4
f 1 4 2
f 2 4 3
OBJ
}

# The same with vertex colours, so that it can be printed.
write_colored() {
  cat > "$1" <<'PLY'
ply
format ascii 1.0
element vertex 4
property float x
property float y
property float z
property uchar red
property uchar green
property uchar blue
element face 4
property list uchar int vertex_indices
end_header
0 0 0 255 0 0
20 -20 10 0 255 0
20 20 10 0 0 255
-20 0 10 255 255 0
3 0 2 1
3 0 3 2
3 0 1 3
3 1 2 3
PLY
}

# A sweep over the coloured model, up to what it varies: write_sweep ELEMENTS STEP_MM < THE_REST
write_sweep() {
  write_colored colored.ply
  cat > sweep.toml <<TOML
[sweep]
models = ["colored.ply"]
quality = "draft"
[set]
"film.width_mm" = 100
"film.height_mm" = 80
"film.elements" = $1
"dip.step_mm" = $2
[vary]
TOML
  cat >> sweep.toml
}

# Settings that make a job quick.
quick='--film 100x80 --set film.elements=800 --set dip.step_mm=1 --dpi 72 --set plan.suggest=off
       --set preview.width_px=200 --set print.samples=1'
quick_simulate='--film 100x80 --set film.elements=800 --set dip.step_mm=1 --set plan.suggest=off
       --set preview.width_px=200'
