#!/bin/sh
# Whole jobs: every file is there and other programs read it, the same bytes come out for 1 and 2
# threads, results can be read by machines, a broken pipe does no harm.
. "$(dirname "$0")/common.sh"

write_tetrahedron tetra.obj
write_colored colored.ply
print_files='film.ply gamut.png maps.png preview.glb preview.png print.pdf print.png print.tif report.html report.json'
simulate_files='film.ply maps.png preview.glb preview.png report.html report.json'

# expect_files FOLDER NAMES: these, whole, and no others.
expect_files() {
  folder=$1
  shift
  [ "$(cd "$folder" && find . -mindepth 1 | sort | tr -d '\n')" = "$(printf './%s' "$@")" ] ||
    fail "$folder holds $(ls -A "$folder")"
  for name in "$@"; do [ -s "$folder/$name" ] || fail "$folder/$name is empty"; done
}

# The lower part of a sphere: past its equator a better way is looked for, which takes longer than all
# else (cli.plan does).
sphere='samples/sphere.obj --size 40 --depth 12'

"$hydrodip" sample sphere -o samples > /dev/null || fail 'sample sphere'
# shellcheck disable=SC2086
"$hydrodip" print $sphere $quick -o out > print.txt || fail "print: $?"
expect_files out $print_files
grep -q 'print.pdf' print.txt || fail 'print does not name its files'
if command -v pdfinfo > /dev/null; then
  pdfinfo out/print.pdf | grep -q 'Page size: *283.4[0-9]* x 226.7[0-9]* pts' ||
    fail "page size: $(pdfinfo out/print.pdf)"
fi
if command -v tiffinfo > /dev/null; then
  tiffinfo out/print.tif 2>&1 | grep -q 'separated' || fail 'tiffinfo on print.tif'
fi
# Ghostscript measures the inks that the report states: mean over a sheet without marks.
if command -v gs > /dev/null; then
  # shellcheck disable=SC2086
  "$hydrodip" print $sphere $quick --set film.margin_mm=0 \
    --set print.color=cmyk -o inks --quiet > /dev/null || fail 'print of a sheet without margin'
  for ink in cyan magenta yellow black; do
    sed -n "s/.*\"$ink\": *\([0-9.e-]*\).*/\1/p" inks/report.json
  done > inks.said
  gs -q -dBATCH -dNOPAUSE -r72 -sDEVICE=ink_cov -o - inks/print.pdf > inks.gs || fail 'gs on print.pdf'
  tr -s ' ' '\n' < inks.gs | sed -n '/[0-9]/p' | paste inks.said - | awk '
      { d = 100 * $1 - $2; if (d > 0.1 || d < -0.1) ++wrong; sum += $2 }
      END { exit NR == 4 && sum > 1 && !wrong ? 0 : 1 }' ||
    fail "inks: $(tr '\n' ' ' < inks.said) against $(cat inks.gs) %"
fi
if command -v pngcheck > /dev/null; then
  pngcheck -q out/print.png out/preview.png out/maps.png || fail 'pngcheck'
fi
head -c 4 out/preview.glb | grep -q glTF || fail 'preview.glb'
head -c 40 out/film.ply | grep -q binary_little_endian || fail 'film.ply'

# The number of threads changes nothing but the times.
# shellcheck disable=SC2086
"$hydrodip" print $sphere $quick --threads 1 -o one --quiet > /dev/null || fail one
# shellcheck disable=SC2086
"$hydrodip" print $sphere $quick --threads 2 -o two --quiet > /dev/null || fail two
for name in $print_files; do
  case $name in report.*) continue ;; esac
  cmp "one/$name" "two/$name" || fail "$name depends on the number of threads"
  cmp "one/$name" "out/$name" || fail "$name depends on the run"
done

# Neither does the instruction set, on a film large enough for whatever the solver does. Whoever
# differs from one thread without any extension is found, alone or with both.
for variant in baseline-1 baseline-2 avx2-2 avx512-1 avx512-2; do
  simd=${variant%-*}
  HYDRODIP_SIMD=$simd "$hydrodip" simulate samples/sphere.obj --size 60 --depth 25 --quality draft \
    --set plan.suggest=off --threads "${variant#*-}" -o "$variant" --quiet > /dev/null 2> simd.txt
  code=$?
  if [ "$code" -ne 0 ] && grep -q 'this processor does not have it' simd.txt; then continue; fi
  [ "$code" -eq 0 ] || fail "HYDRODIP_SIMD=$simd: exit code $code: $(cat simd.txt)"
  cmp "$variant/film.ply" baseline-1/film.ply ||
    fail "the film depends on the instruction set or the threads: $variant"
done

for run in one two; do grep -o 'id="scene">[^<]*' "$run/report.html" > "$run.scene"; done
cmp one.scene two.scene || fail "the page's 3D view depends on the number of threads"

# Forward, with and without an image, of a model with and without appearance; odd names.
"$hydrodip" simulate tetra.obj $quick_simulate -o plain > /dev/null || fail 'simulate'
expect_files plain $simulate_files
mkdir 'ordnung müß sein'
cp colored.ply 'ordnung müß sein/größe 1.ply'
(cd 'ordnung müß sein' && "$hydrodip" print 'größe 1.ply' $quick > /dev/null) || fail 'odd names'
expect_files 'ordnung müß sein/größe 1-print' $print_files
"$hydrodip" simulate colored.ply --film-image 'ordnung müß sein/größe 1-print/print.png' \
  $quick_simulate -o forward > /dev/null || fail 'simulate --film-image'
expect_files forward $simulate_files

# Ink below: the printed image is mirrored, and what it leaves on the object is the same.
"$hydrodip" print colored.ply $quick --set print.ink_side=down -o below > /dev/null ||
  fail 'print.ink_side=down'
cmp -s below/print.png 'ordnung müß sein/größe 1-print/print.png' && fail 'the print is not mirrored'
"$hydrodip" simulate colored.ply --film-image below/print.png --set print.ink_side=down \
  $quick_simulate -o below-forward > /dev/null || fail 'simulate with print.ink_side=down'
cmp forward/preview.png below-forward/preview.png || fail 'the mirrored print dips differently'

# The angle map without a simulation.
"$hydrodip" inspect tetra.obj --set preview.width_px=200 --threads 1 -o inspected > inspected.txt ||
  fail 'inspect -o'
expect_files inspected angles.png report.json
grep -q 'angles.png' inspected.txt || fail 'inspect does not name its files'
"$hydrodip" inspect tetra.obj --set preview.width_px=200 --threads 2 -o inspected-again > /dev/null ||
  fail 'inspect with 2 threads'
cmp inspected/angles.png inspected-again/angles.png || fail 'angles.png depends on the threads'

# A second run replaces the first.
"$hydrodip" simulate tetra.obj $quick_simulate -o plain > /dev/null || fail 'second run'
expect_files plain $simulate_files

# Precedence, seen from outside.
# A configuration that names its model is a job, wherever it stands.
printf '[object]\nfile = "colored.ply"\n' > named.toml
# shellcheck disable=SC2086
{
  "$hydrodip" print named.toml $quick -o as-model --quiet > /dev/null || fail 'a job in the place of a model'
  "$hydrodip" print --config named.toml $quick -o as-config --quiet > /dev/null || fail 'a job by --config alone'
  "$hydrodip" simulate --config named.toml --set object.file=tetra.obj $quick_simulate --quiet > /dev/null || fail 'a model by --set'
  : > empty.toml
  expect 2 'name the model to print' print --config empty.toml $quick
}
cmp as-model/print.tif as-config/print.tif || fail 'a job prints otherwise by --config'
[ -s tetra-simulate/film.ply ] || fail 'without MODEL the folder is not named after the model'
printf 'print.dpi = 50\n[film]\nwidth_mm = 90\nheight_mm = 70\n' > job.toml
"$hydrodip" print colored.ply $quick --config job.toml --set print.dpi=60 --json --quiet \
  -o precedence > precedence.json 2> quiet.txt || fail 'config'
[ ! -s quiet.txt ] || fail '--quiet is not quiet'
if command -v python3 > /dev/null; then
  python3 - <<'PY' || fail 'JSON results'
import json
result = json.load(open('precedence.json'))
parameters = result['parameters']
assert result['folder'] == 'precedence'
assert parameters['print.dpi']['value'] == 60, '--set wins over options'
assert parameters['film.width_mm']['value'] == 100, 'options win over files'
report = json.load(open('precedence/report.json'))
assert report['parameters'] == parameters
assert any(entry['role'] == 'settings' for entry in report['inputs'])
assert 0 <= report['dip_angles']['over_limit_share'] <= 1
assert report['coverage']['torn_mm2'] >= 0 and 'torn_share' in report['coverage']
PY
fi
if command -v python3 > /dev/null; then
  "$hydrodip" params --json | python3 -c 'import json, sys
names = [p["name"] for p in json.load(sys.stdin)["parameters"]]
assert "film.elements" in names and "dip.step_mm" in names' || fail 'params --json'
  "$hydrodip" inspect tetra.obj --json | python3 -c 'import json, sys
report = json.load(sys.stdin)
assert report["size_mm"] == [40, 40, 20] and report["mesh"]["closed"]' || fail 'inspect --json'
  "$hydrodip" sample --json | python3 -c 'import json, sys
assert "mask" in [s["name"] for s in json.load(sys.stdin)["samples"]]' || fail 'sample --json'
fi

# Help, version, lists; readers that go away; closed streams.
for command in print simulate inspect view sample params; do
  "$hydrodip" "$command" --help | grep -q "^Usage: hydrodip $command" || fail "$command --help"
done
"$hydrodip" --help | grep -q inspect || fail '--help'
for command in print 'rig sheet' rig; do
  # shellcheck disable=SC2086
  "$hydrodip" $command --help > asked.txt
  # shellcheck disable=SC2086
  "$hydrodip" help $command | cmp -s - asked.txt || fail "help $command"
done
"$hydrodip" help | grep -q inspect || fail 'help'
expect 2 "unknown command 'pirnt'; did you mean 'print'" help pirnt
# What may be left out is in brackets, what may come several times has dots.
for usage in 'print MODEL' 'studio [MODEL]' 'sample [NAME]' 'nest [PART...]' 'register PHOTO JOB_DIR' \
  'rig stage ACTION [JOB_DIR]' 'correct JOB_DIR SCAN...'; do
  # shellcheck disable=SC2046
  "$hydrodip" $(echo "$usage" | grep -oE '^[a-z ]+') --help | grep -qxF "Usage: hydrodip $usage [OPTIONS]" ||
    fail "usage of $usage"
done
"$hydrodip" rig --help | grep -qx 'Usage: hydrodip rig COMMAND \[OPTIONS\]' || fail 'rig --help'
"$hydrodip" --version | grep -q '^hydrodip [0-9]' || fail '--version'
"$hydrodip" params | grep -q '^film.elements' || fail 'params'
("$hydrodip" params; echo "$?" > code.txt) | head -n 1 > /dev/null
[ "$(cat code.txt)" -eq 0 ] || fail "broken pipe: exit code $(cat code.txt)"
if [ -c /dev/full ]; then
  "$hydrodip" params > /dev/full 2> full.txt
  code=$?
  [ "$code" -eq 2 ] || fail "full disk on stdout: exit code $code"
  grep -q '^error: ' full.txt || fail 'full disk on stdout: no word about it'
fi
"$hydrodip" simulate tetra.obj $quick_simulate -o closed <&- >&- 2>&- || fail "closed streams: $?"
expect_files closed $simulate_files
finish
