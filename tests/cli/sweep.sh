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
for _ in $(seq 2000); do
  [ "$(ls s/claims 2> /dev/null | wc -l)" -lt 2 ] || break
  sleep 0.005
done
kill -9 "$one"
wait "$two" || fail 'sweep run --shard'
wait "$one" 2> /dev/null
"$hydrodip" sweep run s --quiet > rest.txt || fail 'sweep run after a kill'
grep -q '^0 done' rest.txt && fail 'the kill came too late to leave anything'
[ "$(ls s/runs | wc -l)" -eq 24 ] || fail 'not every run is done'
[ -z "$(ls s/claims)" ] || fail 'a claim was left'
"$hydrodip" sweep run s --quiet | grep -q '^0 done, 0 failed, 24 were done before' || fail 'done again'

# What another version of the program did is told, and done once more if that is wanted.
other=$(ls s/runs/*.json | head -1)
sed 's/"version":"[^"]*"/"version":"0.0.1"/' "$other" > other.json && mv other.json "$other"
"$hydrodip" sweep run s --quiet > said.txt || fail 'sweep run after an upgrade'
grep -q '1 by hydrodip 0\.0\.1; this is hydrodip [0-9]' said.txt || fail "another version: $(cat said.txt)"
"$hydrodip" sweep run s --quiet --again > said.txt || fail 'sweep run --again'
grep -q '^1 done, 0 failed, 23 were done before' said.txt || fail "another version: $(cat said.txt)"
grep -q 'other version' said.txt && fail "no other version is left: $(cat said.txt)"

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
# Files are named from the sweep's own file, wherever a run is started.
mkdir -p "o'er there" && cp colored.ply "o'er there/part.ply"
printf '[sweep]\nquality = "draft"\n[set]\n"film.elements" = 800\n"dip.step_mm" = 1\n[vary]\n"object.file" = ["part.ply"]\n' \
  > "o'er there/files.toml"
"$hydrodip" sweep plan "o'er there/files.toml" -o "o'er there/s" --no-trial --tasks 100000 > said.txt ||
  fail 'a sweep elsewhere'
grep -q '^1 run$' said.txt || fail "one run: $(cat said.txt)"
grep -q '(1 task)' said.txt || fail "more tasks than runs: $(cat said.txt)"
eval "$(sed -n "s/^here: *hydrodip/\"\$hydrodip\"/p" said.txt) --quiet" > ran.txt || fail 'the command that is shown'
grep -q '^1 done, 0 failed' ran.txt || fail "elsewhere: $(cat ran.txt)"
rm -r "o'er there/s/runs" && (cd "o'er there/s" && "$hydrodip" sweep run . --quiet) | grep -q '^1 done, 0 failed' ||
  fail 'from within'
# What is wrong with a run is its result, not the sweep's.
printf '[sweep]\nquality = "draft"\nmodels = ["colored.ply"]\n[vary]\n"film.margin_mm" = [10, 200]\n' > half.toml
"$hydrodip" sweep plan half.toml -o half --no-trial > /dev/null || fail 'half: plan'
"$hydrodip" sweep run half --quiet > said.txt || fail 'half: run'
grep -q '^1 done, 1 failed' said.txt || fail "half: $(cat said.txt)"

# A full disk is no run's result. (Where a file system of one's own may be mounted.)
if unshare -rm true 2> /dev/null; then
  mkdir disk
  hydrodip=$hydrodip unshare -rm sh -c '
    mount -t tmpfs -o size=120k tmpfs disk && "$hydrodip" sweep plan sweep.toml -o disk/s --no-trial > /dev/null &&
      dd if=/dev/zero of=disk/full bs=1k 2> /dev/null
    "$hydrodip" sweep run disk/s --quiet > said.txt 2>&1
    echo $? > code.txt
    ls disk/s/runs | wc -l > runs.txt
    "$hydrodip" sweep plan sweep.toml -o disk/t > planned.txt 2>&1
    echo $? >> planned.txt
    ls disk >> planned.txt
    rm disk/full
    mount -o remount,size=64m disk
    "$hydrodip" sweep run disk/s --quiet > rest.txt 2>&1'
  [ "$(cat code.txt)" -eq 2 ] || fail "a full disk: exit code $(cat code.txt): $(cat said.txt)"
  grep -q 'No space left.*kept' said.txt || fail "a full disk: $(cat said.txt)"
  grep -q '0 failed' rest.txt || fail "after a full disk: $(cat rest.txt)"
  # What is not planned cannot be run.
  [ "$(grep -c -x -e 2 -e full -e s planned.txt)" -eq 3 ] && grep -q 'not planned' planned.txt &&
    ! grep -q -e '^t$' -e 'sweep run' planned.txt || fail "planned on a full disk: $(cat planned.txt)"
fi

refused '--set' sweep run s --set dip.depth_mm=3
refused 'sweep plan' sweep run nowhere
refused 'sweep' sweep
refused 'no run' sweep run s --task 0123
refused '2/4' sweep run s --shard 5/4
refused 'name the sweep' sweep plan
echo 'x = 1' > bad.toml
refused "unknown 'x'" sweep plan bad.toml
finish
