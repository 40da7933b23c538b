#!/bin/sh
# A sweep on Dask: a scheduler and two workers on this machine, one of which is killed in the middle.
# Skipped where Dask is not installed.
examples=$(cd "$(dirname "$0")/../../examples/python" && pwd)
. "$(dirname "$0")/common.sh"
# Debian's Python has it, which need not be the first on the path.
for python in python3 /usr/bin/python3 ''; do
  "${python:-false}" -c 'import dask.distributed' 2> /dev/null && break
done
[ -n "$python" ] || { echo 'no Dask: skipped'; exit 77; }

# A worker that is asked to end waits for a scheduler that is gone.
trap 'kill -9 $scheduler $one $two 2> /dev/null; wait 2> /dev/null; rm -rf "$work"' EXIT
HYDRODIP=$hydrodip
export HYDRODIP
port=$((20000 + $$ % 20000))
"$python" -m distributed.cli.dask_scheduler --host 127.0.0.1 --port $port --no-dashboard > scheduler.log 2>&1 &
scheduler=$!
worker() {
  "$python" -m distributed.cli.dask_worker "tcp://127.0.0.1:$port" --nthreads 1 --no-nanny --no-dashboard \
    --name "$1" > "$1.log" 2>&1 &
}
worker one
one=$!
worker two
two=$!

write_sweep 800 0.5 <<'TOML'
"material.z_stretch" = { from = 0.3, to = 0.9, count = 100 }
TOML
"$hydrodip" sweep plan sweep.toml -o s --no-trial --quiet > /dev/null || fail 'sweep plan'
for _ in $(seq 60); do
  grep -q 'name: two\|Registered' two.log 2> /dev/null && grep -q 'Registered' one.log && break
  sleep 0.5
done
"$python" "$examples/sweep_on_dask.py" s "tcp://127.0.0.1:$port" > said.txt 2> progress.txt &
sweep=$!
until [ "$(ls s/runs 2> /dev/null | wc -l)" -ge 3 ]; do
  kill -0 "$sweep" 2> /dev/null || break
  sleep 0.1
done
kill -9 "$two"
wait "$sweep" || fail "the sweep on Dask: $(cat said.txt progress.txt)"
grep -q '^100 runs: 100 done, 0 failed, 0 missing' said.txt || fail "$(cat said.txt)"
finish
