#!/bin/sh
# Another country's way to write numbers changes nothing: every command says and writes the same
# bytes under a German locale, but for times and memory.
here=$(cd "$(dirname "$0")" && pwd)
. "$here/common.sh"

localedef -i de_DE -f UTF-8 "$work/de_DE.UTF-8" 2> /dev/null
[ -d "$work/de_DE.UTF-8" ] || exit 77
LOCPATH=$work
export LOCPATH
# What other programs make of it.
[ "$(LC_ALL=de_DE.UTF-8 awk 'BEGIN { printf "%.1f", 0.5 }' | tr , .)" = 0.5 ] || fail 'awk'
[ "$(LC_ALL=de_DE.UTF-8 locale decimal_point)" = , ] || fail 'the locale is not German'

mkdir plain german inputs
write_colored inputs/colored.ply
"$hydrodip" sample box -o inputs > /dev/null || fail 'sample box'

# Without what may differ: times and memory, which the reports keep in places of their own.
cat > comparable.mjs <<'JS'
import { readFileSync } from "node:fs";
const file = process.argv[2], text = readFileSync(file, "utf8");
const timeless = (key, value) => (/^(time|elapsed_s|seconds|seconds\.total|peak_memory_bytes)$/.test(key) ? undefined : value);
if (file.endsWith(".json")) {
  console.log(JSON.stringify(JSON.parse(text, timeless)));
} else {
  console.log(text.replace(/<section id="times">[^]*?<\/section>/, "")
    .replace(/[0-9]{4}-[0-9]{2}-[0-9]{2}[T ][0-9:.]+Z?/g, "").replace(/[0-9.]+ s\b/g, ""));
}
JS

# works ARGUMENTS...: in both folders, without a fault; what it asks for is answered by the file
# answers. For what depends on when it was and how long it took.
: > answers
works() {
  for language in plain german; do
    locale=C
    if [ "$language" = german ]; then locale=de_DE.UTF-8; fi
    (cd "$language" && LC_ALL=$locale XDG_CONFIG_HOME=$PWD/config "$hydrodip" "$@" \
      > "../$language.out" 2> "../$language.err" < "../answers")
    echo "$?" > "$language.code"
  done
  cmp -s plain.code german.code || fail "$*: exit code $(cat german.code): $(cat german.err)"
  [ "$(cat plain.code)" -eq 0 ] || fail "$*: exit code $(cat plain.code): $(cat plain.err)"
}

# same ARGUMENTS...: and says the same.
same() {
  works "$@"
  # Some name their files with the whole path.
  sed "s|$work/german|$work/plain|" german.out > german.said
  # When it was, and how long it took.
  sed -i -E 's/[0-9]{4}-[0-9]{2}-[0-9]{2}[T ][0-9:.]+Z?/TIME/g; s/[0-9.]+ s( |$)/TIME\1/g' plain.out german.said
  cmp -s plain.out german.said || fail "$*: says something else: $(diff plain.out german.said)"
  grep -v '%' plain.err > plain.said
  grep -v '%' german.err > german.said
  cmp -s plain.said german.said || fail "$*: stderr: $(diff plain.said german.said)"
}

same --version
same params
same params --json
same sample sphere -o samples
same inspect samples/sphere.obj --set preview.width_px=200 -o inspected --quiet
same inspect samples/sphere.obj --size 99.5 --json --quiet
# shellcheck disable=SC2086
same print ../inputs/colored.ply $quick --set material.poisson=0.25 -o printed --quiet
# shellcheck disable=SC2086
same simulate ../inputs/colored.ply --film-image printed/print.png $quick_simulate -o dipped --quiet
same view printed
same rig sheet printed
same rig stage dip printed --dry-run
same calibrate kit -o kit --film letter --quiet
film='--film 110x110 --set film.elements=1000 --set dip.step_mm=1'
# shellcheck disable=SC2086
same calibrate synth sphere $film --noise 0.05 -o scans --quiet
# shellcheck disable=SC2086
same measure sphere=scans/sphere-scan.csv $film --profile scans/truth.toml -o measured --quiet
# shellcheck disable=SC2086
same calibrate scans/sphere-scan.obj $film --z-stretch 0.55,0.75 --ratio 30 --poisson 0.1 \
  -o calibrated --quiet
# shellcheck disable=SC2086
same calibrate pack sphere=scans/sphere-scan.obj $film --film-product f --printer p --ink i \
  --activator a --activator-g 3.5 --water-c 28.5 --soak-s 70 --wait-s 30 --owner o --licence CC0-1.0 \
  -o packed --quiet
small='--film 120x120 --set film.elements=800 --set dip.step_mm=1 --set preview.width_px=200'
# shellcheck disable=SC2086
same pattern ../inputs/colored.ply --tile ../inputs/box.png --tile-mm 12.5 $small --dpi 72 -o patterned --quiet
# shellcheck disable=SC2086
same nest ../inputs/colored.ply ../inputs/colored.ply $small --film 200x120 --dpi 72 -o nested --quiet
# shellcheck disable=SC2086
same orient ../inputs/colored.ply $small -o ways --quiet
# shellcheck disable=SC2086
same plan ../inputs/colored.ply $small --dips 2 -o plan --quiet
same register board -o board
same calibrate printer -o printer
same calibrate printer --readings 180.9,250.2,308.8,308.7 -o printer
same profile save shop --film 100x80 --set cost.film_per_m2=30.5 --set process.soak_min_s=0 \
  --set process.activator_wait_s=0 --set process.dwell_s=0 --set process.speed_mm_per_min=6000
same profile import printer/printer.toml mine
same profile list
same profile show mine
printf '%s\n' '' '' 28.5 '' '' 100 '' 98.9 '' '' '' 28.5 'no notes' > answers
works rig guide printed --profile shop --batch B7
: > answers
works history printed --add --outcome good --water 28.5,27.9 --activator 1.25
works history printed --json
cd inputs || exit 1
write_sweep 800 1 <<'TOML'
"material.z_stretch" = [0.55, 0.65]
TOML
cd .. || exit 1
same sweep plan ../inputs/sweep.toml -o swept --quiet
same sweep run swept --quiet
same sweep collect swept --quiet
# As if all of it had landed half a millimetre off.
python3 "$here/film_ply.py" places plain/printed/film.ply 0.5 > inputs/places.csv || fail 'film.ply'
same correct printed ../inputs/places.csv
# The studio starts, and ends with Ctrl-C.
for locale in C de_DE.UTF-8; do
  rm -f studio.out
  LC_ALL=$locale XDG_DATA_HOME=$work/studio "$hydrodip" studio --no-browser > studio.out 2> studio.err &
  studio=$!
  n=0
  until grep -q 'http://' studio.out 2> /dev/null || [ $((n += 1)) -gt 100 ]; do sleep 0.1; done
  kill -INT $studio
  wait $studio
  echo "$? $(sed 's|http://[^ ]*|ADDRESS|' studio.out)" > "$locale.studio"
done
cmp -s C.studio de_DE.UTF-8.studio || fail "studio: $(diff C.studio de_DE.UTF-8.studio)"
grep -q ADDRESS C.studio || fail "studio does not start: $(cat C.studio studio.err)"

(cd plain && find . -type f | LC_ALL=C sort) > files.txt
(cd german && find . -type f | LC_ALL=C sort) | cmp -s files.txt - || fail 'other files'
[ "$(wc -l < files.txt)" -gt 30 ] || fail "only $(wc -l < files.txt) files"
while read -r file; do
  case $file in
    */history.sqlite | */rig-1/* | */swept/slurm.sh | */swept/table.csv) ;;  # times, and whole paths
    */report.json | */report.html | */swept/*.json)
      for language in plain german; do node comparable.mjs "$language/$file" > "$language.report"; done
      cmp -s plain.report german.report || fail "$file differs" ;;
    */simulations.jsonl) # in the order in which they were done
      for language in plain german; do sort "$language/$file" > "$language.report"; done
      cmp -s plain.report german.report || fail "$file differs" ;;
    *) cmp -s "plain/$file" "german/$file" || fail "$file differs" ;;
  esac
done < files.txt
finish
