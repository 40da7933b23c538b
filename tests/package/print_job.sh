#!/bin/sh
# The library gives the bytes of the program.
. "$(dirname "$0")/example.sh"

hydrodip=$prefix/bin/hydrodip
"$hydrodip" sample mask -o models --quiet > said.txt || fail "the sample mask"
run models/mask.obj library
"$hydrodip" print models/mask.obj --size 60 --film 100x120 --set film.elements=4000 \
  --set dip.step_mm=0.5 --dpi 90 --set print.job_name=example --set preview.pictures=off \
  -o program --quiet > program.txt || fail "the program"
for file in print.png print.tif print.pdf film.ply; do
  cmp -s library/$file program/$file || fail "$file differs from the program's"
done
pngcheck -q library/look.png || fail "look.png is damaged"
# What it says is what the program reports.
node -e '
  const fs = require("fs");
  const said = fs.readFileSync("said.txt", "utf8");
  const report = JSON.parse(fs.readFileSync("program/report.json"));
  const number = (name) => Number(said.match(new RegExp(name + ": ([0-9.]+)"))[1]);
  const near = (a, b, by) => Math.abs(a - b) <= by;
  process.exit(
    near(number("covered"), 100 * report.coverage.covered_downward_share, 0.06) &&
    near(number("largest stretch"), report.stretch.stretch_max, 0.006) ? 0 : 1);
' || fail "it says other than report.json"

"$example" no-such.obj other > said.txt 2> error.txt && fail "a missing model is no error"
grep -q 'no-such.obj' error.txt || fail "it does not say which file is missing: $(cat error.txt)"
[ ! -e other ] || fail "it left a folder behind"
