#!/bin/sh
# hydrodip calibrate and measure from outside: kit, synthetic scans, a calibration that is killed,
# shards, refusals. Usage: sh calibrate.sh HYDRODIP
. "$(dirname "$0")/common.sh"

film='--film 110x110 --set film.elements=3000 --set dip.step_mm=0.5'
grid='--z-stretch 0.55,0.75 --ratio 30 --poisson 0.1'

# refuse PATTERN ARGUMENT...: exit code 2, one line that says PATTERN.
refuse() {
  pattern=$1
  shift
  "$hydrodip" "$@" > stdout.txt 2> stderr.txt
  code=$?
  [ "$code" -eq 2 ] || fail "$*: exit code $code instead of 2"
  grep -v '%' stderr.txt | grep -q -- "$pattern" ||
    fail "$*: does not say '$pattern': $(cat stderr.txt)"
}

"$hydrodip" calibrate kit -o kit --film letter --quiet > /dev/null || fail "kit"
# All of it is on paper: what runs off a page is not among the words of the page.
pdftotext kit/instructions.pdf - | tr '\n' ' ' > instructions.txt
grep -q 'calibrate sphere-90=FILE' instructions.txt || fail "the instructions lack how to fit"
grep -q -- '--profile my-film/profile.toml' instructions.txt || fail "the instructions lack their end"
[ "$(find kit -type f | wc -l)" -eq 7 ] || fail "the kit has not seven files: $(ls kit)"
pdfinfo kit/checkerboard.pdf | grep -q '612 x 792 pts (letter)' || fail "the film is not letter"
for shape in sphere-90 pyramid-90 ellipsoid-135 dome; do
  "$hydrodip" inspect kit/$shape.stl > said.txt || fail "inspect $shape.stl"
  grep -q '1 shell, closed' said.txt || fail "$shape.stl is not closed: $(cat said.txt)"
done
# Squares of true size: five black ones in a row of ten, by an independent reader.
pdftoppm -r 254 -gray kit/checkerboard.pdf film || fail "the film's PDF cannot be drawn"

# shellcheck disable=SC2086
"$hydrodip" calibrate synth sphere $film --set material.ink_stiffness_ratio=30 \
  --set material.poisson=0.1 --noise 0.03 -o scans --quiet > said.txt || fail "synth"
grep -q 'computed, not measured' said.txt || fail "synth does not say that it is synthetic"
# shellcheck disable=SC2086
"$hydrodip" measure sphere=scans/sphere-scan.csv $film --profile scans/truth.toml -o measured \
  --quiet --json > said.json || fail "measure"
node -e '
  const m = JSON.parse(require("fs").readFileSync("said.json")).scans[0].methods;
  const [full, single, straight] =
    ["full", "single-step", "projection"].map((name) => m[name].rms_mm);
  if (!(full < single && full < straight)) process.exit(1);
' || fail "the full method is not the best: $(cat said.json)"

# A dip packed is a scan like any other, with its board, sheet, swelling and depth.
swollen='--set film.swelling_x=1.01 --set film.swelling_y=1.006'
told='--film-product f --printer p --ink i --activator a --activator-g 3.5 --water-c 28 --soak-s 70
  --wait-s 30 --owner o --licence CC0-1.0'
# shellcheck disable=SC2086
"$hydrodip" calibrate pack sphere@11.9=scans/sphere-scan.obj $film $swollen $told -o packed --quiet \
  > said.txt || fail "pack"
# shellcheck disable=SC2086
"$hydrodip" measure sphere@11.9=scans/sphere-scan.obj $film $swollen --quiet | sed 's/([^)]*)//' > by-scan.txt
"$hydrodip" measure packed/sphere-dip.zip --set film.elements=3000 --set dip.step_mm=0.5 --quiet |
  sed 's/([^)]*)//' > by-dip.txt
cmp -s by-scan.txt by-dip.txt || fail "a packed dip measures differently: $(diff by-scan.txt by-dip.txt)"
refuse 'are for scans given as' measure packed/sphere-dip.zip --square 7
refuse 'fewer than 8 squares' calibrate kit --film 120x120 --square 20 -o kit-20
# Another object is not the kit's for its file's name.
"$hydrodip" sample sphere -o named --quiet > /dev/null || fail "sample"
mv named/sphere.obj named/sphere-90.obj
# shellcheck disable=SC2086
refuse 'know by name' calibrate pack named/sphere-90.obj@11.9=scans/sphere-scan.obj $film $told -o other
printf 'PK no archive' > killed.zip
# shellcheck disable=SC2086
refuse '--printer' calibrate pack sphere=scans/sphere-scan.obj $film
# shellcheck disable=SC2086
refuse 'killed.zip' measure killed.zip $film

# A calibration in one go, then one that is killed again and again.
# shellcheck disable=SC2086
"$hydrodip" calibrate scans/sphere-scan.obj $film $grid -o whole --quiet > whole.txt ||
  fail "calibrate"
grep -q 'computed, not scanned' whole.txt || fail "does not say that the scan is synthetic"
grep -q 'triangles is coarser than what the intervals' whole.txt || fail "coarse film without a word"
tries=0
while [ "$tries" -lt 40 ]; do
  tries=$((tries + 1))
  # shellcheck disable=SC2086
  "$hydrodip" calibrate scans/sphere-scan.obj $film $grid -o killed --quiet > killed.txt 2>&1 &
  job=$!
  ( sleep "0.$((tries * 7 % 10))"; sleep $((tries / 4)); kill -9 "$job" 2> /dev/null ) &
  killer=$!
  wait "$job" 2> /dev/null
  code=$?
  kill "$killer" 2> /dev/null
  [ "$code" -eq 137 ] || break
done
[ "$code" -eq 0 ] || fail "killed $tries times, it never ended: $code $(cat killed.txt)"
[ "$tries" -gt 1 ] || fail "it was never killed"
for file in profile.toml error-surface.csv error-surface.png; do
  cmp -s "whole/$file" "killed/$file" || fail "$file differs after $tries kills"
done
[ "$(sort whole/simulations.jsonl | cksum)" = "$(sort killed/simulations.jsonl | cksum)" ] ||
  fail "the stores differ"

# Cancelled half-way.
"$hydrodip" calibrate scans/sphere-scan.obj -o cancelled --quiet > cancelled.txt 2>&1 &
job=$!
while [ ! -s cancelled/simulations.jsonl ] && kill -0 "$job" 2> /dev/null; do sleep 0.1; done
kill -s INT "$job"
wait "$job"
grep -q 'cancelled; what was simulated is kept' cancelled.txt || fail "cancelled: $(cat cancelled.txt)"

# Two shards and their merger.
for shard in 1 2; do
  # shellcheck disable=SC2086
  "$hydrodip" calibrate scans/sphere-scan.obj $film $grid --shard $shard/2 -o shard$shard \
    --quiet > said.txt || fail "shard $shard"
done
# shellcheck disable=SC2086
"$hydrodip" calibrate scans/sphere-scan.obj $film $grid --merge shard1 --merge shard2 -o merged \
  --quiet > said.txt || fail "merge"
cmp -s whole/profile.toml merged/profile.toml || fail "merged shards give another profile"
cmp -s whole/error-surface.csv merged/error-surface.csv || fail "merged shards: another surface"

# The profile works.
"$hydrodip" params --help > /dev/null
write_tetrahedron tetra.obj
# shellcheck disable=SC2086
"$hydrodip" simulate tetra.obj $quick_simulate --profile whole/profile.toml -o used --quiet \
  > /dev/null || fail "the profile is refused"

# How film swelled is asked for, taken from where prints take it, and kept.
grep -q -- '--film-state' instructions.txt || fail "the instructions do not ask for the swelling"
grep -q 'swelling_x = 1' scans/truth.toml || fail "truth.toml does not say the swelling"
grep -q 'swelling' whole/profile.toml && fail "dry film has a swelling in its profile"
cat > registration.json <<'JSON'
{"shift_mm": {"x": 1, "y": 2}, "turn_deg": {"value": 0}, "swelling": {"x": 1.01, "y": 1.006}}
JSON
# shellcheck disable=SC2086
"$hydrodip" measure sphere@11.9=scans/sphere-scan.obj $film --film-state registration.json --quiet |
  sed 's/([^)]*)//' > by-state.txt
cmp -s by-scan.txt by-state.txt || fail "--film-state measures otherwise than the same by --set"
# shellcheck disable=SC2086
"$hydrodip" calibrate scans/sphere-scan.obj $film --z-stretch 0.6,0.65 --ratio 30 --poisson 0.1 \
  --film-state registration.json -o swollen --quiet > said.txt || fail "calibrate --film-state"
grep -q 'swelling_y = 1.006' swollen/profile.toml || fail "the profile lost the swelling"
tr -d ' \n' < swollen/calibration.json | grep -q '"swelling":{"x":1.01,"y":1.006}' ||
  fail "calibration.json lost the swelling"

# Scans that are not right.
awk -F, '/^[0-9]/ {printf "%s,%s,%.7f,%.7f,%.7f\n", $1, $2, $3/25.4, $4/25.4, $5/25.4; next} {print}' \
  scans/sphere-scan.csv > inches.csv
# shellcheck disable=SC2086
refuse '--scan-units in' measure sphere=inches.csv $film
# shellcheck disable=SC2086
"$hydrodip" measure sphere=inches.csv --scan-units in $film --quiet > /dev/null ||
  fail "a scan in inches"
awk '/^f / {print $1, $2, $3, $4; print $1, $2, $4, $5; next} {print}' scans/sphere-scan.obj \
  > triangles.obj
# shellcheck disable=SC2086
refuse 'triangles' measure sphere=triangles.obj $film
# shellcheck disable=SC2086
refuse 'which object was scanned' measure pyramid=scans/sphere-scan.csv $film
# shellcheck disable=SC2086
refuse '--aligned' measure sphere=scans/sphere-scan.csv --aligned $film
awk -F, '/^[0-9]/ {printf "%s,%s,%s,%s,%s\n", $1, $2, -$3, $4, $5; next} {print}' \
  scans/sphere-scan.csv > mirrored.csv
# shellcheck disable=SC2086
"$hydrodip" measure sphere=mirrored.csv $film --quiet > said.txt || fail "a mirrored sphere"
grep -q 'wrong way round' said.txt || fail "does not say that the scan is mirrored: $(cat said.txt)"
refuse 'sphere-90=scan.obj' calibrate
refuse 'which object' calibrate unknown.obj
refuse 'no-such.csv' calibrate sphere=no-such.csv
# The fewer corners are left to compare, the better they may look: a scan in pieces, dipped deeper
# than it is told, of whose pieces only the one about the lowest point has film.
python3 - << 'PY' || fail "a scan in pieces"
rows = [line.strip().split(',') for line in open('scans/sphere-scan.csv') if line[0] in '-0123456789']
places = {(int(c), int(r)): xyz for c, r, *xyz in rows}
low, high = min(c for c, _ in places), max(c for c, _ in places)
def squares():
    for c, r in places:
        square = [(c, r), (c, r + 1), (c + 1, r + 1), (c + 1, r)]
        inner = all(low + 3 <= value <= high - 3 for place in square for value in place)
        if all(place in places for place in square) and (inner or {c, r} & {low, high - 1}):
            yield square
kept = list(squares())
used = sorted({place for square in kept for place in square})
with open('pieces.obj', 'w') as scan:
    for place in used:
        scan.write('v ' + ' '.join(places[place]) + '\n')
    for square in kept:
        scan.write('f ' + ' '.join(str(used.index(place) + 1) for place in square) + '\n')
PY
# shellcheck disable=SC2086
refuse 'corners lie where the simulated dip lays no film, too many' \
  measure sphere@4=pieces.obj $film -o shallow
[ ! -e shallow ] || fail "an error of a few corners was written"
# shellcheck disable=SC2086
refuse 'corners lie where the simulated dip lays no film, too many' \
  calibrate sphere@4=pieces.obj $film $grid -o shallow
[ ! -e shallow/profile.toml ] || fail "parameters by a few corners were written"
rm -rf shallow
refuse "depth in mm after '@'" measure sphere@=scans/sphere-scan.csv
refuse 'begin above 0' calibrate sphere=scans/sphere-scan.csv --ratio 0:100:x2
refuse 'factor has to be above 1' calibrate sphere=scans/sphere-scan.csv --ratio 3:100:x1
refuse 'larger --film' calibrate kit --film 90x90 -o small
grep -q -- '--size\|--rotate' stderr.txt && fail "the kit is mended by what it has not: $(cat stderr.txt)"
refuse '--poisson' calibrate sphere=scans/sphere-scan.csv --poisson 0:1:0.1
cp scans/sphere-scan.csv copy.csv
# shellcheck disable=SC2086
refuse 'no-such' calibrate sphere=scans/sphere-scan.csv $film $grid --merge no-such -o new/er
[ ! -e new ] || fail "a refused calibration left $(find new)"
# shellcheck disable=SC2086
refuse 'give each dip once' calibrate sphere=scans/sphere-scan.csv sphere=copy.csv $film $grid
refuse '--shard' calibrate sphere=scans/sphere-scan.csv --shard 3/2
refuse '--square' measure sphere=scans/sphere-scan.csv --square 0.1
finish
