#!/bin/sh
# Files that people have, and what must never happen to them: nothing of theirs is overwritten,
# nothing in them reaches the terminal raw, and what is missing is named with who asks for it.
. "$(dirname "$0")/common.sh"

# refused FRAGMENT ARGUMENTS...: exit code 2 and one sentence that contains FRAGMENT.
refused() {
  fragment=$1
  shift
  "$hydrodip" "$@" --quiet > "$work/.out" 2> "$work/.err"
  code=$?
  [ "$code" -eq 2 ] || fail "exit code $code instead of 2: $*: $(cat "$work/.err")"
  [ "$(wc -l < "$work/.err")" -eq 1 ] || fail "not one line on stderr: $*: $(cat "$work/.err")"
  grep -qF -- "$fragment" "$work/.err" || fail "no '$fragment' in: $(cat "$work/.err")"
}

write_slab() {  # a textured slab; $1: its material library
  {
    [ -z "$1" ] || echo "mtllib $1"
    printf 'v 0 0 0\nv 60 0 0\nv 60 60 0\nv 0 60 0\nv 0 0 10\nv 60 0 10\nv 60 60 10\nv 0 60 10\n'
    printf 'vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nusemtl m\nf 4/4 3/3 2/2 1/1\nf 5/1 6/2 7/3 8/4\n'
    printf 'f 1/1 2/2 6/3 5/4\nf 2/1 3/2 7/3 6/4\nf 3/1 4/2 8/3 7/4\nf 4/1 1/2 5/3 8/4\n'
  }
}

"$hydrodip" sample box -o samples > /dev/null || fail 'sample box'
mkdir slab
cp samples/box.png slab/tex.png
write_slab slab.mtl > slab/slab.obj
printf 'newmtl m\nKd 1 1 1\nmap_Kd tex.png\n' > slab/slab.mtl
"$hydrodip" print slab/slab.obj $quick -o right --quiet > /dev/null || fail 'print of the slab'

# The same print, however the model is written down.
same() {
  "$hydrodip" print "$1" $quick -o same --quiet > same.txt || fail "print $1"
  cmp -s right/print.png same/print.png || fail "$1 prints differently"
}
{ printf '\357\273\277'; cat slab/slab.obj; } > slab/bom.obj
same slab/bom.obj
printf 'newmtl q\nKd 1 0 0\n' > slab/q.mtl
write_slab 'q.mtl slab.mtl' > slab/two.obj
same slab/two.obj
printf 'newmtl m\nTr 1.000000\nmap_Kd TEX.PNG\n' > slab/tr.mtl
write_slab tr.mtl > slab/tr.obj
same slab/tr.obj
grep -q 'Tr 1' same.txt || fail 'no warning about Tr 1'

# What is missing, and who asks for it.
printf 'newmtl m\nKd 1 1 1\nmap_Kd nothere.png\n' > slab/miss.mtl
write_slab miss.mtl > slab/miss.obj
refused 'nothere.png that miss.mtl refers to' print slab/miss.obj -o out
write_slab gone.mtl > slab/nomtl.obj
refused 'gone.mtl that nomtl.obj refers to' print slab/nomtl.obj -o out
"$hydrodip" inspect slab/nomtl.obj | grep -q 'gone.mtl that nomtl.obj refers to' ||
  fail 'a missing material library is not named'
write_tetrahedron tetra.obj
refused 'nope.png' print tetra.obj --texture nope.png -o out

# One plain colour is a picture; white is none, and neither is a picture of it.
printf 'newmtl m\nKd 0.8 0.2 0.1\n' > slab/plain.mtl
write_slab plain.mtl > slab/plain.obj
"$hydrodip" print slab/plain.obj $quick -o plain --quiet > plain.txt || fail 'print of one colour'
grep -q '#cc331a' plain.txt || fail 'one plain colour is not said'
if command -v convert > /dev/null; then
  convert -size 8x8 xc:white slab/white.png
  refused 'blank' print slab/slab.obj --texture slab/white.png $quick -o blank
  [ ! -e blank ] || fail 'a blank sheet leaves files'
fi

# Nobody's files are overwritten.
mkdir own
cp slab/slab.obj own/slab.obj
cp slab/tex.png own/print.png
printf 'newmtl m\nKd 1 1 1\nmap_Kd print.png\n' > own/slab.mtl
(cd own && refused 'would overwrite it' print slab.obj $quick -o .)
cmp -s own/print.png slab/tex.png || fail 'an input was overwritten'
mkdir foreign
echo 'my notes' > foreign/report.html
refused 'not written by hydrodip' print slab/slab.obj $quick -o foreign
[ "$(cat foreign/report.html)" = 'my notes' ] || fail 'a foreign file was replaced'
[ "$(ls -A foreign)" = report.html ] || fail 'files beside a foreign one'
"$hydrodip" print slab/slab.obj $quick -o right --quiet > again.txt || fail 'second print'
grep -q 'replaced the earlier result' again.txt || fail 'an earlier result is replaced in silence'
grep -q 'replaced' plain.txt && fail 'nothing was replaced the first time'
# A profile that is read is an input too.
mkdir profiled
"$hydrodip" calibrate synth sphere --film 110x110 --set film.elements=1000 --set dip.step_mm=1 -o profiled \
  --quiet > /dev/null || fail 'synth'
cp profiled/truth.toml profiled/profile.toml
(cd profiled && refused 'would overwrite it' calibrate sphere-scan.obj --film 110x110 \
  --set film.elements=1000 --set dip.step_mm=1 --profile profile.toml --z-stretch 0.6 --ratio 30 \
  --poisson 0.1 -o .)
cmp -s profiled/truth.toml profiled/profile.toml || fail 'a profile was overwritten'
# Every command that writes says so.
small="--film 120x120 --set film.elements=200 --set dip.step_mm=5 --set print.dpi=36 --set print.samples=1
  --set preview.width_px=64"
grid='--film 110x110 --set film.elements=1000 --set dip.step_mm=1'
for command in "orient slab/slab.obj $small" "nest slab/slab.obj $small" 'inspect tetra.obj' 'sample sphere' \
  'calibrate printer' 'register board' "calibrate synth sphere $grid" \
  "calibrate twice/sphere-scan.obj $grid --z-stretch 0.6 --ratio 30 --poisson 0.1"; do
  for turn in first second; do
    # shellcheck disable=SC2086
    "$hydrodip" $command -o twice --quiet > $turn.txt 2> $turn.err || fail "$command: $(cat $turn.err)"
  done
  grep -q 'replaced the earlier result' second.txt || fail "$command replaces in silence: $(cat second.txt)"
done

# The next run clears what a killed one left.
mkdir -p killed/.hydrodip-abcdef
echo half > killed/.hydrodip-abcdef/print.png
"$hydrodip" inspect tetra.obj --set preview.width_px=200 -o killed > /dev/null || fail 'inspect -o'
[ "$(ls -A killed | tr '\n' ' ')" = 'angles.png report.json ' ] || fail "left: $(ls -A killed)"

# Reports differ in their times and memory alone.
if command -v python3 > /dev/null; then
  "$hydrodip" print slab/slab.obj $quick -o right --quiet > /dev/null || fail 'third print'
  cp -r right first
  "$hydrodip" print slab/slab.obj $quick -o right --quiet > /dev/null || fail 'fourth print'
  python3 - <<'PY' || fail 'reports differ in more than times and memory'
import json, re
reports = [json.load(open(f + '/report.json')) for f in ('first', 'right')]
for report in reports:
    del report['seconds']
    report.pop('peak_memory_bytes', None)
assert reports[0] == reports[1]
pages = [re.sub(r'<section id="times">.*?</section>', '', open(f + '/report.html').read(), flags=re.S)
         for f in ('first', 'right')]
assert pages[0] == pages[1]
PY
fi

# No control character of a file or a path reaches the terminal; C1 is control too.
esc=$(printf '\033')
mkdir odd
printf 'newmtl a\nKd 0.8 0.5 0.5\nmap_Kd \033]0;title\007\033[31mRED\302\2332J.png\n' > odd/m.mtl
{ echo 'mtllib m.mtl'; echo 'usemtl a'; cat tetra.obj; } > odd/m.obj
printf 'ply\nformat ascii 1.0\nelement \033[31mx\nend_header\n' > odd/e.ply
cp tetra.obj "odd/t${esc}[1m.obj"
for arguments in odd/m.obj odd/e.ply "odd/t${esc}[1m.obj" "odd/none${esc}[1m.obj"; do
  for json in '' --json; do
    # shellcheck disable=SC2086
    "$hydrodip" inspect "$arguments" $json > shown.txt 2>&1
    LC_ALL=C grep -q "[$(printf '\001-\010\013-\037\177')]" shown.txt &&
      fail "control characters from $arguments: $(cat -v shown.txt)"
    LC_ALL=C grep -q "$(printf '\302[\200-\237]')" shown.txt && fail "C1 from $arguments"
  done
done

# Limits of the system end in a sentence, and few threads in the same bytes. Threads are counted for
# users other than root.
if command -v prlimit > /dev/null; then
  one_line() {
    [ "$(wc -l < limit.txt)" -eq 1 ] || fail "$1: not one line: $(cat limit.txt)"
    grep -q 'unexpected' limit.txt && fail "$1: unexpected: $(cat limit.txt)"
    [ ! -e other/limited/.hydrodip-* ] || fail "$1 leaves files"
  }
  cp "$hydrodip" program
  mkdir other
  chmod -R a+rX "$work"
  chmod a+rwx other
  as_other=
  if [ "$(id -u)" -eq 0 ]; then as_other='setpriv --reuid 65534 --regid 65534 --clear-groups'; fi
  # shellcheck disable=SC2086
  $as_other ./program --version > /dev/null 2>&1 || as_other='-'  # no way there for others

  # shellcheck disable=SC2086
  run_limited() {
    timeout -k 1 300 $as_other prlimit "$1" ./program print slab/slab.obj $quick \
      -o other/limited --quiet > /dev/null 2> limit.txt
  }
  if [ "$as_other" != '-' ]; then
    for limit in 1 2 3; do
      run_limited --nproc=$limit || fail "a limit of $limit processes: $?: $(cat limit.txt)"
      cmp -s right/print.png other/limited/print.png || fail "$limit processes: another print"
      rm -rf other/limited
    done
    run_limited --fsize=50000
    code=$?
    [ "$code" -eq 2 ] || fail "a file-size limit: exit code $code: $(cat limit.txt)"
    one_line 'a file-size limit'
    [ ! -e other/limited ] || fail 'a file-size limit leaves files'
    for limit in 150 221 260 300 340 400 500; do
      run_limited --as=${limit}000000
      code=$?
      if [ "$code" -eq 2 ] || [ "$code" -eq 3 ]; then
        one_line "a limit of $limit MB"
        grep -qE 'not enough memory|GB of memory' limit.txt ||
          fail "a limit of $limit MB: no word about memory: $(cat limit.txt)"
      elif [ "$code" -ne 0 ]; then
        fail "a limit of $limit MB: exit code $code: $(cat limit.txt)"
      fi
      rm -rf other/limited
    done
  fi
fi

# Settings.
awk 'BEGIN { printf "a"; for (i = 0; i < 9999; ++i) printf ".a"; print " = 1" }' > deep.toml
refused 'levels deep' inspect tetra.obj --config deep.toml
printf '[object]\nrotate_deg = [-9223372036854775808, 2, 3]\nsize_mm = -9223372036854775808\n' > least.toml
refused '-9223372036854775808' inspect tetra.obj --config least.toml

finish
