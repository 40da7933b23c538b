#!/bin/sh
# Another country's way to write numbers changes nothing: every command says and writes the same
# bytes under a German locale, but for times and memory.
. "$(dirname "$0")/common.sh"

localedef -i de_DE -f UTF-8 "$work/de_DE.UTF-8" 2> /dev/null
[ -d "$work/de_DE.UTF-8" ] || exit 77
LOCPATH=$work
export LOCPATH
# What other programs make of it.
[ "$(LC_ALL=de_DE.UTF-8 awk 'BEGIN { printf "%.1f", 0.5 }' | tr , .)" = 0.5 ] || fail 'awk'
[ "$(LC_ALL=de_DE.UTF-8 locale decimal_point)" = , ] || fail 'the locale is not German'

mkdir plain german inputs
write_colored inputs/colored.ply

# Without what may differ: times and memory, which the reports keep in places of their own.
cat > comparable.mjs <<'JS'
import { readFileSync } from "node:fs";
const text = readFileSync(process.argv[2], "utf8");
if (process.argv[2].endsWith(".json")) {
  const report = JSON.parse(text);
  delete report.seconds;
  delete report.peak_memory_bytes;
  console.log(JSON.stringify(report));
} else {
  console.log(text.replace(/<section id="times">[^]*?<\/section>/, ""));
}
JS

# same ARGUMENTS...: in both folders.
same() {
  for language in plain german; do
    locale=C
    if [ "$language" = german ]; then locale=de_DE.UTF-8; fi
    (cd "$language" && LC_ALL=$locale "$hydrodip" "$@" > "../$language.out" 2> "../$language.err")
    echo "$?" > "$language.code"
  done
  cmp -s plain.code german.code || fail "$*: exit code $(cat german.code): $(cat german.err)"
  [ "$(cat plain.code)" -eq 0 ] || fail "$*: exit code $(cat plain.code): $(cat plain.err)"
  # Some name their files with the whole path.
  sed "s|$work/german|$work/plain|" german.out > german.said
  cmp -s plain.out german.said || fail "$*: says something else: $(diff plain.out german.out)"
  grep -v '%' plain.err > plain.said
  grep -v '%' german.err > german.said
  cmp -s plain.said german.said || fail "$*: stderr: $(diff plain.said german.said)"
}

same --version
same params
same params --json
same sample mask -o samples
same inspect samples/mask.obj --set preview.width_px=200 -o inspected --quiet
same inspect samples/mask.obj --size 99.5 --json --quiet
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

(cd plain && find . -type f | LC_ALL=C sort) > files.txt
(cd german && find . -type f | LC_ALL=C sort) | cmp -s files.txt - || fail 'other files'
[ "$(wc -l < files.txt)" -gt 30 ] || fail "only $(wc -l < files.txt) files"
while read -r file; do
  case $file in
    */report.json | */report.html)
      for language in plain german; do node comparable.mjs "$language/$file" > "$language.report"; done
      cmp -s plain.report german.report || fail "$file differs" ;;
    */simulations.jsonl) # in the order in which they were done
      for language in plain german; do sort "$language/$file" > "$language.report"; done
      cmp -s plain.report german.report || fail "$file differs" ;;
    *) cmp -s "plain/$file" "german/$file" || fail "$file differs" ;;
  esac
done < files.txt
finish
