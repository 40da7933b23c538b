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
expect 2 'none is so far off' calibrate printer --readings 180,230,292.06,292.06
expect 2 'give --film letter' calibrate printer --readings 180,230,292.06,292.06
expect 0 'printer-test.pdf' calibrate printer --film letter -o letter
if command -v pdftotext > /dev/null; then
  pdftotext letter/printer-test.pdf - | tr '\n' ' ' > letter.txt
  for option in '--scan IMAGE' '--readings AB,AC,AD,CB'; do
    grep -qF -- "calibrate printer --film letter $option" letter.txt ||
      fail "the letter sheet's command is not its own: $(cat letter.txt)"
  done
fi
# The smallest page has room for all of it, and smaller ones are refused.
expect 2 '180 x 180 mm at least' calibrate printer --film 160x240
expect 0 'printer-test.pdf' calibrate printer --film 180x180 -o small
if command -v pdftoppm > /dev/null; then
  pdftoppm -singlefile -png -r 600 small/printer-test.pdf small
  "$hydrodip" calibrate printer --film 180x180 --scan small.png --scan-dpi 600 -o small --json > found.json ||
    fail "the smallest test sheet"
  for scale in scale_x scale_y; do
    near "$(number $scale found.json)" 1 0.0004 || fail "the smallest test sheet: $(cat found.json)"
  done
  rm small.png
fi
expect 2 'give its --readings' calibrate printer --save mine
expect 2 'there is none' calibrate printer --readings 180.9,250.2,308.8,308.7 --scan-dpi 300
expect 2 'one of them' calibrate printer --readings 180.9,250.2,308.8,308.7 --save mine -o printer
echo words > words.txt
expect 2 'not a picture' calibrate printer --scan words.txt
if [ -f scan.png ] && command -v convert > /dev/null; then
  convert scan.png -units PixelsPerInch -density 200 scan.tif
  expect 0 'makes 1.000' calibrate printer --scan scan.tif -o printer
  convert scan.png -units PixelsPerInch -density 200x400 uneven.tif
  expect 2 '200 dpi across and 400 along' calibrate printer --scan uneven.tif -o printer
fi

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
expect 2 'no_clobber' register board -o board --no-clobber
if command -v pdftoppm > /dev/null; then
  # A printer that makes 104 mm of 100 across is given strips of 100/104.
  expect 0 'board.pdf' register board -o narrow --set print.scale_x=1.04
  for board in board narrow; do
    pdftoppm -singlefile -gray -r 100 $board/board.pdf $board-drawn
  done
  python3 - board-drawn.pgm narrow-drawn.pgm <<'PY' || fail 'the board is not drawn for the printer'
import sys
def ink_width(name):
    # Of the page's lower half, where strips are and no text is wider.
    magic, size, _, pixels = open(name, 'rb').read().split(b'\n', 3)
    width, height = map(int, size.split())
    rows = [pixels[y * width:(y + 1) * width] for y in range(height // 2, height)]
    dark = [x for x in range(width) if any(row[x] < 128 for row in rows)]
    return dark[-1] - dark[0]
wide, narrow = ink_width(sys.argv[1]), ink_width(sys.argv[2])
sys.exit(abs(wide / narrow - 1.04) > 0.004)
PY
fi
expect 2 'no_clobber' rig sheet job -o board/board.pdf --set output.no_clobber=on
expect 0 'sphere.obj' sample sphere -o samples
expect 2 'no_clobber' sample sphere -o samples --no-clobber
mkfifo pipe.pdf
expect 2 'a pipe of that name' rig sheet job -o pipe.pdf
[ -p pipe.pdf ] || fail 'a pipe was replaced'
expect 2 'cannot be written' rig sheet job -o board
expect 2 'is of --calibrate-camera' register scan.png job -o here.json
expect 2 '--set-place are of a photo' register --calibrate-camera --set-place scan.png
expect 2 '--tolerance are of a photo' register --calibrate-camera --water-sigma 1 scan.png
expect 2 '--tolerance are of a photo' register --calibrate-camera --tolerance 2 scan.png
truncate -s 3G large.bin
expect 2 'not a picture' calibrate printer --scan large.bin
expect 2 'not a picture' register --calibrate-camera large.bin
expect 2 'too many for' register scan.png job --camera large.bin
expect 2 'too many for' print colored.ply --correction large.bin
cp large.bin large.csv
expect 2 'too many for' correct job large.csv
rm large.*
expect 2 'name one photo' register
expect 2 'camera.json' register scan.png job
expect 2 '^error: gone.png: cannot be read' register gone.png job
printf '{}' > camera.json
expect 2 'not a camera' register scan.png job
printf '{"schema_version": 2}' > camera.json
expect 2 "a newer hydrodip wrote this camera's" register scan.png job
rm camera.json
expect 2 'name the photos' register --calibrate-camera
cp job/report.json kept.json
expect 2 'is no camera' register --calibrate-camera scan.png -o job/report.json
cmp -s kept.json job/report.json || fail 'a report was replaced'
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
expect 2 'no such file' print colored.ply --film-state nowhere.json
expect 2 'is a folder' print colored.ply --film-state job
printf '[film]\nmargin_mm = 12\n' > margin.toml
printf '[film]\nswelling_x = 1.03\n' > swells.toml
expect 2 'nothing of how film swells' print colored.ply --film-state margin.toml
# It is said of today's film, and a profile beside it is not.
# shellcheck disable=SC2086
"$hydrodip" print colored.ply $quick --film 140x130 --depth 6 -o both --quiet \
  --film-state swells.toml --profile margin.toml > /dev/null || fail "print --film-state --profile"
near "$(grep -A3 '"film.swelling_x"' both/report.json | number value /dev/stdin)" 1.03 1e-9 ||
  fail "a profile beside --film-state takes it away"

# ---- files of a later version ----
sed '1s/{/{"schema_version": 99, /' registration.json > later.json
expect 2 'a newer hydrodip wrote this registration' print colored.ply --film-state later.json
mkdir later
sed 's/"schema_version": *[0-9]*/"schema_version": 99/' job/report.json > later/report.json
for command in 'history later' 'correct later scan.obj' 'rig sheet later'; do
  # shellcheck disable=SC2086
  expect 2 'a newer hydrodip wrote this report' $command
done
rm later/report.json  # of a schema that there is not

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
# That correction is what its film lies by: another one in its place, or none, is told.
cp job/correction.json first.json
echo >> job/correction.json
expect 2 'job/correction.json: this correction has changed since the job in second' correct second places.csv
rm job/correction.json
expect 2 'job/correction.json: this job was printed with this correction' correct second places.csv
expect 0 'off by' correct second places.csv --set film.correction=first.json
cp first.json job/correction.json
# A job printed over the one that its correction is of can be corrected again.
cp -r job own
# shellcheck disable=SC2086
"$hydrodip" print colored.ply $quick --film 140x130 --depth 6 -o own --quiet \
  --correction own/correction.json > /dev/null || fail "print into the correction's folder"
expect 0 'print again with --correction own/correction-2.json' correct own places.csv
cmp -s first.json own/correction.json || fail "correct replaced what its print was made with"
# What it ends with can be typed, whatever the folder is called.
cp -r job 'my own job'
expect 0 "print again with --correction 'my own job/correction.*'" correct 'my own job' places.csv
# Of several dips, as the job's file has to name it.
mkdir plan
printf '[object]\nfile = "../colored.ply"\n[[dip]]\nrotate_deg = [0, 0, 0]\ndepth_mm = 6\n[[dip]]\nrotate_deg = [180, 0, 0]\ndepth_mm = 3\n' \
  > plan/two.toml
# shellcheck disable=SC2086
"$hydrodip" print plan/two.toml $quick --film 140x130 -o plan/out --quiet > /dev/null || fail "print two dips"
python3 "$here/film_ply.py" places plan/out/dip-1/film.ply 1 > dip-places.csv || fail "film.ply of a dip"
expect 0 'off by' correct plan/out/dip-1 dip-places.csv
named=$(sed -n 's/^print again with \(correction = "[^"]*"\) in the \[\[dip\]\] table 1 of plan.two.toml$/\1/p' said.txt)
[ "$named" = 'correction = "out/dip-1/correction.json"' ] || fail "the path of a dip's correction: $(cat said.txt)"
sed -i "0,/^\[\[dip\]\]/s|^\[\[dip\]\]|&\n$named|" plan/two.toml
# shellcheck disable=SC2086
"$hydrodip" print plan/two.toml $quick --film 140x130 -o plan/again --quiet > /dev/null ||
  fail "a dip's correction is not found where correct says"

# It is of that dip alone, whatever its colours.
refused() {
  pattern=$1
  shift
  # shellcheck disable=SC2086
  expect 2 "this correction $pattern" print $quick "$@" -o other --correction job/correction.json
}
dip='--film 140x130 --depth 6'
sed 's/^0 0 0/0 0 1/' colored.ply > otherwise.ply
sed 's/255 0 0$/200 9 9/' colored.ply > repainted.ply
# shellcheck disable=SC2086
{
  refused 'is of another model' otherwise.ply $dip
  refused 'was found with the object turned by 90.0' colored.ply $dip --rotate 0,0,90
  refused 'was found for the object at another size: .* 10.0 % larger' colored.ply $dip --size 44
  refused 'was found 6.0 mm deep, and this dip goes 7.0' colored.ply --film 140x130 --depth 7
  refused 'was found on film of 140 x 130 mm' colored.ply --film 150x130 --depth 6
  refused 'was found on a print for film that swells' colored.ply $dip --film-state registration.json
  refused 'was found for a dip straight down, and this one goes leaning' colored.ply $dip --set dip.tilt_deg=5
  refused 'was found for a dip straight down, and this one goes straight down, through a disc' colored.ply $dip --set film.shape=disc
  refused 'was found with film of z_stretch' colored.ply $dip --set material.z_stretch=0.9
  expect 2 'pieces of other sizes' nest colored.ply --set film.correction=job/correction.json
  expect 0 'wrote' print repainted.ply $quick $dip -o repainted --correction job/correction.json
}
expect 2 'give each dip once' correct job places.csv places.csv
head -n 1 places.csv > none.csv
expect 2 'no place' correct job none.csv
awk -F, -v OFS=, 'NR > 1 { $1 = -$1 } 1' places.csv > mirrored.csv
expect 2 'mirror image' correct job mirrored.csv
cp colored.ply kept.ply
cp otherwise.ply colored.ply
expect 0 'has changed since it was printed' correct job places.csv
cp kept.ply colored.ply
sed '0,/"of"/s//"for"/' job/correction.json > of-nothing.json
expect 2 'of which dip' print colored.ply --correction of-nothing.json
sed '0,/"schema_version":1/s//"schema_version":2/' job/correction.json > newer.json
expect 2 'a newer hydrodip' print colored.ply --correction newer.json

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
# Half a square and more along x is told as that; so is a scan that lies elsewhere.
python3 -B "$here/corner_scan.py" large/film.ply tints 5 2.5 0 > half.csv
expect 2 '2.[4-9].* from the nearest of the board' correct large half.csv --aligned --board tints
awk -F, -v OFS=, 'NR > 1 { $5 += 100 } 1' tints.csv > high.csv
expect 2 "off the object's surface" correct large high.csv --aligned
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
expect 2 '50 or more each' rig jig job --bed 220,220,0
"$hydrodip" print colored.ply --film 140x130 --size 60 --depth 4 --quality draft -o held --quiet > /dev/null ||
  fail 'print of what a jig holds'
expect 0 'jig.png' rig jig held
expect 2 'no_clobber' rig jig held --no-clobber
# In four pieces, then in one; and gone with the print that it was cut for.
[ -s held/jig/frame-4.stl ] || fail 'a frame in four pieces'
expect 0 'gone with it: frame-1.stl, frame-2.stl, frame-3.stl, frame-4.stl' rig jig held --bed 500,500,300
[ -s held/jig/frame.stl ] || fail 'a frame in one piece'
[ ! -e held/jig/frame-1.stl ] || fail 'a frame of an earlier jig stays'
expect 0 'gone with it: jig/mount.stl, .*jig/jig.png' print colored.ply --film 140x130 --size 60 --depth 5 \
  --quality draft -o held --quiet
[ ! -e held/jig ] || fail 'a jig stays that was cut for an earlier print'
finish
