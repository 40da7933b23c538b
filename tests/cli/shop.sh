#!/bin/sh
# A shop's day: a profile saved, one job dipped five times with its readings typed in, one of them
# failed and repeated, the history and what a good piece costs, and the sixth print refused because
# the profile keeps earlier results.
. "$(dirname "$0")/common.sh"
XDG_CONFIG_HOME=$work/config
export XDG_CONFIG_HOME

refused() { # PATTERN ARGUMENT...
  pattern=$1
  shift
  "$hydrodip" "$@" > said.txt 2>&1 < /dev/null
  code=$?
  [ "$code" -eq 2 ] || fail "$*: exit code $code instead of 2: $(cat said.txt)"
  grep -q -- "$pattern" said.txt || fail "$*: does not say '$pattern': $(cat said.txt)"
}

write_colored colored.ply

# Profiles: made, changed by single values, listed, shown, taken from elsewhere.
"$hydrodip" profile list | grep -q 'no profiles' || fail 'an empty list'
"$hydrodip" profile save shop --film 100x80 --set cost.currency=EUR --set cost.film_per_m2=30 \
  --set cost.activator_per_g=0.2 --set cost.ink_per_ml=0.8 > said.txt || fail 'profile save'
"$hydrodip" profile save shop --set cost.per_piece=1.5 --set process.activator_wait_s=0 \
  --set process.soak_min_s=0 --set process.dwell_s=0 --set process.speed_mm_per_min=6000 > said.txt ||
  fail 'profile save, more values'
"$hydrodip" profile show shop > shop.txt || fail 'profile show'
grep -q '^width_mm = 100' shop.txt || fail "the profile forgot its film: $(cat shop.txt)"
grep -q '^per_piece = 1.5' shop.txt || fail 'the profile forgot what was added'
"$hydrodip" profile list | grep -q '^shop .*cost (5 values)' || fail "profile list: $("$hydrodip" profile list)"
"$hydrodip" profile list --json | python3 -c 'import json, sys; assert json.load(sys.stdin)["profiles"][0]["name"] == "shop"' ||
  fail 'profile list --json'
answers() { # COMMAND ARGUMENT...: with --json it says what it is.
  command=$1
  shift
  # shellcheck disable=SC2086
  "$hydrodip" $command "$@" --json --quiet |
    python3 -c 'import json, sys; r = json.load(sys.stdin)
assert r["schema_version"] == 1 and r["command"] == sys.argv[1], r' "$command" || fail "$command --json"
}
answers 'profile list'
answers 'profile show' shop
answers sample
answers sample sphere -o samples
answers 'register board' -o board
answers 'calibrate printer' -o test-sheet
answers 'calibrate kit' -o kit
cp shop.txt friend.toml
"$hydrodip" profile import friend.toml > /dev/null || fail 'profile import'
refused 'already' profile import friend.toml
refused 'did you mean' profile show shpo
printf '[film]\nmargin_mm = lots\n' > config/hydrodip/profiles/broken.toml
refused 'broken.toml' profile show broken
rm config/hydrodip/profiles/broken.toml
refused 'did you mean' print colored.ply --profile shpo
refused 'name' profile save ../evil --film a3
refused "without .toml: 'shop'" profile save shop.toml --film a3
refused 'there is no file nope.icc' profile save shop --printer-profile nope.icc
refused 'text of one line' profile save shop --set "cost.currency=EUR
or so"
refused 'film.margin_mm' profile save shop --set film.margin_mm=lots
cmp -s shop.txt config/hydrodip/profiles/shop.toml || fail 'a refused value changed the profile'

# The job by the profile's name.
# shellcheck disable=SC2086
"$hydrodip" print colored.ply --profile shop --set film.elements=800 --set dip.step_mm=1 --dpi 72 \
  --set preview.width_px=200 --set print.samples=1 -o job --quiet > /dev/null || fail 'print'
grep -q '"cost.per_piece"' job/report.json || fail 'the report has no cost'
answers history job
answers 'rig sheet' job

# Five dips, typed in. The third is spoilt.
dip() { # LABEL TEMPERATURE NOTES
  printf '%s\n' '' '' "$2" '' '' 100 '' 98.9 '' '' '' "$2" "$3" |
    "$hydrodip" rig guide job --batch B7 --label "$1" > said.txt 2> asked.txt ||
    fail "dip $1: $(tail -n 3 asked.txt)"
}
dip 1 28.5 ''
dip 2 28.4 ''
dip 3 28.1 'film slid'
dip 3 28.0 'again'
dip 4 27.9 ''
for run in 1 2 4 5; do
  "$hydrodip" history job --run rig-$run --outcome good > /dev/null || fail "judging rig-$run"
done
"$hydrodip" history job --run rig-3 --outcome failed > history.txt || fail 'judging rig-3'
grep -q '^5 dips: 4 good, 1 failed, 0 not judged' history.txt || fail "history: $(cat history.txt)"
grep -q 'rig-3.* B7 .*failed.* 28.1.*1.1.*film slid' history.txt || fail "rig-3: $(cat history.txt)"
"$hydrodip" history job --json | python3 -c '
import json, sys
history = json.load(sys.stdin)
runs, totals = history["runs"], history["totals"]
assert [r["label"] for r in runs] == ["1", "2", "3", "3", "4"], runs
assert all(r["batch"] == "B7" and abs(r["activator_g"] - 1.1) < 1e-9 for r in runs)
ink = totals["ink_ml"]
assert ink > 0
expected = 5 * (0.1 * 0.08 * 30 + 1.1 * 0.2 + 1.5) + ink * 0.8
assert abs(totals["cost"] - expected) < 1e-6, (totals, expected)
assert abs(totals["cost_per_good_piece"] - expected / 4) < 1e-6
' || fail 'history --json'
# Independently: what the file itself holds.
python3 -c '
import sqlite3
rows = sqlite3.connect("job/history.sqlite").execute("SELECT run, value FROM amendments WHERE field = ?", ("outcome",))
assert sorted(rows) == [("rig-1", "good"), ("rig-2", "good"), ("rig-3", "failed"), ("rig-4", "good"), ("rig-5", "good")]
' || fail 'history.sqlite'

# One that was dipped without the guide, another batch, and what is refused.
"$hydrodip" history job --add --batch B8 --water 28,27.5 --activator 1.2 --registration 0.3,-0.2,0.5 \
  --notes 'by hand' > said.txt || fail 'history --add'
"$hydrodip" history job --batch B8 | grep -q '^1 dip: 0 good' || fail 'history of one batch'
"$hydrodip" history job --batch B8 | grep -q '+0.30 -0.20' || fail 'history does not show where the film lay'
"$hydrodip" history job --batch B7 | grep -q 'film off' && fail 'a column without anything in it'
"$hydrodip" history job --settings rig-2 | cmp -s - job/report.json || fail 'history --settings'
# A slip of the hand can be taken back.
"$hydrodip" history job --json --quiet > before.json || fail 'history --json'
"$hydrodip" history job --add --batch B7 --outcome failed > said.txt || fail 'history --add by mistake'
grep -q '^added hand-2' said.txt || fail "history --add: $(cat said.txt)"
"$hydrodip" history job --remove hand-2 > said.txt || fail 'history --remove'
grep -q '^removed hand-2' said.txt || fail "history --remove: $(cat said.txt)"
"$hydrodip" history job --json --quiet | cmp -s - before.json || fail 'history --remove leaves something behind'
refused 'log.jsonl' history job --remove rig-1
refused "no run 'hand-2'" history job --remove hand-2
refused 'give one of them' history job --remove hand-1 --add
refused 'takes all of a dip away' history job --remove hand-1 --batch B8
refused 'rig-' history job --run rig-99 --outcome good
refused 'good' history job --run rig-1 --outcome splendid
refused '--run' history job --outcome good
refused '28 C before and 5 C after' history job --add --water 28,5
refused '1 or 2 numbers' history job --add --water 28,27,26
refused '1 or 2 numbers' history job --add --water 28.5C
refused 'there are: B7' history job --batch NOPE
# Another program at the file, and a file of the future.
python3 - <<'PY' &
import sqlite3, time
database = sqlite3.connect("job/history.sqlite", isolation_level=None)
database.execute("BEGIN EXCLUSIVE")
open("locked", "w")
time.sleep(9)
PY
locker=$!
while [ ! -e locked ]; do sleep 0.1; done
refused 'another program is at it' history job
wait $locker
cp -r job future
python3 -c 'import sqlite3; d = sqlite3.connect("future/history.sqlite"); d.execute("UPDATE hydrodip SET schema_version = 99"); d.commit()'
refused 'newer hydrodip' history future
printf 'no database, but longer than its header is, which has a hundred bytes and begins with a magic word of sixteen' > future/history.sqlite
refused 'told later' history future
refused 'there is no such folder' history nowhere

# Labels on the run sheet.
"$hydrodip" rig sheet job --batch B7 --label 5 > /dev/null || fail 'rig sheet'
pdftotext job/run-sheet.pdf - | grep -q 'Batch B7, piece 5' || fail 'the run sheet has no label'

# An earlier result of one's own is replaced with a line that says so, or kept.
again='print colored.ply --profile shop --set film.elements=800 --set dip.step_mm=1 --dpi 72
  --set preview.width_px=200 --set print.samples=1 -o job --quiet'
# shellcheck disable=SC2086
"$hydrodip" $again > said.txt || fail 'print again'
grep -q 'replaced the earlier result' said.txt || fail 'replacing is not said'
sum=$(cat job/print.png job/report.json | cksum)
"$hydrodip" profile save shop --no-clobber > /dev/null || fail 'profile save --no-clobber'
# shellcheck disable=SC2086
refused 'no_clobber' $again
[ "$(cat job/print.png job/report.json | cksum)" = "$sum" ] || fail 'no_clobber did not keep the result'
refused 'no_clobber' print colored.ply --no-clobber -o job

# A finished film image is printed as it is: what one print made, another prints the same.
# shellcheck disable=SC2086
"$hydrodip" print colored.ply --film 100x80 --set film.elements=800 --set dip.step_mm=1 \
  --set preview.width_px=200 --film-image job/print.tif -o given --quiet > said.txt ||
  fail "print --film-image: $(cat said.txt)"
python3 - <<'PY' || fail 'the given film image is not what is printed'
import subprocess
def pixels(name):
    return subprocess.run(["convert", name, "-depth", "8", "cmyk:-"], capture_output=True, check=True).stdout
assert len(pixels("job/print.tif")) > 1000 and pixels("job/print.tif") == pixels("given/print.tif")
PY
pdfinfo given/print.pdf | grep -q 'Page size: *283.* x 226' || fail 'the size of the given sheet'
for file in print.pdf print.png print.tif film.ply preview.png maps.png report.json report.html; do
  [ -s given/$file ] || fail "no given/$file"
done
[ ! -e given/gamut.png ] || fail 'gamut.png of a given image'
# What reaches into the taped margin is left out, with a word.
convert -size 284x227 xc:red -units PixelsPerInch -density 72 full.png
"$hydrodip" print colored.ply --film 100x80 --set film.elements=800 --set dip.step_mm=1 \
  --set preview.pictures=off --film-image full.png -o full --quiet > said.txt || fail 'a full sheet'
grep -q 'taped' full/report.json || fail 'a full sheet is not warned about'
convert full/print.png -alpha extract -crop 20x20+0+0 -format '%[fx:maxima]' info: | grep -q '^0$' ||
  fail 'the margin is printed'
refused 'finished sheet of one dip' print colored.ply --film-image full.png --dips 2 -o given2
refused '^error: --art ' print colored.ply --film-image full.png --art full.png -o given2

# A draft into the folder of a full print: no pictures of the earlier one stay beside it.
# shellcheck disable=SC2086
"$hydrodip" print colored.ply $quick -o stale --quiet > /dev/null || fail 'print into stale'
[ -e stale/gamut.png ] || fail 'no gamut.png to go'
# shellcheck disable=SC2086
"$hydrodip" print colored.ply $quick --set preview.pictures=off -o stale --quiet > /dev/null || fail 'a draft there'
ls stale | grep -q 'preview.png\|maps.png\|gamut.png' && fail "pictures of another job: $(ls stale)"
cp full.png stale/preview.png
# shellcheck disable=SC2086
refused 'preview.png: this file was not written by hydrodip' print colored.ply $quick -o stale

# The ink of each of two dips is known, and the piece is paid for once.
# shellcheck disable=SC2086
"$hydrodip" print colored.ply $quick --dips 2 -o two --quiet > /dev/null || fail 'print --dips 2'
piece() {
  "$hydrodip" history "two/dip-$1" --add --outcome good --set cost.ink_per_ml=1 --set cost.per_piece=100 --json |
    python3 -c 'import json, sys; t = json.load(sys.stdin)["totals"]; assert t["ink_ml"] > 0; print(int(t["cost"] // 100))'
}
[ "$(piece 1) $(piece 2)" = '1 0' ] || fail "the cost of two dips: $(piece 1) $(piece 2)"
finish
