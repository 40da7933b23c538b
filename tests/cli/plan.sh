#!/bin/sh
# How to hold it and several dips: orient, plan, job files, --rotate auto, --strict, and what is
# refused.
here=$(cd "$(dirname "$0")" && pwd)
. "$here/common.sh"

write_colored colored.ply
small="--film 120x120 --set film.elements=800 --set dip.step_mm=1 --set preview.width_px=200"

# shellcheck disable=SC2086
"$hydrodip" orient colored.ply $small -o ways --json > ways.json || fail "orient: $?"
cmp ways.json ways/orient.json || fail 'orient --json is not orient.json'
[ -s ways/orient.png ] || fail 'orient.png'
for key in poses rotate_deg depth_mm covered_share torn_share doubtful_share air_mm2 score command; do
  grep -q "\"$key\"" ways.json || fail "orient --json has no $key"
done
# shellcheck disable=SC2086
"$hydrodip" orient colored.ply $small --set preview.pictures=off --threads 1 -o one --quiet > /dev/null ||
  fail 'orient with one thread'
# The commands differ in what was typed; all else does not depend on threads.
grep -v command ways.json > a; grep -v command one/orient.json > b
cmp a b || fail 'orient depends on the number of threads'
# The command it gives does what it says.
command=$(sed -n 's/.*"command": "hydrodip \(print .*\)".*/\1/p' ways.json | head -n 1)
# shellcheck disable=SC2086
"$hydrodip" $command --dpi 72 --set print.samples=1 -o out --quiet > said.txt || fail "its command: $command"
grep -q '^Good to dip\|^Can be dipped\|^Do not dip' said.txt || fail 'print does not say the headline first'

# shellcheck disable=SC2086
"$hydrodip" print colored.ply $small --dpi 72 --set print.samples=1 --rotate auto --depth auto -o auto \
  --quiet > /dev/null || fail 'rotate auto'
cmp auto/print.png out/print.png || fail 'auto is not the first of orient'

# Where print warns of a sheet larger than the bath, so does who looks for ways.
"$hydrodip" orient colored.ply --film a3 --set film.elements=800 --set dip.step_mm=1 --quality draft \
  --set preview.pictures=off -o large --quiet > said.txt || fail "orient on a3: $?"
grep -q '^warning: The film of .* is larger than the bath' said.txt || fail 'orient is silent about a film larger than the bath'

# Several dips: the plan is a job; the job and its parts print; the same bytes from anywhere.
# shellcheck disable=SC2086
"$hydrodip" plan colored.ply $small --dips 2 -o plan --json > plan.json || fail "plan: $?"
cmp plan.json plan/plan.json || fail 'plan --json is not plan.json'
grep -q '"gained_share"' plan.json || fail 'plan --json'
[ "$(grep -c '^\[\[dip\]\]' plan/plan.toml)" -le 2 ] || fail 'plan.toml has too many dips'
# A look in haste makes no sheets in haste, and what it ends with can be typed.
# shellcheck disable=SC2086
"$hydrodip" plan colored.ply $small --dips 1 --quality draft -o 'a plan' --quiet > said.txt || fail "draft plan: $?"
! grep -q 'rounds_max\|pictures' 'a plan/plan.toml' || fail 'plan.toml prints drafts'
command=$(sed -n 's/^print them all: hydrodip //p' said.txt)
eval "\"$hydrodip\" $command --dpi 72 --set print.samples=1 --set ink.rounds_max=1 --quiet > /dev/null" ||
  fail "its command: $command"
[ -s colored-print/report.json ] || fail 'a plan prints into a folder that every other plan has'
# What is locked stays so, plan for plan, though no rotation is given.
printf '[object]\nfile = "colored.ply"\n[[dip]]\ndown = "+x"\nlocked = true\ndepth_mm = 2\n[[dip]]\n' > locked.toml
for n in 1 2; do
  # shellcheck disable=SC2086
  "$hydrodip" plan locked.toml $small --quality draft -o locked-$n --quiet > /dev/null || fail "a locked dip: $?"
  cp locked-$n/plan.toml locked.toml
  sed -i 's|^file = .*|file = "colored.ply"|' locked.toml
  grep -q '^down = "+x"' locked.toml && grep -q '^locked = true' locked.toml || fail "plan $n loses a locked dip"
done
# A plan says beforehand what its print will say of the film that tears: of film that bears enough, and of film that does not.
"$hydrodip" sample box -o boxes --quiet > /dev/null || fail 'sample box'
printf '[object]\nfile = "boxes/box.obj"\nsize_mm = 40\n[[dip]]\nrotate_deg = [35, 10, 0]\ndepth_mm = 25\nlocked = true\n[[dip]]\nrotate_deg = [-140, 20, 0]\ndepth_mm = 25\nlocked = true\n' > torn.toml
for bears in 1.4 1.3; do
  torn="--film 120x120 --set film.elements=3000 --set dip.step_mm=1 --set material.tear_stretch=$bears --set preview.pictures=off"
  # shellcheck disable=SC2086
  "$hydrodip" plan torn.toml $torn --quality draft -o foretold --quiet > said.txt || fail "plan torn.toml: $?"
  # shellcheck disable=SC2086
  "$hydrodip" print foretold/plan.toml $torn --quality draft --dpi 72 -o told --quiet > /dev/null || fail "print of foretold: $?"
  python3 - "$(grep -c '^warning: The print of these dips will advise against' said.txt)" <<'PY' || fail "what plan foretells of film that bears $bears"
import json, sys
plan, report = json.load(open('foretold/plan.json')), json.load(open('told/report.json'))
assert abs(plan['missed_share'] - report['missed_share']) < 1e-9, (plan['missed_share'], report['missed_share'])
assert (report['concern'] == 'stop') == (sys.argv[1] == '1'), (report['verdict'], sys.argv[1])
print(report['concern'])
PY
done > concerns
[ "$(tr '\n' ' ' < concerns)" = 'care stop ' ] || fail "torn.toml: $(cat concerns)"
# And whatever else its print will advise against: of a picture on one side the second dip is for nothing, and no more of them help.
sed '/^mtllib/d; /^usemtl/d' boxes/box.obj > boxes/bare.obj
printf '<svg xmlns="http://www.w3.org/2000/svg" width="9mm" height="9mm"><rect width="9mm" height="9mm" fill="red"/></svg>' > picture.svg
side="--set preview.pictures=off --quality draft --film 120x120 --set film.elements=3000"
pictured="boxes/bare.obj --size 40 --art picture.svg --art-toward 0,0,1"
# shellcheck disable=SC2086
"$hydrodip" plan $pictured --dips 2 $side -o side --quiet > said.txt || fail "plan of one side: $?"
grep -q '^covered after so many dips: .* of the surface; of what shall be printed: 1: ' said.txt ||
  fail 'plan does not say how much of the picture it covers'
grep -q '^warning: The print of these dips will advise against them: A dip for nothing: 2 .*--dips 1' said.txt ||
  fail "plan does not foretell a dip for nothing: $(cat said.txt)"
# shellcheck disable=SC2086
"$hydrodip" print side/plan.toml $side --dpi 72 -o side-print --quiet > said.txt || fail "print of side: $?"
grep -q 'A dip for nothing: 2 ' said.txt || fail "print of side: $(cat said.txt)"
! grep -q -e '--dips 3' said.txt || fail 'more dips are said to help where one is for nothing'
python3 - <<'PY' || fail 'what plan says of the picture'
import json
plan, report = json.load(open('side/plan.json')), json.load(open('side-print/report.json'))
assert abs(plan['missed_share'] - report['missed_share']) < 1e-9, (plan['missed_share'], report['missed_share'])
covered = [count['covered_wanted_share'] for count in plan['coverage']]
assert abs(covered[1] - report['wanted']['covered_share']) < 1e-9 and covered[0] <= covered[1], (covered, report['wanted'])
assert abs(sum(dip['gained_wanted_share'] for dip in plan['dips']) - covered[1]) < 1e-9, plan
PY
# A dip alone is the one that orient recommends: no other brings what it tears.
# shellcheck disable=SC2086
"$hydrodip" plan boxes/box.obj --size 40 --dips 1 $side -o alone --json --quiet > alone.json || fail "plan of one dip: $?"
# shellcheck disable=SC2086
"$hydrodip" orient boxes/box.obj --size 40 $side -o alone --json --quiet > ways.json || fail "orient of the box: $?"
python3 - <<'PY' || fail 'plan --dips 1 is not what orient recommends'
import json
dip, way = json.load(open('alone.json'))['dips'][0], json.load(open('ways.json'))['poses'][0]
assert (dip['rotate_deg'], dip['depth_mm']) == (way['rotate_deg'], way['depth_mm']), (dip, way)
PY
# inspect tells of each dip what the job says of it, and whether it fits; what is left to be found is.
cat > each.toml <<'TOML'
[object]
file = "boxes/box.obj"
[[dip]]
rotate_deg = [0, 0, 0]
depth_mm = 3
[[dip]]
down = "+x"
depth_mm = 0
[[dip]]
rotate_deg = [0, 90, 0]
[[dip]]
depth_mm = 7
[[dip]]
path = [[0, 0, 0, 0, 0, 0], [4, 0, 0, 0, 0, 0]]
TOML
"$hydrodip" inspect each.toml --film 55x55 --set plan.dips=6 --json --quiet > each.json || fail "inspect each.toml: $?"
"$hydrodip" inspect each.toml --film 55x55 --set plan.dips=6 --quiet > each.txt || fail "inspect each.toml: $?"
python3 - <<'PY' || fail "inspect of several dips: $(cat each.txt each.json)"
import json
report = json.load(open('each.json'))
dips = report['dips']
assert [dip['depth_mm'] for dip in dips] == [3, 40, None, 7, 4, None], dips
assert [dip['down'] for dip in dips] == ['-z', '+x', '-z', None, '-z', None], dips
assert dips[2]['rotate_deg'] == [0, 90, 0] and dips[3]['rotate_deg'] is None
sizes = [dip['size_mm'] and [round(mm, 6) for mm in dip['size_mm']] for dip in dips]
assert sizes == [[40, 40, 15], [15, 40, 40], [15, 40, 40], None, [40, 40, 15], None], sizes
assert [bool(dip['fit']) for dip in dips] == [True, True, False, False, True, False]
# The free film is 35 mm, and both of the box's sides that are told are 40.
assert not any(all(fit['fits'] for fit in dip['fit']) for dip in dips if dip['fit'])
assert next(film for film in report['films'] if film['name'] == 'a4')['fits']
lines = open('each.txt').read().splitlines()
told = {line.split('  ')[0]: line for line in lines if line.startswith('dip ') and line[4].isdigit()}
assert ', 3.00 mm deep; ' in told['dip 1'] and '5.00 mm too much' in told['dip 1'], told
assert ', 40.00 mm deep; ' in told['dip 2'] and ', as deep as plan finds' in told['dip 3'], told
assert 'held as plan finds, 7.00 mm deep' in told['dip 4'] and ', 4.00 mm deep' in told['dip 5'], told
assert not any(line.startswith('dipped ') for line in lines), lines
PY
# What each dip takes is what its print takes, not what the object takes as it stands.
printf '[object]\nfile = "boxes/box.obj"\n[[dip]]\ndown = "+x"\ndepth_mm = 40\n[[dip]]\ndown = "-x"\ndepth_mm = 5\n' > deep.toml
"$hydrodip" inspect deep.toml --set bath.depth_mm=30 --quiet > said.txt || fail "inspect deep.toml: $?"
grep -q '^dip 1 .*, 40.00 mm deep; .*10.00 mm too much' said.txt && grep -q '^dip 2 .*, 5.00 mm deep; fits$' said.txt ||
  fail "inspect of a dip deeper than the bath: $(cat said.txt)"
# Little free film beside the object is told beforehand, dip by dip, as print tells it.
tight="--set film.elements=800 --set dip.step_mm=1 --set dip.air_cells=0 --set preview.pictures=off --film 66x66"
printf '[object]\nfile = "boxes/box.obj"\nsize_mm = 40\n[[dip]]\nrotate_deg = [0, 0, 0]\ndepth_mm = 3\nlocked = true\n[[dip]]\nrotate_deg = [0, 0, 90]\ndepth_mm = 0\nlocked = true\n' > tight.toml
# shellcheck disable=SC2086
"$hydrodip" plan tight.toml $tight -o tight --quiet > said.txt || fail "plan of tight film: $?"
# shellcheck disable=SC2086
"$hydrodip" print tight/plan.toml $tight --dpi 72 -o tight-print --quiet > printed.txt || fail "print on tight film: $?"
for file in said.txt printed.txt; do
  for dip in 1 2; do
    grep -q "^warning: dip $dip: Only .* of free film is left beside the object" $file || fail "tight film: $(cat $file)"
  done
done
# A depth is written as it was said, and one for all is not there beside them.
[ "$(grep -c '^depth_mm = ' tight/plan.toml)" -eq 2 ] && grep -qx 'depth_mm = 0' tight/plan.toml || fail "plan.toml: $(cat tight/plan.toml)"
# shellcheck disable=SC2086
"$hydrodip" plan boxes/box.obj --size 40 --dips 1 --depth 3 $side -o shallow --quiet > /dev/null || fail "plan --depth: $?"
[ "$(grep -c '^depth_mm = 3$' shallow/plan.toml)" -eq 1 ] || fail "plan.toml: $(cat shallow/plan.toml)"
# Air that either of two dips traps is the report's, and is told once, of that dip.
python3 - <<'PY'
from math import cos, pi, sin
ring = lambda r, z: [(r * cos(2 * pi * k / 24), r * sin(2 * pi * k / 24), z) for k in range(24)]
points = [*ring(15, 0), *ring(15, 20), *ring(12, 20), *ring(12, 4), (0, 0, 0), (0, 0, 4)]
with open('cup.obj', 'w') as file:
    for x, y, z in points:
        file.write(f'v {x} {y} {z}\n')
    for k in range(24):
        a, b = k + 1, (k + 1) % 24 + 1
        for low in (0, 24, 48):
            file.write(f'f {low + a} {low + b} {low + b + 24}\nf {low + a} {low + b + 24} {low + a + 24}\n')
        file.write(f'f 97 {b} {a}\nf 98 {a + 72} {b + 72}\n')
PY
for order in '180 90' '90 180'; do
  printf '[object]\nfile = "cup.obj"\n' > cup.toml
  for turn in $order; do printf '[[dip]]\nrotate_deg = [%s, 0, 0]\ndepth_mm = 8\n' "$turn" >> cup.toml; done
  # shellcheck disable=SC2086
  "$hydrodip" print cup.toml --art picture.svg --art-toward 0,1,0 $side --dpi 72 -o cup --quiet > /dev/null || fail "print of a cup: $?"
  python3 - <<'PY' || fail "air of two dips, $order"
import json
report = json.load(open('cup/report.json'))
parts = [json.load(open(f'cup/dip-{k}/report.json'))['air']['area_mm2'] for k in (1, 2)]
assert report['air']['cell_mm'] > 0, report['air']
assert min(parts) == 0 < max(parts) and abs(report['air']['area_mm2'] - max(parts)) < 1e-9, (report['air'], parts)
told = [f['title'] for f in report['findings'] if 'air' in (f['title'] + f['figure'] + f['text']).split()]
assert told == [f'Dip {1 + parts.index(max(parts))}'], report['findings']
PY
done
# Colours land as far off as in the dip whose ink is settled least, whichever that is.
"$hydrodip" sample mask -o masks --quiet > /dev/null || fail 'sample mask'
printf '[object]\nfile = "masks/mask.obj"\n[[dip]]\nrotate_deg = [0, 0, 45]\ndepth_mm = 15\n[[dip]]\nrotate_deg = [-135, 0, 45]\ndepth_mm = 60\n' > masks.toml
"$hydrodip" print masks.toml --film 120x120 --set film.elements=800 --set dip.step_mm=1 --dpi 72 --set dip.air_cells=0 \
  --set ink.rounds_max=2 --set preview.pictures=off -o masks --quiet > /dev/null || fail "print masks.toml: $?"
python3 - <<'PY' || fail 'how far colours land off where the second dip is not settled'
import json
report = json.load(open('masks/report.json'))
moved = [json.load(open(f'masks/dip-{k}/report.json'))['figures']['ink_last_change_mm'] for k in (1, 2)]
told = next(f['figure'] for f in report['findings'] if f['key'] == 'registration')
first, second = (f"{report['stretch']['stretch_max'] + mm:.1f} mm" for mm in moved)
assert moved[0] < moved[1] and told == second != first, (told, moved, report['stretch'])
PY
# A model without a picture can be planned; what it ends with says where the picture goes.
write_tetrahedron plain.obj
# shellcheck disable=SC2086
"$hydrodip" plan plain.obj $small --dips 1 --quality draft -o plain --quiet > said.txt || fail "plain: $?"
grep -q '^print them all, with the picture .*: hydrodip print plain/plan.toml --art IMG -o plain-print$' said.txt || fail 'no word of the picture'
# Dips are chosen by a picture that is given, and it is the plan's from then on.
# shellcheck disable=SC2086
"$hydrodip" plan plain.obj $small --dips 1 --quality draft --art picture.svg --art-toward 0,1,0 -o pictured --quiet > said.txt ||
  fail "plan --art: $?"
grep -q '^print them all: hydrodip print pictured/plan.toml -o plain-print$' said.txt || fail 'plan --art asks for a picture'
grep -q '^\[\[artwork\]\]' pictured/plan.toml || fail 'plan.toml has lost its picture'
# shellcheck disable=SC2086
"$hydrodip" orient plain.obj $small --quality draft --art picture.svg --art-toward 0,1,0 -o toward --json --quiet > toward.json ||
  fail "orient --art: $?"
grep -q '"command": ".*--art picture.svg .*--art-toward 0,1,0' toward.json || fail 'orient loses the picture'
"$hydrodip" print plan/plan.toml --dpi 72 --set print.samples=1 -o dips --quiet > dips.txt ||
  fail "print of a plan: $?"
for file in dip-1/print.pdf dip-1/print.tif dip-1/report.json dip-1/run-sheet.pdf report.html report.json \
  preview.png dips.png; do
  [ -s "dips/$file" ] || fail "no dips/$file"
done
(cd plan && "$hydrodip" print plan.toml --dpi 72 --set print.samples=1 -o ../again --quiet > /dev/null) ||
  fail 'print of a plan from its folder'
for file in dip-1/print.pdf dip-1/print.png preview.png; do
  cmp "dips/$file" "again/$file" || fail "$file depends on the folder"
done

# What is lightened is lightened alike on both sides of a seam, though one dip stretches more.
convert -size 8x8 xc:red red.png
"$hydrodip" sample sphere -o samples --quiet > /dev/null || fail 'sample sphere'
cat > red.toml <<'TOML'
[object]
file = "samples/sphere.obj"
texture = "red.png"
size_mm = 40
[[dip]]
rotate_deg = [180, 0, 25]
depth_mm = 14
[[dip]]
rotate_deg = [-8, -13, 25]
depth_mm = 6
TOML
"$hydrodip" print red.toml --film 120x120 --set film.elements=3000 --set dip.step_mm=1 --dpi 72 --set dip.air_cells=0 \
  --set preview.pictures=off --set gamut.policy=scale -o red --quiet > /dev/null || fail 'print red.toml'
python3 - <<'PY' || fail 'dips are lightened differently'
import json
factors = [json.load(open(f'red/dip-{k}/report.json'))['figures']['lightened'] for k in (1, 2)]
assert factors[0] == factors[1] < 0.95, factors
PY

# A dip that landed elsewhere is corrected by its own table.
python3 "$here/film_ply.py" places dips/dip-1/film.ply 1 > places.csv || fail 'places'
"$hydrodip" correct dips/dip-1 places.csv --quiet > /dev/null || fail "correct of a dip: $?"
awk '{ print } /^rotate_deg/ && !n++ { print "correction = \"../dips/dip-1/correction.json\"" }' \
  plan/plan.toml > plan/second.toml
"$hydrodip" print plan/second.toml --dpi 72 --set print.samples=1 -o second --quiet > second.txt ||
  fail "print with a dip's correction: $?"
python3 "$here/film_ply.py" shifted dips/dip-1/film.ply second/dip-1/film.ply 1 0.1 ||
  fail 'the corrected dip is not moved by 1 mm'
grep -q 'dip-1/correction.json' second/dip-1/report.json || fail 'the report does not name the correction'

# refused WHY COMMAND...: exits with 2 and says so in one line.
refused() {
  why=$1
  shift
  "$hydrodip" "$@" > out.txt 2> err.txt
  code=$?
  [ "$code" -eq 2 ] || fail "$*: exit $code"
  [ "$(wc -l < err.txt)" -eq 1 ] || fail "$*: $(cat err.txt)"
  grep -q -e "$why" err.txt || fail "$*: $(cat err.txt)"
}
refused 'name one of them, as dips/dip-1' rig sheet dips
printf '[object]\nfile = "colored.ply"\n[[dip]]\ncorrection = "dips/dip-1/correction.json"\n' > bad.toml
refused 'of one pose' print bad.toml
refused 'how many dips' plan colored.ply
# What would be passed over is refused.
printf '[object]\nfile = "colored.ply"\n[[dip]]\nrotate_deg = [0, 0, 0]\n[[dip]]\n' > two.toml
refused '^error: --rotate: .*tables' print two.toml --rotate 10,0,0
refused '^error: --depth: .*tables' plan two.toml --dips 2 --depth 3
refused '^error: --set object.down: .*tables' print two.toml --set object.down=+y
refused '2 .*tables' plan two.toml --dips 1
refused '^error: --depth: .*looked for' plan colored.ply --dips 2 --depth 3
refused '^error: --set dip.depth_mm: .*looked for' print colored.ply --dips 2 --set dip.depth_mm=3
for job in '[dips]\ndepth_mm = 3\n[[dip]]\nrotate_deg = [0, 0, 0]' '[dip]\ndepth_mm = 3\n[plan]\ndips = 2'; do
  printf '[object]\nfile = "colored.ply"\n%b\n' "$job" > common.toml
  for command in print plan; do refused '^error: common.toml:4: dips\?.depth_mm: each of several dips' $command common.toml; done
done
refused "'hydrodip plan'" orient two.toml
refused "'hydrodip print'" simulate two.toml
printf '[object]\nfile = "colored.ply"\n[[dip]]\nrotate_deg = [0, 0]\n' > bad.toml
refused 'bad.toml:4' print bad.toml
printf '[object]\nfile = "colored.ply"\n[[dip]]\nrotat_deg = [0, 0, 0]\n' > bad.toml
refused 'rotate_deg' print bad.toml
printf '[[dip]]\n' > bad.toml
refused 'names no model' print bad.toml
printf '[object]\nfile = "colored.ply"\n[[dip]]\n[[dip]]\npath = "gone.csv"\n' > bad.toml
refused '^error: bad.toml:5: \[\[dip]] 2: path: gone.csv: cannot be read' print bad.toml
printf 'lower_mm,shift_x_mm,shift_y_mm,turn_x_deg,turn_y_deg,turn_z_deg\n0,0,0,0,0,0\n5,0,0,0,0,0\n' > way.csv
refused 'a path says how deep' print colored.ply --depth auto --path way.csv

# Another way in than straight down is looked for in its own dips.
# shellcheck disable=SC2086
"$hydrodip" inspect colored.ply $small --rotate auto --path way.csv --quiet > /dev/null || fail 'rotate auto with a path'

# A size that was forgotten is asked about before anything is computed.
printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n' > tiny.obj
refused 'is it really 1 mm' simulate tiny.obj
"$hydrodip" simulate tiny.obj --units cm --film 60x60 --set film.elements=200 --set dip.step_mm=1 \
  --set preview.pictures=off -o tiny --quiet > /dev/null || fail 'units are given'

# --strict: a dip that should not be made is a failure of its own; the files are there all the same.
"$hydrodip" sample sphere -o samples > /dev/null
strict="simulate samples/sphere.obj --film 120x120 --set film.elements=2000 --set dip.step_mm=1
        --set preview.pictures=off"
# shellcheck disable=SC2086
"$hydrodip" $strict --strict -o strict --quiet > strict.txt
[ $? -eq 4 ] || fail '--strict does not exit with 4'
grep -q '^Do not dip it like this' strict.txt || fail 'the headline does not come first'
grep -q '^Better: .*about .* of the surface covered (now .*torn (now ' strict.txt || fail 'no better way is quoted beside what it betters'
[ -s strict/report.json ] || fail 'strict writes nothing'
# shellcheck disable=SC2086
"$hydrodip" $strict --set plan.suggest=off -o lax --quiet > lax.txt || fail 'without --strict'
! grep -q '^Better' lax.txt || fail 'a better way is looked for all the same'
grep -q 'hydrodip orient looks for' lax.txt || fail 'who is not told a better way is not told who knows one'
# Of a picture on top the verdict speaks of what shall be printed, and so does what betters it.
sed '/^mtllib/d; /^usemtl/d' samples/sphere.obj > bare.obj
pictured="simulate bare.obj --film 120x120 --set film.elements=2000 --set dip.step_mm=1 --art picture.svg
          --art-size 30 --set preview.pictures=off --quiet"
# shellcheck disable=SC2086
"$hydrodip" $pictured --art-toward 0,0,-1 -o above > above.txt || fail "a picture above: $?"
grep -q '^Better: .*about .* of what shall be printed covered (now ' above.txt || fail 'what is better is told in another measure'
# Who looked for the best way is not sent to look for it.
# shellcheck disable=SC2086
"$hydrodip" $pictured --art-toward 0,0,1 --set material.tear_stretch=1.02 --rotate auto --depth auto -o best > best.txt ||
  fail "the best: $?"
grep -q '^This is the best single dip that was found: .*--dips 2' best.txt || fail 'nothing is said to help beyond the best dip'
! grep -q 'rotate auto' best.txt || fail 'who looked for the best way is sent to look for it'
# An open shell whose faces look inwards is said to be that, whoever finds no film on it.
python3 - <<'PY'
corners = [(x, y, z) for z in (0, 1) for y in (0, 1) for x in (0, 1)]
faces = [(0, 2, 1), (1, 2, 3), (0, 1, 4), (1, 5, 4), (2, 6, 3), (3, 6, 7), (0, 4, 2), (2, 4, 6), (1, 3, 5), (3, 7, 5)]
with open('tray.obj', 'w') as file:
    for x, y, z in corners:
        file.write(f'v {40 * x} {40 * y} {10 * z}\n')
    for a, b, c in faces:
        file.write(f'f {a + 1} {c + 1} {b + 1}\n')
PY
tray="tray.obj $small --quiet"
mend='faces look inwards.*turn their normals round in the program that made it'
# shellcheck disable=SC2086
"$hydrodip" inspect $tray | grep -q "^warning: .*$mend" || fail 'inspect does not see that faces look inwards'
# shellcheck disable=SC2086
"$hydrodip" simulate $tray -o tray > tray.txt || fail "simulate of a tray: $?"
grep -q "^Do not dip it like this. No film stays on the object: its $mend" tray.txt || fail 'simulate does not know why no film stays'
! grep -q 'hydrodip orient' tray.txt || fail 'turning is said to mend normals'
# shellcheck disable=SC2086
refused "$mend" print --art picture.svg $tray -o tray
printf '[object]\nfile = "tray.obj"\n[[dip]]\nrotate_deg = [0, 0, 0]\ndepth_mm = 5\n[[dip]]\nrotate_deg = [0, 20, 0]\ndepth_mm = 5\n' \
  > trays.toml
# shellcheck disable=SC2086
refused "$mend" print trays.toml --art picture.svg --dpi 72 $small -o trays

# shellcheck disable=SC2086
"$hydrodip" $strict --quality draft -o draft --quiet > draft.txt || fail 'a draft'
! grep -q '^Better' draft.txt || fail 'a draft looks for a better way'

finish
