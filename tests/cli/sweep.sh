#!/bin/sh
# Many runs: planned, done by two processes of which one is killed, collected, and handed to GNU
# parallel where it is installed.
. "$(dirname "$0")/common.sh"

write_sweep 800 0.5 <<'TOML'
"material.z_stretch" = { from = 0.3, to = 0.9, count = 12 }
"object.rotate_deg" = [[0, 0, 0], [0, 0, 90]]
TOML
"$hydrodip" sweep plan sweep.toml -o s > said.txt || fail 'sweep plan'
grep -q '^24 runs, about' said.txt || fail "sweep plan: $(cat said.txt)"
[ -x s/slurm.sh ] && sh -n s/slurm.sh && sh -n s/parallel.sh || fail 'the scripts'
[ "$(ls s/runs | wc -l)" -eq 1 ] || fail 'the trial run'

"$hydrodip" sweep run s --quiet --threads 1 > one.txt &
one=$!
"$hydrodip" sweep run s --shard 2/2 --quiet --threads 1 > two.txt &
two=$!
sleep 0.3
kill -9 "$one"
wait "$two" || fail 'sweep run --shard'
wait "$one" 2> /dev/null
"$hydrodip" sweep run s --quiet > rest.txt || fail 'sweep run after a kill'
[ "$(ls s/runs | wc -l)" -eq 24 ] || fail 'not every run is done'
[ -z "$(ls s/claims)" ] || fail 'a claim was left'
"$hydrodip" sweep run s --quiet | grep -q '^0 done, 0 failed, 24 were done before' || fail 'done again'

# Whoever collects may be killed at any moment: the next one clears up.
for moment in 0 0.005 0.01 0.02 0.03 0.05; do
  "$hydrodip" sweep collect s > /dev/null 2>&1 &
  collector=$!
  sleep "$moment"
  kill -9 "$collector" 2> /dev/null
  wait "$collector" 2> /dev/null
done
"$hydrodip" sweep collect s > said.txt || fail 'sweep collect'
[ "$(ls -A s | tr '\n' ' ')" = 'claims parallel.sh response.svg runs slurm.sh sweep.json table.csv table.json work ' ] ||
  fail "a killed collector left something: $(ls -A s)"
grep -q '^24 runs: 24 done, 0 failed, 0 missing' said.txt || fail "collect: $(cat said.txt)"
python3 - <<'PY' || fail 'table.csv'
import csv, json
rows = list(csv.DictReader(open("s/table.csv")))
assert len(rows) == 24 and all(row["state"] == "done" for row in rows)
assert len({(row["material.z_stretch"], row["object.rotate_deg"]) for row in rows}) == 24
table = json.load(open("s/table.json"))
for row, run in zip(rows, table["runs"]):
    assert row["id"] == run["id"]
    assert float(row["coverage.covered_mm2"]) == run["figures"]["coverage.covered_mm2"]
PY
[ -s s/response.svg ] || fail 'response.svg'

# In an array of Slurm's each task takes its part; together they are the sweep.
"$hydrodip" sweep plan sweep.toml -o t --no-trial --tasks 3 > /dev/null || fail 'sweep plan --no-trial'
grep -q -- '--array=1-3' t/slurm.sh || fail '--tasks'
for task in 10 12 14; do
  SLURM_ARRAY_TASK_ID=$task SLURM_ARRAY_TASK_MIN=10 SLURM_ARRAY_TASK_STEP=2 SLURM_ARRAY_TASK_COUNT=3 \
    "$hydrodip" sweep run t --quiet | grep -q '^8 done' || fail "task $task"
done
for run in s/runs/*; do
  python3 - "$run" "t/runs/$(basename "$run")" <<'PY' || fail "another process gives another result: $run"
import json, sys
one, other = (json.load(open(name))["report"] for name in sys.argv[1:])
for own in ("seconds", "peak_memory_bytes"):
    one.pop(own, None), other.pop(own, None)
assert one == other
PY
done

if command -v parallel > /dev/null; then
  "$hydrodip" sweep plan sweep.toml -o p --no-trial --tasks 4 > /dev/null
  HYDRODIP=$hydrodip p/parallel.sh > said.txt 2> /dev/null || fail "parallel: $(cat said.txt)"
  [ "$(ls p/runs | wc -l)" -eq 24 ] || fail 'GNU parallel did not do every run'
fi

refused() {
  pattern=$1
  shift
  "$hydrodip" "$@" > said.txt 2>&1
  code=$?
  [ "$code" -eq 2 ] || fail "$*: exit code $code instead of 2"
  grep -q -- "$pattern" said.txt || fail "$*: does not say '$pattern': $(cat said.txt)"
}
refused 'sweep plan' sweep run nowhere
refused 'sweep' sweep
refused 'no run' sweep run s --task 0123
refused '2/4' sweep run s --shard 5/4
refused 'name the sweep' sweep plan
echo 'x = 1' > bad.toml
refused "unknown 'x'" sweep plan bad.toml
finish
