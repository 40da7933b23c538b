#!/bin/sh
# calibrate printer, register, correct and rig jig from outside. Usage: sh register.sh HYDRODIP
here=$(cd "$(dirname "$0")" && pwd)
. "$here/common.sh"

# number NAME FILE: of a JSON key.
number() { sed -n "s/.*\"$1\": *\\([-0-9.e]*\\).*/\\1/p" "$2" | head -n 1; }
# near A B LIMIT: whether they differ by less.
near() { awk "BEGIN { d = $1 - $2; exit !((d < 0 ? -d : d) < $3) }"; }

export XDG_CONFIG_HOME="$work/config"

# ---- a printer ----
expect 0 'printer-test.pdf' calibrate printer -o printer
if command -v pdftoppm > /dev/null; then
  pdftoppm -singlefile -png -r 200 printer/printer-test.pdf scan
  # As a printer that makes 101 mm of 100 along the sheet would.
  "$hydrodip" calibrate printer --scan scan.png --scan-dpi 198 --save mine --json > found.json ||
    fail "calibrate printer --scan"
  near "$(number scale_x found.json)" 1.0101 0.0005 || fail "scale_x: $(cat found.json)"
  near "$(number skew_deg found.json)" 0 0.02 || fail "skew: $(cat found.json)"
  expect 0 'print.scale_x' params
  expect 0 'scale_y = 1.0' profile show mine
fi
expect 0 'printer.toml' calibrate printer --readings 180.9,250.2,308.8,308.7 -o printer
expect 0 'imported' profile import printer/printer.toml other
expect 0 'scale_x = 1.005' profile show other
expect 2 'miss each other' calibrate printer --readings 180,250,320,320
expect 2 'at 100 %' calibrate printer --readings 90,125,154.03,154.03
expect 2 '--readings' calibrate printer --readings 180,250

# ---- a job with marks ----
write_colored colored.ply
# shellcheck disable=SC2086
"$hydrodip" print colored.ply $quick --film 140x130 --depth 6 -o job --quiet > /dev/null || fail "print"
# shellcheck disable=SC2086
"$hydrodip" print colored.ply $quick --film 140x130 --depth 6 -o bare --set print.marks=off --quiet \
  > /dev/null || fail "print without marks"
cmp -s job/print.png bare/print.png || fail "marks change the film image"
cmp -s job/print.pdf bare/print.pdf && fail "there are no marks"

expect 0 'board.pdf' register board -o board
expect 2 'name one photo' register
expect 2 'camera.json' register scan.png job
printf '{}' > camera.json
expect 2 'not a camera' register scan.png job
rm camera.json
expect 2 'name the photos' register --calibrate-camera
if [ -f scan.png ]; then
  expect 2 'no strip of the board' register --calibrate-camera scan.png scan.png scan.png scan.png
fi
expect 2 'no marks for the camera' register scan.png bare

# ---- film that swells ----
cat > registration.json <<'JSON'
{"shift_mm": {"x": 1, "y": 2}, "turn_deg": {"value": 0.1}, "swelling": {"x": 1.025, "y": 1.015}}
JSON
# shellcheck disable=SC2086
"$hydrodip" print colored.ply $quick --film 140x130 --depth 6 -o swollen --quiet \
  --film-state registration.json > /dev/null || fail "print --film-state"
near "$(grep -A3 '"film.swelling_x"' swollen/report.json | number value /dev/stdin)" 1.025 1e-9 ||
  fail "the report does not say how film swells"
cmp -s job/print.png swollen/print.png && fail "swollen film gets the same print"
expect 2 'registration.json' print colored.ply --film-state job/report.json

# ---- a correction ----
# Everything landed 1 mm farther to +x of the sheet than was meant: places of film.ply say so.
python3 "$here/film_ply.py" places job/film.ply 1 > places.csv || fail "film.ply"
expect 0 'off by \(1.00\|0.99\)' correct job places.csv
# shellcheck disable=SC2086
"$hydrodip" print colored.ply $quick --film 140x130 --depth 6 -o second --quiet \
  --correction job/correction.json > /dev/null || fail "print --correction"
python3 "$here/film_ply.py" shifted job/film.ply second/film.ply 1 0.02 ||
  fail "the second print is not moved by 1 mm"
expect 0 'off by' correct second places.csv

# Scans of both boards, 1 mm and half a millimetre off, say so without a word on which was dipped.
# shellcheck disable=SC2086
"$hydrodip" print colored.ply $quick --film 140x130 --size 90 --depth 18 -o large --quiet \
  --set film.elements=4000 > /dev/null || fail "print a large one"
for board in tints black; do
  python3 -B "$here/corner_scan.py" large/film.ply $board 5 1 0.5 > "$board.csv" || fail "corner_scan.py"
  expect 0 "taken for the $board board" correct large "$board.csv" --aligned
  expect 0 'off by 1.1[0-3]' correct large "$board.csv" --aligned
  expect 0 'off by 1.1[0-3]' correct large "$board.csv" --aligned --board $board
  python3 -B "$here/corner_scan.py" large/film.ply $board 5 1 0.5 askew > askew.csv
  expect 0 'off by' correct large askew.csv --board $board
done
# As far off as this, either could be meant.
python3 -B "$here/corner_scan.py" job/film.ply tints 2.5 1 0.5 > small.csv || fail "corner_scan.py"
expect 2 'say which one was dipped' correct job small.csv --square 2.5
expect 0 'off by 1.[12]' correct job small.csv --square 2.5 --board tints
expect 2 "'white'" correct large black.csv --board white
expect 2 'board' correct large black.csv --aligned --square 6
awk -F, -v OFS=, 'NR > 1 && NR % 4 { $3 += 500 } 1' places.csv > elsewhere.csv
expect 2 'places lie on the film' correct job elsewhere.csv
expect 2 'in mm' correct job places.csv --scan-units cm
expect 2 'name the job' correct job
for option in '--clearance' '--water-sigma' '--tolerance'; do
  case $option in --clearance) command='rig jig' ;; *) command='register photo.png' ;; esac
  # shellcheck disable=SC2086
  expect 2 'give a number from' $command job $option nan
done
expect 2 'not a correction' print colored.ply --correction registration.json
expect 2 'of one dip' print colored.ply --dips 2 --correction job/correction.json -o twice

# ---- a jig ----
expect 2 'gives no hold' rig jig job
expect 2 '3 numbers' rig jig job --bed 220
finish
